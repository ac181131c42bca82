"""Schedules of EnergyPlus as years: compact, year/week/day, constant, file."""

from __future__ import annotations

import bisect
import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from datetime import date, timedelta
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from mascarin._io.regular import require_regular
from mascarin._io.tables import csv_refused
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.dates import holidays, last_day, special_days, steps_per_hour, summer_time
from mascarin.energyplus.model.field_checks import finite
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.year import (
    DAYS,
    Day,
    Week,
    Year,
    ahead,
    combined,
    constant,
    day_before,
    plain,
    year_of,
)

SCHEDULES: Final = (
    "Schedule:Compact",
    "Schedule:Constant",
    "Schedule:Year",
    "Schedule:File",
    "Schedule:File:Shading",
    "ExternalInterface:Schedule",
    "ExternalInterface:FunctionalMockupUnitImport:To:Schedule",
    "ExternalInterface:FunctionalMockupUnitExport:To:Schedule",
)
_WEEKS: Final = ("Schedule:Week:Daily", "Schedule:Week:Compact")
_DAYS: Final = ("Schedule:Day:Hourly", "Schedule:Day:Interval", "Schedule:Day:List")
#: Kinds of days that occur only where special days name them, and all kinds of a parsed week.
_SPECIAL: Final = ("summerdesignday", "winterdesignday", "customday1", "customday2")
_KINDS: Final = (*DAYS, *_SPECIAL)
#: Words of kinds of days, each also as a part of a longer word, as EnergyPlus finds them.
_GROUPS: Final = {
    "alldays": _KINDS,
    "weekday": ("monday", "tuesday", "wednesday", "thursday", "friday"),
    "weekend": ("saturday", "sunday"),
    **{day: (day,) for day in DAYS},
    **{day.removesuffix("designday"): (day,) for day in _SPECIAL},
}
#: Words of EnergyPlus for the values of steps between the times of a schedule, the older ones included.
_BETWEEN: Final = {"no": "no", "": "no", "yes": "average", "average": "average", "linear": "linear"}
#: Set points that never act, in place of heating or cooling that is not available [degC].
NEVER_HEATS, NEVER_COOLS = -50.0, 80.0


@reads(*SCHEDULES)
def year(context: Context, user: IdfObject, *keys: str, default: float = 1.0) -> Year:
    """Values of the schedule that a field names; the default all year where it names none.

    Raises
    ------
    InputError
        The schedule does not exist or cannot be read.
    """
    key = next((key for key in keys if user.text(key)), None)
    if key is None:
        return constant(default)
    item = context.model.require(user, key, *SCHEDULES)
    held = context.years
    if item.name.casefold() not in held:
        summer = summer_time(context)
        values = _year(context, item)
        values = _with_special_days(context, values)
        held[item.name.casefold()] = replace(
            values if summer is None else ahead(values, *summer), name=item.name
        )
    return held[item.name.casefold()]


def _year(context: Context, item: IdfObject) -> Year:
    if item.kind == "Schedule:Constant":
        return constant(item.number("hourly_value") or 0.0)
    if item.kind == "Schedule:Compact":
        return _compact(context, item)
    if item.kind == "Schedule:Year":
        return _weeks(context, item)
    if item.kind == "Schedule:File":
        return _file(context, item)
    context.findings.left_out(
        item, "values from another program or file", "its first value, or 0, is used all year"
    )
    return constant(item.number("initial_value") or 0.0)


def fraction(context: Context, name: str, values: Year) -> tuple[str | None, float]:
    """Enter a schedule of a fraction.

    Parameters
    ----------
    context : Context
        The conversion.
    name : str
        Name of the schedule, in words.
    values : Year
        Values, none below 0.

    Returns
    -------
    tuple of (str or None, float)
        Its name, None where the value is the same all year, and the factor by which it is to be multiplied:
        fractions of Mascarin are at most 1.
    """
    constant_value = values.constant
    if constant_value is not None:
        return None, constant_value
    most = max(1.0, *values.values)
    return _entered(context, name, combined(lambda value: value / most, values), "fraction"), most


