"""Openings of the pressure network and controls of openings as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.engine_input.air import control_of, schedule_of
from mascarin.building.engine_input.ids import Ids, Json, Positions, below, deeper, each
from mascarin.building.parts.air.vent import LowRise, PressureTable, Vent, VentControl
from mascarin.building.parts.description import Description


def describe_vents(building: Description, positions: Positions, ids: Mapping[str, int]) -> Json:
    """Describe all openings of the pressure network, and all controls."""

    def vent(name: str, part: Vent, part_ids: Ids) -> Json:
        return _vent(building, positions, (name, part), part_ids, ids)

    def control(name: str, part: VentControl, part_ids: Ids) -> Json:
        return _control(building, positions, (name, part), part_ids)

    return {
        "vents": each(building.vents, "vents", ids, vent),
        "controls": each(building.controls, "controls", ids, control),
    }


def _vent(
    building: Description,
    positions: Positions,
    named: tuple[str, Vent],
    part_ids: Ids,
    all_ids: Mapping[str, int],
) -> Json:
    name, vent = named
    zones = [list(building.zones).index(zone) for zone in vent.ends]
    numbers = {key: part_ids(key) for key in ("area", "elevation", "discharge", "exponent")}
    written: Json = {
        "name": name,
        "zone": zones[0],
        "to": zones[1] if vent.between else None,
        **numbers,
        "height": None if vent.height is None else part_ids("height"),
        **schedule_of(vent, positions),
        **control_of(building, vent),
    }
    if isinstance(vent.pressure, LowRise | PressureTable):
        written["wind"] = _wind(vent, vent.pressure, part_ids, all_ids)
    return written


def _wind(vent: Vent, pressure: LowRise | PressureTable, part_ids: Ids, all_ids: Mapping[str, int]) -> Json:
    inner_ids = deeper(part_ids, "pressure")
    azimuth: int | None = None
    if vent.azimuth is not None:
        azimuth = part_ids("azimuth")
    elif vent.surface is not None:
        azimuth = below(all_ids, f"surfaces.{vent.surface}")("azimuth")
    law: dict[str, Any] = {"kind": pressure.kind}
    if isinstance(pressure, LowRise):
        law["side_ratio"] = inner_ids("side_ratio")
    else:
        law["coefficients"] = [float(number) for number in pressure.coefficients]
    return {
        "azimuth": azimuth,
        "height": part_ids("elevation") if pressure.height is None else inner_ids("height"),
        "shelter": inner_ids("shelter"),
        "pressure": law,
    }


def _control(
    building: Description, positions: Positions, named: tuple[str, VentControl], part_ids: Ids
) -> Json:
    name, control = named
    zones = list(building.zones)
    written: Json = {"name": name, "zone": zones.index(control.zone)}
    if control.reference_zone is not None:
        written["reference_zone"] = zones.index(control.reference_zone)
    for condition, _ in control.conditions:
        inner_ids = deeper(part_ids, condition)
        band = {"open": inner_ids("open"), "close": inner_ids("close")}
        if condition == "rain" and control.rain is not None:
            written[condition] = {"channel": positions[control.rain.course.name], "band": band}
        else:
            written[condition] = band
    for key in ("minimum_open_time", "minimum_closed_time"):
        if getattr(control, key) is not None:
            written[key] = part_ids(key)
    return written
