"""Enthalpy of a sample over time, and the speed at which a supercooled sample freezes.

A heat flow is integrated over time, not over temperature: where a sample supercools, its temperature rises
while it gives off heat, and where it melts sharply, it warms more slowly than the oven.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Most points of a specific heat over temperature.
_MOST: Final = 4000
#: Liquid fraction at which the growth of crystals is evaluated no further: what is left is noise.
_END: Final = 0.05


@dataclass(frozen=True)
class Course:
    """Temperature and enthalpy of one run over time.

    Attributes
    ----------
    seconds, temperature, enthalpy : ndarray, shape (N,)
        Time [s], temperature [degC], and heat taken up since the first row [J/kg].
    """

    seconds: Array
    temperature: Array
    enthalpy: Array

    def reversed(self) -> Course:
        """The same with the other sign of heat."""
        return replace(self, enthalpy=-self.enthalpy)

    @property
    def _sign(self) -> float:
        return 1.0 if self.temperature[-1] > self.temperature[0] else -1.0

    @property
    def first_passes(self) -> npt.NDArray[np.bool_]:
        """Rows at which a temperature is reached for the first time, shape (N,)."""
        along = self._sign * self.temperature
        return np.concatenate([[True], along[1:] > np.maximum.accumulate(along)[:-1]])

    def specific_heat(self) -> tuple[Array, Array]:
        """Apparent specific heat over a rising temperature.

        Of a temperature that is passed more than once the first time counts; the heat until it is passed
        belongs to the step to the next temperature.

        Returns
        -------
        temperature, heat : ndarray, shape (M,)
            [degC], [J/(kg K)]
        """
        sign, passed = self._sign, self.first_passes
        along, enthalpy = sign * self.temperature[passed], self.enthalpy[passed]
        width = max(float(np.median(np.diff(along))), float(np.ptp(along)) / _MOST)
        grid = np.linspace(along[0], along[-1], max(round(float(np.ptp(along)) / width), 1) + 1)
        heat = sign * np.gradient(np.interp(grid, along, enthalpy), grid)
        order = slice(None) if sign > 0.0 else slice(None, None, -1)
        return (sign * grid)[order], heat[order]

    def liquid_fraction(self, specific_heat: tuple[float, float], latent_heat: float, centre: float) -> Array:
        """Liquid fraction over time of a run that ends solid.

        Parameters
        ----------
        specific_heat : (float, float)
            Of solid and liquid. [J/(kg K)]
        latent_heat : float
            At the temperature ``centre``. [J/kg]
        centre : float
            [degC]

        Returns
        -------
        ndarray, shape (N,)
        """
        solid, liquid = specific_heat
        over = self.temperature - centre
        enthalpy = self.enthalpy - self.enthalpy[-1] + solid * over[-1]
        return np.asarray((enthalpy - solid * over) / (latent_heat + (liquid - solid) * over))


def course_of(seconds: Array, temperature: Array, flow: Array) -> Course:
    """Integrate a heat flow over time.

    Parameters
    ----------
    seconds, temperature, flow : ndarray, shape (N,)
        Time [s], temperature [degC], heat taken up [W/kg].

    Examples
    --------
    >>> course_of(np.array([0.0, 10.0]), np.array([20.0, 21.0]), np.array([200.0, 200.0])).enthalpy
    array([   0., 2000.])
    """
    steps = 0.5 * (flow[1:] + flow[:-1]) * np.diff(seconds)
    return Course(seconds, temperature, np.concatenate([[0.0], np.cumsum(steps)]))


def crystallisation_time(
    course: Course, fraction: Array, nucleation: float, equilibrium: Callable[[Array], Array]
) -> float:
    """Time constant of first-order growth of crystals, ``d xi/dt = -(xi - f(T))/tau``.

    The law is integrated from nucleation until nearly all is solid, so that noise of the signal cancels:
    ``tau = integral of (xi - f(T)) dt / fall of xi``.

    Parameters
    ----------
    course : Course
        The cooling run.
    fraction : ndarray, shape (N,)
        Its liquid fraction.
    nucleation : float
        Temperature at which freezing begins. [degC]
    equilibrium : callable
        Liquid fraction of the melting curve at temperatures [degC].

    Returns
    -------
    float
        [s]

    Raises
    ------
    InputError
        The run does not show the growth.
    """
    begins = int(np.argmin(np.where(course.temperature <= nucleation, np.arange(len(fraction)), np.inf)))
    solid = np.flatnonzero(fraction[begins:] < _END)
    ends = begins + int(solid[0]) if len(solid) else len(fraction) - 1
    excess = fraction[begins : ends + 1] - equilibrium(course.temperature[begins : ends + 1])
    fall = float(fraction[begins] - fraction[ends])
    lag = float(np.trapezoid(excess, course.seconds[begins : ends + 1]))
    if ends - begins < 3 or not (fall > 0.5 and lag > 0.0):
        raise InputError(
            f"supercooling: found {ends - begins} rows from the beginning to the end of freezing, in which "
            f"the liquid fraction falls by {fall:.2f}; expected at least 3 rows and most of the freezing. "
            "Export more rows a second, or write hysteresis: {model: supercooling, degree: ..., "
            "time_constant: ...} by hand"
        )
    return lag / fall
