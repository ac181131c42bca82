"""Series of a report on one regular time axis, in a compact form.

In a file each column is 16-bit integers with an offset and a scale, in base64: values are exact
to 1/65000 of the span of the column (about 1 mK for a roof).
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, TypedDict

import numpy as np
import numpy.typing as npt

from mascarin._io import atomic
from mascarin._io.sealed import own_files
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: Largest number of values over all columns in a report; longer series are thinned.
MAX_VALUES = 600_000
_MISSING_CODE = -32768
_LEVELS = 65_000


class _Column(TypedDict):
    label: str
    unit: str
    offset: float
    scale: float
    data: str


@dataclass(frozen=True)
class Column:
    """A curve.

    Parameters
    ----------
    values : array, shape (n,)
        Values at the instants; NaN where there is none or it is masked. [unit]
    label : str
        What it is, for legends.
    unit : str
        Unit, for axes (``degC`` is shown as °C).
    """

    values: Array
    label: str
    unit: str


@dataclass(frozen=True)
class Series:
    """Curves on one regular time axis.

    Columns named ``<model>/<sensor>`` belong to a sensor, ``observed/<sensor>`` being what was measured;
    ``weather/<name>`` and ``state/<name>`` are shown beside them.

    Parameters
    ----------
    start : str
        First instant, ISO 8601 local time without offset.
    step : float
        Distance of two instants. [s]
    columns : mapping of str to Column
        Curves of one length.
    """

    start: str
    step: float
    columns: Mapping[str, Column] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check that all columns have one length and that the axis can be read."""
        lengths = {key: len(column.values) for key, column in self.columns.items()}
        if len(set(lengths.values())) > 1:
            raise InputError(f"series of different lengths: {lengths}; expected one time axis for all")
        if not (math.isfinite(self.step) and self.step > 0.0):
            raise InputError(f"series: step {self.step} s; expected a positive number of seconds")
        moment(self.start)

    def __len__(self) -> int:
        """Give the number of instants."""
        return next((len(column.values) for column in self.columns.values()), 0)

    def time(self, index: float) -> datetime:
        """Local time of an instant."""
        return moment(self.start) + timedelta(seconds=self.step * index)

    def slice_of(self, start: str, end: str) -> slice:
        """Instants of a span given by two local times, the end not included."""
        first = (moment(start) - moment(self.start)).total_seconds() / self.step
        last = (moment(end) - moment(self.start)).total_seconds() / self.step
        return slice(max(0, math.ceil(first - 1e-6)), max(0, math.ceil(last - 1e-6)))

    def thinned(self, most: int = MAX_VALUES) -> Series:
        """Keep every k-th instant, k as small as the number of values allows.

        Parameters
        ----------
        most : int
            Most values over all columns. [-]

        Returns
        -------
        Series
            The same object if it is small enough.
        """
        stride = max(1, math.ceil(len(self) * len(self.columns) / most))
        if stride == 1:
            return self
        thinned_columns = {k: Column(c.values[::stride], c.label, c.unit) for k, c in self.columns.items()}
        return Series(self.start, self.step * stride, thinned_columns)

    def to_dict(self) -> dict[str, Any]:
        """Give the compact form, ready for JSON."""
        columns = {key: _packed(column) for key, column in self.columns.items()}
        return {"start": self.start, "step": self.step, "count": len(self), "columns": columns}

    @classmethod
    def from_dict(cls, raw: Mapping[str, Any]) -> Series:
        """Read the compact form.

        Raises
        ------
        InputError
            A key is missing or cannot be read.
        """
        try:
            columns = {key: _unpacked(column) for key, column in raw["columns"].items()}
            return cls(str(raw["start"]), float(raw["step"]), columns)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(
                f"series: {type(error).__name__}: {error}; expected the keys start, step and columns as "
                "written by the study; run the study again"
            ) from error

    def write(self, path: Path) -> None:
        """Write the compact form as JSON."""
        atomic.write(path, json.dumps(self.to_dict(), separators=(",", ":")))

    @classmethod
    def read(cls, path: Path) -> Series:
        """Read what :meth:`write` wrote.

        Raises
        ------
        InputError
            The file is missing or is not such a file.
        """
        return cls.from_dict(read_json(path))


def read_json(path: Path) -> dict[str, Any]:
    """Read a JSON object from a file.

    Raises
    ------
    InputError
        The file is missing, no JSON or no object.
    """
    try:
        content = own_files.json_of(own_files.whole(path))
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; expected a file written by 'mascarin study'") from error
    except own_files.DamagedError as error:
        raise InputError(f"{path}: not JSON ({error}); run the study again") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: holds a {type(content).__name__}; expected an object written by the study")
    return content


def moment(text: str) -> datetime:
    """Read a local time without offset.

    Raises
    ------
    InputError
        It is not ISO 8601 or has an offset.
    """
    try:
        time = datetime.fromisoformat(text)
    except (TypeError, ValueError) as error:
        raise InputError(f"time '{text}': expected ISO 8601, e.g. 2012-09-20T00:00") from error
    if time.tzinfo is not None:
        raise InputError(f"time '{text}' has an offset; expected local time of the study's zone")
    return time


def _packed(column: Column) -> _Column:
    values = np.asarray(column.values, dtype=np.float64)
    finite = values[np.isfinite(values)]
    low = float(finite.min()) if finite.size else 0.0
    high = float(finite.max()) if finite.size else 0.0
    scale = (high - low) / _LEVELS or 1.0
    levels = np.where(np.isfinite(values), np.round((values - low) / scale) - _LEVELS // 2, _MISSING_CODE)
    data = base64.b64encode(levels.astype("<i2").tobytes()).decode("ascii")
    return {"label": column.label, "unit": column.unit, "offset": low, "scale": scale, "data": data}


def _unpacked(raw: Mapping[str, Any]) -> Column:
    levels = np.frombuffer(base64.b64decode(raw["data"]), dtype="<i2").astype(np.float64)
    values = (levels + _LEVELS // 2) * float(raw["scale"]) + float(raw["offset"])
    values[levels == _MISSING_CODE] = math.nan
    return Column(values, str(raw["label"]), str(raw["unit"]))
