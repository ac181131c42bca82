"""The LGI cell over 92 days: computing time and accuracy of Mascarin, EnergyPlus and a hand-written program.

All three calculate the same cell (`cell.py`) in the same weather. The reference is Mascarin with steps of
30 s and four times the nodes. Differences from it are numerical errors, and for the other programs also
different models of the sun and the air.

Times are processor times of one thread, the shortest of several repetitions. EnergyPlus is timed with
hourly weather and hourly results, which is its usual configuration. For its accuracy it runs once more with
weather and results at every step. Its time is given as a whole, and minus the time of a run of one day,
which is start-up and warm-up. With finite differences in all surfaces the conductivity of the steel sheet
is 35 instead of 45 W/(m K), because EnergyPlus rejects 45; the thermal resistance of a sheet of 1 mm is
negligible in both cases.

    python bench/energyplus_lgi.py [--energyplus PATH] [--days 92] [--members 64] [--json FILE]
                                   [--write docs/speed.md]

Without a path EnergyPlus is left out, and the table says so.
"""

from __future__ import annotations

import os

os.environ["RAYON_NUM_THREADS"] = "1"  # before the engine is loaded: times of one thread

import argparse
import json
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import cell
import naive
import numpy as np
import numpy.typing as npt
import page
import pandas as pd

import energyplus
from mascarin.building import Building
from mascarin.building.engine_input.mesh import choose
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate

Array = npt.NDArray[np.float64]
QUARTER = 900.0
COARSE, EVERYWHERE = "EnergyPlus, CondFD ceiling, 3 min", "EnergyPlus, CondFD everywhere, 3 min"
ASKED = {COARSE: "150, 400", EVERYWHERE: "1000"}  # times our run, times a member of our ensemble
SETTLING = 5  # days left out: the programs start from different states
SEVEN = {  # what the ensemble varies: the paper's seven, half-width of the range relative to the value
    "surfaces.floor.inside.convection.coefficient": 0.4,
    "surfaces.ceiling.inside.convection.coefficient": 0.4,
    "surfaces.ceiling.outside.convection.coefficient": 0.4,
    "surfaces.roof.inside.convection.coefficient": 0.4,
    "surfaces.roof.outside.convection.coefficient": 0.4,
    "surfaces.roof.outside.absorptance": 0.1,
    "materials.energain.law.width": 0.4,
}


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    name: str
    seconds: float
    without_start: float | None
    rms: dict[str, float] | None


def fastest(work: Callable[[], object], repeats: int) -> float:
    """Shortest processor time of some repetitions [s]."""
    times = []
    for _ in range(repeats):
        before = time.process_time()
        work()
        times.append(time.process_time() - before)
    return min(times)


def refined(building: Building, factor: int) -> Building:
    """The building with a multiple of the default number of nodes."""
    nodes = choose(building, QUARTER).nodes
    return building.replace(
        {
            f"constructions.{construction}.layers.{layer}.nodes": factor * count
            for (construction, layer), count in nodes.items()
            if count
        }
    )


def ours(building: Building, climate: Climate, end: str, step: float) -> Simulation:
    """Make a simulation of the cell by Mascarin."""
    names = list(cell.OUTPUTS.values())
    return Simulation(building, climate, step=step, start=cell.START, end=end, outputs=names)


def errors(records: Array, reference: Array) -> dict[str, float]:
    """Root mean square of the difference, by output [K]; rows at every quarter of an hour."""
    rows = min(len(records), len(reference))
    first = round(SETTLING * 86400.0 / QUARTER)
    rms = np.sqrt(np.mean((records[first:rows] - reference[first:rows]) ** 2, axis=0))
    return dict(zip(cell.OUTPUTS, map(float, rms), strict=True))


