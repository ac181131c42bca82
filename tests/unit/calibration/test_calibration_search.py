"""Searching: recovery, agreement of sequences, bounds, interruption."""

from __future__ import annotations

import base64
import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin._io.sealed import own_records
from mascarin.calibration import (
    Calibration,
    CalibrationProblem,
    FitParameter,
    FitSensor,
    SearchOptions,
    solve,
)
from mascarin.errors import InputError, SolverError
from mascarin.optimization import NelderMead

Floats = NDArray[np.float64]

STEP = 0.25  # h
TRUTH = np.array([4.0, 0.76, 30.0, 2.5])


class Cell:
    """A sheet without mass in the sun and a heavy room behind it; counts its evaluations."""

    def __init__(self) -> None:
        hour = np.arange(192) * STEP
        self.sun = 800.0 * np.maximum(0.0, np.sin((hour - 6.0) / 12.0 * np.pi))
        self.wave = np.exp(1j * hour / 12.0 * np.pi)
        self.members = 0
        self.batches: list[int] = []

    def __call__(self, x: Floats) -> Floats:
        self.members += x.shape[0]
        self.batches.append(x.shape[0])
        film, absorptance, mass, inner = x.T[:4, :, None]
        air = 24.0 + 4.0 * self.wave.real
        # The sheet loses heat to the air and, 5 W/m2K, to the sky.
        sheet = (absorptance * self.sun + film * air + 5.0 * (air - 10.0)) / (film + 5.0)
        lagged = self.wave / (1.0 + 1j * np.pi / 12.0 * mass / inner)
        room = 24.0 + 10.0 * inner / (inner + 2.0) + 4.0 * lagged.real
        return np.stack([sheet, room], axis=2)


def _parameters() -> tuple[FitParameter, ...]:
    return (
        FitParameter("film", 1.0, 20.0, nominal=10.0, unit="W/m2K"),
        FitParameter("absorptance", 0.3, 0.95, nominal=0.85),
        FitParameter("mass", 5.0, 200.0, scale="log", unit="Wh/m2K"),
        FitParameter("inner", 0.5, 8.0, start=1.0, unit="W/m2K"),
    )


def _problem(model: Any = None, noise: float = 0.0, **keywords: Any) -> CalibrationProblem:
    cell = model or Cell()
    measured = Cell()(TRUTH[None])[0] + noise * np.random.default_rng(1).normal(size=(192, 2))
    measured[40:60, 1] = np.nan
    sensors = (FitSensor("sheet", measured[:, 0], 0.5), FitSensor("room", measured[:, 1], 0.3))
    return CalibrationProblem(_parameters(), sensors, cell, **keywords)


def test_least_squares_recovers_the_truth_from_data_without_noise() -> None:
    cell = Cell()
    fit = solve(_problem(cell), options=SearchOptions(starts=3))
    np.testing.assert_allclose(fit.x, TRUTH, rtol=1e-4)
    assert len(fit.minima) == 3
    assert len(fit.distinct_minima()) == 1
    # Each step and the differences around it come in one batch.
    assert cell.batches[1] >= 4
    assert cell.members < 600
    assert fit.on_bound == {}


def test_intervals_contain_the_true_values_as_in_the_table() -> None:
    fit = solve(_problem(noise=0.3))
    assert np.all((fit.low < TRUTH) & (fit.high > TRUTH))
    assert np.all(fit.low < fit.x)
    assert np.all((fit.high - fit.low) / fit.x < 0.2)
    entry = fit.to_dict()["film"]
    assert list(entry) == ["nominal", "fitted", "low", "high", "unit"]
    assert (entry["nominal"], entry["unit"]) == (10.0, "W/m2K")
    assert fit.to_dict()["inner"]["nominal"] is None
    table = fit.to_dataframe()
    assert table.index.tolist() == ["film", "absorptance", "mass", "inner"]
    # Student's quantile or the simulated one, both about two, between interval and standard error.
    np.testing.assert_allclose(
        table["high"] - table["low"], 2.0 * fit.uncertainty.quantile * table["standard_error"], rtol=0.02
    )
    assert table.loc["film", "correlated_with"] == "absorptance"
    assert table.loc["film", "correlation"] == fit.correlation[0, 1]
    assert fit.values["mass"] == fit.x[2]
    np.testing.assert_allclose(np.diag(fit.correlation), 1.0)
    assert np.isnan(fit.residuals[40:60, 1]).all()
    assert "autoregressive" in fit.uncertainty_method


