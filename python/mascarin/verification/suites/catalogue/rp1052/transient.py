"""Steps and a sinusoid of the air outside, and gains that begin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, simulated
from mascarin.verification.suites.catalogue.rp1052.room import (
    CLOSED,
    INSIDE_FILM,
    Layers,
    indoors,
    numbers,
    outdoors,
    room,
    steady_air,
    weather,
)
from mascarin.verification.suites.verdict import VerdictLine, largest

_WOOD: Final = ((0.1, 0.14, 500.0, 2500.0),)
_WOOL: Final = ((0.1, 0.03, 30.0, 1300.0),)
_FILM: Final = 10.22
_STEP: Final = "5min"
#: Tolerances of surfaces inside and outside [K], of loads after a step, of a sinusoid and of gains [W].
_INSIDE, _OUTSIDE, _LOAD, _SINUSOID, _GAIN = 0.1, 0.3, 4.0, 0.5, 15.0


@dataclass(frozen=True)
class Jump:
    """A wall outside of which the air jumps; its file; whether a room of 20 degC is behind it."""

    case: str
    file: str
    layers: Layers
    room: bool


_JUMPS: Final = (
    Jump("TC1 wood", "Test_TC1-TS6__ASHRAE_10cm_Wood", _WOOD, room=False),
    Jump("TC1 insulation", "Test_TC1-TS6__ASHRAE_10cm_Insul", _WOOL, room=False),
    Jump("TC2 up", "Test_TC2-StepUp-TS6__ASHRAE_10cm_Wood", _WOOD, room=True),
    Jump("TC2 down", "Test_TC2-StepDown-TS6__ASHRAE_10cm_Wood", _WOOD, room=True),
)


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Steps, the sinusoid, gains."""
    for jump in _JUMPS:
        yield from _jump(data, jump)
    yield _sinusoid(data)
    for name, radiant in (("100_Rad", 1.0), ("50_Rad", 0.5), ("100_Conv", 0.0)):
        yield from _gain(data, name, radiant)


def _jump(data: CaseData, jump: Jump) -> Iterator[VerdictLine]:
    # Air outside, surfaces inside and outside, load.
    table = numbers(data, jump.file, (2, 3, 4, 7), 2)
    first = int(np.flatnonzero(np.diff(table[:, 0]))[0])
    air, inside, outside, load = table[first:].T
    count = len(air)
    # Air of 70 degC is no weather: the side faces a column.
    face = {"measured": "air", "convection": _FILM}
    into = indoors() if jump.room else CLOSED
    tree = room(jump.layers, face, into, zone={"held": 20.0} if jump.room else None)
    columns = {
        "air_temperature": np.full(count + 2, 20.0),
        "air": np.full(count + 2, float(air[1])),
    }
    # Before the jump the wall is steady, linear between its sides.
    initial: Any = 20.0
    if air[0] != initial:
        initial = {"zones": {"room": 20.0}, "surfaces": {"wall": [float(outside[0]), float(inside[0])]}}
    outputs = ["wall.inside_temperature", "wall.outside_temperature"]
    outputs += ["room.net_load"] if jump.room else []
    hours, run = simulated(data.building(tree), weather(columns, extra=["air"]), outputs, _STEP, initial)
    hour = np.arange(1, count)
    for side, reference, tolerance in (("inside", inside, _INSIDE), ("outside", outside, _OUTSIDE)):
        values = np.interp(hour, hours, run[f"wall.{side}_temperature"].to_numpy())
        series = hour, values, reference[1:]
        yield largest(jump.case, f"{side} surface, worst of {count - 1} h", "degC", series, tolerance)
    if jump.room:
        series = hour, _load(hour, hours, run["room.net_load"].to_numpy()), load[1:]
        yield largest(jump.case, f"load, worst of {count - 1} h", "W", series, _LOAD)


def _sinusoid(data: CaseData) -> VerdictLine:
    load = numbers(data, "Test_TC3-TS6__ASHRAE_Results", (1, 2, 3), 3)[:, 2]
    count = len(load)
    hour = np.arange(12 * count + 12) / 12.0
    climate = weather({"air_temperature": 20.0 + 15.0 * np.sin(2.0 * np.pi * hour / 24.0)}, step=_STEP)
    layers = ((0.1, 0.2, 500.0, 800.0), (0.05, 0.1, 50.0, 200.0), (0.1, 0.14, 700.0, 500.0))
    tree = room(layers, outdoors(_FILM), indoors(), zone={"held": 20.0})
    hours, run = simulated(data.building(tree), climate, ["room.net_load"], _STEP, "repeat")
    times = np.arange(25, count + 1)
    series = times, _load(times, hours, run["room.net_load"].to_numpy()), load[24:]
    return largest("TC3 sinusoid", f"load, worst of {len(times)} h", "W", series, _SINUSOID)


def _gain(data: CaseData, name: str, radiant: float) -> Iterator[VerdictLine]:
    # The gain ends after a week.
    file = f"Test_IntHeatGain-2XWall-TS6-OpenZone__ASHRAE_{name}"
    _, surface, load = numbers(data, file, (0, 2, 4), 1)[:168].T
    count = len(load)
    zone = {"held": 20.0, "gains": {"step": {"power": 2700, "radiative": radiant}}}
    tree = room(_WOOD, CLOSED, indoors(INSIDE_FILM), zone=zone, area=54.0)
    outputs = ["wall.inside_temperature", "room.net_load"]
    hours, run = simulated(data.building(tree), steady_air(20.0, count + 3), outputs, _STEP, 20.0)
    hour = np.arange(1, count)
    case = f"IntHeatGain {radiant:.0%} radiant"
    if radiant > 0.0:
        values = np.interp(hour, hours, run["wall.inside_temperature"].to_numpy())
        series = hour, values, surface[1:]
        yield largest(case, f"inside surface, worst of {count - 1} h", "degC", series, _INSIDE)
    series = hour, _load(hour, hours, run["room.net_load"].to_numpy()), load[1:]
    yield largest(case, f"load, worst of {count - 1} h", "W", series, _GAIN)


def _load(hour: Any, hours: Any, heat: Any) -> Any:
    """Cooling load at the hour; a record is the mean of its step. [W]"""
    return np.interp(hour, hours - 1.0 / 24.0, -heat)
