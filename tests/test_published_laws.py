"""Published laws of convection that are written as text: coefficients by hand, and their numbers."""

from __future__ import annotations

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import FormulaLaw
from mascarin.building.parts.envelope.published_laws import published_laws
from mascarin.errors import InputError
from mascarin.examples import box, clear_days

FACADE = "surfaces.facade.inside.convection"

#: Law, numbers, tilt [deg], difference [K], coefficient by hand [W/(m2 K)].
BY_HAND = [
    # 20.7 air changes an hour: 20.7^0.604 = 6.2351, 20.7^0.98 = 19.4828, 20.7^0.503 = 4.5913.
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 90, 5.0, 1.208 + 1.012 * 6.2351),
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 0, 5.0, 3.873 + 0.082 * 19.4828),
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 180, -2.0, 2.234 + 4.099 * 4.5913),
    # 10 K, 9 m2 of 12 m: hydraulic diameter 3 m.
    ("awbi_hatton", {"perimeter": 12.0}, 90, 10.0, 1.823 * 10**0.293 / 3**0.121),
    ("awbi_hatton", {"perimeter": 12.0}, 0, 10.0, 2.175 * 10**0.308 / 3**0.076),
    ("awbi_hatton", {"factor": 2.0, "perimeter": 12.0}, 180, 10.0, 2.0 * 0.704 * 10**0.133 / 3**0.601),
]


@pytest.mark.parametrize(("key", "numbers", "tilt", "difference", "expected"), BY_HAND)
def test_coefficients_by_hand(
    key: str, numbers: dict[str, float], tilt: float, difference: float, expected: float
) -> None:
    law = box().replace({FACADE: {"kind": key, **numbers}}).surfaces["facade"].inside.convection
    assert isinstance(law, FormulaLaw)
    found = law.coefficient([difference], tilt=tilt, area=9.0, air_change=0.0)
    assert found[0] == pytest.approx(expected, rel=2e-5)
    assert law.source == published_laws()[key].source


def test_every_law_has_a_case() -> None:
    assert {key for key, *_ in BY_HAND} == published_laws().keys()


def test_a_word_is_enough_and_its_numbers_are_parameters() -> None:
    building = box().replace({FACADE: "fisher_ceiling_diffuser"})
    path = f"{FACADE}.mixing"
    climate = clear_days(
        float(building.site.latitude),
        float(building.site.longitude),
        timezone="UTC-7",
        start="2024-02-01",
        days=2,
        mean=5,
        altitude=1829,
    )
    output = "facade.inside_convection"
    runs = [
        mc.simulate(building, climate, outputs=[output], parameters={path: mixing}, initial=20.0)
        for mixing in (5.0, 20.0)
    ]
    calm, blown = (float(run[output].values[-1]) for run in runs)
    change = float(building.zones["room"].infiltration.constant)
    # The air of the zone changes by infiltration, too.
    for found, mixing in ((calm, 5.0), (blown, 20.0)):
        assert found == pytest.approx(1.208 + 1.012 * (change + mixing) ** 0.604, rel=1e-9)
    assert np.all(np.isfinite(runs[0][output].values))


def test_what_a_law_does_not_have_is_refused() -> None:
    with pytest.raises(InputError, match=r"mixng: 20\.7\n.*one of factor, mixing"):
        box().replace({FACADE: {"kind": "fisher_ceiling_diffuser", "mixng": 20.7}})
    with pytest.raises(InputError, match="mixing"):
        box().replace({FACADE: {"kind": "fisher_ceiling_diffuser", "mixing": -1.0}})
    with pytest.raises(
        InputError, match=r"kind: .*awbi_haton.*\n.*tarp, measured, text, fisher.*awbi_hatton"
    ):
        box().replace({FACADE: "awbi_haton"})
