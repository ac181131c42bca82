"""Instructions of the engine on one thread, by case and kind of work, counted by callgrind.

    python bench/engine_cases.py CASES --bestest 725650TYCST.epw
    python bench/count_instructions.py target/bench/release/mascarin-bench CASES [--days 3] [--write new.json]
    python bench/count_instructions.py PROGRAM CASES --against old.json

The program is that of bench/engine. The instructions for reading the case are subtracted. Counts include
the libraries that the program calls; with `--own` only the program itself is counted. Valgrind does not
support AVX-512, so that packs are counted with AVX2. Counts of runs and gradients are reproducible; those
of packs and Jacobians, where threads wait for each other, differ by up to 0.05 %.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import counting
import page

#: Kinds of work of the program; the count of `nothing` is subtracted from each of the others.
KINDS = ("run", "pack", "jacobian", "gradient")
STEPS_A_DAY = 96
#: Valgrind does not support AVX-512.
ENVIRONMENT = {"MASCARIN_LANES": "avx2", "RAYON_NUM_THREADS": "1"}

#: Kind -> instructions of the program, and with those in libraries.
Row = dict[str, dict[str, int]]


def counted(program: Path, case: Path, days: int, kinds: Sequence[str]) -> Row:
    """Instructions of each kind of work on a case over some days."""

    def taken(kind: str) -> counting.Count:
        return counting.count(program, [str(case), kind, str(STEPS_A_DAY * days)], {}, ENVIRONMENT)

    idle = taken("nothing")
    row = {}
    for kind in kinds:
        more = taken(kind).less(idle, 1)
        row[kind] = {"own": round(more.instructions), "all": round(more.everywhere)}
    return row


def table(rows: Mapping[str, Row], old: Mapping[str, Row], kinds: Sequence[str], which: str) -> str:
    """Millions of instructions, and their ratios to older ones where there are some."""

    def cell(name: str, kind: str) -> str:
        new = rows[name][kind][which]
        before = old.get(name, {}).get(kind)
        text = f"{1e-6 * new:.1f}"
        return text if before is None else f"{text} ({new / before[which]:.4f})"

    lines = [[name, *(cell(name, kind) for kind in kinds)] for name in rows]
    return page.table(["case, millions", *kinds], lines)


def main() -> None:
    """Count, print, write."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("program", type=Path)
    options.add_argument("cases", type=Path, help="folder that engine_cases.py wrote")
    options.add_argument("--days", type=int, default=3)
    options.add_argument("--only", nargs="+", metavar="CASE", help="names of cases")
    options.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    options.add_argument("--own", action="store_true", help="print the program alone, without libraries")
    options.add_argument("--write", type=Path, help="file for the counts")
    options.add_argument("--against", type=Path, help="counts of another program: ratios new/old are added")
    given = options.parse_args()
    if not counting.at_hand():
        raise SystemExit("counting takes valgrind, objdump and an x86_64 processor")
    files = sorted(given.cases.glob("*.json"))
    files = [file for file in files if given.only is None or file.stem in given.only]
    if not files:
        raise SystemExit(f"{given.cases}: no such cases; write them with bench/engine_cases.py")
    old = {"days": given.days, "counts": {}}
    if given.against is not None:
        old = json.loads(given.against.read_text(encoding="utf-8"))
    if old["days"] != given.days:
        raise SystemExit(f"{given.against} was counted over {old['days']} days: give --days {old['days']}")
    rows = {}
    for file in files:
        rows[file.stem] = counted(given.program, file, given.days, given.kinds)
        print(file.stem, rows[file.stem], file=sys.stderr, flush=True)
    if given.write is not None:
        written = {"days": given.days, "environment": ENVIRONMENT, "counts": rows}
        given.write.write_text(json.dumps(written, indent=1), encoding="utf-8")
    print(table(rows, old["counts"], given.kinds, "own" if given.own else "all"))


if __name__ == "__main__":
    main()
