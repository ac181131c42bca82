"""Carpet plots: one pixel per instant, a column for each day, midnight at the bottom, as a small PNG."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
import numpy.typing as npt

from mascarin.figures.svg.chart import Array

#: Colors at -limit, -limit/2, 0, +limit/2, +limit: blue to red through a light grey; distinct in the
#: common kinds of color blindness because they differ in lightness and on the blue-yellow axis.
STOPS = ((8, 64, 129), (91, 155, 203), (240, 239, 235), (232, 142, 88), (148, 30, 18))
#: Color of instants without a value.
EMPTY = (150, 150, 150)
_LEVELS = 201
_MAX_ROWS = 96


@dataclass(frozen=True)
class Carpet:
    """Picture of an error over days and hours.

    Parameters
    ----------
    image : str
        The picture as a ``data:`` address.
    columns, rows : int
        Days and instants in a day. [-]
    limit : float
        Value of the darkest colors.
    days : list of (int, str)
        Marks of the day axis: column and date.
    """

    image: str
    columns: int
    rows: int
    limit: float
    days: list[tuple[int, str]]


def carpet(start: datetime, step: float, values: Array, limit: float) -> Carpet:
    """Draw values over days (across) and hours (midnight at the bottom).

    Parameters
    ----------
    start : datetime
        Time of the first value.
    step : float
        Distance of two values. [s]
    values : array, shape (n,)
        One value per instant.
    limit : float
        Value of the darkest colors, the same to both sides.
    """
    first = start.replace(hour=0, minute=0, second=0, microsecond=0)
    offset = (start - first).total_seconds()
    rows = int(min(_MAX_ROWS, max(1.0, 86400.0 // step)))
    seconds = offset + step * np.arange(len(values))
    days = (seconds // 86400.0).astype(np.intp)
    slots = (seconds % 86400.0 / 86400.0 * rows).astype(np.intp)
    columns = int(days[-1]) + 1 if len(days) else 1
    total, count = np.zeros((rows, columns)), np.zeros((rows, columns))
    good = np.isfinite(values)
    np.add.at(total, (slots[good], days[good]), values[good])
    np.add.at(count, (slots[good], days[good]), 1.0)
    grid = np.where(count > 0, total / np.maximum(count, 1.0), np.nan)[::-1]
    mark_spacing = max(1, round(columns / 6))
    marks = [
        (column, f"{(first + timedelta(days=column)).day} {first + timedelta(days=column):%b}")
        for column in range(0, columns, mark_spacing)
        if column < 0.93 * columns
    ]
    return Carpet(_address(_levels(grid, limit)), columns, rows, limit, marks)


def legend() -> str:
    """Give the color scale from low to high as a ``data:`` address of a picture one pixel high."""
    scale = np.arange(_LEVELS, dtype=np.uint8)[None, :] + np.uint8(1)
    return _address(scale)


def round_limit(spread: float) -> float:
    """Smallest of 1, 2, 5 times a power of ten that is not below a value."""
    if not spread > 0.0:
        return 1.0
    size = 10.0 ** np.floor(np.log10(spread))
    return float(next(m * size for m in (1.0, 2.0, 5.0, 10.0) if m * size >= spread * (1.0 - 1e-9)))


def _levels(grid: Array, limit: float) -> npt.NDArray[np.uint8]:
    level = np.clip((grid / limit + 1.0) * 0.5, 0.0, 1.0) * (_LEVELS - 1)
    levels = np.where(np.isfinite(grid), np.round(np.nan_to_num(level)) + 1.0, 0.0)
    return levels.astype(np.uint8)


def _palette() -> list[int]:
    """Red, green and blue of each level; level 0 is :data:`EMPTY`."""
    positions = np.linspace(0.0, 1.0, _LEVELS)
    stops = np.array(STOPS, dtype=np.float64)
    stop_positions = np.linspace(0.0, 1.0, len(stops))
    colors = np.column_stack([np.interp(positions, stop_positions, stops[:, c]) for c in range(3)])
    return [*EMPTY, *np.round(colors).astype(int).ravel().tolist()]


def _address(levels: npt.NDArray[np.uint8]) -> str:
    """A picture with a palette as a ``data:`` address."""
    from PIL import Image

    picture = Image.fromarray(levels, mode="P")
    picture.putpalette(_palette())
    file = io.BytesIO()
    picture.save(file, format="PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode("ascii")
