"""Indices of one replicate and one output, by SALib but for elementary effects."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.salib.library import salib
from mascarin.sensitivity.salib.plans import LEVELS, SalibName, SalibPlan

#: Length of a step of a trajectory, in ranges.
MOVE: Final = LEVELS / (2.0 * (LEVELS - 1.0))
_MAX_OMITTED_VARIANCE: Final = 1e-6


@dataclass(frozen=True, eq=False)
class ReplicateIndices:
    """The result of one replicate for one output.

    Attributes
    ----------
    first, total : ndarray, shape (G,)
        First-order and total part of the variance; Morris: squared effects. [square of the unit]
    variance : float
        The variance; Morris: sum of the squared effects. [square of the unit]
    effect : ndarray, shape (G,)
        Change of the mean over time over the range; NaN for groups of several factors. [unit]
    mean_size, spread : ndarray, shape (G,)
        Morris: mean magnitude and standard deviation of the elementary effects on the mean over time, else
        NaN. [unit]
    """

    first: Floats
    total: Floats
    variance: float
    effect: Floats
    mean_size: Floats
    spread: Floats


class Estimator(ABC):
    """Computes the indices of one replicate and one output."""

    def __init__(self, plan: SalibPlan) -> None:
        self.plan = plan

    @abstractmethod
    def part(self, u: Floats, y: Floats, basis: Floats) -> ReplicateIndices:
        """Analyze one replicate.

        Parameters
        ----------
        u : ndarray, shape (N, P)
            Samples as probabilities. [-]
        y : ndarray, shape (N, T)
            Output by run and time. [unit]
        basis : ndarray, shape (T, K)
            Orthonormal directions in time, see `components`. [-]

        Returns
        -------
        Part
            The parts of the variance and the effects.
        """

    def _part(self, first: Floats, total: Floats, variance: float, effect: Floats) -> ReplicateIndices:
        none = np.full(effect.shape, np.nan)
        return ReplicateIndices(first, total, variance, effect, none, none)

    def _slopes(self, u: Floats, y: Floats) -> Floats:
        """Change of the mean over time over the range, by linear regression on one factor; NaN for groups."""
        slopes = np.full(len(self.plan.groups), np.nan)
        mean = y.mean(axis=1)
        for g in np.flatnonzero(np.bincount(self.plan.group_of) == 1):
            i = int(np.flatnonzero(self.plan.group_of == g)[0])
            factor = self.plan.factors[i]
            x = factor.quantile(u[:, i])
            centered = x - x.mean()
            slopes[g] = (factor.high - factor.low) * float(centered @ mean) / float(centered @ centered)
        return slopes


class _RbdFast(Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> ReplicateIndices:
        first = np.zeros(len(self.plan.groups))
        for component in (y @ basis).T:
            result = salib("analyze.rbd_fast").analyze(
                self.plan.problem, u, component, M=self.plan.order, num_resamples=2, seed=_unused()
            )
            first += np.array(result["S1"], dtype=np.float64) * component.var()
        return self._part(first, first, float(y.var(axis=0).sum()), self._slopes(u, y))


class _Sobol(Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> ReplicateIndices:
        # The rows of a base point: A, then A with one column of B each, then B.
        step = len(self.plan.groups) + 2
        free = np.r_[np.arange(0, len(y), step), np.arange(step - 1, len(y), step)]
        first, total = np.zeros(step - 2), np.zeros(step - 2)
        for component in (y @ basis).T:
            if np.ptp(component) == 0.0:
                continue
            result = salib("analyze.sobol").analyze(
                self.plan.problem, component, calc_second_order=False, num_resamples=2, seed=_unused()
            )
            size = component[free].var()
            first += np.asarray(result["S1"]) * size
            total += np.asarray(result["ST"]) * size
        return self._part(first, total, float(y[free].var(axis=0).sum()), self._slopes(u[free], y[free]))


class _Morris(Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> ReplicateIndices:
        together = np.column_stack([y.mean(axis=1), y @ basis])
        effects = elementary_effects(u, together, self.plan.group_of)
        of_mean, squares = effects[:, :, 0], np.mean(np.sum(effects[:, :, 1:] ** 2, axis=2), axis=1)
        effect, spread = of_mean.mean(axis=1), of_mean.std(axis=1, ddof=1)
        # The factors of a group move in different directions.
        multiple = np.bincount(self.plan.group_of) > 1
        effect[multiple] = np.nan
        spread[multiple] = np.nan
        size = np.abs(of_mean).mean(axis=1)
        return ReplicateIndices(squares, squares, float(squares.sum()), effect, size, spread)


def elementary_effects(u: Floats, y: Floats, group_of: NDArray[np.int64]) -> Floats:
    """Compute the elementary effects of several outputs at once.

    SALib computes those of one output at a time, with a matrix of parameters by parameters for each.

    Parameters
    ----------
    u : ndarray, shape (R (G + 1), P)
        Samples of R trajectories as probabilities; each step of one moves the factors of one group. [-]
    y : ndarray, shape (R (G + 1), K)
        Outputs of the runs. [unit of each]
    group_of : ndarray of int, shape (P,)
        Group of each factor, of 0 to G - 1.

    Returns
    -------
    ndarray, shape (G, R, K)
        Change of each output for a move of the group over its whole range, with the sign of the move of its
        first factor. [unit of each]

    References
    ----------
    Morris M.D. (1991), Technometrics 33, 161. https://doi.org/10.1080/00401706.1991.10484804

    Examples
    --------
    >>> u = np.array([[0.0, 1.0], [2 / 3, 1.0], [2 / 3, 1 / 3]])
    >>> elementary_effects(u, u @ [[3.0], [-1.0]], np.array([0, 1])).round(3).ravel().tolist()
    [3.0, -1.0]
    """
    count = int(group_of.max()) + 1
    trajectories = u.reshape(-1, count + 1, u.shape[1])
    moves = np.diff(trajectories, axis=1)
    changes = np.diff(y.reshape(len(trajectories), count + 1, -1), axis=1)
    # The first factor that a step moves: all of its group are moved by the same length.
    first = np.argmax(np.abs(moves) > 0.25 * MOVE, axis=2)
    sign = np.sign(np.take_along_axis(moves, first[:, :, None], axis=2))
    effects = np.empty((count, len(trajectories), changes.shape[2]))
    effects[group_of[first].T, np.arange(len(trajectories))] = np.moveaxis(sign * changes / MOVE, 1, 0)
    return effects


ESTIMATORS: Final[dict[SalibName, type[Estimator]]] = {
    "rbd-fast": _RbdFast,
    "sobol": _Sobol,
    "morris": _Morris,
}


def components(y: Floats) -> Floats:
    """Compute orthonormal directions in time that hold all but a millionth of the variance.

    Parameters
    ----------
    y : ndarray, shape (N, T)
        Output by run and time. [unit]

    Returns
    -------
    ndarray, shape (T, K)
        The directions. [-]
    """
    centered = y - y.mean(axis=0)
    value, vector = np.linalg.eigh(centered.T @ centered)
    value, vector = np.maximum(value[::-1], 0.0), vector[:, ::-1]
    total = float(value.sum())
    if total <= 0.0:
        return np.asarray(vector[:, :0])
    count = int(np.searchsorted(np.cumsum(value), (1.0 - _MAX_OMITTED_VARIANCE) * total)) + 1
    return np.asarray(vector[:, : min(count, value.size)])


def _unused() -> np.random.Generator:
    """Random numbers for SALib's intervals, which are not used."""
    return np.random.default_rng(1)