def temperature(context: Context, name: str, values: Year) -> str | float:
    """Enter a schedule of a temperature; the number where it is the same all year. [degC]"""
    constant_value = values.constant
    return constant_value if constant_value is not None else _entered(context, name, values, "temperature")


def _entered(context: Context, name: str, values: Year, kind: str) -> str:
    """Name of a schedule with these values; one that is there already, if it is equal."""
    description = plain(values, kind, holidays(context))
    key = repr(description)
    if key not in context.shapes:
        free = context.names.new("schedules", values.name or name)
        if values.name:
            context.names.original.setdefault("schedules", {}).setdefault(values.name, free)
        context.section("schedules")[free] = description
        context.shapes[key] = free
    return context.shapes[key]


def _with_special_days(context: Context, values: Year) -> Year:
    """A year of weeks with all kinds of days as one of the usual kinds: special days are seasons."""
    if len(values.seasons[0][1]) == len(DAYS):
        return values
    special = {
        f"{first + timedelta(days=k):%m-%d}": _KINDS.index(kind)
        for first, duration, kind in special_days(context)
        if kind in _SPECIAL
        for k in range(duration)
    }
    ends = {until for until, _ in values.seasons}
    for day in special:
        ends |= {day, day_before(day)}
    seasons = []
    for until in sorted(ends - {""}):
        week = values.week_at(until)
        kind = special.get(until)
        seasons.append((until, week[: len(DAYS)] if kind is None else (week[kind],) * len(DAYS)))
    return year_of(seasons)


# --- classes of schedules -----------------------------------------------------------------------------------


def _compact(context: Context, item: IdfObject) -> Year:
    words = [str(row.get("field", "")).strip() for row in item.rows("data")]
    if not words:
        words = [str(value).strip() for value in item.fields.starting("field")]
    seasons: list[tuple[str, Week]] = []
    for end, days in _throughs(context, item, words):
        seasons.append((end, _week(context, item, days)))
    if not seasons or seasons[-1][0] != "12-31":
        last = seasons[-1][0] if seasons else "no day"
        raise item.error(f"values through {last}", "values through 12/31", "Add the rest of the year")
    return year_of(seasons)


def _throughs(
    context: Context, item: IdfObject, words: Sequence[str]
) -> Iterator[tuple[str, list[tuple[str, Day]]]]:
    """Seasons of a compact schedule: last day, and days with the words that say which they are."""
    end, who, between = "", "", "no"
    days: list[tuple[str, Day]] = []
    points: list[tuple[int, float]] = []
    last: int | None = None
    for word in words:
        head, _, tail = word.partition(":")
        low = head.casefold().strip()
        if low.startswith("through"):
            if end:
                yield end, [*days, (who, _closed(context, item, who, points, between))]
            text = tail.strip() or low.removeprefix("through").strip()
            end, days, who, points = last_day(item, text), [], "", []
        elif low.startswith("for"):
            if who:
                days = [*days, (who, _closed(context, item, who, points, between))]
            who, points, between = (low.removeprefix("for") + " " + tail.casefold()).strip(), [], "no"
        elif low.startswith("interpolate"):
            between = _between(item, tail or low.removeprefix("interpolate"))
        elif low.startswith("until"):
            last = _minute(item, (low.removeprefix("until") + ":" + tail).strip(": "))
        elif word:
            points.append((last or 0, _value(item, word)))
    if end:
        yield end, [*days, (who, _closed(context, item, who, points, between))]


def _between(item: IdfObject, text: str) -> str:
    word = text.strip().casefold()
    if word not in _BETWEEN:
        raise item.error(f"interpolate: found '{word}'", "No, Average or Linear", "Correct the schedule")
    return _BETWEEN[word]


def _value(item: IdfObject, word: str) -> float:
    try:
        return finite(word)
    except ValueError:
        raise item.error(f"found '{word}'", "a number after Until", "Correct the schedule") from None


def _minute(item: IdfObject, text: str) -> int:
    match = re.fullmatch(r"(\d{1,2}):(\d{2})(?::\d{2})?", text.replace(" ", ""))
    if match is None or int(match[1]) * 60 + int(match[2]) > 1440:
        raise item.error(f"found a time '{text}'", "00:01 to 24:00", "Correct the schedule")
    return int(match[1]) * 60 + int(match[2])


