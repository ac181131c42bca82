"""Surfaces, their two sides and the sensors in them as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.base.time_series import temperature_course
from mascarin.building.engine_input.air import driven
from mascarin.building.engine_input.ids import Ids, Json, Positions, corners, deeper, fields_of
from mascarin.building.parts.air.schedule import schedule_channel
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.convection import Convection, Measured
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.building.parts.envelope.surface import Side, Surface
from mascarin.building.soil.courses import behind_of, heat_of, soil_of


def describe_surface(
    building: Description,
    channels: tuple[list[str], Positions],
    all_ids: Mapping[str, int],
    name: str,
    surface: Surface,
    ids: Ids,
) -> Json:
    """Describe a surface with its two sides."""
    zones = list(building.zones)
    return {
        **_soil(building, name, channels[1]),
        "name": name,
        "construction": list(building.constructions).index(surface.construction),
        "area": ids("area"),
        "openings": [all_ids[f"windows.{window}.area"] for window in building.connections.windows_in(name)],
        "vertices": corners(surface.vertices),
        "tilt": ids("tilt"),
        "azimuth": ids("azimuth"),
        "outside": _side(surface.outside, zones, channels, deeper(ids, "outside")),
        "inside": _side(surface.inside, zones, channels, deeper(ids, "inside")),
    }


def _soil(building: Description, name: str, positions: Positions) -> Json:
    """Soil behind a surface, from the outermost cell to the construction; nothing where there is none."""
    soil = soil_of(building, name)
    if soil is None:
        return {}
    resistances, capacities = soil.ladder.without_last
    return {
        "soil": {
            "capacities": capacities[::-1],
            "resistances": resistances[::-1],
            "heat": [positions[heat_of(soil.block, cell)] for cell in (0, 1)],
        }
    }


def _side(side: Side, zones: list[str], channels: tuple[list[str], Positions], ids: Ids) -> Json:
    columns, positions = channels
    written = fields_of(side, ids) | {"facing": _facing(side, zones, columns, positions, ids)}
    if side.heat_flux is not None:
        written["facing"] = {"kind": "adiabatic"}
        written["heat_flux"] = driven(side.heat_flux, "flux", positions, deeper(ids, "heat_flux"))
    if side.convection is not None:
        written["convection"] = describe_convection(side.convection, columns, ids)
    if side.longwave is not None:
        written["longwave"] = fields_of(side.longwave, ids, "longwave.")
    if side.irradiance is not None:
        written["irradiance"] = columns.index(side.irradiance)
        written["behind_obstacles"] = bool(side.behind_obstacles)
    if side.exposure is not None:
        written["exposure"] = side.exposure.model_dump()
    return written


def _facing(side: Side, zones: list[str], columns: list[str], positions: Positions, ids: Ids) -> Json:
    if side.zone is not None:
        return {"kind": "zone", "zone": zones.index(side.zone)}
    if isinstance(side.measured, tuple):
        return {"kind": "measured", "channel": positions[temperature_course(side.measured).name]}
    if side.measured is not None:
        return {"kind": "measured", "channel": columns.index(side.measured)}
    if side.scheduled is not None:
        return {"kind": "measured", "channel": columns.index(schedule_channel(side.scheduled))}
    if side.soil is not None:
        return {"kind": "measured", "channel": positions[behind_of(side.soil)]}
    if side.ground is not None:
        return {"kind": "imposed", "law": {"kind": "ground"} | fields_of(side.ground, ids, "ground.")}
    if side.imposed is not None:
        return {"kind": "imposed", "law": fields_of(side.imposed, ids, "imposed.")}
    return {"kind": side.faces}


def describe_convection(convection: Convection, columns: list[str], ids: Ids) -> Json:
    """Describe a surface heat transfer coefficient."""
    if isinstance(convection, Measured):
        return {
            "kind": "measured",
            "channel": columns.index(convection.column),
            "factor": ids("convection.factor"),
        }
    if isinstance(convection, FormulaLaw):
        numbers = [{"name": name, "value": ids(f"convection.{name}")} for name in convection.numbers]
        law = {"formula": convection.formula, "valid": convection.valid, "numbers": numbers}
        return {"kind": "formula", **law}
    if not convection.row.by_direction:
        return fields_of(convection, ids, "convection.")
    groups = ("upward", "downward")
    parts = {way: fields_of(getattr(convection, way), ids, f"convection.{way}.") for way in groups}
    return {"kind": convection.kind, **parts}


def describe_sensor(building: Description, name: str, sensor: Any, ids: Ids) -> Json:
    """Describe a sensor inside a surface."""
    return {"name": name, "surface": list(building.surfaces).index(sensor.surface), "depth": ids("depth")}
