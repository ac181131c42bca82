"""Uncertain parameters: their range, their distribution and their search curve in a spectral design."""

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
"""Normal distributions are cut at this number of standard deviations, to avoid values that are not
physical. [-]"""


@dataclass(frozen=True, slots=True)
class Factor:
    """One uncertain parameter.

    Parameters
    ----------
    path : str
        Path of the parameter.
    low, high : float
        Range. For ``normal`` the limits of the central 95 %. [unit]
    unit : str
        Unit of the parameter.
    distribution : str or callable
        - ``uniform``: all values of the range are equally likely.
        - ``sine``: the parameter follows a sine, so that values near both ends are the most frequent ones
          (arcsine distribution); the output of a linear model then has one frequency only.
        - ``log-uniform``: the logarithm is uniform; for parameters that span decades.
        - ``triangular``: most likely in the middle, never at the ends.
        - ``normal``: cut at three standard deviations.
        - a callable: the inverse distribution function on [0, 1].
    group : str, optional
        Name of a group; the parameters of one group are analyzed together and have one index.

    Raises
    ------
    InputError
        A range without a finite low end and a larger finite high end, an unknown distribution, or a
        log-uniform range that is not positive.

    Examples
    --------
    >>> factor = Factor("materials.brick.conductivity", 0.4, 0.9, "W/m.K")
    >>> factor.quantile(np.array([0.0, 0.5, 1.0])).tolist()
    [0.4, 0.65, 0.9]
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

    def curve(self, angle: Floats) -> Floats:
        """Value of the parameter along its search curve.

        For every distribution the curve is even about an angle of pi/2. Its Fourier series, and that of any
        function of this parameter alone, then has cosines of (angle - pi/2) only. The analysis uses this to
        separate a parameter from others that fall on its lines by chance.

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
        """Evaluate the inverse distribution function.

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
    """Make parameters ``x1 ... x<count>`` on [0, 1], for models that scale their inputs themselves."""
    return tuple(Factor(f"x{k + 1}", 0.0, 1.0) for k in range(count))


def check_factors(factors: Sequence[Factor]) -> tuple[Factor, ...]:
    """Check that there are factors and that no two have the same path; return them as a tuple.

    Raises
    ------
    InputError
        No factor, or the path that occurs twice.
    """
    if not factors:
        msg = "a sensitivity analysis needs at least one parameter with a range"
        raise InputError(msg)
    paths: set[str] = set()
    for factor in factors:
        if factor.path in paths:
            msg = f"parameter '{factor.path}' is listed twice"
            raise InputError(msg)
        paths.add(factor.path)
    return tuple(factors)


def grouped(factors: Sequence[Factor]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Return the names of groups in order of appearance, and the group of each factor.

    A factor without a group is a group of its own, with its path as the name.

    Raises
    ------
    InputError
        A group has the path of a parameter as its name.
    """
    names: dict[str, int] = {}
    for factor in factors:
        if factor.group is None and factor.path in {f.group for f in factors}:
            msg = f"'{factor.path}' is the path of a parameter and the name of a group: rename the group"
            raise InputError(msg)
        names.setdefault(factor.group or factor.path, len(names))
    return tuple(names), np.array([names[f.group or f.path] for f in factors], dtype=np.int64)
