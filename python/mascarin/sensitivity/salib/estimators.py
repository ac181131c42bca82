"""Indices of one replicate and one output by SALib."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.salib.library import salib
from mascarin.sensitivity.salib.plans import LEVELS, SalibName, SalibPlan

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
        single = np.bincount(self.plan.group_of) == 1
        squares = (self._squares if single.all() else self._squares_of_groups)(u, y @ basis)
        effects = self._effects(u, y.mean(axis=1))
        effect, size, spread = (
            np.array(effects[key], dtype=np.float64) for key in ("mu", "mu_star", "sigma")
        )
        # The factors of a group move in different directions.
        effect[~single] = np.nan
        spread[~single] = np.nan
        return ReplicateIndices(squares, squares, float(squares.sum()), effect, size, spread)

    def _squares(self, u: Floats, components: Floats) -> Floats:
        """Mean squared effect (G,), summed over the components (N, K), from mean and spread."""
        if not components.shape[1]:
            return np.zeros(len(self.plan.groups))
        count = self.plan.size
        effects = [self._effects(u, component) for component in components.T]
        mean, spread = (np.array([f[key] for f in effects], dtype=np.float64) for key in ("mu", "sigma"))
        return np.asarray(np.sum(mean**2 + spread**2 * (count - 1) / count, axis=0))

    def _squares_of_groups(self, u: Floats, components: Floats) -> Floats:
        """The same from single trajectories, because SALib gives no spread for groups."""
        step, count = len(self.plan.groups) + 1, self.plan.size
        squares = np.zeros(step - 1)
        for k in range(count):
            rows = slice(k * step, (k + 1) * step)
            for component in components[rows].T:
                squares += np.array(self._effects(u[rows], component)["mu_star"]) ** 2 / count
        return squares

    def _effects(self, u: Floats, y: Floats) -> Any:
        with warnings.catch_warnings():
            # The spread of a single trajectory is undefined, and not used.
            warnings.simplefilter("ignore", RuntimeWarning)
            return salib("analyze.morris").analyze(
                self.plan.problem, u, y, num_resamples=2, num_levels=LEVELS, seed=_unused()
            )


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
