"""Frames of `pvlib.iotools` as records of the weather."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from datetime import tzinfo
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, cast

import numpy as np

from mascarin._io.arguments import finite_number, require_type
from mascarin.errors import InputError
from mascarin.tables.arrays import Array
from mascarin.tables.columns import Column
from mascarin.tables.reading.table import Table, read_table
from mascarin.tables.timezones import fixed_offset, parse_timezone, zone_name, zone_of
from mascarin.weather.reading.measured import record_of_table
from mascarin.weather.records.channels import BY_NAME, RADIATION, UNITS
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import Place

if TYPE_CHECKING:
    import pandas as pd

PvlibStamps: TypeAlias = Literal["start", "middle", "end", "instant"]
"""What a stamp marks: a part of the interval of a mean, or the time of every value."""

_WHERE: Final = "pvlib"
_DAY: Final = 86400.0
_POLAR: Final = 60.0  # deg
_CONVERSIONS: Final[Mapping[str, str]] = {
    "degC": "subtract 273.15 from kelvin",
    "W/m2": "multiply kW/m2 by 1000",
    "Pa": "multiply kPa by 1000",
}

_SITE_LIMITS: Final[Mapping[str, tuple[float, float, str]]] = {
    "latitude": (-90.0, 90.0, "deg"),
    "longitude": (-180.0, 360.0, "deg"),
    "altitude": (-450.0, 9000.0, "m"),
}
# Channel or relative humidity -> names in frames of pvlib, the first that is found is taken.
_NAMES: Final[Mapping[str, tuple[str, ...]]] = {
    "air_temperature": ("temp_air",),
    "relative_humidity": ("relative_humidity",),
    "dew_point": ("temp_dew",),
    "wind_speed": ("wind_speed",),
    "wind_direction": ("wind_direction",),
    "pressure": ("pressure", "atmospheric_pressure"),
    "global_horizontal": ("ghi",),
    "direct_normal": ("dni",),
    "diffuse_horizontal": ("dhi",),
    "infrared": ("longwave_down", "lw", "lwd", "ghi_infrared", "IR(h)"),
    "cloud_cover": ("opaque_sky_cover", "OpqCld (tenths)", "total_sky_cover", "TotCld (tenths)"),
}
# Numbers that mark a missing value in frames of EPW and TMY3 files, by name.
_CODES: Final[Mapping[str, float]] = {
    "temp_air": 99.9,
    "temp_dew": 99.9,
    "relative_humidity": 999.0,
    "atmospheric_pressure": 999999.0,
    "ghi": 9999.0,
    "dni": 9999.0,
    "dhi": 9999.0,
    "ghi_infrared": 9999.0,
    "wind_direction": 999.0,
    "wind_speed": 999.0,
    "opaque_sky_cover": 99.0,
    "total_sky_cover": 99.0,
}


def record_of_pvlib(
    data: pd.DataFrame | tuple[pd.DataFrame, Mapping[str, Any]],
    *,
    latitude: float | None,
    longitude: float | None,
    altitude: float | None,
    stamps: PvlibStamps | None,
    typical: bool | None,
    timezone: str | None,
    absent: Iterable[str] | Mapping[str, float],
) -> WeatherRecord:
    """Record of a frame; parameters are those of `Climate.from_pvlib`."""
    import pandas as pd

    frame, metadata = (data[0], data[1]) if isinstance(data, tuple) else (data, {})
    require_type(f"{_WHERE}: data", frame, pd.DataFrame, "a pandas.DataFrame, or the pair (frame, metadata)")
    site = _site_of(metadata, latitude, longitude, altitude)
    zone = _zone(frame, timezone)
    marked, epw = _stamps(frame, metadata, stamps)
    columns, notes = _columns(frame)
    for name in columns:
        _require_unit(str(name), columns[name].to_numpy(dtype=np.float64), site)
    if epw:
        # Spot values are those at the end of the hour, so that the end is the stamp of the whole row.
        columns.index = columns.index + _seconds(3600.0)
        marked = "end"
    if typical is None:
        typical = "months_selected" in metadata or _months_of_several_years(frame)
    if not typical and not columns.index.is_monotonic_increasing:
        raise InputError(
            f"{_WHERE}: the stamps do not increase, expected a record in the order of time; sort it: "
            "frame.sort_index(). For a year made of months of several years state typical=True."
        )
    if typical:
        columns = _ordered(columns, marked, zone)
    table = read_table(columns, timezone=timezone or zone_name(zone))
    said = (note.replace("table:", f"{_WHERE}:") for note in table.notes)
    table = replace(table, where=_WHERE, notes=(*notes, *said))
    if marked == "middle":
        table = _started(table)
    record = record_of_table(
        table,
        {str(name): Column(str(name), unit=UNITS.get(str(name)), overrule=True) for name in columns.columns},
        extra=(),
        absent=absent,
        stamps="end" if marked == "end" else "start",
        instant=[
            name
            for name in (*RADIATION, "infrared")
            if name in columns and (marked == "instant" or (epw and name == "infrared"))
        ],
        mean=[str(name) for name in columns if marked == "middle"],
    )
    record = replace(record, site=site)
    return _periodic(record, late=marked == "end") if typical else record


def _site_of(
    metadata: Mapping[str, Any], latitude: float | None, longitude: float | None, altitude: float | None
) -> Place:
    """The place, from the arguments or from the metadata of pvlib."""
    inner = metadata.get("inputs", {}) if isinstance(metadata.get("inputs", {}), Mapping) else {}
    location = inner.get("location", {}) if isinstance(inner, Mapping) else {}

    def number_of(argument: float | None, *keys: str) -> float | None:
        if argument is not None:
            return finite_number(f"{_WHERE}: {keys[0]}", argument, *_SITE_LIMITS[keys[0]])
        for source in (metadata, location):
            for key in keys:
                if key in source:
                    return float(source[key])
        return None

    north, east = number_of(latitude, "latitude", "Latitude"), number_of(longitude, "longitude", "Longitude")
    if north is None or east is None:
        raise InputError(
            f"{_WHERE}: latitude and longitude are not known; give latitude=..., longitude=... [deg], or the "
            "pair (data, metadata) that the function of pvlib returns."
        )
    name = str(metadata.get("Name", metadata.get("city", ""))).strip("\"' ")
    return Place(north, east, number_of(altitude, "altitude", "elevation", "Elevation") or 0.0, name)


def _zone(frame: pd.DataFrame, timezone: str | None) -> tzinfo:
    import pandas as pd

    if not isinstance(frame.index, pd.DatetimeIndex):
        raise InputError(
            f"{_WHERE}: the index of the frame is {type(frame.index).__name__}, expected the stamps "
            "(DatetimeIndex), as pvlib.iotools returns it; other tables are read by Climate.from_table."
        )
    if timezone is not None:
        return parse_timezone(timezone, f"{_WHERE}: timezone")
    if frame.index.tz is None:
        raise InputError(
            f"{_WHERE}: the stamps have no time zone; state timezone='UTC' or the zone that they are in."
        )
    return zone_of(frame.index.tz)


def _stamps(
    frame: pd.DataFrame, metadata: Mapping[str, Any], stamps: PvlibStamps | None
) -> tuple[PvlibStamps, bool]:
    """What the stamps mark, and whether the frame is one of `read_epw` whose stamps were not stated."""
    if stamps is not None:
        if stamps not in ("start", "middle", "end", "instant"):
            raise InputError(
                f"{_WHERE}: stamps is {stamps!r}, expected 'start', 'middle', 'end' or 'instant'."
            )
        return stamps, False
    if "data_source_unct" in frame.columns:
        return "start", True
    if "OpqCld (tenths)" in frame.columns or "bhi" in frame.columns or "jobID" in metadata:
        return "end", False
    raise InputError(
        f"{_WHERE}: it is not known what the stamps mark; state stamps='start', 'middle' or 'end' (of the "
        "interval over which irradiances are means) or 'instant' (values at the stamp). PVGIS: 'instant' for "
        "satellite data (SARAH), 'middle' for ERA5; NSRDB PSM: 'middle'; ERA5 and TMY3: 'end'; EPW as pvlib "
        "reads it: 'start'."
    )


def _columns(frame: pd.DataFrame) -> tuple[pd.DataFrame, list[str]]:
    """The channels of a frame in their units, and what was computed."""
    import pandas as pd

    out: dict[str, Array] = {}
    notes: list[str] = []
    coded = "data_source_unct" in frame.columns
    for channel, names in _NAMES.items():
        name = next((name for name in names if name in frame.columns), None)
        if name is None:
            continue
        values = _numbers(frame, name)
        if coded and name in _CODES:
            values = np.where(values >= _CODES[name], np.nan, values)
        values = np.where(values <= -9000.0, np.nan, values)
        if name == "ghi_infrared":
            values = np.where(values <= 0.0, np.nan, values)
        out[channel] = values
    if "relative_humidity" in out:
        _require_percent(out["relative_humidity"])
    _derive(frame, out, notes)
    if "dew_point" in out:
        # The dew point is what the engine takes; the other would be converted to it.
        out.pop("relative_humidity", None)
    if "pressure" in out and np.nanmedian(out["pressure"]) < 2000.0:
        out["pressure"] = 100.0 * out["pressure"]
        notes.append(f"{_WHERE}: pressure converted from hPa to Pa.")
    for name in ("infrared", "cloud_cover", "pressure"):
        if name in out and np.isnan(out[name]).all():
            del out[name]
    if "global_horizontal" not in out and "poa_global" in frame.columns:
        raise InputError(
            f"{_WHERE}: the frame holds irradiance on an inclined plane (poa_global), expected irradiance on "
            "the horizontal; call pvlib.iotools.get_pvgis_hourly(..., surface_tilt=0, components=True)."
        )
    return pd.DataFrame(out, index=frame.index), notes


def _numbers(frame: pd.DataFrame, name: str) -> Array:
    """A column as numbers."""
    import pandas as pd

    try:
        return pd.to_numeric(frame[name]).to_numpy(dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{_WHERE}: column '{name}': expected numbers ({error}).") from error


def _require_unit(channel: str, values: Array, site: Place) -> None:
    """Refuse a channel that is in another unit as a whole; single wrong values are left to the run."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return
    limits, middle, highest = BY_NAME.get(channel), float(np.median(finite)), float(finite.max())
    wrong = limits is not None and not limits.low <= middle <= limits.high
    if channel == "global_horizontal" and abs(site.latitude) < _POLAR:
        # By day even a dark sky gives more than 2 W/m2.
        bright = int(np.count_nonzero(finite > 0.05 * highest))
        wrong = wrong or (0.1 < highest <= 2.0 and bright > 0.1 * len(finite))
    if wrong and limits is not None:
        raise InputError(
            f"{_WHERE}: {channel} ({' or '.join(_NAMES[channel])}): found a median of {middle:g} and "
            f"a maximum of {highest:g}, expected {limits.unit}, from {limits.low:g} to {limits.high:g}, as "
            f"pvlib.iotools gives it; {_CONVERSIONS.get(limits.unit, 'convert the column')} in the frame."
        )


