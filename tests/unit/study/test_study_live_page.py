"""The page beside the report of a study, in which the calibrated building runs."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from mascarin._io import atomic
from mascarin.building import load
from mascarin.building.building import Building
from mascarin.errors import InputError
from mascarin.pages import study as report
from mascarin.pages.live import engine, sliders
from mascarin.pages.study.data.folder import read_folder
from mascarin.pages.study.sections import summary
from mascarin.simulation import Simulation
from mascarin.study import Study, StudyResults
from mascarin.study.context.storage import Workspace
from mascarin.study.results import live_page
from mascarin.study.results.files import write_all
from mascarin.study_document.document import StudyDocument
from study_support import BUILDING, STUDY, Bench, drivers, logger_table

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from mascarin.study.results.live_page import PageContent

JOINT = "wall.interface_1_temperature"


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("bench")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return Bench(folder)


@dataclass(frozen=True)
class Done:
    out: Path
    said: str

    def facts(self) -> dict[str, Any]:
        """What the study says of its page."""
        content: dict[str, Any] = json.loads((self.out / "run.json").read_text(encoding="utf-8"))
        live: dict[str, Any] = content["live"]
        return live

    def told(self) -> dict[str, Any]:
        """What the script of the page reads."""
        text = (self.out / "model.html").read_text(encoding="utf-8")
        found = re.search(r'id="page-data">(.*?)</script>', text, re.DOTALL)
        assert found is not None
        content: dict[str, Any] = json.loads(found[1])
        return content


@pytest.fixture(scope="module")
def done(bench: Bench) -> Done:
    """A study by the command, with measured values in its page."""
    from contextlib import redirect_stderr
    from io import StringIO

    out, said = bench.folder / "out", StringIO()
    with redirect_stderr(said):
        code = cli.main(["study", str(bench.study), "-o", str(out), "--no-figures", "--page", "measured"])
    assert code in (0, 1), said.getvalue()
    return Done(out, said.getvalue())


@pytest.fixture(scope="module")
def results(bench: Bench) -> StudyResults:
    return Study.from_yaml(bench.study).run()


@pytest.fixture
def workspace(results: StudyResults, tmp_path: Path) -> Iterator[Workspace]:
    with Workspace(tmp_path / "out", results.context.identity()) as opened:
        yield opened


def written(results: StudyResults, workspace: Workspace, page: PageContent) -> str:
    """The report, where everything of the study is written; its results are recorded."""
    files = write_all(results, workspace, figures=False, page=page)
    written_to = report.write(workspace.out / "report.html", *read_folder(workspace.out))
    workspace.record("study", files)
    return written_to.read_text(encoding="utf-8")


def test_sliders_are_the_estimates_and_intervals_of_the_study(done: Done) -> None:
    content = json.loads((done.out / "study.json").read_text(encoding="utf-8"))
    entries = {slider["path"]: slider for slider in done.told()["sliders"]}
    assert list(entries) == list(content["parameters"]) == done.facts()["sliders"]
    assert len(entries) == 4
    for path, parameter in content["parameters"].items():
        slider = entries[path]
        assert slider["value"] == pytest.approx(parameter["fitted"], rel=1e-5)
        assert slider["interval"] == pytest.approx([parameter["low"], parameter["high"]], rel=1e-5)
        assert slider["low"] <= slider["interval"][0] < slider["interval"][1] <= slider["high"]


def test_report_and_terminal_name_the_page(done: Done) -> None:
    text = (done.out / "report.html").read_text(encoding="utf-8")
    assert text.count('<a href="model.html">model.html</a>') == 1
    assert "(1 Mar 2023 00:00 to 9 Mar 2023 23:30) beside the measured values, with sliders for its 4" in text
    assert f"the calibrated building runs in: {done.out / 'model.html'}" in done.said
    named = json.loads((done.out / ".work" / "results.json").read_text(encoding="utf-8"))
    assert "model.html" in named["study"]["files"]


def test_measured_values_are_those_of_the_sensors(done: Done, bench: Bench) -> None:
    told = done.told()
    assert told["curves"] == [JOINT, "core.temperature"]
    packed = (done.out / "model.html").read_text(encoding="utf-8")
    assert "Simulated minus measured" in packed
    assert told["sizes"][3] > 1000


def test_without_being_asked_the_page_has_no_measured_values(
    results: StudyResults, workspace: Workspace
) -> None:
    assert 'href="model.html"' in written(results, workspace, "model")
    told = Done(workspace.out, "").told()
    assert told["sizes"][3] == len("{}")
    assert told["base"] == "calibrated.yaml"
    assert (told["step"], told["rows"]) == (1800, 9 * 48)


def test_a_study_without_the_page_removes_the_one_before(results: StudyResults, workspace: Workspace) -> None:
    longer = written(results, workspace, "model")
    assert (workspace.out / "model.html").is_file()
    shorter = written(results, workspace, "none")
    assert not (workspace.out / "model.html").exists()
    assert "model.html" not in shorter
    assert "live" not in json.loads((workspace.out / "run.json").read_text(encoding="utf-8"))
    # One sentence.
    assert 0 < len(longer) - len(shorter) < 600


def test_without_the_engine_for_browsers_the_report_says_how_to_get_it(
    results: StudyResults, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    written(results, workspace, "model")
    monkeypatch.setattr(engine, "FILE", "missing.wasm")
    monkeypatch.setattr(engine, "module", engine.read)
    text = written(results, workspace, "model")
    assert not (workspace.out / "model.html").exists()
    assert "There is no page in which the calibrated building runs: mascarin/pages/live/missing.wasm" in text
    assert "rustup target add wasm32-unknown-unknown &amp;&amp; make build" in text
    assert "href" not in Done(workspace.out, "").facts()["refusal"]


def test_a_study_that_ends_while_it_writes_the_page_is_continued(
    results: StudyResults, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Killed(BaseException):
        """Stands for the end of the process."""

    write = atomic.write

    def killed(path: Path, content: Any, *kind: str) -> Path:
        result = write(path, content, *kind)
        if path.name == "model.html":
            raise Killed
        return result

    with monkeypatch.context() as context:
        context.setattr(atomic, "write", killed)
        with pytest.raises(Killed):
            written(results, workspace, "model")
    left = (workspace.out / "model.html").read_bytes()
    assert 'href="model.html"' in written(results, workspace, "model")
    assert (workspace.out / "model.html").read_bytes() == left


def test_an_input_is_not_replaced_by_the_page(bench: Bench, tmp_path: Path) -> None:
    """A table of that name in the folder of the results."""
    out = tmp_path / "out"
    out.mkdir()
    table = out / "model.html"
    table.write_bytes(bench.table.read_bytes())
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    study = STUDY.replace("table: logger.csv", "table: out/model.html")
    (tmp_path / "study.yaml").write_text(study, encoding="utf-8")
    assert cli.main(["study", str(tmp_path / "study.yaml"), "-o", str(out), "--no-figures"]) == 2
    assert table.read_bytes() == bench.table.read_bytes()


def test_another_choice_of_page_is_refused(bench: Bench) -> None:
    with pytest.raises(InputError, match=r"page: found 'always', expected model, measured, none"):
        Study.from_yaml(bench.study).run(page="always")  # type: ignore[arg-type]


def test_of_a_long_record_the_days_that_were_not_identified_on_are_run(tmp_path: Path) -> None:
    table = drivers(days=20)
    for name in ("joint", "core"):
        table[name] = table["room"]
    table.to_csv(tmp_path / "logger.csv")
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    context = Study.from_yaml(tmp_path / "study.yaml").context
    start, end = live_page.period(context)
    # The identification ends on 6 March: the days after it are all there is.
    assert (start, end) == (
        pd.Timestamp("2023-03-06", tz="UTC+01:00"),
        pd.Timestamp("2023-03-20", tz="UTC+01:00"),
    )


def test_parameters_without_a_slider_are_named() -> None:
    live = {
        "file": "model.html",
        "period": ["2010-08-01T00:00:00", "2010-08-15T00:00:00"],
        "sliders": ["surfaces.roof.outside.absorptance"],
        "fixed": ["weather.columns.sun.gain"],
    }
    words = str(summary.live_words(StudyDocument.read({"live": live})))
    assert "(1–14 Aug 2010), with a slider for 1 of its 2 calibrated parameters (not " in words
    assert "measured" not in words
    all_of_them = str(summary.live_words(StudyDocument.read({"live": live | {"fixed": []}})))
    assert all_of_them.endswith("with a slider for its calibrated parameter.")
    refusal = summary.live_words(StudyDocument.read({"live": {"refusal": "a <b> c; do d"}}))
    assert str(refusal).endswith("runs: a &lt;b&gt; c; do d")
    assert summary.live_words(StudyDocument.read({})) is None


def resealed(building: Building, **changes: Any) -> Building:
    """The building with another posterior."""
    posterior = building.posterior
    assert posterior is not None
    fields = {name: getattr(posterior, name) for name in type(posterior).model_fields if name != "checksum"}
    return building.replace({"posterior": type(posterior).sealed(**fields | changes)})


def test_intervals_that_the_study_does_not_state_are_not_drawn(results: StudyResults) -> None:
    building = results.building
    parameter = building.parameter("surfaces.wall.outside.absorptance")
    stated = sliders.plain(results.fitted.simulation, parameter)
    assert "interval" not in stated  # of the building of the run, which has no posterior
    for which in (True, False):
        carried = resealed(building, stated=which)
        simulation = results.context.models.of_building(carried)
        slider = sliders.plain(simulation, carried.parameter(parameter.path))
        assert ("interval" in slider) == which
        assert ("interval" in slider["estimate"]) == which


def test_a_page_without_any_slider_is_refused_with_its_reasons(results: StudyResults, tmp_path: Path) -> None:
    path = "site.latitude"
    building = resealed(
        results.building, intervals={path: (45.0, 44.0, 46.0)}, numbers={}, sample=f"{path}\n45\n"
    )
    entry = live_page.write_page(results.context, building, tmp_path, "model")
    assert entry.refusal.startswith("none of the calibrated parameters can have a slider (site.latitude: ")
    assert "structural" in entry.refusal
    assert list(tmp_path.iterdir()) == []


@pytest.mark.browser
def test_the_page_has_the_bits_of_runs_of_the_calibrated_building(
    done: Done, bench: Bench, wasm: Path, page: Page
) -> None:
    assert wasm.is_file()
    study = Study.from_yaml(bench.study)
    building, told = load(done.out / "calibrated.yaml"), done.told()
    parameters = [building.parameter(slider["path"]) for slider in told["sliders"]]
    names = [output["name"] for output in told["outputs"]]
    simulation = Simulation(
        building, study.climate, measurements=study.measurements, step="30min", outputs=names,
        start="2023-03-01 00:00", end="2023-03-09 23:30",
        ranges={each.path: (each.low, each.high) for each in parameters},
    )  # fmt: skip
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((done.out / "report.html").as_uri())
    page.click('a[href="model.html"]')
    page.wait_for_selector("body[data-ready=true]", state="attached")
    rng, distinct = np.random.default_rng(3), set()
    for count in range(3):
        values = {each.path: float(rng.uniform(each.low, each.high)) for each in parameters if count}
        columns = page.evaluate(
            "async (values) => { const result = await mascarin.run(values);"
            " return mascarin.data.outputs.map(({ column }) => [...result.column(column)]); }",
            values,
        )
        expected = simulation.run(values).records
        assert np.array_equal(np.array(columns).T, expected), values
        distinct.add(expected.tobytes())
    assert len(distinct) == 3
    assert said == []
