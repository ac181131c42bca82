"""Every document of a study with every form of the model as the one that is used."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mascarin.examples import STUDIES
from mascarin.pages import study as report
from mascarin.pages.study.data.folder import read_folder
from mascarin.study import Study
from mascarin.study.context.forms import label
from mascarin.study.context.storage import Workspace
from mascarin.study.results.document.coefficients import coefficients
from mascarin.study.results.document.phase_change import phase_change
from mascarin.study.results.files import write_all
from mascarin.study.steps import findings
from mascarin.study.steps.model_runs import compared
from mascarin.study.study import all_steps
from study_support import BUILDING, STUDY, logger_table

#: Forms with parameters that the building as described does not have: alone and tied.
ALTERNATIVES = """\
alternatives:
  outside convection:
    power of the wind:
      changes:
        surfaces.wall.outside.convection:
          kind: power
          upward: &law {a: {value: 4, range: [0, 9]}, b: {value: 1.2, range: [0.3, 2.5]}, n: 0.33, c: 3, m: 1}
          downward: *law
      parameters:
        surfaces.wall.outside.convection.*.a: {tie: value, prior: 2}
        surfaces.wall.outside.convection.*.b: {tie: value, prior: 0.5}
    windy:
      changes:
        surfaces.wall.outside.convection: {kind: linear_wind, constant: {value: 15, range: [5, 40]}, wind: 1}
      parameters: {surfaces.wall.outside.convection.constant: {}}
"""
STATED = (
    ("offset: 0, uncertainty: 0.2}", "standard_uncertainty: 0.1, repeatability: 0.03}"),
    ("offset: 0, uncertainty: 0.3}", "offset: 0.2, repeatability: 0.03}"),
    ("sensitivity: {replicates: 3, interval: 1h}\n", ""),
    ("  starts: 2", "  starts: 1\n  discrepancy: {limit: 0.05}"),
    ("limit: 0.25", "limit: 0.001"),  # missed, so that all steps are done
)


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("forms")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    text = STUDY
    for before, after in STATED:
        assert text.count(before) == 1
        text = text.replace(before, after)
    published = "reference:\n  label: paper\n  note: none\n  sensors: {}\n  parameters:\n"
    published += "    - {symbol: h, parameter: surfaces.wall.inside.convection, before: 8, after: 6}\n"
    (folder / "study.yaml").write_text(text + ALTERNATIVES + published, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return folder


def test_the_report_is_written_with_every_form_as_the_used_one(
    bench: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, out = Study.from_yaml(bench / "study.yaml"), bench / "out"
    choices = study.context.variants.forms.combinations()
    assert len(choices) == 3
    used: list[Any] = []
    with Workspace(out, study.context.identity()) as workspace, study.context.keeping(workspace):
        for place, choice in enumerate(choices):
            # The forms are calibrated once; what is kept serves all that follow.
            monkeypatch.setattr(findings, "used_form", lambda *_, place=place: place)
            results = all_steps(study.context, workspace, None)
            assert results.combination is not None
            assert results.combination.forms[0].choice == choice
            write_all(results, workspace, figures=False)
            report.write(out / "report.html", *read_folder(out))
            content = json.loads((out / "study.json").read_text(encoding="utf-8"))
            paths = list(content["parameters"])
            used.append(paths)
            said = f"Form of the model: '{label(choice)}' is used"
            assert any(note["text"].startswith(said) for note in content["notes"])
            law = "surfaces.wall.outside.convection"
            own = {"power of the wind": f"{law}.*.a", "windy": f"{law}.constant"}
            for form, path in own.items():
                assert (path in paths) == (form in label(choice))
    assert len({tuple(paths) for paths in used}) == 3


@pytest.mark.parametrize("name", ["lgi"])
def test_documents_of_shipped_studies_know_the_parameters_of_every_form(name: str) -> None:
    study = Study.from_yaml(STUDIES[name])
    assert study.plan.reference is not None
    published = [entry.parameter for entry in study.plan.reference.parameters]
    for choice in study.context.variants.forms.combinations():
        variant = study.context.variants.variant_of(choice)
        paths = study.context.problem(variant).paths
        simulation = study.context.models.over_record(variant)
        run = compared(study.context, "fitted", simulation, simulation.values, None, label(choice))
        models = coefficients(study.context, {"fitted": run}, (*paths, *published)).coefficients.models
        laws = {path.rpartition(".convection")[0] for path in paths if ".convection" in path}
        assert {f"{law}.convection" for law in laws} <= set(models["fitted"]), label(choice)
        assert all(value > 0.0 for value in models["fitted"].values())
        assert phase_change(study.context, run)
