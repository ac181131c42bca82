"""The score of SimQuality, as its own script computes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_LARGEST: Final = "Max Difference"
_R_SQUARED: Final = "R squared"
#: A mean below this is that of a program that returns nothing.
_NOTHING: Final = 1e-4


@dataclass(frozen=True)
class Reference:
    """Reference of a test function: series, windows of hours and weights.

    Parameters
    ----------
    hours : ndarray, shape (n,)
        Hour of the year at which values stand. [h]
    series : dict of str to ndarray, shape (n,)
        By name of the variable.
    windows : dict of str to list of (float, float)
        First and last hour of each window. [h]
    weights : dict of str to float
        Of the statistics.
    """

    hours: Array
    series: dict[str, Array]
    windows: dict[str, list[tuple[float, float]]]
    weights: dict[str, float]

    @classmethod
    def read(cls, data: CaseData, folder: str) -> Reference:
        """Read the three tables of a test function."""
        header, *rows = _rows(data.text(f"{folder}/Reference.tsv"))
        numbers = np.array([[float(cell) for cell in row[: len(header)]] for row in rows])
        names = [name.split(" [")[0].strip() for name in header]
        windows = {}
        for variable, *ends in _rows(data.text(f"{folder}/EvaluationPeriods.tsv"))[1:]:
            first, last = [cell for cell in ends if cell][:2]
            windows[variable] = [
                (float(a), float(b)) for a, b in zip(first.split(","), last.split(","), strict=True)
            ]
        weights = {row[0]: float(row[1]) for row in _rows(data.text(f"{folder}/WeightFactors.tsv"))[1:]}
        series = dict(zip(names[1:], numbers[:, 1:].T, strict=True))
        return cls(numbers[:, 0], series, windows, weights)

    def score(self, variable: str, hours: Array, values: Array) -> float:
        """Score of a series: mean over the windows. [-]

        Parameters
        ----------
        variable : str
            Its name in the reference.
        hours, values : ndarray, shape (m,)
            Hour of the year [h] and value.
        """
        reference, scores = self.series[variable], []
        for first, last in self.windows[variable]:
            rows = (self.hours >= first - 1e-9) & (self.hours <= last + 1e-9)
            hour = self.hours[rows]
            scores.append(score(self.weights, reference[rows], np.interp(hour, hours, values), hour))
        return float(np.mean(scores))


def score(weights: Mapping[str, float], reference: Array, values: Array, hours: Array) -> float:
    """Score of a window, from 100 downwards. [-]

    Parameters
    ----------
    weights : mapping of str to float
        Of the statistics, or half of the largest difference that gives 80.
    reference, values, hours : ndarray, shape (n,)

    Examples
    --------
    >>> hours = np.arange(48.0)
    >>> swing = 20.0 + np.sin(hours)
    >>> score({"NRMSE": 1.0}, swing, swing, hours)
    100.0
    """
    if abs(round(float(values.mean()), 2)) < _NOTHING:
        return 0.0
    largest = weights.get(_LARGEST, 0.0)
    if largest:
        return 80.0 + 20.0 * (largest - round(float(np.abs(values - reference).max()), 2)) / largest
    total = 0.0
    for name, weight in weights.items():
        if not weight:
            continue
        with np.errstate(divide="ignore", invalid="ignore"):
            number = round(_STATISTICS[name](reference, values, hours), 2)
        if np.isfinite(number):
            total += weight * (number if name == _R_SQUARED else 100.0 - abs(number))
    return total / sum(weights.values())


def _rmse(reference: Array, values: Array) -> float:
    return float(np.sqrt(np.mean((values - reference) ** 2)))


def _amplitudes(values: Array, hours: Array) -> Array:
    day = (hours // 24).astype(int)
    return np.array([np.ptp(values[day == number]) for number in np.unique(day)])


def _amplitude(reference: Array, values: Array, hours: Array) -> float:
    theirs = _amplitudes(reference, hours)
    return 100.0 * _rmse(theirs, _amplitudes(values, hours)) / float(theirs.mean())


def _by_quartiles(reference: Array, values: Array, _: Array) -> float:
    low, high = np.percentile(reference, [25, 75])
    return 100.0 * _rmse(reference, values) / float(high - low)


def _r_squared(reference: Array, values: Array, _: Array) -> float:
    variance = float(np.sum((reference - reference.mean()) ** 2))
    return 100.0 * (1.0 - float(np.sum((values - reference) ** 2)) / variance)


#: Statistics in per cent. [%]
_STATISTICS: Final[dict[str, Callable[[Array, Array, Array], float]]] = {
    "CVRMSE": lambda reference, values, _: 100.0 * _rmse(reference, values) / float(reference.mean()),
    "Daily Amplitude CVRMSE": _amplitude,
    "RMSEIQR": _by_quartiles,
    "NMBE": lambda reference, values, _: float(100.0 * (values - reference).sum() / reference.sum()),
    "NRMSE": lambda reference, values, _: 100.0 * _rmse(reference, values) / float(np.ptp(reference)),
    _R_SQUARED: _r_squared,
}


def _rows(text: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.split("\t")] for line in text.splitlines() if line.strip()]
