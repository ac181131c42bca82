"""The building as it crosses the border into the engine.

The layout is that of ``crates/engine/src/input/description``: references are indices, every number is the id
of a leaf in ``parameters``.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from mascarin.building.convection import Convection, Power
from mascarin.building.glazing import (
    Angular,
    FilledGap,
    GivenGap,
    Glazing,
    Pane,
    SimpleGlazing,
    TwoFaces,
)
from mascarin.building.material import Material, PhaseChangeMaterial, Phases
from mascarin.building.mesh import choose
from mascarin.building.number import Interval, Number
from mascarin.building.part import Part
from mascarin.building.phase_change import (
    CapacityLaw,
    FractionsLaw,
    GumbelLaw,
    SmoothStepLaw,
    TableLaw,
    TanhLaw,
)
from mascarin.building.rules import face_names, references
from mascarin.building.site import Site
from mascarin.building.surface import Side, Surface
from mascarin.building.window import Vertices, Window, windows_of
from mascarin.building.zone import AirPath, GivenSun, Opening, Plant, Zone
from mascarin.building.zone_surfaces import closed, zone_faces
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from mascarin.building.building import Building
    from mascarin.building.surface import Construction

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
    nodes : mapping of (str, str) to int
        Finite volumes by construction and layer.
    """

    json: str
    paths: list[str]
    values: npt.NDArray[np.float64]
    channels: list[str]
    schedules: tuple[str, ...]
    notes: tuple[str, ...]
    nodes: Mapping[tuple[str, str], int]


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
        "materials": [
            *_each(building.materials, "materials", ids, _material),
            *(
                {"kind": "rated", "u_value": ids[f"windows.{name}.frame.u_value"]}
                for name in framed(building)
            ),
        ],
        "constructions": [
            *_each(
                building.constructions, "constructions", ids, partial(_construction, building, mesh.nodes)
            ),
            *_each(building.glazings, "glazings", ids, _glazing),
            *(
                _frame_construction(name, len(building.materials) + index)
                for index, name in enumerate(framed(building))
            ),
        ],
        "zones": _each(building.zones, "zones", ids, partial(_zone, building, places)),
        "air_paths": _each(building.air_paths, "air_paths", ids, partial(_air_path, building, places)),
        "openings": _each(building.openings, "openings", ids, partial(_opening, building, places)),
        "surfaces": [
            *_each(building.surfaces, "surfaces", ids, partial(_surface, building, columns, ids)),
            *_each(building.windows, "windows", ids, partial(_window, building, ids)),
            *(_frame(building, name, ids) for name in framed(building)),
        ],
        "sensors": _each(building.sensors, "sensors", ids, partial(_sensor, building)),
        "shades": [_corners(shade.vertices) for shade in building.shades.values()],
        "channels": columns,
    }
    return EngineDescription(
        json=json.dumps(description, allow_nan=False),
        paths=[leaf.path for leaf in leaves],
        values=np.array([leaf.value for leaf in leaves], dtype=np.float64),
        channels=columns,
        schedules=tuple(schedules),
        notes=mesh.warnings,
        nodes=mesh.nodes,
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


def _deeper(ids: Ids, path: str) -> Ids:
    """Ids below a path of the part that ``ids`` speaks of."""
    return lambda key: ids(f"{path}.{key}")


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
        "sun": _sun(building, name, zone, ids),
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


def _sun(building: Building, name: str, zone: Any, ids: Ids) -> Json:
    if not isinstance(zone.sun, GivenSun):
        return {"kind": "area" if zone.sun is None else zone.sun.kind}
    given = zone.sun.shares
    shares = [
        ids(f"sun.shares.{face.name}") if face.name in given and face.surface is not None else None
        for face in zone_faces(name, building.surfaces, building.windows)
    ]
    return {"kind": "shares", "faces": shares, "lost": ids("sun.lost")}


def view_weights(building: Building, zone: str) -> list[list[float]]:
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
    from mascarin.building.geometry import net_areas, view_factors

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


def _corners(vertices: Vertices | None) -> list[list[float]]:
    return [[float(coordinate) for coordinate in vertex] for vertex in vertices or ()]


def framed(building: Building) -> list[str]:
    """Windows with a frame, in the order of the description."""
    return [name for name, window in building.windows.items() if window.frame is not None]


def _glazing(name: str, glazing: Glazing, ids: Ids) -> Json:
    if isinstance(glazing, SimpleGlazing):
        keys = ("u_value", "solar_heat_gain", "panes", "category")
        films = [ids("outside_film"), ids("inside_film")]
        return {
            "name": name,
            "glazing": {"kind": "simple", **{key: ids(key) for key in keys}, "films": films},
        }
    panes = [_pane(pane, _deeper(ids, f"panes.{k}")) for k, pane in enumerate(glazing.panes)]
    gaps = [_gap(gap, _deeper(ids, f"gaps.{k}")) for k, gap in enumerate(glazing.gaps)]
    written: Json = {"kind": "panes", "panes": panes, "gaps": gaps}
    if glazing.angular is not None:
        written["angular"] = _angular(glazing.angular, ids)
    return {"name": name, "glazing": written}


def _both(value: Any, ids: Ids, key: str) -> list[int]:
    if isinstance(value, TwoFaces):
        return [ids(f"{key}.outside"), ids(f"{key}.inside")]
    return [ids(key)] * 2


def _pane(pane: Pane, ids: Ids) -> Json:
    written: Json = {
        "thickness": ids("thickness"),
        "conductivity": ids("conductivity"),
        "emissivity": _both(pane.emissivity, ids, "emissivity"),
    }
    if pane.density is not None:
        written["storage"] = [ids("density"), ids("specific_heat")]
    if pane.transmittance is not None:
        written["optics"] = {
            "transmittance": ids("transmittance"),
            "reflectance": _both(pane.reflectance, ids, "reflectance"),
            "coated": isinstance(pane.reflectance, TwoFaces),
        }
    return written


def _gap(gap: FilledGap | GivenGap, ids: Ids) -> Json:
    if isinstance(gap, GivenGap):
        return {"kind": "given", "conductance": ids("conductance")}
    return {
        "kind": "filled",
        "thickness": ids("thickness"),
        "pressure": ids("pressure"),
        "gas": gap.gas,
    }


def _angular(table: Angular, ids: Ids) -> Json:
    written: Json = {
        "angles": list(map(float, table.angles)),
        "transmittance": list(map(float, table.transmittance)),
        "absorptance": [list(map(float, pane)) for pane in table.absorptance],
        "transmittance_scale": ids("angular.transmittance_scale"),
        "absorptance_scale": ids("angular.absorptance_scale"),
    }
    if table.diffuse is not None:
        written["diffuse_transmittance"] = float(table.diffuse.transmittance)
        written["diffuse_absorptance"] = list(map(float, table.diffuse.absorptance))
    return written


def _window(building: Building, every: Mapping[str, int], name: str, window: Window, ids: Ids) -> Json:
    """Write the glass of a window as a surface of its own."""
    glass = building.glazings[window.glazing]
    path = f"glazings.{window.glazing}."
    if isinstance(glass, SimpleGlazing):
        emissivity = [every[f"{path}emissivity"]] * 2
    else:
        last = len(glass.panes) - 1
        outer = _both(glass.panes[0].emissivity, lambda key: every[f"{path}panes.0.{key}"], "emissivity")
        inner = _both(
            glass.panes[last].emissivity, lambda key: every[f"{path}panes.{last}.{key}"], "emissivity"
        )
        emissivity = [outer[0], inner[1]]
    written = _glazed(building, every, window, ids, emissivity) | {
        "name": name,
        "construction": len(building.constructions) + list(building.glazings).index(window.glazing),
        "cavity_height": ids("cavity_height"),
    }
    if window.frame is not None:
        written["frame"] = {"fraction": ids("frame.fraction"), "is_frame": False}
    return written


def _frame(building: Building, name: str, every: Mapping[str, int]) -> Json:
    """Write the frame of a window as a surface of its own."""
    ids = _below(every, f"windows.{name}")
    window = building.windows[name]
    written = _glazed(building, every, window, ids, [ids("frame.emissivity")] * 2)
    written["outside"]["absorptance"] = written["inside"]["absorptance"] = ids("frame.absorptance")
    return written | {
        "name": f"{name}.frame",
        "construction": len(building.constructions) + len(building.glazings) + framed(building).index(name),
        "frame": {"fraction": ids("frame.fraction"), "is_frame": True},
    }


def _frame_construction(name: str, material: int) -> Json:
    layer = {"name": "frame", "material": material, "thickness": None, "nodes": 0}
    return {"name": f"{name}.frame", "layers": [layer]}


def _glazed(
    building: Building, every: Mapping[str, int], window: Window, ids: Ids, emissivity: list[int]
) -> Json:
    """Write what glass and frame of a window have in common."""
    wall = building.surfaces[window.surface]
    direction = {key: every[f"surfaces.{window.surface}.{key}"] for key in ("tilt", "azimuth")}
    outside = _fields(window.outside, _deeper(ids, "outside")) | {
        "facing": {"kind": "outdoors"},
        "emissivity": emissivity[0],
        "convection": _convection(window.outside.convection, _deeper(ids, "outside")),
    }
    if window.outside.longwave is not None:
        outside["longwave"] = _fields(window.outside.longwave, _deeper(ids, "outside"), "longwave.")
    inside = {
        "facing": {"kind": "zone", "zone": list(building.zones).index(str(wall.inside.zone))},
        "emissivity": emissivity[1],
        "convection": _convection(window.inside.convection, _deeper(ids, "inside")),
    }
    shape = {"area": ids("area"), "vertices": _corners(window.vertices), **direction}
    return shape | {"outside": outside, "inside": inside}


def _surface(
    building: Building, columns: list[str], every: Mapping[str, int], name: str, surface: Surface, ids: Ids
) -> Json:
    zones = list(building.zones)
    return {
        "name": name,
        "construction": list(building.constructions).index(surface.construction),
        "area": ids("area"),
        "openings": [every[f"windows.{window}.area"] for window, _ in windows_of(name, building.windows)],
        "vertices": _corners(surface.vertices),
        "tilt": ids("tilt"),
        "azimuth": ids("azimuth"),
        "outside": _side(surface.outside, zones, columns, _deeper(ids, "outside")),
        "inside": _side(surface.inside, zones, columns, _deeper(ids, "inside")),
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
