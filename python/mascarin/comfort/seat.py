"""The mean radiant temperature at a seat: how much of each surface of its zone is seen from there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

import numpy as np

from mascarin.building.geometry import Polygon, open_edges, parents, plane_factor, solid_angle
from mascarin.building.geometry.flat import inside
from mascarin.building.parts.openings.window import emissivities as emissivities_of_glass
from mascarin.errors import InputError
from mascarin.physics import KELVIN, STEFAN_BOLTZMANN

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.parts.zone_surfaces import ZoneSurface

    Array = npt.NDArray[np.float64]

Point = tuple[float, float, float]
Posture = Literal["sphere", "seated", "standing"]

#: Projected areas of a person up and down, to the sides, to front and back (ISO 7726:1998, annex B).
_PROJECTED: Final[dict[str, tuple[float, float, float]]] = {
    "seated": (0.18, 0.22, 0.30),
    "standing": (0.08, 0.23, 0.35),
}
#: Least distance of a seat from a surface. [m]
_LEAST_DISTANCE: Final = 0.01
#: Part of all directions that may be without a surface. [-]
_OPEN: Final = 1e-3
_KELVIN: Final = KELVIN
#: Stefan-Boltzmann constant. [W/(m2 K4)]
_SIGMA: Final = STEFAN_BOLTZMANN
#: Names in one line of text at most.
_NAMED: Final = 6


@dataclass(frozen=True)
class SeatView:
    """What is seen from a seat.

    Attributes
    ----------
    sides : tuple of str
        Each side of a surface or window that is seen, such as ``wall.inside``.
    factors : tuple of float
        Angle factor of each; their sum is 1. [-]
    emissivities : tuple of float
        Emissivity of each; empty where surfaces are taken as black. [-]
    notes : tuple of str
        What was assumed.

    Examples
    --------
    >>> SeatView(("wall.inside",), (1.0,)).radiant(np.array([[21.0]])).round(9)
    array([21.])
    """

    sides: tuple[str, ...]
    factors: tuple[float, ...]
    emissivities: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def outputs(self) -> tuple[str, ...]:
        """Outputs of a run that `radiant` needs: temperatures, then the net long-wave radiation."""
        temperatures = tuple(f"{side}_temperature" for side in self.sides)
        return temperatures + tuple(f"{side}_longwave" for side in self.sides if self.emissivities)

    def radiant(self, values: Array) -> Array:
        """Mean radiant temperature of the radiosities, weighted by their angle factors.

        A surface of the emissivity ``e`` that gains ``q`` by long-wave radiation receives
        ``sigma T^4 + q/e``. What leaves it is ``sigma T^4 + q (1 - e)/e``.

        Parameters
        ----------
        values : ndarray, shape (..., outputs)
            Series of `outputs`. [degC, W/m2]

        Returns
        -------
        ndarray, shape (...)
            Mean radiant temperature (ISO 7726:1998, annex B). [degC]
        """
        count = len(self.sides)
        leaving = _SIGMA * (values[..., :count] + _KELVIN) ** 4
        if self.emissivities:
            emissivities = np.asarray(self.emissivities)
            leaving = leaving + values[..., count:] * (1.0 - emissivities) / emissivities
        return np.asarray((leaving @ np.asarray(self.factors) / _SIGMA) ** 0.25 - _KELVIN, dtype=np.float64)


def seen_from(
    building: Building,
    zone: str,
    position: Sequence[float],
    posture: Posture = "sphere",
    facing: float | None = None,
) -> SeatView:
    """Angle factors from a seat to the surfaces and windows of its zone.

    A small sphere sees each polygon under its solid angle. For a person they are the angle factors of small
    planes in six directions, weighted by the projected areas of the body.

    Parameters
    ----------
    building : Building
        The building.
    zone : str
        Name of the zone.
    position : (x, y, z)
        The seat, in the coordinates of the vertices. [m]
    posture : str
        ``sphere``, ``seated`` or ``standing``.
    facing : float, optional
        Direction in which the person looks, clockwise from north; none: each of four directions alike. [deg]

    Returns
    -------
    SeatView
        The temperatures that are seen, and their weights.

    Raises
    ------
    InputError
        There is no such zone, a surface of it has no vertices, the surfaces do not surround the seat, or one
        hides a part of the room.

    References
    ----------
    ISO 7726:1998, annex B; Van Oosterom & Strackee 1983, doi:10.1109/TBME.1983.325207.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import FOLDER
    >>> house = mc.load(FOLDER / "reunion_house" / "building.yaml")
    >>> view = seen_from(house, "living", (3.0, 0.5, 0.6))
    >>> round(view.factors[view.sides.index("jalousie_living_south.inside")], 3)
    0.085
    """
    if zone not in building.zones:
        raise InputError(f"zone: found '{zone}'; expected one of {', '.join(building.zones)}")
    faces, said = _faces(building, zone)
    polygons = [polygon for _, polygon in faces]
    point = (float(position[0]), float(position[1]), float(position[2]))
    _require_distance(zone, polygons, point)
    _require_surrounded(zone, polygons, point)
    gross = np.array([_factor(outline, point, posture, facing) for outline in polygons])
    factors = gross.copy()
    for k, parent in enumerate(parents(polygons)):
        if parent is not None:
            factors[parent] -= gross[k]
    # What is missing between polygons that meet within their tolerance is shared out.
    factors = np.maximum(factors, 0.0) / np.maximum(factors, 0.0).sum()
    emissivities, reflecting = _emissivities(building, zone, [item for item, _ in faces])
    sides = tuple(f"{item.name}.{item.side}" for item, _ in faces)
    return SeatView(sides, tuple(map(float, factors)), emissivities, (reflecting, *said))


def _faces(building: Building, zone: str) -> tuple[list[tuple[ZoneSurface, Polygon]], tuple[str, ...]]:
    """Surfaces and windows of a zone with their outlines, each once, and what is assumed of them."""
    faces: dict[str, tuple[ZoneSurface, Polygon]] = {}
    without, furniture, framed = [], [], []
    for item in building.connections.of(zone):
        if item.window is not None and item.window.frame is not None:
            framed.append(item.name)
        if item.polygon is not None:
            faces.setdefault(item.name, (item, item.polygon))
        elif item.surface is not None and item.surface.internal_mass:
            furniture.append(item.name)
        else:
            without.append(item.name)
    if without or not faces:
        raise InputError(
            f"seat: found {_listed(without) or 'no surface'} of zone '{zone}' without vertices; expected "
            "vertices of all its surfaces and windows, by which it is known what is seen from a seat. Add "
            "'vertices:' to them, or leave out 'seat:': surfaces are then weighted by area"
        )
    notes = []
    if framed:
        notes.append(f"frames radiate as their glass ({_listed(list(dict.fromkeys(framed)))})")
    if furniture:
        notes.append(f"internal mass is not seen, because it has no place ({_listed(furniture)})")
    return list(faces.values()), tuple(notes)


def _emissivities(
    building: Building, zone: str, surfaces: Sequence[ZoneSurface]
) -> tuple[tuple[float, ...], str]:
    """Emissivities, where the long-wave exchange between the surfaces is known; and what is assumed."""
    emissivities = []
    for item in surfaces:
        if item.window is not None:
            both = emissivities_of_glass(building.glazings[item.window.glazing])
            emissivities.append(float(both[item.side == "inside"]))
        elif item.surface is not None:
            side = item.surface.inside if item.side == "inside" else item.surface.outside
            emissivities.append(float(side.emissivity or 0.0))
    blinds = any(item.window is not None and item.window.blind is not None for item in surfaces)
    if building.zones[zone].longwave.kind == "none" or blinds or min(emissivities) <= 0.0:
        return (), "surfaces are taken as black"
    return tuple(emissivities), "surfaces reflect what they do not absorb (radiosities)"


def _require_distance(zone: str, polygons: Sequence[Polygon], point: Point) -> None:
    points = np.array([point])
    for polygon in polygons:
        in_plane = abs(float(polygon.height_of(points)[0])) < _LEAST_DISTANCE
        if in_plane and inside(polygon.outline, polygon.in_plane(points)[0].tolist()):
            raise InputError(
                f"seat: found {_position_text(point)}, on '{polygon.name}' of zone '{zone}'; expected a "
                f"position at least {_LEAST_DISTANCE:g} m from every surface, such as 0.6 m above the floor"
            )


def _require_surrounded(zone: str, polygons: Sequence[Polygon], point: Point) -> None:
    """Refuse a seat that the zone does not surround, and one from which a part of it is hidden."""
    full_sphere = 4.0 * math.pi
    angles = [solid_angle(polygon, point) for polygon in polygons]
    inner = [k for k, parent in enumerate(parents(polygons)) if parent is not None]
    outer = [angle for k, angle in enumerate(angles) if k not in inner]
    covered = sum(outer) / full_sphere
    corners = np.concatenate([polygon.points for polygon in polygons])
    low, high = corners.min(axis=0), corners.max(axis=0)
    beyond = bool(np.any(np.array(point) < low) or np.any(np.array(point) > high))
    if beyond or abs(covered) <= _OPEN:
        spans = ", ".join(f"{c} {a:g} to {b:g}" for c, a, b in zip("xyz", low, high, strict=True))
        raise InputError(
            f"seat: found {_position_text(point)}, outside of zone '{zone}'; expected a position between its "
            f"surfaces ({spans} m), in the coordinates of the vertices"
        )
    if abs(covered - 1.0) > _OPEN:
        gap = next((f"; the first open edge is that of {edge}" for edge in open_edges(polygons)), "")
        raise InputError(
            f"seat: found surfaces of zone '{zone}' in {100.0 * covered:.1f} % of all directions from "
            f"{_position_text(point)}: {(1.0 - covered) * full_sphere:.2f} of {full_sphere:.2f} sr are open; "
            f"expected a closed zone{gap}. Correct the vertices, or leave out 'seat:'"
        )
    behind = [
        polygon.name for polygon, angle in zip(polygons, angles, strict=True) if angle < -_OPEN * full_sphere
    ]
    if behind:
        raise InputError(
            f"seat: found '{behind[0]}' of zone '{zone}' seen from behind from "
            f"{_position_text(point)}: it hides a part of the room; expected a seat "
            "from which the whole room is seen. Choose another position, "
            "or leave out 'seat:'"
        )


def _factor(polygon: Polygon, point: Point, posture: Posture, facing: float | None) -> float:
    """Angle factor from a sphere or a person to a polygon, with the polygons in it."""
    if posture == "sphere":
        return solid_angle(polygon, point) / (4.0 * math.pi)
    level, side, front = _PROJECTED[posture]
    if facing is None:
        side = front = 0.5 * (side + front)
    angle = math.radians(facing or 0.0)
    ahead, right = (math.sin(angle), math.cos(angle), 0.0), (math.cos(angle), -math.sin(angle), 0.0)
    up = (0.0, 0.0, 1.0)
    total = 0.0
    for weight, (x, y, z) in ((level, up), (side, right), (front, ahead)):
        total += weight * plane_factor(polygon, point, (x, y, z))
        total += weight * plane_factor(polygon, point, (-x, -y, -z))
    return total / (2.0 * (level + side + front))


def _position_text(point: Point) -> str:
    return "[" + ", ".join(f"{c:g}" for c in point) + "]"


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(names[:_NAMED]) + more
