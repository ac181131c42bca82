"""How much later than the sun the irradiances of a tilted plane and of the horizontal are.

On a clear day the ratio of the irradiance of a plane to the global one is that of the cosines of the sun,
except for the diffuse part. All that is not known exactly is fitted together with the shift of the clock,
each within its standard uncertainty: azimuth and tilt of the plane, gain of the instruments, the part of the
radiation that is diffuse, at noon, with low sun and between morning and afternoon, and the light from the
ground. An error of the azimuth looks much like a shift; what then remains uncertain of the shift follows
from the fit. Hours in which the plane does not follow, such as those behind an obstacle, count little, and
days with many of them, such as cloudy ones, not at all.

References
----------
Haurwitz 1945, Journal of Meteorology 2(3), 154-166, doi:10.1175/1520-0469(1945)002<0154:IIRTCA>2.0.CO;2.
Liu & Jordan 1963, Solar Energy 7(2), 53-74, doi:10.1016/0038-092X(63)90006-9 (diffuse and reflected part of
a plane).
Hay 1979, Solar Energy 23(4), 301-307, doi:10.1016/0038-092X(79)90123-3 (the part of the sky's light that
comes from about the sun goes with the beam).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.tables.arrays import Array, Flags
from mascarin.weather.checks.clock_shift import LAGS, NODE, Days, days_of
from mascarin.weather.records.record import WeatherRecord

_AZIMUTH: Final = 4.0
"""Standard uncertainty of a stated azimuth: a plan, a compass. [deg]"""
_TILT: Final = 1.5
"""The same of a tilt. [deg]"""
_GAIN: Final = 0.07
"""Standard uncertainty of the ratio of the gains of two pyranometers. [-]"""
_DIFFUSE: Final = (0.12, 0.03)
"""Part of a clear day's global irradiance that comes from all of the sky: with the sun in the zenith, and
for each unit of 1 / sine of the elevation more. [-]"""
_DIFFUSE_KNOWN: Final = (0.07, 0.03)
"""Standard uncertainties of both. [-]"""
_DIFFUSE_OF_DAY: Final = 0.05
"""Standard uncertainty of what it changes over six hours from noon. [-]"""
_ALBEDO_KNOWN: Final = 0.12
"""Standard uncertainty of the reflectance of the ground. [-]"""
_NOISE: Final = (10.0, 0.05)
"""Standard deviation of clear hours: of any [W/m2], and relative to the larger irradiance [-]."""
_FAR: Final = 3.0
"""Residuals beyond this many standard deviations decide nothing. [-]"""
_CLOSE_RESIDUAL: Final = 1.5
"""Hours within this many standard deviations follow the plane. [-]"""
_CLEAR_PART: Final = 0.75
"""Part of the hours of a day that follow the plane from which a day is a clear one. [-]"""
_BRIGHT: Final = 0.8
"""Part of the radiation of a clear sky that a clear day has at least. [-]"""
_CLEAR_SKY: Final = 1098.0
_DECAY: Final = 0.057
"""Clear sky of Haurwitz: irradiance with the sun in the zenith [W/m2] without, and its decay [-]."""
_LOW: Final = 0.08
"""Sine of the elevation below which hours are not compared. [-]"""
FLOOR: Final = 180.0
"""Uncertainty that remains with any number of days. [s]"""
_ITERATIONS: Final = 6
_FEWEST: Final = 6
"""Rows of a day that is used."""
_HOURS: Final = 8.0
"""Comparisons that are independent: those of a day. Days share most errors. [-]"""
_MOST_MISFIT: Final = 1e6
_FIRST, _SECOND = 0, 1
_LEAST: Final = 20.0
"""Least global irradiance that is compared. [W/m2]"""


@dataclass(frozen=True)
class MeasuredPlane:
    """A measured irradiance of a tilted plane.

    Attributes
    ----------
    name : str
        Column.
    values : ndarray, shape (rows,)
        On the grid of the weather. [W/m2]
    azimuth, tilt : float
        Of the outward normal: clockwise from north, and from the vertical. [deg]
    albedo : float
        Reflectance of the ground. [-]
    """

    name: str
    values: Array
    azimuth: float
    tilt: float
    albedo: float = 0.2


@dataclass(frozen=True)
class PlaneShift:
    """How much later than the sun the irradiance of a plane is, beside the global one.

    Attributes
    ----------
    late : float
        Positive where the stamps are too late. [s]
    uncertainty : float
        Standard uncertainty. [s]
    days : int
        Clear days that were used.
    followed, stated : float
        Part of the hours of these days that the plane follows with this shift, and with the stated clock. [-]
    """

    late: float
    uncertainty: float
    days: int
    followed: float
    stated: float


@dataclass(frozen=True)
class _Terms:
    """The comparison of a plane for one shift, linear in what is fitted.

    Attributes
    ----------
    residual : ndarray, shape (days, rows)
        For the stated values. [standard deviations]
    slopes : ndarray, shape (days, rows, 7)
        By each fitted number, in units of its standard uncertainty. [standard deviations]
    used : ndarray of bool, shape (days, rows)
        Rows with the sun up.
    noon : ndarray, shape (days, 1)
        Row with the highest sun.
    """

    residual: Array
    slopes: Array
    used: Flags
    noon: Array

    def of(self, half: int | None) -> _Terms:
        """The rows before or after the middle of the day alone."""
        if half is None:
            return self
        late = np.arange(self.used.shape[1]) >= self.noon
        used = self.used & (late if half == _SECOND else ~late)
        return _Terms(np.where(used, self.residual, 0.0), self.slopes, used, self.noon)


def shift_by_plane(
    record: WeatherRecord, plane: MeasuredPlane, latitude: float, longitude: float
) -> PlaneShift | None:
    """Shift of the clock that a plane shows beside the global irradiance.

    Parameters
    ----------
    record : WeatherRecord
        As read, with a measured global irradiance.
    plane : MeasuredPlane
        Of the same table.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    PlaneShift or None
        None without clear days.
    """
    days = days_of(record, latitude, longitude, {plane.name: plane.values})
    if days is None:
        return None
    terms = [_terms(days, plane, lag) for lag in LAGS.tolist()]
    clear = np.max([_follows(term) for term in terms], axis=0) >= _CLEAR_PART
    clear &= _brightness(days) >= _BRIGHT
    if not clear.any():
        return None
    estimate = _estimate(terms, clear, None)
    halves = [_estimate(terms, clear, half) for half in (_FIRST, _SECOND)]
    if estimate is None or halves[0] is None or halves[1] is None:
        return None
    apart = 0.5 * abs(halves[0][0] - halves[1][0])
    days_apart = 0.0
    numbers = np.flatnonzero(clear)
    if len(numbers) > 1:
        parts = [np.isin(np.arange(len(clear)), numbers[k::2]) for k in (0, 1)]
        both = [_estimate(terms, part, None) for part in parts]
        if both[0] is None or both[1] is None:
            return None
        days_apart = 0.5 * abs(both[0][0] - both[1][0])
    uncertainty = float(np.sqrt(estimate[1] ** 2 + apart**2 + days_apart**2 + FLOOR**2))
    stated = float(_is_close(terms[int(np.argmin(np.abs(LAGS)))], clear).mean())
    return PlaneShift(estimate[0], uncertainty, len(numbers), estimate[2], stated)


def _brightness(days: Days) -> Array:
    """Sum of the global irradiance of each day as a part of that of a clear sky (Haurwitz 1945). [-]"""
    clear = days.means(_CLEAR_SKY * days.sines * np.exp(-_DECAY / np.maximum(days.sines, 1e-3)), 0)
    total = np.nan_to_num(days.values["global_horizontal"])
    return np.asarray(total.sum(axis=1) / np.maximum(clear.sum(axis=1), 1e-9))


def _normal(azimuth: float, tilt: float) -> tuple[Array, Array, Array]:
    """Outward normal, and its changes with azimuth and tilt by 1 rad: east, north, up."""
    turn, lean = np.radians(azimuth), np.radians(tilt)
    east, north = np.sin(turn), np.cos(turn)
    normal = np.array([np.sin(lean) * east, np.sin(lean) * north, np.cos(lean)])
    aside = np.array([np.sin(lean) * north, -np.sin(lean) * east, 0.0])
    down = np.array([np.cos(lean) * east, np.cos(lean) * north, -np.sin(lean)])
    return normal, aside, down


def _terms(days: Days, plane: MeasuredPlane, late: int) -> _Terms:
    normal, aside, down = _normal(plane.azimuth, plane.tilt)
    total, measured = days.values["global_horizontal"], days.values[plane.name]
    sunlit = (days.directions @ normal > 0.0) & (days.sines > 0.0)
    sine = days.means(days.sines, late)
    used = (sine > _LOW) & np.isfinite(total) & np.isfinite(measured) & (total > _LEAST)
    height = np.where(used, sine, 1.0)
    # Direction to the sun while it shines on the plane, for each unit of its part on the horizontal.
    toward = np.stack(
        [days.means(days.directions[..., k] * sunlit, late) / height for k in range(3)], axis=-1
    )
    beam = toward @ normal
    low = 1.0 / height - 1.0
    sky, ground = 0.5 * (1.0 + np.cos(np.radians(plane.tilt))), 0.5 * (1.0 - np.cos(np.radians(plane.tilt)))
    diffuse = np.minimum(_DIFFUSE[0] + _DIFFUSE[1] * low, 0.6)
    expected = (1.0 - diffuse) * beam + diffuse * sky + plane.albedo * ground
    by_diffuse = sky - beam
    noon = np.argmax(sine, axis=1)[:, None]
    hours = (np.arange(days.rows) - noon) * days.width * NODE / 3600.0
    slopes = np.stack(
        [
            np.radians(_AZIMUTH) * (1.0 - diffuse) * (toward @ aside),
            np.radians(_TILT) * (1.0 - diffuse) * (toward @ down),
            _GAIN * expected,
            _DIFFUSE_KNOWN[0] * by_diffuse,
            _DIFFUSE_KNOWN[1] * low * by_diffuse,
            _DIFFUSE_OF_DAY * hours / 6.0 * by_diffuse,
            np.broadcast_to(_ALBEDO_KNOWN * ground, beam.shape),
        ],
        axis=-1,
    )
    size = np.where(used, total, 0.0)
    noise = _NOISE[0] + _NOISE[1] * np.maximum(size, np.where(used, measured, 0.0))
    residual = (np.where(used, measured, 0.0) - size * expected) / noise
    return _Terms(np.where(used, residual, 0.0), slopes * (size / noise)[..., None], used, noon)


def _fit(term: _Terms, clear: Flags, weight: float) -> tuple[Array, Array]:
    """Fitted numbers [standard uncertainties], and residuals of the clear days. [standard deviations]"""
    residual, slopes, used = term.residual[clear], term.slopes[clear], term.used[clear]
    numbers = np.zeros(slopes.shape[-1])
    deviation = residual
    for _ in range(_ITERATIONS):
        # Weights of Geman & McClure: hours that do not follow count little.
        weights = used * weight / (1.0 + (deviation / _FAR) ** 2) ** 2
        matrix = np.einsum("drj,dr,drk->jk", slopes, weights, slopes) + np.eye(len(numbers))
        numbers = np.linalg.solve(matrix, np.einsum("drj,dr,dr->j", slopes, weights, residual))
        deviation = residual - slopes @ numbers
    return numbers, deviation


def _estimate(terms: list[_Terms], clear: Flags, half: int | None) -> tuple[float, float, float] | None:
    """Shift and what the fit leaves uncertain [s], and the part of the hours that follow; None at an end."""
    chosen = [term.of(half) for term in terms]
    misfit = np.array([_misfit(term, clear) for term in chosen])
    best = int(np.argmin(misfit))
    if best in (0, len(misfit) - 1) or misfit[best] >= _MOST_MISFIT:
        return None
    late, spread = _lowest(misfit, best)
    return late, spread, float(_is_close(chosen[best], clear).mean())


def _misfit(term: _Terms, clear: Flags) -> float:
    """What a shift fits worse than the priors and instruments would, for a mean day of hours. [-]"""
    count = int(term.used[clear].sum())
    if count < 3 * int(clear.sum()):
        return float("inf")
    weight = _HOURS / count
    numbers, deviation = _fit(term, clear, weight)
    square = deviation * deviation / (1.0 + (deviation / _FAR) ** 2) * term.used[clear]
    return float(weight * square.sum() + numbers @ numbers)


def _is_close(term: _Terms, clear: Flags) -> Flags:
    _, deviation = _fit(term, clear, _HOURS / float(term.used[clear].sum()))
    return np.asarray(np.abs(deviation)[term.used[clear]] < _CLOSE_RESIDUAL)


def _follows(term: _Terms) -> Array:
    """Part of the hours of each day that follow the plane, with what is fitted to this day. [-]"""
    deviation = term.residual
    for _ in range(_ITERATIONS):
        weights = term.used / (1.0 + (deviation / _FAR) ** 2) ** 2
        weighted = term.slopes * weights[..., None]
        matrix = np.einsum("drj,drk->djk", weighted, term.slopes) + np.eye(term.slopes.shape[-1])
        right = np.einsum("drj,dr->dj", weighted, term.residual)
        numbers = np.linalg.solve(matrix, right[..., None])[..., 0]
        deviation = term.residual - np.einsum("drj,dj->dr", term.slopes, numbers)
    count = term.used.sum(axis=1)
    close_hours = ((np.abs(deviation) < _CLOSE_RESIDUAL) & term.used).sum(axis=1)
    return np.asarray(np.where(count >= _FEWEST, close_hours / np.maximum(count, 1), 0.0))


def _lowest(misfit: Array, best: int) -> tuple[float, float]:
    """Shift with the least misfit, and how far the misfit is one more than that. [s]"""
    before, lowest, after = np.minimum(misfit[best - 1 : best + 2], _MOST_MISFIT)
    bend = before - 2.0 * lowest + after
    part = float(np.clip(0.5 * (before - after) / bend, -0.5, 0.5)) if bend > 0.0 else 0.0
    step = float(LAGS[1] - LAGS[0]) * NODE
    late = float(LAGS[best]) * NODE + part * step
    likely = np.flatnonzero(misfit < lowest + 1.0)
    curved = step / np.sqrt(0.5 * bend) if bend > 0.0 else 9e9
    # Half of what is as good, or what the curvature says; the larger one.
    return late, float(max(curved, 0.5 * (likely[-1] - likely[0]) * step))
