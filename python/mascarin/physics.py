"""The engine's physics for Python: constants, moist air, the globe thermometer, melting curves.

Formulas and constants are written once, in ``crates/engine/src/physics``; this module hands arrays over.

Relative humidity and dew point are those over water, also below 0 degC, as meteorology measures them. A
relative humidity that is read becomes the dew point of the weather, and comes back from the vapour of a room
unchanged.

References
----------
ASHRAE Handbook of Fundamentals 2017, ch. 1, eqs. 6 and 20; written in
``crates/engine/src/physics/psychrometrics.rs``.
WMO-No. 8, Guide to Instruments and Methods of Observation, vol. I, ch. 4 (over water below 0 degC).
ISO 7726:1998, annex B (globe thermometer; ``globe.rs``).
ICAO Doc 7488, Manual of the ICAO Standard Atmosphere (``standard_air.rs``).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from mascarin import _engine
from mascarin.errors import InputError

__all__ = [
    "AIR_SPECIFIC_HEAT",
    "GRAVITY",
    "KELVIN",
    "LATENT_HEAT",
    "STANDARD_PRESSURE",
    "STEFAN_BOLTZMANN",
    "MeltingCurve",
    "condensing_pressure",
    "dew_point",
    "globe_temperature",
    "humidity_of_dew_point",
    "humidity_ratio",
    "imposed_temperature",
    "law_titles",
    "leakage_air_changes",
    "moist_air",
    "ratio_of_vapour",
    "relative_humidity",
    "saturation_pressure",
    "standard_density",
    "vapour_pressure",
]

Floats = npt.NDArray[np.float64]

STANDARD_PRESSURE: Final = _engine.SEA_LEVEL_PRESSURE
"""Pressure of the standard atmosphere at sea level [Pa]."""
KELVIN: Final = _engine.KELVIN
"""0 degC [K]."""
STEFAN_BOLTZMANN: Final = _engine.STEFAN_BOLTZMANN
"""Stefan-Boltzmann constant [W/(m2 K4)]."""
GRAVITY: Final = _engine.GRAVITY
"""Standard gravity [m/s2]."""
AIR_SPECIFIC_HEAT: Final = _engine.AIR_SPECIFIC_HEAT
"""Specific heat of dry air [J/(kg K)]."""

LATENT_HEAT: Final = _engine.LATENT_HEAT
"""Latent heat of vapour [J/kg]."""

_DRIEST: Final = 0.1
"""A lower relative humidity is read as this: it has no dew point of use [%]."""


def _each(function: Callable[..., Floats], *arguments: npt.ArrayLike) -> Floats:
    """A function of the engine for each element of arrays, broadcast against each other."""
    arrays = np.broadcast_arrays(*(np.asarray(values, dtype=np.float64) for values in arguments))
    flat = (np.ascontiguousarray(values).ravel() for values in arrays)
    return function(*flat).reshape(arrays[0].shape)


def saturation_pressure(temperature: npt.ArrayLike) -> Floats:
    """Pressure of saturated water vapour over water, also below 0 degC.

    Parameters
    ----------
    temperature : array_like
        Temperature. [degC]

    Returns
    -------
    ndarray
        Pressure, with the shape of the temperature. [Pa]

    Examples
    --------
    >>> saturation_pressure([-10.0, 25.0]).round(1).tolist()
    [286.6, 3169.2]
    """
    return _each(_engine.saturation_pressure, temperature)


def vapour_pressure(ratio: npt.ArrayLike, pressure: npt.ArrayLike = STANDARD_PRESSURE) -> Floats:
    """Pressure of the vapour in air with a humidity ratio.

    Parameters
    ----------
    ratio : array_like
        Humidity ratio. [kg/kg]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Pressure of the vapour. [Pa]

    Examples
    --------
    >>> float(vapour_pressure(0.01).round(1))
    1603.4
    """
    return _each(_engine.vapour_pressure, ratio, pressure)


def dew_point(temperature: npt.ArrayLike, relative_humidity: npt.ArrayLike) -> Floats:
    """Dew point over water of air with a relative humidity.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    relative_humidity : array_like
        Relative humidity, taken as at least 0.1. [%]

    Returns
    -------
    ndarray
        Dew point. [degC]

    Examples
    --------
    >>> dew_point([-10.0, 20.0], [100.0, 50.0]).round(2).tolist()
    [-10.0, 9.27]
    """
    share = np.maximum(np.asarray(relative_humidity, dtype=np.float64), _DRIEST) / 100.0
    return _each(_engine.dew_point, saturation_pressure(temperature) * share)


def humidity_ratio(
    temperature: npt.ArrayLike,
    relative_humidity: npt.ArrayLike,
    pressure: npt.ArrayLike = STANDARD_PRESSURE,
) -> Floats:
    """Mass of water vapour for each mass of dry air.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    relative_humidity : array_like
        Relative humidity. [%]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Humidity ratio. [kg/kg]

    Examples
    --------
    >>> float(humidity_ratio(26.0, 80.0).round(4))
    0.017
    """
    vapour = saturation_pressure(temperature) * np.asarray(relative_humidity, dtype=np.float64) / 100.0
    return ratio_of_vapour(vapour, pressure)


def ratio_of_vapour(vapour: npt.ArrayLike, pressure: npt.ArrayLike = STANDARD_PRESSURE) -> Floats:
    """Humidity ratio of air by the pressure of its vapour.

    Parameters
    ----------
    vapour : array_like
        Pressure of the vapour; it counts as at most half of that of the air. [Pa]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Humidity ratio. [kg/kg]

    Examples
    --------
    >>> float(ratio_of_vapour(1603.4).round(4))
    0.01
    """
    return _each(_engine.humidity_ratio, vapour, pressure)


def relative_humidity(
    temperature: npt.ArrayLike, ratio: npt.ArrayLike, pressure: npt.ArrayLike = STANDARD_PRESSURE
) -> Floats:
    """Relative humidity of air with a humidity ratio; above 100 where the air is supersaturated.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    ratio : array_like
        Humidity ratio. [kg/kg]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Relative humidity. [%]

    Examples
    --------
    >>> float(relative_humidity(26.0, humidity_ratio(30.0, 50.0)).round(1))
    63.1
    """
    return 100.0 * vapour_pressure(ratio, pressure) / saturation_pressure(temperature)


def humidity_of_dew_point(temperature: npt.ArrayLike, dew_point: npt.ArrayLike) -> Floats:
    """Relative humidity of air by its dew point, at most 100.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    dew_point : array_like
        Dew point. [degC]

    Returns
    -------
    ndarray
        Relative humidity. [%]

    Examples
    --------
    >>> float(humidity_of_dew_point(30.0, 30.0))
    100.0
    """
    return np.minimum(100.0 * saturation_pressure(dew_point) / saturation_pressure(temperature), 100.0)


def condensing_pressure(temperature: npt.ArrayLike) -> Floats:
    """Pressure from which vapour condenses on a surface: over water, and over ice below 0.01 degC.

    Parameters
    ----------
    temperature : array_like
        Temperature of the surface. [degC]

    Returns
    -------
    ndarray
        Pressure, with the shape of the temperature. [Pa]

    Examples
    --------
    >>> condensing_pressure([-10.0, 25.0]).round(1).tolist()
    [259.9, 3169.2]
    """
    return _each(_engine.condensing_pressure, temperature)


def globe_temperature(
    air: npt.ArrayLike,
    radiant: npt.ArrayLike,
    diameter: npt.ArrayLike = 0.15,
    emissivity: npt.ArrayLike = 0.95,
) -> Floats:
    """Temperature of a black globe in still air.

    Balances radiation with natural convection, ``1.4 (|dT|/D)^0.25`` (ISO 7726:1998, annex B).

    Parameters
    ----------
    air, radiant : array_like
        Air and mean radiant temperature. [degC]
    diameter : array_like
        Diameter of the globe. [m]
    emissivity : array_like
        Long-wave emissivity of the globe. [-]

    Returns
    -------
    ndarray
        Globe temperature. [degC]

    Examples
    --------
    >>> globe_temperature([20.0], [30.0]).round(1).tolist()
    [26.2]
    """
    return _each(_engine.globe_temperature, air, radiant, diameter, emissivity)


def standard_density(altitude: float) -> float:
    """Density of dry air of 15 degC at the pressure of the standard atmosphere.

    Parameters
    ----------
    altitude : float
        Altitude. [m]

    Returns
    -------
    float
        Density. [kg/m3]

    Examples
    --------
    >>> round(standard_density(0.0), 3)
    1.225
    """
    return _engine.standard_density(altitude)


def moist_air(temperature: float, humidity: float, pressure: float) -> tuple[float, float]:
    """Density and specific heat of moist air, for `site.air_density` and `site.air_specific_heat`.

    A mixture of ideal gases; the specific heat is that of a kilogram of the mixture. Relative humidity is
    that over water, also below 0 degC.

    Parameters
    ----------
    temperature : float
        Temperature. [degC]
    humidity : float
        Relative humidity, 0 to 1. [-]
    pressure : float
        Pressure. [Pa]

    Returns
    -------
    tuple of float
        Density [kg/m3] and specific heat [J/(kg K)].

    Raises
    ------
    InputError
        A humidity outside 0 to 1, a temperature outside -45 to 60 degC, a pressure that is not above that of
        the vapour.

    References
    ----------
    ASHRAE Handbook of Fundamentals 2017, ch. 1 (mixture, specific heat of water vapour, eqs. 6 and 20).

    Examples
    --------
    >>> density, heat = moist_air(20, 0.5, 101325)
    >>> round(density, 3), round(heat)
    (1.199, 1012)
    """
    if not -45.0 <= temperature <= 60.0:
        raise InputError(f"temperature: found {temperature:g} degC; expected -45 to 60 degC")
    if not 0.0 <= humidity <= 1.0:
        raise InputError(f"humidity: found {humidity:g}; expected a relative humidity from 0 to 1")
    if pressure <= humidity * float(saturation_pressure(temperature)):
        raise InputError(f"pressure: found {pressure:g} Pa; expected a pressure of moist air [Pa]")
    return _engine.moist_air(temperature, humidity, pressure)


def imposed_temperature(kind: str, numbers: Mapping[str, float], day: float, outdoor_air: float) -> float:
    """Temperature that surroundings impose, by a law of the engine. [degC]

    Parameters
    ----------
    kind : str
        The law, such as ``ground``.
    numbers : mapping of str to float
        Its numbers, in their units.
    day : float
        Day of the year. [d]
    outdoor_air : float
        Outdoor air. [degC]

    Examples
    --------
    >>> numbers = {"mean": 12.0, "amplitude": 4.0, "coldest_day": 30.0}
    >>> round(imposed_temperature("ground", numbers, 30.0, 0.0), 6)
    8.0
    """
    try:
        return _engine.imposed(kind, list(numbers.items()), day, outdoor_air)[0]
    except _engine.EngineInputError as error:
        raise InputError(f"imposed temperature: {error}") from None


def leakage_air_changes(kind: str, numbers: Mapping[str, float], wind: float, difference: float) -> float:
    """Air changes of infiltration by a pressure test, by a law of the engine. [1/h]

    Parameters
    ----------
    kind : str
        The law, such as ``factor``.
    numbers : mapping of str to float
        Its numbers, in their units.
    wind : float
        Wind speed at the mast. [m/s]
    difference : float
        Air of the zone minus outdoor air. [K]

    Examples
    --------
    >>> round(leakage_air_changes("factor", {"n50": 2.0, "factor": 0.07}, 4.0, 10.0), 6)
    0.14
    """
    try:
        return _engine.leakage_air_changes(kind, list(numbers.items()), wind, -difference)
    except _engine.EngineInputError as error:
        raise InputError(f"pressure test: {error}") from None


def law_titles(family: str) -> dict[str, str]:
    """Return the titles of published laws in reports, by their kinds.

    Parameters
    ----------
    family : str
        ``convection``, ``sky``, ``diffuse``, ``leakage``, ``imposed`` or ``sorption``.

    Examples
    --------
    >>> law_titles("convection")["tarp"]
    'TARP'
    """
    rows = json.loads(_engine.law_table())[family]
    return {row["kind"]: row["title"] + (", with clouds" if row["clouds"] else "") for row in rows}


class MeltingCurve:
    """Liquid fraction over temperature by a law of the engine.

    Parameters
    ----------
    kind : str
        Law, as descriptions of the engine name it: tanh_width, smooth_step, gaussian, gumbel, linear,
        triangle or fractions.
    numbers : mapping of str to float
        Its parameters by name, such as ``melting_temperature`` [degC] and ``width`` [K].
    shape : mapping of str to object
        What else the law has: ``continuity``, ``tail``, or the points of a table.

    Examples
    --------
    >>> curve = MeltingCurve("tanh_width", {"melting_temperature": 25.0, "width": 2.0})
    >>> curve([25.0, 27.0]).round(3).tolist()
    [0.5, 0.881]
    >>> [round(end, 1) for end in curve.reach]
    [18.1, 31.9]
    """

    def __init__(
        self, kind: str, numbers: Mapping[str, float], shape: Mapping[str, Any] | None = None
    ) -> None:
        positions = {name: position for position, name in enumerate(numbers)}
        self._curve = json.dumps({"kind": kind, **positions, **(shape or {})})
        self._values = np.array(list(numbers.values()), dtype=np.float64)

    def __call__(self, temperature: npt.ArrayLike) -> Floats:
        """Liquid fraction at temperatures [degC], with their shape. [-]"""
        array = np.asarray(temperature, dtype=np.float64)
        flat = np.ascontiguousarray(array).ravel()
        return _engine.liquid_fraction(self._curve, self._values, flat).reshape(array.shape)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, without a thousandth of the transition at tails [degC]."""
        return _engine.melting_reach(self._curve, self._values)


def __dir__() -> list[str]:
    """Public names alone, as packages list them."""
    return __all__
