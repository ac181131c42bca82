"""The building file of a case, written from its row in the catalogue.

``python -m mascarin.verification.bestest.writing`` writes all of them again; a test compares the files.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from mascarin._io import atomic
from mascarin.verification.bestest.catalogue import CASES, FOLDER, Case

Point = tuple[float, float, float]

WIDTH, DEPTH, HEIGHT = 8.0, 6.0, 2.7
"""Inside dimensions of the room: east-west, north-south, height. [m]"""
SUN_DEPTH: Final = 2.0
"""North-south dimension of the sunspace of case 960. [m]"""
SILL, HEAD = 0.2, 2.2
"""Lower and upper edge of the glass. [m]"""
RAISED: Final = 0.3
"""How much higher the glass of the sunspace is. [m]"""
SHADE_DEPTH: Final = 1.0
"""Depth of overhangs and fins. [m]"""

_SPANS: Final = {"south_west": (0.5, 3.5), "south_east": (4.5, 7.5)}
"""Openings in the south wall, from west to east. [m]"""
_SIDE_SPAN: Final = (1.5, 4.5)
"""Opening in the east and in the west wall, from south to north. [m]"""


def text(case: Case) -> str:
    """Write the building file of a case as text."""
    parts = [
        _header(case),
        _SITE,
        _materials(case),
        _constructions(case),
        _glazings(case),
        _schedules(case),
        _zones(case),
        _surfaces(case),
        _windows(case),
        _shades(case),
    ]
    return "\n".join(part for part in parts if part)


def write_all() -> None:
    """Write every building file again."""
    FOLDER.mkdir(exist_ok=True)
    for case in CASES.values():
        atomic.write(case.file, text(case))


# ------------------------------------------------------------------ parts of a file


def _header(case: Case) -> str:
    against = "" if case.base == case.name else f"# As case {case.base}, but: {case.change}.\n"
    title = f"# {case.change[0].upper()}{case.change[1:]}.\n" if not against else ""
    return (
        f"# ANSI/ASHRAE Standard 140-2020, building thermal fabric, case {case.name}.\n{title}{against}"
        "# Choices that the standard leaves open, the same for all cases: docs/bestest.md.\n"
        "# Coordinates: x east, y north, z up [m], inside dimensions, origin: south-west floor corner.\n"
        "# Written by mascarin.verification.bestest.writing from the table of cases; a test compares.\n"
        f"name: Standard 140 case {case.name}\n"
    )


_SITE: Final = """\
site:
  latitude: 39.83
  longitude: -104.65
  altitude: 1650
  air_density: {value: 1.0156, source: "ANSI/ASHRAE 140-2020, 5.2: air of the site"}
  timezone: UTC-7
  ground_reflectance: 0.2
  wind: {terrain: open}
  sky: brunt                        # coefficients of Li et al. 2017 for dew point and clouds
  diffuse: perez
