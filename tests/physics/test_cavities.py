"""Air that flows through a cavity: zones in series, and the stack between two slots, by closed forms."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.examples import clear_days

OUTDOORS, SIDE = 20.0, 50.0
#: Coefficient of the side, area of all of it, flow.
FILM, AREA, FLOW = 6.0, 12.0, 0.05
DENSITY, HEAT = 1.2, 1006.0
RESISTANCE = 0.001 / 50.0


def still() -> mc.Climate:
    return clear_days(
        10.0, 0.0, timezone="UTC", start="2024-01-10", days=2, mean=OUTDOORS, swing=0, wind=0, altitude=0
    )


def cavity(count: int, convection: Any = FILM) -> Building:
    """`count` zones in series along a sheet of a constant temperature."""
    names = [f"part_{number}" for number in range(count)]
    side = {"construction": "sheet", "area": AREA / count, "tilt": 90, "azimuth": 180}
    return Building.from_dict(
        {
            "name": "cavity",
            "site": {
                "latitude": 10, "longitude": 0, "altitude": 0, "timezone": "UTC",
                "air_density": DENSITY, "air_specific_heat": HEAT,
            },
            "materials": {"steel": {"conductivity": 50, "density": 7800, "specific_heat": 450}},
            "constructions": {"sheet": {"layers": [{"material": "steel", "thickness": 0.001}]}},
            "zones": {key: {"volume": 1.2 / count, "infiltration": 0, "longwave": "none"} for key in names},
            "air_paths": {
                f"to_{after}": {"between": [before, after], "flow": FLOW, "one_way": True}
                for before, after in itertools.pairwise(names)
            },
            "ventilation_units": {"fan": {"supply": {names[0]: FLOW}, "exhaust": {names[-1]: FLOW}}},
            "surfaces": {
                f"side_of_{name}": side
                | {
                    "outside": {"ground": {"temperature": SIDE}},
                    "inside": {"zone": name, "convection": convection},
                }
                for name in names
            },
        }
    )  # fmt: skip


def warmed(count: int) -> float:
    """Temperature of the air that leaves the cavity, over the outdoor air. [K]"""
    state = mc.steady(cavity(count), still(), outputs=[f"part_{count - 1}.air_temperature"])
    return state.values[f"part_{count - 1}.air_temperature"] - OUTDOORS


@pytest.mark.parametrize("count", [1, 2, 4])
def test_zones_in_series_take_up_heat_as_stirred_tanks(count: int) -> None:
    units = AREA / (1 / FILM + RESISTANCE) / (FLOW * DENSITY * HEAT)
    assert warmed(count) == pytest.approx((SIDE - OUTDOORS) * (1 - (1 + units / count) ** -count), rel=1e-8)


def test_many_zones_come_to_air_that_never_mixes() -> None:
    units = AREA / (1 / FILM + RESISTANCE) / (FLOW * DENSITY * HEAT)
    exact = (SIDE - OUTDOORS) * (1 - np.exp(-units))
    errors = [exact - warmed(count) for count in (4, 8, 16)]
    assert errors[2] < 0.03 * exact
    np.testing.assert_allclose(errors[:-1], 2 * np.array(errors[1:]), rtol=0.1)


def test_flow_of_the_cavity_drives_its_film() -> None:
    law = {"kind": "ventilated_cavity", "depth": 0.1, "path": 3.0}
    state = mc.steady(
        cavity(1, law), still(), outputs=["part_0.air_temperature", "side_of_part_0.inside_convection"]
    )
    speed = FLOW * 3600 / 1.2 * 3.0 / 3600
    difference = SIDE - state.values["part_0.air_temperature"]
    closed = max(1.25, 0.73 * (2 * difference) ** (1 / 3))
    assert state.values["side_of_part_0.inside_convection"] == pytest.approx(2 * closed + 4 * speed, rel=1e-3)


def test_stack_between_two_slots_is_that_of_the_densities() -> None:
    slot = {"zone": "part_0", "azimuth": 180, "area": 0.018, "pressure": "none"}
    built = cavity(1).replace(
        {
            "ventilation_units": {},
            "vents": {"eaves": slot | {"elevation": 2.8}, "ridge": slot | {"elevation": 3.8}},
        }
    )
    state = mc.steady(built, still(), outputs=["part_0.air_temperature", "eaves.inflow"])
    outdoors, inside = (
        DENSITY * 288.15 / (273.15 + value) for value in (OUTDOORS, state.values["part_0.air_temperature"])
    )
    mass = 0.65 * 0.018 * np.sqrt(2 * (outdoors - inside) * 9.80665 / (1 / outdoors + 1 / inside))
    assert state.values["eaves.inflow"] * DENSITY == pytest.approx(mass, rel=1e-6)
