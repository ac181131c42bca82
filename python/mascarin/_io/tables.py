"""Tables from CSV files, with the numbers as they are written."""

from __future__ import annotations

import contextlib
import csv
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final, Protocol, TextIO

from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

#: First version of pandas that reads every number exactly by itself, and deprecates the argument for it.
_EXACT: Final = (3, 1)


class Pieces(Protocol):
    """What gives its bytes piece by piece, as a file does."""

    def read(self, size: int = -1, /) -> bytes:
        """The next bytes; none at the end."""
        ...

    def __iter__(self) -> Iterator[bytes]:
        """All pieces."""
        ...


def read_csv(path: Path | TextIO | BinaryIO | Pieces, **options: Any) -> pd.DataFrame:
    r"""Read a CSV file; each number is the floating-point number nearest to its text.

    Older versions of pandas read some numbers with an error in the last digit, unless asked not to.

    Parameters
    ----------
    path : Path or file
        The file.
    **options
        Passed to `pandas.read_csv`.

    Returns
    -------
    pandas.DataFrame
        The table.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "table.csv"
    ...     _ = file.write_text("x;y\n1.5;2\n")
    ...     read_csv(file, sep=";").to_dict("list")
    {'x': [1.5], 'y': [2]}
    """
    import pandas as pd

    version = tuple(int(part) for part in pd.__version__.split(".")[:2])
    if version < _EXACT:
        options["float_precision"] = "round_trip"
    table: pd.DataFrame = pd.read_csv(path, **options)  # type: ignore[arg-type, assignment, unused-ignore]
    return table


@contextlib.contextmanager
def csv_refused(where: str) -> Iterator[None]:
    """Refuse a text that the module `csv` cannot read, such as one with a field that never ends.

    Parameters
    ----------
    where : str
        The file, for the message.

    Raises
    ------
    InputError
        The text cannot be read.

    Examples
    --------
    >>> with csv_refused("table.csv"):
    ...     list(csv.reader(["x" * 200000]))
    Traceback (most recent call last):
    mascarin.errors.InputError: table.csv: found no table that can be read (field larger than field limit ...
    """
    try:
        yield
    except csv.Error as error:
        raise InputError(
            f"{where}: found no table that can be read ({error}); expected lines of short fields. Look for a "
            "quotation mark that is not closed, or for another file under this name"
        ) from None


class JoinedBytes:
    """A file of bytes one after the other, which are not copied before they are read."""

    mode = "r"  # pandas passes what it reads on to its parser, as bytes

    def __init__(self, pieces: Iterable[bytes | memoryview]) -> None:
        self._pieces = [memoryview(piece) for piece in pieces]

    def read(self, size: int = -1) -> bytes:
        """The next bytes; none at the end."""
        while self._pieces:
            piece = self._pieces[0]
            if len(piece):
                end = len(piece) if size < 0 else size
                self._pieces[0] = piece[end:]
                return bytes(piece[:end])
            del self._pieces[0]
        return b""

    def __iter__(self) -> Iterator[bytes]:
        """Pieces of a fixed size."""
        return iter(lambda: self.read(_PIECE), b"")


#: Bytes of a piece where no number is asked for.
_PIECE: Final = 200_000
