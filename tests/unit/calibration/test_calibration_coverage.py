"""How often intervals and bands contain the truth when the errors are those that are assumed.

Everything is drawn from the assumed process: parameters and offsets, the sizes of the errors from their
priors, the errors of each day. A Bayesian interval of 95 % then contains 95 % of the truths. Assumed is what
`mascarin.calibration.errors.joint_posterior` says: the scale of the errors of the model is the stated
uncertainty less the offset, the error within a day is at least half of a stated uncertainty, and no offset
exceeds two.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import truncnorm

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor
from mascarin.calibration.errors.bounded_coefficients import LARGEST_ERROR
from mascarin.calibration.errors.covariance_sampling import inverse_wishart
from mascarin.calibration.errors.day_blocks import DayGrid
from mascarin.calibration.errors.discrepancy import (
    CORRELATION_HOURS,
    Discrepancy,
    alike_days,
    at_least,
    drift_kernel,
    hour_basis,
    root_of,
)
from mascarin.calibration.errors.joint_posterior import joint_posterior
from mascarin.calibration.errors.linear_estimation import LEAST_ERROR, ErrorStatement, Linear
from mascarin.calibration.errors.sensor_errors import SensorError, error_columns

Floats = NDArray[np.float64]

SENSORS, PARAMETERS, DAYS, BLIND = 2, 4, 5, 12
SCALE, OFFSET = 0.15, 0.15
#: What is stated of each sensor: its offset and the scale of everything else.
STATED = float(np.hypot(SCALE, OFFSET))
HOURS = np.arange(24.0 * (DAYS + BLIND))
SEEN = HOURS < 24.0 * DAYS
ALIKE = alike_days(DAYS, 5.0)
GRID = DayGrid(np.zeros(0, int), np.zeros(0, int), 1, 24, 1.0)


def covariance(rng: np.random.Generator) -> Floats:
    """A covariance from its prior (Huang and Wand 2013, with 2 degrees of freedom)."""
    inverse = rng.gamma(0.5, 1.0, SENSORS) * SCALE**2
    found = inverse_wishart(rng, 4.0 * np.diag(inverse), SENSORS + 1.0)
    shrink = np.minimum(1.0, 1.0 / np.sqrt(np.diag(found)))
    return np.asarray(found * np.outer(shrink, shrink))


def sizes_of(rng: np.random.Generator) -> Discrepancy:
    white = np.minimum(np.diag(covariance(rng)), 1.0)
    hours = float(rng.choice(CORRELATION_HOURS))
    drift = at_least(covariance(rng), LEAST_ERROR * STATED)
    return Discrepancy(covariance(rng), covariance(rng), drift, white, np.zeros(SENSORS), hours, ALIKE)


def slopes(rng: np.random.Generator) -> Floats:
    """Responses to the parameters: daily cycles whose size differs from day to day, shape (n, S, P)."""
    phase, lag = rng.uniform(0.0, 24.0, (1, 1, PARAMETERS)), rng.uniform(0.0, 4.0, (1, SENSORS, 1))
    level, size = rng.uniform(0.0, 1.5, PARAMETERS), 10.0 ** rng.uniform(-1.0, 0.3, PARAMETERS)
    strength = np.repeat(rng.normal(1.0, 0.4, (DAYS + BLIND, 1, PARAMETERS)), 24, axis=0)
    return np.asarray(size * strength * (level + np.cos((HOURS[:, None, None] - lag - phase) * np.pi / 12.0)))


def errors(rng: np.random.Generator, sizes: Discrepancy) -> Floats:
    """Errors of all hours, shape (n, S)."""
    grid_kernel = drift_kernel(GRID, sizes.correlation_hours)
    repeating = hour_basis(HOURS) @ rng.normal(size=(5, SENSORS)) @ root_of(sizes.hour).T
    day = root_of(sizes.day)
    level = np.where(np.arange(DAYS + BLIND)[:, None] < DAYS, rng.normal(size=SENSORS), 0.0)
    level[DAYS:] = rng.normal(size=(BLIND, SENSORS))  # other weeks have another level
    of_day = (np.sqrt(ALIKE) * level + rng.normal(size=level.shape)) @ day.T
    slow = np.linalg.cholesky(grid_kernel) @ rng.normal(size=(DAYS + BLIND, 24, SENSORS))
    slow = slow.reshape(-1, SENSORS) @ root_of(sizes.drift).T
    white = rng.normal(size=slow.shape) * np.sqrt(sizes.white)
    offset = OFFSET * truncnorm.rvs(-LARGEST_ERROR, LARGEST_ERROR, size=SENSORS, random_state=rng)
    return np.asarray(repeating + np.repeat(of_day, 24, axis=0) + slow + white + offset)


def experiment(seed: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which parameters, and which blind values, are inside."""
    rng = np.random.default_rng(seed)
    slope, z = slopes(rng), rng.normal(0.5, 0.2, PARAMETERS)
    while np.any((z < 0.0) | (z > 1.0)):
        z = rng.normal(0.5, 0.2, PARAMETERS)
    measured = 20.0 + slope @ (z - 0.5) + errors(rng, sizes_of(rng))
    problem = CalibrationProblem(
        tuple(FitParameter(f"p{k}", 0.0, 1.0, nominal=0.5, prior=(0.5, 0.2)) for k in range(PARAMETERS)),
        tuple(FitSensor(f"s{s}", measured[SEEN, s], STATED) for s in range(SENSORS)),
        lambda x: np.tile(measured[SEEN][None], (len(x), 1, 1)),
        step=3600.0,
    )
    stated = ErrorStatement(
        tuple(SensorError(offset=OFFSET) for _ in range(SENSORS)), HOURS[SEEN], 3600.0, np.ones(SENSORS)
    )
    middle = np.full(PARAMETERS, 0.5)
    none = np.zeros((int(SEEN.sum()), SENSORS, 0))
    found = joint_posterior(
        problem, Linear(middle, np.full((len(none), SENSORS), 20.0), slope[SEEN], none), stated
    )
    low, high = np.quantile(found.sample, [0.025, 0.975], axis=0)
    blind = ~SEEN
    # The sample itself: a study widens it, because it does not know that the errors are as assumed.
    known, _ = error_columns(
        [s.name for s in problem.sensors], stated.sensors, np.zeros((int(blind.sum()), SENSORS)), 3600.0
    )
    expected, variance = found.predicted(found.effects(slope[blind], known, HOURS[blind]), middle)
    half = 1.96 * np.sqrt(variance + found.error_covariances.new_day)
    return (low <= z) & (z <= high), np.abs(measured[blind] - 20.0 - expected) <= half


