"""Error and cost of steps that are chosen (`step: auto`), against steps of one minute with the same cells.

    python bench/auto_step.py [--weather 725650TYCST.epw] [--days 30] [--only NAME] [--tolerance 0.05 ...]

For each building: the largest error of the temperatures of air and of mean radiant temperatures at the
records, the number of steps, and process times of a run and of the choice of its steps; beside it the same
with steps of one length. Records are hourly.
"""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import yaml

import mascarin as mc
from mascarin.examples import FOLDER
from mascarin.simulation.preparation import step_sequence
from mascarin.simulation.preparation.step_sequence import StepSequence
from mascarin.verification.bestest.catalogue import CASES
from mascarin.verification.bestest.weather import read

PAGE = Path(__file__).resolve().parent.parent / "docs" / "openings.md"
#: A record interval of an hour is halved so many times for steps of 56 s.
FINE = 6
Case = tuple[mc.Building, mc.Climate, dict[str, Any]]


def house() -> mc.Building:
    """The house with vents and a control of docs/openings.md."""
    text = re.search(r"```yaml\n(name: two rooms.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert text is not None
    file = Path("/tmp") / "auto_step_house.yaml"  # noqa: S108 (removed below)
    try:
        file.write_text(text[1], encoding="utf-8")
        return mc.load(str(file))
    finally:
        file.unlink()


def span(start: str, days: int) -> dict[str, Any]:
    """Start and end of a period."""
    return {"start": start, "end": str(np.datetime64(start) + np.timedelta64(days, "D"))}


def lgi(days: int) -> Case:
    """The cell of the shipped study, in its own weather of every 15 min."""
    folder = FOLDER / "lgi"
    plain = yaml.safe_load((folder / "study.yaml").read_text(encoding="utf-8"))["climate"]["measured"]
    table = folder / plain.pop("table")
    climate = mc.Climate.from_table(table, **plain)
    measured = mc.Measurements.from_table(table, timezone=plain["timezone"])
    building = mc.load(str(folder / "building.yaml"))
    return building, climate, {**span("2010-09-01", days), "measurements": measured}


def cases(weather: Path | None, days: int) -> Iterator[tuple[str, Callable[[], Case]]]:
    """Buildings by name."""
    tampa = mc.Climate.shipped("tampa", elsewhere=True)
    year = tampa.index[0].year
    summer = {
        "start": f"{year}-06-01",
        "end": str(np.datetime64(f"{year}-06-01") + np.timedelta64(days, "D")),
    }
    yield "house with vents and a control, Tampa", lambda: (house(), tampa, summer)
    yield "LGI cell with phase change", lambda: lgi(days)
    if weather is not None:
        denver = read(weather)
        for name in ("600FF", "900FF", "600", "900"):
            span = {
                "start": "2001-01-01",
                "end": str(np.datetime64("2001-01-01") + np.timedelta64(days, "D")),
            }
            yield f"case {name}, Denver", lambda name=name, span=span: (
                mc.load(str(CASES[name].file)), denver, span
            )  # fmt: skip


def of_one_length(halvings: int, *_: Any) -> Callable[..., StepSequence]:
    """In place of the choice: steps of one length."""

    def chosen(auto: Any, interval: float, run: Any, forcings: Any, *_: Any, **__: Any) -> StepSequence:
        count = len(forcings[0]) << halvings
        return StepSequence(np.full(count, halvings, dtype=np.uint8), interval, auto.tolerance, 0.0)

    return chosen


def run(case: Case, step: str, halvings: int | None = None) -> dict[str, Any]:
    """One run: temperatures, times, steps."""
    building, climate, options = case
    names = [
        f"{zone}.{what}"
        for zone in building.zones
        for what in ("air_temperature", "mean_radiant_temperature")
    ]
    before = time.process_time()
    if halvings is None:
        simulation = mc.Simulation(building, climate, step=step, outputs=names, **options)
    else:
        with patch.object(step_sequence, "chosen_sequence", of_one_length(halvings)):
            simulation = mc.Simulation(building, climate, step=step, outputs=names, **options)
    ready = time.process_time() - before
    before = time.process_time()
    results = simulation.run()
    sequence = simulation.sequence
    assert sequence is not None
    return {
        "values": np.array([np.asarray(results[name]) for name in names]),
        "steps": len(sequence.halvings),
        "shortest": sequence.shortest,
        "estimated": sequence.error,
        "seconds": time.process_time() - before,
        "ready": ready,
        "closure": results.energy.closure,
        "halvings": np.bincount(sequence.halvings),
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--weather", type=Path)
    parser.add_argument("--days", type=int, default=30)
    parser.add_argument("--only", default="")
    parser.add_argument("--tolerance", type=float, nargs="*", default=[0.5, 0.2, 0.05])
    given = parser.parse_args()
    for name, make in cases(given.weather, given.days):
        if given.only not in name:
            continue
        case = make()
        fine = run(case, "auto every 1h", FINE)
        print(f"{name}: 1 min: {fine['steps']} steps, {fine['seconds']:.2f} s", flush=True)
        rows = [(f"{60 / 2**k:g} min", run(case, "auto every 1h", k)) for k in (0, 2, 4)]
        for tolerance in given.tolerance:
            try:
                rows.append((f"auto {tolerance:g} K", run(case, f"auto {tolerance}K every 1h")))
            except mc.InputError as error:
                print(f"  auto {tolerance:g} K: {error}")
        for label, row in rows:
            errors = np.abs(row["values"] - fine["values"])[:, 1:]
            print(
                f"  {label:12} {row['steps']:7} steps from {row['shortest']:6.1f} s, error air "
                f"{errors[::2].max():.4f} K, radiant {errors[1::2].max():.4f} K, mean {errors.mean():.5f} K, "
                f"estimated {row['estimated']:.4f} K, run {row['seconds']:.3f} s, before "
                f"{row['ready']:.2f} s, closure {row['closure']:.0e}, {row['halvings']}",
                flush=True,
            )


if __name__ == "__main__":
    main()
