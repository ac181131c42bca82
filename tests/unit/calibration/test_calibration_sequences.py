"""All search methods: the same minimum, the same result after an interruption, and an own optimizer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.calibration import METHODS, CalibrationProblem, FitParameter, FitSensor, SearchOptions, solve
from mascarin.errors import InputError, SolverError
from mascarin.optimization import Evaluation, Optimizer, Point, Space
from mascarin.optimization.base import Steps

Floats = NDArray[np.float64]

TRUTH = np.array([0.3, 0.62])
RULES = SearchOptions(
    starts=2, agree=2, sequences=6, reductions=12, particles=9, generations=25, moves=60, walkers=8
)


class Sheet:
    """Two sensors that depend nonlinearly on two parameters; stops with an error after some evaluations."""

    def __init__(self, stops_after: int | None = None) -> None:
        self.members = 0
        self._stops_after = stops_after
        self.hour = np.arange(96) / 4.0

    def __call__(self, x: Floats) -> Floats:
        if self._stops_after is not None and self.members >= self._stops_after:
            raise KeyboardInterrupt
        self.members += len(x)
        day = np.sin(self.hour * np.pi / 12.0)
        film, mass = x[:, :1], x[:, 1:]
        fast = 20.0 + 6.0 * day / (0.5 + film)
        slow = 20.0 + 5.0 * np.sin((self.hour - 4.0 * mass) * np.pi / 12.0) * np.exp(-mass)
        return np.stack([fast, slow], axis=2)


def problem(model: Any = None, noise: float = 0.05) -> CalibrationProblem:
    measured = Sheet()(TRUTH[None])[0] + noise * np.random.default_rng(3).normal(size=(96, 2))
    return CalibrationProblem(
        tuple(FitParameter(name, 0.05, 1.0, start=0.9) for name in ("film", "mass")),
        tuple(FitSensor(f"s{k}", measured[:, k], 0.05) for k in range(2)),
        model or Sheet(),
    )


@pytest.mark.parametrize("method", METHODS)
def test_every_method_finds_the_minimum_that_least_squares_finds(method: Any) -> None:
    fit = solve(problem(), method=method, options=RULES, seed=1)
    best = solve(problem(), options=RULES)
    np.testing.assert_allclose(fit.x, best.x, atol=2e-3)
    assert np.all((fit.low < TRUTH) & (fit.high > TRUTH))
    assert fit.method == method
    # The uncertainty does not depend on the search method.
    np.testing.assert_allclose(
        fit.high - fit.low, best.high - best.low, rtol=0.3 if method == "emcee" else 0.02
    )


@pytest.mark.parametrize("method", METHODS)
def test_an_interrupted_search_continues_and_gives_the_same_bytes(method: Any, tmp_path: Path) -> None:
    whole, broken = tmp_path / "whole.jsonl", tmp_path / "broken.jsonl"
    fit = solve(problem(), method=method, options=RULES, seed=5, record=whole)
    for stops_after in (10, 20):
        with pytest.raises(KeyboardInterrupt):
            solve(problem(Sheet(stops_after)), method=method, options=RULES, seed=5, record=broken)
    again = solve(problem(), method=method, options=RULES, seed=5, record=broken)
    assert broken.read_bytes() == whole.read_bytes()
    for name in ("x", "low", "high", "correlation"):
        assert getattr(again, name).tobytes() == getattr(fit, name).tobytes()
    assert again.trace.cost.tobytes() == fit.trace.cost.tobytes()
    assert again.trace.replayed >= 20


def test_sequences_differ_by_their_seed_and_agree_in_the_end() -> None:
    for method in ("particle-swarm", "hybrid", "cma-es"):
        fit = solve(problem(), method=method, options=RULES, seed=2)
        assert "sequences reached the same minimum" in fit.reason
        first, second = fit.minima[:2]
        assert not np.array_equal(first.start, second.start)
        assert not np.array_equal(first.x, second.x)
        # A swarm stops when its generations are over, wherever it is then.
        assert method == "particle-swarm" or len(fit.distinct_minima()) == 1


class Bisecting(Optimizer):
    """An own optimizer: shrinks a box about the best of random points."""

    def _search(self) -> Steps:
        rng = np.random.default_rng(1)
        centre, half = np.array([c.initial for c in self.space.continuous]), 1.0
        while half > 1e-4:
            trials = np.clip(centre + half * rng.uniform(-1.0, 1.0, (24, centre.size)), 0.0, 1.0)
            found = yield [Point(tuple(row)) for row in trials.tolist()]
            best = min(found, key=lambda e: e.cost)
            centre, half = np.array(best.point.x), 0.7 * half
        return "the box is small"


def test_an_own_optimizer_is_used() -> None:
    fit = solve(problem(), cost="rmse", optimizer=Bisecting, options=SearchOptions(agree=2, sequences=4))
    np.testing.assert_allclose(fit.x, TRUTH, atol=0.03)
    assert fit.method == "your optimizer"
    assert fit.minima[0].reason == "the box is small"


def test_an_optimizer_that_never_asks_is_stopped() -> None:
    class Silent(Optimizer):
        def _search(self) -> Steps:
            while True:
                yield []

        def tell(self, results: Sequence[Evaluation]) -> None:
            assert not results

    def make(space: Space) -> Optimizer:
        return Silent(space, remember=False)

    with pytest.raises(SolverError, match="Silent of sequence 0 asks for no point and is not done"):
        solve(problem(), optimizer=make)


def test_impossible_rules_are_refused() -> None:
    wrong: tuple[tuple[dict[str, Any], str], ...] = (
        ({"walkers": 7}, "walkers: found 7, expected an even number"),
        ({"moves": 3}, "moves: found 3, expected at least 50"),
        ({"particles": 1}, "particles: found 1, expected at least 4"),
        ({"slopes": "newton"}, "slopes: found 'newton', expected differences or exact"),
    )
    for keywords, text in wrong:
        with pytest.raises(InputError, match=text):
            SearchOptions(**keywords)
    with pytest.raises(
        InputError, match=r"method: found 'particle swarm', expected .* Did you mean 'particle-swarm'"
    ):
        solve(problem(), method="particle swarm")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="walkers: found 2, expected at least 4"):
        solve(problem(), method="emcee", options=SearchOptions(walkers=2))
