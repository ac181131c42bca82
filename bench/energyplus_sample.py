"""Example files of EnergyPlus with ideal loads, a random 60 of them in both programs.

    python bench/energyplus_sample.py FOLDER RUNS --run "COMMAND" [--number 60] [NAME ...]
    python bench/energyplus_sample.py FOLDER RUNS --table [--write docs/energyplus.md]

FOLDER holds the files (``ExampleFiles`` of EnergyPlus 9.6). Their names are shuffled with the seed 44, and
the first 60 that have a building and that EnergyPlus runs are compared: each becomes a model of 25.2 with
ideal loads (``energyplus_ideal.py``), and runs two weeks from 1 January and two from 1 July of 2017 in
Chicago, in steps of 5 min, of which the second week counts.

COMMAND runs EnergyPlus 25.2 with three arguments: model, weather file, and a folder, where it leaves
``eplusout.csv``. RUNS keeps the models, the results of EnergyPlus and a line of JSON for each file, so that
an interrupted run goes on, and a run after a change of the conversion (with NAME, or without the lines)
needs no EnergyPlus.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import random
import shlex
import subprocess
import sys
import time
from datetime import date, timedelta
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from energyplus_ideal import prepared
from energyplus_small import WEATHER, Array

import mascarin as mc
from mascarin.energyplus import Conversion, convert
from mascarin.energyplus.comparison.run_folder import TITLES, rms
from mascarin.energyplus.comparison.series import may_lack_columns, read_series
from mascarin.energyplus.writing import level_lines
from mascarin.errors import InputError, MascarinError

SEED = 44
NUMBER = 60
STEPS = 12
DAYS = 14
RATED = 7
STARTS = {"winter": date(2017, 1, 1), "summer": date(2017, 7, 1)}
PERIODS = tuple((start, start + timedelta(days=DAYS - 1)) for start in STARTS.values())
#: Longest time of each program for one file [s].
LIMIT = 420
#: Close to EnergyPlus: difference of temperatures [K], of loads [%].
CLOSE = (0.3, 3.0)
#: A load below this share of both together is compared with that share.
SMALL_SHARE = 0.1
_OUTPUTS = {
    "air": "air_temperature",
    "heating": "heating_load",
    "cooling": "cooling_load",
    "sun": "transmitted_solar",
}
_HEAD = "<!-- table: sample -->"
_END = "<!-- end -->"


def order(folder: Path) -> list[Path]:
    """Files in the order in which they are tried."""
    files = sorted(folder.glob("*.idf"))
    random.Random(SEED).shuffle(files)
    return files


# ------------------------------------------------------------------ EnergyPlus


def run_energyplus(file: Path, folder: Path, command: str, steps: int = STEPS) -> str:
    """Prepare and run one model; why it cannot be compared, or nothing."""
    model = folder / "model.epJSON"
    if (folder / "eplusout.end").is_file() or (folder / "refused").is_file():
        return _refusal(folder)
    folder.mkdir(parents=True, exist_ok=True)
    try:
        preparation = prepared(file, WEATHER, PERIODS, steps)
    except Exception as error:  # files that the parser does not read, or that lack a name
        (folder / "refused").write_text(f"not prepared: {type(error).__name__}: {error}", encoding="utf-8")
        return _refusal(folder)
    if not preparation.model.get("Zone"):
        (folder / "refused").write_text("no zones", encoding="utf-8")
        return _refusal(folder)
    model.write_text(json.dumps(preparation.model, indent=1), encoding="utf-8")
    (folder / "dropped.json").write_text(json.dumps(preparation.dropped), encoding="utf-8")
    arguments = [*shlex.split(command), str(model), str(WEATHER), str(folder)]
    try:
        subprocess.run(  # noqa: S603 - the command of the user
            arguments, check=False, timeout=LIMIT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
    except subprocess.TimeoutExpired:
        (folder / "refused").write_text(f"EnergyPlus: longer than {LIMIT} s", encoding="utf-8")
    table = folder / "eplusout.csv"
    unread = ("mtr", "mtd", "audit", "bnd", "shd", "mdd", "rdd", "dxf")
    for name in unread if table.is_file() and may_lack_columns(table) else ("eso", *unread):
        (folder / f"eplusout.{name}").unlink(missing_ok=True)
    return _refusal(folder)


def _refusal(folder: Path) -> str:
    refused, table, errors = (folder / name for name in ("refused", "eplusout.csv", "eplusout.err"))
    if refused.is_file():
        return refused.read_text(encoding="utf-8")
    if table.is_file() and "Completed" in (folder / "eplusout.end").read_text(encoding="latin-1"):
        return ""
    text = errors.read_text(encoding="latin-1") if errors.is_file() else ""
    lines = [line.strip(" *") for line in text.splitlines() if "** Severe" in line or "**  Fatal" in line]
    return "EnergyPlus: " + (lines[0] if lines else "no results")


# ------------------------------------------------------------------ Mascarin


@cache
def _climate() -> mc.Climate:
    return mc.Climate.from_epw(WEATHER)


def _simulated(conversion: Conversion, start: date) -> dict[tuple[str, str], Array]:
    """Hourly values of the week that counts, by quantity and zone of the model in capitals."""
    available, steps = {output.name for output in conversion.building.outputs()}, conversion.steps_per_hour
    names = {
        (quantity, original.upper()): f"{zone}.{kind}"
        for original, zone in conversion.names["zones"].items()
        for quantity, kind in _OUTPUTS.items()
        if f"{zone}.{kind}" in available
    }
    run = mc.simulate(
        conversion.building,
        _climate(),
        start=start.isoformat(),
        end=(start + timedelta(days=DAYS)).isoformat(),
        step=f"{60 // steps}min",
        outputs=list(names.values()),
    )
    if not run.energy.closes:
        raise ValueError("the energy balance does not close")
    records = np.asarray(run.records)[-RATED * 24 * steps :].reshape(RATED * 24, steps, -1).mean(axis=1)
    columns = {output.name: k for k, output in enumerate(run.outputs)}
    return {key: records[:, columns[name]] for key, name in names.items()}


def compared(name: str, folder: Path) -> dict[str, Any]:
    """Both programs for one model."""
    began = time.perf_counter()
    row: dict[str, Any] = {"name": name}
    try:
        conversion = convert(folder / "model.epJSON", weather=WEATHER)
        row["listed"] = [f"left out: {line}" for line in level_lines(conversion, "left out")]
        row["listed"] += [f"other form: {line}" for line in level_lines(conversion, "approximated")]
        titles = frozenset(title for group in TITLES.values() for title in group)
        periods = read_series(folder, titles)
        ours: list[dict[tuple[str, str], Array]] = []
        theirs: list[dict[tuple[str, str], Array]] = []
        for period, (start, last) in zip(periods, PERIODS, strict=True):
            if period.days != (f"{start:%m-%d}", f"{last:%m-%d}"):
                raise ValueError(f"results of {period.days}: remove {folder}, and run again")
            ours.append(_simulated(conversion, start))
            theirs.append(
                {
                    (quantity, key): values[-RATED * 24 :] / (3600.0 if title.endswith("[J]") else 1.0)
                    for quantity, group in TITLES.items()
                    for title in group
                    for (which, key), values in period.series.items()
                    if which == title
                }
            )
        row |= _row(ours, theirs)
    except MascarinError as error:
        row |= {"error": str(error)[:600]}
    except Exception as error:  # what a user would see as a defect
        row |= {"error": f"{type(error).__name__}: {error}"[:600]}
    return row | {"seconds": round(time.perf_counter() - began, 1)}


def _row(
    ours: list[dict[tuple[str, str], Array]], theirs: list[dict[tuple[str, str], Array]]
) -> dict[str, Any]:
    """Differences of the air by zone [K], and heat of both programs [kWh] by quantity and season."""
    zones = sorted(key for quantity, key in ours[0] if quantity == "air" and ("air", key) in theirs[0])
    if not zones:
        raise InputError("found no zone in both programs; expected the same zones")
    air = {}
    for zone in zones:
        miss = [first["air", zone] - second["air", zone] for first, second in zip(ours, theirs, strict=True)]
        air[zone] = {
            "rms": round(rms(np.concatenate(miss)), 4),
            "mean": [round(float(part.mean()), 4) for part in miss],
        }
    sums: dict[str, Any] = {}
    for quantity in ("heating", "cooling", "sun"):
        sums[quantity] = [
            [
                round(
                    sum(float(held[quantity, zone].sum()) for zone in zones if (quantity, zone) in held)
                    / 1e3,
                    3,
                )
                for held in pair
            ]
            for pair in zip(ours, theirs, strict=True)
        ]
        by_zone = {}
        for zone in zones:
            pair = [
                sum(float(held[quantity, zone].sum()) for held in side if (quantity, zone) in held) / 1e3
                for side in (ours, theirs)
            ]
            if any(pair):
                by_zone[zone] = [round(value, 3) for value in pair]
        sums[f"{quantity} by zone"] = by_zone
    return {"air": air, **sums}


# ------------------------------------------------------------------ table


def loads(row: dict[str, Any]) -> dict[str, tuple[float, float, float]]:
    """Heating and cooling of both programs [kWh], and their difference [%]."""
    sums = {
        which: tuple(sum(pair[k] for pair in row[which]) for k in (0, 1)) for which in ("heating", "cooling")
    }
    least = SMALL_SHARE * sum(pair[1] for pair in sums.values())
    return {
        which: (first, second, 100.0 * (first - second) / max(second, least, 1e-3))
        for which, (first, second) in sums.items()
    }


def worst(row: dict[str, Any]) -> tuple[str, float]:
    """The zone with the largest difference of its air. [K]"""
    zone = max(row["air"], key=lambda key: row["air"][key]["rms"])
    return zone, float(row["air"][zone]["rms"])


def close(row: dict[str, Any]) -> bool:
    """Whether all zones and both loads are close to EnergyPlus."""
    if "error" in row:
        return False
    percents = [abs(percent) for _, _, percent in loads(row).values()]
    return worst(row)[1] <= CLOSE[0] and max(percents) <= CLOSE[1]


def table(rows: list[dict[str, Any]]) -> str:
    """Rows of the table, worst first."""
    good = [row for row in rows if "error" not in row]
    good.sort(
        key=lambda row: (
            -max(worst(row)[1] / CLOSE[0], *(abs(p) / CLOSE[1] for _, _, p in loads(row).values()))
        )
    )
    lines = [
        "| file | zones | worst zone | middle zone | heating | cooling |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    lines += [f"| {row['name']} | | {row['error'].splitlines()[0]} | | | |" for row in rows if "error" in row]
    for row in good:
        spread = [held["rms"] for held in row["air"].values()]
        zone, most = worst(row)
        cells = [
            "" if first == second == 0.0 else f"{second:.0f} kWh, {percent:+.1f} %"
            for first, second, percent in loads(row).values()
        ]
        lines.append(
            f"| {row['name']} | {len(spread)} | {zone}: {most:.2f} K | {np.median(spread):.2f} K | "
            f"{' | '.join(cells)} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Compare the files, or print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("runs", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--run", metavar="COMMAND", default="")
    parser.add_argument("--number", type=int, default=NUMBER)
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--write", type=Path)
    parser.add_argument("--steps", type=int, default=STEPS, help="steps in an hour; with RUNS of their own")
    options = parser.parse_intermixed_args()
    rows = _compare(options) if not options.table else _held(options.runs)
    chosen = [row for row in rows.values() if "skipped" not in row]
    text = table(chosen)
    print(text)
    skipped = len(rows) - len(chosen)
    print(f"{sum(map(close, chosen))} of {len(chosen)} close; {skipped} files passed over", file=sys.stderr)
    if options.write is not None:
        page = options.write.read_text(encoding="utf-8")
        before, _, rest = page.partition(_HEAD)
        _, _, after = rest.partition(_END)
        options.write.write_text(f"{before}{_HEAD}\n{text}\n{_END}{after}", encoding="utf-8")


def _held(runs: Path) -> dict[str, dict[str, Any]]:
    """Lines of earlier runs; the last one of each file counts."""
    file = runs / "rows.jsonl"
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    return {row["name"]: row for row in map(json.loads, lines)}


def _compare(options: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """Compare files in their order until there are enough."""
    options.runs.mkdir(parents=True, exist_ok=True)
    _climate()  # for all processes
    rows = _held(options.runs)
    count = 0
    for file in order(options.folder):
        if options.names:
            if file.stem not in options.names:
                continue
        elif file.stem in rows:
            count += "skipped" not in rows[file.stem]
            if count == options.number:
                break
            continue
        reason = run_energyplus(file, options.runs / file.stem, options.run, options.steps)
        row = (
            {"name": file.stem, "skipped": reason}
            if reason
            else _separately(file.stem, options.runs / file.stem)
        )
        rows[file.stem] = row
        with (options.runs / "rows.jsonl").open("a", encoding="utf-8") as target:
            target.write(json.dumps(row) + "\n")
        print(_said(row), file=sys.stderr, flush=True)
        count += not reason
        if count == options.number and not options.names:
            break
    return rows


def _separately(name: str, folder: Path) -> dict[str, Any]:
    """The comparison in a process of its own, which a limit of time ends."""
    context = multiprocessing.get_context("fork")
    theirs, ours = context.Pipe(duplex=False)
    process = context.Process(target=lambda: ours.send(compared(name, folder)))
    process.start()
    ours.close()
    row = {"name": name, "error": f"Mascarin: longer than {LIMIT} s"}
    if theirs.poll(LIMIT):
        try:
            row = dict(theirs.recv())
        except EOFError:
            row["error"] = "Mascarin ends without results"
    process.kill()
    process.join()
    return row


def _said(row: dict[str, Any]) -> str:
    if "skipped" in row:
        return f"{row['name']}: passed over: {row['skipped'][:120]}"
    if "error" in row:
        return f"{row['name']}: {row['error'][:200]}"
    percents = ", ".join(f"{which} {percent:+.1f} %" for which, (_, _, percent) in loads(row).items())
    return f"{row['name']}: {worst(row)[1]:.2f} K in {worst(row)[0]}, {percents}, {row['seconds']} s"


if __name__ == "__main__":
    main()
