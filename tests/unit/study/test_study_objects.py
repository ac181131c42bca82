"""Studies made of objects, and studies of buildings with windows and ideal loads."""

from __future__ import annotations

import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.examples import SyntheticWall, synthetic_wall
from mascarin.simulation.checks.energy import FLOWS
from mascarin.simulation.simulation import Simulation
from mascarin.study import Sensor, Study, StudyResults
from mascarin.study.results.document.comparison import FLOW_LABELS
from mascarin.weather import Climate, Measurements

SENSOR = Sensor(column="joint", output="wall.interface_1_temperature", expanded_uncertainty=0.1)
PARAMETERS = ["materials.insulation.conductivity", "surfaces.wall.outside.absorptance"]
TRUE = {"materials.insulation.conductivity": 0.033, "surfaces.wall.outside.absorptance": 0.62}


@pytest.fixture(scope="module")
def wall() -> SyntheticWall:
    return synthetic_wall()


def options(wall: SyntheticWall, **changed: Any) -> dict[str, Any]:
    return {
        "building": wall.building,
        "climate": wall.climate,
        "measurements": wall.measurements,
        "sensors": {
            "joint": Sensor(column="joint", output="wall.interface_1_temperature", expanded_uncertainty=0.1)
        },
        "periods": {"identification": (pd.Timestamp("2023-03-03"), "2023-03-06")},
        "parameters": PARAMETERS,
        "criteria": [{"metric": "rmse", "limit": 0.2}],
        "step": "1h",
        **changed,
    }


@pytest.fixture(scope="module")
def study(wall: SyntheticWall) -> Study:
    return Study(**options(wall))


@pytest.fixture(scope="module")
def results(study: Study) -> StudyResults:
    return study.run()


def test_a_study_of_objects_finds_the_true_parameters(results: StudyResults) -> None:
    assert results.passed
    for path, value in TRUE.items():
        assert results.calibration.values[path] == pytest.approx(value, rel=0.05)  # noqa: PD011
    assert results.fitted.scores["joint"]["blind"].rmse == pytest.approx(0.05, rel=0.2)


def test_results_give_tables_and_a_report(results: StudyResults, tmp_path: Path) -> None:
    metrics = results.to_dataframe()
    assert set(metrics["model"]) == {"nominal", "fitted"}
    assert len(results.to_dataframe("series")) == len(results.context.observation.times)
    with pytest.raises(InputError, match="expected one of metrics, parameters"):
        results.to_dataframe("metric")
    page = results.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Validation summary" in page
    assert results.to_dict()["command"] == []


def test_descriptions_are_short(study: Study, results: StudyResults) -> None:
    for described in (study, results):
        assert len(repr(described).splitlines()) <= 15
        assert described._repr_html_().startswith("<div>")
    assert "3 of 3 met" in repr(results)


def test_studies_and_results_can_be_pickled(study: Study, results: StudyResults) -> None:
    again = pickle.loads(pickle.dumps(study))  # noqa: S301 (our own bytes)
    assert again.context.identity() == study.context.identity()
    assert again.context.models.nominal.identity == study.context.models.nominal.identity
    copy = pickle.loads(pickle.dumps(results))  # noqa: S301
    assert copy.to_dict() == results.to_dict()


def test_written_as_a_file_it_is_the_same_study(study: Study, results: StudyResults, tmp_path: Path) -> None:
    text = study.to_yaml(tmp_path / "study.yaml")
    assert text == study.to_yaml() == (tmp_path / "study.yaml").read_text(encoding="utf-8")
    read = Study.from_yaml(tmp_path / "study.yaml")
    assert read.context.models.nominal.identity == study.context.models.nominal.identity
    found = read.run(tmp_path / "out", figures=False)
    assert found.calibration.values == pytest.approx(results.calibration.values, rel=1e-9)  # noqa: PD011
    (tmp_path / "elsewhere").mkdir()
    read.to_yaml(tmp_path / "elsewhere" / "moved.yaml")
    moved = Study.from_yaml(tmp_path / "elsewhere" / "moved.yaml", allow_outside=True)
    assert moved.plan.sensors == study.plan.sensors
    assert moved.context.models.nominal.identity == study.context.models.nominal.identity


