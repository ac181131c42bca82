"""Temperatures without a cause: what a run, its files and the command line say of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.ensemble import sweep_into
from mascarin.examples import box, box_climate
from mascarin.simulation.checks.judgement import Judgement, ensemble_warnings
from mascarin.simulation.preparation.engine_run import CompiledRun
from mascarin.simulation.preparation.run_results import EnsembleRun

#: What the engine says of a run: step, place, temperature, bound and range of the causes.
OUTLIER = (5, "surface roof (inside)", -41.3, -2.0, 22.0)


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
    assert len(run.warnings) == 1, run.warnings  # that its one wall cannot enclose it
    assert run.judgement == Judgement()
    simulation = mc.Simulation(box(), box_climate(), step="1h")
    members = simulation.ensemble(np.tile(simulation.values, (9, 1)))
    assert members.outside.shape == (9,)
    assert (members.outside == members.outside[0]).all()
    assert members.outside[0] <= 0.0


@pytest.mark.usefixtures("unsound")
@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_an_unsound_run_says_where_when_and_what_to_do(tmp_path: Path, ending: str) -> None:
    run = mc.simulate(box(), box_climate(), step="1h")
    assert not run.sound
    line, shell = run.warnings
    assert "all that acts on it" in line
    assert shell.startswith("zones.room: the surfaces cannot enclose it")
    assert line.startswith("surface roof (inside): -41.3 degC in step 5 from ")
    assert "the lowest is -2.0 degC), by 39 K: do not use" in line
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
    period = ["--start", "2001-01-01", "--end", "2001-01-03"]
    code = cli.main(["run", "box.yaml", "--weather", "shipped:golden", *period, *options])
    assert code == 1
    assert "surface roof (inside): -41.3 degC" in capsys.readouterr().err


def test_members_are_counted() -> None:
    closed = np.zeros(4)
    assert ensemble_warnings(closed[:3], np.array([0.0, -3.0, np.nan])) == []
    (line,) = ensemble_warnings(closed, np.array([0.0, 2.5, np.nan, 0.1]), first=8)
    assert line.startswith("2 of 4 members: ")
    assert "by 2.5 K more" in line
    assert "(member 9)" in line
    assert "Take a shorter step" in line


@pytest.mark.parametrize("precision", ["double", "single"])
def test_an_ensemble_says_which_members_are_unsound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, precision: Any
) -> None:
    ensemble = CompiledRun.ensemble

    def judged(self: CompiledRun, vectors: Any, **options: Any) -> EnsembleRun:
        run = ensemble(self, vectors, **options)
        # By a parameter, as a member of any chunk.
        hot = vectors[:, self.paths.index("surfaces.facade.outside.absorptance")] > 0.72
        return replace(run, outside=np.where(hot, 4.5, run.outside))

    monkeypatch.setattr(CompiledRun, "ensemble", judged)
    samples = {"surfaces.facade.outside.absorptance": list(np.linspace(0.1, 0.9, 17))}
    options: dict[str, Any] = {"step": "1h", "precision": precision, "outputs": ["room.air_temperature"]}
    members = mc.sweep(box(), box_climate(), samples, **options)
    store = sweep_into(tmp_path / "store", box(), box_climate(), samples, **options)
    for lines in (members.attrs["warnings"], store.warnings(), store.to_xarray().attrs["warnings"]):
        # The box has one wall of 54 m2 and a volume: that is said, too, and nothing else.
        assert len(lines) == 2, lines
        assert lines[0].startswith("4 of 17 members: temperatures lie outside")
        assert lines[1].startswith("with the values of the building: zones.room: the surfaces cannot enclose")
    np.testing.assert_array_equal(store.to_dataframe()["outside"].to_numpy(), members["outside"].to_numpy())
    assert members["outside"].attrs["units"] == "K"
