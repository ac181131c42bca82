"""A measured table becomes a climate: channels, kinds, stamps, and what is stated to be absent."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.weather import derive
from mascarin.weather.arrays import Array, Lines
from mascarin.weather.channels import BY_NAME, RADIATION, SOURCE_CHANNELS, UNITS, Kind
from mascarin.weather.checks import line_of
from mascarin.weather.climate import NEUTRAL, Climate
from mascarin.weather.grid import Grid, frame_of
from mascarin.weather.table import Column, Table, epoch_seconds

if TYPE_CHECKING:
    import pandas as pd

_NAMES: Final = (*SOURCE_CHANNELS, "relative_humidity")

Columns = Mapping[str, str | Column | Mapping[str, object]]


def climate_of(
    table: Table,
    columns: Columns,
    extra: Iterable[str] | Columns,
    absent: Iterable[str] | Mapping[str, float],
    stamps: str,
    instant: Iterable[str],
    mean: Iterable[str],
) -> Climate:
    """Climate of a table; parameters are those of `Climate.from_table`."""
    chosen = _chosen(columns, extra, table)
    stated = _stated(absent, chosen, table.where)
    kinds = _kinds(chosen, instant, mean, table.where)
    values, notes = _values(chosen, table)
    climate = _on_grid(table, values, kinds, stamps, notes)
    return _with_humidity(_with_neutral(climate, stated))


def _chosen(
    columns: Columns,
    extra: Iterable[str] | Columns,
    table: Table,
) -> dict[str, Column]:
    chosen: dict[str, Column] = {}
    for name, given in columns.items():
        if name not in _NAMES:
            hint = did_you_mean(name, _NAMES)
            raise InputError(f"{table.where}: columns: {name!r} is no climate channel. {hint}".rstrip())
        chosen[name] = Column.of(given, f"{table.where}: columns.{name}")
    further = extra if isinstance(extra, Mapping) else {name: name for name in extra}
    for name, given in further.items():
        if name in UNITS or name == "relative_humidity":
            raise InputError(f"{table.where}: extra: {name!r} is a climate channel; name it under columns.")
        chosen[name] = Column.of(given, f"{table.where}: extra.{name}")
    if "dew_point" in chosen and "relative_humidity" in chosen:
        raise InputError(f"{table.where}: columns: give dew_point or relative_humidity, not both.")
    return chosen


def _stated(
    absent: Iterable[str] | Mapping[str, float], chosen: Mapping[str, Column], where: str
) -> dict[str, float]:
    """Values of the channels that are stated to be absent; refuse what is neither there nor stated."""
    given: dict[str, float | None] = (
        {name: float(value) for name, value in absent.items()}
        if isinstance(absent, Mapping)
        else dict.fromkeys(absent)
    )
    if "radiation" in given:
        given.pop("radiation")
        given.update({name: 0.0 for name in RADIATION if name not in chosen})
    for name in given:
        if name not in NEUTRAL:
            hint = did_you_mean(name, (*NEUTRAL, "radiation"))
            raise InputError(f"{where}: absent: {name!r} is no channel that may be absent. {hint}".rstrip())
        if name in chosen:
            raise InputError(
                f"{where}: {name} is both mapped to a column and stated to be absent; choose one."
            )
    needed: list[tuple[str, bool]] = [
        ("air_temperature", "air_temperature" in chosen),
        ("dew_point", bool({"dew_point", "relative_humidity"} & ({*chosen} | {*given}))),
        ("wind_speed", "wind_speed" in chosen or "wind_speed" in given),
        ("wind_direction", "wind_direction" in chosen or "wind_direction" in given),
        ("global_horizontal", _enough_radiation({*chosen} | {*given})),
    ]
    for name, there in needed:
        if not there:
            remedy = _remedy(name)
            raise InputError(f"{where}: no column for {name} [{UNITS[name]}]; map one under columns{remedy}.")
    return {name: NEUTRAL[name] if value is None else value for name, value in given.items()}


def _enough_radiation(names: set[str]) -> bool:
    return "global_horizontal" in names or {"direct_normal", "diffuse_horizontal"} <= names


def _remedy(name: str) -> str:
    texts = {
        "air_temperature": "",
        "dew_point": ", or relative_humidity; or state absent: [dew_point] to assume 70 % relative humidity",
        "wind_speed": ", or state absent: [wind_speed] to take still air (0 m/s)",
        "wind_direction": ", or state absent: [wind_direction] to take north",
        "global_horizontal": ", or direct_normal and diffuse_horizontal; or state absent: [radiation] "
        "to take none "
        "(right where every sunlit surface has a measured irradiance of its own)",
    }
    return texts[name]


def _kinds(
    chosen: Mapping[str, Column], instant: Iterable[str], mean: Iterable[str], where: str
) -> dict[str, Kind]:
    kinds: dict[str, Kind] = {}
    for name, column in chosen.items():
        usual: Kind = BY_NAME[name].kind if name in BY_NAME else "instant"
        kinds[name] = column.kind or usual
    for names, kind in ((tuple(instant), "instant"), (tuple(mean), "mean")):
        for name in names:
            if name not in kinds:
                raise InputError(
                    f"{where}: {kind}: {name!r} is not read. {did_you_mean(name, kinds)}".rstrip()
                )
            kinds[name] = cast("Kind", kind)
    radiation = {name: kinds[name] for name in RADIATION if name in kinds}
    if len(set(radiation.values())) > 1:
        raise InputError(f"{where}: irradiances must be all means or all instants, found {radiation}.")
    return kinds


def _values(chosen: Mapping[str, Column], table: Table) -> tuple[dict[str, Array], list[str]]:
    values, notes = {}, []
    for name, column in chosen.items():
        where = f"{table.where}: {name}"
        unit = "%" if name == "relative_humidity" else UNITS.get(name, "")
        values[name] = column.convert(table.numbers(column.column, name), unit, table.interval, where)
        note = column.sentence(name, unit)
        if note:
            notes.append(f"{table.where}: {note}")
        if name == "wind_direction":
            # Within a turn of the compass; a code such as 990 stays what it is and is refused when needed.
            turn = values[name]
            values[name] = np.where((turn >= -360.0) & (turn <= 720.0), turn % 360.0, turn)
    return values, notes


def _on_grid(
    table: Table, values: dict[str, Array], kinds: dict[str, Kind], stamps: str, notes: list[str]
) -> Climate:
    columns, closing, grid, note = to_starts(table, values, kinds, stamps)
    return Climate(
        data=frame_of(columns, grid), kinds=kinds, grid=grid, closing=closing, site=None, file=table.where,
        sha256=table.sha256, provenance=(*table.notes, note, *notes), lines=table.lines,
        knots=knot_lines(table.lines, stamps),
    )  # fmt: skip


def to_starts(
    table: Table, values: Mapping[str, Array], kinds: Mapping[str, Kind], stamps: str
) -> tuple[dict[str, Array], dict[str, float], Grid, str]:
    """Label intervals by their start.

    Parameters
    ----------
    table : Table
        Gives times and step.
    values : mapping of str to ndarray, shape (n,)
        Columns in the order of the stamps.
    kinds : mapping
        Kind of each column.
    stamps : str
        `start` or `end`.

    Returns
    -------
    columns : dict
        Columns by the start of the interval, shape (n,).
    closing : dict
        Instants at the end of the record.
    grid : Grid
        The intervals.
    note : str
        What was done.

    Raises
    ------
    InputError
        `stamps` is neither of the two.
    """
    if stamps not in ("start", "end"):
        raise InputError(f"{table.where}: stamps is {stamps!r}, expected 'start' or 'end'.")
    first = float(epoch_seconds(cast("pd.DatetimeIndex", table.frame.index[:1]))[0])
    late = stamps == "end"
    grid = Grid(first - (table.interval if late else 0.0), table.interval, len(table.frame), table.zone)
    columns, closing = {}, {}
    for name, column in values.items():
        if kinds[name] == "instant":
            columns[name] = np.concatenate([column[:1], column[:-1]]) if late else column
            closing[name] = float(column[-1])
        else:
            columns[name] = column
    means = [name for name in values if kinds[name] == "mean"]
    at = "the end" if late else "the start"
    note = f"{table.where}: a stamp marks {at} of its interval; "
    note += f"means: {', '.join(means)}; " if means else "no means; "
    note += "all other columns are values at the stamp"
    note += ", means moved to the start" if late and means else ""
    held = "the first is held back to the start" if late else "the last is held to the end"
    note += f"; of these {held} of the record."
    return columns, closing, grid, note


def knot_lines(lines: Lines, stamps: str) -> Lines:
    """Line of the instants at the start of each interval and at the end of the last.

    Parameters
    ----------
    lines : ndarray, shape (n,)
        Line of each row of the table.
    stamps : str
        `start` or `end`; with the latter the instants moved on by one interval.

    Returns
    -------
    ndarray, shape (n + 1,)
        Lines.
    """
    return np.concatenate([lines[:1], lines] if stamps == "end" else [lines, lines[-1:]])


def _with_neutral(climate: Climate, stated: Mapping[str, float]) -> Climate:
    data, kinds, closing = climate.data.copy(), dict(climate.kinds), dict(climate.closing)
    notes = list(climate.provenance)
    for name, value in stated.items():
        if name == "dew_point" and np.isnan(value):
            name, value = "relative_humidity", NEUTRAL["relative_humidity"]
        if np.isnan(value):
            continue
        # Columns of one irradiance must not stand beside derived ones.
        kinds[name] = next(
            (kinds[other] for other in RADIATION if name in RADIATION and other in kinds), "instant"
        )
        data[name] = value
        closing[name] = value
        unit = "%" if name == "relative_humidity" else UNITS[name]
        notes.append(f"{climate.file}: {name} was not measured; assumed {value:g} {unit} throughout.")
    return replace(climate, data=data, kinds=kinds, closing=closing, provenance=tuple(notes), _ready={})


def _with_humidity(climate: Climate) -> Climate:
    if "relative_humidity" not in climate.data.columns:
        return climate
    data, kinds, closing = climate.data.copy(), dict(climate.kinds), dict(climate.closing)
    humidity = data.pop("relative_humidity").to_numpy(dtype=np.float64)
    air = data["air_temperature"].to_numpy(dtype=np.float64)
    bad = np.flatnonzero((humidity < 0.0) | (humidity > 110.0))
    if len(bad):
        line = line_of(climate, "relative_humidity", int(bad[0]))
        raise InputError(
            f"{climate.file}:{line}: relative humidity {humidity[bad[0]]:g} %, "
            "expected 0 .. 100; "
            "a column between 0 and 1 has unit: '1'."
        )
    kind = kinds.pop("relative_humidity")
    data["dew_point"] = derive.dew_point(air, humidity)
    kinds["dew_point"] = kind
    if "relative_humidity" in closing:
        pair = (climate.closing.get("air_temperature", float(air[-1])), closing.pop("relative_humidity"))
        closing["dew_point"] = float(derive.dew_point(np.array([pair[0]]), np.array([pair[1]]))[0])
    note = f"{climate.file}: dew point from air temperature and relative humidity (Alduchov & Eskridge 1996)."
    return replace(
        climate, data=data, kinds=kinds, closing=closing, provenance=(*climate.provenance, note), _ready={}
    )
