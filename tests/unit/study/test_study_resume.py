"""A study that is killed again and again ends with the same result, and does nothing twice."""

from __future__ import annotations

from dataclasses import is_dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin._io import atomic
from mascarin.study import Study
from mascarin.study.context import step_cache as kept
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.findings import PredictionIntervals
from study_support import BUILDING, STUDY, Bench, logger_table


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    text = STUDY.replace("offset: 0, uncertainty: 0.2}", "standard_uncertainty: 0.05, offset: 0.03}")
    (tmp_path / "study.yaml").write_text(text.replace("limit: 0.25", "limit: 0.01"), encoding="utf-8")
    logger_table(tmp_path / "building.yaml").to_csv(tmp_path / "logger.csv")
    return Bench(tmp_path)


class Killed(BaseException):
    """Stands for the end of the process."""


def test_a_study_that_is_killed_after_every_few_results_ends(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, pieces = tmp_path / "whole", tmp_path / "pieces"
    results = Study.from_yaml(bench.study).run(whole, figures=False)
    # A criterion is missed, so that all steps are done.
    assert results.error_sources is not None
    write, left = atomic.write, 0

    def counted(path: Path, content: Any, *kind: str) -> Path:
        nonlocal left
        written = write(path, content, *kind)
        if path.name.startswith(kept.NAME) or path.suffix == ".npy":
            left -= 1
            if left == 0:
                raise Killed
        return written

    monkeypatch.setattr(atomic, "write", counted)
    starts, numbers = 0, []
    while not (pieces / "report.html").exists():
        starts, left = starts + 1, 12
        assert starts < 60
        try:
            Study.from_yaml(bench.study).run(pieces, figures=False)
        except Killed:
            numbers.append(len(list((pieces / ".work").iterdir())))
    assert starts > 2
    # Every start adds results: nothing that was kept is computed again.
    assert all(after > before for before, after in pairwise(numbers))
    for name in ("study.json", "tables/series.csv", "tables/parameters.csv", "tables/causes.csv"):
        assert (pieces / name).read_bytes() == (whole / name).read_bytes(), name
    assert not list((pieces / ".work").glob("kept-*"))


def test_what_is_left_is_worked_out_only_when_an_aim_is_missed(bench: Bench) -> None:
    bench.edit("limit: 0.01", "limit: 2.0")
    results = Study.from_yaml(bench.study).run()
    assert results.passed
    assert results.error_sources is None
    assert "shortfall" not in results.to_dict()


def test_results_are_kept_with_all_bits(tmp_path: Path) -> None:
    made = PredictionIntervals(
        0.95,
        np.array([[1.0 / 3.0, np.nan]]),
        np.zeros((1, 2)),
        np.ones(2),
        {"blind": np.array([0.5])},
        np.ones(1),
    )
    problem, calls = object(), []

    def make() -> tuple[Any, ...]:
        calls.append(1)
        return made, problem, {"a": [1, 2.5, None]}, np.float64(0.1)

    with Workspace(tmp_path / "out", {"a": 1}) as workspace:
        first = kept.kept(workspace, "key", make, (problem,))
        again = kept.kept(workspace, "key", make, (problem,))
        assert len(calls) == 1
        assert first[0] is made
        np.testing.assert_array_equal(again[0].half_width, made.half_width)
        assert again[1] is problem
        assert again[2:] == ({"a": [1, 2.5, None]}, 0.1)
        for file in workspace.folder.glob("kept-*"):
            file.write_bytes(file.read_bytes()[:100])
        kept.kept(workspace, "key", make, (problem,))
        assert len(calls) == 2


def test_only_dataclasses_of_this_package_are_read() -> None:
    with pytest.raises(ValueError, match="os"):
        kept._class("os:system")
    for where in ("_io.durations:seconds_of", "errors:InputError", "study.findings:Gone", "nowhere:X"):
        with pytest.raises(TypeError, match=where):
            kept._class(f"mascarin.{where}")
    for module, names in kept.CLASSES.items():
        for name in names:
            assert is_dataclass(kept._class(f"{module}:{name}"))
