"""Random materials, constructions and glazings, for `random_buildings`."""

from __future__ import annotations

import itertools
from typing import Any, get_args

from mascarin.building.base.law_table import SORPTION
from mascarin.building.parts.materials.sorption import Kind as Sorbing
from mascarin.materials.library import PROPERTIES, products
from random_draw import Draw, four, numbers_of

Json = dict[str, Any]

#: What a product lacks is given beside it.
_USUAL: Json = {"conductivity": 0.2, "density": [880, 800], "specific_heat": [2000, 2200]}


def solid(draw: Draw) -> Json:
    """A material with constant properties, from aerogel to metal."""
    return {
        "conductivity": draw.noted(draw.log(0.013, 200.0), 0.005),
        "density": draw.log(12.0, 8000.0),
        "specific_heat": draw.number(300.0, 4200.0),
        **({"source": "a handbook"} if draw.chance(0.1) else {}),
    }


def ordinary(draw: Draw) -> Json:
    """A building material."""
    material: Json = draw.of(
        {"conductivity": 1.75, "density": 2240, "specific_heat": 900},
        {"conductivity": 0.16, "density": 950, "specific_heat": 840},
        {"conductivity": 0.13, "density": 500, "specific_heat": 1600},
        {"conductivity": 0.04, "density": 30, "specific_heat": 1000},
        {"conductivity": 0.8, "density": 1700, "specific_heat": 850},
    )
    return material


# --- materials that melt ------------------------------------------------------------------------------------


def product(draw: Draw) -> Json:
    """A product of the catalogue, by either of its curves, shifted, or with other properties or laws."""
    catalogue = products()
    name = draw.one(sorted(catalogue))
    entry = catalogue[name]
    material: Json = {"product": name}
    material |= {key: _USUAL[key] for key in PROPERTIES if key not in entry.raw}
    curves = [key for key in ("heating", "cooling") if getattr(entry, key) is not None]
    if not curves:
        if "law" not in entry.raw:
            material["law"] = {"kind": "tanh", "width": draw.number(0.3, 3.0)}
        return material
    kind = draw.whole(0, 4)
    if kind == 1:
        material["law"] = draw.one(curves)
    elif kind == 2:
        material["law"] = {"curve": draw.one(curves), "temperature_shift": draw.number(-8.0, 8.0)}
    elif kind == 3:
        material["law"] = {"enthalpy_scale": draw.number(0.8, 1.2)}
    elif kind == 4:
        material["conductivity"] = draw.number(0.1, 2.0)
        if draw.chance(0.5):
            material["density"] = {"solid": 900.0}
    return material


def closed_law(draw: Draw) -> Json:
    """A law of the liquid fraction by a formula."""
    width = draw.log(0.1, 4.0)
    law: Json = draw.of(
        {"kind": "tanh", "width": width},
        {"kind": "tanh", "gamma": 0.04, "delta_t": four(0.01 * width)},
        {"kind": "smooth_step", "width": width, "continuity": draw.of(1, 2)},
        {"kind": "gaussian", "width": width},
        {"kind": "gumbel", "width": width, "tail": draw.of("low", "high")},
        {"kind": "linear", "width": width},
        {
            "kind": "text",
            "formula": "1/(1 + exp(-(T - Tm)/w))",
            "w": width,
            "range": [four(-8.0 * width), four(8.0 * width)],
            "source": "a paper",
        },
        {
            "formula": "0.5 + 0.5*tanh((T - Tm)/w)",
            "numbers": {"w": width},
            "range": [four(-5.0 * width), four(5.0 * width)],
        },
        {"kind": "triangle", "below": width, "above": draw.log(0.1, 4.0)},
    )
    return law


def _fractions(draw: Draw, start: float) -> Json:
    """A measured liquid fraction from a temperature on."""
    steps = [draw.number(0.3, 2.0) for _ in range(draw.whole(2, 5))]
    temperatures = [start]
    for step in steps:
        temperatures.append(four(temperatures[-1] + step))
    inner = sorted({draw.number(0.02, 0.98) for _ in range(len(steps) - 1)})
    fractions = [0.0, *inner, 1.0]
    law: Json = {"kind": "fractions", "temperatures": temperatures[: len(fractions)], "fractions": fractions}
    if draw.chance(0.3):
        law["temperature_shift"] = draw.number(-2.0, 2.0)
    return law


def _table(draw: Draw, start: float) -> Json:
    """A measured curve of enthalpy or of the apparent specific heat."""
    temperatures = [start]
    for _ in range(draw.whole(3, 7)):
        temperatures.append(four(temperatures[-1] + draw.number(0.5, 3.0)))
    law: Json = {"temperatures": temperatures}
    if draw.chance(0.5):
        enthalpies = [0.0]
        for low, high in itertools.pairwise(temperatures):
            enthalpies.append(four(enthalpies[-1] + (high - low) * draw.log(2e3, 8e4)))
        law |= {"kind": "table", "enthalpies": enthalpies}
    else:
        law |= {"kind": "capacity", "capacities": [draw.log(1.5e3, 6e4) for _ in temperatures]}
    if draw.chance(0.5):
        law["melting_range"] = [temperatures[1], temperatures[-2]]
    if draw.chance(0.6):
        law["temperature_shift"] = draw.number(-2.0, 2.0)
    if draw.chance(0.6):
        law["enthalpy_scale"] = draw.number(0.8, 1.2)
    return law


