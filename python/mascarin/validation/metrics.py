"""How far a simulated series is from a measured one.

Differences are always *simulated minus measured*, so that a positive bias means that the model is too
warm. Percentages are shares of the measured range (largest minus smallest measured value over the compared
samples): this is the reading under which the error columns of the reference study agree with its
differences, and unlike a percentage of the mean it does not depend on where the scale has its zero.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError, did_you_mean

METRICS = (
    "bias",
    "sd",
    "rmse",
    "mean_error",
    "max_error",
    "mean_error_percent",
    "max_error_percent",
)
"""Names of the metrics that a criterion may limit."""


@dataclass(frozen=True, slots=True)
class Metrics:
    """Agreement of one sensor over one period.

    Attributes
    ----------
    unit : str
        Unit of the compared quantity; differences of a temperature in degC are kelvins and carry the
        same label.
    n : int
        Number of samples compared. [-]
    bias : float
        Mean difference. [unit]
    sd : float
        Standard deviation of the differences about their mean, divided by n as in equation 4 of the
        reference study; blind to bias. [unit]
    rmse : float
        Root of the mean squared difference; rmse**2 = bias**2 + sd**2. [unit]
    mean_error : float
        Mean of the absolute differences. [unit]
    max_error : float
        The difference of largest size, with its sign. [unit]
    mean_error_percent : float
        `mean_error` as a share of the measured range. [%]
    max_error_percent : float
        `max_error` as a share of the measured range, with its sign. [%]
    measured_range : float
        Largest minus smallest measured value. [unit]
    """

    unit: str
    n: int
    bias: float
    sd: float
    rmse: float
    mean_error: float
    max_error: float
    mean_error_percent: float
    max_error_percent: float
    measured_range: float

    def to_dict(self) -> dict[str, float | int | str | None]:
        """The metrics for a JSON file; what could not be computed is None."""
        values: dict[str, float | int | str | None] = {"unit": self.unit, "n": self.n}
        for name in (*METRICS, "measured_range"):
            value = getattr(self, name)
            values[name] = value if math.isfinite(value) else None
        return values


def compare(
    measured: ArrayLike, simulated: ArrayLike, *, use: ArrayLike | None = None, unit: str = "degC"
) -> Metrics:
    """Compare a simulated with a measured series, sample by sample.

    Parameters
    ----------
    measured : array_like, shape (n,)
        Measured values; NaN where nothing was measured: such samples are left out. [unit]
    simulated : array_like, shape (n,)
        Simulated values at the same instants, or means over the same intervals. [unit]
    use : array_like of bool, shape (n,), optional
        Samples to compare; all when absent. This is where a quality mask or a period enters.
    unit : str
        Unit of both series.

    Returns
    -------
    Metrics
        With ``n = 0`` and NaN values when no sample is left, and NaN percentages when the measured value
        never changes.

    Raises
    ------
    InputError
        When the shapes differ, or a simulated value to be compared is not a number: a simulation has no
        gaps, so that is never passed over.
    """
    m, s, keep = _aligned(measured, simulated, use)
    keep &= ~np.isnan(m)
    bad = keep & ~np.isfinite(s)
    if bad.any():
        msg = (
            f"simulated series: {int(bad.sum())} of {m.size} values are not finite numbers, the first at "
            f"sample {int(np.argmax(bad))}; a simulation has no gaps, so check the run that made it"
        )
        raise InputError(msg)
    infinite = keep & np.isinf(m)
    if infinite.any():
        msg = f"measured series: infinite value at sample {int(np.argmax(infinite))}; mask it or remove it"
        raise InputError(msg)
    return _metrics(m[keep], s[keep], unit)


def compare_sensors(
    measured: Mapping[str, ArrayLike],
    simulated: Mapping[str, ArrayLike],
    *,
    use: Mapping[str, ArrayLike] | ArrayLike | None = None,
    units: Mapping[str, str] | None = None,
) -> dict[str, Metrics]:
    """Compare several sensors over one period.

    Parameters
    ----------
    measured : mapping of str to array_like, shape (n,)
        Measured series by sensor, NaN for gaps.
    simulated : mapping of str to array_like, shape (n,)
        Simulated series by the same names.
    use : mapping of str to array_like of bool, or one array, optional
        Samples to compare, by sensor or the same for all.
    units : mapping of str to str, optional
        Unit by sensor; degC for those not named.

    Returns
    -------
    dict of str to Metrics
        In the order of `measured`.

    Raises
    ------
    InputError
        When a measured sensor has no simulated series.
    """
    found: dict[str, Metrics] = {}
    for name, series in measured.items():
        if name not in simulated:
            msg = f"sensor '{name}' has no simulated series. {did_you_mean(name, simulated)}"
            raise InputError(msg)
        mask = use.get(name) if isinstance(use, Mapping) else use
        unit = (units or {}).get(name, "degC")
        try:
            found[name] = compare(series, simulated[name], use=mask, unit=unit)
        except InputError as error:
            msg = f"sensor '{name}': {error}"
            raise InputError(msg) from error
    return found


def _aligned(
    measured: ArrayLike, simulated: ArrayLike, use: ArrayLike | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Both series and the mask as vectors of one length."""
    m = np.asarray(measured, dtype=np.float64)
    s = np.asarray(simulated, dtype=np.float64)
    keep = np.ones(m.shape, dtype=np.bool_) if use is None else np.array(use, dtype=np.bool_)
    if m.ndim != 1 or m.shape != s.shape or m.shape != keep.shape:
        msg = (
            f"measured, simulated and mask must be vectors of one length, found shapes {m.shape}, {s.shape} "
            f"and {keep.shape}: bring both series to the same instants first"
        )
        raise InputError(msg)
    return m, s, keep


def _metrics(m: NDArray[np.float64], s: NDArray[np.float64], unit: str) -> Metrics:
    """The metrics of two complete series."""
    n = m.size
    if n == 0:
        nan = math.nan
        return Metrics(unit, 0, nan, nan, nan, nan, nan, nan, nan, nan)
    d = s - m
    size = np.abs(d)
    span = float(m.max() - m.min())
    percent = 100.0 / span if span > 0.0 else math.nan
    mean_error = float(size.mean())
    max_error = float(d[np.argmax(size)])
    return Metrics(
        unit=unit,
        n=n,
        bias=float(d.mean()),
        sd=float(d.std()),
        rmse=float(np.sqrt(np.mean(d * d))),
        mean_error=mean_error,
        max_error=max_error,
        mean_error_percent=mean_error * percent,
        max_error_percent=max_error * percent,
        measured_range=span,
    )
