"""Metrics of agreement between a measured and a simulated series.

Differences are always *simulated minus measured*: a positive bias means that the model is too warm.

Two kinds of relative metrics exist, and they have different names:

- over the **mean** of the measurements: CV(RMSE) and NMBE of ASHRAE Guideline 14, made for energy and power,
  whose zero has a physical meaning. The mean of a temperature in degC depends on where its scale has its
  zero, so these two are not given (NaN) for degC, nor where the mean is nearly zero;
- over the **range** (largest minus smallest measured value): all names that end in ``_over_range`` or
  ``_percent``. They mean the same in degC and in K, and the reference study uses them.

References
----------
ASHRAE (2014), Guideline 14-2014, Measurement of energy, demand, and water savings, 5.2.11.3 and annex B:
``CV(RMSE) = 100 sqrt(sum d^2 / (n - p)) / mean`` and ``NMBE = 100 sum d / ((n - p) mean)``, with p = 1 for
calibrated simulations. The Guideline subtracts the simulated from the measured value; the sign of NMBE is
here that of all other metrics, and limits apply to its size.
Ruiz G.R., Bandera C.F. (2017), Validation of calibrated energy models: common errors, Energies 10, 1587.
https://doi.org/10.3390/en10101587
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin._io import display
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

GUIDELINE_PARAMETERS: Final = 1
"""p of ASHRAE Guideline 14 for calibrated simulations: n - p degrees of freedom. [-]"""


@dataclass(frozen=True, slots=True)
class Differences:
    """Differences of two complete series.

    Attributes
    ----------
    signed : ndarray, shape (n,)
        Simulated minus measured. [unit]
    size : ndarray, shape (n,)
        Their size. [unit]
    freedom : int
        Degrees of freedom of ASHRAE Guideline 14, n - p. [-]
    """

    signed: NDArray[np.float64]
    size: NDArray[np.float64]
    freedom: int

    @property
    def bias(self) -> float:
        """Mean difference. [unit]"""
        return float(self.signed.mean())

    @property
    def rmse(self) -> float:
        """Root of the mean squared difference. [unit]"""
        return float(np.sqrt(np.mean(self.signed * self.signed)))

    @property
    def mean_error(self) -> float:
        """Mean size. [unit]"""
        return float(self.size.mean())

    @property
    def max_error(self) -> float:
        """The difference of largest size, with its sign. [unit]"""
        return float(self.signed[np.argmax(self.size)])


class Metric(NamedTuple):
    """What a metric is.

    Attributes
    ----------
    formula : callable
        Its value, before it is divided. [unit]
    words : str
        As criteria say it.
    over : str
        What it is divided by, in percent: the measured ``range``, or the ``mean`` of the measurements;
        nothing for metrics in the unit of the sensor.
    instead : str
        The metric for temperatures in degC, of one over the mean.
    """

    formula: Callable[[Differences], float]
    words: str
    over: Literal["", "range", "mean"] = ""
    instead: str = ""


TABLE: Final[Mapping[str, Metric]] = {
    "bias": Metric(lambda d: d.bias, "|bias|"),
    "sd": Metric(lambda d: float(d.signed.std()), "|sd|"),
    "rmse": Metric(lambda d: d.rmse, "|rmse|"),
    "mean_error": Metric(lambda d: d.mean_error, "|mean error|"),
    "max_error": Metric(lambda d: d.max_error, "|max error|"),
    "mean_error_percent": Metric(lambda d: d.mean_error, "|mean error|", over="range"),
    "max_error_percent": Metric(lambda d: d.max_error, "|max error|", over="range"),
    "cv_rmse": Metric(
        lambda d: math.sqrt(float(np.sum(d.signed * d.signed)) / d.freedom),
        "CV(RMSE)",
        over="mean",
        instead="rmse_over_range",
    ),
    "nmbe": Metric(
        lambda d: float(np.sum(d.signed)) / d.freedom, "|NMBE|", over="mean", instead="bias_over_range"
    ),
    "rmse_over_range": Metric(lambda d: d.rmse, "rmse", over="range"),
    "bias_over_range": Metric(lambda d: d.bias, "|bias|", over="range"),
}
"""The metrics by name; each is a field of `Metrics`."""

METRICS: Final = tuple(TABLE)
"""Names of the metrics that a criterion may limit."""

OVER_MEAN: Final = tuple(name for name, metric in TABLE.items() if metric.over == "mean")
"""Metrics of ASHRAE Guideline 14, which divide by the mean of the measurements."""

PERCENT: Final = tuple(name for name, metric in TABLE.items() if metric.over)
"""Metrics in percent; all others have the unit of the sensor."""

_NEAR_ZERO: Final = (
    0.01  # size of a mean over the largest size of a value below which nothing is divided by it
)


def mean_refusal(measured: NDArray[np.float64], unit: str) -> str:
    """Say why metrics over the mean of a series make no sense.

    Parameters
    ----------
    measured : ndarray, shape (n,)
        Measured values, without gaps. [unit]
    unit : str
        Their unit.

    Returns
    -------
    str
        The reason; empty where CV(RMSE) and NMBE can be given.

    Examples
    --------
    >>> import numpy as np
    >>> mean_refusal(np.array([20.0, 22.0]), "degC")
    'the unit is degC, and the mean of a temperature depends on the zero of its scale'
    >>> mean_refusal(np.array([300.0, 500.0]), "W")
    ''
    """
    if unit == "degC":
        return "the unit is degC, and the mean of a temperature depends on the zero of its scale"
    if measured.size <= GUIDELINE_PARAMETERS:
        return f"{measured.size} values leave no degree of freedom"
    mean = float(measured.mean())
    if abs(mean) <= _NEAR_ZERO * float(np.abs(measured).max()):
        return f"the mean of the measurements, {mean:.3g} {unit}, is nearly zero"
    return ""


@dataclass(frozen=True, slots=True, repr=False)
class Metrics:
    """Agreement of a simulated with a measured series.

    Attributes
    ----------
    unit : str
        Unit of the compared quantity; differences of a temperature in degC are kelvins and carry the
        same label.
    n : int
        Number of values compared. [-]
    bias : float
        Mean difference. [unit]
    sd : float
        Standard deviation of the differences about their mean, divided by n as in equation 4 of the
        reference study; it does not see a bias. [unit]
    rmse : float
        Root of the mean squared difference; rmse**2 = bias**2 + sd**2. [unit]
    mean_error : float
        Mean of the absolute differences. [unit]
    max_error : float
        The difference of largest size, with its sign. [unit]
    mean_error_percent : float
        `mean_error` over the measured range. [%]
    max_error_percent : float
        `max_error` over the measured range, with its sign. [%]
    measured_range : float
        Largest minus smallest measured value. [unit]
    cv_rmse : float
        CV(RMSE) of ASHRAE Guideline 14: root of the sum of squared differences over n - 1, over the size
        of the mean of the measurements. NaN where `mean_refusal` has a reason. [%]
    nmbe : float
        NMBE of ASHRAE Guideline 14: sum of the differences over n - 1, over the mean of the measurements,
        positive where the simulation is too high. NaN as `cv_rmse`. [%]
    rmse_over_range : float
        `rmse` over the measured range. [%]
    bias_over_range : float
        `bias` over the measured range, with its sign. [%]
    remark : str
        Why metrics are missing (NaN); empty where all are given.

    Examples
    --------
    >>> found = metrics([20.0, 22.0, 24.0], [20.5, 22.5, 24.5])
    >>> found.bias, found.bias_over_range, found.cv_rmse
    (0.5, 12.5, nan)
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
    cv_rmse: float = math.nan
    nmbe: float = math.nan
    rmse_over_range: float = math.nan
    bias_over_range: float = math.nan
    remark: str = ""

    def to_dict(self) -> dict[str, float | int | str | None]:
        """Return the metrics for a JSON file; what could not be computed is None."""
        values: dict[str, float | int | str | None] = {"unit": self.unit, "n": self.n}
        for name in (*METRICS, "measured_range"):
            value = getattr(self, name)
            values[name] = value if math.isfinite(value) else None
        return values

    def to_dataframe(self) -> pd.DataFrame:
        """Return one row for each metric, with its value and unit."""
        import pandas as pd

        names = [*METRICS, "measured_range"]
        units = ["%" if name in PERCENT else self.unit for name in names]
        values = [getattr(self, name) for name in names]
        return pd.DataFrame({"value": values, "unit": units}, index=pd.Index(names, name="metric"))

    def __repr__(self) -> str:
        return display.text(f"Metrics of {self.n} values", self._rows())

    def _repr_html_(self) -> str:
        return display.page(f"Metrics of {self.n} values", self._rows())

    def _rows(self) -> list[tuple[str, str]]:
        rows = [
            (name, f"{getattr(self, name):.4g} {'%' if name in PERCENT else self.unit}".rstrip())
            for name in METRICS
            if math.isfinite(getattr(self, name))
        ]
        return [*rows, ("not given", self.remark)] if self.remark else rows