def _closed(
    context: Context, item: IdfObject, who: str, points: list[tuple[int, float]], between: str
) -> Day:
    """A day from points that hold the minute *until* which a value is valid."""
    ends = [minute for minute, _ in points]
    if not points or ends != sorted(ends) or ends[-1] != 1440:
        raise item.error(
            f"times until {', '.join(f'{m // 60}:{m % 60:02d}' for m in ends) or 'nothing'} for '{who}'",
            "rising times until 24:00",
            "Correct the schedule",
        )
    for first, second in pairwise(ends):
        if first == second:
            context.findings.no_effect(
                [item], f"two values until {first // 60}:{first % 60:02d}", "the first is used"
            )
            break
    # A value until the time of the one before it is never valid.
    lasting = [point for k, point in enumerate(points) if k == 0 or point[0] > points[k - 1][0]]
    return _by_steps(context, lasting, between)


def _by_steps(context: Context, points: list[tuple[int, float]], between: str) -> Day:
    """A day from its points, as EnergyPlus takes it in time steps.

    A step has the value of its end, or the mean over the step (``average``), or between the points at its
    end (``linear``); before the first point it is that of the first.
    """
    step = 60 // steps_per_hour(context)
    ends = [minute for minute, _ in points]
    starts = [0, *ends[:-1]]
    if between != "linear" and all(minute % step == 0 for minute in ends):
        return tuple(zip(starts, (value for _, value in points), strict=True))
    values = [value for _, value in points]
    day = []
    for end in range(step, 1441, step):
        k = bisect.bisect_left(ends, end)
        if between == "linear":
            share = 1.0 if k == 0 else (end - starts[k]) / (ends[k] - starts[k])
            value = values[k] - (1.0 - share) * (values[k] - values[k - 1])
        elif between == "average":
            parts = zip(starts, ends, values, strict=True)
            value = sum(max(min(e, end) - max(s, end - step), 0) * v for s, e, v in parts) / step
        else:
            value = values[k]
        day.append((end - step, value))
    return tuple(day)


def _week(context: Context, item: IdfObject, days: Iterable[tuple[str, Day]]) -> Week:
    """A day of each kind; the first entry that names it counts."""
    day_of_kind: dict[str, Day] = {}
    for who, day in days:
        names: list[str] = []
        for word in re.findall(r"[a-z0-9]+", who):
            groups = [group for group in _GROUPS if group in word]
            if "allotherdays" in word or "alldays" in word:
                names += _KINDS
            elif groups:
                names += [name for group in groups for name in _GROUPS[group]]
            elif word not in ("day", "days", "designday", "design", "and"):
                raise item.error(
                    f"found '{word}'", f"a kind of day such as {', '.join(_GROUPS)}", "Correct it"
                )
        for name in names:
            day_of_kind.setdefault(name, day)
    used = {name for *_, name in special_days(context)}
    missing = [name for name in _KINDS if name not in day_of_kind and (name in DAYS or name in used)]
    if missing:
        context.findings.approximated(
            item, f"no values for {', '.join(missing)}", "0 on these days, as in EnergyPlus"
        )
    return tuple(day_of_kind.get(name, ((0, 0.0),)) for name in _KINDS)


@reads(*_WEEKS)
def _weeks(context: Context, item: IdfObject) -> Year:
    seasons = []
    for row in item.rows("schedule_weeks") or _numbered(item):
        week = context.model.require(item, "schedule_week_name", *_WEEKS, name=str(row["schedule_week_name"]))
        month, day = int(row.get("end_month", 12)), int(row.get("end_day", 31))
        seasons.append((f"{month:02d}-{28 if (month, day) == (2, 29) else day:02d}", _week_of(context, week)))
    if not seasons or seasons[-1][0] != "12-31":
        raise item.error("weeks that end before 31 December", "weeks of a whole year", "Add the rest")
    return year_of(sorted(seasons))


