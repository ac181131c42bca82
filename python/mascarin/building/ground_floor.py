"""A floor on the ground by ISO 13370: soil, a resistance below it, and the temperature behind."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final, Literal

from mascarin.building.checks.u_values import layer_resistance
from mascarin.building.ground_slab import SLAB, SOILS, EdgeInsulation, Slab, Soil, require_range
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building.building import Building

#: Density that the heat capacity is divided by [kg/m3]: only the product acts.
_DENSITY: Final = 2000.0
#: Surface resistances inside, downwards, and outside, ISO 6946:2017, table 7 [m2 K/W].
INSIDE_RESISTANCE, OUTSIDE_RESISTANCE = 0.17, 0.04
#: Largest resistance of a surface [m2 K/W]: that of a film of 1 W/(m2 K).
_LARGEST_RESISTANCE: Final = 1.0
#: Soil that is part of the construction [m] (ISO 13370:2017, annex F), and by how much the outdoor swing is
#: late below a slab [d].
_DEPTH, _LAG = 0.5, 365.0 / 12.0


def on_ground(
    building: Building,
    surface: str,
    *,
    area: float,
    perimeter: float | None = None,
    aspect: float | None = None,
    wall_thickness: float,
    mean: float,
    amplitude: float,
    coldest_day: float,
    soil: Literal["clay", "sand", "rock"] | Soil = "sand",
    inside_resistance: float = INSIDE_RESISTANCE,
    outside_resistance: float = OUTSIDE_RESISTANCE,
    edge: EdgeInsulation | None = None,
) -> Building:
    """Put a floor on the ground as ISO 13370 has it for dynamic simulation.

    The construction of the floor gets 0.5 m of soil and a resistance below it, so that its steady
    transmittance is that of the standard; what lies behind has a mean and a swing over the year, with which
    the heat flow by the swing outdoors is that of the standard. Several floors of one slab share its `area`
    and `perimeter`. The joint of wall and floor is a thermal bridge of the zone.

    Parameters
    ----------
    building : Building
        With the floor; what its outside faces is replaced.
    surface : str
        Name of the floor.
    area : float
        Of the whole slab. [m2]
    perimeter : float, optional
        Length of its walls to outdoors. [m]
    aspect : float, optional
        In place of the perimeter: length over width of a rectangle with outdoors on four sides. [-]
    wall_thickness : float
        Of the walls on it. [m]
    mean, amplitude : float
        Yearly mean and amplitude of the outdoor air. [degC], [K]
    coldest_day : float
        Day of the year on which the outdoor air is coldest in the mean. [d]
    soil : {"clay", "sand", "rock"} or Soil
        Kind of soil by table 7 of the standard, or its own numbers.
    inside_resistance, outside_resistance : float
        Of the surfaces of floor and ground, for the transmittance; what acts in a run is the film of the
        floor, and the virtual resistance makes up for no other one: give 1/(convection + radiation) of the
        floor where it is known. 0 outside for ground as warm as the air. [m2 K/W]
    edge : EdgeInsulation, optional
        Along the edge of the slab.

    Returns
    -------
    Building
        Its soil, the resistance and the temperatures are parameters like others.

    Raises
    ------
    InputError
        There is no such floor, a number is out of range, perimeter and aspect are both given or both
        missing, or the slab loses more than 0.5 m of soil let through.

    References
    ----------
    ISO 13370:2017, 7.1 (U value), annex C (periodic heat flow), annex D (edge insulation), annex F (dynamic
    simulation).

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
    ground = _soil(soil)
    _require(building, surface, area, wall_thickness)
    for name, resistance in (("inside", inside_resistance), ("outside", outside_resistance)):
        require_range(f"on_ground: {name}_resistance", resistance, (0.0, _LARGEST_RESISTANCE), "m2 K/W")
    floor = building.surfaces[surface]
    layers = building.constructions[floor.construction].layers
    within = sum(layer_resistance(building.materials[layer.material], layer.thickness) for layer in layers)
    slab = Slab(
        area,
        _perimeter(area, perimeter, aspect),
        wall_thickness,
        ground,
        inside_resistance + within + outside_resistance,
        edge,
    )
    u_value = slab.transmittance
    behind = 1.0 / u_value - inside_resistance - within - _DEPTH / ground.conductivity
    if behind <= 0.0:
        raise InputError(
            f"on_ground: found a slab of U {u_value:.3f} W/(m2 K), which loses more than {_DEPTH:g} m of "
            f"soil of {ground.conductivity:g} W/(m K) let through; expected a slab with insulation, or a "
            "larger one"
        )
    temperature = {
        "mean": {"value": mean, "source": f"{SLAB}: yearly mean outdoors"},
        "amplitude": {
            "value": amplitude * slab.periodic / (area * u_value),
            "source": f"{SLAB}: of the heat flow",
        },
        "coldest_day": (coldest_day + _LAG) % 365.0,
    }
    return _with_soil(building, surface, ground, behind, temperature)


def _with_soil(
    building: Building, surface: str, soil: Soil, behind: float, temperature: dict[str, Any]
) -> Building:
    """Put soil and a resistance below a floor, and the temperature behind them."""
    floor = building.surfaces[surface]
    layers = building.constructions[floor.construction].layers
    names = {key: f"{surface}_{key}" for key in ("soil", "below", "on_ground")}
    lower: list[dict[str, Any]] = [
        {"material": names["below"]},
        {"material": names["soil"], "thickness": _DEPTH},
    ]
    return building.replace(
        {
            f"materials.{names['soil']}": {
                "conductivity": {"value": soil.conductivity, "source": soil.source},
                "density": _DENSITY,
                "specific_heat": {"value": soil.heat_capacity / _DENSITY, "source": soil.source},
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
            f"surfaces.{surface}.outside": {"ground": temperature},
        }
    )


def _soil(soil: str | Soil) -> Soil:
    if isinstance(soil, Soil):
        return soil
    if soil not in SOILS:
        raise InputError(
            f"on_ground: found soil '{soil}', expected one of {', '.join(SOILS)}, or a "
            "mascarin.building.Soil with its own numbers"
        )
    return SOILS[soil]


def _perimeter(area: float, perimeter: float | None, aspect: float | None) -> float:
    """Length of walls to outdoors, given or of a rectangle. [m]"""
    if (perimeter is None) == (aspect is None):
        words = "neither perimeter nor aspect" if perimeter is None else "perimeter and aspect"
        raise InputError(f"on_ground: found {words}, expected one of them")
    if perimeter is not None:
        if not perimeter > 0.0:
            raise InputError(f"on_ground: found perimeter {perimeter:g}, expected a number above 0")
        return perimeter
    require_range("on_ground: aspect", aspect or 0.0, (1.0, 100.0), "-")
    ratio = float(aspect or 1.0)
    return 2.0 * math.sqrt(area) * (math.sqrt(ratio) + 1.0 / math.sqrt(ratio))


def _require(building: Building, surface: str, area: float, wall: float) -> None:
    if surface not in building.surfaces:
        raise InputError(
            f"on_ground: found no surface '{surface}', expected one of {', '.join(building.surfaces)}"
        )
    if not area > 0.0:
        raise InputError(f"on_ground: found area {area:g}, expected a number above 0")
    require_range("on_ground: wall_thickness", wall, (0.0, 3.0), "m")
