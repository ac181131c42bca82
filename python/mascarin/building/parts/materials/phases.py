"""Properties that differ between the solid and the liquid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, SupportsFloat

from pydantic import Discriminator, Tag

from mascarin.building import quantities as q
from mascarin.building.base.part import Pair


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


def phase(value: SupportsFloat | Phases, name: str) -> float:
    """Value of a property in one phase.

    Parameters
    ----------
    value : Number, law or Phases
        The property, of both phases alike (a law at a usual temperature) or of each. [its unit]
    name : str
        ``solid`` or ``liquid``.

    Returns
    -------
    float
        The value. [its unit]

    Examples
    --------
    >>> phase(PhaseDensities(solid=880, liquid=770), "liquid")
    770.0
    """
    return float(getattr(value, name)) if isinstance(value, Phases) else float(value)
