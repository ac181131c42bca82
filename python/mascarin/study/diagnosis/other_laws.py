"""Other forms of a model: each replaces one law of a building by another published one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from mascarin.building.base.law_table import CONVECTION, DIFFUSE, SKY
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building

#: In a building with more surfaces only those of sensors are changed alone, and all others together.
_MAX_SURFACES: Final = 14


def forms(building: Building, measured_surfaces: set[str]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Other choices of a law, one at a time.

    Parameters
    ----------
    building : Building
        As described.
    measured_surfaces : set of str
        Surfaces with a sensor.

    Yields
    ------
    tuple of str, str and dict
        The part that is replaced, its new kind, and the changes as `Building.replace` takes them.
    """
    site = building.site
    for kind, row in SKY.items():
        if row.alternatives and site.sky.kind not in (kind, "measured"):
            yield "site.sky", kind, {"site.sky": kind}
    for kind, row in DIFFUSE.items():
        if row.alternatives and site.diffuse != kind:
            yield "site.diffuse", kind, {"site.diffuse": kind}
    sides = list(_sides(building))
    alone = len(building.surfaces) <= _MAX_SURFACES
    together: dict[tuple[str, str], dict[str, Any]] = {}
    for name, side, now, kinds in sides:
        part = f"surfaces.{name}.{side}.convection"
        for kind, value in kinds:
            if kind == now:
                continue
            if alone or name in measured_surfaces:
                yield part, kind, {part: value}
            else:
                together.setdefault((side, kind), {})[part] = value
    for (side, kind), changes in together.items():
        yield f"surfaces.*.{side}.convection", kind, changes


def _sides(building: Building) -> Iterator[tuple[str, str, str, tuple[tuple[str, Any], ...]]]:
    """Sides with a coefficient: surface, side, kind, and the kinds that are possible there."""
    for name, surface in building.surfaces.items():
        for word, side in (("outside", surface.outside), ("inside", surface.inside)):
            if side.convection is None or side.convection.kind == "measured":
                continue
            if side.outdoors or side.zone is not None:
                yield name, word, side.convection.kind, _alternatives(bool(side.outdoors))


def _alternatives(outdoors: bool) -> tuple[tuple[str, Any], ...]:
    """Published laws of convection outdoors, or in a zone: kind, and what a description has of it."""
    return tuple(
        (kind, {"kind": kind, **numbers} if numbers else kind)
        for kind, row in CONVECTION.items()
        for outside, numbers in row.alternatives
        if outside == outdoors
    )


def changed(building: Building, changes: dict[str, Any]) -> Building | None:
    """The building with another form; None where the building does not allow it."""
    try:
        return building.replace(changes)
    except InputError:
        return None
