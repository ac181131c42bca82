"""Initial temperatures: those that are known, and linear interpolation to all others.

Inside a wall the interpolation is linear in thermal resistance, with the values of the building as described:
the steady state of a wall of constant properties between two constant temperatures.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import Discriminator, Field, Tag, model_validator

from mascarin.building.base.part import Part, fault, refuse
from mascarin.building.base.time_series import temperature_course
from mascarin.building.parts.air.schedule import schedule_channel
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.building.parts.openings.blind import Blind
from mascarin.building.parts.openings.glazing import GivenGap, Glazing, SimpleGlazing
from mascarin.building.soil.courses import behind_of, soil_of
from mascarin.errors import InputError, did_you_mean
from mascarin.physics import imposed_temperature

if TYPE_CHECKING:
    from mascarin.building.building import Building
    from mascarin.building.outputs.output import Output
    from mascarin.building.parts.envelope.surface import Side

#: Surface resistances outdoors, and to the air of a room (ISO 6946:2017, horizontal flow). [m2 K/W]
FILMS: Final = (0.04, 0.13)
#: Resistance of a filled gap between panes (ISO 6946:2017, 15 mm); panes have a small heat capacity. [m2 K/W]
_GAP: Final = 0.17
#: Least resistance of a frame without the rated surface resistances, as in the engine. [m2 K/W]
_LEAST: Final = 1e-3
#: Resistance between an open blind and the glass, as in the engine [m2 K/W].
_OPEN: Final = 1e-3
#: Resistance of an outer pane of a glazing by U and g, as in the engine [m2 K/W].
_PANE: Final = 0.004
#: Positions closer than this are the same. [m2 K/W]
_SAME: Final = 1e-9

#: Limits of the temperatures of a building. [degC]
LIMITS: Final = (-100.0, 200.0)
Degrees = Annotated[float, Field(gt=LIMITS[0], lt=LIMITS[1], strict=True)]


def _one_or_two(raw: Any) -> str:
    return "both" if isinstance(raw, list | tuple) else "one"


Faces = Annotated[
    Annotated[Degrees, Tag("one")] | Annotated[tuple[Degrees, Degrees], Tag("both")],
    Discriminator(_one_or_two),
]


class GivenStart(Part):
    """Temperatures at the start; all others are interpolated between these and their surroundings."""

    zones: dict[str, Degrees] = Field(
        default_factory=dict, description="Zone -> temperature of its air [degC]"
    )
    surfaces: dict[str, Faces] = Field(
        default_factory=dict,
        description="Surface or window -> one temperature, or [outside, inside] of its two sides [degC]",
    )
    default: Degrees | None = Field(
        None, description="Air of the zones that are not named; none: the mean of those that are [degC]"
    )

    @model_validator(mode="after")
    def _some(self) -> GivenStart:
        if not self.zones and not self.surfaces and self.default is None:
            hint = "Write zones: {room: 21}, or default: 21."
            refuse(fault(("zones",), "no temperature", "at least one", hint))
        return self


class StartError(InputError):
    """An initial state that is not possible.

    Attributes
    ----------
    place : tuple of str
        The entry with the error.
    """

    def __init__(self, location: tuple[str, ...], text: str) -> None:
        super().__init__(f"{'.'.join(location)}: {text}")
        self.place = location


@dataclass(frozen=True)
class Known:
    """Temperatures that are known at the start.

    Attributes
    ----------
    zones : mapping of str to float
        Air temperatures. [degC]
    points : mapping of str to sequence of (float, float)
        By surface or window: thermal resistance from the outside, and the temperature there.
        [m2 K/W, degC]
    default : float or None
        Air of the other zones; None: the mean of the known ones. [degC]
    words : str
        The same in words.
    """

    zones: Mapping[str, float]
    points: Mapping[str, Sequence[tuple[float, float]]]
    default: float | None = None
    words: str = ""


@dataclass(frozen=True)
class Ambient:
    """Surroundings of the building at the start.

    Attributes
    ----------
    outdoors : float
        Outdoor air. [degC]
    day : float
        Day of the year, from 0.
    columns : mapping of str to float
        Measured columns. [degC]
    """

    outdoors: float
    day: float
    columns: Mapping[str, float]


@dataclass(frozen=True)
class InitialTemperatures:
    """Temperatures at the start of a run, in the order of the engine.

    Attributes
    ----------
    cells, faces, air : tuple of float
        Of finite volumes, surfaces and zone air; those of surfaces are an initial guess only. [degC]
    words : str
        Where they come from, in words.
    """

    cells: tuple[float, ...]
    faces: tuple[float, ...]
    air: tuple[float, ...]
    words: str


@dataclass(frozen=True)
class InitialWall:
    """A surface, window or frame along its thermal resistance, from the outside.

    Attributes
    ----------
    name : str
        Name of the surface or window; empty for a frame.
    sides : tuple of Side
        Outside, inside.
    layers : tuple of (float, float)
        Thickness, 0 where it has none, and resistance. [m, m2 K/W]
    cells : tuple of float
        Positions of the finite volumes; those of soil are before the outside. [m2 K/W]
    soil : float
        Resistance of the soil behind the outside. [m2 K/W]
    """

    name: str
    sides: tuple[Side, Side]
    layers: tuple[tuple[float, float], ...]
    cells: tuple[float, ...]
    soil: float = 0.0
    edges: tuple[float, ...] = field(init=False)

    def __post_init__(self) -> None:
        """Add up the layers."""
        edges = tuple(accumulate((resistance for _, resistance in self.layers), initial=0.0))
        object.__setattr__(self, "edges", edges)

    @property
    def whole(self) -> float:
        """Resistance between the two surfaces. [m2 K/W]"""
        return self.edges[-1]

    def middle(self, layer: int) -> float:
        """Position of the middle of a layer. [m2 K/W]"""
        return 0.5 * (self.edges[layer] + self.edges[layer + 1])

    def at_depth(self, depth: float) -> float:
        """Position at a depth [m], on the outer side of a layer without thickness. [m2 K/W]"""
        resistance_before, before = 0.0, 0.0
        for thickness, resistance in self.layers:
            part = min(max((depth - before) / thickness, 0.0), 1.0) if thickness else float(before < depth)
            resistance_before, before = resistance_before + part * resistance, before + thickness
        return resistance_before


def walls(building: Building, nodes: Mapping[tuple[str, str], int]) -> list[InitialWall]:
    """All surfaces, then the windows, then their frames: the order of the engine.

    Parameters
    ----------
    building : Building
        The building.
    nodes : mapping of (str, str) to int
        Finite volumes by construction and layer.
    """
    wall_list = [_opaque(building, name, nodes) for name in building.surfaces]
    for name, window in building.windows.items():
        glass = _glazed(name, building.glazings[window.glazing], building.surfaces[window.surface].sides)
        wall_list.append(glass if window.blind is None else _behind(glass, window.blind))
    for window in building.windows.values():
        if window.frame is not None:
            resistance = max(1.0 / window.frame.u_value - sum(FILMS), _LEAST)
            wall_list.append(
                InitialWall("", building.surfaces[window.surface].sides, ((0.0, resistance),), ())
            )
    return wall_list


def _opaque(building: Building, name: str, nodes: Mapping[tuple[str, str], int]) -> InitialWall:
    surface = building.surfaces[name]
    layers: list[tuple[float, float]] = []
    soil = soil_of(building, name)
    behind = [] if soil is None else list(accumulate(soil.ladder.without_last[0]))
    cells = [-position for position in reversed(behind[:-1])]
    # The plane of heat sources is a cell of no thickness.
    planes = {source.after for source in building.heat_sources.values() if source.surface == name}
    for layer in building.constructions[surface.construction].layers:
        material = building.materials[layer.material]
        before = sum(resistance for _, resistance in layers)
        if isinstance(material, Resistance) or layer.thickness is None:
            resistance = float(getattr(material, "resistance", 0.0))
            layers.append((0.0, resistance))
        else:
            # The mean of solid and liquid: which of the two it is depends on the profile.
            both = [phase(material.conductivity, state) for state in ("solid", "liquid")]
            resistance = float(layer.thickness) / (0.5 * sum(both))
            count = nodes[surface.construction, layer.name]
            cells += [before + (i + 0.5) / count * resistance for i in range(count)]
            layers.append((float(layer.thickness), resistance))
        if layer.name in planes:
            cells.append(before + resistance)
    return InitialWall(name, surface.sides, tuple(layers), tuple(cells), behind[-1] if behind else 0.0)


def _glazed(name: str, glazing: Glazing, sides: tuple[Side, Side]) -> InitialWall:
    """Nodes of a window as in the engine: pane surfaces at gaps, and middles of panes with heat capacity."""
    if isinstance(glazing, SimpleGlazing):
        films = glazing.outside_film + glazing.inside_film
        total = float(1.0 / glazing.u_value - films)
        outer = min(_PANE, 0.25 * total)
        return InitialWall(name, sides, ((0.0, total),), (outer, total - outer))
    layers: list[tuple[float, float]] = []
    cells: list[float] = []
    for k, pane in enumerate(glazing.panes):
        before, pane_resistance = sum(r for _, r in layers), float(pane.thickness / pane.conductivity)
        last = k + 1 == len(glazing.panes)
        marks = [(0.0, k > 0), (0.5, pane.density is not None), (1.0, not last)]
        cells += [before + part * pane_resistance for part, node in marks if node]
        layers.append((float(pane.thickness), pane_resistance))
        if not last:
            gap = glazing.gaps[k]
            layers.append((0.0, 1.0 / gap.conductance if isinstance(gap, GivenGap) else _GAP))
    return InitialWall(name, sides, tuple(layers), tuple(cells))


def _behind(glass: InitialWall, blind: Blind) -> InitialWall:
    """A glazing with an open blind, whose node is the surface: that of the glass is one more node."""
    opened = (0.0, _OPEN)
    if blind.position == "outside":
        cells = (_OPEN, *(cell + _OPEN for cell in glass.cells))
        return InitialWall(glass.name, glass.sides, (opened, *glass.layers), cells)
    return InitialWall(glass.name, glass.sides, (*glass.layers, opened), (*glass.cells, glass.whole))


def given(start: GivenStart, wall_list: Sequence[InitialWall], building: Building) -> Known:
    """Known temperatures as the user gave them.

    Raises
    ------
    StartError
        A zone or surface that does not exist.
    """
    by_name = {wall.name: wall for wall in wall_list if wall.name}
    points, said = {}, []
    for section, names, existing in (
        ("zones", start.zones, building.zones),
        ("surfaces", start.surfaces, by_name),
    ):
        for name in names:
            if name not in existing:
                raise StartError(
                    ("initial", section, name),
                    f"found '{name}', expected the name of a {_SINGULAR[section]} of the building. "
                    f"{did_you_mean(name, existing)}".rstrip(),
                )
    said += [f"{name} {value:g}" for name, value in start.zones.items()]
    for name, faces in start.surfaces.items():
        outside, inside = faces if isinstance(faces, tuple) else (faces, faces)
        points[name] = ((0.0, outside), (by_name[name].whole, inside))
        said.append(f"{name} {outside:g}" + (f" to {inside:g}" if inside != outside else ""))
    if start.default is not None:
        said.append(f"{'other ' if start.zones else ''}zones {start.default:g}")
    return Known(start.zones, points, start.default, f"given: {', '.join(said)} degC")


_SINGULAR: Final = {"zones": "zone", "surfaces": "surface or window"}


def located(
    output: Output, wall_list: Sequence[InitialWall], building: Building
) -> tuple[str, float | None] | None:
    """Position of an output that is a temperature of the state: zone and None, or surface and position.

    Parameters
    ----------
    output : Output
        An output of the building.
    wall_list : sequence of InitialWall
        Its walls.
    building : Building
        The building.
    """
    if output.kind == "air_temperature" and output.zone is not None:
        return list(building.zones)[output.zone], None
    if output.kind == "sensor" and output.sensor is not None:
        sensor = list(building.sensors.values())[output.sensor]
        wall = next(wall for wall in wall_list if wall.name == sensor.surface)
        return wall.name, wall.at_depth(float(sensor.depth))
    if output.surface is None:
        return None
    wall = wall_list[output.surface]
    if output.kind == "face_temperature":
        return wall.name, wall.whole if output.side else 0.0
    if output.kind == "interface_temperature" and output.interface is not None:
        return wall.name, wall.edges[output.interface]
    if output.kind == "layer_temperature" and output.layer is not None:
        return wall.name, wall.middle(output.layer)
    return None


def profile(
    building: Building, wall_list: Sequence[InitialWall], start: Known, ambient: Ambient
) -> InitialTemperatures:
    """All temperatures from those that are known.

    Air of unknown temperature takes the default, or the mean of the others. In a wall the temperature is
    linear between the known points; a surface of unknown temperature exchanges heat with its surroundings
    over the surface resistance of ISO 6946. Towards an adiabatic surface the temperature is constant.

    Parameters
    ----------
    building : Building
        The building.
    wall_list : sequence of InitialWall
        Its walls.
    start : Known
        Known temperatures.
    ambient : Ambient
        Surroundings.

    Raises
    ------
    StartError
        There are zones, and no air temperature is known.
    """
    import numpy as np

    air = _airs(building, start)
    cells: list[float] = []
    faces: list[float] = []
    for wall in wall_list:
        # The frame of a window has no name: nothing is known of it.
        points = _points(wall, start.points.get(wall.name, ()) if wall.name else (), air, ambient)
        positions, values = zip(*points, strict=True)
        cells += np.interp(wall.cells, positions, values).tolist()
        faces += np.interp([-wall.soil, wall.whole], positions, values).tolist()
    return InitialTemperatures(
        tuple(cells), tuple(faces), tuple(air.values()), start.words + _advice(building)
    )


def _airs(building: Building, start: Known) -> dict[str, float]:
    mean = start.default
    if mean is None and start.zones:
        mean = sum(start.zones.values()) / len(start.zones)
    if mean is None and building.zones:
        raise StartError(
            ("initial",),
            f"found no air temperature in {', '.join(building.zones)}, expected that of at least "
            "one zone: add it under zones, or give a default",
        )
    return {name: float(start.zones.get(name, mean or 0.0)) for name in building.zones}


def _points(
    wall: InitialWall, inside: Sequence[tuple[float, float]], air: Mapping[str, float], ambient: Ambient
) -> list[tuple[float, float]]:
    """Positions and temperatures between which a wall is interpolated, from outside to inside."""
    points = _merged(inside)
    outer, inner = (_beside(side, air, ambient) for side in wall.sides)
    if outer is not None and not (points and points[0][0] < _SAME and not wall.soil):
        points.insert(0, (-outer[0] - wall.soil, outer[1]))
    if inner is not None and not (points and points[-1][0] > wall.whole - _SAME):
        points.append((wall.whole + inner[0], inner[1]))
    # Between two adiabatic sides only the air of the building is known.
    return points or [(0.0, sum(air.values()) / len(air) if air else ambient.outdoors)]


def _merged(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points in order; the mean of several at one position."""
    together: dict[int, list[tuple[float, float]]] = defaultdict(list)
    for point in points:
        together[round(point[0] / _SAME)].append(point)
    groups = [together[key] for key in sorted(together)]
    return [(group[0][0], sum(value for _, value in group) / len(group)) for group in groups]


