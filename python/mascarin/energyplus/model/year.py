"""Values over a year by season and kind of day, and what is calculated from several of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from datetime import date, timedelta
from typing import Any, Final

#: Days of the week in the order of EnergyPlus, then holidays.
DAYS: Final = ("sunday", "monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "holiday")
_WEEKDAYS: Final = ("monday", "tuesday", "wednesday", "thursday", "friday")
_WEEKENDS: Final = ("saturday", "sunday")

#: One day: pairs of the minute from which a value is valid, and the value.
Day = tuple[tuple[int, float], ...]
#: One day of each kind, in the order of `DAYS`.
Week = tuple[Day, ...]


@dataclass(frozen=True)
class Year:
    """Values over a year.

    Attributes
    ----------
    seasons : tuple of (str, Week)
        Last day as ``MM-DD``, and the week that repeats until then.
    name : str
        Name of the only schedule that these values come from; empty without one.
    """

    seasons: tuple[tuple[str, Week], ...]
    name: str = field(default="", compare=False)

    @property
    def values(self) -> set[float]:
        """All values that occur."""
        return {value for _, week in self.seasons for day in week for _, value in day}

    @property
    def constant(self) -> float | None:
        """The value, if there is only one."""
        values = self.values
        return next(iter(values)) if len(values) == 1 else None

    def mean(self) -> float:
        """Mean over the days of the week of all seasons, without regard to their lengths."""
        days = [day for _, week in self.seasons for day in week[:7]]
        return sum(_mean(day) for day in days) / len(days)

    def week_at(self, end: str) -> Week:
        """Week of the season that holds a day ``MM-DD``."""
        return next((week for until, week in self.seasons if end <= until), self.seasons[-1][1])


def _mean(day: Day) -> float:
    ends = [*(minute for minute, _ in day[1:]), 1440]
    return sum(value * (end - start) for (start, value), end in zip(day, ends, strict=True)) / 1440.0


def constant(value: float) -> Year:
    """The same value all year."""
    return Year((("12-31", (((0, float(value)),),) * len(DAYS)),))


def combined(rule: Callable[..., float], *years: Year) -> Year:
    """Value of a function of several values at every time.

    Parameters
    ----------
    rule : callable
        From one value of each to the value.
    *years : Year
        The values.
    """
    ends = sorted({until for year in years for until, _ in year.seasons})
    seasons = []
    for end in ends:
        weeks = [year.week_at(end) for year in years]
        seasons.append((end, tuple(_combined_day(rule, days) for days in zip(*weeks, strict=True))))
    sources = {year.name for year in years if year.constant is None}
    return _merged(Year(tuple(seasons), sources.pop() if len(sources) == 1 else ""))


def ahead(year: Year, first: str, last: str) -> Year:
    """The values an hour earlier from one day to another, as clocks of daylight saving time show them.

    Parameters
    ----------
    year : Year
        Values by the clock.
    first, last : str
        First and last day of daylight saving time as ``MM-DD``; the first may be after the last.
    """
    spans = [(first, last)] if first <= last else [("01-01", last), (first, "12-31")]
    ends = {until for until, _ in year.seasons}
    for start, end in spans:
        ends |= {end, day_before(start)} - {""}
    seasons = []
    for until in sorted(ends):
        week = year.week_at(until)
        summer = any(start <= until <= end for start, end in spans)
        seasons.append((until, _hour_earlier(week) if summer else week))
    return replace(_merged(Year(tuple(seasons))), name=year.name)


def day_before(day: str) -> str:
    """The day before a day ``MM-DD``; empty before the first of the year."""
    if day == "01-01":
        return ""
    return f"{date(2017, int(day[:2]), int(day[3:])) - timedelta(days=1):%m-%d}"


def _hour_earlier(week: Week) -> Week:
    """Each day an hour earlier; its last hour is the first one of the day after it."""
    shifted = []
    for k, day in enumerate(week):
        following = week[(k + 1) % 7] if k < 7 else day
        points = [(max(minute - 60, 0), value) for minute, value in day]
        # Of what is before midnight, only the last value remains.
        points = [(minute, dict(points)[minute]) for minute in sorted({minute for minute, _ in points})]
        points += [(minute + 1380, value) for minute, value in following if minute < 60]
        shifted.append(_without_repeats(points))
    return tuple(shifted)


def _combined_day(rule: Callable[..., float], days: Sequence[Day]) -> Day:
    minutes = sorted({minute for day in days for minute, _ in day})
    return _without_repeats([(minute, rule(*(_value_at(day, minute) for day in days))) for minute in minutes])


def _value_at(day: Day, minute: int) -> float:
    return [value for start, value in day if start <= minute][-1]


def _without_repeats(points: Sequence[tuple[int, float]]) -> Day:
    changes: list[tuple[int, float]] = []
    for minute, value in points:
        if not changes or changes[-1][1] != value:
            changes.append((minute, float(value)))
    return tuple(changes)


def _merged(year: Year) -> Year:
    """Seasons with equal weeks as one."""
    seasons: list[tuple[str, Week]] = []
    for until, week in year.seasons:
        if seasons and seasons[-1][1] == week:
            seasons.pop()
        seasons.append((until, week))
    return Year(tuple(seasons), year.name)


def year_of(seasons: Sequence[tuple[str, Week]]) -> Year:
    """A year from its seasons, in order; points that change nothing are left out."""
    tidy = [(until, tuple(_without_repeats(day) for day in week)) for until, week in seasons]
    return _merged(Year(tuple(tidy)))


def plain(year: Year, kind: str, holidays: Sequence[str]) -> dict[str, Any]:
    """A schedule of the description.

    Parameters
    ----------
    year : Year
        The values.
    kind : str
        ``fraction`` or ``temperature``.
    holidays : sequence of str
        Dates of the holidays as ``MM-DD``; without them the profile of holidays is left out.
    """
    constant_value = year.constant
    if constant_value is not None:
        return {"kind": kind, "value": _number(constant_value)}
    weeks = [week if holidays else week[:7] for _, week in year.seasons]
    own_holidays = any(week[7] != week[1] for week in weeks) if holidays else False
    profiles = [_profiles(week, own_holidays) for week in weeks]
    if len(profiles) == 1:
        schedule: dict[str, Any] = {"kind": kind, "days": profiles[0]}
    else:
        ends = [until for until, _ in year.seasons]
        pairs = zip(ends, profiles, strict=True)
        schedule = {"kind": kind, "seasons": [{"until": end, "days": days} for end, days in pairs]}
    return schedule | ({"holidays": list(holidays)} if own_holidays else {})


def _profiles(week: Week, own_holidays: bool) -> dict[str, Any]:
    """Profiles of a week with as few names as possible."""
    days = {name: week[k] for k, name in enumerate(DAYS[:7])}
    holiday = {"holidays": _points(week[7])} if own_holidays else {}
    if len(set(days.values())) == 1:
        return {"all": _points(week[0])} | holiday
    profiles: dict[str, Any] = {}
    for group, names in (("weekdays", _WEEKDAYS), ("weekends", _WEEKENDS)):
        common = max(names, key=lambda name: sum(days[name] == days[other] for other in names))
        profiles[group] = _points(days[common])
        profiles |= {name: _points(days[name]) for name in names if days[name] != days[common]}
    return profiles | holiday


def _points(day: Day) -> list[dict[str, Any]]:
    return [{"at": f"{m // 60:02d}:{m % 60:02d}", "value": _number(value)} for m, value in day]


def _number(value: float) -> float | int:
    rounded = round(value, 9)
    return int(rounded) if rounded == int(rounded) and abs(rounded) < 1e9 else rounded
