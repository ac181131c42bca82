"""What outdoor air, sun and sky give to a block of soil at the stages of every step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.physics import KELVIN, STEFAN_BOLTZMANN
from mascarin.tables.steps import Steps
from mascarin.tables.times import clock
from mascarin.weather.checks.missing_infrared import sky_emission
from mascarin.weather.forcing import channel_values, column_means

if TYPE_CHECKING:
    from mascarin.building.soil.courses import SoilCourse
    from mascarin.tables.arrays import Array
    from mascarin.weather.climate import Climate

_HOUR: Final = 3600.0
#: Hours of weather that count as a year. [h]
_YEAR: Final = 8760


def of_soil(climate: Climate, course: SoilCourse, steps: Steps) -> Callable[[Steps], Array]:
    """Heat into the innermost cell [W/m2], or the temperature behind the outermost one. [degC]

    Parameters
    ----------
    climate : Climate
        The weather.
    course : SoilCourse
        What is asked for.
    steps : Steps
        The steps of the run, or the first of them.

    Returns
    -------
    callable
        Values of steps of the run, shape (steps, 1).

    Raises
    ------
    InputError
        The weather is shorter than a year, and nothing says what was before.
    """
    if course.kind == "temperature":
        return lambda steps: np.full((len(steps.edges) - 1, 1), course.behind)
    from mascarin.building.soil.response import heat_of_outdoors

    hours, outdoors = _hourly(climate, steps, course.radiation)
    if course.before is None and len(outdoors) < _YEAR:
        raise InputError(
            f"soil_blocks.{course.block}.before: found {len(outdoors) / 24.0:.0f} days of weather and no "
            "outdoor air before; expected a year of weather, or the yearly mean of the years before it. "
            "Write 'before: {mean: 10, amplitude: 8, coldest_day: 15}'"
        )
    before = course.before
    if before is not None:
        before = (before[0] - course.behind, *before[1:])
    heat = heat_of_outdoors(
        course.ladder,
        np.asarray(outdoors - course.behind, dtype=np.float64),
        before,
        _day_of_year(climate, steps.first + float(hours[0])),
    )
    into_cell = heat[:, course.cell].copy()

    def values(steps: Steps) -> Array:
        middles = 0.5 * (steps.edges[:-1] + steps.edges[1:])
        return np.asarray(np.interp(middles, hours, into_cell)[:, None])

    return values


def _hourly(
    climate: Climate, steps: Steps, radiation: tuple[float, float, float] | None
) -> tuple[Array, Array]:
    """Ends of hours, from the start of a run [s], and the temperature that acts outdoors there. [degC]

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
    air = _without_gaps(channel_values(climate.record, "air_temperature", hours)[:, 0])
    ends = np.asarray(edges[1:] + (first - steps.first))
    return ends, air if radiation is None else air + _excess(climate, hours, air, radiation)


def _excess(climate: Climate, hours: Steps, air: Array, radiation: tuple[float, float, float]) -> Array:
    """What sun and sky add to the temperature that acts on the ground: the sol-air temperature. [K]

    The ground gives off heat by its film, which is linear about the air: with it, the net radiation of a
    ground at the temperature of the air has the effect of warmer air (ASHRAE Handbook of Fundamentals 2017,
    chapter 18: sol-air temperature).
    """
    absorptance, emissivity, film = radiation
    record = climate.record
    # As completed for the place of the building: the global irradiance may have been measured in parts.
    sun = _without_gaps(column_means(climate.used.record, "global_horizontal", hours))
    sky = channel_values(record, "infrared", hours)[:, 0]
    if np.isnan(sky).any():
        needed = ("dew_point", "cloud_cover")
        if any(record.columns.get(name) is None for name in needed):
            raise InputError(
                f"{record.file}: found no infrared radiation of the sky in all hours, and no dew "
                "point and cloud cover to estimate it; expected it where a block of soil has 'absorptance'. "
                "Give the column infrared, or remove 'absorptance' from soil_blocks"
            )
        dew_point, cloud_cover = (channel_values(record, name, hours)[:, 0] for name in needed)
        sky = _without_gaps(np.where(np.isnan(sky), sky_emission(air, dew_point, cloud_cover), sky))
    net = absorptance * np.maximum(sun, 0.0) + emissivity * (sky - STEFAN_BOLTZMANN * (air + KELVIN) ** 4)
    return np.asarray(net / film)


def _without_gaps(values: Array) -> Array:
    """Values with what is missing between others."""
    finite = np.isfinite(values)
    if finite.all() or not finite.any():
        return np.asarray(values, dtype=np.float64)
    index = np.arange(values.size)
    return np.asarray(np.interp(index, index[finite], values[finite]), dtype=np.float64)


def _day_of_year(climate: Climate, seconds: float) -> float:
    """Day of the year at a time since 1970-01-01 UTC, from 0."""
    moment = clock(np.array([seconds]), climate.grid.zone)[0]
    return float((moment - moment.astype("datetime64[Y]")) / np.timedelta64(1, "D"))
