"""Melting of a material: properties of both phases, the law, and the temperatures that follow from them."""

from __future__ import annotations

from pydantic import Field

from mascarin.building import quantities as q
from mascarin.building.base.part import Part
from mascarin.building.parts.materials.closed_law import ClosedLaw
from mascarin.building.parts.materials.history_laws import HistoryLaw, OneCurveLaw
from mascarin.building.parts.materials.phase_change import (
    CapacityLaw,
    FractionLaw,
    FractionsLaw,
    Hysteresis,
    Law,
    TableLaw,
)
from mascarin.building.parts.materials.phases import (
    ConductivityByPhase,
    DensityByPhase,
    SpecificHeatByPhase,
    phase,
)


class Melting(Part):
    """Properties and law of a material that melts; `PhaseChangeMaterial` adds the checks."""

    conductivity: ConductivityByPhase = Field(description="Thermal conductivity [W/(m K)]; [solid, liquid]")
    density: DensityByPhase = Field(description="Density [kg/m3]; [solid, liquid]")
    specific_heat: SpecificHeatByPhase = Field(description="Specific heat [J/(kg K)]; [solid, liquid]")
    latent_heat: q.LatentHeat | None = None
    melting_temperature: q.MeltingTemperature | None = None
    law: Law = Field(description="How the liquid fraction or the enthalpy depends on temperature")
    hysteresis: HistoryLaw | None = Field(
        None, description="Model of hysteresis or supercooling and its numbers; none: it freezes as it melts"
    )

    @property
    def heat_capacities(self) -> tuple[float, float]:
        """Sensible heat capacity of solid and liquid per volume of the solid [J/(m3 K)]."""
        density = phase(self.density, "solid")
        return density * phase(self.specific_heat, "solid"), density * phase(self.specific_heat, "liquid")

    @property
    def centre(self) -> float:
        """Temperature that the heating curve refers to [degC]."""
        if isinstance(self.law, ClosedLaw):
            return float(self.melting_temperature or 0.0)
        return float(self.law.temperature_shift)

    @property
    def reference(self) -> float:
        """Temperature at which the latent heat is given [degC]."""
        if isinstance(self.law, FractionsLaw):
            return self.centre + 0.5 * sum(self.law.reach)
        return self.centre

    @property
    def melting(self) -> tuple[float, float]:
        """Temperatures at which melting starts and is complete, without the tails [degC]."""
        if isinstance(self.law, TableLaw | CapacityLaw):
            low, high = self.law.melting
            return (low + self.centre, high + self.centre)
        low, high = self.law.reach
        return (self.centre + low, self.centre + high)

    @property
    def two_curves(self) -> Hysteresis | None:
        """Hysteresis between a heating and a cooling curve; None without it."""
        return self.hysteresis if isinstance(self.hysteresis, Hysteresis) else None

    @property
    def one_curve(self) -> OneCurveLaw | None:
        """A law with a state and a single curve, such as supercooling; None without it."""
        return self.hysteresis if isinstance(self.hysteresis, OneCurveLaw) else None

    @property
    def cooling(self) -> tuple[FractionLaw, float] | None:
        """Law of the cooling curve and the temperature it refers to [degC]; None without hysteresis."""
        two_curves = self.two_curves
        if two_curves is None or isinstance(self.law, TableLaw | CapacityLaw):
            return None
        law = two_curves.law or self.law
        if isinstance(law, FractionsLaw):
            return law, float(law.temperature_shift)
        return law, float(two_curves.freezing_temperature or 0.0)
