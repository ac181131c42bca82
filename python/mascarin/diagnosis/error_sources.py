"""Sources of the remaining error: wrong parameter values, or missing equations.

The error of a fitted model on days that were not used in the fit is explained by the effects of its
parameters, for all sensors together. Where a few parameters explain it, the data of the identification did
not determine them; where all parameters together do not explain it, no values of parameters help, and the
cause is in the equations or in the weather. Everything is linear about the fitted model, and the fit is not
changed: these days are not used for the calibration.

A change of a parameter has a normal prior about the fitted value, with a standard deviation of a quarter of
its range, and stays inside the range. The error that remains is always computed on days that were not used to
find the change: the record is divided into weeks, and every other week tests what was found on the rest.
Where no change makes the error smaller there, no parameter is named.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin._io.limits import above, at_most
from mascarin._io.numbers import beside_limit
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.validation.criteria import Verdict

Floats = NDArray[np.float64]

#: Fewest decimals of standard deviations in sentences.
_DECIMALS: Final = 3
Flags = NDArray[np.bool_]

PRIOR: Final = 0.25
"""Standard deviation of the prior of a change. [ranges]"""
MAX_NAMED: Final = 6
"""Largest number of parameters that are named."""
#: A parameter is named when it reduces the cost by at least this part of what all of them do, and parameters
#: are named at all when some reduce the squared error by this part on weeks that were not used to find them.
_MIN_GAIN_SHARE: Final = 0.05
#: The coordinate descent ends when no change moves by more [ranges], or after so many sweeps.
_MAX_CHANGE: Final = 1e-6
_MAX_SWEEPS: Final = 500
#: Length of the pieces that the record is divided into. [d]
_BLOCK_DAYS: Final = 7


@dataclass(frozen=True, slots=True)
class Correction:
    """Parameters that are changed together, and the error that remains.

    Attributes
    ----------
    paths : tuple of str
        The parameters.
    changes : tuple of float
        By how much each is changed, in ranges: 0.5 is half the way from the low to the high end. [-]
    sd : tuple of float
        Standard deviation of the remaining error of each sensor, on weeks that were not used to find the
        changes. [unit of each]
    """

    paths: tuple[str, ...]
    changes: tuple[float, ...]
    sd: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ErrorSources:
    """The remaining error of each sensor, and the parameters that explain it.

    Attributes
    ----------
    sensors : tuple of str
        Names.
    sd : tuple of float
        Standard deviation of the error as it is. [unit of each]
    steps : tuple of Correction
        The parameter that explains most, then together with the next, and so on; empty where none does.
    all_adjusted : Correction
        All parameters together: the best that these equations can do.

    Examples
    --------
    >>> ErrorSources(("air",), (0.3,), (), Correction(("absorptance",), (0.1,), (0.05,))).floor("air")
    0.05
    """

    sensors: tuple[str, ...]
    sd: tuple[float, ...]
    steps: tuple[Correction, ...]
    all_adjusted: Correction

    def floor(self, sensor: str) -> float:
        """Return the standard deviation that remains with all parameters changed. [unit of the sensor]"""
        return self.all_adjusted.sd[self.sensors.index(sensor)]

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file, with six digits, which no order of summation changes."""

        def by_sensor(values: Sequence[float]) -> dict[str, float]:
            return {name: float(f"{v:.6g}") for name, v in zip(self.sensors, values, strict=True)}

        return {
            "sd": by_sensor(self.sd),
            "steps": [
                {
                    "path": step.paths[-1],
                    "changes": {p: float(f"{c:.6g}") for p, c in zip(step.paths, step.changes, strict=True)},
                    "sd": by_sensor(step.sd),
                }
                for step in self.steps
            ],
            "all_parameters": {
                "parameters": len(self.all_adjusted.paths),
                "sd": by_sensor(self.all_adjusted.sd),
            },
        }


