"""Analysis of residuals: what the difference of simulation and measurement shows about the model.

The residuals of an adequate model are white noise: not autocorrelated, without a daily pattern, not
correlated with the sun or the wind. `analyze_residuals` computes this for one sensor; causes are told by
`mascarin.diagnosis`. Residuals are *simulated minus measured*.

References
----------
Bartlett M.S. (1955), An Introduction to Stochastic Processes (cumulative periodogram; correlation of
autocorrelated series).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin._io import display
from mascarin.errors import InputError
from mascarin.validation.series import autocorrelation, correlate, fit_autoregression

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]

_MIN_SAMPLES: Final = 24  # samples that an analysis needs
_MAX_LAG: Final = 48.0  # h, of the autocorrelation
_DRIVER_LAG: Final = 6.0  # h, longest delay between a driver and the residual
_KOLMOGOROV: Final = 1.358  # Kolmogorov-Smirnov statistic at 95 %
_SEVERAL_LAGS: Final = 1.5  # widens the 95 % limit, because the strongest of several lags is taken


@dataclass(frozen=True, slots=True)
class DriverCorrelation:
    """Correlation of a residual with a driver, such as the sun or the wind.

    Attributes
    ----------
    driver : str
        Name of the driver.
    correlation : float
        At the lag where it is strongest. [-]
    lag : float
        Delay of the residual behind the driver there. [h]
    limit : float
        Size that 95 % of unrelated series with the same autocorrelation stay below. [-]
    slope : float
        Change of the residual per unit of the driver. [unit per unit of the driver]
    lags, correlations : tuple of float
        The correlation at each lag; NaN where there is none. [h], [-]

    Examples
    --------
    >>> DriverCorrelation("sun", correlation=0.6, lag=1.0, limit=0.2, slope=0.002).significant
    True
    """

    driver: str
    correlation: float
    lag: float
    limit: float
    slope: float
    lags: tuple[float, ...] = ()
    correlations: tuple[float, ...] = ()

    @property
    def significant(self) -> bool:
        """Whether the correlation is significant (95 %)."""
        return abs(self.correlation) > self.limit


@dataclass(frozen=True, slots=True)
class DailyCycle:
    """The sine with a period of 24 h in a series.

    Attributes
    ----------
    amplitude : float
        Half the difference of highest and lowest value. [unit]
    peak : float
        When it is highest. [h of the day]
    """

    amplitude: float
    peak: float


@dataclass(frozen=True, eq=False, repr=False)
class ResidualAnalysis:
    """Analysis of the residuals of one sensor over one period.

    Attributes
    ----------
    sensor, unit : str
        Name of the sensor and its unit.
    n : int
        Number of residuals. [-]
    bias, sd : float
        Their mean and their standard deviation about it. [unit]
    effective_samples : float
        Number of independent values that say as much about the mean. [-]
    lags : ndarray, shape (K,)
        Lags of `acf`. [h]
    acf : ndarray, shape (K,)
        Autocorrelation. [-]
    acf_limit : float
        Size that white noise stays below at 95 % of the lags. [-]
    frequency : ndarray, shape (F,)
        Frequencies of the cumulative periodogram. [1/day]
    cumulative : ndarray, shape (F,)
        Part of the variance up to each frequency. [-]
    cumulative_limit : float
        Largest distance from the straight line for 95 % of white noise series. [-]
    correlations : tuple of DriverCorrelation
        Correlations with the drivers, the strongest first.
    hour_mean, hour_sd : ndarray, shape (24,)
        Mean and standard deviation by hour of the day, NaN where there is none. [unit]
    hour_share : float
        Part of the variance that the hour of the day explains. [-]
    hour_limit : float
        Part that it explains by chance. [-]
    measured, simulated : DailyCycle, optional
        The daily cycle of both series; None when the period is shorter than a day.

    Examples
    --------
    >>> hour = np.arange(192) / 4.0
    >>> noise = np.random.default_rng(3).normal(size=hour.size)
    >>> found = analyze_residuals(20.0 + 0.0 * hour, 20.0 + noise, step=900.0, hour=hour % 24.0)
    >>> found.white, found.n
    (True, 192)
    """

    sensor: str
    unit: str
    n: int
    bias: float
    sd: float
    effective_samples: float
    lags: Floats
    acf: Floats
    acf_limit: float
    frequency: Floats
    cumulative: Floats
    cumulative_limit: float
    correlations: tuple[DriverCorrelation, ...]
    hour_mean: Floats
    hour_sd: Floats
    hour_share: float
    hour_limit: float
    measured: DailyCycle | None
    simulated: DailyCycle | None

    @property
    def white(self) -> bool:
        """Whether the cumulative periodogram is that of white noise (95 %)."""
        straight = np.arange(1, self.cumulative.size + 1) / self.cumulative.size
        return bool(np.max(np.abs(self.cumulative - straight), initial=0.0) <= self.cumulative_limit)

    @property
    def delay(self) -> float:
        """Phase lag of the simulated daily cycle behind the measured one. [min]"""
        if self.measured is None or self.simulated is None:
            return math.nan
        hours = (self.simulated.peak - self.measured.peak + 12.0) % 24.0 - 12.0
        return 60.0 * hours

    def __repr__(self) -> str:
        return display.text(f"ResidualAnalysis of '{self.sensor}'", self._rows())

    def _repr_html_(self) -> str:
        return display.page(f"ResidualAnalysis of '{self.sensor}'", self._rows())

    def _rows(self) -> list[tuple[str, str]]:
        unit = self.unit.replace("degC", "K")
        rows = [
            ("values", f"{self.n}, worth {self.effective_samples:.0f} independent ones"),
            ("bias", f"{self.bias:+.3g} {unit}"),
            ("standard deviation", f"{self.sd:.3g} {unit}"),
            ("white noise", "yes" if self.white else "no"),
            ("explained by the hour", f"{100.0 * self.hour_share:.0f} %"),
        ]
        if math.isfinite(self.delay):
            rows.append(("phase lag", f"{self.delay:+.0f} min"))
        return rows + [
            (
                f"correlation with {link.driver}",
                f"{link.correlation:+.2f} at {link.lag:g} h{'' if link.significant else ', not significant'}",
            )
            for link in self.correlations
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the analysis for a JSON file; what could not be computed is None."""
        limits = [link.limit for link in self.correlations if math.isfinite(link.limit)]
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
            "effective_n": self.effective_samples,
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
            "correlation": {link.driver: _number(link.correlation) for link in self.correlations},
            "correlation_lag": {link.driver: link.lag for link in self.correlations},
            "correlation_band": max(limits, default=None),
            "cross_lags": list(self.correlations[0].lags) if self.correlations else [],
            "cross_correlation": {
                link.driver: [_number(value) for value in link.correlations] for link in self.correlations
            },
            "daily_cycle": cycle,
        }


