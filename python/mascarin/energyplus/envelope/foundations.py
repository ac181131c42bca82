"""Floors on a foundation of Kiva as blocks of soil.

References
----------
Kruis N., Krarti M. (2015), Kiva: a numerical framework for improving foundation heat transfer calculations,
J. Building Performance Simulation 8(6), 449. https://doi.org/10.1080/19401493.2014.988753
EnergyPlus 25.2, Input Output Reference, Foundation:Kiva and Foundation:Kiva:Settings (defaults).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from mascarin.energyplus.envelope.idf_surfaces import IdfSurface
from mascarin.energyplus.envelope.materials import layers_of
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

#: Footing wall of EnergyPlus where the file names none: poured concrete. [m]
_WALL: Final = 0.3
#: Depth of the ground water for each metre of altitude [-], and from where on no heat passes the bottom. [m]
_WATER, _NO_WATER = 0.1022, 40.0
#: The least depth of ground water. EnergyPlus keeps it below the footing; with 2 m, Tampa (0.3 m by altitude)
#: and San Francisco (0.2 m) have its results: 0.2 K in a small room. [m]
_LEAST_DEPTH: Final = 2.0
#: Kiva takes the wind at the height of the ground's roughness, and a ground of great roughness. A constant
#: coefficient with which the loads of a small room in Chicago are those of EnergyPlus 25.2. [W/(m2 K)]
_FILM: Final = 20.0
#: Sizes of a floor, and the extent of the soil, that a block allows. [m]
_SIZES: Final = (1.0, 500.0)
_FARTHEST: Final = 200.0
#: Of a material without mass that is insulation. [m]
_THIN: Final = 0.05
_EXTENTS: Final = (0.05, 10.0)


def foundation(context: Context, surface: IdfSurface, surfaces: Iterable[IdfSurface]) -> Section | None:
    """Enter a block of soil below a floor; the side that lies on it, or None where it is none.

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
        None for walls on a foundation and the floors between them: EnergyPlus solves them together, each with
        its own construction, where a block lumps them.
    """
    basement = any(
        other.boundary == "foundation" and other.shape != "floor" and other.zone is surface.zone
        for other in surfaces
    )
    if basement or surface.shape != "floor":
        return None
    exposed = _exposed_perimeter(context, surface)
    if exposed is None:
        return None
    item = context.model.named(surface.beyond, "Foundation:Kiva")
    block = _plan(surface, exposed) | _soil(context, surface)
    block |= _structure(context, item)
    # As deep as the block needs below its insulation.
    lowest = block["edge"]["extent"] if block.get("edge", {}).get("position") == "vertical" else 0.0
    block["depth"] = round(max(block["depth"], 1.3 * lowest), 4)
    name = context.names.of("soil_blocks", surface.item.name)
    context.section("soil_blocks")[name] = block
    context.findings.approximated(
        surface.item,
        "a foundation of Kiva",
        f"a block of soil with a constant coefficient outdoors of {_FILM:g} W/(m2 K): 0.2 to 1.1 K in a "
        "small room in five climates, up to 24 % of its heating and 5 % of its cooling",
    )
    return {"soil": name}


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
    least, most = _SIZES
    if square and abs(exposed - lengths.sum()) < 0.01 * lengths.sum() and min(lengths) >= least:
        return {"length": round(float(max(lengths[:2])), 4), "width": round(float(min(lengths[:2])), 4)}
    return {"width": round(float(np.clip(2.0 * area / max(exposed, 1e-9), least, most)), 4)}


@reads("Foundation:Kiva:Settings")
def _soil(context: Context, surface: IdfSurface) -> Section:
    """Properties of the soil and of the ground outdoors, and what lies below."""
    item = context.model.one("Foundation:Kiva:Settings")

    def number(key: str, usual: float) -> float:
        value = None if item is None else item.number(key)
        return usual if value is None else value

    capacity = number("soil_density", 1842.0) * number("soil_specific_heat", 419.0)
    boundary = "" if item is None else item.word("deep_ground_boundary_condition")
    depth = None if item is None else item.number("deep_ground_depth")
    if boundary in ("", "autoselect"):
        water = _WATER * float(context.section("site").get("altitude", 0.0))
        boundary = "groundwater" if water <= _NO_WATER else "zeroflux"
        depth = min(water, _NO_WATER)
    soil: Section = {
        "conductivity": number("soil_conductivity", 1.73),
        "heat_capacity": round(capacity, 3),
        "absorptance": number("ground_solar_absorptivity", 0.9),
        "emissivity": number("ground_thermal_absorptivity", 0.9),
        "outdoor_film": _FILM,
        "far": min(number("far_field_width", 40.0), _FARTHEST),
        "depth": min(max(_NO_WATER if depth is None else depth, _LEAST_DEPTH), _FARTHEST),
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
def _structure(context: Context, item: IdfObject | None) -> Section:
    """Thickness of the wall on the ground, and one insulation along its edge."""
    if item is None:
        return {"wall_thickness": _WALL}
    footing = context.model.named(item.text("footing_wall_construction_name"), "Construction")
    wall = _WALL
    if footing is not None:
        wall = sum(layer.number("thickness") or 0.0 for layer in layers_of(context, footing)) or _WALL
    structure: Section = {"wall_thickness": round(float(np.clip(wall, 0.05, 2.0)), 4)}
    # Kiva's slab has its top at that of the wall, the block's at the ground: the depth below it counts.
    vertical = item.number("exterior_vertical_insulation_depth") or 0.0
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
            "saves less here: a small room is 1.2 to 1.4 K colder, with 22 to 53 % more heating and up to "
            "28 % less cooling in five climates",
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


def _layer(item: IdfObject) -> dict[str, float]:
    """Thickness [m] and conductivity [W/(m K)] of insulation."""
    if item.kind == "Material":
        return {"thickness": item.needed("thickness"), "conductivity": item.needed("conductivity")}
    return {"thickness": _THIN, "conductivity": round(_THIN / item.needed("thermal_resistance"), 6)}
