"""Choice of days: how far days lie outside of what a calibration has excited, and which to use next.

A day teaches what the derivatives of the series by the parameters tell on it. The information of the days of
the calibration, with that of the priors, is the inverse covariance C of the estimates; the leverage of a day
is the variance of its prediction from the estimates alone, over the variance of the errors. A day whose
leverage is many times that of the days of the calibration is an extrapolation. The next day to use is that
with the largest expected information: it lowers the volume of the confidence region most (D-optimal), or the
variance of the predictions on all other days (A-optimal, also called V- or I-optimal).

References
----------
Atkinson A.C., Donev A.N., Tobias R.D. (2007), Optimum Experimental Designs, with SAS, ch. 10 and 11. Oxford
University Press.
Hoaglin D.C., Welsch R.E. (1978), Am. Stat. 32, 17 (leverage), doi:10.1080/00031305.1978.10479237.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin._io.limits import above, below
from mascarin.errors import InputError

Floats = NDArray[np.float64]

#: Number of days that are proposed.
_MAX_PROPOSED: Final = 5
#: A day with this many times the leverage of the days of the calibration is an extrapolation. [-]
EXTRAPOLATION_RATIO: Final = 3.0


@dataclass(frozen=True, slots=True)
class DriverRange:
    """Range of a driver on the days of the calibration and on the others.

    Attributes
    ----------
    name : str
        Driver.
    low, high : float
        On the days of the calibration. [unit of the driver]
    other_low, other_high : float
        On the other days. [unit of the driver]
    outside : float
        Part of the other instants outside of the range of the calibration. [-]

    Examples
    --------
    >>> DriverRange("wind", 0.0, 4.0, 0.0, 9.0, 0.12).outside
    0.12
    """

    name: str
    low: float
    high: float
    other_low: float
    other_high: float
    outside: float


@dataclass(frozen=True, eq=False)
class DayChoice:
    """What each day tells, and which to use next.

    Attributes
    ----------
    days : tuple of str
        Dates.
    used : ndarray of bool, shape (D,)
        Whether the day was used in the calibration.
    leverage : ndarray, shape (D,)
        Mean variance of the prediction from the estimates, over the variance of the errors. [-]
    information : ndarray, shape (D,)
        Fall of the logarithm of the volume of the confidence region if the day were used as well (D). [-]
    reduction : ndarray, shape (D,)
        Part by which the variance of the predictions on all days that are not used would fall (A). [-]
    outside : dict of str to ndarray, shape (D,)
        Part of the instants of each day outside of the range of the calibration, by driver. [-]
    ranges : tuple of DriverRange
        Ranges of the drivers.
    proposed : tuple of int
        Days to use next, one after the other; each with those before it.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> day = np.repeat(np.arange(4), 24)
    >>> slopes = rng.normal(size=(2, 96, 1)) * np.array([1.0, 1.0, 1.0, 5.0])[day][None, :, None]
    >>> found = choose_days(slopes, [0.1], [str(d) for d in range(4)], day, day == 0, precision=[16.0, 16.0])
    >>> found.proposed[0], bool(found.extrapolated[3])
    (3, True)
    """

    days: tuple[str, ...]
    used: NDArray[np.bool_]
    leverage: Floats
    information: Floats
    reduction: Floats
    outside: dict[str, Floats]
    ranges: tuple[DriverRange, ...]
    proposed: tuple[int, ...]

    @property
    def ratio(self) -> Floats:
        """Leverage over the mean of the days of the calibration, shape (D,). [-]"""
        usual = float(np.mean(self.leverage[self.used])) if self.used.any() else math.nan
        return np.asarray(self.leverage / usual) if usual > 0.0 else np.full(self.leverage.size, math.nan)

    @property
    def extrapolated(self) -> NDArray[np.bool_]:
        """Days that are an extrapolation, shape (D,)."""
        return np.asarray(~self.used & (np.nan_to_num(self.ratio) > EXTRAPOLATION_RATIO))

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file, with six digits."""

        def plain(values: Floats) -> list[float | None]:
            return [float(f"{v:.6g}") if math.isfinite(v) else None for v in values]

        return {
            "days": list(self.days),
            "used": self.used.tolist(),
            "leverage": plain(self.leverage),
            "ratio": plain(self.ratio),
            "information": plain(self.information),
            "reduction": plain(self.reduction),
            "outside": {name: plain(values) for name, values in self.outside.items()},
            "ranges": {
                driver_range.name: {
                    "calibration": [driver_range.low, driver_range.high],
                    "others": [driver_range.other_low, driver_range.other_high],
                    "outside": driver_range.outside,
                }
                for driver_range in self.ranges
            },
            "proposed": [self.days[k] for k in self.proposed],
        }  # fmt: skip


