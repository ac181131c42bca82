"""Objectives of ideal cooling: sensible heat, and the latent heat of drying where a zone is dried."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from mascarin.design.evaluation.checks import is_dried
from mascarin.design.evaluation.objective import ZoneObjective
from mascarin.design.evaluation.reductions import Heat, PeakLoad
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.design.evaluation.layers import LayerFacts
    from mascarin.design.evaluation.objective import Array, Reductions
    from mascarin.weather import Climate


class _Cooled(ZoneObjective):
    zones: tuple[str, ...] = Field(min_length=1, description="Zones; the value is the sum over them")
    setpoint: float | None = Field(
        None,
        ge=10.0,
        le=40.0,
        description="Set point of ideal cooling of these zones; none: as described in the building [degC]",
    )
    set: dict[str, Any] = Field(
        default_factory=dict,
        description="Path -> value of the cooled building only, such as closed windows",
    )

    def changes(self) -> dict[str, Any]:
        """Ideal cooling, and what goes with it."""
        cooled = {f"zones.{zone}.cooling": {"setpoint": self.setpoint} for zone in self.zones}
        return {**(cooled if self.setpoint is not None else {}), **self.set}

    def check(self, building: Building) -> None:
        """Refuse a zone without cooling."""
        super().check(building)
        for zone in self.zones:
            if building.zones[zone].cooling is None:
                raise InputError(
                    f"found no cooling in zone '{zone}'; expected ideal cooling, whose energy is counted. "
                    f"Add "
                    "setpoint: here, such as setpoint: 26, or cooling: in the building"
                )

    @property
    def words(self) -> str:
        """What it is."""
        setpoint_words = "" if self.setpoint is None else f" at {self.setpoint:g} degC"
        zones = ", ".join(self.zones)
        return f"ideal cooling of {zones}{setpoint_words}; sensible, and latent where a zone is dried"

    def outputs(self, building: Building) -> tuple[str, ...]:
        """The sensible load of each zone, and the latent load of each that is dried."""
        return (*self._sensible(), *self._latent(building))

    def _sensible(self) -> tuple[str, ...]:
        return tuple(f"{zone}.cooling_load" for zone in self.zones)

    def _latent(self, building: Building) -> tuple[str, ...]:
        return tuple(f"{zone}.latent_cooling_load" for zone in self.zones if is_dried(building, zone))


class CoolingEnergy(_Cooled):
    """Energy of ideal cooling over the period: sensible heat, and latent heat of drying."""

    kind: Literal["cooling_energy"] = "cooling_energy"
    PARTS: ClassVar[tuple[str, ...]] = ("sensible", "latent")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "kWh"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """Sensible energy, and latent energy where there is drying."""
        latent = self._latent(building)
        reductions: Reductions = {"sensible": Heat(self._sensible())}
        return reductions | ({"latent": Heat(latent)} if latent else {})

    def value(self, values: Mapping[str, Array], facts: LayerFacts) -> Array:
        """Sensible plus latent energy. [kWh]"""
        return np.asarray(np.sum(list(values.values()), axis=0), dtype=np.float64)


class PeakCooling(_Cooled):
    """Largest load of ideal cooling, mean over an hour, all zones together."""

    kind: Literal["peak_cooling"] = "peak_cooling"

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "W"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """The load."""
        return {"load": PeakLoad(self.outputs(building))}
