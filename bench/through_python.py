"""Times for the user: runs, derivatives and ensembles by pytest-benchmark, the command line by hyperfine.

The command runs the shipped description of the LGI cell in the shipped weather, written as a year of EPW.
An EPW file has no temperature of the slab: the slab is on ground of a constant temperature. The time is
that from the start of Python to the printed result.

    python bench/through_python.py [--hyperfine PATH] [--days 92] [--write docs/speed.md]
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import cell
import page
import pandas as pd
from engine_speed import MODELS

import energyplus
from mascarin.examples import FOLDER

HERE = Path(__file__).resolve().parent
ASKED_DAYS = 92
ASKED_RUN, ASKED_COMMAND = {"constant": 8.0}, 0.7  # ms, s
HEAD = ("model", "one run", "asked", "members/s", "asked", "Jacobian / run", "gradient", "gradient / run")


def benchmarked(days: int) -> dict[tuple[str, str], dict[str, Any]]:
    """Times of pytest-benchmark, by kind of work and model."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found.json"
        command = [sys.executable, "-m", "pytest", str(HERE / "test_speed.py"), "--quiet"]
        command += ["--benchmark-timer=time.process_time", f"--benchmark-json={file}"]
        environment = {**os.environ, "RAYON_NUM_THREADS": "1", "MASCARIN_BENCH_DAYS": str(days)}
        subprocess.run(command, env=environment, check=True, stdout=sys.stderr)  # noqa: S603
        found = json.loads(file.read_text(encoding="utf-8"))["benchmarks"]
    return {(one["name"].split("[")[0].removeprefix("test_"), one["param"]): one for one in found}


def rows(found: dict[tuple[str, str], dict[str, Any]], whole: bool) -> list[list[str]]:
    """A row for each model, with the required time of the whole period."""
    lines = []
    for name, model in MODELS.items():
        run, many, jacobian, gradient = (
            found[what, name]["stats"] for what in ("run", "ensemble", "jacobian", "gradient")
        )
        members = found["ensemble", name]["extra_info"]["members"]
        asked = ASKED_RUN.get(name) if whole else None
        lines.append([
            model.name,
            f"{1e3 * run['min']:.1f} ms",
            "" if asked is None else f"{asked:g} ms",
            f"{members / many['min']:.0f}",
            f"{model.asked:.0f}" if whole and model.asked else "",
            f"{jacobian['min'] / run['min']:.1f}",
            f"{1e3 * gradient['min']:.0f} ms",
            f"{gradient['min'] / run['min']:.1f}",
        ])  # fmt: skip
    return lines


def year_of_weather(file: Path) -> None:
    """Write the shipped weather as an EPW file of a year; the 92 days are repeated."""
    energyplus.write_weather(file, cell.climate(cell.table()), cell.building(), cell.START, cell.END, 1)
    lines = file.read_text(encoding="ascii").splitlines()
    head, records = [*lines[:7], "DATA PERIODS,1,1,Data,Friday,1/1,12/31"], lines[8:]
    hours = pd.date_range("2010-01-01", "2010-12-31 23:00", freq="h")
    first = hours.get_loc(pd.Timestamp(cell.START))
    for k, hour in enumerate(hours):
        values = records[(k - first) % len(records)].split(",")[5:]
        head.append(",".join([f"{hour:%Y},{hour.month},{hour.day},{hour.hour + 1},60", *values]))
    file.write_text("\n".join(head) + "\n", encoding="ascii")


def command_line(hyperfine: str, days: int) -> str:
    """Time of the command, by the clock."""
    end = f"{pd.Timestamp(cell.START) + pd.Timedelta(days=days):%Y-%m-%d}"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        described = (FOLDER / "lgi" / "building.yaml").read_text(encoding="utf-8")
        assert "measured: slab_underside" in described
        building, weather, found = folder / "lgi.yaml", folder / "lgi.epw", folder / "found.json"
        grounded = described.replace("measured: slab_underside", "ground: {mean: 22.5}")
        building.write_text(grounded, encoding="utf-8")
        year_of_weather(weather)
        words = [str(Path(sys.executable).with_name("mascarin")), "run", str(building)]
        words += ["--weather", str(weather), "--start", cell.START, "--end", end]
        call = [hyperfine, "--shell=none", "--warmup=2", "--runs=10", f"--export-json={found}"]
        subprocess.run([*call, shlex.join(words)], check=True, stdout=sys.stderr)  # noqa: S603
        taken = json.loads(found.read_text(encoding="utf-8"))["results"][0]
    return (
        f"Command line, `mascarin run` over {days} days, start to result: "
        f"{taken['mean']:.2f} ± {taken['stddev']:.2f} s by the clock, "
        f"{taken['user'] + taken['system']:.2f} s of processor time (asked: {ASKED_COMMAND} s)."
    )


def main() -> None:
    """Measure and print."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--hyperfine", default=shutil.which("hyperfine"), help="the program")
    options.add_argument("--days", type=int, default=92)
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    given = options.parse_args()
    text = page.table(HEAD, rows(benchmarked(given.days), given.days == ASKED_DAYS))
    note = f"{page.conditions(given.days)}; one thread, processor time, shortest of some repetitions."
    if given.hyperfine is None:
        line = "The command line was not timed: hyperfine is not at hand."
    else:
        line = command_line(given.hyperfine, given.days)
    page.publish("python", f"{text}\n\n{note}\n{line}", given.write)


if __name__ == "__main__":
    main()
