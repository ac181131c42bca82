"""A day of a mutated description: finite records, and an energy balance that closes or is flagged."""

from __future__ import annotations

from functools import cache

import numpy as np
import pandas as pd

from mascarin.building import Building
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate, Measurements

#: Largest relative energy-balance residual without a warning.
CLOSED = 1e-10
STEP = "1h"
HOURS = 25


@cache
def weather() -> tuple[Climate, Measurements]:
    """A day with sun, hourly, and measured columns that the samples name."""
    index = pd.date_range("2001-03-20", periods=HOURS, freq="1h", tz="UTC")
    hour = np.arange(HOURS)
    sun = np.maximum(np.sin((hour - 6.0) * np.pi / 12.0), 0.0)
    frame = pd.DataFrame(
        {
            "air_temperature": 12.0 + 6.0 * np.sin((hour - 9.0) * np.pi / 12.0),
            "dew_point": np.full(HOURS, 4.0),
            "cloud_cover": np.full(HOURS, 3.0),
            "wind_speed": 3.0 - np.cos(hour),
            "wind_direction": (40.0 + 30.0 * hour) % 360.0,
            "global_horizontal": 600.0 * sun,
            "diffuse_horizontal": 200.0 * sun,
            "direct_normal": 500.0 * (sun > 0.1),
            "infrared": np.full(HOURS, 300.0),
        },
        index=index,
    )
    names = [str(name) for name in frame]
    climate = Climate.from_table(frame, timezone="UTC", columns=dict(zip(names, names, strict=True)))
    table = pd.DataFrame(
        {
            "T_out": frame["air_temperature"],
            "T_face": 15.0 + sun,
            "G_north": 80.0 * sun,
            "h_north": 8.0 + sun,
        },
        index=index,
    )
    return climate, Measurements.from_table(table, timezone="UTC")


def day(building: Building) -> None:
    """Run a day from 15 degC everywhere.

    Raises
    ------
    AssertionError
        Records that are not finite, or a balance that does not close and is not flagged.
    MascarinError
        If the building cannot be run, or not be solved.
    """
    climate, measured = weather()
    run = Simulation(building, climate, step=STEP, initial=15.0, measurements=measured).run()
    assert np.isfinite(run.records).all(), "records that are not finite"
    flagged = not run.energy.closes and any("balance" in line for line in run.warnings)
    closure = float(run.energy.closure)
    assert closure <= CLOSED or flagged, (
        f"a relative energy-balance residual of {closure:.3g} without a warning"
    )
