"""Input of the engine: every channel at every stage of every step."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array, Flags
from mascarin.tables.checks import require_range
from mascarin.tables.grid import Grid
from mascarin.tables.profile import PiecewiseProfile, pieces_for, steady
from mascarin.tables.record import Record
from mascarin.tables.steps import Steps
from mascarin.tables.times import clock
from mascarin.weather.derived.radiation import from_instants, from_means
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.derived.sun_position import Sun, states_position, sun_over
from mascarin.weather.records.channels import (
    BY_NAME,
    CHANNELS,
    RADIATION,
    SOURCE_CHANNELS,
    SUN_POSITION,
    UNITS,
)
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import SiteLike
from mascarin.weather.records.window import window_of_steps


def require_period(record: WeatherRecord, steps: Steps) -> None:
    """Refuse a period outside the record, or one with impossible values.

    Parameters
    ----------
    record : WeatherRecord
        The weather as read.
    steps : Steps
        The period.

    Raises
    ------
    InputError
        The period is not covered, or a value in it is impossible.
    """
    hint = " (in Python, if it is a typical year: typical=True)" if record.of_year else ""
    record.grid.require(steps.first, steps.last, record.file, hint)
    for name in (*SOURCE_CHANNELS, *SUN_POSITION):
        if name in record.columns:
            require_range(
                record, name, (BY_NAME[name].low, BY_NAME[name].high), steps.first, steps.last, UNITS[name]
            )


def forcing(
    source: WeatherRecord,
    completed: WeatherRecord,
    site: SiteLike,
    steps: Steps,
    channels: Sequence[str] = (),
    measured: Record | None = None,
    limits: Mapping[str, tuple[float, float]] | None = None,
    further: int = 0,
) -> Array:
    """Channels at the stages of every step of a period.

    Instants are linear between their stamps (wind direction along the shorter arc). Means are
    reconstructed inside their intervals, and radiation follows the sun; over each step, the weighted mean
    of the stages is that of the reconstruction.

    Parameters
    ----------
    source : WeatherRecord
        The weather as read.
    completed : WeatherRecord
        The same with all irradiances, see `completion.complete`.
    site : object with latitude and longitude
        Place for which the position of the sun is computed.
    steps : Steps
        The period.
    channels : sequence of str
        Measured columns to append, from the weather's extra columns or from the measurements.
    measured : Record, optional
        Where to look for columns that the weather does not hold.
    limits : mapping of str to (float, float), optional
        Lowest and highest possible value of measured columns, by their use: `TEMPERATURES`,
        `IRRADIANCES` or `COEFFICIENTS`. [unit of the column]
    further : int
        Channels at the end that the caller fills, so that a long period needs no second array.

    Returns
    -------
    ndarray, shape (steps, stages, len(CHANNELS) + len(channels) + further)
        In the units of `CHANNELS`; measured columns in their own.

    Raises
    ------
    InputError
        A value in the period is missing or impossible, or a column is unknown.
    """
    out = np.empty((*steps.stage.shape, len(CHANNELS) + len(channels) + further))
    first = steps.first
    _fill_at_place(out[..., : len(CHANNELS)], completed, site, steps)
    for column, name in enumerate(channels, start=len(CHANNELS)):
        record = record_of(source, measured, name)
        if steps.opens:
            record.grid.require(first, steps.last, f"{record.file}: {name}")
            if limits is not None and name in limits:
                require_range(record, name, limits[name], first, steps.last, UNITS.get(name, ""))
        out[..., column] = column_values(record, name, steps)
    return out


def _fill_at_place(out: Array, completed: WeatherRecord, site: SiteLike, steps: Steps) -> None:
    """Weather and sun without measured columns; the last one is kept, for other buildings at the place."""
    latitude, longitude = float(site.latitude), float(site.longitude)
    key = (
        latitude,
        longitude,
        steps.first,
        steps.last,
        len(steps.stage),
        steps.weights,
        steps.edges.tobytes(),
    )
    if steps.part is None and _LAST and _LAST[0].record is completed and _LAST[0].key == key:
        out[...] = _LAST[0].values
        return
    sun = sun_over_steps(completed, latitude, longitude, steps)
    # In blocks, so that what is worked out on the way takes no memory beside the result.
    for row in range(0, len(steps.stage), _ROWS):
        block = slice(row, row + _ROWS)
        _fill_sun(out[block], sun, steps.stage[block], steps.first, completed.grid)
    for name in SOURCE_CHANNELS[:7]:
        out[..., CHANNELS.index(name)] = channel_values(completed, name, steps)
    fill_radiation(out, completed, sun, steps)
    if steps.part is None and out.nbytes <= _MOST_KEPT:
        _LAST[:] = [_Kept(completed, key, out.copy())]


def sun_over_steps(record: WeatherRecord, latitude: float, longitude: float, steps: Steps) -> Sun:
    """The sun over a period and what lies around it in a record. [deg]"""
    reach, first = 5.0 * record.grid.interval + 3600.0, steps.first
    span = (first - reach, steps.last + reach)
    if steps.part is None or states_position(record):
        return sun_over(record, latitude, longitude, span, first)
    reach += _OVERLAP * record.grid.interval
    part = (first + float(steps.edges[0]) - reach, first + float(steps.edges[-1]) + reach)
    return SunPath.over(latitude, longitude, *span, first, part)


@dataclass(frozen=True)
class _Kept:
    """Weather at the stages of the steps of a period."""

    record: WeatherRecord
    key: tuple[object, ...]
    values: Array


_LAST: Final[list[_Kept]] = []
#: Steps whose sun is worked out together.
_ROWS: Final = 2**15
#: Intervals by which the values of two parts of a period overlap, at most.
_OVERLAP: Final = 64
#: A year in steps of 15 min takes 10 MB. [B]
_MOST_KEPT: Final = 16 * 2**20


def _fill_sun(out: Array, sun: Sun, stage: Array, origin: float, grid: Grid) -> None:
    """Extraterrestrial irradiance, sun vector and day of the year."""
    out[..., CHANNELS.index("direct_normal_extra")] = sun.normal_irradiance(stage)
    east = CHANNELS.index("sun_east")
    out[..., east : east + 3] = sun.vector(stage)
    out[..., CHANNELS.index("day_of_year")] = _day_of_year(origin + stage, grid)


def _day_of_year(stage: Array, grid: Grid) -> Array:
    local = clock(stage.ravel(), grid.zone)
    year = local.astype("datetime64[Y]").astype(local.dtype)
    return np.asarray((local - year) / np.timedelta64(1, "D"), dtype=np.float64).reshape(stage.shape)


def channel_values(record: WeatherRecord, name: str, steps: Steps) -> Array:
    """A channel of the weather at the stages of every step, shape (steps, stages). [unit of the channel]

    Parameters
    ----------
    record : WeatherRecord
        The weather.
    name : str
        One of the source channels, no short-wave one.
    steps : Steps
        The period.

    Raises
    ------
    InputError
        The weather does not have it.
    """
    if name in record.columns:
        if name != "infrared" or not record.of_year:
            return column_values(record, name, steps)
        # Rows without a value are no fault where the building has a model of the sky.
        with contextlib.suppress(InputError):
            return column_values(record, name, steps)
    if name in ("infrared", "pressure"):
        return np.full(steps.stage.shape, np.nan)
    raise InputError(f"{record.file}: the climate has no {name}; map a column or state that it is absent.")


def column_means(record: Record, name: str, steps: Steps) -> Array:
    """Means of a column over steps.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    steps : Steps
        The period.

    Returns
    -------
    ndarray, shape (steps,)
        A mean is constant inside its interval; instants are joined by straight lines. [unit of the column]
    """
    edges = steps.edges
    start, before, values, kind = window_of_steps(record, name, steps)
    knots = start + record.grid.interval * (before + np.arange(len(values) + (kind == "mean")))
    # Fine enough that the mean of straight lines is exact: the integral at every knot and edge.
    nodes: Array = np.union1d(knots, edges)
    integral: Array = np.empty(0)
    if steps.part is not None and not steps.opens:
        # It goes on from where the part before ended.
        nodes, integral = nodes[nodes >= edges[0]], steps.part.sums["mean", id(record), name, edges[0]][1]
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    inside = (
        values[np.clip(np.searchsorted(knots, middle) - 1, 0, len(values) - 1)]
        if kind == "mean"
        else np.interp(middle, knots, values)
    )
    integral = np.cumsum(np.concatenate([integral, inside * np.diff(nodes)]))
    at_edges = np.interp(edges, nodes, np.concatenate([[0.0], integral]) if steps.opens else integral)
    if steps.part is not None:
        steps.part.sums["mean", id(record), name, edges[-1]] = (0, at_edges[-1:].copy())
    return np.asarray(np.diff(at_edges) / np.diff(edges))


def column_values(record: Record, name: str, steps: Steps) -> Array:
    """A column at the stages of every step.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    steps : Steps
        The period.

    Returns
    -------
    ndarray, shape (steps, stages)
        Instants are joined by straight lines; a mean is reconstructed, and over each step the weighted mean
        of the stages is that of the reconstruction. [unit of the column]
    """
    edges, stage, weights = steps.edges, steps.stage, steps.weights
    start, before, values, kind = window_of_steps(record, name, steps)
    interval = record.grid.interval
    if name == "wind_direction":
        values = _unwrapped(values, steps, before, id(record))
    if kind == "instant":
        knots = start + interval * np.arange(before, before + len(values))
        result = np.asarray(np.interp(stage, knots, values))
        return result % 360.0 if name == "wind_direction" else result
    positive = name != "wind_direction" and not (record.columns[name] < 0.0).any()
    nodes = steady(values, pieces_for(interval), positive=positive)
    profile = PiecewiseProfile(start, interval, nodes, before)
    balanced = _balanced(profile, edges, stage, weights, additive=not positive)
    return balanced % 360.0 if name == "wind_direction" else balanced


def _unwrapped(directions: Array, steps: Steps, before: int, record: int) -> Array:
    """Directions without jumps by whole turns, as `numpy.unwrap` adds up its corrections. [deg]"""
    if steps.part is None:
        return np.unwrap(directions, period=360.0)
    change = np.diff(directions)
    shorter = np.mod(change + 180.0, 360.0) - 180.0
    shorter[(shorter == -180.0) & (change > 0.0)] = 180.0
    turns = np.where(np.abs(change) < 180.0, 0.0, shorter - change)
    first = before
    turned: Array = np.zeros(1)
    if not steps.opens:
        first, turned = steps.part.sums["turns", record, steps.edges[0]]
    # The part before overlaps with this one: from its turns at the first direction on.
    turned = np.cumsum(np.concatenate([turned[before - first : before - first + 1], turns]))
    last = max(len(turned) - _OVERLAP, 0)
    steps.part.sums["turns", record, steps.edges[-1]] = (before + last, turned[last:].copy())
    return np.asarray(directions + turned)


def fill_radiation(out: Array, record: WeatherRecord, sun: Sun, steps: Steps) -> None:
    """Write the short-wave channels at the stages of every step.

    Parameters
    ----------
    out : ndarray, shape (steps, stages, channels)
        Changed in place; its sun is there already. [unit of each channel]
    record : WeatherRecord
        With all irradiances.
    sun : Sun
        The sun over the period and five intervals around it, its times counted from the start.
    steps : Steps
        The period.
    """
    edges, basis = steps.edges, record.radiation_basis
    components = {"direct+diffuse": RADIATION[:2], "global+diffuse": RADIATION[1:], "all": RADIATION}[basis]
    irradiances: dict[str, Array] = {}
    start, before, kind = 0.0, 0, "mean"
    for name in components:
        start, before, irradiances[name], kind = window_of_steps(record, name, steps)
    blank = np.zeros_like(irradiances["diffuse_horizontal"])
    direct, diffuse, total = (irradiances.get(name, blank) for name in RADIATION)
    make = from_means if kind == "mean" else from_instants
    sky = make(sun, start, record.grid.interval, direct, diffuse, total, basis, before)
    sunlit = out[..., CHANNELS.index("sun_up")] > 0.0
    for name in RADIATION:
        profile: PiecewiseProfile = getattr(sky, name)
        usable = sunlit if name == "direct_normal" else None
        column = out[..., CHANNELS.index(name)]
        # In blocks, as the sun.
        for row in range(0, len(column), _ROWS):
            block = slice(row, row + _ROWS)
            column[block] = _balanced(
                profile, edges[row : row + _ROWS + 1], steps.stage[block], steps.weights,
                usable=None if usable is None else usable[block],
            )  # fmt: skip


def _balanced(
    profile: PiecewiseProfile,
    edges: Array,
    stage: Array,
    weights: tuple[float, ...],
    *,
    additive: bool = False,
    usable: Flags | None = None,
) -> Array:
    """Stage values whose weighted mean is the profile's mean over each step.

    The profile's values at the stages are scaled (or shifted, where a sign may change). Where all of them
    vanish and the mean does not, each stage takes the mean.
    """
    means = profile.means(edges)
    values = profile.at(stage)
    weight = np.array(weights)
    if additive:
        return np.asarray(values + (means - values @ weight)[:, None])
    if usable is not None:
        values = np.where(usable, values, 0.0)
    total = values @ weight
    small = np.abs(total) <= 1e-3 * np.abs(means)
    scaled = values * (means / np.where(small, 1.0, total))[:, None]
    return np.asarray(np.where(small[:, None], means[:, None], scaled))


def record_of(weather: WeatherRecord, measured: Record | None, name: str) -> Record:
    """The record that holds a measured column.

    Parameters
    ----------
    weather : WeatherRecord
        Looked at first.
    measured : Record or None
        Looked at next.
    name : str
        Column.

    Raises
    ------
    InputError
        Neither holds it; the text names the nearest columns.
    """
    if name in weather.columns and name not in CHANNELS:
        return weather
    if measured is not None and name in measured.columns:
        return measured
    measured_columns = [str(column) for column in weather.columns if column not in CHANNELS]
    measured_columns += [] if measured is None else [str(column) for column in measured.columns]
    where = weather.file if measured is None else f"{weather.file}, {measured.file}"
    hint = (
        did_you_mean(name, measured_columns)
        if measured_columns
        else "No measured columns were read: name them under extra."
    )
    raise InputError(f"{where}: no measured column {name!r}, which the building needs. {hint}".rstrip())
