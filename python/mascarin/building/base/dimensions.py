"""Dimensions to which areas and transmittances of thermal bridges belong."""

from __future__ import annotations

from typing import Final, Literal

from pydantic import Field

from mascarin.building.base.part import Part

#: Systems of dimensions of EN ISO 13789: between the inner faces of each room; the same, with the partitions
#: of the rooms; between the outer faces of the building.
System = Literal["internal", "overall_internal", "external"]

SOURCE: Final = "EN ISO 13789:2017, annex B; EN ISO 10211:2017 (dimensions of areas and of psi values)"

#: The systems, without those of a bridge that is the same in all.
SYSTEMS: Final[tuple[System, ...]] = ("internal", "overall_internal", "external")


class Dimensions(Part):
    """Dimensions of the areas of a building and of its thermal bridges, where they do not state their own.

    Edges count once only where both belong together: external areas contain the corners, for which external
    psi values are small or negative; internal areas leave them out, and internal psi values contain them.

    Examples
    --------
    >>> Dimensions(areas="external", bridges="external")
    Dimensions(areas=external, bridges=external)
    """

    areas: System = Field(
        description="Areas of surfaces: internal (between the inner faces of each room), overall_internal "
        "(with the partitions, or to their middle), external (between the outer faces of the building)"
    )
    bridges: System | None = Field(
        None, description="Dimensions that psi and chi belong to; none: each bridge states its own"
    )