def test_progress_is_called_with_done_and_total(wall: SyntheticWall) -> None:
    seen: list[tuple[int, int]] = []
    study = Study(**options(wall, sensitivity={"replicates": 3}))
    found = study.run(progress=lambda done, total: seen.append((done, total)))
    assert found.sensitivity is not None
    assert any(done == total > 0 for done, total in seen)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"building": None}, "found no building, expected building, climate"),
        ({"parameters": "materials.brick.conductivity"}, "expected a list of paths"),
        ({"parameters": ["materials.brick.conduct"]}, r"materials.brick.conduct"),
        ({"parameters": {"materials.brick.conductivity": (2.0, 1.0)}}, "materials.brick.conductivity"),
        ({"sensors": {"joint": {"column": "joint", "output": "wall.nothing"}}}, "sensors.joint.output"),
        ({"periods": {}}, "identification"),
        ({"stepp": "1h"}, "Did you mean 'step'"),
        ({"path": "study.yaml"}, "found a file and building"),
    ],
)
def test_what_cannot_be_used_is_refused(wall: SyntheticWall, changed: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Study(**options(wall, **changed))


def test_ranges_given_as_pairs_are_used(wall: SyntheticWall) -> None:
    study = Study(**options(wall, parameters={PARAMETERS[0]: (0.03, 0.05), PARAMETERS[1]: None}))
    first, second = study.context.problem().parameters
    assert (first.lower, first.upper) == (0.03, 0.05)
    assert (second.lower, second.upper) == (0.2, 0.8)


# --- windows and ideal loads ----------------------------------------------------------------------------


INSULATION = {"material": "insulation", "thickness": 0.08}
IDEAL_LOADS = {"heating": {"setpoint": 20.0}, "cooling": {"setpoint": 22.0}}


def glazed() -> Building:
    """A box with a south window, heating and cooling."""
    wall = {
        "construction": "wall",
        "outside": {"outdoors": True, "absorptance": 0.6, "emissivity": 0.9, "convection": 15.0},
        "inside": {"zone": "room", "emissivity": 0.9, "absorptance": 0.5, "convection": 3.0},
    }
    sides = {"south": 180.0, "north": 0.0, "east": 90.0, "west": 270.0}
    surfaces: dict[str, Any] = {
        name: {**wall, "area": 12.0, "tilt": 90.0, "azimuth": azimuth} for name, azimuth in sides.items()
    }
    surfaces["roof"] = {**wall, "area": 16.0, "tilt": 0.0, "azimuth": 0.0}
    surfaces["floor"] = {
        "construction": "wall", "area": 16.0, "tilt": 180.0, "azimuth": 0.0,
        "outside": {"ground": {"temperature": 10.0}},
        "inside": {"zone": "room", "emissivity": 0.9, "absorptance": 0.5, "convection": 2.0},
    }  # fmt: skip
    return Building.model_validate(
        {
            "name": "Glazed box",
            "site": {"latitude": 45.0, "longitude": 5.0, "altitude": 200.0, "timezone": "UTC+1"},
            "materials": {
                "concrete": {"conductivity": 1.0, "density": 2000.0, "specific_heat": 900.0},
                "insulation": {
                    "conductivity": {"value": 0.05, "range": [0.02, 0.06]},
                    "density": 30.0,
                    "specific_heat": 1400.0,
                },
            },
            "constructions": {"wall": {"layers": [INSULATION, {"material": "concrete", "thickness": 0.1}]}},
            "zones": {"room": {"volume": 43.0, **IDEAL_LOADS}},
            "surfaces": surfaces,
            "glazings": {"double": {"kind": "simple", "u_value": 2.7, "solar_heat_gain": 0.6}},
            "windows": {"window": {
                    "surface": "south", "glazing": "double", "area": 5.0,
                    "outside": {"convection": 15.0}, "inside": {"convection": 3.0},
                }},
        }
    )  # fmt: skip


def sunny() -> Climate:
    """Six spring days with sun, cold nights and one hot day."""
    index = pd.date_range("2023-04-01", periods=144, freq="1h", name="time")
    hours = np.arange(144.0)
    table = pd.DataFrame(index=index)
    high = np.maximum(np.sin((hours % 24.0 + 0.5 - 6.5) * np.pi / 12.0), 0.0)
    table["global"], table["diffuse"] = 650.0 * high, 120.0 * high
    table["air"] = 6.0 + 7.0 * np.sin((hours - 9.0) * np.pi / 12.0) + 12.0 * (hours > 96.0)
    return Climate.from_table(
        table,
        timezone="UTC+1",
        columns={"air_temperature": "air", "global_horizontal": "global", "diffuse_horizontal": "diffuse"},
        absent=["wind_speed", "wind_direction", "dew_point"],
        latitude=45.0,
        longitude=5.0,
        altitude=200.0,
        check_sun=False,
    )


def test_a_windowed_building_with_heating_and_cooling_is_studied(tmp_path: Path) -> None:
    building, climate = glazed(), sunny()
    run = Simulation(
        building.replace({"materials.insulation.conductivity": 0.035}),
        climate,
        step="1h",
        end="2023-04-06 22:00",
        outputs=["roof.inside_temperature"],
    ).run()
    logged = pd.DataFrame({"roof": run.records[:, 0]}, index=run.index.tz_localize(None).rename("time"))
    logged["roof"] += np.random.default_rng(2).normal(0.0, 0.02, len(logged))
    study = Study(
        building=building,
        climate=climate,
        measurements=Measurements.from_table(logged, timezone="UTC+1"),
        sensors={"roof": {"column": "roof", "output": "roof.inside_temperature"}},
        periods={"identification": ("2023-04-02", "2023-04-04")},
        parameters=["materials.insulation.conductivity"],
        step="1h",
        identification={"starts": 1},
    )
    results = study.run(tmp_path, figures=False)
    assert results.calibration.values["materials.insulation.conductivity"] == pytest.approx(0.035, rel=0.03)  # noqa: PD011
    balance = results.to_dict()["ledger"]
    assert balance["closure"] < 1e-10
    terms = {term["label"]: term["value"] for term in balance["terms"]}
    for flow in ("transmitted", "glass", "heating"):
        assert terms[FLOW_LABELS[flow]] > 0.0, flow
    assert terms[FLOW_LABELS["cooling"]] < 0.0
    assert sum(terms.values()) == pytest.approx(0.0, abs=1e-6 * max(map(abs, terms.values())))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "solar radiation transmitted by windows" in page
    assert re.search(r"Relative energy-balance residual of the model “fitted”: \d", page)


def test_every_flow_has_a_label() -> None:
    assert tuple(FLOW_LABELS) == FLOWS


def test_a_column_that_is_sensor_and_input_is_masked_as_a_sensor_only(wall: SyntheticWall) -> None:
    """A stuck stretch is not compared, and drives the model with the values of the table all the same."""
    table = wall.measurements.data.copy()
    table.loc[table.index[100:140], "room"] = float(table["room"].iloc[100])
    measured = Measurements.from_table(table)
    sensors = {"joint": SENSOR, "air": Sensor(column="room", output="wall.inside_temperature", use=False)}
    study = Study(**options(wall, measurements=measured, sensors=sensors))
    assert [(s.channel, s.kind) for s in study.quality] == [("room", "stuck")]
    stuck = np.isnan(study.context.observation.measured)
    assert (stuck[:, 0].sum(), stuck[:, 1].sum()) == (0, 39)
    every = Study(**options(wall, measurements=measured, sensors=sensors, quality={"mask": []}))
    assert np.isfinite(every.context.observation.measured).all()
    runs = [opened.context.models.nominal.run() for opened in (study, every)]
    assert np.array_equal(runs[0].records, runs[1].records)
    again = study.with_measurements(measured)
    assert np.isfinite(again.context.models.nominal.run().records).all()


def test_a_study_writes_the_inputs_unmasked(wall: SyntheticWall, tmp_path: Path) -> None:
    table = wall.measurements.data.copy()
    table.loc[table.index[100:140], "room"] = float(table["room"].iloc[100])
    sensors = {"joint": SENSOR, "air": Sensor(column="room", output="wall.inside_temperature", use=False)}
    study = Study(**options(wall, measurements=Measurements.from_table(table), sensors=sensors))
    study.to_yaml(tmp_path / "study.yaml")
    read = Study.from_yaml(tmp_path / "study.yaml")
    assert read.context.inputs.driving.data["room"].notna().all()
    assert np.isnan(read.context.observation.measured[:, 1]).sum() == 39