def main() -> None:
    """Run everything and print the table."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--energyplus", help="the program")
    options.add_argument("--days", type=int, default=92)
    options.add_argument("--members", type=int, default=64)
    options.add_argument("--json", type=Path)
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    given = options.parse_args()
    program = energyplus.program_of(given.energyplus) if given.energyplus else None
    end = f"{pd.Timestamp(cell.START) + pd.Timedelta(days=given.days):%Y-%m-%d}"
    building, weather = cell.building(), cell.table()
    climate = cell.climate(weather)

    reference = ours(refined(building, 4), climate, end, 30.0).run().records[:: round(QUARTER / 30.0)]
    coarser = ours(refined(building, 2), climate, end, 60.0).run().records[:: round(QUARTER / 60.0)]
    rows = [*own_rows(building, climate, end, reference, given.members)]
    if program is not None:
        rows += peer_rows(program, building, climate, end, reference)
    rows.append(naive_row(building, weather, given.days, reference))
    lines = [
        table(rows),
        f"\n{page.conditions(given.days)}; one thread.",
        f"The reference against 60 s and half the nodes, rms [K]: {_text(errors(coarser, reference))}.",
    ]
    if program is None:
        lines.append("EnergyPlus was not at hand.")
    page.publish("peers", "\n".join(lines), given.write)
    if given.json:
        given.json.write_text(json.dumps([asdict(row) for row in rows], indent=2) + "\n", encoding="utf-8")


def own_rows(building: Building, climate: Climate, end: str, reference: Array, members: int) -> list[Row]:
    """Rows of Mascarin: single runs, and one member of an ensemble."""
    rows = []
    for step in (900.0, 450.0, 180.0):
        simulation = ours(building, climate, end, step)
        seconds = fastest(simulation.run, 7)
        records = simulation.run().records[:: round(QUARTER / step)]
        rows.append(Row(f"Mascarin, {step:.0f} s", seconds, None, errors(records, reference)))
        if step == QUARTER:
            samples = np.tile(simulation.values, (members, 1))
            rng = np.random.default_rng(1)
            for path, half in SEVEN.items():
                samples[:, simulation.position(path)] *= rng.uniform(1.0 - half, 1.0 + half, members)
            taken = fastest(partial(simulation.ensemble, samples, record_every=96), 3) / members
            rows.append(Row(f"Mascarin, {step:.0f} s, one of {members}", taken, None, rows[-1].rms))
    return rows


def peer_rows(program: Path, building: Building, climate: Climate, end: str, reference: Array) -> list[Row]:
    """Rows of EnergyPlus with several schemes."""
    ceiling = ("ceiling",)
    schemes = {
        COARSE: energyplus.Scheme(20, ceiling),
        "EnergyPlus, CondFD ceiling, 1 min": energyplus.Scheme(60, ceiling),
        "EnergyPlus, CondFD ceiling, 1 min, fine": energyplus.Scheme(60, ceiling, 0.3, 5e-5),
        EVERYWHERE: energyplus.Scheme(20, None),
    }
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        hourly = folder / "hourly.epw"
        energyplus.write_weather(hourly, climate, building, cell.START, end, 1)
        for label, scheme in schemes.items():
            sheet = building if scheme.finite else building.replace({"materials.steel.conductivity": 35.0})
            rows.append(peer(program, folder, label, scheme, sheet, climate, end, hourly, reference))
    return rows


def peer(
    program: Path, folder: Path, label: str, scheme: energyplus.Scheme, building: Building, climate: Climate,
    end: str, hourly: Path, reference: Array,
) -> Row:  # fmt: skip
    """Row of EnergyPlus with one scheme."""
    outputs = [_there(name) for name in cell.OUTPUTS.values()]
    first = f"{pd.Timestamp(cell.START) + pd.Timedelta('1D'):%Y-%m-%d}"
    repeats = 1 if scheme.finite is None else 2

    def taken(until: str, repeats: int) -> float:
        model = energyplus.write_model(building, scheme, cell.START, until, outputs)
        return min(energyplus.run(program, folder / "timed", model, hourly).cpu for _ in range(repeats))

    seconds, start = taken(end, repeats), taken(first, 3)
    weather = folder / f"{scheme.per_hour}.epw"
    if not weather.exists():
        energyplus.write_weather(weather, climate, building, cell.START, end, scheme.per_hour)
    model = energyplus.write_model(building, scheme, cell.START, end, outputs, every="Timestep")
    found = energyplus.run(program, folder / "held", model, weather).records[outputs].to_numpy()
    each = scheme.per_hour // 4
    records = np.vstack([found[:1], found[each - 1 :: each]])  # the start is in no report; it is not compared
    return Row(label, seconds, seconds - start, errors(records, reference))


def _there(name: str) -> str:
    """Name of an output of Mascarin in EnergyPlus, where a wall between two zones is two surfaces."""
    if name == "ceiling.outside_temperature":
        return f"{energyplus.face_name('ceiling', 'outside')}.inside_temperature"
    return name


def naive_row(building: Building, weather: pd.DataFrame, days: int, reference: Array) -> Row:
    """Row of the hand-written program."""
    zoned = weather.tz_localize("Etc/GMT-4")
    peer = naive.NaiveCell(building, zoned)
    times = np.arange(0.0, days * 86400.0 - QUARTER, QUARTER)
    before = time.process_time()
    states = peer.run(24.0, times)
    seconds = time.process_time() - before
    records = np.column_stack([peer.read(states, name) for name in cell.OUTPUTS.values()])
    return Row("numpy and scipy, by hand", seconds, None, errors(records, reference))


def _text(rms: dict[str, float] | None) -> str:
    return ", ".join(f"{name} {value:.4f}" for name, value in (rms or {}).items())


def table(rows: list[Row]) -> str:
    """The table: times, ratios to a single run and to an ensemble of Mascarin, required ratios, errors."""
    single = next(row.seconds for row in rows if row.name == "Mascarin, 900 s")
    member = next(row.seconds for row in rows if "one of" in row.name)
    head = ("program, step", "CPU s", "less start", "/ one run", "/ member", "asked", *cell.OUTPUTS)
    lines = []
    for row in rows:
        net = row.seconds if row.without_start is None else row.without_start
        shown = "" if row.without_start is None else f"{net:.2f}"
        rms = [f"{value:.3f}" for value in (row.rms or {}).values()]
        ratios = [f"{net / single:.3g}", f"{net / member:.3g}", ASKED.get(row.name, "")]
        lines.append([row.name, f"{row.seconds:.3g}", shown, *ratios, *rms])
    return page.table(head, lines)


if __name__ == "__main__":
    main()
