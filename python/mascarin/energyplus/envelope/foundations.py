"""Floors and walls of basements on a foundation of Kiva as blocks of soil.

References
----------
Kruis N., Krarti M. (2015), Kiva: a numerical framework for improving foundation heat transfer calculations,
J. Building Performance Simulation 8(6), 449. https://doi.org/10.1080/19401493.2014.988753
EnergyPlus 25.2, Input Output Reference, Foundation:Kiva and Foundation:Kiva:Settings (defaults).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from mascarin.energyplus.envelope.glazings import construction_of
from mascarin.energyplus.envelope.idf_surfaces import IdfSurface
from mascarin.energyplus.envelope.materials import layers_of
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

#: The wall on the ground in a block: the thinnest that a block allows. Concrete conducts better than
#: soil: with 0.3 m of soil instead, a slab at 0 degC outdoors loses a fifth less than in EnergyPlus 25.2. [m]
_WALL: Final = 0.05
#: Height of the wall above the ground where the file names none. [m]
_ABOVE: Final = 0.2
#: Resistance from a slab through the wall above the ground: with the footing wall of EnergyPlus (0.3 m, 1.95
#: W/(m K)) 0.15 W/(m K) of each 0.2 m, by which heating in Chicago is that of EnergyPlus 25.2. [m2 K/W]
_FIN, _FOOTING = 1.18, 0.154
#: Depth of the ground water for each metre of altitude [-], and from where on no heat passes the bottom. [m]
_WATER, _NO_WATER = 0.1022, 40.0
#: Of soil below the slab, at least, and of a block. [m]
_BELOW, _LEAST_DEPTH = 1.0, 1.0
#: Kiva takes the wind at the height of the ground's roughness. Constant coefficients with which the loads of
#: a small room in Chicago are those of EnergyPlus 25.2, for the roughness of a file without settings and of
#: blank settings; between them by the logarithm. [m], [W/(m2 K)]
_FILMS: Final = ((0.9, 18.0), (0.03, 13.0))
#: Conductivity, density and specific heat of the soil [W/(m K)], [kg/m3], [J/(kg K)]: where the file has no
#: settings (EnergyPlus 25.2 has the same results with these values), and of blank fields of settings.
_SOIL, _BLANK_SOIL = (0.864, 1510.0, 1260.0), (1.73, 1842.0, 419.0)
#: Depth of a floor from which on it is that of a basement. [m]
_BASEMENT: Final = 0.1
#: Part of the edges of a floor from which on its walls make it that of a basement. [-]
_MOST: Final = 0.5
#: Sizes of a floor, and the extent of the soil, that a block allows. [m]
_SIZES: Final = (1.0, 500.0)
_FARTHEST: Final = 200.0
#: Of a material without mass that is insulation. [m]
_THIN: Final = 0.05
_EXTENTS: Final = (0.05, 10.0)
#: Difference of heights that is none. [m]
_LEVEL: Final = 1e-4


def foundation(context: Context, surface: IdfSurface, surfaces: Iterable[IdfSurface]) -> Section | None:
    """Enter a block of soil for a floor or a wall of a basement; the side that lies on it.

    Parameters
    ----------
    context : Context
        The conversion.
    surface : IdfSurface
        What touches the foundation.
    surfaces : iterable of IdfSurface
        All surfaces.

    Returns
    -------
    dict or None
        None for a foundation without a floor in the zone, or without a length of edges outdoors.
    """
    same = [other for other in surfaces if other.boundary == "foundation" and other.zone is surface.zone]
    floors = [other for other in same if other.shape == "floor"]
    walls = [
        other
        for other in same
        if other.shape == "wall" and other.beyond.casefold() == surface.beyond.casefold()
    ]
    if surface.shape not in ("floor", "wall") or not floors:
        return None
    floor = surface if surface.shape == "floor" else max(floors, key=lambda other: g.area_of(other.points))
    exposed = _exposed_perimeter(context, floor)
    if exposed is None:
        return None
    item = context.model.named(surface.beyond, "Foundation:Kiva")
    depth = _depth(context, item, surface, walls, exposed)
    block: Section = _soil(context, surface) | _structure(context, item, depth)
    if depth is None:
        block = _plan(floor, exposed) | block
        beside = sum(_length(wall) for wall in walls)
        _bridge(context, item, floor, exposed - beside)
    else:
        strip: Section = {"width": _strip(floor, exposed), "basement_depth": round(depth, 4)}
        contact = "floor" if surface.shape == "floor" else "walls"
        block = strip | {"contact": contact} | block
    if surface.shape == "wall" and block.get("edge", {}).get("position") == "horizontal":
        del block["edge"]
    block["depth"] = round(max(block["depth"], _least(context, item, floor, block)), 4)
    name = context.names.of("soil_blocks", surface.item.name)
    context.section("soil_blocks")[name] = block
    context.findings.approximated(surface.item, *_effect(depth))
    return {"soil": name}


def _effect(depth: float | None) -> tuple[str, str]:
    """What is different here, and its effect: of a slab, or of a basement of some depth."""
    if depth is None:
        return (
            "a foundation of Kiva",
            "a block of soil with a constant coefficient outdoors: 0.2 to 0.8 K in a small room in five "
            "climates, up to 5 % of its loads",
        )
    return (
        "a basement of Kiva",
        "a block of soil for each surface with a constant coefficient outdoors, without heat from the floor "
        "to the walls through the soil: 0.2 to 1.1 K in a small room in five climates, up to 9 % of its "
        "loads where they are more than 400 kWh; with walls of bare concrete 8 % of heating, 21 % of cooling",
    )


def above_grade(context: Context, surface: IdfSurface) -> tuple[IdfSurface, IdfSurface] | None:
    """The parts of a wall of a basement below and above the ground; None of a floor, or a wall without one.

    Parameters
    ----------
    context : Context
        The conversion.
    surface : IdfSurface
        What lies on a block of soil.
    """
    above = _above(context.model.named(surface.beyond, "Foundation:Kiva"))
    points = surface.points
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    edges = [np.abs(points[:, 2] - level) < _LEVEL for level in (low, high)]
    rectangle = len(points) == 4 and all(edge.sum() == 2 for edge in edges)
    if surface.shape != "wall" or above < _EXTENTS[0] or not rectangle or high - above <= low:
        return None
    parts = [points.copy(), points.copy()]
    for part, edge in zip(parts, edges[::-1], strict=True):
        part[edge, 2] = high - above
    below = replace(surface, points=parts[0])
    return below, replace(surface, points=parts[1], boundary="outdoors", sun=True, wind=True)


def insulated(context: Context, surface: IdfSurface, name: str) -> str:
    """The construction of a wall above the ground with the insulation outside of it, if there is any.

    Parameters
    ----------
    context : Context
        The conversion.
    surface : IdfSurface
        The wall.
    name : str
        Its construction in the description.
    """
    layer = _outside_insulation(context, context.model.named(surface.beyond, "Foundation:Kiva"))
    if layer is None:
        return name
    constructions = context.section("constructions")
    material = context.names.of("materials", f"{layer.name} outside of walls")
    context.section("materials")[material] = {
        "kind": "resistance",
        "resistance": round(_resistance(layer), 6),
    }
    outside = context.names.of("constructions", f"{name} and {layer.name}")
    constructions[outside] = {"layers": [{"material": material}, *constructions[name]["layers"]]}
    return outside


def _outside_insulation(context: Context, item: IdfObject | None) -> IdfObject | None:
    """Material of the insulation down along the wall."""
    key = "exterior_vertical_insulation_material_name"
    return None if item is None else context.model.named(item.text(key), "Material", "Material:NoMass")


def _above(item: IdfObject | None) -> float:
    """Height of the wall above the ground. [m]"""
    height = None if item is None else item.number("wall_height_above_grade")
    return _ABOVE if height is None else height


def _depth(
    context: Context, item: IdfObject | None, surface: IdfSurface, walls: list[IdfSurface], exposed: float
) -> float | None:
    """Depth of a floor below the ground, or that to which a wall stands; None of a slab. [m]"""
    sizes = []
    for wall in walls if surface.shape == "floor" else [surface]:
        length = _length(wall)
        sizes.append((length, max(g.area_of(wall.points) / length - _above(item), 0.0)))
    total = sum(length for length, _ in sizes)
    # Where most edges have no wall, EnergyPlus has most of the floor beside the open ground.
    if not sizes or total <= 0.0 or (surface.shape == "floor" and total < _MOST * exposed):
        return None
    depths = [depth for _, depth in sizes]
    if surface.shape == "floor" and (max(depths) - min(depths) > _BASEMENT or total < 0.99 * exposed):
        context.findings.approximated(
            surface.item, "walls of several depths around a floor", "their mean is its depth below the ground"
        )
    mean = sum(length * depth for length, depth in sizes)
    mean /= max(total, exposed) if surface.shape == "floor" else total
    return mean if mean >= _BASEMENT or surface.shape == "wall" else None


def _length(wall: IdfSurface) -> float:
    """Length of a wall, seen from above. [m]"""
    plan = wall.points[:, :2]
    return float(np.linalg.norm(plan[:, None] - plan[None, :], axis=-1).max())


def _bridge(context: Context, item: IdfObject | None, floor: IdfSurface, exposed: float) -> None:
    """Enter the wall above the ground as a bridge between the edges of a slab and the outdoor air."""
    above = _above(item)
    if above <= 0.0 or exposed <= 0.0:
        return
    resistance = _FIN + _FOOTING
    if item is not None:
        footing = context.model.named(item.text("footing_wall_construction_name"), "Construction")
        if footing is not None:
            resistance = _FIN + sum(_resistance(layer) for layer in layers_of(context, footing))
        layer = _outside_insulation(context, item)
        resistance += 0.0 if layer is None else _resistance(layer)
    zone = context.section("zones")[context.names.of("zones", floor.zone.name)]
    name = context.names.of("bridges of the zone", f"edge of {floor.item.name}")
    bridge = {"psi": round(above / resistance, 4), "length": round(exposed, 4)}
    zone.setdefault("thermal_bridges", {})[name] = bridge


def _least(context: Context, item: IdfObject | None, floor: IdfSurface, block: Section) -> float:
    """Least depth of a block, by the rule of EnergyPlus: 1 m below the wall and its insulation. [m]"""
    below = None if item is None else item.number("wall_depth_below_slab")
    slab = sum(
        layer.number("thickness") or 0.0 for layer in layers_of(context, construction_of(context, floor.item))
    )
    basement = float(block.get("basement_depth", -_above(item)))
    edge = block.get("edge", {})
    extent = float(edge["extent"]) if edge.get("position") == "vertical" else 0.0
    lowest = max(basement + slab + (below or 0.0), extent)
    return max(lowest + _BELOW, 1.3 * basement, _LEAST_DEPTH)


@reads("SurfaceProperty:ExposedFoundationPerimeter")
def _exposed_perimeter(context: Context, surface: IdfSurface) -> float | None:
    """Length of the edges of a floor along outdoor ground; None if the file does not say. [m]"""
    edges = np.linalg.norm(surface.points - np.roll(surface.points, -1, axis=0), axis=1)
    for item in context.model.of("SurfaceProperty:ExposedFoundationPerimeter"):
        if item.text("surface_name").casefold() != surface.item.name.casefold():
            continue
        method = item.word("exposed_perimeter_calculation_method")
        if method == "totalexposedperimeter":
            return item.number("total_exposed_perimeter") or 0.0
        if method == "exposedperimeterfraction":
            fraction = item.number("exposed_perimeter_fraction")
            return float(edges.sum()) * (1.0 if fraction is None else fraction)
        words = [item.word(f"surface_segment_{k + 1}_exposed") for k in range(len(edges))]
        rows = item.rows("surfaces") or []
        words = [str(row.get("surface_segment_exposed", "")).casefold() for row in rows] + words[len(rows) :]
        return float(sum(edge for edge, word in zip(edges, words, strict=False) if word != "no"))
    return None


def _plan(surface: IdfSurface, exposed: float) -> Section:
    """Length and width of a rectangle with all edges outdoors; else a strip of the same area and edges."""
    points = g.without_repeats(surface.points)
    sides = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(sides, axis=1)
    area = g.area_of(points)
    square = len(points) == 4 and abs(lengths[0] * lengths[1] - area) < 0.01 * area
    least, _ = _SIZES
    if square and abs(exposed - lengths.sum()) < 0.01 * lengths.sum() and min(lengths) >= least:
        return {"length": round(float(max(lengths[:2])), 4), "width": round(float(min(lengths[:2])), 4)}
    return {"width": _strip(surface, exposed)}


def _strip(surface: IdfSurface, exposed: float) -> float:
    """Width of a strip with the area and the edges of a floor: twice their ratio, as in Kiva. [m]"""
    return round(float(np.clip(2.0 * g.area_of(surface.points) / max(exposed, 1e-9), *_SIZES)), 4)


@reads("Foundation:Kiva:Settings")
def _soil(context: Context, surface: IdfSurface) -> Section:
    """Properties of the soil and of the ground outdoors, and what lies below."""
    item = context.model.one("Foundation:Kiva:Settings")

    def number(key: str, usual: float) -> float:
        value = None if item is None else item.number(key)
        return usual if value is None else value

    conductivity, density, specific_heat = _SOIL if item is None else _BLANK_SOIL
    (rough, high), (smooth, low) = _FILMS
    roughness = rough if item is None else max(number("ground_surface_roughness", smooth), 1e-3)
    film = low + (high - low) * math.log(roughness / smooth) / math.log(rough / smooth)
    capacity = number("soil_density", density) * number("soil_specific_heat", specific_heat)
    boundary = "" if item is None else item.word("deep_ground_boundary_condition")
    depth = None if item is None else item.number("deep_ground_depth")
    if boundary in ("", "autoselect"):
        water = _WATER * float(context.section("site").get("altitude", 0.0))
        boundary = "groundwater" if water <= _NO_WATER else "zeroflux"
        depth = min(water, _NO_WATER)
    soil: Section = {
        "conductivity": number("soil_conductivity", conductivity),
        "heat_capacity": round(capacity, 3),
        "absorptance": number("ground_solar_absorptivity", 0.9),
        "emissivity": number("ground_thermal_absorptivity", 0.9),
        "outdoor_film": round(film, 3),
        "far": min(number("far_field_width", 40.0), _FARTHEST),
        "depth": min(_NO_WATER if depth is None else depth, _FARTHEST),
    }
    if boundary == "groundwater" and context.yearly_air is not None:
        soil["deep_temperature"] = round(context.yearly_air, 3)
    elif boundary == "groundwater":
        context.findings.approximated(
            surface.item if item is None else item,
            "ground water at the yearly mean of the outdoor air",
            "no heat passes the bottom of the soil: give the weather file with --weather",
        )
    return soil


@reads("Foundation:Kiva")
def _structure(context: Context, item: IdfObject | None, basement: float | None) -> Section:
    """Thickness of the wall on the ground, and one insulation along its edge."""
    structure: Section = {"wall_thickness": _WALL}
    if item is None:
        return structure
    # Kiva's slab has its top at that of the wall, the block's at the ground: the depth below it counts.
    vertical = item.number("exterior_vertical_insulation_depth") or 0.0
    vertical -= _above(item) if basement is not None else 0.0
    horizontal = item.number("interior_horizontal_insulation_width") or 0.0
    for position, extent, key in (
        ("vertical", vertical, "exterior_vertical"),
        ("horizontal", horizontal, "interior_horizontal"),
    ):
        layer = context.model.named(
            item.text(f"{key}_insulation_material_name"), "Material", "Material:NoMass"
        )
        if layer is None or extent < _EXTENTS[0]:
            continue
        if "edge" in structure:
            context.findings.left_out(item, f"a second insulation, {position}", "more heat enters the ground")
            continue
        context.findings.approximated(
            item,
            f"{position} insulation of the edge",
            "0.4 to 0.7 K in a small room in five climates, up to 5 % of its loads"
            if position == "vertical"
            else "saves more here: 0.7 K in a small room in two climates, 15 to 20 % less heating",
        )
        structure["edge"] = {
            "position": position,
            "extent": round(min(extent, _EXTENTS[1]), 4),
            **_layer(layer),
        }
    if item.number("wall_depth_below_slab"):
        context.findings.approximated(item, "a wall below the slab", "soil in its place")
    unknown = ("interior_vertical_insulation", "exterior_horizontal_insulation", "footing", "custom_block_1")
    for key in unknown:
        if item.text(f"{key}_material_name"):
            context.findings.left_out(
                item, key.replace("_", " "), "the soil has its place: other heat at the edge of the floor"
            )
    return structure


def _resistance(layer: IdfObject) -> float:
    """Resistance of a layer of a wall or of insulation. [m2 K/W]"""
    if layer.kind == "Material":
        return layer.needed("thickness") / layer.needed("conductivity")
    return layer.number("thermal_resistance") or 0.0


def _layer(item: IdfObject) -> dict[str, float]:
    """Thickness [m] and conductivity [W/(m K)] of insulation."""
    if item.kind == "Material":
        return {"thickness": item.needed("thickness"), "conductivity": item.needed("conductivity")}
    return {"thickness": _THIN, "conductivity": round(_THIN / item.needed("thermal_resistance"), 6)}