@pytest.mark.parametrize("cost", ["sd", "rmse", "rmse_over_range", "nll"])
def test_pattern_search_finds_the_minimum_of_every_cost(cost: Any) -> None:
    rules = SearchOptions(agree=1, reductions=12, together=1)
    fit = solve(_problem(noise=0.05), method="hooke-jeeves", cost=cost, options=rules, seed=3)
    if cost == "sd":
        # Without the bias only the amplitude of the room counts: it depends on the ratio of mass and inner.
        assert fit.x[2] / fit.x[3] == pytest.approx(TRUTH[2] / TRUTH[3], rel=0.01)
        assert any("mass and inner cannot be distinguished" in text for text in fit.warnings)
    else:
        np.testing.assert_allclose(fit.x, TRUTH, rtol=0.02)
        # Film and absorptance are correlated by 0.99, but both are known to a part in a hundred.
        assert fit.correlation[0, 1] > 0.95
        assert fit.warnings == ()
    assert fit.reason == "1 of 1 sequences reached the same minimum"
    lowest = min(m.cost for m in fit.minima)
    assert fit.cost == lowest
    assert fit.trace.cost.min() <= lowest
    assert fit.of_sensors.sum() == pytest.approx(lowest)
    assert np.all((fit.low <= fit.x) & (fit.x <= fit.high))


def _two_wells(depth: float) -> CalibrationProblem:
    """A cost with a minimum at 0.2 and another, `depth` higher, at 0.8."""

    def model(x: Floats) -> Floats:
        well = np.minimum(np.abs(x[:, 0] - 0.2), np.abs(x[:, 0] - 0.8) + depth)
        return np.stack([1.0 + well, -1.0 - well], axis=1)[:, :, None]

    return CalibrationProblem(
        (FitParameter("p", 0.0, 1.0),), (FitSensor("s", np.array([0.0, 0.001])),), model
    )


def test_sequences_end_in_different_minima_and_the_lowest_wins() -> None:
    rules = SearchOptions(agree=5, sequences=60, reductions=14)
    fit = solve(_two_wells(0.1), method="hooke-jeeves", cost="rmse", options=rules)
    assert fit.x[0] == pytest.approx(0.2, abs=1e-3)
    groups = fit.distinct_minima()
    assert len(groups) == 2
    assert groups[1][0].x[0] == pytest.approx(0.8, abs=1e-3)
    assert len(groups[0]) == 5
    assert sum(len(g) for g in groups) == len(fit.minima)
    counts, edges = fit.histogram(bins=2)
    assert counts.tolist() == [len(groups[0]), len(groups[1])]
    assert edges[0] == pytest.approx(1.0, abs=0.01)


def test_agreement_waits_for_the_lowest_minimum() -> None:
    rules = SearchOptions(agree=10, sequences=4, reductions=14)
    fit = solve(_two_wells(0.1), method="hooke-jeeves", cost="rmse", options=rules)
    assert fit.reason == "all 4 sequences searched, without agreement of 10"
    assert len(fit.minima) == 4


def test_number_side_by_side_does_not_change_the_result() -> None:
    fits = [
        solve(
            _problem(noise=0.3),
            method="hooke-jeeves",
            cost="rmse",
            options=SearchOptions(agree=3, sequences=8, reductions=3, together=together),
            seed=5,
        )
        for together in (1, 5)
    ]
    for fit in fits[1:]:
        np.testing.assert_array_equal(fit.x, fits[0].x)
        assert [m.cost for m in fit.minima] == [m.cost for m in fits[0].minima]


def test_lanes_are_filled_by_many_sequences() -> None:
    cell = Cell()
    rules = SearchOptions(agree=20, sequences=20, together=16, reductions=2)
    solve(_problem(cell, noise=0.3), method="hooke-jeeves", cost="rmse", options=rules)
    assert np.median(cell.batches) >= 12


def test_budget_of_evaluations_stops_every_sequence() -> None:
    cell = Cell()
    rules = SearchOptions(agree=10, evaluations=100, together=4)
    fit = solve(_problem(cell), method="hooke-jeeves", cost="rmse", options=rules)
    assert "budget of 100 evaluations" in fit.reason
    assert cell.members < 130
    assert fit.cost == fit.trace.cost.min()


def test_an_own_optimizer_is_used() -> None:
    fit = solve(
        _problem(noise=0.05),
        method="hooke-jeeves",
        cost="rmse",
        optimizer=lambda space: NelderMead(space, accuracy=1e-6),
        options=SearchOptions(agree=1, together=1),
    )
    assert np.isfinite(fit.cost)


