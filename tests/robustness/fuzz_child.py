"""A part of the campaign in a process of its own: ``fuzz_child.py KIND SEED FIRST LAST``.

Prints the number of each input before it is tried and its outcome afterwards, one JSON text a line. An input
that ends or blocks the process is then known.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import _folders  # noqa: F401
import fuzz_buildings
import fuzz_readers
import fuzz_states

#: Address space of the process, so that what asks for too much fails here and not on the machine. [B]
MEMORY = 8 * 2**30


def main() -> int:
    """Try the inputs FIRST to LAST - 1."""
    kind, seed, first, last = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    _limit_memory()
    with tempfile.TemporaryDirectory() as name:
        own = {"buildings": _buildings, "states": _states}
        one = own[kind](seed) if kind in own else _reader(kind, Path(name), seed)
        for n in range(first, last):
            _say({"begun": n})
            began = time.process_time()
            outcome = one(n)
            _say({"n": n, "seconds": round(time.process_time() - began, 3), **outcome})
    return 0


def _limit_memory() -> None:
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _say(message: dict[str, Any]) -> None:
    print(json.dumps(message), flush=True)


def _reader(name: str, folder: Path, seed: int) -> Callable[[int], dict[str, Any]]:
    reader = next(one for one in fuzz_readers.readers(folder / "samples") if one.name == name)
    place = folder / "place"
    place.mkdir()

    def one(n: int) -> dict[str, Any]:
        outcome, text = fuzz_readers.attempt(reader, place, n, seed)
        return {"outcome": outcome, "text": text}

    return one


def _buildings(seed: int) -> Callable[[int], dict[str, Any]]:
    weather = fuzz_buildings.climate()

    def one(n: int) -> dict[str, Any]:
        found = fuzz_buildings.one(n, seed, weather)
        return {
            "outcome": "defect" if found.faults else "refused" if found.refused else "unsolved"
            if found.unsolved else "read", "text": "\n".join(found.faults), "runs": found.runs,
            "residual": found.largest_closure, "slow": found.slow,
        }  # fmt: skip

    return one


def _states(seed: int) -> Callable[[int], dict[str, Any]]:
    def one(n: int) -> dict[str, Any]:
        machine = fuzz_states.PassiveBuildings if n % 3 == 0 else fuzz_states.Buildings
        try:
            fuzz_states.explore(machine, seed * 1_000_003 + n, histories=1)
        except Exception:
            return {"outcome": "defect", "text": traceback.format_exc()}
        return {"outcome": "read", "text": ""}

    return one


if __name__ == "__main__":
    sys.exit(main())
