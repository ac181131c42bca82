"""Ten times the usual size: rooms, members and years, with time and largest memory of a process each.

    python bench/ten_times.py rooms 128 1000          # a row with ideal loads, a year at 15 min
    python bench/ten_times.py years 1 10                       # case 900 at 15 min, into a file
    python bench/ten_times.py members 100000                   # over dask.distributed, a worker killed

Each case runs in a process of its own. ``members`` needs ``pip install distributed``; two workers of one
thread, one of which is killed when a third of the members is done. What it finishes must be what the threads
of one process give.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from many_zones import WEATHER, Grid, description
from page import table

import mascarin as mc

YEAR = {"start": "2001-01-01", "end": "2002-01-01"}


def largest() -> float:
    """Largest resident memory of this process so far. [MB]"""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


def rooms(count: int) -> dict[str, object]:
    """A row of rooms with ideal loads over a year."""
    house = mc.Building.from_dict(description(Grid((count, 1, 1)), loads=True))
    read = time.process_time()
    run = mc.simulate(
        house, mc.Climate.from_epw(WEATHER), step="15min", outputs=["r0_0_0.air_temperature"], **YEAR
    )
    return {
        "rooms": count,
        "surfaces": len(house.surfaces),
        "reading [s]": round(read, 1),
        "in all [s]": round(time.process_time(), 1),
        "memory [MB]": round(largest()),
        "closure": f"{run.energy.closure:.0e}",
    }


def years(count: int) -> dict[str, object]:
    """Case 900 over years of the same weather, into a file."""
    house, climate = (
        mc.Building.from_dict(description(Grid((1, 1, 1)), loads=True)),
        mc.Climate.from_epw(WEATHER),
    )
    end = f"{2001 + count}-01-01"
    simulation = mc.Simulation(house, climate, start="2001-01-01", end=end, step="15min")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "years.nc"
        simulation.run_into(file)
        size = file.stat().st_size
    return {
        "years": count,
        "in all [s]": round(time.process_time(), 1),
        "memory [MB]": round(largest()),
        "file [MB]": round(size / 1e6),
    }


def members(count: int) -> dict[str, object]:
    """A sweep over two workers of dask.distributed, one of which is killed, beside one of threads."""
    from distributed import Client, LocalCluster

    house, climate = (
        mc.Building.from_dict(description(Grid((1, 1, 1)), loads=True)),
        mc.Climate.from_epw(WEATHER),
    )
    rng = np.random.default_rng(1)
    samples = {"zones.r0_0_0.gains.use.power": rng.uniform(50.0, 250.0, count)}
    given = {
        "objectives": {"warm": "max:r0_0_0.air_temperature", "mean": "mean:r0_0_0.air_temperature"},
        "start": "2001-01-01", "end": "2001-01-02", "step": "1h", "initial": 20.0,
    }  # fmt: skip
    began = time.perf_counter()
    alone = mc.sweep(house, climate, samples, **given)
    threads = time.perf_counter() - began
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        killed: list[int] = []

        def watch(done: int, total: int) -> None:
            if not killed and 3 * done > total:
                victim = next(iter(cluster.workers.values())).pid
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)

        began = time.perf_counter()
        spread = mc.sweep(house, climate, samples, workers=client.get_executor(), progress=watch, **given)
    failed = sum(bool(np.isnan(spread[name]).any()) for name in given["objectives"])
    same = all(np.array_equal(alone[name], spread[name]) for name in given["objectives"])
    return {
        "members": count,
        "killed": len(killed),
        "the same numbers": same,
        "failed objectives": failed,
        "threads [s]": round(threads, 1),
        "workers [s]": round(time.perf_counter() - began, 1),
        "memory [MB]": round(largest()),
    }


CASES = {"rooms": rooms, "years": years, "members": members}


def main() -> None:
    """Run each size in a process of its own and print a table."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("case", choices=tuple(CASES))
    options.add_argument("sizes", nargs="+", type=int)
    options.add_argument("--alone", action="store_true", help="in this process, as JSON")
    given = options.parse_args()
    if given.alone:
        print(json.dumps(CASES[given.case](given.sizes[0])))
        return
    found = []
    for size in given.sizes:
        command = [sys.executable, __file__, given.case, str(size), "--alone"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
        if done.returncode:
            raise SystemExit(done.stderr)
        found.append(json.loads(done.stdout.splitlines()[-1]))
    print(table(tuple(found[0]), [[str(value) for value in row.values()] for row in found]))


if __name__ == "__main__":
    main()