def test_estimate_on_a_bound_is_named_with_a_reason() -> None:
    parameters = list(_parameters())
    parameters[1] = FitParameter("absorptance", 0.8, 0.95)
    problem = _problem(noise=0.1)
    fit = solve(CalibrationProblem(tuple(parameters), problem.sensors, Cell()))
    assert fit.x[1] == 0.8
    assert (
        "on its lower bound 0.8: the minimum lies beyond, at less than the range allows"
        in fit.on_bound["absorptance"]
    )
    assert list(fit.on_bound) == ["absorptance"]
    assert fit.to_dataframe().loc["absorptance", "remark"] == fit.on_bound["absorptance"]
    assert fit.low[1] == 0.8


def test_parameters_that_cannot_be_distinguished_are_named() -> None:
    rng = np.random.default_rng(2)
    wave = np.sin(np.arange(200) / 10.0)

    def model(x: Floats) -> Floats:
        ratio = x[:, 0] / x[:, 1]
        inactive = 0.0 * x[:, 3]
        return (np.tanh(ratio[:, None] * wave) + x[:, 2:3] * np.roll(wave, 15) + inactive[:, None])[
            :, :, None
        ]

    truth = np.array([[0.04, 0.01, 1.0, 0.5]])
    measured = model(truth)[0, :, 0] + 0.02 * rng.normal(size=200)
    problem = CalibrationProblem(
        (
            FitParameter("gamma", 0.005, 0.06),
            FitParameter("delta_t", 0.005, 0.05),
            FitParameter("gain", 0.0, 2.0),
            FitParameter("color", 0.0, 1.0),
        ),
        (FitSensor("interface", measured, 0.02),),
        model,
    )
    fit = solve(problem)
    assert any("gamma and delta_t cannot be distinguished" in w and "fix one" in w for w in fit.warnings)
    assert "color has no effect on the compared sensors: fix it" in fit.warnings
    assert not any(w.startswith("gain") for w in fit.warnings)
    # An undetermined parameter has an interval as wide as its range.
    assert (fit.low[3], fit.high[3]) == (0.0, 1.0)
    assert fit.high[2] - fit.low[2] < 0.05


def test_a_prior_determines_what_the_data_do_not() -> None:
    def model(x: Floats) -> Floats:
        return (x[:, :1] + x[:, 1:] + np.zeros(50))[:, :, None]

    sensors = (FitSensor("s", 5.0 + 0.1 * np.random.default_rng(3).normal(size=50), 0.1),)
    parameters = (FitParameter("a", 0.0, 10.0, prior=(2.0, 0.2)), FitParameter("b", 0.0, 10.0))
    fit = solve(CalibrationProblem(parameters, sensors, model), options=SearchOptions(starts=1))
    assert fit.x[0] == pytest.approx(2.0, abs=1e-3)
    assert fit.x[1] == pytest.approx(3.0, abs=0.05)
    assert fit.high[0] - fit.low[0] == pytest.approx(2.0 * 1.96 * 0.2, rel=0.05)


def test_bias_costs_without_intervals() -> None:
    fit = solve(
        _problem(noise=0.1),
        method="hooke-jeeves",
        cost="bias_over_range",
        options=SearchOptions(agree=2, sequences=3),
    )
    assert np.isnan(fit.low).all()
    assert fit.to_dict()["film"]["low"] is None
    assert fit.warnings[0].startswith("the cost 'bias_over_range' compares means only")


# --- record and interruption --------------------------------------------------------------------------


class Killed(BaseException):
    """Simulates that the process is killed."""


