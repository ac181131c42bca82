"""The forcing of a run: one array, or blocks of steps that are worked out when a run comes to them.

A long run into a file takes the memory of one block. The blocks have the bits that all steps together have:
times count from the start of the period, and what is added up goes on from block to block
(`mascarin.tables.steps.PartOfPeriod`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io import memory

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: A forcing of this size is one array: a year in steps of 15 min takes 10 MB. [B]
SMALL: Final = 16 * 2**20
#: Steps of a block.
STEPS: Final = 2**13
#: From this run in memory on all steps stay there: that takes less time than to work them out for each run.
_AGAIN: Final = 2
#: Channel of the outdoor air.
_AIR: Final = 0


class ForcingBlocks:
    """The forcing of all steps of a run.

    Parameters
    ----------
    shape : (int, int, int)
        Steps, stages, channels.
    blocks : callable
        Begins the blocks of steps again, each an array (steps, stages, channels). [unit of each channel]
    ends : mapping of int to ndarray, shape (steps,)
        Channels at the last stages of all steps, where they are known. [unit of each channel]
    air_temperature : float, optional
        Mean of the outdoor air at these stages, where it is known. [degC]

    Examples
    --------
    >>> import numpy as np
    >>> forcing = ForcingBlocks.of(np.zeros((3, 2, 15)))
    >>> len(forcing), [len(block) for block in forcing.blocks()]
    (3, [3])
    """

    def __init__(
        self,
        shape: tuple[int, int, int],
        blocks: Callable[[], Iterator[Array]],
        ends: Mapping[int, Array] | None = None,
        air_temperature: float | None = None,
    ) -> None:
        self.shape = shape
        self._air_temperature = air_temperature
        self._blocks = blocks
        self._ends = dict(ends or {})
        self._all_steps: Array | None = None
        self._times = 0

    @classmethod
    def of(cls, forcing: Array) -> ForcingBlocks:
        """From all steps, shape (steps, stages, channels). [unit of each channel]"""
        blocks = cls((forcing.shape[0], forcing.shape[1], forcing.shape[2]), lambda: iter([forcing]))
        blocks._all_steps = forcing
        return blocks

    def __len__(self) -> int:
        return self.shape[0]

    def __reduce__(self) -> tuple[Callable[[Array], ForcingBlocks], tuple[Array]]:
        return ForcingBlocks.of, (self.all_steps,)

    @property
    def nbytes(self) -> int:
        """Memory of all steps [B]."""
        return 8 * self.shape[0] * self.shape[1] * self.shape[2]

    @property
    def all_steps(self) -> Array:
        """All steps, shape (steps, stages, channels); they stay in memory. [unit of each channel]

        Raises
        ------
        InputError
            They take more memory than there is.
        """
        if self._all_steps is None:
            advice = "take a longer step or a shorter period"
            memory.require(float(self.nbytes), f"the weather of {len(self)} steps", advice)
            out, done = np.empty(self.shape), 0
            for block in self._blocks():
                out[done : done + len(block)] = block
                done += len(block)
            self._all_steps = out
        return self._all_steps

    def blocks(self, *, keeps_steps: bool = False) -> Iterator[Array]:
        """The blocks of steps; one where all steps are in memory. [unit of each channel]

        Parameters
        ----------
        keeps_steps : bool
            Whether all steps may stay in memory from the second time on.
        """
        if keeps_steps:
            self._times += 1
        if self._all_steps is None and self._times < _AGAIN:
            return self._blocks()
        return iter([self.all_steps])

    @property
    def opening(self) -> Array:
        """All channels at the first stage, shape (channels,). [unit of each channel]"""
        first: Array = next(self.blocks())[0, 0]
        return first

    @property
    def air_temperature(self) -> float:
        """Mean of the outdoor air at the last stages of all steps. [degC]"""
        if self._air_temperature is None:
            return float(self.all_steps[:, -1, _AIR].mean())
        return self._air_temperature

    def ends(self, channel: int) -> Array:
        """A channel at the last stages of all steps, shape (steps,). [its unit]"""
        series = self._ends.get(channel)
        return self.all_steps[:, -1, channel] if series is None else series
