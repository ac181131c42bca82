"""Files of archives that say by their own rules what their columns are: BSRN stations, Meteo-France.

Both are recognized by what is in them. The layout of BSRN is read by pvlib; names and units of Meteo-France
are those of its description of the hourly data of stations.

References
----------
Driemel et al. 2018, Earth System Science Data 10, 1491-1501, doi:10.5194/essd-10-1491-2018 (BSRN).
Meteo-France, Donnees climatologiques de base, horaires (data.gouv.fr), description of the fields.
"""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

#: First letters of a station-to-archive file.
_BSRN: Final = (b"*C0001", b"*U0001")
_BSRN_UNITS: Final = {
    "ghi": "W/m2", "dni": "W/m2", "dhi": "W/m2", "lwd": "W/m2", "temp_air": "degC",
    "relative_humidity": "%", "pressure": "hPa",
}  # fmt: skip
_STATION: Final = "NUM_POSTE"
_HOUR: Final = "AAAAMMJJHH"
#: Departements overseas begin here; the first digits of a station are its departement.
_OVERSEAS: Final = 97
_ABOUT: Final = (_STATION, "NOM_USUEL", "LAT", "LON", "ALTI")
_METEO_FRANCE: Final = {
    "T": "degC", "TD": "degC", "TN": "degC", "TX": "degC", "T10": "degC", "T20": "degC", "T50": "degC",
    "T100": "degC", "U": "%", "FF": "m/s", "FF2": "m/s", "FXI": "m/s", "FXY": "m/s", "DD": "deg",
    "PSTAT": "hPa", "PMER": "hPa", "GLO": "J/cm2", "GLO2": "J/cm2", "DIR": "J/cm2", "DIR2": "J/cm2",
    "DIF": "J/cm2", "DIF2": "J/cm2", "INFRAR": "J/cm2", "INFRAR2": "J/cm2", "RR1": "mm", "N": "oktas",
}  # fmt: skip


def unpacked(path: Path, content: bytes) -> tuple[Path, bytes]:
    """Name and content of a file without the compression by gzip.

    Parameters
    ----------
    path : Path
        The file; one that ends in .gz is unpacked.
    content : bytes
        What is in it.

    Raises
    ------
    InputError
        The file is damaged.
    """
    if path.suffix.lower() != ".gz":
        return path, content
    try:
        return path.with_suffix(""), gzip.decompress(content)
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(
            f"{path.name}: found a file that gzip cannot unpack ({error}), expected a whole one; get the "
            "file again."
        ) from error


def is_bsrn(content: bytes) -> bool:
    """Whether a file is a station-to-archive file of the Baseline Surface Radiation Network."""
    return content[:6] in _BSRN


def read_bsrn(path: Path, content: bytes) -> pd.DataFrame:
    """The basic measurements of a station: logical record 0100, minute by minute in UTC.

    Parameters
    ----------
    path : Path
        The file; it may be compressed.
    content : bytes
        What is in it, unpacked.

    Returns
    -------
    pandas.DataFrame
        Its means of minutes, with their units.

    Raises
    ------
    InputError
        The record is not there, or the file is damaged.
    """
    from pvlib.iotools import read_bsrn as read

    text = content.decode("latin-1").splitlines()
    heads = [k for k, line in enumerate(text) if line.startswith("*")]
    begin = next((k for k in heads if text[k][2:6] == "0100"), None)
    if begin is None:
        codes = ", ".join(text[k][2:6] for k in heads)
        raise InputError(
            f"{path.name}: found the logical records {codes}, expected 0100, the basic measurements; get the "
            "file of another month, or of another station."
        )
    end = next((k for k in heads if k > begin), len(text))
    rows = [line for line in text[begin + 1 : end] if line.strip()]
    short = next((k for k, line in enumerate(rows) if len(line.split()) < 8), None)
    if short is not None or len(rows) % 2:
        line = begin + 2 + (len(rows) - 1 if short is None else short)
        raise InputError(
            f"{path.name}:{line}: found {text[line - 1]!r}, expected two lines of measurements for each "
            "minute: the file is cut or damaged; get it again."
        )
    try:
        frame: pd.DataFrame = read(path)[0]
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise InputError(
            f"{path.name}: found a station-to-archive file that cannot be read ({error}), expected one of "
            "BSRN; get it again."
        ) from error
    basic: pd.DataFrame = frame[list(_BSRN_UNITS)].astype("float64")
    basic.index.name = "time"
    basic.attrs["units"] = dict(_BSRN_UNITS)
    return basic


def is_meteo_france(frame: pd.DataFrame) -> bool:
    """Whether a table has hourly data of Meteo-France."""
    return _STATION in frame.columns and _HOUR in frame.columns


def of_one_station(frame: pd.DataFrame, where: str) -> tuple[pd.DataFrame, dict[str, str], str]:
    """The measurements of a table of Meteo-France, their units and their clock, without codes of quality.

    Hours are UTC in mainland France and Corsica. Overseas they are those of the place, whose zone the user
    states.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        There are several stations.
    """
    stations = frame[_STATION].dropna().unique()
    if len(stations) != 1:
        first = stations[0]
        raise InputError(
            f"{where}: column {_STATION!r}: found {len(stations)} stations "
            f"({', '.join(map(str, stations[:5]))}{' ...' if len(stations) > 5 else ''}), expected one. "
            f"Write its rows to a file of their own: grep -E '^({_STATION}|0*{first};)' {where} > {first}.csv"
        )
    names = [str(name) for name in frame.columns]
    codes = {name for name in names if name.startswith("Q") and name[1:] in names}
    columns = [name for name in names if name not in codes and name not in _ABOUT and name != _HOUR]
    # The hour first: it is the time.
    overseas = int(stations[0]) // 1_000_000 >= _OVERSEAS
    units = {name: _METEO_FRANCE[name] for name in columns if name in _METEO_FRANCE}
    return frame[[_HOUR, *columns]], units, "" if overseas else "UTC"
