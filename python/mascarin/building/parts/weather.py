"""Errors of the measured weather: what its columns are multiplied by, what is added to them, their clock."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pydantic import Field

from mascarin.building import quantities as q
from mascarin.building.base.names import Name
from mascarin.building.base.number import Number
from mascarin.building.base.part import Part


class WeatherColumn(Part):
    """Corrections of one column: gain times reading plus offset, at the time of the clock.

    Examples
    --------
    >>> WeatherColumn(gain=1.06)
    WeatherColumn(gain=1.06, offset=0 unit of the column, clock=0 s)
    """

    gain: q.ColumnGain = Number(1.0)
    offset: q.ColumnOffset = Number(0.0)
    clock: q.ColumnClock = Number(0.0)


class Weather(Part):
    """Corrections of the weather that a building is simulated in.

    Examples
    --------
    >>> weather = Weather(columns={"global_horizontal": {"gain": {"value": 1.0, "range": [0.9, 1.1]}}})
    >>> weather.columns["global_horizontal"].gain.plausible
    (0.9, 1.1)
    """

    clock: q.ColumnClock = Number(0.0)
    columns: dict[Name, WeatherColumn] = Field(
        default_factory=dict,
        description="Corrections by column: a channel of the weather, radiation for all irradiances of the "
        "weather, or a measured column that the building names",
    )


def unstated(weather: Weather | None, paths: Iterable[str]) -> dict[str, Mapping[str, object]]:
    """Columns that paths name and a building does not state yet, by path, each as it was read.

    Parameters
    ----------
    weather : Weather or None
        What the building states.
    paths : iterable of str
        Paths of numbers, such as ``weather.columns.wind_speed.gain``.

    Examples
    --------
    >>> unstated(None, ["weather.columns.wind_speed.gain", "weather.clock"])
    {'weather': {}, 'weather.columns.wind_speed': {}}
    """
    numbers = [path.split(".") for path in paths if path.startswith("weather.")]
    stated = {} if weather is None else weather.columns
    columns: dict[str, Mapping[str, object]] = {
        ".".join(steps[:3]): {}
        for steps in numbers
        if len(steps) == 4 and steps[1] == "columns" and steps[2] not in stated
    }
    missing: dict[str, Mapping[str, object]] = {"weather": {}} if numbers and weather is None else {}
    return missing | columns
