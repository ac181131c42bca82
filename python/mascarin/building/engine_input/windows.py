"""Glazings, windows and frames as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.building.engine_input.air import schedule_of
from mascarin.building.engine_input.ids import Ids, Json, Positions, below, corners, deeper, fields_of
from mascarin.building.engine_input.surfaces import describe_convection
from mascarin.building.parts.description import Description
from mascarin.building.parts.openings.glazing import (
    Angular,
    FilledGap,
    GivenGap,
    Glazing,
    Pane,
    SimpleGlazing,
    TwoSides,
)
from mascarin.building.parts.openings.window import Window
from mascarin.building.parts.window_shades import window_shades


def framed(building: Description) -> list[str]:
    """Names of the windows with a frame, in the order of the description."""
    return [name for name, window in building.windows.items() if window.frame is not None]


def describe_glazing(name: str, glazing: Glazing, ids: Ids) -> Json:
    """Describe a glazing as a construction."""
    if isinstance(glazing, SimpleGlazing):
        keys = ("u_value", "solar_heat_gain", "panes", "category")
        rated: Json = {"kind": "simple", **{key: ids(key) for key in keys}}
        rated["films"] = [ids("outside_film"), ids("inside_film")]
        if glazing.transmittance is not None:
            rated["transmittance"] = ids("transmittance")
        return {"name": name, "glazing": rated}
    panes = [_pane(pane, deeper(ids, f"panes.{k}")) for k, pane in enumerate(glazing.panes)]
    gaps = [_gap(gap, deeper(ids, f"gaps.{k}")) for k, gap in enumerate(glazing.gaps)]
    written: Json = {"kind": "panes", "panes": panes, "gaps": gaps}
    if glazing.angular is not None:
        written["angular"] = _angular(glazing.angular, ids)
    return {"name": name, "glazing": written}


def both_sides(value: Any, ids: Ids, key: str) -> list[int]:
    """Ids of a property of the outside and of the inside of a pane."""
    if isinstance(value, TwoSides):
        return [ids(f"{key}.outside"), ids(f"{key}.inside")]
    return [ids(key)] * 2


def _pane(pane: Pane, ids: Ids) -> Json:
    written: Json = {
        "thickness": ids("thickness"),
        "conductivity": ids("conductivity"),
        "emissivity": both_sides(pane.emissivity, ids, "emissivity"),
    }
    if pane.density is not None:
        written["storage"] = [ids("density"), ids("specific_heat")]
    if pane.transmittance is not None:
        written["optics"] = {
            "transmittance": ids("transmittance"),
            "reflectance": both_sides(pane.reflectance, ids, "reflectance"),
            "coated": isinstance(pane.reflectance, TwoSides),
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
    for key, optics in (("diffuse", table.diffuse), ("back", table.back)):
        if optics is not None:
            written[f"{key}_transmittance"] = float(optics.transmittance)
            written[f"{key}_absorptance"] = list(map(float, optics.absorptance))
    return written


def describe_window(
    building: Description, columns: list[str], all_ids: Mapping[str, int], name: str, window: Window, ids: Ids
) -> Json:
    """Describe the glass of a window as a surface."""
    glass = building.glazings[window.glazing]
    path = f"glazings.{window.glazing}."
    if isinstance(glass, SimpleGlazing):
        emissivity = [all_ids[f"{path}emissivity"]] * 2
    else:
        last = len(glass.panes) - 1
        outer = both_sides(
            glass.panes[0].emissivity, lambda key: all_ids[f"{path}panes.0.{key}"], "emissivity"
        )
        inner = both_sides(
            glass.panes[last].emissivity, lambda key: all_ids[f"{path}panes.{last}.{key}"], "emissivity"
        )
        emissivity = [outer[0], inner[1]]
    if window.blind is not None:
        emissivity[0 if window.blind.position == "outside" else 1] = ids("blind.emissivity")
    written = _glazed(building, columns, all_ids, name, ids, emissivity) | {
        "name": name,
        "construction": _construction_of(building, name, window),
        "cavity_height": ids("cavity_height"),
    }
    if window.frame is not None:
        written["frame"] = {"fraction": ids("frame.fraction"), "is_frame": False}
    return written


def _construction_of(building: Description, name: str, window: Window) -> int:
    """Place of the construction of a window's glass; those with a blind follow all others."""
    first = len(building.constructions)
    if window.blind is None:
        return first + list(building.glazings).index(window.glazing)
    return first + len(building.glazings) + len(framed(building)) + shaded(building).index(name)


