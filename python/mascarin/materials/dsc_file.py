"""Read a calorimeter file: its columns, heating and cooling, everything as apparent specific heat."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin.errors import InputError
from mascarin.materials.dsc_course import Course, course_of
from mascarin.materials.dsc_formats import Export, export_of
from mascarin.materials.dsc_segments import recalescence, segments_of, supercooling
from mascarin.materials.units import (
    OF_SAMPLE,
    UNITS,
    DscColumn,
    check_unit,
    column_of,
    plain_unit,
    to_celsius,
)
from mascarin.tables.reading.layout import decoded

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

LEAST_ROWS: Final = 10
#: Larger numbers are no measurement in any unit: water has 4e6 J/(kg K) at its sharpest peaks.
LARGEST: Final = 1e9
_SAMPLE: Final = re.compile(r"sample|probe", re.IGNORECASE)
_BASELINE: Final = re.compile(r"baseline", re.IGNORECASE)
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
    column : DscColumn
        Column of the signal.
    factor : float
        From the unit of the file to SI.
    remarks : tuple of str
        Decisions that were made while reading.
    place : str
        File, and line of the names of its columns.
    freezing : (float, float) or None
        Temperature at which a supercooled sample begins to freeze [degC], and rise from there [K].
    course : Course or None
        Temperature and enthalpy over time, where the file has a heat flow and a time.
    """

    direction: str
    temperature: Array
    heat: Array
    rate: float | None
    column: DscColumn
    factor: float
    remarks: tuple[str, ...]
    location: str
    freezing: tuple[float, float] | None = None
    course: Course | None = None


@dataclass(frozen=True)
class DscSettings:
    """What the user gives because the file does not contain it.

    Attributes
    ----------
    unit : str or None
        Unit of the signal.
    rate : float or None
        Heating rate [K/min].
    mass : float or None
        Mass of the sample [mg].
    segments : tuple of str
        Labels of the segments that are used; empty: all that heat or cool.
    """

    unit: str | None = None
    rate: float | None = None
    mass: float | None = None
    segments: tuple[str, ...] = ()


def read(path: Path, settings: DscSettings) -> list[Scan]:
    """Read the runs of a file.

    Raises
    ------
    InputError
        The file, a column, a unit or the order of the rows cannot be used.
    """
    export = _export(path)
    names, table = export.names, export.rows
    # The line of the names of the columns.
    location = f"{path}:{export.line}"
    settings = _with_mass(settings, export.mass, location)
    columns = [column for k, name in enumerate(names) if (column := column_of(k, name)) is not None]
    if settings.unit is not None:
        columns = [_with_unit(column, settings.unit) for column in columns]
    for column in columns:
        check_unit(column, location)
    temperature = _only_column(columns, "temperature", names, location)
    signals = [column for column in columns if column.quantity in SIGNALS]
    if not signals:
        raise InputError(
            f"{location}: found the columns {', '.join(names)}; expected a signal such as 'cp [J/(g K)]', "
            "'DSC/(mW/mg)' or 'enthalpy [J/g]'"
        )
    signals = [column for column in signals if not _BASELINE.search(column.name)] or signals
    quantities = dict.fromkeys(column.quantity for column in signals)
    if len(quantities) > 1:
        raise InputError(
            f"{location}: found {' and '.join(quantities)}; expected one of them. Remove the others"
        )
    per_mass = [column for column in signals if column.unit not in OF_SAMPLE]
    if per_mass and len(per_mass) < len(signals):
        signals = per_mass  # the same heat flow, of the sample and of its mass
    scans = []
    for signal in signals:
        scans += _runs(location, table, columns, temperature, signal, settings, export.exothermal_up)
    directions = [scan.direction for scan in scans]
    for direction in ("heating", "cooling"):
        if directions.count(direction) > 1:
            raise InputError(
                f"{location}: found {directions.count(direction)} runs of {direction}; expected one. Name "
                "the "
                "segment that is meant, often the second heating (--segment 5; in Python segments=['5']), or "
                "keep its rows alone"
            )
    return scans


