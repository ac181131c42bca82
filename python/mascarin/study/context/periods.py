"""Periods of a study: which measured values are used to identify, to corroborate, or not at all.

A sensor may have periods of its own. Values that are excluded count as not measured. Times are local times of
the weather data; the end of a period is not included.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.durations import record_seconds, seconds_of
from mascarin.errors import InputError
from mascarin.measurements.observation import PERIODS
from mascarin.study.file.description import IdentificationPlan
from mascarin.tables.timezones import moment

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.measurements.observation import Observation
    from mascarin.measurements.time_fields import Duration
    from mascarin.study.file.description import SensorPeriods, StudyPlan
    from mascarin.study.file.locations import Places
    from mascarin.study.file.study_inputs import StudyInputs
    from mascarin.tables.grid import Grid

    Flags = npt.NDArray[np.bool_]

NAMED: Final = ("identification", "corroboration")


@dataclass(frozen=True)
class PeriodSpan:
    """One period and where the study states it.

    Attributes
    ----------
    start, end : pandas.Timestamp
        The end is not included.
    place : tuple of str
        Keys in the study file.
    """

    start: pd.Timestamp
    end: pd.Timestamp
    place: tuple[str | int, ...]

    def overlaps(self, other: PeriodSpan) -> bool:
        """Whether both have an instant in common."""
        return self.start < other.end and other.start < self.end

    @property
    def words(self) -> str:
        """Start and end."""
        return f"{self.start:%Y-%m-%d %H:%M} .. {self.end:%Y-%m-%d %H:%M}"


class Timeline:
    """The periods of a study, by sensor.

    Parameters
    ----------
    plan : StudyPlan
        States them.
    zone : tzinfo
        Time zone of the weather data.
    places : Places
        Lines of the study, for errors.
    """

    def __init__(self, plan: StudyPlan, zone: Any, places: Places) -> None:
        self._plan, self._zone, self._places = plan, zone, places

    def warm_up(self) -> PeriodSpan | None:
        """The warm-up, which is not compared."""
        period = self._plan.periods.warm_up
        return None if period is None else self._span(period, ("periods", "warm_up"))

    def spans(self, name: str, sensor: str | None = None) -> list[PeriodSpan]:
        """Periods of a name: those of a sensor where it has its own, else those of the study.

        Parameters
        ----------
        name : str
            ``identification``, ``corroboration`` or ``exclude``.
        sensor : str, optional
            A sensor; None: the study.
        """
        sensor_periods = None if sensor is None else self._plan.sensors[sensor].periods
        if sensor_periods is not None and name in NAMED and getattr(sensor_periods, name) is not None:
            return self._read(sensor_periods, name, ("sensors", str(sensor), "periods", name))
        periods = self._read(self._plan.periods, name, ("periods", name))
        if sensor_periods is not None and name not in NAMED:
            periods += self._read(sensor_periods, name, ("sensors", str(sensor), "periods", name))
        return periods

    def every(self, name: str) -> list[PeriodSpan]:
        """Periods of a name of the study and of all sensors, each once."""
        sensors = (sensor for sensor in self._plan.sensors)
        spans = [*self.spans(name), *(span for sensor in sensors for span in self.spans(name, sensor))]
        return list(dict.fromkeys(spans))

    def identification(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start of the first and end of the last identification period of a sensor that is used."""
        used = [name for name, sensor in self._plan.sensors.items() if sensor.use]
        spans = [span for name in used for span in self.spans("identification", name)]
        spans = spans or self.spans("identification")
        return min(span.start for span in spans), max(span.end for span in spans)

    def excluded(self, observation: Observation) -> Flags:
        """Values that are left out of all comparisons, shape (n, S)."""
        left_out = np.zeros(observation.measured.shape, dtype=np.bool_)
        for s, name in enumerate(observation.names):
            for span in self.spans("exclude", name):
                left_out[:, s] |= observation.during(span.start, span.end)
            for start, end in self._hours(name):
                left_out[:, s] |= self._within(observation, start, end)
        return left_out

    def used(self, observation: Observation) -> dict[str, Flags]:
        """Values of each period, shape (n, S).

        ``blind`` has every value that is in neither of the other two; if there is none, the corroboration.
        """
        shape = observation.measured.shape
        identified, corroborated = np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
        for s, name in enumerate(observation.names):
            identification, corroboration = (
                self.spans("identification", name),
                self.spans("corroboration", name),
            )
            identified[:, s] = _during(observation, identification)
            corroborated[:, s] = ~identified[:, s] & (
                _during(observation, corroboration)
                if corroboration
                else np.asarray(observation.times >= max(span.end for span in identification))
            )
        blind = ~identified & ~corroborated
        return dict(
            zip(PERIODS, (identified, corroborated, blind if blind.any() else corroborated), strict=True)
        )

    def _hours(self, sensor: str) -> Iterator[tuple[float, float]]:
        sensor_periods = self._plan.sensors[sensor].periods
        hours = [
            *self._plan.periods.exclude_hours,
            *(() if sensor_periods is None else sensor_periods.exclude_hours),
        ]
        for first, last in hours:
            yield _hour(first), _hour(last)

    def _within(self, observation: Observation, start: float, end: float) -> Flags:
        """Instants between two hours of the day, over midnight where the end is before the start."""
        local = observation.times.tz_localize(None)
        hour = np.asarray(local.hour + local.minute / 60.0 + local.second / 3600.0)
        if start < end:
            return np.asarray((hour >= start) & (hour < end))
        return np.asarray((hour >= start) | (hour < end))

    def _read(self, periods: SensorPeriods | Any, name: str, place: tuple[str, ...]) -> list[PeriodSpan]:
        return [self._span(period, place) for period in getattr(periods, name) or ()]

    def _span(self, period: str | tuple[str, str], place: tuple[str, ...]) -> PeriodSpan:
        import pandas as pd

        with self._places.blame(*place):
            if isinstance(period, str):
                start = moment(period, self._zone, place[-1]).normalize()
                return PeriodSpan(start, start + pd.Timedelta(days=1), place)
            start, end = (moment(text, self._zone, place[-1]) for text in period)
            if end <= start:
                raise InputError(
                    f"found {start:%Y-%m-%d %H:%M} .. {end:%Y-%m-%d %H:%M}, expected the end after the "
                    "start; exchange the two times"
                )
            return PeriodSpan(start, end, place)


