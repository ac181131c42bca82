"""A study from a logger's table to a corroborated model, and what survives when it is killed."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from mascarin._io.tables import read_csv
from mascarin.study_document.comparison import LedgerEntry, MetricValues
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.entry import ResultEntry
from study_support import BUILDING, NOISE, STUDY, TRUTH, Bench, logger_table

METRICS = {
    "n", "bias", "sd", "rmse", "mean_error", "max_error", "mean_error_percent", "max_error_percent",
}  # fmt: skip
PERIODS = {"identification", "corroboration", "blind"}


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("bench")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY.replace("step: 30min", "step: 10min"), encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return Bench(folder)


class Done(NamedTuple):
    out: Path
    content: dict[str, Any]
    printed: str
    said: str
    code: int

    def table(self, name: str) -> pd.DataFrame:
        return read_csv(self.out / "tables" / f"{name}.csv")


def carried_out(
    study: Path | str, out: Path, capsys: pytest.CaptureFixture[str], *options: str, figures: bool = False
) -> Done:
    capsys.readouterr()
    without = [] if figures else ["--no-figures"]
    code = cli.main(["study", str(study), "-o", str(out), *without, *options])
    printed = capsys.readouterr()
    assert code in (0, 1), printed.err
    content = json.loads((out / "study.json").read_text(encoding="utf-8"))
    return Done(out, content, printed.out, printed.err, code)


@pytest.fixture(scope="module")
def done(bench: Bench) -> Done:
    run = subprocess.run(
        [
            sys.executable,
            "-m",
            "mascarin.cli",
            "study",
            str(bench.study),
            "-o",
            str(bench.folder / "out"),
            "--json",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    content = json.loads((bench.folder / "out" / "study.json").read_text(encoding="utf-8"))
    return Done(bench.folder / "out", content, run.stdout, run.stderr, run.returncode)


# --- what it leaves behind -----------------------------------------------------------------------------


def test_only_json_on_stdout(done: Done) -> None:
    assert done.code == 0
    assert json.loads(done.printed) == done.content
    assert "criteria met: 6 of 6" in done.said


def test_the_files_that_are_left(done: Done) -> None:
    names = {path.relative_to(done.out).as_posix() for path in done.out.rglob("*") if path.is_file()}
    figures = {
        f"figures/{s}{kind}.svg" for s in ("joint", "core") for kind in ("", "-spectrum", "-tornado", "-day")
    }
    tables = {
        f"tables/{name}.csv"
        for name in (
            "metrics", "parameters", "criteria", "quality", "series", "sensitivity", "evaluations",
        )
    }  # fmt: skip
    # The figures of the paper: all sensors together and each by itself, for print and for the screen.
    of_periods = {
        f"figures/{period}-{what}{ending}"
        for period in ("identification", "corroboration")
        for what in ("all", "joint", "core")
        for ending in (".svg", ".pdf")
    }
    assert names >= {"study.json", "report.html"} | figures | tables | of_periods
    assert all((done.out / name).read_bytes()[:5] == b"%PDF-" for name in of_periods if name.endswith("pdf"))
    assert not [name for name in names if name.endswith((".part", ".npy"))]
    for figure in figures:
        assert ET.parse(done.out / figure).getroot().tag.endswith("svg")  # noqa: S314 (our own file)


def undeclared(entry: object, where: str = "") -> list[str]:
    """Keys of results that their model does not declare; models, metrics and flows have their own names."""
    if isinstance(entry, dict | list):
        pairs = entry.items() if isinstance(entry, dict) else enumerate(entry)
        return [key for name, value in pairs for key in undeclared(value, f"{where}.{name}")]
    if not isinstance(entry, ResultEntry):
        return []
    extra = (
        []
        if isinstance(entry, MetricValues | LedgerEntry)
        else [f"{where}.{key}" for key in entry.model_extra or {}]
    )
    values = {key: getattr(entry, key) for key in entry.model_fields_set}
    return [*extra, *undeclared({k: v for k, v in values.items() if f"{where}.{k}" not in extra}, where)]


def test_the_results_are_read_back_without_loss(done: Done) -> None:
    document = StudyDocument.read(done.content)
    assert document.to_dict() == done.content
    assert undeclared(document) == []


def test_the_schema_of_the_result(done: Done) -> None:
    content = done.content
    assert set(content["sensors"]) == {"joint", "core"}
    for periods in content["sensors"].values():
        assert set(periods) == PERIODS
        for found in periods.values():
            assert set(found) >= METRICS
            for model in ("nominal", "fitted"):
                assert set(found[model]) >= METRICS
                assert all(math.isfinite(found[model][metric]) for metric in METRICS)
            assert {metric: found[metric] for metric in METRICS} == {m: found["fitted"][m] for m in METRICS}
    assert set(content["parameters"]) == set(TRUTH)
    for entry in content["parameters"].values():
        assert set(entry) >= {"nominal", "fitted", "low", "high", "unit"}
        assert entry["low"] < entry["fitted"] < entry["high"]
    for shares in content["sensitivity"].values():
        assert len(shares) > 12  # every number of the wall that has a range and acts
        for entry in shares.values():
            assert set(entry) == {"share", "low", "high", "effect"}
            assert 0.0 <= entry["low"] <= entry["share"] <= entry["high"] <= 1.0
    assert content["ledger"]["closure"] < 1e-10
    assert {entry["passed"] for entry in content["criteria"] if entry["model"] == "fitted"} == {True}
    assert {entry["passed"] for entry in content["criteria"] if entry["model"] == "nominal"} == {False}
    assert content["mascarin_version"]
    assert content["seed"] == 1
    assert {entry["name"].partition(":")[0] for entry in content["inputs"]} == {
        "study", "building", "climate", "measurements",
    }  # fmt: skip
    assert all(len(entry["sha256"]) == 64 for entry in content["inputs"])


def test_the_prediction_interval_covers_days_not_used(done: Done) -> None:
    """The data are our own model with white noise: the band is the noise, and a little for the estimates."""
    for sensor, found in done.content["band"].items():
        assert found["error"] == pytest.approx(NOISE, rel=0.15)
        assert 0.0 < found["parameters"] < 0.5 * found["error"]
        assert found["half_width"] == pytest.approx(
            1.96 * math.hypot(found["error"], found["parameters"]), rel=0.05
        )
        assert all(0.91 < share < 0.98 for share in found["held"].values()), (sensor, found)
    series = done.table("series")
    assert np.mean(series["joint.band"]) == pytest.approx(
        done.content["band"]["joint"]["half_width"], rel=1e-5
    )
    (table,) = done.content["tables"]
    assert table["columns"][-1] == "blind"
    assert "Prediction intervals" in (done.out / "report.html").read_text(encoding="utf-8")
    trace = done.table("evaluations")
    best = trace.sort_values("cost").to_dict("records")[0]
    for path, entry in done.content["parameters"].items():
        assert best[path] == pytest.approx(entry["fitted"], rel=1e-3)


def test_the_tables_say_what_the_json_says(done: Done) -> None:
    metrics = done.table("metrics").set_index(["sensor", "period", "model"])
    for sensor, periods in done.content["sensors"].items():
        for period, found in periods.items():
            for model in ("nominal", "fitted"):
                assert metrics.loc[(sensor, period, model), "rmse"] == found[model]["rmse"]
    parameters = done.table("parameters").set_index("parameter")
    for path, entry in done.content["parameters"].items():
        assert parameters.loc[path, "fitted"] == entry["fitted"]
    assert len(done.table("sensitivity")) == sum(len(s) for s in done.content["sensitivity"].values())
    assert len(done.table("criteria")) == len(done.content["criteria"])


def test_the_wall_that_made_the_table_is_found(done: Done) -> None:
    # What remains is the noise of the logger, on the days that the fit has not seen as well.
    for sensor in ("joint", "core"):
        for period in PERIODS:
            assert done.content["sensors"][sensor][period]["rmse"] == pytest.approx(NOISE, rel=0.1)
    for path, value in TRUTH.items():
        entry = done.content["parameters"][path]
        # One draw of the noise, and a mesh coarser than that of the wall that made the table.
        half = (entry["high"] - entry["low"]) / 2.0
        assert abs(entry["fitted"] - value) < 1.2 * half + 0.03 * value, path


def test_what_matters_is_what_acts_on_the_sensor(done: Done) -> None:
    core, joint = done.content["sensitivity"]["core"], done.content["sensitivity"]["joint"]
    # In the insulation the place of the sensor decides, behind it what the layers let through.
    assert max(core, key=lambda path: core[path]["share"]) == "sensors.core.depth"
    assert max(joint, key=lambda path: joint[path]["share"]) == "materials.insulation.conductivity"
    assert joint["sensors.core.depth"]["share"] < 0.01
    # Warmer rooms behind better insulation; a deeper sensor is nearer to the room.
    assert joint["materials.insulation.conductivity"]["effect"] < 0.0
    assert core["sensors.core.depth"]["effect"] > 0.0


def test_blind_days_are_those_not_used_for_the_calibration(done: Done) -> None:
    n = {period: done.content["sensors"]["joint"][period]["n"] for period in PERIODS}
    assert n["identification"] == 4 * 144
    assert n["corroboration"] == 2 * 144
    # 8 and 9 March but for the last interval, which has no later value to interpolate to.
    assert n["blind"] == 2 * 144 - 1


def test_done_again_it_is_the_same_to_the_byte(
    done: Done, bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (done.out / "study.json").read_bytes()
    tables = {path: path.read_bytes() for path in (done.out / "tables").iterdir()}
    assert carried_out(bench.study, done.out, capsys, figures=True).code == 0
    assert (done.out / "study.json").read_bytes() == before
    assert {path: path.read_bytes() for path in tables} == tables


# --- criteria, other inputs ----------------------------------------------------------------------------

QUICK = {
    "step: 10min": "step: 1h",
    "sensitivity: {replicates: 3, interval: 1h}\n": "",
    "starts: 2": "starts: 1",
}


@pytest.fixture
def quick(bench: Bench, tmp_path: Path) -> Bench:
    """The same study, coarse and without its second step."""
    text = bench.study.read_text(encoding="utf-8")
    for before, after in QUICK.items():
        text = text.replace(before, after)
    for path in (bench.building, bench.table):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "study.yaml").write_text(text, encoding="utf-8")
    return Bench(tmp_path)


def test_a_missed_criterion_ends_with_1(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    quick.edit("limit: 0.25}", "limit: 0.001, sensors: joint, periods: [blind], name: too good}")
    found = carried_out(quick.study, quick.folder / "out", capsys, "--json")
    assert found.code == 1
    assert json.loads(found.printed) == found.content
    assert not (found.out / "figures").exists()  # not asked for here
    assert "missed: joint, blind: too good; found 0.0" in found.said
    assert "criteria met: 0 of 1" in found.said
    assert [c["passed"] for c in found.content["criteria"]] == [False, False]


def test_without_a_sensitivity_the_other_steps_are_made(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    found = carried_out(quick.study, quick.folder / "out", capsys)
    assert "sensitivity" not in found.content
    assert not (quick.folder / "out" / "tables" / "sensitivity.csv").exists()
    assert found.printed == ""


def test_exact_slopes_find_the_same_wall(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    near = carried_out(quick.study, quick.folder / "near", capsys)
    quick.edit("  starts: 1\n", "  starts: 1\n  slopes: exact\n")
    found = carried_out(quick.study, quick.folder / "exact", capsys)
    for path, entry in found.content["parameters"].items():
        other = near.content["parameters"][path]
        width = other["high"] - other["low"]
        assert abs(entry["fitted"] - other["fitted"]) < 1e-2 * width, path
        assert entry["high"] - entry["low"] == pytest.approx(width, rel=1e-2)
    before = (found.out / "study.json").read_bytes()
    carried_out(quick.study, found.out, capsys)
    assert (found.out / "study.json").read_bytes() == before


def test_the_reason_of_a_missed_aim_is_the_parameter_left_out(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    """The absorptance of the wall is wrong in the description and is not identified."""
    text = quick.study.read_text("utf-8")
    for path in ("surfaces.wall.outside.absorptance", "materials.brick.conductivity"):
        assert f"    {path}:\n" in text
        text = text.replace(f"    {path}:\n", "")
    aims = "aims:\n  - {metric: sd, limit: 0.06}\n  - {metric: bias, limit: 0.0001, sensors: core}\ncriteria:"
    quick.study.write_text(text.replace("criteria:", aims), "utf-8")
    done = carried_out(quick.study, quick.folder / "out", capsys)
    missed = {(a["sensor"], a["metric"]) for a in done.content["aims"] if not a["passed"]}
    assert {("core", "sd"), ("core", "bias")} <= missed
    found = done.content["shortfall"]
    # More sun taken up, or less of it given to the air: the wall cannot tell the two apart.
    first = found["steps"][0]
    more = {"surfaces.wall.outside.absorptance": 1.0, "surfaces.wall.outside.convection.coefficient": -1.0}
    assert more[first["path"]] * first["changes"][first["path"]] > 0.0
    blind = done.content["sensors"]["core"]["blind"]["fitted"]["sd"]
    assert found["sd"]["core"] == pytest.approx(blind, rel=1e-4)
    assert found["all_parameters"]["sd"]["core"] < 0.5 * blind
    assert any(n["title"] == "Aims that are not met" and "the equations are sufficient" in n["text"]
               for n in done.content["notes"])  # fmt: skip
    reached = sum(a["passed"] for a in done.content["aims"])
    assert f"aims reached: {reached} of {len(done.content['aims'])}" in done.said


def _left(done: Done) -> str:
    """Text of the report section on the sources of remaining error; empty where there is none."""
    page = (done.out / "report.html").read_text(encoding="utf-8")
    if 'id="error-sources"' not in page:
        return ""
    section = page[page.index('id="error-sources"') :]
    return re.sub(r"<[^>]+>|\s+", " ", section[: section.index("</section")])


#: One of the two sensors.
JOINT = "  joint: {column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}\n"
#: The least that a study can say.
LEAST = {
    "criteria:\n  - {metric: rmse, limit: 0.25}\n": "",
    JOINT: "",
    "    materials.insulation.conductivity:\n": "",
    "    materials.brick.conductivity:\n": "",
    "    surfaces.wall.outside.absorptance:\n": "",
}


def test_the_rest_is_asked_for_without_aims_or_criteria_and_of_one_sensor(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    for before, after in LEAST.items():
        quick.edit(before, after)
    found = carried_out(quick.study, quick.folder / "out", capsys)
    assert "1 sensor\n" in found.said
    assert found.content["aims"] == found.content["criteria"] == []
    shortfall = found.content["shortfall"]
    assert list(shortfall["sd"]) == ["core"]
    assert shortfall["steps"]
    assert shortfall["all_parameters"]["sd"]["core"] < 0.5 * shortfall["sd"]["core"]
    assert re.search(r"Table \d+\s+adds the parameters one by one", _left(found))


def test_where_only_noise_is_left_no_parameter_is_blamed(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    quick.edit("step: 1h", "step: 10min")
    quick.edit("criteria:\n  - {metric: rmse, limit: 0.25}\n", "")
    found = carried_out(quick.study, quick.folder / "out", capsys)
    shortfall = found.content["shortfall"]
    assert shortfall["steps"] == []
    assert shortfall["sd"]["joint"] == pytest.approx(NOISE, rel=0.15)
    assert "No parameter reduces the error significantly" in _left(found)


def test_a_sensor_without_blind_values_is_left_out_and_named(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    table = pd.read_csv(quick.table, index_col=0)
    table.loc["2023-03-08 05:00:00":, "core"] = np.nan  # five hours of the blind days are left
    table.to_csv(quick.table)
    quick.edit("limit: 0.25", "limit: 0.001")
    found = carried_out(quick.study, quick.folder / "out", capsys)
    assert list(found.content["shortfall"]["sd"]) == ["joint"]
    assert list(found.content["residuals"]) == ["joint"]
    said = [note["text"] for note in found.content["notes"] if note["title"] == "Residuals"]
    assert said[0].startswith("core: 5 values on the blind days are too few for an analysis of the residuals")


def test_too_short_a_rest_is_not_asked_about_and_said(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    quick.edit('["2023-03-02 00:00", "2023-03-06 00:00"]', '["2023-03-02 00:00", "2023-03-09 12:00"]')
    quick.edit('  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]\n', "")
    found = carried_out(quick.study, quick.folder / "out", capsys)
    assert "shortfall" not in found.content
    assert _left(found) == ""
    said = [note["text"] for note in found.content["notes"] if note["title"] == "Residuals"]
    few = [text[: text.index(" values")] for text in said if "too few" in text]
    assert few == ["joint: 11", "core: 11"]


@pytest.mark.filterwarnings("always::UserWarning")
def test_work_on_other_inputs_is_not_continued(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    out = quick.folder / "out"
    first = carried_out(quick.study, out, capsys)
    # A comment in the building: another file, whatever it means.
    quick.building.write_text(quick.building.read_text(encoding="utf-8") + "# looked at again\n", "utf-8")
    again = carried_out(quick.study, out, capsys)
    assert "found results of other inputs (different: building)" in again.said
    assert again.content["parameters"] == first.content["parameters"]
    # And another range, which changes the start of the searches but no plan of the engine.
    quick.edit("range: [4, 12]", "range: [4, 11]", "building.yaml")
    other = carried_out(quick.study, out, capsys)
    assert "everything is computed again" in other.said
    fresh = carried_out(quick.study, quick.folder / "fresh", capsys)
    assert "again" not in fresh.said
    assert (out / "study.json").read_bytes() == (quick.folder / "fresh" / "study.json").read_bytes()


@pytest.mark.filterwarnings("always::UserWarning")
def test_results_of_other_inputs_do_not_stay(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    out = quick.folder / "out"
    quick.edit(JOINT, "")
    carried_out(quick.study, out, capsys, figures=True)
    assert (out / "figures" / "core.svg").exists()
    mine = out / "figures" / "mine.svg"
    mine.write_text("kept", encoding="utf-8")
    quick.edit("  core: {column", "  heart: {column")
    carried_out(quick.study, out, capsys, figures=True)
    figures = {path.name for path in (out / "figures").iterdir()}
    assert "heart.svg" in figures
    assert not [name for name in figures if name.startswith("core")]
    assert mine.read_text(encoding="utf-8") == "kept"


def test_a_variant_may_hold_dots_in_its_name(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    quick.edit(
        "identification:\n",
        "variants: {h 0.5 W: {identify: false, changes: {surfaces.wall.inside.convection: 9}}}\n"
        "identification:\n",
    )
    done = carried_out(quick.study, quick.folder / "out", capsys)
    assert "h 0.5 W/joint" in (done.out / "report.html").read_text(encoding="utf-8")


def test_two_studies_do_not_share_a_folder(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    from mascarin.study import Study
    from mascarin.study.context.storage import Workspace

    study = Study(quick.study)
    out = quick.folder / "out"
    with Workspace(out, study.context.identity()):
        for command in ("study", "sensitivity", "calibrate", "validate"):
            assert cli.main([command, str(quick.study), "-o", str(out)]) == 2
            assert "another process is writing to this folder" in capsys.readouterr().err
    Workspace(out, study.context.identity()).__exit__()


def test_date_and_run_time_are_in_a_separate_file(done: Done) -> None:
    """The results are the same to the byte each time; date and run time are in run.json."""
    run = json.loads((done.out / "run.json").read_text(encoding="utf-8"))
    assert run["run_time"] > 0.0
    assert run["created"].endswith("+00:00")
    assert "Run time" in (done.out / "report.html").read_text(encoding="utf-8")
    assert done.content["command"] == ["mascarin study study.yaml -o out/"]


@pytest.mark.filterwarnings("always::UserWarning")
def test_an_unreadable_manifest_counts_as_that_of_another_study(
    quick: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = quick.folder / "out" / ".work"
    folder.mkdir(parents=True)
    (folder / "manifest.json").write_text('{"study":', encoding="utf-8")
    (folder / "sensitivity-000000000.npy").write_bytes(b"no array")
    assert carried_out(quick.study, quick.folder / "out", capsys).code == 0


def test_a_mask_is_shown_and_only_acts_on_sensors(quick: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    table = pd.read_csv(quick.table)
    table.loc[300:399, "core"] = float(table["core"].iloc[300])
    table.to_csv(quick.table, index=False)
    found = carried_out(quick.study, quick.folder / "out", capsys)
    stuck = [entry for entry in found.content["quality"] if entry["kind"] == "stuck"]
    assert [(s["channel"], s["start"], s["count"], s["masked"]) for s in stuck] == [
        ("core", "2023-03-03T02:10:00", 99, True)
    ]
    n = {s: found.content["sensors"][s]["identification"]["n"] for s in ("joint", "core")}
    assert n == {"joint": 96, "core": 96 - 16}
    assert "core: stuck from 2023-03-03 02:10" in found.said


# --- killed --------------------------------------------------------------------------------------------


#: A study that kills itself while it writes its n-th piece of the sensitivity, or once it keeps n
#: evaluations: where it ends depends on the count, never on how fast the machine is.
KILLED = """
import os, signal, sys
from mascarin import cli
from mascarin._io.tables import read_csv
from mascarin.calibration.base.evaluations import Evaluator
from mascarin._io import atomic
from mascarin.study.steps import sensitivity as screening

