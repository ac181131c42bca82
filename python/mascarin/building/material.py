"""Materials: solids, bare resistances, phase-change materials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from mascarin.building import quantities as q
from mascarin.building.number import Fixed, Number
from mascarin.building.part import Pair, Part, insist
from mascarin.building.phase_change import (
    CapacityLaw,
    ClosedLaw,
    FractionLaw,
    FractionsLaw,
    Hysteresis,
    Law,
    TableLaw,
)
from mascarin.building.products import FromLibrary


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


class Phases(Pair):
    """A property of the solid and of the liquid; short form ``[solid, liquid]``."""


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


class PhaseChangeMaterial(Part):
    """A material that melts and freezes; each property may differ between solid and liquid.

    A layer keeps its mass: the density of the solid times the thickness as built. The liquid is thicker by
    the ratio of the densities.
    """

    kind: Literal["pcm"]
    conductivity: ConductivityByPhase
    density: DensityByPhase
    specific_heat: SpecificHeatByPhase
    latent_heat: q.LatentHeat | None = None
    melting_temperature: q.MeltingTemperature | None = None
    law: Law
    hysteresis: Hysteresis | None = Field(
        None, description="A cooling curve of its own; none: it freezes as it melts"
    )
    product: str | None = Field(None, description="Product of the library that the rest comes from")
    source: str | None = Field(None, description="Where the properties come from")

    @model_validator(mode="after")
    def _law_fits(self) -> PhaseChangeMaterial:
        from mascarin.building import phase_change_rules as rules

        insist(*rules.missing_or_idle(self))
        insist(*rules.unit_slips(self))
        insist(*rules.falling_enthalpy(self))
        insist(*rules.contradicted_latent_heat(self))
        insist(*rules.crossing_curves(self))
        if self.latent_heat is not None and isinstance(self.law, TableLaw | CapacityLaw):
            self._settle(latent_heat=_only_compared(self.latent_heat))
        return self

    @property
    def heat_capacities(self) -> tuple[float, float]:
        """Sensible heat capacity of solid and liquid per volume as built [J/(m3 K)]."""
        density = phase(self.density, "solid")
        return density * phase(self.specific_heat, "solid"), density * phase(self.specific_heat, "liquid")

    @property
    def centre(self) -> float:
        """Temperature from which the heating curve is reckoned [degC]."""
        if isinstance(self.law, ClosedLaw):
            return float(self.melting_temperature or 0.0)
        return float(self.law.temperature_shift)

    @property
    def reference(self) -> float:
        """Temperature that the latent heat is given at [degC]."""
        if isinstance(self.law, FractionsLaw):
            return self.centre + 0.5 * sum(self.law.reach)
        return self.centre

    @property
    def melting(self) -> tuple[float, float]:
        """Temperatures at which melting starts and is complete, tails cut [degC]."""
        if isinstance(self.law, TableLaw | CapacityLaw):
            low, high = self.law.melting
            return (low + self.centre, high + self.centre)
        low, high = self.law.reach
        return (self.centre + low, self.centre + high)

    @property
    def cooling(self) -> tuple[FractionLaw, float] | None:
        """Law of the cooling curve and where it is reckoned from [degC]; none: no hysteresis."""
        if self.hysteresis is None or isinstance(self.law, TableLaw | CapacityLaw):
            return None
        law = self.hysteresis.law or self.law
        if isinstance(law, FractionsLaw):
            return law, float(law.temperature_shift)
        return law, float(self.hysteresis.freezing_temperature or 0.0)


def _only_compared(number: Number) -> Number:
    """Mark a number that the engine has no use for."""
    if number.quantity is None:
        return number
    return number.of(
        replace(number.quantity, spread=Fixed("the table holds it; it is only compared with it"))
    )


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
