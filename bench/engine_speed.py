"""Speed of the engine on the LGI cell over 92 days: single runs through Python, ensembles, lanes and cores.

Every time is the shortest of several repetitions. Single runs and ensembles on one thread are measured in
processor time, which other programs on the machine disturb least. The ratio of two threads to one is
measured by the clock, so that no other program should run meanwhile. Instructions of a stage are counted by
valgrind where it is installed: the difference of runs over six and over two days.

    python bench/engine_speed.py [--days 92] [--members 16] [--write docs/speed.md]

With `--write` the table is written into the page.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import page
import pandas as pd

import mascarin as mc
from mascarin.building import Building
from mascarin.examples import FOLDER
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate

START = pd.Timestamp("2010-08-01")
OUTPUTS = (
    "room.air_temperature",
    "ceiling.inside_temperature",
    "ceiling.energain_plasterboard_temperature",
    "ceiling.outside_temperature",
    "air_gap.air_temperature",
    "roof.inside_temperature",
)
#: Varied in ensembles: the paper's seven as far as a model has them, half-width relative to the value.
VARIED = {
    "materials.energain.law.width": 0.4,
    "surfaces.roof.outside.absorptance": 0.1,
    "surfaces.floor.inside.convection.coefficient": 0.4,
    "surfaces.ceiling.inside.convection.coefficient": 0.4,
    "surfaces.ceiling.outside.convection.coefficient": 0.4,
    "surfaces.roof.inside.convection.coefficient": 0.4,
    "surfaces.roof.outside.convection.coefficient": 0.4,
}
LANES = "MASCARIN_LANES"


@dataclass(frozen=True)
class Model:
    """A way of modelling the cell, and how many members a second on one core were asked of it.

    What was asked was asked of 46 nodes. The shipped cell has 64, for each of the four upstands about its air
    gap is a wall of its own. Where the cell is not `whole`, one wall of the same construction and area stands
    for them.
    """

    name: str
    inside: object
    outside: object
    straight: bool
    asked: float | None
    whole: bool = True


LINEAR_WIND = {"kind": "linear_wind", "constant": 11.4, "wind": 5.7}
MODELS = {
    "constant": Model("constant films, radiation linear", 3.0, 15.0, True, 900.0),
    "table4": Model("table 4 after: 5.7 V + 11.4, radiation linear", 3.0, LINEAR_WIND, True, 600.0),
    "alamdari": Model(
        "Alamdari-Hammond inside, rest as before", "alamdari_hammond", LINEAR_WIND, True, 300.0
    ),
    "table4-exact": Model("table 4 after, radiation exact", 3.0, LINEAR_WIND, False, None),
    "constant-46": Model("constant films, 46 nodes", 3.0, 15.0, True, 900.0, whole=False),
    "table4-46": Model("table 4 after, 46 nodes", 3.0, LINEAR_WIND, True, 600.0, whole=False),
    "alamdari-46": Model(
        "Alamdari-Hammond, 46 nodes", "alamdari_hammond", LINEAR_WIND, True, 300.0, whole=False
    ),
    "shipped": Model("as shipped: TARP, MoWiTT, radiation exact", None, None, False, None),
}


def building(model: Model) -> Building:
    """The cell with the convection and radiation of a model; the slab below it at a constant temperature."""
    cell = mc.load(FOLDER / "lgi" / "building.yaml") if model.whole else smaller()
    changes: dict[str, object] = {"surfaces.floor.outside": {"ground": {"mean": 22.5}}}
    for name, surface in cell.surfaces.items():
        if model.inside is not None:
            changes[f"surfaces.{name}.inside.convection"] = model.inside
            if name == "ceiling":
                changes[f"surfaces.{name}.outside.convection"] = model.inside
        if surface.outside.outdoors:
            if model.outside is not None:
                changes[f"surfaces.{name}.outside.convection"] = model.outside
            if model.straight:
                changes[f"surfaces.{name}.outside.longwave"] = {"kind": "linearised", "reference": 25}
    if model.straight:
        changes["zones.room.longwave"] = {"kind": "linearised", "reference": 27}
        changes["zones.air_gap.longwave"] = {"kind": "linearised", "reference": 30}
    return cell.replace(changes)


def smaller() -> Building:
    """The cell with one upstand of the area of all four, without a position in space."""
    text = (FOLDER / "lgi" / "building.yaml").read_text(encoding="utf-8")
    for gone in ("north", "east", "west"):
        text = re.sub(rf"  upstand_{gone}:\n(?:    .*\n)+", "", text)
    text = re.sub(
        r"(  upstand_south:\n(?:    .*\n)*?)    vertices: .*\n",
        r"\1    area: 3.576\n    tilt: 90\n    azimuth: 180\n",
        text,
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "building.yaml"
        file.write_text(text, encoding="utf-8")
        return mc.load(file)


@cache
def climate() -> Climate:
    """The weather of the shipped virtual experiment."""
    names = ("relative_humidity", "wind_speed", "wind_direction", "pressure", "global_horizontal")
    columns = {"air_temperature": "outdoor_air", "diffuse_horizontal": "diffuse_horizontal"}
    columns |= {name: name for name in names}
    return Climate.from_table(FOLDER / "lgi" / "lgi_virtual.csv", timezone="UTC+4", columns=columns)


def simulation(model: Model, days: int) -> Simulation:
    """A model over some days."""
    end = START + pd.Timedelta(days=days)
    return Simulation(building(model), climate(), step=900.0, start=START, end=end, outputs=OUTPUTS)


def samples(of: Simulation, members: int) -> np.ndarray:
    """Parameter vectors of an ensemble, one a row."""
    rows = np.tile(of.values, (members, 1))
    rng = np.random.default_rng(1)
    for path, half in VARIED.items():
        if path in of.paths:
            rows[:, of.position(path)] *= rng.uniform(1.0 - half, 1.0 + half, members)
    return rows


def fastest(work: Callable[[], object], repeats: int, clock: Callable[[], float]) -> float:
    """Shortest time of some repetitions [s]."""
    times = []
    for _ in range(repeats):
        before = clock()
        work()
        times.append(clock() - before)
    return min(times)


def stages(result: Results, days: int) -> int:
    """Stages of a run, those of the repeated first day included."""
    repeated = re.search(r"repeated (\d+) times", result.provenance.start)
    assert repeated is not None
    return 2 * 96 * (days + int(repeated[1]))


def measure(name: str, days: int, members: int, repeats: int) -> dict[str, float]:
    """Times of a run, and of a member of an ensemble by processor time and by the clock [s]."""
    of = simulation(MODELS[name], days)
    many = samples(of, members)
    result = of.run()

    def sweep() -> object:
        return of.ensemble(many, record_every=96)

    sweep()
    return {
        "run": fastest(lambda: of.run(), repeats, time.process_time),
        "iterations": result.provenance.newton_iterations / stages(result, days),
        "closure": float(result.energy.closure),
        "member": fastest(sweep, repeats, time.process_time) / members,
        "member_by_clock": fastest(sweep, repeats, time.perf_counter) / members,
    }


def apart(name: str, given: argparse.Namespace, threads: int, lanes: str = "") -> dict[str, float]:
    """The same in a process of its own, with a given number of threads and kind of lanes."""
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads), LANES: lanes}
    command = [sys.executable, __file__, "--child", name, "--days", str(given.days)]
    command += ["--members", str(given.members), "--repeats", str(given.repeats)]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)  # noqa: S603
    found: dict[str, float] = json.loads(done.stdout)
    return found


def table(given: argparse.Namespace) -> str:
    """Everything measured, as a table."""
    head = ("model", "one run", "members/s, one core", "asked", "two cores", "AVX2", "arrays")
    lines = []
    for name, model in MODELS.items():
        one = apart(name, given, 1)
        two = apart(name, given, 2)
        narrow, plain = (apart(name, given, 1, lanes) for lanes in ("avx2", "array"))
        cells = [
            model.name,
            f"{1e3 * one['run']:.0f} ms",
            f"{1.0 / one['member']:.0f}",
            "" if model.asked is None else f"{model.asked:.0f}",
            f"x {one['member_by_clock'] / two['member_by_clock']:.2f}",
            *(f"{1.0 / other['member']:.0f}" for other in (narrow, plain)),
            f"{one['iterations']:.2f}",
        ]
        lines.append(cells)
        print(" | ".join(cells), file=sys.stderr)
    note = f"{page.conditions(given.days)}; {given.members} members, shortest of {given.repeats}."
    return f"{page.table([*head, 'iterations a stage'], lines)}\n\n{note}"


def main() -> None:
    """Measure, print, and write on demand."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--days", type=int, default=92)
    options.add_argument("--members", type=int, default=16)
    options.add_argument("--repeats", type=int, default=3)
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    options.add_argument("--child", choices=list(MODELS), help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.child:
        print(json.dumps(measure(given.child, given.days, given.members, given.repeats)))
        return
    page.publish("ensembles", table(given), given.write)


if __name__ == "__main__":
    main()
