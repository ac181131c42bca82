"""Supercooling and recalescence: a lumped node in closed form and by an independent integration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pytest

from mascarin.building import PhaseChangeMaterial, Supercooling
from mascarin.errors import InputError
from mascarin.verification.analytical import setup
from mascarin.verification.analytical.phase import slab

if TYPE_CHECKING:
    from mascarin.simulation.preparation.options import Scheme
    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation

Array = npt.NDArray[np.float64]

# Of a salt hydrate about 29 degC, and of a slab of it that has one temperature: Biot number 7e-4.
DENSITY, LATENT, MELTING, WIDTH, THICKNESS, COEFFICIENT = 1700.0, 190e3, 29.0, 0.2, 0.01, 8.0
SOLID, LIQUID, DEGREE = 1400.0, 2100.0, 8.0
CONDUCTIVITY = 60.0
CONDUCTANCE = 1.0 / (1.0 / COEFFICIENT + 0.5 * THICKNESS / CONDUCTIVITY)
START, AROUND = 35.0, 12.0
#: Heat of the slab per kelvin and kilogram of its material [J/K].
MASS = DENSITY * THICKNESS


def wax(kinetics: str, solid: float = SOLID, liquid: float = LIQUID, width: float = WIDTH) -> str:
    return (
        f"density: {DENSITY}, conductivity: {CONDUCTIVITY}, specific_heat: [{solid}, {liquid}], "
        f"latent_heat: {LATENT}, melting_temperature: {MELTING}, law: {{kind: linear, width: {width}}}, "
        f"hysteresis: {{model: supercooling, degree: {DEGREE}, {kinetics}}}"
    )


def cooled(
    material: str, length: float, step: float, scheme: Scheme = "sdirk2", start: float = START
) -> Results:
    """Run of a slab in air of 12 degC; records of temperature and liquid fraction."""
    text = slab(material, THICKNESS, 1, f"measured: surface, convection: {COEFFICIENT}")
    return setup.run(
        text, length, {"surface": setup.steady(AROUND)}, step=step, initial=start, scheme=scheme,
        outputs=["slab.wax_temperature", "slab.wax_liquid_fraction"],
    )  # fmt: skip


# --- closed form --------------------------------------------------------------------------------------------


def test_a_lumped_node_supercools_returns_to_its_melting_point_and_freezes_there() -> None:
    """Without delay (time constant 0) and with equal specific heats each part has a closed form."""
    heat, half = 2000.0, 1e-3
    run = cooled(wax("time_constant: 0", heat, heat, half), 9 * setup.HOUR, 10.0)
    time = 10.0 * np.arange(len(run.records))
    temperature, liquid = run.records.T
    decay = MASS * heat / CONDUCTANCE
    nucleation = decay * np.log((START - AROUND) / (MELTING - DEGREE - AROUND))
    before = time < nucleation
    expected = AROUND + (START - AROUND) * np.exp(-time / decay)
    assert np.abs(temperature - expected)[before].max() < 1e-5
    assert (liquid[before] == 1.0).all()
    # The heat that warms it back freezes c dT/L of it.
    first = np.flatnonzero(time > nucleation + 20.0)[0]
    left = 1.0 - heat * DEGREE / LATENT
    frozen = CONDUCTANCE * (MELTING - AROUND) / (MASS * LATENT)
    assert abs(temperature[first] - MELTING) < half
    # It is colder than then while it warms, for a step and a half at most, and loses less heat.
    less = 1.5 * 10.0 * frozen * DEGREE / (MELTING - AROUND)
    assert abs(liquid[first] - (left - frozen * (time[first] - nucleation))) < less
    # The plateau lasts until all latent heat has gone.
    end = nucleation + left / frozen
    on = (time > nucleation + 20.0) & (time < end - 20.0)
    assert np.abs(temperature[on] - MELTING).max() <= half
    assert np.abs(liquid[on] - (left - frozen * (time[on] - nucleation))).max() < less
    solid = time > end + 20.0
    after = AROUND + (MELTING - AROUND) * np.exp(-(time - end) / decay)
    assert liquid[solid].max() == 0.0
    # The end is later by what was not lost before.
    assert np.abs(temperature - after)[solid].max() < less / frozen * (MELTING - AROUND) / decay


@pytest.mark.parametrize("kinetics", ["time_constant: 0", "time_constant: 600", "rate: 2e-4"])
@pytest.mark.parametrize("step", [30.0, 900.0])
@pytest.mark.parametrize("scheme", ["sdirk2", "backward-euler", "linearly-implicit"])
def test_all_heat_of_melting_is_set_free(kinetics: str, step: float, scheme: Scheme) -> None:
    run = cooled(wax(kinetics), 4 * setup.DAY, step, scheme)
    end = run.records[-1, 0]
    expected = MASS * (LATENT + LIQUID * (START - MELTING) + SOLID * (MELTING - end))
    # Heat is counted from the temperature and the fraction at both ends; what is left of it is rounding.
    assert run.records[-1, 1] < 1e-9
    assert -run.energy.stored == pytest.approx(expected, rel=1e-6 if scheme == "linearly-implicit" else 1e-9)
    assert run.energy.closure < 1e-10


# --- an independent integration -----------------------------------------------------------------------------


def integrated(kinetics: dict[str, float], length: float, every: float, inner: int = 100) -> Array:
    """Temperature and liquid fraction by Runge-Kutta of fourth order, shape (n, 2)."""

    def curve(temperature: float) -> float:
        return float(np.clip(0.5 * (1.0 + (temperature - MELTING) / WIDTH), 0.0, 1.0))

    def warmth(enthalpy: float, liquid: float) -> float:
        # H = c_s (T - Tm) + xi (L + (c_l - c_s)(T - Tm)), solved for T.
        return MELTING + (enthalpy - liquid * LATENT) / (SOLID + liquid * (LIQUID - SOLID))

    def speed(temperature: float, liquid: float, seeded: bool) -> float:
        if not seeded:
            return 0.0
        if "rate" in kinetics:
            factor = kinetics["rate"] * max(MELTING + WIDTH - temperature, 0.0)
        else:
            factor = 1.0 / kinetics["time_constant"]
        return -factor * max(liquid - curve(temperature), 0.0)

    state, seeded = np.array([LIQUID * (START - MELTING) + LATENT, 1.0]), False

    def slope(state: Array) -> Array:
        temperature = warmth(*state)
        flow = CONDUCTANCE * (AROUND - temperature) / MASS
        return np.array([flow, speed(temperature, state[1], seeded)])

    def advance(state: Array, dt: float) -> Array:
        a = slope(state)
        b = slope(state + 0.5 * dt * a)
        c = slope(state + 0.5 * dt * b)
        return state + dt / 6.0 * (a + 2.0 * b + 2.0 * c + slope(state + dt * c))

    rows, dt = [[warmth(*state), state[1]]], every / inner
    for _ in range(round(length / every)):
        for _ in range(inner):
            reached = advance(state, dt)
            if not seeded and warmth(*reached) <= MELTING - DEGREE:
                low, high = 0.0, dt
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    cold = warmth(*advance(state, middle)) <= MELTING - DEGREE
                    low, high = (low, middle) if cold else (middle, high)
                state, seeded = advance(state, high), True
                reached = advance(state, dt - high)
            state = reached
        rows.append([warmth(*state), state[1]])
    return np.array(rows)


@pytest.mark.parametrize("kinetics", [{"time_constant": 900.0}, {"rate": 1.5e-4}])
def test_an_independent_integration_gives_the_same(kinetics: dict[str, float]) -> None:
    length, every = 5 * setup.HOUR, 100.0
    exact = integrated(kinetics, length, every)
    text = ", ".join(f"{name}: {value}" for name, value in kinetics.items())
    records = cooled(wax(text), length, 2.0).records[:: round(every / 2.0)]
    assert np.abs(records - exact)[:, 0].max() < 1e-3
    # It comes back by recalescence, and then stays about its melting temperature.
    coldest = int(np.argmin(exact[: round(2 * setup.HOUR / every), 0]))
    assert exact[coldest:, 0].max() - exact[coldest, 0] > 3.0


@pytest.mark.parametrize(("scheme", "order"), [("sdirk2", 2.0), ("backward-euler", 1.0)])
@pytest.mark.parametrize("kinetics", ["time_constant: 900", "rate: 1.5e-4"])
def test_the_order_of_the_scheme_holds_through_the_nucleation(
    kinetics: str, scheme: Scheme, order: float
) -> None:
    """Three hours after it, over nucleations at many places within a step."""
    length, late = 5 * setup.HOUR, 3 * setup.HOUR

    def errors(start: float) -> list[float]:
        def at(step: float) -> Array:
            run = cooled(wax(kinetics), length, step, scheme, start=start)
            return np.asarray(run.records[round(late / step) :: round(100.0 / step), 0])

        fine = at(0.5)
        return [float(np.abs(at(step) - fine).max()) for step in (20.0, 10.0)]

    coarse, fine = np.mean([errors(start) for start in np.linspace(33.0, 37.0, 8)], axis=0)
    assert np.log(coarse / fine) / np.log(2.0) == pytest.approx(order, abs=0.35)


# --- every entrance -----------------------------------------------------------------------------------------

WALL = """\
materials:
  salt: {kind: pcm, density: [1700, 1550], conductivity: [1.0, 0.55], specific_heat: [1400, 2100],
         latent_heat: 190000, melting_temperature: 26, law: {kind: tanh, width: 0.4},
         hysteresis: {model: supercooling, degree: {value: 4, range: [2, 6]}, KINETICS}}
  board: {conductivity: 0.16, density: 800, specific_heat: 1090}