def _require_percent(values: Array) -> None:
    highest = np.max(values, initial=0.0, where=np.isfinite(values))
    if 0.0 < highest <= 1.5:
        raise InputError(
            f"{_WHERE}: relative_humidity: found a maximum of {highest:g}, expected percent, from 0 to 100; "
            "multiply a fraction by 100 in the frame."
        )


def _months_of_several_years(frame: pd.DataFrame) -> bool:
    """Whether the stamps go back where a month ends, at most eleven times, as in a typical year."""
    steps = np.diff(cast("pd.DatetimeIndex", frame.index).asi8)
    return bool(0 < np.count_nonzero(steps < 0) <= 11)


def _derive(frame: pd.DataFrame, out: dict[str, Array], notes: list[str]) -> None:
    """Irradiances and wind that a source gives as components."""

    def numbers(name: str) -> Array:
        return np.asarray(frame[name].to_numpy(dtype=np.float64))

    parts = ("poa_direct", "poa_sky_diffuse", "poa_ground_diffuse")
    # A horizontal plane, and only that one, receives nothing from the ground.
    if "global_horizontal" not in out and all(name in frame.columns for name in parts):
        beam, sky, ground = (numbers(name) for name in parts)
        if not ground.any():
            out["global_horizontal"], out["diffuse_horizontal"] = beam + sky, sky
            notes.append(f"{_WHERE}: global and diffuse irradiance from the components on the horizontal.")
    if "bhi" in frame.columns and "diffuse_horizontal" not in out and "global_horizontal" in out:
        out["diffuse_horizontal"] = np.maximum(out["global_horizontal"] - numbers("bhi"), 0.0)
        notes.append(f"{_WHERE}: diffuse irradiance from global and direct on the horizontal (bhi).")
    if "wind_speed" not in out and {"u10", "v10"} <= set(frame.columns):
        east, north = numbers("u10"), numbers("v10")
        out["wind_speed"] = np.hypot(east, north)
        out["wind_direction"] = np.degrees(np.arctan2(-east, -north)) % 360.0
        notes.append(f"{_WHERE}: wind from its components to the east and to the north (u10, v10).")


