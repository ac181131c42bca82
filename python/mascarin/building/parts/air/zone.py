"""Zones: volumes of well-mixed air, their gains, ventilation and ideal loads, and the air between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ControlName, Name, ScheduleName
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.parts.air.flow_density import DENSITY, FlowDensity
from mascarin.building.parts.air.leakage import PressureTest
from mascarin.building.parts.air.set_point import SetPoint
from mascarin.building.parts.envelope.bridge import ThermalBridge
from mascarin.building.parts.envelope.measured_values import Driven
from mascarin.building.parts.envelope.surface import Linearised, NoLongwave
from mascarin.building.parts.materials.text_law import InfiltrationLaw


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
    blower_door: PressureTest | None = Field(
        None, description="Infiltration by a pressure test, in addition: n50 [1/h], or a part with its kind"
    )
    density: FlowDensity | None = Field(None, description=DENSITY)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of all infiltration; none: always 1"
    )
    control: ControlName | None = Field(
        None, description="Name of the control that lets air infiltrate; none: not controlled"
    )


class TextInfiltration(InfiltrationLaw, Infiltration):
    """Infiltration as a formula, beside what the other keys add to it.

    The formula may use ``dT`` (air of the zone minus outdoor air [K]), ``V`` (wind at the mast [m/s]), ``Ti``
    and ``To`` (air of the zone and outdoor air [degC]), and the numbers given with it: [1/h].

    Examples
    --------
    >>> law = TextInfiltration(formula="c*sqrt(0.02*abs(dT) + 0.01*V^2)", c={"value": 0.8, "range": [0.2, 2]})
    >>> law.value(20.0, 3.0).round(4).tolist()
    0.56
    """


def _infiltration_kind(raw: Any) -> str:
    if isinstance(raw, Mapping):
        return "text" if "formula" in raw else "parts"
    return "text" if isinstance(raw, TextInfiltration) else "parts"


class Radiosity(Part):
    """Exact exchange between gray, diffuse surfaces, with the fourth power of temperature."""

    kind: Literal["radiosity"] = "radiosity"


ZoneLongwave = Annotated[
    Radiosity | Linearised | NoLongwave, Field(discriminator="kind"), Shorthand(word="kind")
]


class Gain(Driven):
    """Heat from people, light, equipment or heaters; a negative power takes heat away.

    Examples
    --------
    >>> people = Gain(power=240, activity=120, radiative=0.5, schedule="presence")
    >>> float(people.activity)
    120.0
    >>> heater = Gain(column="P_heater", unit="kW", radiative=0.3)
    >>> heater.course.name
    'P_heater [kW]'
    """

    NUMBER: ClassVar = "power"
    KIND: ClassVar = "power"
    advice: ClassVar[Mapping[str, str]] = {
        "latent": "The power is sensible heat; of people write all heat as 'power:', with 'activity:'.",
        "persons": "Write the heat of all people as 'power:', and 'activity:' [W] of one of them.",
        "convective": "What is not 'radiative' goes to the air: write 'radiative:' alone.",
    }

    power: q.GainPower | None = None
    unit: Literal["W", "kW"] | None = Field(None, description="Unit of the column; none: W")
    radiative: q.Radiative = Number(0.0, source=Remark("not given: all of it goes to the air"), assumed=True)
    activity: q.Activity | None = Field(
        None,
        description="Heat of the activity of a person [W]: the power is then all heat of people, and its "
        "sensible part at the air temperature counts; none: all of the power counts",
    )
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the power; none: always 1"
    )


class Ventilation(Part):
    """Ventilation with outdoor air; ``density`` says at which density a flow is a volume.

    Examples
    --------
    >>> float(Ventilation(air_changes=1.5).air_changes)
    1.5
    """

    air_changes: q.Ventilation | None = None
    flow: q.VolumeFlow | None = None
    density: FlowDensity | None = Field(None, description=DENSITY)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )

    control: ControlName | None = Field(
        None, description="Name of the control that lets it flow; none: not controlled"
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


class MixingAir(Driven):
    """Air that a fan moves within a zone; laws of convection by flow depend on it, balances do not.

    Examples
    --------
    >>> MixingAir(air_changes=20.7)
    MixingAir(air_changes=20.7 1/h)
    >>> MixingAir(column="n_fan").course.name
    'n_fan [1/h]'
    """

    NUMBER: ClassVar = "air_changes"
    KIND: ClassVar = "air_change"

    air_changes: q.MixingAirChange | None = None
    unit: Literal["1/h"] | None = Field(None, description="Unit of the column; none: 1/h")
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the air; none: always 1"
    )


class StratifiedAir(Driven):
    """Air that is warmer above than below, as convection at the surfaces of a zone sees it.

    Examples
    --------
    >>> StratifiedAir(gradient=1.5)
    StratifiedAir(gradient=1.5 K/m)
    >>> StratifiedAir(column="dT_dz").course.name
    'dT_dz [K/m]'
    """

    NUMBER: ClassVar = "gradient"
    KIND: ClassVar = "temperature_gradient"

    gradient: q.AirGradient | None = None
    unit: Literal["K/m"] | None = Field(None, description="Unit of the column; none: K/m")
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the gradient; none: always 1"
    )


class IdealLoads(Part):
    """Ideal heating or cooling: it holds the air, or an operative temperature, without losses and delay.

    The share of the mean radiant temperature is the zone's ``setpoint_radiant_share``.

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
    radiative: q.LoadRadiative | None = None
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


