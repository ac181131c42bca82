"""Blocks of days against days: independent errors leave intervals as they are, lasting ones widen them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mascarin.calibration.errors.block_dispersion import block_dispersion
from mascarin.calibration.errors.day_blocks import DayGaussian, Experiments
from mascarin.calibration.errors.discrepancy import Discrepancy
from mascarin.calibration.errors.joint_posterior import JointPosterior

DAYS, LENGTH = 100, 5


def distribution(days: int = DAYS) -> Experiments:
    """Days with a common effect of any size, and errors of variance 1 that are taken as independent."""
    return Experiments(
        [DayGaussian(np.ones((days, 1, 1)), np.full((days, 1, 1), 10.0), np.ones((days, 1), dtype=bool))]
    )


def mean_dispersion(correlation: float, draws: int = 200) -> float:
    """Mean over draws of errors whose days have the correlation ``exp(-lag / correlation)``."""
    rng, lag = np.random.default_rng(3), np.abs(np.subtract.outer(np.arange(DAYS), np.arange(DAYS)))
    kernel = np.exp(-lag / correlation) if correlation else np.eye(DAYS)
    root = np.linalg.cholesky(kernel)
    gaussian = distribution()
    values = (root @ rng.standard_normal(DAYS) + 3.0 for _ in range(draws))
    return float(np.mean([block_dispersion(gaussian, [value[:, None]], LENGTH) for value in values]))


def test_independent_days_need_no_wider_intervals() -> None:
    """A chi-squared variable over its 20 degrees of freedom, not below 1: its mean is 1.13."""
    assert mean_dispersion(0.0) == pytest.approx(1.13, abs=0.04)


def test_errors_that_last_are_found() -> None:
    """The variance of means of five days about that of all days, 1/5 - 1/100 where days are independent.

    The variance of the mean of n days is ``(1 + 2 sum (1 - k/n) e^(-k/5)) / n``.
    """

    def of_mean(days: int) -> float:
        k = np.arange(1, days)
        return (1.0 + 2.0 * float(np.sum((1.0 - k / days) * np.exp(-k / 5.0)))) / days

    expected = (of_mean(LENGTH) - of_mean(DAYS)) / (1.0 / LENGTH - 1.0 / DAYS)
    assert expected == pytest.approx(3.43, abs=0.01)
    assert mean_dispersion(5.0) == pytest.approx(expected, rel=0.05)


def test_two_blocks_say_nothing() -> None:
    values = np.repeat([5.0, -5.0], LENGTH)[:, None]
    assert block_dispersion(distribution(2 * LENGTH), [values], LENGTH) == 1.0
    # A block is at least as long as the errors last: 14 days have two of 5.5 days.
    assert block_dispersion(distribution(14), [np.arange(14.0)[:, None]], 5.5) == 1.0


def test_blocks_of_all_experiments_count() -> None:
    """Two experiments of ten days have four blocks."""
    half = distribution(2 * LENGTH).alone[0]
    values = np.repeat([5.0, -5.0], LENGTH)[:, None]
    assert block_dispersion(Experiments([half, half]), [values, values], LENGTH) > 20.0


def test_intervals_and_bands_are_wider_by_its_root() -> None:
    """With priors that say nothing, intervals of parameters are wider by 2, variances of bands by 4."""
    rng = np.random.default_rng(1)
    unit = np.eye(1)
    none = np.zeros(0)
    posterior = JointPosterior(
        np.array([0.5]), np.array([0.5]), 1e-4 * unit, 0.5 + 0.01 * rng.standard_normal((4000, 1)),
        Discrepancy(unit, unit, unit, np.ones(1), np.ones(1), 4.0), (), np.zeros(20), 0.0, np.array([1e3]),
        np.zeros(1), none, none, none, none,
    )  # fmt: skip
    wide = replace(posterior, dispersion=4.0)
    spread = [float(np.ptp(np.quantile(each.widened(), [0.025, 0.975]))) for each in (posterior, wide)]
    assert spread[1] == pytest.approx(2.0 * spread[0], rel=1e-6)
    columns = np.ones((1, 1, 1))
    variance = [each.predicted(columns, np.array([0.5]))[1][0, 0] for each in (posterior, wide)]
    assert variance == pytest.approx([1e-4, 4e-4])
