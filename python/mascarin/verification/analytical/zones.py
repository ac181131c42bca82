"""Zones: a lumped room after a step, two zones in steady state, order in time, energy balance, ensembles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.verification.analytical import setup
from mascarin.verification.analytical.check import Case, Check

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.simulation.preparation.options import Scheme
    from mascarin.simulation.simulation import Simulation

#: Dry air at sea level: ICAO standard pressure, 15 degC; specific heat of ASHRAE Fundamentals, ch. 1.
AIR_DENSITY: Final = 101_325.0 / (287.055 * 288.15)
AIR_HEAT: Final = 1006.0


# --- lumped zone -------------------------------------------------------------------------------------------


def _lumped(name: str) -> Iterator[Check]:
    volume, factor, changes, resistance, area = 30.0, 4.0, 1.5, 0.5, 12.0
    convection = (20.0, 5.0)
    text = f"""\
materials: {{panel: {{kind: resistance, resistance: {resistance}}}}}
constructions: {{panel: {{layers: [{{material: panel}}]}}}}
zones: {{room: {{volume: {volume}, capacity_factor: {factor}, infiltration: {changes}, longwave: none}}}}
surfaces:
  panel: {{construction: panel, area: {area}, tilt: 90, azimuth: 0,
          outside: {{measured: cold, convection: {convection[0]}}},
          inside: {{zone: room, convection: {convection[1]}}}}}
"""
    air = AIR_DENSITY * AIR_HEAT * volume
    conductance = area / (resistance + 1.0 / convection[0] + 1.0 / convection[1]) + air * changes / 3600.0
    constant = factor * air / conductance
    step, end = 60.0, 3 * setup.HOUR
    columns = {"air_temperature": setup.steady(0.0), "cold": setup.steady(0.0)}
    series = setup.run(text, end, columns, step=step, outputs=["room.air_temperature"], initial=20.0).records[
        :, 0
    ]
    # SDIRK2 follows an exponential with the relative error 0.04 (dt/tau)^2 per time constant.
    for hours in (1.0, 3.0):
        elapsed = hours * setup.HOUR / constant
        expected = 20.0 * math.exp(-elapsed)
        bound = 2.0 * 0.0404 * (step / constant) ** 2 * elapsed * expected
        temperature = series[round(hours * setup.HOUR / step)]
        yield Check.near(name, f"air after {hours:g} h", "degC", temperature, expected, within=bound)


# --- two zones, steady -------------------------------------------------------------------------------------


def _two_zones(name: str) -> Iterator[Check]:
    text = """\
materials:
  brick: {conductivity: 0.8, density: 1700, specific_heat: 900}
  board: {conductivity: 0.2, density: 800, specific_heat: 1000}
constructions:
  wall: {layers: [{material: brick, thickness: 0.24}]}
  partition: {layers: [{material: board, thickness: 0.1}]}
zones:
  sunny: {volume: 40, infiltration: 0.5, longwave: none}
  shady: {volume: 25, infiltration: 2.0, longwave: none}
surfaces:
  south: {construction: wall, area: 10, tilt: 90, azimuth: 180,
          outside: {outdoors: true, convection: 20, emissivity: 0.9, absorptance: 0.6, longwave: none,
                    irradiance: sun},
          inside: {zone: sunny, convection: 3}}
  north: {construction: wall, area: 8, tilt: 90, azimuth: 0,
          outside: {outdoors: true, convection: 20, emissivity: 0.9, absorptance: 0.6, longwave: none,
                    irradiance: sky},
          inside: {zone: shady, convection: 3}}
  between: {construction: partition, area: 12, tilt: 90, azimuth: 0,
            outside: {zone: sunny, convection: 2.5}, inside: {zone: shady, convection: 2.0}}
  floor: {construction: wall, area: 16, tilt: 180, outside: {ground: {temperature: 12}},
          inside: {zone: sunny, convection: 1.5}}
