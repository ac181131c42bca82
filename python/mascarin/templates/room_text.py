"""The description of a room as YAML: short, with comments, each assumed number marked as such."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from mascarin.templates.geometry import (
    Outline,
    floor_outline,
    roof_outline,
    wall_outlines,
    window_outlines,
)
from mascarin.templates.place import place_of
from mascarin.templates.short_texts import WALLS, size_of

if TYPE_CHECKING:
    from mascarin.templates.room import Room
    from mascarin.templates.short_texts import WindowText

#: Between roof and ceiling. [m]
_GAP_HEIGHT: Final = 0.25
#: Materials with a bright metal surface.
_METALS: Final = ("steel", "aluminium")
#: Free area of both openings of a gap together, as a part of the ceiling.
_FREE_AREA: Final = 1.0 / 150.0

_HEAD: Final = """\
# Lengths in m, temperatures in degC; x points east, y north, z up. Vertices run counter-clockwise
# seen from outside, layers from outside to inside. Numbers that are assumed are typical values
# with a plausible range: put yours in their place."""
_DEFAULTS: Final = """\
# Keys that many parts share; a part that has a key keeps it.
defaults:
  outdoors:
    convection: doe2
    emissivity: 0.9
    absorptance: {value: 0.6, range: [0.3, 0.9], source: medium colour, assumed: true}"""
_INDOORS: Final = "  indoors: {convection: tarp, emissivity: 0.9}"
#: The sun enters rooms with windows.
_SUNLIT: Final = """\
  indoors:
    convection: tarp
    emissivity: 0.9
    absorptance: {value: 0.5, range: [0.2, 0.7], source: light to medium colour, assumed: true}
  windows: {glazing: double, outside: {convection: doe2}, inside: {convection: tarp}}"""
_GLAZING: Final = """\
glazings:
  double: {kind: simple, u_value: 2.8, solar_heat_gain: 0.75}
windows:"""
_CONTROL: Final = (
    "{{zone: {room}, indoor: {{open: 23, close: 20}}, difference: {{open: 1, close: 0}}, "
    "minimum_open_time: 30, minimum_closed_time: 30}}"
)
_ROOF: Final = "{value: 0.7, range: [0.3, 0.9], source: colour of the roof, assumed: true}"
_COOL_ROOF: Final = (
    '{value: 0.35, range: [0.2, 0.45], source: "white coating: new 0.2, aged to 0.45 (Bretz & Akbari 1997, '
    'doi:10.1016/S0378-7788(96)01004-3)"}'
)
_FOIL: Final = "{value: 0.05, range: [0.03, 0.15], source: bright foil}"
_METAL: Final = "{value: 0.25, range: [0.2, 0.9], source: galvanised sheet, assumed: true}"


def text_of(room: Room) -> str:
    """Description of a room as YAML.

    Parameters
    ----------
    room : Room
        The room.
    """
    return "\n".join(_lines(room)) + "\n"


def _lines(room: Room) -> Iterator[str]:
    """Lines of the description of a room.

    Parameters
    ----------
    room : Room
        The room.
    """
    length, width, height = size_of(room.size)
    location = place_of(room.place)
    what = "A room" if room.rooms == 1 else f"{room.rooms} rooms in a house"
    yield f"# {what} of {length:g} x {width:g} x {height:g} m in the climate of {location.title}."
    yield f"# Made by: {room.command}"
    yield _HEAD
    yield f"name: {'room' if room.rooms == 1 else 'house'}"
    yield f"site: {location.site}"
    yield _DEFAULTS
    yield _SUNLIT if room.openings else _INDOORS
    yield from _constructions(room)
    yield "zones:"
    for name in room.names:
        yield f"  {name}: {_infiltration(0.5, 1.5, 'closed windows')}"
    if room.gap != "none":
        yield f"  gap: {_infiltration(0.5 if room.gap == 'closed' else 0.2, 2.0, 'leaks')}"
    yield "surfaces:"
    for name, keys in _surfaces(room, location.ground):
        yield f"  {name}:"
        yield f"    {{{', '.join(keys)}}}"
    yield from _openings(room)


def _infiltration(value: float, high: float, source: str) -> str:
    return (
        f"{{infiltration: {{constant: {{value: {value:g}, range: [0.1, {high:g}], source: {source}, "
        "assumed: true}}}"
    )


def _constructions(room: Room) -> Iterator[str]:
    layers = room.layers
    yield "materials:"
    for name, material in {layer.name: layer.material for part in layers.values() for layer in part}.items():
        yield f"  {name}: {flow(material)}"
    yield "constructions:"
    for construction, part in layers.items():
        yield f"  {construction}:"
        yield "    layers:"
        counts: dict[str, int] = {}
        for layer in reversed(part):
            counts[layer.name] = counts.get(layer.name, 0) + 1
            thickness: Any = layer.thickness
            if layer.assumed:
                thickness = {"value": layer.thickness, "source": "typical", "assumed": True}
            own_name = {"name": f"{layer.name}_{counts[layer.name]}"} if counts[layer.name] > 1 else {}
            yield f"      - {flow({**own_name, 'material': layer.name, 'thickness': thickness})}"


def _parts(room: Room) -> Iterator[tuple[str, str, float, float]]:
    """Name, prefix of its surfaces, west and east end of each room."""
    step = size_of(room.size)[0] / room.rooms
    for k, name in enumerate(room.names):
        yield name, "" if room.rooms == 1 else f"{name}_", k * step, (k + 1) * step


