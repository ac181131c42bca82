"""Materials, laws of melting and constructions as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping

from mascarin.building.base.part import Part
from mascarin.building.engine_input.ids import Ids, Json, fields_of
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.surface import Construction
from mascarin.building.parts.materials.formula_curve import FormulaCurve
from mascarin.building.parts.materials.history_laws import OneCurveLaw
from mascarin.building.parts.materials.material import Material, PhaseChangeMaterial, VariableSolid
from mascarin.building.parts.materials.phase_change import (
    CapacityLaw,
    FractionsLaw,
    GumbelLaw,
    SmoothStepLaw,
    TableLaw,
    TanhLaw,
)
from mascarin.building.parts.materials.phases import Phases
from mascarin.building.parts.materials.text_law import numbers_of


def describe_material(_: str, material: Material, ids: Ids) -> Json:
    """Describe a material."""
    if isinstance(material, VariableSolid):
        law = numbers_of(material.conductivity, ids, "conductivity.")
        return fields_of(material, ids) | {"conductivity": law}
    if not isinstance(material, PhaseChangeMaterial):
        return fields_of(material, ids)
    properties = {
        key: [ids(f"{key}.solid"), ids(f"{key}.liquid")]
        if isinstance(getattr(material, key), Phases)
        else [ids(key)] * 2
        for key in ("conductivity", "density", "specific_heat")
    }
    return {"kind": "pcm", **properties, "law": _law(material, ids)}


def _law(material: PhaseChangeMaterial, ids: Ids) -> Json:
    law = material.law
    if isinstance(law, TableLaw | CapacityLaw):
        points = (
            {"enthalpies": list(map(float, law.enthalpies))}
            if isinstance(law, TableLaw)
            else {"capacities": list(map(float, law.capacities))}
        )
        return fields_of(law, ids, "law.") | {
            "kind": "tabulated",
            "temperatures": list(map(float, law.temperatures)),
            "points": points,
            "melting_range": list(law.melting),
        }
    latent_heat = ids("latent_heat")
    heating = _melting_curve(law, ids, "law.", "melting_temperature")
    hysteresis = material.hysteresis
    if hysteresis is None:
        return {"kind": "melting", "latent_heat": latent_heat, "curve": heating}
    history = {"kind": "history", "latent_heat": latent_heat, "model": hysteresis.model}
    if isinstance(hysteresis, OneCurveLaw):
        named = fields_of(hysteresis, ids, "hysteresis.")
        numbers = [{"name": name, "value": number} for name, number in named.items()]
        return history | {"curves": [heating], "numbers": numbers}
    shape, prefix = (law, "law.") if hysteresis.law is None else (hysteresis.law, "hysteresis.law.")
    cooling = _melting_curve(shape, ids, prefix, "hysteresis.freezing_temperature")
    return history | {"curves": [heating, cooling], "numbers": []}


def _melting_curve(law: Part, ids: Ids, prefix: str, centre: str) -> Json:
    written = fields_of(law, ids, prefix)
    if isinstance(law, FractionsLaw):
        temperatures, fractions = (list(map(float, column)) for column in (law.temperatures, law.fractions))
        return written | {"temperatures": temperatures, "fractions": fractions}
    written |= {"melting_temperature": ids(centre)}
    if isinstance(law, TanhLaw):
        written["kind"] = "tanh_width" if law.width is not None else "tanh_gamma"
    elif isinstance(law, SmoothStepLaw):
        written["continuity"] = int(law.continuity)
    elif isinstance(law, GumbelLaw):
        written["tail"] = law.tail
    elif isinstance(law, FormulaCurve):
        numbers = [{"name": name, "value": ids(f"{prefix}{name}")} for name in law.numbers]
        written |= {"formula": law.formula, "range": list(law.reach), "numbers": numbers}
    return written


def describe_construction(
    building: Description,
    nodes: Mapping[tuple[str, str], int],
    name: str,
    construction: Construction,
    ids: Ids,
) -> Json:
    """Describe a construction with the finite volumes of its layers."""
    materials = list(building.materials)
    layers = []
    for layer in construction.layers:
        thickness = None if layer.thickness is None else ids(f"layers.{layer.name}.thickness")
        material = materials.index(layer.material)
        layers.append(
            {
                "name": layer.name,
                "material": material,
                "thickness": thickness,
                "nodes": nodes[name, layer.name],
            }
        )
    return {"name": name, "layers": layers}
