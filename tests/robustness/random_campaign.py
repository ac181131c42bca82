"""Campaign of random buildings in extreme weather.

``random_campaign.py --first 0 --count 5000 --resume FILE`` runs 5000 cases.

Each case is one line of JSON in the file: what became of it, extremes, residuals, members of an ensemble that
differ from a run alone, warnings, faults, time. A campaign that was ended goes on after the cases that the
file has. ``--show SEED`` prints a case as YAML with the options of its run, ``--summary`` counts a file.
"""

from __future__ import annotations

import argparse
import collections
import dataclasses
import json
import signal
import sys
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import _folders  # noqa: F401
import random_judges
from mascarin.errors import InputError, MascarinError, SolverError
from mascarin.simulation.simulation import Simulation
from random_cases import Case, case
from random_judges import RESIDUAL, Fault

#: Longest run of any case, processor time. [s]
LONGEST = 60
#: Scheme whose energy balance does not close, by its definition.
OPEN = "apparent-capacity"


class TooLong(Exception):
    """A run takes longer than any may."""


@contextmanager
def within(seconds: int) -> Iterator[None]:
    """End what takes too much processor time, whatever else the machine does; without such timers, wait."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def late(number: int, frame: object) -> None:
        raise TooLong(f"longer than {seconds} s")

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def judged(seed: int) -> dict[str, Any]:
    """Run the case of a seed and judge it.

    Returns
    -------
    dict
        The line of the case: see the head of this file.
    """
    began = time.process_time()
    line: dict[str, Any] = {"seed": seed, "outcome": "defect", "exit": 70, "faults": []}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            _judge(seed, line)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a panic of compiled code is no Exception
            _ended(line, error)
    line["seconds"] = round(time.process_time() - began, 3)
    return line


def _ended(line: dict[str, Any], error: BaseException) -> None:
    """How a case ended with an exception."""
    line["error"] = f"{type(error).__name__}: {error}"
    if isinstance(error, MascarinError):
        line["exit"] = error.exit_code
        line["outcome"] = {2: "refused", 3: "unsolved"}.get(error.exit_code, "error")
        if error.exit_code == InputError.exit_code and line.get("checked"):
            line["outcome"] = "refused by the run"
    else:
        kind = "too long" if isinstance(error, TooLong) else "exception"
        place = traceback.extract_tb(error.__traceback__)[-1]
        line["faults"].append([kind, f"{line['error'][:300]} ({Path(place.filename).name}:{place.lineno})"])


def _judge(seed: int, line: dict[str, Any]) -> None:
    drawn = case(seed)
    line |= {"weather": drawn.weather.kind, "scheme": drawn.options["scheme"], "step": drawn.options["step"]}
    building = drawn.building()
    building.check(drawn.options["step"])
    line["checked"] = True
    with within(LONGEST):
        simulation = drawn.simulation(building)
        alone = simulation.run()
    line |= {"outcome": "run", "exit": 0 if alone.energy.closes else 1, "warnings": list(alone.warnings)}
    line |= dataclasses.asdict(random_judges.extremes(building, list(alone.outputs), alone.records))
    line["residual"] = float(alone.energy.relative_residual)
    faults = random_judges.faults(drawn, building, list(alone.outputs), alone.records)
    faults += _residuals(drawn, "energy", line["residual"])
    if alone.vapour is not None:
        line["vapour_residual"] = float(alone.vapour.relative_residual)
        faults += _residuals(drawn, "vapour", line["vapour_residual"])
    faults += _members(drawn, simulation, line)
    line["faults"] += [[fault.kind, fault.text] for fault in faults]


def _residuals(drawn: Case, what: str, residual: float) -> list[Fault]:
    if residual <= RESIDUAL or (what == "energy" and drawn.options["scheme"] == OPEN):
        return []
    return [Fault(f"{what} residual", f"{residual:.3g}")]


def _members(drawn: Case, simulation: Simulation, line: dict[str, Any]) -> list[Fault]:
    """Faults of unlike members of an ensemble, and members that differ from a run alone."""
    vectors = drawn.vectors(simulation)
    faults: list[Fault] = []
    with within(LONGEST * len(vectors)):
        records, residuals, failures = simulation.ensemble(vectors)
    failed, differ, largest, unsolved = {one.member for one in failures}, 0, 0.0, 0
    for member, vector in enumerate(vectors):
        where = f"member {member} of {len(vectors)}"
        try:
            with within(LONGEST):
                alone, raw = simulation.compiled.run(vector)
        except SolverError:
            unsolved += 1
            if member not in failed:
                faults.append(Fault("members", f"{where}: solved in the ensemble, not alone"))
            continue
        if member in failed:
            faults.append(Fault("members", f"{where}: not solved in the ensemble, solved alone"))
            continue
        # An ensemble gives the larger residual of heat and vapour.
        residual = max(raw["closure"], raw["vapour"]["closure"] if simulation.building.humidity else 0.0)
        if residual != residuals[member]:
            off = abs(residual - residuals[member])
            faults.append(Fault("residual of a member", f"{where}: {off:.2g} off that of a run alone"))
        if not np.array_equal(alone, records[member], equal_nan=True):
            differ += 1
            largest = max(largest, float(np.nanmax(np.abs(alone - records[member]), initial=0.0)))
        changed = simulation._changed(vector)
        own = random_judges.faults(drawn, simulation.building, list(simulation.outputs), alone, changed)
        own += _residuals(drawn, "energy", raw["closure"])
        faults += [Fault(one.kind, f"{where}: {one.text}") for one in own]
    line |= {
        "members": len(vectors),
        "differ": differ,
        "largest_difference": largest,
        "unsolved_members": unsolved,
    }
    if differ:
        faults.append(
            Fault("members", f"{differ} of {len(vectors)} differ from a run alone, by {largest:.3g} at most")
        )
    return faults


# --- the campaign -------------------------------------------------------------------------------------------


def shown(drawn: Case) -> str:
    """A case as YAML, with the options of its run and its weather as comments."""
    from mascarin.building.files.yaml_text import text_of

    head = [f"weather: {drawn.weather.kind}, {len(drawn.weather.frame)} rows"]
    head += [f"{key}: {value!r}" for key, value in drawn.options.items()]
    return "\n".join([*(f"# {comment}" for comment in head), text_of(drawn.tree)])


def done(path: Path) -> list[dict[str, Any]]:
    """Lines of a file; a last line that was cut off is left out."""
    lines = []
    for text in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
        try:
            lines.append(json.loads(text))
        except ValueError:
            continue
    return lines


def summary(lines: list[dict[str, Any]]) -> str:
    """Counts of a campaign: outcomes, and kinds of faults with the first seeds that show each."""
    text = [f"{len(lines)} drawn"]
    text += [
        f"  {name}: {count}"
        for name, count in collections.Counter(line["outcome"] for line in lines).most_common()
    ]
    members = sum(line.get("members", 0) for line in lines)
    text.append(f"  members: {members}, of which {sum(line.get('differ', 0) for line in lines)} differ")
    by_kind: dict[str, dict[int, str]] = {}
    for line in lines:
        for kind, what in line["faults"]:
            by_kind.setdefault(kind, {}).setdefault(line["seed"], what)
    for kind, seeds in sorted(by_kind.items(), key=lambda item: -len(item[1])):
        first = ", ".join(map(str, sorted(seeds)[:8]))
        text.append(f"{kind}: {len(seeds)} cases ({first})\n    {next(iter(seeds.values()))}")
    for outcome in ("unsolved", "refused by the run", "refused"):
        for line in [line for line in lines if line["outcome"] == outcome][:12]:
            text.append(f"{outcome}, seed {line['seed']}: {' '.join(line['error'].split())[:200]}")
    return "\n".join(text)


def main() -> int:
    """Run what the command line asks for; 1 where there are faults."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--count", type=int, default=100, help="number of cases")
    parser.add_argument("--resume", type=Path, help="file of what is done; the same command continues it")
    parser.add_argument("--summary", action="store_true", help="count the file only")
    parser.add_argument("--show", type=int, help="print the case of a seed as YAML")
    asked = parser.parse_args()
    if asked.show is not None:
        print(shown(case(asked.show)))
        return 0
    lines = done(asked.resume) if asked.resume else []
    seeds = {line["seed"] for line in lines}
    requested = [] if asked.summary else range(asked.first, asked.first + asked.count)
    for seed in requested:
        if seed in seeds:
            continue
        lines.append(judged(seed))
        if asked.resume:
            with asked.resume.open("a", encoding="utf-8") as file:
                file.write(json.dumps(lines[-1]) + "\n")
        else:
            print(json.dumps(lines[-1]), flush=True)
    print(summary(lines))
    return 1 if any(line["faults"] for line in lines) else 0


if __name__ == "__main__":
    sys.exit(main())
