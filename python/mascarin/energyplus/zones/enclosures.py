"""What depends on the whole enclosure of a zone: where the sun falls, view factors of zones not convex."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from mascarin.building import Building
from mascarin.building.geometry import view_factors
from mascarin.building.parts.zone_surfaces import ZoneSurface, closed, floors, surface_names
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.geometry import Array
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.zones.zones import Zone
from mascarin.errors import InputError

#: Surfaces whose directions differ by less do not see each other [deg].
_SAME_DIRECTION: Final = 10.0
#: Area of a surface over that of all which it sees, above which it sees itself [-].
_LARGE: Final = 0.99
#: Endings of the names of shades that are reveals.
_REVEALS: Final = tuple(f"reveal_{k}" for k in range(1, 5))
_NO_CORNERS: Final = "surfaces without corners"


@reads("Building")
def describe_enclosures(context: Context, building: Building, zones: dict[str, Zone]) -> None:
    """Enter the distribution of the sun, and view factors where those from the corners do not exist.

    Parameters
    ----------
    context : Context
        The conversion; its building has no ``sun`` yet.
    building : Building
        The building as far as it is described.
    zones : dict of Zone
        Its zones.
    """
    main = context.model.one("Building")
    word = main.word("solar_distribution") if main is not None else ""
    traced = word.startswith("fullinterior")
    if main is not None and word.startswith("minimal"):
        context.section("site")["self_shading"] = False
        # Only the reveals of windows, which stand out of the plane of their wall here, shade them.
        shades = context.section("shades")
        for name in [name for name in shades if not name.endswith(_REVEALS)]:
            del shades[name]
            context.findings.no_effect(
                [main], "minimal shadowing", "nothing but reveals shades, as in EnergyPlus"
            )
    for zone in zones.values():
        zone_surfaces = building.connections.of(zone.name)
        held = context.section("zones")[zone.name]
        reason = _not_exact(zone_surfaces)
        if reason not in ("", _NO_CORNERS):
            held["view_factors"] = by_areas(zone_surfaces)
            context.findings.approximated(
                zone.item, reason, "view factors by areas, as those of EnergyPlus: some tenths of a kelvin"
            )
        if not any(item.window is not None for item in zone_surfaces):
            continue
        if traced and reason:
            context.findings.approximated(zone.item, reason, "beams fall on the floor, not where they would")
        held["sun"] = _sun(context, zone.item, zone_surfaces, traced and not reason)


def _sun(context: Context, item: IdfObject, zone_surfaces: Sequence[ZoneSurface], traced: bool) -> str:
    if traced:
        return "geometry"
    if any(floors(zone_surfaces)):
        return "floor"
    context.findings.approximated(item, "a sunlit zone without a floor", "sun falls evenly on all surfaces")
    return "area"


def _not_exact(zone_surfaces: Sequence[ZoneSurface]) -> str:
    """Why exact view factors and traced beams do not exist in a zone; empty where they do."""
    if not closed(zone_surfaces):
        return _NO_CORNERS
    outlines = {item.name: item.polygon for item in zone_surfaces if item.polygon is not None}
    try:
        view_factors(list(outlines.values()))
    except InputError as error:
        return f"a shape that is not convex or not closed ({str(error).split('; expected')[0]})"
    return ""


def by_areas(zone_surfaces: Sequence[ZoneSurface]) -> dict[str, dict[str, float]]:
    """View factors in proportion to areas, zero between surfaces of one direction.

    Scaled symmetrically until the rows sum to one and ``A_i F_ij = A_j F_ji``.

    Parameters
    ----------
    zone_surfaces : list of ZoneSurface
        Surfaces of a zone.

    Returns
    -------
    dict of str to dict of str to float
        View factors by the names of the surfaces. [-]
    """
    areas = np.array([float(item.area) for item in zone_surfaces])
    visible = _visible(zone_surfaces)
    largest = int(np.argmax(areas))
    # What faces less area than it has must see itself too; EnergyPlus does the same.
    if areas[largest] > _LARGE * float(areas @ visible[largest]):
        visible[largest, largest] = 1.0
    exchange = np.outer(areas, areas) * visible
    factors = np.ones(len(zone_surfaces))
    for _ in range(2000):
        rows = exchange @ factors
        new = np.sqrt(factors * areas / np.maximum(rows, 1e-300))
        if float(np.max(np.abs(new / factors - 1.0))) < 1e-12:
            break
        factors = new
    shares = exchange * np.outer(factors, factors) / areas[:, None]
    shares /= shares.sum(axis=1)[:, None]
    names = surface_names(zone_surfaces)
    return {
        row: {column: round(float(shares[i, j]), 9) for j, column in enumerate(names) if shares[i, j] > 0.0}
        for i, row in enumerate(names)
    }


def _visible(zone_surfaces: Sequence[ZoneSurface]) -> Array:
    """One where two surfaces may see each other, zero for one direction and for a surface itself."""
    visibility = 1.0 - np.eye(len(zone_surfaces))
    normals: list[Any] = [
        None if surface.polygon is None else surface.polygon.normal for surface in zone_surfaces
    ]
    limit = np.cos(np.radians(_SAME_DIRECTION))
    for i, first in enumerate(normals):
        for j, second in enumerate(normals[:i]):
            if first is not None and second is not None and float(first @ second) > limit:
                visibility[i, j] = visibility[j, i] = 0.0
    return np.asarray(visibility)
