"""Which air a volume flow is a volume of."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mascarin.building import quantities as q
from mascarin.building.base.part import Part, Shorthand


class SiteDensity(Part):
    """The density of the site: that of ``site.air_density``, or of the altitude at 15 degC.

    Examples
    --------
    >>> SiteDensity().kind
    'site'
    """

    kind: Literal["site"] = "site"

    @property
    def words(self) -> str:
        """Whose density it is, in words."""
        return "the air of the site"


class OutdoorDensity(Part):
    """The density of the outdoor air of the moment, ``P/(R T (1 + 1.6078 W))``.

    Examples
    --------
    >>> OutdoorDensity().words
    'the outdoor air'
    """

    kind: Literal["outdoors"] = "outdoors"

    @property
    def words(self) -> str:
        """Whose density it is, in words."""
        return "the outdoor air"


class ZoneDensity(Part):
    """The density of the air of the zone that the flow enters or leaves, at the start of a step.

    Examples
    --------
    >>> ZoneDensity().words
    'the air of the zone'
    """

    kind: Literal["zone"] = "zone"

    @property
    def words(self) -> str:
        """Whose density it is, in words."""
        return "the air of the zone"


class ConstantDensity(Part):
    """One density at all times, such as the 1.2 kg/m3 of the standard air of fans.

    Examples
    --------
    >>> ConstantDensity(constant=1.2).words
    'air of 1.2 kg/m3'
    """

    kind: Literal["constant"] = "constant"
    constant: q.FlowDensity

    @property
    def words(self) -> str:
        """Whose density it is, in words."""
        return f"air of {self.constant:g} kg/m3"


FlowDensity = Annotated[
    SiteDensity | OutdoorDensity | ZoneDensity | ConstantDensity,
    Field(discriminator="kind"),
    Shorthand(word="kind", number="constant", kind="constant"),
]

#: What the key says, in all parts that have it.
DENSITY = (
    "Air that the flow is a volume of: site, outdoors, zone, or a density [kg/m3]; none: that of the site"
)