def find_error_sources(
    residuals: Mapping[str, ArrayLike],
    effects: Mapping[str, ArrayLike],
    *,
    standard_uncertainty: Sequence[float],
    allowed: Mapping[str, tuple[float, float]],
    days: ArrayLike,
    weight: float = 1.0,
) -> ErrorSources:
    """Find the parameters that explain the remaining error of a model.

    Parameters
    ----------
    residuals : mapping of str to array_like, shape (n,)
        Simulated minus measured by sensor, NaN where there is none. [unit of each]
    effects : mapping of str to array_like, shape (n, S)
        Change of the simulated series from the low to the high end of the range of a parameter. [unit of
        each]
    standard_uncertainty : sequence of float, length S
        Of each sensor; makes the sensors comparable. [unit of each]
    allowed : mapping of str to (float, float)
        Lowest and highest change of each parameter, in ranges. [-]
    days : array_like, shape (n,)
        Number of the day of each instant.
    weight : float
        Weight of a sample relative to the prior; below one where errors are autocorrelated. [-]

    Returns
    -------
    ErrorSources

    Raises
    ------
    InputError
        The shapes do not match.

    Examples
    --------
    >>> import numpy as np
    >>> day = np.repeat(np.arange(28), 24)
    >>> effect = np.sin(np.arange(day.size) / 12.0 * np.pi)[:, None]
    >>> found = find_error_sources(
    ...     {"air": 0.3 * effect[:, 0]},
    ...     {"absorptance": effect},
    ...     standard_uncertainty=[0.1],
    ...     allowed={"absorptance": (-0.5, 0.5)},
    ...     days=day,
    ... )
    >>> found.steps[0].paths, round(found.steps[0].changes[0], 2)
    (('absorptance',), -0.3)
    """
    equations = _NormalEquations(residuals, effects, standard_uncertainty, allowed, days, weight)
    everything = list(range(len(equations.paths)))
    gain_of_all = equations.gain(everything)
    chosen: list[int] = []
    steps: list[Correction] = []
    gained = 0.0
    while len(chosen) < min(MAX_NAMED, len(everything)):
        gains = {k: equations.gain([*chosen, k]) for k in everything if k not in chosen}
        best = max(gains, key=lambda k: gains[k])
        if gains[best] - gained < _MIN_GAIN_SHARE * gain_of_all or gains[best] <= gained:
            break
        gained = gains[best]
        chosen.append(best)
        steps.append(equations.correction(chosen))
    as_it_is, all_adjusted = tuple(equations.scatter(equations.error)), equations.correction(everything)
    least = min(equations.weighted(correction.sd) for correction in (*steps, all_adjusted))
    if least > (1.0 - _MIN_GAIN_SHARE) * equations.weighted(as_it_is):
        steps = []
    return ErrorSources(tuple(residuals), as_it_is, tuple(steps), all_adjusted)


def explain_missed_aims(
    aims: Iterable[Verdict], sources: ErrorSources, period: str, noise: Mapping[str, float] | None = None
) -> list[str]:
    """Say of each missed aim whether other values of parameters could reach it.

    Parameters
    ----------
    aims : iterable of Verdict
        Desired limits, and the values reached.
    sources : ErrorSources
        From `find_error_sources`.
    period : str
        The period that it was found on.
    noise : mapping of str to float, optional
        White noise of each sensor, which no model takes away. [unit of each]

    Returns
    -------
    list of str
        A sentence for each standard deviation above its limit in that period.

    Examples
    --------
    >>> from mascarin.validation.criteria import Verdict
    >>> found = ErrorSources(("air",), (0.3,), (), Correction(("a",), (0.1,), (0.05,)))
    >>> missed = Verdict("sd", "air", "blind", "sd", 0.3, 0.1, "degC", passed=False)
    >>> explain_missed_aims([missed], found, "blind")[0][:60]
    'air: the standard deviation is 0.300 K, the aim is 0.100 K. '
    """
    sentences = []
    for aim in aims:
        if aim.passed or aim.metric != "sd" or aim.period != period or aim.sensor not in sources.sensors:
            continue
        floor, unit = sources.floor(aim.sensor), aim.unit.replace("degC", "K")
        white = (noise or {}).get(aim.sensor, 0.0)
        if above(white, aim.limit):
            size, _ = beside_limit(white, aim.limit)
            why = f"the white noise of the sensor, {size} {unit}, is above the aim: no model reaches it"
        elif at_most(floor, aim.limit):
            why = "the equations are sufficient, but the identification data do not determine these values"
        else:
            why = (
                "no parameter values reach the aim: the cause is in the equations, the weather data or the "
                "sensor"
            )
        value, limit = beside_limit(aim.value, aim.limit, _DECIMALS)
        remaining, _ = beside_limit(floor, aim.limit, _DECIMALS)
        count = len(sources.all_adjusted.paths)
        adjusted = "the only parameter" if count == 1 else f"all {count} parameters"
        sentences.append(
            f"{aim.sensor}: the standard deviation is {value} {unit}, the aim is {limit} {unit}. With "
            f"{adjusted} adjusted to these days {remaining} {unit} would remain: {why}."
        )
    return sentences


