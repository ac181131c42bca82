from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.sensitivity import plots
from mascarin.sensitivity.factors import Factor
from mascarin.sensitivity.spectral import SpectralSensitivity, analyse, design

HOURS = np.arange(48) / 2.0  # one day in half hours


@pytest.fixture(scope="module")
def result() -> SpectralSensitivity:
    factors = [Factor(name, -1.0, 1.0) for name in ("roof.absorptance", "gap.film", "walls.mass", "idle")]
    plan = design(factors, seed=1)
    sun, film, mass, _ = plan.all_samples().T[:, :, None]
    day = np.maximum(0.0, np.sin((HOURS - 6.0) / 12.0 * np.pi))
    y = (
        20.0
        + 3.0 * sun * day
        - 2.0 * film * day
        + mass * np.cos(HOURS / 12.0 * np.pi)
        + 3.0 * sun * film * day
    )
    return analyse(plan, np.concatenate([y, y], axis=1)[:, :, None], names=["gap.air"], units=["degC"])


def _text(path: Path) -> str:
    root = ET.parse(path).getroot()  # noqa: S314 (our own file)
    return "\n".join(t for element in root.iter() if (t := (element.text or "").strip()))


def test_spectrum_names_its_peaks_and_draws_its_threshold(
    result: SpectralSensitivity, tmp_path: Path
) -> None:
    figure = plots.spectrum(result, "gap.air", replicate=2)
    text = _text(plots.save(figure, tmp_path / "deep" / "spectrum.svg"))
    line = int(result.design.frequencies[2, 0])
    assert f"{line}  " in text
    assert "roof.absorptance" in text
    assert "roof.absorptance + gap.film" in text
    assert "noise stays below" in text
    assert "share of the variance [%]" in text
    assert "idle" not in text


def test_shares_over_the_day_are_folded_by_variance(result: SpectralSensitivity, tmp_path: Path) -> None:
    figure = plots.shares_over_time(result, "gap.air", hour=np.concatenate([HOURS, HOURS + 24.0]))
    text = _text(plots.save(figure, tmp_path / "day.svg"))
    assert "hour of the day [h]" in text
    assert "sd [degC]" in text
    assert "others and interactions" in text
    upper = figure.axes[0]
    assert upper.get_xlim() == (0.0, 24.0)
    # The uppermost area, of what is left, reaches 100 %.
    highest = np.asarray(upper.collections[-1].get_paths()[0].vertices)[:, 1].max()
    assert highest == pytest.approx(100.0, abs=1.0)


def test_tornado_has_the_effects_in_order(result: SpectralSensitivity, tmp_path: Path) -> None:
    figure = plots.tornado(result, "gap.air", top=3)
    left = figure.axes[0]
    widths = [patch.get_width() for patch in left.patches]  # type: ignore[attr-defined]
    labels = [label.get_text() for label in left.get_yticklabels()]
    assert labels == result.ranking("gap.air", 3)
    mean = np.mean(np.maximum(0.0, np.sin((HOURS - 6.0) / 12.0 * np.pi)))
    assert widths[labels.index("gap.film")] == pytest.approx(-4.0 * mean, rel=0.05)
    assert "[degC]" in left.get_xlabel()
    assert "95 % interval" in _text(plots.save(figure, tmp_path / "tornado.svg"))


def test_same_figure_same_bytes(result: SpectralSensitivity, tmp_path: Path) -> None:
    first = plots.save(plots.tornado(result, "gap.air"), tmp_path / "a.svg").read_bytes()
    second = plots.save(plots.tornado(result, "gap.air"), tmp_path / "b.svg").read_bytes()
    assert first == second
    assert not list(tmp_path.glob("*.part"))


def test_hours_that_do_not_fit_are_refused(result: SpectralSensitivity) -> None:
    with pytest.raises(InputError, match="48 values for 96 times"):
        plots.shares_over_time(result, "gap.air", hour=HOURS)
    with pytest.raises(InputError, match="same hour of the day"):
        plots.shares_over_time(result, "gap.air", hour=np.full(96, 12.0))
