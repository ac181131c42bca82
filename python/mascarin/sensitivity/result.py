"""What every sensitivity method returns."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]

VARIANCE: Final = "first-order share of the variance"
"""What `Sensitivity.share` is, unless a method says otherwise."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Sensitivity:
    """Shares of the variance of each output that each parameter alone accounts for.

    Attributes
    ----------
    method : str
        Name of the method.
    names : tuple of str, length G
        Parameter paths, or names of groups.
    outputs : tuple of str, length S
        Output names.
    units : tuple of str, length S
        Unit of each output.
    share : ndarray, shape (G, S)
        Share of the variance, summed over time before dividing; see `measure`. [-]
    low, high : ndarray, shape (G, S)
        Confidence interval of the share. [-]
    effect : ndarray, shape (G, S)
        Change of the output, averaged over time, when the parameter goes from the low to the high end of
        its range; NaN where a method or a group has no sign. [unit of the output]
    significant : ndarray of bool, shape (G, S)
        Whether the share is above zero beyond doubt, with all parameters looked at together.
    confidence : float
        Of the intervals. [-]
    runs : int
        Number of simulations used. [-]
    seed : int
        Of the random numbers.
    warnings : tuple of str
        What a reader must know.
    measure : str
        What `share` is, in words: the first-order share for all methods but Morris'.
    total, total_low, total_high : ndarray, shape (G, S), optional
        Share that goes when the parameter is held, interactions included, with its interval; None for
        methods that do not tell. [-]
    """

    method: str
    names: tuple[str, ...]
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    share: Floats
    low: Floats
    high: Floats
    effect: Floats
    significant: NDArray[np.bool_]
    confidence: float
    runs: int
    seed: int
    warnings: tuple[str, ...] = field(default=())
    measure: str = VARIANCE
    total: Floats | None = None
    total_low: Floats | None = None
    total_high: Floats | None = None

    @property
    def rest(self) -> Floats:
        """Part of the variance that no parameter explains alone: interactions and what the method cuts off.

        Returns
        -------
        ndarray, shape (S,)
            [-]
        """
        rest: Floats = 1.0 - self.share.sum(axis=0)
        return rest

    def output_index(self, output: str) -> int:
        """Position of an output.

        Raises
        ------
        InputError
            When there is no such output.
        """
        if output not in self.outputs:
            msg = f"output '{output}' is not in this analysis. {did_you_mean(output, self.outputs)}"
            raise InputError(msg)
        return self.outputs.index(output)

    def ranking(self, output: str, limit: int | None = None) -> list[str]:
        """Names by falling share.

        Parameters
        ----------
        output : str
            Which output.
        limit : int, optional
            Longest list wanted. [-]
        """
        order = np.argsort(-self.share[:, self.output_index(output)], kind="stable")
        return [self.names[k] for k in order[:limit]]

    def influential(self, minimum: float = 0.01) -> list[str]:
        """Names that matter for at least one output: significant, and with a share worth fitting.

        Parameters
        ----------
        minimum : float
            Smallest share of an output's variance that counts. [-]

        Returns
        -------
        list of str
            By falling largest share.
        """
        largest = np.where(self.significant, self.share, -1.0).max(axis=1, initial=-1.0)
        return [self.names[k] for k in np.argsort(-largest, kind="stable") if largest[k] >= minimum]

    def to_dict(self) -> dict[str, dict[str, dict[str, float | None]]]:
        """The analysis as ``{output: {path: {share, low, high, effect}}}``, ready for JSON."""
        return {
            output: {
                name: {
                    "share": _number(self.share[i, s]),
                    "low": _number(self.low[i, s]),
                    "high": _number(self.high[i, s]),
                    "effect": _number(self.effect[i, s]),
                    **self._totals(i, s),
                }
                for i, name in enumerate(self.names)
            }
            for s, output in enumerate(self.outputs)
        }

    def table(self) -> pd.DataFrame:
        """One row per output and parameter, by falling share within each output."""
        import pandas as pd

        rows = [
            (output, self.names[i], *self._row(int(i), s))
            for s, output in enumerate(self.outputs)
            for i in np.argsort(-self.share[:, s], kind="stable")
        ]
        return pd.DataFrame(rows, columns=["output", "parameter", *self._columns()])

    def _totals(self, i: int, s: int) -> dict[str, float | None]:
        """The total share with its interval, where the method tells it."""
        if self.total is None or self.total_low is None or self.total_high is None:
            return {}
        values = (self.total[i, s], self.total_low[i, s], self.total_high[i, s])
        return dict(zip(_TOTALS, map(_number, values), strict=True))

    def _columns(self) -> list[str]:
        columns = ["share", "low", "high", "effect", "unit", "significant"]
        return columns if self.total is None else [*columns, *_TOTALS]

    def _row(self, i: int, s: int) -> tuple[object, ...]:
        return (
            float(self.share[i, s]),
            float(self.low[i, s]),
            float(self.high[i, s]),
            float(self.effect[i, s]),
            self.units[s],
            bool(self.significant[i, s]),
            *self._totals(i, s).values(),
        )


_TOTALS: Final = ("total", "total_low", "total_high")


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
