"""Read weather files of a year: EPW and TMY3."""

from __future__ import annotations

import hashlib
import math
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, tzinfo
from pathlib import Path
from typing import Final

import numpy as np

from mascarin._io.sealed.cache import Cached, cached
from mascarin.errors import InputError
from mascarin.physics import dew_point
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.reading.files import file_hash
from mascarin.tables.timezones import fixed_zone, zone_name
from mascarin.weather.reading import year_checks
from mascarin.weather.reading.shipped import COMPRESSED, content

_HEADER = 8
_FIELDS = 35
_TMY_HEAD = 7
_HOURS = 8760

# Channel, field number in the file, factor, entry from which on it means "no value".
_EPW: Final = (
    ("air_temperature", 6, 1.0, 99.9),
    ("dew_point", 7, 1.0, 99.9),
    ("pressure", 9, 1.0, 999999.0),
    ("infrared", 12, 1.0, 9999.0),
    ("global_horizontal", 13, 1.0, 9999.0),
    ("direct_normal", 14, 1.0, 9999.0),
    ("diffuse_horizontal", 15, 1.0, 9999.0),
    ("wind_direction", 20, 1.0, 999.0),
    ("wind_speed", 21, 1.0, 999.0),
    ("cloud_cover", 23, 1.0, 99.0),
)
# Channel, pvlib's column, column in the file, factor.
_TMY: Final = (
    ("air_temperature", "temp_air", "Dry-bulb (C)", 1.0),
    ("dew_point", "temp_dew", "Dew-point (C)", 1.0),
    ("pressure", "pressure", "Pressure (mbar)", 100.0),
    ("global_horizontal", "ghi", "GHI (W/m^2)", 1.0),
    ("direct_normal", "dni", "DNI (W/m^2)", 1.0),
    ("diffuse_horizontal", "dhi", "DHI (W/m^2)", 1.0),
    ("wind_direction", "wind_direction", "Wdir (degrees)", 1.0),
    ("wind_speed", "wind_speed", "Wspd (m/s)", 1.0),
    ("cloud_cover", "OpqCld (tenths)", "OpqCld (tenths)", 1.0),
)
_HUMIDITY: Final = ("relative_humidity", 8, 1.0, 999.0)
_MEANS: Final = frozenset({"global_horizontal", "direct_normal", "diffuse_horizontal"})

