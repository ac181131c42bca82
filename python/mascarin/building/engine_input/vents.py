"""Openings of the pressure network and controls of openings as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.engine_input.air import control_of, schedule_of
from mascarin.building.engine_input.ids import Ids, Json, Places, below, deeper, each
from mascarin.building.parts.air.vent import LowRise, PressureTable, Vent, VentControl
from mascarin.building.parts.description import Description


def describe_vents(building: Description, places: Places, ids: Mapping[str, int]) -> Json:
    """Describe all openings of the pressure network, and all controls."""

    def vent(name: str, part: Vent, own: Ids) -> Json:
        return _vent(building, places, (name, part), own, ids)

    def control(name: str, part: VentControl, own: Ids) -> Json:
        return _control(building, places, (name, part), own)

    return {
        "vents": each(building.vents, "vents", ids, vent),
        "controls": each(building.controls, "controls", ids, control),
    }


def _vent(
    building: Description, places: Places, named: tuple[str, Vent], own: Ids, every: Mapping[str, int]
) -> Json:
    name, vent = named
    zones = [list(building.zones).index(zone) for zone in vent.ends]
    numbers = {key: own(key) for key in ("area", "elevation", "discharge", "exponent")}
    written: Json = {
        "name": name,
        "zone": zones[0],
        "to": zones[1] if vent.between else None,
        **numbers,
        "height": None if vent.height is None else own("height"),
        **schedule_of(vent, places),
        **control_of(building, vent),
    }
    if isinstance(vent.pressure, LowRise | PressureTable):
        written["wind"] = _wind(vent, vent.pressure, own, every)
    return written


def _wind(vent: Vent, pressure: LowRise | PressureTable, own: Ids, every: Mapping[str, int]) -> Json:
    at = deeper(own, "pressure")
    azimuth: int | None = None
    if vent.azimuth is not None:
        azimuth = own("azimuth")
    elif vent.surface is not None:
        azimuth = below(every, f"surfaces.{vent.surface}")("azimuth")
    law: dict[str, Any] = {"kind": pressure.kind}
    if isinstance(pressure, LowRise):
        law["side_ratio"] = at("side_ratio")
    else:
        law["coefficients"] = [float(number) for number in pressure.coefficients]
    return {
        "azimuth": azimuth,
        "height": own("elevation") if pressure.height is None else at("height"),
        "shelter": at("shelter"),
        "pressure": law,
    }


def _control(building: Description, places: Places, named: tuple[str, VentControl], own: Ids) -> Json:
    name, control = named
    written: Json = {"name": name, "zone": list(building.zones).index(control.zone)}
    for condition, _ in control.conditions:
        at = deeper(own, condition)
        band = {"open": at("open"), "close": at("close")}
        if condition == "rain" and control.rain is not None:
            written[condition] = {"channel": places[control.rain.course.name], "band": band}
        else:
            written[condition] = band
    for key in ("minimum_open_time", "minimum_closed_time"):
        if getattr(control, key) is not None:
            written[key] = own(key)
    return written
