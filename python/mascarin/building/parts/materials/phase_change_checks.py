"""Errors of a phase-change material: falling enthalpy, crossing curves, numbers in another unit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from pydantic_core import InitErrorDetails

from mascarin.building.base.number import Number
from mascarin.building.base.part import Location, fault
from mascarin.building.parts.materials.closed_law import CUT, ClosedLaw
from mascarin.building.parts.materials.melting import Melting
from mascarin.building.parts.materials.phase_change import CapacityLaw, FractionLaw, FractionsLaw, TableLaw
from mascarin.building.parts.materials.phases import phase
from mascarin.physics import KELVIN

Floats = npt.NDArray[np.float64]
_Curve = Callable[[Floats], Floats]

#: Largest relative difference of a latent heat from that of its table [-].
AGREEMENT: Final = 0.10
#: Round-off of a liquid fraction.
_EPSILON: Final = 1e-9
_POINTS: Final = 800
#: (largest or smallest value that can be meant, factor, unit meant, unit written) by property.
_UNIT_ERRORS: Final = {
    "conductivity": (60.0, 1e-3, "W/(m K)", "mW/(m K)"),
    "density": (20.0, 1e3, "kg/m3", "g/cm3"),
    "specific_heat": (50.0, 1e3, "J/(kg K)", "kJ/(kg K)"),
    "latent_heat": (1000.0, 1e3, "J/kg", "kJ/kg"),
}


def missing_or_inactive(material: Melting) -> list[InitErrorDetails]:
    """What the law needs and is not given, and what has no effect beside it."""
    law, kind = material.law, material.law.kind
    table = isinstance(law, TableLaw | CapacityLaw)
    faults = []
    if material.latent_heat is None and not table:
        faults.append(_needed("latent_heat", kind))
    if isinstance(law, ClosedLaw) and material.melting_temperature is None:
        faults.append(_needed("melting_temperature", kind))
    if not isinstance(law, ClosedLaw) and material.melting_temperature is not None:
        faults.append(
            fault(
                ("melting_temperature",),
                f"{material.melting_temperature:g}",
                f"no value: the {kind} law includes the melting temperature",
                "Remove 'melting_temperature:', or vary the law's temperature_shift.",
            )
        )
    return [*faults, *_hysteresis_fits(material)]


def _needed(key: str, kind: str, path: Location = ()) -> InitErrorDetails:
    return fault((*path, key), "nothing", f"{key}: needed by the {kind} law", f"Add '{key}:'.")


def _hysteresis_fits(material: Melting) -> Iterator[InitErrorDetails]:
    law = material.law
    if material.hysteresis is None:
        return
    if isinstance(law, TableLaw | CapacityLaw):
        yield fault(
            ("law",),
            f"the law {law.kind} with hysteresis",
            "a law of the liquid fraction alone: the enthalpy must follow from temperature and fraction",
            "Write 'law: {kind: fractions, temperatures: [...], fractions: [0, ..., 1]}' and 'latent_heat:'.",
        )
        return
    hysteresis = material.two_curves
    if hysteresis is None:
        return
    cooling = hysteresis.law or law
    if isinstance(cooling, FractionsLaw):
        if hysteresis.freezing_temperature is not None:
            yield fault(
                ("hysteresis", "freezing_temperature"),
                f"{hysteresis.freezing_temperature:g}",
                "no value: the fractions law includes the freezing temperature",
                "Remove it, or vary the law's temperature_shift.",
            )
        if hysteresis.law is None:
            yield fault(
                ("hysteresis", "law"),
                "nothing",
                "law: the cooling curve; the fractions above are the heating curve",
                "Add 'law: {kind: fractions, ...}' below hysteresis.",
            )
    elif hysteresis.freezing_temperature is None:
        yield _needed("freezing_temperature", cooling.kind, ("hysteresis",))


# --- units --------------------------------------------------------------------------------------------------


def unit_errors(material: Melting) -> list[InitErrorDetails]:
    """Numbers that no phase-change material has, but would have in another unit."""
    faults = []
    for key in _UNIT_ERRORS:
        held: Any = getattr(material, key)
        if held is None:
            continue
        values = {(): held} if isinstance(held, Number) else {(p,): getattr(held, p) for p in _PHASES}
        faults += [
            _unit_error(key, (key, *part), value)
            for part, value in values.items()
            if _implausible(key, value)
        ]
    law = material.law
    faults += [
        fault(
            path,
            f"{value:g}",
            "a temperature in degC below 200",
            f"{value:g} K are {value - KELVIN:.2f} degC.",
        )
        for path, value in _temperatures(material)
        if value > 200.0
    ]
    if (
        isinstance(law, TableLaw | CapacityLaw)
        and 0.0 < law.rise(*law.melting) < _UNIT_ERRORS["latent_heat"][0]
    ):
        rise = law.rise(*law.melting)
        column = "enthalpies" if isinstance(law, TableLaw) else "capacities"
        unit = "J/kg, not kJ/kg" if column == "enthalpies" else "J/(kg K), not kJ/(kg K)"
        faults.append(
            fault(
                ("law", column),
                f"{rise:g} J/kg over the melting range",
                "at least 1000 J/kg of latent and sensible heat",
                f"Write the table in {unit}.",
            )
        )
    return faults


_PHASES: Final = ("solid", "liquid")


def _temperatures(material: Melting) -> Iterator[tuple[Location, float]]:
    hysteresis = material.two_curves
    if material.melting_temperature is not None:
        yield ("melting_temperature",), material.melting_temperature
    if hysteresis is not None and hysteresis.freezing_temperature is not None:
        yield ("hysteresis", "freezing_temperature"), hysteresis.freezing_temperature
    for path, law in ((("law",), material.law), (("hysteresis", "law"), hysteresis and hysteresis.law)):
        if isinstance(law, TableLaw | CapacityLaw | FractionsLaw):
            yield (*path, "temperatures", 0), law.temperatures[0]


def _implausible(key: str, value: float) -> bool:
    limit = _UNIT_ERRORS[key][0]
    return value > limit if key == "conductivity" else 0.0 < value < limit


def _unit_error(key: str, path: Location, value: float) -> InitErrorDetails:
    limit, factor, unit, other = _UNIT_ERRORS[key]
    side = "at most" if key == "conductivity" else "at least"
    return fault(
        path,
        f"{value:g}",
        f"{side} {limit:g} {unit} in a phase-change material",
        f"{value:g} {other} are {value * factor:g} {unit}.",
    )


# --- enthalpy -----------------------------------------------------------------------------------------------


def falling_enthalpy(material: Melting) -> list[InitErrorDetails]:
    """Temperature at which ``dH/dT = C_s + D xi + xi' (L + D (T - Tr))`` is not positive."""
    curves = _curves(material)
    solid, liquid = material.heat_capacities
    difference = liquid - solid
    latent = solid_density(material) * (material.latent_heat or 0.0)
    for key, (curve, low, high) in curves.items():
        small = (high - low) * 1e-5
        temperature = np.linspace(low, high, _POINTS + 1)
        slope = np.maximum(curve(temperature + small) - curve(temperature - small), 0.0) / (2.0 * small)
        jump = latent + difference * (temperature - material.reference)
        capacity = solid + difference * curve(temperature) + slope * jump
        falls = (capacity <= 0.0) | ((jump <= 0.0) & (len(curves) > 1))
        if not falls.any():
            continue
        k = int(np.argmax(falls))
        text = (
            f"dH/dT = {capacity[k]:.3g} J/(m3 K)" if capacity[k] <= 0.0 else f"{jump[k]:.3g} J/m3 to melt it"
        )
        return [
            fault(
                key,
                f"{text} at {temperature[k]:.2f} degC",
                "an enthalpy that rises with temperature and with the liquid fraction",
                "The difference of the heat capacities exceeds the latent heat over this width: "
                "check specific_heat of both phases, latent_heat and the width.",
            )
        ]
    return []


