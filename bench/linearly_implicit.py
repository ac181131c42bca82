"""The linearly implicit scheme beside SDIRK2: time, iterations, and how far the results are apart.

    python bench/linearly_implicit.py [--write docs/speed.md]

Buildings with phase-change materials, with ideal loads, and with rooms side by side, at steps of 15 min. The
weather of case 900 and of the rooms is read from `MASCARIN_DATA`. Times are processor time of one thread,
both schemes in turn, the shortest of some repetitions.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

import numpy as np
import page
import yaml
from engine_speed import MODELS, START, building, climate
from many_zones import WEATHER, Grid, description

import mascarin as mc
from mascarin.building import Building
from mascarin.examples import FOLDER
from mascarin.simulation.preparation.options import Scheme
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.verification.bestest.catalogue import CASES
from mascarin.verification.bestest.weather import read
from mascarin.weather import Climate

CASE_900 = WEATHER.parents[1] / "bestest" / "725650TYCST.epw"
STEP = 900.0
#: Days at the start of a run that are not compared.
SETTLING = 2
REPEATS = 3
AIRS, SURFACES, LOADS = ("air_temperature",), ("face_temperature",), ("heating_load", "cooling_load")


@dataclass(frozen=True)
class Case:
    """A building, its weather, and the days of the run."""

    name: str
    building: Building
    climate: Climate
    days: int
    start: object = None


def cases() -> Iterator[Case]:
    """All buildings."""
    for name in ("constant", "table4", "alamdari", "shipped"):
        model = MODELS[name]
        yield Case(f"LGI cell, {model.name}", building(model), climate(), 92, START)
    golden = Climate.from_epw(WEATHER)
    house = mc.load(FOLDER / "reunion_house" / "building.yaml")
    there = {"site.latitude": 27.97, "site.longitude": -82.53, "site.timezone": "UTC-5", "site.altitude": 3}
    yield Case("reunion-house in Tampa", house.replace(there), Climate.from_epw("shipped:tampa"), 90)
    yield Case("case 900", mc.load(CASES["900"].file), read(CASE_900), 365)
    yield Case("case 900FF", mc.load(CASES["900FF"].file), read(CASE_900), 365)
    for loads in (False, True):
        rooms = _rooms(Grid((8, 1, 1)), loads)
        yield Case(f"row of 8 rooms, {'ideal loads' if loads else 'free'}", rooms, golden, 90)


def _rooms(grid: Grid, loads: bool) -> Building:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "building.yaml"
        file.write_text(yaml.safe_dump(description(grid, loads)), encoding="utf-8")
        return mc.load(file)


def simulation(case: Case, scheme: Scheme, step: float = STEP) -> Simulation:
    """A case with a scheme and a step [s]; it records airs, surfaces and loads."""
    start = case.climate.index[0] if case.start is None else case.start
    outputs = [output.name for output in case.building.outputs() if output.kind in (*AIRS, *SURFACES, *LOADS)]
    end = start + timedelta(days=case.days)
    return Simulation(
        case.building, case.climate, step=step, scheme=scheme, start=start, end=end, outputs=outputs
    )


def line(case: Case) -> list[str]:
    """The line of a case in the table."""
    runs = [simulation(case, scheme) for scheme in ("sdirk2", "linearly-implicit")]
    times: list[list[float]] = [[], []]
    results: list[Results] = []
    for _ in range(REPEATS):
        results = []
        for run, taken in zip(runs, times, strict=True):
            before = time.process_time()
            results.append(run.run(progress=False))
            taken.append(time.process_time() - before)
    whole, linear = (min(taken) for taken in times)
    stages = 2 * round(case.days * 86400 / STEP)
    iterations = [result.provenance.newton_iterations / stages for result in results]
    return [
        case.name,
        f"{whole:.3f} s",
        f"{linear / whole:.2f}",
        " -> ".join(f"{number:.2f}" for number in iterations),
        *_apart(results),
        f"{results[1].energy.closure:.0e}",
    ]


def _apart(results: list[Results]) -> list[str]:
    """Largest rms and largest difference of airs and surfaces [K], and of loads [% of the largest load]."""
    first, second = (result.records[96 * SETTLING :] for result in results)
    kinds = [output.kind for output in results[0].outputs]
    cells = []
    for of in (AIRS, SURFACES):
        which = [k for k, kind in enumerate(kinds) if kind in of]
        difference = second[:, which] - first[:, which]
        rms = np.sqrt(np.mean(difference**2, axis=0)).max(initial=0.0)
        cells.append(f"{rms:.4f} ({np.abs(difference).max(initial=0.0):.3f})")
    loads = [k for k, kind in enumerate(kinds) if kind in LOADS]
    if not loads:
        return [*cells, ""]
    sums = [np.abs(records[:, loads]).sum() for records in (first, second)]
    largest = np.abs(second[:, loads] - first[:, loads]).max() / np.abs(first[:, loads]).max()
    return [*cells, f"{100 * (sums[1] / sums[0] - 1):+.3f} ({100 * largest:.2f})"]


def main() -> None:
    """Measure, print, and write on demand."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    options.add_argument("--only", help="cases whose name contains this")
    given = options.parse_args()
    head = (
        "building",
        "SDIRK2",
        "time",
        "iterations a stage",
        "airs, rms (max) [K]",
        "surfaces, rms (max) [K]",
        "loads, sum (max) [%]",
        "closure",
    )
    lines = []
    for case in cases():
        if given.only is None or given.only in case.name:
            lines.append(line(case))
            print(" | ".join(lines[-1]), flush=True)
    note = f"x86_64, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the end; shortest of {REPEATS}."
    page.publish("linearly implicit", f"{page.table(head, lines)}\n\n{note}", given.write)


if __name__ == "__main__":
    main()
