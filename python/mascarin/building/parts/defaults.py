"""Defaults derived from the rest of a description: areas, lengths, heights, volumes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from mascarin.building.base.law_table import CONVECTION as LAWS
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Location, NotDerivableError, derived_number, fault, insist, refuse
from mascarin.building.parts.air.humidity import with_all_zones
from mascarin.building.parts.air.zone import Zone
from mascarin.building.parts.envelope.convection import CLASSES, Convection, ConvectionLaw
from mascarin.building.parts.envelope.formula_law import LENGTH, PERIMETER, FormulaLaw
from mascarin.building.parts.envelope.surface import Ground, Side, Surface
from mascarin.building.parts.openings.window import Window, WindowOutside
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building.geometry import Polygon
    from mascarin.building.parts.openings.window import Shade, Vertices

_FROM_VERTICES = Remark("from the vertices")
#: Sine of the tilt below which a polygon is horizontal [-].
_LEVEL = 1e-6
#: Days of the year.
_MID_JANUARY, _MID_JULY = 15.0, 196.0


def outlines(surfaces: Mapping[str, Surface]) -> dict[str, Polygon]:
    """Polygons of the surfaces that have vertices, as seen from outside."""
    return _outlines("surfaces", {name: surface.vertices for name, surface in surfaces.items()})


def _outlines(section: str, by_name: Mapping[str, Vertices | None]) -> dict[str, Polygon]:
    with_vertices = {name: vertices for name, vertices in by_name.items() if vertices is not None}
    if not with_vertices:
        return {}
    from mascarin.building.geometry import Polygon

    polygons, faults = {}, []
    for name, vertices in with_vertices.items():
        try:
            polygons[name] = Polygon.of(name, vertices)
        except InputError as error:
            faults.append(fault((section, name, "vertices"), *_sentence(error)))
    insist(*faults)
    return polygons


def sides_by_zone(surfaces: Mapping[str, Surface]) -> dict[str, list[tuple[str, str]]]:
    """Surfaces of each zone as (surface, side), in the order of the description, outside before inside."""
    by_zone: dict[str, list[tuple[str, str]]] = {}
    for name, surface in surfaces.items():
        for side, facing in (("outside", surface.outside), ("inside", surface.inside)):
            if facing.zone is not None:
                by_zone.setdefault(facing.zone, []).append((name, side))
    return by_zone


def enclosure(sides: Sequence[tuple[str, str]], surfaces: Mapping[str, Surface]) -> list[Polygon] | None:
    """Surfaces of a zone as polygons that point into it; None unless all have vertices."""
    if not sides or any(surfaces[name].vertices is None for name, _ in sides):
        return None
    polygons = outlines({name: surfaces[name] for name, _ in sides})
    return [polygons[name] if side == "outside" else polygons[name].reversed() for name, side in sides]


def derive_surfaces(surfaces: Mapping[str, Surface], latitude: float) -> dict[str, Surface]:
    """Derive area and direction of every surface, lengths and heights of its sides, and the coldest day."""
    polygons, areas = outlines(surfaces), drawn_areas(surfaces)

    def derived(name: str, surface: Surface) -> Surface:
        with _located(("surfaces", name)):
            return _derived_surface(surface, polygons.get(name), areas.get(name), latitude)

    return {name: derived(name, surface) for name, surface in surfaces.items()}


@contextmanager
def _located_below(key: str) -> Iterator[None]:
    """Add a key to where a value stands that cannot be derived."""
    try:
        yield
    except NotDerivableError as error:
        raise error.below(key) from None


@contextmanager
def _located(location: Location) -> Iterator[None]:
    """Say where a value stands that cannot be derived."""
    try:
        yield
    except NotDerivableError as error:
        refuse(error.at(location))


def drawn_areas(surfaces: Mapping[str, Surface]) -> dict[str, float]:
    """Areas of the surfaces that have vertices, without the surfaces that lie in them [m2]."""
    polygons = outlines(surfaces)
    if not polygons:
        return {}
    try:
        return dict(zip(polygons, _net_areas(tuple(polygons.values())), strict=True))
    except InputError as error:
        refuse(fault(("surfaces",), *_sentence(error)))


@lru_cache(maxsize=4)
def _net_areas(polygons: tuple[Polygon, ...]) -> tuple[float, ...]:
    """The areas of the same polygons are needed by several rules [m2]."""
    from mascarin.building.geometry import net_areas

    return tuple(map(float, net_areas(polygons)))


def _derived_surface(
    surface: Surface, polygon: Polygon | None, area: float | None, latitude: float
) -> Surface:
    shape: dict[str, Number] = {}
    if polygon is not None and area is not None:
        derived = {"area": area, "tilt": polygon.tilt, "azimuth": polygon.azimuth}
        shape = {
            key: derived_number(Surface, key, value, _FROM_VERTICES)
            for key, value in derived.items()
            if getattr(surface, key) is None
        }
    elif surface.azimuth is None:
        shape = {
            "azimuth": derived_number(
                Surface, "azimuth", 0.0, Remark("not given: the direction has no effect here")
            )
        }
    placed = surface.model_copy(update=shape)
    sides: dict[str, Side] = {}
    for name in ("outside", "inside"):
        with _located_below(name):
            sides[name] = _derived_side(getattr(placed, name), placed, polygon, latitude)
    return placed.model_copy(update=sides)


def _derived_side(side: Side, surface: Surface, polygon: Polygon | None, latitude: float) -> Side:
    update: dict[str, object] = {}
    if side.ground is not None:
        update["ground"] = _derived_ground(side.ground, latitude)
    if side.convection is not None:
        area, tilt = float(surface.area or 0.0), float(surface.tilt or 0.0)
        update["convection"] = _derived_convection(side.convection, bool(side.outdoors), area, tilt, polygon)
    if polygon is not None and side.outdoors and side.height is None and polygon.centroid[2] > 0.0:
        update["height"] = derived_number(
            Side, "height", float(polygon.centroid[2]), Remark("centroid of the vertices")
        )
    return side.model_copy(update=update)


def _coldest_day(latitude: float) -> Number:
    day, said = (
        (_MID_JANUARY, "not given: mid-January, in the northern hemisphere")
        if latitude >= 0.0
        else (_MID_JULY, "not given: mid-July, in the southern hemisphere")
    )
    return derived_number(Ground, "coldest_day", day, Remark(said), assumed=True)


def _derived_convection(
    convection: Convection,
    outdoors: bool,
    area: float,
    tilt: float,
    polygon: Polygon | None,
    *,
    glass: bool = False,
) -> Convection:
    if isinstance(convection, ConvectionLaw):
        with _located_below("convection"):
            numbers = _of_law(convection, outdoors, area, tilt, polygon)
            if glass and "roughness" in numbers:
                numbers["roughness"] = _roughness_of_glass(convection)
        return convection.model_copy(update=numbers) if numbers else convection
    if isinstance(convection, FormulaLaw):
        with _located_below("convection"):
            numbers = _of_shape(convection, area, tilt, polygon)
        return convection.model_copy(update={"numbers": {**convection.numbers, **numbers}})
    return convection


def _of_law(
    law: ConvectionLaw, outdoors: bool, area: float, tilt: float, polygon: Polygon | None
) -> dict[str, Number]:
    """Numbers of a published law that are not given and follow from the surface or are assumed."""
    numbers = {}
    for number in law.row.numbers:
        if not number.follows or getattr(law, number.name) is not None:
            continue
        if not outdoors and (number.outdoors or number.wind):
            continue
        if number.assumed is not None:
            value, source = number.assumed
        else:
            value, source = _shape_of(number.follows, area, tilt, polygon)
        numbers[number.name] = derived_number(
            type(law), number.name, value, source, assumed=number.assumed is not None
        )
    return numbers


def _roughness_of_glass(law: ConvectionLaw) -> Number:
    roughness = next(number for number in law.row.numbers if number.name == "roughness")
    smooth = roughness.quantity.words["very_smooth"]
    return derived_number(type(law), "roughness", smooth, "Walton 1983: very smooth, as glass", assumed=True)


def _shape_of(word: str, area: float, tilt: float, polygon: Polygon | None) -> tuple[float, str]:
    """Length or perimeter of a surface [m], and where it comes from."""
    return _length(area, tilt, polygon) if word == LENGTH else _perimeter(area, polygon)


def _of_shape(law: FormulaLaw, area: float, tilt: float, polygon: Polygon | None) -> dict[str, Number]:
    """Length and perimeter of a surface, where a formula uses them and has no values of its own."""
    missing = [word for word in (LENGTH, PERIMETER) if law.uses(word) and word not in law.numbers]
    return {word: _number_of_shape(word, *_shape_of(word, area, tilt, polygon)) for word in missing}


def _number_of_shape(word: str, value: float, source: str) -> Number:
    row = next(row for row in LAWS.values() if any(number.name == word for number in row.numbers))
    return derived_number(CLASSES[row.class_name], word, value, source)


def _length(area: float, tilt: float, polygon: Polygon | None) -> tuple[float, str]:
    """Height of a vertical surface, 4 A/P of a horizontal one [m]; without vertices, the edge of a square."""
    if polygon is None:
        return math.sqrt(area), Remark("edge of a square of this area")
    if 45.0 < tilt < 135.0:
        heights = polygon.points[:, 2]
        return float(heights.max() - heights.min()), Remark("height of the vertices")
    return 4.0 * polygon.area / polygon.perimeter, Remark("4 area/perimeter of the vertices")


def _cavity_height(area: float, polygon: Polygon | None) -> tuple[float, str]:
    """Length of the gaps along the line of greatest slope [m], the height of ISO 15099:2003, 5.3.3.

    In a horizontal window there is no such line, and the correlations do not depend on it.
    """
    if polygon is None:
        return math.sqrt(area), Remark("edge of a square of this area")
    east, north, up = map(float, polygon.normal)
    level = math.hypot(east, north)
    if level < _LEVEL:
        return math.sqrt(area), Remark("edge of a square of this area: a horizontal gap has no height")
    slope = (-up * east / level, -up * north / level, level)
    along = [sum(a * b for a, b in zip(corner, slope, strict=True)) for corner in polygon.vertices]
    return max(along) - min(along), Remark("height of the vertices along the slope")


def _perimeter(area: float, polygon: Polygon | None) -> tuple[float, str]:
    """Perimeter [m]; without vertices, that of a square."""
    if polygon is None:
        return 4.0 * math.sqrt(area), Remark("perimeter of a square of this area")
    return polygon.perimeter, _FROM_VERTICES


def derive_windows(windows: Mapping[str, Window], surfaces: Mapping[str, Surface]) -> dict[str, Window]:
    """Derive area of every window, and lengths and heights of its sides and gaps."""
    polygons = window_outlines(windows)

    def derived(name: str, window: Window) -> Window:
        with _located(("windows", name)):
            return _derived_window(window, surfaces[window.surface], polygons.get(name))

    return {name: derived(name, window) for name, window in windows.items()}


def window_outlines(windows: Mapping[str, Window]) -> dict[str, Polygon]:
    """Polygons of the windows that have vertices, as seen from outside."""
    return _outlines("windows", {name: window.vertices for name, window in windows.items()})


def shade_outlines(shades: Mapping[str, Shade]) -> dict[str, Polygon]:
    """Polygons of the shades."""
    return _outlines("shades", {name: shade.vertices for name, shade in shades.items()})


def _derived_window(window: Window, wall: Surface, polygon: Polygon | None) -> Window:
    update: dict[str, object] = {}
    area = float(window.area or (polygon.area if polygon is not None else 0.0))
    if window.area is None:
        update["area"] = derived_number(Window, "area", area, _FROM_VERTICES)
    if window.cavity_height is None:
        high, source = _cavity_height(area, polygon)
        update["cavity_height"] = derived_number(Window, "cavity_height", high, source)
    outside, inside = window.outside, window.inside
    films: dict[str, Convection] = {}
    for side, film, face in (
        ("outside", outside.convection, wall.outside),
        ("inside", inside.convection, wall.inside),
    ):
        with _located_below(side):
            films[side] = _derived_convection(
                film, bool(face.outdoors), area, float(wall.tilt or 0.0), polygon, glass=True
            )
    height = outside.height
    if not wall.outside.outdoors:
        height = None
    elif height is None and polygon is not None and polygon.centroid[2] > 0.0:
        source = Remark("centroid of the vertices")
        height = derived_number(WindowOutside, "height", float(polygon.centroid[2]), source)
    elif height is None and wall.outside.height is not None:
        height = derived_number(WindowOutside, "height", wall.outside.height, Remark("height of the wall"))
    update["outside"] = outside.model_copy(update={"convection": films["outside"], "height": height})
    update["inside"] = inside.model_copy(update={"convection": films["inside"]})
    return window.model_copy(update=update)


def derive_zones(
    zones: Mapping[str, Zone], surfaces: Mapping[str, Surface], latitude: float
) -> dict[str, Zone]:
    """Derive the volume of every zone, and the coldest day of the ground that thermal bridges end in."""
    sides = sides_by_zone(surfaces)

    def derived(name: str, zone: Zone) -> Zone:
        update: dict[str, object] = {}
        if zone.volume is None:
            update["volume"] = _volume(name, enclosure(sides.get(name, ()), surfaces))
        if any(bridge.ground is not None for bridge in zone.thermal_bridges.values()):
            update["thermal_bridges"] = {
                key: bridge.model_copy(update={"ground": _derived_ground(bridge.ground, latitude)})
                for key, bridge in zone.thermal_bridges.items()
            }
        return zone.model_copy(update=update) if update else zone

    return {name: derived(name, zone) for name, zone in zones.items()}


def _derived_ground(ground: Ground | None, latitude: float) -> Ground | None:
    if ground is None or ground.coldest_day is not None:
        return ground
    return ground.model_copy(update={"coldest_day": _coldest_day(latitude)})


def _volume(zone: str, polygons: list[Polygon] | None) -> Number:
    location: Location = ("zones", zone, "volume")
    if polygons is None:
        refuse(
            fault(
                location,
                "nothing",
                "Volume of air, above 0 [m3]",
                "Add 'volume:' (or vertices to every surface).",
            )
        )
    from mascarin.building.geometry import volume

    try:
        with _located(location[:-1]):
            return derived_number(Zone, "volume", volume(polygons), _FROM_VERTICES)
    except InputError as error:
        refuse(fault(location, *_sentence(error)))


def _sentence(error: InputError) -> tuple[str, str, str]:
    """Split 'found; expected ...; do ...' into its three parts."""
    actual, _, expected_text = str(error).partition("; expected ")
    expected, _, advice = expected_text.partition("; ")
    return actual, expected or "a valid geometry", f"{advice[:1].upper()}{advice[1:]}." if advice else ""


#: Sections that are completed when a building is made, in this order.
DERIVED: Final[Mapping[str, Callable[[Any], object]]] = {
    "surfaces": lambda building: derive_surfaces(building.surfaces, building.site.latitude),
    "windows": lambda building: derive_windows(building.windows, building.surfaces),
    "zones": lambda building: derive_zones(building.zones, building.surfaces, building.site.latitude),
    "humidity": lambda building: with_all_zones(building.humidity, building.zones),
}
