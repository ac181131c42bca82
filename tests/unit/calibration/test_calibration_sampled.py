"""A sampled posterior: a linear model in closed form, a model that is not linear, bounds, and its file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions
from mascarin.calibration.errors.day_blocks import DayGrid
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy, hour_basis
from mascarin.calibration.errors.joint_posterior import joint_posterior
from mascarin.calibration.errors.linear_estimation import ErrorStatement, Linear
from mascarin.calibration.errors.sampled_posterior import ChainLengths
from mascarin.calibration.errors.sensor_errors import SensorError
from mascarin.calibration.sampling.convergence import bulk_size, r_hat, tail_size
from mascarin.calibration.sampling.nuts import StepSize, moved
from mascarin.calibration.sampling.posterior_sample import PosteriorSample
from mascarin.errors import InputError

Floats = NDArray[np.float64]
HOURS = np.arange(72.0)
#: Two parameters that are hard to tell apart, in positions.
COLUMNS = np.stack([np.sin(HOURS / 5.0), np.sin(HOURS / 5.0) + 0.3 * np.cos(HOURS / 9.0)], axis=-1)[:, None]
LENGTHS = ChainLengths(chains=4, draws=600, warmup=200, seed=3)


def sizes() -> Discrepancy:
    """Known errors of the model."""
    eye = np.eye(1)
    return Discrepancy(0.01 * eye, 0.02 * eye, 0.01 * eye, np.array([0.02]), np.zeros(1), 4.0)


def problem_of(measured: Floats, prior: float | None, upper: float = 1.0) -> CalibrationProblem:
    parameters = tuple(
        FitParameter(name, 0.0, upper, nominal=0.5, prior=None if prior is None else (0.5, prior))
        for name in ("first", "second")
    )
    return CalibrationProblem(
        parameters,
        (FitSensor("room", measured, 0.2),),
        lambda x: np.einsum("tsp,mp->mts", COLUMNS, x),
    )


def sampled(problem: CalibrationProblem, offset: float) -> tuple[Floats, Floats, PosteriorSample]:
    """Positions of the linear and of the sampled posterior."""
    z = np.full(2, 0.5)

    def simulate(points: Floats) -> Floats:
        return np.asarray(np.einsum("tsp,mp->mts", COLUMNS, points))

    linear = Linear(z, simulate(z[None])[0], COLUMNS, np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=offset),), HOURS, 3600.0, np.array([5.0]))
    plain = joint_posterior(problem, linear, stated, sizes())
    found = joint_posterior(problem, linear, stated, sizes(), simulate=simulate, lengths=LENGTHS)
    assert found.chains is not None
    return plain.sample, found.sample, found.chains


def test_of_a_linear_model_it_is_the_closed_form() -> None:
    rng = np.random.default_rng(1)
    measured = COLUMNS[:, 0] @ np.array([0.45, 0.55]) + 0.2 * rng.standard_normal(72)
    # Priors narrow enough that no end matters: the posterior is normal.
    problem = problem_of(measured, 0.1)
    plain, drawn, chains = sampled(problem, 0.05)
    assert chains.accepted > 0.999
    reduction, bulk, _ = chains.convergence.T
    assert reduction.max() < 1.01
    spread = plain.std(axis=0)
    # Both are samples: their means differ by the errors of both, of which three are allowed.
    error = spread * np.sqrt(1.0 / bulk[:2] + 1.0 / 4000.0)
    assert np.all(np.abs(drawn.mean(axis=0) - plain.mean(axis=0)) < 4.0 * error)
    assert drawn.std(axis=0) / spread == pytest.approx([1.0, 1.0], abs=0.1)
    correlation, expected = (np.atleast_2d(np.corrcoef(one, rowvar=False))[0, 1] for one in (drawn, plain))
    assert correlation == pytest.approx(expected, abs=0.05)


def drawn_for(
    measured: Floats,
    simulate: Callable[[Floats], Floats],
    jacobian: Floats,
    z: Floats,
    lengths: ChainLengths = LENGTHS,
) -> PosteriorSample:
    """Chains of two parameters with uniform priors and a sensor without an offset."""
    names = ("first", "second")
    problem = CalibrationProblem(
        tuple(FitParameter(name, 0.0, 1.0) for name in names), (FitSensor("room", measured, 0.2),), simulate
    )
    linear = Linear(z, simulate(z[None])[0], jacobian, np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=0.0),), HOURS, 3600.0, np.array([5.0]))
    found = joint_posterior(problem, linear, stated, sizes(), simulate=simulate, lengths=lengths)
    assert found.chains is not None
    return found.chains


def level_density(measured: Floats) -> Callable[[Floats], Floats]:
    """Log density of the data by the level of a constant series, up to a constant."""
    grid = DayGrid.of(HOURS, interval=1.0, sensors=1)
    mask = np.ones((72, 1), dtype=np.bool_)
    basis = grid.means(hour_basis(HOURS)[:, None, :], mask)[0]
    error, _ = grid.means(measured[:, None], mask)
    present = np.ones(error.shape, dtype=np.bool_)
    data = DayData(grid, error, np.zeros((3, 24, 0)), basis, present, np.zeros(1))
    weight = data.gaussian(sizes()).solve(np.ones(error.shape))
    precision, pull = float(weight.sum()), float(np.sum(weight * error))
    return lambda level: np.asarray(pull * level - 0.5 * precision * level**2)


def quantiles_of(log_density: Floats, points: Floats) -> Floats:
    """Quantiles of 2.5, 25, 50, 75 and 97.5 % of a density at the middles of equal intervals."""
    weight = np.exp(log_density - log_density.max())
    share = (np.cumsum(weight) - 0.5 * weight) / weight.sum()
    return np.asarray(np.interp(LEVELS, share, points))


LEVELS = np.array([0.025, 0.25, 0.5, 0.75, 0.975])
LONG = ChainLengths(chains=8, draws=400, warmup=200, seed=5)
#: Along a curved ridge chains move slowly.
LONGEST = ChainLengths(chains=8, draws=1000, warmup=200, seed=5)


def assert_drawn(chains: PosteriorSample, number: int, expected: Floats) -> None:
    """The chains have converged; their parts below quantiles are right within their error."""
    reduction, bulk, tail = chains.convergence[number]
    assert reduction < 1.01
    assert min(bulk, tail) > 400.0
    parts = np.mean(chains.draws[:, :, number][..., None] < expected, axis=(0, 1))
    assert np.all(np.abs(parts - LEVELS) < 4.0 * np.sqrt(LEVELS * (1.0 - LEVELS) / min(bulk, tail)))


def curved(points: Floats) -> Floats:
    """A level that tells a curve of the two parameters alone: a banana."""
    level = points[:, 1] + 1.5 * (points[:, 0] - 0.5) ** 2
    return np.broadcast_to(level[:, None, None], (len(points), 72, 1))


def kinked(points: Floats) -> Floats:
    """A level with a kink, which no polynomial has."""
    level = 0.8 * np.abs(points[:, 0] - 0.5) + 0.0 * points[:, 1]
    return np.broadcast_to(level[:, None, None], (len(points), 72, 1))


@pytest.mark.parametrize(
    ("simulate", "slope", "z"),
    [(curved, (0.0, 1.0), (0.5, 0.6)), (kinked, (0.8, 0.0), (0.6, 0.5))],
    ids=["banana", "kink"],
)
def test_of_a_model_that_is_not_linear_it_is_that_of_the_model(
    simulate: Callable[[Floats], Floats], slope: tuple[float, float], z: tuple[float, float]
) -> None:
    """The linear model is about one point; the density by quadrature is that of the model itself."""
    measured = simulate(np.array([z]))[0, :, 0] + 0.02 * np.random.default_rng(2).standard_normal(72)
    jacobian = np.broadcast_to(np.array(slope), (72, 1, 2))
    chains = drawn_for(measured, simulate, jacobian, np.array(z), LONGEST)
    middles = np.asarray((np.arange(400.0) + 0.5) / 400.0, dtype=np.float64)
    both = np.stack(np.meshgrid(middles, middles, indexing="ij"), axis=-1).reshape(-1, 2)
    logs = level_density(measured)(simulate(both)[:, 0, 0]).reshape(400, 400)
    for number in range(2):
        marginal = np.asarray(np.log(np.exp(logs - logs.max()).sum(axis=1 - number)))
        assert_drawn(chains, number, quantiles_of(marginal, middles))


@pytest.mark.parametrize("beyond", [-0.5, -0.1, 0.02])
def test_a_truncated_normal_distribution_at_its_end(beyond: float) -> None:
    """The data want a value beyond the end of the range, or one near by: quantiles in closed form."""
    measured = 2.0 * beyond + 0.02 * np.random.default_rng(3).standard_normal(72)

    def simulate(points: Floats) -> Floats:
        return np.broadcast_to(2.0 * points[:, None, :1], (len(points), 72, 1))

    jacobian = np.broadcast_to(np.array([2.0, 0.0]), (72, 1, 2))
    chains = drawn_for(measured, simulate, jacobian, np.array([0.0, 0.5]), LONG)
    assert chains.accepted > 0.999
    log_density = level_density(measured)
    # The log density of the level is a parabola: its mean and variance by three of its values.
    before, at, after = log_density(np.array([-1.0, 0.0, 1.0]))
    variance = 1.0 / (2.0 * at - before - after)
    mean, sd = 0.5 * (after - before) * variance / 2.0, np.sqrt(variance) / 2.0
    exact = stats.truncnorm(-mean / sd, (1.0 - mean) / sd, loc=mean, scale=sd)
    assert_drawn(chains, 0, exact.ppf(LEVELS))
    assert chains.draws[:, :, 0].min() >= 0.0
    assert_drawn(chains, 1, LEVELS)  # of which the data say nothing


@pytest.mark.parametrize("highest", [0.7, -1.0], ids=["in part", "nowhere"])
def test_where_the_model_cannot_be_run_nothing_is_drawn(highest: float) -> None:
    measured = 0.02 * np.random.default_rng(3).standard_normal(72)

    def simulate(points: Floats) -> Floats:
        level = np.where(points[:, 0] < highest, 0.0, np.nan)
        return np.broadcast_to(level[:, None, None], (len(points), 72, 1))

    def linear_model(points: Floats) -> Floats:
        return np.zeros((len(points), 72, 1))

    names = ("first", "second")
    problem = CalibrationProblem(
        tuple(FitParameter(name, 0.0, 1.0) for name in names), (FitSensor("room", measured, 0.2),), simulate
    )
    z = np.full(2, 0.5)
    linear = Linear(z, linear_model(z[None])[0], np.zeros((72, 1, 2)), np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=0.0),), HOURS, 3600.0, np.array([5.0]))
    lengths = ChainLengths(chains=4, draws=300, warmup=100, seed=2)
    chains = joint_posterior(problem, linear, stated, sizes(), simulate=simulate, lengths=lengths).chains
    assert chains is not None
    if highest < 0.0:
        assert chains.accepted == 0.0
        assert any("the model accepts 0 % of the moves" in text for text in chains.warnings)
    else:
        assert chains.draws[:, :, 0].max() < highest
        assert np.quantile(chains.draws[:, :, 0], [0.25, 0.75]) == pytest.approx([0.175, 0.525], abs=0.08)


def test_two_parameters_that_are_hard_to_tell_apart() -> None:
    """A correlation of -0.999 in the middle of the ranges: quantiles of the normal distribution."""
    columns = np.stack([np.ones(72), 1.0 + 0.002 * np.sin(HOURS / 7.0)], axis=-1)[:, None] * 60.0
    measured = columns[:, 0] @ np.array([0.5, 0.5]) + 0.2 * np.random.default_rng(4).standard_normal(72)

    def simulate(points: Floats) -> Floats:
        return np.asarray(np.einsum("tsp,mp->mts", columns, points))

    plain_problem = problem_of(measured, 0.05)
    problem = CalibrationProblem(plain_problem.parameters, plain_problem.sensors, simulate)
    z = np.full(2, 0.5)
    linear = Linear(z, simulate(z[None])[0], columns, np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=0.0),), HOURS, 3600.0, np.array([5.0]))
    plain = joint_posterior(problem, linear, stated, sizes())
    drawn = joint_posterior(problem, linear, stated, sizes(), simulate=simulate, lengths=LONG).chains
    assert drawn is not None
    spread = np.sqrt(np.diag(plain.covariance)[:2])
    correlation = plain.covariance[0, 1] / spread.prod()
    assert correlation < -0.998
    for number in range(2):
        expected = plain.mean[number] + spread[number] * stats.norm.ppf(LEVELS)
        assert_drawn(drawn, number, expected)
    flat = drawn.draws[:, :, :2].reshape(-1, 2)
    drawn_correlation = np.atleast_2d(np.corrcoef(flat, rowvar=False))[0, 1]
    assert drawn_correlation == pytest.approx(correlation, abs=0.003)


def test_a_parameter_without_data_is_uniform_and_one_at_its_end_stays_inside() -> None:
    measured = -0.4 * COLUMNS[:, 0, 0] + 0.05 * np.random.default_rng(6).standard_normal(72)
    problem = CalibrationProblem(
        (FitParameter("first", 0.0, 1.0), FitParameter("second", 0.0, 1.0)),
        (FitSensor("room", measured, 0.2),),
        lambda x: np.einsum("tsp,mp->mts", COLUMNS * np.array([1.0, 0.0]), x),
    )
    z = np.full(2, 0.5)
    jacobian = COLUMNS * np.array([1.0, 0.0])

    def simulate(points: Floats) -> Floats:
        return np.asarray(np.einsum("tsp,mp->mts", jacobian, points))

    linear = Linear(z, simulate(z[None])[0], jacobian, np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=0.0),), HOURS, 3600.0, np.array([5.0]))
    found = joint_posterior(problem, linear, stated, sizes(), simulate=simulate, lengths=LENGTHS)
    assert found.sample.min() >= 0.0
    assert found.sample.max() <= 1.0
    assert np.quantile(found.sample[:, 1], [0.1, 0.5, 0.9]) == pytest.approx([0.1, 0.5, 0.9], abs=0.05)


def test_moves_leave_a_correlated_distribution_as_it_is() -> None:
    covariance = np.array([[1.0, 0.8], [0.8, 1.0]])
    precision = np.linalg.inv(covariance)
    rng, state, step = np.random.default_rng(5), np.zeros(2), StepSize()
    sample = []
    for number in range(3000):
        move = moved(lambda x: (-0.5 * float(x @ precision @ x), -precision @ x), state, step.step, rng)
        state = move.state
        if number < 500:
            step.adapt(move.acceptance)
        else:
            step.settle()
            sample.append(state)
    drawn = np.array(sample)
    assert np.cov(drawn, rowvar=False) == pytest.approx(covariance, abs=0.12)
    assert drawn.mean(axis=0) == pytest.approx([0.0, 0.0], abs=0.1)


def test_autocorrelated_chains_are_worth_what_theory_says() -> None:
    """An autoregressive chain with coefficient r has n (1 - r) / (1 + r) effective draws."""
    rng, r = np.random.default_rng(4), 0.8
    noise = rng.standard_normal((4, 4000))
    chains = np.zeros_like(noise)
    chains[:, 0] = noise[:, 0] / np.sqrt(1.0 - r**2)
    for k in range(1, 4000):
        chains[:, k] = r * chains[:, k - 1] + noise[:, k]
    assert bulk_size(chains) == pytest.approx(16000 * (1.0 - r) / (1.0 + r), rel=0.15)
    assert r_hat(chains) < 1.02
    assert r_hat(chains * np.array([[1.0], [1.0], [1.0], [3.0]])) > 1.05  # alike in the mean alone
    assert tail_size(chains) > 500.0


def test_the_file_is_laid_out_as_inference_data(tmp_path: Path) -> None:
    draws = np.random.default_rng(1).normal(size=(2, 60, 2))
    draws[1] += 5.0
    names = ("materials.brick.conductivity", "room offset")
    sample = PosteriorSample(names, ("W/(m K)", "-"), draws, np.zeros((2, 60)), 0.9, 0)
    assert "has not converged" in sample.warnings[0]
    assert sample.summary()["r_hat"].to_numpy()[1] > 1.5
    file = sample.to_netcdf(tmp_path / "posterior.nc")
    with xr.open_dataset(file, group="posterior", engine="h5netcdf") as posterior:
        assert posterior["room offset"].dims == ("chain", "draw")
        np.testing.assert_array_equal(posterior[names[0]].to_numpy(), draws[:, :, 0])
    with xr.open_dataset(file, group="sample_stats", engine="h5netcdf") as statistics:
        assert statistics["lp"].shape == (2, 60)


def test_another_word_is_refused() -> None:
    with pytest.raises(InputError, match="posterior: found 'exact', expected linearized or sampled"):
        SearchOptions(posterior="exact")  # type: ignore[arg-type]


@pytest.mark.parametrize("model_itself", [False, True])
def test_an_interval_does_not_depend_on_another_estimate_being_at_its_end(model_itself: bool) -> None:
    """Two parameters of which the data tell the sum alone: one is at its end, the other may be anywhere."""
    effect = np.full((72, 1, 2), 2.0)

    def simulate(points: Floats) -> Floats:
        return np.asarray(np.einsum("tsp,mp->mts", effect, points))

    measured = 1.0 + 0.05 * np.random.default_rng(8).standard_normal(72)  # the sum is one half
    problem = CalibrationProblem(
        (FitParameter("first", 0.0, 1.0), FitParameter("second", 0.0, 1.0)),
        (FitSensor("room", measured, 0.2),),
        simulate,
    )
    z = np.array([0.0, 0.5])  # the estimate of the first is at its end
    linear = Linear(z, simulate(z[None])[0], effect, np.zeros((72, 1, 0)))
    stated = ErrorStatement((SensorError(offset=0.0),), HOURS, 3600.0, np.array([5.0]))
    found = joint_posterior(
        problem, linear, stated, sizes(), simulate=simulate if model_itself else None, lengths=LENGTHS
    )
    low, high = np.quantile(found.sample, [0.025, 0.975], axis=0)
    assert high[0] > 0.4
    assert low[1] < 0.1
    assert np.std(found.sample.sum(axis=1)) < 0.5 * np.std(found.sample[:, 1])
