"""The result of a calibration: text, tables, figures, pickling."""

from __future__ import annotations

import io
import pickle
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mascarin.calibration import (
    Calibration,
    CalibrationProblem,
    FitParameter,
    FitSensor,
    SearchOptions,
    plot_profiles,
    profiles,
    solve,
)
from mascarin.errors import InputError
from mascarin.figures import calibration as figures

TIME = np.linspace(0.0, 3.0, 40)


def decay(x: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray((x[:, 1:] * np.exp(-x[:, :1] * TIME))[:, :, None])


@pytest.fixture(scope="module")
def fit() -> Calibration:
    measured = 2.0 * np.exp(-0.8 * TIME) + 0.02 * np.random.default_rng(1).normal(size=TIME.size)
    problem = CalibrationProblem(
        (FitParameter("rate", 0.0, 4.0, nominal=2.0, unit="1/h"), FitParameter("size", 0.1, 5.0)),
        (FitSensor("s", measured, 0.02),),
        decay,
    )
    return solve(problem, method="hooke-jeeves", options=SearchOptions(agree=3, sequences=6))


# --- text and tables ------------------------------------------------------------------------------------


def test_the_text_is_short_and_has_the_estimates(fit: Calibration) -> None:
    lines = repr(fit).splitlines()
    assert len(lines) <= 15
    assert lines[0] == "Calibration of 2 parameters by hooke-jeeves"
    assert any(line.split()[0] == "rate" and line.endswith("1/h") for line in lines)
    page = fit._repr_html_()
    assert "<details><summary>Correlations</summary>" in page


def test_the_table_has_estimates_errors_and_correlations(fit: Calibration) -> None:
    table = fit.to_dataframe()
    assert table.loc["rate", "estimate"] == fit.x[0]
    assert table.loc["rate", "nominal"] == 2.0
    assert table["nominal"].isna().tolist() == [False, True]
    # In units of the parameter, not in ranges: the range of the rate is 4 1/h wide.
    assert table.loc["rate", "standard_error"] == pytest.approx(4.0 * fit.uncertainty.sd[0])
    assert table.loc["rate", "correlation"] == fit.correlation[0, 1]
    assert fit.correlations().loc["size", "rate"] == fit.correlation[1, 0]


def test_a_calibration_of_one_parameter_has_no_correlation() -> None:
    problem = CalibrationProblem(
        (FitParameter("level", 0.0, 9.0),),
        (FitSensor("s", np.array([4.0, 5.0, 6.0]), 0.1),),
        lambda x: np.tile(x[:, :, None], (1, 3, 1)),
    )
    row = solve(problem).to_dataframe().iloc[0]
    assert np.isnan(row["correlation"])
    assert row["correlated_with"] == ""


def test_standard_errors_on_a_log_scale_are_in_the_unit() -> None:
    noise = 0.02 * np.random.default_rng(1).normal(size=TIME.size)
    found = {}
    for scale in ("linear", "log"):
        problem = CalibrationProblem(
            (FitParameter("rate", 0.2, 4.0, scale=scale), FitParameter("size", 0.1, 5.0)),
            (FitSensor("s", 2.0 * np.exp(-0.8 * TIME) + noise, 0.02),),
            decay,
        )
        found[scale] = solve(problem, options=SearchOptions(starts=1)).standard_error
    np.testing.assert_allclose(found["log"], found["linear"], rtol=1e-3)


def test_a_calibration_is_pickled_with_its_problem(fit: Calibration) -> None:
    again = pickle.loads(pickle.dumps(fit))  # noqa: S301 (our own bytes)
    np.testing.assert_array_equal(again.x, fit.x)
    assert repr(again) == repr(fit)
    np.testing.assert_array_equal(again.problem.residuals(fit.x[None]), fit.problem.residuals(fit.x[None]))


def test_a_problem_on_arrays_has_no_building(fit: Calibration) -> None:
    with pytest.raises(InputError, match="was made by solve"):
        _ = fit.building


def test_only_public_names_are_offered() -> None:
    import mascarin.calibration as package

    assert dir(package) == sorted(package.__all__)


def test_the_text_names_estimates_on_a_bound(fit: Calibration) -> None:
    measured = 2.0 * np.exp(-0.8 * TIME)
    problem = CalibrationProblem(
        # The best rate, 0.8, is below the range.
        (FitParameter("rate", 1.0, 4.0), FitParameter("size", 0.1, 5.0)),
        (FitSensor("s", measured, 0.02),),
        decay,
    )
    found = solve(problem, options=SearchOptions(starts=1))
    assert list(found.on_bound) == ["rate"]
    assert "  on a bound  rate; see .on_bound" in repr(found).splitlines()
    assert "on a bound" in found._repr_html_()
    assert "on a bound" not in repr(fit)


# --- figures --------------------------------------------------------------------------------------------


def test_a_panel_for_each_profile(fit: Calibration) -> None:
    found = profiles(fit)
    drawn = [axes for axes in plot_profiles(found, columns=3).axes if axes.get_visible()]
    assert [axes.get_title(loc="left") for axes in drawn] == ["rate", "size"]
    np.testing.assert_array_equal(drawn[0].lines[0].get_ydata(), found[0].rise)
    assert drawn[0].get_xlabel() == "[1/h]"
    with pytest.raises(InputError, match="no profile to draw"):
        plot_profiles([])


def test_convergence_ends_at_the_lowest_cost(fit: Calibration) -> None:
    axes = fit.plot("convergence", ax=Figure().subplots())
    number, lowest = (np.asarray(d, dtype=float) for d in axes.lines[1].get_data())
    assert (number[0], number[-1]) == (1, fit.trace.cost.size)
    assert np.all(np.diff(lowest[:-1]) < 0.0)
    assert lowest[-1] == lowest[-2] < 1e-6 * lowest[0]


def test_many_evaluations_are_drawn_as_pixels(fit: Calibration, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not fit.plot("convergence", ax=Figure().subplots()).lines[0].get_rasterized()
    monkeypatch.setattr(figures, "MAX_DOTS", 10)
    figure = Figure()
    assert fit.plot("convergence", ax=figure.subplots()).lines[0].get_rasterized()
    drawn = io.StringIO()
    figure.savefig(drawn, format="svg")
    assert "data:image/png" in drawn.getvalue()


def test_searches_of_equal_cost_are_drawn(fit: Calibration) -> None:
    """Equal but for rounding: no bins fit between them."""
    same = tuple(replace(fit.minima[0], cost=cost) for cost in (2.0, np.nextafter(2.0, 3.0), 2.0))
    counts, edges = replace(fit, minima=same).histogram()
    assert counts.sum() == 3
    assert edges[0] == 2.0 < edges[-1] < 2.0 + 1e-8


def test_all_searches_are_in_the_histogram(fit: Calibration) -> None:
    axes = fit.plot("minima", ax=Figure().subplots())
    assert sum(bar.get_height() for bar in axes.patches) == len(fit.minima)  # type: ignore[attr-defined]
    assert f"{len(fit.minima)} searches, {len(fit.distinct_minima())} distinct minima" in axes.get_title(
        loc="left"
    )


def test_estimates_are_drawn_within_their_ranges(fit: Calibration) -> None:
    axes = fit.plot(ax=Figure().subplots())
    drawn = np.asarray(axes.lines[0].get_xdata(), dtype=float)
    np.testing.assert_allclose(drawn, fit.problem.positions(fit.x))
    nominal = next(line for line in axes.lines if line.get_label() == "nominal")
    assert np.asarray(nominal.get_xdata(), dtype=float)[0] == pytest.approx(0.5)
    assert np.isnan(np.asarray(nominal.get_xdata(), dtype=float)[1])


def test_residuals_and_correlations_are_drawn(fit: Calibration) -> None:
    axes = fit.plot("residuals", ax=Figure().subplots())
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), fit.residuals[:, 0])
    assert axes.get_xlabel() == "sample"
    shown = fit.plot("correlation", ax=Figure().subplots())
    assert [text.get_text() for text in shown.texts][1] == f"{fit.correlation[0, 1]:.2f}"
    with pytest.raises(InputError, match="Did you mean 'minima'"):
        fit.plot("minimum")  # type: ignore[arg-type]