def _surfaces(room: Room, ground: str) -> Iterator[tuple[str, list[str]]]:
    """Name and keys of each surface."""
    length, width, height = size_of(room.size)
    before = None
    for name, prefix, west, east in _parts(room):
        inside = f"inside: {{zone: {name}}}"
        for wall, outline in wall_outlines(west, east, width, 0.0, height).items():
            if f"{prefix}{wall}" in _outdoors(room):
                yield f"{prefix}{wall}", ["construction: wall", _vertices(outline), inside]
            elif wall == "west":
                outside = f"outside: {{zone: {before}}}"
                yield f"{before}_{name}", ["construction: partition", _vertices(outline), outside, inside]
        below = _vertices(floor_outline(west, east, width))
        yield f"{prefix}floor", ["construction: floor", below, f"outside: {{ground: {ground}}}", inside]
        above = _vertices(roof_outline(west, east, width, height))
        if room.gap == "none":
            yield f"{prefix}roof", ["construction: roof", above, _roof_outside(room), inside]
        else:
            foil = f", emissivity: {_FOIL}" if "radiant-foil" in room.recipes else ""
            outside = f"outside: {{zone: gap{foil}}}"
            yield f"{prefix}ceiling", ["construction: ceiling", above, outside, inside]
        before = name
    if room.gap == "none":
        return
    top = height + _GAP_HEIGHT
    for wall, outline in wall_outlines(0.0, length, width, height, top).items():
        yield f"gap_{wall}", ["construction: wall", _vertices(outline), "inside: {zone: gap}"]
    bright = f", emissivity: {_METAL}" if room.layers["roof"][0].name in _METALS else ""
    outline = roof_outline(0.0, length, width, top)
    inside = f"inside: {{zone: gap{bright}}}"
    yield "roof", ["construction: roof", _vertices(outline), _roof_outside(room), inside]


def _outdoors(room: Room) -> set[str]:
    """Names of the walls that face outdoors."""
    ends = {("west", room.names[0]), ("east", room.names[-1])}
    return {
        f"{prefix}{wall}"
        for name, prefix, _, _ in _parts(room)
        for wall in WALLS
        if wall in ("south", "north") or (wall, name) in ends
    }


def _roof_outside(room: Room) -> str:
    absorptance = _COOL_ROOF if "cool-roof" in room.recipes else _ROOF
    return f"outside: {{outdoors: true, absorptance: {absorptance}}}"


def _windows(room: Room) -> Iterator[tuple[str, str, str, WindowText, Outline]]:
    """Zone, wall, name, window and outline of each window that faces outdoors."""
    _, width, height = size_of(room.size)
    for zone, prefix, west, east in _parts(room):
        for name, window, outline in window_outlines(room.openings, west, east, width, height):
            if f"{prefix}{window.wall}" in _outdoors(room):
                yield zone, f"{prefix}{window.wall}", f"{prefix}{name}", window, outline


def _openings(room: Room) -> Iterator[str]:
    """Glazings, windows, vents and controls."""
    windows = list(_windows(room))
    if windows:
        yield _GLAZING
        for _, wall, name, _, outline in windows:
            yield f"  {name}: {{surface: {wall}, {_vertices(outline)}}}"
    if room.gap == "ventilated" or "night-ventilation" in room.recipes:
        yield "# Air by wind and temperature differences through free areas [m2]."
        yield "vents:"
    if room.gap == "ventilated":
        yield from _gap_vents(room)
    if "night-ventilation" in room.recipes:
        for zone, wall, name, window, outline in windows:
            yield f"  {name}_opening:"
            yield (
                f"    {{zone: {zone}, surface: {wall}, area: {0.5 * window.width * window.height:.3g}, "
                f"height: {window.height:g}, elevation: {0.5 * (outline[0][2] + outline[2][2]):.4g}, "
                f"pressure: low_rise, control: night_{zone}}}"
            )
        yield "controls:"
        for zone in dict.fromkeys(zone for zone, *_ in windows):
            yield f"  night_{zone}: {_CONTROL.format(room=zone)}"


def _gap_vents(room: Room) -> Iterator[str]:
    length, width, height = size_of(room.size)
    area = 0.5 * _FREE_AREA * length * width
    for wall in ("south", "north"):
        yield f"  gap_{wall}_vent:"
        yield (
            f"    {{zone: gap, surface: gap_{wall}, elevation: {height + 0.5 * _GAP_HEIGHT:.4g}, "
            f"pressure: low_rise, area: {{value: {area:.3g}, range: [{0.2 * area:.2g}, {3.0 * area:.2g}], "
            'source: "1/150 of the ceiling in all (International Residential Code R806.2)", assumed: true}}'
        )


def _vertices(outline: Outline) -> str:
    return f"vertices: {flow([[round(value, 4) for value in point] for point in outline])}"


def flow(value: Any) -> str:
    """A value as YAML in one line.

    Examples
    --------
    >>> flow({"value": 0.5, "source": "a table: 3", "assumed": True})
    '{value: 0.5, source: "a table: 3", assumed: true}'
    """
    match value:
        case dict():
            return "{" + ", ".join(f"{key}: {flow(item)}" for key, item in value.items()) + "}"
        case list() | tuple():
            return "[" + ", ".join(map(flow, value)) + "]"
        case bool():
            return "true" if value else "false"
        case int() | float():
            return f"{value:g}"
    text = str(value)
    return f'"{text}"' if any(sign in text for sign in ",:#[]{}") else text
