"""Results of a compiled run: members of an ensemble, and a run whose derivatives are pulled back."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin import _engine
    from mascarin.simulation.records.recorded_outputs import Readings

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Failure:
    """A member of an ensemble that did not finish.

    Parameters
    ----------
    member : int
        Its row.
    reason : str
        Message of the engine.

    Examples
    --------
    >>> Failure(2, "step 4 did not converge").member
    2
    """

    member: int
    reason: str


@dataclass(frozen=True, eq=False)
class EnsembleRun:
    """Results of an ensemble. ``records, residuals, failures = run`` takes the first three.

    Parameters
    ----------
    records : ndarray, shape (M, rows, outputs)
        NaN for a member that failed.
    residuals : ndarray, shape (M,)
        Relative energy-balance residual of each member. [-]
    failures : list of Failure
        Members that failed, and why.
    outside : ndarray, shape (M,)
        How far temperatures of each member are outside of their causes, see `Judgement`; NaN for one that
        failed. [K]
    beyond : ndarray, shape (M,)
        Steps of each member at whose end a law written as text did not hold, of the law that holds least
        often; NaN for one that failed.

    Examples
    --------
    >>> numbers = np.zeros(1)
    >>> records, residuals, failures = EnsembleRun(np.zeros((1, 2, 1)), numbers, [], numbers, numbers)
    >>> failures
    []
    """

    records: Array
    residuals: Array
    failures: list[Failure]
    outside: Array
    beyond: Array

    def __iter__(self) -> Iterator[Any]:
        return iter((self.records, self.residuals, self.failures))

    def __getitem__(self, index: int) -> Any:
        return (self.records, self.residuals, self.failures)[index]


class Trajectory:
    """A run that keeps what its derivatives in reverse mode need; see `CompiledRun.trajectory`.

    Attributes
    ----------
    records : ndarray, shape (rows, outputs)
        Outputs of the run.
    """

    def __init__(
        self,
        run: _engine.Trajectory,
        raw: Array,
        readings: Readings,
        further: Mapping[int, Callable[[], Array]],
    ) -> None:
        self._run = run
        self._raw = raw
        self._readings = readings
        self._further = further
        self._slopes: dict[int, Array] = {}
        self.records = readings.values(raw)

    def pull(self, weights: Array) -> Array:
        """Derivatives of a quantity by all parameters, from its derivatives by all records.

        Parameters
        ----------
        weights : ndarray, shape (rows, outputs)
            Derivative of the quantity by each record.

        Returns
        -------
        ndarray, shape (P,)
            Derivative of the quantity by each parameter, in the order of the parameter vector.
        """
        pulled = self._run.pull(np.ascontiguousarray(self._readings.weights(self._raw, weights)))
        for position, slope in self._further.items():
            if position not in self._slopes:
                self._slopes[position] = slope()
            pulled[position] = float(np.sum(weights * self._slopes[position]))
        return pulled
