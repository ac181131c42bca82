"""What the outdoor air gives to a block of soil at the stages of every step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.steps import Steps
from mascarin.tables.times import clock
from mascarin.weather.forcing import channel_values

if TYPE_CHECKING:
    from mascarin.building.soil.courses import SoilCourse
    from mascarin.tables.arrays import Array
    from mascarin.weather.climate import Climate

_HOUR: Final = 3600.0
#: Hours of weather that count as a year. [h]
_YEAR: Final = 8760


def of_soil(climate: Climate, course: SoilCourse, steps: Steps) -> Array:
    """Heat into the innermost cell [W/m2], or the temperature behind the outermost one. [degC]

    Parameters
    ----------
    climate : Climate
        The weather.
    course : SoilCourse
        What is asked for.
    steps : Steps
        The steps of the run.

    Raises
    ------
    InputError
        The weather is shorter than a year, and nothing says what was before.
    """
    if course.kind == "temperature":
        return np.full((len(steps.edges) - 1, 1), course.behind)
    from mascarin.building.soil.response import heat_of_outdoors

    hours, air = _hourly(climate, steps)
    if course.before is None and len(air) < _YEAR:
        raise InputError(
            f"soil_blocks.{course.block}.before: found {len(air) / 24.0:.0f} days of weather and no outdoor "
            "air before; expected a year of weather, or the yearly mean of the years before it. Write "
            "'before: {mean: 10, amplitude: 8, coldest_day: 15}'"
        )
    before = course.before
    if before is not None:
        before = (before[0] - course.behind, *before[1:])
    heat = heat_of_outdoors(
        course.ladder,
        np.asarray(air - course.behind, dtype=np.float64),
        before,
        _day_of_year(climate, steps.first + float(hours[0])),
    )
    middles = 0.5 * (steps.edges[:-1] + steps.edges[1:])
    return np.asarray(np.interp(middles, hours, heat[:, course.cell])[:, None])


def _hourly(climate: Climate, steps: Steps) -> tuple[Array, Array]:
    """Ends of hours, from the start of a run [s], and the outdoor air at them. [degC]

    From the beginning of the weather on; a typical year begins a year before the run.
    """
    grid = climate.grid
    first = steps.first - _YEAR * _HOUR if grid.periodic else min(grid.start, steps.first)
    count = max(int((steps.last - first) // _HOUR), 1)
    if not grid.periodic:
        # Weather after the run, as far as a year needs it.
        count = max(count, min(_YEAR, int((grid.end - first) // _HOUR)))
    edges = _HOUR * np.arange(count + 1)
    hours = Steps(first, first + float(edges[-1]), edges, edges[1:, None], (1.0,))
    air = channel_values(climate.record, "air_temperature", hours)[:, 0]
    finite = np.isfinite(air)
    if not finite.all():
        air = np.interp(edges[1:], edges[1:][finite], air[finite])
    return np.asarray(edges[1:] + (first - steps.first)), np.asarray(air, dtype=np.float64)


def _day_of_year(climate: Climate, seconds: float) -> float:
    """Day of the year at a time since 1970-01-01 UTC, from 0."""
    moment = clock(np.array([seconds]), climate.grid.zone)[0]
    return float((moment - moment.astype("datetime64[Y]")) / np.timedelta64(1, "D"))