def no_heat_of_crystallisation(material: Melting) -> list[InitErrorDetails]:
    """A supercooled liquid so cold that it would set no heat free: ``L + (c_l - c_s)(T - Tr)`` below zero."""
    if material.one_curve is None or material.latent_heat is None:
        return []
    coldest = material.one_curve.coldest_liquid(material.reference)
    solid, liquid = (phase(material.specific_heat, name) for name in _PHASES)
    heat = material.latent_heat + (liquid - solid) * (coldest - material.reference)
    if heat > 0.0:
        return []
    return [
        fault(
            ("hysteresis",),
            f"{heat:.3g} J/kg set free by crystallisation at {coldest:.2f} degC",
            "heat that is set free: latent_heat + (c_liquid - c_solid)(T - melting temperature) above zero",
            "Check specific_heat of both phases, latent_heat and the degree of supercooling.",
        )
    ]


def solid_density(material: Melting) -> float:
    """Density of the solid, to which heat per volume refers [kg/m3]."""
    return phase(material.density, "solid")


def contradicted_latent_heat(material: Melting) -> list[InitErrorDetails]:
    """A latent heat that contradicts the table beside it."""
    law = material.law
    if material.latent_heat is None or not isinstance(law, TableLaw | CapacityLaw):
        return []
    low, high = law.melting
    solid, liquid = (heat / solid_density(material) for heat in material.heat_capacities)
    held = law.rise(low, high) - 0.5 * (solid + liquid) * (high - low)
    if abs(material.latent_heat - held) <= AGREEMENT * max(held, 0.0):
        return []
    return [
        fault(
            ("latent_heat",),
            f"{material.latent_heat:g}",
            f"{held:g} J/kg within {100 * AGREEMENT:g} %: the rise of the table between {low:g} and {high:g} "
            f"degC minus the sensible heat of {0.5 * (solid + liquid):g} J/(kg K)",
            "Correct the table, its melting_range, specific_heat, or remove latent_heat: the table is used.",
        )
    ]