def metrics(
    measured: ArrayLike | pd.Series[float],
    simulated: ArrayLike | pd.Series[float],
    *,
    use: ArrayLike | None = None,
    unit: str = "degC",
) -> Metrics:
    """Compare a simulated with a measured series.

    Parameters
    ----------
    measured : pandas.Series or array_like, shape (n,)
        Measured values; NaN where nothing was measured: such values are left out. [unit]
    simulated : pandas.Series or array_like, shape (n,)
        Simulated values. Of two series with an index, such as times, the labels that both have are compared;
        arrays must have the same length. [unit]
    use : array_like of bool, shape (n,), optional
        Which of the measured values to compare, such as those of a period; all when absent.
    unit : str
        Unit of both series.

    Returns
    -------
    Metrics
        All metrics; `Metrics.to_dataframe` gives them as a table.

    Raises
    ------
    InputError
        The series have different lengths or no common label, a label is there twice, or a simulated value
        is not a number.

    Examples
    --------
    >>> print(metrics([300.0, 500.0, 400.0], [310.0, 520.0, 390.0], unit="W"))
    Metrics of 3 values
      bias                6.667 W
      sd                  12.47 W
      rmse                14.14 W
      mean_error          13.33 W
      max_error           20 W
      mean_error_percent  6.667 %
      max_error_percent   10 %
      cv_rmse             4.33 %
      nmbe                2.5 %
      rmse_over_range     7.071 %
      bias_over_range     3.333 %
    """
    if not (hasattr(measured, "reindex") and hasattr(simulated, "reindex")):
        return compare(cast(ArrayLike, measured), cast(ArrayLike, simulated), use=use, unit=unit)
    first, second = cast("pd.Series[float]", measured), cast("pd.Series[float]", simulated)
    for name, index in (("measured", first.index), ("simulated", second.index)):
        if not index.is_unique:
            twice = index[index.duplicated()][0]
            raise InputError(f"{name} series: the label {twice} is there twice; expected each label once")
    keep = np.ones(len(first), dtype=np.bool_) if use is None else np.asarray(use, dtype=np.bool_)
    if keep.shape != (len(first),):
        raise InputError(
            f"use: found shape {keep.shape}, expected one flag for each of {len(first)} measured values"
        )
    common = first.index[keep & first.index.isin(second.index)]
    if common.empty:
        raise InputError(
            f"measured and simulated series: found no common label ({_span(first)}; {_span(second)}), "
            "expected the same times; resample one of them, and give both a time zone or neither"
        )
    return compare(
        first.reindex(common).to_numpy(dtype=np.float64),
        second.reindex(common).to_numpy(dtype=np.float64),
        unit=unit,
    )


