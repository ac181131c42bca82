"""What the cases of a suite read and run: their files, climates from numbers, and runs."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

#: Environment variable with the folder of data.
FOLDER: Final = "MASCARIN_DATA"
#: What weather from a few numbers does not have. [m/s, deg, W/m2, degC]
_ABSENT: Final = {
    "wind_speed": 0.0,
    "wind_direction": 0.0,
    "global_horizontal": 0.0,
    "direct_normal": 0.0,
    "diffuse_horizontal": 0.0,
    "dew_point": -40.0,
}

Tree = dict[str, Any]


def unchanged(tree: Tree) -> Tree:
    """The description as it is."""
    return tree


@dataclass(frozen=True)
class CaseData:
    """Files of a suite, and how its buildings are made.

    Parameters
    ----------
    folder : Path
        With the reference numbers.
    change : callable
        Changes each description before it is used: a test takes a physical term away.
    """

    folder: Path
    change: Callable[[Tree], Tree] = unchanged

    def file(self, name: str) -> Path:
        """A file of the suite, or the same compressed.

        Raises
        ------
        InputError
            There is none, or it is where results will be written.
        """
        for path in (self.folder / name, self.folder / f"{name}.gz"):
            if path.is_file():
                require_regular(path)
                return path
        raise InputError(f"{self.folder}: no file '{name}', which the suite compares with")

    def text(self, name: str) -> str:
        """Content of a file."""
        path = self.file(name)
        content = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
        return content.decode("utf-8", errors="replace")

    def building(self, tree: Tree) -> Building:
        """Make a building of a description, as `change` leaves it."""
        from mascarin.building import Building

        return Building.from_dict(self.change(tree))


def folder_of(data: str) -> Path | None:
    """Where the reference numbers of a suite lie; None where they are not there."""
    root = os.environ.get(FOLDER)
    folder = Path(root) / "suites" / data if root else None
    return folder if folder is not None and folder.is_dir() else None


@dataclass(frozen=True)
class CasePlace:
    """Where and when the weather of a case is.

    Parameters
    ----------
    latitude, longitude : float
        [deg]
    timezone : str
        Of the stamps.
    start : str
        First stamp.
    step : str
        Between the stamps.
    """

    latitude: float = 52.383
    longitude: float = 13.067
    timezone: str = "Etc/GMT-1"
    start: str = "2001-01-01"
    step: str = "1h"

    def climate(
        self,
        columns: Mapping[str, Array],
        *,
        extra: Sequence[str] = (),
        instant: Sequence[str] = (),
        mean: Sequence[str] = (),
    ) -> Climate:
        """Make weather of arrays; what is not among them is absent.

        Parameters
        ----------
        columns : mapping of str to ndarray
            Channels and further columns. Radiation is a mean over the step that begins at its stamp.
        extra : sequence of str
            Columns that are no channels of the weather.
        instant, mean : sequence of str
            Columns that hold values at their stamps, or means over the step.
        """
        import pandas as pd

        from mascarin.weather import Climate

        count = len(next(iter(columns.values())))
        index = pd.date_range(self.start, periods=count, freq=self.step, tz=self.timezone)
        channels = {name: name for name in columns if name not in extra}
        return Climate.from_table(
            pd.DataFrame(dict(columns), index=index),
            columns=channels,
            extra=list(extra),
            absent={name: value for name, value in _ABSENT.items() if name not in channels},
            instant=instant,
            mean=mean,
            latitude=self.latitude,
            longitude=self.longitude,
            altitude=0.0,
            check_sun=False,
        )


def simulated(
    building: Building, climate: Climate, outputs: Sequence[str], step: str, initial: Any
) -> tuple[Array, pd.DataFrame]:
    """Run a building over its weather.

    Returns
    -------
    ndarray, shape (n,)
        Time from the start. [h]
    pandas.DataFrame
        Records.
    """
    from mascarin.simulation.run import simulate

    table = simulate(building, climate, step=step, outputs=list(outputs), initial=initial).to_dataframe()
    hours = (table.index - table.index[0]).total_seconds().to_numpy() / 3600.0
    return hours, table
