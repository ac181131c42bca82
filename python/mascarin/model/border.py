"""The building as it crosses the border into the engine.

The layout is that of ``crates/engine/src/description.rs``: references are indices, every number is the id
of a leaf in ``parameters``.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from mascarin.errors import InputError
from mascarin.model.convection import Convection, Power
from mascarin.model.envelope import Side, Surface
from mascarin.model.material import Material, PhaseChangeMaterial, Phases
from mascarin.model.melting import CapacityLaw, FractionsLaw, GumbelLaw, SmoothStepLaw, TableLaw, TanhLaw
from mascarin.model.mesh import choose
from mascarin.model.number import Interval, Number
from mascarin.model.part import Part
from mascarin.model.rules import face_names, references
from mascarin.model.settling import enclosure, faces_of
from mascarin.model.site import Site
from mascarin.model.zone import AirPath, Opening, Plant, Zone

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from mascarin.model.building import Building
    from mascarin.model.envelope import Construction

Json = dict[str, Any]
#: Position of the channel of each schedule.
Places = Mapping[str, int]
#: Id of the leaf at a path.
Ids = Callable[[str], int]


@dataclass(frozen=True)
class EngineDescription:
    """What the engine needs to know.

    Attributes
    ----------
    json : str
        The description.
    paths : list of str
        Path of each parameter, by id.
    values : ndarray, shape (P,)
        Nominal value of each parameter. [unit of each]
    channels : list of str
        What the forcing holds after the climate's channels: measured columns, then schedules.
    schedules : tuple of str
        Names of the schedules, which are the last of the channels.
    notes : tuple of str
        Warnings about the mesh.
    """

    json: str
    paths: list[str]
    values: npt.NDArray[np.float64]
    channels: list[str]
    schedules: tuple[str, ...]
    notes: tuple[str, ...]


def describe(building: Building, step_seconds: float, ranges: Mapping[str, Interval]) -> EngineDescription:
    """Describe a building to the engine; see :meth:`Building.to_engine`."""
    import numpy as np

    mesh = choose(building, step_seconds, ranges)
    leaves = [parameter for parameter in building.parameters() if not parameter.structural]
    ids = {leaf.path: index for index, leaf in enumerate(leaves)}
    columns = channels(building)
    schedules = used_schedules(building)
    places = {name: len(columns) + k for k, name in enumerate(schedules)}
    columns = [*columns, *(f"schedule {name}" for name in schedules)]
    description = {
        "parameters": [{"path": leaf.path, "value": leaf.value} for leaf in leaves],
        "site": _site(building.site, _below(ids, "site")),
        "materials": _each(building.materials, "materials", ids, _material),
        "constructions": _each(
            building.constructions, "constructions", ids, partial(_construction, building, mesh.nodes)
        ),
        "zones": _each(building.zones, "zones", ids, partial(_zone, building, places)),
        "air_paths": _each(building.air_paths, "air_paths", ids, partial(_air_path, building, places)),
        "openings": _each(building.openings, "openings", ids, partial(_opening, building, places)),
        "surfaces": _each(building.surfaces, "surfaces", ids, partial(_surface, building, columns)),
        "sensors": _each(building.sensors, "sensors", ids, partial(_sensor, building)),
        "channels": columns,
    }
    return EngineDescription(
        json=json.dumps(description, allow_nan=False),
        paths=[leaf.path for leaf in leaves],
        values=np.array([leaf.value for leaf in leaves], dtype=np.float64),
        channels=columns,
        schedules=tuple(schedules),
        notes=mesh.warnings,
    )


def channels(building: Building) -> list[str]:
    """Measured columns that a building refers to, in the order of the description."""
    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    columns = [column for side in sides for column in (side.measured, side.irradiance)]
    return list(dict.fromkeys(column for column in columns if column is not None))


def measured_columns(building: Building) -> list[str]:
    """Measured columns that a building needs, those of its schedules included."""
    scheduled = (building.schedules[name].column for name in used_schedules(building))
    return list(dict.fromkeys([*channels(building), *(column for column in scheduled if column is not None)]))


def used_schedules(building: Building) -> list[str]:
    """Names of the schedules that something in the building follows, in the order of the description."""
    used = {name for name, _, _ in references(building)}
    return [name for name in building.schedules if name in used]


def _below(ids: Mapping[str, int], path: str) -> Ids:
    """Ids of the leaves below a path."""
    return lambda key: ids[f"{path}.{key}"]


def _each(
    parts: Mapping[str, Any], section: str, ids: Mapping[str, int], write: Callable[..., Json]
) -> list[Json]:
    return [write(name, part, _below(ids, f"{section}.{name}")) for name, part in parts.items()]


def _fields(part: Any, ids: Ids, prefix: str = "") -> Json:
    """Write a part whose fields bear the names of the border: its kind and the ids of its numbers."""
    written = {"kind": part.kind} if hasattr(part, "kind") else {}
    for key in type(part).model_fields:
        number = getattr(part, key)
        if isinstance(number, Number) and not number.structural:
            written[key] = ids(f"{prefix}{key}")
    return written


def _site(site: Site, ids: Ids) -> Json:
    return {
        **_fields(site, ids),
        "wind": _fields(site.wind, ids, "wind."),
        "sky": _fields(site.sky, ids, "sky."),
        "cloud": [ids("cloud.c1"), ids("cloud.c2"), ids("cloud.c3")],
        "diffuse": site.diffuse,
    }


def _material(_: str, material: Material, ids: Ids) -> Json:
    if not isinstance(material, PhaseChangeMaterial):
        return _fields(material, ids)
    properties = {
        key: [ids(f"{key}.solid"), ids(f"{key}.liquid")]
        if isinstance(getattr(material, key), Phases)
        else [ids(key)] * 2
        for key in ("conductivity", "density", "specific_heat")
    }
    return {"kind": "pcm", **properties, "law": _law(material, ids)}


def _law(material: PhaseChangeMaterial, ids: Ids) -> Json:
    law = material.law
    if isinstance(law, TableLaw | CapacityLaw):
        points = (
            {"enthalpies": list(map(float, law.enthalpies))}
            if isinstance(law, TableLaw)
            else {"capacities": list(map(float, law.capacities))}
        )
        return _fields(law, ids, "law.") | {
            "kind": "tabulated",
            "temperatures": list(map(float, law.temperatures)),
            "points": points,
            "melting_range": list(law.melting),
        }
    latent_heat = ids("latent_heat")
    heating = _melting_curve(law, ids, "law.", "melting_temperature")
    hysteresis = material.hysteresis
    if hysteresis is None:
        return {"kind": "melting", "latent_heat": latent_heat, "curve": heating}
    shape, prefix = (law, "law.") if hysteresis.law is None else (hysteresis.law, "hysteresis.law.")
    return {
        "kind": "hysteresis",
        "latent_heat": latent_heat,
        "model": hysteresis.model,
        "heating": heating,
        "cooling": _melting_curve(shape, ids, prefix, "hysteresis.freezing_temperature"),
    }


def _melting_curve(law: Part, ids: Ids, prefix: str, centre: str) -> Json:
    written = _fields(law, ids, prefix)
    if isinstance(law, FractionsLaw):
        temperatures, fractions = (list(map(float, column)) for column in (law.temperatures, law.fractions))
        return written | {"temperatures": temperatures, "fractions": fractions}
    written |= {"melting_temperature": ids(centre)}
    if isinstance(law, TanhLaw):
        written["kind"] = "tanh_width" if law.width is not None else "tanh_gamma"
    elif isinstance(law, SmoothStepLaw):
        written["continuity"] = int(law.continuity)
    elif isinstance(law, GumbelLaw):
        written["tail"] = law.tail
    return written


def _construction(
    building: Building, nodes: Mapping[tuple[str, str], int], name: str, construction: Construction, ids: Ids
) -> Json:
    materials = list(building.materials)
    layers = []
    for layer in construction.layers:
        thickness = None if layer.thickness is None else ids(f"layers.{layer.name}.thickness")
        material = materials.index(layer.material)
        layers.append(
            {
                "name": layer.name,
                "material": material,
                "thickness": thickness,
                "nodes": nodes[name, layer.name],
            }
        )
    return {"name": name, "layers": layers}


def _zone(building: Building, places: Places, name: str, zone: Zone, ids: Ids) -> Json:
    def each(section: str) -> list[Json]:
        parts: Mapping[str, Part] = getattr(zone, section)
        return [
            {"name": key, **_fields(part, ids, f"{section}.{key}."), **_schedule(part, places)}
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
        "infiltration": _fields(zone.infiltration, ids, "infiltration."),
        "longwave": _fields(zone.longwave, ids, "longwave."),
        "view_weights": view_weights(building, name),
    }


def _schedule(part: Any, places: Places) -> Json:
    return {"schedule": None if part.schedule is None else places[part.schedule]}


def _plant(plant: Plant, places: Places, ids: Ids, which: str) -> Json:
    given = plant.setpoint.schedule
    setpoint: Json = (
        {"kind": "constant", "temperature": ids(f"{which}.setpoint.temperature")}
        if given is None
        else {"kind": "scheduled", "channel": places[given]}
    )
    return {"setpoint": setpoint, **_fields(plant, ids, f"{which}."), **_schedule(plant, places)}


def _air_path(building: Building, places: Places, name: str, path: AirPath, ids: Ids) -> Json:
    between = [list(building.zones).index(zone) for zone in path.between]
    return {"name": name, "between": between, **_fields(path, ids), **_schedule(path, places)}


def _opening(building: Building, places: Places, name: str, opening: Opening, ids: Ids) -> Json:
    zone = list(building.zones).index(opening.zone)
    return {"name": name, "zone": zone, **_fields(opening, ids), **_schedule(opening, places)}


def view_weights(building: Building, zone: str) -> list[list[float]]:
    """Exchange areas A_i F_ij between the faces of a zone [m2]; empty where nothing tells them.

    Raises
    ------
    InputError
        If the vertices enclose no convex zone.
    """
    faces = faces_of(zone, building.surfaces)
    given = building.zones[zone].view_factors
    if given is not None:
        names = face_names(faces)
        areas = [float(building.surfaces[surface].area or 0.0) for surface, _ in faces]
        one_way = [
            [a * given[row].get(column, 0.0) for column in names] for a, row in zip(areas, names, strict=True)
        ]
        both_ways = zip(one_way, zip(*one_way, strict=True), strict=True)
        # Reciprocity: A_i F_ij = A_j F_ji, as far as the rounding of the given factors allows.
        return [[0.5 * (there + back) for there, back in zip(*pair, strict=True)] for pair in both_ways]
    polygons = enclosure(zone, building.surfaces)
    if polygons is None:
        return []
    from mascarin.model.geometry import net_areas, view_factors

    try:
        weights: list[list[float]] = (net_areas(polygons)[:, None] * view_factors(polygons)).tolist()
    except InputError as error:
        raise InputError(f"zones.{zone}: {error}") from None
    return weights


def _surface(building: Building, columns: list[str], name: str, surface: Surface, ids: Ids) -> Json:
    zones = list(building.zones)
    return {
        "name": name,
        "construction": list(building.constructions).index(surface.construction),
        "area": ids("area"),
        "tilt": ids("tilt"),
        "azimuth": ids("azimuth"),
        "outside": _side(surface.outside, zones, columns, lambda key: ids(f"outside.{key}")),
        "inside": _side(surface.inside, zones, columns, lambda key: ids(f"inside.{key}")),
    }


def _side(side: Side, zones: list[str], columns: list[str], ids: Ids) -> Json:
    written = _fields(side, ids) | {"facing": _facing(side, zones, columns, ids)}
    if side.convection is not None:
        written["convection"] = _convection(side.convection, ids)
    if side.longwave is not None:
        written["longwave"] = _fields(side.longwave, ids, "longwave.")
    if side.irradiance is not None:
        written["irradiance"] = columns.index(side.irradiance)
    if side.exposure is not None:
        written["exposure"] = side.exposure.model_dump()
    return written


def _facing(side: Side, zones: list[str], columns: list[str], ids: Ids) -> Json:
    if side.zone is not None:
        return {"kind": "zone", "zone": zones.index(side.zone)}
    if side.measured is not None:
        return {"kind": "measured", "channel": columns.index(side.measured)}
    if side.ground is not None:
        return {"kind": "ground"} | _fields(side.ground, ids, "ground.")
    return {"kind": side.faces}


def _convection(convection: Convection, ids: Ids) -> Json:
    if isinstance(convection, Power):
        return {
            "kind": "power",
            "upward": _fields(convection.upward, ids, "convection.upward."),
            "downward": _fields(convection.downward, ids, "convection.downward."),
        }
    return _fields(convection, ids, "convection.")


def _sensor(building: Building, name: str, sensor: Any, ids: Ids) -> Json:
    return {"name": name, "surface": list(building.surfaces).index(sensor.surface), "depth": ids("depth")}
