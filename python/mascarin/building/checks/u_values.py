"""U values and time constants of what is described, with the surface resistances of ISO 6946."""

from __future__ import annotations

import math

from mascarin.building.engine_input.mesh import Mesh
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.convection import is_law
from mascarin.building.parts.envelope.surface import Side, Surface
from mascarin.building.parts.materials.material import Material, Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.building.parts.openings.glazing import glazing_resistance
from mascarin.building.parts.openings.window import (
    Window,
    WindowInside,
    WindowOutside,
    emissivities,
    outer_side,
)

#: Surface resistances of ISO 6946:2017, table 7 [m2 K/W]: heat upwards, horizontal, downwards; and outdoors.
_ISO_UP, _ISO_LEVEL, _ISO_DOWN, _ISO_OUTDOORS = 0.10, 0.13, 0.17, 0.04
#: Wind [m/s] and coefficients of black radiation at 10 and 20 degC [W/(m2 K)] of ISO 6946:2017, annex C.
_WIND, _BLACK_OUTDOORS, _BLACK_INDOORS = 4.0, 5.1, 5.7
_ISO, _DESCRIBED, _NONE, _CLOSED = "ISO 6946", "described", "no", "adiabatic"


def window_u_value(building: Description, window: Window) -> float:
    """Thermal transmittance of a window with its frame, with the surface resistances of ISO 6946.

    Gaps without a given conductance are taken at 0 degC outside and 20 degC inside: conduction of the gas
    and radiation, without convection.

    Parameters
    ----------
    building : Building
        The building.
    window : Window
        One of its windows.

    Returns
    -------
    float
        U value. [W/(m2 K)]
    """
    resistance = glazing_resistance(building.glazings[window.glazing])
    outdoors = building.surfaces[window.surface].outside.outdoors
    glass = 1.0 / ((_ISO_OUTDOORS if outdoors else _ISO_LEVEL) + resistance + _ISO_LEVEL)
    if window.frame is None:
        return glass
    share = float(window.frame.fraction)
    return (1.0 - share) * glass + share * float(window.frame.u_value)


def u_value(building: Description, surface: Surface) -> float:
    """Thermal transmittance between the two sides.

    A surface resistance is taken as described where the coefficient is a constant that includes radiation;
    otherwise it is that of ISO 6946.

    Parameters
    ----------
    building : Building
        The building.
    surface : Surface
        One of its surfaces.

    Returns
    -------
    float
        U value; infinite without any resistance, 0 where a side is adiabatic. [W/(m2 K)]
    """
    layers = building.constructions[surface.construction].layers
    resistance = sum(
        layer_resistance(building.materials[layer.material], layer.thickness) for layer in layers
    )
    resistance += sum(_surface_resistance(building, side, surface)[0] for side in surface.sides)
    return 1.0 / resistance if resistance > 0.0 else math.inf


def described_u_value(building: Description, surface: Surface) -> float:
    """Thermal transmittance between the two sides, by the coefficients that are described.

    Constant coefficients are taken as they are, those by wind at 4 m/s (ISO 6946), correlations and measured
    columns as the convection of ISO 6946. Long-wave exchange is added with the emissivity of the side and a
    black coefficient of 5.7 W/(m2 K) (20 degC) in a zone and 5.1 W/(m2 K) (10 degC) outdoors.

    Parameters
    ----------
    building : Building
        The building.
    surface : Surface
        One of its surfaces.

    Returns
    -------
    float
        U value; infinite without any resistance, 0 where a side is adiabatic. [W/(m2 K)]

    References
    ----------
    ISO 6946:2017, annex C.
    """
    layers = building.constructions[surface.construction].layers
    resistance = sum(
        layer_resistance(building.materials[layer.material], layer.thickness) for layer in layers
    )
    return _inverse(resistance + sum(described_films(building, surface)))


def described_films(building: Description, surface: Surface) -> tuple[float, float]:
    """Surface resistances outside and inside by the coefficients that are described.

    As `described_u_value`; infinite for an adiabatic side, 0 for one without a coefficient.

    Parameters
    ----------
    building : Building
        The building.
    surface : Surface
        One of its surfaces.

    Returns
    -------
    tuple of float
        [m2 K/W]
    """
    outside, inside = (_film(building, side, float(surface.tilt or 0.0)) for side in surface.sides)
    return outside, inside


def _film(building: Description, side: Side, tilt: float) -> float:
    if side.closed:
        return math.inf
    if side.convection is None:
        return 0.0
    emissivity = 0.0 if _without_radiation(building, side) else float(side.emissivity or 0.0)
    coefficient = _coefficient(side, tilt) * float(side.area_factor or 1.0)
    return _inverse(coefficient + emissivity * _black(side))


def described_window_u_value(building: Description, window: Window) -> float:
    """Thermal transmittance of the glass of a window by the coefficients that are described.

    As `described_u_value`; gaps as in `window_u_value`.

    Parameters
    ----------
    building : Building
        The building.
    window : Window
        One of its windows.

    Returns
    -------
    float
        U value without the frame. [W/(m2 K)]
    """
    glazing, wall = building.glazings[window.glazing], building.surfaces[window.surface]
    resistance = glazing_resistance(glazing)
    zone = building.zones[str(wall.inside.zone)]
    if wall.outside.zone is None:
        outside = window.outside.longwave is None or window.outside.longwave.kind != "none"
    else:
        outside = building.zones[wall.outside.zone].longwave.kind != "none"
    exchanged = (outside, zone.longwave.kind != "none")
    both: list[WindowOutside | WindowInside] = [outer_side(window, wall), window.inside]
    for k, side in enumerate(both):
        radiation = float(emissivities(glazing)[k]) * _black(side) if exchanged[k] else 0.0
        resistance += _inverse(_coefficient(side, float(wall.tilt or 0.0)) + radiation)
    return _inverse(resistance)


