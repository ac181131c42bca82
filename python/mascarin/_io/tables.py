"""Tables from CSV files, with the numbers as they are written."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TextIO

if TYPE_CHECKING:
    import pandas as pd

#: First version of pandas that reads every number exactly by itself, and deprecates the argument for it.
_EXACT: Final = (3, 1)


def read_csv(path: Path | TextIO, **options: Any) -> pd.DataFrame:
    r"""Read a CSV file; each number is the floating-point number nearest to its text.

    Older versions of pandas read some numbers with an error in the last digit, unless asked not to.

    Parameters
    ----------
    path : Path or text file
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
    found: pd.DataFrame = pd.read_csv(path, **options)
    return found
