"""Faults of sensors in a part of the record: an offset, a clock, exchanged columns from or until some time.

The time of the change is the one with the largest likelihood (change point). It is one more unknown, which
any noise can be fitted with: the fall of the deviance is reduced by twice the logarithm of the number of
times that were compared, so that a fault of the whole record is preferred where it explains as much.

References
----------
Hinkley D.V. (1970), Inference about the change-point in a sequence of random variables, Biometrika 57, 1.
https://doi.org/10.1093/biomet/57.1.1
Yao Y.-C. (1988), Estimating the number of change-points via Schwarz' criterion, Statistics & Probability
Letters 6, 181. https://doi.org/10.1016/0167-7152(88)90118-6
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.validation.sensor_faults import NORMAL_95, Fault, Series, pairs_alike, shifted
from mascarin.validation.whitened_regression import Extra, Solution, WhitenedRegression

Floats = NDArray[np.float64]

#: Neither part of the record is shorter than this, nor than this part of it. [s], [-]
_MIN_PART_SECONDS: Final = 86400.0
_MIN_PART_SHARE: Final = 0.04
#: Jumps of a clock that are tried: daylight saving. [s]
_JUMPS: Final = (-3600.0, 3600.0)
#: Difference of the deviance that tells the side of a change.
_MIN_SIDE_DEVIANCE: Final = 2.0


def step_changes(
    regression: WhitenedRegression, active: Sequence[int], null: Solution, series: Series
) -> list[Fault]:
    """Fit every fault of a part of the record by itself.

    Parameters
    ----------
    regression, active, null, series
        As for `mascarin.validation.sensor_faults.sensor_faults`.

    Returns
    -------
    list of Fault
        Those whose effect is larger than the stated uncertainty, the largest fall of the deviance first. The
        deviance is less by what the choice of the time is worth.

    Examples
    --------
    An offset of 1 in the second half of ten days:

    >>> from mascarin.validation.whitened_regression import Whitening
    >>> noise = np.random.default_rng(1).normal(0.0, 0.1, (240, 1))
    >>> measured = noise + (np.arange(240) >= 120)[:, None]
    >>> regression = WhitenedRegression(
    ...     measured, np.ones((1, 240, 1)), np.zeros(1), np.array([4.0]), np.array([[-9.0, 9.0]]),
    ...     Whitening((np.empty(0),)),
    ... )
    >>> compared = Series(measured, np.zeros((240, 1)), np.array([0.1]), 3600.0, 1800.0, ("degC",), {})
    >>> fault = step_changes(regression, [0], regression.solve([0]), compared)[0]
    >>> fault.what, fault.rows, round(fault.value, 1)
    ('offset', (120, 240), 1.0)
    """
    n = len(series.measured)
    edge = max(math.ceil(_MIN_PART_SECONDS / series.interval), math.ceil(_MIN_PART_SHARE * n))
    if n < 3 * edge:
        return []
    search = _Search(regression, active, null, series, edge)
    faults: list[Fault] = []
    for s in range(regression.sensors):
        if regression.count[s] >= 3:
            faults += [*search.offset(s), *search.clock(s)]
    for i, j in pairs_alike(regression, series):
        faults += search.swap(i, j)
    return sorted(faults, key=lambda fault: -fault.deviance)


class _Search:
    """Every row as the time of a change, and what each takes away."""

    def __init__(
        self, regression: WhitenedRegression, active: Sequence[int], null: Solution, series: Series, edge: int
    ) -> None:
        self.regression, self.active, self.null, self.series = regression, list(active), null, series
        self.n = len(series.measured)
        self.edge = edge
        self.price = 2.0 * math.log(max(self.n - 2 * edge, 2))

    def offset(self, s: int) -> list[Fault]:
        """An offset of one sensor after a change, or before it."""
        step = self._after(s, np.ones(self.n))
        conditional_square = step.square - np.sum((step.across @ self._free_part[1]) * step.across, axis=1)
        scores = step.slope**2 / np.maximum(conditional_square, 1e-6 * step.square + 1e-12)
        first = self.edge + int(np.argmax(scores[self.edge : self.n - self.edge + 1]))
        # Which side is wrong is told by the stated uncertainty of the other; else it is the shorter one.
        sides = sorted([(0, first), (first, self.n)], key=lambda rows: rows[1] - rows[0])
        candidates = [self._offset(s, rows) for rows in sides]
        best = (
            candidates[1]
            if candidates[1].deviance > candidates[0].deviance + _MIN_SIDE_DEVIANCE
            else candidates[0]
        )
        return [best] if best.effect > NORMAL_95 * self.series.uncertainty[s] else []

    def _offset(self, s: int, rows: tuple[int, int]) -> Fault:
        column = np.zeros(self.n)
        column[slice(*rows)] = 1.0
        extra = Extra(s, column)
        fit = self.regression.solve(self.active, [extra], start=self.null)
        value, error = float(fit.values[-1]), fit.standard_error(fit.values.size - 1)
        gain = self.null.deviance - fit.deviance - self.price
        return Fault("offset", (s,), value, error, gain, abs(value), extra=(extra,), solution=fit, rows=rows)

    def clock(self, s: int) -> list[Fault]:
        """A clock of one sensor that jumps by an hour."""
        measured, simulated = self.series.measured[:, s], self.series.simulated[:, s]
        faults = []
        for jump in _JUMPS:
            late = shifted(simulated, jump, self.series.interval)
            fault = self._replaced("clock", (s,), {s: measured - late}, jump)
            effect = float(np.sqrt(np.mean((late - simulated) ** 2)))
            if fault is not None and effect > self.series.uncertainty[s]:
                faults.append(replace(fault, effect=effect))
        return faults

    def swap(self, i: int, j: int) -> list[Fault]:
        """Two columns that are exchanged."""
        y, m = self.series.measured, self.series.simulated
        fault = self._replaced("swapped", (i, j), {i: y[:, j] - m[:, i], j: y[:, i] - m[:, j]}, math.nan)
        effect = float(np.sqrt(np.nanmean((y[:, i] - y[:, j]) ** 2)))
        if fault is None or effect <= max(self.series.uncertainty[i], self.series.uncertainty[j]):
            return []
        return [replace(fault, effect=effect)]

    def _replaced(
        self, what: str, sensors: tuple[int, ...], other: dict[int, Floats], value: float
    ) -> Fault | None:
        """A fault that replaces residuals after or before a change."""
        base = {s: self.regression.residual[:, s] for s in sensors}
        if any((np.isfinite(base[s]) != np.isfinite(other[s])).any() for s in sensors):
            return None
        parts = [self._after(s, np.nan_to_num(other[s] - base[s])) for s in sensors]
        best: tuple[float, tuple[int, int]] | None = None
        for after in (True, False):
            gain = self._gain([part if after else part.before() for part in parts])
            first = self.edge + int(np.argmax(gain[self.edge : self.n - self.edge + 1]))
            if best is None or gain[first] > best[0]:
                best = (float(gain[first]), (first, self.n) if after else (0, first))
        if best is None or best[0] <= self.price:
            return None
        rows = best[1]
        inside = (np.arange(self.n) >= rows[0]) & (np.arange(self.n) < rows[1])
        residual = {s: np.where(inside, other[s], base[s]) for s in sensors}
        fit = self.regression.with_residual(residual).solve(self.active, start=self.null)
        gained = self.null.deviance - fit.deviance - self.price
        if gained <= 0.0:
            return None
        return Fault(what, sensors, value, math.nan, gained, 0.0, residual=residual, solution=fit, rows=rows)

    def _gain(self, parts: Sequence[_Part]) -> Floats:
        """Fall of the deviance by known changes of residuals, the variances held, shape (n + 1,)."""
        across = np.sum([part.across for part in parts], axis=0)
        slope = np.sum([part.slope for part in parts], axis=0)
        square = np.sum([part.square for part in parts], axis=0)
        return np.asarray(np.sum((across @ self._free_part[1]) * across, axis=1) - 2.0 * slope - square)

    @cached_property
    def _free_part(self) -> tuple[NDArray[np.int64], Floats, list[Floats]]:
        """Columns that are free, their covariance, and what remains of each sensor without a fault."""
        index = np.asarray(self.active, dtype=np.int64)
        free = np.flatnonzero(self.null.free[: index.size])
        covariance = np.asarray(
            np.linalg.pinv(self.null.information[np.ix_(free, free)], hermitian=True), dtype=np.float64
        )
        return index[free], covariance, self.regression.remaining(self.null, self.active)

    def _after(self, s: int, change: Floats) -> _Part:
        """A change (n,) of a residual from each row on.

        Whitening makes a pulse of its beginning, so that every row is looked at; after the pulse the products
        are sums from the end.
        """
        free, _, residual = self._free_part
        rows, variance = self.regression.rows[s], self.null.variance[s]
        whitened = np.where(rows, self.regression.whitening.series(change, s), 0.0)
        table = np.zeros((self.n, free.size + 2))
        table[rows, :-2] = self.regression.white[s][:, free]
        table[rows, -2] = residual[s]
        table[:, -1] = whitened
        phi = self.regression.whitening.coefficients[s]
        order = phi.size
        total = np.zeros((self.n + 1 + order, free.size + 2))
        total[: self.n] = np.cumsum((table * whitened[:, None])[::-1], axis=0)[::-1]
        products = total[order:].copy()
        square = products[:, -1].copy()
        padded = np.concatenate([table, np.zeros((order + 1, table.shape[1]))])
        comparable = np.concatenate([rows, np.zeros(order + 1, dtype=bool)])
        values = np.concatenate([change, np.zeros(order + 1)])
        for j in range(order):
            pulse = values[j : j + self.n + 1].copy()
            for lag in range(1, j + 1):
                pulse -= phi[lag - 1] * values[j - lag : j - lag + self.n + 1]
            pulse *= comparable[j : j + self.n + 1]
            products += pulse[:, None] * padded[j : j + self.n + 1]
            square += pulse**2
        return _Part(
            products[:, :-2] / variance,
            products[:, -2] / variance,
            square / variance,
            products[:, -1] / variance,
        )


@dataclass(frozen=True, eq=False)
class _Part:
    """Products of a whitened change from each row on, over the variance.

    With the free columns (n + 1, K), with what remains, with itself, and with the change of the whole record.
    """

    across: Floats
    slope: Floats
    square: Floats
    total: Floats

    def before(self) -> _Part:
        """The same for a change until each row."""
        square = self.square[0] - 2.0 * self.total + self.square
        return _Part(
            self.across[0] - self.across, self.slope[0] - self.slope, square, self.total[0] - self.total
        )