def _inverse(number: float) -> float:
    return 1.0 / number if number > 0.0 else math.inf


def _black(side: Side | WindowOutside | WindowInside) -> float:
    """Coefficient of black radiation [W/(m2 K)]."""
    return _BLACK_OUTDOORS if side.outdoors else _BLACK_INDOORS


def _coefficient(side: Side | WindowOutside | WindowInside, tilt: float) -> float:
    """Convective coefficient [W/(m2 K)]; that of ISO 6946, annex C, where it is no number."""
    film = side.convection
    if is_law(film, "constant"):
        return float(film.coefficient)
    wind = _WIND if side.outdoors and side.exposed.wind else 0.0
    if is_law(film, "linear_wind"):
        return float(film.constant + film.wind * wind)
    if side.outdoors:
        return 4.0 + 4.0 * wind
    # Heat flows outwards, as in the heating season.
    return 5.0 if tilt < 30.0 else 0.7 if tilt > 150.0 else 2.5


def layer_resistance(material: Material, thickness: float | None) -> float:
    """Thermal resistance of a layer, of a solid phase-change material below its melting. [m2 K/W].

    Parameters
    ----------
    material : Solid, PhaseChangeMaterial or Resistance
        What it is made of.
    thickness : float or None
        Its thickness; None for a resistance. [m]
    """
    if isinstance(material, Resistance):
        return float(material.resistance)
    return (thickness or 0.0) / phase(material.conductivity, "solid")


def _surface_resistance(building: Description, side: Side, surface: Surface) -> tuple[float, str]:
    """Surface resistance [m2 K/W], and where it comes from."""
    if side.closed:
        return math.inf, _CLOSED
    if side.convection is None:
        return 0.0, _NONE
    if is_law(side.convection, "constant") and _without_radiation(building, side):
        conductance = side.convection.coefficient * (side.area_factor or 1.0)
        return (1.0 / conductance if conductance > 0.0 else math.inf), _DESCRIBED
    return _iso_resistance(side, surface), _ISO


def _without_radiation(building: Description, side: Side) -> bool:
    """Whether no radiation is exchanged beside the convection."""
    if side.zone is not None:
        return building.zones[side.zone].longwave.kind == "none"
    return not side.outdoors or (side.longwave is not None and side.longwave.kind == "none")


def resistance_words(building: Description, surface: Surface) -> str:
    """Where the surface resistances in a U value come from, in words."""
    outside, inside = (_surface_resistance(building, side, surface)[1] for side in surface.sides)
    if _CLOSED in (outside, inside):
        return "adiabatic"
    if outside == inside:
        return f"{outside} surface resistances"
    return f"surface resistances: {outside} outside, {inside} inside"


def _iso_resistance(side: Side, surface: Surface) -> float:
    if side.convection is None:
        return 0.0
    if side.outdoors:
        return _ISO_OUTDOORS
    tilt = float(surface.tilt or 0.0)
    # Heat flows outwards, as in the heating season.
    return _ISO_UP if tilt < 30.0 else _ISO_DOWN if tilt > 150.0 else _ISO_LEVEL


def time_constant(building: Description, construction: str, mesh: Mesh) -> float:
    """Smallest time constant of a construction's nodes: heat capacity over the conductances to both sides.

    Parameters
    ----------
    building : Building
        The building.
    construction : str
        Name of the construction.
    mesh : Mesh
        Its nodes.

    Returns
    -------
    float
        Infinite without heat capacity. [s]
    """
    links: list[float] = [0.0]  # resistance between neighboring nodes, first and last to the surfaces
    capacities: list[float] = []
    for layer in building.constructions[construction].layers:
        material, nodes = building.materials[layer.material], mesh.nodes[construction, layer.name]
        if isinstance(material, Resistance):
            links[-1] += float(material.resistance)
            continue
        thickness = (layer.thickness or 0.0) / nodes
        half = 0.5 * thickness / phase(material.conductivity, "solid")
        capacity = phase(material.density, "solid") * phase(material.specific_heat, "solid") * thickness
        for _ in range(nodes):
            links[-1] += half
            capacities.append(capacity)
            links.append(half)
    films = _least_surface_resistances(building, construction)
    links[0], links[-1] = links[0] + films[0], links[-1] + films[1]
    return min(
        (
            capacity / (1.0 / before + 1.0 / after)
            for capacity, before, after in zip(capacities, links, links[1:], strict=False)
        ),
        default=math.inf,
    )


def _least_surface_resistances(building: Description, construction: str) -> tuple[float, float]:
    """Least surface resistance outside and inside over the surfaces of a construction [m2 K/W]."""
    built = [surface for surface in building.surfaces.values() if surface.construction == construction]
    outside = [_nominal_resistance(surface.outside, surface) for surface in built]
    inside = [_nominal_resistance(surface.inside, surface) for surface in built]
    return (min(outside, default=_ISO_OUTDOORS), min(inside, default=_ISO_LEVEL))


def _nominal_resistance(side: Side, surface: Surface) -> float:
    if side.closed:
        return math.inf
    if is_law(side.convection, "constant") and side.convection.coefficient > 0.0:
        return 1.0 / float(side.convection.coefficient)
    return _iso_resistance(side, surface)
