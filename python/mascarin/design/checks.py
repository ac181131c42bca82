"""What an objective names must be in the building."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building import Building


def require_zone(building: Building, zone: str) -> None:
    """Refuse a zone that the building does not have.

    Raises
    ------
    InputError
        Naming the zones.
    """
    if zone not in building.zones:
        raise InputError(
            f"found the zone '{zone}', expected one of {', '.join(building.zones)}. "
            f"{did_you_mean(zone, building.zones)}".rstrip()
        )


def require_layer(building: Building, layer: str, *, melts: bool) -> None:
    """Refuse a layer that is not there, and one that does not melt where this is needed.

    Raises
    ------
    InputError
        Naming surfaces or layers.
    """
    surface, _, name = layer.partition(".")
    if surface not in building.surfaces or not name:
        raise InputError(
            f"found '{layer}', expected SURFACE.LAYER with one of the surfaces "
            f"{', '.join(building.surfaces)}. "
            f"{did_you_mean(surface, building.surfaces)}".rstrip()
        )
    construction = building.surfaces[surface].construction
    found = {one.name: one for one in building.constructions[construction].layers}
    if name not in found:
        raise InputError(
            f"found '{layer}', but construction '{construction}' of this surface has the layers "
            f"{', '.join(map(str, found))}; expected one of them. "
            f"{did_you_mean(name, list(map(str, found)))}".rstrip()
        )
    material = building.materials[found[name].material]
    if melts and material.kind != "pcm":
        raise InputError(
            f"found '{layer}' of kind '{material.kind}', expected a phase-change material (kind: pcm)"
        )
    if material.kind == "resistance":
        raise InputError(f"found '{layer}', a resistance without mass, expected a layer with a density")
