from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.calibration import CalibrationProblem, Cost, FitParameter, FitSensor
from mascarin.errors import InputError

Floats = NDArray[np.float64]


def _problem(**keywords: Any) -> CalibrationProblem:
    parameters = (FitParameter("a", 0.0, 10.0, unit="W/m2K"), FitParameter("b", 0.1, 100.0, scale="log"))
    sensors = (
        FitSensor("room", np.array([20.0, 22.0, np.nan, 24.0]), standard_uncertainty=0.5),
        FitSensor(
            "flux",
            np.array([10.0, 12.0, 14.0, 30.0]),
            1.0,
            use=np.array([1, 1, 1, 0], dtype=bool),
            unit="W/m2",
        ),
    )

    def model(x: Floats) -> Floats:
        base = np.array([[20.0, 10.0], [22.0, 12.0], [math.nan, 14.0], [21.0, math.nan]])
        return np.asarray(x[:, :1, None] + base)

    return CalibrationProblem(parameters, sensors, model, **keywords)


def test_values_and_positions_are_inverse_on_both_scales() -> None:
    problem = _problem()
    x = problem.values(np.array([[0.5, 0.5], [0.0, 1.0], [0.25, 1.0 / 3.0]]))
    np.testing.assert_allclose(x, [[5.0, math.sqrt(10.0)], [0.0, 100.0], [2.5, 1.0]])
    np.testing.assert_allclose(problem.positions(x[2]), [0.25, 1.0 / 3.0])
    # The ends are exact: an estimate on a bound is on the bound.
    assert problem.values(np.array([[1.0, 0.0]])).tolist() == [[10.0, 0.1]]


def test_start_falls_back_on_the_nominal_value_and_the_middle() -> None:
    assert FitParameter("a", 0.0, 1.0).first == 0.5
    assert FitParameter("a", 0.0, 1.0, nominal=0.2).first == 0.2
    assert FitParameter("a", 0.0, 1.0, nominal=3.0).first == 0.5
    assert FitParameter("a", 0.0, 1.0, nominal=0.2, start=0.9).first == 0.9


def test_residuals_leave_out_gaps_and_masked_samples() -> None:
    residuals = _problem().residuals(np.array([[1.0, 1.0], [0.0, 1.0]]))
    np.testing.assert_array_equal(residuals[0], [[1.0, 1.0], [1.0, 1.0], [0.0, 1.0], [-2.0, 0.0]])
    assert residuals.shape == (2, 4, 2)


def test_a_member_that_failed_is_not_a_number_as_a_whole() -> None:
    problem = _problem()
    residuals = problem.residuals(np.array([[math.nan, 1.0], [0.0, 1.0]]))
    assert np.isnan(residuals[0]).all()
    assert np.isfinite(residuals[1]).all()
    cost = Cost(problem, "rmse")
    assert cost.total(np.zeros((2, 2)), cost.of_sensors(residuals))[0] == math.inf


def test_costs_worked_out_by_hand() -> None:
    problem = _problem()
    x = np.array([[1.0, 1.0]])
    residuals = problem.residuals(x)  # room 1, 1, -2; flux 1, 1, 1
    expected = {
        "sd": (math.sqrt(2.0), 0.0),
        "rmse": (math.sqrt(2.0), 1.0),
        "rmse_over_range": (100.0 * math.sqrt(2.0) / 4.0, 100.0 / 4.0),
        "bias_over_range": (0.0, 100.0 / 4.0),
        "nll": (
            0.5 * 6.0 / 0.25 + 3.0 * math.log(0.5 * math.sqrt(2.0 * math.pi)),
            0.5 * 3.0 + 3.0 * math.log(math.sqrt(2.0 * math.pi)),
        ),
    }
    for name, costs in expected.items():
        cost = Cost(problem, name)  # type: ignore[arg-type]
        found = cost.of_sensors(residuals)
        np.testing.assert_allclose(found[0], costs, atol=1e-12)
        assert cost.total(x, found)[0] == pytest.approx(sum(costs))


