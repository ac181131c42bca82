"""Reading a long table: two years at 30 s, beside `pandas.read_csv` with its dates parsed.

Run it with `python bench/tables_speed.py`. Each reading is done in a process of its own, the smallest of
some times is printed, and the largest memory of the process.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

#: Rows of two years at 30 s.
ROWS = 2 * 365 * 2880
LEAST = 3.0
"""Times of `pandas.read_csv` within which the reader should stay. [-]"""


def write(path: Path, rows: int) -> None:
    """Write a table of three columns in the layout that most loggers have."""
    import numpy as np
    import pandas as pd

    rng = np.random.default_rng(1)
    stamps = pd.date_range("2022-01-01", periods=rows, freq="30s").strftime("%Y-%m-%d %H:%M:%S")
    frame = pd.DataFrame(
        {
            "time": stamps,
            "T [degC]": (15.0 + 5.0 * rng.normal(size=rows)).round(2),
            "RH [%]": rng.uniform(30.0, 90.0, rows).round(1),
            "G [W/m2]": np.maximum(500.0 * rng.normal(size=rows), 0.0).round(1),
        }
    )
    frame.to_csv(path, index=False)


def read(path: Path, how: str) -> tuple[float, float]:
    """Seconds of the processor, and memory [GB], of one reading in this process."""
    import pandas as pd

    from mascarin import Measurements

    begin = time.process_time()
    if how == "pandas":
        pd.read_csv(path, parse_dates=["time"])
    else:
        Measurements.from_table(path, timezone="UTC")
    seconds = time.process_time() - begin
    return seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0**2


def main() -> None:
    """Print both times, their ratio and the memory; exit 1 where the reader takes too long."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=ROWS)
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--one", nargs=2, metavar=("FILE", "HOW"))
    options = parser.parse_args()
    if options.one:
        print(*read(Path(options.one[0]), options.one[1]))
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "logger.csv"
        write(path, options.rows)
        quiet = {**os.environ, "MASCARIN_CACHE": "off"}
        best: dict[str, tuple[float, float]] = {}
        for _ in range(options.times):
            for how in ("pandas", "mascarin"):
                call = [sys.executable, __file__, "--one", str(path), how]
                process = subprocess.run(call, capture_output=True, text=True, check=True, env=quiet)  # noqa: S603
                text = process.stdout
                seconds, memory = map(float, text.split())
                best[how] = min(best.get(how, (1e9, 0.0)), (seconds, memory))
    ratio = best["mascarin"][0] / best["pandas"][0]
    for how, (seconds, memory) in best.items():
        print(f"{how:10} {seconds:6.2f} s  {memory:5.2f} GB")
    print(f"ratio {ratio:.2f} (at most {LEAST:g})")
    sys.exit(ratio > LEAST)


if __name__ == "__main__":
    main()
