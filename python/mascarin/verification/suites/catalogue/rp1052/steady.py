"""Steady walls, a sky, and air that passes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

from mascarin.verification.suites.case_data import CaseData, Tree, simulated
from mascarin.verification.suites.catalogue.rp1052.room import (
    CLOSED,
    indoors,
    number,
    outdoors,
    room,
    rows,
    steady_air,
)
from mascarin.verification.suites.verdict import VerdictLine, around

#: Of loads, of the air of a fan, and of that of a stack. [-]
_OF_LOAD, _OF_AIR, _OF_STACK = 0.001, 0.005, 0.02
#: Of surfaces between two airs, and of those under a sky. [K]
_SURFACE, _UNDER_SKY = 0.01, 0.02
_OUTPUTS: Final = ("room.net_load", "wall.inside_temperature", "wall.outside_temperature")
#: Density outdoors at 10 degC [kg/m3], specific heat [J/(kg K)] of air with 4.6 g of vapour in a kilogram.
_DENSITY: Final = 1.2432
_HEAT: Final = 1006.0 + 1860.0 * 0.0046


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Walls, then the sky, then air."""
    yield from _walls(data)
    yield from _sky(data)
    yield from _infiltration(data)
    yield from _stack(data)


def _walls(data: CaseData) -> Iterator[VerdictLine]:
    thick = ((0.1, 1.0, 1.0, 100.0),)
    three = ((0.1, 0.1, 1.0, 100.0), (0.05, 0.05, 1.0, 100.0), (0.05, 0.25, 1.0, 100.0))
    for case, layers, film in (("SSConv", thick, 3.079), ("SSCond", three, 2.18)):
        table = _table(data, f"Tests_SSConv_and_SSCond__Test_{case}")
        tree = room(layers, outdoors(film), indoors(), zone={"held": 10.0})
        last = _last(data, tree, 40.0)
        load, program = table["Zone Load"]
        value = -last["room.net_load"]
        yield VerdictLine(
            case, "load", "W", value, load, around(load, _OF_LOAD * load), {"EnergyPlus": program}
        )
        for side in ("inside", "outside"):
            reference, program = table[f"{side.capitalize()} Surface Temperature"]
            value = last[f"wall.{side}_temperature"]
            limits = around(reference, _SURFACE)
            yield VerdictLine(
                case, f"{side} surface", "degC", value, reference, limits, {"EnergyPlus": program}
            )


def _sky(data: CaseData) -> Iterator[VerdictLine]:
    table = _table(data, "Test_ExtLWRad__Test_ExtLWRad")
    # The sky is at 7.552 degC.
    sky = {"sky": {"kind": "offset", "depression": 20.0 - 7.552}}
    roof = outdoors(1.352, longwave=None)
    tree = room(((0.1, 1.0, 1.0, 100.0),), roof, indoors(4.04), zone={"held": 20.0}, keys_of_site=sky, tilt=0)
    last = _last(data, tree, 20.0)
    load, program = table["Zone Load"]
    yield VerdictLine(
        "ExtLWRad", "load", "W", last["room.net_load"], load, around(load, 0.5), {"EnergyPlus": program}
    )
    for side in ("inside", "outside"):
        reference, program = table[f"{side.capitalize()} Surface Temperature"]
        value = last[f"wall.{side}_temperature"]
        limits = around(reference, _UNDER_SKY)
        yield VerdictLine(
            "ExtLWRad", f"{side} surface", "degC", value, reference, limits, {"EnergyPlus": program}
        )


def _infiltration(data: CaseData) -> Iterator[VerdictLine]:
    load, program = _table(data, "Tests_Infil-1__Infil-1")["Zone Load"]
    zone = {"held": 20.0, "ventilation": {"fan": {"flow": 0.5}}}
    tree = room(((0.1, 1.15, 1.0, 100.0),), CLOSED, indoors(3.0), zone=zone, keys_of_site=_air())
    value = _last(data, tree, 10.0)["room.net_load"]
    limits = around(load, _OF_AIR * load)
    yield VerdictLine("Infil-1", "load", "W", value, load, limits, {"EnergyPlus": program})


def _stack(data: CaseData) -> Iterator[VerdictLine]:
    table = _table(data, "Tests_Infil-2__Infil-1")
    # Cracks at 0.25 and 9.75 m pass 0.0929 kg/s at 1 Pa; an opening has its flow at 4 Pa.
    exponent, coefficient = 0.65, 0.0929
    area = coefficient / _DENSITY / (0.6 * math.sqrt(2.0 / _DENSITY) * 4.0 ** (0.5 - exponent))
    crack = {"zone": "room", "area": area, "exponent": exponent, "discharge": 0.6, "azimuth": 0}
    vents = {
        name: crack | {"elevation": height, "pressure": "none"}
        for name, height in (("low", 0.25), ("high", 9.75))
    }
    tree = room(
        ((0.1, 0.04, 30.0, 800.0),),
        CLOSED,
        indoors(3.0),
        zone={"held": 20.0},
        keys_of_site=_air(),
        vents=vents,
    )
    last = _last(data, tree, 10.0, ("room.net_load", "low.inflow"))
    flow, program = table["Mass Flow Rate of Air"]
    limits = around(flow, _OF_STACK * flow)
    value = _DENSITY * last["low.inflow"]
    yield VerdictLine("Infil-2", "mass flow", "kg/s", value, flow, limits, {"EnergyPlus": program})
    load, program = table["Zone Load"]
    limits = around(load, _OF_STACK * load)
    yield VerdictLine("Infil-2", "load", "W", last["room.net_load"], load, limits, {"EnergyPlus": program})


def _air() -> Tree:
    return {"air_density": _DENSITY, "air_specific_heat": _HEAT}


def _table(data: CaseData, name: str) -> dict[str, tuple[float, float]]:
    """Numbers of the toolkit and of EnergyPlus by the words beside them."""
    return {row[1]: (number(row[5]), number(row[6])) for row in rows(data, name) if len(row) > 6 and row[1]}


def _last(
    data: CaseData, tree: Tree, outdoor: float, outputs: tuple[str, ...] = _OUTPUTS
) -> Mapping[str, Any]:
    """Records of the steady state."""
    _, table = simulated(data.building(tree), steady_air(outdoor, 40), outputs, "15min", "repeat")
    return {name: float(table[name].iloc[-1]) for name in outputs}
