"""Glazings: panes with gaps between them, or a unit by its rated values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Pair, Part, derived_number, fault, insist
from mascarin.physics import STANDARD_PRESSURE

ISO_15099 = "ISO 15099:2003, 5.3 and annex B"
_FIT = "Karlsson & Roos 2000, doi:10.1016/S0038-092X(00)00083-9"
_RATED = "ISO 10292:1994 and EN 673"
#: Largest deviation from one of the sum of transmittance, reflectance and absorptance: by the rounding of a
#: table, and for hemispherical values by the few angles they are integrated from [-].
SUM_LIMIT, DIFFUSE_LIMIT = 0.006, 0.015
#: Units above the first U value usually have one pane, below the second three [W/(m2 K)].
_SINGLE, _TRIPLE = 3.9, 0.9


class TwoSides(Pair):
    """A property of the outer and of the inner side of a pane; short form ``[outside, inside]``."""


class PaneEmissivities(TwoSides):
    """Long-wave emissivity of the outer and of the inner side; short form ``[outside, inside]``."""

    outside: q.Emissivity
    inside: q.Emissivity


class PaneReflectances(TwoSides):
    """Solar reflectance of a coated pane from outside and from inside; short form ``[outside, inside]``."""

    outside: q.Reflectance
    inside: q.Reflectance


def _one_or_two(raw: Any) -> str:
    pair = isinstance(raw, list | tuple | TwoSides) or (isinstance(raw, Mapping) and "value" not in raw)
    return "faces" if pair else "both"


_EITHER = Discriminator(_one_or_two)
EmissivityBySide = Annotated[
    Annotated[q.Emissivity, Tag("both")] | Annotated[PaneEmissivities, Tag("faces")], _EITHER
]
ReflectanceBySide = Annotated[
    Annotated[q.Reflectance, Tag("both")] | Annotated[PaneReflectances, Tag("faces")], _EITHER
]


class Pane(Part):
    """A pane, opaque to long-wave radiation.

    Its solar optics at normal incidence are needed unless the glazing has a table (`Angular`). One
    reflectance means plain glass, which behaves as a homogeneous plate at other angles; two mean a coating. A
    pane without density and specific heat has no heat capacity.

    Examples
    --------
    >>> clear = Pane(thickness=0.004, emissivity=0.84, transmittance=0.83, reflectance=0.08)
    >>> float(clear.conductivity)
    1.0
    """

    thickness: q.PaneThickness
    conductivity: q.Conductivity = Number(1.0, source="EN 673:2011, soda-lime glass")
    emissivity: EmissivityBySide = Field(description="One value, or [outside, inside]")
    transmittance: q.Transmittance | None = None
    reflectance: ReflectanceBySide | None = Field(
        None, description="One value for plain glass, or [outside, inside] for coated glass"
    )
    density: q.Density | None = None
    specific_heat: q.SpecificHeat | None = None

    @model_validator(mode="after")
    def _sound(self) -> Pane:
        pairs = (("transmittance", "reflectance"), ("density", "specific_heat"))
        insist(*(error for pair in pairs for error in self._together(*pair)), *self._optics())
        return self

    def _together(self, first: str, second: str) -> Iterator[InitErrorDetails]:
        stated = [key for key in (first, second) if getattr(self, key) is not None]
        if len(stated) == 1:
            missing = second if stated == [first] else first
            yield fault(
                (missing,),
                "nothing",
                f"{missing} beside {stated[0]}",
                f"Add '{missing}:' or remove the other.",
            )

    def _optics(self) -> Iterator[InitErrorDetails]:
        if self.transmittance is None or self.reflectance is None:
            return
        for reflectance in both(self.reflectance):
            total = self.transmittance + reflectance
            if total > 1.0:
                yield fault(
                    ("reflectance",),
                    f"transmittance {self.transmittance:g} and reflectance {reflectance:g}, sum {total:g}",
                    "a sum of at most 1: the rest is absorbed",
                    "Correct one of them.",
                )


def both(value: Any) -> tuple[float, float]:
    """Values of the outer and of the inner side."""
    if isinstance(value, PaneEmissivities | PaneReflectances):
        return (value.outside, value.inside)
    return (value, value)


class FilledGap(Part):
    """A gap filled with gas: convection by ISO 15099, long-wave radiation between gray panes.

    Examples
    --------
    >>> FilledGap(thickness=0.016, gas="argon")
    FilledGap(thickness=0.016 m, gas=argon, pressure=101325 Pa)
    """

    thickness: q.GapThickness
    gas: Literal["air", "argon", "krypton", "xenon"] = Field("air", description="Gas in the gap")
    pressure: q.GapPressure = Number(STANDARD_PRESSURE, source=f"{ISO_15099}: sealed at sea level")


class GivenGap(Part):
    """A gap of known conductance, by convection and radiation together.

    Examples
    --------
    >>> GivenGap(conductance=5)
    GivenGap(conductance=5 W/(m2 K))
    """

    conductance: q.GapConductance


def _gap_kind(raw: Any) -> str:
    is_stated = "conductance" in raw if isinstance(raw, Mapping) else isinstance(raw, GivenGap)
    return "given" if is_stated else "filled"


Gap = Annotated[
    Annotated[FilledGap, Tag("filled")] | Annotated[GivenGap, Tag("given")], Discriminator(_gap_kind)
]


class DiffuseOptics(Part):
    """Optics of a glazing for diffuse solar radiation from outside or from inside.

    Examples
    --------
    >>> DiffuseOptics(transmittance=0.7, absorptance=[0.1])
    DiffuseOptics(transmittance=0.7, absorptance=[0.1])
    """

    transmittance: q.CurveOptic
    reflectance: q.CurveOptic | None = None
    absorptance: tuple[q.CurveOptic, ...] = Field(description="Of each pane, outside to inside")


class Angular(Part):
    """Optics of a glazing over the angle of incidence, for solar radiation from outside.

    Examples
    --------
    >>> Angular(angles=[0, 90], transmittance=[0.8, 0], absorptance=[[0.1, 0]])
    Angular(angles=[0 deg, 90 deg], transmittance=[0.8, 0], absorptance=[[0.1, 0]], transmittance_sc...)
    """

    angles: tuple[q.CurveAngle, ...] = Field(description="Rising from 0 to 90")
    transmittance: tuple[q.CurveOptic, ...] = Field(description="At each angle")
    reflectance: tuple[q.CurveOptic, ...] | None = Field(None, description="At each angle; a check only")
    absorptance: tuple[tuple[q.CurveOptic, ...], ...] = Field(
        description="Of each pane, outside to inside: one list for each pane, a value at each angle"
    )
    diffuse: DiffuseOptics | None = Field(None, description="Hemispherical values; none: integrated")
    back: DiffuseOptics | None = Field(
        None,
        description="Hemispherical values from inside; none: those from outside, panes reversed",
    )
    transmittance_scale: q.OpticScale = Number(1.0, source=Remark("the table without a correction"))
    absorptance_scale: q.OpticScale = Number(1.0, source=Remark("the table without a correction"))

    @model_validator(mode="after")
    def _sound(self) -> Angular:
        angles = list(self.angles)
        if len(angles) < 2 or angles[0] != 0.0 or angles[-1] != 90.0 or sorted(set(angles)) != angles:
            insist(
                fault(
                    ("angles",),
                    f"angles {', '.join(f'{angle:g}' for angle in angles)}",
                    "angles that rise from 0 to 90 deg",
                    "At 90 deg transmittance and absorptance are 0.",
                )
            )
        lengths = {"transmittance": len(self.transmittance)}
        lengths |= {"reflectance": len(self.reflectance)} if self.reflectance is not None else {}
        lengths |= {f"absorptance of pane {k}": len(pane) for k, pane in enumerate(self.absorptance, start=1)}
        insist(
            *(
                fault(
                    (key.split()[0],),
                    f"{count} values of {key}",
                    f"{len(angles)}: one for each angle",
                    "Complete the list.",
                )
                for key, count in lengths.items()
                if count != len(angles)
            )
        )
        insist(*self._sums())
        return self

    def _sums(self) -> Iterator[InitErrorDetails]:
        rows = [
            (f"at {angle:g} deg", self.transmittance[k], sum(pane[k] for pane in self.absorptance))
            for k, angle in enumerate(self.angles)
        ]
        reflected = list(self.reflectance or [None] * len(rows))
        if self.diffuse is not None:
            rows.append(("diffuse", self.diffuse.transmittance, sum(self.diffuse.absorptance)))
            reflected.append(self.diffuse.reflectance)
        if self.back is not None:
            rows.append(("diffuse, from inside", self.back.transmittance, sum(self.back.absorptance)))
            reflected.append(self.back.reflectance)
        for (where, through, absorbed), back in zip(rows, reflected, strict=True):
            total = through + absorbed + (back or 0.0)
            limit = DIFFUSE_LIMIT if where.startswith("diffuse") else SUM_LIMIT
            if total > 1.0 + limit or (back is not None and total < 1.0 - limit):
                yield fault(
                    ("transmittance",),
                    f"a sum of {total:.3f} ({where})",
                    "transmittance, reflectance and absorptance that sum to 1",
                    "Check the row.",
                )


class PaneGlazing(Part):
    """A glazing by its panes and the gaps between them, outside to inside.

    Examples
    --------
    >>> clear = Pane(thickness=0.004, emissivity=0.84, transmittance=0.83, reflectance=0.08)
    >>> double = PaneGlazing(panes=[clear, clear], gaps=[FilledGap(thickness=0.016, gas="argon")])
    >>> round(1 / (0.17 + glazing_resistance(double)), 2)
    2.58
    """

    kind: Literal["panes"] = "panes"
    panes: tuple[Pane, ...] = Field(description="Outside to inside")
    gaps: tuple[Gap, ...] = Field((), description="Between the panes, outside to inside")
    angular: Angular | None = Field(
        None, description="Optics of the whole glazing; none: calculated from those of the panes"
    )
    source: str | None = Field(None, description="Where the properties come from")

    @model_validator(mode="after")
    def _sound(self) -> PaneGlazing:
        insist(*self._counts(), *self._optics())
        return self

    def _counts(self) -> Iterator[InitErrorDetails]:
        if not self.panes:
            yield fault(("panes",), "no panes", "at least one pane", "List them from outside to inside.")
        elif len(self.gaps) != len(self.panes) - 1:
            yield fault(
                ("gaps",),
                f"{len(self.gaps)} gaps between {len(self.panes)} panes",
                f"{len(self.panes) - 1}",
                "There is one gap between two panes.",
            )
        table = self.angular
        both_ways = () if table is None else (table.diffuse, table.back)
        diffuse = (optics.absorptance if optics is not None else None for optics in both_ways)
        for absorbed in (table.absorptance if table is not None else None, *diffuse):
            if absorbed is not None and len(absorbed) != len(self.panes):
                yield fault(
                    ("angular", "absorptance"),
                    f"{len(absorbed)} absorbing panes",
                    f"{len(self.panes)}: one for each pane",
                    "Write one list (or value) for each pane, outside to inside.",
                )

    def _optics(self) -> Iterator[InitErrorDetails]:
        for index, pane in enumerate(self.panes):
            if self.angular is None and pane.transmittance is None:
                yield fault(
                    ("panes", index, "transmittance"),
                    "nothing",
                    "solar transmittance of the pane at normal incidence [-]",
                    "Add 'transmittance:' and 'reflectance:', or an 'angular:' table of the glazing.",
                )
            if self.angular is not None and pane.transmittance is not None:
                yield fault(
                    ("panes", index, "transmittance"),
                    "optics of the pane beside those of the whole glazing",
                    "one of the two",
                    "Remove 'transmittance:' and 'reflectance:', or 'angular:'.",
                )


class SimpleGlazing(Part):
    """A glazing by its rated U value and solar heat gain, represented by panes that have both.

    Without a coating the panes are of one glass. A U value that needs a coating gives clear panes with a
    coated one; its solar transmittance is estimated (Arasteh et al. 2009) unless it is given.

    Examples
    --------
    >>> float(SimpleGlazing(u_value=1.1, solar_heat_gain=0.6).panes)
    2.0
    >>> float(SimpleGlazing(u_value=5.8, solar_heat_gain=0.85).panes)
    1.0
    """

    kind: Literal["simple"] = "simple"
    u_value: q.GlazingU
    solar_heat_gain: q.SolarHeatGain
    transmittance: q.UnitTransmittance | None = None
    panes: q.PaneCount | None = None
    category: q.GlassCategory = Number(4.0, source=f"{_FIT}: clear glass without coating", assumed=True)
    outside_film: q.SurfaceResistance = Number(0.04, source=_RATED)
    inside_film: q.SurfaceResistance = Number(0.13, source=_RATED)
    emissivity: q.Emissivity = Number(0.84, source="EN 673:2011: 0.837, glass without coating")
    source: str | None = Field(None, description="Where the values come from")

    @model_validator(mode="after")
    def _resists(self) -> SimpleGlazing:
        most = 1.0 / (self.outside_film + self.inside_film)
        if self.u_value >= most:
            insist(
                fault(
                    ("u_value",),
                    f"{self.u_value:g} W/(m2 K)",
                    f"less than {most:.2f} W/(m2 K), the conductance of the rated surface resistances alone",
                    "Correct it, or describe the glazing by 'kind: panes'.",
                )
            )
        insist(*self._transmits())
        if self.panes is None:
            panes = 1.0 if self.u_value > _SINGLE else 3.0 if self.u_value < _TRIPLE else 2.0
            source = Remark("usual number for this U value")
            self._fill(panes=derived_number(SimpleGlazing, "panes", panes, source, assumed=True))
        return self

    def _transmits(self) -> Iterator[InitErrorDetails]:
        if self.transmittance is not None and self.transmittance > self.solar_heat_gain:
            yield fault(
                ("transmittance",),
                f"{self.transmittance:g}, above solar_heat_gain {self.solar_heat_gain:g}",
                "at most the solar heat gain: transmitted radiation, and absorbed radiation that enters",
                "Correct one of them. Both are of solar radiation (not of light), at normal incidence.",
            )

    @property
    def resistance(self) -> float:
        """Resistance without the surface resistances [m2 K/W]."""
        return 1.0 / self.u_value - self.outside_film - self.inside_film


Glazing = Annotated[PaneGlazing | SimpleGlazing, Field(discriminator="kind")]

#: Conductivity of the gases at 10 degC [W/(m K)] (ISO 15099, annex B).
_CONDUCTIVITY = {"air": 0.0248, "argon": 0.0169, "krypton": 0.0089, "xenon": 0.0053}
#: Black-body exchange at 10 degC, 4 sigma T^3 [W/(m2 K)].
_RADIATION = 5.15


def glazing_resistance(glazing: Glazing) -> float:
    """Resistance between the two surfaces, with gas at 10 degC and without convection.

    Parameters
    ----------
    glazing : PaneGlazing or SimpleGlazing
        The glazing.

    Returns
    -------
    float
        Resistance. [m2 K/W]
    """
    if isinstance(glazing, SimpleGlazing):
        return glazing.resistance
    resistance = sum(pane.thickness / pane.conductivity for pane in glazing.panes)
    for index, gap in enumerate(glazing.gaps):
        if isinstance(gap, GivenGap):
            resistance += 1.0 / gap.conductance
            continue
        outer, inner = both(glazing.panes[index].emissivity)[1], both(glazing.panes[index + 1].emissivity)[0]
        radiation = _RADIATION / (1.0 / outer + 1.0 / inner - 1.0)
        resistance += 1.0 / (_CONDUCTIVITY[gap.gas] / gap.thickness + radiation)
    return resistance


#: Where the methods come from, by what uses them.
SOURCES = {
    "panes": "Duffie & Beckman 2013, doi:10.1002/9781118671603, ch. 5 (optics of panes)",
    "coated": "Finlayson et al. 1993, WINDOW 4.0, LBL-33943 (angular behaviour of coated panes)",
    "filled": f"{ISO_15099} (convection in gaps)",
    "simple": "Arasteh, Kohler & Griffith 2009, LBNL-2804E (transmittance by U and solar heat gain)",
    "angle": f"{_FIT} (angular behaviour of a category of glass)",
}