"""
    days = 120
    columns = {"air_temperature": setup.steady(5.0), "sun": setup.steady(300.0), "sky": setup.steady(50.0)}
    outputs = [
        "sunny.air_temperature",
        "shady.air_temperature",
        "between.inside_flux",
        "south.outside_temperature",
    ]
    simulated = setup.run(
        text, days * setup.DAY, columns, step=setup.HOUR, outputs=outputs, initial=10.0
    ).records[-1]

    def vent(volume: float, changes: float) -> float:
        return AIR_DENSITY * AIR_HEAT * volume * changes / 3600.0

    brick, board = 0.24 / 0.8, 0.1 / 0.2
    south, north = 10.0 / (1 / 20 + brick + 1 / 3), 8.0 / (1 / 20 + brick + 1 / 3)
    between, floor = 12.0 / (1 / 2.5 + board + 1 / 2.0), 16.0 / (brick + 1 / 1.5)
    # An absorbed irradiance acts like outdoor air warmer by a I / h.
    sol_air = [5.0 + 0.6 * 300.0 / 20.0, 5.0 + 0.6 * 50.0 / 20.0]
    matrix = np.array(
        [[south + floor + between + vent(40, 0.5), -between], [-between, north + between + vent(25, 2.0)]]
    )
    right = np.array(
        [south * sol_air[0] + floor * 12.0 + vent(40, 0.5) * 5.0, north * sol_air[1] + vent(25, 2.0) * 5.0]
    )
    sunny, shady = np.linalg.solve(matrix, right)
    surface = sol_air[0] - south / 10.0 * (sol_air[0] - sunny) / 20.0
    flux = between / 12.0 * (sunny - shady)
    bound = 1e-6
    expected = (sunny, shady, flux, surface)
    units = ("degC", "degC", "W/m2", "degC")
    for output, unit, value, right_value in zip(outputs, units, simulated, expected, strict=True):
        yield Check.near(name, output, unit, value, float(right_value), within=bound)


# --- a building with all features: order in time, energy balance, ensembles --------------------------------

EVERYTHING: Final = """\
name: everything
site: {latitude: -35, longitude: 0, altitude: 55, timezone: UTC, sky: martin_berdahl}
materials:
  board: {conductivity: 0.16, density: 800, specific_heat: 1090}
  concrete: {conductivity: 1.75, density: 2240, specific_heat: 900}
  steel: {conductivity: 45, density: 7800, specific_heat: 480}
  foam: {conductivity: 0.028, density: 30, specific_heat: 1470}
  energain: {kind: pcm, density: 855, conductivity: [0.22, 0.18], specific_heat: [3134, 2833],
             latent_heat: 71000, melting_temperature: 23.4, law: {kind: tanh, width: 1.0}}
constructions:
  roof: {layers: [{material: steel, thickness: 0.001}]}
  ceiling: {layers: [{material: energain, thickness: 0.00526}, {material: board, thickness: 0.0125}]}
  wall: {layers: [{material: board, thickness: 0.01}, {material: foam, thickness: 0.06},
                  {material: board, name: lining, thickness: 0.01}]}
  floor: {layers: [{material: foam, thickness: 0.06}, {material: concrete, thickness: 0.08}]}
zones:
  gap: {volume: 2.7, infiltration: {constant: 0.1, temperature: 0.01, wind: 0.05}}
  room: {volume: 27, capacity_factor: 2, infiltration: 0.2}
surfaces:
  roof: {construction: roof, area: 9.6, tilt: 20, azimuth: 0,
         outside: {outdoors: true, convection: {kind: mowitt}, emissivity: 0.9, absorptance: 0.8,
                   height: 3.3},
         inside: {zone: gap, convection: {kind: tarp}, emissivity: 0.25}}
  ceiling: {construction: ceiling, area: 9.6, tilt: 20, azimuth: 0,
            outside: {zone: gap, convection: {kind: tarp}, emissivity: 0.05},
            inside: {zone: room, convection: {kind: alamdari_hammond, length: 3}, emissivity: 0.9}}
  north: {construction: wall, area: 9, tilt: 90, azimuth: 0,
          outside: {outdoors: true, convection: {kind: linear_wind, constant: 5.7, wind: 3.8},
                    emissivity: 0.9, absorptance: 0.4},
          inside: {zone: room, convection: {kind: tarp}, emissivity: 0.9}}
  south: {construction: wall, area: 9, tilt: 90, azimuth: 180,
          outside: {outdoors: true, convection: 15, emissivity: 0.9, absorptance: 0.4},
          inside: {zone: room, convection: 3, emissivity: 0.9}}
  floor: {construction: floor, area: 9, tilt: 180,
          outside: {ground: {mean: 22, amplitude: 2, coldest_day: 200}},
          inside: {zone: room, convection: {kind: alamdari_hammond, length: 3}, emissivity: 0.9}}
