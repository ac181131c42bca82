"""Figures of a sensitivity analysis."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from mascarin.errors import InputError
from mascarin.figures.files import save, save_both
from mascarin.sensitivity import files
from mascarin.sensitivity.base.factors import Factor
from mascarin.sensitivity.spectral import SpectralSensitivity, analyze, design

HOURS = np.arange(48) / 2.0  # one day in half hours


@pytest.fixture(scope="module")
def result() -> SpectralSensitivity:
    factors = [
        Factor(name, -1.0, 1.0) for name in ("roof.absorptance", "gap.coefficient", "walls.mass", "inactive")
    ]
    plan = design(factors, seed=1)
    sun, coefficient, mass, _ = plan.all_samples().T[:, :, None]
    day = np.maximum(0.0, np.sin((HOURS - 6.0) / 12.0 * np.pi))
    y = (
        20.0
        + 3.0 * sun * day
        - 2.0 * coefficient * day
        + mass * np.cos(HOURS / 12.0 * np.pi)
        + 3.0 * sun * coefficient * day
    )
    return analyze(plan, np.concatenate([y, y], axis=1)[:, :, None], names=["gap.air"], units=["degC"])


def _text(path: Path) -> str:
    root = ET.parse(path).getroot()  # noqa: S314 (written here)
    return "\n".join(t for element in root.iter() if (t := (element.text or "").strip()))


def test_spectrum_has_named_peaks_and_the_threshold(result: SpectralSensitivity, tmp_path: Path) -> None:
    figure = files.spectrum(result, "gap.air", replicate=2)
    text = _text(save(figure, tmp_path / "deep" / "spectrum.svg"))
    line = int(result.design.frequencies[2, 0])
    assert f"{line}  " in text
    assert "roof.absorptance" in text
    assert "roof.absorptance + gap.coefficient" in text
    assert "noise stays below" in text
    assert "part of the variance [%]" in text
    assert "inactive" not in text


def test_indices_over_the_day_are_weighted_with_the_variance(
    result: SpectralSensitivity, tmp_path: Path
) -> None:
    figure = files.day(result, "gap.air", hour=np.concatenate([HOURS, HOURS + 24.0]))
    text = _text(save(figure, tmp_path / "day.svg"))
    assert "hour of the day, local time [h]" in text
    assert "sd [degC]" in text
    assert "others and interactions" in text
    upper = figure.axes[0]
    assert upper.get_xlim() == (0.0, 24.0)
    # The uppermost area, of what is left, reaches 100 %.
    highest = np.asarray(upper.collections[-1].get_paths()[0].vertices)[:, 1].max()
    assert highest == pytest.approx(100.0, abs=1.0)


def test_tornado_has_the_effects_in_order(result: SpectralSensitivity, tmp_path: Path) -> None:
    figure = files.tornado(result, "gap.air", top=3)
    left = figure.axes[0]
    widths = [patch.get_width() for patch in left.patches]  # type: ignore[attr-defined]
    labels = [label.get_text() for label in left.get_yticklabels()]
    assert labels == result.ranking("gap.air", 3)
    mean = np.mean(np.maximum(0.0, np.sin((HOURS - 6.0) / 12.0 * np.pi)))
    assert widths[labels.index("gap.coefficient")] == pytest.approx(-4.0 * mean, rel=0.05)
    assert "[degC]" in left.get_xlabel()
    assert "95 % interval" in _text(save(figure, tmp_path / "tornado.svg"))


def test_same_figure_same_bytes(result: SpectralSensitivity, tmp_path: Path) -> None:
    first = save(files.tornado(result, "gap.air"), tmp_path / "a.svg").read_bytes()
    second = save(files.tornado(result, "gap.air"), tmp_path / "b.svg").read_bytes()
    assert first == second
    assert not list(tmp_path.glob("*.part"))


def test_a_figure_with_a_layout_has_the_bytes_of_matplotlib(tmp_path: Path) -> None:
    """Its parts are placed once and drawn once; `savefig` places them and draws all twice."""

    def figure() -> Figure:
        drawn = Figure(figsize=(7.0, 4.0), layout="constrained")
        upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(2, 1))
        (line,) = upper.plot(HOURS, 1e5 * np.sin(HOURS / 4.0), label="heat")
        lower.plot(HOURS, np.cos(HOURS / 4.0))
        upper.set_title("a title", loc="left")
        lower.set_xlabel("local time")
        drawn.legend(handles=[line], loc="outside lower left", frameon=False)
        return drawn

    for kind, date in (("svg", "Date"), ("pdf", "CreationDate")):
        with mpl.rc_context({"svg.hashsalt": "mascarin", "svg.fonttype": "none"}):
            figure().savefig(tmp_path / f"expected.{kind}", dpi=150, metadata={date: None})
        expected = (tmp_path / f"expected.{kind}").read_bytes()
        assert save(figure(), tmp_path / f"one.{kind}").read_bytes() == expected
    both = save_both(figure(), tmp_path / "both")
    assert both[0].read_bytes() == (tmp_path / "expected.svg").read_bytes()


def test_errors_of_hours(result: SpectralSensitivity) -> None:
    with pytest.raises(InputError, match="48 values for 96 times"):
        files.day(result, "gap.air", hour=HOURS)
    with pytest.raises(InputError, match="same hour of the day"):
        files.day(result, "gap.air", hour=np.full(96, 12.0))


def test_plot_draws_on_the_axes_of_the_user(result: SpectralSensitivity) -> None:
    ax = Figure().subplots()
    assert result.plot(ax=ax, top=2) is ax
    assert [label.get_text() for label in ax.get_yticklabels()] == result.ranking("gap.air", 2)
    assert ax.get_xlabel() == "S1, 95 % interval [%]"
    assert (
        result.plot("effects", ax=Figure().subplots()).get_xlabel() == "low to high end of the range [degC]"
    )
    legend = result.plot("spectrum", ax=Figure().subplots(), replicate=2).get_legend()
    assert legend is not None
    assert "noise stays below" in legend.get_texts()[-1].get_text()
    assert result.plot("day", ax=Figure().subplots()).get_xlabel() == "time [steps]"
    with pytest.raises(InputError, match="expected one of indices, effects, day, spectrum"):
        result.plot("bars")
