"""Calibration of a building with simulated measurements of known parameters."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from mascarin.building import Building, load
from mascarin.calibration import (
    Calibration,
    CalibrationProblem,
    FitParameter,
    SearchOptions,
    calibrate,
    fit_parameter,
    solve,
)
from mascarin.calibration.base.building_problem import problem_of
from mascarin.calibration.methods.least_squares import derivative
from mascarin.errors import InputError
from mascarin.examples import FOLDER
from mascarin.measurements import Sensor
from mascarin.measurements.observation import observe
from mascarin.simulation.preparation import prepare
from mascarin.simulation.simulation import Simulation
from mascarin.study import Study
from mascarin.weather import Climate, Measurements
from study_support import BUILDING, FINE, NOISE, TRUTH, logger_table, open_climate

SENSORS = {
    "joint": Sensor("joint", expanded_uncertainty=0.06, output="wall.interface_1_temperature"),
    "core.temperature": Sensor("core", expanded_uncertainty=0.06),
}
SPAN: dict[str, Any] = {"start": "2023-03-02", "end": "2023-03-06", "step": "10min", "warm_up": "1d"}


@pytest.fixture(scope="module")
def building(tmp_path_factory: pytest.TempPathFactory) -> Building:
    path = tmp_path_factory.mktemp("building") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return load(path)


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    path = tmp_path_factory.mktemp("table") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return logger_table(path)


@pytest.fixture(scope="module")
def climate(table: pd.DataFrame) -> Climate:
    return open_climate(table)


@pytest.fixture(scope="module")
def measured(table: pd.DataFrame) -> Measurements:
    return Measurements.from_table(table, timezone="UTC+1")


def test_the_true_values_are_in_the_intervals(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    # The conductivities go together (correlation 0.97): only on the mesh of the wall that made the table are
    # they as good as their intervals. A bound that is far away asks for that mesh.
    free = {path: FINE.get(path, (0.2, 12.0)) for path in TRUTH} | {
        "surfaces.wall.outside.absorptance": (0.2, 0.8)
    }
    fit = calibrate(
        building, climate, measured, vary=free, sensors=SENSORS, options=SearchOptions(starts=1), **SPAN
    )
    assert fit.reason.startswith("1 start searched, then estimated together with the errors of sensors")
    for k, parameter in enumerate(fit.problem.parameters):
        half = (fit.high[k] - fit.low[k]) / 2.0
        assert abs(fit.x[k] - TRUTH[parameter.path]) < 1.5 * half, parameter.path
    # The residuals are the noise of the logger.
    assert np.nanstd(fit.residuals, axis=0) == pytest.approx([NOISE, NOISE], rel=0.1)
    assert fit.residuals.shape == (4 * 144, 2)


def test_a_record_is_continued_and_an_estimate_ends_on_its_bound(
    building: Building, climate: Climate, measured: Measurements, tmp_path: Path
) -> None:
    # The true absorptance, 0.62, lies outside: the estimate ends on the bound, which is reported.
    told: list[int] = []
    record = tmp_path / "record.jsonl"

    def fit() -> Any:
        return calibrate(
            building, climate, measured,
            vary={"surfaces.wall.outside.absorptance": (0.3, 0.55)},
            sensors=SENSORS, options=SearchOptions(starts=1), record=record,
            progress=lambda done, total: told.append(done), **SPAN | {"step": "1h"},
        )  # fmt: skip

    first = fit()
    assert first.x[0] == 0.55
    assert "surfaces.wall.outside.absorptance" in first.on_bound
    count, before = len(told), record.read_bytes()
    again = fit()
    assert again.x[0] == first.x[0]
    assert record.read_bytes() == before
    assert len(told) == count


def test_output_and_column_are_enough_for_a_sensor(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    fit = calibrate(
        building, climate, measured,
        vary=["surfaces.wall.outside.absorptance"], sensors={"core.temperature": "core"},
        options=SearchOptions(starts=1), **SPAN | {"step": "1h"},
    )  # fmt: skip
    assert [sensor.name for sensor in fit.problem.sensors] == ["core.temperature"]
    assert fit.problem.sensors[0].standard_uncertainty == pytest.approx(0.5 / 1.96)


def test_bounds_come_from_the_building_where_none_are_given(building: Building) -> None:
    found = fit_parameter(building, "surfaces.wall.outside.absorptance", (None, 0.7), prior=0.1)
    assert (found.lower, found.upper) == (0.2, 0.7)
    assert found.nominal == 0.5
    assert found.prior == (0.5, 0.1)
    assert found.unit == "-"
    # A short way to write a path leads to the parameter itself.
    short = fit_parameter(building, "constructions.wall.layers.brick.conductivity")
    assert short.path == "materials.brick.conductivity"


def test_several_columns_are_averaged_where_they_have_values(
    building: Building, climate: Climate, table: pd.DataFrame
) -> None:
    more = table.assign(twin=table["core"] + 0.2)
    more.loc[more.index[144:432], "core"] = np.nan
    measured = Measurements.from_table(more, timezone="UTC+1")
    fit = calibrate(
        building, climate, measured,
        vary=["surfaces.wall.outside.absorptance"],
        sensors={"core.temperature": Sensor(["core", "twin"])},
        options=SearchOptions(starts=1), **SPAN | {"step": "1h"},
    )  # fmt: skip
    shown = fit.problem.sensors[0].measured
    want = table["core"].resample("1h").first()["2023-03-02":"2023-03-05"].to_numpy()
    assert len(shown) == 96
    np.testing.assert_allclose(shown[:48], want[:48] + 0.2, atol=1e-9)
    np.testing.assert_allclose(shown[48:], want[48:] + 0.1, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"vary": ["materials.brick.condctivity"]}, "Did you mean 'materials.brick.conductivity'"),
        ({"vary": ["site.latitude"]}, "structural .* cannot be estimated; choose another"),
        ({"vary": {"materials.brick.conductivity": (-1.0, 1.0)}}, "is not within the possible values"),
        ({"sensors": {"core.temprature": "core"}}, "Did you mean 'core.temperature'"),
        ({"sensors": {"core.temperature": "cor"}}, "no measured column 'cor'. Did you mean 'core'"),
        ({"start": "2023-04-02", "end": "2023-04-06"}, "outside the data"),
        ({"start": "2023-03-06", "end": "2023-03-02"}, "expected the end after the start"),
    ],
)
def test_what_cannot_be_used_is_refused(
    change: dict[str, Any], says: str, building: Building, climate: Climate, measured: Measurements
) -> None:
    given: dict[str, Any] = {"vary": ["materials.brick.conductivity"], "sensors": SENSORS, **SPAN}
    with pytest.raises(InputError, match=says):
        calibrate(building, climate, measured, **(given | change))


def test_a_constant_sensor_is_refused_before_the_first_run(
    building: Building, climate: Climate, table: pd.DataFrame
) -> None:
    dead = table.copy()
    dead.loc["2023-03-02 06:00":"2023-03-05 18:00", "core"] = 17.3
    measured = Measurements.from_table(dead, timezone="UTC+1")
    with pytest.raises(
        InputError, match=r"sensor 'core.temperature', column core: stuck from 2023-03-02 06:"
    ) as found:
        calibrate(building, climate, measured, vary=["materials.brick.conductivity"], sensors=SENSORS, **SPAN)
    assert "leave it out, mask these values, or choose another period" in str(found.value)


def test_start_scale_and_a_relative_uncertainty_reach_the_problem(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    free = fit_parameter(building, "materials.brick.conductivity", (0.2, 2.0), start=1.5, scale="log")
    fit = calibrate(
        building, climate, measured,
        vary=[free],
        sensors={"core.temperature": Sensor("core", expanded_uncertainty=0.06, relative=0.05)},
        options=SearchOptions(starts=1), **SPAN | {"step": "1h"},
    )  # fmt: skip
    assert fit.minima[0].start[0] == pytest.approx(1.5)
    assert fit.problem.parameters[0].scale == "log"
    core = fit.problem.sensors[0]
    want = np.hypot(0.06 / 1.96, 0.05 / 1.96 * np.abs(core.measured))
    np.testing.assert_allclose(core.sigma, want)
    with pytest.raises(InputError, match=r"range \[0.2, 2\] W/\(m K\) does not contain the start 3"):
        fit_parameter(building, "materials.brick.conductivity", (0.2, 2.0), start=3.0)


# --- exact slopes ---------------------------------------------------------------------------------------

#: Where the seven parameters of the paper stand between the ends of their ranges, beside their start.
PLACES = np.array([0.62, 0.35, 0.41, 0.55, 0.33, 0.47, 0.58])


@pytest.fixture(scope="module")
def seven() -> CalibrationProblem:
    """The seven parameters of the LGI cell on two days, against data that a known truth made.

    One sensor is a mean over its interval, one an output that the records are turned into. The start is
    periodic within 1e-9 K, so that differences of runs do not show its tolerance.
    """
    monkeypatch = pytest.MonkeyPatch()
    monkeypatch.setattr(prepare, "REPEATED_WITHIN", 1e-9)
    study = Study(FOLDER / "lgi" / "study.yaml")
    variant = "the paper's seven, 25 outside"
    building = study.context.variants.building_of(variant)
    free = [fit_parameter(building, path) for path in study.context.variants.plan_of(variant).parameters]
    sensors = {
        "room.operative_temperature": Sensor("room_air", expanded_uncertainty=0.3),
        "ceiling.energain_plasterboard_temperature": Sensor("pcm_plasterboard", expanded_uncertainty=0.3),
        "ceiling.outside_temperature": Sensor("pcm_top", expanded_uncertainty=0.3),
        "air_gap.air_temperature": Sensor("gap_air", expanded_uncertainty=0.3),
        "roof.inside_temperature": Sensor("steel_sheet", expanded_uncertainty=0.3),
    }
    simulation = Simulation(
        building,
        study.climate,
        step="15min",
        start="2010-09-20",
        end="2010-09-23",
        outputs=list(sensors),
        measurements=study.measurements,
        ranges={parameter.path: (parameter.lower, parameter.upper) for parameter in free},
    )
    monkeypatch.undo()
    begin = pd.Timestamp("2010-09-21", tz=study.climate.grid.zone)
    observation = observe(simulation, study.measurements, sensors, begin)
    observation = replace(observation, kinds=("instant", "instant", "instant", "mean", "instant"))
    # Two stretches, of which one night between them takes no part.
    use = np.ones(len(observation.times), dtype=np.bool_)
    use[80:112] = False
    posed = problem_of(
        simulation, observation, use, free, {name: s.uncertainty("degC") for name, s in sensors.items()}
    )
    truth = posed.values(PLACES[None])
    made = np.asarray(posed.model(truth))[0]
    data = (replace(s, measured=made[:, k]) for k, s in enumerate(posed.sensors))
    return replace(posed, sensors=tuple(data))


def test_vectors_that_were_the_last_ones_are_not_run_again(
    seven: CalibrationProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    count, ensemble = [], Simulation.ensemble

    def counted(self: Simulation, vectors: np.ndarray, **options: Any) -> Any:
        count.append(len(vectors))
        return ensemble(self, vectors, **options)

    monkeypatch.setattr(Simulation, "ensemble", counted)
    pair = seven.values(np.stack([PLACES, 0.9 * PLACES]))
    first = seven.model(pair)
    assert np.array_equal(seven.model(pair.copy()), first)
    assert count == [2]
    assert np.array_equal(np.asarray(seven.model(pair[::-1]))[::-1], first)
    assert count == [2, 2]
    with pytest.raises(ValueError, match="read-only"):
        np.asarray(first)[0] = 0.0


def test_exact_slopes_of_the_cell_are_those_of_differences(seven: CalibrationProblem) -> None:
    for z in (PLACES, seven.positions(np.array([p.first for p in seven.parameters]))):
        found = seven.jacobian(seven.values(z[None])[0]) * seven.rates(z)
        near = derivative(seven, z, 1e-4)[1]
        assert found.shape == (160, 5, 7)
        largest = np.abs(found).max(axis=(0, 1))
        assert (largest > 0.1).all()
        apart = np.abs(found - near)
        assert apart.max() < 1e-5 * largest.max()
        # Of each parameter's own largest too, but for the few instants at which the iteration of a step ends
        # early: differences are those of the last iterate, whatever their step, exact slopes of the solution.
        assert (np.quantile(apart, 0.99, axis=(0, 1)) < 1e-6 * largest).all()
        assert (apart.max(axis=(0, 1)) < 3e-5 * largest).all()


def test_seven_parameters_of_the_cell_come_back_with_exact_slopes(
    seven: CalibrationProblem, tmp_path: Path
) -> None:
    rules = SearchOptions(starts=2, slopes="exact")
    record = tmp_path / "record.jsonl"
    fit = solve(seven, options=rules, record=record)
    assert len(fit.minima) == 2
    for minimum in fit.minima:
        np.testing.assert_allclose(minimum.x, seven.values(PLACES[None])[0], rtol=1e-6)
    kept = record.read_bytes()
    again = solve(seven, options=rules, record=record)
    np.testing.assert_array_equal(again.x, fit.x)
    np.testing.assert_array_equal(again.low, fit.low)
    assert record.read_bytes() == kept


def test_exact_slopes_hold_at_bounds(
    building: Building, climate: Climate, measured: Measurements, tmp_path: Path
) -> None:
    found, near = (
        calibrate(
            building, climate, measured,
            vary={
                "surfaces.wall.outside.absorptance": (0.3, 0.55),
                "surfaces.wall.inside.convection.coefficient": (4.0, 12.0),
            },
            sensors=SENSORS, options=SearchOptions(starts=2, slopes=slopes), **SPAN | {"step": "1h"},
        )
        for slopes in ("exact", "differences")
    )  # fmt: skip
    assert found.x[0] == near.x[0] == 0.55
    assert "surfaces.wall.outside.absorptance" in found.on_bound
    np.testing.assert_allclose(found.x, near.x, rtol=1e-3)


def test_what_has_no_slope_is_refused(building: Building, climate: Climate, measured: Measurements) -> None:
    exact = SearchOptions(slopes="exact")
    given: dict[str, Any] = {"sensors": SENSORS, "options": exact, **SPAN}
    by_hand = FitParameter("site.latitude", 40.0, 50.0)
    with pytest.raises(InputError, match=r"site\.latitude: is structural"):
        calibrate(building, climate, measured, vary=[by_hand], **given)
    with pytest.raises(InputError, match="least-squares minimizes 'nll'; for the cost 'sd'"):
        calibrate(building, climate, measured, vary=["materials.brick.conductivity"], cost="sd", **given)


# --- the result -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def calibration(building: Building, climate: Climate, measured: Measurements) -> Calibration:
    """The absorptance alone, with another conductivity than that of the building."""
    return calibrate(
        building, climate, measured,
        vary=["surfaces.wall.outside.absorptance"], parameters={"materials.brick.conductivity": 0.6},
        sensors={"core.temperature": "core"}, options=SearchOptions(starts=1), progress=False,
        **SPAN | {"step": "1h"},
    )  # fmt: skip


def test_the_calibrated_building_has_the_estimates_and_can_be_simulated(
    calibration: Calibration, climate: Climate, measured: Measurements
) -> None:
    found = calibration.building
    assert found.parameter("surfaces.wall.outside.absorptance").value == calibration.x[0]
    assert found.parameter("materials.brick.conductivity").value == 0.6
    run = Simulation(
        found, climate, step="1h", start="2023-03-01", end="2023-03-06", outputs=["core.temperature"],
        measurements=measured,
    ).run()  # fmt: skip
    compared = run.records[24 : 24 + 96, 0] - calibration.problem.sensors[0].measured
    np.testing.assert_allclose(compared, calibration.residuals[:, 0], atol=1e-9)


def test_a_calibration_of_a_building_is_pickled(calibration: Calibration) -> None:
    again = pickle.loads(pickle.dumps(calibration))  # noqa: S301 (our own bytes)
    assert again.building.to_yaml() == calibration.building.to_yaml()
    x = calibration.x[None]
    np.testing.assert_array_equal(again.problem.residuals(x), calibration.problem.residuals(x))
    np.testing.assert_array_equal(again.problem.jacobian(x[0]), calibration.problem.jacobian(x[0]))


def test_residuals_have_local_times(calibration: Calibration) -> None:
    assert calibration.times is not None
    assert calibration.times[0].isoformat() == "2023-03-02T00:00:00+01:00"
    axes = calibration.plot("residuals", ax=Figure().subplots())
    assert "local time" in axes.get_xlabel()
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), calibration.residuals[:, 0])


@pytest.mark.parametrize("unit_given", [False, True])
def test_a_heat_flux_needs_an_uncertainty(
    unit_given: bool, building: Building, climate: Climate, table: pd.DataFrame
) -> None:
    flux = "wall.inside_flux"
    logger = Measurements.from_table(table.assign(flux=10.0 * table["core"]), timezone="UTC+1")
    given: dict[str, Any] = {
        "vary": ["surfaces.wall.outside.absorptance"],
        "options": SearchOptions(starts=1),
        **SPAN,
        "step": "1h",
    }
    if unit_given:
        fit = calibrate(
            building, climate, logger, sensors={flux: Sensor("flux", standard_uncertainty=2.0)}, **given
        )
        assert fit.problem.sensors[0].standard_uncertainty == 2.0
    else:
        with pytest.raises(
            InputError, match=r"sensors: wall.inside_flux: found no uncertainty, expected one"
        ):
            calibrate(building, climate, logger, sensors={flux: "flux"}, **given)


@pytest.mark.parametrize(
    "more",
    [
        {"mean": ("wall.inside_flux", "wall.outside_flux")},
        {"use": False},
        {"periods": {"identification": ("2023-03-02", "2023-03-03")}},
    ],
)
def test_keys_that_only_a_study_reads_are_refused(
    more: dict[str, Any], building: Building, climate: Climate, table: pd.DataFrame
) -> None:
    logger = Measurements.from_table(table, timezone="UTC+1")
    sensors = {"core.temperature": Sensor("core", **more)}
    (key,) = more
    with pytest.raises(InputError, match=rf"sensors: core\.temperature: found {key}, expected keys"):
        calibrate(building, climate, logger, sensors=sensors, vary=["surfaces.wall.outside.absorptance"])