@pytest.mark.parametrize("method", ["least-squares", "hooke-jeeves"])
def test_an_interrupted_calibration_continues_and_ends_the_same(method: Any, tmp_path: Path) -> None:
    keywords: dict[str, Any] = {
        "method": method,
        "cost": "nll" if method == "least-squares" else "rmse",
        "options": SearchOptions(starts=2, agree=2, sequences=4, reductions=4),
    }
    whole = solve(_problem(noise=0.2), **keywords)
    path = tmp_path / "deep" / "record.jsonl"

    class Interrupted(Cell):
        def __call__(self, x: Floats) -> Floats:
            if self.members > 60:
                raise Killed
            return super().__call__(x)

    with pytest.raises(Killed):
        solve(_problem(Interrupted(), noise=0.2), record=path, **keywords)
    kept = path.read_bytes()
    path.write_bytes(kept + b'{"x": [1.0, 0.5')  # the line that was being written
    cell = Cell()
    fit = solve(_problem(cell, noise=0.2), record=path, **keywords)
    np.testing.assert_array_equal(fit.x, whole.x)
    np.testing.assert_array_equal(fit.high, whole.high)
    assert fit.trace.replayed >= 60
    assert cell.members <= whole.trace.x.shape[0] - fit.trace.replayed + 2 * 4 + 1
    again = Cell()
    solve(_problem(again, noise=0.2), record=path, **keywords)
    assert again.members == 2 * 4 + 1  # the derivatives at the minimum alone
    # Nothing is in the record twice.
    lines = [json.loads(line) for line in path.read_text().splitlines()][1:]
    assert len({tuple(line["x"]) for line in lines}) == len(lines) == whole.trace.x.shape[0]


def test_a_larger_budget_continues_from_the_record(tmp_path: Path) -> None:
    path = tmp_path / "record.jsonl"
    keywords: dict[str, Any] = {"method": "hooke-jeeves", "cost": "rmse", "record": path}
    solve(_problem(noise=0.2), options=SearchOptions(agree=9, sequences=2, reductions=4), **keywords)
    fit = solve(_problem(noise=0.2), options=SearchOptions(agree=9, sequences=4, reductions=4), **keywords)
    assert 0 < fit.trace.replayed < fit.trace.x.shape[0]
    assert len(fit.minima) == 4


def test_members_that_fail_are_recorded_and_avoided(tmp_path: Path) -> None:
    class Fragile(Cell):
        def __call__(self, x: Floats) -> Floats:
            out = super().__call__(x)
            out[x[:, 0] > 9.0] = np.nan
            return out

    parameters = (FitParameter("film", 1.0, 20.0, start=8.0), *_parameters()[1:])
    path = tmp_path / "record.jsonl"
    for method, cost in (("hooke-jeeves", "rmse"), ("least-squares", "nll")):
        problem = CalibrationProblem(parameters, _problem(noise=0.05).sensors, Fragile())
        record = path if method == "hooke-jeeves" else None
        fit = solve(
            problem,
            method=method,  # type: ignore[arg-type]
            cost=cost,  # type: ignore[arg-type]
            options=SearchOptions(starts=4, agree=1, sequences=4, reductions=6),
            record=record,
        )
        assert fit.x[0] == pytest.approx(4.0, rel=0.1)
        assert np.isinf(fit.trace.cost).any()
    assert "null" in path.read_text()


def test_records_of_another_problem_and_other_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "record.jsonl"
    rules = SearchOptions(agree=1, sequences=1, reductions=2)
    keywords: dict[str, Any] = {"method": "hooke-jeeves", "options": rules, "record": path}
    solve(_problem(), cost="rmse", **keywords)
    with pytest.raises(InputError, match=r"another calibration \(differing: cost\)"):
        solve(_problem(), cost="sd", **keywords)
    with pytest.raises(InputError, match=r"\(differing: problem\)"):
        solve(_problem(identity="other"), cost="rmse", **keywords)
    for content in ("a,b\n1,2\n", "a,b", '{"something": "else"}\n'):
        path.write_text(content)
        with pytest.raises(InputError, match="not that of a record of a calibration"):
            solve(_problem(), cost="rmse", **keywords)
        assert path.read_text() == content


def _edited(line: str, key: str, value: Any) -> str:
    return json.dumps(json.loads(line) | {key: value}) + "\n"


