"""A climate of one year as an EPW file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io import atomic
from mascarin.errors import InputError
from mascarin.physics import humidity_of_dew_point
from mascarin.weather.derived.sun_position import states_position
from mascarin.weather.records.channels import SUN_POSITION

if TYPE_CHECKING:
    from mascarin.weather.climate import Climate

#: Field of the file, digits after the point, and entry for an unknown value.
_FIELDS: Final = {
    "air_temperature": (6, 2, "99.9"),
    "dew_point": (7, 2, "99.9"),
    "relative_humidity": (8, 0, "999"),
    "pressure": (9, 0, "999999"),
    "infrared": (12, 1, "9999"),
    "global_horizontal": (13, 1, "9999"),
    "direct_normal": (14, 1, "9999"),
    "diffuse_horizontal": (15, 1, "9999"),
    "wind_direction": (20, 0, "999"),
    "wind_speed": (21, 2, "999"),
    "cloud_cover": (23, 0, "99"),
}
_UNKNOWN: Final = (
    "", "", "", "", "", "?9?9?9?9E0?9?9?9?9?9?9?9?9?9?9?9?9?9?9?9*9*9?9?9?9", "99.9", "99.9", "999", "999999",
    "9999", "9999", "9999", "9999", "9999", "9999", "999999", "999999", "999999", "9999", "999", "999", "99",
    "99", "9999", "99999", "9", "999999999", "999", "0.999", "999", "99", "999", "999", "99",
)  # fmt: skip
_YEAR: Final = (8760, 8784)


def write_epw(climate: Climate, path: str | Path) -> None:
    """Write a climate of one year as an EPW file, which `Climate.from_epw` and EnergyPlus read.

    Parameters
    ----------
    climate : Climate
        A whole year of hours, with its site.
    path : str or Path
        The file; one that exists is replaced.

    Raises
    ------
    InputError
        The climate is no whole year of hours, its site is not known, or it states the position of the sun.

    Examples
    --------
    >>> import tempfile
    >>> import mascarin as mc
    >>> file = Path(tempfile.mkdtemp()) / "tampa.epw"
    >>> write_epw(mc.Climate.shipped("tampa"), file)
    >>> mc.Climate.from_epw(file).grid.periodic
    True
    """
    grid, site = climate.grid, climate.site
    first = climate.index[0]
    is_full_year = (
        grid.interval == 3600.0 and grid.count in _YEAR and (first.month, first.day, first.hour) == (1, 1, 0)
    )
    if not is_full_year or site is None:
        raise InputError(
            f"{climate.file}: found {'no site' if is_full_year else grid.span()}; expected a climate of one "
            "calendar year of hours, from 1 January 00:00 on, with its site"
        )
    if states_position(climate.record):
        raise InputError(
            f"{climate.file}: found the position of the sun in the columns {' and '.join(SUN_POSITION)}, "
            "which an EPW file cannot have; expected a climate without them. Read the table "
            "without these columns"
        )
    columns = {name: _ending(climate, name) for name in climate.data.columns if name in _FIELDS}
    if {"air_temperature", "dew_point"} <= columns.keys():
        columns["relative_humidity"] = humidity_of_dew_point(columns["air_temperature"], columns["dew_point"])
    rows = []
    texts = {name: _texts(values, *_FIELDS[name][1:]) for name, values in columns.items()}
    for k, stamp in enumerate(climate.index):
        row = list(_UNKNOWN)
        # Readers know a typical year by months of several years: the file has no other mark for it.
        year = stamp.year + (1 if grid.periodic and stamp.month > 1 else 0)
        row[:5] = [str(year), str(stamp.month), str(stamp.day), str(stamp.hour + 1), "0"]
        for name, text in texts.items():
            row[_FIELDS[name][0]] = text[k]
        rows.append(",".join(row))
    atomic.write(Path(path), "\n".join([*_head(climate), *rows]) + "\n")


def _head(climate: Climate) -> list[str]:
    site = climate.site
    assert site is not None  # noqa: S101 (checked before)
    first = climate.index[0]
    offset = first.utcoffset()
    hours = 0.0 if offset is None else offset.total_seconds() / 3600.0
    name = site.name.replace(",", " ") or "unknown"
    notes = " ".join(climate.provenance).replace(",", ";")[-400:]
    return [
        f"LOCATION,{name},-,-,Mascarin,000000,{site.latitude:.4f},{site.longitude:.4f},{hours:g},"
        f"{site.altitude:.1f}",
        "DESIGN CONDITIONS,0",
        "TYPICAL/EXTREME PERIODS,0",
        "GROUND TEMPERATURES,0",
        "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0",
        f"COMMENTS 1,{notes}",
        "COMMENTS 2,written by Mascarin",
        f"DATA PERIODS,1,1,Data,{first:%A},1/1,12/31",
    ]


def _ending(climate: Climate, name: str) -> np.ndarray:
    """Values as the file has them: those at the end of an hour, or means of the hour."""
    values = climate.data[name].to_numpy(dtype=np.float64)
    if climate.kinds[name] == "mean":
        return values
    return np.append(values[1:], climate.record.closing.get(name, values[-1]))


def _texts(values: np.ndarray, digits: int, unknown: str) -> list[str]:
    return [unknown if np.isnan(value) else f"{value:.{digits}f}" for value in values]
