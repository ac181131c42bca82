from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from mascarin.errors import InputError
from mascarin.simulation.linear_model import StateSpace, state_space
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from simulation_samples import LINEAR, hours, measured, read, weather

Array = NDArray[np.float64]
SIGMA, KELVIN = 5.670374419e-8, 273.15
DAYS = 2

# A panel that gives the irradiance on the north wall: I = q + (T - Ta) with h = 1 and absorptance 1.
PANEL = """\
site: {latitude: -35, longitude: 0, altitude: 55, timezone: UTC, diffuse: hay_davies}
materials: {panel: {kind: resistance, resistance: 1}}
constructions: {panel: {layers: [{material: panel}]}}
surfaces:
  panel: {construction: panel, area: 1, tilt: 90, azimuth: 0, inside: {adiabatic: true},
          outside: {outdoors: true, convection: 1, emissivity: 0.9, absorptance: 1, longwave: none}}
"""


def irradiance(climate: Climate, step: float, folder: Path) -> Array:
    """On the north wall at the recorded times, as the engine transposes it. [W/m2]"""
    names = ["panel.outside_flux", "panel.outside_temperature"]
    panel = Simulation(
        read(PANEL, folder), climate, step=step, end=climate.index[-1], outputs=names, initial=18.0
    )
    flux, surface = panel.run().records.T
    return np.asarray(flux + surface - panel.weather("air_temperature"))


def drive(system: StateSpace, climate: Climate, step: float, sun: Array) -> Array:
    """Inputs of the matrices at the recorded times, shape (rows, inputs)."""
    t = step * np.arange(len(sun))

    def at(name: str) -> Array:
        return np.asarray(np.interp(t, hours(DAYS), climate.data[name].to_numpy()))

    dew, cloud, air = at("dew_point") / 100.0, at("cloud_cover"), at("air_temperature")
    clear = 0.711 + 0.56 * dew + 0.73 * dew**2
    cloudy = clear + (1.0 - clear) * 0.1 * cloud * np.exp(-1200.0 / 8200.0)
    known = {
        "outdoor_air_temperature": air,
        "sky_emission": cloudy * SIGMA * (air + KELVIN) ** 4,
        "north.outside_irradiance": sun,
        "roof.outside_irradiance": at("pyranometer"),
        "yard": at("yard"),
        "floor.outside_ground_temperature": np.full(len(t), 14.0),
        "one": np.ones(len(t)),
    }
    assert set(system.inputs) == set(known)
    return np.column_stack([known[name] for name in system.inputs])


def respond(system: StateSpace, u: Array, step: float, start: float) -> Array:
    """Outputs for inputs that are linear between the rows: exact, by the exponential of a larger matrix."""
    n, m = system.b.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n], block[:n, n : n + m] = system.a * step, system.b * step
    block[n : n + m, n + m :] = np.eye(m)
    power = expm(block)
    x = np.full(n, start)
    rows = [system.c @ x + system.d @ u[0]]
    for before, after in pairwise(u):
        x = power[:n, :n] @ x + power[:n, n : n + m] @ before + power[:n, n + m :] @ (after - before)
        rows.append(system.c @ x + system.d @ after)
    return np.array(rows)


def differences(step: float, folder: Path) -> dict[str, float]:
    """Largest difference between matrices and engine over two days, by output. [K]"""
    climate = weather(DAYS, **measured(DAYS))
    building = read(LINEAR, folder)
    system = state_space(building, step=step)
    bench = Simulation(
        building, climate, step=step, end=climate.index[-1], outputs=system.outputs, initial=18.0
    )
    sun = irradiance(climate, step, folder)
    apart = np.abs(respond(system, drive(system, climate, step, sun), step, 18.0) - bench.run().records)
    # From the third hour on: at the start the boundaries jump, which every one-step method smears.
    largest = apart[round(7200.0 / step) :].max(axis=0)
    return dict(zip(system.outputs, map(float, largest), strict=True))


