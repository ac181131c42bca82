"""Costs: one number per sensor from its residuals, and their sum.

======== ================================================= ==============================================
name     cost of a sensor                                  remarks
======== ================================================= ==============================================
sd       standard deviation of the residual about its mean the reference study; blind to bias
rmse     root mean square                                  in the unit of the sensor
cv_rmse  root mean square over the measured range, in %    not over the mean, which depends on where a
                                                           temperature scale has its zero
nmbe     size of the bias over the measured range, in %    one number per sensor: cannot find more
                                                           parameters than there are sensors
nll      negative log-likelihood of independent normal     with the sensors' uncertainty; parameters may
         errors                                            have priors
======== ================================================= ==============================================
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.problem import CalibrationProblem
from mascarin.errors import InputError, did_you_mean

Floats = NDArray[np.float64]
CostName = Literal["sd", "rmse", "cv_rmse", "nmbe", "nll"]


@dataclass(frozen=True, eq=False)
class Cost:
    """A cost function on a problem.

    Parameters
    ----------
    problem : CalibrationProblem
        Gives measurements, uncertainties and priors.
    name : str
        One of the names in this module's table.
    """

    problem: CalibrationProblem
    name: CostName

    def __post_init__(self) -> None:
        if self.name not in _SENSOR_COSTS:
            msg = f"cost '{self.name}' is not known. {did_you_mean(self.name, _SENSOR_COSTS)}"
            raise InputError(msg)
        priors = [p.path for p in self.problem.parameters if p.prior is not None]
        if priors and self.name != "nll":
            msg = f"{priors[0]} has a prior: only the cost 'nll' can weigh it against data, not '{self.name}'"
            raise InputError(msg)

    def of_sensors(self, residuals: Floats) -> Floats:
        """Cost of each sensor.

        Parameters
        ----------
        residuals : ndarray, shape (M, T, S)
            As `CalibrationProblem.residuals` gives them. [unit]

        Returns
        -------
        ndarray, shape (M, S)
            NaN for members that could not be simulated.
        """
        weights = np.array([s.weight for s in self.problem.sensors])
        costs: Floats = weights * _SENSOR_COSTS[self.name](self.problem, residuals)
        return costs

    def total(self, x: Floats, of_sensors: Floats) -> Floats:
        """Sum over the sensors, with the priors; infinite where a sensor's cost is not a number.

        Parameters
        ----------
        x : ndarray, shape (M, P)
            Members. [unit of each parameter]
        of_sensors : ndarray, shape (M, S)
            Cost of each sensor.

        Returns
        -------
        ndarray, shape (M,)
        """
        total = of_sensors.sum(axis=1) + 0.5 * np.sum(self.prior_residuals(x) ** 2, axis=1)
        return np.where(np.isfinite(total), total, math.inf)

    def prior_residuals(self, x: Floats) -> Floats:
        """Distances from the means of the priors in standard deviations, shape (M, number of priors)."""
        columns = [
            (x[:, i] - p.prior[0]) / p.prior[1]
            for i, p in enumerate(self.problem.parameters)
            if p.prior is not None
        ]
        return np.column_stack(columns) if columns else np.empty((x.shape[0], 0))

    def prior_slopes(self, z: Floats) -> Floats:
        """Their derivatives by the positions (P,), shape (number of priors, P). [-]"""
        rates = self.problem.rates(z)
        rows = [
            rates[i] / p.prior[1] * np.eye(z.size)[i]
            for i, p in enumerate(self.problem.parameters)
            if p.prior is not None
        ]
        return np.array(rows).reshape(-1, z.size)

    def weights(self, residuals: Floats) -> Floats:
        """Weights of the squared residuals for which least squares has its minimum where this cost has.

        Parameters
        ----------
        residuals : ndarray, shape (T, S)
            At the minimum. [unit]

        Returns
        -------
        ndarray, shape (T, S)
            0 where nothing is compared.
        """
        problem = self.problem
        importance = np.array([s.weight for s in problem.sensors])
        if self.name == "nll":
            return np.where(problem.mask, importance / problem.sigma**2, 0.0)
        # d(sqrt(q)) = dq / (2 sqrt(q)): a sum of root mean squares weighs each by its inverse.
        kind: CostName = "sd" if self.name == "sd" else "rmse"
        size = _SENSOR_COSTS[kind](problem, residuals[None])[0]
        span = _spans(problem) if self.name in ("cv_rmse", "nmbe") else np.ones(len(problem.sensors))
        count = problem.mask.sum(axis=0)
        floor = 1e-12 * np.maximum(_spans(problem), 1e-300)
        return np.where(problem.mask, importance / (np.maximum(size, floor) * span * count), 0.0)

    def tolerance(self, lowest: float, within: float) -> float:
        """Difference below which two costs count as the same.

        Parameters
        ----------
        lowest : float
            The lower of them.
        within : float
            Share of the lowest cost, or of the cost that errors of the size of the sensors' uncertainty would
            have, if that is more: data without noise would otherwise have no two equal costs. [-]
        """
        problem = self.problem
        importance = np.array([s.weight for s in problem.sensors])
        if self.name == "nll":
            expected = 0.5 * importance * problem.mask.sum(axis=0)
        else:
            expected = importance * _rmse(problem, np.where(problem.mask, problem.sigma, 0.0)[None])[0]
            if self.name in ("cv_rmse", "nmbe"):
                expected = 100.0 * expected / _spans(problem)
        return within * max(abs(lowest), float(expected.sum()))

    @property
    def blind_to_bias(self) -> bool:
        """Whether a constant added to a sensor's residuals changes nothing."""
        return self.name == "sd"


def _spans(problem: CalibrationProblem) -> Floats:
    return np.array([s.span for s in problem.sensors])


def _mean(problem: CalibrationProblem, values: Floats) -> Floats:
    """Mean over the compared samples of (M, T, S), shape (M, S)."""
    mean: Floats = values.sum(axis=1) / problem.mask.sum(axis=0)
    return mean


def _sd(problem: CalibrationProblem, residuals: Floats) -> Floats:
    centred = np.where(problem.mask, residuals - _mean(problem, residuals)[:, None], 0.0)
    return np.asarray(np.sqrt(_mean(problem, centred**2)))


def _rmse(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return np.asarray(np.sqrt(_mean(problem, residuals**2)))


def _cv_rmse(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return 100.0 * _rmse(problem, residuals) / _spans(problem)


def _nmbe(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return 100.0 * np.abs(_mean(problem, residuals)) / _spans(problem)


def _nll(problem: CalibrationProblem, residuals: Floats) -> Floats:
    sigma = np.where(problem.mask, problem.sigma, 1.0)
    constant = np.sum(np.where(problem.mask, np.log(sigma) + 0.5 * math.log(2.0 * math.pi), 0.0), axis=0)
    return np.asarray(0.5 * np.sum((residuals / sigma) ** 2, axis=1) + constant)


_SENSOR_COSTS: Final[dict[str, Callable[[CalibrationProblem, Floats], Floats]]] = {
    "sd": _sd,
    "rmse": _rmse,
    "cv_rmse": _cv_rmse,
    "nmbe": _nmbe,
    "nll": _nll,
}
