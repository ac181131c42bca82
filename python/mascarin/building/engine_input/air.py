"""Air between zones, mechanical ventilation, openings and thermal bridges as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.base.time_series import temperature_course
from mascarin.building.engine_input.ids import Ids, Json, Positions, below, deeper, fields_of
from mascarin.building.parts.air.air_path import AirPath, Opening
from mascarin.building.parts.air.flow_density import ConstantDensity
from mascarin.building.parts.air.set_point import SetPoint
from mascarin.building.parts.air.ventilation import VentilationUnit
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.bridge import ThermalBridge
from mascarin.building.parts.envelope.measured_values import Driven


def schedule_of(part: Any, positions: Positions) -> Json:
    """Channel of the schedule of a part."""
    return {"schedule": None if part.schedule is None else positions[part.schedule]}


def control_of(building: Description, part: Any) -> Json:
    """Position of the control of a part."""
    return {"control": None if part.control is None else list(building.controls).index(part.control)}


def driven(part: Driven, key: str, positions: Positions, ids: Ids) -> Json:
    """Describe a power or flow: a number with its schedule, or a factor with the channel of its column."""
    if part.course is None:
        return {key: ids(key), **schedule_of(part, positions)}
    return {key: ids("factor"), "schedule": positions[part.course.name]}


def density_of(part: Any, ids: Ids, prefix: str = "") -> Json:
    """Describe the density at which a flow is a volume; nothing where it is that of the site."""
    if part.density is None or part.density.kind == "site":
        return {}
    written: Json = {"kind": part.density.kind}
    if isinstance(part.density, ConstantDensity):
        written["value"] = ids(f"{prefix}density.constant")
    return {"density": written}


def set_point(point: SetPoint, positions: Positions, ids: Ids) -> Json:
    """Describe a temperature that is a number, a schedule or a column."""
    if point.temperature is not None:
        return {"kind": "constant", "temperature": ids("temperature")}
    return {"kind": "scheduled", "channel": positions[str(point.course)]}


def describe_air_path(
    building: Description, positions: Positions, name: str, path: AirPath, ids: Ids
) -> Json:
    """Describe the air that two zones exchange, or that flows from one to the other."""
    first, second = _zones(building, path)
    ends = {"from": first, "to": second} if path.one_way else {"between": [first, second]}
    written = {"name": name, **ends, **driven(path, "flow", positions, ids), **density_of(path, ids)}
    # A flow one way has none.
    return written if path.one_way else written | control_of(building, path)


def describe_door(building: Description, positions: Positions, name: str, path: AirPath, ids: Ids) -> Json:
    """Describe a door between two zones."""
    written = {"name": name, "between": list(_zones(building, path))}
    numbers = fields_of(path.door, ids, "door.")
    return {**written, **numbers, **schedule_of(path, positions), **control_of(building, path)}


def _zones(building: Description, path: AirPath) -> tuple[int, int]:
    first, second = (list(building.zones).index(zone) for zone in path.between)
    return first, second


def describe_unit(
    building: Description, positions: Positions, name: str, unit: VentilationUnit, ids: Ids
) -> Json:
    """Describe a ventilation unit."""
    zones = list(building.zones)

    def flows(section: str) -> list[Json]:
        flow_ids = {zone: deeper(ids, f"{section}.{zone}") for zone in getattr(unit, section)}
        return [
            {
                "zone": zones.index(zone),
                **driven(flow, "flow", positions, flow_ids[zone]),
                **density_of(flow, flow_ids[zone]),
            }
            for zone, flow in getattr(unit, section).items()
        ]

    supply = unit.temperature
    return {
        "name": name,
        "supply": flows("supply"),
        "exhaust": flows("exhaust"),
        "temperature": None if supply is None else set_point(supply, positions, deeper(ids, "temperature")),
        "recovery": None if unit.recovery is None else ids("recovery"),
    }


def describe_opening(
    building: Description, positions: Positions, name: str, opening: Opening, ids: Ids
) -> Json:
    """Describe an opening to outdoors."""
    zone = list(building.zones).index(opening.zone)
    written = {"name": name, "zone": zone, **fields_of(opening, ids)}
    return {**written, **schedule_of(opening, positions), **control_of(building, opening)}


def describe_bridges(building: Description, positions: Positions, ids: Mapping[str, int]) -> list[Json]:
    """Describe the thermal bridges of all zones."""
    return [
        written
        for zone, part in building.zones.items()
        for name, bridge in part.thermal_bridges.items()
        for written in _bridge(
            building, positions, (zone, name), bridge, below(ids, f"zones.{zone}.thermal_bridges.{name}")
        )
    ]


def _bridge(
    building: Description, positions: Positions, names: tuple[str, str], bridge: ThermalBridge, ids: Ids
) -> list[Json]:
    """Describe a bridge, and what its conversion to the dimensions of the areas adds to it."""
    zones = list(building.zones)
    to: Json = {"kind": bridge.faces}
    if bridge.zone is not None:
        to["zone"] = zones.index(bridge.zone)
    elif bridge.ground is not None:
        law = {"kind": "ground"} | fields_of(bridge.ground, ids, "ground.")
        to = {"kind": "imposed", "law": law}
    elif bridge.measured is not None:
        to["channel"] = positions[temperature_course(bridge.measured).name]
    factors = [("psi", "length") if bridge.psi is not None else ("chi", "number")]
    if bridge.converted is not None:
        factors.append(("converted", "number"))
    return [
        {
            "name": ".".join(names),
            "zone": zones.index(names[0]),
            "coefficient": ids(coefficient),
            "size": ids(size),
            "to": to,
        }
        for coefficient, size in factors
    ]
