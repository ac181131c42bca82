"""Errors of sensors and model: compared with dense normal distributions and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions, solve
from mascarin.calibration.errors.covariance_sampling import sample_covariances
from mascarin.calibration.errors.day_blocks import DayGaussian, DayGrid
from mascarin.calibration.errors.discrepancy import (
    DayData,
    Discrepancy,
    SizeLimits,
    alike_days,
    drift_kernel,
    estimate_discrepancy,
    hour_basis,
)
from mascarin.calibration.errors.joint_estimation import estimate_jointly
from mascarin.calibration.errors.joint_posterior import JointPosterior, joint_posterior
from mascarin.calibration.errors.linear_estimation import ErrorStatement, Linear
from mascarin.calibration.errors.nearness import nearness
from mascarin.calibration.errors.pseudo_bma_weights import pseudo_bma_weights, used_form, weighted_quantiles
from mascarin.calibration.errors.sensor_errors import SensorError, error_columns
from mascarin.calibration.sampling.truncated_normal import within_bounds
from mascarin.errors import InputError

Floats = NDArray[np.float64]


def dense(gaussian: DayGaussian) -> Floats:
    """The whole covariance of the values that are there."""
    days, size, shared = gaussian.columns.shape
    columns = gaussian.columns.reshape(days * size, shared)
    whole = columns @ columns.T
    for d, block in enumerate(gaussian.blocks):
        whole[d * size : (d + 1) * size, d * size : (d + 1) * size] += block
    there = gaussian.present.ravel()
    return np.asarray(whole[np.ix_(there, there)])


def example(missing: bool) -> tuple[DayGaussian, Floats]:
    rng = np.random.default_rng(3)
    half = rng.normal(size=(6, 6))
    block = half @ half.T + np.eye(6)
    present = np.ones((4, 6), dtype=np.bool_)
    if missing:
        present[1, 2:4] = False
        present[3, 0] = False
    values = np.where(present, rng.normal(size=(4, 6)), 0.0)
    blocks = np.broadcast_to(block, (4, 6, 6))
    return DayGaussian(blocks, rng.normal(size=(4, 6, 3)), present), values


@pytest.mark.parametrize("missing", [False, True])
def test_the_density_is_that_of_the_dense_distribution(missing: bool) -> None:
    gaussian, values = example(missing)
    whole, there = dense(gaussian), gaussian.present.ravel()
    expected = stats.multivariate_normal(np.zeros(len(whole)), whole).logpdf(values.ravel()[there])
    assert gaussian.log_density(values) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("missing", [False, True])
def test_a_day_left_out_has_its_conditional_density(missing: bool) -> None:
    gaussian, values = example(missing)
    whole, there = dense(gaussian), gaussian.present.ravel()
    day = np.repeat(np.arange(4), 6)[there]
    y = values.ravel()[there]
    for d, found in enumerate(gaussian.left_out(values)):
        out, rest = day == d, day != d
        gain = whole[np.ix_(out, rest)] @ np.linalg.inv(whole[np.ix_(rest, rest)])
        covariance = whole[np.ix_(out, out)] - gain @ whole[np.ix_(rest, out)]
        expected = stats.multivariate_normal(gain @ y[rest], covariance).logpdf(y[out])
        assert found == pytest.approx(expected, rel=1e-9)


def test_the_coefficients_are_those_of_ridge_regression() -> None:
    gaussian, values = example(missing=False)
    columns = gaussian.columns.reshape(24, 3)
    noise = np.linalg.inv(np.kron(np.eye(4), gaussian.blocks[0]))
    precision = np.eye(3) + columns.T @ noise @ columns
    expected = np.linalg.solve(precision, columns.T @ noise @ values.ravel())
    np.testing.assert_allclose(gaussian.coefficients(values), expected, rtol=1e-9)
    np.testing.assert_allclose(gaussian.covariance, np.linalg.inv(precision), rtol=1e-8)


def test_slots_are_averaged_over_what_is_there() -> None:
    hours = np.arange(0.0, 48.0, 0.25)
    grid = DayGrid.of(hours, interval=0.25, sensors=1)
    assert (grid.days, grid.slots, grid.slot_hours) == (2, 24, 1.0)
    values = hours[:, None].copy()
    mask = np.ones((192, 1), dtype=np.bool_)
    mask[0] = mask[4:8] = False
    mean, count = grid.means(values, mask)
    assert mean[0, 0] == pytest.approx(0.5)  # of 0.25, 0.5, 0.75
    assert (mean[0, 1], count[0, 1], count[0, 2]) == (0.0, 0, 4)
    assert grid.within(np.tile([[0.0], [2.0]], (96, 1)), np.ones((192, 1), dtype=np.bool_)) == pytest.approx(
        1.0
    )


def test_with_many_sensors_the_slots_are_longer() -> None:
    hours = np.arange(0.0, 120.0, 0.25)
    assert DayGrid.of(hours, interval=0.25, sensors=6).slots == 24
    assert DayGrid.of(hours, interval=0.25, sensors=20).slots == 6


def data_of(error: Floats, slots: int, sensors: int = 1) -> DayData:
    """Errors (D, slots * sensors) of complete days without parameters and sensors."""
    days = len(error)
    grid = DayGrid(np.zeros(0, int), np.zeros(0, int), days, slots, 24.0 / slots)
    basis = np.repeat(hour_basis(np.arange(slots) * 24.0 / slots + 12.0 / slots), sensors, axis=0)
    return DayData(
        grid,
        error,
        np.zeros((days, slots * sensors, 0)),
        np.broadcast_to(basis, (days, *basis.shape)),
        np.ones(error.shape, dtype=np.bool_),
        np.zeros(sensors),
    )


def test_the_effect_of_a_day_has_the_size_of_a_balanced_analysis_of_variance() -> None:
    """Random effect of a day plus white noise: the restricted likelihood has a closed form (ANOVA)."""
    rng = np.random.default_rng(1)
    days, slots, sd_day, sd_noise = 400, 8, 0.3, 0.2
    error = sd_day * rng.normal(size=(days, 1)) + sd_noise * rng.normal(size=(days, slots))
    between = slots * error.mean(axis=1).var(ddof=1)
    inside = float(np.sum((error - error.mean(axis=1, keepdims=True)) ** 2) / (days * (slots - 1)))
    found = estimate_discrepancy(data_of(error, slots), scale=np.array([0.02]), limit=np.array([10.0]))
    # A part of the error that is correlated within a day counts to both, by the mean of its correlations.
    kernel = drift_kernel(DayGrid(np.zeros(0, int), np.zeros(0, int), 1, 8, 3.0), found.correlation_hours)
    alike = (kernel.sum() - slots) / (slots * (slots - 1))
    assert found.day[0, 0] + alike * found.drift[0, 0] == pytest.approx((between - inside) / slots, rel=0.05)
    assert found.white[0] + (1.0 - alike) * found.drift[0, 0] == pytest.approx(inside, rel=0.03)


def test_the_estimate_has_a_larger_density_than_sizes_beside_it() -> None:
    rng = np.random.default_rng(4)
    days, slots = 30, 12
    data = data_of(np.zeros((days, 2 * slots)), slots, sensors=2)
    true = Discrepancy(
        0.04 * np.eye(2), 0.02 * np.eye(2), np.array([[0.09, 0.05], [0.05, 0.06]]),
        np.array([0.01, 0.02]), np.zeros(2), 4.0,
    )  # fmt: skip
    whole = dense(data.gaussian(true))
    values = (np.linalg.cholesky(whole) @ rng.normal(size=len(whole))).reshape(days, -1)
    data = data_of(values, slots, sensors=2)
    found = estimate_discrepancy(data, scale=np.full(2, 0.01), limit=np.full(2, 10.0))
    best = data.gaussian(found).log_density(values)
    assert best >= data.gaussian(true).log_density(values) - 0.5
    assert np.sqrt(np.diag(found.drift)) == pytest.approx([0.3, 0.245], rel=0.35)
    assert found.correlation_hours == 4.0


def test_a_limit_is_never_exceeded() -> None:
    error = 5.0 * np.random.default_rng(2).normal(size=(10, 1)) * np.ones((10, 8))
    found = estimate_discrepancy(data_of(error, 8), scale=np.array([0.1]), limit=np.array([0.5]))
    for part in (found.day, found.drift, found.hour):
        assert np.sqrt(part[0, 0]) <= 0.5 + 1e-12


def test_days_in_a_row_have_most_of_their_error_in_common() -> None:
    lag = np.abs(np.subtract.outer(np.arange(5), np.arange(5)))
    correlation = np.exp(-lag / 5.0)
    # The mean variance of days about their mean, for a variance of 1.
    inside = np.trace(correlation - correlation.mean(axis=0)[None, :]) / 4.0
    assert 1.0 / (1.0 + alike_days(5, 5.0)) == pytest.approx(inside, rel=1e-12)
    assert alike_days(1, 5.0) == 0.0


def test_the_kernel_of_a_day_decays_with_its_correlation_time() -> None:
    grid = DayGrid(np.zeros(0, int), np.zeros(0, int), 1, 12, 2.0)
    assert drift_kernel(grid, 4.0)[0, 3] == pytest.approx(np.exp(-1.5))


def test_errors_of_a_sensor_have_their_exact_derivatives() -> None:
    series = np.array([[20.0, 5.0], [22.0, 5.0], [24.0, 5.0]])
    stated = [SensorError(offset=0.2, gain=0.01, reference=20.0, clock=60.0), SensorError(common=0.1)]
    columns, names = error_columns(["a", "b"], stated, series, 600.0)
    assert names == ("a offset", "a gain", "a clock", "common offset")
    np.testing.assert_allclose(columns[:, 0, 0], 0.2)
    np.testing.assert_allclose(columns[:, 0, 1], [0.0, 0.02, 0.04])
    np.testing.assert_allclose(columns[:, 0, 2], -60.0 * 2.0 / 600.0)
    np.testing.assert_allclose(columns[:, 1], [[0.0, 0.0, 0.0, 0.1]] * 3)


def linear_problem(measured: Floats, slope: Floats, prior: float | None = None) -> CalibrationProblem:
    """One parameter between -5 and 5 whose effect on one sensor is a straight multiple of a series."""
    return CalibrationProblem(
        (FitParameter("p", -5.0, 5.0, nominal=0.0, prior=None if prior is None else (0.0, prior)),),
        (FitSensor("s", measured, 0.1),),
        lambda x: 20.0 + slope[None, :, None] * x[:, :, None],
        step=3600.0,
    )


def test_an_offset_is_estimated_with_the_parameter_as_in_closed_form() -> None:
    """Known sizes of white errors: the posterior of a parameter and an offset is that of two regressors."""
    hours = np.arange(96.0)
    slope = 0.5 + np.sin(hours / 5.0)
    rng = np.random.default_rng(5)
    measured = 20.0 + 0.4 * slope + 0.15 + 0.2 * rng.normal(size=96)
    problem = linear_problem(measured, slope, prior=1.0)
    sizes = Discrepancy(
        1e-12 * np.eye(1), 1e-12 * np.eye(1), 1e-12 * np.eye(1), np.array([0.04]), np.zeros(1), 4.0
    )
    stated = ErrorStatement((SensorError(offset=0.3),), hours, 3600.0, np.array([1.0]), 0.0)
    linear = Linear(
        np.array([0.5]), np.full((96, 1), 20.0), (10.0 * slope)[:, None, None], np.zeros((96, 1, 0))
    )
    found = joint_posterior(problem, linear, stated, sizes)
    x = np.column_stack([slope, np.ones(96)])
    precision = x.T @ x / 0.04 + np.diag([1.0, 1.0 / 0.09])
    expected = np.linalg.solve(precision, x.T @ (measured - 20.0) / 0.04)
    covariance = np.linalg.inv(precision)
    assert 10.0 * (found.z[0] - 0.5) == pytest.approx(expected[0], abs=1e-6)
    assert 0.3 * found.mean[1] == pytest.approx(expected[1], abs=2e-3)
    assert 10.0 * np.sqrt(found.covariance[0, 0]) == pytest.approx(np.sqrt(covariance[0, 0]), rel=0.02)
    assert 0.3 * np.sqrt(found.covariance[1, 1]) == pytest.approx(np.sqrt(covariance[1, 1]), rel=0.02)


def test_a_stated_offset_no_longer_moves_the_parameter() -> None:
    """A response that never changes its sign takes an offset for a change of the parameter."""
    hours = np.arange(120.0)
    slope = 1.0 + np.sin(2.0 * np.pi * hours / 24.0)
    measured = 20.0 + slope + 0.3 + 0.02 * np.random.default_rng(6).normal(size=120)
    problem = linear_problem(measured, slope)
    plain = solve(problem, options=SearchOptions(starts=1))
    assert plain.x[0] > 1.15
    stated = ErrorStatement((SensorError(offset=0.3),), hours, 3600.0, np.array([1.0]))
    found, errors = estimate_jointly(plain, stated, SearchOptions())
    assert found.x[0] == pytest.approx(1.0, abs=0.03)
    assert found.low[0] < 1.0 < found.high[0]
    assert 0.3 * errors.mean[1] == pytest.approx(0.3, abs=0.06)


def test_an_estimate_on_the_end_of_its_range_says_how_far_it_wants_to_go() -> None:
    """Known white errors: the deviance beyond the end is that of a normal distribution."""
    hours = np.arange(96.0)
    slope = 0.5 + np.sin(hours / 5.0)
    measured = 20.0 + 5.1 * slope + 0.2 * np.random.default_rng(5).normal(size=96)
    problem = linear_problem(measured, slope)  # up to 5
    sizes = Discrepancy(
        1e-12 * np.eye(1), 1e-12 * np.eye(1), 1e-12 * np.eye(1), np.array([0.04]), np.zeros(1), 4.0
    )
    stated = ErrorStatement((SensorError(),), hours, 3600.0, np.array([1.0]), 0.0)
    linear = Linear(
        np.array([0.5]), np.full((96, 1), 20.0), (10.0 * slope)[:, None, None], np.zeros((96, 1, 0))
    )
    found = joint_posterior(problem, linear, stated, sizes)
    # The range is a prior as well: uniform, with the variance 10^2 / 12.
    precision = slope @ slope / 0.04 + 12.0 / 100.0
    best = slope @ (measured - 20.0) / 0.04 / precision
    assert found.z == [1.0]
    assert found.beyond[0] == pytest.approx(precision * (best - 5.0) ** 2, rel=1e-3)
    assert best > 5.0
    inside = joint_posterior(linear_problem(measured - slope, slope), linear, stated, sizes)
    assert inside.beyond == [0.0]


@pytest.mark.parametrize(
    ("truth", "said"),
    [(5.5, "lies beyond, at more"), (5.008, "within the uncertainty, the data fit best at this end")],
)
def test_the_interval_contains_an_estimate_on_the_end_of_its_range(truth: float, said: str) -> None:
    hours = np.arange(120.0)
    slope = np.sin(2.0 * np.pi * hours / 24.0)
    measured = 20.0 + truth * slope + 0.05 * np.random.default_rng(6).normal(size=120)
    stated = ErrorStatement((SensorError(),), hours, 3600.0, np.array([0.05]))
    found, _ = estimate_jointly(
        solve(linear_problem(measured, slope), options=SearchOptions(starts=1)), stated, SearchOptions()
    )
    assert found.x[0] == found.high[0] == 5.0
    assert 4.8 < found.low[0] < 5.0
    assert said in found.on_bound["p"]


def test_a_normal_distribution_within_bounds_has_the_moments_of_the_truncated_one() -> None:
    sample = within_bounds(np.array([0.3]), np.array([[0.25]]), np.zeros(1), np.ones(1))
    expected = stats.truncnorm((0.0 - 0.3) / 0.5, (1.0 - 0.3) / 0.5, 0.3, 0.5)
    assert sample.mean() == pytest.approx(expected.mean(), abs=0.015)
    assert sample.std() == pytest.approx(expected.std(), rel=0.05)
    assert np.all((sample >= 0.0) & (sample <= 1.0))


def test_without_active_bounds_the_sample_is_that_of_the_normal_distribution() -> None:
    covariance = np.array([[1.0, 0.8], [0.8, 2.0]])
    sample = within_bounds(np.array([1.0, -1.0]), covariance, np.full(2, -50.0), np.full(2, 50.0))
    np.testing.assert_allclose(sample.mean(axis=0), [1.0, -1.0], atol=0.12)
    np.testing.assert_allclose(np.cov(sample, rowvar=False), covariance, rtol=0.12)


def test_forms_of_equal_density_have_equal_weights() -> None:
    np.testing.assert_allclose(pseudo_bma_weights(np.full((3, 5), -100.0)), 1.0 / 3.0)


def test_with_one_day_the_weights_are_those_of_bayesian_model_averaging() -> None:
    """The bootstrap has nothing to vary: weights are in proportion to the densities."""
    np.testing.assert_allclose(pseudo_bma_weights(np.log([[0.6], [0.3], [0.1]])), [0.6, 0.3, 0.1], rtol=1e-12)


def test_days_that_disagree_leave_the_choice_open() -> None:
    clear = pseudo_bma_weights(np.array([[10.0, 10.0, 10.0], [0.0, 0.0, 0.0]]))
    open_ = pseudo_bma_weights(np.array([[10.0, 0.0, 10.5], [0.0, 10.0, 0.0]]))
    assert clear[0] > 0.999
    assert 0.5 < open_[0] < 0.95


def _used(by_day: list[list[float]], free: list[int]) -> int:
    densities = np.array(by_day)
    return used_form(densities, pseudo_bma_weights(densities), [(count,) for count in free])


def test_a_simpler_form_is_used_only_if_it_predicts_every_day_as_well() -> None:
    assert _used([[0.0, 0.0, 0.0], [0.4, 0.4, 0.4]], [4, 5]) == 0
    assert _used([[0.0, 0.0, 0.0], [0.4, 0.4, 0.4]], [5, 4]) == 1
    # The sum is the same, but one day differs: it is not said by the days that they are alike.
    assert _used([[0.0, 0.0, 0.0], [0.0, 0.0, 1.2]], [4, 5]) == 1


def test_one_outlying_day_does_not_save_a_form_that_is_far_behind() -> None:
    """Five days, 20 log units a day behind but for one: two standard errors of the sum are 90 there."""
    worse = [-20.0, -22.0, -19.0, -21.0, 0.0]
    assert _used([worse, [0.0] * 5], [4, 8]) == 1
    assert _used([[-20.0] * 5, [0.0] * 5], [4, 8]) == 1
    assert _used([[-50.0, 10.0, -1.0, -1.0, -1.0], [0.0] * 5], [4, 8]) == 1


@pytest.mark.parametrize("seed", range(8))
def test_the_form_used_is_never_far_behind_the_best(seed: int) -> None:
    """Drawn densities with heavy tails: within 3 over all days, and with a twentieth of the best weight."""
    rng = np.random.default_rng(seed)
    for _ in range(25):
        forms, days = int(rng.integers(2, 13)), int(rng.integers(1, 21))
        by_day = 2.0 * rng.standard_t(1.5, size=(forms, days))
        weights = pseudo_bma_weights(by_day)
        free = [(int(count),) for count in rng.integers(3, 9, forms)]
        used, total = used_form(by_day, weights, free), by_day.sum(axis=1)
        assert total[used] >= total.max() - 3.0
        assert weights[used] >= 0.05 * weights.max()
        counted = (total >= total.max() - 3.0) & (weights >= 0.05 * weights[total.argmax()])
        heaviest = int(np.flatnonzero(counted)[weights[counted].argmax()])
        if used != heaviest:  # for its simplicity, and only where every day is predicted as well
            assert free[used] <= free[heaviest]
            assert np.abs(by_day[heaviest] - by_day[used]).max() <= 0.5


def test_quantiles_of_a_mixture_are_those_of_its_distribution() -> None:
    first, second = np.linspace(0.0, 1.0, 10001), np.linspace(2.0, 3.0, 101)
    found = weighted_quantiles([first, second], np.array([0.75, 0.25]), np.array([0.25, 0.5, 0.875]))
    np.testing.assert_allclose(found, [1.0 / 3.0, 2.0 / 3.0, 2.5], atol=0.02)


def test_a_prior_wider_than_its_range_is_refused() -> None:
    with pytest.raises(
        InputError, match=r"range \[0, 1\].* narrower than the standard deviation of its prior, 2"
    ):
        FitParameter("p", 0.0, 1.0, prior=(0.5, 2.0))


def test_sensors_that_err_alike_do_not_stop_the_sampling() -> None:
    """Six sensors with one error of 5 K, as five days show it."""
    rng = np.random.default_rng(8)
    days, slots, sensors = 5, 24, 6
    shape = np.sin(np.arange(slots) * np.pi / 12.0)
    error = 5.0 * rng.normal(size=(days, 1, 1)) + 3.0 * shape[None, :, None] * np.ones(sensors)
    data = data_of(error.reshape(days, -1), slots, sensors=sensors)
    small = 1e-4 * np.eye(sensors)
    first = Discrepancy(small, small, small, np.full(sensors, 1e-4), np.zeros(sensors), 4.0, 2.0)
    limit = np.full(sensors, 6.0)
    drawn = sample_covariances([data], [first], [SizeLimits(np.full(sensors, 0.05), limit)])
    typical = drawn.typical[0]
    for part in (typical.hour, typical.day, typical.drift):
        correlation = part / np.sqrt(np.outer(np.diag(part), np.diag(part)))
        assert np.linalg.eigvalsh(correlation)[0] > 0.9e-6
        assert np.all(np.sqrt(np.diag(part)) <= 6.0 * (1.0 + 1e-6))
    assert np.all(np.isfinite(drawn.mean))


def test_days_left_out_narrow_bands_near_the_identification_alone() -> None:
    """A band of twice what left-out days need: narrowed in the identification, as assumed far away."""
    ratio = np.zeros((400, 1, 2))
    ratio[:, 0, 0], ratio[:, 0, 1] = 0.7, 1.3  # the quantile of 95 % of a constant is that constant
    joint = object.__new__(JointPosterior)
    object.__setattr__(joint, "left_out", ratio * stats.norm.ppf(0.975))
    object.__setattr__(joint, "left_out_sd", np.ones_like(ratio))
    hours = 24.0 * np.array([10.0, 11.0, 12.0, 17.0, 100.0])
    near = nearness(hours, np.array([False, True, True, False, False]), 5.0)
    assert near == pytest.approx([np.exp(-0.2), 1.0, 1.0, np.exp(-1.0), 0.0], abs=1e-7)
    factor = joint.days_left_out(0.95, near)
    assert factor[:, 0] == pytest.approx(1.0 - 0.3 * near)
    assert factor[:, 1] == pytest.approx(np.full(5, 1.3))
    assert joint.days_left_out(0.95) == pytest.approx([1.0, 1.3])
