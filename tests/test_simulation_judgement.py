"""Temperatures without a cause: what a run, its files and the command line say of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.examples import box, box_climate
from mascarin.simulation.compiled import CompiledRun
from mascarin.simulation.judgement import Judgement, member_warnings

#: What the engine says of a run: step, place, temperature and bound.
OUTLIER = (5, "surface roof (inside)", -41.3, -2.0)


@pytest.fixture
def unsound(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run of the engine has a temperature without a cause."""
    run_into = CompiledRun.run_into

    def judged(self: CompiledRun, *arguments: Any, **options: Any) -> dict[str, Any]:
        return {**run_into(self, *arguments, **options), "outside": 7.5, "outlier": OUTLIER}

    monkeypatch.setattr(CompiledRun, "run_into", judged)


def test_a_sound_run_says_nothing() -> None:
    run = mc.simulate(box(), box_climate(), step="1h")
    assert run.sound
    assert run.judgement == Judgement()
    members = mc.Simulation(box(), box_climate(), step="1h").ensemble(
        np.array([mc.Simulation(box(), box_climate(), step="1h").values] * 9)
    )
    assert members.outside.shape == (9,)
    assert (members.outside == members.outside[0]).all()
    assert members.outside[0] <= 0.0


@pytest.mark.usefixtures("unsound")
@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_an_unsound_run_says_where_when_and_what_to_do(tmp_path: Path, ending: str) -> None:
    run = mc.simulate(box(), box_climate(), step="1h")
    assert not run.sound
    (line,) = [text for text in run.warnings if "acts on it" in text]
    assert line.startswith("surface roof (inside): -41.3 degC in step 5 from ")
    assert "the lowest is -2.0 degC), by 7.5 K more" in line
    assert "Take a step of 15 min" in line
    run.write(tmp_path / f"run{ending}")
    read = mc.Results.open(tmp_path / f"run{ending}")
    assert read == run
    assert not read.sound


@pytest.mark.usefixtures("unsound")
@pytest.mark.parametrize("options", [[], ["--json"], ["-o", "run.nc"], ["-o", "run.csv", "--interval", "1d"]])
def test_the_command_ends_with_exit_code_1(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], options: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    box().to_yaml("box.yaml")
    code = cli.main(
        ["run", "box.yaml", "--weather", "golden", "--start", "2001-01-01", "--end", "2001-01-03", *options]
    )
    assert code == 1
    assert "surface roof (inside): -41.3 degC" in capsys.readouterr().err


def test_members_are_counted() -> None:
    assert member_warnings(np.array([0.0, -3.0, np.nan]), 900.0) == []
    (line,) = member_warnings(np.array([0.0, 2.5, np.nan, 0.1]), 900.0, first=8)
    assert line.startswith("2 of 4 members: ")
    assert "by 2.5 K more" in line
    assert "(member 9)" in line
    assert "a step of 3 min" in line
