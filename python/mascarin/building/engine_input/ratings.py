"""Rated values of the windows of a building, from the panes and gaps that a run uses."""

from __future__ import annotations

from dataclasses import dataclass

from mascarin.building.engine_input.description import describe
from mascarin.building.parts.description import Description


@dataclass(frozen=True)
class WindowRating:
    """What the glass of a window is rated at.

    Attributes
    ----------
    u_value : float
        Thermal transmittance. [W/(m2 K)]
    solar_heat_gain : float
        Total solar heat gain at normal incidence. [-]
    transmittance : float
        Solar transmittance at normal incidence. [-]
    diffuse_transmittance : float
        Hemispherical solar transmittance. [-]

    Examples
    --------
    >>> WindowRating(1.1, 0.6, 0.52, 0.45).u_value
    1.1
    """

    u_value: float
    solar_heat_gain: float
    transmittance: float
    diffuse_transmittance: float


def require_accepted(building: Description, step_seconds: float) -> None:
    """Refuse what a run refuses before its first step, as far as it does not depend on the weather.

    The building is described to the engine and compiled as for a run, and what follows from its values is
    worked out once: polygons that enclose no zone, cavities without a height, optics that do not fit.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step of the runs. [s]

    Raises
    ------
    InputError
        As a run has it, with the same words.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> require_accepted(box(), 900.0)
    """
    from mascarin.engine_errors import plan_of, translated  # the engine, which a description needs no more of

    described = describe(building, step_seconds)
    with translated():
        plan_of(described.json).window_ratings(described.values)


def window_ratings(building: Description, step_seconds: float = 900.0) -> dict[str, WindowRating]:
    """U value, solar heat gain and transmittance of the glass of every window, without its frame.

    The engine computes them with the gaps and optics of a run, with glass of 2.5 degC outside and 17.5 degC
    inside and the surface resistances of EN 673 (0.04 and 0.13 m2 K/W). `<window>.solar_transmittance` is the
    transmittance during a run.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step of the runs, for which the building is described to the engine anyhow; ratings do not depend
        on it. [s]

    Returns
    -------
    dict of str to WindowRating
        By name of the window.

    References
    ----------
    EN 673:2011 and EN 410:2011.

    Examples
    --------
    >>> from mascarin.building import load
    >>> from mascarin.verification.bestest.catalogue import CASES
    >>> rating = window_ratings(load(CASES["600"].file))["south_west_window"]
    >>> round(rating.transmittance, 3), round(rating.solar_heat_gain, 2)
    (0.703, 0.76)
    """
    if not building.windows:
        return {}
    from mascarin.engine_errors import plan_of, translated  # the engine, which a description needs no more of

    described = describe(building, step_seconds)
    with translated():
        ratings = plan_of(described.json).window_ratings(described.values)
    return {name: WindowRating(*map(float, row)) for name, row in zip(building.windows, ratings, strict=True)}
