"""Evidence for a cause: its significance, and the part of the sum of squares that it takes away."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.validation.whitened_regression import Extra, Solution, WhitenedRegression, Whitening

Floats = NDArray[np.float64]

#: Fewest blocks of the record over which an improvement is compared.
_BLOCKS: Final = 8
_DAY: Final = 86400.0


def p_value(
    before: tuple[WhitenedRegression, Solution, Sequence[int]],
    after: tuple[WhitenedRegression, Solution, Sequence[int], Sequence[Extra]],
    *,
    interval: float,
    tried: int,
    deviance: float,
) -> float:
    """Probability of an improvement by chance.

    The larger one of two: that of a likelihood ratio (errors with the autocorrelation of the residuals), and
    that of a t-test over days, which asks that the improvement is not that of a few of them.

    Parameters
    ----------
    before, after : tuple
        Problem, solution and columns without and with the cause.
    interval : float
        Between the samples. [s]
    tried : int
        Number of causes that were compared (Bonferroni).
    deviance : float
        Fall of the deviance.

    Returns
    -------
    float
        [-]
    """
    from scipy import stats

    ratio = float(stats.chi2.sf(max(deviance, 0.0), 1))
    size = len(before[0].residual)
    length = max(1, min(round(_DAY / interval), size // _BLOCKS))
    block = np.arange(size) // length
    improvement = np.zeros(int(block[-1]) + 1)
    first = before[0].remaining(before[1], before[2])
    second = after[0].remaining(after[1], after[2], after[3])
    for s, (before_series, after_series) in enumerate(zip(first, second, strict=True)):
        v, w = before[1].variance[s], after[1].variance[s]
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = math.log(v / w)
        for rows, whitened, sign, variance in (
            (before[0].rows[s], before_series, 1.0, v),
            (after[0].rows[s], after_series, -1.0, w),
        ):
            improvement += sign * np.bincount(block[rows], whitened**2 / variance, improvement.size)
        improvement += logs * np.bincount(block[before[0].rows[s]], minlength=improvement.size)
    used = improvement[improvement != 0.0]
    if used.size < 3:
        return min(1.0, tried * ratio)
    spread = float(np.std(used, ddof=1)) / math.sqrt(used.size)
    t = float(np.mean(used)) / max(spread, 1e-300)
    return min(1.0, max(tried * ratio, float(stats.t.sf(t, used.size - 1))))


def step_change_p_value(errors: Floats, rows: tuple[int, int], *, interval: float) -> float:
    """Probability that the level of errors differs by chance between a part of the record and the rest.

    From means over days, whose correlation from one day to the next is accounted for: a jump that does not
    last is no offset.

    Parameters
    ----------
    errors : ndarray, shape (n,)
        NaN where nothing was measured. [unit]
    rows : tuple of int
        First row of the part and the row after the last.
    interval : float
        Between the samples. [s]

    Returns
    -------
    float
        1 for fewer than two days on a side. [-]

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(size=480)
    >>> step_change_p_value(noise + (np.arange(480) >= 240), (240, 480), interval=3600.0) < 1e-6
    True
    >>> step_change_p_value(noise, (240, 480), interval=3600.0) > 0.05
    True
    """
    from scipy import stats

    length = max(1, round(_DAY / interval))
    inside = (np.arange(errors.size) >= rows[0]) & (np.arange(errors.size) < rows[1])
    means, parts = [], []
    for part in (inside, ~inside):
        part_errors = errors[part]
        day = np.arange(part_errors.size) // length
        finite = np.isfinite(part_errors)
        count = np.bincount(day[finite])
        total = np.bincount(day[finite], weights=part_errors[finite])
        means.append(total[count > 0] / count[count > 0])
        parts.append(means[-1] - means[-1].mean() if means[-1].size else means[-1])
    size = np.array([day_means.size for day_means in means], dtype=np.float64)
    if size.min() < 2:
        return 1.0
    square = sum(float(part @ part) for part in parts)
    lagged = sum(float(part[1:] @ part[:-1]) for part in parts)
    correlation = min(max(lagged / max(square, 1e-300), 0.0), 0.9)
    # The mean of correlated days is worth that of fewer.
    worth = np.maximum(size * (1.0 - correlation) / (1.0 + correlation), 1.0)
    freedom = max(float(worth.sum()) - 2.0, 1.0)
    spread = math.sqrt(square / max(float(size.sum()) - 2.0, 1.0) * float(np.sum(1.0 / worth)))
    t = abs(float(means[0].mean() - means[1].mean())) / max(spread, 1e-300)
    return 2.0 * float(stats.t.sf(t, freedom))


class SquareSums:
    """Sums of squares over the stated uncertainties, before and after a cause; nothing is whitened.

    Offsets within the stated uncertainty help to fit the other columns, and are not taken away themselves.

    Parameters
    ----------
    regression : WhitenedRegression
        The problem.
    active : sequence of int
        Columns that are fitted with and without the cause.
    uncertainty : ndarray, shape (S,)
        Standard uncertainty of each sensor. [unit of each]
    """

    def __init__(self, regression: WhitenedRegression, active: Sequence[int], uncertainty: Floats) -> None:
        plain = Whitening(tuple(np.empty(0) for _ in range(regression.sensors)))
        self._regression = WhitenedRegression(
            regression.residual,
            regression.columns,
            regression.center,
            regression.precision,
            regression.limits,
            plain,
        )
        self._active, self._u = list(active), uncertainty
        self._null = self._regression.solve(self._active)
        self.before = self._of(self._regression, self._null, self._active, (), None)

    def after(
        self,
        *,
        column: int | None = None,
        extra: Sequence[Extra] = (),
        residual: dict[int, Floats] | None = None,
        offset: int | None = None,
    ) -> Floats:
        """Sums with a cause: a column, a column of one sensor, or other residuals; shape (S,). [-]"""
        regression = self._regression if residual is None else self._regression.with_residual(residual)
        active = self._active if column is None else [*self._active, column]
        solution = regression.solve(active, extra)
        return self._of(regression, solution, active, extra, offset)

    def share(self, after: Floats) -> tuple[float, float]:
        """Part taken away over all sensors, and of the sensor where it is largest. [-]"""
        share_of_all = 1.0 - float(after.sum()) / max(float(self.before.sum()), 1e-300)
        each = 1.0 - after / np.maximum(self.before, 1e-300)
        return share_of_all, float(each.max(initial=0.0))

    def _of(
        self,
        regression: WhitenedRegression,
        solution: Solution,
        active: Sequence[int],
        extra: Sequence[Extra],
        excluded_offset: int | None,
    ) -> Floats:
        remaining = regression.remaining(solution, active, extra)
        first = len(regression.columns) - regression.sensors
        for value, k in zip(solution.values, active, strict=False):
            if k >= first and k - first != excluded_offset:
                remaining[k - first] = remaining[k - first] + value
        return np.array([float(r @ r) for r in remaining]) / self._u**2