constructions:
  wall:
    layers: [{material: salt, thickness: 0.002, nodes: 4}, {material: board, thickness: 0.0125, nodes: 2}]
surfaces:
  slab: {construction: wall, area: 10, tilt: 90, outside: {measured: gap, convection: 10},
         inside: {measured: room, convection: 6}}
"""
KINETICS = (
    "time_constant: {value: 900, range: [300, 3000]}",
    "rate: {value: 0.0002, range: [0.00005, 0.001]}",
)


def wall(kinetics: str, **options: Any) -> Simulation:
    step = 300.0
    t = setup.times(3 * setup.DAY, step)
    gap = 24.0 + 11.0 * np.sin(2.0 * np.pi * t / setup.DAY)
    return setup.simulation(
        setup.building(WALL.replace("KINETICS", kinetics)),
        setup.climate(step, {"gap": gap, "room": 22.0 + 2.0 * np.sin(2.0 * np.pi * (t / setup.DAY - 0.2))}),
        step=step, initial=20.0, outputs=["slab.salt_liquid_fraction", "slab.inside_temperature"], **options,
    )  # fmt: skip


@pytest.mark.parametrize("kinetics", KINETICS)
def test_derivatives_are_those_of_differences(kinetics: str) -> None:
    run = wall(kinetics)
    name = f"materials.salt.hysteresis.{kinetics.partition(':')[0]}"
    paths = [
        name,
        "materials.salt.hysteresis.degree",
        "materials.salt.melting_temperature",
        "materials.salt.latent_heat",
    ]
    _, slopes = run.jacobian_vector(paths)
    for k, path in enumerate(paths):
        value = run.building.parameter(path).value
        small = 1e-6 * value
        low, high = (run.jacobian_vector(paths, run.vector({path: value + s * small}))[0] for s in (-1, 1))
        quotient = (high - low) / (2.0 * small)
        largest = np.abs(slopes[k]).max()
        assert largest > 0.0
        assert np.abs(quotient - slopes[k]).max() < 1e-4 * largest, path


@pytest.mark.parametrize("kinetics", KINETICS)
def test_members_of_a_sweep_have_the_bits_of_runs_alone(kinetics: str) -> None:
    run = wall(kinetics)
    path = "materials.salt.hysteresis.degree"
    degrees = np.linspace(2.0, 6.0, 9)
    found = run.ensemble(np.array([run.vector({path: degree}) for degree in degrees])).records
    assert np.ptp(found[:, :, 0].mean(axis=1)) > 0.01
    for member, degree in enumerate(degrees):
        assert np.array_equal(found[member], run.run({path: degree}).records)


def test_a_supercooled_wall_conserves_energy_at_every_step() -> None:
    for kinetics in ("time_constant: 0", "time_constant: 900", "rate: 0.01"):
        for step in (60.0, 300.0, 3600.0):
            t = setup.times(6 * setup.DAY, step)
            gap = (
                24.0 + 11.0 * np.sin(2.0 * np.pi * t / setup.DAY) + 4.0 * ((3.0 * t / setup.DAY) % 1.0 < 0.1)
            )
            run = setup.run(
                WALL.replace("KINETICS", kinetics), step, {"gap": gap, "room": np.full(len(t), 22.0)},
                step=step, initial=20.0, outputs=["slab.salt_liquid_fraction"],
            )  # fmt: skip
            assert run.energy.closure < 1e-10
            assert run.records.min() < 0.1 < 0.9 < run.records.max()


# --- the description ----------------------------------------------------------------------------------------


def material(**changes: Any) -> PhaseChangeMaterial:
    properties: dict[str, Any] = {
        "conductivity": [1.0, 0.5], "density": 1700, "specific_heat": [1400, 2100], "latent_heat": 190e3,
        "melting_temperature": 29, "law": {"kind": "tanh", "width": 0.3},
    }  # fmt: skip
    return PhaseChangeMaterial(**properties | changes)


def test_a_material_keeps_what_is_written() -> None:
    salt = material(hysteresis={"model": "supercooling", "degree": 8, "time_constant": 600})
    assert isinstance(salt.hysteresis, Supercooling)
    assert salt.written()["hysteresis"] == {"model": "supercooling", "degree": 8, "time_constant": 600}
    assert salt.hysteresis.coldest_liquid(29.0) == 21.0
    assert salt.cooling is None
    assert "down to 21.00 degC, crystallises with a time constant of 600 s" in salt.hysteresis.said(29.0)


@pytest.mark.parametrize(
    ("hysteresis", "changes", "words"),
    [
        ({"degree": 8}, {}, "neither time_constant nor rate"),
        ({"degree": 8, "time_constant": 600, "rate": 1e-4}, {}, "time_constant and rate"),
        ({"degree": 0, "time_constant": 600}, {}, "degree"),
        ({"time_constant": 600}, {}, "degree"),
        ({"degree": 8, "time_constant": -1}, {}, "time_constant"),
        ({"degree": 8, "time_constant": 600, "freezing_temperature": 20}, {}, "freezing_temperature"),
        ({"degree": 100, "time_constant": 600}, {"specific_heat": [1400, 4200]}, "set free by crystalli"),
        (
            {"degree": 8, "time_constant": 600},
            {
                "law": {"kind": "table", "temperatures": [15, 29, 30], "enthalpies": [0, 2e4, 2e5]},
                "latent_heat": None, "melting_temperature": None,
            },
            "a law of the liquid fraction alone",
        ),
    ],
)  # fmt: skip
def test_what_contradicts_itself_is_refused(
    hysteresis: dict[str, Any], changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError) as error:
        material(**changes | {"hysteresis": {"model": "supercooling", **hysteresis}})
    assert words in str(error.value)
    assert "hysteresis.supercooling" not in str(error.value)


def test_the_scheme_with_an_apparent_capacity_is_refused() -> None:
    with pytest.raises(
        InputError, match=r"scheme: found 'apparent-capacity' with supercooling in materials.salt"
    ):
        wall(KINETICS[0], scheme="apparent-capacity").run()
