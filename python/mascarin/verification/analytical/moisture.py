"""Moisture: a room of constant temperature with a source of vapour by day, without and with sorption.

The situation of cases 0A and 0B of common exercise 1 of IEA Annex 41: the room of BESTEST, 500 g/h from 9 to
17 h, 0.5 air changes an hour. The report of the exercise with its series was not at hand: its series are not
compared, and the numbers of the wall in the second case are our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from mascarin.verification.analytical import setup
from mascarin.verification.analytical.check import Case, Check
from mascarin.verification.analytical.zones import AIR_DENSITY, AIR_HEAT

if TYPE_CHECKING:
    from mascarin.simulation.results import Results

WARM: Final = 20.0
OUTDOORS: Final = 0.3
VOLUME: Final = 129.6
AREA: Final = 171.6
CHANGES: Final = 0.5
SOURCE: Final = 0.5 / 3600.0
BEGIN, END = 9, 17
PRESSURE: Final = 101_325.0
#: Film of the wall [W/(m2 K)]; capacity [kg/m3], vapour resistance [-] and depth [m] of what sorbs.
FILM: Final = 8.29
CAPACITY: Final = 20.0
RESISTANCE: Final = 7.0
DEPTH: Final = 0.01
#: Gas constant of water vapour. [J/(kg K)]
GAS: Final = 461.524
#: Terms of the Fourier series of the thick wall.
HARMONICS: Final = 4000

DRY: Final = AIR_DENSITY * VOLUME
FLOW: Final = DRY * CHANGES / 3600.0


def saturation(celsius: float) -> float:
    """Saturation pressure over water (ASHRAE Handbook of Fundamentals 2017, ch. 1, eq. 6). [Pa]"""
    t = celsius + 273.15
    terms = -5.8002206e3 / t + 1.3914993 - 4.8640239e-2 * t + 4.1764768e-5 * t**2
    return math.exp(terms - 1.4452093e-8 * t**3 + 6.5459673 * math.log(t))


def _ratio(humidity: float) -> float:
    """Humidity ratio at a relative humidity. [kg/kg]"""
    vapour = humidity * saturation(WARM)
    return 0.621945 * vapour / (PRESSURE - vapour)


def _relative(ratio: float) -> float:
    """Relative humidity at a humidity ratio. [-]"""
    return float(ratio * PRESSURE / (0.621945 + ratio) / saturation(WARM))


def _slope(ratio: float) -> float:
    """Change of the vapour pressure with the humidity ratio. [Pa]"""
    return PRESSURE * 0.621945 / (0.621945 + ratio) ** 2


def _run(source: float, sorption: str, initial: float, days: int, step: float) -> Results:
    text = f"""\
materials: {{concrete: {{conductivity: 0.18, density: 650, specific_heat: 840}}}}
constructions: {{wall: {{layers: [{{material: concrete, thickness: 0.15}}]}}}}
schedules:
  day: {{kind: fraction, days: {{all: [{{at: "00:00", value: 0}}, {{at: "{BEGIN:02d}:00", value: 1}},
                                       {{at: "{END}:00", value: 0}}]}}}}
zones: {{room: {{volume: {VOLUME}, infiltration: {CHANGES}, longwave: none}}}}
surfaces:
  walls: {{construction: wall, area: {AREA}, tilt: 90, azimuth: 0,
           outside: {{measured: outside, convection: 29.3}}, inside: {{zone: room, convection: {FILM}}}}}
