"""Reading a long table: two years at 30 s, beside `pandas.read_csv` with its dates parsed.

Run it with `python bench/tables_speed.py`. The two read the same file in turns in one process, and the
smallest of some times of the processor is taken; the largest memory is that of a process that reads the file
once. The tables are those that loggers write: three and ten columns, a row of units, semicolons and decimal
commas, date and time of day in two columns with the day first, gaps.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

#: Rows of two years at 30 s.
ROWS = 2 * 365 * 2880
LEAST = 2.5
"""Times of `pandas.read_csv` within which the reader should stay. [-]"""
MEMORY = 1.0
"""Largest memory of a process that reads a table of three columns. [GB]"""
NAMES = ("T [degC]", "RH [%]", "G [W/m2]")
#: Format of dates and times of day in two columns.
DAY_FIRST = "%d.%m.%Y %H:%M:%S"


@dataclass(frozen=True)
class Dialect:
    """How a table is written, and how pandas is told so.

    Attributes
    ----------
    columns : int
        Columns beside the time.
    units : bool
        Whether a row of units is below the names.
    european : bool
        Whether semicolons stand between entries, and commas before decimals.
    day_first : bool
        Whether the time is a date with the day first and a time of day, in two columns.
    gaps : bool
        Whether entries are empty and rows are missing.
    options : dict
        For `pandas.read_csv`.
    """

    columns: int = 3
    units: bool = False
    european: bool = False
    day_first: bool = False
    gaps: bool = False
    options: dict[str, Any] = field(default_factory=dict)


DIALECTS = {
    "plain": Dialect(),
    "ten columns": Dialect(columns=10),
    "units": Dialect(units=True, options={"skiprows": [1]}),
    "european": Dialect(european=True, options={"sep": ";", "decimal": ","}),
    "day first": Dialect(day_first=True, european=True, options={"sep": ";", "decimal": ","}),
    "gaps": Dialect(gaps=True),
}


def write(path: Path, rows: int, dialect: Dialect = DIALECTS["plain"]) -> None:
    """Write a table in a layout that loggers have."""
    import numpy as np
    import pandas as pd

    rng = np.random.default_rng(1)
    stamps = pd.date_range("2022-01-01", periods=rows, freq="30s")
    values = {
        NAMES[0]: (15.0 + 5.0 * rng.normal(size=rows)).round(2),
        NAMES[1]: rng.uniform(30.0, 90.0, rows).round(1),
        NAMES[2]: np.maximum(500.0 * rng.normal(size=rows), 0.0).round(1),
    }
    for k in range(3, dialect.columns):
        values[f"T{k} [degC]"] = (20.0 + rng.normal(size=rows)).round(2)
    if dialect.units:
        values = {name.split(" [")[0]: column for name, column in values.items()}
    times = (
        {"Date": stamps.strftime("%d.%m.%Y"), "Time": stamps.strftime("%H:%M:%S")}
        if dialect.day_first
        else {"time": stamps.strftime("%Y-%m-%d %H:%M:%S")}
    )
    frame = pd.DataFrame({**times, **values})
    if dialect.gaps:
        for name in values:
            frame.loc[rng.random(rows) < 0.01, name] = np.nan
        keep = rng.random(rows) > 0.001
        keep[rows // 3 : rows // 3 + rows // 50] = False
        frame = frame[keep | (np.arange(rows) < 10)]
    marks: dict[str, Any] = {"sep": ";", "decimal": ","} if dialect.european else {}
    if dialect.units:
        head = f"{','.join(frame.columns)}\n,{','.join(name.split('[')[1][:-1] for name in NAMES)}\n"
        path.write_text(head)
        frame.to_csv(path, mode="a", header=False, index=False, **marks)
    else:
        frame.to_csv(path, index=False, **marks)


def by_pandas(path: Path, dialect: Dialect) -> pd.DataFrame:
    """What one writes by hand for such a table."""
    import pandas as pd

    if dialect.day_first:
        frame = pd.read_csv(path, **dialect.options)
        return frame.assign(time=pd.to_datetime(frame["Date"] + " " + frame["Time"], format=DAY_FIRST))
    return pd.read_csv(path, parse_dates=["time"], **dialect.options)


def by_reader(path: Path, dialect: Dialect) -> object:
    """The same table without a word about its layout."""
    from mascarin import Measurements

    del dialect
    return Measurements.from_table(path, timezone="UTC")


READERS: dict[str, Callable[[Path, Dialect], object]] = {"pandas": by_pandas, "mascarin": by_reader}


def in_turns(path: Path, dialect: Dialect, times: int) -> dict[str, float]:
    """Least seconds of the processor of each, read in turns in this process."""
    best = dict.fromkeys(READERS, float("inf"))
    for _ in range(times):
        for name, reader in READERS.items():
            begin = time.process_time()
            reader(path, dialect)
            best[name] = min(best[name], time.process_time() - begin)
    return best


def largest_memory() -> float:
    """Largest memory of this process so far. [GB]"""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0**2


def apart(*arguments: str) -> list[float]:
    """Numbers that this file prints in a process of its own, begun by a small one: its memory is its own."""
    call = [sys.executable, __file__, *arguments]
    process = subprocess.run(call, capture_output=True, text=True, check=True)  # noqa: S603
    return [float(word) for word in process.stdout.split()]


def main() -> None:
    """Print times, their ratios and the memory; exit 1 where the reader takes too much of either."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=ROWS)
    parser.add_argument("--times", type=int, default=5)
    parser.add_argument("--only", nargs="*", choices=list(DIALECTS), default=list(DIALECTS))
    parser.add_argument("--part", nargs=3, metavar=("WHAT", "FILE", "DIALECT"))
    options = parser.parse_args()
    os.environ["MASCARIN_CACHE"] = "off"
    if options.part:
        what, path, dialect = options.part[0], Path(options.part[1]), DIALECTS[options.part[2]]
        if what == "write":
            write(path, options.rows, dialect)
        elif what == "turns":
            print(*in_turns(path, dialect, options.times).values())
        else:
            READERS[what](path, dialect)
            print(largest_memory())
        return
    counts = ["--rows", str(options.rows), "--times", str(options.times)]
    failed = False
    print(f"{'table':12} {'pandas':>9} {'mascarin':>9} {'ratio':>6}   memory")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "logger.csv"
        for name in options.only:
            apart(*counts, "--part", "write", str(path), name)
            seconds = dict(zip(READERS, apart(*counts, "--part", "turns", str(path), name), strict=True))
            used = {reader: apart("--part", reader, str(path), name)[0] for reader in READERS}
            ratio = seconds["mascarin"] / seconds["pandas"]
            print(
                f"{name:12} {seconds['pandas']:7.2f} s {seconds['mascarin']:7.2f} s {ratio:6.2f}   "
                f"{used['pandas']:.2f} GB, {used['mascarin']:.2f} GB",
                flush=True,
            )
            failed |= ratio > LEAST or (name == "plain" and used["mascarin"] > MEMORY)
    print(f"ratio at most {LEAST:g}, {MEMORY:g} GB for the plain table")
    sys.exit(failed)


if __name__ == "__main__":
    main()
