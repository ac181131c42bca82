"""Signatures of faults of single sensors: offset, gain, drift, clock, place, exchanged columns; white noise.

A signature is made of the simulated series, not of the measured ones: without the fault it does not depend on
the errors of the measurements.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGrid
from mascarin.diagnosis.hypotheses import Candidate, What

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Delays of a clock that are tried beside small ones: time zones and daylight saving are whole hours. [h]
_HOURS: Final = (-12.0, -8.0, -6.0, -4.0, -3.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0)
#: Delay of a clock that may jump within the record: daylight saving. [h]
_JUMP: Final = 1.0
#: Standard deviations of the sizes of faults: of offsets and drifts [stated standard uncertainties], of gains
#: [-], of a small delay [s], of the part of a neighbouring temperature [-], and about a size that is known:
#: of whole hours and exchanged columns. [-]
_LARGE: Final = 5.0
_GAIN: Final = 0.1
_DELAY: Final = 900.0
_PART: Final = 0.3
_KNOWN_SIZE: Final = 0.1
#: Largest number of pairs of columns that may be exchanged: those whose simulated series differ least.
_MOST_PAIRS: Final = 24
#: Parts of the day of which the quietest quarter gives the white noise.
_PARTS: Final = 8
#: Mean of the two lowest of eight normal variables, below their mean. [standard deviations]
_QUIET_SCORE: Final = 1.14


@dataclass(frozen=True, eq=False)
class SensorSeries:
    """Simulated series of the sensors, and what is stated of the sensors.

    Attributes
    ----------
    names : tuple of str, length S
        Of the sensors.
    simulated : ndarray, shape (T, S)
        At all instants that are compared. [unit of each]
    mask : ndarray of bool, shape (T, S)
        Where something was measured.
    uncertainty : ndarray, shape (S,)
        Stated standard uncertainty of a measured value. [unit of each]
    interval : float
        Between the samples. [s]
    units : tuple of str
        Of each sensor.
    grid : DayGrid
        Days and slots of the samples.
    neighbours : dict of int to dict of str to ndarray, shape (T,)
        Simulated series of other places near a sensor, by name. [unit of the sensor]
    """

    names: tuple[str, ...]
    simulated: Floats
    mask: Flags
    uncertainty: Floats
    interval: float
    units: tuple[str, ...]
    grid: DayGrid
    neighbours: Mapping[int, Mapping[str, Floats]] = field(default_factory=dict)

    def means(self, sensors: Mapping[int, Floats]) -> Floats:
        """Average changes of some sensors over slots, shape (D, H * S). [unit of each]"""
        change = np.zeros(self.simulated.shape)
        for s, column in sensors.items():
            change[:, s] = column
        return self.grid.means(change, self.mask)[0]


def shifted(series: Floats, seconds: float, interval: float) -> Floats:
    """Delay a series by some time, with a cubic spline; the ends keep their value.

    Parameters
    ----------
    series : ndarray, shape (n, ...)
        [unit]
    seconds : float
        Delay; negative: earlier. [s]
    interval : float
        Between the samples. [s]

    Returns
    -------
    ndarray, shape (n, ...)

    Examples
    --------
    >>> shifted(np.array([0.0, 1.0, 2.0, 3.0]), 900.0, 1800.0).tolist()
    [0.0, 0.5, 1.5, 2.5]
    """
    from scipy.interpolate import CubicSpline

    if seconds == 0.0:
        return series
    sample = np.arange(len(series), dtype=np.float64)
    spline = CubicSpline(sample, series)
    return np.asarray(spline(np.clip(sample - seconds / interval, 0.0, len(series) - 1.0)))


def sensor_candidates(series: SensorSeries) -> list[Candidate]:
    """Return all faults that a sensor may have over the whole record.

    Parameters
    ----------
    series : SensorSeries
        What is simulated and stated.

    Returns
    -------
    list of Candidate

    Examples
    --------
    >>> hours = np.arange(72.0)
    >>> grid = DayGrid.of(hours, interval=1.0, sensors=1)
    >>> room = 20.0 + np.sin(hours / 4.0)[:, None]
    >>> used = np.ones((72, 1), bool)
    >>> stated = SensorSeries(("room",), room, used, np.array([0.1]), 3600.0, ("degC",), grid)
    >>> sorted({one.what for one in sensor_candidates(stated)})
    ['clock', 'drift', 'gain', 'offset', 'scale']
    """
    candidates: list[Candidate] = []
    for s in range(len(series.names)):
        if series.mask[:, s].sum() >= 3:
            candidates += _of_sensor(series, s)
    return [candidate for candidate in (*candidates, *_swaps(series)) if np.any(candidate.signature)]


def _of_sensor(series: SensorSeries, s: int) -> Iterator[Candidate]:
    """Faults of one sensor."""
    m, u, name = series.simulated[:, s], float(series.uncertainty[s]), (series.names[s],)
    unit = series.units[s].replace("degC", "K")
    middle = np.linspace(-0.5, 0.5, m.size)

    def fault(what: What, column: Floats, sd: float, scale: float, of: str) -> Candidate:
        later: What | None = "step" if what == "offset" else None
        return Candidate("data", what, name, series.means({s: column}), 0.0, sd, scale, of, later=later)

    yield fault("offset", np.ones(m.size), _LARGE * u, 1.0, unit)
    yield fault("drift", middle, _LARGE * u, 1.0, unit)
    if np.ptp(m) > 0.0:
        yield fault("gain", m, _GAIN, 100.0, "%")
        yield fault("scale", m - m.mean(), _GAIN, 100.0, "%")
        yield fault("clock", -np.gradient(m, series.interval) * _DELAY, 1.0, _DELAY / 60.0, "min")
        yield from _clocks(series, s, _HOURS)
    for neighbour, other in series.neighbours.get(s, {}).items():
        signature = series.means({s: other - m})
        detail, part = f"part of {neighbour}", (0.0, 1.0)
        yield Candidate("data", "place", name, signature, 0.0, _PART, 100.0, "%", detail, limits=part)


def _clocks(series: SensorSeries, s: int, hours: tuple[float, ...]) -> Iterator[Candidate]:
    """A clock that is wrong by a time of a list."""
    m, longest = series.simulated[:, s], 0.25 * len(series.simulated) * series.interval
    for delay in hours:
        if abs(delay) * 3600.0 <= longest:
            signature = series.means({s: shifted(m, 3600.0 * delay, series.interval) - m})
            name, later = (series.names[s],), "clock_step" if abs(delay) == _JUMP else None
            yield Candidate(
                "data",
                "clock",
                name,
                signature,
                1.0,
                _KNOWN_SIZE,
                60.0 * delay,
                "min",
                later=later,  # type: ignore[arg-type]
            )


def _swaps(series: SensorSeries) -> Iterator[Candidate]:
    """Pairs of sensors of one unit whose columns may be exchanged."""
    m, u = series.simulated, series.uncertainty
    pairs = []
    for i in range(len(series.names)):
        for j in range(i + 1, len(series.names)):
            apart = float(np.sqrt(np.mean((m[:, i] - m[:, j]) ** 2)))
            if series.units[i] == series.units[j] and apart > max(u[i], u[j]):
                pairs.append((apart, i, j))
    for _, i, j in sorted(pairs)[:_MOST_PAIRS]:
        signature = series.means({i: m[:, j] - m[:, i], j: m[:, i] - m[:, j]})
        names = (series.names[i], series.names[j])
        yield Candidate("data", "swapped", names, signature, 1.0, _KNOWN_SIZE, later="swap_step")


def stated_errors(series: SensorSeries) -> Floats:
    """Errors that are within what is stated of a sensor, beside its offset, for one standard deviation.

    An error of its stated uncertainty that grows with the distance from the mean, a drift by it over the
    record, and a clock that is wrong by a quarter of a sample or two and a half minutes: none is a fault.

    Parameters
    ----------
    series : SensorSeries
        What is simulated and stated.

    Returns
    -------
    ndarray, shape (D, H * S, k)
        [unit of the sensors]
    """
    columns = []
    for s in range(len(series.names)):
        m, u = series.simulated[:, s], series.uncertainty[s]
        middle = np.linspace(-0.5, 0.5, m.size)
        columns.append(series.means({s: u * middle}))
        if np.ptp(m) > 0.0:
            columns.append(series.means({s: u * (m - m.mean()) / m.std()}))
            delay = max(150.0, 0.25 * series.interval)
            columns.append(series.means({s: -np.gradient(m, series.interval) * delay}))
    shape = (series.grid.days, series.grid.slots * len(series.names), 0)
    return np.stack(columns, axis=2) if columns else np.zeros(shape)


def white_noise(errors: Floats, interval: float) -> tuple[float, float]:
    """Estimate the white part of errors: what is independent from one sample to the next.

    From second differences, in which errors that last are small; by parts of the day, of which the
    quietest quarter counts: the weather is not noisy at all hours, a sensor is.

    Parameters
    ----------
    errors : ndarray, shape (n,)
        Of a fitted model, NaN where nothing was measured. [unit]
    interval : float
        Between the samples. [s]

    Returns
    -------
    tuple of float
        Standard deviation of the white part, and the standard error of it; NaN for fewer than 24 samples.
        [unit]

    Examples
    --------
    >>> noise = 0.3 * np.random.default_rng(1).normal(size=4000)
    >>> sd, error = white_noise(noise + np.sin(np.arange(4000) / 15.0), 900.0)
    >>> abs(sd - 0.3) < 0.03
    True
    """
    second = errors[:-2] - 2.0 * errors[1:-1] + errors[2:]
    hour = ((np.arange(second.size) * interval / 3600.0) % 24.0).astype(np.int64) * _PARTS // 24
    finite = np.isfinite(second)
    if finite.sum() < 24:
        return math.nan, math.nan
    count = np.bincount(hour[finite], minlength=_PARTS)
    power = np.bincount(hour[finite], weights=second[finite] ** 2 / 6.0, minlength=_PARTS)
    mean = power[count > 0] / count[count > 0]
    quiet = np.sort(mean)[: max(1, mean.size // 4)]
    # Relative standard deviation of a mean square of overlapping second differences of white noise, whose
    # autocorrelations are -2/3 and 1/6; and the expected place of the lowest quarter among such means.
    spread = math.sqrt(2.0 * (1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0)) / float(np.mean(count[count > 0])))
    lowest = _QUIET_SCORE if mean.size == _PARTS else 0.0
    sd = math.sqrt(float(np.mean(quiet)) / max(1.0 - lowest * spread, 0.5))
    return sd, 0.5 * sd * spread / math.sqrt(quiet.size)
