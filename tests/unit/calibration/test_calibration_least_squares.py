"""Least squares: exact derivatives and differences, and the reduced normal equations."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin._io.sealed import own_records
from mascarin.calibration import (
    CalibrationProblem,
    Cost,
    Evaluator,
    FitParameter,
    FitSensor,
    SearchOptions,
    solve,
)
from mascarin.calibration.methods.least_squares import Squares, derivative, exact, scale_of
from mascarin.errors import InputError, SolverError

Floats = NDArray[np.float64]

TIME = np.linspace(0.0, 4.0, 300)
TRUTH = np.array([0.8, 2.0, 5.0])
EXACT = SearchOptions(starts=2, slopes="exact")


def model(x: Floats) -> Floats:
    """A decay and a sinusoid, measured by two sensors."""
    rate, size, offset = (x[:, k, None] for k in range(3))
    decay = size * np.exp(-rate * TIME)
    return np.stack([decay + offset, offset * np.cos(TIME) + decay**2], axis=2)


def slopes(x: Floats) -> Floats:
    """Their derivatives, by hand."""
    rate, size, _ = x
    decay = size * np.exp(-rate * TIME)
    first = np.stack([-TIME * decay, decay / size, np.ones_like(TIME)], axis=1)
    second = np.stack([-2.0 * TIME * decay**2, 2.0 * decay**2 / size, np.cos(TIME)], axis=1)
    return np.stack([first, second], axis=1)


def posed(noise: float = 0.0, given: Callable[[Floats], Floats] | None = slopes) -> CalibrationProblem:
    """Gaps, a mask, a weight, an uncertainty that grows, a log scale and two priors."""
    measured = model(TRUTH[None])[0] + noise * np.random.default_rng(4).standard_normal((TIME.size, 2))
    measured[20:40, 1] = np.nan
    parameters = (
        FitParameter("rate", 0.1, 4.0, start=2.0, scale="log", prior=(0.8, 0.5)),
        FitParameter("size", 0.5, 6.0, start=4.0),
        FitParameter("offset", 1.0, 9.0, start=2.0, prior=(5.0, 3.0)),
    )
    sensors = (
        FitSensor("a", measured[:, 0], 0.1, relative_standard_uncertainty=0.02, weight=0.25),
        FitSensor("b", measured[:, 1], 0.2, use=TIME < 3.0),
    )
    return CalibrationProblem(parameters, sensors, model, slopes=given)


def test_exact_slopes_go_through_scales_weights_priors_and_gaps() -> None:
    problem = posed(0.1)
    z = np.array([0.3, 0.6, 0.45])
    with Evaluator(Cost(problem, "nll"), keep_residuals=True) as evaluator:
        found = Squares(problem, evaluator, EXACT).jacobian(z)
        near = Squares(problem, evaluator, SearchOptions(difference=1e-6)).jacobian(z)
        by_position = exact(problem, evaluator, z)
    assert found.shape == (problem.mask.sum() + 2, 3)
    np.testing.assert_allclose(found, near, atol=1e-5 * np.abs(found).max())
    # The priors stand last: one row each, the change of the value over its standard deviation.
    rates = problem.rates(z)
    assert rates[0] == pytest.approx(problem.values(z[None])[0, 0] * np.log(40.0))
    np.testing.assert_allclose(found[-2:], [[rates[0] / 0.5, 0.0, 0.0], [0.0, 0.0, 8.0 / 3.0]])
    assert not by_position[~problem.mask].any()
    central = derivative(problem, z, 1e-5)[1]
    np.testing.assert_allclose(by_position, central, atol=1e-7 * np.abs(central).max())


def test_the_reduced_jacobian_has_the_same_normal_equations() -> None:
    problem = posed(0.1)
    z = np.array([0.3, 0.6, 0.45])
    with Evaluator(Cost(problem, "nll"), keep_residuals=True) as evaluator:
        squares = Squares(problem, evaluator, EXACT)
        r, j = squares.residuals(z), squares.jacobian(z)
        size, rows = squares.size(z), squares.condensed(z)
    assert size.shape == (4,)
    assert rows.shape == (4, 3)
    np.testing.assert_allclose(size @ size, r @ r, rtol=1e-13)
    np.testing.assert_allclose(rows.T @ rows, j.T @ j, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(rows.T @ size, j.T @ r, rtol=1e-11, atol=1e-11)
    assert scale_of(problem).size == problem.mask.sum()


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_both_kinds_of_slopes_end_at_the_same_place(noise: float) -> None:
    near = solve(posed(noise), options=SearchOptions(starts=2))
    found = solve(posed(noise), options=EXACT)
    assert len(found.distinct_minima()) == 1
    np.testing.assert_allclose(found.x, near.x, rtol=1e-5)
    # One member a step in the place of one and its neighbours.
    assert found.trace.cost.size < near.trace.cost.size / 2
    if noise:
        np.testing.assert_allclose(found.high - found.low, near.high - near.low, rtol=1e-3)
    else:
        np.testing.assert_allclose(found.x, TRUTH, rtol=1e-9)


def test_an_estimate_on_its_bound_has_slopes_there() -> None:
    problem = posed(0.1)
    first = replace(problem.parameters[1], upper=1.5, start=1.0)
    narrow = replace(problem, parameters=(problem.parameters[0], first, problem.parameters[2]))
    fits = [solve(narrow, options=rules) for rules in (EXACT, SearchOptions(starts=2))]
    assert fits[0].x[1] == 1.5
    assert "size" in fits[0].on_bound
    # Forward differences are off by the curvature over their step, which the large residuals here weigh.
    assert (np.abs(fits[0].x - fits[1].x) <= 1e-3 * (fits[0].high - fits[0].low)).all()


def test_other_methods_take_exact_slopes_for_their_intervals() -> None:
    rules: dict[str, Any] = {"agree": 1, "sequences": 1, "reductions": 14}
    found, near = (
        solve(posed(0.1), method="hooke-jeeves", options=SearchOptions(slopes=kind, **rules))
        for kind in ("exact", "differences")
    )
    np.testing.assert_array_equal(found.x, near.x)
    np.testing.assert_allclose(found.high - found.low, near.high - near.low, rtol=1e-3)


class Killed(BaseException):
    """Simulates that the process is killed."""


def test_interrupted_between_slopes_it_continues_and_ends_the_same(tmp_path: Path) -> None:
    whole = solve(posed(0.2), options=EXACT)
    path = tmp_path / "record.jsonl"
    taken: list[bytes] = []

    def counted(x: Floats) -> Floats:
        taken.append(x.tobytes())
        return slopes(x)

    def mortal(x: Floats) -> Floats:
        if len(taken) == 5:
            raise Killed
        return counted(x)

    with pytest.raises(Killed):
        solve(posed(0.2, mortal), options=EXACT, record=path)
    path.write_bytes(path.read_bytes() + b'{"x": [1.0, 0.5, 2.0], "j": "AAA')  # what was being written
    fit = solve(posed(0.2, counted), options=EXACT, record=path)
    np.testing.assert_array_equal(fit.x, whole.x)
    np.testing.assert_array_equal(fit.high, whole.high)
    assert len(set(taken)) == len(taken)
    assert fit.trace.replayed > 0
    before = path.read_bytes()
    again = solve(posed(0.2, mortal), options=EXACT, record=path)
    assert path.read_bytes() == before
    np.testing.assert_array_equal(again.low, whole.low)
    # Evaluations are evaluations, whichever way the slopes are taken.
    other = solve(posed(0.2), options=SearchOptions(starts=2), record=path)
    assert other.trace.replayed == again.trace.cost.size


def test_damaged_slopes_in_a_record_are_computed_again(tmp_path: Path) -> None:
    path = tmp_path / "record.jsonl"
    reference = solve(posed(0.2), options=EXACT, record=path)
    sound = path.read_bytes()
    lines = path.read_text().splitlines(keepends=True)
    at = next(k for k, line in enumerate(lines) if "j" in json.loads(line))
    head = own_records.seal_of(lines[0])
    entry = own_records.opened(head, lines[at].encode())
    edited = json.dumps(entry | {"j": "AAAA"}) + "\n"
    sealed = [own_records.sealed(head, entry | {"j": "AAAA"})]
    undefined = base64.b64encode(np.full((300, 2, 3), np.nan).tobytes()).decode()
    sealed.append(own_records.sealed(head, entry | {"j": undefined}))
    for changed in (edited, *sealed):
        path.write_text("".join([*lines[:at], changed, *lines[at + 1 :]]))
        with pytest.warns(UserWarning, match=rf"damaged lines: 1 \(line {at + 1}: .*computed again"):
            fit = solve(posed(0.2), options=EXACT, record=path)
        np.testing.assert_array_equal(fit.x, reference.x)
        np.testing.assert_array_equal(fit.high, reference.high)
        assert sorted(path.read_bytes().splitlines()) == sorted(sound.splitlines())


def test_a_function_without_derivatives_has_none() -> None:
    with pytest.raises(InputError, match=r"a function without derivatives; give them .* or choose slopes"):
        solve(posed(given=None), options=EXACT)
    with pytest.raises(InputError, match=r"slopes of shape \(300, 2\), expected \(300, 2, 3\)"):
        solve(posed(given=lambda x: slopes(x)[:, :, 0]), options=EXACT)
    with pytest.raises(SolverError, match=r"no derivative at rate = .*: it is not a number"):
        solve(posed(given=lambda x: np.nan * slopes(x)), options=EXACT)

    def unsettled(x: Floats) -> Floats:
        raise SolverError("step 3 did not converge")

    with pytest.raises(SolverError, match=r"no derivative at rate = .*: step 3 did not converge"):
        solve(posed(given=unsettled), options=EXACT)
