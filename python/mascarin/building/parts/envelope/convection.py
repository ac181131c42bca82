"""Surface heat transfer coefficients: constants and correlations."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mascarin.building import quantities as q
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.parts.envelope.formula_law import FormulaLaw

_AS_PUBLISHED = Remark("the correlation as published")


class Constant(Part):
    """A constant surface heat transfer coefficient.

    Examples
    --------
    >>> Constant(coefficient=8)
    Constant(coefficient=8 W/(m2 K))
    """

    kind: Literal["constant"] = "constant"
    coefficient: q.HeatTransferCoefficient


class Measured(Part):
    """A surface heat transfer coefficient from a measured column [W/(m2 K)], times a factor.

    Examples
    --------
    >>> Measured(column="h_wall")
    Measured(column=h_wall, factor=1)
    """

    kind: Literal["measured"] = "measured"
    column: str = Field(description="Name of a measured column [W/(m2 K)], not below 0")
    factor: q.ConvectionFactor = Number(1.0, source=Remark("the measurement without a correction"))


class LinearWind(Part):
    """``constant + wind V``, with the wind speed V at the surface.

    Examples
    --------
    >>> LinearWind(constant=11.4, wind=5.7)
    LinearWind(constant=11.4 W/(m2 K), wind=5.7 W/(m2 K)/(m/s))
    """

    kind: Literal["linear_wind"] = "linear_wind"
    constant: q.HeatTransferCoefficient
    wind: q.HeatTransferCoefficientPerSpeed


class AlamdariHammond(Part):
    """Buoyant convection by orientation and direction of heat flow (Alamdari & Hammond 1983).

    Examples
    --------
    >>> AlamdariHammond(factor=1.1)
    AlamdariHammond(factor=1.1)
    """

    kind: Literal["alamdari_hammond"] = "alamdari_hammond"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class PaperEq5(Part):
    """Equation 5 of Guichard et al. 2016 as printed.

    Examples
    --------
    >>> PaperEq5()
    PaperEq5(factor=1)
    """

    kind: Literal["paper_eq5"] = "paper_eq5"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class Tarp(Part):
    """TARP (Walton 1983): buoyant part, and outdoors a forced part by roughness and perimeter.

    Examples
    --------
    >>> Tarp(roughness="smooth").roughness
    1.11
    """

    kind: Literal["tarp"] = "tarp"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)
    roughness: q.Roughness | None = None
    perimeter: q.Perimeter | None = None


class Mowitt(Part):
    """MoWiTT (Yazdanian & Klems 1994), for smooth surfaces outdoors.

    Examples
    --------
    >>> Mowitt(factor=0.9)
    Mowitt(factor=0.9)
    """

    kind: Literal["mowitt"] = "mowitt"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class Doe2(Part):
    """DOE-2: the buoyant part of TARP and the wind of MoWiTT on surfaces of any roughness, outdoors.

    Examples
    --------
    >>> Doe2(roughness="rough")
    Doe2(factor=1, roughness=1.67)
    """

    kind: Literal["doe2"] = "doe2"
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)
    roughness: q.Roughness | None = None


class Iso15099(Part):
    """Free convection on the room side of a glazing, by its height and tilt (ISO 15099:2003).

    Examples
    --------
    >>> Iso15099()
    Iso15099(factor=1)
    """

    kind: Literal["iso15099"] = "iso15099"
    length: q.ConvectionLength | None = None
    factor: q.ConvectionFactor = Number(1.0, source=_AS_PUBLISHED)


class PowerLaw(Part):
    """``a + b |dT|^n + c V^m`` for one direction of heat flow.

    Examples
    --------
    >>> PowerLaw(b=1.5, n=0.33)
    PowerLaw(a=0 W/(m2 K), b=1.5 W/(m2 K^(n+1)), n=0.33, c=0 W/(m2 K (m/s)^m), m=0.8)
    """

    a: q.PowerConstant = Number(0.0, source=Remark("not given: no constant part"))
    b: q.PowerBuoyant = Number(0.0, source=Remark("not given: no buoyant part"))
    n: q.PowerExponent = Number(1.0 / 3.0, source=Remark("turbulent free convection"))
    c: q.PowerForced = Number(0.0, source=Remark("not given: no forced part"))
    m: q.PowerWindExponent = Number(0.8, source=Remark("turbulent flow along a plate"))


class Power(Part):
    """A power law for each direction of heat flow.

    Examples
    --------
    >>> Power(upward={"b": 1.5}, downward={"b": 0.6, "n": 0.25})
    Power(upward=PowerLaw, downward=PowerLaw)
    """

    kind: Literal["power"] = "power"
    upward: PowerLaw = Field(description="Heat flows up, or the surface is vertical")
    downward: PowerLaw = Field(description="Heat flows down")


Convection = Annotated[
    Constant
    | LinearWind
    | AlamdariHammond
    | PaperEq5
    | Tarp
    | Mowitt
    | Doe2
    | Iso15099
    | Power
    | Measured
    | FormulaLaw,
    Field(discriminator="kind"),
    Shorthand(word="kind", number="coefficient", kind="constant", implied=("formula", "text")),
]


def measured_column(convection: Convection | None) -> str | None:
    """Column of a measured coefficient; None for any other."""
    return convection.column if isinstance(convection, Measured) else None


def by_wind_direction(convection: Convection | None) -> bool:
    """Whether a coefficient depends on the direction of the wind."""
    if isinstance(convection, FormulaLaw):
        return convection.uses("windward")
    return isinstance(convection, Tarp | Mowitt | Doe2)


#: Description of the fields that hold a coefficient.
CONVECTION = "Surface heat transfer coefficient: a number [W/(m2 K)], or a correlation"

#: Sources of the correlations.
SOURCES = {
    "alamdari_hammond": "Alamdari & Hammond 1983, doi:10.1177/014362448300400304",
    "paper_eq5": "Guichard et al. 2016, doi:10.3390/en9010009, eq. 5 as printed",
    "tarp": "Walton 1983, Thermal Analysis Research Program Reference Manual, NBSIR 83-2655",
    "mowitt": "Yazdanian & Klems 1994, ASHRAE Transactions 100(1)",
    "doe2": "LBL 1994, DOE2.1E-053 source code; EnergyPlus Engineering Reference, outside convection",
    "iso15099": "ISO 15099:2003, 8.3.2.2: convection indoors",
}