# Background jobs of a shell inherit that the signal is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
where, count = sys.argv[1], int(sys.argv[2])
screening.CHUNK_SECONDS = 0.02  # many pieces, also on a fast machine
pieces, write, run = 0, atomic.write, Evaluator._run

def torn(path, content):
    global pieces
    pieces += path.suffix == ".npy"
    if where == "sensitivity" and pieces == count:
        path.with_name("." + path.name + ".x.part").write_bytes(content[: len(content) // 2])
        os.kill(os.getpid(), signal.SIGKILL)
    return write(path, content)

def cut(self, x, keep):
    run(self, x, keep)
    if where == "identification" and self.count >= count:
        self._file.write(b'{"x": [0.0')
        self._file.flush()
        os.kill(os.getpid(), signal.SIGKILL)

atomic.write, Evaluator._run = torn, cut
sys.exit(cli.main(["study", sys.argv[3], "-o", sys.argv[4]]))
"""


def killed(bench: Bench, out: Path, where: str, count: int) -> None:
    command = [sys.executable, "-c", KILLED, where, str(count), str(bench.study), str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == -signal.SIGKILL, done.stderr


def chunks(out: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (out / ".work").glob("sensitivity-*.npy")}


def evaluations(out: Path) -> int:
    """Evaluations that are whole, the header aside."""
    return sum(path.read_bytes().count(b"\n") - 1 for path in (out / ".work").glob("evaluations-*.jsonl"))


@pytest.fixture
def long(bench: Bench, tmp_path: Path) -> Bench:
    """The same study with a finer step and more replicates: several chunks of work."""
    text = bench.study.read_text(encoding="utf-8").replace("step: 10min", "step: 4min")
    text = text.replace("replicates: 3", "replicates: 4").replace("starts: 2", "starts: 3")
    for path in (bench.building, bench.table):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "study.yaml").write_text(text, encoding="utf-8")
    return Bench(tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_killed_again_and_again_it_ends_with_the_same_bytes(
    long: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    out = long.folder / "killed"
    random = np.random.default_rng(int.from_bytes(os.urandom(4), "big"))
    kept: dict[str, bytes] = {}
    for _ in range(2):  # in the sensitivity: what was being written is lost, the pieces before it are not
        whole = int(random.integers(1, 5))
        killed(long, out, "sensitivity", whole + 1)
        now = chunks(out)
        assert {name: now[name] for name in kept} == kept
        assert len(now) == len(kept) + whole
        kept = now
    least = int(random.integers(5, 40))
    killed(long, out, "identification", least)
    assert not (out / "study.json").exists()
    found, every = evaluations(out), chunks(out)
    assert found >= least
    assert {name: every[name] for name in kept} == kept
    finished = carried_out(long.study, out, capsys)
    whole_run = carried_out(long.study, long.folder / "whole", capsys)
    assert finished.code == whole_run.code == 0
    assert (out / "study.json").read_bytes() == (whole_run.out / "study.json").read_bytes()
    for path in (whole_run.out / "tables").iterdir():
        assert (out / "tables" / path.name).read_bytes() == path.read_bytes(), path.name
    # Every run of the design was made once: the last run took what was there.
    assert evaluations(out) == evaluations(whole_run.out)


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_interrupted_it_ends_with_130_and_keeps_its_work(long: Bench) -> None:
    out = long.folder / "out"
    code = KILLED.replace("signal.SIGKILL", "signal.SIGINT")
    command = [sys.executable, "-c", code, "sensitivity", "3", str(long.study), str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 130
    assert done.stdout == ""
    assert done.stderr.strip().splitlines()[-1] == "interrupted"
    assert chunks(out)
    assert not (out / "study.json").exists()


def test_chunks_of_work_last_about_a_second() -> None:
    from mascarin.study.steps.sensitivity import CHUNK_SECONDS, _Pace

    assert CHUNK_SECONDS <= 1.0
    pace = _Pace()
    packs = 8 * (os.cpu_count() or 1)  # eight members on each processor: fewer would take as long
    assert pace.size == packs
    pace.update(packs, 0.1)
    assert pace.size == 10 * packs
    pace.update(10 * packs, 8.0)  # a busy machine
    assert pace.size == packs
    pace.update(packs, 5.0)  # long runs: still whole packs
    assert pace.size == packs
    pace.update(packs, 0.0)
    assert pace.size == 128 * packs


# --- the wall bench: real measurements -----------------------------------------------------------------


@pytest.fixture(scope="module")
def wall(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Done:
    out = tmp_path_factory.mktemp("wall") / "out"
    run = subprocess.run(
        [sys.executable, "-m", "mascarin.cli", "study", "wall-bench", "-o", str(out), "--no-figures"],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MASCARIN_DATA": str(data_dir)},
    )
    content = json.loads((out / "study.json").read_text(encoding="utf-8"))
    return Done(out, content, run.stdout, run.stderr, run.returncode)


def static_regression(data_dir: Path, series: pd.DataFrame, column: str, sensor: str) -> tuple[float, float]:
    """RMSE on the days of the identification and on the others of a line through the same inputs. [K]"""
    with (data_dir / "wall_bench" / "wall_bench_2024.csv").open(encoding="utf-8") as file:
        header, *rows = csv.reader(file, delimiter=";")
    at = {row[0]: row for row in rows}
    stamps = pd.to_datetime(series["time"], utc=True).dt.tz_convert("Etc/GMT-2")
    local = [f"{stamp:%Y-%m-%d %H:%M:%S}" for stamp in stamps]
    inputs = ("T_ext", "Pyr", "Tint_2")
    x = np.array([[1.0, *(float(at[t][header.index(name)]) for name in inputs)] for t in local])
    y = np.array([float(at[t][header.index(column)]) for t in local])
    np.testing.assert_allclose(y, series[f"{sensor}.measured"].fillna(pd.Series(y)), atol=1e-9)
    seen = (stamps < pd.Timestamp("2024-09-11", tz="Etc/GMT-2")).to_numpy()
    use = series[f"{sensor}.measured"].notna().to_numpy()
    line = np.linalg.lstsq(x[seen], y[seen], rcond=None)[0]
    error = x @ line - y
    return (
        float(np.sqrt(np.mean(error[seen & use] ** 2))),
        float(np.sqrt(np.mean(error[~seen & use] ** 2))),
    )


def test_the_wall_bench_is_accurate_on_blind_days(wall: Done, data_dir: Path) -> None:
    sensors, series = wall.content["sensors"], wall.table("series")
    # The expected reading has the estimated offset of the sensor, which is no error of the model.
    seen = pd.to_datetime(series["time"], utc=True) < pd.Timestamp("2024-09-11", tz="Etc/GMT-2")
    blind = {
        name: float(np.sqrt(((series[f"{name}.expected"] - series[f"{name}.measured"])[~seen] ** 2).mean()))
        for name in ("interface", "insulation")
    }
    assert blind["interface"] <= 0.15
    assert blind["insulation"] <= 0.35
    for name, column in (("interface", "T_interface_2"), ("insulation", "T_ins_2")):
        _, regression = static_regression(data_dir, series, column, name)
        assert blind[name] < regression, name
        assert blind[name] < 0.3 * sensors[name]["blind"]["nominal"]["rmse"]
    assert wall.content["ledger"]["closure"] <= 1e-10


def test_every_estimate_of_the_wall_bench_on_a_bound_has_a_reason(wall: Done) -> None:
    for path, entry in wall.content["parameters"].items():
        low, high = entry["range"]
        on_bound = min(entry["fitted"] - low, high - entry["fitted"]) <= 1e-3 * (high - low)
        assert not on_bound or entry.get("reason"), path


def test_the_stuck_sensor_of_the_wall_bench_is_found(wall: Done) -> None:
    stuck = [entry for entry in wall.content["quality"] if entry["kind"] == "stuck"]
    assert [entry["channel"] for entry in stuck] == ["T_ins_1"]
    assert stuck[0]["start"].startswith("2024-09-07T05:0")
    assert stuck[0]["end"].startswith("2024-09-14T23:59")
    assert "T_ins_1: stuck from 2024-09-07 05:0" in wall.said
