"""Example files of EnergyPlus, converted and simulated, beside hourly results of EnergyPlus 25.2.

The files, with a README on each, lie in a folder ``peers/idf`` beside the data folder (MASCARIN_DATA); they
come from the repository NREL/Spawn, commit ab07bde9bbd6913d755fc3e429c660bdc4aecc0d, folder
``energyplus/testfiles``, with runs of the full year. EnergyPlus itself is not needed.

    python bench/energyplus_files.py [NAME ...] [--write docs/energyplus.md]
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

import mascarin as mc
from mascarin.energyplus import Conversion, convert

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("MASCARIN_DATA") or ROOT.parent / "shared" / "data")
FILES = DATA.parent / "peers" / "idf"
CHICAGO = "USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw"
WEATHER = {"VentilationSimpleTest": "USA_FL_Tampa.Intl.AP.722110_TMY3.epw"}
AIR, HEATING, COOLING = (
    "Zone Mean Air Temperature [C]",
    "Zone Air System Sensible Heating Energy [kWh]",
    "Zone Air System Sensible Cooling Energy [kWh]",
)


@dataclass(frozen=True)
class Row:
    """One zone: difference of its air temperature [K], and loads of both programs [kWh]."""

    zone: str
    rms: float
    mean: float
    worst: float
    heating: tuple[float, float] | None
    cooling: tuple[float, float] | None


def names() -> list[str]:
    """Names of the files."""
    return sorted(path.stem for path in FILES.glob("*.idf"))


def peer(name: str) -> pd.DataFrame:
    """Hourly results of EnergyPlus by column."""
    return pd.read_csv(FILES / f"{name}.csv.gz")


def simulated(name: str, conversion: Conversion) -> pd.DataFrame:
    """Hourly means of air temperatures [degC] and loads [kWh] by output, 8760 rows."""
    climate = mc.Climate.from_epw(DATA / "weather" / WEATHER.get(name, CHICAGO))
    building = conversion.building
    wanted = [f"{zone}.air_temperature" for zone in building.zones]
    for zone, described in building.zones.items():
        wanted += [f"{zone}.{which}_load" for which in described.loads]
    minutes = 60 // conversion.steps_per_hour
    run = mc.simulate(
        building,
        climate,
        start=conversion.start,
        end=conversion.end,
        step=f"{minutes}min",
        outputs=wanted,
    )
    assert run.energy.closes, f"{name}: the energy balance does not close"
    records = run.to_dataframe()
    # A record belongs to the step that ends there.
    records = records[1:] if len(records) % 8760 else records
    hourly = records.to_numpy().reshape(8760, -1, len(wanted)).mean(axis=1)
    found = pd.DataFrame(hourly, columns=list(records.columns))
    loads = [column for column in found.columns if column.endswith("_load")]
    found[loads] /= 1000.0
    return found


def compared(name: str) -> tuple[Conversion, list[Row]]:
    """A file converted, simulated and compared zone by zone."""
    conversion = convert(FILES / f"{name}.idf")
    ours, theirs = simulated(name, conversion), peer(name)
    rows = []
    for original, zone in conversion.names["zones"].items():
        key = original.upper()
        miss = ours[f"{zone}.air_temperature"].to_numpy() - theirs[f"{key}:{AIR}"].to_numpy()
        rows.append(
            Row(
                original,
                float(np.sqrt(np.mean(miss**2))),
                float(miss.mean()),
                float(np.abs(miss).max()),
                *(
                    (float(ours[f"{zone}.{which}_load"].sum()), float(theirs[f"{key}:{column}"].sum()))
                    if f"{zone}.{which}_load" in ours and f"{key}:{column}" in theirs
                    else None
                    for which, column in (("heating", HEATING), ("cooling", COOLING))
                ),
            )
        )
    return conversion, rows


def table(chosen: list[str]) -> str:
    """Rows of all zones as a table."""
    text = [
        "| file | zone | air temperature, rms | mean | largest | heating here and there | cooling |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in chosen:
        began = time.perf_counter()
        _, rows = compared(name)
        print(f"{name}: {time.perf_counter() - began:.1f} s", file=sys.stderr)
        for row in rows:
            loads = [
                "" if pair is None else f"{pair[0]:.0f}, {pair[1]:.0f} kWh ({_percent(*pair)})"
                for pair in (row.heating, row.cooling)
            ]
            text.append(
                f"| {name} | {row.zone} | {row.rms:.2f} K | {row.mean:+.2f} K | {row.worst:.1f} K | "
                f"{loads[0]} | {loads[1]} |"
            )
    return "\n".join(text)


def _percent(ours: float, theirs: float) -> str:
    return f"{100.0 * (ours / theirs - 1.0):+.1f} %" if theirs > 0.0 else "-"


def main() -> None:
    """Print the table, or write it into a page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--write", type=Path)
    given = parser.parse_args()
    found = table(given.names or names())
    if given.write is None:
        print(found)
        return
    page = given.write.read_text(encoding="utf-8")
    block = re.compile(r"(<!-- table: files -->\n).*?(<!-- end -->)", re.DOTALL)
    given.write.write_text(block.sub(lambda m: f"{m[1]}{found}\n{m[2]}", page), encoding="utf-8")


if __name__ == "__main__":
    main()
