"""Openings that wind and stack drive air through in a network of zones, and controls of openings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ControlName, ScheduleName, SurfaceName, ZoneName
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.base.time_series import ColumnCourse

SWAMI_CHANDRA: Final = (
    "Swami & Chandra 1988, ASHRAE Trans. 94(1), 243-266 (wind pressure on walls of low buildings)"
)
ORIFICE: Final = "ASHRAE Handbook of Fundamentals 2017, ch. 16 (flow through openings by pressure)"


#: Conditions of a control, in the order in which they are shown.
CONDITIONS: Final = ("indoor", "outdoor", "difference", "indoor_below", "outdoor_below", "wind", "rain")


class _Wind(Part):
    """The wind that pressure coefficients refer to."""

    shelter: q.Shelter = Number(1.0, source=Remark("not given: nothing stands in front"), assumed=True)
    height: q.Height | None = Field(None, description="Height above ground of that wind; none: `elevation`")


class LowRise(_Wind):
    """Wind pressure on a wall of a low building by Swami & Chandra (1988), from the angle of the wind.

    Examples
    --------
    >>> LowRise(side_ratio=1.5).kind
    'low_rise'
    """

    kind: Literal["low_rise"] = "low_rise"
    side_ratio: q.SideRatio = Number(1.0, source=Remark("not given: a square plan"), assumed=True)


class PressureTable(_Wind):
    """Wind pressure coefficients at equal angles of a whole turn: the first along the normal, then clockwise.

    Examples
    --------
    >>> len(PressureTable(coefficients=[0.6, 0.2, -0.5, -0.4, -0.3, -0.4, -0.5, 0.2]).coefficients)
    8
    """

    kind: Literal["table"] = "table"
    coefficients: tuple[q.PressureCoefficient, ...] = Field(
        min_length=1, description="Coefficients; a single one holds for all directions"
    )


class NoWind(Part):
    """No wind reaches the opening: it is driven by stack, and by the wind on others.

    Examples
    --------
    >>> NoWind().kind
    'none'
    """

    kind: Literal["none"] = "none"


WindPressure = Annotated[
    LowRise | PressureTable | NoWind, Field(discriminator="kind"), Shorthand(word="kind")
]


class Vent(Part):
    """An opening of the pressure network: a window that opens, a louvre, a door, a leak.

    It joins a zone with outdoors (``zone``), or two zones (``between``). Pressures of wind and stack drive
    ``C_d A sqrt(2 dp/rho)`` through it; a tall one lets air pass both ways.

    Examples
    --------
    >>> Vent(zone="room", azimuth=90, area=1.2, height=1, elevation=1.5, pressure="low_rise").pressure.kind
    'low_rise'
    >>> float(Vent(between=("room", "hall"), area=1.8, height=2, elevation=1).discharge)
    0.65
    """

    advice: ClassVar[Mapping[str, str]] = {
        "width": "Give the free area and the height: 'area:' and 'height:'.",
        "side_ratio": "It belongs to the wind: 'pressure: {kind: low_rise, side_ratio: 1.5}'.",
        "shelter": "It belongs to the wind: 'pressure: {kind: low_rise, shelter: 0.5}'.",
        "wind_coefficient": "Give 'pressure:', or describe it under 'openings:', which has no network.",
    }

    zone: ZoneName | None = Field(None, description="Name of the zone that it joins with outdoors")
    between: tuple[ZoneName, ZoneName] | None = Field(
        None, description="Names of the two zones that it joins"
    )
    area: q.OpeningArea
    height: q.VentHeight | None = None
    elevation: q.Elevation
    discharge: q.Discharge = Number(0.65, source=ORIFICE, assumed=True)
    exponent: q.FlowExponent = Number(0.5, source=Remark("not given: an orifice"), assumed=True)
    surface: SurfaceName | None = Field(
        None, description="Name of the surface it is in, which gives the direction; or `azimuth`"
    )
    azimuth: q.Azimuth | None = None
    pressure: WindPressure | None = Field(
        None, description="Wind pressure: low_rise, table with coefficients, or none; not between zones"
    )
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the area that is open; none: always 1"
    )
    control: ControlName | None = Field(
        None, description="Name of the control that opens and closes it; none: not controlled"
    )

    @model_validator(mode="after")
    def _ends(self) -> Vent:
        if (self.zone is None) == (self.between is None):
            raise problem(
                "both 'zone' and 'between'" if self.zone else "neither 'zone' nor 'between'",
                "one of them: 'zone' for an opening to outdoors, 'between' for one from zone to zone",
                "Name the zone, or the two zones.",
            )
        if self.between is not None and self.between[0] == self.between[1]:
            raise problem(f"'{self.between[0]}' twice", "two different zones", "Name the other zone.")
        return self

    @model_validator(mode="after")
    def _wind(self) -> Vent:
        stated = [key for key in ("surface", "azimuth", "pressure") if getattr(self, key) is not None]
        if self.between is not None:
            if stated:
                raise problem(
                    f"{' and '.join(stated)} of an opening between zones",
                    "none of them: no wind reaches it",
                    "Remove them.",
                )
            return self
        if self.pressure is None:
            raise problem(
                "no 'pressure' of an opening to outdoors",
                "'pressure: low_rise' for a wall of a low building, '{kind: table, coefficients: [...]}', or "
                "'none' where no wind reaches it",
                "Add 'pressure:'.",
            )
        if self.surface is not None and self.azimuth is not None:
            raise problem("surface and azimuth", "one of them", "Remove one: each gives the direction.")
        if self.directed and len(stated) == 1:
            raise problem(
                "no direction of an opening that the wind reaches",
                "'surface: NAME' of the wall it is in, or 'azimuth:'",
                "Add one of them.",
            )
        return self

    @property
    def directed(self) -> bool:
        """Whether its wind pressure depends on the direction of the wind."""
        pressure = self.pressure
        return isinstance(pressure, LowRise) or (
            isinstance(pressure, PressureTable) and len(pressure.coefficients) > 1
        )

    @property
    def windy(self) -> bool:
        """Whether the wind reaches it."""
        return isinstance(self.pressure, LowRise | PressureTable)

    @property
    def ends(self) -> tuple[str, ...]:
        """Names of its zones."""
        return self.between or (str(self.zone),)


class _Band(Part):
    """Two limits with a distance between them: opening and closing again and again is avoided."""

    ABOVE: ClassVar = True
    open: q.ControlTemperature
    close: q.ControlTemperature

    @model_validator(mode="after")
    def _apart(self) -> _Band:
        right = self.open >= self.close if self.ABOVE else self.open <= self.close
        if not right:
            order = (
                "'open' at least as large as 'close'" if self.ABOVE else "'open' at most as large as 'close'"
            )
            side = "above" if self.ABOVE else "below"
            raise problem(
                f"open: {self.open:g}, close: {self.close:g}",
                order,
                f"It opens {side} 'open' and closes on the other side of 'close'. Exchange them.",
            )
        return self


class TemperatureBand(_Band):
    """Open above a temperature, closed below another one.

    Examples
    --------
    >>> TemperatureBand(open=24, close=22)
    TemperatureBand(open=24 degC, close=22 degC)
    """


class LowBand(_Band):
    """Open below a temperature, closed above another one.

    Examples
    --------
    >>> LowBand(open=26, close=28)
    LowBand(open=26 degC, close=28 degC)
    """

    ABOVE: ClassVar = False


class DifferenceBand(_Band):
    """Open above a temperature difference, closed below another one.

    Examples
    --------
    >>> DifferenceBand(open=2, close=0.5)
    DifferenceBand(open=2 K, close=0.5 K)
    """

    open: q.ControlDifference
    close: q.ControlDifference


class WindBand(_Band):
    """Open up to a wind speed, closed above another one.

    Examples
    --------
    >>> WindBand(open=6, close=8)
    WindBand(open=6 m/s, close=8 m/s)
    """

    ABOVE: ClassVar = False
    open: q.ControlSpeed
    close: q.ControlSpeed


class RainBand(_Band):
    """Open up to a rain intensity of a column, closed above another one.

    Examples
    --------
    >>> RainBand(column="rain").course.name
    'rain [mm/h]'
    """

    ABOVE: ClassVar = False
    column: str = Field(description="Column of the weather or the measurements with the rain [mm/h]")
    open: q.ControlRain = Number(0.0, source=Remark("not given: no rain"), assumed=True)
    close: q.ControlRain = Number(0.0, source=Remark("not given: any rain"), assumed=True)

    @property
    def course(self) -> ColumnCourse:
        """The column as a course over time."""
        return ColumnCourse("rain", (self.column,), "mm/h")


class VentControl(Part):
    """What opens and closes openings: they open where all conditions let them, and close where one does not.

    A control decides at the beginning of each step, and keeps its state for the minimum times.

    Examples
    --------
    >>> night = VentControl(zone="room", indoor={"open": 24, "close": 22}, difference={"open": 2, "close": 1})
    >>> [name for name, _ in night.conditions]
    ['indoor', 'difference']
    """

    zone: ZoneName = Field(description="Name of the zone whose air temperature it measures")
    indoor: TemperatureBand | None = Field(None, description="Air temperature of the zone above limits")
    outdoor: TemperatureBand | None = Field(None, description="Outdoor air temperature above limits")
    difference: DifferenceBand | None = Field(
        None, description="Air temperature of the zone less that outdoors or of the reference, above limits"
    )
    reference_zone: ZoneName | None = Field(
        None, description="Name of the zone that 'difference' is taken to; none: the outdoor air"
    )
    indoor_below: LowBand | None = Field(None, description="Air temperature of the zone below limits")
    outdoor_below: LowBand | None = Field(None, description="Outdoor air temperature below limits")
    wind: WindBand | None = Field(None, description="Wind speed at the mast below limits")
    rain: RainBand | None = Field(None, description="Rain below limits")
    minimum_open_time: q.MinimumTime | None = Field(
        None, description="Time for which it stays open, unless wind or rain close it; none: 0"
    )
    minimum_closed_time: q.MinimumTime | None = Field(
        None, description="Time for which it stays closed; none: 0"
    )

    @model_validator(mode="after")
    def _conditioned(self) -> VentControl:
        if not list(self.conditions):
            raise problem(
                "a control without conditions",
                f"at least one of {', '.join(CONDITIONS)}",
                "Add 'indoor: {open: 24, close: 22}', for example.",
            )
        if self.reference_zone is not None and (self.difference is None or self.reference_zone == self.zone):
            raise problem(
                "reference_zone "
                + ("without difference" if self.difference is None else f"'{self.zone}', the zone itself"),
                "the other zone of a 'difference'",
                "Add 'difference: {open: 2, close: 1}', name another zone, or remove 'reference_zone'.",
            )
        return self

    @property
    def by_temperature(self) -> bool:
        """Whether a temperature is among its conditions."""
        return any(name not in ("wind", "rain") for name, _ in self.conditions)

    @property
    def conditions(self) -> Iterator[tuple[str, _Band]]:
        """Its conditions by name."""
        for name in CONDITIONS:
            band = getattr(self, name)
            if band is not None:
                yield name, band