def test_damaged_evaluations_are_computed_again(tmp_path: Path) -> None:
    """An edited residual, a NaN, lines of another record, swapped and cut lines: the same estimates."""
    path = tmp_path / "record.jsonl"
    other = tmp_path / "other.jsonl"
    keywords: dict[str, Any] = {
        "method": "least-squares",
        "cost": "nll",
        "options": SearchOptions(starts=1, agree=1),
    }
    reference = solve(_problem(noise=0.2), record=path, **keywords)
    solve(_problem(noise=0.3), record=other, **keywords)
    first, *lines = path.read_text().splitlines(keepends=True)
    shape = _problem(noise=0.2).measured.shape
    shifted = base64.b64encode(np.full(shape, 0.25).tobytes()).decode()
    undefined = base64.b64encode(np.full(shape, np.nan).tobytes()).decode()
    head, entry = (
        own_records.seal_of(first),
        own_records.opened(own_records.seal_of(first), lines[0].encode()),
    )
    changes = {
        "residual": [_edited(lines[0], "r", shifted), *lines[1:]],
        "cost": [*lines[:-1], _edited(lines[-1], "c", [0.0, 0.0])],
        "value": [_edited(lines[0], "x", [1.0, 1.0]), *lines[1:]],
        "word": ["nonsense\n", *lines[1:]],
        "NaN": [lines[0].replace('"c":[', '"c":[NaN,'), *lines[1:]],
        "undefined residual": [own_records.sealed(head, entry | {"r": undefined}), *lines[1:]],
        "number of values": [own_records.sealed(head, entry | {"x": [1.0]}), *lines[1:]],
        "another record": [other.read_text().splitlines(keepends=True)[1], *lines[1:]],
        "cut": [lines[0][:-9] + "\n", *lines[1:]],
    }
    for name, changed in changes.items():
        path.write_text("".join([first, *changed]))
        with pytest.warns(UserWarning, match=r"damaged lines: 1 \(line \d+: .*computed again"):
            fit = solve(_problem(noise=0.2), record=path, **keywords)
        assert fit.x.tobytes() == reference.x.tobytes(), name
        assert fit.trace.replayed == len(lines) - 1, name
        # What is in the file afterwards is sound: nothing is warned of a second time.
        again = solve(_problem(noise=0.2), record=path, **keywords)
        assert again.trace.replayed == len(lines), name
    path.write_text("".join([first, *reversed(lines)]))
    assert solve(_problem(noise=0.2), record=path, **keywords).x.tobytes() == reference.x.tobytes()
    path.write_text("".join([_edited(first, "weights", [1.0, 9.0]), *lines]))
    with pytest.warns(UserWarning, match="damaged or of another version; everything is computed again"):
        fit = solve(_problem(noise=0.2), record=path, **keywords)
    assert fit.x.tobytes() == reference.x.tobytes()
    assert fit.trace.replayed == 0
    path.write_text(first[:30])  # killed while the first line was written
    assert solve(_problem(noise=0.2), record=path, **keywords).trace.replayed == 0


# --- early errors -------------------------------------------------------------------------------------


def test_a_cost_that_is_no_number_at_the_start_stops_at_once() -> None:
    calls = 0

    def model(x: Floats) -> Floats:
        nonlocal calls
        calls += x.shape[0]
        out = np.zeros((x.shape[0], 3, 2))
        out[:, 1, 1] = math.nan
        return out

    sensors = (FitSensor("room", np.arange(3.0)), FitSensor("gap", np.arange(3.0)))
    problem = CalibrationProblem((FitParameter("film", 0.0, 1.0, unit="W/m2K"),), sensors, model)
    with pytest.raises(
        InputError, match=r"at the start \(film = 0.5 W/m2K\): the model gives no number for gap"
    ):
        solve(problem)
    assert calls <= 2


def test_unknown_method_and_costs_that_do_not_fit() -> None:
    with pytest.raises(InputError, match="method: found 'newton'"):
        solve(_problem(), method="newton")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="for the cost 'sd' use a method such as 'hooke-jeeves'"):
        solve(_problem(), cost="sd")
    with pytest.raises(InputError, match="between 0 and 1, such as"):
        solve(_problem(), confidence=95.0)
    with pytest.raises(InputError, match="agree: found 0"):
        SearchOptions(agree=0)
    with pytest.raises(InputError, match="difference: found 2"):
        SearchOptions(difference=2.0)


def test_no_derivative_next_to_the_minimum_is_said() -> None:
    def model(x: Floats) -> Floats:
        out = np.tile(x[:, :, None], (1, 4, 1))
        out[x[:, 0] != 0.5] = np.nan
        return out

    problem = CalibrationProblem((FitParameter("p", 0.0, 1.0),), (FitSensor("s", np.arange(4.0)),), model)
    with pytest.raises(SolverError, match=r"near p = 0\.5"):
        solve(problem, options=SearchOptions(starts=1))


def test_progress_counts_evaluations_and_shows_the_lowest_cost() -> None:
    seen: list[tuple[int, float]] = []

    def progress(count: int, lowest: float) -> None:
        seen.append((count, lowest))

    fit: Calibration = solve(_problem(noise=0.2), options=SearchOptions(starts=1), on_batch=progress)
    assert seen[-1][0] == fit.trace.x.shape[0]
    assert seen[-1][1] == fit.trace.cost.min()
    assert all(b[1] <= a[1] for a, b in itertools.pairwise(seen))
