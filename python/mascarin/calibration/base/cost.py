"""Costs: one number for each sensor from its residuals, and their sum, which a calibration minimizes.

=============== =================================================== ==========================================
name            cost of a sensor                                    remarks
=============== =================================================== ==========================================
nll             negative log-likelihood of independent normal       with the uncertainty of the sensors;
                errors                                              parameters may have priors
sd              standard deviation of the residuals                 the cost of the reference study; does not
                                                                    include the bias
rmse            root mean square error                              in the unit of the sensor
rmse_over_range root mean square error over the measured range [%]  does not depend on the zero of a
                                                                    temperature scale
bias_over_range size of the bias over the measured range [%]        one number per sensor: cannot determine
                                                                    more parameters than there are sensors
cv_rmse         CV(RMSE) of ASHRAE Guideline 14: over the mean of   for energy and power, not for degC
                the measurements [%]
nmbe            size of NMBE of ASHRAE Guideline 14, over the mean  for energy and power, not for degC
                of the measurements [%]
=============== =================================================== ==========================================

`cv_rmse` and `nmbe` were names of `rmse_over_range` and `bias_over_range` before. For problems with a sensor
in degC they still are, with a note in `Cost.note` and in the warnings of the calibration.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.errors import InputError, did_you_mean
from mascarin.validation.comparison import GUIDELINE_PARAMETERS, OVER_MEAN, mean_refusal

Floats = NDArray[np.float64]
CostName = Literal["nll", "sd", "rmse", "rmse_over_range", "bias_over_range", "cv_rmse", "nmbe"]

ONE_NUMBER: Final = ("bias_over_range", "nmbe")
"""Costs that compare one number of each sensor, so that estimates have no intervals."""

_FORMER_NAMES: Final[dict[str, CostName]] = {"cv_rmse": "rmse_over_range", "nmbe": "bias_over_range"}


@dataclass(frozen=True, eq=False)
class Cost:
    """A cost function of a calibration problem.

    Parameters
    ----------
    problem : CalibrationProblem
        Gives measurements, uncertainties and priors.
    name : str
        One of the names in the table of this module.

    Attributes
    ----------
    note : str
        Note that the name was read as another one; empty if it was not.

    Raises
    ------
    InputError
        The name is unknown, a parameter has a prior that the cost cannot use, or a cost over the mean of the
        measurements cannot be computed.

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 0.0, 10.0),),
    ...     (FitSensor("heat", np.array([4.0, 6.0]), 0.1, unit="kWh"),),
    ...     lambda x: np.tile(x[:, :, None], (1, 2, 1)),
    ... )
    >>> Cost(problem, "rmse").of_sensors(problem.residuals(np.array([[5.0]])))
    array([[1.]])
    """

    problem: CalibrationProblem
    name: CostName
    note: str = field(init=False, default="")

    def __post_init__(self) -> None:
        if self.name not in _SENSOR_COSTS:
            msg = f"cost '{self.name}' is not known. {did_you_mean(self.name, _SENSOR_COSTS)}"
            raise InputError(msg)
        if self.name in OVER_MEAN:
            self._require_means()
        priors = [p.path for p in self.problem.parameters if p.prior is not None]
        if priors and self.name != "nll":
            msg = f"{priors[0]} has a prior: only the cost 'nll' can use it, not '{self.name}'"
            raise InputError(msg)

    def _require_means(self) -> None:
        """Read a former name of a cost over the range, and refuse means that nothing can be divided by."""
        temperatures = [s.name for s in self.problem.sensors if s.unit == "degC"]
        if temperatures:
            other = _FORMER_NAMES[self.name]
            note = (
                f"the cost '{self.name}' was read as '{other}' (over the measured range), because sensor "
                f"'{temperatures[0]}' is in degC; write '{other}'"
            )
            object.__setattr__(self, "note", note)
            object.__setattr__(self, "name", other)
            return
        for sensor in self.problem.sensors:
            reason = mean_refusal(sensor.measured[sensor.mask], sensor.unit)
            if reason:
                raise InputError(
                    f"cost '{self.name}': sensor '{sensor.name}': {reason}; expected measurements with a "
                    f"mean away from zero; use '{_FORMER_NAMES[self.name]}'"
                )

    def of_sensors(self, residuals: Floats) -> Floats:
        """Compute the cost of each sensor.

        Parameters
        ----------
        residuals : ndarray, shape (M, T, S)
            As `CalibrationProblem.residuals` gives them. [unit]

        Returns
        -------
        ndarray, shape (M, S)
            NaN for parameter vectors that could not be simulated.
        """
        weights = np.array([s.weight for s in self.problem.sensors])
        costs: Floats = weights * _SENSOR_COSTS[self.name](self.problem, residuals)
        return costs

    def total(self, x: Floats, of_sensors: Floats) -> Floats:
        """Sum the costs of the sensors and of the priors; infinite where one is not a number.

        Parameters
        ----------
        x : ndarray, shape (M, P)
            Parameter vectors. [unit of each parameter]
        of_sensors : ndarray, shape (M, S)
            Cost of each sensor.

        Returns
        -------
        ndarray, shape (M,)
        """
        total = of_sensors.sum(axis=1) + 0.5 * np.sum(self.prior_residuals(x) ** 2, axis=1)
        return np.where(np.isfinite(total), total, math.inf)

    def prior_residuals(self, x: Floats) -> Floats:
        """Return distances from means of priors in standard deviations, shape (M, number of priors). [-]"""
        columns = [
            (x[:, i] - p.prior[0]) / p.prior[1]
            for i, p in enumerate(self.problem.parameters)
            if p.prior is not None
        ]
        return np.column_stack(columns) if columns else np.empty((x.shape[0], 0))

    def prior_slopes(self, z: Floats) -> Floats:
        """Return the derivatives of `prior_residuals` by positions (P,), shape (number of priors, P). [-]"""
        rates = self.problem.rates(z)
        rows = [
            rates[i] / p.prior[1] * np.eye(z.size)[i]
            for i, p in enumerate(self.problem.parameters)
            if p.prior is not None
        ]
        return np.array(rows).reshape(-1, z.size)

    def weights(self, residuals: Floats) -> Floats:
        """Return weights of squared residuals for which least squares has the minimum of this cost.

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
        span = self._divisors()
        count = problem.mask.sum(axis=0)
        floor = 1e-12 * np.maximum(_spans(problem), 1e-300)
        return np.where(problem.mask, importance / (np.maximum(size, floor) * span * count), 0.0)

    def tolerance(self, lowest: float, within: float) -> float:
        """Return the difference below which two costs count as the same.

        Parameters
        ----------
        lowest : float
            The lower of them.
        within : float
            Part of the lowest cost, or of the cost of errors as large as the uncertainty of the sensors, if
            that is more: without noise no two costs would be equal otherwise. [-]
        """
        problem = self.problem
        importance = np.array([s.weight for s in problem.sensors])
        if self.name == "nll":
            expected = 0.5 * importance * problem.mask.sum(axis=0)
        else:
            expected = importance * _rmse(problem, np.where(problem.mask, problem.sigma, 0.0)[None])[0]
            expected = 100.0 * expected / self._divisors() if self.name in _PERCENT else expected
        return within * max(abs(lowest), float(expected.sum()))

    @property
    def ignores_bias(self) -> bool:
        """Whether a constant added to the residuals of a sensor changes nothing."""
        return self.name == "sd"

    def _divisors(self) -> Floats:
        """What the root mean square of each sensor is divided by, shape (S,). [unit]"""
        if self.name in OVER_MEAN:
            count = self.problem.mask.sum(axis=0)
            return np.asarray(_mean_sizes(self.problem) * np.sqrt((count - GUIDELINE_PARAMETERS) / count))
        return _spans(self.problem) if self.name in _PERCENT else np.ones(len(self.problem.sensors))


