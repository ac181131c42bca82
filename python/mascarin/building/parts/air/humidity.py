"""Humidity of the air: one section of a building that turns the vapour balances of all zones on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import MaterialName, Name, ScheduleName, SurfaceName, ZoneName
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.base.time_series import ColumnCourse, CourseKind
from mascarin.building.parts.envelope.measured_values import Driven
from mascarin.building.parts.materials.sorption import Sorption

LEWIS: Final = (
    "EnergyPlus 25.2 Engineering Reference, effective moisture penetration depth (Lewis relation of air: 1)"
)
EMPD: Final = (
    "Woods, Winkler & Christensen 2013, NREL/TP-5500-57441 (effective moisture penetration depth, two layers)"
)
PSYCHROMETRICS: Final = (
    "ASHRAE Handbook of Fundamentals 2017, ch. 1, eqs. 5, 6, 20, 33, 35 (moist air; saturation pressure "
    "after Hyland & Wexler 1983)"
)


class VapourGain(Driven):
    """A source of vapour: people, plants, kitchens, bathrooms.

    Examples
    --------
    >>> people = VapourGain(power=100, schedule="presence")
    >>> float(people.power)
    100.0
    >>> VapourGain(column="vapour", unit="g/h").course.name
    'vapour [g/h]'
    >>> float(VapourGain(power=360, activity=120).activity)  # three people: all their heat
    120.0
    """

    NUMBER: ClassVar = "rate"
    KIND: ClassVar = "vapour"
    advice: ClassVar[Mapping[str, str]] = {
        "latent": "Write 'power:' for latent heat [W], or 'rate:' for vapour [kg/s].",
    }

    power: q.LatentPower | None = None
    rate: q.VapourRate | None = None
    unit: Literal["kg/s", "kg/h", "g/h"] | None = Field(None, description="Unit of the column; none: kg/s")
    activity: q.Activity | None = Field(
        None,
        description="Heat of the activity of a person [W]: the power is then all heat of people, and its "
        "latent part at the air temperature becomes vapour; none: all of the power does",
    )
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the source; none: always 1"
    )

    def _needs_none(self) -> bool:
        return self.power is not None

    @classmethod
    def _usual_unit(cls) -> str:
        return "kg/s"

    @model_validator(mode="after")
    def _one_measure(self) -> VapourGain:
        if self.power is not None and (self.rate is not None or self.column is not None):
            other = "rate" if self.rate is not None else "column"
            raise problem(
                f"power and {other}",
                "one of power [W], rate [kg/s] and column",
                "Keep one of them: 100 W of latent heat are 4e-5 kg/s.",
            )
        if self.activity is not None and self.power is None:
            raise problem(
                "'activity' without 'power'",
                "the heat of all people as power [W]",
                "Write 'power:', or remove 'activity:': a rate is vapour already.",
            )
        return self


class HumiditySetPoint(Part):
    """A humidity that the air is brought to: a number, a schedule or a measured column."""

    #: What a column holds, its usual unit, and the number in words.
    KIND: ClassVar[CourseKind]
    USUAL: ClassVar[str]
    WORDS: ClassVar[tuple[float, str]]
    #: Kind of the schedule that gives its values.
    SCHEDULED: ClassVar[str]

    constant: Number | None = None
    schedule: ScheduleName | None = Field(None, description="Schedule with its values")
    column: str | None = Field(None, description="Measured column with its values")

    @model_validator(mode="after")
    def _one_source(self) -> HumiditySetPoint:
        stated = [key for key in ("constant", "schedule", "column") if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                " and ".join(stated) or "neither",
                "a number, {schedule: name} or {column: name}",
                "Write for instance 'relative_humidity: 0.6'.",
            )
        if self.column is None and getattr(self, "unit", None) is not None:
            raise problem("'unit' without a column", "none", "Remove 'unit:'.")
        return self

    @property
    def measured(self) -> ColumnCourse | None:
        """Course of the column; None without one."""
        if self.column is None:
            return None
        return ColumnCourse(self.KIND, (self.column,), getattr(self, "unit", None) or self.USUAL)

    @property
    def course(self) -> str | None:
        """Name of the schedule or of the course of the column; None for a number."""
        return self.schedule if self.measured is None else self.measured.name

    @property
    def words(self) -> str:
        """The value, or where it comes from."""
        factor, unit = self.WORDS
        if self.constant is not None:
            return f"{factor * float(self.constant):g} {unit}"
        return f"schedule {self.schedule}" if self.schedule is not None else f"column {self.column}"


class RelativeHumiditySetPoint(HumiditySetPoint):
    """A relative humidity that the air is brought to.

    Examples
    --------
    >>> RelativeHumiditySetPoint(constant=0.6).words
    '60 % relative humidity'
    """

    KIND: ClassVar = "relative_humidity"
    USUAL: ClassVar = "-"
    WORDS: ClassVar = (100.0, "% relative humidity")
    SCHEDULED: ClassVar = "fraction"

    constant: q.RelativeHumidity | None = None
    unit: Literal["-", "%"] | None = Field(None, description="Unit of the column; none: -")


class HumidityRatioSetPoint(HumiditySetPoint):
    """A humidity ratio that the air is brought to.

    Examples
    --------
    >>> HumidityRatioSetPoint(constant=0.007).words
    '7 g/kg'
    """

    KIND: ClassVar = "humidity_ratio"
    USUAL: ClassVar = "kg/kg"
    WORDS: ClassVar = (1000.0, "g/kg")
    SCHEDULED: ClassVar = "humidity_ratio"

    constant: q.HumidityRatio | None = None
    unit: Literal["kg/kg", "g/kg"] | None = Field(None, description="Unit of the column; none: kg/kg")


class Humidistat(Part):
    """Ideal drying or humidifying to a set point; its latent heat is counted as a load.

    Examples
    --------
    >>> Humidistat(relative_humidity=0.6).words
    '60 % relative humidity'
    """

    relative_humidity: Annotated[RelativeHumiditySetPoint, Shorthand(number="constant")] | None = Field(
        None, description="Set point of the relative humidity: a number, {schedule: name} or {column: name}"
    )
    humidity_ratio: Annotated[HumidityRatioSetPoint, Shorthand(number="constant")] | None = Field(
        None, description="Set point of the humidity ratio: a number, {schedule: name} or {column: name}"
    )
    capacity: q.LatentCapacity | None = None
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the available fraction of the capacity; none: always 1"
    )

    @model_validator(mode="after")
    def _one_source(self) -> Humidistat:
        stated = [key for key in ("relative_humidity", "humidity_ratio") if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                " and ".join(stated) or "no set point",
                "one of relative_humidity [-] and humidity_ratio [kg/kg]",
                "Write for instance 'drying: {relative_humidity: 0.6}'.",
            )
        return self

    @property
    def setpoint(self) -> tuple[str, HumiditySetPoint]:
        """The set point and its key."""
        if self.relative_humidity is not None:
            return "relative_humidity", self.relative_humidity
        if self.humidity_ratio is None:
            raise TypeError("a humidistat has a set point")
        return "humidity_ratio", self.humidity_ratio

    @property
    def words(self) -> str:
        """The set point in words."""
        return self.setpoint[1].words


class CoolingCoil(Part):
    """Drying by the coil of the ideal cooling: its latent heat follows from the sensible load.

    Examples
    --------
    >>> float(CoolingCoil(sensible_heat_ratio=0.75).coil_temperature)
    10.0
    """

    sensible_heat_ratio: q.SensibleHeatRatio
    coil_temperature: q.CoilTemperature = Number(
        10.0, source=Remark("not given: usual in room units"), assumed=True
    )

    @property
    def words(self) -> str:
        """The coil in words."""
        return f"a coil at {self.coil_temperature:g} degC, sensible heat ratio {self.sensible_heat_ratio:g}"


def _kind_of_drying(raw: Any) -> str:
    keys = set(raw) if isinstance(raw, Mapping) else set()
    is_coil = isinstance(raw, CoolingCoil) or keys & {"sensible_heat_ratio", "coil_temperature"}
    return "coil" if is_coil else "humidistat"


Drying = Annotated[
    Annotated[Humidistat, Tag("humidistat")] | Annotated[CoolingCoil, Tag("coil")],
    Discriminator(_kind_of_drying),
]


class ZoneHumidity(Part):
    """Vapour in the air of a zone: sources, drying, humidifying.

    Examples
    --------
    >>> room = ZoneHumidity(gains={"people": {"power": 100}}, drying={"relative_humidity": 0.6})
    >>> room.drying.words
    '60 % relative humidity'
    """

    storage: q.VapourStorage = Number(1.0, source=Remark("not given: the air alone"), assumed=True)
    gains: dict[Name, VapourGain] = Field(default_factory=dict, description="Sources of vapour by name")
    drying: Drying | None = Field(
        None,
        description="Ideal drying: to a set point {relative_humidity: 0.6}, or by the coil of the cooling "
        "{sensible_heat_ratio: 0.75}; none: no drying",
    )
    humidifying: Humidistat | None = Field(
        None, description="Ideal humidifying to a set point; none: no humidifying"
    )

    @property
    def plants(self) -> dict[str, Humidistat]:
        """Set points, by drying and humidifying."""
        both = {"drying": self.drying, "humidifying": self.humidifying}
        return {name: plant for name, plant in both.items() if isinstance(plant, Humidistat)}


class SurfaceHumidity(Part):
    """What differs at one surface: paint, or no take-up of vapour at all.

    Examples
    --------
    >>> SurfaceHumidity(paint=0.5)
    SurfaceHumidity(paint=0.5 m, sealed=False)
    """

    paint: q.AirThickness | None = None
    sealed: bool = Field(False, description="Whether the surface takes up no vapour, such as tiles")


class Humidity(Part):
    """The vapour balances of all zones; without this section air has no humidity.

    Examples
    --------
    >>> people = {"gains": {"people": {"power": 80}}}
    >>> humidity = Humidity(materials={"board": "gypsum"}, zones={"room": people})
    >>> humidity.materials["board"].like
    'gypsum'
    """

    initial: q.InitialHumidity = Number(0.5, source=Remark("not given: usual indoors"), assumed=True)
    lewis: q.LewisNumber = Number(1.0, source=LEWIS, assumed=True)
    period: q.HumidityPeriod = Number(24.0, source=EMPD, assumed=True)
    deep_period: q.HumidityPeriod | None = None
    materials: dict[MaterialName, Sorption] = Field(
        default_factory=dict,
        description="Moisture content by material: gypsum, plaster, concrete, brick, wood, plywood, carpet, "
        "or {capacity, vapour_resistance}, or {humidities, contents, vapour_resistance}",
    )
    zones: dict[ZoneName, ZoneHumidity] = Field(
        default_factory=dict, description="Sources of vapour, drying and humidifying by zone"
    )
    surfaces: dict[SurfaceName, SurfaceHumidity] = Field(
        default_factory=dict, description="Paint, or no take-up, by surface"
    )
    recovery: dict[Name, q.VapourRecovery] = Field(
        default_factory=dict, description="Effectiveness of the recovery of vapour by ventilation unit"
    )


def with_all_zones(humidity: Humidity | None, zones: Iterable[str]) -> Humidity | None:
    """The same section with every zone of the building, in its order."""
    if humidity is None:
        return None
    by_zone = {name: humidity.zones.get(name) or ZoneHumidity() for name in zones}
    return humidity.model_copy(update={"zones": by_zone})
