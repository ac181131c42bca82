from __future__ import annotations

import math

import pytest

from mascarin.errors import InputError
from mascarin.optimization import Evaluation, HookeJeeves, Point, box, minimize, uniform_starts


def quadratic(points: list[Point]) -> list[float]:
    return [(p.x[0] - 0.3) ** 2 + 2 * (p.x[1] + 0.4) ** 2 + 0.5 for p in points]


def two_wells(points: list[Point]) -> list[float]:
    return [
        0.1 * (p.x[0] ** 2 + p.x[1] ** 2) + 2 - math.cos(2 * p.x[0]) - math.cos(2 * p.x[1]) + 0.05 * p.x[0]
        for p in points
    ]


def plane(start: float = 0.9) -> HookeJeeves:
    return HookeJeeves(box(["a", "b"], [start, start], [-1, -1], [1, 1], [0.1, 0.1]), reductions=6)


def test_hooke_jeeves_finds_the_minimum_on_its_mesh() -> None:
    search = plane()
    best = minimize(search, quadratic)
    assert best.point.x == (0.3, -0.4)
    assert best.cost == pytest.approx(0.5, abs=1e-15)
    assert search.reason == "required accuracy is reached"


def test_points_run_in_advance_change_neither_the_search_nor_the_count() -> None:
    alone, helped = plane(), plane()
    calls = [0, 0]

    def count(which: int, points: list[Point]) -> list[float]:
        calls[which] += 1
        return quadratic(points)

    first = minimize(alone, lambda p: count(0, p))
    second = minimize(helped, lambda p: count(1, p), ahead=5)
    assert first == second
    assert alone.count == helped.count
    assert calls[1] < calls[0] / 2


def test_guesses_run_later_starts_at_the_same_time() -> None:
    space = box(["a", "b"], [2.5, 2.5], [-4, -4], [4, 4], [0.5, 0.5])
    starts = uniform_starts(space, 5, seed=3)
    rounds = []
    results = []
    for ahead in (0, 15):
        search = HookeJeeves(space, starts=starts, reductions=5)
        n = 0
        while points := search.ask(ahead):
            n += 1
            search.tell([Evaluation(p, c) for p, c in zip(points, two_wells(points), strict=True)])
        rounds.append(n)
        results.append((search.best, search.count))
    assert results[0] == results[1]
    assert rounds[1] < rounds[0] / 4


def test_replay_continues_without_asking_again() -> None:
    whole, log = plane(), []
    while points := whole.ask():
        results = [Evaluation(p, c) for p, c in zip(points, quadratic(points), strict=True)]
        log += results
        whole.tell(results)
    again = plane()
    again.replay(log[:20])
    asked = []
    while points := again.ask():
        asked += points
        again.tell([Evaluation(p, c) for p, c in zip(points, quadratic(points), strict=True)])
    assert asked == [e.point for e in log[20:]]
    assert again.best == whole.best


def test_a_start_outside_its_bounds_is_named() -> None:
    with pytest.raises(InputError, match=r"a=1\.9 is outside -1\.0\.\.1\.0"):
        plane(1.9)


def test_a_cost_that_is_no_number_is_never_chosen() -> None:
    def hole(points: list[Point]) -> list[float]:
        return [math.nan if p.x[0] < 0.5 else c for p, c in zip(points, quadratic(points), strict=True)]

    assert minimize(plane(), hole).point.x == (0.5, -0.4)


def test_results_of_other_points_are_refused() -> None:
    search = plane()
    search.ask()
    with pytest.raises(ValueError, match="expected the evaluations of the 1 points of the last ask"):
        search.tell([Evaluation(Point((0.0, 0.0)), 1.0)])


def test_the_estimate_of_what_is_left_falls_to_one_round() -> None:
    search = plane()
    left = []
    while points := search.ask():
        search.tell([Evaluation(p, c) for p, c in zip(points, quadratic(points), strict=True)])
        left.append(search.remaining)
    assert left[0] == 7 * 4
    assert left[-1] == 4
