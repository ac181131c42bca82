"""Materials: solids, bare resistances, phase-change materials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator
from pydantic_core import InitErrorDetails

from mascarin.model import quantities as q
from mascarin.model.library import FromLibrary
from mascarin.model.number import Number, Remark, problem
from mascarin.model.part import Part, fault, insist


def _or_pair(schema: dict[str, Any]) -> None:
    """Allow the short form of :class:`Phases` in its JSON Schema."""
    written, properties = dict(schema), schema["properties"]
    schema.clear()
    pair = [properties["solid"], properties["liquid"]]
    schema["anyOf"] = [written, {"type": "array", "prefixItems": pair, "minItems": 2, "items": False}]


class Solid(Part):
    """A material with constant properties."""

    kind: Literal["solid"] = "solid"
    conductivity: q.Conductivity
    density: q.Density
    specific_heat: q.SpecificHeat
    source: str | None = Field(None, description="Where the properties come from")


class Resistance(Part):
    """A layer that resists and stores nothing: an air space, a contact, a mask."""

    kind: Literal["resistance"]
    resistance: q.Resistance
    source: str | None = Field(None, description="Where the value comes from")


class Phases(Part):
    """A property of the solid and of the liquid; short form ``[solid, liquid]``."""

    model_config = ConfigDict(json_schema_extra=_or_pair)

    @model_validator(mode="before")
    @classmethod
    def _from_pair(cls, raw: Any) -> Any:
        if not isinstance(raw, list | tuple):
            return raw
        if len(raw) != 2:
            raise problem(f"{len(raw)} values", "[solid, liquid]", "Write one value for each phase.")
        return {"solid": raw[0], "liquid": raw[1]}


class PhaseConductivities(Phases):
    """Thermal conductivity of the solid and of the liquid; short form ``[solid, liquid]``."""

    solid: q.Conductivity
    liquid: q.Conductivity


class PhaseDensities(Phases):
    """Density of the solid and of the liquid; short form ``[solid, liquid]``."""

    solid: q.Density
    liquid: q.Density


class PhaseSpecificHeats(Phases):
    """Specific heat of the solid and of the liquid; short form ``[solid, liquid]``."""

    solid: q.PhaseSpecificHeat
    liquid: q.PhaseSpecificHeat


def _one_or_two(raw: Any) -> str:
    pair = isinstance(raw, list | tuple | Phases) or (isinstance(raw, Mapping) and "value" not in raw)
    return "phases" if pair else "both"


_EITHER = Discriminator(_one_or_two)
ConductivityByPhase = Annotated[
    Annotated[q.Conductivity, Tag("both")] | Annotated[PhaseConductivities, Tag("phases")], _EITHER
]
DensityByPhase = Annotated[
    Annotated[q.Density, Tag("both")] | Annotated[PhaseDensities, Tag("phases")], _EITHER
]
SpecificHeatByPhase = Annotated[
    Annotated[q.PhaseSpecificHeat, Tag("both")] | Annotated[PhaseSpecificHeats, Tag("phases")], _EITHER
]


class TanhLaw(Part):
    """Liquid fraction ``(1 + tanh((T - Tm)/w))/2``.

    Either the half-width ``w`` is given, or ``gamma`` and ``delta_t`` of Guichard et al., with which
    ``w = 4 delta_t/gamma``.
    """

    kind: Literal["tanh"]
    width: q.MeltingWidth | None = None
    gamma: q.Gamma | None = None
    delta_t: q.DeltaT | None = None

    @model_validator(mode="after")
    def _one_form(self) -> TanhLaw:
        given = [name for name in ("width", "gamma", "delta_t") if getattr(self, name) is not None]
        if given not in (["width"], ["gamma", "delta_t"]):
            raise problem(
                ", ".join(given) or "neither",
                "either width or both gamma and delta_t",
                "width = 4 delta_t/gamma; give one form.",
            )
        return self

    @property
    def half_width(self) -> float:
        """Half-width of the melting range [K]."""
        if self.gamma is None or self.delta_t is None:
            return float(self.width or 0.0)
        return 4.0 * self.delta_t / self.gamma


class TableLaw(Part):
    """Measured enthalpy over temperature, interpolated monotonically."""

    kind: Literal["table"]
    temperatures: tuple[q.CurveTemperature, ...]
    enthalpies: tuple[q.CurveEnthalpy, ...]
    melting_range: tuple[q.CurveTemperature, q.CurveTemperature] | None = Field(
        None, description="Temperatures at which melting starts and is complete; none: the ends of the table"
    )
    temperature_shift: q.TemperatureShift = Number(0.0, source=Remark("the curve as measured"))
    enthalpy_scale: q.EnthalpyScale = Number(1.0, source=Remark("the curve as measured"))

    @model_validator(mode="after")
    def _monotone(self) -> TableLaw:
        faults = [*_rising("temperatures", self.temperatures), *_rising("enthalpies", self.enthalpies)]
        if len(self.temperatures) != len(self.enthalpies):
            faults.append(
                fault(
                    (),
                    f"{len(self.temperatures)} temperatures and {len(self.enthalpies)} enthalpies",
                    "as many of one as of the other",
                    "Complete the table.",
                )
            )
        faults += self._melting_outside()
        insist(*faults)
        return self

    def _melting_outside(self) -> list[InitErrorDetails]:
        if self.melting_range is None or not self.temperatures:
            return []
        (start, end), first, last = self.melting_range, self.temperatures[0], self.temperatures[-1]
        if first <= start < end <= last:
            return []
        expected = f"[start, end] with start < end, between {first:g} and {last:g} degC"
        return [
            fault(("melting_range",), f"[{start:g}, {end:g}]", expected, "Swap the two or extend the table.")
        ]

    @property
    def melting(self) -> tuple[float, float]:
        """Temperatures at which melting starts and is complete [degC]."""
        low, high = self.melting_range or (self.temperatures[0], self.temperatures[-1])
        return (float(low), float(high))


def _rising(key: str, values: tuple[Number, ...]) -> list[InitErrorDetails]:
    if len(values) < 2:
        return [fault((key,), f"{len(values)} points", "at least two points", "Complete the table.")]
    return [
        fault(
            (key, i + 1),
            f"{after:g} after {before:g}",
            "strictly rising values: heat must raise enthalpy",
            "Sort the table, remove repeated points; a plateau needs a small slope.",
        )
        for i, (before, after) in enumerate(pairwise(values))
        if not after > before
    ]


Law = Annotated[TanhLaw | TableLaw, Field(discriminator="kind")]


class PhaseChangeMaterial(Part):
    """A material that melts and freezes; each property may differ between solid and liquid."""

    kind: Literal["pcm"]
    conductivity: ConductivityByPhase
    density: DensityByPhase
    specific_heat: SpecificHeatByPhase
    latent_heat: q.LatentHeat | None = None
    melting_temperature: q.MeltingTemperature | None = None
    law: Law
    product: str | None = Field(None, description="Product of the library that the rest comes from")
    source: str | None = Field(None, description="Where the properties come from")

    @model_validator(mode="after")
    def _law_fits(self) -> PhaseChangeMaterial:
        melting = ("latent_heat", "melting_temperature")
        if isinstance(self.law, TanhLaw):
            insist(
                *(
                    fault((key,), "nothing", f"{key}: needed by the tanh law", f"Add '{key}:'.")
                    for key in melting
                    if getattr(self, key) is None
                )
            )
            insist(*self._falling_enthalpy(self.law))
        else:
            insist(
                *(
                    fault(
                        (key,),
                        f"{getattr(self, key):g}",
                        "no value: the enthalpy table holds it",
                        f"Remove '{key}:', or vary the table's temperature_shift and enthalpy_scale.",
                    )
                    for key in melting
                    if getattr(self, key) is not None
                )
            )
        return self

    def _falling_enthalpy(self, law: TanhLaw) -> list[InitErrorDetails]:
        """Find where dH/dT = (rho c)_s + D f + f' (rho_l L + D (T - Tm)) is not positive."""
        solid, liquid = self.heat_capacities
        difference, latent = liquid - solid, phase(self.density, "liquid") * (self.latent_heat or 0.0)
        w = law.half_width
        for step in range(-400, 401):
            u = step / 40.0  # beyond |u| = 10 the melting term is gone
            f, slope = 0.5 + 0.5 * math.tanh(u), 0.5 / (w * math.cosh(u) ** 2)
            capacity = solid + difference * f + slope * (latent + difference * u * w)
            if not capacity > 0.0:
                at = (self.melting_temperature or 0.0) + u * w
                return [
                    fault(
                        ("law",),
                        f"dH/dT = {capacity:.3g} J/(m3 K) at {at:.2f} degC",
                        "an enthalpy that rises with temperature",
                        "The difference of the heat capacities outweighs the latent heat over this width: "
                        "check density and specific_heat of both phases, latent_heat and the width.",
                    )
                ]
        return []

    @property
    def heat_capacities(self) -> tuple[float, float]:
        """Volumetric sensible heat capacity of solid and liquid [J/(m3 K)]."""
        solid, liquid = (
            phase(self.density, name) * phase(self.specific_heat, name) for name in ("solid", "liquid")
        )
        return solid, liquid


def phase(value: Number | Phases, name: str) -> float:
    """Value of a property in the solid or the liquid phase."""
    return float(value) if isinstance(value, Number) else float(getattr(value, name))


def _kind(raw: Any) -> str:
    kind = raw.get("kind", "solid") if isinstance(raw, Mapping) else getattr(raw, "kind", "solid")
    return str(kind)


Material = Annotated[
    Annotated[Solid, Tag("solid")]
    | Annotated[Resistance, Tag("resistance")]
    | Annotated[PhaseChangeMaterial, Tag("pcm")],
    Discriminator(_kind),
    FromLibrary(),
]