class StudyPeriods:
    """When a study runs, and what it compares.

    Parameters
    ----------
    inputs : StudyInputs
        What was read.
    """

    def __init__(self, inputs: StudyInputs) -> None:
        self._inputs = inputs
        self._plan = inputs.plan
        #: Periods of the study and of its sensors.
        self.timeline: Timeline = Timeline(inputs.plan, inputs.climate.grid.zone, inputs.places)

    @cached_property
    def identification(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start of the first and end of the last identification period."""
        return self.timeline.identification()

    @cached_property
    def start(self) -> pd.Timestamp:
        """Start of the run: that of the warm-up, else of the record."""
        span = self.timeline.warm_up()
        return span.start if span is not None else self.record[0]

    @cached_property
    def compared_from(self) -> pd.Timestamp:
        """First instant that is compared."""
        span = self.timeline.warm_up()
        return span.end if span is not None else self.start

    @cached_property
    def record(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start and end of the time that weather and measurements both cover."""
        import pandas as pd

        first, last = max(grid.start for grid in self._grids), min(grid.end for grid in self._grids)
        zone = self._inputs.climate.grid.zone
        return (
            pd.Timestamp(first, unit="s", tz="UTC").tz_convert(zone),
            pd.Timestamp(last, unit="s", tz="UTC").tz_convert(zone),
        )

    @property
    def _grids(self) -> list[Grid]:
        weather = self._inputs.climate.grid
        return [self._inputs.measurements.grid, *([] if weather.periodic else [weather])]

    @cached_property
    def moment_of_end(self) -> pd.Timestamp | None:
        """End of the record to use, as the study gives it."""
        text = self._plan.periods.end
        with self._inputs.places.blame("periods", "end"):
            return None if text is None else moment(text, self._inputs.climate.grid.zone, "end")

    @cached_property
    def end(self) -> pd.Timestamp:
        """End of the run: that of the study, else of the record, a whole number of steps after the start."""
        import pandas as pd

        # Instants at the very end of a table have no value to interpolate to.
        interval = max(grid.interval for grid in self._grids)
        last = self.record[1] - pd.Timedelta(seconds=interval)
        if self.moment_of_end is not None:
            last = min(last, self.moment_of_end)
        return self.start + self.whole_steps((last - self.start).total_seconds())

    def whole_steps(self, seconds: float, length: Duration | None = None) -> pd.Timedelta:
        """The longest whole number of steps in so much time; steps of the study, or of another length."""
        import pandas as pd

        step = record_seconds(length or self._plan.step)
        return pd.Timedelta(seconds=step * math.floor(seconds / step + 1e-9))

    @cached_property
    def lead_seconds(self) -> float:
        """Length of the warm-up before the identification period, limited by the record. [s]"""
        available = (self.identification[0] - self.start).total_seconds()
        plan = self._plan.identification
        length = IdentificationPlan.model_fields["lead"].default if plan is None else plan.lead
        lead = min(seconds_of(length, "lead"), available)
        return self.whole_steps(lead).total_seconds()

    @property
    def step_of_many(self) -> Duration:
        """Time step of the runs in which all parameters vary."""
        step = None if self._plan.sensitivity is None else self._plan.sensitivity.step
        return step or self._plan.step


def overlap(known: list[PeriodSpan], held: list[PeriodSpan]) -> tuple[PeriodSpan, PeriodSpan] | None:
    """The first two periods that have an instant in common; None where there are none."""
    return next(((a, b) for a in known for b in held if a is not b and a.overlaps(b)), None)


def _during(observation: Observation, spans: list[PeriodSpan]) -> Flags:
    inside = np.zeros(len(observation.times), dtype=np.bool_)
    for span in spans:
        inside |= observation.during(span.start, span.end)
    return inside


def _hour(text: str) -> float:
    """Hour of the day of a text such as 22:30. [h]"""
    hours, _, minutes = text.partition(":")
    return float(hours) + float(minutes or 0.0) / 60.0
