"""The kind of a warning decides the exit code: it travels with the text through every file and process."""

from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import mascarin as mc
from crossing_entrances import Bench, enter
from crossing_features import description
from mascarin.commands.options.exit_code import exit_code
from mascarin.ensemble import sweep_into
from mascarin.ensemble.store import Store
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.simulation.checks.judgement import Judgement
from mascarin.simulation.checks.warning_kinds import UNSOUND, RunWarning, WarningKind, with_kinds
from mascarin.simulation.preparation.engine_run import CompiledRun
from mascarin.study.context.step_cache import _decoded, _encoded

DAMP = {"humidity": {"zones": {"room": {"gains": {"people": {"power": 100}}}}}}


@pytest.mark.parametrize("kind", WarningKind)
def test_the_kind_counts_and_not_the_words(kind: WarningKind) -> None:
    misleading = "the energy balance does not close: do not use these results"
    for line in (RunWarning(misleading, kind), RunWarning(misleading, kind).after("tampa")):
        assert exit_code(warnings=[line]) == (1 if kind in UNSOUND else 0)


def test_a_kind_goes_through_processes_and_kept_results() -> None:
    line = RunWarning("roof: 70 degC", WarningKind.CAUSE)
    arrays: dict[str, Any] = {}
    copies = [pickle.loads(pickle.dumps(line)), _decoded(_encoded((line,), arrays, ()), arrays, ())[0]]  # noqa: S301
    for copy in copies:
        assert copy == line == "roof: 70 degC"
        assert copy.kind is WarningKind.CAUSE


@pytest.fixture
def open_vapour(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run of the engine has a vapour balance that does not close."""
    run_into = CompiledRun.run_into

    def run(self: CompiledRun, *arguments: Any, **options: Any) -> dict[str, Any]:
        raw = run_into(self, *arguments, **options)
        return {**raw, "vapour": {**raw["vapour"], "closure": 2e-8}}

    monkeypatch.setattr(CompiledRun, "run_into", run)


@pytest.mark.usefixtures("open_vapour")
@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_an_open_vapour_balance_is_unsound(tmp_path: Path, ending: str) -> None:
    run = mc.simulate(box().replace(DAMP), box_climate(), step="1h")
    assert run.energy.closes
    assert not run.sound
    (line,) = [line for line in run.warnings if line.kind is WarningKind.VAPOUR_BALANCE]
    assert "2.0e-08 of all vapour exchanged" in line
    run.write(tmp_path / f"run{ending}")
    read = mc.Results.open(tmp_path / f"run{ending}")
    assert not read.sound
    assert [line.kind for line in read.warnings] == [line.kind for line in run.warnings]


@pytest.mark.usefixtures("open_vapour")
@pytest.mark.parametrize("name", ["run", "sweep", "fmu", "design", "calibrate", "validate", "genopt"])
def test_an_open_vapour_balance_ends_with_1(name: str, tmp_path: Path) -> None:
    told = enter(name, Bench(tmp_path / "room", description("humidity")))
    assert told.code == 1, told.text[-2000:]
    assert "vapour balance does not close" in " ".join(told.text.split())


def test_a_finished_sweep_that_is_read_again_has_the_kinds(tmp_path: Path) -> None:
    samples = {"surfaces.facade.outside.absorptance": [0.2, 0.8]}
    options: dict[str, Any] = {"step": "1h", "outputs": ["room.air_temperature"]}
    store = sweep_into(tmp_path / "store", box(), box_climate(), samples, **options)
    manifest = json.loads((tmp_path / "store" / "manifest.json").read_text())
    assert manifest["warning_kinds"] == [WarningKind.BUILDING.value]
    manifest["warning_kinds"] = [WarningKind.CAUSE.value]
    (tmp_path / "store" / "manifest.json").write_text(json.dumps(manifest))
    assert exit_code(warnings=Store(tmp_path / "store").warnings()) == 1
    assert exit_code(warnings=store.warnings()) == 0
    del manifest["warning_kinds"]  # of an earlier version
    (tmp_path / "store" / "manifest.json").write_text(json.dumps(manifest))
    assert [line.kind for line in Store(tmp_path / "store").warnings()] == [WarningKind.UNKNOWN]
    for damaged in ([], ["odd"], [WarningKind.CAUSE.value, WarningKind.CAUSE.value]):
        (tmp_path / "store" / "manifest.json").write_text(json.dumps({**manifest, "warning_kinds": damaged}))
        with pytest.raises(InputError, match="warning_kinds"):
            Store(tmp_path / "store")
    with pytest.raises(ValueError, match="odd"):
        with_kinds(["text"], ["odd"])


def test_the_step_that_is_named_has_no_overshoot() -> None:
    """A part of one time constant overshoots by |R(z)| of a jump; in steps that are named, not at all."""
    diagonal = 1.0 - math.sqrt(0.5)

    def factor(z: float) -> float:
        return (1.0 - (1.0 - 2.0 * diagonal) * z) / (1.0 + diagonal * z) ** 2

    for z in (3.0, 5.0, 8.2, 12.0, 40.0, 150.0):
        beyond = -20.0 * factor(z)
        judged = Judgement(beyond - 0.5, "roof", "step 4", -beyond, 0.0, 20.0)
        (line,) = judged.warnings(3600.0, "sdirk2")
        minutes = float(line.split("Take a step of ")[1].split()[0])
        assert factor(z * minutes / 60.0) >= -1e-12, z
    assert replace(judged, span=0.0).warnings(3600.0, "sdirk2")[0].count("Take a step of 15 min") == 1
