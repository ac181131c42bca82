"""Grids that are fine where the heat flow bends: at the edges of a floor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Width of the cells at an edge, and by how much each is wider than its neighbour towards it. [m], [-]
FINE: Final = (0.02, 1.2)
#: The same where all of the block is solved at once.
COARSE: Final = (0.05, 1.3)
#: Lengths below this are none. [m]
_NOTHING: Final = 1e-9


def graded(length: float, first: bool, last: bool, size: tuple[float, float] = FINE) -> Array:
    """Widths of cells that grow away from one end of a length, or from both.

    Parameters
    ----------
    length : float
        What the cells add up to. [m]
    first, last : bool
        Whether the cells are finest at the beginning, and at the end.
    size : (float, float)
        Width of the finest cells, and by how much each is wider than its neighbour. [m], [-]

    Returns
    -------
    ndarray
        Widths in order. [m]

    Examples
    --------
    >>> cells = graded(2.0, True, False)
    >>> bool(cells[0] < 0.05 < cells[-1]), round(float(cells.sum()), 12)
    (True, 2.0)
    """
    if first and last:
        half = graded(0.5 * length, True, False, size)
        return np.concatenate([half, half[::-1]])
    finest, growth = size
    count = max(2, math.ceil(math.log1p(length * (growth - 1.0) / finest) / math.log(growth)))
    widths = growth ** np.arange(count)
    widths *= length / widths.sum()
    return np.asarray(widths if first else widths[::-1], dtype=np.float64)


def axis(
    edges: Sequence[float], fine: Sequence[float], size: tuple[float, float] = FINE
) -> tuple[Array, Array]:
    """Widths and middles of cells between edges, finest at some of them.

    Parameters
    ----------
    edges : sequence of float
        Rising positions that cells end at; equal ones count once. [m]
    fine : sequence of float
        Those at which cells are finest. [m]
    size : (float, float)
        As in `graded`. [m], [-]

    Returns
    -------
    ndarray, ndarray
        Widths and middles. [m]
    """
    ends = [edges[0]]
    for edge in edges[1:]:
        if edge > ends[-1] + _NOTHING:
            ends.append(edge)
    is_fine = [any(abs(end - other) <= _NOTHING for other in fine) for end in ends]
    spans = zip(ends, ends[1:], is_fine, is_fine[1:], strict=False)
    parts = [graded(end - start, first, last, size) for start, end, first, last in spans]
    widths = np.concatenate(parts)
    return widths, ends[0] + np.cumsum(widths) - 0.5 * widths
