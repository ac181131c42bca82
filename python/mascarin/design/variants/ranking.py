"""Ranking of designs over samples of what is uncertain, and which of them cannot be told apart.

All designs have the same samples, so that they are compared in pairs: what a sample changes in all designs
alike does not count. Two designs are tied where the interval of their mean difference contains 0, or a
difference that is called negligible. The intervals hold for all pairs with the best design at once
(Bonferroni).

References
----------
Montgomery (2017), Design and Analysis of Experiments, 9th ed., sec. 2.5 (paired comparison).
Law (2015), Simulation Modeling and Analysis, 5th ed., ch. 10 (common random numbers, Bonferroni).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    Array = npt.NDArray[np.float64]

#: Probability with which all intervals together contain the true differences.
CONFIDENCE: Final = 0.95
#: Relative differences smaller than this are round-off. [-]
_ROUNDING_ERROR: Final = 1e-9


@dataclass(frozen=True)
class Ranking:
    """Designs in the order of their means.

    Attributes
    ----------
    order : ndarray of int, shape (K,)
        Designs, the best first.
    mean, spread : ndarray, shape (K,)
        Mean and standard deviation over the samples, by design. [unit of the objective]
    difference, low, high : ndarray, shape (K,)
        Mean of the value less that of the best design, with its interval, by design. [unit of the objective]
    tied : ndarray of bool, shape (K,)
        Whether a design cannot be told from the best one.
    tied_before : ndarray of bool, shape (K,)
        Whether a design cannot be told from the one before it in the order: with other samples the two may
        change places.
    better : ndarray, shape (K,)
        Part of the samples in which a design is better than the best one. [-]
    samples : int
        Samples without a failure.

    Examples
    --------
    >>> values = np.array([[1.0, 2.0, 3.0, 4.0], [1.5, 2.4, 3.6, 4.5], [0.9, 2.1, 3.0, 4.0]])
    >>> found = ranked(values, least=True)
    >>> found.order.tolist(), found.tied.tolist(), found.tied_before.tolist()
    ([0, 2, 1], [True, False, True], [False, False, True])
    """

    order: npt.NDArray[np.int64]
    mean: Array
    spread: Array
    difference: Array
    low: Array
    high: Array
    tied: npt.NDArray[np.bool_]
    tied_before: npt.NDArray[np.bool_]
    better: Array
    samples: int

    def to_dataframe(self) -> pd.DataFrame:
        """A row for each design, the best first."""
        import pandas as pd

        columns = ("mean", "spread", "difference", "low", "high", "tied", "tied_before", "better")
        table = pd.DataFrame({name: getattr(self, name) for name in columns})
        return table.iloc[self.order].rename_axis("design").reset_index()


def ranked(values: Array, *, least: bool, negligible: float = 0.0) -> Ranking:
    """Rank designs by their means over samples.

    Parameters
    ----------
    values : ndarray, shape (K, N)
        Value of each design with each sample; a sample with which a design failed (NaN) is left out for all.
        [unit of the objective]
    least : bool
        Whether small values are good.
    negligible : float
        Part of the best mean below which a difference is called a tie. [-]

    Returns
    -------
    Ranking
        Designs in order; with fewer than two samples only equal values are tied.
    """
    from scipy import stats

    good = np.isfinite(values).all(axis=0)
    used = np.asarray(values[:, good], dtype=np.float64)
    count = used.shape[1]
    if not count:
        empty = np.full(len(values), np.nan)
        none = np.zeros(len(values), dtype=bool)
        return Ranking(np.arange(len(values)), empty, empty, empty, empty, empty, none, none, empty, 0)
    mean = used.mean(axis=1)
    order = np.argsort(mean if least else -mean, kind="stable")
    best = order[0]
    pairs = used - used[best]
    difference = pairs.mean(axis=1)
    comparisons = max(len(used) - 1, 1)
    quantile = stats.t.ppf(1.0 - (1.0 - CONFIDENCE) / (2.0 * comparisons), max(count - 1, 1))

    def half_width(differences: Array) -> Array:
        if count < 2:
            return np.zeros(len(differences))
        return np.asarray(quantile * differences.std(axis=1, ddof=1) / np.sqrt(count))

    half = half_width(pairs)
    rounding = _ROUNDING_ERROR * max(float(np.abs(used).max()), 1e-300)
    least_difference = max(rounding, negligible * abs(float(mean[best])))
    worse = difference if least else -difference
    # Each design less the one before it.
    steps = np.diff(used[order], axis=0) * (1.0 if least else -1.0)
    tied_before = np.zeros(len(used), dtype=bool)
    tied_before[order[1:]] = steps.mean(axis=1) - half_width(steps) <= least_difference
    better = ((pairs < -rounding) if least else (pairs > rounding)).mean(axis=1)
    return Ranking(
        order=order,
        mean=mean,
        spread=used.std(axis=1, ddof=1) if count > 1 else np.zeros(len(used)),
        difference=difference,
        low=difference - half,
        high=difference + half,
        tied=worse - half <= least_difference,
        tied_before=tied_before,
        better=better,
        samples=count,
    )


def pareto(costs: Array) -> npt.NDArray[np.bool_]:
    """Designs that no other one beats in every respect, shape (K,).

    Parameters
    ----------
    costs : ndarray, shape (K, M)
        Objectives to be minimized; a design with NaN is none of them.

    Examples
    --------
    >>> pareto(np.array([[1.0, 3.0], [2.0, 2.0], [2.0, 3.0]])).tolist()
    [True, True, False]
    """
    efficient: npt.NDArray[np.bool_] = np.asarray(np.isfinite(costs).all(axis=1))
    for k in np.flatnonzero(efficient):
        front = costs[efficient]
        no_worse = (front <= costs[k]).all(axis=1)
        better = (front < costs[k]).any(axis=1)
        efficient[k] = not bool((no_worse & better).any())
    return efficient
