"""Least squares of several series together, with correlated errors and one unknown variance for each series.

Residuals are explained by columns: the effects of parameters, which act on all series, and errors of single
sensors. Each series is whitened with an autoregressive model, so that errors that last for hours do not count
as independent ones, and has its own unknown variance. What a column explains is the fall of the deviance
``sum_s N_s log v_s`` plus the penalties of the priors, where ``v_s`` is the variance of the whitened series.
A series with a gross error therefore has little influence on the others.

References
----------
Cochrane D., Orcutt G.H. (1949), J. Am. Stat. Assoc. 44, 32 (whitening), doi:10.1080/01621459.1949.10483290.
Seber G.A.F., Wild C.J. (1989), Nonlinear Regression, ch. 6 and 11, doi:10.1002/0471725315.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.validation.series import fit_autoregression

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Highest order of the autoregressive models: gaps cost as many samples.
_MAX_ORDER: Final = 6
#: A series of which less than this part remains after whitening keeps one coefficient only.
_MIN_KEPT_SHARE: Final = 0.7
#: Iterations of the variances.
_MAX_SWEEPS: Final = 12
#: The iteration ends when no variance changes by more than this part.
_MAX_VARIANCE_CHANGE: Final = 1e-3
#: Largest number of active sets that are tried.
_MAX_ACTIVE_SETS: Final = 60
#: Information, in units of the prior, from which a combination of columns is told from zero. [-]
_MIN_INFORMATION: Final = 1e-3
#: Smallest variance of a whitened series, as a part of that of the measured values (rounding).
_MIN_VARIANCE_SHARE: Final = 1e-12


@dataclass(frozen=True, eq=False)
class Whitening:
    """One autoregressive model for each series.

    Attributes
    ----------
    coefficients : tuple of ndarray
        Of each series. [-]

    Examples
    --------
    >>> found = Whitening((np.array([0.5]),)).series(np.array([1.0, 1.5, 2.0]), 0)
    >>> found.tolist()
    [1.0, 1.0, 1.25]
    """

    coefficients: tuple[Floats, ...]

    @classmethod
    def of(cls, errors: Floats) -> Whitening:
        """Fit the models.

        Parameters
        ----------
        errors : ndarray, shape (n, S)
            NaN where nothing was measured. [unit of each]
        """
        coefficients = []
        for x in errors.T:
            finite = np.isfinite(x)
            if finite.sum() < 50 or np.ptp(x[finite]) == 0.0:
                coefficients.append(np.empty(0))
                continue
            model = fit_autoregression(x, longest=_MAX_ORDER)
            if cls._usable_rows(finite, model.order) < _MIN_KEPT_SHARE * finite.sum():
                model = fit_autoregression(x, longest=1)
            coefficients.append(model.coefficients)
        return cls(tuple(coefficients))

    @staticmethod
    def _usable_rows(finite: Flags, order: int) -> int:
        valid = finite.copy()
        for lag in range(1, order + 1):
            valid[lag:] &= finite[:-lag]
            valid[:lag] = False
        return int(valid.sum())

    def rows(self, finite: Flags, s: int) -> Flags:
        """Samples of a series whose predecessors are known, shape (n,)."""
        valid = finite.copy()
        for lag in range(1, self.coefficients[s].size + 1):
            valid[lag:] &= finite[:-lag]
            valid[:lag] = False
        return valid

    def series(self, x: Floats, s: int) -> Floats:
        """Whiten one or several series, shape (n, ...); those before the first count as zero."""
        out = x.copy()
        for lag, phi in enumerate(self.coefficients[s], start=1):
            out[lag:] -= phi * x[:-lag]
        return out


@dataclass(frozen=True, eq=False)
class Solution:
    """Coefficients of columns, and what remains.

    Attributes
    ----------
    values : ndarray, shape (k,)
        Coefficients. [-]
    deviance : float
        ``sum N log v`` plus penalties. [-]
    variance : ndarray, shape (S,)
        Of each whitened series. [unit^2 of each]
    free : ndarray of bool, shape (k,)
        Coefficients that are not held on a limit.
    information : ndarray, shape (k, k)
        Of the coefficients, that of the priors included. [-]
    """

    values: Floats
    deviance: float
    variance: Floats
    free: Flags
    information: Floats

    def standard_error(self, k: int) -> float:
        """Standard error of a coefficient; zero on a limit. [-]"""
        if not self.free[k]:
            return 0.0
        block = np.ix_(self.free, self.free)
        unit = np.zeros(int(self.free.sum()))
        unit[int(self.free[:k].sum())] = 1.0
        return float(np.sqrt(max(float(unit @ np.linalg.lstsq(self.information[block], unit)[0]), 0.0)))


@dataclass(frozen=True, eq=False)
class Extra:
    """A further column that acts on one series.

    Attributes
    ----------
    sensor : int
        Which series.
    column : ndarray, shape (n,)
        Effect of a coefficient of 1. [unit of the series]
    sd : float
        Standard deviation of the prior of its coefficient about zero; infinite: none. [-]
    limits : tuple of float
        Lowest and highest coefficient. [-]
    """

    sensor: int
    column: Floats
    sd: float = np.inf
    limits: tuple[float, float] = (-np.inf, np.inf)


class WhitenedRegression:
    """Residuals of several series, and columns that may explain them.

    Parameters
    ----------
    residual : ndarray, shape (n, S)
        Measured minus simulated, NaN where nothing was measured. [unit of each]
    columns : ndarray, shape (K, n, S)
        Effects of coefficients that act on all series. [unit of each]
    center, precision : ndarray, shape (K,)
        Mean and inverse variance of the prior of each coefficient; zero precision: no prior. [-]
    limits : ndarray, shape (K, 2)
        Lowest and highest coefficient. [-]
    whitening : Whitening
        Of the errors.
    """

    def __init__(
        self,
        residual: Floats,
        columns: Floats,
        center: Floats,
        precision: Floats,
        limits: Floats,
        whitening: Whitening,
    ) -> None:
        self.residual, self.columns = residual, columns
        self.center, self.precision, self.limits = center, precision, limits
        self.whitening = whitening
        self.sensors = residual.shape[1]
        finite = np.isfinite(residual)
        self.rows = [whitening.rows(finite[:, s], s) for s in range(self.sensors)]
        self.count = np.array([rows.sum() for rows in self.rows], dtype=np.float64)
        self.white = [whitening.series(columns[:, :, s].T, s)[self.rows[s]] for s in range(self.sensors)]
        self.gram = [a.T @ a for a in self.white]
        self._grams: dict[bytes, Floats] = {}
        self.right: list[Floats] = []
        self.left = [self.whitened(residual[:, s], s) for s in range(self.sensors)]
        self.total = np.array([r @ r for r in self.left])
        self.right = [a.T @ r for a, r in zip(self.white, self.left, strict=True)]
        scale = np.array(
            [np.nanvar(residual[:, s]) if finite[:, s].any() else 1.0 for s in range(self.sensors)]
        )
        self.floor = np.maximum(_MIN_VARIANCE_SHARE * scale, np.finfo(float).tiny)

    def remaining(
        self, solution: Solution, active: Sequence[int], extra: Sequence[Extra] = ()
    ) -> list[Floats]:
        """Whitened series without what the columns of a solution explain, (N,) for each sensor."""
        index = np.asarray(active, dtype=np.int64)
        unexplained = [
            r - a[:, index] @ solution.values[: index.size]
            for r, a in zip(self.left, self.white, strict=True)
        ]
        for value, e in zip(solution.values[index.size :], extra, strict=True):
            unexplained[e.sensor] = unexplained[e.sensor] - value * self.whitened(e.column, e.sensor)
        return unexplained

    def whitened(self, series: Floats, s: int) -> Floats:
        """Whiten a series of sensor s at the samples that are used, shape (N,)."""
        filled = np.where(np.isfinite(series), series, 0.0)
        return self.whitening.series(filled, s)[self.rows[s]]

    def with_residual(self, changed: dict[int, Floats]) -> WhitenedRegression:
        """The same with other residuals of some sensors, measured at the same instants."""
        other = object.__new__(WhitenedRegression)
        other.__dict__.update(self.__dict__)
        other.left, other.right, other.total = list(self.left), list(self.right), self.total.copy()
        other.residual = self.residual.copy()
        for s, series in changed.items():
            other.residual[:, s] = series
            other.left[s] = self.whitened(series, s)
            other.right[s] = self.white[s].T @ other.left[s]
            other.total[s] = other.left[s] @ other.left[s]
        return other

    def in_directions(self, unchanged: Sequence[int]) -> WhitenedRegression:
        """The same problem with few columns in place of many.

        Columns with a prior about zero are replaced by those combinations of them that the measurements can
        tell from zero: eigenvectors of their information in units of the priors. Along all other
        combinations the measurements say next to nothing. The limits of the replaced columns are dropped;
        their priors hold them.

        Parameters
        ----------
        unchanged : sequence of int
            Columns that stay as they are, as do those without a prior about zero and those that act on one
            series.

        Returns
        -------
        WhitenedRegression
            Columns in the same order, the combinations where the first of the replaced ones was.
        """
        replaced = (self.precision > 0.0) & (self.center == 0.0)
        replaced[list(unchanged)] = False
        replaced &= np.sum([np.diag(gram) > 0.0 for gram in self.gram], axis=0) > 1
        of = np.flatnonzero(replaced)
        if of.size == 0:
            return self
        variance = self.solve(range(len(self.columns))).variance
        sd = self.precision[of] ** -0.5
        information = np.tensordot(1.0 / variance, np.stack([g[np.ix_(of, of)] for g in self.gram]), 1)
        eigenvalues, vectors = np.linalg.eigh(sd[:, None] * information * sd)
        directions = vectors[:, eigenvalues > _MIN_INFORMATION]
        unreplaced = np.flatnonzero(~replaced)
        before, after = unreplaced[unreplaced < of[0]], unreplaced[unreplaced > of[0]]
        combined = np.tensordot((sd[:, None] * directions).T, self.columns[of], 1)
        none = np.tile([-np.inf, np.inf], (len(combined), 1))
        return WhitenedRegression(
            self.residual,
            np.concatenate([self.columns[before], combined, self.columns[after]]),
            np.concatenate([self.center[before], np.zeros(len(combined)), self.center[after]]),
            np.concatenate([self.precision[before], np.ones(len(combined)), self.precision[after]]),
            np.concatenate([self.limits[before], none, self.limits[after]]),
            self.whitening,
        )

    def solve(
        self, active: Sequence[int], extra: Sequence[Extra] = (), start: Solution | None = None
    ) -> Solution:
        """Estimate coefficients and variances.

        Parameters
        ----------
        active : sequence of int
            Columns to use.
        extra : sequence of Extra
            Further columns; their coefficients follow those of `active`.
        start : Solution, optional
            Where to begin: a solution whose first columns are those of `active`.
        """
        index = np.asarray(active, dtype=np.int64)
        k, size = index.size, index.size + len(extra)
        chosen = self._chosen(index)
        gram, right = chosen, np.zeros((self.sensors, size))
        if extra:
            gram = np.zeros((self.sensors, size, size))
            gram[:, :k, :k] = chosen
        for s in range(self.sensors):
            right[s, :k] = self.right[s][index]
        white = [self.whitened(e.column, e.sensor) for e in extra]
        for i, e in enumerate(extra):
            s = e.sensor
            gram[s, k + i, :k] = gram[s, :k, k + i] = self.white[s][:, index].T @ white[i]
            right[s, k + i] = white[i] @ self.left[s]
            for j, other in enumerate(extra[: i + 1]):
                if other.sensor == s:
                    gram[s, k + i, k + j] = gram[s, k + j, k + i] = white[i] @ white[j]
        precision = np.concatenate([self.precision[index], [_precision(e.sd) for e in extra]])
        center = np.concatenate([self.center[index], np.zeros(len(extra))])
        limits = np.concatenate([self.limits[index], np.array([e.limits for e in extra]).reshape(-1, 2)])
        return self._solved(gram, right, precision, center, limits, start)

    def _chosen(self, index: NDArray[np.int64]) -> Floats:
        """Normal matrices of some columns, shape (S, k, k)."""
        key = index.tobytes()
        if key not in self._grams:
            self._grams.clear()
            self._grams[key] = np.stack([gram[np.ix_(index, index)] for gram in self.gram])
        return self._grams[key]

    def screen(self, active: Sequence[int], null: Solution) -> Callable[[dict[int, Floats]], float]:
        """Objective with other residuals of some sensors, at the variances of a solution: a quick search.

        Parameters
        ----------
        active : sequence of int
            Columns of the solution.
        null : Solution
            Gives variances, and which coefficients are held on a limit.

        Returns
        -------
        callable
            From residuals by sensor, as for `with_residual`, to a number that is the lower the better.
        """
        from scipy import linalg

        index = np.asarray(active, dtype=np.int64)
        k = index.size
        free = np.flatnonzero(null.free[:k])
        held = np.flatnonzero(~null.free[:k])
        value = null.values[:k]
        weighted = null.information[:k, :k]
        factor = _factor(weighted[np.ix_(free, free)])
        shift = weighted[np.ix_(free, held)] @ value[held]
        base = sum(b[index] / v for b, v in zip(self.right, null.variance, strict=True))
        base = base + (self.precision * self.center)[index]

        def objective(changed: dict[int, Floats]) -> float:
            right, total = base.copy(), 0.0
            for s, series in changed.items():
                whitened = self.whitened(series, s)
                right = right + ((self.white[s].T @ whitened) - self.right[s])[index] / null.variance[s]
                fixed = self.white[s][:, index[held]] @ value[held] if held.size else 0.0
                reduced = whitened - fixed
                total += float(reduced @ reduced) / null.variance[s]
            target = right[free] - shift
            return total - float(target @ linalg.cho_solve(factor, target, check_finite=False))

        return objective

    def _solved(
        self,
        gram: Floats,
        right: Floats,
        precision: Floats,
        center: Floats,
        limits: Floats,
        start: Solution | None,
    ) -> Solution:
        variance = np.maximum(self.total / np.maximum(self.count, 1.0), self.floor)
        values = np.zeros(right.shape[1])
        free = np.ones(right.shape[1], dtype=bool)
        if start is not None:
            variance = np.maximum(start.variance, self.floor)
            shared = min(free.size, start.free.size)
            free[:shared], values[:shared] = start.free[:shared], start.values[:shared]
        weighted = np.zeros_like(gram[0])
        for _ in range(_MAX_SWEEPS):
            weighted = np.tensordot(1.0 / variance, gram, 1) + np.diag(precision)
            target = right.T @ (1.0 / variance) + precision * center
            values, free = _inside(weighted, target, limits, values, free)
            squares = self.total - 2.0 * right @ values + (gram @ values) @ values
            updated = np.maximum(squares / np.maximum(self.count, 1.0), self.floor)
            done = np.all(np.abs(updated / variance - 1.0) < _MAX_VARIANCE_CHANGE)
            variance = updated
            if done:
                break
        penalty = float(np.sum(precision * (values - center) ** 2))
        deviance = float(np.sum(self.count * np.log(variance))) + penalty
        return Solution(values, deviance, variance, free, weighted)


def _precision(sd: float) -> float:
    return 0.0 if np.isinf(sd) else 1.0 / sd**2


def _inside(
    matrix: Floats, right: Floats, limits: Floats, start: Floats, loose: Flags
) -> tuple[Floats, Flags]:
    """Minimum of ``c A c - 2 b c`` inside a box, and the coefficients that are not on its sides.

    Active sets: coefficients that leave the box are held on its side, and released where the slope points
    back into it.
    """
    from scipy import linalg

    low, high = limits.T
    held = ~loose
    values = np.clip(start, low, high)
    for _ in range(_MAX_ACTIVE_SETS):
        free = np.flatnonzero(~held)
        fixed = np.flatnonzero(held)
        target = right[free] - matrix[np.ix_(free, fixed)] @ values[fixed]
        values[free] = linalg.cho_solve(_factor(matrix[np.ix_(free, free)]), target, check_finite=False)
        out = ~held & ((values < low) | (values > high))
        if out.any():
            values = np.clip(values, low, high)
            held |= out
            continue
        slope = right - matrix @ values
        inward = held & (((values <= low) & (slope > 0.0)) | ((values >= high) & (slope < 0.0)))
        inward &= np.abs(slope) > 1e-9 * np.abs(right).max(initial=1.0)
        inward &= low < high
        if not inward.any():
            break
        held &= ~inward
    return np.clip(values, low, high), ~held


def _factor(matrix: Floats) -> tuple[Floats, bool]:
    """Cholesky factor; columns that nothing determines get a small ridge."""
    from scipy import linalg

    ridge = 1e-12 * float(np.diag(matrix).max(initial=1.0))
    lower = linalg.cholesky(matrix + ridge * np.eye(len(matrix)), lower=True, check_finite=False)
    return lower, True