def _span(series: pd.Series[float]) -> str:
    return f"{series.index[0]} to {series.index[-1]}" if len(series) else "empty"


def compare(
    measured: ArrayLike, simulated: ArrayLike, *, use: ArrayLike | None = None, unit: str = "degC"
) -> Metrics:
    """Compare two arrays of the same instants, value by value; see `metrics`.

    Parameters
    ----------
    measured : array_like, shape (n,)
        Measured values; NaN where nothing was measured: such values are left out. [unit]
    simulated : array_like, shape (n,)
        Simulated values at the same instants, or means over the same intervals. [unit]
    use : array_like of bool, shape (n,), optional
        Values to compare; all when absent.
    unit : str
        Unit of both series.

    Returns
    -------
    Metrics
        With ``n = 0`` and NaN where no value is left, and NaN for percentages of the range when the measured
        value never changes.

    Raises
    ------
    InputError
        The shapes differ, a measured value is infinite, or a simulated value to be compared is not a number:
        a simulation has no gaps.

    Examples
    --------
    >>> compare([20.0, 22.0, 24.0], [20.5, 22.5, 24.5]).bias
    0.5
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


def _aligned(
    measured: ArrayLike, simulated: ArrayLike, use: ArrayLike | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Return both series and the mask as vectors of one length."""
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
    """Metrics of two complete series."""
    n = m.size
    if n == 0:
        missing = {field.name: math.nan for field in fields(Metrics) if field.type == "float"}
        return Metrics(unit=unit, n=0, **missing, remark="all metrics: there is no value to compare")
    d = s - m
    span = float(m.max() - m.min())
    refusal = mean_refusal(m, unit)
    factors = {
        "": 1.0,
        "range": 100.0 / span if span > 0.0 else math.nan,
        "mean": math.nan if refusal else 100.0 / abs(float(m.mean())),
    }
    differences = Differences(d, np.abs(d), n - GUIDELINE_PARAMETERS)
    values = {
        # Where there is no factor there may be no degree of freedom, either.
        name: math.nan if math.isnan(factor) else metric.formula(differences) * factor
        for name, metric in TABLE.items()
        for factor in [factors[metric.over]]
    }
    remarks = [f"{', '.join(OVER_MEAN)}: {refusal}"] if refusal else []
    if span == 0.0:
        remarks.append("metrics over the range: the measured value never changes")
    return Metrics(unit=unit, n=n, measured_range=span, **values, remark="; ".join(remarks))