def analyze_residuals(
    measured: ArrayLike | pd.Series[float],
    simulated: ArrayLike | pd.Series[float],
    *,
    step: float | None = None,
    hour: ArrayLike | None = None,
    drivers: Mapping[str, ArrayLike] | None = None,
    use: ArrayLike | None = None,
    sensor: str = "",
    unit: str = "degC",
) -> ResidualAnalysis:
    """Analyze the residuals of one sensor.

    Parameters
    ----------
    measured, simulated : pandas.Series or array_like, shape (n,)
        Both series at the same regular instants; NaN in the measured one where nothing was measured. [unit]
    step : float, optional
        Time between samples; from the index of `measured` when absent. [s]
    hour : array_like, shape (n,), optional
        Local hour of the day of each sample, fractions included; from the index of `measured` when absent,
        which is then in local time. [h]
    drivers : mapping of str to array_like, shape (n,), optional
        Named series that act on the building, such as ``sun``, ``wind`` and ``outdoor air``.
    use : array_like of bool, shape (n,), optional
        Samples to analyze; all when absent.
    sensor, unit : str
        Name of the sensor and its unit.

    Returns
    -------
    ResidualAnalysis

    Raises
    ------
    InputError
        Lengths differ, fewer than 24 samples are left, or step and hour are neither given nor in an index.

    Examples
    --------
    >>> import numpy as np
    >>> hour = np.arange(96) / 4.0
    >>> measured = 20.0 + 3.0 * np.cos((hour - 15.0) / 12.0 * np.pi)
    >>> simulated = 20.0 + 3.0 * np.cos((hour - 16.0) / 12.0 * np.pi)
    >>> found = analyze_residuals(measured, simulated, step=900.0, hour=hour, sensor="room")
    >>> round(found.delay)
    60
    """
    if step is None or hour is None:
        seconds, local = _clock(sensor, measured)
        step, hour = seconds if step is None else step, local if hour is None else hour
    m, s, hours = (np.asarray(v, dtype=np.float64) for v in (measured, simulated, hour))
    keep = np.ones(m.shape, dtype=np.bool_) if use is None else np.array(use, dtype=np.bool_)
    _require_length(sensor, m, {"simulated": s, "hour": hours, "use": keep, **dict(drivers or {})})
    keep &= np.isfinite(m) & np.isfinite(s)
    n = int(keep.sum())
    if n < _MIN_SAMPLES:
        msg = (
            f"sensor '{sensor}': {n} samples to analyze, expected at least {_MIN_SAMPLES}: compare a longer "
            "period"
        )
        raise InputError(msg)
    if not step > 0.0:
        msg = f"sensor '{sensor}': step {step:g} s must be positive"
        raise InputError(msg)
    r = np.where(keep, s - m, np.nan)
    per_day = 86400.0 / step
    lags = np.arange(min(int(_MAX_LAG * 3600.0 / step), r.size - 1) + 1)
    frequency, cumulative = _cumulative_periodogram(r, per_day)
    effective = fit_autoregression(r).effective_samples
    mean, spread, share, limit = _by_hour(r, hours, effective, r.size / per_day)
    correlations = [
        _correlation_with(name, r, np.asarray(d, dtype=np.float64), step)
        for name, d in (drivers or {}).items()
    ]
    whole_day = r.size >= per_day
    return ResidualAnalysis(
        sensor=sensor,
        unit=unit,
        n=n,
        bias=float(np.nanmean(r)),
        sd=float(np.nanstd(r)),
        effective_samples=effective,
        lags=np.asarray(lags * step / 3600.0, dtype=np.float64),
        acf=autocorrelation(r, int(lags[-1])),
        acf_limit=1.959964 / math.sqrt(n),
        frequency=frequency,
        cumulative=cumulative,
        cumulative_limit=_KOLMOGOROV / math.sqrt(max(cumulative.size, 1)),
        correlations=tuple(sorted(correlations, key=lambda link: -_size(link.correlation))),
        hour_mean=mean,
        hour_sd=spread,
        hour_share=share,
        hour_limit=limit,
        measured=_daily_cycle(np.where(keep, m, np.nan), hours) if whole_day else None,
        simulated=_daily_cycle(np.where(keep, s, np.nan), hours) if whole_day else None,
    )


