"""Zones: volumes of well-mixed air, what heats and airs them, and how they exchange air."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.names import Name, ScheduleName, ZoneName
from mascarin.building.number import Number, Remark, problem
from mascarin.building.part import Part, Shorthand
from mascarin.building.surface import Linearised, NoLongwave

ASHRAE_OPENING = (
    "ASHRAE Handbook of Fundamentals 2017, ch. 16, eqs. 37, 38 (flow through openings by wind and buoyancy)"
)


class Infiltration(Part):
    """Outdoor air that enters unasked: ``constant + temperature |dT| + wind V`` air changes per hour."""

    constant: q.AirChange = Number(0.0, source=Remark("not written: airtight"), assumed=True)
    temperature: q.AirChangePerKelvin = Number(
        0.0, source=Remark("not written: no stack effect"), assumed=True
    )
    wind: q.AirChangePerSpeed = Number(0.0, source=Remark("not written: no effect of wind"), assumed=True)


class Radiosity(Part):
    """Exact grey-diffuse exchange, with the fourth power of temperature."""

    kind: Literal["radiosity"] = "radiosity"


ZoneLongwave = Annotated[
    Radiosity | Linearised | NoLongwave, Field(discriminator="kind"), Shorthand(word="kind")
]


class Gain(Part):
    """Heat from people, light and machines."""

    power: q.GainPower
    radiative: q.Radiative = Number(
        0.0, source=Remark("not written: all of it goes to the air"), assumed=True
    )
    schedule: ScheduleName | None = Field(None, description="Fraction of the power; none: always all of it")


class Ventilation(Part):
    """Outdoor air let in on purpose, at the density of the site."""

    air_changes: q.Ventilation | None = None
    flow: q.VolumeFlow | None = None
    schedule: ScheduleName | None = Field(None, description="Fraction of the flow; none: always all of it")

    @model_validator(mode="after")
    def _sourced(self) -> Ventilation:
        if (self.air_changes is None) == (self.flow is None):
            raise problem(
                "ventilation without a source of air" if self.flow is None else "air_changes and flow",
                "exactly one of air_changes [1/h] and flow [m3/s], the outdoor air that comes in",
                "Say how much air it is, in one of the two ways.",
            )
        return self


class SetPoint(Part):
    """Air temperature that a plant keeps: a number, or a schedule."""

    temperature: q.SetPoint | None = None
    schedule: ScheduleName | None = Field(None, description="Schedule of temperature")

    @model_validator(mode="after")
    def _one(self) -> SetPoint:
        if (self.temperature is None) == (self.schedule is None):
            raise problem(
                "neither" if self.schedule is None else "both",
                "a temperature [degC] or {schedule: name}",
                "Write for instance 'setpoint: 20'.",
            )
        return self


class IdealLoads(Part):
    """Ideal heating or cooling: all of it to the air, which it senses, with no loss and no delay."""

    setpoint: Annotated[SetPoint, Shorthand(number="temperature")] = Field(
        description="Air temperature that it keeps: a number, or {schedule: name}"
    )
    capacity: q.Capacity | None = None
    schedule: ScheduleName | None = Field(
        None, description="Fraction of the capacity that is available; none: always all of it"
    )


class EvenSun(Part):
    """Sun spread over all faces, each absorbing by its absorptance; glass lets part of it out again."""

    kind: Literal["area"] = "area"


class GivenSun(Part):
    """Sun by given shares, scaled to a sum of one."""

    kind: Literal["shares"] = "shares"
    shares: dict[Name, q.SunShare] = Field(
        default_factory=dict, description="Share of each surface of the zone, by its name"
    )
    lost: q.SunShare = Number(0.0, source=Remark("not written: nothing leaves again"))


class TracedSun(Part):
    """Beam followed to where its rays end, all else by view factors; needs vertices all round the zone."""

    kind: Literal["geometry"] = "geometry"


ZoneSun = Annotated[EvenSun | GivenSun | TracedSun, Field(discriminator="kind"), Shorthand(word="kind")]


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
    sun: ZoneSun | None = Field(
        None, description="Where the sun that enters through windows lands; none: area"
    )
    view_factors: dict[str, dict[str, q.ViewFactor]] | None = Field(
        None,
        description="View factors from face to face, by surface name (name.outside and name.inside where "
        "both sides of a surface face the zone); none: from vertices, else an approximation by areas",
    )
    gains: dict[Name, Gain] = Field(
        default_factory=dict, description="Heat from people, light and machines, by name"
    )
    ventilation: dict[Name, Ventilation] = Field(
        default_factory=dict, description="Outdoor air let in on purpose, by name"
    )
    heating: IdealLoads | None = Field(None, description="Ideal heating; none: none")
    cooling: IdealLoads | None = Field(None, description="Ideal cooling; none: none")

    @property
    def plants(self) -> dict[str, IdealLoads]:
        """Heating and cooling, as far as there are any."""
        both = {"heating": self.heating, "cooling": self.cooling}
        return {name: plant for name, plant in both.items() if plant is not None}


class AirPath(Part):
    """Air that two zones exchange, as much one way as the other."""

    between: tuple[ZoneName, ZoneName] = Field(description="Names of the two zones")
    flow: q.VolumeFlow
    schedule: ScheduleName | None = Field(None, description="Fraction of the flow; none: always all of it")

    @model_validator(mode="after")
    def _two(self) -> AirPath:
        if self.between[0] == self.between[1]:
            raise problem(f"'{self.between[0]}' twice", "two different zones", "Name the other zone.")
        return self


class Opening(Part):
    """An opening to outdoors that wind and buoyancy drive air through."""

    zone: ZoneName = Field(description="Name of the zone")
    area: q.OpeningArea
    height: q.OpeningHeight
    discharge: q.Discharge = Number(0.65, source=ASHRAE_OPENING, assumed=True)
    wind_coefficient: q.WindCoefficient = Number(0.3, source=ASHRAE_OPENING, assumed=True)
    schedule: ScheduleName | None = Field(
        None, description="Fraction of the area that is open; none: always all of it"
    )
