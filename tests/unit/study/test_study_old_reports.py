"""A report stays until a new one replaces it, and one of other inputs is said to be so."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.errors import SolverError
from mascarin.pages.study import Series, write
from mascarin.study.context.storage import Workspace

INPUTS = {"study": "a", "building": "b"}


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """A folder with the complete results of a study."""
    folder = tmp_path / "out"
    with Workspace(folder, INPUTS) as workspace:
        report = write(folder / "report.html", {"title": "Old"}, Series("2024-01-01T00:00", 900.0))
        workspace.record("study", [report])
    return folder


def test_a_report_of_the_same_inputs_stays(out: Path) -> None:
    with Workspace(out, INPUTS):
        assert (out / "report.html").exists()


def test_a_report_of_other_inputs_stays_until_a_new_one_replaces_it(out: Path) -> None:
    report = out / "report.html"
    before = report.read_bytes()
    with (
        pytest.warns(UserWarning, match=r"different: building.*the earlier report stays"),
        Workspace(out, INPUTS | {"building": "c"}) as workspace,
    ):
        # Another command of the folder, which writes no report.
        workspace.record("calibration", [])
    assert report.read_bytes() == before
    with Workspace(out, INPUTS | {"building": "c"}) as workspace:
        write(report, {"title": "New"}, Series("2024-01-01T00:00", 900.0))
        workspace.record("study", [report])
    assert report.read_bytes() != before


def test_a_study_that_fails_says_that_the_report_is_an_earlier_one(out: Path) -> None:
    before = (out / "report.html").read_bytes()
    with (
        pytest.warns(UserWarning, match="computed again|earlier state") as said,
        pytest.raises(SolverError),
        Workspace(out, INPUTS | {"building": "c"}),
    ):
        raise SolverError("step 4 did not converge")
    assert "report.html: of an earlier state of the study; it was not replaced" in str(said[-1].message)
    assert (out / "report.html").read_bytes() == before
    # The inputs are those of the last run now, and the report is still not theirs.
    with (
        pytest.warns(UserWarning, match="of an earlier state of the study"),
        pytest.raises(SolverError),
        Workspace(out, INPUTS | {"building": "c"}),
    ):
        raise SolverError("step 4 did not converge")


def test_a_study_of_the_same_inputs_that_fails_says_nothing_of_the_report(out: Path) -> None:
    with pytest.raises(SolverError), Workspace(out, INPUTS):
        raise SolverError("step 4 did not converge")
    assert (out / "report.html").exists()


def test_another_page_of_that_name_stays(tmp_path: Path) -> None:
    mine = tmp_path / "report.html"
    mine.write_text("<!doctype html><title>Mine</title>", encoding="utf-8")
    with Workspace(tmp_path, INPUTS):
        assert mine.exists()