class MassShares(Part):
    """Fractions of the solar radiation that the two sides of a surface within the zone absorb.

    Examples
    --------
    >>> float(MassShares(outside=0.1, inside=0.2).inside)
    0.2
    """

    outside: q.SunShare = Number(0.0, source=Remark("not given: this side gets none"))
    inside: q.SunShare = Number(0.0, source=Remark("not given: this side gets none"))


class SunShares(Part):
    """Fractions of the diffuse part of the solar radiation, scaled to a sum of one.

    Examples
    --------
    >>> SunShares(shares={"floor": 0.3, "walls": 0.7})
    SunShares(shares=floor, walls, masses=none, lost=0)
    """

    shares: dict[Name, q.SunShare] = Field(
        default_factory=dict, description="Fraction of each surface of the zone, by its name"
    )
    masses: dict[Name, MassShares] = Field(
        default_factory=dict,
        description="Fractions of both sides of surfaces within the zone (internal masses), by name",
    )
    lost: q.SunShare = Number(0.0, source=Remark("not given: nothing leaves again"))


class GivenSun(Part):
    """Solar radiation distributed by given fractions, scaled to a sum of one.

    Examples
    --------
    >>> GivenSun(shares={"floor": 0.6, "walls": 0.4})
    GivenSun(shares=floor, walls, masses=none, lost=0)
    """

    kind: Literal["shares"] = "shares"
    shares: dict[Name, q.SunShare] = Field(
        default_factory=dict, description="Fraction of each surface of the zone, by its name"
    )
    masses: dict[Name, MassShares] = Field(
        default_factory=dict,
        description="Fractions of both sides of surfaces within the zone (internal masses), by name",
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


#: Sources of a set point beside a number.
_SET_POINT = ("schedule", "column")


def _plant_of(held: Any) -> Any:
    """Heating, or cooling, of a zone that is held: ``when`` is the schedule of both."""
    if not isinstance(held, Mapping):
        return {"setpoint": held}
    plant = {"setpoint": {key: value for key, value in held.items() if key not in ("when", "radiative")}}
    if "radiative" in held:
        plant["radiative"] = held["radiative"]
    if "when" in held:
        plant["schedule"] = held["when"]
    return plant


def _or_held(schema: dict[str, Any]) -> None:
    """Allow ``held``, the short form of heating and cooling with one set point, in the JSON Schema."""
    texts = {
        "schedule": "Schedule that gives the set point",
        "column": "Measured column that gives the set point",
        "when": "Schedule of the hours in which the zone is held",
    }
    words = {key: {"type": "string", "description": text} for key, text in texts.items()}
    facts = {"temperature": "Set point [degC]", "radiative": "Radiative part of the load [-]"}
    numbers = {key: {"type": ["number", "object"], "description": text} for key, text in facts.items()}
    schema["properties"]["held"] = {
        "description": "Heating and cooling with this set point [degC], where a schedule 'when' says so; "
        "part of it may be radiative",
        "anyOf": [
            {"type": "number"},
            {
                "type": "object",
                "properties": words | numbers,
                "minProperties": 1,
                "additionalProperties": False,
            },
        ],
    }


class Zone(Part):
    """A volume of well-mixed air.

    ``held`` in place of heating and cooling gives both the same set point.

    Examples
    --------
    >>> zone = Zone(volume=30, infiltration=0.5, heating={"setpoint": 20})
    >>> float(zone.infiltration.constant)
    0.5
    """

    model_config = ConfigDict(json_schema_extra=_or_held)
    advice: ClassVar[Mapping[str, str]] = {
        "temperature": "The air temperature is a result: hold it with 'held: 24' or 'held: {column: "
        "T_room}'. That at the start of a run is an option of the run (initial).",
        "setpoint": "Write 'heating: {setpoint: 20}' or 'cooling: {setpoint: 26}'.",
        "furniture": "Furniture is a surface with 'internal_mass: true', both sides of which face the zone.",
        "n50": "Write 'infiltration: {blower_door: 2.2}'.",
    }

    volume: q.Volume | None = None
    capacity_factor: q.CapacityFactor = Number(1.0, source=Remark("air alone, no furniture"), assumed=True)
    infiltration: Annotated[
        Annotated[Infiltration, Tag("parts")] | Annotated[TextInfiltration, Tag("text")],
        Discriminator(_infiltration_kind),
        Shorthand(number="constant"),
    ] = Field(
        default_factory=Infiltration,
        description="Infiltration: a number [1/h], its three parts, or a formula",
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
    mixing_air_change: Annotated[MixingAir, Shorthand(number="air_changes")] | None = Field(
        None,
        description="Air that a fan moves within the zone: a number [1/h], or a part with a schedule or "
        "column; none: no air",
    )
    air_gradient: Annotated[StratifiedAir, Shorthand(number="gradient")] | None = Field(
        None,
        description="Air that is warmer above than below: a number [K/m], or a part with a schedule or "
        "column; none: one temperature",
    )
    heating: IdealLoads | None = Field(None, description="Ideal heating; none: no heating")
    cooling: IdealLoads | None = Field(None, description="Ideal cooling; none: no cooling")
    setpoint_radiant_share: q.SetPointRadiantShare | None = None
    thermal_bridges: dict[Name, ThermalBridge] = Field(
        default_factory=dict, description="Thermal bridges of the zone, by name"
    )
    solar_to_air: q.SolarToAir | None = None
    makeup_air: Literal["outdoors", "vents"] | None = Field(
        None,
        description="Where the air comes from that fans take out of the zone and do not bring in, and "
        "where it goes to that they bring in too much: outdoors, through leaks, or vents, through the "
        "pressure network; none: flows must balance",
    )

    @model_validator(mode="before")
    @classmethod
    def _held(cls, raw: Any) -> Any:
        """Read ``held`` as heating and cooling with the same set point."""
        if not isinstance(raw, Mapping) or "held" not in raw:
            return raw
        both = [key for key in ("heating", "cooling") if raw.get(key) is not None]
        if both:
            raise problem(
                f"held and {' and '.join(both)}",
                "one of them",
                "A zone that is held has both at one set point.",
            )
        other_keys = {key: value for key, value in raw.items() if key != "held"}
        return other_keys | {key: _plant_of(raw["held"]) for key in ("heating", "cooling")}

    @property
    def loads(self) -> dict[str, IdealLoads]:
        """Heating and cooling, where there are any."""
        both = {"heating": self.heating, "cooling": self.cooling}
        return {name: plant for name, plant in both.items() if plant is not None}
