"""A study names a planted fault with its size and time; its report says what its numbers say."""

from __future__ import annotations

import json
import re
from html import unescape
from pathlib import Path

import pytest

from mascarin import Study
from mascarin.building import load
from mascarin.building.heat_loss import heat_loss
from study_support import BUILDING, STUDY, logger_table


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wall whose sensor at the joint reads 1 K too high from the fifth day on."""
    folder = tmp_path_factory.mktemp("diagnosis")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    plan = STUDY.replace("sensitivity: {replicates: 3, interval: 1h}\n", "")
    (folder / "study.yaml").write_text(plan, encoding="utf-8")
    table = logger_table(folder / "building.yaml")
    table.loc["2023-03-06":, "joint"] += 1.0
    table.to_csv(folder / "logger.csv")
    return folder


def test_a_step_is_named_and_the_report_agrees_with_the_numbers(folder: Path) -> None:
    results = Study.from_yaml(folder / "study.yaml").run(folder / "out", figures=False)
    found = results.diagnosis
    first = found.first
    assert first is not None
    assert (first.group, first.what, first.subject, first.told) == ("data", "step", ("joint",), True)
    assert first.value == pytest.approx(1.0, abs=4.0 * first.error)
    assert "from about 2023-03-06 00:00 on" in first.text
    # Not more certain than the records that were simulated, and than a model with one form.
    assert first.p >= 1.0 / (found.draws + 1)
    assert first.certainty <= 0.95

    content = json.loads((folder / "out" / "study.json").read_text(encoding="utf-8"))
    stored = content["diagnosis"]["causes"][0]
    assert stored["text"] == first.text
    size, error = re.search(r"it reads ([\d.]+) ± ([\d.]+) K too high", stored["text"]).groups()  # type: ignore[union-attr]
    assert float(size) == pytest.approx(stored["value"], abs=0.5 * 10.0 ** -len(size.split(".")[1]))
    assert float(error) == pytest.approx(stored["error"], rel=0.1)
    certain = re.search(r"has a probability of (\d+) %", stored["text"])
    assert certain is not None
    assert int(certain[1]) == int(100.0 * stored["certainty"])
    said = re.search(r"\(p ([\d.e-]+)\)", stored["text"])
    assert said is not None
    assert float(said[1]) == pytest.approx(stored["p"], rel=0.05)

    report = unescape((folder / "out" / "report.html").read_text(encoding="utf-8"))
    assert first.text in report
    assert "no longer blind" in report
    assert "No cause is named" not in report
    assert "probability of chance" not in report


def test_quantities_of_the_calibrated_building_have_intervals(folder: Path) -> None:
    # A wall alone has no zone: there is nothing to lose heat.
    assert Study.from_yaml(folder / "study.yaml").run().derived == []
    assert heat_loss(load(folder / "building.yaml")).destinations.keys() == {"outdoors"}