def melting(draw: Draw) -> Json:
    """A material that melts: a formula or a measured curve, with or without hysteresis."""
    middle = draw.number(-5.0, 40.0)
    material: Json = {
        "kind": "pcm",
        "conductivity": draw.of(0.2, [0.5, 0.3], {"solid": 0.22, "liquid": 0.18}),
        "density": draw.of(855, [880, 770], {"solid": 1500, "liquid": 1450}),
        "specific_heat": draw.of(2000, [3134, 2833], {"solid": 2100, "liquid": 2300}),
    }
    if draw.chance(0.1):
        material["source"] = "a measurement"
    way = draw.whole(0, 4)
    if way == 0:
        return material | {"law": _table(draw, middle)}
    material["latent_heat"] = draw.log(5e4, 3e5)
    if way == 1:
        material["law"] = _fractions(draw, middle)
        if draw.chance(0.4):
            law = material["law"]
            apart = draw.number(0.0, 3.0)
            lower = law | {"temperatures": [four(t - apart) for t in law["temperatures"]]}
            material["hysteresis"] = {"model": _model(draw), "law": lower}
        return material
    material |= {"law": closed_law(draw), "melting_temperature": draw.noted(middle, 1.0)}
    if draw.chance(0.2):
        material["hysteresis"] = _supercooling(draw)
        return material
    if draw.chance(0.45):
        apart = draw.number(0.05, 4.0)
        material["hysteresis"] = {"model": _model(draw), "freezing_temperature": four(middle - apart)}
        if draw.chance(0.3):  # far enough that the curves cannot cross
            material["law"] = {"kind": "smooth_step", "width": 1.0}
            material["hysteresis"] |= {
                "freezing_temperature": four(middle - 3.0),
                "law": {"kind": draw.of("linear", "smooth_step"), "width": draw.number(0.5, 1.8)},
            }
    return material


def _supercooling(draw: Draw) -> Json:
    kinetics = draw.of({"time_constant": draw.log(1.0, 1e4)}, {"rate": draw.log(1e-6, 1e-2)})
    return {"model": "supercooling", "degree": draw.number(0.5, 12.0), **kinetics}


def _model(draw: Draw) -> str:
    return str(draw.of("curve_track", "curve_switch", "curve_scale", "curve-track"))


# --- constructions ------------------------------------------------------------------------------------------


def materials(draw: Draw) -> Json:
    """Materials of a building by name; the names say what they are."""
    materials_by_name: Json = {"base": ordinary(draw)}
    if draw.chance(0.6):
        materials_by_name["other"] = solid(draw) if draw.chance(0.4) else ordinary(draw)
    if draw.chance(0.4):
        materials_by_name["gap"] = {"kind": "resistance", "resistance": draw.log(0.01, 3.0)}
        if draw.chance(0.3):
            materials_by_name["gap"]["source"] = "ISO 6946:2017"
    if draw.chance(0.35):
        materials_by_name["product"] = product(draw)
    if draw.chance(0.45):
        materials_by_name["wax"] = melting(draw)
    return materials_by_name


def construction(draw: Draw, known: Json) -> Json:
    """One to four layers; a resistance stands between two others, or alone with one."""
    names = [name for name in known if name != "gap"]
    layers: list[Json] = []
    for at in range(draw.whole(1, 4)):
        if (
            "gap" in known
            and layers
            and "gap" not in (entry["material"] for entry in layers)
            and draw.chance(0.3)
        ):
            layers.append({"material": "gap"})
            continue
        name = draw.one(names)
        melts = name in ("product", "wax")
        layer: Json = {"material": name, "thickness": draw.log(0.002, 0.03 if melts else 0.4)}
        if draw.chance(0.3) or any(entry.get("name", entry["material"]) == name for entry in layers):
            layer["name"] = f"layer_{at}"
        if draw.chance(0.25):
            layer["nodes"] = draw.whole(1, 12)
        layers.append(layer)
    if draw.chance(0.1):
        layers[0]["thickness"] = draw.noted(float(layers[0]["thickness"]), 0.001)
    return {"layers": layers}


# --- glazings -----------------------------------------------------------------------------------------------


def _pane(draw: Draw, optics: bool) -> Json:
    pane: Json = {
        "thickness": draw.number(0.003, 0.012),
        "emissivity": draw.of(0.84, 0.9, [0.84, 0.04], [0.1, 0.84]),
    }
    if optics:
        pane["transmittance"] = draw.number(0.1, 0.88)
        most = 0.99 - pane["transmittance"]
        plain = draw.number(0.03, 0.08)
        pane["reflectance"] = min(plain, most) if draw.chance(0.6) else [
            four(most * draw.number(0.1, 0.9)), four(most * draw.number(0.1, 0.9))]  # fmt: skip
    if draw.chance(0.5):
        pane |= {"density": 2500, "specific_heat": 750}
    if draw.chance(0.2):
        pane["conductivity"] = draw.number(0.2, 1.2)
    return pane


