"""What all methods share: a plan of runs in replicates, and a collector of their outputs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.factors import Floats
from mascarin.sensitivity.result import Sensitivity


class Runs(Protocol):
    """Which runs to make: some replicates of equal size."""

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


class Plan(Runs, Protocol):
    """Runs that bring their analysis."""

    def collector(
        self, outputs: Sequence[str], units: Sequence[str] | None = None
    ) -> Collector[Runs, Sensitivity]:
        """What takes the outputs of the runs and analyses them."""
        ...


class Collector(ABC, Generic[PlanT_co, ResultT_co]):
    """Takes the outputs of a plan's runs as they come, in any order.

    A replicate's outputs are held until it is complete and those before it are; what the analysis keeps of
    it is then small.

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
        """Keep what the analysis needs of a complete replicate (N, T, S); they come in their order."""

    @abstractmethod
    def _result(self, confidence: float) -> ResultT_co:
        """The analysis of all replicates."""

    @property
    def missing(self) -> int:
        """Number of runs whose outputs have not come yet. [-]"""
        held = sum(int(filled.sum()) for _, filled in self._filling.values())
        return len(self.plan) - self.plan.runs * self._next - held

    def add(self, first: int, values: ArrayLike) -> None:
        """Outputs of consecutive runs.

        Parameters
        ----------
        first : int
            Number of the first run among all runs of the plan, from 0.
        values : array_like, shape (m, T, S)
            Outputs by run, time and output; (m, T) when there is one output. [unit of each output]

        Raises
        ------
        InputError
            When shapes do not fit, a run comes twice, or a value is not a finite number.
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
        """The analysis of all runs.

        Parameters
        ----------
        confidence : float
            Of the intervals. [-]

        Raises
        ------
        InputError
            While runs are missing.
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
            msg = f"outputs of shape {y.shape}: expected (runs, times, {len(self.outputs)} outputs)"
            raise InputError(msg)
        if self._shape is None:
            self._shape = (y.shape[1], y.shape[2])
        if y.shape[1:] != self._shape:
            msg = (
                f"outputs at {y.shape[1]} times, before there were {self._shape[0]}: every run needs the same"
            )
            raise InputError(msg)
        if first < 0 or first + y.shape[0] > len(self.plan):
            msg = f"runs {first} to {first + y.shape[0] - 1}: the design has runs 0 to {len(self.plan) - 1}"
            raise InputError(msg)
        bad = ~np.isfinite(y)
        if bad.any():
            run, time, output = (int(k) for k in np.argwhere(bad)[0])
            msg = (
                f"run {first + run}: '{self.outputs[output]}' is not a finite number at time {time}; a run "
                f"that failed cannot be left out of a {self.plan.method} design: narrow the range that makes "
                f"it fail"
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
        # In their order, so that the analysis does not depend on which came first.
        while self._next in self._filling and self._filling[self._next][1].all():
            complete, _ = self._filling.pop(self._next)
            self._next += 1
            self._take(self._next - 1, complete)


def run(
    plan: Plan,
    evaluate: Callable[[Floats], ArrayLike],
    *,
    outputs: Sequence[str],
    units: Sequence[str] | None = None,
    batch: int = 256,
    confidence: float = 0.95,
    progress: Callable[[int, int], object] | None = None,
) -> Sensitivity:
    """Make the runs of a plan in batches and analyse them.

    Parameters
    ----------
    plan : Plan
        The runs, of any method.
    evaluate : callable
        ``(m, P) -> (m, T, S)``: outputs of a batch of runs.
    outputs, units : sequence of str, length S
        Names and units of the outputs.
    batch : int
        Largest number of runs handed over at once. [-]
    confidence : float
        Of the intervals. [-]
    progress : callable, optional
        Called with the number of runs done and their total.
    """
    collector = plan.collector(outputs, units)
    for first, x in batches(plan, batch):
        collector.add(first, evaluate(x))
        if progress is not None:
            progress(first + x.shape[0], len(plan))
    return collector.result(confidence=confidence)


def batches(plan: Runs, size: int) -> Iterator[tuple[int, Floats]]:
    """The runs of a plan in order, as pairs of the first run's number and the samples (m, P)."""
    for r in range(plan.replicates):
        x = plan.samples(r)
        for row in range(0, plan.runs, size):
            yield r * plan.runs + row, x[row : row + size]
