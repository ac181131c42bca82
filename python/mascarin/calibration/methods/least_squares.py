"""Least squares from several starts, with derivatives by differences (one batch of runs) or exact ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.evaluations import Evaluator
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.result import Minimum
from mascarin.calibration.base.search_options import SearchOptions
from mascarin.errors import SolverError

Floats = NDArray[np.float64]

#: A search ends when so many steps lower the cost by less than a part `_MIN_COST_DECREASE` of it.
_IDLE_STEPS: Final = 6
_MIN_COST_DECREASE: Final = 1e-7
#: Rows of one block of the QR decomposition.
_BLOCK_ROWS: Final = 256
_NO_DERIVATIVE: Final = "the model cannot be evaluated near the minimum: the uncertainty cannot be estimated"


class _Idle(Exception):
    """The cost no longer moves."""


class _Watch:
    """Ends a search whose cost no longer moves.

    Where a run has a small error of its own (iterations that end, a layer that begins to melt) the reduction
    differs from what the derivatives predict. The method then never takes its tolerance of the cost as met,
    and shrinks its steps down to the tolerance of the position.
    """

    def __init__(self, size: Callable[[Floats], Floats]) -> None:
        self._size = size
        self._lowest: list[float] = []
        self.best: Floats = np.empty(0)

    def __call__(self, z: Floats) -> Floats:
        residuals = self._size(z)
        cost = float(residuals @ residuals)
        before = self._lowest[-1] if self._lowest else np.inf
        if cost < before or not self._lowest:
            self.best = np.array(z)
        self._lowest.append(float(np.fmin(cost, before)))
        if len(self._lowest) > _IDLE_STEPS:
            fall = self._lowest[-1 - _IDLE_STEPS] - self._lowest[-1]
            if fall <= _MIN_COST_DECREASE * self._lowest[-1]:
                raise _Idle
        return residuals


def least_squares(
    problem: CalibrationProblem, evaluator: Evaluator, options: SearchOptions, seed: int
) -> tuple[list[Minimum], str]:
    """Run one trust-region search from each start.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    evaluator : Evaluator
        Evaluates and keeps the record.
    options : SearchOptions
        Number of starts, kind of derivatives and tolerance.
    seed : int
        Of the Latin hypercube of starts.

    Returns
    -------
    list of Minimum
        Where the searches ended.
    str
        Why the calibration ended.
    """
    from scipy import optimize

    minima = []
    skipped = 0
    for k, z in enumerate(_hypercube(problem, options.starts, seed)):
        if k and not np.isfinite(evaluator.residuals(problem.values(z[None]))).all():
            skipped += 1
            continue
        squares = Squares(problem, evaluator, options)
        tight = options.tolerance
        watch = _Watch(squares.size)
        try:
            solution = optimize.least_squares(
                watch,
                z,
                jac=squares.condensed,
                bounds=(0.0, 1.0),
                method="trf",
                ftol=tight,
                xtol=tight,
                gtol=tight,
                max_nfev=100,
            )
            ended, message = solution.x, str(solution.message)
        except _Idle:
            ended, message = watch.best, f"the cost did not move in {_IDLE_STEPS} steps"
        # The method stays a little inside its bounds: an end that near to a bound is the bound.
        end = np.where(ended < 1e-6, 0.0, np.where(ended > 1.0 - 1e-6, 1.0, ended))
        x = problem.values(end[None])[0]
        cost = float(evaluator.costs(x[None])[0])
        start = problem.values(z[None])[0]
        minima.append(Minimum(k, start, x, cost, squares.evaluations, message))
    text = f"{len(minima)} start{'s' * (len(minima) != 1)} searched"
    return minima, text + (f", {skipped} skipped because the model fails there" if skipped else "")


def scale_of(problem: CalibrationProblem) -> Floats:
    """Return factors that turn compared residuals (n,) into those of the likelihood. [1/unit]"""
    weight = np.array([s.weight for s in problem.sensors])
    return np.asarray(np.where(problem.mask, np.sqrt(weight) / problem.sigma, 0.0)[problem.mask])


class Squares:
    """Weighted residuals and their derivative by the positions z.

    The search gets only the norm of the residuals r (n,), and of their Jacobian J only P + 1 rows with the
    same J'J and J'r: all that it needs, whatever the number of samples. With a long matrix the linear algebra
    libraries would use several threads, which wait for each other on a busy machine.
    """

    def __init__(self, problem: CalibrationProblem, evaluator: Evaluator, options: SearchOptions) -> None:
        self._problem = problem
        self._evaluator = evaluator
        self._exact = options.slopes == "exact"
        self._difference = options.difference
        self._scale = scale_of(problem)
        self.evaluations = 0

    def size(self, z: Floats) -> Floats:
        """Return the norm of the residuals, then P zeros."""
        return np.concatenate([[np.linalg.norm(self.residuals(z))], np.zeros(z.size)])

    def condensed(self, z: Floats) -> Floats:
        """Return the Jacobian (P + 1, P) for `size`: of R in [r J] = Q R all but the first column."""
        long = np.column_stack([self.weighted(z[None])[0], self.jacobian(z)])
        rows = max(_BLOCK_ROWS, long.shape[1])
        count = -(-len(long) // rows)
        blocks = np.zeros((count * rows, long.shape[1]))
        blocks[: len(long)] = long
        parts = _triangles(blocks.reshape(count, rows, -1))
        triangle = _triangles(parts.reshape(-1, long.shape[1]))
        return np.asarray(np.copysign(1.0, triangle[0, 0]) * triangle[:, 1:])

    def residuals(self, z: Floats) -> Floats:
        """Return residuals over their uncertainty, then those of the priors."""
        # The neighbors are needed next, unless the step is rejected; together they fill a batch.
        points = z[None] if self._exact else np.concatenate([z[None], self._neighbors(z)])
        self.evaluations += points.shape[0]
        values: Floats = self.weighted(points)[0]
        return values

    def jacobian(self, z: Floats) -> Floats:
        """Return exact derivatives, or forward differences (backward at a bound or after a failure)."""
        if self._exact:
            # Counted like differences: one run for each parameter.
            self.evaluations += z.size
            data = exact(self._problem, self._evaluator, z)[self._problem.mask] * self._scale[:, None]
            return np.concatenate([data, self._evaluator.cost.prior_slopes(z)])
        points = np.concatenate([z[None], self._neighbors(z)])
        values = self.weighted(points)
        for i in np.flatnonzero(~np.isfinite(values[1:]).all(axis=1)):
            points[1 + i, i] = 2.0 * z[i] - points[1 + i, i]
            if not 0.0 <= points[1 + i, i] <= 1.0:
                points[1 + i, i] = z[i]
            values[1 + i] = self.weighted(points[1 + i : 2 + i])[0]
            self.evaluations += 1
        steps = np.diagonal(points[1:]) - z
        if not np.isfinite(values).all() or np.any(steps == 0.0):
            where = self._problem.values(z[None])[0]
            text = ", ".join(f"{p} = {v:g}" for p, v in zip(self._problem.paths, where, strict=True))
            msg = f"the model cannot be evaluated near {text}: no derivative there"
            raise SolverError(msg)
        return np.asarray(((values[1:] - values[0]) / steps[:, None]).T)

    def _neighbors(self, z: Floats) -> Floats:
        step = np.where(z + self._difference <= 1.0, self._difference, -self._difference)
        return np.asarray(z + np.diag(step))

    def weighted(self, z: Floats) -> Floats:
        """Return residuals over their uncertainty, then those of the priors, for positions (M, P)."""
        x = self._problem.values(z)
        residuals = self._evaluator.residuals(x)[:, self._problem.mask] * self._scale
        priors = self._evaluator.cost.prior_residuals(x)
        return np.asarray(np.concatenate([residuals, priors], axis=1), dtype=np.float64)


def _triangles(rows: Floats) -> Floats:
    """Return R of the QR decomposition of each matrix (..., m, n), shape (..., n, n)."""
    return np.asarray(np.linalg.qr(rows, mode="r"), dtype=np.float64)


def _hypercube(problem: CalibrationProblem, count: int, seed: int) -> Iterator[Floats]:
    """The given start, then a Latin hypercube over the ranges."""
    from scipy.stats import qmc

    yield problem.positions(np.array([p.first for p in problem.parameters]))
    if count > 1:
        yield from qmc.LatinHypercube(len(problem.parameters), rng=np.random.default_rng(seed)).random(
            count - 1
        )


def exact(problem: CalibrationProblem, evaluator: Evaluator, z: Floats) -> Floats:
    """Compute exact derivatives of residuals by positions z (P,), shape (T, S, P). [unit of the sensor]"""
    return np.ascontiguousarray(evaluator.slopes(problem.values(z[None])[0]) * problem.rates(z))


def residuals_and_derivatives(
    problem: CalibrationProblem, evaluator: Evaluator, z: Floats, options: SearchOptions
) -> tuple[Floats, Floats]:
    """Compute residuals (T, S) at a minimum and their derivatives by z (T, S, P), as the options say."""
    if options.slopes == "exact":
        return evaluator.residuals(problem.values(z[None]))[0], exact(problem, evaluator, z)
    return derivative(problem, z, options.difference)


def residuals_at(problem: CalibrationProblem, z: Floats) -> Floats:
    """Compute residuals at positions z (P,), shape (T, S). [unit]

    Raises
    ------
    SolverError
        The model cannot be simulated there.
    """
    residuals = problem.residuals(problem.values(z[None]))[0]
    if not np.isfinite(residuals).all():
        raise SolverError(_NO_DERIVATIVE)
    return np.asarray(residuals)


def derivative(problem: CalibrationProblem, z: Floats, difference: float) -> tuple[Floats, Floats]:
    """Compute residuals (T, S) and central differences by z (T, S, P), one-sided at a bound, in one batch."""
    n = z.size
    ahead = np.minimum(z + difference, 1.0)
    behind = np.maximum(z - difference, 0.0)
    points = np.tile(z, (2 * n, 1))
    for i in range(n):
        points[i, i] = ahead[i]
        points[n + i, i] = behind[i]
    # The middle by itself: a search has it already.
    middle, values = residuals_at(problem, z), problem.residuals(problem.values(points))
    if not np.isfinite(values).all():
        raise SolverError(_NO_DERIVATIVE)
    jacobian = (values[:n] - values[n:]) / (ahead - behind)[:, None, None]
    # As it is when it is read again: products depend in the last digits on the order in memory.
    return middle, np.ascontiguousarray(np.moveaxis(jacobian, 0, -1))