_PERCENT: Final = ("rmse_over_range", "bias_over_range", *OVER_MEAN)


def _spans(problem: CalibrationProblem) -> Floats:
    return np.array([s.span for s in problem.sensors])


def _mean_sizes(problem: CalibrationProblem) -> Floats:
    """Size of the mean of the compared measurements, shape (S,). [unit]"""
    return np.array([abs(float(s.measured[s.mask].mean())) for s in problem.sensors])


def _mean(problem: CalibrationProblem, values: Floats) -> Floats:
    """Average over the compared samples of (M, T, S), shape (M, S)."""
    mean: Floats = values.sum(axis=1) / problem.mask.sum(axis=0)
    return mean


def _sd(problem: CalibrationProblem, residuals: Floats) -> Floats:
    centered = np.where(problem.mask, residuals - _mean(problem, residuals)[:, None], 0.0)
    return np.asarray(np.sqrt(_mean(problem, centered**2)))


def _rmse(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return np.asarray(np.sqrt(_mean(problem, residuals**2)))


def _rmse_over_range(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return 100.0 * _rmse(problem, residuals) / _spans(problem)


def _bias_over_range(problem: CalibrationProblem, residuals: Floats) -> Floats:
    return 100.0 * np.abs(_mean(problem, residuals)) / _spans(problem)


def _cv_rmse(problem: CalibrationProblem, residuals: Floats) -> Floats:
    freedom = problem.mask.sum(axis=0) - GUIDELINE_PARAMETERS
    return np.asarray(100.0 * np.sqrt(np.sum(residuals**2, axis=1) / freedom) / _mean_sizes(problem))


def _nmbe(problem: CalibrationProblem, residuals: Floats) -> Floats:
    freedom = problem.mask.sum(axis=0) - GUIDELINE_PARAMETERS
    return np.asarray(100.0 * np.abs(residuals.sum(axis=1)) / freedom / _mean_sizes(problem))


def _nll(problem: CalibrationProblem, residuals: Floats) -> Floats:
    sigma = np.where(problem.mask, problem.sigma, 1.0)
    constant = np.sum(np.where(problem.mask, np.log(sigma) + 0.5 * math.log(2.0 * math.pi), 0.0), axis=0)
    return np.asarray(0.5 * np.sum((residuals / sigma) ** 2, axis=1) + constant)


_SENSOR_COSTS: Final[dict[str, Callable[[CalibrationProblem, Floats], Floats]]] = {
    "sd": _sd,
    "rmse": _rmse,
    "rmse_over_range": _rmse_over_range,
    "bias_over_range": _bias_over_range,
    "cv_rmse": _cv_rmse,
    "nmbe": _nmbe,
    "nll": _nll,
}
