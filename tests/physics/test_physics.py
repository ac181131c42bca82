"""What Python gets from the physics of the engine, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from mascarin import _engine, physics
from mascarin.errors import InputError

T = np.linspace(15.0, 35.0, 401)


def test_melting_curves_are_their_formulas() -> None:
    about = {"melting_temperature": 25.0}
    u = (T - 25.0) / 1.5
    ramp = np.clip(0.5 + 0.5 * u, 0.0, 1.0)
    normal = np.array([0.5 * math.erfc(-x / math.sqrt(2.0)) for x in u])
    below, above = 3.0, 1.0
    rising = np.clip(1.0 + (T - 25.0) / below, 0.0, 1.0) ** 2 * below / (below + above)
    falling = 1.0 - np.clip(1.0 - (T - 25.0) / above, 0.0, 1.0) ** 2 * above / (below + above)
    cases: list[tuple[str, dict[str, float], dict[str, Any], npt.NDArray[np.float64]]] = [
        ("tanh_width", {"width": 1.5}, {}, 0.5 + 0.5 * np.tanh(u)),
        ("smooth_step", {"width": 1.5}, {"continuity": 1}, ramp**2 * (3.0 - 2.0 * ramp)),
        ("smooth_step", {"width": 1.5}, {"continuity": 2}, ramp**3 * (10.0 - 15.0 * ramp + 6.0 * ramp**2)),
        ("gaussian", {"width": 1.5}, {}, normal),
        ("gumbel", {"width": 1.5}, {"tail": "low"}, -np.expm1(-np.exp(u))),
        ("gumbel", {"width": 1.5}, {"tail": "high"}, np.exp(-np.exp(-u))),
        ("linear", {"width": 1.5}, {}, ramp),
        ("triangle", {"below": below, "above": above}, {}, np.where(T <= 25.0, rising, falling)),
    ]
    for kind, widths, shape, expected in cases:
        curve = physics.MeltingCurve(kind, about | widths, shape)
        np.testing.assert_allclose(curve(T), expected, atol=1e-13, err_msg=kind)
        low, high = curve.reach
        assert curve(low) == pytest.approx(0.0, abs=1.0001e-3)
        assert curve(high) == pytest.approx(1.0, abs=1.0001e-3)
    table = {"temperatures": [19.0, 21.0, 22.0], "fractions": [0.0, 0.6, 1.0]}
    measured = physics.MeltingCurve("fractions", {"temperature_shift": 0.5}, table)
    assert measured([19.5, 21.5, 22.5]).tolist() == pytest.approx([0.0, 0.6, 1.0])
    assert measured.reach == (19.5, 22.5)


def test_what_is_no_melting_curve_is_refused() -> None:
    with pytest.raises(_engine.EngineInputError, match="unreadable melting curve"):
        physics.MeltingCurve("tangent", {"melting_temperature": 25.0})(T)
    with pytest.raises(_engine.EngineInputError, match="reads value 7, found 1 values"):
        _engine.liquid_fraction('{"kind": "linear", "melting_temperature": 0, "width": 7}', np.ones(1), T)
    falls = {"temperatures": [21.0, 19.0], "fractions": [0.0, 1.0]}
    with pytest.raises(_engine.EngineInputError, match="rising temperatures"):
        physics.MeltingCurve("fractions", {"temperature_shift": 0.0}, falls)(T)


def test_a_globe_is_between_air_and_surroundings_and_has_its_balance() -> None:
    air, radiant = np.meshgrid(np.linspace(-20.0, 60.0, 41), np.linspace(-40.0, 120.0, 41))
    globe = physics.globe_temperature(air, radiant, 0.04, 0.9)
    assert globe.shape == air.shape
    assert (globe >= np.minimum(air, radiant) - 1e-9).all()
    assert (globe <= np.maximum(air, radiant) + 1e-9).all()
    emitted = 0.9 * 5.670374419e-8 * ((radiant + 273.15) ** 4 - (globe + 273.15) ** 4)
    carried = 1.4 * (np.abs(globe - air) / 0.04) ** 0.25 * (globe - air)
    np.testing.assert_allclose(emitted, carried, rtol=1e-10, atol=1e-9)


def test_air_of_the_standard_atmosphere_and_moist_air() -> None:
    # ICAO Doc 7488: 89 874.6 Pa at 1000 m; 1.225 kg/m3 at 0 m.
    assert physics.standard_density(0.0) == pytest.approx(1.225, abs=5e-4)
    ratio = physics.standard_density(1000.0) / physics.standard_density(0.0)
    assert ratio == pytest.approx(89_874.6 / 101_325.0, rel=1e-4)
    assert physics.moist_air(20.0, 0.0, 101_325.0)[1] == physics.AIR_SPECIFIC_HEAT == 1006.0
    with pytest.raises(InputError, match="expected a pressure of moist air"):
        physics.moist_air(60.0, 1.0, 10_000.0)
    assert (physics.KELVIN, physics.GRAVITY) == (273.15, 9.80665)
