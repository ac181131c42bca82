from __future__ import annotations

import numpy as np
import pytest

from mascarin.materials.laws import LAWS, Law, fit


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_each_law_integrates_to_one_and_has_its_peak(law: Law) -> None:
    t = np.linspace(0.0, 50.0, 50001)
    p = (25.0, 1.0) if len(law.keys) == 1 else (25.0, 2.0, 0.5)
    xi = law.fraction(t, p[0], p[1:])
    assert (xi[0], xi[-1]) == (pytest.approx(0.0, abs=1e-9), pytest.approx(1.0, abs=1e-9))
    assert np.diff(xi).min() >= -1e-15
    rise = np.gradient(xi, t)
    top = t[rise > 0.999 * rise.max()]
    assert top.min() - 0.05 <= 25.0 <= top.max() + 0.05


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_a_law_is_fitted_to_itself(law: Law) -> None:
    t = np.linspace(15.0, 35.0, 2001)
    p = (25.3, 0.9) if len(law.keys) == 1 else (25.3, 3.0, 0.7)
    found = fit(law, t, law.fraction(t, p[0], p[1:]))
    assert (found.melting_temperature, *found.widths) == pytest.approx(p, rel=1e-3)
    assert found.residual < 1e-4
    assert found.description().keys() == {*law.kind, *law.keys}
