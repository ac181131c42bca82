"""Gamma of the tanh law by each published relation, and the width of melting that it gives.

The liquid fraction is ``f(T) = 1/2 + 1/2 tanh(gamma (T - Tm) / (4 dT))``. Only gamma / dT has an
effect; the half-width ``w = 4 dT / gamma`` is the same in kelvins: half of the
melting is within 0.55 w of Tm, 76 % within w, 96 % within 2 w.

References
----------
Guichard, Miranville, Bigot, Malet-Damour, Libelle & Boyer 2016, Energies 9(1), doi:10.3390/en9010009, section
4.4 and equation 3.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name}: found {value!r}, expected a positive number")


def half_width(gamma: float, delta_t: float) -> float:
    """Half-width of melting, 4 dT / gamma.

    Parameters
    ----------
    gamma : float
        Steepness [-].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    float
        Distance from the melting temperature at which the tanh has the argument one [K].
    """
    _positive(gamma=gamma, delta_t=delta_t)
    return 4.0 * delta_t / gamma


def gamma_of_width(width: float, delta_t: float) -> float:
    """Gamma of a half-width, 4 dT / w.

    Parameters
    ----------
    width : float
        Half-width of melting [K].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    float
        Gamma [-].
    """
    _positive(width=width, delta_t=delta_t)
    return 4.0 * delta_t / width


def gamma_equation_3(
    latent_heat: float, specific_heat: float, melting_temperature: float, delta_t: float
) -> float:
    """Gamma by equation 3: L / (c_s (Tm - dT)).

    It divides by a temperature in degC: in kelvins the same material has another gamma.

    Parameters
    ----------
    latent_heat : float
        Latent heat [J/kg].
    specific_heat : float
        Specific heat of the solid [J/(kg K)].
    melting_temperature : float
        Melting temperature, above dT [degC].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    float
        Gamma [-].
    """
    _positive(latent_heat=latent_heat, specific_heat=specific_heat, delta_t=delta_t)
    _positive(melting_temperature=melting_temperature - delta_t)
    return latent_heat / (specific_heat * (melting_temperature - delta_t))


def gamma_from_dsc(
    peak: float, specific_heat: tuple[float, float], latent_heat: float, delta_t: float
) -> float:
    """Gamma with which the capacity at the melting temperature is the peak of a calorimeter's curve.

    The law's capacity there is ``(c_s + c_l) / 2 + L gamma / (8 dT)``.

    Parameters
    ----------
    peak : float
        Largest apparent specific heat of the curve [J/(kg K)].
    specific_heat : tuple of float
        Of the solid and of the liquid [J/(kg K)].
    latent_heat : float
        Latent heat [J/kg].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    float
        Gamma [-].

    Raises
    ------
    InputError
        The peak is not above the mean of the two specific heats.
    """
    solid, liquid = specific_heat
    _positive(peak=peak, solid=solid, liquid=liquid, latent_heat=latent_heat, delta_t=delta_t)
    base = 0.5 * (solid + liquid)
    if peak <= base:
        raise InputError(
            f"peak: found {peak:g} J/(kg K), expected more than the mean {base:g} J/(kg K) of the two "
            "specific heats"
        )
    return (peak - base) * 8.0 * delta_t / latent_heat


def peak_capacity(
    gamma: float, specific_heat: tuple[float, float], latent_heat: float, delta_t: float
) -> float:
    """Largest apparent specific heat of the law: the inverse of `gamma_from_dsc`.

    Parameters
    ----------
    gamma : float
        Steepness [-].
    specific_heat : tuple of float
        Of the solid and of the liquid [J/(kg K)].
    latent_heat : float
        Latent heat [J/kg].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    float
        Apparent specific heat at the melting temperature [J/(kg K)].
    """
    _positive(gamma=gamma, delta_t=delta_t)
    return 0.5 * sum(specific_heat) + latent_heat * gamma / (8.0 * delta_t)


def two_valued_gamma(
    temperature: npt.ArrayLike, melting_temperature: float, delta_t: float, *, near: float, far: float
) -> npt.NDArray[np.float64]:
    """The two-valued gamma: one value within dT of the melting temperature, another beyond.

    With dT = 0.01 K the near value is used in a window of 0.02 K only; a simulation uses the far one.

    Parameters
    ----------
    temperature : array_like, shape (...)
        Temperature [degC].
    melting_temperature : float
        Melting temperature [degC].
    delta_t : float
        Half the window of the near value, and the step that gamma refers to [K].
    near, far : float
        Gamma inside and outside the window [-].

    Returns
    -------
    ndarray, shape (...)
        Gamma at each temperature [-].
    """
    _positive(delta_t=delta_t, near=near, far=far)
    away = np.abs(np.asarray(temperature, dtype=np.float64) - melting_temperature)
    return np.where(away <= delta_t, near, far)


def liquid_fraction(
    temperature: npt.ArrayLike, melting_temperature: float, gamma: npt.ArrayLike, delta_t: float
) -> npt.NDArray[np.float64]:
    """Liquid fraction of the tanh law.

    Parameters
    ----------
    temperature : array_like, shape (...)
        Temperature [degC].
    melting_temperature : float
        Melting temperature [degC].
    gamma : array_like
        Steepness; an array such as `two_valued_gamma` gives is taken point by point [-].
    delta_t : float
        Temperature step that gamma refers to [K].

    Returns
    -------
    ndarray, shape (...)
        Liquid fraction [-].
    """
    _positive(delta_t=delta_t)
    above = np.asarray(temperature, dtype=np.float64) - melting_temperature
    return np.asarray(0.5 + 0.5 * np.tanh(np.asarray(gamma) * above / (4.0 * delta_t)))
