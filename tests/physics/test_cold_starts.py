"""Cold starts under radiant ideal heating: windows stay above absolute zero, and every start converges."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mascarin.building import Building
from mascarin.simulation.run import simulate
from mascarin.weather import Climate

INSIDE = {"zone": "room", "convection": "tarp", "emissivity": 0.9, "absorptance": 0.5}
OUTSIDE = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}


def room(area: float, film: Any, heating: dict[str, Any], cooling: dict[str, Any] | None = None) -> Building:
    """A room with a double-glazed window and ideal loads that are radiated."""

    def surface(tilt: int, azimuth: int | None, size: float, outside: dict[str, Any]) -> dict[str, Any]:
        place = {"tilt": tilt} | ({} if azimuth is None else {"azimuth": azimuth})
        return {"construction": "wall", "area": size, **place, "outside": outside, "inside": INSIDE}

    pane = {"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}
    return Building.from_dict(
        {
            "name": "cold room",
            "site": {"latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"},
            "materials": {
                "concrete": {"conductivity": 1.75, "density": 2240, "specific_heat": 900},
                "wool": {"conductivity": 0.04, "density": 30, "specific_heat": 1000},
            },
            "constructions": {
                "wall": {
                    "layers": [
                        {"material": "wool", "thickness": 0.1},
                        {"material": "concrete", "thickness": 0.1},
                    ]
                }
            },
            "glazings": {
                "double": {
                    "kind": "panes", "panes": [pane, pane], "gaps": [{"thickness": 0.016, "gas": "air"}],
                }
            },
            "zones": {
                "room": {"volume": 50, "infiltration": 0.5, "heating": heating}
                | ({"cooling": cooling} if cooling else {})
            },
            "windows": {
                "window": {
                    "surface": "south", "glazing": "double", "area": area,
                    "outside": {"convection": 15}, "inside": {"convection": film},
                }
            },
            "surfaces": {
                "south": surface(90, 180, 12, OUTSIDE),
                "north": surface(90, 0, 12, OUTSIDE),
                "roof": surface(0, None, 20, OUTSIDE),
                "floor": surface(180, None, 20, {"adiabatic": True}),
            },
        }
    )  # fmt: skip


@pytest.fixture(scope="module")
def climate() -> Climate:
    return Climate.shipped("golden")


@pytest.mark.parametrize(
    ("start", "step", "initial", "area", "scheme"),
    [
        ("2001-01-08", "5min", 0.0, 6.0, "sdirk2"),  # -1041 degC with sigma T^4 below 0 K
        ("2001-12-10", "5min", -10.0, 6.0, "sdirk2"),  # did not converge
        ("2001-12-10", "1min", 0.0, 2.0, "sdirk2"),  # -1225 degC
        ("2001-01-08", "1min", -10.0, 6.0, "linearly-implicit"),
        ("2001-01-08", "1min", -10.0, 6.0, "backward-euler"),
        ("2001-12-10", "15min", -40.0, 6.0, "apparent-capacity"),
        ("2001-12-10", "3h", -40.0, 0.5, "sdirk2"),
    ],
)
def test_windows_stay_above_absolute_zero(
    climate: Climate, start: str, step: str, initial: float, area: float, scheme: str
) -> None:
    run = simulate(
        room(area, "tarp", {"setpoint": 20, "radiative": 0.95}),
        climate,
        start=start,
        end=str(np.datetime64(start) + 1),
        step=step,
        initial=initial,
        scheme=scheme,  # type: ignore[arg-type]
        outputs=["window.inside_temperature", "window.outside_temperature", "room.air_temperature"],
    )
    # The outdoor air is above -30 degC, and the sky some 30 K colder.
    assert run.records.min() > -60.0
    assert run.energy.closes


def test_heating_and_cooling_that_are_radiated(climate: Climate) -> None:
    building = room(
        3.0, 3, {"setpoint": 20, "radiative": 0.9}, {"setpoint": 20.5, "radiative": 0.9, "capacity": 20000}
    )
    run = simulate(
        building, climate, start="2001-04-10", end="2001-04-12", step="5min", initial=-10.0,
        outputs=["window.inside_temperature", "room.air_temperature"],
    )  # fmt: skip
    assert run.records.min() > -60.0
    assert run.energy.closes
