"""Heat sources in surfaces as the engine reads them."""

from __future__ import annotations

from mascarin.building.engine_input.air import control_of, driven, set_point
from mascarin.building.engine_input.ids import Ids, Json, Positions, deeper
from mascarin.building.parts.description import Description
from mascarin.building.parts.heat_source import HeatSource


def describe_heat_source(
    building: Description, positions: Positions, name: str, source: HeatSource, ids: Ids
) -> Json:
    """Describe heat in a plane between two layers."""
    surface = building.surfaces[source.surface]
    layers = [layer.name for layer in building.constructions[surface.construction].layers]
    written: Json = {
        "name": name,
        "surface": list(building.surfaces).index(source.surface),
        "layer": layers.index(source.after),
        "means": _means(source, positions, ids),
        **control_of(building, source),
    }
    if source.thermostat is not None:
        inner = deeper(ids, "thermostat")
        written["thermostat"] = {
            "zone": list(building.zones).index(source.thermostat.zone),
            "setpoint": set_point(source.thermostat.setpoint, positions, deeper(inner, "setpoint")),
            "range": inner("range"),
            "cooling": source.thermostat.mode == "cooling",
        }
    return written


def _means(source: HeatSource, positions: Positions, ids: Ids) -> Json:
    path, part = source.driven
    if source.water is None:
        return {"kind": "electric", **driven(part, "power", positions, deeper(ids, path))}
    inner = deeper(ids, "water")
    key = "conductance" if source.water.conductance is not None else "effectiveness"
    return {
        "kind": "water",
        **driven(part, "flow", positions, deeper(ids, path)),
        "supply": set_point(source.water.supply, positions, deeper(inner, "supply")),
        "specific_heat": inner("specific_heat"),
        "exchange": {"kind": key, key: inner(key)},
    }
