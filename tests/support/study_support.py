"""A wall that was never built: a logger's table made by our own model with noise, and a study of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from mascarin.building import load
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate, Measurements

BUILDING = """\
name: Test wall
site:
  latitude: 45.0
  longitude: 5.0
  altitude: 200
  timezone: UTC+1
  sky: {kind: offset, depression: {value: 11, range: [5, 15]}}
materials:
  insulation: {conductivity: {value: 0.040, range: [0.02, 0.06]}, density: 30, specific_heat: 1400}
  brick: {conductivity: {value: 0.60, range: [0.3, 1.2]}, density: 1700, specific_heat: 850}
constructions:
  wall:
    layers:
      - {material: insulation, thickness: 0.06}
      - {material: brick, thickness: 0.12}
surfaces:
  wall:
    construction: wall
    area: 4.0
    tilt: 90
    azimuth: 180
    outside:
      outdoors: true
      irradiance: sun
      absorptance: {value: 0.5, range: [0.2, 0.8]}
      emissivity: 0.9
      convection: {value: 15, range: [5, 40]}
    inside:
      measured: room
      convection: {value: 8, range: [4, 12]}
sensors:
  core: {surface: wall, depth: {value: 0.03, range: [0.01, 0.05]}}
"""

STUDY = """\
name: Test wall
building: building.yaml
climate:
  measured:
    table: logger.csv
    timezone: UTC+1
    columns: {air_temperature: air}
    absent: [wind_speed, wind_direction, dew_point, global_horizontal, diffuse_horizontal, direct_normal]
measurements:
  table: logger.csv
  timezone: UTC+1
sensors:
  joint: {column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}
  core: {column: core, output: core.temperature, offset: 0, uncertainty: 0.3}
step: 30min
periods:
  warm_up: ["2023-03-01 00:00", "2023-03-02 00:00"]
  identification: ["2023-03-02 00:00", "2023-03-06 00:00"]
  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]
quality: {mask: [stuck]}
criteria:
  - {metric: rmse, limit: 0.25}
sensitivity: {replicates: 3, interval: 1h}
identification:
  starts: 2
  lead: 1d
  parameters:
    materials.insulation.conductivity:
    materials.brick.conductivity:
    surfaces.wall.outside.absorptance:
    surfaces.wall.inside.convection.coefficient:
"""

#: What the wall "really" is.
TRUTH = {
    "materials.insulation.conductivity": 0.033,
    "materials.brick.conductivity": 0.75,
    "surfaces.wall.outside.absorptance": 0.62,
    "surfaces.wall.inside.convection.coefficient": 6.5,
}
#: Ranges so wide that the mesh of the wall that makes the table is several times finer than that of a study.
FINE = {"materials.insulation.conductivity": (0.001, 0.06), "materials.brick.conductivity": (0.01, 1.2)}
NOISE = 0.03  # K
ABSENT = (
    "wind_speed", "wind_direction", "dew_point", "global_horizontal", "diffuse_horizontal", "direct_normal",
)  # fmt: skip


def drivers(days: int = 9) -> pd.DataFrame:
    """Outdoor air, sun on the facade and room air of days that all differ."""
    index = pd.date_range("2023-03-01", periods=days * 144, freq="10min")
    hours = np.arange(len(index)) / 6.0
    day = np.floor(hours / 24.0)
    clear = 0.55 + 0.45 * np.sin(1.7 * day)
    sun = np.maximum(np.sin((hours % 24.0 - 6.0) * np.pi / 12.0), 0.0) * 700.0 * clear
    air = (
        8.0
        + 2.5 * np.sin(hours / 31.0)
        + 5.0 * np.sin((hours - 9.0) * np.pi / 12.0)
        + 0.02 * np.sin(hours * 40.0)
    )
    room = 20.0 + 1.5 * np.sin((hours - 7.0) * np.pi / 12.0) + np.sin(hours / 17.0)
    return pd.DataFrame({"air": air, "sun": sun, "room": room}, index=index.rename("time"))


def open_climate(table: pd.DataFrame) -> Climate:
    """The weather of the drivers."""
    return Climate.from_table(
        table,
        timezone="UTC+1",
        columns={"air_temperature": "air"},
        absent=ABSENT,
        latitude=45.0,
        longitude=5.0,
        altitude=200.0,
    )


def logger_table(building: Path, *, noise: float = NOISE) -> pd.DataFrame:
    """What a logger in the wall would have written; local stamps."""
    table = drivers()
    measured = Measurements.from_table(table, timezone="UTC+1")
    climate = open_climate(table)
    run = Simulation(
        load(building).replace(TRUTH),
        climate,
        step="10min",
        end=table.index[-1],
        outputs=["wall.interface_1_temperature", "core.temperature"],
        measurements=measured,
        ranges=FINE,
    ).run()
    random = np.random.default_rng(7)
    for k, name in enumerate(("joint", "core")):
        table[name] = run.records[:, k] + random.normal(0.0, noise, len(table))
    return table.round(4)


@dataclass(frozen=True)
class Bench:
    """A folder with a building, a table and a study."""

    folder: Path

    @property
    def study(self) -> Path:
        """The study file."""
        return self.folder / "study.yaml"

    @property
    def building(self) -> Path:
        """The building file."""
        return self.folder / "building.yaml"

    @property
    def table(self) -> Path:
        """The logger's table."""
        return self.folder / "logger.csv"

    def edit(self, before: str, after: str, file: str = "study.yaml") -> int:
        """Replace the only occurrence of a text; the line (from 1) where it stood."""
        path = self.folder / file
        text = path.read_text(encoding="utf-8")
        assert text.count(before) == 1, f"{before!r} stands {text.count(before)} times in {file}"
        path.write_text(text.replace(before, after), encoding="utf-8")
        return text[: text.index(before)].count("\n") + 1
