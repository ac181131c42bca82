"""Drawings of a building from its vertices and constructions: view from above, section, layers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg.chart import Array, Svg
from mascarin.study_document.building import BuildingEntry, ConstructionEntry, LayerEntry, SurfaceEntry
from mascarin.study_document.comparison import SensorEntry

#: Class of the mark of a sensor.
SENSOR: Final = "sensor-dot"


def _polygons(building: BuildingEntry) -> list[tuple[SurfaceEntry, Array]]:
    return [
        (surface, np.array(surface.vertices, dtype=np.float64))
        for surface in building.surfaces
        if surface.vertices
    ]


def _normal(vertices: Array) -> Array:
    p = vertices - vertices[0]
    normal: Array = np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
    return normal


def _construction_class(building: BuildingEntry, name: str) -> str:
    names = [c.name for c in building.constructions]
    return f"fill-{names.index(name) % 8}" if name in names else "fill-0"


# --- view from above ------------------------------------------------------------------------------


def view(building: BuildingEntry) -> Markup | None:
    """Parallel projection of the outer surfaces from above, hidden edges dashed.

    Parameters
    ----------
    building : BuildingEntry
        The building.

    Returns
    -------
    Markup or None
        None if no surface has vertices.
    """
    polygons = _polygons(building)
    if len(polygons) < 4:
        return None
    # Seen from the north-east, 28 degrees above the horizon.
    turn, rise = math.radians(35.0), math.radians(28.0)
    to_eye = np.array([math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise), math.sin(rise)])
    right = np.array([-math.cos(turn), math.sin(turn), 0.0])
    up = np.cross(to_eye, right)
    if up[2] < 0.0:
        up = -up
    frame = np.stack([right, -up])
    projected = np.vstack([v for _, v in polygons]) @ frame.T
    low, high = projected.min(axis=0), projected.max(axis=0)
    width, height, margin = 420.0, 360.0, 46.0
    scale = min((width - 2 * margin) / (high[0] - low[0]), (height - 2 * margin) / (high[1] - low[1]))
    offset = 0.5 * (np.array([width, height]) - scale * (low + high))
    svg = Svg(width, height)

    def on_page(points: Array) -> Array:
        placed: Array = scale * (points @ frame.T) + offset
        return placed

    visible: list[tuple[SurfaceEntry, Array]] = []
    hidden: list[tuple[SurfaceEntry, Array]] = []
    for surface, vertices in polygons:
        faces_out = surface.outside == "outdoors"
        faces_viewer = faces_out and float(_normal(vertices) @ to_eye) > 1e-9
        (visible if faces_viewer else hidden).append((surface, vertices))
    for surface, vertices in sorted(visible, key=lambda item: float((item[1] @ to_eye).mean())):
        kind = _construction_class(building, surface.construction)
        svg.polygon(on_page(vertices), f"face {kind}")
    for surface, vertices in hidden:
        inner = surface.outside != "outdoors"
        svg.polygon(on_page(vertices), "hidden-edge inner" if inner else "hidden-edge")
    _name_surfaces(svg, [(surface, on_page(vertices)) for surface, vertices in visible])
    _compass(svg, frame)
    _scale_bar(svg, scale, width, height)
    return svg.markup(f"Drawing of {building.name or 'the building'} seen from the north-east and above")


def _name_surfaces(svg: Svg, faces: Sequence[tuple[SurfaceEntry, Array]]) -> None:
    """Write names on surfaces where they do not cover another name or a smaller surface."""
    taken: list[tuple[float, float, float]] = []
    boxes = [(outline.min(axis=0), outline.max(axis=0)) for _, outline in faces]
    for (surface, outline), (low, high) in zip(faces, boxes, strict=True):
        name = text.plain_path(surface.name)
        half = 3.1 * len(name)
        if float(high[0] - low[0]) < 1.5 * half:
            continue
        smaller = [(a, b) for a, b in boxes if np.prod(b - a) < 0.5 * np.prod(high - low)]
        middle = outline.mean(axis=0)
        for down in (0.0, 0.3, -0.3, 0.5):
            x, y = float(middle[0]), float(middle[1] + down * (high[1] - low[1]))
            free = all(abs(x - p) > half + n or abs(y - q) > 13.0 for p, q, n in taken)
            clear = all(
                x + half < a[0] or x - half > b[0] or y + 6.0 < a[1] or y - 6.0 > b[1]
                for a, b in smaller
                if bool(np.all(a > low) and np.all(b < high))
            )
            if free and clear:
                svg.label(x, y + 4.0, name, "on-face", "middle")
                taken.append((x, y, half))
                break


def _compass(svg: Svg, frame: Array) -> None:
    centre = np.array([38.0, svg.height - 34.0])
    north = frame @ np.array([0.0, 1.0, 0.0])
    tip = centre + 24.0 * north / max(float(np.linalg.norm(north)), 1e-9)
    svg.line(float(centre[0]), float(centre[1]), float(tip[0]), float(tip[1]), "arrow")
    svg.add("circle", cx=float(centre[0]), cy=float(centre[1]), r=2.5, class_="arrow-dot")
    away = tip + 9.0 * (tip - centre) / 24.0
    svg.label(float(away[0]), float(away[1]) + 4.0, "N", "small", "middle")


def _scale_bar(svg: Svg, scale: float, width: float, height: float) -> None:
    length = next(
        m for m in (100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1) if m * scale < 0.35 * width
    )
    x, y = width - 14.0, height - 16.0
    svg.line(x - length * scale, y, x, y, "scale-bar")
    svg.line(x - length * scale, y - 4, x - length * scale, y + 4, "scale-bar")
    svg.line(x, y - 4, x, y + 4, "scale-bar")
    svg.label(x - 0.5 * length * scale, y - 6, f"{length:g}\u00a0m", "small", "middle")


# --- section --------------------------------------------------------------------------------------


def section(building: BuildingEntry, sensors: Mapping[str, SensorEntry]) -> Markup | None:
    """Section through the middle from south to north, with zones and sensors.

    Parameters
    ----------
    building : BuildingEntry
        The building.
    sensors : mapping of str to SensorEntry
        The output gives where a sensor is.

    Returns
    -------
    Markup or None
        None if the plane cuts less than three surfaces.
    """
    polygons = _polygons(building)
    if not polygons:
        return None
    all_points = np.vstack([v for _, v in polygons])
    middle = 0.5 * float(all_points[:, 0].min() + all_points[:, 0].max()) + 1e-6
    cuts = [(surface, cut) for surface, v in polygons if (cut := _cut(v, middle)) is not None]
    if len(cuts) < 3:
        return None
    low, high = all_points[:, 1:].min(axis=0), all_points[:, 1:].max(axis=0)
    longest = max((len(info.label or "") for info in sensors.values()), default=0)
    # Wide enough for the longest name beside the section, about 6.4 px for each letter.
    room = max(150.0, 46.0 + 6.4 * longest) if sensors else 46.0
    width, height, margin = 270.0 + room, 360.0, 46.0
    scale = min((width - margin - room) / (high[0] - low[0]), (height - 2 * margin) / (high[1] - low[1]))

    def on_page(points: Array) -> Array:
        # Seen from the east: north to the right.
        shifted = (points - low) * scale
        x = margin + shifted[:, 0]
        y = height - margin - 0.5 * (height - 2 * margin - scale * (high[1] - low[1])) - shifted[:, 1]
        return np.column_stack([x, y])

    svg = Svg(width, height)
    _zone_fills(svg, cuts, [zone.name for zone in building.zones], on_page)
    for surface, cut in cuts:
        (x1, y1), (x2, y2) = on_page(cut)
        kind = _construction_class(building, surface.construction).replace("fill", "stroke")
        svg.line(float(x1), float(y1), float(x2), float(y2), f"cut {kind}")
    bottom = float(on_page(low[None, :])[0][1])
    svg.label(margin, bottom + 22, "S", "small", "middle")
    svg.label(margin + scale * float(high[0] - low[0]), bottom + 22, "N", "small", "middle")
    _sensor_marks(svg, cuts, sensors, on_page, width - room + 12.0)
    return svg.markup("Section from south to north with the zones and the places of the sensors")


def _cut(vertices: Array, x: float) -> Array | None:
    """Piece of a polygon in the plane of constant x, as two points (y, z)."""
    points = []
    for a, b in zip(vertices, np.roll(vertices, -1, axis=0), strict=True):
        if (a[0] - x) * (b[0] - x) < 0.0:
            points.append((a + (x - a[0]) / (b[0] - a[0]) * (b - a))[1:])
    if len(points) < 2:
        return None
    far = max(points[1:], key=lambda p: float(np.linalg.norm(p - points[0])))
    return np.stack([points[0], far])


def _facing(surface: SurfaceEntry, zone: str) -> bool:
    return zone in (surface.outside, surface.inside)


def _zone_fills(
    svg: Svg, cuts: Sequence[tuple[SurfaceEntry, Array]], zones: Sequence[str], on_page: Any
) -> None:
    for number, zone in enumerate(zones):
        bounds = [cut for surface, cut in cuts if _facing(surface, zone)]
        if len(bounds) < 2:
            continue
        ends = np.vstack(bounds)
        centre = ends.mean(axis=0)
        order = np.argsort(np.arctan2(ends[:, 1] - centre[1], ends[:, 0] - centre[0]))
        outline = on_page(ends[order])
        svg.polygon(outline, f"zone zone-{number % 4}")
        x = 0.72 * float(outline[:, 0].min()) + 0.28 * float(outline[:, 0].max())
        y = _height_at(outline, x)
        # The name of a thin inclined zone is parallel to it.
        slope = math.degrees(math.atan2(_height_at(outline, x + 10.0) - y, 10.0))
        turned = f"rotate({slope:.1f} {x:.1f} {y:.1f})"
        svg.add(
            "text",
            text.plain_path(zone),
            x=x,
            y=y + 4.0,
            class_="t zone-name",
            text_anchor="middle",
            transform=turned if abs(slope) > 15.0 else "rotate(0)",
        )


def _height_at(outline: Array, x: float) -> float:
    """Middle of an outline at a horizontal place. [px]"""
    crossings = [
        float(a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]))
        for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)
        if (a[0] - x) * (b[0] - x) < 0.0
    ]
    return sum(crossings) / len(crossings) if crossings else float(outline[:, 1].mean())


def _sensor_marks(
    svg: Svg,
    cuts: Sequence[tuple[SurfaceEntry, Array]],
    sensors: Mapping[str, SensorEntry],
    on_page: Any,
    x_text: float,
) -> None:
    spots = []
    for number, info in enumerate(sensors.values(), start=1):
        spot = _spot(info.output, cuts, on_page)
        if spot is not None:
            spots.append((number, info.label or "", spot))
    spots.sort(key=lambda item: item[2][1])
    spread = 24.0
    y_first = (
        max(24.0, float(np.mean([s[2][1] for s in spots])) - 0.5 * spread * len(spots)) if spots else 0.0
    )
    for row, (number, label, (x, y)) in enumerate(spots):
        y_text = y_first + spread * row
        svg.add(
            "polyline",
            points=f"{x:.1f},{y:.1f} {x_text - 16:.1f},{y_text:.1f} {x_text - 5:.1f},{y_text:.1f}",
            class_="leader",
        )
        svg.add("circle", cx=x, cy=y, r=3.2, class_="sensor-dot")
        svg.label(x_text, y_text + 4, f"{number} {label}", "sensor-name")


def _spot(
    output: str, cuts: Sequence[tuple[SurfaceEntry, Array]], on_page: Any
) -> tuple[float, float] | None:
    """Position of an output in the section: the middle of a zone, or a position across a wall."""
    owner, _, what = output.partition(".")
    for surface, cut in cuts:
        if surface.name == owner:
            ends = on_page(cut)
            x, y = (
                ends[0] + 0.62 * (ends[1] - ends[0])
                if ends[0][0] < ends[1][0]
                else ends[1] + 0.62 * (ends[0] - ends[1])
            )
            across = on_page(cut[:1] + np.array([[0.0, 1.0]])) - ends[:1]
            up = across[0] / np.linalg.norm(across[0])
            shift = {"outside_temperature": 5.0, "inside_temperature": -5.0}.get(what, 0.0)
            outward = 1.0 if abs(ends[1][0] - ends[0][0]) > abs(ends[1][1] - ends[0][1]) else 0.0
            return float(x + shift * outward * up[0]), float(y + shift * outward * up[1])
    ends = [cut for surface, cut in cuts if _facing(surface, owner)]
    if not ends:
        return None
    x, y = on_page(np.vstack(ends).mean(axis=0)[None, :])[0]
    return float(x), float(y)


# --- layers ---------------------------------------------------------------------------------------


def layers(
    building: BuildingEntry, construction: ConstructionEntry, sensors: Mapping[str, SensorEntry]
) -> Markup:
    """Layers of a construction from outside (left) to inside; widths increase with the thickness.

    Parameters
    ----------
    building : BuildingEntry
        The building.
    construction : ConstructionEntry
        The construction.
    sensors : mapping of str to SensorEntry
        Those in surfaces of this construction
        are marked.
    """
    entries = list(construction.layers)
    thick = _thickness(entries)
    widths = _widths(thick)
    total_widths = [_widths(_thickness(c.layers)).sum() for c in building.constructions]
    # One scale for all constructions, so that thickness can be compared.
    widths = np.maximum(300.0 * widths / max([widths.sum(), *total_widths]), 15.0) if len(widths) else widths
    svg = Svg(420.0, 132.0 + 17.0 * len(entries))
    edges = 60.0 + np.concatenate([[0.0], np.cumsum(widths)])
    top, bottom = 50.0, 112.0
    for number, (layer, x0, x1) in enumerate(zip(entries, edges, edges[1:], strict=False), start=1):
        fill_of(svg, layer, (float(x0), float(x1)), (top, bottom))
        svg.label(0.5 * float(x0 + x1), bottom + 14.0, str(number), "tick", "middle")
        svg.label(60.0, bottom + 17.0 * number + 16.0, _layer_text(number, layer), "layer-name")
    sides = _neighbors(building, construction.name)
    svg.label(0.0, top + 34.0, "outside", "small")
    svg.label(0.0, 12.0, f"outside: {sides[0]}" if sides[0] else "", "tick")
    svg.label(float(edges[-1]) + 8.0, top + 34.0, "inside", "small")
    svg.label(416.0, 12.0, f"inside: {sides[1]}" if sides[1] else "", "tick", "end")
    _layer_sensors(svg, building, construction, sensors, edges, thick, top)
    return svg.markup(f"Layers of {construction.name} from outside to inside")


def _thickness(entries: Sequence[LayerEntry]) -> Array:
    return np.array([float(layer.thickness or 0.0) for layer in entries])


def _widths(thick: Array) -> Array:
    """Drawn widths before scaling: a power below one keeps thin layers visible beside thick ones."""
    widths: Array = np.maximum(thick, 2e-3) ** 0.45
    return widths


def fill_of(svg: Svg, layer: LayerEntry, across: tuple[float, float], down: tuple[float, float]) -> None:
    """Draw one layer: a rectangle with the look of its material.

    Parameters
    ----------
    svg : Svg
        Where to.
    layer : LayerEntry
        Of it, kind, conductivity and density.
    across, down : (float, float)
        Ends of the rectangle. [px]
    """
    (x0, x1), (top, bottom) = across, down
    kind = _look(layer)
    svg.add("rect", x=x0, y=top, width=x1 - x0, height=bottom - top, class_=f"layer {kind}")
    if kind == "pcm":
        _droplets(svg, x0, x1, top, bottom)
    if kind == "insulation":
        _hatch(svg, x0, x1, top, bottom)


def _look(layer: LayerEntry) -> str:
    """Style of a layer: by its kind, else by its conductivity and density."""
    kind = layer.kind
    conductivity, density = layer.conductivity, layer.density
    if kind != "solid" or not isinstance(conductivity, int | float):
        return kind
    if conductivity < 0.07:
        return "insulation"
    if conductivity > 10.0:
        return "metal"
    return "heavy" if isinstance(density, int | float) and density > 1500.0 else "board"


def _hatch(svg: Svg, x0: float, x1: float, top: float, bottom: float) -> None:
    """Zigzag across an insulating layer."""
    steps = np.arange(top, bottom + 1e-6, 0.125 * (bottom - top))
    xs = [x0 if i % 2 else x1 for i in range(len(steps))]
    svg.polyline(np.column_stack([xs, steps]), "hatch")


def _droplets(svg: Svg, x0: float, x1: float, top: float, bottom: float) -> None:
    for row, y in enumerate(np.arange(top + 7.0, bottom - 3.0, 9.0)):
        for x in np.arange(x0 + (5.0 if row % 2 else 9.5), x1 - 3.0, 9.0):
            svg.add("circle", cx=float(x), cy=float(y), r=1.9, class_="droplet")


def _layer_text(number: int, layer: LayerEntry) -> str:
    name = text.plain_path(str(layer.material or layer.name))
    if layer.kind == "resistance":
        return f"{number}  {name}, {text.with_unit(layer.resistance, 'm2 K/W')}"
    thickness = layer.thickness
    size = "" if thickness is None else f", {text.significant(1000.0 * float(thickness), 3)}\u00a0mm"
    conductivity = layer.conductivity
    pair = conductivity if isinstance(conductivity, list) else [conductivity]
    shown = "/".join(text.significant(k) for k in pair if k is not None)
    return f"{number}  {name}{size}" + (f", {shown}\u00a0{units.shown('W/(m K)')}" if shown else "")


def _neighbors(building: BuildingEntry, construction: str) -> tuple[str, str]:
    sides: tuple[list[str], list[str]] = ([], [])
    for surface in building.surfaces:
        if surface.construction == construction:
            for names, side in zip(sides, (surface.outside, surface.inside), strict=True):
                shown = text.plain_path(str(side))
                if shown not in names:
                    names.append(shown)
    return tuple(n[0] if len(n) == 1 else "" for n in sides)  # type: ignore[return-value]


def _layer_sensors(
    svg: Svg,
    building: BuildingEntry,
    construction: ConstructionEntry,
    sensors: Mapping[str, SensorEntry],
    edges: Array,
    thick: Array,
    top: float,
) -> None:
    names = {s.name for s in building.surfaces if s.construction == construction.name}
    probes = {p.name: p for p in building.probes}
    for number, info in enumerate(sensors.values(), start=1):
        owner, _, what = info.output.partition(".")
        x: float | None = None
        if owner in probes and probes[owner].surface in names:
            depths = np.concatenate([[0.0], np.cumsum(thick)])
            x = float(np.interp(probes[owner].depth, depths, edges))
        elif owner in names:
            x = _face_place(what, edges, [e.name for e in construction.layers])
        if x is not None:
            svg.line(x, top - 10.0, x, top + 26.0, "leader")
            svg.add("circle", cx=x, cy=top + 26.0, r=3.2, class_=SENSOR)
            svg.label(x, top - 13.0, str(number), "sensor-name", "middle")


def _face_place(what: str, edges: Array, names: Sequence[str]) -> float | None:
    if what == "outside_temperature":
        return float(edges[0])
    if what == "inside_temperature":
        return float(edges[-1])
    if what.startswith("interface_"):
        return float(edges[int(what.split("_")[1])])
    for k, (a, b) in enumerate(pairwise(names), start=1):
        if what == f"{a}_{b}_temperature":
            return float(edges[k])
    return None
