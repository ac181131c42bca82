"""Laws of what a side is in contact with that give heat or a coefficient, beside closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.errors import InputError

AREA, FILM, WALL, OUTDOORS = 20.0, 5.0, 60.0, 5.0
#: Thickness over conductivity of the panel, and of the walls. [m2 K/W]
PANEL, INSULATION = 0.05 / 0.5, 0.1 / 0.05


def climate(air: float = OUTDOORS, days: int = 20) -> mc.Climate:
    """A constant air, without sun."""
    hours = 24 * days
    table = pd.DataFrame(
        {"air_temperature": air, "wind_speed": 0.0, "wind_direction": 0.0},
        index=pd.date_range("2001-01-08", periods=hours, freq="1h", tz="UTC"),
    )
    names = list(table.columns)
    return mc.Climate.from_table(
        table, timezone="UTC", columns={name: name for name in names}, instant=names,
        absent=["radiation", "cloud_cover", "dew_point"],
    )  # fmt: skip


def room(mat: dict[str, Any], **outside: Any) -> mc.Building:
    """A room between a panel with a mat behind it and walls to outdoors, without radiation."""
    shell = {"outdoors": True, "convection": 20, "longwave": "none", "exposure": {"sun": False}}
    inside = {"zone": "room", "convection": FILM, "emissivity": 0.9}
    return mc.Building.from_dict(
        {
            "name": "mat",
            "site": {"latitude": 48, "longitude": 2, "altitude": 0, "timezone": "UTC"},
            "materials": {
                "screed": {"conductivity": 0.5, "density": 1000, "specific_heat": 1000},
                "foam": {"conductivity": 0.05, "density": 30, "specific_heat": 1000},
            },
            "constructions": {
                "panel": {"layers": [{"material": "screed", "thickness": 0.05}]},
                "wall": {"layers": [{"material": "foam", "thickness": 0.1}]},
            },
            "zones": {"room": {"volume": 50, "longwave": "none"}},
            "surfaces": {
                "floor": {"construction": "panel", "area": AREA, "tilt": 180,
                          "outside": {"imposed": mat, **outside}, "inside": inside},
                "walls": {"construction": "wall", "area": WALL, "tilt": 90, "azimuth": 0,
                          "outside": shell, "inside": inside},
            },
        }
    )  # fmt: skip


def run(building: mc.Building, air: float = OUTDOORS) -> Any:
    outputs = ["room.air_temperature", "floor.outside_temperature"]
    return mc.simulate(building, climate(air), step=900, outputs=outputs, initial=20.0)


LOSS = WALL / (1 / 20 + INSULATION + 1 / FILM)
WATER = {"kind": "water_mat", "indoor": 21.0, "steepness": 0.5, "limit": 15.0, "coefficient": 8.0}
HEAT = {"kind": "heating_mat", "power": 30.0, "limit": 15.0, "span": 25.0}


def test_water_of_a_heating_curve_warms_a_room() -> None:
    """``K (T_w - T) = L (T - T_o)``, water of 21 + 0.5 (15 - 5) degC."""
    water = 21.0 + 0.5 * (15.0 - OUTDOORS)
    supply = AREA / (1 / 8.0 + PANEL + 1 / FILM)
    expected = (supply * water + LOSS * OUTDOORS) / (supply + LOSS)
    results = run(room(WATER))
    assert results.records[-1, 0] == pytest.approx(expected, abs=1e-4)
    back = water - supply / AREA * (water - expected) / 8.0
    assert results.records[-1, 1] == pytest.approx(back, abs=1e-4)
    assert results.energy.closes


def test_an_electric_mat_gives_its_heat_to_the_room() -> None:
    """``q A = L (T - T_o)``, with 30 (15 - 5)/25 W/m2."""
    results = run(room(HEAT))
    expected = OUTDOORS + 30.0 * 10.0 / 25.0 * AREA / LOSS
    assert results.records[-1, 0] == pytest.approx(expected, abs=1e-3)
    assert results.energy.closes
    assert results.energy.into["boundary"] > 0.0


@pytest.mark.parametrize("mat", [WATER, HEAT], ids=["water", "electric"])
def test_a_mat_is_off_above_its_limit(mat: dict[str, Any]) -> None:
    """No heat flows to or from a mat that is turned off: the room takes the temperature of outdoors."""
    assert run(room(mat), air=16.0).records[-1, 0] == pytest.approx(16.0, abs=0.02)


@pytest.mark.parametrize("mat", [WATER, HEAT], ids=["water", "electric"])
def test_slopes_by_the_numbers_of_a_mat_are_exact(mat: dict[str, Any]) -> None:
    simulation = mc.Simulation(
        room(mat), climate(days=3), step=900, outputs=["room.air_temperature"], initial=20.0
    )
    for name in (name for name in mat if name != "kind"):
        path = f"surfaces.floor.outside.imposed.{name}"
        slope = float(simulation.jacobian([path])["d room.air_temperature"][0, -1])
        step = 1e-4 * float(mat[name])
        ends = [simulation.run({path: float(mat[name]) + by}).records[-1, 0] for by in (-step, step)]
        assert slope == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-5, abs=1e-9), name


def test_members_of_an_ensemble_have_the_bits_of_runs_alone() -> None:
    simulation = mc.Simulation(
        room(WATER), climate(days=2), step=900, outputs=["room.air_temperature"], initial=20.0
    )
    path = "surfaces.floor.outside.imposed.coefficient"
    vectors = np.array([simulation.vector({path: 4.0 + 0.5 * k}) for k in range(9)])
    records, _, failures = simulation.ensemble(vectors)
    assert not failures
    for vector, record in zip(vectors, records, strict=True):
        assert np.array_equal(simulation.compiled.run(vector)[0], record)


def test_a_coefficient_is_given_once() -> None:
    with pytest.raises(InputError, match="this law gives the coefficient itself"):
        room(WATER, convection=8.0)
