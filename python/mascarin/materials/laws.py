"""Laws of melting with a few parameters, fitted to a measured liquid fraction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

Shape = Callable[["Array", tuple[float, ...]], "Array"]


def tanh(t: Array, p: tuple[float, ...]) -> Array:
    """Liquid fraction ``(1 + tanh((T - Tm)/w))/2``."""
    return np.asarray(0.5 + 0.5 * np.tanh((t - p[0]) / p[1]))


def smooth_step(t: Array, p: tuple[float, ...]) -> Array:
    """Cubic between ``Tm - w`` and ``Tm + w``, flat at both ends."""
    u = np.clip((t - p[0] + p[1]) / (2.0 * p[1]), 0.0, 1.0)
    return np.asarray(u * u * (3.0 - 2.0 * u))


def gaussian(t: Array, p: tuple[float, ...]) -> Array:
    """Normal distribution of standard deviation ``w`` about ``Tm``."""
    from scipy.special import ndtr

    return np.asarray(ndtr((t - p[0]) / p[1]))


def gumbel_low(t: Array, p: tuple[float, ...]) -> Array:
    """Gumbel distribution of scale ``w``: peak at ``Tm``, long tail towards low temperatures."""
    return np.asarray(-np.expm1(-np.exp(np.clip((t - p[0]) / p[1], -700.0, 700.0))))


def gumbel_high(t: Array, p: tuple[float, ...]) -> Array:
    """Gumbel distribution with the long tail towards high temperatures."""
    return np.asarray(np.exp(-np.exp(np.clip(-(t - p[0]) / p[1], -700.0, 700.0))))


def linear(t: Array, p: tuple[float, ...]) -> Array:
    """Linear between ``Tm - w`` and ``Tm + w``."""
    return np.asarray(np.clip((t - p[0] + p[1]) / (2.0 * p[1]), 0.0, 1.0))


def triangle(t: Array, p: tuple[float, ...]) -> Array:
    """Latent capacity as a triangle: from ``Tm - below`` to its peak at ``Tm`` and down to ``Tm + above``."""
    centre, below, above = p
    whole = below + above
    rising = np.clip(t - centre + below, 0.0, below) ** 2 / (below * whole)
    falling = np.clip(centre + above - t, 0.0, above) ** 2 / (above * whole)
    return np.asarray(np.where(t <= centre, rising, 1.0 - falling))


@dataclass(frozen=True)
class Law:
    """A shape, and how it is written in a building file."""

    name: str
    shape: Shape
    kind: dict[str, Any]
    keys: tuple[str, ...]


LAWS: Final = (
    Law("tanh", tanh, {"kind": "tanh"}, ("width",)),
    Law("smooth step", smooth_step, {"kind": "smooth_step"}, ("width",)),
    Law("gaussian", gaussian, {"kind": "gaussian"}, ("width",)),
    Law("gumbel, tail low", gumbel_low, {"kind": "gumbel", "tail": "low"}, ("width",)),
    Law("gumbel, tail high", gumbel_high, {"kind": "gumbel", "tail": "high"}, ("width",)),
    Law("linear", linear, {"kind": "linear"}, ("width",)),
    Law("triangle", triangle, {"kind": "triangle"}, ("below", "above")),
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
        return np.asarray(law.shape(t, (float(p[0]), *(math.exp(q) for q in p[1:]))) - measured)

    found = least_squares(error, [middle, *np.log(widths)], x_scale=[width, *[1.0] * len(widths)])
    left, moving = error(found.x), (measured > 1e-3) & (measured < 1.0 - 1e-3)
    return LawFit(
        law,
        float(found.x[0]),
        tuple(math.exp(q) for q in found.x[1:]),
        float(np.sqrt(np.mean(left[moving] ** 2))),
        float(np.abs(left).max()),
    )