def choose_days(
    slopes: ArrayLike,
    sd: ArrayLike,
    labels: list[str],
    day: ArrayLike,
    used: ArrayLike,
    *,
    precision: ArrayLike,
    weight: ArrayLike = 1.0,
    drivers: Mapping[str, ArrayLike] | None = None,
) -> DayChoice:
    """Compare the days of a record by what they tell about the parameters.

    Parameters
    ----------
    slopes : array_like, shape (P, n, S)
        Derivatives of the series by the calibrated parameters, in ranges; NaN where nothing is measured or
        computed. [unit of each sensor]
    sd : array_like, shape (S,)
        Standard deviation of the errors; NaN leaves a sensor out. [unit of each]
    labels : list of str
        Dates of the days, D of them.
    day : array_like, shape (n,)
        Number of the day of each instant, from 0.
    used : array_like of bool, shape (n,)
        Instants of the calibration.
    precision : array_like, shape (P,)
        Inverse variance of the prior of each parameter; zero: none. [1/ranges^2]
    weight : array_like, shape (S,) or float
        Weight of a sample: below one where errors are autocorrelated. [-]
    drivers : mapping of str to array_like, shape (n,), optional
        Weather and states, to compare their ranges.

    Returns
    -------
    DayChoice

    Raises
    ------
    InputError
        The shapes do not match.

    Examples
    --------
    >>> found = choose_days(np.ones((1, 2, 1)), [1.0], ["Mon", "Tue"], [0, 1], [True, False], precision=[0.0])
    >>> found.leverage.tolist()
    [1.0, 1.0]
    """
    j, number = np.asarray(slopes, dtype=np.float64), np.asarray(day, dtype=np.int64)
    in_use, sigma = np.asarray(used, dtype=bool), np.asarray(sd, dtype=np.float64)
    if j.ndim != 3 or j.shape[1:] != (number.size, sigma.size) or in_use.shape != number.shape:
        raise InputError(
            f"slopes: found shape {j.shape}, expected (parameters, {number.size}, {sigma.size}): one value "
            "for each instant and sensor"
        )
    w = np.broadcast_to(np.asarray(weight, dtype=np.float64), sigma.shape)
    good = np.isfinite(j).all(axis=0) & np.isfinite(sigma)[None, :]
    scaled = np.where(good, j, 0.0) / np.where(np.isfinite(sigma) & (sigma > 0.0), sigma, np.inf)
    count = len(labels)
    matrices = np.zeros((count, len(j), len(j)))
    samples, from_used = np.zeros(count), np.zeros((len(j), len(j)))
    for d in range(count):
        of_day = number == d
        part = scaled[:, of_day]
        matrices[d] = np.einsum("pts,s,qts->pq", part, w, part)
        samples[d] = float((good[of_day] * w).sum())
    from_used = np.einsum("pts,s,qts->pq", scaled[:, in_use], w, scaled[:, in_use])
    share = np.bincount(number, weights=in_use.astype(np.float64), minlength=count) / np.maximum(
        np.bincount(number, minlength=count), 1
    )
    used_days = share >= 0.5
    information = from_used + np.diag(np.asarray(precision, dtype=np.float64))
    covariance = np.linalg.pinv(information, hermitian=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Per sample, so that days with gaps compare with others.
        leverage = np.einsum("pq,dpq->d", covariance, matrices) / samples * float(w.mean())
    other_information: Floats = matrices[~used_days].sum(axis=0)
    gains = [_gains(information, covariance, matrices[d], other_information) for d in range(count)]
    outside, ranges = _drivers(drivers or {}, number, in_use, count)
    return DayChoice(
        tuple(labels), used_days, leverage, np.array([g[0] for g in gains]), np.array([g[1] for g in gains]),
        outside, ranges, _proposed(information, matrices, used_days),
    )  # fmt: skip


def _gains(
    information: Floats, covariance: Floats, matrix: Floats, other_information: Floats
) -> tuple[float, float]:
    """Gain of information of a day, and the part by which the variance of predictions falls."""
    sign, logarithm = np.linalg.slogdet(np.eye(len(information)) + covariance @ matrix)
    before = float(np.sum(covariance * other_information))
    after = float(np.sum(np.linalg.pinv(information + matrix, hermitian=True) * other_information))
    return 0.5 * float(logarithm) if sign > 0 else 0.0, 1.0 - after / before if before > 0.0 else 0.0


def _proposed(information: Floats, matrices: Floats, used: NDArray[np.bool_]) -> tuple[int, ...]:
    """Days with the largest gain of information, each beside those before it."""
    chosen: list[int] = []
    now: Floats = information
    other_information: Floats = matrices[~used].sum(axis=0)
    while len(chosen) < min(_MAX_PROPOSED, int((~used).sum())):
        covariance: Floats = np.asarray(np.linalg.pinv(now, hermitian=True), dtype=np.float64)
        gain = {
            d: _gains(now, covariance, matrices[d], other_information)[0]
            for d in np.flatnonzero(~used).tolist()
            if d not in chosen
        }
        best = max(gain, key=lambda d: gain[d])
        if gain[best] <= 0.0:
            break
        chosen.append(best)
        now = now + matrices[best]
    return tuple(chosen)


def _drivers(
    drivers: Mapping[str, ArrayLike], day: NDArray[np.int64], in_use: NDArray[np.bool_], count: int
) -> tuple[dict[str, Floats], tuple[DriverRange, ...]]:
    outside: dict[str, Floats] = {}
    ranges = []
    for name, values in drivers.items():
        x = np.asarray(values, dtype=np.float64)
        finite = np.isfinite(x)
        inside, other = x[in_use & finite], x[~in_use & finite]
        if not inside.size or not other.size:
            continue
        low, high = float(inside.min()), float(inside.max())
        out = finite & (below(x, low) | above(x, high))
        total = np.bincount(day[finite], minlength=count)
        outside[name] = np.bincount(day[out], minlength=count) / np.maximum(total, 1)
        ranges.append(
            DriverRange(
                name,
                low,
                high,
                float(other.min()),
                float(other.max()),
                float(out[~in_use].sum() / other.size),
            )
        )
    return outside, tuple(ranges)
