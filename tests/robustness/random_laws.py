"""Laws as text, derived outputs and errors of weather columns, put into a random building.

They have a stream of their own, so that all else of a case is as it was without them.
"""

from __future__ import annotations

from typing import Any

from random_draw import Draw

Json = dict[str, Any]


def add(draw: Draw, tree: Json) -> None:
    """Put some of them into a building that is complete otherwise."""
    if draw.chance(0.2):
        _conductivity(draw, tree["materials"]["base"])
    if draw.chance(0.2):
        name = draw.one(sorted(tree["zones"]))
        tree["zones"][name]["infiltration"] = _infiltration(draw)
    if draw.chance(0.2):
        tree["site"]["sky"] = _sky(draw, clouds="cloud" not in tree["site"])
    if draw.chance(0.2):
        tree["derived_outputs"] = _derived(draw, tree)
    if draw.chance(0.2):
        tree["weather"] = _weather(draw)


def add_to_sky(draw: Draw, site: Json) -> None:
    """How the sky radiates on tilted surfaces, and by day."""
    if draw.chance(0.2):
        site["sky_exponent"] = draw.number(0.8, 2.0)
    if draw.chance(0.2):
        site["sky_diurnal"] = draw.number(-60.0, 60.0)


def _law(draw: Draw, formula: str, valid: str, numbers: Json) -> Json:
    """A law with its numbers beside it or under a key."""
    law: Json = {"formula": formula} | ({"numbers": numbers} if draw.chance(0.4) else numbers)
    law |= {"valid": valid} if draw.chance(0.5) else {}
    return law | ({"source": "a paper"} if draw.chance(0.4) else {})


def _conductivity(draw: Draw, material: Json) -> None:
    """A conductivity that changes by up to half over 100 K."""
    slope: Json = {"value": draw.number(-0.002, 0.004), "unit": "1/K"}
    usual = {"value": material["conductivity"], "unit": "W/(m K)"}
    numbers = {"k": usual, "a": slope}
    material["conductivity"] = _law(draw, "k*(1 + a*T)", "T > -30 and T < 80", numbers)
    if draw.chance(0.5):
        material["kind"] = "variable"
    if draw.chance(0.3):
        material["source"] = "a data sheet"


def _infiltration(draw: Draw) -> Json:
    coefficient = draw.log(0.2, 2.0)
    numbers = {
        "c": {"value": coefficient, "range": [0.5 * coefficient, 2.0 * coefficient]},
        "s": draw.number(0.005, 0.02),
        "w": draw.number(0.0, 0.02),
    }
    law = _law(draw, "c*sqrt(s*abs(dT) + w*V^2)", "abs(dT) < 40 and V < 30", numbers)
    if draw.chance(0.3):
        law["density"] = draw.of("outdoors", "zone", 1.2)
    law |= {"kind": "text"} if draw.chance(0.5) else {}
    for key, low, high in (("constant", 0.0, 1.0), ("temperature", 0.0, 0.02), ("wind", 0.0, 0.1)):
        law |= {key: draw.number(low, high)} if draw.chance(0.3) else {}
    return law | ({"blower_door": draw.log(0.3, 10.0)} if draw.chance(0.3) else {})


def _sky(draw: Draw, *, clouds: bool) -> Json:
    """The emissivity of the clear sky, of all skies, or the temperature of the sky."""
    numbers = {"a": draw.number(0.5, 0.6), "b": draw.number(0.04, 0.07)}
    clear = "a + b*sqrt(pw/100)"
    way = draw.whole(0, 2) if clouds else 0
    if way == 2:
        depression = {"d": {"value": draw.number(2.0, 20.0), "unit": "K"}}
        law = _law(draw, "To - d", "To > -40 and To < 50", depression) | {"of": "temperature"}
    else:
        text = f"min(1, ({clear})*(1 + 0.02*cloud))" if way else f"min(1, {clear})"
        law = _law(draw, text, "To > -40 and To < 50", numbers)
        law |= {"of": "emissivity"} if draw.chance(0.3) else {}
    return law | {"kind": "text"}


def _derived(draw: Draw, tree: Json) -> Json:
    zone, surface = draw.one(sorted(tree["zones"])), draw.one(sorted(tree["surfaces"]))
    difference = f"{zone}.air_temperature - {surface}.inside_temperature"
    outputs: Json = {
        "apart": {"formula": difference, "unit": "K"},
        "flow": {"formula": "k*apart", "unit": "W", "k": {"value": draw.log(0.5, 50.0), "unit": "W/K"}},
        "warm": f"max({zone}.air_temperature - 26, 0)",
    }
    if draw.chance(0.4):
        outputs["flow"]["source"] = "a definition"
    return outputs


def _weather(draw: Draw) -> Json:
    """Errors that leave extreme weather inside of what is possible."""
    weather: Json = {"clock": draw.of(-600, 0, 300)} if draw.chance(0.4) else {}
    columns: Json = {
        "air_temperature": {"offset": draw.number(-0.5, 0.5)},
        "wind_speed": {"gain": draw.number(0.8, 1.0)},
        "radiation": {"gain": draw.number(0.9, 1.0), "clock": draw.of(-300, 0, 600)},
    }
    names = draw.some(sorted(columns), least=1)
    return weather | {"columns": {name: columns[name] for name in names}}
