"""Gains, ventilation, paths, openings and ideal plant: balances that a pencil can check."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from mascarin.climate import Climate
from mascarin.model import Building
from mascarin.model.air import SPECIFIC_HEAT, density
from mascarin.model.reading import parse
from mascarin.results import Results
from mascarin.simulation import simulate
from simulation_samples import hours

#: Thickness over conductivity, and both films: what a square metre of wall lets through [W/(m2 K)].
U = 1.0 / (0.1 / 0.04 + 1.0 / 20.0 + 1.0 / 4.0)


def box(zones: dict[str, Any], **more: Any) -> Building:
    """Rooms of 30 m2 of light wall each to outdoor air, held by a measured column; nothing is radiated."""
    walls = {
        f"wall_{name}": {
            "construction": "wall",
            "area": 30,
            "tilt": 90,
            "azimuth": 0,
            "outside": {"measured": "yard", "convection": 20},
            "inside": {"zone": name, "convection": 4},
        }
        for name in zones
    }
    plain = {
        "site": {"latitude": -35, "longitude": 0, "altitude": 55, "timezone": "UTC"},
        "materials": {"foam": {"conductivity": 0.04, "density": 20, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "foam", "thickness": 0.1}]}},
        "zones": {name: {"volume": 50, "longwave": "none"} | zone for name, zone in zones.items()},
        "surfaces": walls | more.pop("surfaces", {}),
        **more,
    }
    return parse(json.dumps(plain), "box.yaml")


def dark(outdoor: NDArray[np.float64], wind: float = 3.0, **columns: NDArray[np.float64]) -> Climate:
    """Hourly outdoor air, the same in the measured column, without a sun."""
    level = np.ones(len(outdoor))
    frame = pd.DataFrame(
        {
            "air_temperature": outdoor,
            "yard": outdoor,
            "dew_point": outdoor - 5,
            "cloud_cover": 0 * level,
            "wind_speed": wind * level,
            "wind_direction": 0 * level,
            "direct_normal": 0 * level,
            "diffuse_horizontal": 0 * level,
            **columns,
        },
        index=pd.date_range("2001-01-01", periods=len(outdoor), freq="1h", tz="UTC"),
    )
    extra = ["yard", *columns]
    channels = [str(name) for name in frame.columns if name not in extra]
    return Climate.from_table(
        frame,
        timezone="UTC",
        columns={name: name for name in channels},
        extra=extra,
        instant=[*channels, *extra],
    )


def run(
    building: Building, outdoor: float = 0.0, days: float = 2, step: str = "15min", **options: Any
) -> Results:
    """A run in outdoor air of one temperature; every output recorded."""
    climate = dark(np.full(len(hours(days)), outdoor))
    outputs = [output.name for output in building.outputs()]
    return simulate(building, climate, step=step, outputs=outputs, **options)


def last(results: Results, name: str) -> float:
    return float(results[name][-1])


def test_the_load_of_a_steady_room_is_its_loss() -> None:
    """UA dT and the heat of the air that comes in, less the gain."""
    building = box(
        {
            "room": {
                "infiltration": 0.5,
                "ventilation": {"fan": {"flow": 0.02}},
                "gains": {"lamp": {"power": 100, "radiative": 0.4}},
                "heating": {"setpoint": 20},
            }
        }
    )
    air = density(building.site) * SPECIFIC_HEAT * (0.5 * 50 / 3600 + 0.02)
    results = run(building)
    assert last(results, "room.air_temperature") == pytest.approx(20.0, abs=1e-8)
    # Some of the radiated heat leaves through the wall that it falls on, whose film resists it.
    through = 100 * 0.4 * (1.0 - U / 4.0)
    expected = (30 * U + air) * 20 - 60 - through
    assert last(results, "room.heating_load") == pytest.approx(expected, rel=1e-6)
    assert results.energy.closure < 1e-10
    assert last(results, "room.air_changes") == pytest.approx(0.5 + 0.02 * 3600 / 50, rel=1e-9)