humidity:
  initial: {initial}
{sorption}  zones: {{room: {{gains: {{source: {{rate: {source}, schedule: day}}}}}}}}
"""
    dew_point = float(brentq(lambda t: saturation(t) - OUTDOORS * saturation(WARM), 0.1, WARM))
    columns = {
        "air_temperature": setup.steady(WARM),
        "outside": setup.steady(WARM),
        "dew_point": setup.steady(dew_point),
    }
    outputs = ["room.relative_humidity"]
    return setup.run(text, days * setup.DAY, columns, step=step, outputs=outputs, initial=WARM)


def _last_day(results: Results, step: float) -> tuple[float, float]:
    """Relative humidity at the begin and at the end of the source on the last day. [-]"""
    per_day = round(setup.DAY / step)
    day = results.records[-per_day - 1 :, 0]
    return float(day[round(BEGIN * per_day / 24)]), float(day[round(END * per_day / 24)])


def _without_sorption(name: str) -> Iterator[Check]:
    step = 300.0
    begin, end = _last_day(_run(SOURCE, "", OUTDOORS, 3, step), step)
    full, on, off = SOURCE / FLOW, CHANGES * (END - BEGIN), CHANGES * (24 - END + BEGIN)
    peak = full * (1.0 - math.exp(-on)) / (1.0 - math.exp(-on - off))
    outdoors = _ratio(OUTDOORS)
    # SDIRK2 follows an exponential with the relative error 0.04 (n dt)^2 per time constant.
    bound = 2.0 * 0.0404 * (CHANGES * step / 3600.0) ** 2 * math.exp(-1.0) * _relative(outdoors + full)
    for hour, value, excess in ((END, end, peak), (BEGIN, begin, peak * math.exp(-off))):
        expected = 100.0 * _relative(outdoors + excess)
        quantity = f"relative humidity at {hour} h"
        yield Check.near(name, quantity, "%", 100.0 * value, expected, within=100.0 * bound)


def _exchange() -> float:
    """Transfer of vapour from the air to the middle of the layer. [kg/(m2 s Pa)]"""
    permeability = 2e-7 * (WARM + 273.15) ** 0.81 / PRESSURE / RESISTANCE
    film = FILM / (AIR_DENSITY * AIR_HEAT * GAS * (WARM + 273.15))
    return float(1.0 / (1.0 / film + 0.5 * DEPTH / permeability))


def _layer(source: float) -> tuple[float, float]:
    """Humidity ratio at the begin and the end of the source: air and one layer, linear about their mean."""
    mean = _ratio(OUTDOORS) + source / FLOW * (END - BEGIN) / 24.0
    transfer, saturated = AREA * _exchange(), saturation(WARM)
    to_wall, from_wall = transfer * _slope(mean), transfer * saturated
    store = AREA * DEPTH * CAPACITY
    matrix = np.array([[-(FLOW + to_wall) / DRY, from_wall / DRY], [to_wall / store, -from_wall / store]])
    share = (END - BEGIN) / 24.0
    on, off = (expm(matrix * hours * setup.HOUR) for hours in (END - BEGIN, 24 - END + BEGIN))
    # Steady states with the source on and off, as differences from the mean.
    steady = [np.linalg.solve(-matrix, [source * part / DRY, 0.0]) for part in (1.0 - share, -share)]
    # x_end = r_on + E_on (x_begin - r_on), x_begin = r_off + E_off (x_end - r_off)
    constant = steady[0] - on @ steady[0] + on @ (steady[1] - off @ steady[1])
    end = np.linalg.solve(np.eye(2) - on @ off, constant)
    begin = steady[1] + off @ (end - steady[1])
    return mean + float(begin[0]), mean + float(end[0])


def _thick_wall(source: float) -> tuple[float, float]:
    """The same with a thick wall of the resistance ``1/sqrt(i w c delta/p_sat)``, by a Fourier series."""
    mean = _ratio(OUTDOORS) + source / FLOW * (END - BEGIN) / 24.0
    permeability = 2e-7 * (WARM + 273.15) ** 0.81 / PRESSURE / RESISTANCE
    film = FILM / (AIR_DENSITY * AIR_HEAT * GAS * (WARM + 273.15))
    k = np.arange(1, HARMONICS + 1)
    omega = 2.0 * np.pi * k / setup.DAY
    wall = 1.0 / np.sqrt(1j * omega * CAPACITY * permeability / saturation(WARM))
    gain = source * (np.exp(-1j * omega * BEGIN * 3600) - np.exp(-1j * omega * END * 3600))
    response = gain / (2j * np.pi * k) / (1j * omega * DRY + FLOW + AREA * _slope(mean) / (1.0 / film + wall))
    begin, end = (2.0 * float(np.sum(response * np.exp(1j * omega * h * 3600)).real) for h in (BEGIN, END))
    return mean + begin, mean + end


def _with_sorption(name: str) -> Iterator[Check]:
    step, days = 900.0, 12
    law = f"{{capacity: {CAPACITY}, vapour_resistance: {RESISTANCE}, depth: {DEPTH}}}"
    sorption = f"  materials: {{concrete: {law}}}\n"
    for source, words in ((0.01 * SOURCE, "5 g/h"), (SOURCE, "500 g/h")):
        mean = _ratio(OUTDOORS) + source / FLOW * (END - BEGIN) / 24.0
        begin, end = _last_day(_run(source, sorption, _relative(mean), days, step), step)
        expected = [100.0 * _relative(humidity_ratio) for humidity_ratio in _layer(source)]
        swing = expected[1] - expected[0]
        bound = 2e-3 * swing
        for hour, value, right in ((END, end, expected[1]), (BEGIN, begin, expected[0])):
            quantity = f"relative humidity at {hour} h, {words}"
            yield Check.near(name, quantity, "%", 100.0 * value, right, within=bound)
    for hour, value, ratio in zip((BEGIN, END), (begin, end), _thick_wall(SOURCE), strict=True):
        quantity = f"relative humidity at {hour} h, 500 g/h, beside a thick wall"
        yield Check(name, quantity, "%", 100.0 * value, 100.0 * _relative(ratio))


CASES: Final = (
    Case(
        name="moisture by day, no sorption",
        problem="A room of 129.6 m3 at 20 degC, outdoor air of 20 degC and 30 %, 0.5 air changes an hour, "
        "500 g/h of vapour from 9 to 17 h; nothing takes up vapour (as case 0A of common exercise 1, IEA "
        "Annex 41). Day 3, 300 s.",
        answer="w = w_o + G/m (1 - exp(-8 n))/(1 - exp(-24 n)) at 17 h, and exp(-16 n) of it at 9 h",
        source="vapour balance of well-mixed air; the situation: Rode & Woloszyn 2007, Whole-building "
        "hygrothermal modeling in IEA Annex 41. The outdoor humidity is ours, the series of the exercise are "
        "not compared",
        tolerance="Twice the leading term of the step, 0.04 (n dt)^2 exp(-1), times the steady humidity.",
        topics=("building",),
        work=_without_sorption,
    ),
    Case(
        name="moisture by day, sorbing walls",
        problem="The same room with 171.6 m2 of aerated concrete that takes up vapour (as case 0B; sorption "
        "in proportion to the humidity, 20 kg/m3, vapour resistance 7, one layer of 10 mm: our numbers). "
        "Day 12, 900 s.",
        answer="two linear balances of air and layer about their mean, periodic: matrix exponentials of 8 h "
        "and 16 h; beside a thick wall: Fourier series with p/f = 1/h_v + 1/sqrt(i w c delta/p_sat)",
        source="vapour balances; thick wall: Carslaw & Jaeger 1959, 2.6, with vapour in place of heat",
        tolerance="0.2 % of the swing: the step, what is left of the start, and at 500 g/h the vapour "
        "pressure, which is not linear in the humidity ratio. The thick wall shows what the one layer leaves "
        "out.",
        topics=("building",),
        work=_with_sorption,
    ),
)
