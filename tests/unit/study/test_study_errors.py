"""Errors of sensors and model and alternatives in a study, from its keys to its results."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from mascarin.calibration.errors.pseudo_bma_weights import pseudo_bma_weights, used_form
from mascarin.study import Study
from mascarin.study.context.forms import comparable
from mascarin.study.context.storage import Workspace
from mascarin.study.steps import model_runs
from mascarin.study.steps.model_runs import ModelRuns
from study_support import BUILDING, STUDY, TRUTH, logger_table

OFFSET = 0.25  # K, added to one sensor
ALTERNATIVES = """\
alternatives:
  outside convection:
    windy: {changes: {surfaces.*.outside.convection: {kind: linear_wind, constant: 45, wind: 1}}}
  site.ground_reflectance: [0.2, 0.5]
"""
STATED = (
    ("offset: 0, uncertainty: 0.2}", "standard_uncertainty: 0.1, repeatability: 0.03}"),
    ("offset: 0, uncertainty: 0.3}", "offset: 0.2, repeatability: 0.03, clock: 5min, depth: 0.001}"),
    ("sensitivity: {replicates: 3, interval: 1h}\n", ""),
    ("  starts: 2", "  starts: 1\n  discrepancy: {limit: 0.05}"),
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("errors")
    (found / "building.yaml").write_text(BUILDING, encoding="utf-8")
    text = STUDY
    for before, after in STATED:
        assert text.count(before) == 1
        text = text.replace(before, after)
    (found / "study.yaml").write_text(text + ALTERNATIVES, encoding="utf-8")
    table = logger_table(found / "building.yaml")
    table["core"] += OFFSET
    table.to_csv(found / "logger.csv")
    return found


@pytest.fixture(scope="module")
def content(folder: Path) -> dict[str, Any]:
    assert cli.main(["study", str(folder / "study.yaml"), "-o", str(folder / "out"), "--no-figures"]) in (
        0,
        1,
    )
    found: dict[str, Any] = json.loads((folder / "out" / "study.json").read_text(encoding="utf-8"))
    return found


def test_the_true_parameters_are_in_their_intervals_beside_a_wrong_sensor(content: dict[str, Any]) -> None:
    for path, value in TRUTH.items():
        entry = content["parameters"][path]
        assert entry["low"] <= value <= entry["high"], path


def test_the_offset_is_found_at_the_sensor_that_has_it(content: dict[str, Any]) -> None:
    found = content["sensor_errors"]
    assert set(found) == {"joint offset", "core offset", "core clock"}
    core = found["core offset"]
    assert core["stated"] == 0.2
    assert abs(core["estimate"] - OFFSET) < 2.0 * core["standard_uncertainty"]
    assert core["standard_uncertainty"] < 0.75 * core["stated"]
    assert abs(found["joint offset"]["estimate"]) < 0.1
    # Stated are 0.1 K in all, of which 0.03 K are scatter: the offset has the rest.
    assert found["joint offset"]["stated"] == pytest.approx(np.sqrt(0.1**2 - 0.03**2))


def test_the_wrong_law_has_no_weight_and_the_weights_sum_up_to_one(content: dict[str, Any]) -> None:
    forms = {entry["label"]: entry for entry in content["alternatives"]}
    assert len(forms) == 4
    assert "windy" not in content["alternatives"][0]["label"]
    assert sum(entry["weight"] for entry in forms.values()) == pytest.approx(1.0, abs=1e-4)
    wrong = [entry["weight"] for label, entry in forms.items() if "windy" in label]
    assert max(wrong) < 0.05
    # The sun on the wall is measured, so that the ground changes nothing: both forms count the same.
    assert forms["as described"]["weight"] == pytest.approx(0.5, abs=0.05)


def test_sizes_of_the_errors_of_the_model_stay_below_their_limits(content: dict[str, Any]) -> None:
    for entry in content["model_errors"].values():
        assert max(entry["repeating"], entry["day"], entry["within_day"]) <= entry["limit"] + 1e-9
        assert entry["independent"] == pytest.approx(0.03, rel=0.35)


def test_the_intervals_hold_the_blind_values_about_the_expected_reading(
    content: dict[str, Any], folder: Path
) -> None:
    series = pd.read_csv(folder / "out" / "tables" / "series.csv")
    for name in ("joint", "core"):
        assert content["band"][name]["held"]["blind"] > 0.9
        # 0.300 by errors of sensors and model, 0.318 with the published error of a modelled sky.
        assert content["band"][name]["half_width"] < 0.32
    # The expected reading has the offset; the fitted series has not.
    away = series["core.expected"] - series["core.fitted"]
    assert away.mean() == pytest.approx(OFFSET, abs=0.12)


def test_tables_and_notes_are_in_the_report(content: dict[str, Any], folder: Path) -> None:
    titles = [table["title"] for table in content["tables"]]
    assert titles == [
        "Prediction intervals",
        "Forms of the model",
        "Errors of the sensors",
        "Errors of the model",
    ]
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    for title in titles:
        assert title in page
    assert any(
        note["text"].startswith("Form of the model: 'as described' is used") for note in content["notes"]
    )


def test_a_list_of_values_leaves_out_the_one_of_the_building(folder: Path) -> None:
    forms = Study.from_yaml(folder / "study.yaml").context.variants.forms
    assert {part: list(known) for part, known in forms.parts.items()} == {
        "outside convection": ["windy"],
        "site.ground_reflectance": ["0.5"],
    }
    assert list(forms.parts["outside convection"]["windy"].changes) == ["surfaces.wall.outside.convection"]


def test_parameters_of_a_replaced_law_are_not_compared(folder: Path) -> None:
    forms = Study.from_yaml(folder / "study.yaml").context.variants.forms
    windy = (("outside convection", "windy"),)
    assert not comparable("surfaces.wall.outside.convection.coefficient", (), windy, forms)
    assert comparable("surfaces.wall.outside.absorptance", (), windy, forms)
    assert comparable("surfaces.wall.outside.convection.coefficient", windy, windy, forms)


def test_tied_parameters_of_an_alternative_are_one_parameter(folder: Path) -> None:
    text = (folder / "study.yaml").read_text(encoding="utf-8").split("alternatives:")[0]
    free = (
        "alternatives:\n  outside convection:\n    free:\n      changes:\n"
        "        surfaces.wall.outside.convection:\n"
        "          {kind: power, upward: &law {c: {value: 4, range: [1, 8]}}, downward: *law}\n"
        "      parameters:\n        surfaces.wall.outside.convection.*.c: {tie: value, prior: 1.5}\n"
    )
    path = folder / "tied.yaml"
    path.write_text(text + free, encoding="utf-8")
    study = Study.from_yaml(path)
    variant = study.context.variants.variant_of((("outside convection", "free"),))
    found = {p.path: p for p in study.context.problem(variant).parameters}
    law = found["surfaces.wall.outside.convection.*.c"]
    assert (law.nominal, law.lower, law.upper, law.prior) == (4.0, 1.0, 8.0, (4.0, 1.5))
    assert not any(path.endswith("ward.c") for path in found)


def test_a_finished_calibration_is_not_searched_again(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study.from_yaml(folder / "study.yaml")
    with Workspace(tmp_path, study.context.identity()) as workspace, study.context.keeping(workspace):
        first = ModelRuns(study.context, workspace, False).plain()

        def searched(*_: Any, **__: Any) -> Any:
            raise AssertionError("the calibration was kept")

        monkeypatch.setattr(model_runs, "identify", searched)
        again = ModelRuns(study.context, workspace, False).plain()
    np.testing.assert_array_equal(again.x, first.x)
    assert (again.cost, again.warnings) == (first.cost, first.warnings)
    np.testing.assert_array_equal(again.trace.x, first.trace.x)
    np.testing.assert_array_equal([again.low, again.high], [first.low, first.high])
    for path, estimate in zip(first.problem.paths, first.x, strict=True):
        assert again.building.parameter(path).value == estimate


def test_incomplete_files_of_a_killed_study_are_removed(folder: Path, tmp_path: Path) -> None:
    study = Study.from_yaml(folder / "study.yaml")
    left = [tmp_path / ".study.json.a1b2.part", tmp_path / "tables" / ".causes.csv.a1b2.part"]
    others = [tmp_path / "download.part", tmp_path / ".study.json"]
    (tmp_path / "tables").mkdir()
    for file in [*left, *others]:
        file.write_text("half", encoding="utf-8")
    with Workspace(tmp_path, study.context.identity()):
        assert not any(file.exists() for file in left)
        assert all(file.exists() for file in others)


def test_the_form_and_its_words_follow_from_the_stored_densities(content: dict[str, Any]) -> None:
    forms = content["alternatives"]
    by_day = np.array([form["left_out"] for form in forms])
    weights = pseudo_bma_weights(by_day)
    np.testing.assert_allclose(weights, [form["weight"] for form in forms], atol=2e-3)
    complexity = [(form["free_numbers"], len(form["choice"])) for form in forms]
    assert used_form(by_day, weights, complexity) == 0
    total = by_day.sum(axis=1)
    assert total[0] >= total.max() - 3.0
    assert weights[0] >= 0.05 * weights.max()
    said = next(n["text"] for n in content["notes"] if n["text"].startswith("Form of the model"))
    used = re.search(rf"'{re.escape(forms[0]['label'])}' is used \(weight ([\d.]+) %\)", said)
    assert used is not None
    assert float(used[1]) == pytest.approx(100.0 * weights[0], abs=0.3)
    sentences = said.split(". ")
    alike = next((one for one in sentences if "does not tell it from" in one), "")
    rest = next((one for one in sentences if "not excluded" in one), "")
    near = (total[0] - total <= 3.0) & (weights >= 0.05 * weights[0])
    for k, form in enumerate(forms[1:], start=1):
        assert (f"'{form['label']}' (" in alike) == near[k], form["label"]
        assert (f"'{form['label']}' (" in rest) == (not near[k] and weights[k] >= 0.05)


def test_the_bands_of_the_report_hold_what_it_says(content: dict[str, Any], folder: Path) -> None:
    series = pd.read_csv(folder / "out" / "tables" / "series.csv")
    stamps = pd.to_datetime(series["time"]).dt.tz_localize(None)
    rows = {table["title"]: table for table in content["tables"]}["Prediction intervals"]["rows"]
    for name, row in zip(("joint", "core"), rows, strict=True):
        away = (series[f"{name}.measured"] - series[f"{name}.expected"]).abs()
        assert row[2] == pytest.approx(series[f"{name}.band"].mean(), rel=1e-3)
        for period, start, end in (
            ("identification", "2023-03-02", "2023-03-06"),
            ("corroboration", "2023-03-06", "2023-03-08"),
        ):
            use = (stamps >= pd.Timestamp(start)) & (stamps < pd.Timestamp(end)) & away.notna()
            share = float((away[use] <= series[f"{name}.band"][use]).mean())
            assert content["band"][name]["held"][period] == pytest.approx(share, abs=0.01)


def test_what_contradicts_the_model_is_said_first_and_widens_what_it_says(
    content: dict[str, Any], folder: Path
) -> None:
    assert next(iter(content)) == "contradictions"
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert ("Read first." in page) == bool(content["contradictions"])
    factor = max([1.0, *(one["factor"] for one in content["contradictions"])])
    method = dict(content["identification"])["uncertainty"]
    assert ("times wider" in method) == (1.0 < factor <= 3.0)
    assert ("not stated" in method) == (factor > 3.0)
