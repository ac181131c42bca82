"""The spectral method against models whose indices are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.base.factors import Factor
from mascarin.sensitivity.base.runs import batches
from mascarin.sensitivity.methods import run
from mascarin.sensitivity.spectral import SpectralCollector, analyze, design

Floats = NDArray[np.float64]

ISHIGAMI_A, ISHIGAMI_B = 7.0, 0.1
ISHIGAMI = (0.31391, 0.44241, 0.0)  # first-order indices


def ishigami(x: Floats) -> Floats:
    s = np.sin(x)
    return np.asarray(s[:, 0] + ISHIGAMI_A * s[:, 1] ** 2 + ISHIGAMI_B * x[:, 2] ** 4 * s[:, 0])


def ishigami_factors() -> list[Factor]:
    return [Factor(name, -math.pi, math.pi) for name in ("a", "b", "c")]


def sines(count: int) -> list[Factor]:
    return [Factor(f"p{k}", -1.0, 1.0, distribution="sine") for k in range(count)]


def test_linear_model_gives_squared_standardized_coefficients_exactly() -> None:
    rng = np.random.default_rng(1)
    low = rng.normal(0.0, 5.0, 30)
    span = rng.uniform(0.5, 4.0, 30)
    slope = rng.normal(0.0, 1.0, (30, 5)) * rng.exponential(1.0, (30, 1)) ** 2
    factors = [Factor(f"p{k}", low[k], low[k] + span[k], distribution="sine") for k in range(30)]
    plan = design(factors, order=1, seed=2)
    assert plan.runs == 2 * 32 + 1
    result = analyze(plan, (7.0 + plan.all_samples() @ slope)[:, :, None])
    part = (slope * span[:, None]) ** 2  # the variance of a sine is a eighth of its squared range
    np.testing.assert_allclose(result.index_t[:, :, 0], part / part.sum(axis=0), rtol=0, atol=1e-12)
    np.testing.assert_allclose(result.index[:, 0], part.sum(axis=1) / part.sum(), rtol=0, atol=1e-12)
    np.testing.assert_allclose(result.raw_index, result.index, rtol=0, atol=1e-12)
    np.testing.assert_allclose(result.high, result.low, rtol=0, atol=1e-9)
    np.testing.assert_allclose(result.effect_t[:, :, 0], slope * span[:, None], rtol=0, atol=1e-10)
    np.testing.assert_allclose(result.variance_t[:, 0], part.sum(axis=0) / 8.0, rtol=1e-12)
    np.testing.assert_allclose(result.interactions, 0.0, atol=1e-12)


def test_uniform_curve_keeps_all_but_a_seventieth_in_the_fundamental() -> None:
    slope = np.array([3.0, -2.0, 0.5])
    factors = [Factor(f"p{k}", 1.0, 2.0) for k in range(3)]
    expected = slope**2 / np.sum(slope**2)
    for order, kept in ((1, 96.0 / math.pi**4), (3, 96.0 / math.pi**4 * (1.0 + 1.0 / 81.0))):
        plan = design(factors, order=order, runs=1001, frequencies=[11, 21, 31], replicates=16)
        result = analyze(plan, plan.all_samples() @ slope)
        np.testing.assert_allclose(result.index[:, 0], kept * expected, rtol=2e-4)
        np.testing.assert_allclose(result.effect[:, 0], slope, rtol=2e-3)


@pytest.mark.parametrize("distribution", ["log-uniform", "triangular", "normal", "uniform", "sine"])
def test_samples_follow_their_distribution(distribution: str) -> None:
    factor = Factor("p", 1.0, 10.0, distribution=distribution)  # type: ignore[arg-type]
    angle = 2.0 * np.pi * np.arange(100_001) / 100_001
    along = np.sort(factor.curve(angle))
    u = (np.arange(along.size) + 0.5) / along.size
    np.testing.assert_allclose(along, factor.quantile(u), atol=1e-3)
    moments = {
        "uniform": (5.5, 9.0**2 / 12.0),
        "sine": (5.5, 9.0**2 / 8.0),
        "triangular": (5.5, 9.0**2 / 24.0),
        "log-uniform": (9.0 / math.log(10.0), 99.0 / (2.0 * math.log(10.0)) - (9.0 / math.log(10.0)) ** 2),
        # A normal distribution cut at three standard deviations keeps 97.33 % of its variance.
        "normal": (5.5, 0.97334 * (9.0 / (2.0 * 1.959964)) ** 2),
    }
    mean, variance = moments[distribution]
    assert along.mean() == pytest.approx(mean, abs=1e-3)
    assert along.var() == pytest.approx(variance, rel=1e-3)


def test_inverse_distribution_function_of_the_user() -> None:
    factor = Factor("p", 0.0, 4.0, distribution=lambda u: 4.0 * u**2)
    np.testing.assert_allclose(factor.curve(np.array([0.0, np.pi / 2.0])), [1.0, 4.0])


def test_ishigami() -> None:
    plan = design(ishigami_factors(), order=8, replicates=16, seed=1)
    result = analyze(plan, ishigami(plan.all_samples()))
    np.testing.assert_allclose(result.index[:, 0], ISHIGAMI, atol=0.02)
    assert np.all(result.low[:, 0] <= np.array(ISHIGAMI))
    assert np.all(result.high[:, 0] >= np.array(ISHIGAMI) - 1e-4)
    assert np.all(result.high[:2, 0] - result.low[:2, 0] < 0.06)
    assert result.significant[:, 0].tolist() == [True, True, False]
    assert result.variance_t[0, 0] == pytest.approx(13.8446, rel=0.02)
    assert result.interactions[0] == pytest.approx(1.0 - sum(ISHIGAMI), abs=0.03)


def test_g_function_and_coverage_over_seeds() -> None:
    a = np.array([0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0])

    def g(u: Floats) -> Floats:
        return np.asarray(np.prod((np.abs(4.0 * u - 2.0) + a) / (1.0 + a), axis=1))

    part = 1.0 / 3.0 / (1.0 + a) ** 2
    first = part / (np.prod(1.0 + part) - 1.0)
    # |4 u - 2| varies at twice the frequency: of its variance harmonics 2 and 6 hold this much.
    expected = first * 96.0 / math.pi**4 * (1.0 + 1.0 / 81.0)
    inside, indices = np.zeros(8), np.zeros(8)
    for seed in range(60):
        plan = design(8, order=6, seed=seed)
        result = analyze(plan, g(plan.all_samples()))
        inside += (result.low[:, 0] <= expected) & (expected <= result.high[:, 0])
        indices += result.index[:, 0]
    np.testing.assert_allclose(indices / 60, expected, atol=0.003)
    assert np.all(inside >= 54)  # 95 % of 60, less two and a half standard deviations


def test_harmonics_on_the_lines_of_others_are_not_counted() -> None:
    # With w_i = i the second harmonic of every parameter falls on another one. Only p3 acts, squared.
    plan = design(sines(8), order=2, frequencies=range(1, 9), seed=4)
    result = analyze(plan, plan.all_samples()[:, 3] ** 2)
    assert result.index[3, 0] == pytest.approx(1.0)
    others = np.delete(np.arange(8), 3)
    assert np.all(result.low[others, 0] == 0.0)
    assert np.all(result.index[others, 0] < 0.05)
    assert np.max(result.raw_index[others, 0]) > 0.05


def test_estimates_are_unbiased_where_lines_are_crowded() -> None:
    # 20 parameters with all their interactions, every line taken many times over.
    rng = np.random.default_rng(5)
    slope = rng.exponential(1.0, 20) ** 2
    cross = np.triu(np.sqrt(np.outer(slope, slope)), 1)
    expected = slope**2 / 8.0
    expected = expected / (expected.sum() + np.sum(cross**2) / 64.0)
    indices = np.zeros(20)
    for seed in range(30):
        plan = design(
            [Factor(f"p{k}", -0.5, 0.5, distribution="sine") for k in range(20)], order=1, seed=seed
        )
        x = plan.all_samples()
        y = x @ slope + np.einsum("ni,ij,nj->n", x, cross, x)
        indices += analyze(plan, y).index[:, 0]
    np.testing.assert_allclose(indices / 30, expected, atol=0.004)


def test_noise_stays_below_the_threshold_and_is_not_significant() -> None:
    rng = np.random.default_rng(6)
    exceeded = significant = 0
    for seed in range(150):
        plan = design(12, order=2, replicates=4, seed=seed)
        result = analyze(plan, rng.normal(size=len(plan)))
        exceeded += bool(np.any(result.raw_index > result.threshold))
        significant += bool(np.any(result.significant))
        assert result.raw_index.mean() == pytest.approx(2.0 / ((plan.runs - 1) // 2), rel=0.4)
    assert 1 <= exceeded <= 16  # 5 % of 150, give or take
    assert significant <= 3


def test_any_order_of_batches_gives_the_same_bits() -> None:
    plan = design(ishigami_factors(), replicates=3, seed=7)
    y = np.stack([ishigami(plan.all_samples()), plan.all_samples()[:, 2]], axis=1)[:, None, :]
    whole = analyze(plan, y, names=["f", "c"])
    accumulator = SpectralCollector(plan, ["f", "c"])
    pieces = [(first, y[first : first + x.shape[0]]) for first, x in batches(plan, 50)]
    for first, values in pieces[::-1]:
        accumulator.add(first, values)
    assert accumulator.missing == 0
    np.testing.assert_array_equal(accumulator.result().index, whole.index)
    np.testing.assert_array_equal(accumulator.result().high_t, whole.high_t)


def test_runs_are_made_in_batches_with_progress() -> None:
    plan = design(ishigami_factors(), replicates=3, seed=7)
    seen: list[tuple[int, int]] = []
    sizes: list[int] = []

    def evaluate(x: Floats) -> Floats:
        sizes.append(x.shape[0])
        return ishigami(x)[:, None, None]

    def progress(done: int, total: int) -> None:
        seen.append((done, total))

    result = run(plan, evaluate, outputs=["f"], units=["degC"], batch=100, progress=progress)
    assert max(sizes) == 100
    assert seen[-1] == (len(plan), len(plan))
    np.testing.assert_array_equal(result.index, analyze(plan, ishigami(plan.all_samples())).index)


def test_indices_over_the_day() -> None:
    plan = design(sines(2), order=1, seed=8)
    hour = np.arange(24)
    sun = np.maximum(0.0, np.sin((hour - 6) / 12 * np.pi))
    x = plan.all_samples()
    y = x[:, :1] * sun + 0.5 * x[:, 1:]
    y[:, 3] = 20.0  # before anything has happened nothing varies
    result = analyze(plan, y[:, :, None], names=["room"], units=["degC"])
    night = [0, 22]
    np.testing.assert_allclose(result.index_t[0, night, 0], 0.0, atol=1e-12)
    assert result.index_t[0, 12, 0] == pytest.approx(0.8)
    assert np.all(np.isnan(result.index_t[:, 3, 0]))
    assert np.isfinite(result.index).all()
    assert result.units == ("degC",)


def test_an_output_that_no_parameter_changes_is_reported() -> None:
    plan = design(3, replicates=3)
    result = analyze(plan, np.full((len(plan), 4, 1), 21.3), names=["constant"])
    assert np.all(result.index == 0.0)
    assert not result.significant.any()
    assert result.warnings == ("'constant' does not depend on any of the varied parameters",)


def test_index_of_a_group_is_that_of_its_members() -> None:
    slope = np.array([1.0, -1.0, 0.5, 1.5, -0.7])
    factors = [
        Factor("a", -1, 1, distribution="sine", group="coefficients"),
        Factor("b", -1, 1, distribution="sine", group="coefficients"),
        Factor("c", -1, 1, distribution="sine", group="coefficients"),
        Factor("d", -1, 1, distribution="sine"),
        Factor("e", -1, 1, distribution="sine"),
    ]
    plan = design(factors, seed=9)
    assert plan.groups == ("coefficients", "d", "e")
    result = analyze(plan, plan.all_samples() @ slope)
    expected = np.array([2.25, 2.25, 0.49]) / 4.99
    np.testing.assert_allclose(result.index[:, 0], expected, atol=0.05)
    assert np.all((result.low[:, 0] <= expected + 1e-9) & (expected <= result.high[:, 0] + 1e-9))
    assert math.isnan(result.effect[0, 0])
    assert result.effect[2, 0] == pytest.approx(-1.4, rel=0.2)


def test_same_seed_same_design_and_frequencies_never_collide() -> None:
    one, two, other = design(60, seed=3), design(60, seed=3), design(60, seed=4)
    np.testing.assert_array_equal(one.all_samples(), two.all_samples())
    assert not np.array_equal(one.frequencies, other.frequencies)
    assert one.order == 2
    assert one.runs == 2 * 2 * 60 + 1
    for row in one.frequencies:
        assert np.unique(row).size == 60


def test_result_as_dictionary_and_table() -> None:
    plan = design(ishigami_factors(), order=8, seed=1)
    result = analyze(plan, ishigami(plan.all_samples()), names=["room"], units=["degC"])
    entry = result.to_dict()["room"]["b"]
    assert set(entry) == {"share", "low", "high", "effect"}
    assert entry["low"] is not None
    assert entry["share"] is not None
    assert entry["low"] < entry["share"]
    table = result.table()
    assert table["parameter"].tolist() == ["b", "a", "c"]
    assert table["unit"].tolist() == ["degC"] * 3
    assert result.ranking("room", 1) == ["b"]
    assert result.influential() == ["b", "a"]
    assert result.influential(minimum=0.4) == ["b"]
    with pytest.raises(InputError, match="Did you mean 'room'"):
        result.ranking("rom")


@pytest.mark.parametrize(
    ("keywords", "text"),
    [
        ({"factors": 0}, "at least one parameter"),
        ({"factors": 3, "replicates": 2}, "at least 3"),
        ({"factors": 3, "order": 0}, "at least 1 harmonic"),
        ({"factors": 100, "order": 2, "runs": 300}, r"needs 401 \(2 M w_max \+ 1\)"),
        ({"factors": 3, "frequencies": [1, 2, 2]}, "distinct positive"),
        ({"factors": [Factor("a", 0, 1), Factor("a", 0, 2)]}, "'a' is listed twice"),
        ({"factors": [Factor("a", 0, 1), Factor("b", 0, 2, group="a")]}, "rename the group"),
    ],
)
def test_errors_of_designs(keywords: dict[str, object], text: str) -> None:
    with pytest.raises(InputError, match=text):
        design(**keywords)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("low", "high", "distribution", "text"),
    [
        (1.0, 1.0, "uniform", "larger finite high"),
        (0.0, math.nan, "uniform", "larger finite high"),
        (0.0, 1.0, "log-uniform", "must be positive"),
        (0.0, 1.0, "gauss", "is none of uniform"),
    ],
)
def test_errors_of_factors(low: float, high: float, distribution: str, text: str) -> None:
    with pytest.raises(InputError, match=text):
        Factor("p", low, high, distribution=distribution)  # type: ignore[arg-type]


def test_errors_of_outputs() -> None:
    plan = design(3, replicates=3)
    accumulator = SpectralCollector(plan, ["f"])
    y = np.zeros((10, 4, 1))
    accumulator.add(0, y)
    with pytest.raises(InputError, match="run 5 was added before"):
        accumulator.add(5, y)
    with pytest.raises(InputError, match="at 3 times, expected 4"):
        accumulator.add(20, y[:, :3])
    with pytest.raises(InputError, match="expected runs 0 to"):
        accumulator.add(len(plan) - 5, y)
    y[2, 1] = math.nan
    with pytest.raises(InputError, match="run 22: 'f' is not a finite number at time 1"):
        accumulator.add(20, y)
    with pytest.raises(InputError, match="have not been added"):
        accumulator.result()