# --- two curves ---------------------------------------------------------------------------------------------


def _curves(
    material: Melting,
) -> dict[Location, tuple[_Curve, float, float]]:
    """Heating curve, and the cooling curve if there is one, with the range in which each rises [degC]."""
    if isinstance(material.law, TableLaw | CapacityLaw):
        return {}
    cooling = material.cooling
    if material.one_curve is not None:
        return {("law",): _compact(material.law, material.centre)}
    if cooling is None:
        law, centre = material.law, material.centre
        low, high = law.reach
        if law.tails:  # beyond three times the reach they are negligible
            low, high = 3.0 * low, 3.0 * high
        return {
            ("law",): (lambda temperature: law.fraction(temperature - centre), centre + low, centre + high)
        }
    return {
        ("law",): _compact(material.law, material.centre),
        ("hysteresis",): _compact(*cooling),
    }


def _compact(law: FractionLaw, centre: float) -> tuple[_Curve, float, float]:
    """A curve without its tails, the rest scaled to 0..1, as hysteresis uses it."""
    low, high = law.reach

    def curve(temperature: Floats) -> Floats:
        fraction = law.fraction(temperature - centre)
        return np.clip((fraction - CUT) / (1.0 - 2.0 * CUT), 0.0, 1.0) if law.tails else fraction

    return curve, centre + low, centre + high


def crossing_curves(material: Melting) -> list[InitErrorDetails]:
    """Temperature with more liquid on heating than on cooling: cycles would destroy entropy."""
    if material.cooling is None:
        return []
    (heating, *_), (cooling, *_) = _curves(material).values()
    grid = _grid(material)
    hot, cold = heating(grid), cooling(grid)
    k = int(np.argmax(hot - cold))
    if hot[k] - cold[k] <= _EPSILON:
        return []
    temperature, melted, frozen = grid[k], 100.0 * hot[k], 100.0 * cold[k]
    return [
        fault(
            ("hysteresis",),
            f"{melted:.3g} % liquid on heating and {frozen:.3g} % on cooling at {temperature:.2f} degC",
            "never more liquid on heating than on cooling",
            "Exchange the two curves, lower freezing_temperature, narrow the wider curve, or leave "
            "hysteresis out.",
        )
    ]


def unordered_slopes(material: Melting) -> tuple[float, float] | None:
    """Temperatures at which small cycles of curve_scale would destroy entropy.

    In a cycle between two temperatures melting is proportional to the slope of the heating curve, and
    freezing to that of the cooling curve. Melting is at higher temperatures than freezing where the ratio of
    the slopes rises with temperature (likelihood ratio order of the two curves).

    Returns
    -------
    tuple of float or None
        First and last temperature between which the ratio falls; None where it does not. [degC]
    """
    if material.two_curves is None or material.two_curves.model != "curve_scale" or material.cooling is None:
        return None
    (heating, *_), (cooling, *_) = _curves(material).values()
    grid = _grid(material)
    melts, freezes = np.diff(heating(grid)), np.diff(cooling(grid))
    (h0, h1), (c0, c1) = ((rises[:-1], rises[1:]) for rises in (melts, freezes))
    falls = h1 * c0 - h0 * c1 < -1e-6 * np.maximum(h1 * c0, h0 * c1)
    falls &= np.minimum(np.minimum(c0, c1), h0) > _EPSILON
    temperature = grid[2:][falls]
    return (float(temperature[0]), float(temperature[-1])) if len(temperature) else None


def _grid(material: Melting) -> Floats:
    ends = [end for _, *both in _curves(material).values() for end in both]
    low, high = min(ends), max(ends)
    return np.linspace(low, high, _POINTS + 1)
