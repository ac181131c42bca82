"""Zones: volumes of well-mixed air."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mascarin.model import quantities as q
from mascarin.model.envelope import Linearised, NoLongwave
from mascarin.model.number import Number, Remark
from mascarin.model.part import Part, Shorthand


class Infiltration(Part):
    """Outdoor air that enters unasked: ``constant + temperature |dT| + wind V`` air changes per hour."""

    constant: q.AirChange = Number(0.0, source=Remark("not written: airtight"), assumed=True)
    temperature: q.AirChangePerKelvin = Number(
        0.0, source=Remark("not written: no stack effect"), assumed=True
    )
    wind: q.AirChangePerSpeed = Number(0.0, source=Remark("not written: no effect of wind"), assumed=True)


class Radiosity(Part):
    """Exact grey-diffuse exchange, with the fourth power of temperature."""

    kind: Literal["radiosity"]


ZoneLongwave = Annotated[
    Radiosity | Linearised | NoLongwave, Field(discriminator="kind"), Shorthand(word="kind")
]


class Zone(Part):
    """A volume of well-mixed air."""

    volume: q.Volume | None = None
    capacity_factor: q.CapacityFactor = Number(1.0, source=Remark("air alone, no furniture"), assumed=True)
    infiltration: Annotated[Infiltration, Shorthand(number="constant")] = Field(
        default_factory=Infiltration,
        description="Outdoor air that enters unasked: a number, or its three parts",
    )
    longwave: ZoneLongwave = Field(
        default_factory=lambda: Radiosity(kind="radiosity"),
        description="Long-wave exchange between the faces of the zone",
    )
    view_factors: dict[str, dict[str, q.ViewFactor]] | None = Field(
        None,
        description="View factors from face to face, by surface name (name.outside and name.inside where "
        "both sides of a surface face the zone); none: from vertices, else an approximation by areas",
    )
