"""What an objective names must be in the building."""

from __future__ import annotations

from collections.abc import Sequence
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
            f"{did_you_mean(zone, building.zones, known=False)}".rstrip()
        )


def require_no_columns(building: Building) -> None:
    """Refuse a building that is driven by measured columns: weather files have none.

    Raises
    ------
    InputError
        Naming the columns.
    """
    from mascarin.building.engine_input import measured_columns

    columns = measured_columns(building)
    if columns:
        raise InputError(
            f"found the measured columns {', '.join(columns)}, expected numbers and schedules: designs are "
            "compared in weather files, which have no measurements of a building. Write a building that "
            "extends this one, with numbers or schedules in their place"
        )


def is_dried(building: Building, zone: str) -> bool:
    """Whether a zone has ideal drying, whose latent heat is a load."""
    return building.humidity is not None and building.humidity.zones[zone].drying is not None


def require_same_basis(basis: Sequence[object], other_basis: Sequence[object]) -> None:
    """Refuse designs of which only some are dried, or whose seats see different surfaces.

    Their latent heat would count in a part of them, and all designs have the angle factors of the first.

    Parameters
    ----------
    basis, other_basis : sequence
        What an objective reads of two designs: names of outputs, and views from seats.

    Raises
    ------
    InputError
        Naming the loads that are not in both.
    """
    different = {str(name) for name in {*basis} ^ {*other_basis} if isinstance(name, str)}
    if not different and tuple(basis) != tuple(other_basis):
        raise InputError(
            "found a seat that sees the surfaces of the designs differently; expected the same vertices and "
            "emissivities of the zone in all designs and samples. Remove 'seat:', or make a study of each"
        )
    if different and not all(name.endswith("latent_cooling_load") for name in different):
        raise InputError(
            f"found designs with and without {', '.join(sorted(different))}; expected outputs that all of "
            "them have. Remove 'seat:', or make a study of each shape"
        )
    if different:
        raise InputError(
            f"found designs with and without {', '.join(sorted(different))}; expected drying in all of "
            "them or in none. Give it to all, with 'schedule:' of a schedule that is 0 where there is none"
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
            f"{did_you_mean(surface, building.surfaces, known=False)}".rstrip()
        )
    construction = building.surfaces[surface].construction
    layers = {entry.name: entry for entry in building.constructions[construction].layers}
    if name not in layers:
        raise InputError(
            f"found '{layer}', but construction '{construction}' of this surface has the layers "
            f"{', '.join(map(str, layers))}; expected one of them. "
            f"{did_you_mean(name, list(map(str, layers)), known=False)}".rstrip()
        )
    material = building.materials[layers[name].material]
    if melts and material.kind != "pcm":
        raise InputError(
            f"found '{layer}' of kind '{material.kind}', expected a phase-change material (kind: pcm)"
        )
    if material.kind == "resistance":
        raise InputError(f"found '{layer}', a resistance without mass, expected a layer with a density")
