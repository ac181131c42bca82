"""Schedules: a fraction, a temperature or a humidity ratio over days, weeks and holidays."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from datetime import date
from typing import Annotated, ClassVar, Final, Literal

from pydantic import AfterValidator, Field, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.base.number import problem, shown
from mascarin.building.base.part import Part, fault, insist

DAYS: Final = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")
"""Names of the days of the week, in the order of `datetime.date.weekday`."""

#: Start and end of a part of a day [min], value at its start and at its end.
Piece = tuple[float, float, float, float]

_DAY_MINUTES: Final = 1440.0


def _clock_time(text: str) -> str:
    if not re.fullmatch(r"([01]\d|2[0-3]):[0-5]\d", text):
        raise problem(shown(text), 'a time of day, "00:00" to "23:59"', 'Write it as at: "07:30".')
    return text


def _holiday(text: str) -> str:
    try:
        # 2000 is a leap year: "02-29" is a day.
        date.fromisoformat(text if len(text) > len("12-25") else f"2000-{text}")
    except ValueError:
        raise problem(
            shown(text),
            'a date: "12-25" in every year, or "2024-05-20"',
            "Write month and day with two digits.",
        ) from None
    return text


ClockTime = Annotated[str, AfterValidator(_clock_time)]
Holiday = Annotated[str, AfterValidator(_holiday)]


class FractionPoint(Part):
    """A fraction from a time of day on.

    Examples
    --------
    >>> FractionPoint(at="08:00", value=1)
    FractionPoint(at=08:00, value=1)
    """

    at: ClockTime = Field(description='Time of day, "07:30"')
    value: q.ScheduledFraction
    ramp_to: q.ScheduledFraction | None = Field(
        None, description="Value that is reached linearly at the next point"
    )


class TemperaturePoint(Part):
    """A temperature from a time of day on.

    Examples
    --------
    >>> TemperaturePoint(at="07:00", value=15, ramp_to=20)
    TemperaturePoint(at=07:00, value=15 degC, ramp_to=20 degC)
    """

    at: ClockTime = Field(description='Time of day, "07:30"')
    value: q.ScheduledTemperature
    ramp_to: q.ScheduledTemperature | None = Field(
        None, description="Value that is reached linearly at the next point"
    )


class HumidityRatioPoint(Part):
    """A humidity ratio from a time of day on.

    Examples
    --------
    >>> HumidityRatioPoint(at="07:00", value=0.007)
    HumidityRatioPoint(at=07:00, value=0.007 kg/kg)
    """

    at: ClockTime = Field(description='Time of day, "07:30"')
    value: q.ScheduledHumidityRatio
    ramp_to: q.ScheduledHumidityRatio | None = Field(
        None, description="Value that is reached linearly at the next point"
    )


Point = FractionPoint | TemperaturePoint | HumidityRatioPoint


class _Days(Part):
    """Profiles by kind of day; the most specific name is used: monday before weekdays before all."""

    @model_validator(mode="after")
    def _sound(self) -> _Days:
        insist(*self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        for key in type(self).model_fields:
            points: tuple[Point, ...] | None = getattr(self, key)
            if points is not None:
                yield from _in_order(key, points)
        missing = [day for day in DAYS if self.profile(DAYS.index(day)) is None]
        if missing:
            yield fault(
                (missing[0],),
                f"no profile for {', '.join(missing)}",
                "a profile for every day of the week",
                "Add 'all:', 'weekdays:', 'weekends:' or the days themselves.",
            )

    def profile(self, weekday: int, *, holiday: bool = False) -> tuple[Point, ...] | None:
        """Points of a day of the week (0: Monday), or of a holiday."""
        group = "weekends" if weekday >= 5 else "weekdays"
        keys = (*(("holidays",) if holiday else ()), DAYS[weekday], group, "all")
        candidates = (getattr(self, key) for key in keys)
        return next((points for points in candidates if points is not None), None)


class FractionDays(_Days):
    """Profiles of a fraction by kind of day.

    Examples
    --------
    >>> FractionDays(all=[{"at": "00:00", "value": 0.5}])
    FractionDays(all=[FractionPoint])
    """

    all: tuple[FractionPoint, ...] | None = Field(None, description="Profile of all days")
    weekdays: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Monday to Friday")
    weekends: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Saturday and Sunday")
    monday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Mondays")
    tuesday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Tuesdays")
    wednesday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Wednesdays")
    thursday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Thursdays")
    friday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Fridays")
    saturday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Saturdays")
    sunday: tuple[FractionPoint, ...] | None = Field(None, description="Profile of Sundays")
    holidays: tuple[FractionPoint, ...] | None = Field(None, description="Profile of holidays")


class TemperatureDays(_Days):
    """Profiles of a temperature by kind of day.

    Examples
    --------
    >>> TemperatureDays(all=[{"at": "00:00", "value": 20}])
    TemperatureDays(all=[TemperaturePoint])
    """

    all: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of all days")
    weekdays: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Monday to Friday")
    weekends: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Saturday and Sunday")
    monday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Mondays")
    tuesday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Tuesdays")
    wednesday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Wednesdays")
    thursday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Thursdays")
    friday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Fridays")
    saturday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Saturdays")
    sunday: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of Sundays")
    holidays: tuple[TemperaturePoint, ...] | None = Field(None, description="Profile of holidays")


class HumidityRatioDays(_Days):
    """Profiles of a humidity ratio by kind of day.

    Examples
    --------
    >>> HumidityRatioDays(all=[{"at": "00:00", "value": 0.007}])
    HumidityRatioDays(all=[HumidityRatioPoint])
    """

    all: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of all days")
    weekdays: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Monday to Friday")
    weekends: tuple[HumidityRatioPoint, ...] | None = Field(
        None, description="Profile of Saturday and Sunday"
    )
    monday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Mondays")
    tuesday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Tuesdays")
    wednesday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Wednesdays")
    thursday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Thursdays")
    friday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Fridays")
    saturday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Saturdays")
    sunday: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of Sundays")
    holidays: tuple[HumidityRatioPoint, ...] | None = Field(None, description="Profile of holidays")


def _last_day(text: str) -> str:
    if not re.fullmatch(r"\d\d-\d\d", text):
        raise problem(shown(text), 'a day of the year, "03-31"', "Write month and day with two digits.")
    return _holiday(text)


LastDay = Annotated[str, AfterValidator(_last_day)]


class FractionSeason(Part):
    """Profiles of a fraction for a part of the year.

    Examples
    --------
    >>> FractionSeason(until="12-31", days={"all": [{"at": "00:00", "value": 1}]}).until
    '12-31'
    """

    until: LastDay = Field(description='Last day, "03-31"; it begins after that of the season before')
    days: FractionDays = Field(description="Profiles by kind of day")


class TemperatureSeason(Part):
    """Profiles of a temperature for a part of the year.

    Examples
    --------
    >>> TemperatureSeason(until="12-31", days={"all": [{"at": "00:00", "value": 20}]}).until
    '12-31'
    """

    until: LastDay = Field(description='Last day, "03-31"; it begins after that of the season before')
    days: TemperatureDays = Field(description="Profiles by kind of day")


class HumidityRatioSeason(Part):
    """Profiles of a humidity ratio for a part of the year.

    Examples
    --------
    >>> HumidityRatioSeason(until="12-31", days={"all": [{"at": "00:00", "value": 0.007}]}).until
    '12-31'
    """

    until: LastDay = Field(description='Last day, "03-31"; it begins after that of the season before')
    days: HumidityRatioDays = Field(description="Profiles by kind of day")


def schedule_channel(name: str) -> str:
    """Name of the channel of the forcing that holds a schedule."""
    return f"schedule {name}"


class _Schedule(Part):
    """What all schedules have in common."""

    WAYS: ClassVar = ("value", "days", "seasons", "column")

    column: str | None = Field(None, description="Measured column with the values")
    holidays: tuple[Holiday, ...] = Field(
        (), description='Holidays: "12-25" in every year, or dates such as "2024-05-20"'
    )

    @model_validator(mode="after")
    def _sound(self) -> _Schedule:
        stated = [way for way in self.WAYS if getattr(self, way) is not None]
        if len(stated) != 1:
            raise problem(
                " and ".join(stated) or "a schedule without values",
                f"exactly one of {', '.join(self.WAYS)}",
                "A schedule is one value, profiles of days, those of seasons, or a measured column.",
            )
        insist(*self._seasons_in_order(), *self._inactive_holidays())
        return self

    def _seasons_in_order(self) -> Iterator[InitErrorDetails]:
        seasons = getattr(self, "seasons", None)
        if seasons is None:
            return
        ends = [season.until for season in seasons]
        if not ends or ends[-1] != "12-31" or sorted(set(ends)) != ends:
            yield fault(
                ("seasons",),
                f"seasons until {', '.join(ends) or 'no day'}",
                'last days in the order of the year, the last one "12-31"',
                "Sort them, each day once.",
            )

    def _inactive_holidays(self) -> Iterator[InitErrorDetails]:
        has_holidays = any(days.profile(0, holiday=True) is not days.profile(0) for days in self.profiles)
        if self.holidays and not has_holidays:
            yield fault(
                ("holidays",),
                "dates, but no profile for them",
                "days.holidays as well",
                "Add it or remove them.",
            )
        if has_holidays and not self.holidays:
            yield fault(
                ("days", "holidays"), "a profile, but no dates", "the dates under 'holidays:'", "List them."
            )

    @property
    def columns(self) -> tuple[str, ...]:
        """The measured column; empty without one."""
        return () if self.column is None else (self.column,)

    @property
    def scale(self) -> float:
        """Factor from the unit of a column to that of the schedule: they are the same."""
        return 1.0

    @property
    def profiles(self) -> tuple[FractionDays | TemperatureDays | HumidityRatioDays, ...]:
        """Profiles by kind of day, of each season; none for one value or a column."""
        days, seasons = getattr(self, "days", None), getattr(self, "seasons", None)
        return tuple(season.days for season in seasons or ()) or ((days,) if days is not None else ())

    def season(self, day: date) -> int:
        """Index of the season of a date; 0 without seasons."""
        seasons = getattr(self, "seasons", None) or ()
        return next((k for k, entry in enumerate(seasons) if f"{day:%m-%d}" <= entry.until), 0)

    def pieces(self, weekday: int, *, holiday: bool = False, season: int = 0) -> list[Piece]:
        """One day as linear pieces; none for a measured column.

        Parameters
        ----------
        weekday : int
            Day of the week, 0 for Monday.
        holiday : bool
            Whether it is a holiday.
        season : int
            Index of the season; see `season`.

        Returns
        -------
        list of (start, end, value at the start, value at the end)
            In order, from 0 to 1440. [min, min, unit of the schedule, likewise]
        """
        value = getattr(self, "value", None)
        if value is not None:
            return [(0.0, _DAY_MINUTES, float(value), float(value))]
        points = self.profiles[season].profile(weekday, holiday=holiday) if self.profiles else None
        if points is None:
            return []
        starts = [_minutes(point.at) for point in points]
        ends = [*starts[1:], _DAY_MINUTES]
        return [
            (start, end, float(point.value), float(point.value if point.ramp_to is None else point.ramp_to))
            for start, end, point in zip(starts, ends, points, strict=True)
        ]

    def is_holiday(self, day: date) -> bool:
        """Whether a date is one of the holidays."""
        return f"{day:%m-%d}" in self.holidays or day.isoformat() in self.holidays


class FractionSchedule(_Schedule):
    """A fraction from 0 to 1 over time; a run uses its mean over a step.

    Examples
    --------
    >>> presence = FractionSchedule(
    ...     days={"all": [{"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}]}
    ... )
    >>> presence.pieces(weekday=0)
    [(0.0, 480.0, 0.0, 0.0), (480.0, 1440.0, 1.0, 1.0)]
    """

    kind: Literal["fraction"] = "fraction"
    value: q.ScheduledFraction | None = None
    days: FractionDays | None = Field(None, description="Profiles by kind of day")
    seasons: tuple[FractionSeason, ...] | None = Field(
        None, description="Profiles that change in the course of the year, in order"
    )


class TemperatureSchedule(_Schedule):
    """A temperature over time; a run uses its value at the end of a step.

    Examples
    --------
    >>> float(TemperatureSchedule(value=20).value)
    20.0
    """

    kind: Literal["temperature"] = "temperature"
    value: q.ScheduledTemperature | None = None
    days: TemperatureDays | None = Field(None, description="Profiles by kind of day")
    seasons: tuple[TemperatureSeason, ...] | None = Field(
        None, description="Profiles that change in the course of the year, in order"
    )


class HumidityRatioSchedule(_Schedule):
    """A humidity ratio over time; a run uses its mean over a step.

    Examples
    --------
    >>> float(HumidityRatioSchedule(value=0.007).value)
    0.007
    """

    kind: Literal["humidity_ratio"] = "humidity_ratio"
    value: q.ScheduledHumidityRatio | None = None
    days: HumidityRatioDays | None = Field(None, description="Profiles by kind of day")
    seasons: tuple[HumidityRatioSeason, ...] | None = Field(
        None, description="Profiles that change in the course of the year, in order"
    )


Schedule = Annotated[
    FractionSchedule | TemperatureSchedule | HumidityRatioSchedule, Field(discriminator="kind")
]


def _minutes(clock: str) -> float:
    hours, minutes = clock.split(":")
    return 60.0 * int(hours) + int(minutes)


def _in_order(key: str, points: Sequence[Point]) -> Iterator[InitErrorDetails]:
    if not points:
        yield fault((key,), "no points", 'at least one, at "00:00"', "List {at: ..., value: ...}.")
        return
    if points[0].at != "00:00":
        yield fault(
            (key, 0, "at"),
            f'"{points[0].at}"',
            'the first point of a day at "00:00"',
            'Add a point at "00:00".',
        )
    for index in range(1, len(points)):
        if not points[index - 1].at < points[index].at:
            yield fault(
                (key, index, "at"),
                f'"{points[index].at}" after "{points[index - 1].at}"',
                "points in the order of the day, each time once",
                "Sort them.",
            )
