"""Opaque materials and constructions, phase change included."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, Final

from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

MATERIALS: Final = (
    "Material",
    "Material:NoMass",
    "Material:AirGap",
    "Material:InfraredTransparent",
    "Material:RoofVegetation",
)
WINDOW_MATERIALS: Final = (
    "WindowMaterial:Glazing",
    "WindowMaterial:Glazing:RefractionExtinctionMethod",
    "WindowMaterial:GlazingGroup:Thermochromic",
    "WindowMaterial:Glazing:EquivalentLayer",
    "WindowMaterial:SimpleGlazingSystem",
    "WindowMaterial:Gas",
    "WindowMaterial:GasMixture",
    "WindowMaterial:Gap",
    "WindowMaterial:Gap:EquivalentLayer",
    "WindowMaterial:Shade",
    "WindowMaterial:Shade:EquivalentLayer",
    "WindowMaterial:Blind",
    "WindowMaterial:Blind:EquivalentLayer",
    "WindowMaterial:Screen",
    "WindowMaterial:Screen:EquivalentLayer",
    "WindowMaterial:Drape:EquivalentLayer",
    "WindowMaterial:ComplexShade",
)


#: Properties without which a material does not melt.
MELTING: Final = ("MaterialProperty:PhaseChange", "MaterialProperty:PhaseChangeHysteresis")
#: Properties of a material that change with temperature, which only finite differences regard.
VARYING: Final = (*MELTING, "MaterialProperty:VariableThermalConductivity")
#: Concrete and surface resistances that EnergyPlus puts into constructions of C and F factors: thickness
#: [m], conductivity [W/(m K)], density [kg/m3], specific heat [J/(kg K)]; inside, outside [m2 K/W]
#: (EnergyPlus Engineering Reference, ground heat transfer calculations using C and F factor constructions).
CONCRETE: Final = (0.15, 1.95, 2240.0, 900.0)
_FILMS: Final = (0.125, 0.03)
#: Resistance of an unexposed F factor floor: 1000 h ft2 degF/Btu, as in EnergyPlus [m2 K/W].
_UNEXPOSED: Final = 177.0
#: Largest resistance of a material of a description [m2 K/W], and number of such layers.
_MAX_RESISTANCE: Final = 100.0
_MAX_LAYERS: Final = 10
#: Distance from a jump of the heat capacity over which it is smoothed, of the shorter interval [-].
_JUMP_WIDTH: Final = 0.25


@reads(*MATERIALS, *WINDOW_MATERIALS)
def layers_of(context: Context, construction: IdfObject) -> list[IdfObject]:
    """Materials of a construction, from outside to inside.

    Raises
    ------
    InputError
        No layer, or a material that does not exist.
    """
    keys = ["outside_layer", *(f"layer_{k}" for k in range(2, 11))]
    kinds = (*MATERIALS, *WINDOW_MATERIALS)
    layers = [context.model.require(construction, key, *kinds) for key in keys if construction.text(key)]
    if not layers:
        raise construction.error("no layer", "a material as Outside Layer", "Name its layers")
    return layers


def plain_layers(context: Context, construction: IdfObject, finite_differences: bool) -> list[Section]:
    """Layers of a construction as the description has them, each with its material entered.

    Parameters
    ----------
    context : Context
        The conversion.
    construction : IdfObject
        The construction.
    finite_differences : bool
        Whether EnergyPlus solves the surface by finite differences, without which it ignores phase change.
    """
    if construction.kind == "Construction:FfactorGroundFloor":
        return _factor_layers(context, construction, *_f_factor(construction))
    if construction.kind == "Construction:CfactorUndergroundWall":
        return _factor_layers(context, construction, *_c_factor(construction))
    layers = [_layer(context, item, finite_differences) for item in layers_of(context, construction)]
    return [layer for parts in layers for layer in parts]


@reads(*MELTING, "MaterialProperty:VariableThermalConductivity")
def _layer(context: Context, item: IdfObject, finite_differences: bool) -> list[Section]:
    source = f"EnergyPlus {item.label}"
    melts = finite_differences and (
        context.model.named(item.name, "MaterialProperty:PhaseChange") is not None
        or context.model.named(item.name, "MaterialProperty:PhaseChangeHysteresis") is not None
    )
    varies = (
        finite_differences
        and context.model.named(item.name, "MaterialProperty:VariableThermalConductivity") is not None
    )
    kind = " melting" if melts else " variable" if varies else ""
    name = context.names.of("materials", item.name + kind)
    materials = context.section("materials")
    thickness = item.number("thickness")
    if name not in materials:
        materials[name] = _material(context, item, melts, varies) | {"source": source}
    if materials[name].get("kind") == "resistance":
        return _resistances(context, item, name)
    return [{"material": name, "thickness": thickness}]


def _resistances(context: Context, item: IdfObject, name: str) -> list[Section]:
    """Layers of a resistance: one, or several equal ones where it is larger than that of a material."""
    material = context.section("materials")[name]
    total = context.resistances.setdefault(name, float(material["resistance"]))
    if total > _MAX_LAYERS * _MAX_RESISTANCE:
        context.findings.no_effect(
            [item],
            f"a resistance of {total:.4g} m2 K/W",
            f"{_MAX_LAYERS * _MAX_RESISTANCE:g} m2 K/W: the heat flow is below 0.05 W/m2",
        )
    count = min(math.ceil(total / _MAX_RESISTANCE), _MAX_LAYERS)
    material["resistance"] = min(total / count, _MAX_RESISTANCE) if count > 1 else total
    return [{"material": name} for _ in range(count)]


def _material(context: Context, item: IdfObject, melts: bool, varies: bool) -> Section:
    if item.kind in ("Material:NoMass", "Material:AirGap"):
        return {"kind": "resistance", "resistance": item.needed("thermal_resistance")}
    if item.kind == "Material:InfraredTransparent":
        context.findings.approximated(
            item, "transparent to infrared", "a layer of small resistance; radiation does not pass it"
        )
        return {"kind": "resistance", "resistance": 0.01}
    keys: tuple[str, ...] = ("conductivity", "density", "specific_heat")
    if item.kind == "Material:RoofVegetation":
        context.findings.left_out(
            item, "plants and moist soil", "only the dry soil is carried over: roofs are warmer in summer"
        )
        keys = tuple(f"{key}_of_dry_soil" for key in keys)
    conductivity, density, heat = (item.needed(key) for key in keys)
    solid = {"conductivity": conductivity, "density": density, "specific_heat": heat}
    variable = _variable_conductivity(context, item) if varies else None
    if variable is not None and melts:
        context.findings.approximated(
            item, "a conductivity that changes with temperature", "of a material that melts: it is constant"
        )
    if not melts:
        return solid if variable is None else solid | {"conductivity": variable}
    hysteresis = context.model.named(item.name, "MaterialProperty:PhaseChangeHysteresis")
    if hysteresis is not None:
        return _two_curves(context, hysteresis)
    table = context.model.require(item, "name", "MaterialProperty:PhaseChange", name=item.name)
    return _enthalpy_table(context, table, solid)


@reads("MaterialProperty:VariableThermalConductivity")
def _variable_conductivity(context: Context, item: IdfObject) -> Section | None:
    """A conductivity that is linear between temperatures, as a formula; None where it is constant."""
    variable = context.model.named(item.name, "MaterialProperty:VariableThermalConductivity")
    if variable is None:
        return None
    pairs = [tuple(row.values()) for row in variable.rows("values") or variable.rows("extensions")]
    if not pairs:
        keys = range(1, 11)
        pairs = [
            (variable.number(f"temperature_{k}"), variable.number(f"thermal_conductivity_{k}")) for k in keys
        ]
    points = [(float(pair[0]), float(pair[1])) for pair in pairs if None not in pair[:2]]
    if not points or any(b[0] <= a[0] for a, b in pairwise(points)):
        raise variable.error(
            f"{len(points)} temperatures", "rising temperatures, each with its conductivity", "Correct them"
        )
    terms = [f"{points[0][1]!r}"]
    for (low, first), (high, last) in pairwise(points):
        terms.append(f"({(last - first) / (high - low)!r})*(min(max(T, {low!r}), {high!r}) - ({low!r}))")
    return {"formula": " + ".join(terms), "source": f"EnergyPlus {variable.label}"}


def _enthalpy_table(context: Context, item: IdfObject, solid: Section) -> Section:
    """A piecewise linear enthalpy as heat capacities with short ramps at its corners.

    EnergyPlus uses the larger of the slope of the table and the specific heat of the material.
    """
    pairs = [(row.get("temperature"), row.get("enthalpy")) for row in item.rows("values")]
    if not pairs:
        keys = range(1, 17)
        pairs = [(item.number(f"temperature_{k}"), item.number(f"enthalpy_{k}")) for k in keys]
    points = [(float(t), float(h)) for t, h in pairs if t is not None and h is not None]
    if len(points) < 2 or any(b[0] <= a[0] for a, b in pairwise(points)):
        raise item.error(
            f"{len(points)} temperatures", "at least 2, rising, each with its enthalpy", "Correct the table"
        )
    if item.number("temperature_coefficient_for_thermal_conductivity"):
        context.findings.approximated(
            item, "temperature coefficient of the conductivity", "the conductivity does not change with it"
        )
    least = float(solid["specific_heat"])
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points)]
    if min(slopes) < least:
        context.findings.approximated(
            item,
            f"slopes below the specific heat of the material, {least:g} J/(kg K)",
            "that specific heat is used there, as EnergyPlus does: the results are those of EnergyPlus",
        )
    knots, heats = _stepped([t for t, _ in points], [max(slope, least) for slope in slopes])
    peak = max(range(len(slopes)), key=lambda k: slopes[k])
    law = {
        "kind": "capacity",
        "temperatures": knots,
        "capacities": heats,
        "melting_range": [points[peak][0], points[peak + 1][0]],
    }
    return {"kind": "pcm", **solid, "law": law}


def _stepped(temperatures: list[float], slopes: list[float]) -> tuple[list[float], list[float]]:
    """Knots of a heat capacity that is constant between the temperatures. [degC, J/(kg K)]"""
    knots, heats = [temperatures[0]], [slopes[0]]
    for k in range(1, len(slopes)):
        width = _JUMP_WIDTH * min(
            temperatures[k] - temperatures[k - 1], temperatures[k + 1] - temperatures[k]
        )
        knots += [temperatures[k] - width, temperatures[k] + width]
        heats += [slopes[k - 1], slopes[k]]
    return [round(t, 6) for t in [*knots, temperatures[-1]]], [round(c, 4) for c in [*heats, slopes[-1]]]


def _two_curves(context: Context, item: IdfObject) -> Section:
    """Melting and freezing curves about their peaks."""
    melting, freezing = item.needed("peak_melting_temperature"), item.needed("peak_freezing_temperature")
    curves = [
        _curve(
            peak,
            item.needed(f"low_temperature_difference_of_{way}_curve"),
            item.needed(f"high_temperature_difference_of_{way}_curve"),
        )
        for way, peak in (("melting", melting), ("freezing", freezing))
    ]
    context.findings.approximated(
        item,
        "hysteresis",
        "the model curve_switch conserves heat, that of EnergyPlus does not where it changes between the "
        "curves (docs/pcm-energyplus.md): results differ in and around the melting range",
    )
    section: Section = {"kind": "pcm"}
    for key in ("conductivity", "density", "specific_heat"):
        ending = "thermal_conductivity" if key == "conductivity" else key
        pair = [item.needed(f"{phase}_state_{ending}") for phase in ("solid", "liquid")]
        section[key] = pair[0] if pair[0] == pair[1] else pair
    section["latent_heat"] = item.needed("latent_heat_during_the_entire_phase_change_process")
    (middle, width), (back, narrow) = curves
    section |= {"melting_temperature": middle, "law": {"kind": "tanh", "width": width}}
    if freezing > melting:
        raise item.error(
            f"a freezing peak of {freezing:g} degC above the melting peak of {melting:g} degC",
            "a freezing peak at or below it",
            "Exchange the two",
        )
    if curves[1] != curves[0]:
        cooling = {"model": "curve_switch", "freezing_temperature": back}
        shape = {} if narrow == width else {"law": {"kind": "tanh", "width": narrow}}
        section["hysteresis"] = cooling | shape
    return section


def _curve(peak: float, low: float, high: float) -> tuple[float, float]:
    """Middle and half-width of a tanh law for exponential flanks about a peak. [degC, K]

    The latent capacity of EnergyPlus is ``exp(-2 |T - Tp|/tau)/tau``, with one ``tau`` below the peak and one
    above it: half of the heat on each side. The law has the same mean and standard deviation; that of
    ``tanh((T - Tm)/w)`` is ``pi w/sqrt(12)``.
    """
    below, above = 0.5 * low, 0.5 * high
    shift = 0.5 * (above - below)
    deviation = math.sqrt(below**2 + above**2 - shift**2)
    return round(peak + shift, 6), round(math.sqrt(12.0) / math.pi * deviation, 6)


def _f_factor(item: IdfObject) -> tuple[float, float]:
    area, edge = item.needed("area"), item.number("perimeterexposed") or 0.0
    factor = item.needed("f_factor")
    if edge <= 0.0 or factor <= 0.0:
        return _UNEXPOSED, 0.0
    return area / (edge * factor) - sum(_FILMS), 0.0


def _c_factor(item: IdfObject) -> tuple[float, float]:
    # Resistance of the soil by the depth of the wall (ASHRAE 90.1-2010, table C6.10.1, as fitted there).
    return 1.0 / item.needed("c_factor") + 0.0607 + 0.3479 * item.needed("height"), 0.0


def _factor_layers(context: Context, item: IdfObject, total_resistance: float, _: float) -> list[Section]:
    thickness, conductivity, density, heat = CONCRETE
    soil_resistance = total_resistance - thickness / conductivity
    if soil_resistance <= 0.0:
        raise item.error(
            f"a resistance of {total_resistance:.3f} m2 K/W",
            f"more than {thickness / conductivity:.3f} m2 K/W, that of the concrete in it",
            "Correct the factor",
        )
    context.findings.approximated(
        item, "a C or F factor", "concrete and a resistance between it and the ground, as in EnergyPlus"
    )
    materials: dict[str, Any] = context.section("materials")
    concrete, soil = (
        context.names.of("materials", "factor concrete"),
        context.names.of("materials", item.name),
    )
    materials[concrete] = {"conductivity": conductivity, "density": density, "specific_heat": heat}
    if soil not in materials:
        materials[soil] = {"kind": "resistance", "resistance": round(soil_resistance, 5)}
    return [*_resistances(context, item, soil), {"material": concrete, "thickness": thickness}]


def skin(context: Context, construction: IdfObject, outer: bool) -> dict[str, Any]:
    """Emissivity, solar absorptance and roughness of a side of a construction."""
    if construction.kind != "Construction":
        return {"emissivity": 0.9, "absorptance": 0.7, "roughness": "medium_rough"}
    layers = layers_of(context, construction)
    item = layers[0 if outer else -1]
    rough = {"veryrough": "very_rough", "mediumrough": "medium_rough", "mediumsmooth": "medium_smooth"}
    rough |= {"verysmooth": "very_smooth"}
    word = item.word("roughness") or "mediumrough"
    emissivity = item.number("thermal_absorptance", "thermal_hemispherical_emissivity")
    absorptance = item.number("solar_absorptance")
    return {
        "emissivity": 0.9 if emissivity is None else max(emissivity, 1e-3),
        "absorptance": 0.7 if absorptance is None else absorptance,
        "roughness": rough.get(word, word),
    }
