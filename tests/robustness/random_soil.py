"""Random blocks of soil below a random building: most are strips, which are reduced in no time."""

from __future__ import annotations

from typing import Any

from random_draw import Draw

Json = dict[str, Any]


def add(draw: Draw, tree: Json) -> None:
    """Put a floor or wall that faces nothing, or ground, on a block of soil."""
    if not draw.chance(0.12):
        return
    may = [
        name
        for name, part in sorted(tree["surfaces"].items())
        if {"adiabatic", "ground"} & set(part["outside"]) and "zone" in part["inside"]
    ]
    if not may or "air_temperature" in tree.get("weather", {}).get("columns", {}):
        return
    block: Json = {
        "width": draw.number(2.0, 12.0),
        "wall_thickness": draw.number(0.1, 0.5),
        "conductivity": draw.number(0.5, 3.0),
        "heat_capacity": draw.number(1e6, 4e6),
        "before": {
            "mean": draw.number(0.0, 20.0),
            "amplitude": draw.number(0.0, 15.0),
            "coldest_day": draw.number(0.0, 365.0),
        },
    }
    if draw.chance(0.7):
        block["deep_temperature"] = draw.number(4.0, 18.0)
    if draw.chance(0.3):
        block |= {"far": draw.number(3.0, 25.0), "depth": draw.number(6.0, 25.0)}
    if draw.chance(0.3):
        block["basement_depth"] = draw.number(0.5, 3.0)
        contact = Draw(f"contact {block['basement_depth']}").of("both", "floor", "walls")
        if contact != "both":
            block["contact"] = contact
    if draw.chance(0.3):
        block["edge"] = {
            "position": draw.of("horizontal", "vertical"),
            "extent": draw.number(0.3, 1.5),
            "thickness": draw.number(0.02, 0.2),
            "conductivity": draw.number(0.02, 0.06),
        }
    if draw.chance(0.3):
        block |= {"inside_film": draw.number(1.0, 10.0), "outdoor_film": draw.number(5.0, 50.0)}
        if block["outdoor_film"] < 20.0:
            block |= {
                "absorptance": block["outdoor_film"] / 20.0,
                "emissivity": 1.0 - block["outdoor_film"] / 50.0,
            }
    if draw.chance(0.3):
        block["source"] = "soil survey"
    surface = tree["surfaces"][draw.one(may)]
    area = surface.get("area")
    if isinstance(area, float | int) and area > 4.0 and draw.chance(0.25):
        # Three dimensions take a second or two.
        block.pop("basement_depth", None)
        block.pop("contact", None)
        block["width"] = (area * draw.number(0.3, 1.0)) ** 0.5
        block["length"] = area / block["width"]
    tree["soil_blocks"] = {"soil_below": block}
    surface["outside"] = {"soil": "soil_below"}
