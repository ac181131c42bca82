"""A building as a scene: polygons with what a reader wants to know of each, ready for JSON."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from mascarin.building.checks.conductances import infiltration_rate
from mascarin.building.checks.u_values import described_u_value, resistance_words, u_value, window_u_value
from mascarin.building.engine_input.ratings import window_ratings
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.figures import text
from mascarin.pages.view.panels import Array, home, panels, window_panels

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parts.envelope.convection import Convection
    from mascarin.building.parts.envelope.surface import Side, Surface
    from mascarin.building.parts.openings.window import Window

Facts: TypeAlias = list[tuple[str, str]]
#: Warnings by section and name.
Said: TypeAlias = dict[tuple[str, str], list[str]]

#: What a warning is about: a part of a section, or a word that is the name of one.
_PART: Final = re.compile(r"\b(surfaces|windows|zones|materials|constructions|glazings|shades)\.([\w-]+)")
_U: Final = "W/(m2 K)"


def scene(building: Building, warnings: Sequence[str]) -> dict[str, Any]:
    """Polygons and facts of surfaces, windows and shades.

    Parameters
    ----------
    building : Building
        The building.
    warnings : sequence of str
        Warnings of its check.

    Returns
    -------
    dict
        ``parts``: each with ``id``, ``kind``, ``name``, ``corners`` [m], ``holes`` [m], the classes by which
        it is colored, and ``facts`` for the panel; ``zones`` with the place of their label; ``schematic``:
        names of the surfaces that were placed by their direction alone.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [part["name"] for part in scene(box(), [])["parts"]]
    ['facade']
    """
    placed = panels(building)
    walls = {
        name: placed[name] if surface.vertices is None else _points(surface.vertices)
        for name, surface in building.surfaces.items()
    }
    glass = _windows(building, walls)
    about = _about(building, warnings)
    parts = [
        _surface(building, name, walls[name], [glass[key] for key in _in(building, name)], about)
        for name in building.surfaces
    ]
    ratings = window_ratings(building)
    parts += [_window(building, name, corners, ratings, about) for name, corners in glass.items()]
    parts += [
        _shade(name, _points(shade.vertices), about.get(("shades", name), []))
        for name, shade in building.shades.items()
    ]
    said = Counter(line for part in parts for line in part["warnings"])
    for number, part in enumerate(parts):
        part["id"] = number
        # A warning about most of the building marks nothing.
        part["marked"] = any(2 * said[line] <= len(parts) for line in part["warnings"])
    return {"parts": parts, "zones": _zones(building, walls), "schematic": list(placed)}


def _points(vertices: Iterable[Sequence[float]]) -> Array:
    return np.array([[float(x) for x in vertex] for vertex in vertices])


def _in(building: Building, wall: str) -> list[str]:
    return [name for name, window in building.windows.items() if window.surface == wall]


def _windows(building: Building, walls: Mapping[str, Array]) -> dict[str, Array]:
    outlines: dict[str, Array] = {}
    for wall, corners in walls.items():
        wall_windows = {name: building.windows[name] for name in _in(building, wall)}
        bare = {name: window for name, window in wall_windows.items() if window.vertices is None}
        area = float(building.surfaces[wall].area or 1.0)
        outlines |= {
            name: _points(window.vertices)
            for name, window in wall_windows.items()
            if window.vertices is not None
        } | window_panels(corners, bare, area)
    return {name: outlines[name] for name in building.windows}


def _rounded(corners: Array) -> list[list[float]]:
    return [[round(float(x), 4) for x in corner] for corner in corners]


def _surface(
    building: Building,
    name: str,
    corners: Array,
    holes: Sequence[Array],
    about: Said,
) -> dict[str, Any]:
    surface = building.surfaces[name]
    u = u_value(building, surface)
    materials = [layer.material for layer in building.constructions[surface.construction].layers]
    zones = [side.zone for side in surface.sides if side.zone is not None]
    keys = [
        ("surfaces", name),
        ("constructions", surface.construction),
        *(("materials", material) for material in dict.fromkeys(materials)),
        *(("zones", zone) for zone in dict.fromkeys(zones)),
    ]
    return {
        "kind": "surface",
        "name": name,
        "corners": _rounded(corners),
        "holes": [_rounded(hole) for hole in holes],
        "construction": surface.construction,
        "boundary": _boundary(surface),
        "zone": home(surface) or "no zone",
        "u": round(u, 4) if math.isfinite(u) else None,
        "facts": _surface_facts(building, surface, u),
        "warnings": [line for key in keys for line in about.get(key, [])],
    }


def _boundary(surface: Surface) -> str:
    """What the outside faces; between zones, that."""
    if surface.internal_mass:
        return "internal mass"
    if surface.inside.zone is None:
        return f"{surface.outside.faces} / {surface.inside.faces}"
    return "another zone" if surface.outside.zone else surface.outside.faces


def _surface_facts(building: Building, surface: Surface, u: float) -> Facts:
    described = described_u_value(building, surface)
    facts = [
        ("Construction", surface.construction),
        ("U value", f"{text.with_unit(u, _U)}, {resistance_words(building, surface)}"),
    ]
    if math.isfinite(described) and not math.isclose(u, described, rel_tol=5e-4):
        facts.append(("U value as described", text.with_unit(described, _U)))
    facts += [
        ("Area", text.with_unit(float(surface.area or 0.0), "m2", 4)),
        *_direction(surface),
        ("Outside", _side(surface.outside)),
        ("Inside", _side(surface.inside)),
    ]
    return facts


def _direction(surface: Surface) -> Facts:
    tilt = float(surface.tilt or 0.0)
    facts = [("Tilt", text.with_unit(tilt, "deg"))]
    if 0.0 < tilt < 180.0 and surface.azimuth is not None:
        turn = float(surface.azimuth)
        facts.append(("Azimuth", f"{text.with_unit(turn, 'deg')} ({compass(turn)})"))
    return facts


def compass(azimuth: float) -> str:
    """Direction in words, such as ``south-west``.

    Examples
    --------
    >>> compass(225.0)
    'south-west'
    """
    names = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
    return names[round((azimuth % 360.0) / 45.0) % 8]


def _side(side: Side) -> str:
    """What a side faces, with the numbers of its exchange."""
    words = [side.in_short() if side.zone else side.in_words()]
    if side.convection is not None:
        words.append(f"convection {_film(side.convection)}")
    if side.emissivity is not None:
        words.append(f"emissivity {text.significant(float(side.emissivity))}")
    if side.absorptance is not None:
        words.append(f"absorptance {text.significant(float(side.absorptance))}")
    return ", ".join(words)


def _film(law: Convection) -> str:
    """A coefficient, a formula, or the name of a law."""
    if isinstance(law, FormulaLaw):
        return law.formula
    coefficient = getattr(law, "coefficient", None)
    return text.choice(law.kind) if coefficient is None else text.with_unit(float(coefficient), _U)


def _window(
    building: Building,
    name: str,
    corners: Array,
    ratings: Mapping[str, Any],
    about: Said,
) -> dict[str, Any]:
    window = building.windows[name]
    wall = building.surfaces[window.surface]
    u, rating = window_u_value(building, window), ratings[name]
    keys = [("windows", name), ("glazings", window.glazing)]
    return {
        "kind": "window",
        "name": name,
        "corners": _rounded(corners),
        "holes": [],
        "construction": f"glazing {window.glazing}",
        "boundary": _boundary(wall),
        "zone": wall.inside.zone or "no zone",
        "u": round(u, 4) if math.isfinite(u) else None,
        "facts": [
            ("Glazing", window.glazing),
            ("In", window.surface),
            ("U value", text.with_unit(u, _U)),
            ("Solar heat gain", f"{text.significant(rating.solar_heat_gain)} of the glass, by EN 410"),
            ("Solar transmittance", text.significant(rating.transmittance)),
            ("Area", text.with_unit(float(window.area or 0.0), "m2", 4)),
            *_frame(window),
            *([] if window.blind is None else [("Blind", window.blind.words)]),
            *_direction(wall),
        ],
        "warnings": [line for key in keys for line in about.get(key, [])],
    }


def _frame(window: Window) -> Facts:
    if window.frame is None:
        return []
    share = text.percent(float(window.frame.fraction), 0)
    return [("Frame", f"{share} of the area, {text.with_unit(float(window.frame.u_value), _U)}")]


def _shade(name: str, corners: Array, warnings: list[str]) -> dict[str, Any]:
    turned = np.roll(corners, -1, axis=0) - corners[0]
    area = 0.5 * float(np.linalg.norm(np.cross(corners - corners[0], turned).sum(axis=0)))
    return {
        "kind": "shade",
        "name": name,
        "corners": _rounded(corners),
        "holes": [],
        "construction": "shade",
        "boundary": "shade",
        "zone": "no zone",
        "u": None,
        "facts": [
            ("Area", text.with_unit(area, "m2")),
            ("Acts as", "an opaque plane outdoors, without heat"),
        ],
        "warnings": warnings,
    }


def _zones(building: Building, walls: Mapping[str, Array]) -> list[dict[str, Any]]:
    rows = []
    for name, zone in building.zones.items():
        sides = [surface for surface, _ in building.connections.sides(name)]
        # Of surfaces between two zones that have no vertices only one zone has the drawing.
        own_surfaces = [
            surface_name
            for surface_name in sides
            if building.surfaces[surface_name].vertices or home(building.surfaces[surface_name]) == name
        ]
        middles = [walls[surface_name].mean(axis=0) for surface_name in own_surfaces]
        rows.append(
            {
                "name": name,
                "volume": text.with_unit(float(zone.volume or 0.0), "m3"),
                "surfaces": len(sides),
                "place": _rounded(np.mean(middles, axis=0)[None, :])[0] if middles else None,
                "heating": _loads(zone.heating),
                "cooling": _loads(zone.cooling),
                "infiltration": text.with_unit(infiltration_rate(zone), "1/h"),
            }
        )
    return rows


def _loads(loads: Any) -> str:
    return text.NONE if loads is None else str(loads.setpoint.words)


def _about(building: Building, warnings: Sequence[str]) -> Said:
    """Warnings by the parts that they name."""
    lines_by_part: dict[tuple[str, str], list[str]] = {}
    for line in warnings:
        named = {(section, name) for section, name in _PART.findall(line)}
        words = set(re.findall(r"[\w-]+", line))
        for section in ("constructions", "surfaces"):
            # Without its section a name is only taken where the line speaks of such parts.
            if not named and (section[:-1] in line or section == "constructions"):
                named |= {(section, name) for name in getattr(building, section) if name in words}
        for key in named:
            lines_by_part.setdefault(key, []).append(line)
    return lines_by_part
