"""Random air flows, gains, loads, controls and humidity of a random building."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import random_materials
from mascarin.building.base.law_table import LEAKAGE
from random_draw import Draw, four, numbers_of
from random_schedules import Schedules

Json = dict[str, Any]


def zone(draw: Draw, schedules: Schedules, others: list[str]) -> Json:
    """Everything that acts on the air of a zone; `others` are the names of the other zones."""
    tree: Json = {"volume": draw.noted(draw.log(4.0, 600.0), 1.0)}
    if draw.chance(0.3):
        tree["capacity_factor"] = draw.number(1.0, 12.0)
    if draw.chance(0.6):
        tree["infiltration"] = _infiltration(draw)
    if draw.chance(0.3):
        tree["longwave"] = draw.of(
            "radiosity", "none", "linearised", {"kind": "linearised", "reference": draw.number(0.0, 30.0)}
        )
    for name in draw.some(["people", "lamp", "heater"]):
        tree.setdefault("gains", {})[name] = _gain(draw, schedules)
    for name in draw.some(["fan", "shaft"]) if draw.chance(0.4) else []:
        flow = {"air_changes": draw.log(0.1, 30.0)} if draw.chance(0.6) else {"flow": draw.log(0.001, 0.3)}
        tree.setdefault("ventilation", {})[name] = flow | schedules.maybe("on", 0.5) | _density(draw)
    if draw.chance(0.2):
        tree["mixing_air_change"] = _mixing(draw, schedules)
        tree["air_gradient"] = _gradient(tree["mixing_air_change"])
    tree |= _loads(draw, schedules)
    if draw.chance(0.25):
        tree["thermal_bridges"] = {"edge": _bridge(draw, others)}
        if draw.chance(0.4):
            tree["thermal_bridges"]["post"] = _bridge(draw, others)
    return tree


def _infiltration(draw: Draw) -> Any:
    if draw.chance(0.4):
        return draw.noted(draw.log(0.02, 6.0), 0.01)
    tree: Json = {"constant": draw.number(0.0, 2.0)} | _density(draw)
    if draw.chance(0.5):
        tree["temperature"] = draw.number(0.0, 0.05)
    if draw.chance(0.5):
        tree["wind"] = draw.number(0.0, 0.3)
    if draw.chance(0.4):
        tree["blower_door"] = draw.of(
            draw.log(0.3, 15.0),
            {"kind": "factor", "n50": draw.log(0.3, 15.0), "factor": draw.number(0.01, 0.1)},
            {"kind": "stack_wind", "n50": 3, "storeys": draw.whole(1, 3), "shelter": draw.whole(1, 5)},
            {
                "kind": "stack_wind", "n50": draw.log(0.3, 15.0), "exponent": draw.number(0.5, 1.0),
                "stack": 0.0003, "wind": 0.0002,
            },
            # Laws that the engine's table has beside these.
            *(
                {"kind": row.kind, **numbers_of(draw, row)}
                for row in LEAKAGE.values()
                if row.kind not in ("factor", "stack_wind")
            ),
        )  # fmt: skip
    return tree


def _mixing(draw: Draw, schedules: Schedules) -> Any:
    """Air that a fan moves within a zone."""
    if draw.chance(0.3):
        return draw.number(0.0, 40.0)
    if draw.chance(0.5):
        column: Json = {"column": "n_fan"} | ({"unit": "1/h"} if draw.chance(0.5) else {})
        return column | ({"factor": draw.number(0.0, 2.0)} if draw.chance(0.5) else {})
    return {"air_changes": draw.number(0.0, 40.0)} | schedules.maybe("on", 0.5)


def _gradient(mixing: Any) -> Any:
    """Stratified air where a fan moves air, without a draw of its own; other cases keep their numbers."""
    if isinstance(mixing, Mapping) and "column" in mixing:
        unit = {"unit": "K/m"} if "unit" in mixing else {}
        return {"column": "P_kilo", "factor": mixing.get("factor", 1.0)} | unit
    if isinstance(mixing, Mapping):
        schedule = {key: mixing[key] for key in ("schedule",) if key in mixing}
        return {"gradient": 0.2 * mixing["air_changes"] - 3.0} | schedule
    return 0.1 * mixing


def _density(draw: Draw) -> Json:
    """Which air a flow is a volume of."""
    return {"density": draw.of("site", "outdoors", "zone", 1.2)} if draw.chance(0.3) else {}


def _people(source: Json, least: float) -> Json:
    """People where a power is large, without a draw of their own; other buildings stay the same."""
    return {"activity": 70.0 + source["power"] % 400.0} if source.get("power", 0.0) > least else {}


def _gain(draw: Draw, schedules: Schedules) -> Json:
    tree: Json = {} if draw.chance(0.4) else {"radiative": draw.of(0.0, 1.0, draw.number(0.0, 1.0))}
    if draw.chance(0.2):
        column, unit = draw.of(("P_heater", None), ("P_heater", "W"), ("P_kilo", "kW"))
        tree |= {"column": column} | ({"unit": unit} if unit else {})
        if draw.chance(0.4):
            tree["factor"] = draw.number(-1.0, 1.5)
    else:
        tree["power"] = draw.of(draw.log(1.0, 4000.0), draw.number(-300.0, 300.0))
    if "radiative" in tree:
        tree |= _people(tree, 300.0)
    return tree | schedules.maybe("on", 0.5)


def _loads(draw: Draw, schedules: Schedules) -> Json:
    """Heating and cooling, one of them, a zone that is held, or nothing."""
    way = draw.whole(0, 9)
    if way == 0:
        held: Json = draw.of(
            {"column": "T_held"}, {"temperature": draw.number(-5.0, 35.0)}, {"schedule": "?"}
        )
        if "schedule" in held:
            held = {"schedule": schedules.named("warm")}
        if draw.chance(0.4):
            held["when"] = schedules.named("on")
        if draw.chance(0.3):
            held["radiative"] = draw.number(0.0, 0.95)
        return {"held": held if draw.chance(0.7) else draw.number(5.0, 30.0)}
    if way > 6:
        return {}
    loads: Json = {}
    for key, purpose, column, low, high in (
        ("heating", "warm", "T_low", 10.0, 21.5),
        ("cooling", "cool", "T_high", 22.0, 30.0),
    ):
        if not draw.chance(0.75):
            continue
        plant: Json = {"setpoint": draw.number(low, high)}
        if draw.chance(0.3):
            plant["setpoint"] = {"schedule": schedules.named(purpose)}
        elif draw.chance(0.15):
            plant["setpoint"] = {"column": column}
        if draw.chance(0.6):
            plant["capacity"] = draw.log(20.0, 20_000.0)
        if draw.chance(0.4):
            plant["radiative"] = draw.of(0.95, 0.0, draw.number(0.0, 0.95))
        loads[key] = plant | schedules.maybe("on", 0.35)
    return loads


def _bridge(draw: Draw, others: list[str]) -> Json:
    bridge: Json = (
        {"psi": draw.number(-0.05, 1.0), "length": draw.number(0.0, 60.0)}
        if draw.chance(0.6)
        else {"chi": draw.number(0.0, 5.0)} | ({"number": draw.whole(1, 40)} if draw.chance(0.5) else {})
    )
    ends: list[Json] = [
        {}, {"outdoors": True}, {"ground": {"temperature": draw.number(0.0, 20.0)}},
        {"ground": {"mean": 9, "amplitude": draw.number(0.0, 9.0)}},
        {"measured": draw.of("T_a", ["T_a", "T_b"])},
    ]  # fmt: skip
    ends += [{"zone": name} for name in others[:2]]
    end: Json = draw.one(ends)
    return bridge | end


# --- air between zones and outdoors -------------------------------------------------------------------------


def paths(draw: Draw, schedules: Schedules, zones: list[str]) -> Json:
    """Air between zones: mixing, doors, and flows of fans from one to another."""
    paths_by_name: Json = {}
    for at in range(draw.whole(0, 3) if len(zones) > 1 else 0):
        first = draw.whole(0, len(zones) - 2)
        between = [zones[first], zones[draw.whole(first + 1, len(zones) - 1)]]
        way = draw.whole(0, 3)
        if way == 0:
            door: Json = {"width": draw.number(0.6, 3.0), "height": draw.number(0.5, 4.0)}
            door |= {"discharge": draw.number(0.4, 0.8)} if draw.chance(0.3) else {}
            door |= {"open": draw.number(0.0, 1.0)} if draw.chance(0.4) else {}
            path: Json = {"between": between, "door": door}
        elif way == 1:
            path = {"between": between, "column": "Q_fan", "unit": "m3/h"}
            path |= {"factor": draw.number(0.0, 2.0)} if draw.chance(0.4) else {}
        else:
            path = {"between": between, "flow": draw.log(0.001, 0.5)}
        if way:
            path |= _density(draw)
        if way and draw.chance(0.3):
            path["one_way"] = True
        paths_by_name[f"path_{at}"] = path | schedules.maybe("on", 0.4)
    return paths_by_name


def units(draw: Draw, schedules: Schedules, zones: list[str]) -> Json:
    """Ventilation units with recovery or a given temperature of the supplied air."""
    units_by_name: Json = {}
    for at in range(draw.of(0, 0, 0, 1, 1, 2)):
        unit: Json = {}
        for section in ("supply", "exhaust"):
            flows = {name: _flow(draw, schedules) for name in draw.some(zones, least=1)[:3]}
            if draw.chance(0.85):
                unit[section] = flows
        if not unit:
            unit["supply"] = {zones[0]: 0.02}
        if "supply" in unit and draw.chance(0.3):
            unit["temperature"] = draw.of(
                draw.number(10.0, 40.0), {"schedule": schedules.named("warm")}, {"column": "T_b"}
            )
        elif len(unit) == 2 and draw.chance(0.6):
            unit["recovery"] = draw.number(0.0, 1.0)
        units_by_name[f"unit_{at}"] = unit
    return units_by_name


def _flow(draw: Draw, schedules: Schedules) -> Any:
    if draw.chance(0.5):
        return draw.log(0.001, 0.2)
    if draw.chance(0.4):
        flow: Json = {"column": "Q_fan", "unit": "m3/h"}
        return flow | ({"factor": draw.number(0.1, 2.0)} if draw.chance(0.5) else {}) | _density(draw)
    return {"flow": draw.log(0.001, 0.2)} | schedules.maybe("on", 0.5) | _density(draw)


def moved(made_paths: Json, made_units: Json) -> set[str]:
    """Zones that fans move air into or out of."""
    changes = {
        name for unit in made_units.values() for key in ("supply", "exhaust") for name in unit.get(key, {})
    }
    return changes | {name for path in made_paths.values() if path.get("one_way") for name in path["between"]}


def openings(draw: Draw, schedules: Schedules, zones: list[str], controls: list[str]) -> Json:
    """Openings to outdoors by wind and buoyancy, without a network."""
    openings_by_name: Json = {}
    for at in range(draw.of(0, 0, 1, 2)):
        opening: Json = {
            "zone": draw.one(zones),
            "area": draw.log(0.001, 2.0),
            "height": draw.number(0.0, 4.0),
        }
        opening |= {"discharge": draw.number(0.4, 0.8)} if draw.chance(0.3) else {}
        opening |= {"wind_coefficient": draw.number(0.0, 0.6)} if draw.chance(0.3) else {}
        opening |= {"control": draw.one(controls)} if controls and draw.chance(0.5) else {}
        openings_by_name[f"opening_{at}"] = opening | schedules.maybe("on", 0.4)
    return openings_by_name


def vents(
    draw: Draw, schedules: Schedules, zones: list[str], walls: dict[str, str], controls: list[str]
) -> Json:
    """Openings of the pressure network; `walls` are vertical outdoor walls with their zones."""
    vents_by_name: Json = {}
    for at in range(draw.of(0, 0, 0, 1, 2, 4)):
        vent: Json = {"area": draw.log(0.0005, 3.0), "elevation": draw.number(0.0, 12.0)}
        if len(zones) > 1 and draw.chance(0.35):
            first = draw.whole(0, len(zones) - 2)
            vent["between"] = [zones[first], zones[draw.whole(first + 1, len(zones) - 1)]]
        else:
            vent |= _to_outdoors(draw, zones, walls)
        vent |= {"height": draw.log(0.05, 3.0)} if draw.chance(0.5) else {}
        vent |= {"discharge": draw.number(0.4, 0.8)} if draw.chance(0.3) else {}
        vent |= {"exponent": draw.number(0.5, 1.0)} if draw.chance(0.4) else {}
        vent |= {"control": draw.one(controls)} if controls and draw.chance(0.5) else {}
        vents_by_name[f"vent_{at}"] = vent | schedules.maybe("on", 0.35)
    return vents_by_name


def _to_outdoors(draw: Draw, zones: list[str], walls: dict[str, str]) -> Json:
    way = draw.whole(0, 3)
    if way == 0:
        return {"zone": draw.one(zones), "pressure": "none"}
    if way == 1:
        return {
            "zone": draw.one(zones),
            "pressure": {"kind": "table", "coefficients": [draw.number(-1.0, 0.5)]},
        }
    pressure: Json = {"kind": "low_rise"}
    if draw.chance(0.5):
        coefficients = [draw.number(-1.2, 0.8) for _ in range(draw.of(2, 4, 8))]
        pressure = {"kind": "table", "coefficients": coefficients}
    if pressure["kind"] == "low_rise" and draw.chance(0.5):
        pressure["side_ratio"] = draw.number(0.3, 4.0)
    if draw.chance(0.4):
        pressure |= {"shelter": draw.number(0.0, 1.2), "height": draw.log(1.0, 40.0)}
    if walls and draw.chance(0.6):
        name = draw.one(sorted(walls))
        return {"zone": walls[name], "surface": name, "pressure": pressure}
    return {"zone": draw.one(zones), "azimuth": draw.number(0.0, 360.0), "pressure": pressure}


def controls(draw: Draw, zones: list[str]) -> Json:
    """What opens and closes openings: bands that are wide, narrow, or of no width."""
    controls_by_name: Json = {}
    for at in range(draw.of(0, 0, 1, 2)):
        control: Json = {"zone": draw.one(zones)}
        for key, low, high, apart in (
            ("indoor", 15.0, 28.0, -3.0), ("outdoor", -5.0, 25.0, -4.0), ("difference", -5.0, 6.0, -3.0),
            ("wind", 2.0, 12.0, 3.0),
        ):  # fmt: skip
            if draw.chance(0.4):
                opens = draw.number(low, high)
                control[key] = {
                    "open": opens,
                    "close": four(opens + draw.of(0.0, apart * draw.number(0.01, 1.0))),
                }
        if draw.chance(0.25) or len(control) == 1:
            control["rain"] = {"column": "rain"} | ({"open": 0.5, "close": 1.5} if draw.chance(0.5) else {})
        for key in ("minimum_open_time", "minimum_closed_time"):
            if draw.chance(0.3):
                control[key] = draw.of(0, 10, 45, draw.whole(1, 240))
        # Without a draw of their own, so that cases keep their numbers.
        if at == 1:
            for key in ("indoor", "outdoor"):
                if key in control:
                    opens = four(control[key]["open"] + 6.0)
                    control[f"{key}_below"] = {"open": opens, "close": four(opens + 1.5)}
        controls_by_name[f"control_{at}"] = control
    return controls_by_name


def controlled_flows(tree: Json) -> None:
    """Schedules and controls of infiltration and ventilation, without a draw of their own."""
    controls_by_name = tree.get("controls", {})
    if len(controls_by_name) < 2:
        return
    fractions = sorted(
        name for name, entry in tree.get("schedules", {}).items() if entry["kind"] == "fraction"
    )
    keys = {"control": "control_1"} | ({"schedule": fractions[0]} if fractions else {})
    for entry in tree["zones"].values():
        infiltration = entry.get("infiltration", 0.0)
        if isinstance(infiltration, int | float):
            entry["infiltration"] = {"constant": infiltration} | keys
        elif "column" not in infiltration and "value" not in infiltration:
            entry["infiltration"] = {**infiltration, **keys}
        for flow in entry.get("ventilation", {}).values():
            flow["control"] = "control_1"
    for path in tree.get("air_paths", {}).values():
        if not path.get("one_way"):
            path["control"] = "control_1"
    control = controls_by_name["control_1"]
    others = sorted(set(tree["zones"]) - {control["zone"]})
    if "difference" in control and others:
        control["reference_zone"] = others[0]


def operative_set_points(tree: Json) -> None:
    """Operative set points in zones with limited radiative heating, without a draw of their own."""
    for entry in tree["zones"].values():
        heating = entry.get("heating", {})
        if "radiative" in heating and "capacity" in heating:
            entry["setpoint_radiant_share"] = 0.4


# --- humidity -----------------------------------------------------------------------------------------------


def humidity(draw: Draw, schedules: Schedules, tree: Json) -> Json:
    """The vapour balances: sources, plants, sorption, paint, recovery."""
    section: Json = {}
    for key, low, high in (("initial", 0.02, 1.0), ("lewis", 0.7, 1.3), ("period", 6.0, 48.0)):
        if draw.chance(0.4):
            section[key] = draw.number(low, high)
    if draw.chance(0.3):
        section["deep_period"] = draw.number(100.0, 1000.0)
    solids = [name for name, entry in tree["materials"].items() if entry.get("kind") != "resistance"]
    for name in draw.some(solids):
        section.setdefault("materials", {})[name] = random_materials.sorption(draw)
    for name, entry in tree["zones"].items():
        part = _zone_humidity(draw, schedules, cooled="cooling" in entry or "held" in entry)
        if part:
            section.setdefault("zones", {})[name] = part
    for name in draw.some(sorted(tree["surfaces"])) if draw.chance(0.3) else []:
        section.setdefault("surfaces", {})[name] = draw.of({"paint": draw.log(0.01, 5.0)}, {"sealed": True})
    both = [
        name
        for name, unit in tree.get("ventilation_units", {}).items()
        if unit.keys() >= {"supply", "exhaust"}
    ]
    for name in draw.some(both):
        section.setdefault("recovery", {})[name] = draw.number(0.0, 1.0)
    return section


def _zone_humidity(draw: Draw, schedules: Schedules, *, cooled: bool) -> Json:
    section: Json = {} if draw.chance(0.6) else {"storage": draw.number(1.0, 20.0)}
    for name in draw.some(["people", "shower", "plants"]):
        source: Json = draw.of(
            {"power": draw.log(1.0, 3000.0)},
            {"rate": draw.log(1e-7, 1e-3)},
            {"column": "vapour", "unit": "g/h"},
        )
        if "column" in source and draw.chance(0.4):
            source["factor"] = draw.number(0.0, 2.0)
        source |= _people(source, 500.0)
        section.setdefault("gains", {})[name] = source | schedules.maybe("on", 0.5)
    if draw.chance(0.4):
        coil: Json = {"sensible_heat_ratio": draw.number(0.4, 1.0)}
        coil |= {"coil_temperature": draw.number(2.0, 16.0)} if draw.chance(0.5) else {}
        section["drying"] = coil if cooled and draw.chance(0.4) else _humidistat(draw, schedules, "drying")
    if draw.chance(0.3):
        section["humidifying"] = _humidistat(draw, schedules, "humidifying")
    return section


def _humidistat(draw: Draw, schedules: Schedules, which: str) -> Json:
    dries = which == "drying"
    level, ratio = ("damp", "humid") if dries else ("dry", "arid")
    columns = ("phi_high", "w_high") if dries else ("phi_low", "w_low")
    set_point: Json = draw.of(
        {"relative_humidity": draw.number(0.5, 0.9) if dries else draw.number(0.1, 0.49)},
        {"relative_humidity": {"schedule": schedules.named(level)}},
        {"relative_humidity": {"column": columns[0], "unit": "%"}},
        {"humidity_ratio": draw.number(0.007, 0.014) if dries else draw.number(0.001, 0.0068)},
        {"humidity_ratio": {"schedule": schedules.named(ratio)}},
        {"humidity_ratio": {"column": columns[1], "unit": "g/kg"}},
    )
    if draw.chance(0.5):
        set_point["capacity"] = draw.log(5.0, 20_000.0)
    return set_point | schedules.maybe("on", 0.3)
