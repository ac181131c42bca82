"""Derivatives: equal to difference quotients for every parameter, and named."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest

from mascarin.building import load
from mascarin.errors import InputError
from mascarin.examples import STUDIES
from mascarin.simulation.derivatives import Mean, SquaredResiduals, gradient, jacobian
from mascarin.simulation.preparation.engine_run import MEMORY
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.study import Study
from mascarin.verification.bestest.catalogue import CASES
from mascarin.weather import Climate

Array = npt.NDArray[np.float64]

SIDES = ("north", "east", "south", "west")
THREE = [
    "materials.energain.law.width",
    "surfaces.roof.outside.absorptance",
    "surfaces.ceiling.inside.convection.factor",
]


@pytest.fixture(scope="module")
def cell() -> Study:
    return Study(STUDIES["lgi"])


@pytest.fixture(scope="module")
def days(cell: Study) -> Simulation:
    """Two days in which the ceiling melts and freezes."""
    return Simulation(
        cell.building,
        cell.climate,
        start="2010-09-20",
        end="2010-09-22",
        outputs=[sensor.output for sensor in cell.plan.sensors.values()] + ["room.operative_temperature"],
        measurements=cell.measurements,
        initial=23.0,
    )


#: Temperatures of the cell differ by this between runs that should be equal. [K]
ROUNDING = 5e-10


def nudge_of(run: Simulation, path: str, relative: float) -> float:
    parameter = run.building.parameter(path)
    return relative * max(parameter.high - parameter.low, abs(parameter.value))


def quotient(run: Simulation, path: str, relative: float) -> Array:
    """Central difference; at a limit of the parameter the one-sided one of second order."""
    parameter = run.building.parameter(path)
    nudge = nudge_of(run, path, relative)

    def at(steps: float) -> Array:
        vector = run.vector({path: parameter.value + steps * nudge})
        # With derivatives Newton's iteration does one step more: its tolerance would be seen in the quotient.
        return run.jacobian_vector([path], vector)[0]

    if parameter.value - nudge < parameter.lower:
        return (4.0 * at(1.0) - 3.0 * at(0.0) - at(2.0)) / (2.0 * nudge)
    if parameter.value + nudge > parameter.upper:
        return (3.0 * at(0.0) - 4.0 * at(-1.0) + at(-2.0)) / (2.0 * nudge)
    return (at(1.0) - at(-1.0)) / (2.0 * nudge)


def misses(run: Simulation) -> dict[str, tuple[float, list[float]]]:
    """Paths whose derivative agrees with no quotient, with the largest derivative and the errors."""
    slopes = run.jacobian_vector(run.paths)[1]
    missed = {}
    for k, path in enumerate(run.paths):
        largest = np.abs(slopes[k]).max()
        # A quotient has an error of curvature for a large nudge and of rounding for a small one.
        errors = []
        for relative in (1e-3, 1e-4, 1e-5, 1e-2):
            errors.append(np.abs(quotient(run, path, relative) - slopes[k]).max())
            if errors[-1] <= 1e-5 * largest + ROUNDING / nudge_of(run, path, relative):
                break
        else:
            missed[path] = (largest, errors)
    return missed


def test_every_path_of_the_cell_agrees_with_central_differences(days: Simulation) -> None:
    records, slopes = days.jacobian_vector(days.paths)
    assert slopes.shape == (len(days.paths), 193, 7)
    assert not misses(days)
    np.testing.assert_allclose(records[:, 0], days.run()["room.air_temperature"], atol=2e-6)


def test_the_repeated_start_is_differentiated(cell: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    # The slopes are those of the periodic state: differences show them where both states are found as well.
    monkeypatch.setattr("mascarin.simulation.preparation.prepare.REPEATED_WITHIN", 1e-8)
    simulation = Simulation(
        cell.building, cell.climate, start="2010-09-20", end="2010-09-21", outputs=["room.air_temperature"],
        measurements=cell.measurements,
    )  # fmt: skip
    path = "surfaces.roof.outside.absorptance"
    start = simulation.jacobian_vector([path])[1][0, 0, 0]
    vectors = [simulation.vector({path: 0.8 + nudge}) for nudge in (-1e-4, 1e-4)]
    low, high = (simulation.jacobian_vector([path], vector)[0][0, 0] for vector in vectors)
    # At the first record the repeated period has already warmed the room through a darker roof.
    assert start > 3.0
    at = simulation.jacobian_vector([path], simulation.vector({path: 0.8}))[1][0, 0, 0]
    assert (high - low) / 2e-4 == pytest.approx(at, rel=1e-4)


def test_dataset_names_units_and_parameters(cell: Study) -> None:
    found = jacobian(
        cell.building, cell.climate, THREE, outputs=["room.air_temperature"], parameters={THREE[1]: 0.7},
        start="2010-09-20", end="2010-09-21", measurements=cell.measurements, initial=23.0,
    )  # fmt: skip
    series = found["room.air_temperature"]
    slopes = found["d room.air_temperature"]
    assert slopes.dims == ("parameter", "time")
    assert found["parameter"].to_numpy().tolist() == THREE
    assert found["parameter_unit"].to_numpy().tolist() == ["K", "-", "-"]
    changed = simulate(
        cell.building.replace({THREE[1]: 0.7}), cell.climate, start="2010-09-20", end="2010-09-21",
        outputs=["room.air_temperature"], measurements=cell.measurements, initial=23.0,
    )  # fmt: skip
    np.testing.assert_allclose(series, changed["room.air_temperature"], atol=2e-6)
    # Nothing given at the start depends on a parameter; a darker roof then warms the room.
    assert slopes.sel(parameter=THREE[1]).to_numpy()[0] == 0.0
    assert float(slopes.sel(parameter=THREE[1]).max()) > 0.5
    assert pd.Timestamp(found["time"].to_numpy()[0]) == pd.Timestamp("2010-09-19 20:00")


def test_globe_temperature_follows_air_and_radiant_temperature(cell: Study) -> None:
    names = ["room.globe_temperature", "room.air_temperature", "room.mean_radiant_temperature"]
    simulation = Simulation(
        cell.building, cell.climate, start="2010-09-20", end="2010-09-21", outputs=names,
        measurements=cell.measurements, initial=23.0,
    )  # fmt: skip
    path = "surfaces.roof.outside.absorptance"
    records, slopes = simulation.jacobian_vector([path])
    exact = quotient(simulation, path, 1e-5)
    # The derivative of its convective coefficient is infinite where globe and air are equally warm.
    apart = np.abs(exact[:, 0]) > 0.1
    np.testing.assert_allclose(slopes[0, apart, 0], exact[apart, 0], rtol=2e-3)
    assert apart.sum() > 50
    # By the implicit function theorem on the balance of ISO 7726: 4 e sigma T^3 and 1.25 times the convective
    # coefficient are the weights of the surroundings and of the air.
    globe, air, radiant = records.T
    convection = 1.25 * 1.4 * (np.abs(globe - air) / 0.15) ** 0.25
    at_globe, at_walls = (4.0 * 0.95 * 5.670374419e-8 * (t + 273.15) ** 3 for t in (globe, radiant))
    _, by_air, by_walls = slopes[0].T
    implicit = (convection * by_air + at_walls * by_walls) / (at_globe + convection)
    # Closer than 1e-8 K the coefficient at the globe is lost in round-off.
    np.testing.assert_allclose(slopes[0, :, 0], implicit, rtol=1e-6, atol=1e-7)
    assert records.shape == (97, 3)


def test_refusals(days: Simulation) -> None:
    with pytest.raises(InputError, match="no parameters"):
        days.jacobian_vector([])
    with pytest.raises(InputError, match=r"surfaces\.roof\.outside\.absorptance"):
        days.jacobian_vector(["surfaces.roof.outside.absorptanc"])
    with pytest.raises(InputError, match="structural"):
        days.jacobian_vector(["site.latitude"])


# --- in reverse ----------------------------------------------------------------------------------------


def both_ways(simulation: Simulation, *, memory: int = MEMORY) -> tuple[Array, Array]:
    """Slopes of a random sum of records by each parameter, times its range: in reverse and forward."""
    trajectory = simulation.trajectory(memory=memory)
    weights = np.random.default_rng(7).normal(size=trajectory.records.shape)
    records, forward = simulation.jacobian_vector(simulation.paths)
    np.testing.assert_allclose(trajectory.records, records, rtol=0.0, atol=2e-6)
    parameters = [simulation.building.parameter(path) for path in simulation.paths]
    ranges = np.array([p.high - p.low for p in parameters])
    return trajectory.pull(weights) * ranges, np.einsum("to,pto->p", weights, forward) * ranges


@pytest.mark.parametrize("memory", [MEMORY, 200_000], ids=["all kept", "parts calculated again"])
def test_every_path_of_the_cell_is_the_same_in_reverse(days: Simulation, memory: int) -> None:
    reverse, forward = both_ways(days, memory=memory)
    assert (forward != 0.0).sum() > 150
    np.testing.assert_allclose(reverse, forward, rtol=0.0, atol=1e-9 * np.abs(forward).max())


@pytest.mark.parametrize("scheme", ["sdirk2", "backward-euler"])
def test_the_repeated_start_is_the_same_in_reverse(
    cell: Study, scheme: Literal["sdirk2", "backward-euler"]
) -> None:
    simulation = Simulation(
        cell.building, cell.climate, start="2010-09-20", end="2010-09-21", outputs=["ceiling.inside_flux"],
        measurements=cell.measurements, scheme=scheme,
    )  # fmt: skip
    reverse, forward = both_ways(simulation)
    np.testing.assert_allclose(reverse, forward, rtol=0.0, atol=1e-9 * np.abs(forward).max())


@pytest.fixture(scope="module")
def massive(data_dir: Path) -> Simulation:
    """Case 900 of Standard 140 over two days of January: windows, gains, heating at night."""
    return Simulation(
        load(CASES["900"].file),
        Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw"),
        start="2001-01-02",
        end="2001-01-04",
        step="30min",
        outputs=["room.air_temperature", "room.heating_load"],
        initial=20.0,
    )


def test_windows_and_ideal_loads_are_the_same_in_reverse(massive: Simulation) -> None:
    reverse, forward = both_ways(massive)
    assert (forward != 0.0).sum() > 80
    np.testing.assert_allclose(reverse, forward, rtol=0.0, atol=1e-9 * np.abs(forward).max())


def test_windows_and_ideal_loads_agree_with_central_differences(massive: Simulation) -> None:
    # Where a wall is turned, the direct sun jumps from one surface to another; no derivative contains that.
    turned = {f"surfaces.{side}_wall.{way}" for side in SIDES for way in ("azimuth", "tilt")}
    assert set(misses(massive)) <= turned


def test_a_step_against_the_gradient_lowers_the_quantity(cell: Study) -> None:
    options: dict[str, Any] = {
        "outputs": ["room.air_temperature"], "start": "2010-09-20", "end": "2010-09-21",
        "measurements": cell.measurements, "initial": 23.0,
    }  # fmt: skip
    seen = np.asarray(simulate(cell.building, cell.climate, **options)["room.air_temperature"]) + 0.5
    objective = SquaredResiduals({"room.air_temperature": seen}, {"room.air_temperature": 0.3})
    at = gradient(cell.building, cell.climate, objective, **options)
    assert at.value == pytest.approx(len(seen) * (0.5 / 0.3) ** 2, rel=1e-6)
    table = at.to_dataframe()
    path = str(table.index[0])
    span = np.ptp(at.ranges[path])
    step = -1e-4 * span * np.sign(at.slopes[path])
    nominal = cell.building.parameter(path).value
    there = gradient(cell.building, cell.climate, objective, parameters={path: nominal + step}, **options)
    assert there.value - at.value == pytest.approx(at.slopes[path] * step, rel=0.02)
    assert there.value < at.value
    mean = gradient(cell.building, cell.climate, Mean("room.air_temperature"), **options)
    lines = repr(mean).splitlines()
    assert len(lines) <= 15
    # The parameter with the largest change over its range is first.
    assert lines[1].split()[0] == mean.to_dataframe().index[0]
    assert "<details>" in mean._repr_html_()
    assert mean.value == pytest.approx(float(np.mean(seen)) - 0.5, abs=1e-6)


def test_an_objective_that_does_not_fit_is_refused(cell: Study) -> None:
    options: dict[str, Any] = {
        "outputs": ["room.air_temperature"], "start": "2010-09-20", "end": "2010-09-21",
        "measurements": cell.measurements, "initial": 23.0,
    }  # fmt: skip
    with pytest.raises(InputError, match=r"no output 'room\.air_temperatur'.*room\.air_temperature"):
        gradient(cell.building, cell.climate, Mean("room.air_temperatur"), **options)
    short = SquaredResiduals({"room.air_temperature": np.zeros(3)})
    with pytest.raises(InputError, match=r"found 3 measured values, expected one for each record \(97\)"):
        gradient(cell.building, cell.climate, short, **options)
