"""Problems of several experiments as one, and their errors: compared with the whole covariance."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import linalg, stats

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions, solve
from mascarin.calibration.base.joined_problem import joined, of_experiment, shares_of
from mascarin.calibration.errors.day_blocks import DayGaussian, Experiments
from mascarin.calibration.errors.discrepancy import Discrepancy
from mascarin.calibration.errors.joint_estimation import estimate_experiments, estimate_jointly
from mascarin.calibration.errors.linear_estimation import ErrorStatement, Linear, objective
from mascarin.calibration.errors.sensor_errors import SensorError
from mascarin.errors import InputError

Floats = NDArray[np.float64]
HOURS = np.arange(0.0, 5 * 24.0)
LEVELS = (1.0, -1.0)
TRUTH = (4.0, 2.0)


def room(sign: float, seed: int, sensors: int = 1) -> CalibrationProblem:
    """Heat of walls and of air, whose sum or difference a room shows."""
    wave = 1.0 + 0.2 * np.sin(HOURS * np.pi / 12.0)

    def model(x: Floats) -> Floats:
        series = (x[:, :1] + sign * x[:, 1:]) * wave[None, :]
        return np.repeat(series[:, :, None], sensors, axis=2)

    noise = np.random.default_rng(seed).normal(0.0, 0.1, (HOURS.size, sensors))
    measured = model(np.array([TRUTH]))[0] + noise
    return CalibrationProblem(
        (FitParameter("walls", 0.0, 10.0, nominal=5.0), FitParameter("air", 0.0, 10.0, prior=(3.0, 4.0))),
        tuple(FitSensor(f"air {s}", measured[:, s], 0.2) for s in range(sensors)),
        model,
        step=3600.0,
    )


def statement(sensors: int = 1) -> ErrorStatement:
    return ErrorStatement((SensorError(offset=0.1),) * sensors, HOURS, 3600.0, np.full(sensors, 0.5))


def statements(problem: CalibrationProblem) -> list[ErrorStatement]:
    return [
        ErrorStatement(
            (SensorError(offset=0.1),) * len(share.problem.sensors),
            HOURS,
            3600.0,
            np.full(len(share.problem.sensors), 0.5),
            rows=share.rows,
            columns=share.sensors,
            names=tuple(sensor.name for sensor in share.problem.sensors),
        )
        for share in shares_of(problem)
    ]


def test_the_density_is_that_of_the_whole_covariance() -> None:
    """Blocks of days of two experiments of other sizes, with shared columns, against one dense matrix."""
    rng = np.random.default_rng(2)
    parts, values = [], []
    for days, size in ((3, 4), (2, 6)):
        root = rng.normal(size=(size, size))
        block = root @ root.T + np.eye(size)
        present = rng.random((days, size)) > 0.2
        parts.append(
            DayGaussian(np.broadcast_to(block, (days, size, size)), rng.normal(size=(days, size, 3)), present)
        )
        values.append(np.where(present, rng.normal(size=(days, size)), 0.0))
    together = Experiments(parts)
    rows = np.concatenate([part.present.ravel() for part in parts])
    dense = linalg.block_diag(*(block for part in parts for block in part.blocks))
    columns = np.concatenate([part.columns.reshape(-1, 3) for part in parts])
    dense = (dense + columns @ columns.T)[np.ix_(rows, rows)]
    flat = np.concatenate([each.ravel() for each in values])[rows]
    expected = stats.multivariate_normal(np.zeros(len(dense)), dense).logpdf(flat)
    assert together.log_density(values) == pytest.approx(expected, rel=1e-10)
    solved = np.concatenate([each.ravel() for each in together.solve(values)])[rows]
    np.testing.assert_allclose(solved, np.linalg.solve(dense, flat), rtol=1e-9, atol=1e-12)
    inverse = np.linalg.inv(dense)
    last = slice(int(sum(part.present.sum() for part in parts) - parts[1].present[1].sum()), None)
    present = parts[1].present[1]
    block = together.parts[1].inverse_blocks[1][np.ix_(present, present)]
    np.testing.assert_allclose(block, inverse[last, last], rtol=1e-8, atol=1e-12)
    left_out = together.parts[1].left_out(values[1], together.beside(values)[1])
    first = slice(0, last.start)
    gain = np.linalg.solve(dense[first, first], dense[first, last]).T
    conditional = stats.multivariate_normal(gain @ flat[first], dense[last, last] - gain @ dense[first, last])
    assert left_out[1] == pytest.approx(conditional.logpdf(flat[last]), rel=1e-9)


def test_one_experiment_is_the_problem_itself() -> None:
    problem = room(1.0, 1)
    assert joined({"only": problem}) is problem
    fit = solve(problem)
    assert of_experiment(fit, shares_of(problem)[0], None) is fit


def test_two_rooms_tell_both_numbers() -> None:
    rooms = {"sum": room(1.0, 1), "difference": room(-1.0, 2, sensors=2)}
    both = joined(rooms)
    assert both.measured.shape == (2 * HOURS.size, 3)
    fit, joints = estimate_experiments(solve(both), statements(both), SearchOptions())
    np.testing.assert_allclose(fit.x, TRUTH, atol=0.2)
    assert np.all((fit.low < TRUTH) & (fit.high > TRUTH))
    for name, problem in rooms.items():
        sensors = len(problem.sensors)
        alone, _ = estimate_jointly(solve(problem), statement(sensors), SearchOptions())
        assert np.all(fit.high - fit.low < 0.3 * (alone.high - alone.low)), name
    assert [joint.names for joint in joints] == [("air 0 offset",), ("air 0 offset", "air 1 offset")]
    assert [joint.whitened.shape[2] for joint in joints] == [1, 2]
    view = of_experiment(fit, shares_of(both)[1], None)
    assert view.problem is rooms["difference"]
    np.testing.assert_array_equal(view.residuals, fit.residuals[HOURS.size :, 1:])


def test_the_log_density_is_the_sum_without_the_prior_once_more() -> None:
    rooms = {"sum": room(1.0, 1), "difference": room(-1.0, 2)}
    both = joined(rooms)
    z = np.array([0.35, 0.25])

    def linear(problem: CalibrationProblem) -> Linear:
        simulated = np.asarray(problem.model(problem.values(z[None])))[0]
        return Linear(z, simulated, np.zeros((*simulated.shape, 2)), np.zeros((*simulated.shape, 0)))

    one = np.eye(1)
    size = Discrepancy(0.01 * one, 0.01 * one, 0.02 * one, np.array([0.01]), np.array([0.0]), 4.0)
    each = [objective(problem, linear(problem), [statement()], [size]) for problem in rooms.values()]
    # Minus the log of the priors: uniform over the range, and the stated one.
    prior = 0.5 * ((z[0] - 0.5) ** 2 * 12.0 + ((z[1] - 0.3) / 0.4) ** 2)
    total = objective(both, linear(both), statements(both), [size, size])
    assert total == pytest.approx(sum(each) - prior, rel=1e-10)


def test_a_number_of_every_experiment_has_its_name() -> None:
    both = joined({"sum": room(1.0, 1), "difference": room(-1.0, 2)}, own_paths=["air"])
    assert both.paths == ("walls", "air (sum)", "air (difference)")
    slope = shares_of(both)[1].columns
    assert slope == (0, 2)
    fit = solve(both)
    view = of_experiment(fit, shares_of(both)[1], None)
    assert view.problem.paths == ("walls", "air")
    np.testing.assert_array_equal(view.x, fit.x[[0, 2]])


def test_shared_numbers_that_differ_are_refused() -> None:
    other = room(-1.0, 2)
    walls = FitParameter("walls", 0.0, 10.0, nominal=6.0)
    changed = CalibrationProblem((walls, other.parameters[1]), other.sensors, other.model)
    with pytest.raises(InputError, match=r"walls: found the value 5 in 'a' and 6 in 'b', expected the same"):
        joined({"a": room(1.0, 1), "b": changed})
