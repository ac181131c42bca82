"""What is left when the simulation is taken from the measurement, and what it says about the model.

A good model leaves noise: no memory, no favourite hour, no likeness to the sun or the wind. `examine` puts
numbers to this for one sensor, and `diagnose` says it in words. Residuals are *simulated minus measured*.

References
----------
Bartlett M.S. (1955), An Introduction to Stochastic Processes (cumulative periodogram; correlation of
autocorrelated series).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.calibration.series import autocorrelation, correlate, fit_autoregression
from mascarin.errors import InputError

Floats = NDArray[np.float64]

_FEWEST: Final = 24  # samples below which nothing is said
_LONGEST_LAG: Final = 48.0  # h
_DRIVER_LAG: Final = 6.0  # h, how far an answer may come after its cause
_KOLMOGOROV: Final = 1.358  # 95 % of the largest distance of a sum of noise, times the root of its length
_SEARCHED: Final = 1.5  # widens a 95 % limit for a correlation looked for at several lags

# Shares and differences from which a sentence is worth saying.
_TOLD_CORRELATION: Final = 0.3
_TOLD_HOURS: Final = 0.25
_TOLD_RATIO: Final = 0.1
_TOLD_LAG: Final = 20.0  # min


@dataclass(frozen=True, slots=True)
class Link:
    """Likeness of a residual to something that drives the building.

    Attributes
    ----------
    driver : str
        Its name.
    correlation : float
        At the lag where it is largest in size. [-]
    lag : float
        How long the residual comes after the driver. [h]
    limit : float
        What 95 % of unrelated series with the same memory stay below. [-]
    slope : float
        Change of the residual per unit of the driver. [unit per unit of the driver]
    lags, correlations : tuple of float
        The correlation at each lag looked at; NaN where there is none. [h], [-]
    """

    driver: str
    correlation: float
    lag: float
    limit: float
    slope: float
    lags: tuple[float, ...] = ()
    correlations: tuple[float, ...] = ()

    @property
    def real(self) -> bool:
        """Whether chance does not give such a correlation."""
        return abs(self.correlation) > self.limit


@dataclass(frozen=True, slots=True)
class DailyCycle:
    """The part of a series that repeats every 24 h as a sine.

    Attributes
    ----------
    amplitude : float
        Half the swing. [unit]
    peak : float
        When it is highest. [h of the day]
    """

    amplitude: float
    peak: float


@dataclass(frozen=True, eq=False)
class Examination:
    """The residual of one sensor over one period.

    Attributes
    ----------
    sensor, unit : str
        Name of the sensor and its unit.
    n : int
        Number of residuals. [-]
    bias, sd : float
        Their mean and standard deviation about it. [unit]
    effective : float
        Number of independent residuals they are worth. [-]
    lags : ndarray, shape (K,)
        Lags of `acf`. [h]
    acf : ndarray, shape (K,)
        Autocorrelation. [-]
    acf_limit : float
        What white noise stays below at 95 % of the lags. [-]
    frequency : ndarray, shape (F,)
        Frequencies of the cumulative periodogram. [1/day]
    cumulative : ndarray, shape (F,)
        Share of the variance up to each frequency. [-]
    cumulative_limit : float
        Largest distance from the straight line that 95 % of white noises keep. [-]
    links : tuple of Link
        Likeness to the drivers, the largest first.
    hour_mean, hour_sd : ndarray, shape (24,)
        Mean and standard deviation by hour of the day, NaN where there is none. [unit]
    hour_share : float
        Share of the variance that the hour of the day explains. [-]
    hour_limit : float
        What chance makes of it. [-]
    measured, simulated : DailyCycle, optional
        The daily cycle of both series; None when the period is shorter than a day.
    """

    sensor: str
    unit: str
    n: int
    bias: float
    sd: float
    effective: float
    lags: Floats
    acf: Floats
    acf_limit: float
    frequency: Floats
    cumulative: Floats
    cumulative_limit: float
    links: tuple[Link, ...]
    hour_mean: Floats
    hour_sd: Floats
    hour_share: float
    hour_limit: float
    measured: DailyCycle | None
    simulated: DailyCycle | None

    @property
    def white(self) -> bool:
        """Whether the cumulative periodogram stays within its limit: nothing but noise is left."""
        straight = np.arange(1, self.cumulative.size + 1) / self.cumulative.size
        return bool(np.max(np.abs(self.cumulative - straight), initial=0.0) <= self.cumulative_limit)

    @property
    def delay(self) -> float:
        """How much later the simulated daily cycle peaks than the measured one. [min]"""
        if self.measured is None or self.simulated is None:
            return math.nan
        hours = (self.simulated.peak - self.measured.peak + 12.0) % 24.0 - 12.0
        return 60.0 * hours

    def to_dict(self) -> dict[str, Any]:
        """The examination for a JSON file; what could not be computed is None."""
        limits = [link.limit for link in self.links if math.isfinite(link.limit)]
        cycle = None
        if self.measured is not None and self.simulated is not None:
            cycle = {
                "measured_amplitude": self.measured.amplitude,
                "measured_peak": self.measured.peak,
                "simulated_amplitude": self.simulated.amplitude,
                "simulated_peak": self.simulated.peak,
                "delay_minutes": self.delay,
            }
        return {
            "unit": self.unit,
            "n": self.n,
            "effective_n": self.effective,
            "white": self.white,
            "acf_lags": self.lags.tolist(),
            "acf": self.acf.tolist(),
            "acf_band": self.acf_limit,
            "periodogram_frequency": self.frequency.tolist(),
            "periodogram_cumulative": self.cumulative.tolist(),
            "periodogram_band": self.cumulative_limit,
            "hour_mean": [_number(v) for v in self.hour_mean],
            "hour_sd": [_number(v) for v in self.hour_sd],
            "hour_share": self.hour_share,
            "correlation": {link.driver: _number(link.correlation) for link in self.links},
            "correlation_lag": {link.driver: link.lag for link in self.links},
            "correlation_band": max(limits, default=None),
            "cross_lags": list(self.links[0].lags) if self.links else [],
            "cross_correlation": {
                link.driver: [_number(value) for value in link.correlations] for link in self.links
            },
            "daily_cycle": cycle,
        }


def examine(
    measured: ArrayLike,
    simulated: ArrayLike,
    *,
    step: float,
    hour: ArrayLike,
    drivers: Mapping[str, ArrayLike] | None = None,
    use: ArrayLike | None = None,
    sensor: str = "",
    unit: str = "degC",
) -> Examination:
    """Examine what is left of one sensor.

    Parameters
    ----------
    measured, simulated : array_like, shape (n,)
        Both series at the same regular instants; NaN in the measured one where nothing was measured. [unit]
    step : float
        Time between samples. [s]
    hour : array_like, shape (n,)
        Local hour of the day of each sample, fractions included. [h]
    drivers : mapping of str to array_like, shape (n,), optional
        Named series that act on the building, such as ``sun``, ``wind`` and ``outdoor air``.
    use : array_like of bool, shape (n,), optional
        Samples to look at; all when absent.
    sensor, unit : str
        Name of the sensor and its unit.

    Returns
    -------
    Examination

    Raises
    ------
    InputError
        When lengths differ or fewer than 24 samples are left.
    """
    m, s, hours = (np.asarray(v, dtype=np.float64) for v in (measured, simulated, hour))
    keep = np.ones(m.shape, dtype=np.bool_) if use is None else np.array(use, dtype=np.bool_)
    _require_length(sensor, m, {"simulated": s, "hour": hours, "use": keep, **dict(drivers or {})})
    keep &= np.isfinite(m) & np.isfinite(s)
    n = int(keep.sum())
    if n < _FEWEST:
        msg = (
            f"sensor '{sensor}': {n} samples to examine, expected at least {_FEWEST}: compare a longer period"
        )
        raise InputError(msg)
    if not step > 0.0:
        msg = f"sensor '{sensor}': step {step:g} s must be positive"
        raise InputError(msg)
    r = np.where(keep, s - m, np.nan)
    per_day = 86400.0 / step
    lags = np.arange(min(int(_LONGEST_LAG * 3600.0 / step), r.size - 1) + 1)
    frequency, cumulative = _cumulative_periodogram(r, per_day)
    effective = fit_autoregression(r).effective_samples
    mean, spread, share, limit = _by_hour(r, hours, effective, r.size / per_day)
    links = [_link(name, r, np.asarray(d, dtype=np.float64), step) for name, d in (drivers or {}).items()]
    whole_day = r.size >= per_day
    return Examination(
        sensor=sensor,
        unit=unit,
        n=n,
        bias=float(np.nanmean(r)),
        sd=float(np.nanstd(r)),
        effective=effective,
        lags=np.asarray(lags * step / 3600.0, dtype=np.float64),
        acf=autocorrelation(r, int(lags[-1])),
        acf_limit=1.959964 / math.sqrt(n),
        frequency=frequency,
        cumulative=cumulative,
        cumulative_limit=_KOLMOGOROV / math.sqrt(max(cumulative.size, 1)),
        links=tuple(sorted(links, key=lambda link: -_size(link.correlation))),
        hour_mean=mean,
        hour_sd=spread,
        hour_share=share,
        hour_limit=limit,
        measured=_daily_cycle(np.where(keep, m, np.nan), hours) if whole_day else None,
        simulated=_daily_cycle(np.where(keep, s, np.nan), hours) if whole_day else None,
    )


def diagnose(examinations: Iterable[Examination]) -> list[str]:
    """What is wrong, in words.

    Parameters
    ----------
    examinations : iterable of Examination
        One per sensor.

    Returns
    -------
    list of str
        Sentences, each naming its sensor; one sentence says so when nothing is wrong.
    """
    sentences = []
    for e in examinations:
        found = [*_bias_words(e), *_cycle_words(e), *_link_words(e), *_hour_words(e)]
        if not found and not e.white:
            found = [_memory_words(e)]
        if not found:
            found = ["what is left is noise: nothing points to an error of the model"]
        sentences += [f"{e.sensor}: {text}." for text in found]
    return sentences


# --- numbers ------------------------------------------------------------------------------------------


def _require_length(sensor: str, measured: Floats, others: Mapping[str, ArrayLike]) -> None:
    for name, values in others.items():
        if measured.ndim != 1 or np.shape(values) != measured.shape:
            msg = (
                f"sensor '{sensor}': measured has shape {measured.shape} and {name} {np.shape(values)}; "
                f"bring them to the same instants first"
            )
            raise InputError(msg)


def _cumulative_periodogram(r: Floats, per_day: float) -> tuple[Floats, Floats]:
    """Frequencies [1/day] and the share of the variance up to each; gaps count as the mean."""
    centred = np.where(np.isfinite(r), r - np.nanmean(r), 0.0)
    power = np.abs(np.fft.rfft(centred))[1 : (r.size - 1) // 2 + 1] ** 2
    frequency = np.arange(1, power.size + 1) / r.size * per_day
    total = float(power.sum())
    if total <= 0.0:
        return frequency, np.arange(1, power.size + 1) / max(power.size, 1)
    return frequency, np.cumsum(power) / total


def _by_hour(r: Floats, hours: Floats, effective: float, days: float) -> tuple[Floats, Floats, float, float]:
    """Mean and spread by hour of the day, the share of the variance they explain and what chance gives."""
    keep = np.isfinite(r)
    bins = np.mod(hours[keep], 24.0).astype(np.int64)
    values = r[keep]
    count = np.bincount(bins, minlength=24)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.bincount(bins, weights=values, minlength=24) / count
        spread = np.sqrt(
            np.maximum(np.bincount(bins, weights=values**2, minlength=24) / count - mean**2, 0.0)
        )
    whole = float(np.var(values))
    if whole <= 0.0:
        return mean, spread, 0.0, 1.0
    there = count > 0
    between = float(np.sum(count[there] * (mean[there] - values.mean()) ** 2) / values.size)
    # Without a daily pattern the means of k independent pieces of a day, over d days, still differ: they
    # explain about 1 / d of the variance. Twice that, and the scatter of a sum of k squares, is the limit.
    pieces = max(1.0, min(23.0, effective / max(days, 1.0)))
    chance = (1.0 + 2.0 * math.sqrt(2.0 / pieces)) / max(days, 1.0)
    return mean, spread, between / whole, min(chance, 1.0)


def _link(name: str, r: Floats, driver: Floats, step: float) -> Link:
    """Correlation with a driver at the lag, up to some hours, where it is strongest."""
    most = min(int(_DRIVER_LAG * 3600.0 / step), r.size // 4)
    every = max(1, round(900.0 / step))
    best, best_lag = math.nan, 0
    looked = range(0, most + 1, every)
    found = dict.fromkeys(looked, math.nan)
    for lag in looked:
        a, b = r[lag:], driver[: r.size - lag]
        both = np.isfinite(a) & np.isfinite(b)
        if both.sum() < _FEWEST or np.ptp(a[both]) == 0.0 or np.ptp(b[both]) == 0.0:
            continue
        value = float(np.corrcoef(a[both], b[both])[0, 1])
        found[lag] = value
        if math.isnan(best) or abs(value) > abs(best):
            best, best_lag = value, lag
    lags, values = tuple(lag * step / 3600.0 for lag in looked), tuple(found.values())
    if math.isnan(best):
        return Link(name, math.nan, 0.0, math.inf, math.nan, lags, values)
    a, b = r[best_lag:], driver[: r.size - best_lag]
    both = np.isfinite(a) & np.isfinite(b)
    slope = best * float(np.std(a[both]) / np.std(b[both]))
    limit = min(_SEARCHED * correlate(a, b)[1], 1.0)
    return Link(name, best, best_lag * step / 3600.0, limit, slope, lags, values)


def _daily_cycle(series: Floats, hours: Floats) -> DailyCycle:
    """Least squares of a mean, a trend and a sine of 24 h."""
    keep = np.isfinite(series)
    angle = hours * np.pi / 12.0
    trend = np.linspace(-1.0, 1.0, series.size)
    columns = np.column_stack([np.ones(series.size), trend, np.cos(angle), np.sin(angle)])
    c, s = np.linalg.lstsq(columns[keep], series[keep])[0][2:]
    return DailyCycle(float(math.hypot(c, s)), float(math.atan2(s, c) * 12.0 / math.pi % 24.0))


# --- words --------------------------------------------------------------------------------------------

_HINTS: Final = {
    "sun": (
        "too much of the sun's heat gets in or stays (absorptance, shading, films that carry it away)",
        "too little of the sun's heat gets in or stays (absorptance, shading, films that carry it away)",
    ),
    "wind": (
        "the outside film or the infiltration takes too little heat away when it blows",
        "the outside film or the infiltration takes too much heat away when it blows",
    ),
    "outdoor air": (
        "it follows the outdoor air too closely (insulation, infiltration, heat capacity)",
        "it follows the outdoor air too little (insulation, infiltration, heat capacity)",
    ),
}
"""What a positive and a negative correlation may mean, by the usual names of drivers."""


def _bias_words(e: Examination) -> list[str]:
    if abs(e.bias) <= 3.0 * e.sd / math.sqrt(max(e.effective, 1.0)) or abs(e.bias) < 0.5 * e.sd:
        return []
    side = "above" if e.bias > 0.0 else "below"
    return [f"the model is {abs(e.bias):.2g} {_of_difference(e)} {side} the measurement on average"]


def _cycle_words(e: Examination) -> list[str]:
    if e.measured is None or e.simulated is None:
        return []
    texts = []
    difference = e.simulated.amplitude - e.measured.amplitude
    noticeable = max(_TOLD_RATIO * e.measured.amplitude, 0.5 * e.sd)
    swings = min(e.measured.amplitude, e.simulated.amplitude) > e.sd
    if abs(difference) > noticeable:
        more = "more" if difference > 0.0 else "less"
        cause = (
            "too little storage, or too much coupling" if difference > 0.0 else "too much storage or damping"
        )
        texts.append(
            f"over the day the model swings {more} than measured, by {e.simulated.amplitude:.2g} against "
            f"{e.measured.amplitude:.2g} {_of_difference(e)}: {cause}"
        )
    if swings and abs(e.delay) > _TOLD_LAG:
        late = "late" if e.delay > 0.0 else "early"
        cause = "too much" if e.delay > 0.0 else "too little"
        texts.append(f"its daily peak comes {abs(e.delay):.0f} min {late}: {cause} heat capacity on the way")
    return texts


def _link_words(e: Examination) -> list[str]:
    texts = []
    for link in e.links:
        if not (link.real and abs(link.correlation) >= _TOLD_CORRELATION):
            continue
        after = f" {link.lag:.2g} h later" if link.lag > 0.0 else ""
        text = f"its error goes with the {link.driver}{after} (correlation {link.correlation:+.2f})"
        hint = _HINTS.get(link.driver)
        texts.append(text if hint is None else f"{text}: {hint[0 if link.correlation > 0.0 else 1]}")
    return texts


def _hour_words(e: Examination) -> list[str]:
    if e.hour_share < max(_TOLD_HOURS, e.hour_limit):
        return []
    highest, lowest = int(np.nanargmax(e.hour_mean)), int(np.nanargmin(e.hour_mean))
    return [
        f"the hour of the day explains {100.0 * e.hour_share:.0f} % of its scatter, from "
        f"{e.hour_mean[lowest]:+.2g} at {lowest} h to {e.hour_mean[highest]:+.2g} {_of_difference(e)} "
        f"at {highest} h"
    ]


def _memory_words(e: Examination) -> str:
    below = np.flatnonzero(e.acf < math.exp(-1.0))
    if below.size and e.acf[1] > e.acf_limit:
        lasts = f", errors last for about {e.lags[below[0]]:.2g} h"
    else:
        lasts = ""
    return (
        f"what is left is not noise{lasts}, but goes with none of the drivers: {e.n} samples are worth "
        f"{e.effective:.0f} independent ones"
    )


def _of_difference(e: Examination) -> str:
    """Unit of a difference: kelvins for temperatures."""
    return e.unit.replace("degC", "K")


def _size(value: float) -> float:
    return abs(value) if math.isfinite(value) else -1.0


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
