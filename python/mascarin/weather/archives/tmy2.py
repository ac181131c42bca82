"""Typical meteorological years of the second collection (TMY2, NREL 1995), read by pvlib.

References
----------
Marion & Urban 1995, User's Manual for TMY2s, NREL/SP-463-7668, doi:10.2172/87130.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mascarin._io.regular import require_regular
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

ENDING: Final = ".tm2"
_HOURS: Final = 8760
_WIDTH: Final = 142
#: Name of pvlib, field of the file, its number that means no value, and factor to the unit of pvlib.
_FIELDS: Final = {
    "ghi": ("GHI", 9999, 1.0), "dni": ("DNI", 9999, 1.0), "dhi": ("DHI", 9999, 1.0),
    "temp_air": ("DryBulb", 9999, 0.1), "temp_dew": ("DewPoint", 9999, 0.1),
    "relative_humidity": ("RHum", 999, 1.0), "pressure": ("Pressure", 9999, 1.0),
    "wind_direction": ("Wdir", 999, 1.0), "wind_speed": ("Wspd", 999, 0.1),
    "total_sky_cover": ("TotCld", 99, 1.0),
}  # fmt: skip


def read_tmy2(path: Path) -> tuple[pd.DataFrame, dict[str, Any]]:
    """A file as pvlib names its quantities, and its place; stamps are those of the ends of hours.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    frame : pandas.DataFrame
        Irradiances [W/m2], temperatures [degC], humidity [%], pressure [hPa], wind [deg, m/s].
    metadata : dict
        Latitude, longitude [deg] and altitude [m].

    Raises
    ------
    InputError
        The file is not there, cut or damaged.
    """
    import pandas as pd
    from pvlib.iotools import read_tmy2 as read

    require_regular(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file; give the path from the folder you work in.")
    lines = path.read_text(encoding="latin-1").splitlines()
    if len(lines) != _HOURS + 1:
        raise InputError(
            f"{path.name}: found {max(len(lines) - 1, 0)} hours below the first line, expected {_HOURS}: the "
            "file is cut or damaged; get it again."
        )
    short = next((k for k, line in enumerate(lines[1:], start=2) if len(line) < _WIDTH), None)
    if short is not None:
        raise InputError(
            f"{path.name}:{short}: found a line of {len(lines[short - 1])} characters, expected {_WIDTH}; "
            "get the file again."
        )
    try:
        table, meta = read(str(path))
        fields = {
            name: pd.to_numeric(table[field]).astype("float64").mask(lambda v, n=none: v >= n) * factor
            for name, (field, none, factor) in _FIELDS.items()
        }
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise InputError(
            f"{path.name}: cannot be read as TMY2 ({error}), expected a file of NREL; get it again."
        ) from error
    frame = pd.DataFrame(fields)
    # pvlib labels hour 1, which ends at 1:00, by 0:00.
    frame.index = pd.DatetimeIndex(table.index) + pd.Timedelta(hours=1)
    return frame, {name: float(meta[name]) for name in ("latitude", "longitude", "altitude")}
