"""Readers of one's own for files of tables, and NetCDF.

A package offers a function under the entry point ``mascarin.table_readers``; the name of the entry is the
ending of the files, such as ``dtf``. In Python `register_reader` does the same for the running program. The
function takes a path and returns a `pandas.DataFrame` with a column or an index of times; units may stand in
``frame.attrs["units"]``, a mapping of column to unit.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from mascarin.errors import InputError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    import pandas as pd

Reader: TypeAlias = "Callable[[Path], pd.DataFrame]"

GROUP: Final = "mascarin.table_readers"
_NETCDF: Final = frozenset({"nc", "nc4", "cdf"})
_REGISTERED: Final[dict[str, Reader]] = {}


def register_reader(ending: str, reader: Reader | None) -> None:
    """Read files with an ending by a function, in this program.

    Parameters
    ----------
    ending : str
        Ending of the files, such as ``dtf``.
    reader : callable or None
        Takes a `pathlib.Path` and returns a frame; None: no longer.

    Raises
    ------
    InputError
        The ending is empty.

    Examples
    --------
    >>> import pandas as pd
    >>> register_reader("dtf", lambda path: pd.read_csv(path, sep="!"))
    >>> reader_of(Path("log.dtf")) is None
    False
    >>> register_reader("dtf", None)
    """
    key = ending.strip(". ").lower()
    if not key:
        raise InputError(f"register_reader: found the ending {ending!r}; expected one such as 'dtf'")
    if reader is None:
        _REGISTERED.pop(key, None)
    else:
        _REGISTERED[key] = reader


def reader_of(path: Path) -> Reader | None:
    """The reader for a file: registered, of an installed package, or that of NetCDF.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    callable or None
        None where Mascarin reads the file as a table itself.

    Raises
    ------
    InputError
        Two packages offer a reader for the ending.
    """
    ending = path.suffix.lower().lstrip(".")
    if ending in _REGISTERED:
        return _REGISTERED[ending]
    offered = _entries().get(ending, ())
    if len(offered) > 1:
        names = " and ".join(entry.value for entry in offered)
        raise InputError(
            f"{path.name}: found two readers for files ending in .{ending}, {names}; expected one. "
            f"Uninstall the "
            "package of the other one, or choose in Python with register_reader"
        )
    if offered:
        return _loaded(offered[0])
    return _netcdf if ending in _NETCDF else None


def name_of(reader: Reader) -> str:
    """Name of a reader with its module.

    Parameters
    ----------
    reader : callable
        From `reader_of`.
    """
    return f"{getattr(reader, '__module__', '')}.{getattr(reader, '__name__', type(reader).__name__)}"


def read_own(path: Path, reader: Reader) -> pd.DataFrame:
    """The frame of a reader.

    Parameters
    ----------
    path : Path
        The file.
    reader : callable
        From `reader_of`.

    Raises
    ------
    InputError
        The reader fails, or what it returns is no table.
    """
    import pandas as pd

    name = getattr(reader, "__name__", type(reader).__name__)
    try:
        frame = reader(path)
    except InputError:
        raise
    except Exception as error:  # code of others may raise anything
        raise InputError(
            f"{path.name}: the reader {name!r} for files ending in {path.suffix} failed "
            f"({type(error).__name__}: {error}); expected a table. Correct the file or the reader"
        ) from error
    if not isinstance(frame, pd.DataFrame):
        raise InputError(
            f"{path.name}: the reader {name!r} returned {type(frame).__name__}; expected a pandas.DataFrame"
        )
    return frame


@cache
def _entries() -> dict[str, tuple[EntryPoint, ...]]:
    """Entry points by the ending of their files."""
    from importlib.metadata import entry_points

    readers: dict[str, tuple[EntryPoint, ...]] = {}
    for entry in entry_points(group=GROUP):
        key = entry.name.strip(". ").lower()
        readers[key] = (*readers.get(key, ()), entry)
    return readers


def _loaded(entry: EntryPoint) -> Reader:
    try:
        reader: Reader = entry.load()
    except Exception as error:  # a package of others
        raise InputError(
            f"{GROUP}: the reader {entry.value} cannot be imported ({type(error).__name__}: {error}); "
            f"expected a "
            "function. Repair or uninstall its package"
        ) from error
    return reader


def _netcdf(path: Path) -> pd.DataFrame:
    """Variables of a NetCDF file that vary with the time alone, and their units."""
    import xarray as xr

    try:
        with xr.open_dataset(path) as opened:
            data = opened.load().squeeze()
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(
            f"{path.name}: cannot be read as NetCDF ({error}), expected a whole file; get it again"
        ) from error
    times = [name for name, index in data.indexes.items() if index.dtype.kind == "M"]
    if len(times) != 1:
        raise InputError(
            f"{path.name}: found {len(times)} coordinates of time ({', '.join(map(str, data.dims))}); "
            "expected one: select the others first, such as data.isel(step=0)"
        )
    names = [str(name) for name in data.data_vars if data[name].dims == (times[0],)]
    if not names:
        sizes = ", ".join(f"{name} ({size})" for name, size in data.sizes.items())
        raise InputError(
            f"{path.name}: found no variable that varies with {times[0]!r} alone (dimensions "
            f"{sizes}); expected the "
            "series of one place: select it first, such as data.sel(latitude=..., "
            "longitude=...).to_netcdf(...)"
        )
    frame = data[names].drop_vars([name for name in data.coords if name != times[0]]).to_dataframe()
    frame.index.name = "time"
    frame.attrs["units"] = {name: str(data[name].attrs.get("units", "")) for name in names}
    return frame
