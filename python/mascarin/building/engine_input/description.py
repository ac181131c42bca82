"""The whole building as the engine reads it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from mascarin._io.memory import uncollected
from mascarin.building.base.number import Interval
from mascarin.building.base.part import cached_on
from mascarin.building.engine_input.air import (
    describe_air_path,
    describe_bridges,
    describe_door,
    describe_opening,
    describe_unit,
)
from mascarin.building.engine_input.channels import channels
from mascarin.building.engine_input.derived_outputs import describe_derived
from mascarin.building.engine_input.heat_sources import describe_heat_source
from mascarin.building.engine_input.humidity import describe_humidity
from mascarin.building.engine_input.ids import Ids, Json, Positions, below, corners, each, fields_of
from mascarin.building.engine_input.materials import describe_construction, describe_material
from mascarin.building.engine_input.mesh import Mesh, choose
from mascarin.building.engine_input.series_users import courses
from mascarin.building.engine_input.surfaces import describe_sensor, describe_surface
from mascarin.building.engine_input.vents import describe_vents
from mascarin.building.engine_input.windows import (
    describe_blinded_glazing,
    describe_frame,
    describe_frame_construction,
    describe_glazing,
    describe_window,
    framed,
    shaded,
)
from mascarin.building.engine_input.zones import describe_zone
from mascarin.building.parameters.parameter import parameters
from mascarin.building.parts.air.air_path import AirPath
from mascarin.building.parts.air.schedule import schedule_channel
from mascarin.building.parts.description import Description
from mascarin.building.parts.levels import levels
from mascarin.building.parts.materials.text_law import TextSky, numbers_of
from mascarin.building.parts.self_shading import obstructions
from mascarin.building.parts.site import CloudFactor, CloudLayer, Site


@dataclass(frozen=True)
class EngineDescription:
    """A building as the engine reads it.

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
        Names of the schedules and of other courses over time, which are the last of the channels.
    notes : tuple of str
        Warnings about the mesh.
    nodes : mapping of (str, str) to int
        Finite volumes by construction and layer.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> description = box().to_engine()
    >>> len(description.paths) == len(description.values)
    True
    """

    json: str
    paths: list[str]
    values: npt.NDArray[np.float64]
    channels: list[str]
    schedules: tuple[str, ...]
    notes: tuple[str, ...]
    nodes: Mapping[tuple[str, str], int]


def describe(
    building: Description, step_seconds: float, ranges: Mapping[str, Interval] | None = None
) -> EngineDescription:
    """Describe a building to the engine; see `Building.to_engine`.

    The last description is kept with the building: its check and its run need the same one.
    """
    stored = cached_on(building, "_described", dict[Any, EngineDescription])
    key = (step_seconds, tuple(sorted((ranges or {}).items())))
    if key not in stored:
        stored.clear()
        stored[key] = _describe(building, step_seconds, ranges or {})
    described = stored[key]
    return replace(
        described,
        paths=list(described.paths),
        values=described.values.copy(),
        channels=list(described.channels),
    )


@uncollected()
def _describe(
    building: Description, step_seconds: float, ranges: Mapping[str, Interval]
) -> EngineDescription:
    mesh = choose(building, step_seconds, ranges)
    leaves = [parameter for parameter in parameters(building) if not parameter.structural]
    ids = {leaf.path: index for index, leaf in enumerate(leaves)}
    columns = channels(building)
    schedules = list(courses(building))
    positions = {name: len(columns) + k for k, name in enumerate(schedules)}
    columns = [*columns, *(schedule_channel(name) for name in schedules)]
    description = {
        "parameters": [{"path": leaf.path, "value": leaf.value} for leaf in leaves],
        "site": _site(building.site, below(ids, "site")),
        **_constructions(building, mesh, ids, positions),
        "zones": each(building.zones, "zones", ids, partial(describe_zone, building, positions)),
        **_air(building, ids, positions),
        "openings": each(building.openings, "openings", ids, partial(describe_opening, building, positions)),
        **describe_vents(building, positions, ids),
        "surfaces": _placed(
            building,
            [
                *each(
                    building.surfaces,
                    "surfaces",
                    ids,
                    partial(describe_surface, building, (columns, positions), ids),
                ),
                *each(building.windows, "windows", ids, partial(describe_window, building, columns, ids)),
                *(describe_frame(building, columns, name, ids) for name in framed(building)),
            ],
        ),
        "heat_sources": each(
            building.heat_sources, "heat_sources", ids, partial(describe_heat_source, building, positions)
        ),
        "sensors": each(building.sensors, "sensors", ids, partial(describe_sensor, building)),
        "outputs": describe_derived(building, ids),
        "humidity": describe_humidity(building, positions, ids),
        "shades": [corners(shade.vertices) for shade in building.shades.values()],
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


def _constructions(building: Description, mesh: Mesh, ids: Mapping[str, int], positions: Positions) -> Json:
    """Materials and constructions, those of glazings, frames and blinds included."""
    return {
        "materials": [
            *each(building.materials, "materials", ids, describe_material),
            *(
                {"kind": "rated", "u_value": ids[f"windows.{name}.frame.u_value"]}
                for name in framed(building)
            ),
        ],
        "constructions": [
            *each(
                building.constructions,
                "constructions",
                ids,
                partial(describe_construction, building, mesh.nodes),
            ),
            *each(building.glazings, "glazings", ids, describe_glazing),
            *(
                describe_frame_construction(name, len(building.materials) + index)
                for index, name in enumerate(framed(building))
            ),
            *(describe_blinded_glazing(building, positions, ids, name) for name in shaded(building)),
        ],
    }


def _air(building: Description, ids: Mapping[str, int], positions: Positions) -> Json:
    """Air between zones, mechanical ventilation and thermal bridges."""
    paths = building.air_paths

    def listed(chosen: Callable[[AirPath], bool], write: Callable[..., Json]) -> list[Json]:
        some = {name: path for name, path in paths.items() if chosen(path)}
        return each(some, "air_paths", ids, partial(write, building, positions))

    return {
        "air_paths": listed(lambda path: path.door is None and not path.one_way, describe_air_path),
        "directed_flows": listed(lambda path: path.one_way, describe_air_path),
        "doors": listed(lambda path: path.door is not None, describe_door),
        "ventilation_units": each(
            building.ventilation_units, "ventilation_units", ids, partial(describe_unit, building, positions)
        ),
        "thermal_bridges": describe_bridges(building, positions, ids),
    }


def _placed(building: Description, written: list[Json]) -> list[Json]:
    """Surfaces, windows and frames with what stands in front of them, and their heights in stratified air."""
    return _levelled(building, _obstructed(building, written))


def _obstructed(building: Description, written: list[Json]) -> list[Json]:
    """Surfaces, windows and frames with the surfaces in front of their sides."""
    indices = {name: index for index, name in enumerate(building.surfaces)}
    names = [*building.surfaces, *building.windows, *framed(building)]
    in_front = obstructions(building)
    for name, part in zip(names, written, strict=True):
        for side in ("outside", "inside"):
            if obstacles := in_front.get((name, side)):
                part[side]["shaded_by"] = [indices[other] for other in obstacles]
    return written


def _levelled(building: Description, written: list[Json]) -> list[Json]:
    """The same with the heights of surfaces in stratified air."""
    for zone, part in building.zones.items():
        if part.air_gradient is None:
            continue
        names = [*building.surfaces, *building.windows]
        for item, level in zip(building.connections.of(zone), levels(building, zone)[0], strict=True):
            written[names.index(item.name)][item.side]["level"] = level
            if item.window is not None and item.name in framed(building):
                frame = len(names) + list(framed(building)).index(item.name)
                written[frame][item.side]["level"] = level
    return written


def _clouds(clouds: CloudFactor | CloudLayer, ids: Ids) -> Json | list[int]:
    if isinstance(clouds, CloudFactor):
        return [ids(f"cloud.{key}") for key in ("c1", "c2", "c3")]
    return {key: ids(f"cloud.{key}") for key in ("emissivity", "base")}


def _sky(site: Site, ids: Ids) -> Json:
    if isinstance(site.sky, TextSky):
        law = numbers_of(site.sky, ids, "sky.")
        return {"kind": "text", "temperature": site.sky.of == "temperature", "law": law}
    return fields_of(site.sky, ids, "sky.")


def _site(site: Site, ids: Ids) -> Json:
    return {
        **fields_of(site, ids),
        "wind": fields_of(site.wind, ids, "wind."),
        "sky": _sky(site, ids),
        "cloud": _clouds(site.cloud, ids),
        "diffuse": site.diffuse,
        **(
            {"horizon": [[float(angle) for angle in point] for point in site.horizon]} if site.horizon else {}
        ),
    }
