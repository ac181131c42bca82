"""Weather, measured columns and schedules of a building, at the stages of steps: all of a run, or a block."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mascarin.tables.forcing_blocks import ForcingBlocks
from mascarin.tables.steps import Steps
from mascarin.weather.checks.place_check import require_place
from mascarin.weather.climate import Climate
from mascarin.weather.derived.sun_position import states_position
from mascarin.weather.forcing import forcing, require_period
from mascarin.weather.reading.measurements import Measurements
from mascarin.weather.records.channels import CHANNELS
from mascarin.weather.schedules import Courses

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.weather.records.site import SiteLike

    Array = npt.NDArray[np.float64]

_AIR = CHANNELS.index("air_temperature")


class ForcingSource:
    """Weather, measured columns and schedules of a building, at the stages of any steps.

    Parameters
    ----------
    climate : Climate
        The weather.
    site : object with latitude and longitude
        Place of the building.
    columns : sequence of str
        Measured columns that follow the channels of the climate.
    courses : Courses
        Schedules and other courses, which follow the columns.
    measurements : Measurements, optional
        Where to look for columns that the climate does not hold.
    limits : mapping of str to (float, float), optional
        As in `mascarin.weather.forcing.forcing`.
    """

    def __init__(
        self,
        climate: Climate,
        site: SiteLike,
        columns: Sequence[str],
        courses: Courses,
        measurements: Measurements | None = None,
        limits: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        self._climate, self._site, self._columns, self._limits = climate, site, columns, limits
        self._measured = None if measurements is None else measurements.record
        self._courses = courses

    @property
    def channels(self) -> int:
        """Number of channels."""
        return len(CHANNELS) + len(self._columns) + len(self._courses)

    @property
    def divisible(self) -> bool:
        """Whether blocks have the values of all steps.

        Not where a table states the position of the sun, or a year of weather has gaps in its infrared
        radiation, which is then not used at all.
        """
        require_place(self._climate.record, self._site)
        record = self._climate.completed(self._site).record
        infrared = record.columns.get("infrared")
        gaps = record.of_year and infrared is not None and bool(np.isnan(infrared).any())
        return not gaps and not states_position(record)

    def at(self, steps: Steps) -> Array:
        """Values at the stages of steps; parts of a period in their order.

        Parameters
        ----------
        steps : Steps
            All steps of a period, or a part of them.

        Returns
        -------
        ndarray, shape (steps, stages, channels)
            In the units of `CHANNELS`; measured columns and courses in their own.

        Raises
        ------
        InputError
            The climate is of another place, the period is outside the data, a value in it is missing or
            impossible, or a column is unknown.
        """
        record = self._climate.record
        if steps.opens:
            require_place(record, self._site)
            require_period(record, steps)
        channels = forcing(
            record, self._climate.completed(self._site).record, self._site, steps, self._columns,
            self._measured, self._limits, len(self._courses),
        )  # fmt: skip
        if len(self._courses):
            self._courses.fill(channels[..., -len(self._courses) :], steps)
        return np.asarray(channels, dtype=np.float64)


def in_blocks(
    source: ForcingSource,
    parts: Callable[[], Iterator[Steps]],
    check: Callable[[Array, Steps], object],
    shape: tuple[int, int, int],
    channels: Collection[int],
) -> ForcingBlocks:
    """A forcing that is worked out twice: here, where it is checked, and when a run comes to it.

    Parameters
    ----------
    source : ForcingSource
        Gives the values.
    parts : callable
        Begins the parts of the period again.
    check : callable
        Called with each block and its steps; refuses what cannot be used.
    shape : (int, int, int)
        Steps, stages, channels.
    channels : collection of int
        Channels whose values at the last stages are kept.

    Raises
    ------
    InputError
        Values that cannot be used.
    """
    ends: dict[int, list[Array]] = {channel: [] for channel in (_AIR, *channels)}
    for steps in parts():
        block = source.at(steps)
        check(block, steps)
        for channel, values in ends.items():
            values.append(block[:, -1, channel].copy())
    air_temperature = float(np.concatenate(ends[_AIR]).mean())
    kept_series = {channel: np.concatenate(ends[channel]) for channel in channels}
    return ForcingBlocks(shape, lambda: map(source.at, parts()), kept_series, air_temperature)