def test_a_prior_adds_to_the_likelihood() -> None:
    problem = CalibrationProblem(
        (FitParameter("a", 0.0, 10.0, prior=(4.0, 0.5)),),
        (FitSensor("room", np.array([1.0, 2.0])),),
        lambda x: np.tile(x[:, :, None], (1, 2, 1)),
    )
    cost = Cost(problem, "nll")
    of_sensors = cost.of_sensors(problem.residuals(np.array([[5.0]])))
    assert cost.total(np.array([[5.0]]), of_sensors)[0] == pytest.approx(of_sensors.sum() + 0.5 * 2.0**2)
    with pytest.raises(InputError, match="a has a prior"):
        Cost(problem, "rmse")


def test_weights_make_least_squares_stationary_where_the_cost_is() -> None:
    rng = np.random.default_rng(0)
    measured = rng.normal(20.0, 3.0, (50, 2))
    direction = rng.normal(size=(50, 2))
    problem = CalibrationProblem(
        (FitParameter("a", -5.0, 5.0),),
        (
            FitSensor("s", measured[:, 0], 0.3, weight=2.0, unit="W"),
            FitSensor("t", measured[:, 1], 0.7, unit="W"),
        ),
        lambda x: 21.0 + x[:, 0][:, None, None] * direction,
    )
    for name in ("sd", "rmse", "rmse_over_range", "cv_rmse", "nll"):
        cost = Cost(problem, name)
        step = 1e-6
        at = problem.residuals(np.array([[0.4], [0.4 + step], [0.4 - step]]))
        totals = cost.total(np.zeros((3, 1)), cost.of_sensors(at))
        r = at[0] - at[0].mean(axis=0) if cost.ignores_bias else at[0]
        slope = float(np.sum(cost.weights(at[0]) * r * direction))
        factor = 100.0 if name in ("rmse_over_range", "cv_rmse") else 1.0
        assert (totals[1] - totals[2]) / (2.0 * step) == pytest.approx(factor * slope, rel=1e-5)


def test_the_fingerprint_changes_with_the_identity() -> None:
    plain = _problem().fingerprint()
    assert plain == _problem().fingerprint()
    assert plain != _problem(identity="another climate").fingerprint()