"""

_SOURCE: Final = "ANSI/ASHRAE 140-2020, 5.2"


def _materials(case: Case) -> str:
    rows = ["siding", "quilt", "plasterboard", "roof_deck"]
    if case.sunspace or not case.heavy:
        rows += ["timber", "light_underfloor"]
    if case.sunspace or case.heavy:
        rows += ["foam", "concrete_block", "concrete_slab", "heavy_underfloor"]
    if case.opening == "panels":
        rows += ["panel", "panel_gap"]
    return "materials:\n" + "".join(f"  {row}: {_MATERIALS[row]}\n" for row in rows)


def _solid(conductivity: str, density: str, specific_heat: str) -> str:
    return (
        f"{{conductivity: {conductivity}, density: {density}, specific_heat: {specific_heat}, "
        f'source: "{_SOURCE}"}}'
    )


_MATERIALS: Final = {
    "siding": _solid("0.14", "530", "900"),
    "quilt": _solid("0.04", "12", "840"),
    "plasterboard": _solid("0.16", "950", "840"),
    "roof_deck": _solid("0.14", "530", "900"),
    "timber": _solid("0.14", "650", "1200"),
    "foam": _solid("0.04", "10", "1400"),
    "concrete_block": _solid("0.51", "1400", "1000"),
    "concrete_slab": _solid("1.13", "1400", "1000"),
    "panel": _solid("1.0", "2470", "750"),
    "panel_gap": _solid("0.0625", "1.2925", "1006.1"),
    "light_underfloor": f'{{kind: resistance, resistance: 25.075, source: "{_SOURCE}"}}  # 1.003 m of 0.04',
    "heavy_underfloor": f'{{kind: resistance, resistance: 25.175, source: "{_SOURCE}"}}  # 1.007 m of 0.04',
}

_LAYERS: Final = {
    "light_wall": [("siding", "0.009"), ("quilt", "0.066"), ("plasterboard", "0.012")],
    "light_floor": [("light_underfloor", ""), ("timber", "0.025")],
    "heavy_wall": [("siding", "0.009"), ("foam", "0.0615"), ("concrete_block", "0.100")],
    "heavy_floor": [("heavy_underfloor", ""), ("concrete_slab", "0.080")],
    "roof": [("roof_deck", "0.019"), ("quilt", "0.1118"), ("plasterboard", "0.010")],
    "common_wall": [("concrete_block", "0.200")],
    "panels": [("panel", "0.003048"), ("panel_gap", "0.012"), ("panel", "0.003048")],
}


def _constructions(case: Case) -> str:
    names = ["roof"]
    if case.sunspace or not case.heavy:
        names += ["light_wall", "light_floor"]
    if case.sunspace or case.heavy:
        names += ["heavy_wall", "heavy_floor"]
    if case.sunspace:
        names.append("common_wall")
    if case.opening == "panels":
        names.append("panels")
    return "constructions:                     # layers from outside to inside\n" + "".join(
        f"  {name}:\n    layers:\n{_layers(_LAYERS[name])}" for name in names
    )


def _layers(layers: Sequence[tuple[str, str]]) -> str:
    materials = [material for material, _ in layers]
    lines = []
    for index, (material, thickness) in enumerate(layers):
        twice = materials.count(material) > 1
        name = f"name: {'outer' if index == 0 else 'inner'}, " if twice else ""
        size = f", thickness: {thickness}" if thickness else ""
        lines.append(f"      - {{{name}material: {material}{size}}}\n")
    return "".join(lines)


def _glazings(case: Case) -> str:
    return _CLEAR_DOUBLE if case.windows else ""


_CLEAR_DOUBLE: Final = """\
glazings:
  clear_double:                     # two equal clear panes; angles of the whole unit from WINDOW 7
    kind: panes
    panes:
      - {thickness: 0.003048, conductivity: 1.0, emissivity: 0.84}
      - {thickness: 0.003048, conductivity: 1.0, emissivity: 0.84}
    gaps:
      - {thickness: 0.012, gas: air}
    angular:
      angles:        [0,     10,    20,    30,    40,    50,    60,    70,    80,    90]
      transmittance: [0.703, 0.702, 0.699, 0.692, 0.678, 0.646, 0.577, 0.438, 0.208, 0]
      reflectance:   [0.128, 0.128, 0.128, 0.130, 0.139, 0.164, 0.227, 0.365, 0.612, 1]
      absorptance:
        - [0.096, 0.097, 0.099, 0.102, 0.106, 0.112, 0.119, 0.127, 0.130, 0]
        - [0.072, 0.073, 0.074, 0.075, 0.077, 0.078, 0.077, 0.070, 0.050, 0]
      diffuse: {transmittance: 0.601, reflectance: 0.206, absorptance: [0.110, 0.073]}
