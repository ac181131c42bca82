"""A measured table as a record of the weather: channels, kinds, stamps and absent channels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final, cast

import numpy as np

from mascarin._io.arguments import names_of
from mascarin.errors import InputError, did_you_mean
from mascarin.physics import dew_point
from mascarin.tables.arrays import Array
from mascarin.tables.columns import Column
from mascarin.tables.reading.interval_labels import knot_lines, to_starts
from mascarin.tables.reading.records import converted
from mascarin.tables.reading.table import Table
from mascarin.tables.record import Kind, Origin
from mascarin.weather.reading.likely_units import require_likely_unit
from mascarin.weather.records.channels import BY_NAME, RADIATION, SOURCE_CHANNELS, SUN_POSITION, UNITS
from mascarin.weather.records.record import WeatherRecord

NEUTRAL: Final[Mapping[str, float]] = {
    "dew_point": np.nan,
    "relative_humidity": 70.0,
    "wind_speed": 0.0,
    "wind_direction": 0.0,
    "direct_normal": 0.0,
    "diffuse_horizontal": 0.0,
    "global_horizontal": 0.0,
    "cloud_cover": 0.0,
    "infrared": np.nan,
    "pressure": np.nan,
}
"""Values assumed for channels that the user states to be absent from a table."""

_NAMES: Final = (*SOURCE_CHANNELS, "relative_humidity", *SUN_POSITION)

Columns = Mapping[str, str | Column | Mapping[str, object]]


def record_of_table(
    table: Table,
    columns: Columns,
    extra: Iterable[str] | Columns,
    absent: Iterable[str] | Mapping[str, float],
    stamps: str,
    instant: Iterable[str],
    mean: Iterable[str],
) -> WeatherRecord:
    """Record of a table; parameters are those of `Climate.from_table`."""
    chosen = _chosen(columns, extra, table)
    stated = _stated(absent, chosen, table.where)
    kinds = _kinds(chosen, instant, mean, table.where, "instant" if table.of_pvgis else None)
    values, origins = _values(chosen, table)
    record = _on_grid(table, values, kinds, stamps, origins)
    return _with_humidity(_with_neutral(record, stated))


def _chosen(
    columns: Columns,
    extra: Iterable[str] | Columns,
    table: Table,
) -> dict[str, Column]:
    chosen: dict[str, Column] = {}
    for name, entry in columns.items():
        if name not in _NAMES:
            hint = did_you_mean(name, _NAMES)
            raise InputError(f"{table.where}: columns: {name!r} is no climate channel. {hint}".rstrip())
        chosen[name] = Column.of(entry, f"{table.where}: columns.{name}")
    further = extra if isinstance(extra, Mapping) else {name: name for name in extra}
    for name, entry in further.items():
        if name in UNITS or name == "relative_humidity":
            raise InputError(f"{table.where}: extra: {name!r} is a climate channel; name it under columns.")
        chosen[name] = Column.of(entry, f"{table.where}: extra.{name}")
    position = [name for name in SUN_POSITION if name in chosen]
    if len(position) == 1:
        raise InputError(
            f"{table.where}: columns: found {position[0]} alone, expected {' and '.join(SUN_POSITION)}; map "
            "both, or neither: the position of the sun then follows from place and time."
        )
    if "dew_point" in chosen and "relative_humidity" in chosen:
        raise InputError(f"{table.where}: columns: give dew_point or relative_humidity, not both.")
    return chosen


def _stated(
    absent: Iterable[str] | Mapping[str, float], chosen: Mapping[str, Column], where: str
) -> dict[str, float]:
    """Values of absent channels; refuse one that is neither in the table nor stated to be absent."""
    stated: dict[str, float | None] = (
        {name: float(value) for name, value in absent.items()}
        if isinstance(absent, Mapping)
        else dict.fromkeys(names_of(f"{where}: absent", absent, such_as="'wind_speed'"))
    )
    if "radiation" in stated:
        stated.pop("radiation")
        stated.update({name: None for name in RADIATION if name not in chosen})
    for name in stated:
        if name not in NEUTRAL:
            hint = did_you_mean(name, (*NEUTRAL, "radiation"))
            raise InputError(f"{where}: absent: {name!r} is no channel that may be absent. {hint}".rstrip())
        if name in chosen:
            raise InputError(
                f"{where}: {name} is both mapped to a column and stated to be absent; choose one."
            )
    needed: list[tuple[str, bool]] = [
        ("air_temperature", "air_temperature" in chosen),
        ("dew_point", bool({"dew_point", "relative_humidity"} & ({*chosen} | {*stated}))),
        ("wind_speed", "wind_speed" in chosen or "wind_speed" in stated),
        ("wind_direction", "wind_direction" in chosen or "wind_direction" in stated),
        ("global_horizontal", _enough_radiation({*chosen} | {*stated})),
    ]
    for name, available in needed:
        if not available:
            remedy = _remedy(name)
            raise InputError(f"{where}: no column for {name} [{UNITS[name]}]; map one under columns{remedy}.")
    for name, source in _follows_from(chosen).items():
        value = stated.pop(name, None)
        if value is not None:
            raise InputError(
                f"{where}: absent: found {name} with the value {value:g}, but it follows from {source}, "
                f"which is mapped to a column; leave {name} out of absent, or {source} out of columns."
            )
    return {name: NEUTRAL[name] if value is None else value for name, value in stated.items()}


def _follows_from(chosen: Mapping[str, Column]) -> dict[str, str]:
    """Channels that are computed from mapped ones, whatever is stated to be absent: name -> from what."""
    computed = {}
    if "relative_humidity" in chosen:
        computed["dew_point"] = "relative_humidity"
    elif "dew_point" in chosen:
        computed["relative_humidity"] = "dew_point"
    if "global_horizontal" in chosen:
        computed |= {name: "global_horizontal" for name in RADIATION if name not in chosen}
    elif {"direct_normal", "diffuse_horizontal"} <= {*chosen}:
        computed["global_horizontal"] = "direct_normal and diffuse_horizontal"
    return computed


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
        "(right where every surface that the sun reaches has a measured irradiance)",
    }
    return texts[name]


def _kinds(
    chosen: Mapping[str, Column], instant: Iterable[str], mean: Iterable[str], where: str,
    of_radiation: Kind | None,
) -> dict[str, Kind]:  # fmt: skip
    kinds: dict[str, Kind] = {}
    for name, column in chosen.items():
        usual: Kind = BY_NAME[name].kind if name in BY_NAME else "instant"
        if of_radiation is not None and name in RADIATION:
            usual = of_radiation
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
    position = {name: kinds[name] for name in SUN_POSITION if name in kinds}
    if len(set(position.values())) > 1:
        raise InputError(
            f"{where}: {' and '.join(position)} must both be means or both be instants, found {position}."
        )
    return kinds


def _values(chosen: Mapping[str, Column], table: Table) -> tuple[dict[str, Array], dict[str, Origin]]:
    values, origins = {}, {}
    for name, column in chosen.items():
        unit = "%" if name == "relative_humidity" else UNITS.get(name, "")
        values[name], origins[name] = converted(table, column, name, unit)
        if not origins[name].stated:
            require_likely_unit(name, values[name], table.lines, column.column, table.where)
        if name in ("wind_direction", "sun_azimuth"):
            # Between 0 and 360 deg; a code such as 990 is kept and is refused when it is needed.
            turn = values[name]
            values[name] = np.where((turn >= -360.0) & (turn <= 720.0), turn % 360.0, turn)
    return values, origins


def _on_grid(
    table: Table, values: dict[str, Array], kinds: dict[str, Kind], stamps: str, origins: dict[str, Origin]
) -> WeatherRecord:
    columns, closing, grid, note = to_starts(table, values, kinds, stamps)
    notes = [f"{table.where}: {origin.line}" for origin in origins.values()]
    return WeatherRecord(
        columns=columns, kinds=kinds, grid=grid, closing=closing, file=table.where,
        sha256=table.sha256, provenance=(*table.notes, note, *notes), lines=table.lines,
        knots=knot_lines(table.lines, stamps), origins=origins,
    )  # fmt: skip


def _with_neutral(record: WeatherRecord, stated: Mapping[str, float]) -> WeatherRecord:
    columns, kinds, closing = dict(record.columns), dict(record.kinds), dict(record.closing)
    notes = list(record.provenance)
    for name, value in stated.items():
        if name == "dew_point" and np.isnan(value):
            name, value = "relative_humidity", NEUTRAL["relative_humidity"]
        if np.isnan(value):
            continue
        # All irradiances must have the same kind.
        kinds[name] = next(
            (kinds[other] for other in RADIATION if name in RADIATION and other in kinds), "instant"
        )
        columns[name] = np.full(record.grid.count, value)
        closing[name] = value
        unit = "%" if name == "relative_humidity" else UNITS[name]
        notes.append(f"{record.file}: {name} was not measured; assumed {value:g} {unit} throughout.")
    assumed = frozenset(stated)
    return replace(
        record, columns=columns, kinds=kinds, closing=closing, provenance=tuple(notes), assumed=assumed
    )


def _with_humidity(record: WeatherRecord) -> WeatherRecord:
    if "relative_humidity" not in record.columns:
        return record
    columns, kinds, closing = dict(record.columns), dict(record.kinds), dict(record.closing)
    humidity = columns.pop("relative_humidity")
    air = columns["air_temperature"]
    bad = np.flatnonzero((humidity < 0.0) | (humidity > 110.0))
    if len(bad):
        line = record.line("relative_humidity", int(bad[0]))
        raise InputError(
            f"{record.file}:{line}: relative humidity {humidity[bad[0]]:g} %, expected 0 .. 100; a column "
            "between 0 and 1 has unit: '1'."
        )
    kind = kinds.pop("relative_humidity")
    columns["dew_point"] = dew_point(air, humidity)
    kinds["dew_point"] = kind
    if "relative_humidity" in closing:
        pair = (record.closing.get("air_temperature", float(air[-1])), closing.pop("relative_humidity"))
        closing["dew_point"] = float(dew_point(*pair))
    note = f"{record.file}: dew point from air temperature and relative humidity over water."
    notes = (*record.provenance, note)
    return replace(record, columns=columns, kinds=kinds, closing=closing, provenance=notes)
