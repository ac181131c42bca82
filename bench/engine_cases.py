"""Cases for bench/engine, the engine without Python: what a run of a model of engine_speed.py hands over.

Only the first day is not repeated until it settles, so that the number of stages is known.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from engine_speed import MODELS, climate, samples, simulation

#: Members of a pack: the lanes of the engine.
WIDTH = 8
STEP = 900.0


def write(folder: Path, days: int) -> list[Path]:
    """Write a JSON file for every model, and its weather beside it as plain numbers; the JSON files."""
    folder.mkdir(parents=True, exist_ok=True)
    return [_written(folder / f"{name}.json", name, days) for name in MODELS]


def _written(file: Path, name: str, days: int) -> Path:
    of = simulation(MODELS[name], days)
    described = of.building.to_engine(STEP, {})
    weather = climate().forcing(of.building.site, of.start, of.end, STEP, "sdirk2", list(described.channels))
    case = {
        "description": json.loads(described.json),
        "values": of.values.tolist(),
        "members": samples(of, WIDTH).ravel().tolist(),
        "probes": [{"kind": output.kind, **output.place} for output in of.outputs],
        "dt": STEP,
        "initial": float(weather[:, -1, 0].mean()),
    }
    file.write_text(json.dumps(case), encoding="utf-8")
    np.ascontiguousarray(weather, dtype="<f8").tofile(file.with_suffix(".f64"))
    return file