def _started(table: Table) -> Table:
    """Stamps in the middle of an interval, moved to its start."""
    frame = table.frame.set_axis(
        cast("pd.DatetimeIndex", table.frame.index) - _seconds(0.5 * table.interval), axis=0
    )
    note = f"{_WHERE}: a stamp marks the middle of its interval; all values are taken as its means."
    return replace(table, frame=frame, notes=(*table.notes, note))


# ---------------------------------------------------------------------- typical years


def _ordered(columns: pd.DataFrame, marked: PvlibStamps, zone: tzinfo) -> pd.DataFrame:
    """The rows of a typical year, labeled by one year of 365 days and in its order."""
    import pandas as pd

    if not fixed_offset(zone):
        raise InputError(
            f"{_WHERE}: timezone {zone_name(zone)} has summer time, expected a fixed offset such as UTC+1 "
            "for a typical year."
        )
    index = cast("pd.DatetimeIndex", columns.index)
    local = index.tz_localize(zone) if index.tz is None else index.tz_convert(zone)
    naive = local.tz_localize(None)
    days = 366 if len(columns) % 366 == 0 and len(columns) % 365 else 365
    if len(columns) % days or _DAY % (len(columns) // days):
        raise InputError(
            f"{_WHERE}: found {len(columns)} rows for a typical year, expected 365 whole days; a record of "
            "several years has typical=False."
        )
    interval = _DAY / (len(columns) // days)
    shift = _seconds({"start": 0.0, "instant": 0.0, "middle": 0.5 * interval, "end": interval}[marked])
    keep = np.ones(len(columns), dtype=bool)
    if days == 366:
        starts = naive - shift
        keep = ~((starts.month == 2) & (starts.day == 29))
    else:
        # The end of 28 February may be stamped 29 February or 1 March; both are 1 March of 2001.
        late = (naive.month == 2) & (naive.day == 29)
        moved = naive.where(~late, naive + _seconds(_DAY))
        same_year = [stamp.replace(year=2001) for stamp in moved]
        starts = pd.DatetimeIndex(same_year) - shift
    labels = pd.DatetimeIndex([stamp.replace(year=2001) for stamp in starts[keep]])
    frame = columns.loc[keep].set_axis(labels + shift, axis=0).sort_index()
    first = labels.min()
    if first != pd.Timestamp(2001, 1, 1) or labels.has_duplicates:
        raise InputError(
            f"{_WHERE}: the rows are not those of one year of 365 days in {zone_name(zone)}: the first "
            f"interval starts at {first:%m-%d %H:%M}, expected 01-01 00:00, every time once. Check stamps, "
            "and timezone, which must be that of the stamps."
        )
    frame.index = pd.DatetimeIndex(frame.index).tz_localize(zone)
    return frame


def _periodic(record: WeatherRecord, *, late: bool) -> WeatherRecord:
    """The record as a year that is repeated at its end."""
    columns, closing = dict(record.columns), dict(record.closing)
    for name in closing:
        values = columns[name].copy()
        if late:
            # The value at the end of the year is the one at its start.
            values[0] = closing[name]
        closing[name] = float(values[0])
        columns[name] = values
    note = (
        f"{_WHERE}: one typical year of 365 days; it represents any year, is repeated at its end, and 29 "
        "February takes the values of 28 February."
    )
    grid = replace(record.grid, periodic=True)
    return replace(record, columns=columns, closing=closing, grid=grid, provenance=(*record.provenance, note))


def _seconds(count: float) -> pd.Timedelta:
    import pandas as pd

    return pd.Timedelta(seconds=count)