def test_intervals_and_bands_contain_what_they_say_over_many_experiments() -> None:
    results = [experiment(seed) for seed in range(120)]
    inside = np.array([parameters for parameters, _ in results])
    held = np.array([values.mean(axis=0) for _, values in results])
    assert 0.93 <= inside.mean() <= 0.97
    assert inside.mean(axis=0).min() >= 0.85
    assert 0.93 <= held.mean() <= 0.97
    assert held.mean(axis=0).min() >= 0.88


def test_a_covariance_is_drawn_from_fewer_large_errors_than_sensors() -> None:
    """The sum of squares is singular, and what the prior adds is below its round-off."""
    rng = np.random.default_rng(5)
    for size in (3, 8, 12):
        errors = 1e5 * rng.standard_normal((2, size))
        total = errors.T @ errors + 1e-9 * np.eye(size)
        with pytest.raises(np.linalg.LinAlgError):
            np.linalg.cholesky(total - 1e-4 * np.eye(size))
        draw = inverse_wishart(rng, total - 1e-4 * np.eye(size), size + 3.0)
        assert np.isfinite(draw).all()
        assert (np.diag(draw) > 0.0).all()
    # A regular sum is drawn as before: the mean is total / (freedom - size - 1).
    draws = [inverse_wishart(rng, np.diag([4.0, 1.0]), 30.0) for _ in range(4000)]
    assert np.mean(draws, axis=0) == pytest.approx(np.diag([4.0, 1.0]) / 27.0, abs=0.01)
