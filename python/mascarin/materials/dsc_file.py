"""Read a calorimeter file: its columns, heating and cooling, everything as apparent specific heat."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin._io.tables import csv_refused
from mascarin.errors import InputError
from mascarin.materials.units import OF_SAMPLE, UNITS, Column, check_unit, column_of, plain_unit, to_celsius

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

LEAST_ROWS: Final = 10
#: Larger numbers are no measurement in any unit: water has 4e6 J/(kg K) at its sharpest peaks.
LARGEST: Final = 1e9
SIGNALS: Final = ("heat flow", "specific heat", "enthalpy")


@dataclass(frozen=True)
class Scan:
    """One run of the calorimeter.

    Attributes
    ----------
    direction : str
        ``heating`` or ``cooling``.
    temperature : ndarray, shape (N,)
        Rising [degC].
    heat : ndarray, shape (N,)
        Apparent specific heat; about 0 beside the peak where the baseline was subtracted [J/(kg K)].
    rate : float or None
        Heating rate, positive [K/min]; None where it is not known.
    column : Column
        Column of the signal.
    factor : float
        From the unit of the file to SI.
    remarks : tuple of str
        Decisions that were made while reading.
    place : str
        File, and line of the names of its columns.
    """

    direction: str
    temperature: Array
    heat: Array
    rate: float | None
    column: Column
    factor: float
    remarks: tuple[str, ...]
    place: str


@dataclass(frozen=True)
class Settings:
    """What the user gives because the file does not contain it.

    Attributes
    ----------
    unit : str or None
        Unit of the signal.
    rate : float or None
        Heating rate [K/min].
    mass : float or None
        Mass of the sample [mg].
    """

    unit: str | None = None
    rate: float | None = None
    mass: float | None = None


def read(path: Path, settings: Settings) -> list[Scan]:
    """Read the runs of a file.

    Raises
    ------
    InputError
        The file, a column, a unit or the order of the rows cannot be used.
    """
    names, table, line = _table(path)
    # The line of the names of the columns.
    place = f"{path}:{line}"
    columns = [column for k, name in enumerate(names) if (column := column_of(k, name)) is not None]
    if settings.unit is not None:
        columns = [_with_unit(column, settings.unit) for column in columns]
    for column in columns:
        check_unit(column, place)
    temperature = _one(columns, "temperature", names, place)
    signals = [column for column in columns if column.quantity in SIGNALS]
    if not signals:
        raise InputError(
            f"{place}: found the columns {', '.join(names)}; expected a signal such as 'cp [J/(g K)]', "
            "'DSC/(mW/mg)' or 'enthalpy [J/g]'"
        )
    quantities = dict.fromkeys(column.quantity for column in signals)
    if len(quantities) > 1:
        raise InputError(
            f"{place}: found {' and '.join(quantities)}; expected one of them. Remove the others"
        )
    scans = []
    for signal in signals:
        scans += _runs(place, table, columns, temperature, signal, settings)
    directions = [scan.direction for scan in scans]
    for direction in ("heating", "cooling"):
        if directions.count(direction) > 1:
            raise InputError(
                f"{place}: found {directions.count(direction)} runs of {direction}; expected one. Keep the "
                "run that is meant (often the second heating)"
            )
    return scans


def _with_unit(column: Column, unit: str) -> Column:
    if column.quantity not in SIGNALS:
        return column
    meant = plain_unit(unit)
    quantity = next((key for key in SIGNALS if meant in UNITS[key]), None)
    if quantity is None:
        known = ", ".join(unit for key in SIGNALS for unit in UNITS[key])
        raise InputError(f"unit: found '{unit}'; expected one of {known}")
    return Column(column.index, column.name, quantity, meant, column.direction)


def _table(path: Path) -> tuple[list[str], list[list[str]], int]:
    """Names of the columns, the rows below, and the line of the names."""
    try:
        raw = require_regular(path, "a DSC file as CSV").read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected a DSC file as CSV") from None
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    numbered = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [line for _, line in numbered]
    head = next((k for k, line in enumerate(lines) if _is_head(line, lines[k + 1 : k + 2])), None)
    if head is None:
        raise InputError(
            f"{path}: found no line of column names above numbers; expected a first line such as "
            "'temperature [degC],cp [J/(g K)]'"
        )
    separator = _separator(lines[head + 1])
    with csv_refused(str(path)):
        rows = list(csv.reader(io.StringIO("\n".join(lines[head:])), delimiter=separator))
    return [name.strip().lstrip("#").strip() for name in rows[0]], rows[1:], numbered[head][0]


def _is_head(line: str, following: list[str]) -> bool:
    return bool(following) and not _starts_with_number(line) and _starts_with_number(following[0])


def _starts_with_number(line: str) -> bool:
    return re.match(r'^\s*"?[-+]?[\d.,]*\d', line) is not None


def _separator(line: str) -> str:
    return next((one for one in (";", "\t", ",") if one in line), ",")


def _one(columns: list[Column], quantity: str, names: list[str], place: str) -> Column:
    found = [column for column in columns if column.quantity == quantity]
    if len(found) != 1:
        raise InputError(
            f"{place}: found {len(found)} columns of {quantity} among {', '.join(names)}; expected one, "
            f"such as '{quantity} [{'degC' if quantity == 'temperature' else '...'}]'"
        )
    return found[0]


def _runs(
    place: str, table: list[list[str]], columns: list[Column], temperature: Column, signal: Column,
    settings: Settings,
) -> list[Scan]:  # fmt: skip
    """The runs in one column of the signal."""
    time = next((column for column in columns if column.quantity == "time"), None)
    label = next((column for column in columns if column.quantity == "direction"), None)
    wanted = [temperature, signal, *([time] if time else [])]
    rows, labels = [], []
    for number, row in enumerate(table, start=2):
        if signal.index >= len(row) or not row[signal.index].strip():
            continue  # columns for heating and for cooling may have different lengths
        rows.append([_number(row, column, number, place) for column in wanted])
        labels.append(row[label.index].strip().casefold() if label else "")
    if len(rows) < LEAST_ROWS:
        raise InputError(
            f"{place}: column '{signal.name}': found {len(rows)} rows; expected at least {LEAST_ROWS}"
        )
    values = np.array(rows, dtype=np.float64)
    values[:, 0] = to_celsius(values[:, 0].tolist(), temperature, place)
    return [
        _scan(place, values[first:last], direction, signal, time, settings)
        for first, last, direction in _segments(values[:, 0], labels, signal, place)
    ]


def _number(row: list[str], column: Column, number: int, place: str) -> float:
    text = row[column.index].strip() if column.index < len(row) else ""
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = float("nan")
    if not abs(value) <= LARGEST:  # NaN, too
        raise InputError(
            f"{place}: row {number}, column '{column.name}': found '{text}'; expected a number of at most "
            f"{LARGEST:g}. Correct the row or remove it"
        )
    return value


def _segments(
    temperature: Array, labels: list[str], signal: Column, place: str
) -> list[tuple[int, int, str]]:
    """First and last row of each run, and its direction."""
    if signal.direction is not None:
        return [(0, len(temperature), signal.direction)]
    if any(labels):
        return _labelled(labels, place)
    turn = _turning_point(temperature, place)
    if turn in (0, len(temperature) - 1):
        direction = "heating" if temperature[-1] > temperature[0] else "cooling"
        return [(0, len(temperature), direction)]
    first = "heating" if temperature[turn] > temperature[0] else "cooling"
    second = "cooling" if first == "heating" else "heating"
    return [(0, turn + 1, first), (turn, len(temperature), second)]


def _labelled(labels: list[str], place: str) -> list[tuple[int, int, str]]:
    segments, first = [], 0
    for k in range(1, len(labels) + 1):
        if k < len(labels) and labels[k] == labels[first]:
            continue
        direction = next((one for one in ("heating", "cooling") if labels[first].startswith(one[:4])), None)
        if direction is None:
            raise InputError(f"{place}: found the direction '{labels[first]}'; expected heating or cooling")
        segments.append((first, k, direction))
        first = k
    return segments


def _turning_point(temperature: Array, place: str) -> int:
    """Row at which heating changes to cooling or cooling to heating; the first or last if it does not."""
    total = abs(temperature[-1] - temperature[0])
    top, bottom = int(np.argmax(temperature)), int(np.argmin(temperature))
    turn = top if temperature[top] - max(temperature[0], temperature[-1]) > 0.02 * np.ptp(temperature) else 0
    if min(temperature[0], temperature[-1]) - temperature[bottom] > 0.02 * np.ptp(temperature):
        turn = bottom
    way = np.abs(np.diff(temperature)).sum()
    expected = (
        total
        if turn == 0
        else abs(temperature[turn] - temperature[0]) + abs(temperature[-1] - temperature[turn])
    )
    if way > 1.2 * expected:
        jump = int(np.argmax(np.abs(np.diff(temperature))))
        raise InputError(
            f"{place}: row {jump + 3}: found {temperature[jump + 1]:.2f} degC after "
            f"{temperature[jump]:.2f} degC; expected temperatures in the order of the run: rising, "
            "falling, or one after the other. Restore the order, or put heating and cooling into "
            "different columns"
        )
    return turn


def _scan(
    place: str, values: Array, direction: str, signal: Column, time: Column | None, settings: Settings
) -> Scan:
    rate = _rate(values, time) or settings.rate
    remarks = []
    order = np.argsort(values[:, 0], kind="stable")
    t, raw = values[order, 0], values[order, 1]
    t, raw = _merged(t, raw)
    if len(t) < LEAST_ROWS:
        raise InputError(f"{place}: {direction}: found {len(t)} temperatures; expected at least {LEAST_ROWS}")
    factor, remark = _factor(signal, raw, t, settings, rate, place)
    remarks += [remark] if remark else []
    if signal.quantity == "enthalpy":
        heat = np.gradient(raw * factor, t)
        if heat.mean() < 0.0:
            raise InputError(
                f"{place}: column '{signal.name}': found an enthalpy that falls with temperature; expected "
                "it to rise. Change its sign"
            )
    else:
        heat = raw * factor
    if signal.quantity == "heat flow" and _upside_down(heat):
        heat = -heat
        remarks.append(f"{direction}: the peak points down: sign changed, heat taken up is positive")
    return Scan(direction, t, heat, rate, signal, factor, tuple(remarks), place)


def _upside_down(heat: Array) -> bool:
    largest = heat[np.argmax(np.abs(heat - np.median(heat)))]
    return bool(largest < np.median(heat)) and bool(largest < 0.0)


def _merged(t: Array, raw: Array) -> tuple[Array, Array]:
    """The mean of rows with the same temperature."""
    unique, where = np.unique(np.round(t, 6), return_inverse=True)
    count = np.bincount(where)
    return unique, np.bincount(where, weights=raw) / count


def _rate(values: Array, time: Column | None) -> float | None:
    if time is None:
        return None
    seconds = values[:, 2] * UNITS["time"][time.unit or "s"]
    slopes = np.abs(np.diff(values[:, 0])) / np.maximum(np.abs(np.diff(seconds)), 1e-12)
    return float(np.median(slopes) * 60.0)


def _factor(
    signal: Column, raw: Array, t: Array, settings: Settings, rate: float | None, place: str
) -> tuple[float, str]:
    """Factor to J/(kg K) or J/kg, and what was assumed where the file has no unit."""
    unit, remark = signal.unit, ""
    if unit is None:
        if signal.quantity == "heat flow":
            raise InputError(
                f"{place}: column '{signal.name}': found no unit; expected one in its name, such as "
                f"'{signal.name} [mW/mg]', or unit="
            )
        slope = np.gradient(raw, t) if signal.quantity == "enthalpy" else raw
        grams = float(np.median(np.abs(slope))) < 100.0
        unit = {"specific heat": ("j/kgk", "j/gk"), "enthalpy": ("j/kg", "j/g")}[signal.quantity][grams]
        remark = f"column '{signal.name}' has no unit: {unit} assumed by the size of its numbers"
    factor = UNITS[signal.quantity][unit]
    if signal.quantity != "heat flow":
        return factor, remark
    if rate is None:
        raise InputError(
            f"{place}: column '{signal.name}': found a heat flow and no heating rate; expected a column of "
            "time, or rate= in K/min"
        )
    if unit in OF_SAMPLE:
        if settings.mass is None:
            raise InputError(
                f"{place}: column '{signal.name}': found a heat flow of the whole sample; expected its mass, "
                "mass= in mg"
            )
        factor /= settings.mass * 1e-6
    return factor * 60.0 / rate, remark
