"""What would take the rest of the error away: a parameter that is off, or an equation that is missing.

The error that a fitted model leaves on days that it has not seen is laid over the effects of its parameters,
all sensors at once. Where a few parameters take it away, the identification did not show them; where all of
them together do not, no value helps, and the equations differ. Everything is linear about the fitted model,
and nothing of it goes back into the fit: the days stay blind.

A change has a normal prior about the fitted value, a quarter of its range wide, and stays inside the range.
What it leaves is always told on days that the change was not found on: the record is cut into weeks, and
every other week judges the rest. Where no change makes the error smaller there, none is named.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.validation.criteria import Verdict

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Standard deviation of the prior of a change. [ranges]
PRIOR: Final = 0.25
#: Parameters that are named one after the other, at most.
MOST: Final = 6
#: A parameter is named when it takes away this part at least of what all of them take away, and any at all
#: when some of them take this part of the squared error away where they were not found.
_WORTH: Final = 0.05
#: The search for the best changes ends when none moves by more [ranges], or after so many sweeps.
_STILL: Final = 1e-6
_SWEEPS: Final = 500
#: Length of a piece of the record that is judged by the others. [d]
_PIECE: Final = 7


@dataclass(frozen=True, slots=True)
class Correction:
    """Parameters that are changed together, and what they leave.

    Attributes
    ----------
    paths : tuple of str
        The parameters.
    changes : tuple of float
        By how much each is changed, in ranges: 0.5 is half the way from the low to the high end. [-]
    sd : tuple of float
        Standard deviation of what is left of each sensor, on weeks that the changes were not found on.
        [unit of each]
    """

    paths: tuple[str, ...]
    changes: tuple[float, ...]
    sd: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Shortfall:
    """What is left, and what would take it away.

    Attributes
    ----------
    sensors : tuple of str
        Names.
    sd : tuple of float
        Standard deviation of the error as it is. [unit of each]
    steps : tuple of Correction
        The most telling parameter, then with it the next, and so on; empty where none helps.
    every : Correction
        All parameters together: what the equations can do.
    """

    sensors: tuple[str, ...]
    sd: tuple[float, ...]
    steps: tuple[Correction, ...]
    every: Correction

    def floor(self, sensor: str) -> float:
        """Standard deviation that no change of parameters goes below. [unit of the sensor]"""
        return self.every.sd[self.sensors.index(sensor)]

    def to_dict(self) -> dict[str, Any]:
        """For a JSON file; six digits, which no order of summation changes."""

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
            "every": {"parameters": len(self.every.paths), "sd": by_sensor(self.every.sd)},
        }


def shortfall(
    residuals: Mapping[str, ArrayLike],
    effects: Mapping[str, ArrayLike],
    *,
    uncertainty: Sequence[float],
    room: Mapping[str, tuple[float, float]],
    days: ArrayLike,
    weight: float = 1.0,
) -> Shortfall:
    """Find the parameters that account for what is left.

    Parameters
    ----------
    residuals : mapping of str to array_like, shape (n,)
        Simulated minus measured by sensor, NaN where there is none. [unit of each]
    effects : mapping of str to array_like, shape (n, S)
        Change of the simulated series when a parameter goes through its whole range. [unit of each]
    uncertainty : sequence of float, length S
        Standard deviation of each sensor, which makes them comparable. [unit of each]
    room : mapping of str to (float, float)
        How far down and up each parameter can be changed, in ranges. [-]
    days : array_like, shape (n,)
        Number of the day of each instant.
    weight : float
        What a sample counts against the prior; below one where errors last for many samples. [-]

    Returns
    -------
    Shortfall

    Raises
    ------
    InputError
        Shapes that do not fit.
    """
    fault = _Fault(residuals, effects, uncertainty, room, days, weight)
    everything = list(range(len(fault.paths)))
    gain_of_all = fault.gain(everything)
    chosen: list[int] = []
    steps: list[Correction] = []
    gained = 0.0
    while len(chosen) < min(MOST, len(everything)):
        gains = {k: fault.gain([*chosen, k]) for k in everything if k not in chosen}
        best = max(gains, key=lambda k: gains[k])
        if gains[best] - gained < _WORTH * gain_of_all or gains[best] <= gained:
            break
        gained = gains[best]
        chosen.append(best)
        steps.append(fault.correction(chosen))
    as_it_is, every = tuple(fault.scatter(fault.error)), fault.correction(everything)
    least = min(fault.weighed(found.sd) for found in (*steps, every))
    if least > (1.0 - _WORTH) * fault.weighed(as_it_is):
        steps = []
    return Shortfall(tuple(residuals), as_it_is, tuple(steps), every)


def words(aims: Iterable[Verdict], found: Shortfall, period: str) -> list[str]:
    """What keeps each sensor from its aim.

    Parameters
    ----------
    aims : iterable of Verdict
        What was wanted, and what was reached.
    found : Shortfall
        What would take the rest away.
    period : str
        The period that it was found on.

    Returns
    -------
    list of str
        A sentence for each standard deviation that is larger than wished in that period.
    """
    sentences = []
    for aim in aims:
        if aim.passed or aim.metric != "sd" or aim.period != period or aim.sensor not in found.sensors:
            continue
        floor, unit = found.floor(aim.sensor), aim.unit.replace("degC", "K")
        if floor <= aim.limit:
            why = "the equations can do it, but the days of the identification do not show these values"
        else:
            why = "no values do it: what is missing is in the equations, or in the weather that drives them"
        sentences.append(
            f"{aim.sensor}: the standard deviation is {aim.value:.3f} {unit}, aimed at {aim.limit:g}. "
            f"With all {len(found.every.paths)} parameters adjusted to these days {floor:.3f} {unit} would "
            f"be left: {why}."
        )
    return sentences


class _Fault:
    """Residuals and effects, without their means, and their normal equations week by week."""

    def __init__(
        self,
        residuals: Mapping[str, ArrayLike],
        effects: Mapping[str, ArrayLike],
        uncertainty: Sequence[float],
        room: Mapping[str, tuple[float, float]],
        days: ArrayLike,
        weight: float,
    ) -> None:
        error = np.stack([np.asarray(r, dtype=np.float64) for r in residuals.values()], axis=-1)
        self.known: Flags = np.isfinite(error)
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
        self.room = np.array([room[path] for path in self.paths]).reshape(-1, 2)
        piece = (np.asarray(days) // _PIECE) % 2
        # A record of less than two pieces is cut in the middle.
        if np.ptp(piece) == 0:
            piece = (np.arange(len(error)) >= len(error) // 2).astype(np.int64)
        self.pieces: list[Flags] = [piece == 0, piece == 1]
        self.scale: Floats = np.sqrt(weight) / np.asarray(uncertainty, dtype=np.float64)
        self.normal = [self._normal(use, self.scale) for use in self.pieces]

    def _centred(self, values: Floats) -> Floats:
        """A series less its mean where something is measured, zero elsewhere, shape (n, S)."""
        count = np.maximum(self.known.sum(axis=0), 1)
        mean = np.where(self.known, values, 0.0).sum(axis=0) / count
        centred: Floats = np.where(self.known, values - mean, 0.0)
        return centred

    def _normal(self, use: Flags, scale: Floats) -> tuple[Floats, Floats]:
        rows = np.array([(effect[use] * scale).ravel() for effect in self.effects]).reshape(
            len(self.effects), int(use.sum()) * scale.size
        )
        return rows @ rows.T, -rows @ (self.error[use] * scale).ravel()

    def _whole(self) -> tuple[Floats, Floats]:
        (first, right), (second, left) = self.normal
        return first + second, right + left

    def _changes(self, normal: tuple[Floats, Floats], chosen: list[int]) -> Floats:
        """The most probable changes inside the ranges, shape (chosen,)."""
        matrix = normal[0][np.ix_(chosen, chosen)] + np.eye(len(chosen)) / PRIOR**2
        return _lowest(matrix, normal[1][chosen], *self.room[chosen].T)

    def gain(self, chosen: list[int]) -> float:
        """How much the changes lower the cost. [-]"""
        matrix, right = self._whole()
        c = self._changes((matrix, right), chosen)
        within = matrix[np.ix_(chosen, chosen)] + np.eye(len(chosen)) / PRIOR**2
        return float(2.0 * right[chosen] @ c - c @ within @ c)

    def correction(self, chosen: list[int]) -> Correction:
        """The changes, and what they leave where they were not found."""
        left = np.empty_like(self.error)
        for normal, judged in zip(self.normal, reversed(self.pieces), strict=True):
            left[judged] = self.error[judged]
            for k, change in zip(chosen, self._changes(normal, chosen), strict=True):
                left[judged] += change * self.effects[k][judged]
        changes = self._changes(self._whole(), chosen)
        return Correction(
            tuple(self.paths[k] for k in chosen), tuple(map(float, changes)), tuple(self.scatter(left))
        )

    def weighed(self, sd: Sequence[float]) -> float:
        """Sum of the squared standard deviations over the uncertainties of the sensors. [-]"""
        return float(np.sum((np.asarray(sd) * self.scale) ** 2))

    def scatter(self, left: Floats) -> list[float]:
        """Standard deviation of each sensor. [unit of each]"""
        count = np.maximum(self.known.sum(axis=0), 1)
        mean = np.where(self.known, left, 0.0).sum(axis=0) / count
        square = np.where(self.known, (left - mean) ** 2, 0.0).sum(axis=0) / count
        return [float(value) for value in np.sqrt(square)]


def _lowest(matrix: Floats, right: Floats, low: Floats, high: Floats) -> Floats:
    """Where c A c - 2 b c is lowest inside a box, one coordinate after the other; A is positive definite."""
    c = np.zeros(len(right))
    slope = right.copy()  # b - A c
    for _ in range(_SWEEPS):
        largest = 0.0
        for k in range(len(c)):
            moved = min(max(c[k] + slope[k] / matrix[k, k], low[k]), high[k]) - c[k]
            if moved != 0.0:
                c[k] += moved
                slope -= moved * matrix[k]
                largest = max(largest, abs(moved))
        if largest < _STILL:
            break
    return c