class _NormalEquations:
    """Residuals and effects without their means, and their normal equations for both halves of the weeks."""

    def __init__(
        self,
        residuals: Mapping[str, ArrayLike],
        effects: Mapping[str, ArrayLike],
        standard_uncertainty: Sequence[float],
        allowed: Mapping[str, tuple[float, float]],
        days: ArrayLike,
        weight: float,
    ) -> None:
        error = np.stack([np.asarray(r, dtype=np.float64) for r in residuals.values()], axis=-1)
        self.finite: Flags = np.isfinite(error)
        self.error: Floats = self._centred(error)
        self.paths = tuple(effects)
        self.effects: list[Floats] = []
        for path, effect in effects.items():
            values = np.asarray(effect, dtype=np.float64)
            if values.shape != error.shape:
                raise InputError(
                    f"effect of '{path}': found shape {values.shape}, expected {error.shape}, that of the "
                    "residuals"
                )
            self.effects.append(self._centred(values))
        self.allowed = np.array([allowed[path] for path in self.paths]).reshape(-1, 2)
        piece = (np.asarray(days) // _BLOCK_DAYS) % 2
        # A record shorter than two pieces is divided in the middle.
        if np.ptp(piece) == 0:
            piece = (np.arange(len(error)) >= len(error) // 2).astype(np.int64)
        self.pieces: list[Flags] = [piece == 0, piece == 1]
        self.scale: Floats = np.sqrt(weight) / np.asarray(standard_uncertainty, dtype=np.float64)
        self.normal = [self._normal(use, self.scale) for use in self.pieces]

    def _centred(self, values: Floats) -> Floats:
        """Subtract the mean where something is measured, zero elsewhere, shape (n, S)."""
        count = np.maximum(self.finite.sum(axis=0), 1)
        mean = np.where(self.finite, values, 0.0).sum(axis=0) / count
        centred: Floats = np.where(self.finite, values - mean, 0.0)
        return centred

    def _normal(self, use: Flags, scale: Floats) -> tuple[Floats, Floats]:
        rows = np.empty((len(self.effects), int(use.sum()) * scale.size))
        for row, effect in zip(rows, self.effects, strict=True):
            np.multiply(effect[use], scale, out=row.reshape(-1, scale.size))
        return rows @ rows.T, -rows @ (self.error[use] * scale).ravel()

    def _total(self) -> tuple[Floats, Floats]:
        (first, first_right), (second, second_right) = self.normal
        return first + second, first_right + second_right

    def _changes(self, normal: tuple[Floats, Floats], chosen: list[int]) -> Floats:
        """Return the most probable changes inside the ranges, shape (chosen,)."""
        matrix = normal[0][np.ix_(chosen, chosen)] + np.eye(len(chosen)) / PRIOR**2
        return _lowest(matrix, normal[1][chosen], *self.allowed[chosen].T)

    def gain(self, chosen: list[int]) -> float:
        """Return by how much the changes lower the cost. [-]"""
        matrix, right = self._total()
        c = self._changes((matrix, right), chosen)
        within = matrix[np.ix_(chosen, chosen)] + np.eye(len(chosen)) / PRIOR**2
        return float(2.0 * right[chosen] @ c - c @ within @ c)

    def correction(self, chosen: list[int]) -> Correction:
        """Return the changes, and the error that remains on weeks that were not used to find them."""
        remaining = np.empty_like(self.error)
        for normal, tested in zip(self.normal, reversed(self.pieces), strict=True):
            remaining[tested] = self.error[tested]
            for k, change in zip(chosen, self._changes(normal, chosen), strict=True):
                remaining[tested] += change * self.effects[k][tested]
        changes = self._changes(self._total(), chosen)
        return Correction(
            tuple(self.paths[k] for k in chosen), tuple(map(float, changes)), tuple(self.scatter(remaining))
        )

    def weighted(self, sd: Sequence[float]) -> float:
        """Sum the squares of standard deviations over the uncertainties of the sensors. [-]"""
        return float(np.sum((np.asarray(sd) * self.scale) ** 2))

    def scatter(self, errors: Floats) -> list[float]:
        """Return the standard deviation of each sensor. [unit of each]"""
        count = np.maximum(self.finite.sum(axis=0), 1)
        mean = np.where(self.finite, errors, 0.0).sum(axis=0) / count
        square = np.where(self.finite, (errors - mean) ** 2, 0.0).sum(axis=0) / count
        return [float(value) for value in np.sqrt(square)]


def _lowest(matrix: Floats, right: Floats, low: Floats, high: Floats) -> Floats:
    """Minimize c A c - 2 b c inside a box by coordinate descent; A is positive definite."""
    slope = right.copy()  # b - A c
    # Single numbers of Python: those of numpy take several times as long.
    c, diagonal = [0.0] * len(right), np.diag(matrix).tolist()
    parts = list(zip(diagonal, low.tolist(), high.tolist(), matrix, strict=True))
    for _ in range(_MAX_SWEEPS):
        largest = 0.0
        for k, (curvature, lowest, highest, row) in enumerate(parts):
            moved = min(max(c[k] + slope.item(k) / curvature, lowest), highest) - c[k]
            if moved != 0.0:
                c[k] += moved
                slope -= moved * row
                largest = max(largest, abs(moved))
        if largest < _MAX_CHANGE:
            break
    return np.array(c)