def _clock(sensor: str, measured: object) -> tuple[float, Floats]:
    """Return the step [s] and the local hour of the day [h] of a series with times as its index."""
    import pandas as pd

    index = getattr(measured, "index", None)
    if not isinstance(index, pd.DatetimeIndex) or len(index) < 2:
        raise InputError(
            f"sensor '{sensor}': found no times, expected pandas series with times as their index, or step "
            "and hour; give step= and hour="
        )
    hours = index.hour + index.minute / 60.0 + index.second / 3600.0
    return (index[1] - index[0]).total_seconds(), np.asarray(hours, dtype=np.float64)


def _require_length(sensor: str, measured: Floats, companions: Mapping[str, ArrayLike]) -> None:
    for name, values in companions.items():
        if measured.ndim != 1 or np.shape(values) != measured.shape:
            msg = (
                f"sensor '{sensor}': measured has shape {measured.shape} and {name} {np.shape(values)}; "
                f"bring them to the same instants first"
            )
            raise InputError(msg)


def _cumulative_periodogram(r: Floats, per_day: float) -> tuple[Floats, Floats]:
    """Return frequencies [1/day] and the part of the variance up to each; gaps count as the mean."""
    centred = np.where(np.isfinite(r), r - np.nanmean(r), 0.0)
    power = np.abs(np.fft.rfft(centred))[1 : (r.size - 1) // 2 + 1] ** 2
    frequency = np.arange(1, power.size + 1) / r.size * per_day
    total = float(power.sum())
    if total <= 0.0:
        return frequency, np.arange(1, power.size + 1) / max(power.size, 1)
    return frequency, np.cumsum(power) / total


def _by_hour(r: Floats, hours: Floats, effective: float, days: float) -> tuple[Floats, Floats, float, float]:
    """Return mean and spread by hour of the day, explained variance and its chance level."""
    keep = np.isfinite(r)
    bins = np.mod(hours[keep], 24.0).astype(np.int64)
    values = r[keep]
    count = np.bincount(bins, minlength=24)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.bincount(bins, weights=values, minlength=24) / count
        spread = np.sqrt(
            np.maximum(np.bincount(bins, weights=values**2, minlength=24) / count - mean**2, 0.0)
        )
    total_variance = float(np.var(values))
    if total_variance <= 0.0:
        return mean, spread, 0.0, 1.0
    populated = count > 0
    between = float(np.sum(count[populated] * (mean[populated] - values.mean()) ** 2) / values.size)
    # Without a daily pattern the means of k independent pieces of a day, over d days, still differ: they
    # explain about 1 / d of the variance. Twice that, and the scatter of a sum of k squares, is the limit.
    pieces = max(1.0, min(23.0, effective / max(days, 1.0)))
    chance = (1.0 + 2.0 * math.sqrt(2.0 / pieces)) / max(days, 1.0)
    return mean, spread, between / total_variance, min(chance, 1.0)


def _correlation_with(name: str, r: Floats, driver: Floats, step: float) -> DriverCorrelation:
    """Correlate with a driver at the lag, up to some hours, where the correlation is strongest."""
    most = min(int(_DRIVER_LAG * 3600.0 / step), r.size // 4)
    stride = max(1, round(900.0 / step))
    best, best_lag = math.nan, 0
    tried = range(0, most + 1, stride)
    correlation_of_lag = dict.fromkeys(tried, math.nan)
    for lag in tried:
        a, b = r[lag:], driver[: r.size - lag]
        both = np.isfinite(a) & np.isfinite(b)
        if both.sum() < _MIN_SAMPLES or np.ptp(a[both]) == 0.0 or np.ptp(b[both]) == 0.0:
            continue
        value = float(np.corrcoef(a[both], b[both])[0, 1])
        correlation_of_lag[lag] = value
        if math.isnan(best) or abs(value) > abs(best):
            best, best_lag = value, lag
    lags, values = tuple(lag * step / 3600.0 for lag in tried), tuple(correlation_of_lag.values())
    if math.isnan(best):
        return DriverCorrelation(name, math.nan, 0.0, math.inf, math.nan, lags, values)
    a, b = r[best_lag:], driver[: r.size - best_lag]
    both = np.isfinite(a) & np.isfinite(b)
    slope = best * float(np.std(a[both]) / np.std(b[both]))
    limit = min(_SEVERAL_LAGS * correlate(a, b)[1], 1.0)
    return DriverCorrelation(name, best, best_lag * step / 3600.0, limit, slope, lags, values)


def _daily_cycle(series: Floats, hours: Floats) -> DailyCycle:
    """Fit a mean, a trend and a sine of 24 h by least squares."""
    keep = np.isfinite(series)
    angle = hours * np.pi / 12.0
    trend = np.linspace(-1.0, 1.0, series.size)
    columns = np.column_stack([np.ones(series.size), trend, np.cos(angle), np.sin(angle)])
    c, s = np.linalg.lstsq(columns[keep], series[keep])[0][2:]
    return DailyCycle(float(math.hypot(c, s)), float(math.atan2(s, c) * 12.0 / math.pi % 24.0))


def _size(value: float) -> float:
    return abs(value) if math.isfinite(value) else -1.0


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