_HINT: Final = (
    "get it whole from its source; a shorter record can be used as a measured table (measured in a study, "
    "Climate.from_table in Python)"
)
#: Records of an hour that divide it into whole minutes.
_RECORDS: Final = (1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30, 60)
_NO_VALUE_TMY: Final = -9900.0
_DAYS: Final = (31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
_TMY_STAMP: Final = ("Date (MM/DD/YYYY)", "Time (HH:MM)")
_TMY_DATE: Final = re.compile(r"(\d{1,2})/(\d{1,2})/(\d{4}) (\d{1,2}):\d{2}(?::\d{2})?")
#: Largest size of the entries that state the place; time zone in h, altitude in m, angles in degrees.
_SITE_LIMITS: Final = {"latitude": 90.0, "longitude": 180.0, "time zone": 14.0, "altitude": 9000.0}

_STAMPS_NOTE: Final = (
    "{where}: stamps are hour-ending. Radiation stamped h is the mean of the hour before and was moved to "
    "its start; temperature, humidity, wind, pressure, cloud cover and infrared are values at the stamp and "
    "stay there."
)


@dataclass(frozen=True)
class WeatherYear:
    """One year of hourly weather as read; values of hour-ending rows, in order.

    Attributes
    ----------
    year : int
        Calendar year of the first row.
    mixed : bool
        The months come from different years.
    zone : datetime.tzinfo
        Fixed offset.
    values : mapping of str to ndarray, shape (8760 or 8784 times records,)
        Channels; NaN where missing.
    place : tuple of float and str
        Latitude, longitude [deg], altitude [m] and name.
    where : str
        File name.
    sha256 : str
        Hash of the file.
    lines : ndarray
        Line of each row.
    notes : tuple of str
        What was done.
    records : int
        Records of an hour.
    start : tuple of int
        Month and day of the first row.
    """

    year: int
    mixed: bool
    zone: tzinfo
    values: Mapping[str, Array]
    place: tuple[float, float, float, str]
    where: str
    sha256: str
    lines: Lines
    notes: tuple[str, ...]
    records: int = 1
    start: tuple[int, int] = (1, 1)


def read_epw(path: Path) -> WeatherYear:
    """Read an EPW file (EnergyPlus Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary").

    Raises
    ------
    InputError
        Header or rows are broken; the line is named.
    """
    digest = file_hash(path)  # refuses what is no file
    where = path.name.removesuffix(COMPRESSED)
    kept_year = cached(
        (digest, where), [sys.modules[__name__], year_checks], lambda: _packed(_parsed_epw(path, where))
    )
    return _unpacked(kept_year, where)


def _parsed_epw(path: Path, where: str) -> WeatherYear:
    raw = content(path)
    digest = hashlib.sha256(raw).hexdigest()
    lines = raw.decode("utf-8-sig", errors="replace").splitlines()
    rows = _read_epw_rows(lines, where)
    values = {}
    for (channel, _, factor, limit), column in zip((*_EPW, _HUMIDITY), rows.table.T, strict=True):
        # Many files write 0 where no infrared was known.
        unknown = (column >= limit) | ((column <= 0.0) & (channel == "infrared"))
        values[channel] = np.where(unknown, np.nan, column * factor)
    humidity = values.pop("relative_humidity")
    doubts = year_checks.doubts_of_year(values, humidity, float(lines[0].split(",")[6]), where)
    derived = _dew_point_from(humidity, values, where)
    head = [field.strip() for field in lines[0].split(",")]
    latitude, longitude, hours, altitude = (float(field) for field in head[6:10])
    name = ", ".join(part for part in (head[1], head[3]) if part)
    zone = fixed_zone(hours)
    notes = (
        f"{where}: EPW, {len(rows.table) // rows.records} hours, {name}, time zone {zone_name(zone)}.",
        _STAMPS_NOTE.format(where=where),
        f"{where}: cloud cover is the opaque sky cover.",
        *rows.notes,
        *derived,
        *doubts,
    )
    numbers = np.arange(len(rows.table), dtype=np.int64) + _HEADER + 1
    site = (latitude, longitude, altitude, name)
    return WeatherYear(
        rows.year, rows.mixed, zone, values, site, where, digest, numbers, notes, rows.records, rows.start
    )


def _dew_point_from(humidity: Array, values: dict[str, Array], where: str) -> tuple[str, ...]:
    """Fill the dew point where it is missing and the relative humidity is there; what was done."""
    air, dew = values["air_temperature"], values["dew_point"]
    derivable = np.isnan(dew) & (humidity > 0.0) & (humidity <= 110.0) & np.isfinite(air)
    if not derivable.any():
        return ()
    values["dew_point"] = dew.copy()
    values["dew_point"][derivable] = dew_point(air[derivable], humidity[derivable])
    return (
        f"{where}: dew point of {int(derivable.sum())} hours from air temperature and relative humidity.",
    )


def _packed(read: WeatherYear) -> Cached:
    """A year as the cache keeps it."""
    offset = read.zone.utcoffset(None)
    hours = offset.total_seconds() / 3600.0 if offset is not None else 0.0
    notes = {
        "year": read.year, "mixed": read.mixed, "hours": hours, "place": read.place, "sha256": read.sha256,
        "first": int(read.lines[0]), "notes": read.notes, "records": read.records, "start": read.start,
    }  # fmt: skip
    return Cached(notes, read.values)


def _unpacked(entry: Cached, where: str) -> WeatherYear:
    """The year of `_packed`; its rows are lines without a gap."""
    notes, values = entry.notes, entry.columns
    latitude, longitude, altitude, name = notes["place"]
    lines = np.arange(len(values["air_temperature"]), dtype=np.int64) + int(notes["first"])
    site, zone = (latitude, longitude, altitude, name), fixed_zone(notes["hours"])
    said = tuple(notes["notes"])
    month, day = notes["start"]
    return WeatherYear(
        notes["year"], notes["mixed"], zone, values, site, where, notes["sha256"], lines, said,
        notes["records"], (month, day),
    )  # fmt: skip


def read_tmy3(path: Path) -> WeatherYear:
    """Read a TMY3 CSV file with pvlib.

    Raises
    ------
    InputError
        The file is not TMY3, or not a whole year.
    """
    from pvlib import iotools

    digest = file_hash(path)
    where = path.name
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    _check_tmy(text.splitlines(), where)
    try:
        frame, meta = iotools.read_tmy3(str(path), map_variables=True)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(
            f"{where}: cannot be read as TMY3 CSV ({error}); use from_table for other tables."
        ) from error
    if len(frame) not in (_HOURS, _HOURS + 24):
        raise InputError(
            f"{where}: found {len(frame)} rows, expected 8760 hours; the file is cut or holds gaps: {_HINT}."
        )
    values = {}
    for channel, column, _, factor in _TMY:
        raw = frame[column].to_numpy(dtype=np.float64)
        values[channel] = np.where(raw <= -9000.0, np.nan, raw * factor)
    years = [int(stamp.year) for stamp in frame.index[12::24]]
    site = (
        float(meta["latitude"]),
        float(meta["longitude"]),
        float(meta["altitude"]),
        str(meta.get("Name", "")).strip("\"' "),
    )
    zone = fixed_zone(float(meta["TZ"]))
    notes = (
        f"{where}: TMY3, {len(frame)} hours, {site[3]}, time zone {zone_name(zone)}.",
        _STAMPS_NOTE.format(where=where),
        f"{where}: cloud cover is the opaque sky cover.",
    )
    lines = np.arange(len(frame), dtype=np.int64) + 3
    return WeatherYear(years[0], len(set(years)) > 1, zone, values, site, where, digest, lines, notes)


def kind_of(channel: str) -> str:
    """`mean` for the radiation of a yearly file, `instant` for the rest."""
    return "mean" if channel in _MEANS else "instant"


def _check_tmy(lines: list[str], where: str) -> None:
    """Check the head and every row of a TMY3 table."""
    head = lines[0].count(",") + 1 if lines else 0
    if head != _TMY_HEAD or len(lines) < 3:
        raise InputError(
            f"{where}:1: expected the seven fields of a TMY3 table (station, name, state, time zone, "
            f"latitude, longitude, altitude), found {head}; read other tables with from_table, or on the "
            "command "
            "line with --column."
        )
    station = lines[0].split(",")
    _check_place(where, [("latitude", station[4]), ("longitude", station[5]), ("time zone", station[3])])
    _check_place(where, [("altitude", station[6])])
    names = [name.strip() for name in lines[1].split(",")]
    missing = [name for name in (*_TMY_STAMP, *(entry[2] for entry in _TMY)) if name not in names]
    if missing:
        raise InputError(
            f"{where}:2: no column {missing[0]!r}, which TMY3 has; found {', '.join(names[:8])}, ..."
        )
    value_columns = [(f"{channel} ({name})", names.index(name)) for channel, _, name, _ in _TMY]
    stamp = [names.index(name) for name in _TMY_STAMP]
    previous: tuple[int, int, int] | None = None
    for line, row in enumerate(lines[2:], start=3):
        fields = row.split(",")
        if len(fields) < len(names):
            raise InputError(
                f"{where}:{line}: found {len(fields)} fields, expected {len(names)}; the file is cut or "
                f"damaged here: {_HINT}."
            )
        for name, column in value_columns:
            _number(fields[column], name, where, line, _NO_VALUE_TMY)
        date_, time = (fields[column].strip() for column in stamp)
        previous = _check_order(previous, _tmy_stamp(date_, time, where, line), where, line)


def _tmy_stamp(day: str, time: str, where: str, line: int) -> tuple[int, int, int, int]:
    """Year, month, day and hour of a row."""
    match = _TMY_DATE.fullmatch(f"{day} {time}")
    if match is None:
        raise InputError(
            f"{where}:{line}: date and time are {day!r} and {time!r}, expected MM/DD/YYYY and HH:00; correct "
            "the row."
        )
    month, number, year, hour = (int(part) for part in match.groups())
    return year, month, number, hour


@dataclass(frozen=True)
class _Rows:
    """The rows of an EPW file: first year, whether months are of several years, and the numbers."""

    year: int
    mixed: bool
    table: Array
    records: int
    start: tuple[int, int]
    notes: tuple[str, ...]


def _read_epw_rows(lines: list[str], where: str) -> _Rows:
    """Check every line; numbers in the order of the channels, then the relative humidity."""
    if len(lines) <= _HEADER or not lines[0].upper().startswith("LOCATION"):
        raise InputError(
            f"{where}:1: expected the LOCATION line of an EPW file, found {lines[0][:60] if lines else ''!r}."
        )
    _check_location(lines[0], where)
    records = _records_of(lines[_HEADER - 1], where)
    rows = lines[_HEADER:]
    while rows and not rows[-1].strip():
        rows.pop()
    stamps, table = [], []
    previous: tuple[int, int, int] | None = None
    shift, empty = 0, 0
    used = [field for _, field, _, _ in (*_EPW, _HUMIDITY)]
    for count, row in enumerate(rows):
        line = _HEADER + 1 + count
        fields = row.split(",")
        if len(fields) < _FIELDS - 3:
            raise InputError(
                f"{where}:{line}: found {len(fields)} fields, expected {_FIELDS}; the file is cut or "
                f"damaged here: {_HINT}."
            )
        year, month, day, hour = _integers(fields, where, line)
        if count == 0:
            shift = int(hour == 0)  # hours from 0 to 23
        table.append(
            [
                _number(fields[field], f"{channel} (field {field + 1})", where, line, code, empty=True)
                for channel, field, _, code in (*_EPW, _HUMIDITY)
            ]
        )
        empty += sum(not fields[field].strip() for field in used)
        stamp = (year, month, day, hour + shift)
        stamps.append(stamp[:3])
        if count % records == 0:
            previous = _check_order(previous, stamp, where, line, any_day=True)
        elif stamp[1:] != previous:
            raise InputError(
                f"{where}:{line}: found {month}/{day} hour {hour}, expected {records} rows of each hour, as "
                "the DATA PERIODS line states; a row is missing, or that line is wrong."
            )
    if len(rows) not in (_HOURS * records, (_HOURS + 24) * records):
        raise InputError(
            f"{where}:{_HEADER + len(rows)}: the file ends after {len(rows) / records:g} hours, expected "
            f"8760 (or 8784 in a leap year); it is cut or holds gaps: {_HINT}."
        )
    start = stamps[0][1:]
    return _Rows(
        stamps[0][0], _is_mixed(stamps), np.array(table), records, start,
        _row_notes(records, shift, start, empty, where),
    )  # fmt: skip


def _is_mixed(stamps: Sequence[tuple[int, int, int]]) -> bool:
    """Whether the years of the rows do not follow the calendar: months of several years."""
    year, before = stamps[0][0], stamps[0][1:]
    for row_year, month, day in stamps:
        year += int((month, day) == (1, 1) and before == (12, 31))
        before = (month, day)
        if row_year != year:
            return True
    return False


def _row_notes(records: int, shift: int, start: tuple[int, int], empty: int, where: str) -> tuple[str, ...]:
    notes = []
    if records > 1:
        notes.append(
            f"{where}: {records} records an hour; radiation is the mean of each interval in W/m2, as "
            "EnergyPlus takes it."
        )
    if shift:
        notes.append(
            f"{where}: warning: hours are 0 to 23, where the format has 1 to 24; hour 0 was taken as the "
            "hour from 0:00 to 1:00."
        )
    if start != (1, 1):
        notes.append(f"{where}: the first row is of {start[0]}/{start[1]}, not of 1 January.")
    if empty:
        notes.append(f"{where}: {empty} empty fields were taken as missing values.")
    return tuple(notes)


def _check_location(line: str, where: str) -> None:
    fields = line.split(",")
    if len(fields) < 10:
        raise InputError(f"{where}:1: LOCATION has {len(fields)} fields, expected 10.")
    names = ("latitude", "longitude", "time zone", "altitude")
    _check_place(where, list(zip(names, fields[6:10], strict=True)))


def _check_place(where: str, entries: Sequence[tuple[str, str]]) -> None:
    """Refuse entries of the first line that are no numbers, or too far from zero."""
    for name, text in entries:
        limit = _SITE_LIMITS[name]
        try:
            good = abs(float(text)) <= limit
        except ValueError:
            good = False
        if not good:
            raise InputError(f"{where}:1: {name} is {text!r}, expected a number within {limit:g} of zero.")


def _records_of(line: str, where: str) -> int:
    """Records of an hour, as the DATA PERIODS line states them."""
    fields = line.split(",")
    if not line.upper().startswith("DATA PERIODS") or len(fields) < 3:
        raise InputError(f"{where}:{_HEADER}: expected the DATA PERIODS line, found {line[:60]!r}.")
    text = fields[2].strip()
    if not text.isdigit() or int(text) not in _RECORDS:
        raise InputError(
            f"{where}:{_HEADER}: found {text!r} records per hour, expected one of "
            f"{', '.join(map(str, _RECORDS))}; correct the line."
        )
    return int(text)


def _integers(fields: list[str], where: str, line: int) -> tuple[int, int, int, int]:
    try:
        year, month, day, hour = (int(float(field)) for field in fields[:4])
    except (ValueError, OverflowError) as error:
        raise InputError(
            f"{where}:{line}: date {','.join(fields[:4])!r} is not year,month,day,hour."
        ) from error
    return year, month, day, hour


def _number(text: str, what: str, where: str, line: int, code: float, *, empty: bool = False) -> float:
    """The number of an entry; `code` marks a missing value in this format, and so may an empty entry."""
    if empty and not text.strip():
        return code
    try:
        number, expected = float(text), "a finite number"
    except ValueError:
        number, expected = math.nan, "a number"
    if not math.isfinite(number):
        raise InputError(
            f"{where}:{line}: {what} is {text.strip()!r}, expected {expected}; correct it, or "
            f"write {code:.15g}, which marks a missing value, and choose a period without this hour."
        )
    return number


def _check_order(
    previous: tuple[int, int, int] | None, stamp: tuple[int, int, int, int], where: str, line: int,
    *, any_day: bool = False,
) -> tuple[int, int, int]:  # fmt: skip
    _, month, day, hour = stamp
    row_hour = (month, day, hour)
    if previous is None and any_day and hour == 1 and 1 <= month <= 12 and 1 <= day <= _DAYS[month - 1]:
        return row_hour
    expected = _next_hours(previous)
    if row_hour not in expected:
        hours = " or ".join(f"{m}/{d} hour {h}" for m, d, h in expected)
        raise InputError(
            f"{where}:{line}: found {month}/{day} hour {hour}, expected {hours}; a row is missing or twice."
        )
    return row_hour


def _next_hours(previous: tuple[int, int, int] | None) -> list[tuple[int, int, int]]:
    if previous is None:
        return [(1, 1, 1)]
    month, day, hour = previous
    if hour < 24:
        return [(month, day, hour + 1)]
    if (month, day) == (2, 28):
        return [(2, 29, 1), (3, 1, 1)]
    following = date.fromordinal(date(2000, month, day).toordinal() + 1)
    return [(following.month, following.day, 1)]
