"""Zones and the air between them as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.description import Description
from mascarin.building.engine_input.ids import Ids, Json, Places, fields_of
from mascarin.building.geometry import net_areas, view_factors
from mascarin.building.part import Part
from mascarin.building.rules import face_names
from mascarin.building.zone import AirPath, GivenSun, IdealLoads, Opening, Zone
from mascarin.building.zone_surfaces import closed, zone_faces
from mascarin.errors import InputError


def describe_zone(building: Description, places: Places, name: str, zone: Zone, ids: Ids) -> Json:
    """Describe a zone."""

    def each(section: str) -> list[Json]:
        parts: Mapping[str, Part] = getattr(zone, section)
        return [
            {"name": key, **fields_of(part, ids, f"{section}.{key}."), **_schedule(part, places)}
            for key, part in parts.items()
        ]

    plants = {which: _plant(plant, places, ids, which) for which, plant in zone.plants.items()}
    return {
        "name": name,
        "gains": each("gains"),
        "ventilation": each("ventilation"),
        **plants,
        "volume": ids("volume"),
        "capacity_factor": ids("capacity_factor"),
        "infiltration": fields_of(zone.infiltration, ids, "infiltration."),
        "longwave": fields_of(zone.longwave, ids, "longwave."),
        "view_weights": view_weights(building, name),
        "sun": _sun(building, name, zone, ids),
    }


def _schedule(part: Any, places: Places) -> Json:
    return {"schedule": None if part.schedule is None else places[part.schedule]}


def _plant(plant: IdealLoads, places: Places, ids: Ids, which: str) -> Json:
    given = plant.setpoint.schedule
    setpoint: Json = (
        {"kind": "constant", "temperature": ids(f"{which}.setpoint.temperature")}
        if given is None
        else {"kind": "scheduled", "channel": places[given]}
    )
    return {"setpoint": setpoint, **fields_of(plant, ids, f"{which}."), **_schedule(plant, places)}


def describe_air_path(building: Description, places: Places, name: str, path: AirPath, ids: Ids) -> Json:
    """Describe the air that two zones exchange."""
    between = [list(building.zones).index(zone) for zone in path.between]
    return {"name": name, "between": between, **fields_of(path, ids), **_schedule(path, places)}


def describe_opening(building: Description, places: Places, name: str, opening: Opening, ids: Ids) -> Json:
    """Describe an opening to outdoors."""
    zone = list(building.zones).index(opening.zone)
    return {"name": name, "zone": zone, **fields_of(opening, ids), **_schedule(opening, places)}


def _sun(building: Description, name: str, zone: Any, ids: Ids) -> Json:
    if not isinstance(zone.sun, GivenSun):
        return {"kind": "area" if zone.sun is None else zone.sun.kind}
    given = zone.sun.shares
    shares = [
        ids(f"sun.shares.{face.name}") if face.name in given and face.surface is not None else None
        for face in zone_faces(name, building.surfaces, building.windows)
    ]
    return {"kind": "shares", "faces": shares, "lost": ids("sun.lost")}


def view_weights(building: Description, zone: str) -> list[list[float]]:
    """Exchange areas A_i F_ij between the faces of a zone [m2]; empty where nothing tells them.

    Raises
    ------
    InputError
        If the vertices enclose no convex zone.
    """
    faces = zone_faces(zone, building.surfaces, building.windows)
    given = building.zones[zone].view_factors
    if given is not None:
        names = face_names(faces)
        areas = [face.area for face in faces]
        one_way = [
            [a * given[row].get(column, 0.0) for column in names] for a, row in zip(areas, names, strict=True)
        ]
        both_ways = zip(one_way, zip(*one_way, strict=True), strict=True)
        # Reciprocity: A_i F_ij = A_j F_ji, as far as the rounding of the given factors allows.
        return [[0.5 * (there + back) for there, back in zip(*pair, strict=True)] for pair in both_ways]
    if not closed(faces):
        return []
    # Glass and frame of a window share its polygon, and do not see each other.
    outlines = {face.name: face.polygon for face in faces if face.polygon is not None}
    polygons = list(outlines.values())

    try:
        weights = net_areas(polygons)[:, None] * view_factors(polygons)
    except InputError as error:
        raise InputError(f"zones.{zone}: {error}") from None
    places = [list(outlines).index(face.name) for face in faces]
    shares = [face.share for face in faces]
    return [
        [a * b * float(weights[i, j]) for j, b in zip(places, shares, strict=True)]
        for i, a in zip(places, shares, strict=True)
    ]
