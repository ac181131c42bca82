"""Uncertain parameters: range, distribution and the way they swing in a spectral design."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.errors import InputError

Floats = NDArray[np.float64]
Quantile = Callable[[Floats], Floats]
"""Inverse distribution function: shape (...) in [0, 1] -> values in the parameter's unit."""

DistributionName = Literal["uniform", "sine", "log-uniform", "triangular", "normal"]
DISTRIBUTIONS: Final = ("uniform", "sine", "log-uniform", "triangular", "normal")

_NORMAL_CUT: Final = 3.0
"""Normal distributions end at so many standard deviations, so that no run gets an absurd value. [-]"""


@dataclass(frozen=True, slots=True)
class Factor:
    """One uncertain parameter.

    Attributes
    ----------
    path : str
        Path of the parameter.
    low, high : float
        Range. For ``normal`` the limits of the central 95 %. [unit]
    unit : str
        Unit of the parameter.
    distribution : str or callable
        - ``uniform``: every value of the range alike.
        - ``sine``: the parameter follows a sine, so that both ends are visited most (the arcsine
          distribution); a linear model then answers at one frequency alone.
        - ``log-uniform``: every ratio alike; for parameters that span decades.
        - ``triangular``: most likely in the middle, never at the ends.
        - ``normal``: cut at three standard deviations.
        - a callable: the inverse distribution function on [0, 1].
    group : str, optional
        Parameters of one group share one frequency and are judged together.
    """

    path: str
    low: float
    high: float
    unit: str = ""
    distribution: DistributionName | Quantile = "uniform"
    group: str | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            msg = (
                f"{self.path}: range [{self.low:g}, {self.high:g}] {self.unit}".rstrip()
                + " must go from a finite low to a larger finite high"
            )
            raise InputError(msg)
        if not callable(self.distribution) and self.distribution not in DISTRIBUTIONS:
            msg = f"{self.path}: distribution '{self.distribution}' is none of {', '.join(DISTRIBUTIONS)}"
            raise InputError(msg)
        if self.distribution == "log-uniform" and self.low <= 0.0:
            msg = f"{self.path}: a log-uniform range must be positive, found a low end of {self.low:g}"
            raise InputError(msg)

    def swing(self, angle: Floats) -> Floats:
        """Value of the parameter along its search curve.

        Whatever the distribution, the curve is even about an angle of pi/2: its Fourier series, and that of
        any function of this parameter alone, then holds cosines of (angle - pi/2) only. The analysis uses
        this to tell a parameter from others that fall on its lines by coincidence.

        Parameters
        ----------
        angle : ndarray
            Frequency times position on the curve plus phase. [rad]

        Returns
        -------
        ndarray
            [unit]
        """
        sine = np.sin(angle)
        if self.distribution == "sine":
            middle, half = 0.5 * (self.low + self.high), 0.5 * (self.high - self.low)
            return np.asarray(middle + half * sine, dtype=np.float64)
        return self.quantile(0.5 + np.arcsin(sine) / np.pi)

    def quantile(self, u: Floats) -> Floats:
        """Inverse distribution function.

        Parameters
        ----------
        u : ndarray
            Probabilities in [0, 1]. [-]

        Returns
        -------
        ndarray
            [unit]
        """
        if callable(self.distribution):
            return np.asarray(self.distribution(u), dtype=np.float64)
        return np.asarray(self._named(self.distribution, u), dtype=np.float64)

    def _named(self, name: DistributionName, u: Floats) -> Floats:
        low, span = self.low, self.high - self.low
        if name == "uniform":
            return low + span * u
        if name == "sine":
            return low + 0.5 * span * (1.0 - np.cos(np.pi * u))
        if name == "log-uniform":
            return np.asarray(low * (self.high / low) ** u)
        if name == "triangular":
            rising = np.sqrt(0.5 * u)
            falling = 1.0 - np.sqrt(0.5 * (1.0 - u))
            return low + span * np.where(u < 0.5, rising, falling)
        from scipy.special import ndtr, ndtri

        tail = ndtr(-_NORMAL_CUT)
        z = ndtri(tail + u * (1.0 - 2.0 * tail))
        return np.asarray(low + span * (0.5 + z / (2.0 * ndtri(0.975))))


def unit_factors(count: int) -> tuple[Factor, ...]:
    """Parameters ``x1 ... x<count>`` on [0, 1], for models that scale their inputs themselves."""
    return tuple(Factor(f"x{k + 1}", 0.0, 1.0) for k in range(count))


def check_factors(factors: Sequence[Factor]) -> tuple[Factor, ...]:
    """The factors as a tuple, refused when there is none or when two have the same path.

    Raises
    ------
    InputError
        With the path that stands twice.
    """
    if not factors:
        msg = "a sensitivity analysis needs at least one parameter with a range"
        raise InputError(msg)
    seen: set[str] = set()
    for factor in factors:
        if factor.path in seen:
            msg = f"parameter '{factor.path}' is listed twice"
            raise InputError(msg)
        seen.add(factor.path)
    return tuple(factors)


def grouped(factors: Sequence[Factor]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Names of what is judged, in order of appearance, and which of them each factor belongs to.

    Raises
    ------
    InputError
        When a group bears the path of a parameter.
    """
    names: dict[str, int] = {}
    for factor in factors:
        if factor.group is None and factor.path in {f.group for f in factors}:
            msg = f"'{factor.path}' is the path of a parameter and the name of a group: rename the group"
            raise InputError(msg)
        names.setdefault(factor.group or factor.path, len(names))
    return tuple(names), np.array([names[f.group or f.path] for f in factors], dtype=np.int64)