def _with_mass(settings: DscSettings, mass: float | None, location: str) -> DscSettings:
    """The settings with the mass of the sample that the file states.

    Raises
    ------
    InputError
        The user states another one.
    """
    if mass is None or settings.mass is None:
        return settings if mass is None else replace(settings, mass=mass)
    if abs(settings.mass - mass) > 0.01 * mass:
        raise InputError(
            f"{location}: found mass={settings.mass:g} mg, but the file states {mass:g} mg; expected the "
            "same. Leave the mass out to use that of the file, or correct the file"
        )
    return settings


def _with_unit(column: DscColumn, unit: str) -> DscColumn:
    if column.quantity not in SIGNALS:
        return column
    meant = plain_unit(unit)
    quantity = next((key for key in SIGNALS if meant in UNITS[key]), None)
    if quantity is None:
        units = ", ".join(unit for key in SIGNALS for unit in UNITS[key])
        raise InputError(f"unit: found '{unit}'; expected one of {units}")
    return DscColumn(column.index, column.name, quantity, meant, column.direction)


def _export(path: Path) -> Export:
    """The file as text, with its names, rows and facts."""
    try:
        raw = require_regular(path, "a DSC file as CSV").read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected a DSC file as CSV") from None
    return export_of(decoded(raw, str(path))[0], str(path))


def _only_column(columns: list[DscColumn], quantity: str, names: list[str], location: str) -> DscColumn:
    candidates = [column for column in columns if column.quantity == quantity]
    if len(candidates) > 1:
        # PerkinElmer and Setaram give the temperature of the program or furnace, too.
        candidates = [column for column in candidates if _SAMPLE.search(column.name)] or candidates
    if len(candidates) != 1:
        raise InputError(
            f"{location}: found {len(candidates)} columns of {quantity} among {', '.join(names)}; expected "
            f"one, such as '{quantity} [{'degC' if quantity == 'temperature' else '...'}]'"
        )
    return candidates[0]


def _runs(
    location: str, table: list[list[str]], columns: list[DscColumn], temperature: DscColumn,
    signal: DscColumn, settings: DscSettings, exothermal_up: bool | None,
) -> list[Scan]:  # fmt: skip
    """The runs in one column of the signal."""
    time = next((column for column in columns if column.quantity == "time"), None)
    label = next((column for column in columns if column.quantity == "direction"), None)
    needed = [temperature, signal, *([time] if time else [])]
    rows, labels = [], []
    for number, row in enumerate(table, start=2):
        if signal.index >= len(row) or not row[signal.index].strip():
            continue  # columns for heating and for cooling may have different lengths
        rows.append([_number(row, column, number, location) for column in needed])
        labels.append(row[label.index].strip().casefold() if label else "")
    if len(rows) < LEAST_ROWS:
        raise InputError(
            f"{location}: column '{signal.name}': found {len(rows)} rows; expected at least {LEAST_ROWS}"
        )
    values = np.array(rows, dtype=np.float64)
    values[:, 0] = to_celsius(values[:, 0].tolist(), temperature, location)
    segments, held = segments_of(values[:, 0], labels, signal, settings.segments, location)
    remarks = [f"{held} rows at a constant temperature were left out"] if held else []
    return [
        _scan(location, values[first:last], direction, signal, time, settings, exothermal_up, remarks)
        for first, last, direction in segments
    ]


def _number(row: list[str], column: DscColumn, number: int, location: str) -> float:
    text = row[column.index].strip() if column.index < len(row) else ""
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = float("nan")
    if not abs(value) <= LARGEST:  # NaN, too
        raise InputError(
            f"{location}: row {number}, column '{column.name}': found '{text}'; expected a number of at most "
            f"{LARGEST:g}. Correct the row or remove it"
        )
    return value


