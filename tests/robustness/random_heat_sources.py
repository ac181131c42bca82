"""Random heat sources between the layers of a random building."""

from __future__ import annotations

from typing import Any

from random_draw import Draw

Json = dict[str, Any]


def add(draw: Draw, tree: Json) -> None:
    """Put electric mats and pipes of water between layers of some surfaces."""
    if not draw.chance(0.3):
        return
    layered = [name for name, part in sorted(tree["surfaces"].items()) if len(_layers(tree, part)) > 1]
    zones = sorted(tree["zones"])
    schedules, warm = (
        [name for name, part in sorted(tree.get("schedules", {}).items()) if part["kind"] == kind]
        for kind in ("fraction", "temperature")
    )
    sources: Json = {}
    for name in layered[: draw.of(1, 1, 2, 4)]:
        layers = [layer.get("name", layer["material"]) for layer in _layers(tree, tree["surfaces"][name])]
        source: Json = {"surface": name, "after": draw.one(layers[:-1])}
        if draw.chance(0.5):
            source["electric"] = _driven(draw, "power", draw.log(1.0, 150.0), schedules)
        else:
            source["water"] = _water(draw, schedules, warm)
        if draw.chance(0.5):
            source["thermostat"] = {
                "zone": draw.one(zones),
                "setpoint": draw.number(16.0, 28.0),
                "range": draw.of(0.2, 2.0, draw.number(0.5, 6.0)),
                "mode": draw.of("heating", "cooling"),
            }
        if tree.get("controls") and draw.chance(0.3):
            source["control"] = draw.one(sorted(tree["controls"]))
        sources[f"source_{len(sources)}"] = source
    if sources:
        tree["heat_sources"] = sources


def _layers(tree: Json, surface: Json) -> list[Json]:
    layers: list[Json] = tree["constructions"][surface["construction"]]["layers"]
    return layers


def _driven(draw: Draw, key: str, value: float, schedules: list[str]) -> Any:
    if draw.chance(0.2):
        unit = "W/m2" if key == "power" else "kg/h"
        return {"column": "rain", "factor": draw.number(0.5, 20.0), "unit": unit}
    if schedules and draw.chance(0.5):
        return {key: value, "schedule": draw.one(schedules)}
    return value


def _water(draw: Draw, schedules: list[str], warm: list[str]) -> Json:
    supplies = [draw.number(10.0, 50.0), {"column": "rain"}, *({"schedule": name} for name in warm)]
    water: Json = {
        "flow": _driven(draw, "flow", draw.log(1e-3, 0.5), schedules),
        "supply": draw.one(supplies),
    }
    water |= (
        {"conductance": draw.log(0.5, 200.0)}
        if draw.chance(0.6)
        else {"effectiveness": draw.number(0.0, 1.0)}
    )
    if draw.chance(0.2):
        water["specific_heat"] = draw.number(3500.0, 4200.0)
    return water
