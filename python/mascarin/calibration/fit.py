"""The result of a calibration."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.cost import Cost, CostName
from mascarin.calibration.evaluations import Trace
from mascarin.calibration.problem import CalibrationProblem
from mascarin.calibration.uncertainty import METHOD, Uncertainty

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where one search ended.

    Attributes
    ----------
    sequence : int
        Number of the search, from 0.
    start, x : ndarray, shape (P,)
        Where it began and ended. [unit of each parameter]
    cost : float
        Cost at the end.
    evaluations : int
        Number of evaluations the search asked for. [-]
    reason : str
        Why it ended.
    """

    sequence: int
    start: Floats
    x: Floats
    cost: float
    evaluations: int
    reason: str


@dataclass(frozen=True, eq=False)
class Fit:
    """Estimates with their uncertainty, and how they were found.

    Attributes
    ----------
    problem : CalibrationProblem
        What was fitted.
    method, cost_name : str
        Search method and cost.
    x : ndarray, shape (P,)
        Estimates. [unit of each parameter]
    low, high : ndarray, shape (P,)
        Confidence intervals, within the range searched; NaN where the cost allows none. [unit]
    correlation : ndarray, shape (P, P)
        Between the estimates. [-]
    confidence : float
        Of the intervals. [-]
    cost : float
        At the estimates.
    of_sensors : ndarray, shape (S,)
        Cost of each sensor at the estimates.
    residuals : ndarray, shape (T, S)
        Simulated minus measured at the estimates, NaN where nothing is compared. [unit of each sensor]
    uncertainty : Uncertainty
        Effective samples and more.
    on_bound : dict of str to str
        Reason for every estimate on a bound, by path.
    warnings : tuple of str
        What a reader must know, in words.
    minima : tuple of Minimum
        Where every search ended, in their order.
    reason : str
        Why the searching ended.
    trace : Trace
        All evaluations.
    seed : int
        Of the random numbers.
    uncertainty_method : str
        How the intervals were made.
    samples : ndarray, shape (n, P), optional
        Posterior sample of the method ``emcee``. [unit of each parameter]
    """

    problem: CalibrationProblem
    method: str
    cost_name: CostName
    x: Floats
    low: Floats
    high: Floats
    correlation: Floats
    confidence: float
    cost: float
    of_sensors: Floats
    residuals: Floats
    uncertainty: Uncertainty
    on_bound: dict[str, str]
    warnings: tuple[str, ...]
    minima: tuple[Minimum, ...]
    reason: str
    trace: Trace
    seed: int

    uncertainty_method: str = METHOD
    samples: Floats | None = None

    @property
    def values(self) -> dict[str, float]:
        """Estimates by path. [unit of each parameter]"""
        return dict(zip(self.problem.paths, self.x.tolist(), strict=True))

    def to_dict(self) -> dict[str, dict[str, float | str | None]]:
        """The parameters as ``{path: {nominal, fitted, low, high, unit}}``, ready for JSON."""
        return {
            p.path: {
                "nominal": p.nominal,
                "fitted": float(self.x[i]),
                "low": _number(self.low[i]),
                "high": _number(self.high[i]),
                "unit": p.unit,
            }
            for i, p in enumerate(self.problem.parameters)
        }

    def table(self) -> pd.DataFrame:
        """One row per parameter."""
        import pandas as pd

        rows = [
            (p.path, p.nominal, self.x[i], self.low[i], self.high[i], p.unit, self.on_bound.get(p.path, ""))
            for i, p in enumerate(self.problem.parameters)
        ]
        columns = ["parameter", "nominal", "fitted", "low", "high", "unit", "remark"]
        return pd.DataFrame(rows, columns=columns)

    def evaluations(self) -> pd.DataFrame:
        """Every evaluation in its order: the parameters, the cost of each sensor and the total."""
        import pandas as pd

        columns = {path: self.trace.x[:, i] for i, path in enumerate(self.problem.paths)}
        sensors = {f"cost {s.name}": self.trace.of_sensors[:, k] for k, s in enumerate(self.problem.sensors)}
        return pd.DataFrame({**columns, **sensors, "cost": self.trace.cost})

    def distinct_minima(self, *, within: float = 1e-3, apart: float = 0.02) -> list[list[Minimum]]:
        """Minima grouped by where they are, the lowest group first.

        Parameters
        ----------
        within : float
            Two minima are the same if their costs differ by less than this share, see `Cost.tolerance`, [-]
        apart : float
            and no parameter by more than this share of its range. [-]

        Returns
        -------
        list of list of Minimum
            Each group begins with its lowest member.
        """
        groups: list[list[Minimum]] = []
        tolerance = Cost(self.problem, self.cost_name).tolerance(self.cost, within)
        for minimum in sorted(self.minima, key=lambda m: m.cost):
            z = self.problem.positions(minimum.x)
            for group in groups:
                away = np.abs(self.problem.positions(group[0].x) - z).max()
                if away <= apart and minimum.cost - group[0].cost <= tolerance:
                    group.append(minimum)
                    break
            else:
                groups.append([minimum])
        return groups

    def histogram(self, bins: int = 20) -> tuple[NDArray[np.int64], Floats]:
        """How many searches ended at which cost.

        Parameters
        ----------
        bins : int
            Number of bins from the lowest to the highest cost. [-]

        Returns
        -------
        tuple of ndarray
            Counts (bins,) and edges (bins + 1,).
        """
        costs = np.array([m.cost for m in self.minima if math.isfinite(m.cost)])
        counts, edges = np.histogram(costs, bins=bins)
        return counts.astype(np.int64), edges.astype(np.float64)


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