def _scan(
    location: str, values: Array, direction: str, signal: DscColumn, time: DscColumn | None,
    settings: DscSettings, exothermal_up: bool | None, said: list[str],
) -> Scan:  # fmt: skip
    rate = _rate(values, time) or settings.rate
    remarks = [*said, *supercooling(values[:, 0], direction)]
    order = np.argsort(values[:, 0], kind="stable")
    t, raw = values[order, 0], values[order, 1]
    t, raw = _merged(t, raw)
    if len(t) < LEAST_ROWS:
        raise InputError(
            f"{location}: {direction}: found {len(t)} temperatures; expected at least {LEAST_ROWS}"
        )
    factor, remark = _factor(signal, raw, t, settings, rate, location)
    remarks += [remark] if remark else []
    course = None
    if signal.quantity == "heat flow" and time is not None and rate is not None:
        # The factor is that to an apparent specific heat at the rate of the run; a flow has it per kelvin.
        flow = values[:, 1] * (factor * rate / 60.0)
        course = course_of(_seconds(values, time), values[:, 0], flow)
        t, heat = _heat_along(course, f"{location}: {direction}")
    elif signal.quantity == "enthalpy":
        heat = np.gradient(raw * factor, t)
        if heat.mean() < 0.0:
            raise InputError(
                f"{location}: column '{signal.name}': found an enthalpy that falls with temperature; "
                "expected it to rise. Change its sign"
            )
    elif signal.quantity == "heat flow":
        # Per kelvin: while it cools, the temperature falls.
        heat = raw * factor * (1.0 if direction == "heating" else -1.0)
    else:
        heat = raw * factor
    if signal.quantity == "heat flow" and _upside_down(heat):
        heat = -heat
        course = None if course is None else course.reversed()
        if exothermal_up is None:
            remarks.append(f"{direction}: heat given off points up: sign changed, heat taken up is positive")
        elif not exothermal_up:
            remarks.append(
                f"{direction}: the file says that heat given off points down, but the peak points the other "
                "way: the peak was followed"
            )
    elif signal.quantity == "heat flow" and exothermal_up:
        remarks.append(
            f"{direction}: the file says that heat given off points up, but the peak points the other way: "
            "the peak was followed"
        )
    return Scan(
        direction,
        t,
        heat,
        rate,
        signal,
        factor,
        tuple(remarks),
        location,
        recalescence(values[:, 0], direction),
        course,
    )


def _heat_along(course: Course, location: str) -> tuple[Array, Array]:
    """Temperature and apparent specific heat of a run that goes on in its direction."""
    reached = int(course.first_passes.sum())
    if reached < LEAST_ROWS:
        raise InputError(
            f"{location}: found {reached} temperatures that go on in the direction of the run; expected at "
            f"least {LEAST_ROWS}. Remove rows before it or after it, or name its segment"
        )
    return course.specific_heat()


def _upside_down(heat: Array) -> bool:
    largest = heat[np.argmax(np.abs(heat - np.median(heat)))]
    return bool(largest < np.median(heat)) and bool(largest < 0.0)


def _merged(t: Array, raw: Array) -> tuple[Array, Array]:
    """The mean of rows with the same temperature."""
    unique, where = np.unique(np.round(t, 6), return_inverse=True)
    count = np.bincount(where)
    return unique, np.bincount(where, weights=raw) / count


def _seconds(values: Array, time: DscColumn) -> Array:
    return np.asarray(values[:, 2] * UNITS["time"][time.unit or "s"])


def _rate(values: Array, time: DscColumn | None) -> float | None:
    if time is None:
        return None
    seconds = _seconds(values, time)
    slopes = np.abs(np.diff(values[:, 0])) / np.maximum(np.abs(np.diff(seconds)), 1e-12)
    return float(np.median(slopes) * 60.0)


def _factor(
    signal: DscColumn, raw: Array, t: Array, settings: DscSettings, rate: float | None, location: str
) -> tuple[float, str]:
    """Factor to J/(kg K) or J/kg, and what was assumed where the file has no unit."""
    unit, remark = signal.unit, ""
    if unit is None:
        if signal.quantity == "heat flow":
            raise InputError(
                f"{location}: column '{signal.name}': found no unit; expected one in its name, such as "
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
            f"{location}: column '{signal.name}': found a heat flow and no heating rate; expected a column "
            "of time, or rate= in K/min"
        )
    if unit in OF_SAMPLE:
        if settings.mass is None:
            raise InputError(
                f"{location}: column '{signal.name}': found a heat flow of the whole sample; expected its "
                "mass, mass= in mg"
            )
        factor /= settings.mass * 1e-6
    return factor * 60.0 / rate, remark
