"""Film coefficients of a face: which correlation, with which numbers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mascarin.building import quantities as q
from mascarin.building.number import Number, Remark
from mascarin.building.part import Part, Shorthand

_AS_PUBLISHED = Remark("the correlation as published")


class Constant(Part):
    """A constant film coefficient."""

    kind: Literal["constant"] = "constant"
    coefficient: q.Film


class LinearWind(Part):
    """``constant + wind V``, V the wind speed at the face."""

    kind: Literal["linear_wind"] = "linear_wind"
    constant: q.Film
    wind: q.FilmPerSpeed


class AlamdariHammond(Part):
    """Buoyant convection by orientation and direction of heat flow (Alamdari & Hammond 1983)."""

    kind: Literal["alamdari_hammond"] = "alamdari_hammond"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class PaperEq5(Part):
    """Eq. 5 of Guichard et al. as it is printed there."""

    kind: Literal["paper_eq5"] = "paper_eq5"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class Tarp(Part):
    """TARP (Walton 1983): buoyant part, and outdoors a forced part by roughness and perimeter."""

    kind: Literal["tarp"] = "tarp"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)
    roughness: q.Roughness | None = None
    perimeter: q.Perimeter | None = None


class Mowitt(Part):
    """MoWiTT (Yazdanian & Klems 1994), for smooth faces outdoors."""

    kind: Literal["mowitt"] = "mowitt"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class Doe2(Part):
    """DOE-2: TARP's buoyant part, and MoWiTT's wind on faces of any roughness, outdoors."""

    kind: Literal["doe2"] = "doe2"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)
    roughness: q.Roughness | None = None


class Iso15099(Part):
    """Free convection at the room's face of a glazing, by its height and tilt (ISO 15099:2003)."""

    kind: Literal["iso15099"] = "iso15099"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class PowerLaw(Part):
    """``a + b |dT|^n + c V^m`` for one direction of heat flow."""

    a: q.PowerConstant = Number(0.0, source=Remark("not written: no constant part"))
    b: q.PowerBuoyant = Number(0.0, source=Remark("not written: no buoyant part"))
    n: q.PowerExponent = Number(1.0 / 3.0, source=Remark("turbulent free convection"))
    c: q.PowerForced = Number(0.0, source=Remark("not written: no forced part"))
    m: q.PowerWindExponent = Number(0.8, source=Remark("turbulent flow along a plate"))


class Power(Part):
    """A power law for each direction of heat flow."""

    kind: Literal["power"] = "power"
    upward: PowerLaw = Field(description="Heat flows up, or the face is vertical")
    downward: PowerLaw = Field(description="Heat flows down")


Convection = Annotated[
    Constant | LinearWind | AlamdariHammond | PaperEq5 | Tarp | Mowitt | Doe2 | Iso15099 | Power,
    Field(discriminator="kind"),
    Shorthand(word="kind", number="coefficient", kind="constant"),
]

#: Where the correlations come from.
SOURCES = {
    "alamdari_hammond": "Alamdari & Hammond 1983, doi:10.1177/014362448300400304",
    "paper_eq5": "Guichard et al. 2016, doi:10.3390/en9010009, eq. 5 as printed",
    "tarp": "Walton 1983, Thermal Analysis Research Program Reference Manual, NBSIR 83-2655",
    "mowitt": "Yazdanian & Klems 1994, ASHRAE Transactions 100(1)",
    "doe2": "LBL 1994, DOE2.1E-053 source code; EnergyPlus Engineering Reference, outside convection",
    "iso15099": "ISO 15099:2003, 8.3.2.2: convection indoors",
}
