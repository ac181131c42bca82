"""A floor on the ground by ISO 13370: soil, a resistance below it, and the temperature behind."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final, Literal

from mascarin.building.checks.u_values import layer_resistance
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building.building import Building

SLAB = "ISO 13370:2017, slab on ground"

#: Conductivity [W/(m K)] and heat capacity [J/(m3 K)] of soils, ISO 13370:2017, table 7.
_SOILS: Final = {"clay": (1.5, 3.0e6), "sand": (2.0, 2.0e6), "rock": (3.5, 2.0e6)}
#: Density that the heat capacity is divided by [kg/m3]: only the product acts.
_DENSITY: Final = 2000.0
#: Surface resistances inside, downwards, and outside [m2 K/W].
_INSIDE, _OUTSIDE = 0.17, 0.04
#: Soil that is part of the construction [m] (ISO 13370:2017, annex F), and by how much the outdoor swing is
#: late below a slab [d].
_DEPTH, _LAG = 0.5, 365.0 / 12.0
_YEAR = 3.15e7


def on_ground(
    building: Building,
    surface: str,
    *,
    area: float,
    perimeter: float,
    wall_thickness: float,
    mean: float,
    amplitude: float,
    coldest_day: float,
    soil: Literal["clay", "sand", "rock"] = "sand",
) -> Building:
    """Put a floor on the ground as ISO 13370 has it for dynamic simulation.

    The construction of the floor gets 0.5 m of soil and a resistance below it, so that its steady
    transmittance is that of the standard; what lies behind has a mean and a swing over the year, with which
    the heat flow by the swing outdoors is that of the standard. Several floors of one slab share its `area`
    and `perimeter`. Edge insulation and the joint of wall and floor are thermal bridges of the zone.

    Parameters
    ----------
    building : Building
        With the floor; what its outside faces is replaced.
    surface : str
        Name of the floor.
    area, perimeter : float
        Of the whole slab; the perimeter is the length of walls to outdoors. [m2], [m]
    wall_thickness : float
        Of the walls on it. [m]
    mean, amplitude : float
        Yearly mean and amplitude of the outdoor air. [degC], [K]
    coldest_day : float
        Day of the year on which the outdoor air is coldest in the mean. [d]
    soil : {"clay", "sand", "rock"}
        Kind of soil.

    Returns
    -------
    Building
        Its soil, the resistance and the temperatures are parameters like others.

    Raises
    ------
    InputError
        There is no such floor, a number is not above zero, or the slab loses more than 0.5 m of soil let
        through.

    References
    ----------
    ISO 13370:2017, 7.1 (U value), annex C (periodic heat flow), annex F (dynamic simulation).

    Examples
    --------
    >>> from mascarin.building import load
    >>> from mascarin.verification.bestest.catalogue import CASES
    >>> house = on_ground(
    ...     load(CASES["900"].file),
    ...     "floor",
    ...     area=48,
    ...     perimeter=28,
    ...     wall_thickness=0.2,
    ...     mean=9.7,
    ...     amplitude=11,
    ...     coldest_day=15,
    ...     soil="clay",
    ... )
    >>> [layer.material for layer in house.constructions["floor_on_ground"].layers][:2]
    ['floor_below', 'floor_soil']
    """
    _require(building, surface, {"area": area, "perimeter": perimeter}, soil)
    floor = building.surfaces[surface]
    layers = building.constructions[floor.construction].layers
    within = sum(layer_resistance(building.materials[layer.material], layer.thickness) for layer in layers)
    conductivity, capacity = _SOILS[soil]
    u_value, swing = _slab(within, area, perimeter, wall_thickness, (conductivity, capacity))
    behind = 1.0 / u_value - _INSIDE - within - _DEPTH / conductivity
    if behind <= 0.0:
        raise InputError(
            f"on_ground: found a slab of U {u_value:.3f} W/(m2 K), which loses more than {_DEPTH:g} m of "
            f"{soil} let through; expected a slab with insulation, or a larger one"
        )
    names = {key: f"{surface}_{key}" for key in ("soil", "below", "on_ground")}
    lower: list[dict[str, Any]] = [
        {"material": names["below"]},
        {"material": names["soil"], "thickness": _DEPTH},
    ]
    ground = {
        "mean": {"value": mean, "source": f"{SLAB}: yearly mean outdoors"},
        "amplitude": {"value": amplitude * swing / (area * u_value), "source": f"{SLAB}: of the heat flow"},
        "coldest_day": (coldest_day + _LAG) % 365.0,
    }
    return building.replace(
        {
            f"materials.{names['soil']}": {
                "conductivity": {"value": conductivity, "source": SLAB},
                "density": _DENSITY,
                "specific_heat": {"value": capacity / _DENSITY, "source": SLAB},
            },
            f"materials.{names['below']}": {
                "kind": "resistance",
                "resistance": behind,
                "source": f"{SLAB}, virtual layer",
            },
            f"constructions.{names['on_ground']}": {
                "layers": [*lower, *(layer.written() for layer in layers)]
            },
            f"surfaces.{surface}.construction": names["on_ground"],
            f"surfaces.{surface}.outside": {"ground": ground},
        }
    )


def _require(building: Building, surface: str, numbers: Mapping[str, float], soil: str) -> None:
    if surface not in building.surfaces:
        raise InputError(
            f"on_ground: found no surface '{surface}', expected one of {', '.join(building.surfaces)}"
        )
    if soil not in _SOILS:
        raise InputError(f"on_ground: found soil '{soil}', expected one of {', '.join(_SOILS)}")
    for name, number in numbers.items():
        if not number > 0.0:
            raise InputError(f"on_ground: found {name} {number:g}, expected a number above 0")


def _slab(
    within: float, area: float, perimeter: float, wall: float, soil: tuple[float, float]
) -> tuple[float, float]:
    """Transmittance of a slab [W/(m2 K)] and its periodic coefficient by the outdoor air [W/K]."""
    conductivity, capacity = soil
    size = area / (0.5 * perimeter)
    thickness = wall + conductivity * (_INSIDE + within + _OUTSIDE)
    if thickness < size:
        u_value = 2.0 * conductivity / (math.pi * size + thickness)
        u_value *= math.log(math.pi * size / thickness + 1.0)
    else:
        u_value = conductivity / (0.457 * size + thickness)
    depth = math.sqrt(_YEAR * conductivity / (math.pi * capacity))
    return u_value, 0.37 * perimeter * conductivity * math.log(depth / thickness + 1.0)