def _numbered(item: IdfObject) -> list[dict[str, Any]]:
    """Weeks of a year as version 8.9 has them, with numbered fields; the first blank name ends them."""
    rows: list[dict[str, Any]] = []
    while item.text(f"schedule_week_name_{len(rows) + 1}"):
        number = len(rows) + 1
        values = {
            key: item.fields.get(f"{key}_{number}") for key in ("schedule_week_name", "end_month", "end_day")
        }
        rows.append({key: value for key, value in values.items() if value is not None})
    return rows


@reads(*_DAYS)
def _week_of(context: Context, item: IdfObject) -> Week:
    if item.kind == "Schedule:Week:Daily":
        keys = [f"{name}_schedule_day_name" for name in _KINDS]
        return tuple(_day(context, context.model.require(item, key, *_DAYS)) for key in keys)
    days = []
    for row in item.rows("data"):
        who = re.sub(r"^for:?", "", str(row.get("daytype_list", "")).strip().casefold())
        day_schedule = context.model.require(
            item, "schedule_day_name", *_DAYS, name=str(row.get("schedule_day_name"))
        )
        days.append((who, _day(context, day_schedule)))
    return _week(context, item, days)


def _day(context: Context, item: IdfObject) -> Day:
    if item.kind == "Schedule:Day:Hourly":
        return tuple((60 * k, item.number(f"hour_{k + 1}") or 0.0) for k in range(24))
    between = _between(item, item.text("interpolate_to_timestep"))
    if item.kind == "Schedule:Day:List":
        minutes = int(item.number("minutes_per_item") or 60)
        values = [_value(item, str(next(iter(row.values())))) for row in item.rows("extensions")]
        count = 1440 // minutes
        if len(values) != count:
            raise item.error(f"{len(values)} values", f"{count}: a day by {minutes} minutes", "Correct it")
        return _closed(
            context, item, item.name, [(minutes * (k + 1), v) for k, v in enumerate(values)], between
        )
    pairs = []
    for row in item.rows("data"):
        text = str(row.get("time", "24:00")).casefold().removeprefix("until").strip(": ")
        pairs.append((_minute(item, text), _value(item, str(row.get("value_until_time", 0.0)))))
    return _closed(context, item, item.name, pairs, between)


def _file(context: Context, item: IdfObject) -> Year:
    """Values of a file: each day is a season of its own, unless it equals the one before."""
    values = _column(context, item)
    minutes = int(item.number("minutes_per_item") or 60)
    count = 1440 // minutes
    if len(values) == 366 * count:
        del values[59 * count : 60 * count]
    if len(values) != 365 * count:
        raise item.error(
            f"{len(values)} values", f"{365 * count}: a year by {minutes} minutes", "Correct file or rows"
        )
    first = date(2017, 1, 1)
    between = _between(item, item.text("interpolate_to_timestep"))
    seasons = []
    for k in range(365):
        day = _by_steps(
            context,
            [(minutes * (j + 1), value) for j, value in enumerate(values[k * count : (k + 1) * count])],
            between,
        )
        seasons.append((f"{first + timedelta(days=k):%m-%d}", (day,) * len(_KINDS)))
    return year_of(seasons)


def _column(context: Context, item: IdfObject) -> list[float]:
    named = Path(item.text("file_name").replace("\\", "/"))
    folder = context.model.file.parent
    path = next(
        (candidate for candidate in (folder / named, folder / named.name) if candidate.is_file()), None
    )
    if path is None:
        raise item.error(f"file_name: found no file '{named}'", f"a table in {folder}", "Put it there")
    mark = {"comma": ",", "tab": "\t", "space": " ", "semicolon": ";"}[
        item.word("column_separator") or "comma"
    ]
    with (
        csv_refused(str(path)),
        require_regular(path).open(encoding="utf-8-sig", errors="replace", newline="") as lines,
    ):
        rows = list(csv.reader(lines, delimiter=mark, skipinitialspace=True))
    column = int(item.needed("column_number")) - 1
    rows = [row for row in rows[int(item.number("rows_to_skip_at_top") or 0) :] if row]
    try:
        return [finite(row[column]) for row in rows]
    except (IndexError, ValueError) as error:
        raise item.error(
            f"{path.name}: {error}", f"numbers in column {column + 1}", "Correct the file"
        ) from None
