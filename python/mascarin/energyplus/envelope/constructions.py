"""Constructions as they are used: as described, or as far as the plane through which no heat flows.

A surface of EnergyPlus that is adiabatic, that names itself as its other side, or that is internal mass has
the temperature of its inner surface on its outer surface as well. Heat then enters from both sides, and in
slow changes none passes a plane in between. The part between that plane and the inside is what the zone
feels: half of a symmetric wall, exactly.
"""

from __future__ import annotations

from typing import Any

from mascarin.building.parts.materials.text_law import ConductivityLaw
from mascarin.energyplus.envelope.materials import VARYING, plain_layers
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

#: Resistance that is insulation [m2 K/W], and the time in which what it hides follows the room [s].
_INSULATION, _SLOW = 0.5, 86400.0
#: Layers below this are left out where a construction is cut [m].
_MIN_THICKNESS = 1e-5


def construction(
    context: Context, item: IdfObject, *, cut: bool, finite_differences: bool, on_soil: bool = False
) -> str:
    """Enter a construction, if it is not there, and return its name.

    Parameters
    ----------
    context : Context
        The conversion.
    item : IdfObject
        The construction of EnergyPlus.
    cut : bool
        Whether only the part inside of the plane without heat flow is wanted.
    finite_differences : bool
        Whether EnergyPlus solves the surface by finite differences.
    on_soil : bool
        Whether it lies on a block of soil.
    """
    melting = finite_differences and _can_melt(context, item)
    original = item.name + (" melting" if melting else "") + (" inner part" if cut else "")
    if on_soil:
        plain = plain_layers(context, item, finite_differences)
        on_soil = light_outside(context, plain) != plain
    original += " on soil" if on_soil else ""
    name = context.names.of("constructions", original)
    held = context.section("constructions")
    if name not in held:
        layers = plain_layers(context, item, finite_differences)
        if cut:
            layers = inner_part(layers, context.section("materials"))
        if on_soil:
            layers = light_outside(context, layers)
        held[name] = {"layers": _named_apart(layers)}
    return name


@reads(*VARYING)
def _can_melt(context: Context, item: IdfObject) -> bool:
    """Whether a layer melts, or conducts by its temperature."""
    properties = context.model.of(*VARYING)
    names = {material_property.name.casefold() for material_property in properties}
    keys = ["outside_layer", *(f"layer_{k}" for k in range(2, 11))]
    return any(item.word(key) in names for key in keys if item.word(key))


def inner_part(layers: list[Section], materials: Section) -> list[Section]:
    """Layers between the plane without heat flow in slow changes of temperature and the inside.

    Where both surfaces change at one rate, ``d/dx (k dT/dx)`` is the heat capacity times that rate: the flux
    grows in proportion to the heat capacity passed, and the temperatures of both surfaces are equal. So the
    plane has on its outer side the fraction of the heat capacity that weighs as much in
    ``integral R(x) dC(x)``: the mean of the resistance from the outside, weighted by the heat capacity, over
    the whole resistance is the fraction of the capacity inside of the plane.

    Parameters
    ----------
    layers : list of dict
        Layers from outside to inside.
    materials : dict
        Their materials.
    """
    held = [_held(layer, materials[layer["material"]]) for layer in layers]
    total_resistance, capacity = sum(r for r, _ in held), sum(c for _, c in held)
    if capacity <= 0.0 or total_resistance <= 0.0:
        return layers
    passed = moment = 0.0
    for resistance, heat in held:
        moment += heat * (passed + 0.5 * resistance)
        passed += resistance
    outer_capacity = capacity * (1.0 - moment / (capacity * total_resistance))
    inner_layers: list[Section] = []
    for layer, (_, heat) in zip(layers, held, strict=True):
        if heat <= outer_capacity:
            outer_capacity -= heat
            if heat == 0.0 and outer_capacity > 0.0:
                continue
            if heat == 0.0:
                inner_layers.append(layer)
            continue
        thickness = float(layer["thickness"]) * (1.0 - outer_capacity / heat)
        outer_capacity = 0.0
        if thickness > _MIN_THICKNESS:
            inner_layers.append(layer | {"thickness": round(thickness, 7)})
    return inner_layers or layers[-1:]


def light_outside(context: Context, layers: list[Section]) -> list[Section]:
    """Layers on soil, of which those outside of insulation store nothing: the soil in their place does.

    Concrete between insulation and soil has the temperature of the soil, of which a block has as much as if
    the construction displaced none.

    Parameters
    ----------
    context : Context
        The conversion, which has their materials.
    layers : list of dict
        Layers from outside to inside.
    """
    materials = context.section("materials")
    numbers = [_held(layer, materials[layer["material"]]) for layer in layers]
    light = []
    for k, (layer, (resistance, heat)) in enumerate(zip(layers, numbers, strict=True)):
        insulation = sum(inner for inner, _ in numbers[k + 1 :])
        if insulation >= _INSULATION and heat * insulation > _SLOW:
            name = context.names.of("materials", f"{layer['material']} {layer['thickness']:g} m on soil")
            materials[name] = {"kind": "resistance", "resistance": round(resistance, 6)}
            layer = {"material": name}
        light.append(layer)
    return light


def _held(layer: Section, material: dict[str, Any]) -> tuple[float, float]:
    """Resistance and heat capacity of a layer, of the solid. [m2 K/W, J/(m2 K)]"""
    if material.get("kind") == "resistance":
        return float(material["resistance"]), 0.0
    solid = [
        value[0] if isinstance(value, list) else _at_20(value) if isinstance(value, dict) else value
        for value in (material[key] for key in ("conductivity", "density", "specific_heat"))
    ]
    thickness = float(layer["thickness"])
    return thickness / solid[0], thickness * solid[1] * solid[2]


def _at_20(law: dict[str, Any]) -> float:
    """Conductivity of a formula at 20 degC. [W/(m K)]"""
    return float(ConductivityLaw(**law).value(20.0))


def _named_apart(layers: list[Section]) -> list[Section]:
    """Layers with names of their own where a material occurs twice, or is called outside or inside."""
    uses: dict[str, int] = {}
    named = []
    for layer in layers:
        material = layer["material"]
        uses[material] = uses.get(material, 0) + 1
        if uses[material] > 1 or material in ("outside", "inside"):
            layer = {"name": f"{material}_layer_{uses[material]}", **layer}
        named.append(layer)
    return named