"""
"""A room under a melting ceiling and a ventilated gap: two zones, all heat flows, nonlinear laws."""


def island_weather(days: int) -> dict[str, setup.Array]:
    """Return hourly weather of smooth days on an island: warm, windy, clear and cloudy."""
    t = setup.times(days * setup.DAY, setup.HOUR)
    day, slow = 2.0 * np.pi * t / setup.DAY, 2.0 * np.pi * t / (2.7 * setup.DAY)
    light = np.maximum(-np.cos(day), 0.0)
    return {
        "air_temperature": 23.0 - 5.0 * np.cos(day - 0.7) + 1.5 * np.sin(slow),
        "dew_point": 16.0 + 2.0 * np.sin(slow + 1.0),
        "cloud_cover": 4.0 + 3.0 * np.sin(slow),
        "wind_speed": 3.0 - 1.5 * np.cos(day) + np.sin(slow),
        "wind_direction": 110.0 + 60.0 * np.sin(slow),
        "direct_normal": 700.0 * light,
        "diffuse_horizontal": 180.0 * light,
    }


def everything(
    step: float, days: int = 4, scheme: Scheme = "sdirk2", described: Building | None = None
) -> Simulation:
    """Prepare a simulation of the building with all features in the weather of an island. [s]"""
    outputs = ["room.air_temperature", "gap.air_temperature", "ceiling.outside_temperature",
               "roof.inside_flux",
               "ceiling.energain_liquid_fraction", "room.mean_radiant_temperature"]  # fmt: skip
    return setup.simulation(
        setup.building(EVERYTHING) if described is None else described,
        setup.climate(setup.HOUR, island_weather(days)),
        step=step,
        outputs=outputs,
        initial=23.0,
        scheme=scheme,
    )


_SMOOTH: Final = """\
materials:
  board: {conductivity: 0.2, density: 800, specific_heat: 1000}
  wax: {kind: pcm, density: 855, conductivity: [0.22, 0.18], specific_heat: [3134, 2833], latent_heat: 71000,
        melting_temperature: 23.4, law: {kind: tanh, width: 2.0}}
constructions:
  ceiling: {layers: [{material: wax, thickness: 0.01, nodes: 8},
                     {material: board, thickness: 0.0125, nodes: 4}]}
  wall: {layers: [{material: board, thickness: 0.03, nodes: 6}]}
zones: {room: {volume: 20, capacity_factor: 5, infiltration: 1}}
surfaces:
  ceiling: {construction: ceiling, area: 10, tilt: 0, outside: {measured: roof, convection: 5},
            inside: {zone: room, convection: {kind: tarp}, emissivity: 0.9}}
  wall: {construction: wall, area: 20, tilt: 90, azimuth: 0, outside: {measured: roof, convection: 8},
         inside: {zone: room, convection: 3, emissivity: 0.9}}
