"""Two set points of a zone: equal constant ones are one parameter, and they never cross."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import date
from typing import TYPE_CHECKING

from mascarin.building.parts.air.schedule import DAYS, Piece

if TYPE_CHECKING:
    from mascarin.building.base.number import Number
    from mascarin.building.parts.description import Description

#: A set point: a number, or the name of a schedule; neither for a measured column.
Bound = tuple[float | None, str | None]


def tied_set_points(building: Description) -> dict[str, str]:
    """Set points that vary together because heating and cooling of a zone have the same one.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of str to str
        Path of each such set point -> path of the one that has its value, in both directions.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> tied_set_points(box())
    {}
    """
    ties: dict[str, str] = {}
    for heating, cooling, warm, cold in _constant(building):
        if warm == cold:
            ties |= {heating: cooling, cooling: heating}
    return ties


def cut_ranges(building: Description) -> dict[str, tuple[float, float]]:
    """Default ranges of set points that would cross.

    They end in the middle between the two set points, or where the given range of the other one begins.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of str to (float, float)
        Path -> range. A range that the description gives is left as it is. [degC]
    """
    ranges = {}
    for heating, cooling, warm, cold in _constant(building):
        if warm == cold or warm.plausible[1] <= cold.plausible[0]:
            continue
        middle = 0.5 * (float(warm) + float(cold))
        if warm.range is None:
            top = middle if cold.range is None else max(float(warm), cold.plausible[0])
            ranges[heating] = (warm.plausible[0], min(warm.plausible[1], top))
        if cold.range is None:
            bottom = middle if warm.range is None else min(float(cold), warm.plausible[1])
            ranges[cooling] = (max(cold.plausible[0], bottom), cold.plausible[1])
    return ranges


def _constant(building: Description) -> Iterator[tuple[str, str, Number, Number]]:
    """Paths and values of heating and cooling in zones where both set points are numbers."""
    for name, zone in building.zones.items():
        if zone.heating is None or zone.cooling is None:
            continue
        warm, cold = zone.heating.setpoint.temperature, zone.cooling.setpoint.temperature
        if warm is not None and cold is not None:
            yield (
                f"zones.{name}.heating.setpoint.temperature",
                f"zones.{name}.cooling.setpoint.temperature",
                warm,
                cold,
            )


def first_crossing(building: Description, low: Bound, high: Bound) -> tuple[str, float, float] | None:
    """First time of a week at which the lower of two set points is above the other one.

    Parameters
    ----------
    building : Description
        The building.
    low, high : (float or None, str or None)
        The set points: a number, or the name of a schedule; neither for a measured column, which is compared
        over the period of a run.

    Returns
    -------
    (str, float, float) or None
        Day and time in words, and both set points; None where they never cross. [unit of both]

    Examples
    --------
    >>> from mascarin.examples import box
    >>> first_crossing(box(), (26.0, None), (20.0, None))
    ('monday at 00:00', 26.0, 20.0)
    """
    used = [building.schedules[name] for _, name in (low, high) if name is not None]
    ends = sorted({season.until for entry in used for season in entry.seasons or ()}) or ["12-31"]
    for end in ends:
        weeks = [_week(building, entry, date.fromisoformat(f"2000-{end}")) for entry in (low, high)]
        season = "" if len(ends) == 1 else f" before {end}"
        for (day, below), (_, above) in zip(*weeks, strict=True):
            for minute, first, second in _crossings(below, above):
                clock = f"{int(minute // 60):02d}:{int(minute % 60):02d}"
                return f"{day}{season} at {clock}", first, second
    return None


def _week(building: Description, bound: Bound, day: date) -> list[tuple[str, list[Piece]]]:
    """Pieces of a set point on each day of the week of a season, and on holidays; empty for a column."""
    number, name = bound
    if name is None:
        always = [] if number is None else [(0.0, 1440.0, float(number), float(number))]
        return [(day_name, always) for day_name in (*DAYS, "holidays")]
    schedule = building.schedules[name]
    season = schedule.season(day)
    days = [(day_name, schedule.pieces(weekday, season=season)) for weekday, day_name in enumerate(DAYS)]
    return [*days, ("holidays", schedule.pieces(0, holiday=True, season=season))]


def _crossings(low: list[Piece], high: list[Piece]) -> Iterator[tuple[float, float, float]]:
    """Minutes of the day at which the first set point is above the second, with both."""
    for start, end, first, last in low:
        for other_start, other_end, other_first, other_last in high:
            begin, finish = max(start, other_start), min(end, other_end)
            for minute in (begin, finish) if begin < finish else ():
                below = first + (last - first) * (minute - start) / (end - start)
                above = other_first + (other_last - other_first) * (minute - other_start) / (
                    other_end - other_start
                )
                if below > above + 1e-9:
                    yield minute, below, above
