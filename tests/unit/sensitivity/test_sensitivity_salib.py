"""SALib's methods: known indices, time series, groups, seeds, errors."""

from __future__ import annotations

import builtins
import math
import pickle
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.errors import InputError
from mascarin.sensitivity import METHODS, Factor, Sensitivity, collector, plan, run
from mascarin.sensitivity.salib import SQUARES, MorrisSensitivity, SalibPlan
from mascarin.sensitivity.salib.estimators import elementary_effects
from mascarin.sensitivity.spectral import SpectralSensitivity

Floats = NDArray[np.float64]

ISHIGAMI = [Factor(f"x{k}", -math.pi, math.pi) for k in (1, 2, 3)]
FIRST, TOTAL = (0.3139, 0.4424, 0.0), (0.5576, 0.4424, 0.2437)


def ishigami(x: Floats) -> Floats:
    s = np.sin(x)
    return np.asarray(s[:, 0] + 7.0 * s[:, 1] ** 2 + 0.1 * x[:, 2] ** 4 * s[:, 0])[:, None, None]


def made(method: Any, model: Any, factors: list[Factor], **keywords: Any) -> Sensitivity:
    return run(plan(factors, method, **keywords), model, outputs=["y"], units=["K"])


def test_first_order_indices_of_ishigami() -> None:
    for method, size, within in (("rbd-fast", 1024, 0.02), ("sobol", 512, 0.02)):
        found = made(method, ishigami, ISHIGAMI, samples=size)
        assert found.index[:, 0] == pytest.approx(FIRST, abs=within)
        assert found.significant[:, 0].tolist() == [True, True, False]
        assert np.all((found.low <= found.index) & (found.index <= found.high))
        assert found.method == method
        assert found.runs == 8 * size * (5 if method == "sobol" else 1)


def test_only_sobol_gives_total_indices() -> None:
    found = made("sobol", ishigami, ISHIGAMI, samples=512)
    assert found.total is not None
    assert found.total_low is not None
    assert found.total_high is not None
    assert found.total[:, 0] == pytest.approx(TOTAL, abs=0.02)
    assert np.all((found.total_low <= found.total) & (found.total <= found.total_high))
    assert {"total", "total_low", "total_high"} <= set(found.to_dict()["y"]["x1"])
    assert {"total", "total_low", "total_high"} <= set(found.table().columns)
    assert made("morris", ishigami, ISHIGAMI).total is None


def test_morris_is_exact_on_a_linear_model() -> None:
    slope = np.array([2.0, -1.0, 0.5])
    factors = [Factor("a", 0.0, 1.0), Factor("b", 10.0, 12.0), Factor("c", -1.0, 1.0)]
    found = made("morris", lambda x: (x @ slope)[:, None, None], factors)
    effect = slope * [1.0, 2.0, 2.0]
    assert found.effect[:, 0] == pytest.approx(effect, rel=1e-9)
    assert found.index[:, 0] == pytest.approx(effect**2 / np.sum(effect**2), rel=1e-9)
    assert found.high[:, 0] == pytest.approx(found.low[:, 0], abs=1e-9)
    assert found.measure == SQUARES


@pytest.mark.parametrize("method", METHODS)
def test_effects_are_signed_and_over_the_range(method: Any) -> None:
    factors = [Factor("up", 0.0, 2.0, "W"), Factor("down", 0.1, 10.0, "m", "log-uniform")]
    found = made(method, lambda x: (3.0 * x[:, 0] - x[:, 1])[:, None, None], factors)
    assert found.effect[0, 0] == pytest.approx(6.0, rel=0.05)
    # The curve of a Morris trajectory spans the range; the others regress on the values.
    assert found.effect[1, 0] == pytest.approx(-9.9, rel=0.35)


@pytest.mark.parametrize("method", METHODS)
def test_the_index_of_a_time_series_is_that_of_the_sum_over_time(method: Any) -> None:
    wave = np.sin(np.arange(24) * math.pi / 12.0)

    def series(x: Floats) -> Floats:
        first, second = 2.0 * np.outer(x[:, 0], wave), np.outer(x[:, 1], 1.0 - wave)
        return np.stack([first + second, first * 0.0 + 5.0], axis=2)

    factors = [Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0), Factor("inactive", 0.0, 1.0)]
    found = run(plan(factors, method), series, outputs=["y", "still"], units=["K", "K"])
    a, b = 4.0 * float(wave @ wave), float((1.0 - wave) @ (1.0 - wave))
    assert found.index[:, 0] == pytest.approx([a / (a + b), b / (a + b), 0.0], abs=0.03)
    assert found.index[:, 1].tolist() == [0.0, 0.0, 0.0]
    assert found.warnings == ("'still' does not depend on any of the varied parameters",)
    assert not found.significant[2].any()


