"""Example files of EnergyPlus: which of them convert, run two days in July, and close their balance.

    python bench/energyplus_examples.py FOLDER [NAME ...] [--write FILE.jsonl]

FOLDER holds the files (``ExampleFiles`` of EnergyPlus 9.6 without macros: 718 files). Each is a line
of JSON: the name, ``runs``, ``refused`` or ``fails``, seconds, the error, and the classes that are left out.
Lines that are there already are kept: an interrupted run goes on.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import time
from collections import Counter
from datetime import date, timedelta
from pathlib import Path
from types import FrameType
from typing import Any

from energyplus_small import WEATHER

import mascarin as mc
from mascarin.energyplus import convert
from mascarin.errors import MascarinError

#: Longest time for one file [s].
LIMIT = 240
FIRST = "07-01"


def _stop(_: int, __: FrameType | None) -> None:
    raise TimeoutError(f"longer than {LIMIT} s")


def tried(file: Path, climate: mc.Climate) -> dict[str, Any]:
    """What happens to one file."""
    began = time.perf_counter()
    row: dict[str, Any] = {"name": file.stem}
    signal.signal(signal.SIGALRM, _stop)
    signal.alarm(LIMIT)
    try:
        conversion = convert(file, weather=WEATHER)
        omissions = [finding for finding in conversion.findings if finding.level == "left out"]
        omitted = Counter(finding.kind for finding in omissions)
        unmeasured = Counter(finding.kind for finding in omissions if finding.kelvin is None)
        row |= {
            "left_out": dict(omitted),
            "unmeasured": dict(unmeasured),
            "zones": len(conversion.building.zones),
        }
        start = date.fromisoformat(f"{conversion.start[:4]}-{FIRST}")
        run = mc.simulate(
            conversion.building,
            climate,
            start=start.isoformat(),
            end=(start + timedelta(days=2)).isoformat(),
            step=f"{60 // conversion.steps_per_hour}min",
        )
        row |= {"result": "runs" if run.energy.closes else "open balance"}
    except MascarinError as error:
        row |= {"result": "refused", "error": str(error)[:400]}
    except Exception as error:  # what a user would see as a defect
        row |= {"result": "fails", "error": f"{type(error).__name__}: {error}"[:400]}
    finally:
        signal.alarm(0)
    return row | {"seconds": round(time.perf_counter() - began, 2)}


def main() -> None:
    """Try the files, and print how many run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--write", type=Path)
    options = parser.parse_args()
    files = sorted(options.folder.glob("*.idf"))
    files = [file for file in files if not options.names or file.stem in options.names]
    rows: dict[str, dict[str, Any]] = {}
    if options.write is not None and options.write.is_file():
        lines = options.write.read_text(encoding="utf-8").splitlines()
        rows = {row["name"]: row for row in map(json.loads, lines)}
    climate = mc.Climate.from_epw(WEATHER)
    for file in files:
        if file.stem in rows:
            continue
        rows[file.stem] = tried(file, climate)
        line = json.dumps(rows[file.stem])
        if options.write is None:
            print(line, flush=True)
        else:
            with options.write.open("a", encoding="utf-8") as target:
                target.write(line + "\n")
    counts = Counter(row["result"] for row in rows.values())
    print(f"{len(rows)} files: {dict(counts)}", file=sys.stderr)
    by_class = Counter(kind for row in rows.values() for kind in row.get("left_out", {}))
    for kind, number in by_class.most_common(40):
        print(f"{number:5d} {kind}", file=sys.stderr)


if __name__ == "__main__":
    main()