def _beside(side: Side, air: Mapping[str, float], ambient: Ambient) -> tuple[float, float] | None:
    """Surface resistance of a side and the temperature behind it; None if adiabatic. [m2 K/W, degC]"""
    if side.closed:
        return None
    if side.outdoors:
        return FILMS[0], ambient.outdoors
    gives_film = side.convection is not None or (
        side.imposed is not None and side.imposed.row.gives_coefficient
    )
    film = FILMS[1] if gives_film else 0.0
    if side.zone is not None:
        return film, air[side.zone]
    if side.soil is not None:
        return film, ambient.columns[schedule_channel(behind_of(side.soil))]
    if side.ground is not None:
        ground = {name: float(getattr(side.ground, name) or 0.0) for name in type(side.ground).model_fields}
        return film, imposed_temperature("ground", ground, ambient.day, ambient.outdoors)
    if side.imposed is not None:
        numbers = {
            number.name: float(getattr(side.imposed, number.name)) for number in side.imposed.row.numbers
        }
        return film, imposed_temperature(side.imposed.kind, numbers, ambient.day, ambient.outdoors)
    if side.scheduled is not None:
        return film, ambient.columns[schedule_channel(side.scheduled)]
    if isinstance(side.measured, tuple):
        return film, ambient.columns[f"schedule {temperature_course(side.measured).name}"]
    return film, ambient.columns[str(side.measured)]


def _advice(building: Building) -> str:
    said = "; all others interpolated linearly in between"
    melts = any(isinstance(material, PhaseChangeMaterial) for material in _used(building))
    return said + ("; phase-change layers on the heating curve" if melts else "")


def _used(building: Building) -> Iterator[Any]:
    for surface in building.surfaces.values():
        for layer in building.constructions[surface.construction].layers:
            yield building.materials[layer.material]