def shaded(building: Description) -> list[str]:
    """Names of the windows with a blind, in the order of the description."""
    return [name for name, window in building.windows.items() if window.blind is not None]


def describe_blinded_glazing(
    building: Description, positions: Positions, all_ids: Mapping[str, int], name: str
) -> Json:
    """Describe the glazing of a window with its blind as a construction."""
    window, ids = building.windows[name], below(all_ids, f"windows.{name}.blind")
    written = describe_glazing(
        f"{name}.glass", building.glazings[window.glazing], below(all_ids, f"glazings.{window.glazing}")
    )
    blind: Json = {"inside": window.blind is not None and window.blind.position == "inside"}
    blind |= {key: ids(key) for key in ("transmittance", "reflectance", "resistance", "cover")}
    blind |= schedule_of(window.blind, positions)
    if window.blind is not None:
        optional = {"radiation": window.blind.radiation, "to_air": window.blind.to_air}
        blind |= {key: ids(key) for key, number in optional.items() if number is not None}
    return written | {"blind": blind}


def describe_frame(building: Description, columns: list[str], name: str, all_ids: Mapping[str, int]) -> Json:
    """Describe the frame of a window as a surface."""
    ids = below(all_ids, f"windows.{name}")
    written = _glazed(building, columns, all_ids, name, ids, [ids("frame.emissivity")] * 2)
    written["outside"]["absorptance"] = written["inside"]["absorptance"] = ids("frame.absorptance")
    return written | {
        "name": f"{name}.frame",
        "construction": len(building.constructions) + len(building.glazings) + framed(building).index(name),
        "frame": {"fraction": ids("frame.fraction"), "is_frame": True},
    }


def describe_frame_construction(name: str, material: int) -> Json:
    """Describe the construction of a frame: one layer without heat capacity."""
    layer = {"name": "frame", "material": material, "thickness": None, "nodes": 0}
    return {"name": f"{name}.frame", "layers": [layer]}


def _glazed(
    building: Description,
    columns: list[str],
    all_ids: Mapping[str, int],
    name: str,
    ids: Ids,
    emissivity: list[int],
) -> Json:
    """Describe what glass and frame of a window have in common."""
    window = building.windows[name]
    wall = building.surfaces[window.surface]
    direction = {key: all_ids[f"surfaces.{window.surface}.{key}"] for key in ("tilt", "azimuth")}
    zones = list(building.zones)
    beyond: Json = {"kind": "outdoors"}
    if wall.outside.zone is not None:
        beyond = {"kind": "zone", "zone": zones.index(wall.outside.zone)}
    outside = fields_of(window.outside, deeper(ids, "outside")) | {
        "facing": beyond,
        "emissivity": emissivity[0],
        "convection": describe_convection(window.outside.convection, columns, deeper(ids, "outside")),
    }
    if window.outside.irradiance is not None:
        outside["irradiance"] = columns.index(window.outside.irradiance)
        outside["behind_obstacles"] = bool(window.outside.behind_obstacles)
    if window.outside.longwave is not None:
        outside["longwave"] = fields_of(window.outside.longwave, deeper(ids, "outside"), "longwave.")
    before = window_shades(building, name)
    if before is not None:
        outside |= {"own_shades": before.shades, "outline": before.outline}
    inside = {
        "facing": {"kind": "zone", "zone": zones.index(str(wall.inside.zone))},
        "emissivity": emissivity[1],
        "convection": describe_convection(window.inside.convection, columns, deeper(ids, "inside")),
    }
    shape = {"area": ids("area"), "vertices": corners(window.vertices), **direction}
    return shape | {"outside": outside, "inside": inside}
