"""From a building and a climate to what the engine needs: period, outputs, forcing and start."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.arguments import mapping_of, require_type
from mascarin.building import Building
from mascarin.building.engine_input.series_users import courses
from mascarin.building.outputs.output import chosen
from mascarin.building.parts.envelope.convection import measured_column
from mascarin.engine_errors import plan_of
from mascarin.errors import InputError
from mascarin.simulation.checks.flow_balance import require_balanced_flows
from mascarin.simulation.checks.wind_check import require_wind
from mascarin.simulation.preparation import step_sequence
from mascarin.simulation.preparation.initial import MeasuredStart, resolved
from mascarin.simulation.preparation.initial import read as read_initial
from mascarin.simulation.preparation.initial_state import Ambient, GivenStart
from mascarin.simulation.preparation.limits import require_scheme, set_point_pairs
from mascarin.simulation.preparation.sky import with_sky_of
from mascarin.simulation.preparation.weather_inputs import with_weather_inputs
from mascarin.simulation.records.times import Times
from mascarin.tables.forcing_blocks import SMALL, STEPS, ForcingBlocks
from mascarin.tables.steps import Steps
from mascarin.tables.times import stamps_of
from mascarin.tables.timezones import seconds_at, with_year
from mascarin.weather import (
    CHANNELS,
    COEFFICIENTS,
    IRRADIANCES,
    STAGES,
    TEMPERATURES,
    Climate,
    Measurements,
    parse_timezone,
)
from mascarin.weather.forcing_source import ForcingSource, in_blocks
from mascarin.weather.schedules import Courses

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin._io.durations import AutoStep
    from mascarin.building import EngineDescription, Output
    from mascarin.simulation.preparation.initial_state import InitialTemperatures
    from mascarin.simulation.preparation.options import Scheme, TimeLike
    from mascarin.simulation.preparation.step_sequence import StepSequence
    from mascarin.simulation.preparation.weather_inputs import WeatherInputs
    from mascarin.tables.arrays import Halvings

    Array = npt.NDArray[np.float64]

__all__ = [
    "changed_parameters",
    "chosen_forcing_of",
    "chosen_outputs",
    "forcing_of",
    "in_climate",
    "limits_of_columns",
    "period",
    "read_initial",
    "require_inputs",
    "settings_of",
    "span",
    "start_of",
]

#: Largest change of any temperature between two repetitions of the first period. [K]
REPEATED_WITHIN: Final = 0.01
#: Repetitions after which the first period counts as not converged.
MAX_REPETITIONS: Final = 1000


def require_inputs(building: object, climate: object, measurements: object = None) -> None:
    """Refuse what is no building, no climate or no measurements, before anything is read from them.

    Raises
    ------
    InputError
        Something else was given; the text names what makes it.
    """
    require_type(
        "building", building, Building, "a mascarin.Building; Building.from_yaml and from_dict read one"
    )
    require_type(
        "climate",
        climate,
        Climate,
        "a mascarin.Climate; Climate.from_epw, from_tmy, from_table and from_pvlib read one",
    )
    if measurements is not None:
        require_type(
            "measurements",
            measurements,
            Measurements,
            "mascarin.Measurements; Measurements.from_table reads them",
        )


def in_climate(
    building: Building,
    climate: Climate,
    *,
    measurements: Measurements | None = None,
    parameters: Mapping[str, float] | None = None,
    varied: Iterable[str] = (),
) -> Building:
    """The building as it is simulated in a climate; every run, sweep, analysis and study begins here.

    Parameters
    ----------
    building : Building
        The building as described.
    climate : Climate
        Its weather.
    measurements : Measurements, optional
        Measured boundaries and sensors.
    parameters : mapping of str to float, optional
        Other values, by path. [unit of each]
    varied : iterable of str
        Paths of the parameters that vary.

    Returns
    -------
    Building
        With the other values, and with the infrared radiation of the weather unless a model of the sky is
        given or varies.

    Raises
    ------
    InputError
        Something is of another type, or a parameter cannot have its value.
    """
    require_inputs(building, climate, measurements)
    return with_sky_of(_with_parameters(building, parameters), climate, varied)


def _with_parameters(building: Building, parameters: Mapping[str, float] | None) -> Building:
    """The building with other values of some parameters.

    Raises
    ------
    InputError
        Unknown path, something that is no number, or a value that the parameter cannot have.
    """
    if not parameters:
        return building
    for path, value in mapping_of("parameters", parameters, "values by path").items():
        if isinstance(value, str | bool) or not np.isscalar(value):
            unit = building.parameter(path).unit or "its unit"
            raise InputError(
                f"parameters: {path}: found {value!r}, expected a number in {unit}. Replace a whole "
                "part with Building.replace()"
            )
    return building.with_values(parameters)


def changed_parameters(
    before: Building, after: Building, parameters: Mapping[str, float] | None
) -> dict[str, float]:
    """Parameters that `in_climate` changed, by whole path. [unit of each]"""
    old = {before.parameter(path).path: before.parameter(path).value for path in parameters or {}}
    new = {path: after.parameter(path).value for path in old}
    return {path: float(value) for path, value in new.items() if value != old[path]}


def period(
    climate: Climate, start: TimeLike | None, end: TimeLike | None
) -> tuple[pd.Timestamp, pd.Timestamp]:
    """Start and end in local time; by default those of the climate."""
    first, last = stamps_of(np.array(span(climate, start, end)), climate.grid.zone)
    return first, last


def span(
    climate: Climate, start: TimeLike | None, end: TimeLike | None, step: float = 0.0
) -> tuple[float, float]:
    """Start and end, by default those of the climate, in seconds since 1970-01-01 UTC. [s]

    An end that is not stated is that of the last whole step of so many seconds.
    """
    grid = climate.grid
    # A date without a year is the first one in the climate, and after the start.
    first, last = grid.start, grid.end
    if start is not None:
        first = seconds_at(with_year(start, grid.zone, grid.start), grid.zone, "start")
    if end is not None:
        last = seconds_at(with_year(end, grid.zone, first), grid.zone, "end")
    if last <= first:
        begin, finish = stamps_of(np.array([first, last]), grid.zone)
        if start is None or end is None:
            opening, closing = stamps_of(np.array([grid.start, grid.end]), grid.zone)
            which, limit, side = ("end", finish, "before") if start is None else ("start", begin, "after")
            raise InputError(
                f"{which}: found {limit}, {side} all values of {climate.file}; expected a time within "
                f"{opening} .. {closing}. Choose one there, or another weather file"
            )
        raise InputError(f"period: found start {begin} and end {finish}, expected the end after the start")
    if end is None and 0.0 < step <= last - first:
        last = first + step * math.floor((last - first) / step + 1e-9)
    return first, last


def chosen_outputs(building: Building, names: Sequence[str] | None) -> list[Output]:
    """Outputs by name, or the usual ones."""
    if names is not None:
        return chosen(building, names)
    return [output for output in building.outputs() if output.usual]


def forcing_of(
    building: Building,
    climate: Climate,
    description: EngineDescription,
    *,
    times: Times,
    scheme: Scheme,
    measurements: Measurements | None,
    halvings: Halvings | None = None,
    divided: bool = True,
) -> tuple[ForcingBlocks, WeatherInputs | None]:
    """Climate, measured columns and schedules at every stage, and what of the weather is a parameter.

    A long forcing is looked at in blocks of steps, and worked out again where it is needed, unless it is not
    to be `divided`, or something needs all steps at once: chosen steps, errors of the weather as parameters,
    a stated position of the sun.

    Raises
    ------
    InputError
        A channel that the building needs has no values.
    """
    require_scheme(building, scheme)
    names = description.schedules
    # Radiation whose clock the building corrects is compared with the sun when it is corrected.
    unchecked = climate if building.weather is None else Climate(replace(climate.record, check_sun=False))
    timezone = parse_timezone(building.site.timezone)
    source = ForcingSource(
        unchecked,
        building.site,
        description.channels[: len(description.channels) - len(names)],
        Courses(climate, courses(building) if names else {}, timezone, measurements),
        measurements,
        limits_of_columns(building),
    )
    check = _ForcingCheck(building, climate, description.channels, times)
    in_period = (times.zone, times.start, times.end, times.step, scheme)
    stages = len(STAGES[scheme][0]) if scheme in STAGES else 0
    shape = (round((times.last - times.first) / times.step), stages, source.channels)
    small = not divided or 8 * math.prod(shape) <= SMALL
    if small or halvings is not None or building.weather is not None or not source.divisible:
        steps = Steps.over(*in_period, halvings)
        forcing = source.at(steps)
        check.require(forcing, steps)
        check.require_wind()
        corrected, inputs = with_weather_inputs(
            building, climate, description, forcing,
            times=times, scheme=scheme, measurements=measurements, halvings=halvings,
        )  # fmt: skip
        return ForcingBlocks.of(corrected), inputs
    parts = partial(Steps.parts, *in_period, STEPS)
    blocks = in_blocks(source, parts, check.require, shape, _set_points(building, description.channels))
    check.require_wind()
    return blocks, None


def _set_points(building: Building, channels: Sequence[str]) -> set[int]:
    """Channels with set points, which are compared with each other before each run."""
    names = {course for pair in set_point_pairs(building) for _, course in pair.points if course is not None}
    return {len(CHANNELS) + list(channels).index(f"schedule {name}") for name in names}


class _ForcingCheck:
    """What a building needs of its forcing, looked at in blocks of steps."""

    def __init__(self, building: Building, climate: Climate, channels: Sequence[str], times: Times) -> None:
        self._building, self._climate = building, climate
        self._channels, self._times = channels, times
        self._calm = True

    def require(self, forcing: Array, steps: Steps) -> None:
        """Refuse missing numbers, and flows that do not balance."""
        _require_numbers(forcing, self._channels, self._building)
        begins = np.asarray(self._times.first + steps.edges, dtype=np.float64)
        require_balanced_flows(self._building, forcing, self._channels, begins, self._times.zone)
        self._calm = self._calm and not forcing[..., CHANNELS.index("wind_speed")].any()

    def require_wind(self) -> None:
        """Refuse weather without wind, when all steps were looked at."""
        require_wind(self._building, self._climate, calm=self._calm)


def start_of(
    initial: float | GivenStart | MeasuredStart | None,
    building: Building,
    description: EngineDescription,
    forcing: ForcingBlocks,
    start: datetime,
) -> float | InitialTemperatures | None:
    """Temperature or temperatures at the start; None to repeat the first period."""
    if initial is None or isinstance(initial, float):
        return initial
    # The weather of the first stage is also used at the start.
    now = dict(zip((*CHANNELS, *description.channels), forcing.opening.tolist(), strict=True))
    ambient = Ambient(now["air_temperature"], now["day_of_year"], now)
    return resolved(initial, building, description.nodes, ambient, start)


def settings_of(
    initial: float | InitialTemperatures | None,
    forcing: ForcingBlocks,
    *,
    step_seconds: float,
    scheme: Scheme,
    first_period: float,
    sequence: StepSequence | None = None,
) -> dict[str, Any]:
    """Step, scheme, start and repeated period, as the engine reads them."""
    intervals = len(forcing) if sequence is None else round(sequence.edges[-1] / step_seconds)
    steps = min(max(round(first_period / step_seconds), 1), intervals)
    temperatures: float | dict[str, list[float]]
    if initial is None:
        # The temperature that the repetition starts from changes only its length.
        temperatures = forcing.air_temperature
    elif isinstance(initial, float):
        temperatures = initial
    else:
        temperatures = {key: list(getattr(initial, key)) for key in ("cells", "faces", "air")}
    if sequence is not None:
        steps = sequence.count_in(steps)
    lengths = {} if sequence is None else {"halvings": sequence.halvings.tolist()}
    return {
        **lengths,
        "dt": step_seconds,
        "scheme": scheme,
        "initial": temperatures,
        "warmup_steps": steps if initial is None else 0,
        "warmup_tolerance": REPEATED_WITHIN,
        "warmup_max_cycles": MAX_REPETITIONS,
    }


def chosen_forcing_of(
    auto: AutoStep | None,
    building: Building,
    climate: Climate,
    description: EngineDescription,
    *,
    times: Times,
    scheme: Scheme,
    measurements: Measurements | None,
    start: float | GivenStart | MeasuredStart | None,
    first_period: float,
    outputs: Sequence[Output],
) -> tuple[ForcingBlocks, WeatherInputs | None, StepSequence | None]:
    """As `forcing_of`, with the steps of the run, which are chosen with the values of the building.

    Parameters
    ----------
    auto : AutoStep or None
        Tolerance; None: all steps have the length of `times`.
    building, climate, description, times, scheme, measurements
        As in `forcing_of`; `times` are those of the records.
    start : float, GivenStart, MeasuredStart or None
        What the run starts from.
    first_period : float
        Length of the repeated period. [s]
    outputs : sequence of Output
        What is recorded.

    Raises
    ------
    InputError
        The tolerance cannot be met, or an output depends on equal steps.
    """
    forcing_in = partial(forcing_of, building, climate, description, scheme=scheme, measurements=measurements)
    if auto is None:
        return *forcing_in(times=times), None
    step_sequence.require_outputs(building, outputs)
    forcings = [
        forcing_in(times=replace(times, step=times.step / 2**level), divided=False)[0]
        for level in range(step_sequence.weather_levels(times.step) + 1)
    ]
    initial = start_of(start, building, description, forcings[-1], times.start)
    settings = settings_of(
        initial, forcings[0], step_seconds=times.step, scheme=scheme, first_period=first_period
    )
    nominal = description.values  # noqa: PD011 (no pandas object)
    sequence = step_sequence.chosen_sequence(
        auto, times.step, (plan_of(description.json), nominal), [level.all_steps for level in forcings],
        settings, (times.first, times.zone), controlled=bool(building.controls),
    )  # fmt: skip
    return *forcing_in(times=times, halvings=sequence.halvings), sequence


def limits_of_columns(building: Building) -> dict[str, tuple[float, float]]:
    """Limits of the measured columns that act on a building, by what each is used for."""
    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    temperatures = {side.measured: TEMPERATURES for side in sides if isinstance(side.measured, str)}
    panes = [side for window in building.windows.values() for side in (window.outside, window.inside)]
    measured = (side.irradiance for side in [*sides, *panes])
    irradiances = {column: IRRADIANCES for column in measured if column is not None}
    films = [measured_column(side.convection) for side in [*sides, *panes]]
    return temperatures | irradiances | {film: COEFFICIENTS for film in films if film is not None}


def _require_numbers(forcing: Array, channels: Sequence[str], building: Building) -> None:
    """Channels that the engine reads must hold numbers; some may be absent."""
    names = (*CHANNELS, *channels)
    needed = building.site.sky.weather | (set() if building.humidity is None else {"dew_point"})
    absent = {"pressure"} | ({"infrared", "dew_point"} - needed)
    bad = [bool(np.isnan(forcing[..., k]).any()) for k in range(len(names))]
    missing = [name for name, empty in zip(names, bad, strict=True) if empty and name not in absent]
    if "dew_point" in missing and building.humidity is not None:
        raise InputError(
            "climate: found no dew point or relative humidity of the outdoor air, expected one of them: the "
            "building has a section 'humidity:'. Give the column (dew_point or relative_humidity), or remove "
            "'humidity:' from the building"
        )
    if missing:
        raise InputError(
            f"climate: no values for {', '.join(missing)}, which this building needs (sky model "
            f"'{building.site.sky.kind}'). Give the column, or choose another sky model, for example "
            "site.sky: {kind: offset}"
        )