@pytest.mark.parametrize("method", ["spectral", "sobol", "morris"])
def test_groups_are_analyzed_together(method: Any) -> None:
    factors = [
        Factor("a", 0.0, 1.0, group="pair"), Factor("b", 0.0, 1.0), Factor("c", 0.0, 1.0, group="pair"),
    ]  # fmt: skip
    keywords = {"samples": 256} if method == "sobol" else {}
    found = made(method, lambda x: (x[:, 0] + 2.0 * x[:, 1] + x[:, 2])[:, None, None], factors, **keywords)
    assert found.names == ("pair", "b")
    assert math.isnan(found.effect[0, 0])
    assert found.effect[1, 0] == pytest.approx(2.0, rel=0.1)
    # Morris moves a group's members up or down at once: (1 + 1)^2 or 0, on average 2.
    assert found.index[:, 0] == pytest.approx(
        [1.0 / 3.0, 2.0 / 3.0], abs=0.12 if method == "morris" else 0.04
    )


@pytest.mark.parametrize("method", METHODS)
def test_the_seed_determines_the_result_and_numpys_state_is_unchanged(method: Any) -> None:
    state = str(np.random.get_state(legacy=False))  # noqa: NPY002 (the state that must not move)
    drawn = np.random.get_state(legacy=False)["state"]["key"].copy()  # noqa: NPY002
    one, two, other = (made(method, ishigami, ISHIGAMI, seed=seed) for seed in (0, 0, 1))
    assert np.array_equal(one.index, two.index)
    assert np.array_equal(one.low, two.low)
    assert not np.array_equal(one.index, other.index)
    assert str(np.random.get_state(legacy=False)) == state  # noqa: NPY002
    assert np.array_equal(np.random.get_state(legacy=False)["state"]["key"], drawn)  # noqa: NPY002


def test_order_of_the_outputs_does_not_matter() -> None:
    runs = plan(ISHIGAMI, "rbd-fast", replicates=3)
    assert isinstance(runs, SalibPlan)
    forth, back = collector(runs, ["y"]), collector(runs, ["y"])
    pieces = [(r * runs.runs, ishigami(runs.samples(r))) for r in range(3)]
    for first, y in pieces:
        forth.add(first, y)
    for first, y in reversed(pieces):
        back.add(first, y)
    assert np.array_equal(forth.result().index, back.result().index)


