"""Records of a run in blocks of rows: how many rows have one, where they go, and what is watched in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io import memory
from mascarin.simulation.checks import step_check

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building, Output

    Array = npt.NDArray[np.float64]

#: Largest size of a block. [B] The engine fills one while another one is written.
SIZE: Final = 32 * 2**20
#: Size of a block of few series, and of one that stays in memory, beside all records. [B]
SMALL: Final = 4 * 2**20
#: Rows of a block of many series: a file gets each series in pieces of so many numbers.
ROWS: Final = 4096


def rows_of(columns: int, *, keeps_rows: bool = False) -> int:
    """Rows of a block.

    Parameters
    ----------
    columns : int
        Numbers in a row.
    keeps_rows : bool
        Whether the records stay in memory.

    Examples
    --------
    >>> rows_of(1024)
    4096
    """
    row = 8 * max(columns, 1)
    least = max(SMALL // row, 1)
    return least if keeps_rows else max(min(SIZE // row, ROWS), least)


class InMemory:
    """All rows in one array; a run of one block is not copied.

    Parameters
    ----------
    rows, columns : int
        Shape of the array.

    Raises
    ------
    InputError
        It would take more memory than there is.
    """

    def __init__(self, rows: int, columns: int) -> None:
        memory.require(
            8.0 * rows * columns,
            f"{rows} records of {columns} outputs",
            "write them to a file while the run goes on (mascarin run -o, Simulation.run_into), record fewer "
            "outputs, or take a longer step or a shorter period",
        )
        self._shape = (rows, columns)
        self._whole: Array | None = None
        self._done = 0

    def take(self, rows: Array) -> None:
        """Add the next rows, shape (n, columns)."""
        if self._whole is None:
            if rows.shape == self._shape:
                self._whole = np.ascontiguousarray(rows)
                return
            self._whole = np.empty(self._shape)
        self._whole[self._done : self._done + len(rows)] = rows
        self._done += len(rows)

    @property
    def records(self) -> Array:
        """All rows, shape (rows, columns)."""
        return np.empty(self._shape) if self._whole is None else self._whole


class Watch:
    """What warnings need of all records of a run: phase-change layers that melt, airs that bend.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What is recorded; behind it in a row is what `unmelted.watched` names, then `coarse.watched`.
    scheme : str
        Time-stepping scheme.
    chosen : object, optional
        Steps that were chosen: their error was estimated before the run, so that no air is judged by its
        bends.

    Attributes
    ----------
    melting : Extremes
        Of phase-change layers.
    bends : Bends
        Of air temperatures.
    """

    def __init__(
        self, building: Building, outputs: Sequence[Output], scheme: str = "sdirk2", chosen: object = None
    ) -> None:
        # The package imports pydantic, which an evaluation for GenOpt does without.
        from mascarin.simulation.checks import unmelted

        melting, airs = unmelted.watched(building), step_check.watched(building, outputs)
        self._melting = slice(len(outputs), len(outputs) + len(melting))
        self.melting = unmelted.Extremes(building)
        self.bends = step_check.Bends(building, [*outputs, *melting, *airs] if chosen is None else [], scheme)

    def add(self, rows: Array) -> None:
        """Watch the next rows, shape (n, outputs and watched outputs)."""
        self.melting.add(rows[:, self._melting])
        self.bends.add(rows)