@pytest.mark.parametrize(
    ("keywords", "text"),
    [
        ({"lower": 1.0, "upper": 1.0}, "finite lower bound below a finite upper bound"),
        ({"lower": 0.0, "upper": math.inf}, "finite upper bound"),
        (
            {"lower": -1.0, "upper": 1.0, "limits": (0.0, 1.0)},
            r"is not within the possible values, \[0, 1\]",
        ),
        ({"lower": 0.0, "upper": 1.0, "start": 2.0}, "does not contain the start 2"),
        ({"lower": 0.0, "upper": 1.0, "scale": "log"}, "must be positive"),
        ({"lower": 0.0, "upper": 1.0, "prior": (0.5, 0.0)}, "positive standard deviation"),
    ],
)
def test_parameters_that_cannot_be_searched_are_refused(keywords: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        FitParameter("roof.absorptance", **keywords)


@pytest.mark.parametrize(
    ("keywords", "text"),
    [
        ({"measured": np.full(3, np.nan)}, "'mid' has no value"),
        ({"measured": np.ones(3), "use": np.zeros(3, dtype=bool)}, "'mid' has no value"),
        ({"measured": np.full(3, 21.5)}, "21.5 degC in all 3 samples and does not measure"),
        ({"measured": np.arange(3.0), "standard_uncertainty": 0.0}, "uncertainty is zero"),
        (
            {"measured": np.arange(3.0), "standard_uncertainty": 0.0, "relative_standard_uncertainty": 0.05},
            "uncertainty is zero",
        ),
        ({"measured": np.arange(3.0), "weight": 0.0}, "found weight 0, expected a positive number"),
        ({"measured": np.zeros((3, 2))}, "one series"),
        ({"measured": np.arange(3.0), "use": np.ones(2, dtype=bool)}, "3 samples but a mask"),
    ],
)
def test_sensors_that_cannot_be_met_are_refused(keywords: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        FitSensor("mid", **keywords)


def test_problems_that_cannot_be_solved_are_refused() -> None:
    a = FitParameter("a", 0.0, 1.0)
    room = FitSensor("room", np.arange(3.0))

    def build(parameters: tuple[FitParameter, ...], sensors: tuple[FitSensor, ...]) -> CalibrationProblem:
        return CalibrationProblem(parameters, sensors, lambda x: np.zeros((x.shape[0], 2, 1)))

    for parameters, sensors, text in (
        ((), (room,), "at least one parameter"),
        ((a,), (), "at least one sensor"),
        ((a, a), (room,), "parameter 'a' is listed twice"),
        ((a,), (room, room), "sensor 'room' is listed twice"),
        ((a,), (room, FitSensor("gap", np.arange(4.0))), "'room' 3, 'gap' 4"),
        (
            tuple(FitParameter(f"p{k}", 0, 1) for k in range(4)),
            (room,),
            "4 parameters cannot be estimated from 3",
        ),
    ):
        with pytest.raises(InputError, match=text):
            build(parameters, sensors)
    with pytest.raises(InputError, match=r"shape \(1, 2, 1\) for 1 parameter vectors, expected \(1, 3, 1\)"):
        build((a,), (room,)).residuals(np.array([[0.5]]))
    with pytest.raises(InputError, match=r"cost 'rsme' is not known\. Did you mean 'rmse'"):
        Cost(build((a,), (room,)), "rsme")  # type: ignore[arg-type]


def _heat(measured: list[float], unit: str = "W") -> CalibrationProblem:
    return CalibrationProblem(
        (FitParameter("a", -10.0, 10.0),),
        (FitSensor("heat", np.array(measured), 1.0, unit=unit),),
        lambda x: np.tile(x[:, :, None], (1, len(measured), 1)) + np.array(measured)[None, :, None],
    )


def test_costs_of_the_guideline_are_over_the_mean() -> None:
    problem = _heat([300.0, 500.0, 400.0, 800.0])  # mean 500 W; the differences are a everywhere
    residuals = problem.residuals(np.array([[3.0], [-3.0]]))
    # sqrt(4 a^2 / 3) / 500 and 4 |a| / 3 / 500.
    np.testing.assert_allclose(
        Cost(problem, "cv_rmse").of_sensors(residuals), 100.0 * math.sqrt(12.0) / 500.0
    )
    np.testing.assert_allclose(Cost(problem, "nmbe").of_sensors(residuals), 100.0 * 4.0 / 500.0)
    assert Cost(problem, "nmbe").note == ""
    with pytest.raises(InputError, match=r"cost 'nmbe': sensor 'heat': the mean .* is nearly zero"):
        Cost(_heat([-100.0, 100.5]), "nmbe")


@pytest.mark.parametrize(("name", "other"), [("cv_rmse", "rmse_over_range"), ("nmbe", "bias_over_range")])
def test_for_a_temperature_the_former_names_of_costs_over_the_range_work(name: Any, other: Any) -> None:
    problem = _heat([20.0, 24.0], "degC")
    cost = Cost(problem, name)
    assert (cost.name, f"write '{other}'" in cost.note) == (other, True)
    residuals = problem.residuals(np.array([[1.0]]))
    np.testing.assert_array_equal(cost.of_sensors(residuals), Cost(problem, other).of_sensors(residuals))
    np.testing.assert_allclose(cost.of_sensors(residuals), 25.0)


def test_a_unit_other_than_degc_needs_an_uncertainty() -> None:
    assert FitSensor("room", np.array([20.0, 21.0])).standard_uncertainty == 0.5 / 1.96
    with pytest.raises(InputError, match=r"sensor 'heat': found no uncertainty, expected one"):
        FitSensor("heat", np.array([1.0, 2.0]), unit="W")
