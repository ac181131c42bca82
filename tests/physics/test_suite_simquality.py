"""How the weather of SimQuality is read: both choices, with their scores."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from mascarin.verification.suites.case_data import CaseData, CasePlace
from mascarin.verification.suites.catalogue.simquality import cases
from mascarin.verification.suites.catalogue.simquality.rooms import epw
from mascarin.verification.suites.suite import suites
from mascarin.weather import Climate

Array = npt.NDArray[np.float64]
WEATHER = "SIMQ_TF06_Klima"


@pytest.fixture(scope="module")
def data(data_dir: Path) -> CaseData:
    return CaseData(data_dir / "suites" / "simquality")


def straight(table: Array, hours: int = 8760) -> Climate:
    """The sun on straight lines between the middles of the hours."""
    air, *sun = table[:hours].T
    names = ["global_horizontal", "direct_normal", "diffuse_horizontal"]
    middles, stamps = np.arange(hours) + 0.5, np.arange(0.0, hours, 0.5)
    columns = {name: np.interp(stamps, middles, values) for name, values in zip(names, sun, strict=True)}
    return CasePlace(step="30min").climate({"air_temperature": np.repeat(air, 2), **columns}, instant=names)


def scores(data: CaseData) -> dict[tuple[str, str], float]:
    lines = cases.lines(data)
    return {(line.case, line.quantity): line.value for line in lines if np.isfinite(line.value)}


def test_both_readings_of_the_sun_are_listed_with_their_scores(
    data: CaseData, monkeypatch: pytest.MonkeyPatch
) -> None:
    (setting,) = (words for words in suites()["simquality"].settings if words.startswith("radiation"))
    hourly_means = scores(data)
    monkeypatch.setattr(cases, "with_sun", straight)
    lines = scores(data)
    readings = (("kept, as its format says; mean score", hourly_means), ("the mean score is", lines))
    for words, reading in readings:
        assert f"{words} {np.mean(list(reading.values())):.1f}" in setting
    of_sun = [key for key in hourly_means if "Strahlung" in key[1] and key[0].startswith("TF06")]
    assert len(of_sun) == 12
    assert min(lines[key] for key in of_sun) > 99.0
    assert min(hourly_means[key] for key in of_sun) < 94.0


def test_the_reference_has_sun_after_the_last_hour_of_sun(data: CaseData) -> None:
    reference = cases.Judge.of(data, "TF06").reference
    west = reference.series["Variante 1 abs. Strahlung Westwand"]
    hour = int(np.flatnonzero(reference.hours == 4101.0)[0])
    row = epw(data, WEATHER)[4100]  # the hour that ends at 4101
    assert row[1:].max() == 0.0
    assert west[hour] == pytest.approx(46.87, abs=0.01)
