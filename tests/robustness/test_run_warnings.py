"""Warnings of a run at every entrance: each gives what a single run of the same building gives."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

import mascarin as mc
from design_support import written as design_written
from mascarin import cli
from mascarin.building import Building
from mascarin.ensemble import sweep_into
from mascarin.ensemble.objectives import Statistic
from mascarin.examples import box, box_climate
from mascarin.pages.explore import Session
from mascarin.simulation import Mean, state_space
from mascarin.simulation.checks.step_check import LARGE, SHARES
from mascarin.simulation.nominal import of_nominal, of_short_run
from mascarin.simulation.preparation.options import SCHEMES
from mascarin.simulation.run_warnings import of_members
from study_support import BUILDING, STUDY, logger_table

LATE = "is too long for its air"
CLIMATE = box_climate()
TAMPA = mc.Climate.shipped("tampa")
PLACE = {"site.latitude": 27.97, "site.longitude": -82.53, "site.altitude": 6, "site.timezone": "UTC-5"}
YEAR = TAMPA.index[0].year
DAYS = {"start": f"{YEAR}-07-01", "end": f"{YEAR}-07-05"}


@pytest.fixture(scope="module")
def sheet() -> Building:
    """The box of bare steel sheet, whose air reacts faster than a step of three hours."""
    name = next(iter(box().materials))
    steel = {"conductivity": 50, "density": 7800, "specific_heat": 480}
    layer = f"constructions.{next(iter(box().constructions))}.layers"
    return box().replace({f"materials.{name}": steel, layer: [{"material": name, "thickness": 0.001}]})


@pytest.fixture(scope="module")
def said(sheet: Building) -> tuple[str, ...]:
    lines = mc.simulate(sheet, CLIMATE, step="3h").warnings
    assert LATE in lines[0]
    assert "cannot enclose it" in lines[-1]  # of the building
    return lines


@pytest.fixture(scope="module")
def tampa(sheet: Building) -> Building:
    return sheet.replace(PLACE)


@pytest.fixture(scope="module")
def exact(tampa: Building) -> np.ndarray:
    run = mc.simulate(tampa, TAMPA, step="2min", outputs=["room.air_temperature"], **DAYS)  # type: ignore[arg-type]
    return run.every("3h").records[:, 0]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_long_step_is_said_with_every_scheme(tampa: Building, exact: np.ndarray, scheme: str) -> None:
    """Where it is said the error is that large, and with the step that is named it is below the limit."""
    options = {"outputs": ["room.air_temperature"], "scheme": scheme, **DAYS}

    def error(run: mc.Results) -> float:
        return float(np.sqrt(np.mean((run.every("3h").records[3:, 0] - exact[3:]) ** 2)))

    late = mc.simulate(tampa, TAMPA, step="3h", **options)  # type: ignore[arg-type]
    (line, *_) = [text for text in late.warnings if LATE in text]
    estimate = float(line.split("wrong by about ")[1].split()[0])
    assert error(late) > 0.5 * LARGE
    assert 0.4 * error(late) < estimate < 3.0 * error(late)
    better = f"{line.split('take a step of ')[1].split()[0]}min"
    assert error(mc.simulate(tampa, TAMPA, step=better, **options)) < LARGE  # type: ignore[arg-type]


def test_every_scheme_has_its_share() -> None:
    assert set(SHARES) == set(SCHEMES)


def test_an_air_that_is_not_recorded_is_watched_too(sheet: Building, said: tuple[str, ...]) -> None:
    run = mc.simulate(sheet, CLIMATE, step="3h", outputs=["facade.outside_temperature"])
    assert run.warnings == said
    assert run.records.shape[1] == 1


def test_files_have_the_warnings(sheet: Building, said: tuple[str, ...], tmp_path: Path) -> None:
    simulation = mc.Simulation(sheet, CLIMATE, step="3h")
    for ending in ("nc", "csv"):
        stored = simulation.run_into(tmp_path / f"run.{ending}")
        assert stored.finished.warnings == said
        assert mc.Results.open(stored.path).warnings == said


def test_sweeps_have_the_warnings_of_members_and_of_the_building(
    sheet: Building, said: tuple[str, ...], tmp_path: Path
) -> None:
    layer = f"constructions.{next(iter(sheet.constructions))}.layers.0.thickness"
    path = next(p.path for p in sheet.parameters() if p.path.endswith("thickness")) or layer
    samples = {path: [0.001, 0.2, 0.0012]}
    members = mc.sweep(sheet, CLIMATE, samples, step="3h", outputs=["room.air_temperature"])
    lines = members.attrs["warnings"]
    assert lines[0].startswith("2 of 3 members: the time step of 180 min is too long for the air of a zone")
    assert lines[1:] == [f"with the values of the building: {line}" for line in said]
    hidden = mc.sweep(sheet, CLIMATE, samples, step="3h", outputs=["facade.outside_temperature"])
    assert hidden.attrs["warnings"] == lines[1:]  # no air was recorded, the building is still checked
    hottest = {"hottest": Statistic.read("max:room.air_temperature")}
    store = sweep_into(tmp_path / "store", sheet, CLIMATE, samples, step="3h", objectives=hottest)
    assert store.warnings() == store.to_xarray().attrs["warnings"] == lines
    assert json.loads((tmp_path / "store" / "manifest.json").read_text())["warnings"] == lines[1:]
    again = sweep_into(tmp_path / "store", sheet, CLIMATE, samples, step="3h", objectives=hottest)
    assert again.warnings() == lines
    assert store.sound()
    assert "time_step_error" not in store.to_dataframe()


def test_members_that_failed_have_no_step_error() -> None:
    nan = np.nan
    assert of_members(*np.full((4, 1), nan), step_seconds=900.0) == []


def test_analyses_have_the_warnings(sheet: Building, said: tuple[str, ...]) -> None:
    base = [f"with the values of the building: {line}" for line in said]
    vary = {"surfaces.facade.outside.absorptance": (0.3, 0.9), "zones.room.volume": (40.0, 60.0)}
    options = {"outputs": ["room.air_temperature"], "step": "3h"}
    analysis = mc.sensitivity_analysis(
        sheet,
        CLIMATE,
        vary=vary,
        method="morris",
        replicates=3,
        **options,  # type: ignore[arg-type]
    )
    assert analysis.warnings[-len(base) :] == tuple(base)
    slopes = mc.jacobian(sheet, CLIMATE, list(vary), **options)  # type: ignore[arg-type]
    assert slopes.attrs["warnings"] == list(said)
    assert mc.gradient(sheet, CLIMATE, Mean("room.air_temperature"), step="3h").warnings == said
    session = Session(sheet, CLIMATE, parameters=list(vary), options={"step": "3h"})
    assert session.run({})["warnings"] == list(said)


def test_a_short_run_says_what_the_whole_run_says(sheet: Building, said: tuple[str, ...]) -> None:
    simulation = mc.Simulation(sheet, CLIMATE, step="3h")
    assert of_nominal(simulation) == said
    assert LATE in of_short_run(simulation, 2 * 86400.0)[0]
    assert len(simulation.index) == 25  # it is as it was


def test_a_linear_model_has_the_warnings_of_the_building(said: tuple[str, ...]) -> None:
    linear = {"kind": "linearised", "reference": 20.0}
    building = box().replace({"zones.room.longwave": linear, "surfaces.facade.outside.longwave": linear})
    assert state_space(building).warnings == said[-1:]


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    """A study of a wall whose materials have a value in another unit."""
    odd = BUILDING.replace("range: [0.02, 0.06]}, density: 30,", "range: [0.02, 0.06]}, density: 0.05,")
    (tmp_path / "building.yaml").write_text(BUILDING, "utf-8")
    logger_table(tmp_path / "building.yaml").to_csv(tmp_path / "logger.csv", index_label="time")
    (tmp_path / "building.yaml").write_text(odd, "utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, "utf-8")
    return tmp_path


def test_validate_gives_the_warnings(bench: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli.main(["validate", str(bench / "study.yaml"), "-o", str(tmp_path / "out")])
    assert "warning: nominal: materials.insulation: a diffusivity of" in capsys.readouterr().err
    content = json.loads((tmp_path / "out" / "validation.json").read_text())
    assert content["warnings"][0].startswith("nominal: materials.insulation: a diffusivity of")


def test_designs_have_the_warnings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = design_written(
        tmp_path, uncertainty=None,
        variables={"thickness": {"path": "constructions.ceiling.layers.pcm.thickness", "values": [0.005]}},
        objectives={"hot": {"kind": "degree_hours", "zones": ["room"], "above": 27}},
    )  # fmt: skip
    text = (tmp_path / "building.yaml").read_text()
    (tmp_path / "building.yaml").write_text(text.replace("RT28HC", "RT25HC"))
    cli.main(["design", str(file if file.is_file() else tmp_path / "design.yaml"), "-o", str(tmp_path / "o")])
    line = "tampa: with the values of the building: materials.pcm: RT25HC freezes by its cooling curve"
    assert f"warning: {line}" in capsys.readouterr().err
    assert json.loads((tmp_path / "o" / "design.json").read_text())["warnings"][0].startswith(line)
    assert "RT25HC freezes by its cooling curve" in (tmp_path / "o" / "report.html").read_text()


def test_commands_give_the_warnings(
    sheet: Building, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    room = tmp_path / "sheet.yaml"
    sheet.replace(PLACE).to_yaml(room)
    weather = ["--weather", "shipped:tampa", "--step", "3h"]
    days = ["--start", DAYS["start"], "--end", DAYS["end"]]
    page = tmp_path / "page.html"
    assert cli.main(["run", str(room), *weather, *days, "--report", str(page)]) == 0
    err = capsys.readouterr().err
    assert err.count(LATE) == err.count("cannot enclose it") == 1
    assert LATE in page.read_text(encoding="utf-8")
    assert cli.main(["fmu", str(room), *weather, *days, "-o", str(tmp_path / "u.fmu")]) == 0
    assert LATE in capsys.readouterr().err
    assert zipfile.is_zipfile(tmp_path / "u.fmu")
