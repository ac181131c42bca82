"""Cases for bench/engine, the engine without Python: the input that a run gives to the engine.

They are the models of engine_speed.py and, if its weather file is given, case 900 of Standard 140. The
first day is not repeated until it converges, so that the number of stages is known.

    python bench/engine_cases.py FOLDER [--days 10] [--bestest 725650TYCST.epw]
"""

from __future__ import annotations

import argparse
import json
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from engine_speed import MODELS, climate, samples, simulation

from mascarin.building import load
from mascarin.simulation.simulation import Simulation
from mascarin.verification.bestest.catalogue import CASES
from mascarin.verification.bestest.running import outputs
from mascarin.verification.bestest.weather import read
from mascarin.weather import Climate

#: Members of a pack: the lanes of the engine.
WIDTH = 8
STEP = 900.0
#: Days from here on have hours of heating and hours of cooling in case 900.
SPRING = datetime(2001, 3, 10)
#: Leaves that the members of case 900 differ in, by a tenth at most.
VARIED = ("conductivity", "specific_heat", "thickness", "factor")


def write(folder: Path, days: int) -> list[Path]:
    """Write a JSON file for every model, and its weather beside it as plain numbers; the JSON files."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, model in MODELS.items():
        of = simulation(model, days)
        files.append(_written(folder / f"{name}.json", of, climate(), samples(of, WIDTH)))
    return files


def standard_140(folder: Path, days: int, weather: Path) -> Path:
    """Write case 900 of Standard 140, which has windows and ideal loads, in the same way; the JSON file."""
    case, found = CASES["900"], read(weather)
    of = Simulation(
        load(case.file),
        found,
        step=STEP,
        start=SPRING,
        end=SPRING + timedelta(days=days),
        outputs=sorted(outputs(case)),
    )
    rows = np.tile(of.values, (WIDTH, 1))
    rng = np.random.default_rng(1)
    for position, path in enumerate(of.paths):
        if path.rsplit(".", 1)[-1] in VARIED:
            rows[:, position] *= rng.uniform(0.9, 1.1, WIDTH)
    folder.mkdir(parents=True, exist_ok=True)
    return _written(folder / "standard-140-900.json", of, found, rows, initial=22.0)


def _written(
    file: Path, of: Simulation, source: Climate, members: np.ndarray, initial: float | None = None
) -> Path:
    """Write a case; its initial temperature is by default the mean of the outdoor air."""
    described = of.building.to_engine(STEP, {})
    weather = source.forcing(of.building.site, of.start, of.end, STEP, "sdirk2", list(described.channels))
    case = {
        "description": json.loads(described.json),
        "values": of.values.tolist(),
        "members": members.ravel().tolist(),
        "outputs": [{"kind": output.kind, **output.place} for output in of.outputs],
        "dt": STEP,
        "initial": float(weather[:, -1, 0].mean()) if initial is None else initial,
    }
    file.write_text(json.dumps(case), encoding="utf-8")
    np.ascontiguousarray(weather, dtype="<f8").tofile(file.with_suffix(".f64"))
    return file


def main() -> None:
    """Write the cases."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("folder", type=Path)
    options.add_argument("--days", type=int, default=10)
    options.add_argument("--bestest", type=Path, help="weather of Standard 140; none: without case 900")
    given = options.parse_args()
    files = write(given.folder, given.days)
    if given.bestest is not None:
        files.append(standard_140(given.folder, given.days, given.bestest))
    for file in files:
        print(file)


if __name__ == "__main__":
    main()