def _gap(draw: Draw) -> Json:
    if draw.chance(0.25):
        return {"conductance": draw.log(0.5, 10.0)}
    gap: Json = {"thickness": draw.log(0.004, 0.15)}
    if draw.chance(0.7):
        gap["gas"] = draw.of("air", "argon", "krypton", "xenon")
    if draw.chance(0.2):
        gap["pressure"] = draw.number(60_000.0, 105_000.0)
    return gap


def _angular(draw: Draw, panes: int) -> Json:
    """Optics over the angle that sum to one, with values for diffuse radiation in some cases."""
    angles = [0, 30, 60, 75, 90]
    through = draw.number(0.1, 0.7)
    each = draw.number(0.01, 0.25 / panes)
    falling = [1.0, 0.98, 0.85, 0.5, 0.0]
    transmitted = [four(through * f) for f in falling]
    absorbed = [[four(each * f) for f in falling] for _ in range(panes)]
    table: Json = {"angles": angles, "transmittance": transmitted, "absorptance": absorbed}
    if draw.chance(0.5):
        table["reflectance"] = [
            four(1.0 - t - sum(pane[k] for pane in absorbed)) for k, t in enumerate(transmitted)
        ]
    for key in ("diffuse", "back"):
        if draw.chance(0.4):
            part: Json = {"transmittance": four(0.85 * through), "absorptance": [four(0.9 * each)] * panes}
            if draw.chance(0.5):
                part["reflectance"] = four(1.0 - part["transmittance"] - sum(part["absorptance"]))
            table[key] = part
    for key in ("transmittance_scale", "absorptance_scale"):
        if draw.chance(0.2):
            table[key] = draw.number(0.9, 1.0)
    return table


def glazing(draw: Draw) -> Json:
    """Panes with gaps, a table over the angle, or rated values."""
    if draw.chance(0.3):
        unit: Json = {
            "kind": "simple",
            "u_value": draw.log(0.5, 5.6),
            "solar_heat_gain": draw.number(0.15, 0.85),
        }
        if draw.chance(0.3):
            unit["transmittance"] = four(unit["solar_heat_gain"] * draw.number(0.6, 1.0))
        if draw.chance(0.2):
            unit["panes"] = draw.whole(1, 4)
        if draw.chance(0.2):
            unit["category"] = draw.number(1.0, 10.0)
        if draw.chance(0.15):
            unit |= {"outside_film": 0.04, "inside_film": draw.of(0.13, 0.1)}
        if draw.chance(0.15):
            unit["emissivity"] = draw.number(0.2, 0.95)
    else:
        count = draw.of(1, 1, 2, 2, 2, 3, 4)
        angular = draw.chance(0.25)
        unit = {
            "kind": "panes",
            "panes": [_pane(draw, optics=not angular) for _ in range(count)],
            "gaps": [_gap(draw) for _ in range(count - 1)],
        }
        if angular:
            unit["angular"] = _angular(draw, count)
    if draw.chance(0.1):
        unit["source"] = "a data sheet"
    return unit


def sorption(draw: Draw) -> Any:
    """The moisture content of a material."""
    way = draw.whole(0, 3)
    depths: Json = {"depth": draw.log(0.0005, 0.02)} if draw.chance(0.3) else {}
    if depths and draw.chance(0.6):
        depths["deep_depth"] = four(depths["depth"] * draw.number(1.5, 5.0))
    # Laws that the engine's table has beside the one below.
    others = [row for row in SORPTION.values() if row.kind != "linear"]
    if others and draw.chance(0.3):
        row = draw.one(others)
        numbers = numbers_of(draw, row)
        return {"kind": row.kind, **numbers, "vapour_resistance": draw.log(2.0, 300.0)} | depths
    if way == 0:
        return draw.one(get_args(Sorbing))
    if way == 1:
        isotherm: Json = {"like": draw.one(get_args(Sorbing)), "factor": draw.number(0.5, 1.5)}
        return isotherm | depths | ({"vapour_resistance": draw.log(2.0, 300.0)} if draw.chance(0.5) else {})
    if way == 2:
        return {"capacity": draw.log(1.0, 100.0), "vapour_resistance": draw.log(2.0, 300.0)} | depths
    isotherm = {
        "humidities": [0, draw.number(0.2, 0.6), draw.number(0.7, 0.95)],
        "contents": [0, draw.number(5.0, 30.0), draw.number(40.0, 90.0)],
        "vapour_resistance": draw.log(2.0, 300.0),
    }
    return isotherm | depths | ({"factor": draw.number(0.5, 1.5)} if draw.chance(0.4) else {})
