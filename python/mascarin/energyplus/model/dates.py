"""Dates of a model: the year that is simulated, special days, daylight saving time, time steps."""

from __future__ import annotations

import calendar
import re
from datetime import date, timedelta
from typing import Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.tables.timezones import YEARS

_MONTHS: Final = {name.casefold(): k for k, name in enumerate(calendar.month_name) if name} | {
    name.casefold(): k for k, name in enumerate(calendar.month_abbr) if name
}

#: Numbers of time steps in an hour that EnergyPlus takes.
_STEPS: Final = (1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30, 60)


@reads("RunPeriod")
def calendar_year(context: Context) -> int:
    """Year without a 29 February whose days of the week are those of the run period."""
    item = context.model.one("RunPeriod")
    if item is None:
        return 2017
    begin_year = item.number("begin_year", "start_year")
    if begin_year is not None and not YEARS[0] <= begin_year <= YEARS[1]:
        raise item.error(
            f"begin_year: found {begin_year:g}", f"a year from {YEARS[0]} to {YEARS[1]}", "Correct it"
        )
    if begin_year is not None and not calendar.isleap(int(begin_year)):
        return int(begin_year)
    month, day = int(item.number("begin_month") or 1), int(item.number("begin_day_of_month") or 1)
    names = [name.casefold() for name in calendar.day_name]
    word = item.word("day_of_week_for_start_day")
    weekday = names.index(word) if word in names else 6
    if begin_year is not None and word not in names:
        weekday = day_of(item, int(begin_year), month, day).weekday()
    years = [2017, 2018, 2019, 2014, 2015, 2010, 2011]
    return next(candidate for candidate in years if day_of(item, candidate, month, day).weekday() == weekday)


def day_of(item: IdfObject, in_year: int, month: int, day: int) -> date:
    """A day of a year; 29 February counts as the 28th.

    Raises
    ------
    InputError
        There is no such day.
    """
    try:
        return date(in_year, month, 28 if (month, day) == (2, 29) else day)
    except (ValueError, OverflowError):
        raise item.error(f"found the day {month}/{day}", "a day of the year", "Correct the date") from None


@reads("RunPeriodControl:SpecialDays")
def special_days(context: Context) -> list[tuple[date, int, str]]:
    """First day, number of days, and kind of the special days of the file."""
    days = []
    for item in context.model.of("RunPeriodControl:SpecialDays"):
        kind = item.word("special_day_type") or "customday2"
        first = date_in(item, item.text("start_date"), calendar_year(context))
        days.append((first, int(item.number("duration") or 1), kind))
    return days


def holidays(context: Context) -> list[str]:
    """Holidays of the file, as ``MM-DD``, in order."""
    return sorted(
        f"{first + timedelta(days=k):%m-%d}"
        for first, duration, kind in special_days(context)
        if kind == "holiday"
        for k in range(duration)
    )


def date_in(item: IdfObject, text: str, in_year: int) -> date:
    """A date such as 12/25, December 25, 25 Dec, 4th Thursday in November, Last Monday in May."""
    words = re.findall(r"[a-z]+|\d+", text.casefold())
    numbers = [int(word) if len(word) < 9 else 0 for word in words if word.isdigit()]  # no day is 0
    months = [_MONTHS[word] for word in words if word in _MONTHS]
    weekday = next((k for k, name in enumerate(calendar.day_name) if name.casefold() in words), None)
    try:
        if weekday is not None and months:
            days = [
                date(in_year, months[0], d)
                for d in range(1, calendar.monthrange(in_year, months[0])[1] + 1)
                if date(in_year, months[0], d).weekday() == weekday
            ]
            return days[-1] if "last" in words else days[numbers[0] - 1]
        if months:
            return date(in_year, months[0], numbers[0])
        return date(in_year, numbers[0], numbers[1])
    except (IndexError, ValueError):
        raise item.error(f"found a date '{text}'", "a day such as 12/25", "Correct the date") from None


def last_day(item: IdfObject, text: str) -> str:
    """A last day as ``MM-DD``; 29 February counts as the 28th."""
    cleaned = re.sub(r"\b0?2/29\b", "2/28", text)
    return f"{date_in(item, cleaned, 2017):%m-%d}"


@reads("RunPeriodControl:DaylightSavingTime")
def summer_time(context: Context) -> tuple[str, str] | None:
    """First and last day of daylight saving time as ``MM-DD``; None without it."""
    item = context.model.one("RunPeriodControl:DaylightSavingTime")
    if item is None:
        return None
    days = [date_in(item, item.text(key), calendar_year(context)) for key in ("start_date", "end_date")]
    return f"{days[0]:%m-%d}", f"{days[1]:%m-%d}"


@reads("Timestep")
def steps_per_hour(context: Context) -> int:
    """Number of time steps of EnergyPlus in an hour."""
    item = context.model.one("Timestep")
    number = item.number("number_of_timesteps_per_hour") if item is not None else None
    if item is None or not number:
        return 6
    feasible = min(_STEPS, key=lambda steps: abs(steps - number))
    if feasible != number:
        context.findings.approximated(item, f"{number:g} steps in an hour", f"{feasible}, as in EnergyPlus")
    return feasible
