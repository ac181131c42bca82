"""Common to all methods: the plan of runs in replicates, and the collection of their outputs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.base.result import Sensitivity


class Runs(Protocol):
    """A plan of runs: several replicates of equal size."""

    @property
    def method(self) -> str:
        """Name of the method."""
        ...

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the parameters, the columns of the samples."""
        ...

    @property
    def replicates(self) -> int:
        """Number of replicates. [-]"""
        ...

    @property
    def runs(self) -> int:
        """Runs per replicate. [-]"""
        ...

    def __len__(self) -> int:
        """Number of runs in all replicates. [-]"""
        ...

    def samples(self, replicate: int) -> Floats:
        """Parameter values of one replicate, shape (N, P). [unit of each parameter]"""
        ...


PlanT_co = TypeVar("PlanT_co", bound=Runs, covariant=True)
ResultT_co = TypeVar("ResultT_co", bound=Sensitivity, covariant=True)


class Collector(ABC, Generic[PlanT_co, ResultT_co]):
    """Takes the outputs of the runs of a plan, in any order, and analyzes them.

    The outputs of a replicate are kept until it and those before it are complete; then they are reduced to
    the sums that the analysis needs.

    Parameters
    ----------
    plan : Runs
        The runs.
    outputs : sequence of str, length S
        Output names.
    units : sequence of str, length S, optional
        Their units.
    """

    def __init__(self, plan: PlanT_co, outputs: Sequence[str], *, units: Sequence[str] | None = None) -> None:
        self.plan = plan
        self.outputs = tuple(outputs)
        self.units = tuple(units) if units is not None else ("",) * len(self.outputs)
        if not self.outputs or len(self.units) != len(self.outputs):
            msg = f"{len(self.outputs)} outputs, {len(self.units)} units: give at least one, each with a unit"
            raise InputError(msg)
        self._shape: tuple[int, int] | None = None
        self._filling: dict[int, tuple[Floats, NDArray[np.bool_]]] = {}
        self._next = 0

    @abstractmethod
    def _take(self, replicate: int, y: Floats) -> None:
        """Keep what the analysis needs of a complete replicate (N, T, S); replicates come in order."""

    @abstractmethod
    def _result(self, confidence: float) -> ResultT_co:
        """Analyze all replicates."""

    @property
    def missing(self) -> int:
        """Number of runs whose outputs have not been added yet. [-]"""
        held = sum(int(filled.sum()) for _, filled in self._filling.values())
        return len(self.plan) - self.plan.runs * self._next - held

    def add(self, first: int, values: ArrayLike) -> None:
        """Add the outputs of consecutive runs.

        Parameters
        ----------
        first : int
            Number of the first run among all runs of the plan, from 0.
        values : array_like, shape (m, T, S)
            Outputs by run, time and output; (m, T) when there is one output. [unit of each output]

        Raises
        ------
        InputError
            Shapes do not fit, a run is added twice, or a value is not a finite number.
        """
        y = self._checked(first, np.asarray(values, dtype=np.float64))
        n = self.plan.runs
        done = 0
        while done < y.shape[0]:
            replicate, row = divmod(first + done, n)
            take = min(n - row, y.shape[0] - done)
            self._fill(replicate, row, y[done : done + take])
            done += take

    def result(self, *, confidence: float = 0.95) -> ResultT_co:
        """Analyze the runs when all have been added.

        Parameters
        ----------
        confidence : float
            Of the intervals. [-]

        Returns
        -------
        Sensitivity
            Indices with intervals and effects.

        Raises
        ------
        InputError
            Runs are missing, or the confidence is not between 0 and 1.
        """
        if self.missing:
            msg = f"{self.missing} of {len(self.plan)} runs have not been added: the analysis needs them all"
            raise InputError(msg)
        if not 0.0 < confidence < 1.0:
            msg = f"confidence: found {confidence:g}, expected a number between 0 and 1, such as 0.95"
            raise InputError(msg)
        return self._result(confidence)

    def _checked(self, first: int, y: Floats) -> Floats:
        if y.ndim == 2 and len(self.outputs) == 1:
            y = y[:, :, None]
        if y.ndim != 3 or y.shape[2] != len(self.outputs) or y.shape[1] == 0:
            msg = f"found outputs of shape {y.shape}, expected (runs, times, {len(self.outputs)} outputs)"
            raise InputError(msg)
        if self._shape is None:
            self._shape = (y.shape[1], y.shape[2])
        if y.shape[1:] != self._shape:
            msg = f"found outputs at {y.shape[1]} times, expected {self._shape[0]} as in the runs before"
            raise InputError(msg)
        if first < 0 or first + y.shape[0] > len(self.plan):
            last = first + y.shape[0] - 1
            msg = f"found runs {first} to {last}, expected runs 0 to {len(self.plan) - 1} of the design"
            raise InputError(msg)
        bad = ~np.isfinite(y)
        if bad.any():
            run, time, output = (int(k) for k in np.argwhere(bad)[0])
            msg = (
                f"run {first + run}: '{self.outputs[output]}' is not a finite number at time {time}; a "
                f"{self.plan.method} design needs all its runs: narrow the range that makes this run fail"
            )
            raise InputError(msg)
        return y

    def _fill(self, replicate: int, row: int, y: Floats) -> None:
        n = self.plan.runs
        if replicate < self._next:
            msg = f"run {replicate * n + row} was added before"
            raise InputError(msg)
        if replicate not in self._filling:
            self._filling[replicate] = (np.empty((n, *y.shape[1:])), np.zeros(n, dtype=np.bool_))
        held, filled = self._filling[replicate]
        if filled[row : row + y.shape[0]].any():
            again = row + int(np.argmax(filled[row : row + y.shape[0]]))
            msg = f"run {replicate * n + again} was added before"
            raise InputError(msg)
        held[row : row + y.shape[0]] = y
        filled[row : row + y.shape[0]] = True
        # In order, so that the result does not depend on the order in which runs were added.
        while self._next in self._filling and self._filling[self._next][1].all():
            complete, _ = self._filling.pop(self._next)
            self._next += 1
            self._take(self._next - 1, complete)


def batches(plan: Runs, size: int) -> Iterator[tuple[int, Floats]]:
    """Divide the runs of a plan into batches, in order.

    Parameters
    ----------
    plan : Runs
        The runs.
    size : int
        Largest number of runs of a batch. [-]

    Yields
    ------
    tuple of int and ndarray, shape (m, P)
        Number of the first run of a batch, and its samples. [unit of each parameter]
    """
    for r in range(plan.replicates):
        x = plan.samples(r)
        for row in range(0, plan.runs, size):
            yield r * plan.runs + row, x[row : row + size]
