"""Inputs of studies of real experiments: new parts, measured powers, errors of sensors, units."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from mascarin.building import Building, json_schema, load
from mascarin.calibration import (
    CalibrationProblem,
    FitParameter,
    FitSensor,
    SearchOptions,
    calibrate,
    profiles,
    solve,
)
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.measurements import Sensor
from mascarin.weather import Measurements
from study_support import BUILDING, STUDY, TRUTH, Bench, logger_table, open_climate

JOINT = "joint: {column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}"


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    path = tmp_path_factory.mktemp("table") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return logger_table(path)


@pytest.fixture
def bench(tmp_path: Path, table: pd.DataFrame) -> Bench:
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    table.to_csv(tmp_path / "logger.csv")
    return Bench(tmp_path)


def test_a_change_adds_a_material_a_layer_and_a_window() -> None:
    changed = box().replace(
        {
            "materials.wool": {"conductivity": 0.035, "density": 30, "specific_heat": 1000},
            "constructions.wall.layers": [
                {"material": "wool", "thickness": 0.1},
                {"material": "concrete", "thickness": 0.2},
            ],
            "sensors.middle": {"surface": "facade", "depth": 0.05},
        }
    )
    assert [layer.name for layer in changed.constructions["wall"].layers] == ["wool", "concrete"]
    assert changed.output("middle.temperature").unit == "degC"
    thick = {"constructions.thin": {"layers": [{"material": "concrete", "thickness": 0.05}]}}
    other = box().replace({**thick, "surfaces.facade.construction": "thin"})
    assert other.surfaces["facade"].construction == "thin"
    with pytest.raises(InputError, match=r"materials\.wool"):
        box().replace({"materials.wool": {"conductivity": -1, "density": 30, "specific_heat": 1000}})
    with pytest.raises(InputError, match="found no such parameter"):
        box().replace({"material.wool": {"conductivity": 1}})


def test_the_schema_has_the_keys_that_are_read_first() -> None:
    schema = json_schema()
    assert schema["properties"]["extends"]["type"] == "string"
    assert schema["properties"]["set"]["type"] == "object"
    assert {"required": ["extends"]} in schema["anyOf"]


def test_a_measured_power_has_no_range_unless_it_is_given() -> None:
    def heated(power: Any, schedule: dict[str, Any]) -> Building:
        return box().replace(
            {
                "schedules.heater": schedule,
                "zones.room.gains": {"heater": {"power": power, "schedule": "heater"}},
            }
        )

    path, column = "zones.room.gains.heater.power", {"kind": "fraction", "column": "P"}
    measured = heated(2000, column).parameter(path)
    assert not measured.varies
    assert "measured column" in str(measured.reason)
    assert heated(2000, {"kind": "fraction", "value": 0.5}).parameter(path).high == pytest.approx(2600)
    given = heated({"value": 2000, "range": [1900, 2100]}, column).parameter(path)
    assert (given.low, given.high, given.varies) == (1900, 2100, True)


def test_validation_writes_series_with_units(bench: Bench, tmp_path: Path) -> None:
    bench.edit(JOINT, JOINT.removesuffix("}") + ", relative: 0.01}")
    out = tmp_path / "out"
    assert cli.main(["validate", str(bench.study), "-o", str(out)]) == 1
    series = pd.read_csv(out / "series.csv")
    assert list(series.columns[:6]) == [
        "time",
        "joint.period",
        "joint.measured [degC]",
        "joint.predicted [degC]",
        "joint.band [K]",
        "joint.residual [K]",
    ]
    left = series["joint.predicted [degC]"] - series["joint.measured [degC]"]
    np.testing.assert_allclose(series["joint.residual [K]"], left, atol=1e-6)
    metrics = pd.read_csv(out / "tables" / "validation_metrics.csv").set_index(["sensor", "period"])
    known = series["joint.period"] == "identification"
    rmse = float(np.sqrt((series["joint.residual [K]"][known] ** 2).mean()))
    assert rmse == pytest.approx(metrics.loc[("joint", "identification"), "rmse"], rel=1e-5)
    measured = series["joint.measured [degC]"]
    np.testing.assert_allclose(series["joint.band [K]"], np.hypot(0.2, 0.01 * measured), rtol=1e-4)
    np.testing.assert_allclose(series["core.band [K]"], 0.3, rtol=1e-6)


def test_temperatures_and_fluxes_together(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    line = bench.edit(JOINT, "joint: {column: joint, output: wall.inside_flux}") + 0
    assert cli.main(["validate", str(bench.study)]) == 2
    text = capsys.readouterr().err
    assert f"study.yaml:{line}" in text
    assert "because the unit is W/m2 and not degC" in text


def test_criteria_apply_to_one_unit(bench: Bench, table: pd.DataFrame, tmp_path: Path) -> None:
    flux = table.assign(flux=5.0 + 0.0 * table["joint"] + np.sin(np.arange(len(table)) / 20.0))
    flux.to_csv(bench.table)
    added = JOINT + "\n  flux: {column: flux, output: wall.inside_flux, standard_uncertainty: 2}"
    bench.edit(JOINT, added)
    bench.edit(
        "  - {metric: rmse, limit: 0.25}\n",
        "  - {metric: rmse, limit: 3, units: degC}\n  - {metric: rmse, limit: 500, units: [W/m2]}\n",
    )
    assert cli.main(["validate", str(bench.study), "-o", str(tmp_path / "out")]) == 0
    judged = pd.read_csv(tmp_path / "out" / "tables" / "validation_criteria.csv")
    assert {(row.sensor, row.limit) for row in judged.itertuples()} == {
        ("joint", 3.0),
        ("core", 3.0),
        ("flux", 500.0),
    }


def test_a_calibration_estimates_an_offset_that_is_stated(table: pd.DataFrame, tmp_path: Path) -> None:
    file = tmp_path / "building.yaml"
    file.write_text(BUILDING, encoding="utf-8")
    wall = load(file)
    shifted = Measurements.from_table(table.assign(joint=table["joint"] + 0.3), timezone="UTC+1")
    options: dict[str, Any] = {"start": "2023-03-02", "end": "2023-03-06", "step": "10min", "warm_up": "1d"}

    normal = Sensor("core", standard_uncertainty=0.05)

    def found(joint: Sensor, core: Sensor = normal, **more: Any) -> Any:
        sensors = {"joint": joint, "core.temperature": core}
        return calibrate(
            wall, open_climate(table), shifted, sensors=sensors, vary=list(TRUTH), **options, **more
        )

    output = "wall.interface_1_temperature"
    # Errors that are independent from value to value, without an offset, are not what was planted.
    scatter: dict[str, Any] = {"offset": 0.0, "repeatability": 0.05}
    plain = found(Sensor("joint", output=output, **scatter), Sensor("core", **scatter))
    fit = found(Sensor("joint", output=output, offset=0.3, repeatability=0.03))
    # All four are inside in 95 of 100 experiments if each interval is 1.27 times as wide as that of one.
    truth = np.array([TRUTH[path] for path in fit.problem.paths])
    centre, half = 0.5 * (fit.low + fit.high), 0.5 * (fit.high - fit.low)
    assert np.all(np.abs(truth - centre) <= 1.27 * half)
    wrong = [
        low <= TRUTH[p] <= high
        for p, low, high in zip(plain.problem.paths, plain.low, plain.high, strict=True)
    ]
    assert not all(wrong)
    with pytest.raises(InputError, match="holds the errors of the sensors"):
        profiles(fit)
    with pytest.raises(InputError, match="found emcee with errors of sensors"):
        found(Sensor("joint", output=output, offset=0.3), method="emcee")
    with pytest.raises(InputError, match="which is not inside a wall"):
        found(Sensor("joint", output=output, depth=0.002))
    with pytest.raises(InputError, match=r"offset\n +found: -0\.1"):
        Sensor("joint", offset=-0.1)


def test_least_squares_ends_when_the_cost_no_longer_moves() -> None:
    time = np.linspace(0.0, 1.0, 50)
    measured = 2.0 + 3.0 * time + 0.1 * np.sin(40.0 * time)

    def model(x: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        # Each run has an error of its own, as of iterations that end.
        jitter = 1e-6 * np.sin(1e9 * x.sum(axis=1))
        return np.asarray((x[:, :1] + x[:, 1:] * time + jitter[:, None])[:, :, None])

    problem = CalibrationProblem(
        (FitParameter("a", 0.0, 10.0), FitParameter("b", 0.0, 10.0)),
        (FitSensor("room", measured, 0.1),),
        model,
    )
    fit = solve(problem, options=SearchOptions(starts=1, difference=1e-4))
    best = np.linalg.lstsq(np.column_stack([np.ones(50), time]), measured, rcond=None)[0]
    np.testing.assert_allclose(fit.x, best, atol=1e-3)
    assert fit.minima[0].evaluations <= 3 * 12