"""


def _order_in_time(name: str) -> Iterator[Check]:
    end = 1.5 * setup.DAY
    t = setup.times(end, 15.0)
    drive = 23.0 + 8.0 * np.sin(2.0 * np.pi * t / setup.DAY)
    columns = {"roof": drive, "air_temperature": drive}

    def state(step: float, scheme: Scheme) -> setup.Array:
        names = ["room.air_temperature", "ceiling.inside_temperature", "ceiling.wax_board_temperature",
                 "wall.inside_temperature"]  # fmt: skip
        run = setup.run(_SMOOTH, 15.0, columns, step=step, outputs=names, initial=23.0, scheme=scheme)
        return run.records[round(0.5 * end / step) :: round(0.125 * end / step)]

    schemes: tuple[tuple[Scheme, float, tuple[float, ...]], ...] = (
        ("sdirk2", 2.0, (1350.0, 675.0, 337.5)),
        ("backward-euler", 1.0, (540.0, 270.0, 135.0)),
    )
    exact = state(15.0, "sdirk2")
    for scheme, formal, steps in schemes:
        errors = [float(np.sqrt(np.mean((state(step, scheme) - exact) ** 2))) for step in steps]
        for k, (coarse, fine) in enumerate(pairwise(errors)):
            order = math.log2(coarse / fine)
            yield Check.near(name, f"{scheme}, halving {k + 1}", "-", order, formal, within=0.1)
        yield Check(name, f"{scheme}, error at {steps[-1]:g} s", "K", errors[-1])


CLOSED: Final = 1e-10
"""Largest relative energy-balance residual that this project accepts. [-]"""


def _closure(name: str) -> Iterator[Check]:
    schemes: tuple[Scheme, ...] = ("sdirk2", "backward-euler")
    for scheme in schemes:
        for step in (900.0, 3600.0):
            residual = everything(step, scheme=scheme).run().energy.closure
            yield Check.most(name, f"{scheme}, {step:g} s", "-", residual, high=CLOSED)


def _apparent_loss(name: str) -> Iterator[Check]:
    losses = [
        everything(step, scheme="apparent-capacity").run().energy.closure for step in (900.0, 450.0, 225.0)
    ]
    yield Check(name, "heat lost over total heat exchanged, 900 s", "-", losses[0])
    for k, (coarse, fine) in enumerate(pairwise(losses)):
        yield Check(name, f"order of the loss, halving {k + 1} (formally 1)", "-", math.log2(coarse / fine))


def _lanes(name: str) -> Iterator[Check]:
    prepared = everything(900.0, days=2)
    rng = np.random.default_rng(20)
    samples = np.tile(prepared.values, (11, 1))  # one full pack of eight and a part
    paths = ("materials.energain.latent_heat", "materials.energain.law.width",
             "surfaces.roof.outside.absorptance",
             "zones.room.infiltration.constant", "surfaces.ceiling.outside.emissivity", "surfaces.north.area",
             "constructions.ceiling.layers.energain.thickness")  # fmt: skip
    for path in paths:
        samples[:, prepared.position(path)] *= rng.uniform(0.6, 1.2, len(samples))
    records, closure, failures = prepared.ensemble(samples)
    alone = [prepared.run_vector(row) for row in samples]
    apart = max(float(np.max(np.abs(records[k] - run.records))) for k, run in enumerate(alone))
    residual = max(abs(float(closure[k]) - run.energy.closure) for k, run in enumerate(alone))
    yield Check.most(name, "largest difference of 11 members, alone and in an ensemble", "K", apart, high=0.0)
    yield Check.most(name, "largest difference of the energy-balance residual", "-", residual, high=0.0)
    yield Check.most(name, "members that failed", "-", float(len(failures)), high=0.0)


CASES: Final = (
    Case(
        name="lumped zone",
        problem="A room of 30 m3 behind a panel without mass, 1.5 air changes an hour, all at 20 "
        "degC; the outdoor air changes to 0 degC. 60 s.",
        answer="T = T0 exp(-t/tau), tau = 4 rho c V/(A/(1/he + R + 1/hi) + rho c V n/3600)",
        source="heat balance of one capacity",
        tolerance="Twice the leading term of the step, 0.04 (dt/tau)^2 t/tau, times the temperature.",
        topics=("building",),
        work=_lumped,
    ),
    Case(
        name="two zones, steady",
        problem="Two zones behind sunlit walls, with a partition, a floor on ground of 12 degC and "
        "infiltration; 120 days.",
        answer="two heat balances with sol-air temperatures, K T = q",
        source="heat balance",
        tolerance="1e-6 K: the tolerance of Newton's iteration, the only difference of a steady state "
        "from its balance.",
        topics=("building",),
        work=_two_zones,
    ),
    Case(
        name="order in dt",
        problem="A room with a melting ceiling (half-width 2 K), natural convection and radiosity between "
        "sinusoids, compared with a run at 15 s. Root mean square over four temperatures at five times.",
        answer="error ~ dt^2 (SDIRK2), ~ dt (backward Euler)",
        source="Alexander 1977, doi:10.1137/0714068",
        tolerance="The formal order within 0.1: the effect of the next order at these steps is smaller.",
        topics=("building",),
        work=_order_in_time,
    ),
    Case(
        name="energy balance",
        problem="A room under a melting ceiling and a ventilated gap, four days of sun and wind: all "
        "heat flows, all laws nonlinear.",
        answer="stored = solar + convection + long-wave + boundary + infiltration, in every step",
        source="first law of thermodynamics",
        tolerance="1e-10 of the total heat exchanged, as for every run.",
        topics=("building",),
        work=_closure,
    ),
    Case(
        name="apparent capacity",
        problem="The same building with the scheme of the paper, which takes the heat capacity at the "
        "previous temperature.",
        answer="heat is lost in proportion to dt, as long as a step stays within the melting range",
        source="Guichard et al., eq. 2 with implicit Euler",
        tolerance="For information: this scheme is available to show its loss.",
        topics=("building",),
        work=_apparent_loss,
    ),
    Case(
        name="ensemble",
        problem="Eleven variants of that building in an ensemble, eight at a time in SIMD lanes, and each of "
        "them alone.",
        answer="the same bits",
        source="requirement of this project",
        tolerance="0.",
        topics=("building",),
        work=_lanes,
    ),
)
