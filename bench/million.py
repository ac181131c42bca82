"""Memory for a million objectives: the LGI cell swept into a store, and its table read again.

Memory depends on the members that are kept, not on the length of the period, because series are reduced in
parts of a fixed size (`mascarin/ensemble/work.py`). Therefore the period is short and the number of samples
is the full one. The largest resident memory is that of the process as the system reports it: Python,
samples, store and table.

    python bench/million.py [--members 1000000] [--days 1] [--step 1h] [--write docs/speed.md]
"""

from __future__ import annotations

import argparse
import os
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import page
import pandas as pd
from engine_speed import MODELS, OUTPUTS, START, VARIED, building, climate

from mascarin.ensemble import Statistic, sweep_into

ASKED = 1.0  # GiB
OBJECTIVES = {"mean": "mean:room.air_temperature", "hottest": "max:room.air_temperature"}


def largest() -> float:
    """Largest resident memory of this process so far [GiB]."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 2**30


def main() -> None:
    """Sweep, read the table, and print the memory."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--members", type=int, default=1_000_000)
    options.add_argument("--days", type=int, default=1)
    options.add_argument("--step", default="1h")
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    given = options.parse_args()
    cell, weather = building(MODELS["table4"]), climate()
    rng = np.random.default_rng(1)
    samples = {
        path: float(cell.parameter(path).value) * rng.uniform(1.0 - half, 1.0 + half, given.members)
        for path, half in VARIED.items()
        if path in {parameter.path for parameter in cell.parameters()}
    }
    before, began = largest(), time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        store = sweep_into(
            Path(folder) / "swept",
            cell,
            weather,
            samples,
            outputs=OUTPUTS,
            objectives={name: Statistic.read(text) for name, text in OBJECTIVES.items()},
            step=given.step,
            start=START,
            end=START + pd.Timedelta(days=given.days),
            initial=24.0,
        )
        swept, stored = largest(), (store.path / "members.parquet").stat().st_size
        found = store.table()
    assert len(found) == given.members
    rows = [
        ("before the sweep: program, weather and samples", f"{before:.2f} GiB", ""),
        ("until the store is complete", f"{swept:.2f} GiB", f"< {ASKED:g} GiB"),
        ("until its table is read back", f"{largest():.2f} GiB", ""),
        ("file of the store", f"{stored / 2**30:.2f} GiB", ""),
    ]
    text = page.table(("largest resident memory", "found", "asked"), rows)
    note = (
        f"{given.members:,} members, {len(samples)} parameters varied, {len(OBJECTIVES)} objectives each; "
        f"{given.days} d at {given.step}, {time.perf_counter() - began:.0f} s on "
        f"{os.environ.get('RAYON_NUM_THREADS', os.cpu_count())} threads; "
        f"{int(found['failure'].notna().sum())} failed."
    )
    page.publish("memory", f"{text}\n\n{note}", given.write)


if __name__ == "__main__":
    main()
