"""One step of a study on the command line."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pandas as pd
import pytest

from mascarin import cli
from mascarin.pages.study.data.main_results import judged_criteria
from mascarin.study_document.document import StudyDocument
from study_support import BUILDING, STUDY, TRUTH, Bench, logger_table


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("bench")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    text = STUDY.replace("step: 30min", "step: 1h").replace("starts: 2", "starts: 1")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return Bench(folder)


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    capsys.readouterr()
    code = cli.main(list(words))
    printed = capsys.readouterr()
    return code, printed.out, printed.err


def test_sensitivity_ranks_every_parameter(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, printed, _ = run(capsys, "sensitivity", str(bench.study), "-o", str(tmp_path), "--json")
    assert code == 0
    content = json.loads(printed)
    assert content == json.loads((tmp_path / "sensitivity.json").read_text(encoding="utf-8"))
    joint = content["sensitivity"]["joint"]
    assert max(joint, key=lambda path: joint[path]["share"]) == "materials.insulation.conductivity"
    table = pd.read_csv(tmp_path / "tables" / "sensitivity.csv")
    assert len(table) == 2 * len(joint)
    assert {path.name for path in (tmp_path / "figures").iterdir()} == {
        f"{sensor}-{kind}.svg" for sensor in ("joint", "core") for kind in ("spectrum", "tornado", "day")
    }
    # Again, from what was kept: the same, as a table.
    code, printed, _ = run(capsys, "sensitivity", str(bench.study), "-o", str(tmp_path))
    lines = printed.splitlines()
    assert lines[0].split() == ["sensor", "parameter", "S1", "low", "high"]
    assert lines[1].split()[:2] == ["joint", "materials.insulation.conductivity"]


def test_sensitivity_by_another_method(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("sensitivity", str(bench.study), "-o", str(tmp_path), "--method", "morris", "--json")
    code, printed, _ = run(capsys, *words)
    assert code == 0
    content = json.loads(printed)
    assert ["method", "morris"] in content["sensitivity_design"]
    assert "spectra" not in content
    core = content["sensitivity"]["core"]
    assert max(core, key=lambda path: core[path]["share"]) == "sensors.core.depth"
    assert {path.name for path in (tmp_path / "figures").iterdir()} == {
        "joint-tornado.svg", "core-tornado.svg",
    }  # fmt: skip


def test_sensitivity_needs_no_plan_of_its_own(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = bench.folder / "plain.yaml"
    study.write_text(
        bench.study.read_text("utf-8").replace("sensitivity: {replicates: 3, interval: 1h}\n", ""), "utf-8"
    )
    code, printed, _ = run(capsys, "sensitivity", str(study), "-o", str(tmp_path), "--json")
    assert code == 0
    assert ["replicates", "8"] in json.loads(printed)["sensitivity_design"]


@pytest.mark.filterwarnings("always:.*record")
def test_calibrate_finds_the_wall_and_a_study_goes_on_from_there(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, printed, said = run(capsys, "calibrate", str(bench.study), "-o", str(tmp_path), "--json")
    assert code == 0
    content = at_first = json.loads(printed)
    assert content == json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    assert set(content["parameters"]) == set(TRUTH)
    assert content["sensors"]["joint"]["corroboration"]["fitted"]["rmse"] < 0.05
    assert content["sensors"]["joint"]["corroboration"]["nominal"]["rmse"] > 0.4
    assert "criteria met: 6 of 6" in said
    assert {path.name for path in (tmp_path / "tables").iterdir()} == {
        "parameters.csv", "calibration_metrics.csv", "calibration_criteria.csv", "quality.csv",
        "evaluations.csv",
    }  # fmt: skip
    record = next((tmp_path / ".work").glob("evaluations-*.jsonl"))
    before = record.read_bytes()
    code, _, said = run(capsys, "study", str(bench.study), "-o", str(tmp_path), "--no-figures")
    assert code == 0
    assert record.read_bytes() == before
    # The terminal counts what the report counts.
    met, total = counted(said)
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert f'Criteria met</span> <span class="fact-value">{met} of {total}<' in report
    # The folder came by mail, with a file in the place of the record; and no kept results.
    for damaged in (b"a,b\n1,2\n", before.replace(b'"weights":[', b'"weights":[9.0,', 1)):
        for file in (tmp_path / ".work").glob("*.npz"):
            file.unlink()
        record.write_bytes(damaged)
        code, printed, said = run(capsys, "calibrate", str(bench.study), "-o", str(tmp_path), "--json")
        assert code == 0
        assert json.loads(printed)["parameters"] == at_first["parameters"]
        assert f"{record.name}: found something else" in said or "everything is computed again" in said
    study = json.loads((tmp_path / "study.json").read_text(encoding="utf-8"))
    assert study["parameters"] == content["parameters"]
    assert study["criteria"] == content["criteria"]


def test_validate_compares_the_building_as_described(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(bench.folder.rglob("*"))
    code, printed, said = run(capsys, "validate", str(bench.study), "--json")
    assert code == 1
    assert sorted(bench.folder.rglob("*")) == before  # nothing is written unasked
    content = json.loads(printed)
    assert list(content["models"]) == ["nominal"]
    assert (
        content["sensors"]["core"]["blind"]["rmse"] == content["sensors"]["core"]["blind"]["nominal"]["rmse"]
    )
    assert "parameters" not in content
    assert "criteria met: 0 of 6" in said
    assert said.count("missed: ") == 6
    code, printed, _ = run(capsys, "validate", str(bench.study), "-o", str(tmp_path / "out"))
    assert code == 1
    assert json.loads((tmp_path / "out" / "validation.json").read_text(encoding="utf-8")) == content
    assert printed.splitlines()[0].split() == ["sensor", "period", "model", "rmse", "sd", "bias", "max"]
    metrics = pd.read_csv(tmp_path / "out" / "tables" / "validation_metrics.csv")
    assert len(metrics) == 6
    assert set(metrics["model"]) == {"nominal"}


def counted(said: str) -> tuple[int, int]:
    """Criteria that the terminal says are met, and how many there are."""
    found = re.search(r"criteria met: (\d+) of (\d+)", said)
    assert found is not None
    return int(found[1]), int(found[2])


def test_where_no_other_days_are_left_their_criteria_count_once(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    study = bench.folder / "no_blind_days.yaml"
    text = bench.study.read_text("utf-8")
    all_others = text.replace('corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]',
                              'corroboration: ["2023-03-06 00:00", "2023-03-10 00:00"]')  # fmt: skip
    assert all_others != text
    study.write_text(all_others, "utf-8")
    code, printed, said = run(capsys, "validate", str(study), "--json")
    assert code == 1
    content = StudyDocument.read(json.loads(printed))
    assert content.periods["blind"].spans == content.periods["corroboration"].spans
    assert len(content.criteria) == 6
    shown = content.without_repeated_periods()
    assert counted(said) == (0, 4)
    assert len(judged_criteria(shown)) == 4
    assert said.count("missed: ") == 4


def test_validate_ends_with_0_when_every_criterion_is_kept(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    study = bench.folder / "loose.yaml"
    study.write_text(bench.study.read_text("utf-8").replace("limit: 0.25", "limit: 5"), "utf-8")
    code, _, said = run(capsys, "validate", str(study))
    assert code == 0
    assert "criteria met: 6 of 6" in said


def test_a_run_may_start_from_a_temperature_that_is_given(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    """The initial state is printed, and an error of it is still visible after a warm-up of a day."""
    study = bench.folder / "cold.yaml"
    starts, errors = [], []
    for initial in ("repeat", "12.5", "-20"):
        study.write_text(f"initial: {initial}\n" + bench.study.read_text("utf-8"), "utf-8")
        _, printed, _ = run(capsys, "validate", str(study), "--json")
        content = json.loads(printed)
        starts.append(content["start"])
        errors.append(content["sensors"]["core"]["identification"]["nominal"]["rmse"])
    assert starts[0].startswith("first 24 h repeated")
    assert starts[1:] == ["12.5 degC everywhere", "-20 degC everywhere"]
    assert len(set(errors)) == 3
    study.write_text("initial: cold\n" + bench.study.read_text("utf-8"), "utf-8")
    code, _, said = run(capsys, "validate", str(study))
    assert code == 2
    assert "cold.yaml:1: initial" in said


@pytest.mark.parametrize("command", ["sensitivity", "calibrate", "validate"])
def test_a_step_refuses_what_a_study_refuses(
    command: str, bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = bench.folder / "bad.yaml"
    study.write_text(bench.study.read_text("utf-8").replace("column: joint", "column: jiont"), "utf-8")
    code, printed, said = run(capsys, command, str(study), "-o", str(tmp_path / "out"))
    assert (code, printed) == (2, "")
    assert "bad.yaml:13: sensors.joint.column" in said
    assert not (tmp_path / "out").exists()
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    code, _, said = run(capsys, command, str(bench.study), "-o", str(tmp_path / "file"))
    assert code == 2
    assert "found a file, expected a folder" in said


def test_a_posterior_sample_with_profiles(
    bench: Bench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = bench.study.read_text(encoding="utf-8")
    chosen = text.replace("  starts: 1", "  starts: 1\n  method: emcee\n  moves: 60\n  profiles: true")
    study = bench.study.with_name("posterior.yaml")
    study.write_text(chosen, encoding="utf-8")
    code, printed, _ = run(capsys, "calibrate", str(study), "-o", str(tmp_path), "--json")
    assert code == 0
    content = json.loads(printed)
    assert ["method", "emcee"] in content["identification"]
    assert set(content["profiles"]) == set(TRUTH)
    for path, profile in content["profiles"].items():
        found = content["parameters"][path]
        assert min(profile["rise"]) < 0.05 * profile["limit"]
        assert profile["low"] <= found["fitted"] <= profile["high"]
        assert found["low"] < found["fitted"] < found["high"]
    assert {path.name for path in (tmp_path / "figures").iterdir()} >= {
        "identification-course.svg",
        "identification-profiles.svg",
    }
    assert (tmp_path / "tables" / "evaluations.csv").exists()
    assert set(content["band"]) == {"joint", "core"}
