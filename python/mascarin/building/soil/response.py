"""Heat that the outdoor air lets into a ladder of soil, by the weather of years before and during a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.tables.recursion import recursion

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building.soil.ladder import SoilLadder

    Array = npt.NDArray[np.float64]

#: Hours of a year, and seconds of an hour and a day.
YEAR_HOURS: Final = 8760
_HOUR, _DAY = 3600.0, 86400.0


def heat_of_outdoors(
    ladder: SoilLadder, excess: Array, before: tuple[float, float, float] | None, day: float
) -> Array:
    """Heat by the outdoor air into the two innermost cells of a ladder. [W/m2]

    Temperatures are the sum of two: those by the outdoor air with a zone that is as warm as what lies
    behind, and those by the zone. The first are known before a run. Cells of a run have the second, but for
    the innermost one, which has the sum: what couples the two is heat into this cell and the next. So a run
    needs to know nothing of the years before, and a zone that has been what it is at the start is at rest
    with its soil.

    Each mode is integrated exactly, for air that is linear between the hours.

    Parameters
    ----------
    ladder : SoilLadder
        The row of cells.
    excess : ndarray
        Outdoor air over what lies behind, at each hour. [K]
    before : (float, float, float) or None
        Mean excess, amplitude and coldest day of the year of the outdoor air before the hours begin; None:
        the first year of the hours, again and again. [K], [K], [d]
    day : float
        Day of the year at the first hour. [d]

    Returns
    -------
    ndarray, shape (hours, 2)
        Of the innermost cell and of the next one.

    References
    ----------
    Carslaw and Jaeger 1959, Conduction of Heat in Solids, ch. 2.6 (periodic solutions).
    """
    shares, capacities = np.array(ladder.shares), np.array(ladder.capacities)
    link = 1.0 / ladder.resistances[1]
    rates, modes = _modes(ladder)
    driven = modes.T @ (shares / np.sqrt(capacities))
    start = _periodic(rates, driven, excess) if before is None else _swung(rates, driven, before, day)
    first, second = np.zeros_like(excess), np.zeros_like(excess)
    to_first, to_second = (modes[k] / np.sqrt(capacities[k]) for k in (0, 1))
    for k, rate in enumerate(rates):
        mode = _followed(float(rate), driven[k] * excess, float(start[k]))
        first += to_first[k] * mode
        second += to_second[k] * mode
    return np.column_stack([shares[0] * excess + link * second, -link * first])


def _modes(ladder: SoilLadder) -> tuple[Array, Array]:
    """Rates [1/s] and modes of the cells between a zone and what lies behind, both at rest."""
    from scipy.linalg import eigh_tridiagonal

    capacities = np.array(ladder.capacities)
    resistances = np.array(ladder.resistances)
    resistances[0] += 1.0 / ladder.inside
    links = 1.0 / resistances
    diagonal = (links[:-1] + links[1:]) / capacities
    beside = -links[1:-1] / np.sqrt(capacities[:-1] * capacities[1:])
    rates, modes = eigh_tridiagonal(diagonal, beside)
    return np.asarray(rates, dtype=np.float64), np.asarray(modes, dtype=np.float64)


def _weights(rate: float) -> tuple[float, float, float]:
    """Of a mode at an hour: that of the hour before, and of what drives it then and now."""
    length = rate * _HOUR
    constant = -float(np.expm1(-length)) / rate
    # Of a straight line from nothing to one.
    rising = 0.5 * _HOUR * (1.0 - length / 3.0) if length < 1e-5 else (1.0 - constant / _HOUR) / rate
    return float(np.exp(-length)), constant - rising, rising


def _followed(rate: float, driving: Array, first: float) -> Array:
    """A mode at each hour that starts from a value."""
    decay, then, now = _weights(rate)
    change = np.empty_like(driving)
    change[0] = first
    change[1:] = then * driving[:-1] + now * driving[1:]
    return recursion(np.array([decay]), change)


def _periodic(rates: Array, driven: Array, excess: Array) -> Array:
    """Modes at the first hour of air whose first year repeats."""
    year = np.append(excess[:YEAR_HOURS], excess[0])
    modes = zip(rates, driven, strict=True)
    ends = np.array([_followed(float(rate), share * year, 0.0)[-1] for rate, share in modes])
    # What a year leaves of a mode is exp(-rate year).
    return np.asarray(ends / -np.expm1(-rates * _HOUR * (len(year) - 1)))


def _swung(rates: Array, driven: Array, before: tuple[float, float, float], day: float) -> Array:
    """Modes on a day after many years of ``mean - amplitude cos(2 pi (day - coldest)/365)``."""
    mean, amplitude, coldest = before
    speed = 2.0 * np.pi / (365.0 * _DAY)
    wave = np.exp(1j * speed * _DAY * (day - coldest))
    return np.asarray(driven * (mean / rates - amplitude * np.real(wave / (rates + 1j * speed))))
