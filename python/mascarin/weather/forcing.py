"""What the engine is driven by: every channel at every stage of every step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.weather.arrays import Array, Flags
from mascarin.weather.channels import BY_NAME, CHANNELS, RADIATION, SOURCE_CHANNELS
from mascarin.weather.checks import require_range, require_values
from mascarin.weather.grid import Grid, course
from mascarin.weather.place import require_place
from mascarin.weather.profile import Profile, pieces_for, steady
from mascarin.weather.radiation import from_instants, from_means
from mascarin.weather.sun import SunPath
from mascarin.weather.table import stamps_of
from mascarin.weather.timezones import moment

if TYPE_CHECKING:
    from mascarin.weather.climate import Climate, SiteLike
    from mascarin.weather.measurements import Measurements


_GAMMA: Final = 1.0 - 0.5 * float(np.sqrt(2.0))

STAGES: Final[dict[str, tuple[tuple[float, ...], tuple[float, ...]]]] = {
    "sdirk2": ((_GAMMA, 1.0), (1.0 - _GAMMA, _GAMMA)),
    "backward-euler": ((1.0,), (1.0,)),
    "apparent-capacity": ((1.0,), (1.0,)),
}
"""Stage times as parts of a step, and stage weights, of each scheme."""


def forcing(
    climate: Climate,
    site: SiteLike,
    start: object,
    end: object,
    step_seconds: float,
    scheme: str = "sdirk2",
    channels: Sequence[str] = (),
    measurements: Measurements | None = None,
    limits: Mapping[str, tuple[float, float]] | None = None,
) -> Array:
    """Channels at the stages of every step of a period.

    Instants are linear between their stamps (wind direction the short way round). Means are
    reconstructed inside their intervals, radiation following the sun; over each step the weighted mean of the
    stages is that of the reconstruction.

    Parameters
    ----------
    climate : Climate
        The weather.
    site : object with latitude and longitude
        Where the sun is seen from.
    start, end : str, datetime or pandas.Timestamp
        Period; without an offset, local time of the climate. A whole number of steps.
    step_seconds : float
        Step [s].
    scheme : str
        A key of `STAGES`.
    channels : sequence of str
        Measured columns to append, from the climate's extra columns or the measurements.
    measurements : Measurements, optional
        Where to look for columns that the climate does not hold.
    limits : mapping of str to (float, float), optional
        Lowest and highest possible value of measured columns, by what each is used for: `TEMPERATURES` or
        `IRRADIANCES` [unit of the column].

    Returns
    -------
    ndarray, shape (steps, stages, len(CHANNELS) + len(channels))
        Units of `CHANNELS`; measured columns in their own.

    Raises
    ------
    InputError
        The climate is of another place, the period is outside the data, a value in it is missing or
        impossible, a column is unknown.
    """
    require_place(climate, site)
    nodes, weights = _stages(scheme)
    first = moment(start, climate.grid.zone, "start").timestamp()
    last = moment(end, climate.grid.zone, "end").timestamp()
    count = _steps(first, last, step_seconds)
    # Times count from the period's start, so that sums over a year lose no digits.
    edges = step_seconds * np.arange(count + 1)
    stage = edges[:-1, None] + step_seconds * np.array(nodes)
    hint = " (in Python, a year that stands for any other: typical=True)" if climate.of_year else ""
    climate.grid.require(first, last, climate.file, hint)
    for name in SOURCE_CHANNELS:
        if name in climate.data.columns:
            require_range(climate, name, (BY_NAME[name].low, BY_NAME[name].high), first, last)
    ready = climate.completed(site)
    out = np.empty((count, len(nodes), len(CHANNELS) + len(channels)))
    reach = 5.0 * ready.grid.interval + 3600.0
    sun = SunPath.over(float(site.latitude), float(site.longitude), first - reach, last + reach, first)
    _fill_sun(out, sun, stage, first, climate.grid)
    for name in SOURCE_CHANNELS[:7]:
        out[..., CHANNELS.index(name)] = _weather(ready, name, first, edges, stage, weights)
    _fill_radiation(out, ready, sun, first, edges, stage, weights)
    for place, name in enumerate(channels, start=len(CHANNELS)):
        holder = holder_of(climate, measurements, name)
        holder.grid.require(first, last, f"{holder.file}: {name}")
        if limits is not None and name in limits:
            require_range(holder, name, limits[name], first, last)
        out[..., place] = column_values(holder, name, first, edges, stage, weights)
    return out


def _stages(scheme: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if scheme not in STAGES:
        raise InputError(f"scheme: no scheme {scheme!r}. {did_you_mean(scheme, STAGES)}")
    return STAGES[scheme]


def _steps(first: float, last: float, step: float) -> int:
    if not step > 0.0:
        raise InputError(f"step: found {step!r} s, expected a positive length.")
    count = round((last - first) / step)
    if count < 1 or abs(count * step - (last - first)) > 1e-6:
        raise InputError(
            f"period: {last - first:g} s from start to end is not a whole number of steps of {step:g} "
            "s, at least one; "
            "move the end or change the step."
        )
    return count


def _fill_sun(out: Array, sun: SunPath, stage: Array, origin: float, grid: Grid) -> None:
    """Extraterrestrial irradiance, sun vector and day of the year."""
    out[..., CHANNELS.index("direct_normal_extra")] = sun.normal_irradiance(stage)
    east = CHANNELS.index("sun_east")
    out[..., east : east + 3] = sun.vector(stage)
    out[..., CHANNELS.index("day_of_year")] = _day_of_year(origin + stage, grid)


def _day_of_year(stage: Array, grid: Grid) -> Array:
    local = stamps_of(stage.ravel(), grid.zone).tz_localize(None).to_numpy()
    year = local.astype("datetime64[Y]").astype(local.dtype)
    return np.asarray((local - year) / np.timedelta64(1, "D"), dtype=np.float64).reshape(stage.shape)


def _weather(
    climate: Climate, name: str, origin: float, edges: Array, stage: Array, weights: tuple[float, ...]
) -> Array:
    if name in climate.data.columns:
        return column_values(climate, name, origin, edges, stage, weights)
    if name in ("infrared", "pressure"):
        return np.full(stage.shape, np.nan)
    raise InputError(f"{climate.file}: the climate has no {name}; map a column or state that it is absent.")


def column_means(holder: Climate | Measurements, name: str, origin: float, edges: Array) -> Array:
    """Means of a column over steps.

    Parameters
    ----------
    holder : Climate or Measurements
        Where the column is.
    name : str
        Column.
    origin : float
        Start of the period, seconds since 1970-01-01 UTC [s].
    edges : ndarray, shape (steps + 1,)
        Ends of the steps from there [s].

    Returns
    -------
    ndarray, shape (steps,)
        A mean stays level inside its interval; instants are joined by straight lines. [unit of the column]
    """
    start, values, kind = window(holder, name, origin + edges[0], origin + edges[-1])
    knots = start - origin + holder.grid.interval * np.arange(len(values) + (kind == "mean"))
    # Fine enough that the mean of straight lines is exact: the integral at every knot and edge.
    places = np.union1d(knots, edges)
    middle = 0.5 * (places[1:] + places[:-1])
    inside = (
        values[np.clip(np.searchsorted(knots, middle) - 1, 0, len(values) - 1)]
        if kind == "mean"
        else np.interp(middle, knots, values)
    )
    integral = np.concatenate([[0.0], np.cumsum(inside * np.diff(places))])
    return np.asarray(np.diff(np.interp(edges, places, integral)) / np.diff(edges))


def column_values(
    holder: Climate | Measurements,
    name: str,
    origin: float,
    edges: Array,
    stage: Array,
    weights: tuple[float, ...],
) -> Array:
    """A column at the stages of every step; times from `origin` [s]."""
    start, values, kind = window(holder, name, origin + edges[0], origin + edges[-1])
    start -= origin
    interval = holder.grid.interval
    if kind == "instant":
        knots = start + interval * np.arange(len(values))
        if name == "wind_direction":
            return np.asarray(np.interp(stage, knots, np.unwrap(values, period=360.0)) % 360.0)
        return np.asarray(np.interp(stage, knots, values))
    positive = bool(holder.data[name].min() >= 0.0)
    if name == "wind_direction":
        values, positive = np.unwrap(values, period=360.0), False
    nodes = steady(values, pieces_for(interval), positive=positive)
    result = _balanced(Profile(start, interval, nodes), edges, stage, weights, additive=not positive)
    return result % 360.0 if name == "wind_direction" else result


def window(holder: Climate | Measurements, name: str, first: float, last: float) -> tuple[float, Array, str]:
    """Values of a column over a span and a little more.

    Parameters
    ----------
    holder : Climate or Measurements
        Where the column is.
    name : str
        Column.
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].

    Returns
    -------
    start : float
        Start of the first interval [s].
    values : ndarray
        Instants at both ends of all intervals, or means.
    kind : str
        `instant` or `mean`.

    Raises
    ------
    InputError
        A value that the span needs is missing.
    """
    kind = holder.kinds[name]
    start, rows = holder.grid.rows(first, last)
    values = course(
        holder.data[name].to_numpy(dtype=np.float64), holder.closing.get(name, np.nan), rows, kind
    )
    gaps = np.isnan(values)
    if gaps.any():
        require_values(holder, name, start, rows, gaps, first, last)
        values = _held(values)
    return start, values, kind


def _held(values: Array) -> Array:
    """Gaps in the margin take the nearest value."""
    good = np.flatnonzero(~np.isnan(values))
    if not len(good):
        return np.zeros_like(values)
    place = np.arange(len(values))
    right = np.clip(np.searchsorted(good, place), 0, len(good) - 1)
    left = np.clip(right - 1, 0, len(good) - 1)
    nearer = np.abs(good[left] - place) <= np.abs(good[right] - place)
    return values[np.where(nearer, good[left], good[right])]


def _fill_radiation(
    out: Array,
    climate: Climate,
    sun: SunPath,
    origin: float,
    edges: Array,
    stage: Array,
    weights: tuple[float, ...],
) -> None:
    basis = climate.radiation_basis()
    kept = {"direct+diffuse": RADIATION[:2], "global+diffuse": RADIATION[1:], "all": RADIATION}[basis]
    courses: dict[str, Array] = {}
    start, kind = 0.0, "mean"
    for name in kept:
        start, courses[name], kind = window(climate, name, origin + edges[0], origin + edges[-1])
    blank = np.zeros_like(courses["diffuse_horizontal"])
    direct, diffuse, total = (courses.get(name, blank) for name in RADIATION)
    make = from_means if kind == "mean" else from_instants
    sky = make(sun, start - origin, climate.grid.interval, direct, diffuse, total, basis)
    lit = out[..., CHANNELS.index("sun_up")] > 0.0
    for name in RADIATION:
        profile: Profile = getattr(sky, name)
        usable = lit if name == "direct_normal" else None
        out[..., CHANNELS.index(name)] = _balanced(profile, edges, stage, weights, usable=usable)


def _balanced(
    profile: Profile,
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


def holder_of(climate: Climate, measurements: Measurements | None, name: str) -> Climate | Measurements:
    """Who holds a measured column.

    Raises
    ------
    InputError
        Nobody; the text names the nearest columns.
    """
    if name in climate.data.columns and name not in CHANNELS:
        return climate
    if measurements is not None and name in measurements.data.columns:
        return measurements
    known = [str(column) for column in climate.data.columns if column not in CHANNELS]
    known += [] if measurements is None else [str(column) for column in measurements.data.columns]
    where = climate.file if measurements is None else f"{climate.file}, {measurements.file}"
    hint = did_you_mean(name, known) if known else "No measured columns were read: name them under extra."
    raise InputError(f"{where}: no measured column {name!r}, which the building needs. {hint}".rstrip())
