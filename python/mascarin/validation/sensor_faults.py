"""Faults of single sensors, found by their fit: clock, offset, gain, drift, place, exchanged columns, noise.

Each fault is estimated together with the parameters of the model, which may take any values that their priors
allow: a fault is one only where no values of parameters have the same effect. A clock that is late delays one
series at all frequencies alike, whereas a heat capacity also damps it, and acts on its neighbours.

An error within the stated uncertainty of a sensor is no fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.validation.whitened_regression import Extra, Solution, WhitenedRegression

Floats = NDArray[np.float64]
Objective = Callable[[dict[int, Floats]], float]

#: Shifts of a clock that are tried first: time zones and daylight saving are whole hours. [h]
_HOURS: Final = (-24, -12, -10, -8, -7, -6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 24)
#: Half-width of the interval of 95 % of a normal distribution, in standard deviations.
NORMAL_95: Final = 1.96
#: Halvings of the step of the search for a shift.
_HALVINGS: Final = 5
#: A shift of this size that makes the objective worse by so much on both sides is not looked for. [s], [-]
_NEAR_DELAY: Final = 600.0
_NEAR_DEVIANCE: Final = 4.0
#: Parts of the day of which the quietest quarter gives the white noise.
_PARTS: Final = 8
#: Mean of the two lowest of eight normal variables, below their mean. [standard deviations]
_QUIET_SCORE: Final = 1.14
#: Smaller errors of a gain cannot be distinguished from the form of a model. [-]
_MIN_GAIN_ERROR: Final = 0.03
#: Largest number of pairs of columns that are tried, the most similar ones.
_MAX_PAIRS: Final = 8


@dataclass(frozen=True, eq=False)
class Fault:
    """A fault of one sensor, or of two whose columns are exchanged.

    Attributes
    ----------
    what : str
        ``clock``, ``offset``, ``gain``, ``scale``, ``drift``, ``place`` or ``swapped``.
    sensors : tuple of int
        Which.
    value, error : float
        Estimate and standard error: delay [s], offset or drift over the record [unit of the sensor], relative
        error of the gain [-], part of the neighbour's temperature in the reading [-].
    deviance : float
        By how much it lowers the deviance. [-]
    effect : float
        Root mean square of its effect on the series. [unit of the sensor]
    neighbour : str
        Name of the other place, for ``place``.
    extra : tuple of Extra
        Its column, if it has one.
    residual : dict of int to ndarray
        Residuals of the sensors with the fault removed, if it is not a column.
    solution : Solution or None
        The fit with it.
    rows : tuple of int or None
        First row with it and the row after the last, if it is not in the whole record.
    """

    what: str
    sensors: tuple[int, ...]
    value: float
    error: float
    deviance: float
    effect: float
    neighbour: str = ""
    extra: tuple[Extra, ...] = ()
    residual: Mapping[int, Floats] | None = None
    solution: Solution | None = None
    rows: tuple[int, int] | None = None


@dataclass(frozen=True, eq=False)
class Series:
    """What is compared.

    Attributes
    ----------
    measured, simulated : ndarray, shape (n, S)
        NaN where nothing was measured. [unit of each]
    uncertainty : ndarray, shape (S,)
        Stated standard uncertainty of a measured value. [unit of each]
    interval : float
        Between the samples. [s]
    shortest : float
        Shorter delays are none of a clock. [s]
    units : tuple of str
        Of each sensor.
    neighbours : dict of int to dict of str to ndarray, shape (n,)
        Simulated series of other places near a sensor, by name. [unit of the sensor]
    """

    measured: Floats
    simulated: Floats
    uncertainty: Floats
    interval: float
    shortest: float
    units: tuple[str, ...]
    neighbours: Mapping[int, Mapping[str, Floats]]


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


def sensor_faults(
    regression: WhitenedRegression, active: Sequence[int], null: Solution, series: Series
) -> list[Fault]:
    """Fit every fault of every sensor by itself.

    Parameters
    ----------
    regression : WhitenedRegression
        Residuals of the model and the effects of its parameters; its last S columns are the offsets of the
        sensors within their stated uncertainty.
    active : sequence of int
        Columns that are fitted with every fault.
    null : Solution
        Without any fault.
    series : Series
        Measured and simulated.

    Returns
    -------
    list of Fault
        Those whose effect is larger than the stated uncertainty, the largest fall of the deviance first.
    """
    faults: list[Fault] = []
    objective = regression.screen(active, null)
    for s in range(regression.sensors):
        if regression.count[s] < 3:
            continue
        faults += [*_columns(regression, active, null, series, s)]
        clock = _clock(regression, active, null, series, s, objective)
        faults += [clock] if clock is not None else []
    faults += _swaps(regression, active, null, series)
    return sorted(faults, key=lambda fault: -fault.deviance)


def _columns(
    regression: WhitenedRegression, active: Sequence[int], null: Solution, series: Series, s: int
) -> list[Fault]:
    """Faults of one sensor that are a column."""
    simulated, u = series.simulated[:, s], series.uncertainty[s]
    n = simulated.size
    offset = len(regression.columns) - regression.sensors + s
    centred = simulated - simulated.mean()
    tried: list[tuple[str, str, Floats, tuple[float, float]]] = [
        ("offset", "", np.ones(n), (-np.inf, np.inf)),
        ("gain", "", simulated, (-np.inf, np.inf)),
        ("scale", "", centred, (-np.inf, np.inf)),
        ("drift", "", (np.arange(n) - 0.5 * n) / n, (-np.inf, np.inf)),
    ]
    for name, other in series.neighbours.get(s, {}).items():
        tried.append(("place", name, other - simulated, (0.0, 1.0)))
    faults = []
    for what, name, column, limits in tried:
        if not np.any(column) or (what == "gain" and np.ptp(simulated) == 0.0):
            continue
        extra = Extra(s, column, limits=limits)
        fit = regression.solve(active, [extra], start=null)
        value = float(fit.values[-1])
        effect = abs(value) * float(np.sqrt(np.mean(column**2)))
        limit = u
        if what == "offset":
            # What the fit leaves to the offset within its stated uncertainty belongs to it as well.
            value += float(fit.values[list(active).index(offset)]) if offset in active else 0.0
            effect, limit = abs(value), NORMAL_95 * u
        if what in ("gain", "scale") and abs(value) < _MIN_GAIN_ERROR:
            continue
        if effect > limit:
            error = fit.standard_error(fit.values.size - 1)
            faults.append(
                Fault(
                    what, (s,), value, error, null.deviance - fit.deviance, effect, name, (extra,),
                    solution=fit,
                )
            )  # fmt: skip
    return faults


def _clock(
    regression: WhitenedRegression,
    active: Sequence[int],
    null: Solution,
    series: Series,
    s: int,
    objective: Objective,
) -> Fault | None:
    """The delay of one series with the largest likelihood."""
    measured, simulated, interval = series.measured[:, s], series.simulated[:, s], series.interval
    slope = np.gradient(simulated) / interval
    scores: dict[float, float] = {}

    def score(delay: float) -> float:
        if delay not in scores:
            scores[delay] = objective({s: measured - shifted(simulated, delay, interval)})
        return scores[delay]

    fits: dict[float, Solution] = {0.0: null}

    def fit_of(delay: float) -> Solution:
        if delay not in fits:
            moved = measured - shifted(simulated, delay, interval)
            fits[delay] = regression.with_residual({s: moved}).solve(active, start=null)
        return fits[delay]

    longest = 0.25 * measured.size * interval
    for hours in (0, *_HOURS):
        if abs(hours) * 3600.0 <= longest:
            score(3600.0 * hours)
    best = min(scores, key=lambda delay: scores[delay])
    if best == 0.0 and min(score(-_NEAR_DELAY), score(_NEAR_DELAY)) > score(0.0) + _NEAR_DEVIANCE:
        return None
    best = _refined(best, lambda delay: fit_of(delay).deviance)
    moved = measured - shifted(simulated, best, interval)
    effect = float(np.sqrt(np.mean((shifted(simulated, best, interval) - simulated) ** 2)))
    if abs(best) < series.shortest or effect <= series.uncertainty[s]:
        return None
    # A small further delay changes the series by its slope: standard error with the parameters free.
    changed = regression.with_residual({s: moved})
    fit = fit_of(best)
    further = Extra(s, -shifted(slope, best, interval))
    local = changed.solve(active, [further], start=fit)
    error = local.standard_error(local.values.size - 1)
    return Fault(
        "clock", (s,), best, error, null.deviance - fit.deviance, effect,
        residual={s: moved}, solution=fit,
    )  # fmt: skip


def _refined(start: float, objective: Callable[[float], float]) -> float:
    """Minimum near a start, by parabolas through three points whose distance is halved. [s]"""
    values = {start: objective(start)}
    best, step = start, 1800.0
    for _ in range(_HALVINGS):
        for delay in (best - step, best + step):
            values.setdefault(delay, objective(delay))
        low, middle, high = values[best - step], values[best], values[best + step]
        bend = low + high - 2.0 * middle
        if bend > 0.0:
            vertex = best + float(np.clip(0.5 * step * (low - high) / bend, -step, step))
            values.setdefault(vertex, objective(vertex))
        best = min(values, key=lambda delay: values[delay])
        step *= 0.5
    return best


def pairs_alike(regression: WhitenedRegression, series: Series) -> list[tuple[int, int]]:
    """Pairs of sensors of one unit whose columns may be exchanged, those that fit best exchanged first.

    Parameters
    ----------
    regression : WhitenedRegression
        Gives the number of values.
    series : Series
        Measured and simulated.

    Returns
    -------
    list of tuple of int
    """
    y, m = series.measured, series.simulated
    pairs = []
    for i in range(regression.sensors):
        for j in range(i + 1, regression.sensors):
            if series.units[i] != series.units[j] or min(regression.count[i], regression.count[j]) < 3:
                continue
            both = np.isfinite(y[:, i]) & np.isfinite(y[:, j])
            if not both.any():
                continue
            straight = float(np.mean((y - m)[both][:, [i, j]] ** 2))
            crossed = float(np.mean((y[:, [j, i]] - m[:, [i, j]])[both] ** 2))
            pairs.append((crossed / max(straight, 1e-300), i, j))
    return [(i, j) for _, i, j in sorted(pairs)[:_MAX_PAIRS]]


def _swaps(
    regression: WhitenedRegression, active: Sequence[int], null: Solution, series: Series
) -> list[Fault]:
    """Pairs of sensors of one unit whose columns are exchanged."""
    y, m = series.measured, series.simulated
    faults = []
    for i, j in pairs_alike(regression, series):
        residual = {i: y[:, j] - m[:, i], j: y[:, i] - m[:, j]}
        same = np.isfinite(y[:, i]) == np.isfinite(y[:, j])
        if not same.all():
            residual = {k: np.where(same, r, np.nan) for k, r in residual.items()}
        fit = regression.with_residual(residual).solve(active, start=null)
        effect = float(np.sqrt(np.nanmean((y[:, i] - y[:, j]) ** 2)))
        if effect > max(series.uncertainty[i], series.uncertainty[j]) and fit.deviance < null.deviance:
            faults.append(
                Fault(
                    "swapped", (i, j), math.nan, math.nan, null.deviance - fit.deviance, effect,
                    residual=residual, solution=fit,
                )
            )  # fmt: skip
    return faults


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
