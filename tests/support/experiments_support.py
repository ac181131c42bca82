"""Two cells that were never built: the same walls and joints, another shape; a study of their experiments."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from mascarin.building import load
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Measurements
from study_support import ABSENT, open_climate

#: A cell of large walls around little air.
WIDE = """\
name: Wide cell
site: {latitude: 45.0, longitude: 5.0, altitude: 200, timezone: UTC+1}
materials:
  insulation: {conductivity: {value: 0.040, range: [0.02, 0.06]}, density: 30, specific_heat: 1400}
  board: {conductivity: 0.25, density: 900, specific_heat: 1000}
constructions:
  shell: {layers: [{material: insulation, thickness: 0.08}, {material: board, thickness: 0.02}]}
zones:
  room:
    volume: 40
    infiltration: {constant: {value: 0.5, range: [0.1, 1.5]}}
    gains: {heater: {column: heat, radiative: 0}}
surfaces:
  shell:
    construction: shell
    area: 80
    tilt: 90
    azimuth: 180
    outside: {outdoors: true, absorptance: 0.5, emissivity: 0.9, convection: 15}
    inside: {zone: room, emissivity: 0.9, convection: 8}
"""
#: The same walls around much air.
TALL = {
    "extends": "wide.yaml",
    "name": "Tall cell",
    "zones": {"room": {"volume": 160}},
    "surfaces": {"shell": {"area": 40}},
}
CONDUCTIVITY, AIR = "materials.insulation.conductivity", "zones.room.infiltration.constant"
TRUTH = {CONDUCTIVITY: 0.033, AIR: 0.8}
NOISE = 0.05  # K

STUDY = f"""\
name: Two cells
climate:
  measured: {{timezone: UTC+1, columns: {{air_temperature: air}}, absent: [{", ".join(ABSENT)}]}}
measurements: {{timezone: UTC+1}}
sensors:
  room: {{column: room, output: room.air_temperature, offset: 0.1, uncertainty: 0.2}}
step: 30min
periods:
  warm_up: ["2023-03-01 00:00", "2023-03-02 00:00"]
  identification: ["2023-03-02 00:00", "2023-03-06 00:00"]
  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]
identification:
  starts: 1
  lead: 1d
  parameters:
    {CONDUCTIVITY}:
    {AIR}:
"""


def experiment(name: str, role: str = "identification", **keys: Any) -> dict[str, Any]:
    """One experiment: a building and a table of the same name."""
    table = {"table": f"{name}.csv"}
    return {
        "role": role,
        "building": f"{name}.yaml",
        "climate": {"measured": table},
        "measurements": table,
        **keys,
    }


def cells(folder: Path, truth: dict[str, dict[str, float]] | None = None) -> None:
    """Buildings and tables of both cells; the truth may differ between them."""
    (folder / "wide.yaml").write_text(WIDE, encoding="utf-8")
    (folder / "tall.yaml").write_text(yaml.safe_dump(TALL), encoding="utf-8")
    for seed, name in enumerate(("wide", "tall"), start=1):
        own = TRUTH if truth is None else truth[name]
        recorded(folder / f"{name}.yaml", own, seed).to_csv(folder / f"{name}.csv")


def recorded(building: Path, truth: dict[str, float], seed: int) -> pd.DataFrame:
    """What a logger in a cell would have written; local stamps."""
    index = pd.date_range("2023-03-01", periods=9 * 48, freq="30min", name="time")
    hours = np.arange(len(index)) / 2.0
    air = 6.0 + 2.0 * np.sin(hours / 31.0 + seed) + 4.0 * np.sin((hours - 9.0) * np.pi / 12.0)
    # Slow steps of the heating: a fast one would tell the walls by their heat capacity.
    heat = 900.0 + 250.0 * np.sin(hours / 40.0 + 2.0 * seed)
    table = pd.DataFrame({"air": air, "heat": heat}, index=index)
    run = Simulation(
        load(building).replace(truth),
        open_climate(table),
        step="30min",
        end=index[-1],
        outputs=["room.air_temperature"],
        measurements=Measurements.from_table(table, timezone="UTC+1"),
        ranges={CONDUCTIVITY: (0.02, 0.06)},
    ).run()
    noise = np.random.default_rng(seed).normal(0.0, NOISE, len(table))
    return table.assign(room=run.records[:, 0] + noise).round(4)


def written(folder: Path, experiments: dict[str, Any], **changes: Any) -> Path:
    """A study of experiments; a change without a value removes the key."""
    plain = yaml.safe_load(STUDY) | {"experiments": experiments} | changes
    plain = {key: value for key, value in plain.items() if value is not None}
    (folder / "study.yaml").write_text(yaml.safe_dump(plain, sort_keys=False), encoding="utf-8")
    return folder / "study.yaml"
