"""Schedules at the stages of every step: temperatures at the stage, all else as means."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta, tzinfo
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Halvings
from mascarin.tables.checks import require_range
from mascarin.tables.record import Origin, Record
from mascarin.tables.steps import Steps
from mascarin.tables.times import local_time
from mascarin.weather.climate import Climate
from mascarin.weather.forcing import column_means, column_values, record_of
from mascarin.weather.reading.measurements import Measurements
from mascarin.weather.records.channels import TEMPERATURES, UNITS
from mascarin.weather.soil import of_soil

if TYPE_CHECKING:
    from mascarin.building.base.time_series import ColumnCourse
    from mascarin.building.parts.air.schedule import Schedule
    from mascarin.building.soil.courses import SoilCourse

#: Days whose pieces are made together.
_DAYS: Final = 400
# A step that ends at a switch ends before it. [s]
_BEFORE: Final = 1e-3


@dataclass(frozen=True)
class StraightPieces:
    """A function of time made of straight pieces.

    Attributes
    ----------
    knots : ndarray, shape (n + 1,)
        Ends of the pieces. [s]
    first, last : ndarray, shape (n,)
        Values at the start and at the end of each piece.
    """

    knots: Array
    first: Array
    last: Array

    def before(self, times: Array) -> Array:
        """Values just before some times: the end of a piece belongs to the piece."""
        piece = np.searchsorted(self.knots, times - _BEFORE, side="right") - 1
        length = self.knots[piece + 1] - self.knots[piece]
        part = (times - self.knots[piece]) / length
        return np.asarray(self.first[piece] + (self.last[piece] - self.first[piece]) * part)

    def means(self, edges: Array) -> Array:
        """Means between edges, shape (len(edges) - 1,)."""
        lengths = np.diff(self.knots)
        sums = np.concatenate([[0.0], np.cumsum(0.5 * (self.first + self.last) * lengths)])
        piece = np.clip(np.searchsorted(self.knots, edges, side="right") - 1, 0, len(lengths) - 1)
        inside = edges - self.knots[piece]
        slope = (self.last - self.first)[piece] / lengths[piece]
        integral = sums[piece] + (self.first[piece] + 0.5 * slope * inside) * inside
        return np.asarray(np.diff(integral) / np.diff(edges))


def scheduled(
    climate: Climate,
    schedules: Mapping[str, Schedule | ColumnCourse | SoilCourse],
    timezone: tzinfo,
    start: object,
    end: object,
    step_seconds: float,
    scheme: str = "sdirk2",
    measurements: Measurements | None = None,
    halvings: Halvings | None = None,
) -> Array:
    """Values of schedules at the stages of every step of a period.

    A fraction, power or flow is the mean over the step, the same in all stages, so that the heat is right
    where a switch is inside a step. A temperature is the value at the time of the stage; at a jump, the value
    before it. A column with a schedule is the product of both means.

    Parameters
    ----------
    climate : Climate
        Gives the time zone of the period, and may hold measured columns.
    schedules : mapping of str to Schedule or ColumnCourse
        Schedules and courses of measured columns, by name.
    timezone : datetime.tzinfo
        Time zone of the site: days and hours are those of its clocks, summer time included.
    start, end : str, datetime or pandas.Timestamp
        Period; without an offset, local time of the climate. A whole number of steps.
    step_seconds : float
        Step [s].
    scheme : str
        A key of `STAGES`.
    measurements : Measurements, optional
        Where to look for columns that the climate does not hold.
    halvings : ndarray of uint8, shape (steps,), optional
        How often the step is halved for each step that is taken. Default: never.

    Returns
    -------
    ndarray, shape (steps, stages, schedules)
        Fractions [-], temperatures [degC], powers [W] and flows [m3/s].

    Raises
    ------
    InputError
        A measured column is unknown, or a value in it is missing or impossible.

    Examples
    --------
    >>> import pandas as pd
    >>> from mascarin.weather import Climate
    >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="UTC")
    >>> climate = Climate.from_table(
    ...     pd.DataFrame({"T": [12.0, 13.0, 15.0, 16.0]}, index=index),
    ...     columns={"air_temperature": "T"},
    ...     absent=["radiation", "dew_point", "wind_speed", "wind_direction"],
    ... )
    >>> from datetime import UTC
    >>> from mascarin.building import TemperatureSchedule
    >>> night = TemperatureSchedule(value=18.0)
    >>> scheduled(climate, {"night": night}, UTC, index[0], index[2], 3600.0, "backward-euler").ravel()
    array([18., 18.])
    """
    steps = Steps.over(climate.grid.zone, start, end, step_seconds, scheme, halvings)
    out = np.empty((*steps.stage.shape, len(schedules)))
    Courses(climate, schedules, timezone, measurements).fill(out, steps)
    return out


class Courses:
    """Schedules and other courses, whose values are asked for over a period or over its parts.

    Parameters
    ----------
    climate, schedules, timezone, measurements
        As in `scheduled`.
    """

    def __init__(
        self,
        climate: Climate,
        schedules: Mapping[str, Schedule | ColumnCourse | SoilCourse],
        timezone: tzinfo,
        measurements: Measurements | None = None,
    ) -> None:
        self._climate, self._courses = climate, schedules
        self._timezone, self._measurements = timezone, measurements
        self._pieces: dict[str, StraightPieces] = {}
        self._soil: dict[str, Callable[[Steps], Array]] = {}

    def __len__(self) -> int:
        return len(self._courses)

    def fill(self, out: Array, steps: Steps) -> None:
        """Write the values at the stages of steps.

        Parameters
        ----------
        out : ndarray, shape (steps, stages, courses)
            Changed in place. [unit of each course]
        steps : Steps
            The steps; those of one period, its parts in their order.

        Raises
        ------
        InputError
            A measured column is unknown, or a value in it is missing or impossible.
        """
        for column, name in enumerate(self._courses):
            out[..., column] = self._values(name, steps)

    def _values(self, name: str, steps: Steps) -> Array:
        course = self._courses[name]
        if hasattr(course, "ladder"):
            if name not in self._soil:
                self._soil[name] = of_soil(self._climate, cast("SoilCourse", course), steps)
            return self._soil[name](steps)
        if not course.columns:
            # Only a schedule has no columns.
            if name not in self._pieces:
                schedule = cast("Schedule", course)
                self._pieces[name] = pieces_of(schedule, self._timezone, steps.first, steps.last)
            pieces, means = self._pieces[name], course.kind != "temperature"
            return pieces.means(steps.edges)[:, None] if means else pieces.before(steps.stage)
        values = _measured(self._climate, self._measurements, name, course, steps)
        fraction = getattr(course, "schedule", None)
        return values if fraction is None else np.asarray(values * self._values(fraction, steps))


def pieces_of(schedule: Schedule, timezone: tzinfo, first: float, last: float) -> StraightPieces:
    """A schedule over a span of time, by the clocks of a time zone.

    Parameters
    ----------
    schedule : Schedule
        One value, or profiles of days.
    timezone : datetime.tzinfo
        The time zone.
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].

    Returns
    -------
    StraightPieces
        Times from the start of the span [s].
    """
    day, end = (local_time(seconds, timezone).date() for seconds in (first, last))
    day, end = day - timedelta(days=1), end + timedelta(days=1)
    knots: list[Array] = []
    pairs: list[Array] = []
    while day <= end:
        starts: list[datetime] = []
        values: list[tuple[float, float]] = []
        # Some days at a time: a number in a list takes many times the memory of one in an array.
        for _ in range(min(_DAYS, (end - day).days + 1)):
            midnight = datetime(day.year, day.month, day.day)  # by the local clock
            for minute, _, begin, finish in schedule.pieces(
                day.weekday(), holiday=schedule.is_holiday(day), season=schedule.season(day)
            ):
                starts.append(midnight + timedelta(minutes=minute))
                values.append((begin, finish))
            day += timedelta(days=1)
        knots.append(_instants(starts, timezone) - first)
        pairs.append(np.array(values))
    knots.append(_instants([datetime(day.year, day.month, day.day)], timezone) - first)
    return _pieces_with_length(np.concatenate(knots), np.concatenate(pairs))


def _pieces_with_length(knots: Array, pairs: Array) -> StraightPieces:
    """Without pieces that have no length: where clocks go forward, those in the skipped hour."""
    real = np.diff(knots) > 0.0
    return StraightPieces(np.concatenate([knots[:-1][real], knots[-1:]]), pairs[real, 0], pairs[real, 1])


def _instants(clock: Sequence[datetime], timezone: tzinfo) -> Array:
    """Seconds since 1970-01-01 UTC of local times; the first one where an hour occurs twice."""
    offset = timezone.utcoffset(None)
    if offset is not None:  # clocks never change, and pandas takes longer to import than a run
        moments = np.array(clock, dtype="datetime64[us]").astype(np.int64) * 1e-6
        return np.asarray(moments - offset.total_seconds(), dtype=np.float64)
    import pandas as pd

    stamps = pd.DatetimeIndex(list(clock))
    local = stamps.tz_localize(timezone, ambiguous=np.ones(len(stamps), bool), nonexistent="shift_forward")
    return np.asarray(
        local.tz_convert("UTC").tz_localize(None).to_numpy().astype("datetime64[s]"), dtype=np.float64
    )


#: Limits of measured columns by their use, in the unit of the engine.
LIMITS_OF_COURSES: Final = {
    "fraction": (0.0, 1.0),
    "temperature": TEMPERATURES,
    "power": (-1e7, 1e7),
    "heat_flux": (-1e5, 1e5),
    "flow": (0.0, 1000.0),
    "air_change": (0.0, 1000.0),
    "temperature_gradient": (-20.0, 20.0),
    "vapour": (0.0, 10.0),
    "water_flow": (0.0, 1000.0),
    "rain": (0.0, 1000.0),
    "relative_humidity": (0.0, 1.0),
    "humidity_ratio": (0.0, 0.2),
}


def _measured(
    climate: Climate,
    measurements: Measurements | None,
    name: str,
    course: Schedule | ColumnCourse,
    steps: Steps,
) -> Array:
    """A schedule or another course from measured columns, the mean of several."""
    values = [_of_column(climate, measurements, name, course, column, steps) for column in course.columns]
    return np.asarray(sum(values[1:], values[0]) * (course.scale / len(values)))


def _of_column(
    climate: Climate,
    measurements: Measurements | None,
    name: str,
    course: Schedule | ColumnCourse,
    column: str,
    steps: Steps,
) -> Array:
    try:
        record = record_of(climate.record, None if measurements is None else measurements.record, column)
    except InputError as error:
        if not hasattr(course, "column"):  # no schedule
            raise
        raise InputError(f"schedules.{name}.column: {error}") from None
    if steps.opens:
        _require_usable(record, course, column, steps)
    if course.kind == "temperature":
        return column_values(record, column, steps)
    return column_means(record, column, steps)[:, None]


def _require_usable(record: Record, course: Schedule | ColumnCourse, column: str, steps: Steps) -> None:
    """Refuse a column that does not cover the period, has another unit, or an impossible value in it."""
    record.grid.require(steps.first, steps.last, f"{record.file}: {column}")
    _require_unit(record.origins.get(column), course, column, f"{record.file}: {column}")
    low, high = LIMITS_OF_COURSES[course.kind]
    limits = (low / course.scale, high / course.scale)
    require_range(record, column, limits, steps.first, steps.last, UNITS.get(column, ""))


def _require_unit(origin: Origin | None, course: Schedule | ColumnCourse, column: str, where: str) -> None:
    """Refuse a column whose file states another unit than the building takes it in."""
    unit = getattr(course, "unit", "")
    if origin is None or not origin.unit or not unit or unit == "degC":
        return
    stated = {"%": "%", "1": "-"}.get(origin.unit, origin.unit)
    if stated == unit or (stated, unit) == ("mm", "mm/h"):
        return
    raise InputError(
        f"{where}: the file states the unit {origin.unit}, but the building takes the column {column!r} in "
        f"{unit}; expected the same. Write unit: {stated} in the building if it is among "
        "W, kW, m3/s, m3/h, L/s, kg/s, kg/h, g/h, %, g/kg, else convert the column in the file; or correct "
        "the unit that the file states."
    )
