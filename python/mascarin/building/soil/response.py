"""Heat that the outdoor air lets into a ladder of soil, by the weather of years before and during a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building.soil.ladder import SoilLadder

    Array = npt.NDArray[np.float64]

#: Hours of a year, and days. [h], [d]
YEAR_HOURS: Final = 8760
_YEAR_DAYS: Final = 365.0
_HOUR: Final = 3600.0


def heat_of_outdoors(
    ladder: SoilLadder, excess: Array, before: tuple[float, float, float] | None, day: float
) -> Array:
    """Heat into the first cell of a ladder that is held at the temperature behind it. [W/m2]

    The other cells follow the outdoor air; each of their modes is integrated exactly, for air that is linear
    between the hours. What the heat does in the first cell is part of the run.

    Parameters
    ----------
    ladder : SoilLadder
        The row of cells.
    excess : ndarray
        Outdoor air over what lies behind, at each hour. [K]
    before : (float, float, float) or None
        Mean excess, amplitude and coldest day of the year of the outdoor air before the hours begin; None: the first
        year of the hours, again and again. [K], [K], [d]
    day : float
        Day of the year at the first hour. [d]

    Returns
    -------
    ndarray
        At each hour. [W/m2]

    References
    ----------
    Carslaw and Jaeger 1959, Conduction of Heat in Solids, ch. 2.6 (periodic solutions).
    """
    shares, capacities = np.array(ladder.shares), np.array(ladder.capacities)
    heat = shares[0] * excess
    if len(capacities) == 1:
        return np.asarray(heat)
    rates, modes, to_first = _modes(ladder)
    driven = modes.T @ (shares[1:] / np.sqrt(capacities[1:]))
    if before is None:
        year = np.append(excess[:YEAR_HOURS], excess[0])
        start = _periodic(rates, driven, year)
    else:
        start = _swung(rates, driven, before, day)
    for rate, share, weight, first in zip(rates, driven, to_first, start, strict=True):
        heat = heat + weight * _followed(float(rate), share * excess, float(first))
    return np.asarray(heat)


def _modes(ladder: SoilLadder) -> tuple[Array, Array, Array]:
    """Rates [1/s] and modes of the cells behind the first one, and the heat of each into that one."""
    from scipy.linalg import eigh_tridiagonal

    capacities = np.array(ladder.capacities)[1:]
    links = 1.0 / np.array(ladder.resistances)[1:]
    diagonal = (links[:-1] + links[1:]) / capacities
    beside = -links[1:-1] / np.sqrt(capacities[:-1] * capacities[1:])
    rates, modes = eigh_tridiagonal(diagonal, beside)
    return rates, modes, links[0] / np.sqrt(capacities[0]) * modes[0]


def _weights(rate: float) -> tuple[float, float, float]:
    """Of a mode at an hour: that of the hour before, and of what drives it then and now."""
    length = rate * _HOUR
    decay = float(np.exp(-length))
    whole = -float(np.expm1(-length)) / rate
    # Of a straight line from nothing to one.
    if length < 1e-5:
        rising = 0.5 * _HOUR * (1.0 - length / 3.0)
    else:
        rising = (1.0 - whole / _HOUR) / rate
    return decay, whole - rising, rising


def _followed(rate: float, driving: Array, first: float) -> Array:
    """A mode at each hour that starts from a value."""
    from scipy.signal import lfilter

    decay, then, now = _weights(rate)
    change = np.empty_like(driving)
    change[0] = first
    change[1:] = then * driving[:-1] + now * driving[1:]
    return np.asarray(lfilter([1.0], [1.0, -decay], change))


def _periodic(rates: Array, driven: Array, year: Array) -> Array:
    """Modes at the beginning of a year that repeats."""
    ends = [float(_followed(float(rate), share * year, 0.0)[-1]) for rate, share in zip(rates, driven, strict=True)]
    # What a year leaves of a mode is exp(-rate year).
    return np.array(ends) / -np.expm1(-rates * _HOUR * (len(year) - 1))


def _swung(rates: Array, driven: Array, before: tuple[float, float, float], day: float) -> Array:
    """Modes on a day after many years of ``mean - amplitude cos(2 pi (day - coldest)/365)``."""
    mean, amplitude, coldest = before
    speed = 2.0 * np.pi / (_YEAR_DAYS * 86400.0)
    wave = np.exp(1j * speed * 86400.0 * (day - coldest))
    return np.asarray(driven * (mean / rates - amplitude * np.real(wave / (rates + 1j * speed))))
