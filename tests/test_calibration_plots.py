"""Figures of a calibration show its numbers."""

from __future__ import annotations

import io

import numpy as np
import pytest

from mascarin.calibration import (
    CalibrationProblem,
    Fit,
    FitParameter,
    FitSensor,
    Rules,
    plots,
    profiles,
    solve,
)
from mascarin.errors import InputError

TIME = np.linspace(0.0, 3.0, 40)


@pytest.fixture(scope="module")
def fit() -> Fit:
    measured = 2.0 * np.exp(-0.8 * TIME) + 0.02 * np.random.default_rng(1).normal(size=TIME.size)
    problem = CalibrationProblem(
        (FitParameter("rate", 0.0, 4.0, unit="1/h"), FitParameter("size", 0.1, 5.0)),
        (FitSensor("s", measured, 0.02),),
        lambda x: (x[:, 1:] * np.exp(-x[:, :1] * TIME))[:, :, None],
    )
    return solve(problem, method="hooke-jeeves", rules=Rules(agree=3, sequences=6))


def test_a_panel_for_each_profile(fit: Fit) -> None:
    found = profiles(fit)
    drawn = [axes for axes in plots.profiles(found, columns=3).axes if axes.get_visible()]
    assert [axes.get_title(loc="left") for axes in drawn] == ["rate", "size"]
    np.testing.assert_array_equal(drawn[0].lines[0].get_ydata(), found[0].rise)
    assert drawn[0].get_xlabel() == "[1/h]"
    with pytest.raises(InputError, match="no profile to draw"):
        plots.profiles([])


def test_the_course_ends_at_the_lowest_cost(fit: Fit) -> None:
    axes = plots.course(fit).axes[0]
    number, lowest = (np.asarray(d, dtype=float) for d in axes.lines[1].get_data())
    assert (number[0], number[-1]) == (1, fit.trace.cost.size)
    assert np.all(np.diff(lowest[:-1]) < 0.0)
    assert lowest[-1] == lowest[-2] < 1e-6 * lowest[0]


def test_many_evaluations_are_drawn_as_a_picture(fit: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not plots.course(fit).axes[0].lines[0].get_rasterized()
    monkeypatch.setattr(plots, "MOST_DOTS", 10)
    figure = plots.course(fit)
    assert figure.axes[0].lines[0].get_rasterized()
    drawn = io.StringIO()
    figure.savefig(drawn, format="svg")
    assert "data:image/png" in drawn.getvalue()


def test_all_sequences_are_in_the_histogram(fit: Fit) -> None:
    axes = plots.minima(fit).axes[0]
    assert sum(bar.get_height() for bar in axes.patches) == len(fit.minima)  # type: ignore[attr-defined]
    assert f"{len(fit.minima)} sequences, {len(fit.distinct_minima())} different minima" in axes.get_title(
        loc="left"
    )
