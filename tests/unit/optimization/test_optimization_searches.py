"""The other searches through ask and tell."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from mascarin.errors import InputError, SolverError
from mascarin.optimization import (
    ArmijoGradient,
    Continuous,
    CoordinateSearch,
    CovarianceSearch,
    Discrete,
    Evaluation,
    FibonacciSearch,
    GoldenSection,
    Grid,
    NelderMead,
    Observer,
    OneAtATime,
    Optimizer,
    ParticleSwarm,
    Point,
    Space,
    SwarmRules,
    SwarmThenPattern,
    box,
    minimize,
)
from mascarin.optimization.line import fibonacci_points, golden_points
from mascarin.optimization.random import Lcg48
from mascarin.optimization.transform import free_step, from_free, to_free

PLANE = box(["a", "b"], [0.9, 0.9], [-1, -1], [1, 1], [0.1, 0.1])
MIXED = Space((Continuous("a", 0.5, 0.25, -2, 2),), (Discrete("n", 0, 8),))
LINE = box(["a"], [0.0], [-1], [1])


def quadratic(p: Point) -> float:
    return (p.x[0] - 0.3) ** 2 + 2 * (p.x[1] + 0.4) ** 2 + 0.5


def mixed(p: Point) -> float:
    return (p.x[0] - 0.1 * p.choices[0]) ** 2 + 0.2 * (p.choices[0] - 5) ** 2


@pytest.mark.parametrize(
    ("search", "tolerance"),
    [
        (CoordinateSearch(PLANE), 1e-12),
        (NelderMead(PLANE, accuracy=1e-6), 1e-5),
        (ArmijoGradient(PLANE), 1e-2),
        (ParticleSwarm(PLANE, SwarmRules(generations=60, constriction=0.8)), 1e-2),
        (SwarmThenPattern(PLANE, SwarmRules(generations=10)), 1e-12),
        (CovarianceSearch(PLANE), 1e-6),
    ],
    ids=lambda v: type(v).__name__ if isinstance(v, Optimizer) else "",
)
def test_the_minimum_is_found(search: Optimizer, tolerance: float) -> None:
    best = minimize(search, lambda points: [quadratic(p) for p in points])
    assert best.cost - 0.5 <= tolerance
    assert search.done
    assert search.ask() == []


def test_mixed_parameters() -> None:
    first, second = (
        minimize(ParticleSwarm(MIXED), lambda points: [mixed(p) for p in points]) for _ in range(2)
    )
    assert first == second
    assert first.point.choices == (5,)


def test_every_search_can_be_replayed() -> None:
    whole, log = NelderMead(PLANE), []
    while points := whole.ask():
        results = [Evaluation(p, quadratic(p)) for p in points]
        log += results
        whole.tell(results)
    again = NelderMead(PLANE)
    again.replay(log)
    assert again.done
    assert again.best == whole.best


def test_bounds_are_kept_by_the_change_of_variables() -> None:
    asked: list[Point] = []

    def cost(points: list[Point]) -> list[float]:
        asked.extend(points)
        return [(p.x[0] - 2) ** 2 + (p.x[1] - 0.2) ** 2 for p in points]

    best = minimize(NelderMead(PLANE, accuracy=1e-6), cost)
    assert best.point.x == pytest.approx((1.0, 0.2), abs=1e-3)
    assert all(PLANE.feasible(p.x) for p in asked)


@pytest.mark.parametrize(
    "c",
    [
        Continuous("a", 0.4, 0.1, 0, 1),
        Continuous("a", 0.4, 0.1, 0),
        Continuous("a", 0.4, 0.1, upper=1),
        Continuous("a", 0.4, 0.1),
    ],
)
def test_free_variables_lead_back(c: Continuous) -> None:
    t = to_free(c, 0.4)
    assert from_free(c, t) == pytest.approx(0.4, rel=1e-14)
    moved = {from_free(c, t + s) for s in (-free_step(c, 0.4), free_step(c, 0.4))}
    assert min(abs(v - 0.4) for v in moved) == pytest.approx(0.1, rel=0.15)


def test_intervals_shrink_by_golden_and_fibonacci_ratios() -> None:
    def cost(points: list[Point]) -> list[float]:
        return [(p.x[0] - 0.3) ** 2 for p in points]

    for search, limit in (
        (GoldenSection(LINE, golden_points(0.01)), 0.01),
        (FibonacciSearch(LINE, 12), 2 * 2 / 377),
    ):
        assert abs(minimize(search, cost).point.x[0] - 0.3) <= 2 * limit
    assert golden_points(0.01) == 11
    assert fibonacci_points(0.01) == 10


def test_the_last_interval_of_a_fibonacci_search_is_two_of_its_smallest_parts() -> None:
    said: list[str] = []

    class Listener(Observer):
        def summary(self, lines: Sequence[str]) -> None:
            said.extend(lines)

    search = FibonacciSearch(LINE, fibonacci_points(0.01), observer=Listener())
    minimize(search, lambda points: [(p.x[0] - 0.3) ** 2 for p in points])
    assert float(said[-1].split(": ")[1]) == pytest.approx(2 / 144, rel=1e-9)


def test_a_line_without_effect_is_an_error() -> None:
    with pytest.raises(SolverError, match="Nullspace"):
        minimize(GoldenSection(LINE, 20), lambda points: [1.0] * len(points))


def test_grids_vary_the_first_parameter_fastest() -> None:
    space = Space(
        (Continuous("a", 0, 2, 0, 1), Continuous("b", 1, -2, 1, 100), Continuous("c", 7, 0, 0, 9)),
        (Discrete("n", 1, 2),),
    )
    points = Grid(space).ask()
    assert [p.x[0] for p in points[:4]] == [0.0, 0.5, 1.0, 0.0]
    assert [round(p.x[1], 9) for p in points[::3][:3]] == [1.0, 10.0, 100.0]
    assert {p.x[2] for p in points} == {7.0}
    assert [p.choices[0] for p in points] == [0] * 9 + [1] * 9
    single = OneAtATime(space).ask()
    assert len(single) == 3 + 3 + 2 - 2  # the initial point is on all three lines


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: NelderMead(LINE), "at least two"),
        (lambda: NelderMead(MIXED), "only have continuous"),
        (lambda: GoldenSection(PLANE, 9), "one continuous parameter"),
        (lambda: ParticleSwarm(Space((Continuous("a", 0, 1),))), "lower and upper bounds"),
        (lambda: SwarmRules(topology="vonNewmann"), "not known"),  # type: ignore[arg-type]
        (lambda: Space((Continuous("a", 0, 1, 2, 1),)), "exchange them"),
        (lambda: Space((), (Discrete("n", 3, 3),)), "outside 0..2"),
    ],
)
def test_what_cannot_work_is_refused(make: object, message: str) -> None:
    assert callable(make)
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)


def test_random_numbers_are_those_of_java() -> None:
    random = Lcg48(1)
    first = [random.uniform() for _ in range(3)]
    assert first == pytest.approx([0.7308781907032909, 0.41008081149220166, 0.20771484130971707], rel=1e-15)
    random = Lcg48(1)
    for bound in (8, 10):
        assert {random.below(bound) for _ in range(400)} == set(range(bound))