def test_the_matrices_agree_with_the_engine(tmp_path: Path) -> None:
    coarse, fine = (differences(step, tmp_path) for step in (120.0, 60.0))
    # At sunrise, and where the sun starts to reach the wall, a sunlit surface converges at first order.
    lit = {"north.outside_temperature", "roof.outside_temperature"}
    assert max(value for name, value in fine.items() if name not in lit) < 2e-5
    assert max(fine.values()) < 1e-3
    # What is left in the air, where no kink arrives, is the engine's step: of second order.
    for zone in ("sunny", "shady"):
        assert coarse[f"{zone}.air_temperature"] / fine[f"{zone}.air_temperature"] == pytest.approx(
            4.0, rel=0.15
        )


def test_names_and_time_constants(tmp_path: Path) -> None:
    system = state_space(read(LINEAR, tmp_path))
    assert system.a.shape == (len(system.states), len(system.states))
    assert system.b.shape == (len(system.states), len(system.inputs))
    assert system.c.shape == (len(system.outputs), len(system.states))
    assert system.d.shape == (len(system.outputs), len(system.inputs))
    assert len(set(system.states)) == len(system.states)
    assert {"sunny.air_temperature", "shady.air_temperature", "roof.outside_temperature"} <= set(
        system.outputs
    )
    constants = system.time_constants()
    assert np.all(constants > 0.0)
    assert np.all(np.diff(constants) <= 0.0)


def test_everything_at_one_temperature_stays_there(tmp_path: Path) -> None:
    """Rows of conductances sum to zero: a building at the temperature of its surroundings keeps it."""
    system = state_space(read(LINEAR.replace("reference: 15", "reference: 20"), tmp_path))
    black = SIGMA * (20.0 + KELVIN) ** 4
    level = {"outdoor_air_temperature": 20.0, "sky_emission": black, "yard": 20.0, "one": 1.0,
             "floor.outside_ground_temperature": 20.0}  # fmt: skip
    u = np.array([level.get(name, 0.0) for name in system.inputs])
    x = np.full(len(system.states), 20.0)
    assert np.abs(system.a @ x + system.b @ u).max() < 1e-12
    assert system.c @ x + system.d @ u == pytest.approx(np.full(len(system.outputs), 20.0), abs=1e-9)


NONLINEAR = {
    "film": (
        "convection: 2, emissivity: 0.9}",
        "convection: tarp, emissivity: 0.9}",
        "convection at surface roof",
    ),
    "outdoors": ("longwave: none}", "longwave: exact}", "long-wave exchange at surface roof"),
    "zone": ("longwave: {kind: linearised, reference: 18}", "longwave: radiosity", "exchange in zone shady"),
    "infiltration": (
        "infiltration: 1,",
        "infiltration: {constant: 1, wind: 0.1},",
        "infiltration of zone shady",
    ),
    "phase change": (
        "foam: {conductivity: 0.03, density: 30, specific_heat: 1470}",
        "foam: {kind: pcm, conductivity: 0.2, density: 900, specific_heat: 2000, latent_heat: 1e5, "
        "melting_temperature: 23, law: {kind: tanh, width: 1}}",
        "materials.foam (phase change)",
    ),
}


@pytest.mark.parametrize("name", NONLINEAR)
def test_a_law_that_is_not_linear_is_named(name: str, tmp_path: Path) -> None:
    old, new, where = NONLINEAR[name]
    assert LINEAR.count(old) == 1
    building = read(LINEAR.replace(old, new), tmp_path)
    with pytest.raises(InputError) as caught:
        state_space(building)
    assert where in str(caught.value)
    assert "is not linear and constant; " in str(caught.value)


def test_the_first_of_several_nonlinear_laws_is_named(tmp_path: Path) -> None:
    text = LINEAR
    for name in ("infiltration", "zone", "film"):
        old, new, _ = NONLINEAR[name]
        text = text.replace(old, new)
    with pytest.raises(InputError, match="convection at surface roof"):
        state_space(read(text, tmp_path))
