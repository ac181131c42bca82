"""Melting from the signal of a calorimeter: sensible heat, liquid fraction, latent heat, onset and end.

The signal becomes an apparent specific heat. Beside the peak it is that of the solid and of the liquid;
below the peak the sensible heat changes from one to the other with the liquid fraction (Hemminger & Sarge
1991, J. Thermal Anal. 37, 1455), so that ``h(T, xi) = c_s (T - Tr) + xi [L + (c_l - c_s)(T - Tr)]`` is valid
for the file as for the engine. The rest is melting.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.materials.dsc_course import Course
from mascarin.materials.dsc_file import Scan
from mascarin.materials.laws import LAWS, LawFit, fit
from mascarin.materials.units import check_heat

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

EDGE: Final = 0.08
"""Fraction of the temperatures at each end without melting, unless a range is given."""
SLOW: Final = 0.5
"""A faster heating rate broadens and shifts the curve; walls change by some kelvins an hour [K/min]."""

TAIL: Final = 0.002
"""Liquid fraction at which melting has started; it is complete this far below one."""


@dataclass(frozen=True)
class MeasuredMelting:
    """Results of one run.

    Attributes
    ----------
    direction : str
        ``heating`` or ``cooling``.
    temperature, fraction : ndarray, shape (N,)
        Liquid fraction over temperature, from 0 to 1 [degC, -].
    heat : ndarray, shape (N,)
        Apparent specific heat, sensible part included [J/(kg K)].
    specific_heat : tuple of float
        Of solid and liquid [J/(kg K)].
    latent_heat : float
        At the temperature at which half is liquid [J/kg].
    onset, peak, end : float
        Extrapolated onset and end (tangents at the steepest flanks), largest specific heat [degC].
    rate : float or None
        Heating rate [K/min].
    fits : tuple of LawFit
        Fitted laws, the best first.
    freezing : (float, float) or None
        Temperature at which a supercooled sample begins to freeze [degC], and rise from there [K].
    course : Course or None
        Temperature and enthalpy over time, where the file has a heat flow and a time.
    """

    direction: str
    temperature: Array
    fraction: Array
    heat: Array
    specific_heat: tuple[float, float]
    latent_heat: float
    onset: float
    peak: float
    end: float
    rate: float | None
    fits: tuple[LawFit, ...]
    freezing: tuple[float, float] | None = None
    course: Course | None = None

    @property
    def half(self) -> float:
        """Temperature at which half is liquid [degC]."""
        return float(np.interp(0.5, self.fraction, self.temperature))

    @property
    def melting_range(self) -> tuple[float, float]:
        """Temperatures at which melting has started and is complete, within `TAIL` [degC]."""
        low, high = np.interp([TAIL, 1.0 - TAIL], self.fraction, self.temperature)
        return float(low), float(high)


def melting_of(
    scan: Scan,
    stated: tuple[float, float] | None,
    span: tuple[float, float] | None,
    where: str,
) -> tuple[MeasuredMelting, list[str]]:
    """Melting of a run, and remarks about it.

    Parameters
    ----------
    scan : Scan
        The run.
    stated : (float, float) or None
        Specific heat of solid and liquid, where the baseline was subtracted. [J/(kg K)]
    span : (float, float) or None
        First and last temperature of melting. [degC]
    where : str
        File, for errors.

    Raises
    ------
    InputError
        There is no peak, or what follows from it is not possible.
    """
    t, heat = scan.temperature, scan.heat
    low, high = _edges(t, span, f"{where}: {scan.direction}")
    solid, liquid = (float(np.median(heat[part])) for part in (t <= low, t >= high))
    height = float(heat.max()) - 0.5 * (solid + liquid)
    if max(abs(solid), abs(liquid)) < 0.02 * height and max(abs(solid), abs(liquid)) < 100.0:
        if stated is None:
            raise InputError(
                f"{where}: {scan.direction}: found no sensible heat beside the peak: the baseline was "
                "subtracted; expected specific_heat=(solid, liquid) in J/(kg K)"
            )
        heat = heat + np.interp(t, [low, high], stated)
        solid, liquid = stated
    for base in (solid, liquid):
        check_heat(base, scan.column, where, scan.factor)
    if not height > 0.2 * max(solid, liquid):
        raise InputError(
            f"{where}: {scan.direction}: found no peak above the sensible heat ({heat.max():.4g} against "
            f"{max(solid, liquid):.4g} J/(kg K)); expected a run through the whole melting range"
        )
    with np.errstate(all="ignore"):  # a curve that cannot be used is refused below
        fraction, latent = _fractions(t, heat, (solid, liquid), (low, high))
    if not (np.isfinite(fraction).all() and math.isfinite(latent) and latent > 0.0):
        raise InputError(
            f"{where}: {scan.direction}: found no latent heat that is positive between {low:.4g} and "
            f"{high:.4g} degC (the signal is {heat.min():.4g} to {heat.max():.4g} J/(kg K)); expected a peak "
            "above the sensible heat of solid and liquid. Remove rows that are wrong, or give melting_range"
        )
    remarks = _remarks(scan, (solid, liquid), (low, high), span, height)
    onset, end = _tangents(t, heat, (solid, liquid))
    fits = tuple(sorted((fit(law, t, fraction) for law in LAWS), key=lambda law_fit: law_fit.residual))
    peak = float(t[np.argmax(heat)])
    melting = MeasuredMelting(
        scan.direction,
        t,
        fraction,
        heat,
        (solid, liquid),
        latent,
        onset,
        peak,
        end,
        scan.rate,
        fits,
        scan.freezing,
        scan.course,
    )
    return melting, remarks


def _remarks(
    scan: Scan,
    heats: tuple[float, float],
    edges: tuple[float, float],
    span: tuple[float, float] | None,
    height: float,
) -> list[str]:
    """Where the file begins or ends inside the melting, and a rate that is too fast."""
    t, heat, (solid, liquid), (low, high) = scan.temperature, scan.heat, heats, edges
    remarks = []
    steepest = 0.03 * height
    for part, name in ((t <= low, "begins"), (t >= high, "ends")):
        if span is None and np.ptp(heat[part]) > steepest + 0.1 * max(solid, liquid):
            remarks.append(
                f"{scan.direction}: the file {name} where the specific heat still changes: latent heat "
                "and tails are uncertain; measure further, or give melting_range"
            )
    if scan.rate is not None and scan.rate > SLOW:
        remarks.append(
            f"{scan.direction}: {scan.rate:g} K/min is faster than in any wall: the sample lags behind the "
            "oven, which broadens the curve and shifts it in the direction of the run; expect a kelvin "
            "or more, and vary temperature_shift or the melting temperature"
        )
    return remarks


def _edges(t: Array, span: tuple[float, float] | None, where: str) -> tuple[float, float]:
    if span is None:
        return float(t[0] + EDGE * np.ptp(t)), float(t[-1] - EDGE * np.ptp(t))
    low, high = span
    if not t[0] < low < high < t[-1]:
        raise InputError(
            f"{where}: melting_range: found {low:g} to {high:g} degC; expected a range inside the file's "
            f"{t[0]:g} to {t[-1]:g} degC"
        )
    return low, high


def _fractions(
    t: Array, heat: Array, heats: tuple[float, float], edges: tuple[float, float]
) -> tuple[Array, float]:
    """Liquid fraction and latent heat by iteration: baseline and fraction depend on each other."""
    solid, liquid = heats
    inside = (t > edges[0]) & (t < edges[1])
    fraction = np.clip((t - edges[0]) / (edges[1] - edges[0]), 0.0, 1.0)
    latent, centre = 1.0, 0.5 * (edges[0] + edges[1])
    for _ in range(100):
        excess = np.where(inside, heat - solid - (liquid - solid) * fraction, 0.0)
        taken = _integral(t, excess)
        before, latent = latent, _latent(t, excess, liquid - solid, centre, max(float(taken[-1]), 1.0))
        rise = np.maximum(excess / (latent + (liquid - solid) * (t - centre)), 0.0)
        grown = _integral(t, rise)
        fraction = grown / grown[-1]
        centre = float(np.interp(0.5, fraction, t))
        if abs(latent - before) < 1e-9 * latent:
            break
    return fraction, latent


def _latent(t: Array, excess: Array, difference: float, centre: float, guess: float) -> float:
    """Latent heat at the centre for which the fraction ends at one."""
    latent = guess
    for _ in range(50):
        share = float(_integral(t, excess / (latent + difference * (t - centre)))[-1])
        latent *= share
        if abs(share - 1.0) < 1e-12:
            break
    return latent


def _integral(t: Array, y: Array) -> Array:
    """Integral from the first point, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(t))])


def _tangents(t: Array, heat: Array, heats: tuple[float, float]) -> tuple[float, float]:
    """Extrapolated onset and end: the steepest tangents of the flanks intersect the sensible heat."""
    # Rows that are much closer than the others, such as those of a hold, have slopes of noise.
    apart = np.concatenate([[True], np.diff(t) > 0.2 * float(np.median(np.diff(t)))])
    t, heat = t[apart], heat[apart]
    slope = np.gradient(heat, t)
    top = int(np.argmax(heat))
    up = int(np.argmax(slope[: top + 1]))
    down = top + int(np.argmin(slope[top:]))
    onset = t[up] - (heat[up] - heats[0]) / slope[up] if slope[up] > 0 else t[0]
    end = t[down] - (heat[down] - heats[1]) / slope[down] if slope[down] < 0 else t[-1]
    return float(max(onset, t[0])), float(min(end, t[-1]))
