"""Buildings and weather for the tests of simulation, results and state space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from mascarin.building import Building, load
from mascarin.weather import Climate

LINEAR = """\
name: linear
site: {latitude: -35, longitude: 0, altitude: 55, timezone: UTC, diffuse: hay_davies}
materials:
  board: {conductivity: 0.16, density: 800, specific_heat: 1090}
  foam: {conductivity: 0.03, density: 30, specific_heat: 1470}
  gap: {kind: resistance, resistance: 0.15}
constructions:
  wall: {layers: [{material: board, thickness: 0.012}, {material: foam, thickness: 0.05}, {material: gap},
                  {material: board, name: lining, thickness: 0.012}]}
  partition: {layers: [{material: board, thickness: 0.02}]}
zones:
  sunny: {volume: 30, infiltration: 0.4, longwave: {kind: linearised, reference: 20}}
  shady: {volume: 20, capacity_factor: 3, infiltration: 1, longwave: {kind: linearised, reference: 18}}
surfaces:
  north: {construction: wall, area: 9, tilt: 90, azimuth: 0,
          outside: {outdoors: true, convection: 18, emissivity: 0.9, absorptance: 0.6,
                    longwave: {kind: linearised, reference: 15}},
          inside: {zone: sunny, convection: 3, emissivity: 0.9}}
  roof: {construction: wall, area: 12, tilt: 10, azimuth: 0,
         outside: {outdoors: true, convection: 18, emissivity: 0.8, absorptance: 0.5, irradiance: pyranometer,
                   longwave: none},
         inside: {zone: sunny, convection: 2, emissivity: 0.9}}
  between: {construction: partition, area: 10, tilt: 90, azimuth: 0,
            outside: {zone: sunny, convection: 2.5, emissivity: 0.9},
            inside: {zone: shady, convection: 2.5, emissivity: 0.9}}
  south: {construction: wall, area: 8, tilt: 90, azimuth: 180,
          outside: {measured: yard, convection: 10}, inside: {zone: shady, convection: 3, emissivity: 0.85}}
  floor: {construction: partition, area: 10, tilt: 180, outside: {ground: {temperature: 14}},
          inside: {zone: shady, convection: 1.5, emissivity: 0.9}}
sensors: {deep: {surface: north, depth: 0.03}}
"""


def read(text: str, folder: Path) -> Building:
    file = folder / "building.yaml"
    file.write_text(text, encoding="utf-8")
    return load(file)


def hours(days: float) -> NDArray[np.float64]:
    return 3600.0 * np.arange(round(24 * days) + 1, dtype=np.float64)


def weather(days: float = 3, **columns: float | NDArray[np.float64]) -> Climate:
    """Summer days at 35 S, hourly instants; other measured columns as they are given."""
    t = hours(days)
    day = 2.0 * np.pi * t / 86400.0
    light = np.maximum(-np.cos(day), 0.0)
    channels = {
        "air_temperature": 18.0 - 6.0 * np.cos(day - 0.6),
        "dew_point": 10.0 + np.sin(day / 3.0),
        "cloud_cover": 3.0 + 2.0 * np.sin(day / 2.0),
        "wind_speed": 3.0 - np.cos(day),
        "wind_direction": 40.0 + 30.0 * np.sin(day / 2.0),
        "direct_normal": 650.0 * light,
        "diffuse_horizontal": 160.0 * light,
    }
    index = pd.date_range("2001-01-01", periods=len(t), freq="1h", tz="UTC")
    frame = pd.DataFrame({**channels, **columns}, index=index)
    return Climate.from_table(
        frame,
        timezone="UTC",
        columns={name: name for name in channels},
        extra=list(columns),
        instant=list(channels),
    )


def measured(days: float = 3) -> dict[str, NDArray[np.float64]]:
    """What the linear building's measured boundaries need."""
    day = 2.0 * np.pi * hours(days) / 86400.0
    return {"pyranometer": np.maximum(-600.0 * np.cos(day), 0.0), "yard": 16.0 + 3.0 * np.sin(day)}