"""


def _schedules(case: Case) -> str:
    lines = []
    if case.thermostat == "setback":
        lines.append(
            '  setback: {kind: temperature, days: {all: [{at: "00:00", value: 10}, '
            '{at: "07:00", value: 10, ramp_to: 20}, {at: "08:00", value: 20}, {at: "23:00", value: 10}]}}\n'
        )
    if case.thermostat == "day cooling":
        lines.append(
            '  day: {kind: fraction, days: {all: [{at: "00:00", value: 0}, {at: "07:00", value: 1}, '
            '{at: "18:00", value: 0}]}}\n'
        )
    if case.fan:
        lines.append(
            '  night: {kind: fraction, days: {all: [{at: "00:00", value: 1}, {at: "07:00", value: 0}, '
            '{at: "18:00", value: 1}]}}\n'
        )
    return "schedules:\n" + "".join(lines) if lines else ""


def _zones(case: Case) -> str:
    lines = ["zones:\n", f"  {case.zone}:\n", f"    volume: {_number(WIDTH * DEPTH * HEIGHT)}\n"]
    lines.append(f"    infiltration: {_number(case.air_changes)}\n")
    if case.gain:
        lines.append(f"    gains: {{internal: {{power: {_number(case.gain)}, radiative: 0.6}}}}\n")
    if case.fan:
        lines.append("    ventilation: {fan: {flow: 0.4722, schedule: night}}  # 1700 m3/h of outdoor air\n")
    lines += _IDEAL_LOADS[case.thermostat]
    if case.windows and not case.sunspace:
        lines.append(_SUN)
    if case.sunspace:
        lines += [
            "  sunspace:\n",
            f"    volume: {_number(WIDTH * SUN_DEPTH * HEIGHT)}\n",
            f"    infiltration: {_number(case.air_changes)}\n",
            _SUN,
        ]
    return "".join(lines)


_SUN: Final = "    sun: {kind: geometry}\n"

_IDEAL_LOADS: Final = {
    "20,27": ["    heating: {setpoint: 20}\n", "    cooling: {setpoint: 27}\n"],
    "20,20": ["    heating: {setpoint: 20}\n", "    cooling: {setpoint: 20}\n"],
    "setback": ["    heating: {setpoint: {schedule: setback}}\n", "    cooling: {setpoint: 27}\n"],
    "day cooling": ["    cooling: {setpoint: 27, schedule: day}\n"],
    "none": [],
}


# ------------------------------------------------------------------ geometry


def _surfaces(case: Case) -> str:
    kind = "heavy" if case.heavy else "light"
    lines = ["surfaces:\n"]
    if case.sunspace:
        lines += _box(case, "back_", "light", case.zone, (0.0, DEPTH), ("east", "north", "west"))
        lines += _common_wall(case)
        lines += _box(case, "sun_", "heavy", "sunspace", (-SUN_DEPTH, 0.0), ("south", "east", "west"))
    else:
        lines += _box(case, "", kind, case.zone, (0.0, DEPTH), ("south", "east", "north", "west"))
    if case.opening == "panels":
        lines += _panels(case)
    return "".join(lines)


def _box(
    case: Case, prefix: str, kind: str, zone: str, span: tuple[float, float], walls: Sequence[str]
) -> Iterator[str]:
    """Walls, roof and floor around a zone between two north-south coordinates."""
    south, north = span
    corners = {
        "south": ((0.0, south), (WIDTH, south)),
        "east": ((WIDTH, south), (WIDTH, north)),
        "north": ((WIDTH, north), (0.0, north)),
        "west": ((0.0, north), (0.0, south)),
    }
    outside = _weather(case, "rough")
    inside = _inside(case, zone)
    anchors = f"&{prefix}outside ", f"&{prefix}inside "
    for wall in walls:
        (x0, y0), (x1, y1) = corners[wall]
        outline = [(x0, y0, 0.0), (x1, y1, 0.0), (x1, y1, HEIGHT), (x0, y0, HEIGHT)]
        yield from _surface(
            f"{prefix}{wall}_wall", f"{kind}_wall", outline, anchors[0] + outside, anchors[1] + inside
        )
        outside, inside, anchors = f"*{prefix}outside", f"*{prefix}inside", ("", "")
    base = [(0.0, south), (WIDTH, south), (WIDTH, north), (0.0, north)]
    yield from _surface(f"{prefix}roof", "roof", [(x, y, HEIGHT) for x, y in base], outside, inside)
    under = [(x, y, 0.0) for x, y in (base[0], base[3], base[2], base[1])]
    yield from _surface(f"{prefix}floor", f"{kind}_floor", under, _underside(case), inside)


def _common_wall(case: Case) -> Iterator[str]:
    outline = [(0.0, 0.0, 0.0), (WIDTH, 0.0, 0.0), (WIDTH, 0.0, HEIGHT), (0.0, 0.0, HEIGHT)]
    yield from _surface("common_wall", "common_wall", outline, _inside(case, "sunspace"), "*back_inside")


def _panels(case: Case) -> Iterator[str]:
    outside = f"&panel_outside {_weather(case, 'very_smooth')}"
    for window, (west, east) in _SPANS.items():
        outline = _upright((west, 0.0), (east, 0.0), SILL, HEAD)
        yield from _surface(f"{window}_panel", "panels", outline, outside, "*inside")
        outside = "*panel_outside"


def _surface(
    name: str, construction: str, outline: Sequence[Point], outside: str, inside: str
) -> Iterator[str]:
    yield f"  {name}:\n"
    yield f"    construction: {construction}\n"
    yield f"    vertices: {_points(outline)}\n"
    yield f"    outside: {outside}\n"
    yield f"    inside: {inside}\n"


def _weather(case: Case, roughness: str) -> str:
    return (
        f"{{outdoors: true, convection: {{kind: doe2, roughness: {roughness}}}, "
        f"emissivity: {_number(case.emissivity_outside)}, absorptance: {_number(case.absorptance_outside)}}}"
    )


def _underside(case: Case) -> str:
    """A raised floor: outdoor air, no sun, no wind, surroundings at the temperature of the air."""
    return (
        "{outdoors: true, exposure: {sun: false, wind: false, sky: false}, convection: tarp, "
        f"emissivity: {_number(case.emissivity_outside)}}}"
    )


def _inside(case: Case, zone: str) -> str:
    sun = f", absorptance: {_number(case.absorptance_inside)}" if case.windows and zone != "back" else ""
    return f"{{zone: {zone}, convection: tarp, emissivity: {_number(case.emissivity_inside)}{sun}}}"


def _windows(case: Case) -> str:
    if not case.windows:
        return ""
    lines = ["windows:\n"]
    sides = (
        "&pane_outside {convection: {kind: doe2, roughness: very_smooth}}",
        "&pane_inside {convection: iso15099}",
    )
    for name, (surface, outline) in zip(case.windows, _openings(case), strict=True):
        lines.append(f"  {name}:\n    surface: {surface}\n    glazing: clear_double\n")
        lines.append(f"    vertices: {_points(outline)}\n    outside: {sides[0]}\n    inside: {sides[1]}\n")
        sides = "*pane_outside", "*pane_inside"
    return "".join(lines)


def _openings(case: Case) -> list[tuple[str, list[Point]]]:
    """Wall and outline of each window."""
    if case.opening == "east_west":
        south, north = _SIDE_SPAN
        return [
            ("east_wall", _upright((WIDTH, south), (WIDTH, north), SILL, HEAD)),
            ("west_wall", _upright((0.0, north), (0.0, south), SILL, HEAD)),
        ]
    wall, y, up = ("sun_south_wall", -SUN_DEPTH, RAISED) if case.sunspace else ("south_wall", 0.0, 0.0)
    return [(wall, _upright((west, y), (east, y), SILL + up, HEAD + up)) for west, east in _SPANS.values()]


def _shades(case: Case) -> str:
    if not case.shaded:
        return ""
    lines = ["shades:                            # thin, black, opaque\n"]
    if case.opening == "south":
        edge = [(0.0, 0.0), (WIDTH, 0.0)]
        lines.append(f"  overhang: {{vertices: {_points(_flat(edge, (0.0, -SHADE_DEPTH)))}}}\n")
        return "".join(lines)
    south, north = _SIDE_SPAN
    for name, x, out in (("east", WIDTH, SHADE_DEPTH), ("west", 0.0, -SHADE_DEPTH)):
        edge = [(x, south), (x, north)]
        lines.append(f"  {name}_overhang: {{vertices: {_points(_flat(edge, (out, 0.0)))}}}\n")
        for fin, y in (("south", south), ("north", north)):
            outline = _upright((x, y), (x + out, y), 0.0, HEIGHT)
            lines.append(f"  {name}_{fin}_fin: {{vertices: {_points(outline)}}}\n")
    return "".join(lines)


def _upright(start: tuple[float, float], end: tuple[float, float], low: float, high: float) -> list[Point]:
    """A rectangle over a horizontal line."""
    return [(*start, low), (*end, low), (*end, high), (*start, high)]


def _flat(edge: Sequence[tuple[float, float]], out: tuple[float, float]) -> list[Point]:
    """A horizontal rectangle at roof level, from an edge outwards."""
    (x0, y0), (x1, y1) = edge
    dx, dy = out
    return [(x, y, HEIGHT) for x, y in ((x0, y0), (x1, y1), (x1 + dx, y1 + dy), (x0 + dx, y0 + dy))]


def _points(outline: Sequence[Point]) -> str:
    return "[" + ", ".join(f"[{', '.join(_number(c) for c in point)}]" for point in outline) + "]"


def _number(value: float) -> str:
    return f"{value:.10g}"


if __name__ == "__main__":
    write_all()
