"""Laws of melting with a few parameters, fitted to a measured liquid fraction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.physics import MeltingCurve

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Law:
    """A law of the engine, and how it is written in a building file.

    Attributes
    ----------
    name : str
        Its name in tables.
    curve : str
        Its name in the engine.
    kind : dict
        What it is in a building file.
    keys : tuple of str
        Its widths.
    """

    name: str
    curve: str
    kind: dict[str, Any]
    keys: tuple[str, ...]

    def fraction(self, temperature: Array, melting_temperature: float, widths: Sequence[float]) -> Array:
        """Liquid fraction at temperatures [degC] about a melting temperature [degC], by widths [K]. [-]"""
        numbers = {"melting_temperature": melting_temperature, **dict(zip(self.keys, widths, strict=True))}
        shape = {key: value for key, value in self.kind.items() if key != "kind"}
        if self.curve == "smooth_step":
            shape["continuity"] = 1
        return MeltingCurve(self.curve, numbers, shape)(temperature)


LAWS: Final = (
    Law("tanh", "tanh_width", {"kind": "tanh"}, ("width",)),
    Law("smooth step", "smooth_step", {"kind": "smooth_step"}, ("width",)),
    Law("gaussian", "gaussian", {"kind": "gaussian"}, ("width",)),
    Law("gumbel, tail low", "gumbel", {"kind": "gumbel", "tail": "low"}, ("width",)),
    Law("gumbel, tail high", "gumbel", {"kind": "gumbel", "tail": "high"}, ("width",)),
    Law("linear", "linear", {"kind": "linear"}, ("width",)),
    Law("triangle", "triangle", {"kind": "triangle"}, ("below", "above")),
)


@dataclass(frozen=True)
class LawFit:
    """A law fitted to a measured liquid fraction.

    Attributes
    ----------
    law : Law
        The law.
    melting_temperature : float
        Its Tm [degC].
    widths : tuple of float
        Its widths, in the order of `Law.keys` [K].
    residual : float
        Root mean square difference of the liquid fraction over the range in which it changes [-].
    largest : float
        Largest difference [-].
    """

    law: Law
    melting_temperature: float
    widths: tuple[float, ...]
    residual: float
    largest: float

    def description(self) -> dict[str, Any]:
        """The law as in a building file."""
        widths = {key: round(width, 4) for key, width in zip(self.law.keys, self.widths, strict=True)}
        return self.law.kind | widths


#: Decades by which a width may leave its first guess.
_DECADES: Final = 3.0


def fit(law: Law, temperature: Array, fraction: Array) -> LawFit:
    """Least squares on the liquid fraction, with equal weight for every kelvin.

    Parameters
    ----------
    law : Law
        The law.
    temperature : ndarray, shape (N,)
        Rising [degC].
    fraction : ndarray, shape (N,)
        Measured liquid fraction, rising from 0 to 1 [-].
    """
    from scipy.optimize import least_squares

    t = np.linspace(temperature[0], temperature[-1], 400)
    measured = np.interp(t, temperature, fraction)
    low, middle, high = (float(np.interp(level, fraction, temperature)) for level in (0.1, 0.5, 0.9))
    width = max(0.5 * (high - low), 1e-3)
    widths = [width] if len(law.keys) == 1 else [max(middle - low, 1e-3), max(high - middle, 1e-3)]

    def error(p: Array) -> Array:
        return np.asarray(law.fraction(t, float(p[0]), [math.exp(q) for q in p[1:]]) - measured)

    # A curve that is one step has no width: without bounds the search leaves the numbers.
    start = np.array([middle, *np.log(widths)])
    reach = np.array([float(np.ptp(t)), *[_DECADES * math.log(10.0)] * len(widths)])
    solution = least_squares(
        error, start, x_scale=[width, *[1.0] * len(widths)], bounds=(start - reach, start + reach)
    )
    residuals, moving = error(solution.x), (measured > 1e-3) & (measured < 1.0 - 1e-3)
    return LawFit(
        law,
        float(solution.x[0]),
        tuple(math.exp(q) for q in solution.x[1:]),
        float(np.sqrt(np.mean(residuals[moving] ** 2))),
        float(np.abs(residuals).max()),
    )
