"""No report of other inputs is left where a study runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.report import Series, write
from mascarin.study.storage import Workspace

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


def test_a_report_of_other_inputs_is_removed_before_anything_is_computed(out: Path) -> None:
    # The study may be interrupted at any later time: the old report is no longer there.
    with (
        pytest.warns(UserWarning, match=r"different: building.*the old report is removed"),
        Workspace(out, INPUTS | {"building": "c"}),
    ):
        assert not (out / "report.html").exists()


def test_a_report_without_a_record_of_its_inputs_is_removed(out: Path) -> None:
    (out / ".work" / "results.json").unlink()
    with Workspace(out, INPUTS):
        assert not (out / "report.html").exists()


def test_another_page_of_that_name_stays(tmp_path: Path) -> None:
    mine = tmp_path / "report.html"
    mine.write_text("<!doctype html><title>Mine</title>", encoding="utf-8")
    with Workspace(tmp_path, INPUTS):
        assert mine.exists()
