"""Zones as the engine reads them."""

from __future__ import annotations

from typing import Any

from mascarin.building.engine_input.air import control_of, density_of, driven, schedule_of, set_point
from mascarin.building.engine_input.ids import Ids, Json, Positions, deeper, fields_of
from mascarin.building.geometry import closed_exchange_areas
from mascarin.building.parts.air.zone import (
    FloorSun,
    GivenSun,
    IdealLoads,
    Infiltration,
    SunShares,
    TextInfiltration,
    TracedSun,
    Zone,
)
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.surface import NoLongwave
from mascarin.building.parts.levels import levels
from mascarin.building.parts.materials.text_law import numbers_of
from mascarin.building.parts.zone_surfaces import ZoneSurface, closed, floors, surface_names
from mascarin.errors import InputError


def describe_zone(building: Description, positions: Positions, name: str, zone: Zone, ids: Ids) -> Json:
    """Describe a zone."""
    gains = [
        {
            "name": key,
            **driven(part, "power", positions, deeper(ids, f"gains.{key}")),
            "radiative": ids(f"gains.{key}.radiative"),
            **({} if part.activity is None else {"activity": ids(f"gains.{key}.activity")}),
        }
        for key, part in zone.gains.items()
    ]
    ventilation = [
        {
            "name": key,
            **fields_of(part, ids, f"ventilation.{key}."),
            **schedule_of(part, positions),
            **density_of(part, ids, f"ventilation.{key}."),
            **(control_of(building, part) if part.control is not None else {}),
        }
        for key, part in zone.ventilation.items()
    ]
    loads = {which: _ideal_loads(loads, positions, ids, which) for which, loads in zone.loads.items()}
    return {
        "name": name,
        "gains": gains,
        "ventilation": ventilation,
        **_mixing(zone, positions, ids),
        **_stratification(building, name, positions, ids),
        **loads,
        "volume": ids("volume"),
        "capacity_factor": ids("capacity_factor"),
        "infiltration": _infiltration(building, positions, zone.infiltration, deeper(ids, "infiltration")),
        "solar_to_air": None if zone.solar_to_air is None else ids("solar_to_air"),
        "setpoint_radiant_share": None
        if zone.setpoint_radiant_share is None
        else ids("setpoint_radiant_share"),
        "makeup_by_vents": zone.makeup_air == "vents",
        "longwave": fields_of(zone.longwave, ids, "longwave."),
        "view_weights": view_weights(building, name),
        "sun": _sun(building, name, zone, ids),
    }


def _mixing(zone: Zone, positions: Positions, ids: Ids) -> Json:
    if zone.mixing_air_change is None:
        return {}
    written = driven(zone.mixing_air_change, "air_changes", positions, deeper(ids, "mixing_air_change"))
    return {"mixing": written}


def _stratification(building: Description, name: str, positions: Positions, ids: Ids) -> Json:
    air = building.zones[name].air_gradient
    if air is None:
        return {}
    written = driven(air, "gradient", positions, deeper(ids, "air_gradient"))
    return {"stratification": written | {"height": levels(building, name)[1]}}


def _infiltration(building: Description, positions: Positions, part: Infiltration, ids: Ids) -> Json:
    written = {**fields_of(part, ids), **density_of(part, ids)}
    if part.schedule is not None:
        written |= schedule_of(part, positions)
    if part.control is not None:
        written |= control_of(building, part)
    if part.blower_door is not None:
        written["leakage"] = fields_of(part.blower_door, ids, "blower_door.")
    if isinstance(part, TextInfiltration):
        written.pop("kind")
        written["law"] = numbers_of(part, ids, "")
    return written


def _ideal_loads(loads: IdealLoads, positions: Positions, ids: Ids, which: str) -> Json:
    return {
        "setpoint": set_point(loads.setpoint, positions, deeper(ids, f"{which}.setpoint")),
        **fields_of(loads, ids, f"{which}."),
        **schedule_of(loads, positions),
    }


def _sun(building: Description, name: str, zone: Any, ids: Ids) -> Json:
    surfaces = building.connections.of(name)
    if all(item.window is None for item in surfaces):
        return {"kind": "area"}  # no sun enters
    if isinstance(zone.sun, FloorSun):
        return {"kind": "floor", "floor": floors(surfaces)}
    if not isinstance(zone.sun, GivenSun):
        return {"kind": "area" if zone.sun is None else zone.sun.kind}

    def share(item: ZoneSurface, part: GivenSun | SunShares, path: str) -> int | None:
        if item.name in part.masses:
            return ids(f"{path}.masses.{item.name}.{item.side}")
        return ids(f"{path}.shares.{item.name}") if item.name in part.shares else None

    def shares(part: GivenSun | SunShares, path: str) -> Json:
        faces = [None if item.surface is None else share(item, part, path) for item in surfaces]
        return {"faces": faces, "lost": ids(f"{path}.lost")}

    written: Json = {"kind": "shares", **shares(zone.sun, "sun")}
    if zone.sun.diffuse is not None:
        written["diffuse"] = shares(zone.sun.diffuse, "sun.diffuse")
    return written


def view_weights(building: Description, zone: str) -> list[list[float]]:
    """Exchange areas A_i F_ij between the surfaces of a zone [m2]; empty where they are approximated.

    Raises
    ------
    InputError
        If the vertices do not enclose a convex zone.
    """
    surfaces = building.connections.of(zone)
    factors = building.zones[zone].view_factors
    if factors is not None:
        names = surface_names(surfaces)
        areas = [item.area for item in surfaces]
        one_way = [
            [a * factors[row].get(column, 0.0) for column in names]
            for a, row in zip(areas, names, strict=True)
        ]
        both_ways = zip(one_way, zip(*one_way, strict=True), strict=True)
        # Reciprocity: A_i F_ij = A_j F_ji, as far as the rounding of the given factors allows.
        return [[0.5 * (forth + back) for forth, back in zip(*pair, strict=True)] for pair in both_ways]
    definition = building.zones[zone]
    if isinstance(definition.longwave, NoLongwave) and not isinstance(definition.sun, TracedSun):
        return []  # nothing is exchanged by view factors
    if not closed(surfaces):
        return []
    # Glass and frame of a window are in one polygon and do not exchange radiation.
    outlines = {item.name: item.polygon for item in surfaces if item.polygon is not None}
    polygons = list(outlines.values())

    try:
        weights = closed_exchange_areas(polygons)
    except InputError as error:
        raise InputError(f"zones.{zone}: {error}") from None
    index_of = {name: index for index, name in enumerate(outlines)}
    indices = [index_of[item.name] for item in surfaces]
    shares = [item.share for item in surfaces]
    return [
        [a * b * float(weights[i, j]) for j, b in zip(indices, shares, strict=True)]
        for i, a in zip(indices, shares, strict=True)
    ]
