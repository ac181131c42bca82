"""Weather with gains, offsets and clocks of its columns: the forcing of the engine that follows from them.

Readings are multiplied by the gain, then the offset is added; the clock is added to their times. Irradiances
are corrected as they were measured: what is derived from them, such as the diffuse part of a global
irradiance, follows, and so do the direction of the sun and the cover by clouds. A reading of exactly zero of
an irradiance stays zero: by night there is nothing to add an offset to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, TypeVar

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array
from mascarin.tables.record import Record
from mascarin.tables.steps import Steps
from mascarin.weather.checks.missing_infrared import with_whole_infrared
from mascarin.weather.derived.completion import complete
from mascarin.weather.derived.sun_position import Sun, states_position
from mascarin.weather.forcing import channel_values, column_values, fill_radiation, record_of, sun_over_steps
from mascarin.weather.records.channels import BY_NAME, CHANNELS, RADIATION, SOURCE_CHANNELS, SUN_POSITION
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import SiteLike

SUN: Final = "radiation"
"""Name for all irradiances of the weather together."""
_MARGIN: Final = 2.0 * 86400.0
"""What is used of a record on both sides of a period: clouds are interpolated over a night. [s]"""
_DAY: Final = 86400.0
_NOT_NEGATIVE: Final = ("wind_speed", "cloud_cover", "infrared")

AnyRecord = TypeVar("AnyRecord", bound=Record)


@dataclass(frozen=True)
class ColumnError:
    """What makes readings of a column right.

    Attributes
    ----------
    gain : float
        Factor on the readings. [-]
    offset : float
        Added to them after the gain. [unit of the column]
    clock : float
        Added to their times. [s]
    """

    gain: float = 1.0
    offset: float = 0.0
    clock: float = 0.0


RIGHT: Final = ColumnError()
"""Of a column that is right as it was read."""

Errors = Mapping[str, ColumnError]


class CorrectedForcing:
    """The forcing of a period as a function of the errors of its columns.

    Parameters
    ----------
    weather : WeatherRecord
        As read.
    measured : Record or None
        Measured columns beside the weather.
    site : object with latitude and longitude
        Place of the building.
    steps : Steps
        The period.
    channels : sequence of str
        What the forcing holds after the channels of the climate: measured columns first.
    names : sequence of str
        Columns that have errors: channels of the weather, `SUN`, or measured columns.

    Raises
    ------
    InputError
        A column that is not in the weather, or was not measured.
    """

    def __init__(
        self,
        weather: WeatherRecord,
        measured: Record | None,
        site: SiteLike,
        steps: Steps,
        channels: Sequence[str],
        names: Sequence[str],
    ) -> None:
        self._place = (float(site.latitude), float(site.longitude))
        self._steps = steps
        self._channels = {name: len(CHANNELS) + k for k, name in enumerate(channels)}
        self._given = [name for name in SOURCE_CHANNELS if name in weather.columns]
        self._sun = [name for name in RADIATION if name in self._given and name not in weather.assumed]
        self._columns: dict[str, Record] = {}
        for name in names:
            self._require(name, weather, measured)
        position = SUN_POSITION if states_position(weather) else ()
        self._weather = _cut(weather, [*self._given, *position], steps)
        weather_columns = {name for name in self._channels if name in weather.columns}
        further = {name for name in names if name in self._channels} | weather_columns
        for name in sorted(further):
            self._columns[name] = _cut(record_of(weather, measured, name), [name], steps)
        self._of_weather = weather_columns

    def _require(self, name: str, weather: WeatherRecord, measured: Record | None) -> None:
        """Refuse a name of no column that acts."""
        where = f"weather.columns.{name}"
        if name == SUN and self._sun:
            return
        if name == SUN or name in weather.assumed:
            raise InputError(
                f"{where}: {weather.file} has no measured {'irradiance' if name == SUN else name}, expected "
                "one whose error can be corrected. Remove the entry, or map the column that was measured"
            )
        if name in self._given or name in self._channels:
            return
        choices = [SUN, *self._given, *(c for c in self._channels if c in weather.columns), *(
            c for c in self._channels if measured is not None and c in measured.columns
        )]  # fmt: skip
        if name == "relative_humidity":
            hint = "The dew point was made of it: write dew_point."
        elif name in SUN_POSITION:
            hint = "A stated position of the sun has no errors."
        elif name in BY_NAME:
            hint = "It is derived from the others: correct those."
        else:
            hint = did_you_mean(name, choices)
        raise InputError(
            f"{where}: found no such column in the weather, expected one of {', '.join(choices)}. "
            f"{hint}".rstrip()
        )

    def at(
        self, forcing: Array, old_errors: Errors, new_errors: Errors, clocks: tuple[float, float]
    ) -> Array:
        """The forcing with other errors.

        Parameters
        ----------
        forcing : ndarray, shape (steps, stages, channels)
            Forcing with the old errors. [unit of each channel]
        old_errors, new_errors : mapping of str to ColumnError
            Errors by column, before and after.
        clocks : (float, float)
            Clock of the weather as a whole, before and after. [s]

        Returns
        -------
        ndarray, shape (steps, stages, channels)
            The same array where nothing differs, else a new one.

        Raises
        ------
        InputError
            Irradiances of one table have different clocks.
        """
        before, after = (
            self._resolved(errors, clock)
            for errors, clock in zip((old_errors, new_errors), clocks, strict=True)
        )
        changed = {name for name in after if after[name] != before[name]}
        if not changed:
            return forcing
        # A run may be shorter than the period; what is behind its end is worked out and left.
        out: Array = np.resize(forcing, (len(self._steps.stage), *forcing.shape[1:]))
        scaled = _scaled(self._weather, after)
        sunlit = changed & set(RADIATION)
        if sunlit:
            completed = complete(self._moved_sun(scaled, after), *self._place)
            fill_radiation(out, completed, self._sun_path, self._steps)
            if "cloud_cover" not in self._weather.columns:
                self._put(out, "cloud_cover", channel_values(completed, "cloud_cover", self._steps))
        if self._with_modelled_sky and (changed & {"air_temperature", "dew_point", "cloud_cover"} or sunlit):
            changed.add("infrared")
        for name in SOURCE_CHANNELS[:7]:
            if name in changed and name in self._weather.columns:
                source = scaled
                if name == "infrared":
                    source = with_whole_infrared(complete(scaled, *self._place))
                moved = _moved(source, [name], after[name].clock)
                self._put(out, name, channel_values(moved, name, self._steps))
        for name in changed & set(self._channels):
            moved_column = _moved(_scaled(self._columns[name], after), [name], after[name].clock)
            out[..., self._channels[name]] = column_values(moved_column, name, self._steps)
        return out[: len(forcing)]

    def largest(self, name: str) -> float:
        """Largest magnitude of a column as it was read. [unit of the column]"""
        names = self._sun if name == SUN else [name]
        sources = [self._columns.get(each, self._weather) for each in names]
        values = [source.columns[each] for source, each in zip(sources, names, strict=True)]
        return max(float(np.nanmax(np.abs(column), initial=0.0)) for column in values)

    def readings(self, errors: Errors, clock: float) -> dict[str, Array]:
        """Columns that gains and offsets change, with them. [unit of each]"""
        after = self._resolved(errors, clock)
        sources = {**dict.fromkeys(self._given, self._weather), **self._columns}
        return {
            name: _scaled(source, after).columns[name]
            for name, source in sources.items()
            if (after[name].gain, after[name].offset) != (1.0, 0.0)
        }

    def sunlit(self, errors: Errors, clock: float) -> WeatherRecord:
        """The weather with its irradiances as corrected, such as for a comparison with the sun.

        Parameters
        ----------
        errors : mapping of str to ColumnError
            Errors by column.
        clock : float
            Clock of the weather as a whole. [s]
        """
        after = self._resolved(errors, clock)
        return self._moved_sun(_scaled(self._weather, after), after)

    def _put(self, out: Array, name: str, values: Array) -> None:
        out[..., CHANNELS.index(name)] = values

    @cached_property
    def _sun_path(self) -> Sun:
        return sun_over_steps(self._weather, *self._place, self._steps)

    @cached_property
    def _with_modelled_sky(self) -> bool:
        infrared = self._weather.columns.get("infrared")
        return infrared is not None and self._weather.of_year and bool(np.isnan(infrared).any())

    def _resolved(self, errors: Errors, clock: float) -> dict[str, ColumnError]:
        """Errors of every column, with those of all irradiances and of the whole weather."""
        sun = errors.get(SUN, RIGHT)
        resolved = {}
        for name in (*self._given, *self._columns):
            column_error = errors.get(name, RIGHT)
            late = clock if name in self._given or name in self._of_weather else 0.0
            if name in RADIATION:
                column_error = ColumnError(
                    column_error.gain * sun.gain,
                    column_error.offset + sun.offset,
                    column_error.clock + sun.clock,
                )
            resolved[name] = replace(column_error, clock=column_error.clock + late)
        clocks = [resolved[name].clock for name in self._sun]
        if any(clocks) and states_position(self._weather):
            raise InputError(
                f"weather.columns: found a clock of {clocks[0]:g} s for {', '.join(self._sun)}, but the "
                f"table states the position of the sun ({', '.join(SUN_POSITION)}), which has no clock; "
                "expected a clock of 0. Remove the clock, or the columns of the position"
            )
        if len(set(clocks)) > 1:
            raise InputError(
                f"weather.columns: found {', '.join(self._sun)} with clocks of "
                f"{', '.join(f'{value:g} s' for value in clocks)}, expected one clock: the sun divides "
                f"them. State the clock under weather.columns.{SUN}, or that of all as weather.clock"
            )
        return resolved

    def _moved_sun(self, scaled: WeatherRecord, errors: Errors) -> WeatherRecord:
        if states_position(scaled):
            return scaled
        names = [name for name in (*RADIATION, "cloud_cover") if name in scaled.columns]
        clocks = [errors[name].clock for name in names if name in RADIATION]
        return _moved(scaled, names, clocks[0] if clocks else 0.0)


def _cut(record: AnyRecord, names: Sequence[str], steps: Steps) -> AnyRecord:
    """Some columns over a period and two days around it; all of a year that represents any year."""
    grid = record.grid
    columns = {name: record.columns[name] for name in names}
    kinds = {name: record.kinds[name] for name in names}
    closing = {name: record.closing[name] for name in names if name in record.closing}
    if grid.periodic:
        return replace(record, columns=columns, kinds=kinds, closing=closing)
    low = max(int((steps.first - _MARGIN - grid.start) / grid.interval), 0)
    high = min(int((steps.last + _MARGIN - grid.start) / grid.interval) + 1, grid.count)
    if high < grid.count:
        closing = {name: float(record.columns[name][high]) for name in closing}
    return replace(
        record,
        columns={name: values[low:high] for name, values in columns.items()},
        kinds=kinds,
        closing=closing,
        grid=replace(grid, start=grid.start + low * grid.interval, count=high - low),
        lines=record.lines[low:high],
        knots=None if record.knots is None else record.knots[low : high + 1],
    )


def _scaled(record: AnyRecord, errors: Errors) -> AnyRecord:
    """Columns with their gains and offsets."""

    def right(name: str, values: Any) -> Any:
        error = errors.get(name, RIGHT)
        if error.gain == 1.0 and error.offset == 0.0:
            return values
        corrected = error.gain * values + error.offset
        if name == "wind_direction":
            return corrected % 360.0
        if name in RADIATION:
            return np.where(np.asarray(values) == 0.0, 0.0, corrected)
        if name in _NOT_NEGATIVE:
            corrected = np.maximum(corrected, 0.0)
        return np.minimum(corrected, 10.0) if name == "cloud_cover" else corrected

    return replace(
        record,
        columns={name: right(name, values) for name, values in record.columns.items()},
        closing={name: float(right(name, value)) for name, value in record.closing.items()},
    )


def _moved(record: AnyRecord, names: Sequence[str], seconds: float) -> AnyRecord:
    """Some columns at other times; where a record ends, the same hour of the next day goes on."""
    grid = record.grid
    columns = {name: record.columns[name] for name in names}
    kinds = {name: record.kinds[name] for name in names}
    closing = {name: record.closing[name] for name in names if name in record.closing}
    later = replace(grid, start=grid.start + seconds)
    if seconds == 0.0 or grid.periodic:
        return replace(record, columns=columns, kinds=kinds, closing=closing, grid=later)
    more = int(np.ceil(abs(seconds) / grid.interval)) + 1
    day = min(max(round(_DAY / grid.interval), 1), grid.count)
    before = np.arange(-more, 0) % day
    after = grid.count - day + np.arange(more + 1) % day
    for name, values in columns.items():
        # At its end an instant has its own value; the rows that follow are those of a day before.
        ends = values[after[:more]].copy()
        if name in closing:
            ends[0], closing[name] = closing[name], float(values[after[more]])
        columns[name] = np.concatenate([values[before], values, ends])
    unknown = np.zeros(more, dtype=record.lines.dtype)
    return replace(
        record,
        columns=columns,
        kinds=kinds,
        closing=closing,
        grid=replace(later, start=later.start - more * grid.interval, count=grid.count + 2 * more),
        lines=np.concatenate([unknown, record.lines, unknown]),
        knots=None,
    )
