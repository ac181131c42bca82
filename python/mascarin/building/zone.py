"""Zones: volumes of well-mixed air, their gains, ventilation and ideal loads, and the air between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

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
    """Infiltration: ``constant + temperature |dT| + wind V`` air changes per hour.

    Examples
    --------
    >>> Infiltration(constant=0.2, wind=0.05)
    Infiltration(constant=0.2 1/h, temperature=0 1/(h K), wind=0.05 1/(h m/s))
    """

    constant: q.AirChange = Number(0.0, source=Remark("not given: airtight"), assumed=True)
    temperature: q.AirChangePerKelvin = Number(0.0, source=Remark("not given: no stack effect"), assumed=True)
    wind: q.AirChangePerSpeed = Number(0.0, source=Remark("not given: no effect of wind"), assumed=True)


class Radiosity(Part):
    """Exact exchange between gray, diffuse surfaces, with the fourth power of temperature."""

    kind: Literal["radiosity"] = "radiosity"


ZoneLongwave = Annotated[
    Radiosity | Linearised | NoLongwave, Field(discriminator="kind"), Shorthand(word="kind")
]


class Gain(Part):
    """Internal heat gain from people, light or equipment.

    Examples
    --------
    >>> people = Gain(power=200, radiative=0.5, schedule="presence")
    >>> float(people.radiative)
    0.5
    """

    power: q.GainPower
    radiative: q.Radiative = Number(0.0, source=Remark("not given: all of it goes to the air"), assumed=True)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the power; none: always 1"
    )


class Ventilation(Part):
    """Ventilation with outdoor air; flows are volumes at the density of the site.

    Examples
    --------
    >>> float(Ventilation(air_changes=1.5).air_changes)
    1.5
    """

    air_changes: q.Ventilation | None = None
    flow: q.VolumeFlow | None = None
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )

    @model_validator(mode="after")
    def _sourced(self) -> Ventilation:
        if (self.air_changes is None) == (self.flow is None):
            raise problem(
                "ventilation without a flow" if self.flow is None else "air_changes and flow",
                "exactly one of air_changes [1/h] and flow [m3/s]",
                "Give the flow of outdoor air in one of the two ways.",
            )
        return self


class SetPoint(Part):
    """Set point of ideal heating or cooling: a number, or a schedule.

    Examples
    --------
    >>> SetPoint(temperature=20)
    SetPoint(temperature=20 degC)
    """

    advice: ClassVar[Mapping[str, str]] = {
        "measured": "Write 'setpoint: {schedule: NAME}' with a schedule of kind temperature that has this "
        "column."
    }

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
    """Ideal heating or cooling: it acts on the air temperature alone, without losses and without delay.

    Examples
    --------
    >>> heating = IdealLoads(setpoint=20, capacity=2000)
    >>> float(heating.setpoint.temperature)
    20.0
    """

    setpoint: Annotated[SetPoint, Shorthand(number="temperature")] = Field(
        description="Set point of the air temperature: a number, or {schedule: name}"
    )
    capacity: q.Capacity | None = None
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the available fraction of the capacity; none: always 1"
    )


class EvenSun(Part):
    """Solar radiation distributed evenly over all surfaces; part of it leaves through the glass again.

    Examples
    --------
    >>> EvenSun()
    EvenSun()
    """

    kind: Literal["area"] = "area"


class SunShares(Part):
    """Fractions of the diffuse part of the solar radiation, scaled to a sum of one.

    Examples
    --------
    >>> SunShares(shares={"floor": 0.3, "walls": 0.7})
    SunShares(shares=floor, walls, lost=0)
    """

    shares: dict[Name, q.SunShare] = Field(
        default_factory=dict, description="Fraction of each surface of the zone, by its name"
    )
    lost: q.SunShare = Number(0.0, source=Remark("not given: nothing leaves again"))


class GivenSun(Part):
    """Solar radiation distributed by given fractions, scaled to a sum of one.

    Examples
    --------
    >>> GivenSun(shares={"floor": 0.6, "walls": 0.4})
    GivenSun(shares=floor, walls, lost=0)
    """

    kind: Literal["shares"] = "shares"
    shares: dict[Name, q.SunShare] = Field(
        default_factory=dict, description="Fraction of each surface of the zone, by its name"
    )
    lost: q.SunShare = Number(0.0, source=Remark("not given: nothing leaves again"))
    diffuse: SunShares | None = Field(
        None, description="Fractions of the diffuse part; none: those of the beam for all of it"
    )


class FloorSun(Part):
    """Beam radiation evenly on the floor; diffuse and reflected radiation evenly over all surfaces.

    Examples
    --------
    >>> FloorSun()
    FloorSun()
    """

    kind: Literal["floor"] = "floor"


class TracedSun(Part):
    """Beam radiation traced to the surfaces, the rest by view factors; needs vertices of all surfaces.

    Examples
    --------
    >>> TracedSun()
    TracedSun()
    """

    kind: Literal["geometry"] = "geometry"


ZoneSun = Annotated[
    EvenSun | GivenSun | FloorSun | TracedSun, Field(discriminator="kind"), Shorthand(word="kind")
]


class Zone(Part):
    """A volume of well-mixed air.

    Examples
    --------
    >>> zone = Zone(volume=30, infiltration=0.5, heating={"setpoint": 20})
    >>> float(zone.infiltration.constant)
    0.5
    """

    advice: ClassVar[Mapping[str, str]] = {
        "temperature": "The air temperature is a result: hold it with 'heating: {setpoint: 24}' and "
        "'cooling: "
        "{setpoint: 24}'. That at the start of a run is an option of the run (initial).",
        "setpoint": "Write 'heating: {setpoint: 20}' or 'cooling: {setpoint: 26}'.",
    }

    volume: q.Volume | None = None
    capacity_factor: q.CapacityFactor = Number(1.0, source=Remark("air alone, no furniture"), assumed=True)
    infiltration: Annotated[Infiltration, Shorthand(number="constant")] = Field(
        default_factory=Infiltration,
        description="Infiltration: a number [1/h], or its three parts",
    )
    longwave: ZoneLongwave = Field(
        default_factory=lambda: Radiosity(kind="radiosity"),
        description="Long-wave exchange between the surfaces of the zone",
    )
    sun: ZoneSun | None = Field(
        None, description="Distribution of the solar radiation that enters through windows; none: area"
    )
    view_factors: dict[str, dict[str, q.ViewFactor]] | None = Field(
        None,
        description="View factors between surfaces, by their names (name.outside and name.inside where both "
        "sides of a surface face the zone); none: from vertices, else an approximation by areas",
    )
    gains: dict[Name, Gain] = Field(default_factory=dict, description="Internal heat gains by name")
    ventilation: dict[Name, Ventilation] = Field(
        default_factory=dict, description="Ventilation with outdoor air, by name"
    )
    heating: IdealLoads | None = Field(None, description="Ideal heating; none: no heating")
    cooling: IdealLoads | None = Field(None, description="Ideal cooling; none: no cooling")

    @property
    def loads(self) -> dict[str, IdealLoads]:
        """Heating and cooling, where there are any."""
        both = {"heating": self.heating, "cooling": self.cooling}
        return {name: plant for name, plant in both.items() if plant is not None}


class AirPath(Part):
    """Air that two zones exchange, with the same flow in both directions.

    Examples
    --------
    >>> AirPath(between=("office", "corridor"), flow=0.02)
    AirPath(between=[office, corridor], flow=0.02 m3/s)
    """

    between: tuple[ZoneName, ZoneName] = Field(description="Names of the two zones")
    flow: q.VolumeFlow
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )

    @model_validator(mode="after")
    def _two(self) -> AirPath:
        if self.between[0] == self.between[1]:
            raise problem(f"'{self.between[0]}' twice", "two different zones", "Name the other zone.")
        return self


class Opening(Part):
    """An opening to outdoors, with a flow of air by wind and buoyancy.

    Examples
    --------
    >>> Opening(zone="attic", area=0.02, height=0.3)
    Opening(zone=attic, area=0.02 m2, height=0.3 m, discharge=0.65, wind_coefficient=0.3)
    """

    zone: ZoneName = Field(description="Name of the zone")
    area: q.OpeningArea
    height: q.OpeningHeight
    discharge: q.Discharge = Number(0.65, source=ASHRAE_OPENING, assumed=True)
    wind_coefficient: q.WindCoefficient = Number(0.3, source=ASHRAE_OPENING, assumed=True)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the area that is open; none: always 1"
    )