@pytest.mark.parametrize(
    ("method", "keywords", "text"),
    [
        ("rbd-fst", {}, "Did you mean 'rbd-fast'"),
        ("sobol", {"samples": 100}, "expected a power of 2"),
        ("sobol", {"order": 4}, "has no harmonics"),
        ("rbd-fast", {"samples": 64}, "expected more than 4 M\\^2 = 64"),
        ("morris", {"replicates": 2}, "expected at least 3"),
        ("morris", {"samples": 1}, "expected at least 2"),
    ],
)
def test_errors_of_options(method: Any, keywords: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        plan(ISHIGAMI, method, **keywords)


def test_groups_are_an_error_for_rbd_fast() -> None:
    factors = [Factor("a", 0.0, 1.0, group="g"), Factor("b", 0.0, 1.0, group="g"), Factor("c", 0.0, 1.0)]
    with pytest.raises(InputError, match="analyzes single parameters"):
        plan(factors, "rbd-fast")


def test_a_distribution_that_is_not_finite_is_an_error() -> None:
    from scipy.special import ndtri

    factors = [Factor("endless", 0.0, 1.0, distribution=ndtri), Factor("b", 0.0, 1.0)]
    with pytest.raises(InputError, match="endless: found the value"):
        plan(factors, "morris").samples(0)


def test_without_salib_the_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    original = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name.startswith("SALib"):
            raise ImportError(name)
        return original(name, *rest)

    import importlib

    def none(name: str) -> Any:
        return without(name)

    monkeypatch.setattr(importlib, "import_module", none)
    with pytest.raises(InputError, match=r"pip install 'mascarin\[sensitivity\]'"):
        plan(ISHIGAMI, "sobol")


def test_plan_makes_the_spectral_method_too() -> None:
    assert isinstance(made("spectral", ishigami, ISHIGAMI), SpectralSensitivity)


def test_morris_gives_the_statistics_of_salib() -> None:
    """One replicate of all trajectories, analyzed by SALib itself."""
    from SALib.analyze import morris

    runs = plan(ISHIGAMI, "morris", replicates=5, samples=6)
    assert isinstance(runs, SalibPlan)
    found = run(runs, ishigami, outputs=["y"])
    assert isinstance(found, MorrisSensitivity)
    u = np.concatenate([runs.unit_samples(r) for r in range(5)])
    y = np.concatenate([ishigami(runs.samples(r))[:, 0, 0] for r in range(5)])
    expected = morris.analyze(runs.problem, u, y, num_levels=4, seed=1)
    for name in ("mu", "mu_star", "sigma"):
        assert getattr(found, name)[:, 0] == pytest.approx(
            np.asarray(expected[name], dtype=float), rel=1e-9
        ), name
    table = found.to_dataframe()
    assert list(table.columns[:6]) == ["output", "parameter", "mu", "mu_star", "sigma", "mu_star_conf"]
    assert found.first_order is None
    assert "S1" not in table


def test_elementary_effects_of_groups_are_those_of_salib() -> None:
    from SALib.analyze import morris

    groups = ["pair", None, "pair", "three", "three", "three"]
    factors = [Factor(f"x{i}", 0.0, 1.0, group=group) for i, group in enumerate(groups)]
    runs = plan(factors, "morris", samples=5)
    assert isinstance(runs, SalibPlan)
    u, x = runs.unit_samples(1), runs.samples(1)
    y = np.column_stack([np.sin(x @ np.arange(1.0, 7.0)), x[:, 1] ** 2 - x[:, 0]])
    effects = elementary_effects(u, y, runs.group_of)
    assert effects.shape == (len(runs.groups), 5, 2)
    single = runs.groups.index("x1")
    for k in range(2):
        expected = morris.analyze(runs.problem, u, y[:, k], num_levels=4, seed=1)
        size = np.asarray(expected["mu_star"], dtype=float)
        assert np.abs(effects[:, :, k]).mean(axis=1) == pytest.approx(size, rel=1e-12)
        assert effects[single, :, k].mean() == pytest.approx(float(expected["mu"][single]), rel=1e-12)
        assert effects[single, :, k].std(ddof=1) == pytest.approx(float(expected["sigma"][single]), rel=1e-12)


def test_tables_have_the_columns_of_salib() -> None:
    found = made("sobol", ishigami, ISHIGAMI, samples=128)
    table = found.to_dataframe()
    assert list(table.columns[:6]) == ["output", "parameter", "S1", "S1_conf", "ST", "ST_conf"]
    assert table["parameter"].tolist() == found.ranking("y")
    row = table.set_index("parameter").loc["x1"]
    assert row["S1"] == found.index[0, 0]
    assert row["S1_conf"] == pytest.approx(0.5 * (row["S1_high"] - row["S1_low"]))
    arrays = found.to_xarray()
    assert arrays["ST"].sel(parameter="x3", output="y").item() == found.total[2, 0]  # type: ignore[index]


@pytest.mark.parametrize("method", METHODS)
def test_results_are_short_in_print_and_can_be_pickled(method: Any) -> None:
    factors = [Factor(f"x{k}", 0.0, 1.0) for k in range(12)]
    names = [f"room {k}.air_temperature" for k in range(5)]
    found = run(plan(factors, method), lambda x: x[:, None, :5] + x[:, None, 5:10], outputs=names)
    assert len(repr(found).splitlines()) <= 15
    assert method in repr(found)
    shown = found._repr_html_()
    assert "<svg" in shown
    # Five factors of each output: the rows of the second and later ones have no empty head (axe).
    assert "room 0.air_temperature</th>" in shown
    assert "'></th>" not in shown
    assert np.array_equal(pickle.loads(pickle.dumps(found)).index, found.index)  # noqa: S301 (written here)
