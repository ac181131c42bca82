"""Whether blocks of soil fit the surfaces on them, each other and the weather."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING, Final

from mascarin.building.base.part import fault
from mascarin.building.geometry import Polygon
from mascarin.errors import InputError

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.parts.description import Description

#: Part by which the area of a surface may differ from that of its block. [-]
_SAME: Final = 0.01


def soil_faults(building: Description) -> Iterator[InitErrorDetails]:
    """Errors of the blocks of soil of a building."""
    on: dict[str, list[str]] = {name: [] for name in building.soil_blocks}
    for name, surface in building.surfaces.items():
        if surface.outside.soil is not None:
            on[surface.outside.soil].append(name)
            yield from _inside_a_zone(building, name)
        if surface.inside.soil is not None:
            yield fault(
                ("surfaces", name, "inside", "soil"),
                f"soil '{surface.inside.soil}' on the inside",
                "soil on the outside of a surface, whose inside faces a zone",
                "Exchange 'outside:' and 'inside:', and the order of the layers.",
            )
    for name, surfaces in on.items():
        yield from _one_surface(name, surfaces)
        for floor in surfaces[:1]:
            yield from _same_area(building, name, floor)
        yield from _inside_the_block(building, name)
    yield from _apart(building, on)
    yield from _weather_as_read(building)


def _inside_a_zone(building: Description, surface: str) -> Iterator[InitErrorDetails]:
    side = building.surfaces[surface].inside
    if side.zone is None:
        yield fault(
            ("surfaces", surface, "inside"),
            f"a side facing {side.faces} on soil",
            "a side that faces a zone",
            "Write 'zone: NAME', or leave the surface out: soil without a zone on it has no effect.",
        )


def _one_surface(name: str, surfaces: list[str]) -> Iterator[InitErrorDetails]:
    if not surfaces:
        yield fault(
            ("soil_blocks", name),
            "a block that no surface is on",
            "one surface with it on its outside",
            f"Write 'outside: {{soil: {name}}}' in the floor, or remove the block.",
        )
    elif len(surfaces) > 1:
        yield fault(
            ("soil_blocks", name),
            f"the surfaces {', '.join(surfaces)} on it",
            "one surface on a block: it lumps the floor and the walls of a basement",
            "Join them to one surface with the sum of their areas, or give each zone a block of its own.",
        )


def _same_area(building: Description, name: str, surface: str) -> Iterator[InitErrorDetails]:
    expected, area = building.soil_blocks[name].area, building.surfaces[surface].area
    if expected is None or area is None or abs(float(area) / expected - 1.0) <= _SAME:
        return
    block = building.soil_blocks[name]
    both = "floor and walls below the ground" if block.basement_depth > 0.0 else "floor"
    part = both if block.contact == "both" else block.contact
    yield fault(
        ("surfaces", surface, "area"),
        f"{float(area):g} m2",
        f"{expected:g} m2 within 1 %: {part} of block '{name}'",
        "Correct the area, or length and width of the block; for a floor that is no rectangle leave "
        "'length:' out and write the area over half of the perimeter as 'width:'.",
    )


def _inside_the_block(building: Description, name: str) -> Iterator[InitErrorDetails]:
    block = building.soil_blocks[name]
    lowest = float(block.basement_depth)
    what = "the floor"
    if block.contact == "walls" and lowest == 0.0:
        yield fault(
            ("soil_blocks", name, "contact"),
            "walls of a slab on the ground",
            "a basement, whose walls touch the soil",
            "Write its 'basement_depth', or 'contact: floor'.",
        )
    if block.edge is not None and block.edge.position == "vertical" and float(block.edge.extent) > lowest:
        lowest, what = float(block.edge.extent), "the edge insulation"
    if lowest > 0.8 * float(block.depth):
        yield fault(
            ("soil_blocks", name, "depth"),
            f"{float(block.depth):g} m of soil, and {what} down to {lowest:g} m",
            "a floor that is on the block, with at least a fifth of the depth below it",
            f"Write 'depth: {2.0 * lowest + 5.0:g}'.",
        )


def _apart(building: Description, on: dict[str, list[str]]) -> Iterator[InitErrorDetails]:
    """Floors that are outlines must not lie over each other."""
    outlines = {}
    for name, surfaces in on.items():
        vertices = building.surfaces[surfaces[0]].vertices if surfaces else None
        if vertices is not None:
            plan = [(float(x), float(y), 0.0) for x, y, _ in vertices]
            # A surface with corners that are no outline has its own error.
            with contextlib.suppress(InputError):
                outlines[name] = Polygon.of(name, plan)
    for (block, first), (other, second) in combinations(outlines.items(), 2):
        if first.overlaps(second):
            yield fault(
                ("soil_blocks", other),
                f"a floor that overlaps that of block '{block}' in plan",
                "floors beside each other",
                "Correct the vertices; floors of one zone are one surface on one block.",
            )


def _weather_as_read(building: Description) -> Iterator[InitErrorDetails]:
    corrected = set() if building.weather is None else set(building.weather.columns)
    used = {"air_temperature"} if building.soil_blocks else set()
    if any(block.absorptance is not None for block in building.soil_blocks.values()):
        used |= {"global_horizontal", "direct_normal", "diffuse_horizontal", "infrared"}
    for column in sorted(corrected & used):
        yield fault(
            ("weather", "columns", column),
            f"a corrected {column.replace('_', ' ')} beside a block of soil",
            "the column as it was read: the soil remembers that of years",
            "Correct the column in the weather file, or describe the floor with 'ground:'.",
        )
