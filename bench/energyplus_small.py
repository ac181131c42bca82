"""Small models of EnergyPlus, one feature each, in both programs: `tests/idf_small`.

The models are our own. Hourly air temperatures and monthly loads of EnergyPlus 25.2 lie beside them, in
``energyplus.npz``; EnergyPlus itself is needed only to make them again:

    python bench/energyplus_small.py [NAME ...]                       # the table
    python bench/energyplus_small.py --reference "COMMAND" [NAME ...]  # the results of EnergyPlus

COMMAND runs EnergyPlus 25.2 with three arguments: model, weather file, and a folder, where it leaves
``eplusout.csv``; such as a script with ``energyplus -r -w "$2" -d "$3" "$1"``.
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd

import mascarin as mc
from mascarin.energyplus import Conversion, convert
from mascarin.errors import MascarinError

ROOT = Path(__file__).resolve().parent.parent
SMALL = ROOT / "tests" / "idf_small"
RESULTS = "energyplus.npz"
DATA = Path(os.environ.get("MASCARIN_DATA") or ROOT.parent / "shared" / "data")
WEATHER = DATA / "weather" / "USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw"
AIR = "Zone Mean Air Temperature [C](Hourly)"
LOADS = {
    "heating": "Zone Air System Sensible Heating Energy [J](Hourly)",
    "cooling": "Zone Air System Sensible Cooling Energy [J](Hourly)",
}
HUMIDITY = "Zone Air Relative Humidity [%](Hourly)"
#: Resolution of the stored temperatures [K], and of the relative humidities [%].
STEP, HUMIDITY_STEP = 0.02, 0.1
_MONTHS = np.repeat(np.arange(12), [24 * days for days in (31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)])

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Zone:
    """Results of one zone over a year.

    Attributes
    ----------
    air : ndarray, shape (8760,)
        Hourly means of the air temperature. [degC]
    loads : dict of str to ndarray, shape (12,)
        Heating and cooling by month. [kWh]
    humidity : ndarray, shape (8760,), or None
        Hourly means of the relative humidity, where the model has vapour. [%]
    """

    air: Array
    loads: dict[str, Array]
    humidity: Array | None = None


def by_month(hourly: Array) -> Array:
    """Sums by month of 8760 values."""
    return np.bincount(_MONTHS, hourly, 12)


@cache
def _stored() -> dict[str, npt.NDArray[np.int32]]:
    with np.load(SMALL / RESULTS) as held:
        return {key: held[key] for key in held}


def reference(name: str) -> dict[str, Zone]:
    """Results of EnergyPlus by zone, in small letters; empty where EnergyPlus refuses the model."""
    zones = {}
    for key, values in _stored().items():
        file, zone, quantity = key.split("|")
        if file == name and quantity == "air":
            damp = _stored().get(f"{file}|{zone}|humidity")
            loads = {which: _stored().get(f"{file}|{zone}|{which}") for which in LOADS}
            zones[zone.casefold()] = Zone(
                np.cumsum(values.astype(float)) * STEP,
                {which: load / 100.0 for which, load in loads.items() if load is not None},
                None if damp is None else np.cumsum(damp.astype(float)) * HUMIDITY_STEP,
            )
    return zones


def names() -> list[str]:
    """Names of the models."""
    return sorted(path.stem for path in SMALL.glob("*.idf"))


def make(name: str, command: str) -> dict[str, npt.NDArray[np.int32]]:
    """Run EnergyPlus and return what is stored of a model; nothing where EnergyPlus refuses it."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = [*shlex.split(command), str(SMALL / f"{name}.idf"), str(WEATHER), folder]
        subprocess.run(  # noqa: S603 - the command of the user
            arguments, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        file = Path(folder) / "eplusout.csv"
        return packed(name, pd.read_csv(file)) if file.is_file() else {}


def packed(name: str, table: pd.DataFrame) -> dict[str, npt.NDArray[np.int32]]:
    """Hourly results as they are stored: differences of temperatures in steps, loads in 0.01 kWh."""
    # Several run periods stand one below the other: the first whole year counts.
    starts = table.index[table["Date/Time"].str.strip().str.startswith("01/01  01:00")]
    table = table[starts[0] : starts[0] + 8760] if len(starts) else table
    stored = {}
    for column in table.columns:
        zone, _, quantity = column.strip().partition(":")
        if quantity == AIR:
            steps = np.rint(table[column].to_numpy() / STEP).astype(np.int32)
            small = np.diff(steps, prepend=0)
            stored[f"{name}|{zone}|air"] = small
        if quantity == HUMIDITY:
            tenths = np.rint(table[column].to_numpy() / HUMIDITY_STEP).astype(np.int32)
            stored[f"{name}|{zone}|humidity"] = np.diff(tenths, prepend=0)
        for which, title in LOADS.items():
            if quantity == title and len(table) == 8760:
                monthly = by_month(table[column].to_numpy() / 3.6e6)
                if monthly.sum() > 0.0:
                    stored[f"{name}|{zone}|{which}"] = np.rint(100.0 * monthly).astype(np.int32)
    return stored


@cache
def _climate() -> mc.Climate:
    return mc.Climate.from_epw(WEATHER)


def simulated(conversion: Conversion, *, start: str = "", end: str = "") -> dict[str, Zone]:
    """Results of Mascarin by zone of the model, in small letters; a year, unless days are given."""
    building = conversion.building
    outputs = [f"{zone}.air_temperature" for zone in building.zones]
    for zone, described in building.zones.items():
        outputs += [f"{zone}.{which}_load" for which in described.loads]
        outputs += [f"{zone}.relative_humidity"] if building.humidity is not None else []
    run = mc.simulate(
        building,
        _climate(),
        start=start or f"{conversion.start[:4]}-01-01",
        end=end or f"{int(conversion.start[:4]) + 1}-01-01",
        step=f"{60 // conversion.steps_per_hour}min",
        outputs=outputs,
    )
    if not run.energy.closes:
        raise ValueError("the energy balance does not close")
    records = run.to_dataframe()
    hours = len(records) // conversion.steps_per_hour
    # A record belongs to the step that ends there.
    records = records[-hours * conversion.steps_per_hour :]
    hourly = dict(
        zip(records.columns, records.to_numpy().reshape(hours, -1, len(outputs)).mean(axis=1).T, strict=True)
    )
    return {
        original.casefold(): Zone(
            hourly[f"{zone}.air_temperature"],
            {
                which: by_month(hourly[f"{zone}.{which}_load"] / 1000.0)
                if hours == 8760
                else hourly[f"{zone}.{which}_load"] / 1000.0
                for which in LOADS
                if f"{zone}.{which}_load" in hourly
            },
            100.0 * hourly[f"{zone}.relative_humidity"] if building.humidity is not None else None,
        )
        for original, zone in conversion.names["zones"].items()
    }


def rows(name: str) -> list[str]:
    """Rows of the table: both programs for each zone, and what the list says."""
    theirs = reference(name)
    try:
        conversion = convert(SMALL / f"{name}.idf")
        ours = simulated(conversion)
    except MascarinError as error:
        return [f"| {name} | | | | | | refused: {str(error).splitlines()[0]} |"]
    listed = [
        f"{one.kind} {one.name}: {one.level}" for one in conversion.findings if one.level != "no effect"
    ]
    text = []
    for zone in theirs or ours:
        cells = ["", "", "", ""]
        if theirs and zone in ours and len(ours[zone].air) == len(theirs[zone].air):
            miss = ours[zone].air - theirs[zone].air
            cells[:2] = [f"{np.sqrt(np.mean(miss**2)):.2f} K", f"{miss.mean():+.2f} K"]
        for k, which in enumerate(LOADS, start=2):
            pair = [
                float(held[zone].loads[which].sum()) if zone in held and which in held[zone].loads else 0.0
                for held in (ours, theirs)
            ]
            if any(pair):
                percent = f" ({100.0 * (pair[0] / pair[1] - 1.0):+.1f} %)" if pair[1] else ""
                cells[k] = f"{pair[0]:.0f}, {pair[1]:.0f}{percent}"
        remark = "; ".join(listed) if theirs else "EnergyPlus refuses it"
        text.append(f"| {name} | {zone} | {' | '.join(cells)} | {remark} |")
    return text


def main() -> None:
    """Print the table, or make the results of EnergyPlus again."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--reference", metavar="COMMAND")
    arguments = parser.parse_args()
    chosen = arguments.names or names()
    if arguments.reference:
        held = dict(_stored()) if (SMALL / RESULTS).is_file() else {}
        for name in chosen:
            held = {key: values for key, values in held.items() if key.split("|")[0] != name}
            held |= make(name, arguments.reference)
            print(name, file=sys.stderr)
        np.savez_compressed(SMALL / RESULTS, **{key: held[key] for key in sorted(held)})
        return
    print("| model | zone | rms | mean | heating here and there [kWh] | cooling | listed |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name in chosen:
        print("\n".join(rows(name)), flush=True)


if __name__ == "__main__":
    main()
