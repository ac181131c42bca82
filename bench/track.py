"""Instructions and times of the engine over commits: a row for each case, kind of work and commit.

    python bench/track.py                    count the present state and append it to bench/tracked.csv
    python bench/track.py --show             the table over commits, as Markdown
    python bench/track.py --limit 0.02       fail where a count rose by more than a part of that before

Instructions are those of count_instructions.py, over some days on one thread, with what libraries do: they
are the same on every machine of a kind, so that a change of a thousandth is one of the code. Times are those
of criterion (engine_alone.py), if `--times` asks for them: they differ between machines, and only rows of one
machine can be compared. A working tree with changes is counted, but not appended.
"""

from __future__ import annotations

import argparse
import csv
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass, fields
from datetime import UTC, datetime
from pathlib import Path

import count_instructions
import counting
import engine_alone
import engine_cases
import page

FILE = Path(__file__).resolve().parent / "tracked.csv"
#: Kinds of work whose counts are reproducible to a few hundred instructions.
KINDS = ("run", "gradient", "pack", "jacobian")


@dataclass(frozen=True)
class Row:
    """One number of one commit.

    Attributes
    ----------
    commit, date : str
        The commit, shortened, and its day.
    machine : str
        Processor and compiler.
    case, kind, unit : str
        What was measured, and its unit: ``instructions``, or ``ns`` for a time.
    days : int
        Days that were simulated.
    value : int
        The number.
    """

    commit: str
    date: str
    machine: str
    case: str
    kind: str
    unit: str
    days: int
    value: int


def read(file: Path) -> list[Row]:
    """All rows of the file; none where there is no file."""
    if not file.exists():
        return []
    with file.open(encoding="utf-8", newline="") as lines:
        return [
            Row(**{**entry, "days": int(entry["days"]), "value": int(entry["value"])})
            for entry in csv.DictReader(lines)
        ]


def append(file: Path, rows: Iterable[Row]) -> None:
    """Write further rows at the end of the file; those of the same commit and machine are replaced."""
    new = list(rows)
    measured = {(row.commit, row.machine) for row in new}
    kept_rows = [row for row in read(file) if (row.commit, row.machine) not in measured]
    with file.open("w", encoding="utf-8", newline="") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(field.name for field in fields(Row))
        writer.writerows(astuple(row) for row in (*kept_rows, *new))


def changes(before: Sequence[Row], rows: Iterable[Row]) -> list[tuple[Row, float]]:
    """Ratio of each number to the last one of an earlier commit, of the same machine, case and days."""
    last = {(row.machine, row.case, row.kind, row.unit, row.days): row for row in before}
    pairs = [(row, last.get((row.machine, row.case, row.kind, row.unit, row.days))) for row in rows]
    return [
        (row, row.value / old.value) for row, old in pairs if old is not None and old.commit != row.commit
    ]


def table(rows: Sequence[Row], unit: str = "instructions") -> str:
    """The numbers over commits: a line for each commit and machine, a column for each case and kind."""
    shown = [row for row in rows if row.unit == unit]
    columns = list(dict.fromkeys((row.case, row.kind) for row in shown))
    lines: dict[tuple[str, str, str], dict[tuple[str, str], int]] = {}
    for row in shown:
        lines.setdefault((row.date, row.commit, row.machine), {})[row.case, row.kind] = row.value
    head = ["day", "commit", "machine", *(f"{case}, {kind}" for case, kind in columns)]
    cells = [
        [*key, *(f"{1e-6 * values[c]:.3f}" if c in values else "" for c in columns)]
        for key, values in lines.items()
    ]
    return page.table(head, cells)


def _printed(*words: str) -> str:
    done = subprocess.run(words, cwd=FILE.parent, check=True, capture_output=True, text=True)  # noqa: S603
    return done.stdout.strip()


def machine() -> str:
    """Kind of processor and the compiler: what instruction counts depend on beside the code."""
    return f"{platform.system()} {platform.machine()}, {' '.join(_printed('rustc', '--version').split()[:2])}"


def measured(days: int, *, times: bool) -> list[Row]:
    """All numbers of the present state of the repository."""
    commit, date = _printed("git", "log", "-1", "--format=%h"), _printed("git", "log", "-1", "--format=%cs")
    name = machine()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        cases = engine_cases.write(Path(folder), days)
        engine_alone.build(times=times, cases=Path(folder))
        for case in cases:
            print(f"{datetime.now(UTC):%H:%M:%S} {case.stem}", file=sys.stderr, flush=True)
            counts = count_instructions.counted(engine_alone.PROGRAM, case, days, KINDS)
            rows += [
                Row(commit, date, name, case.stem, kind, "instructions", days, counts[kind]["all"])
                for kind in KINDS
            ]
            for kind in ("run", "pack") if times else ():
                seconds, _ = engine_alone.criterion(kind, case.stem)
                host = f"{name}, {os.cpu_count()} cores"
                rows.append(Row(commit, date, host, case.stem, kind, "ns", days, round(1e9 * seconds)))
    return rows


def main() -> None:
    """Measure, append, compare."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--days", type=int, default=3)
    options.add_argument("--file", type=Path, default=FILE)
    options.add_argument("--times", action="store_true", help="criterion's times as well")
    options.add_argument("--limit", type=float, help="largest rise of a count that is not a failure")
    options.add_argument("--show", action="store_true", help="print the table over commits, and end")
    options.add_argument("--changed", action="store_true", help="append a tree with changes as well")
    arguments = options.parse_args()
    before = read(arguments.file)
    if arguments.show:
        print(table(before))
        return
    if not counting.at_hand():
        raise SystemExit("counting takes valgrind, objdump and an x86_64 processor")
    rows = measured(arguments.days, times=arguments.times)
    changed = _printed("git", "status", "--porcelain", "--untracked-files=no", "--", "../crates", ".")
    if not changed or arguments.changed:
        append(arguments.file, rows)
    else:
        print("the tree has changes: counted, not appended", file=sys.stderr)
    print(table(rows))
    ratios = changes(before, rows)
    for row, ratio in ratios:
        print(f"{row.case}, {row.kind} [{row.unit}]: {ratio:.4f} of the commit before", file=sys.stderr)
    if arguments.limit is not None:
        limit = 1.0 + arguments.limit
        rises = [f"{r.case} {r.kind}" for r, ratio in ratios if r.unit == "instructions" and ratio > limit]
        if rises:
            raise SystemExit(f"more than {100 * arguments.limit:g} % more instructions: {', '.join(rises)}")


if __name__ == "__main__":
    main()
