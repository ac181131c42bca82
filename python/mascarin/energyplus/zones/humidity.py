"""Vapour in zones and in the skin of their surfaces (effective moisture penetration depth)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, Final

from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined, constant
from mascarin.physics import (
    KELVIN,
    LATENT_HEAT,
    STANDARD_PRESSURE,
    dew_point,
    relative_humidity,
    saturation_pressure,
    standard_density,
)

SETTINGS: Final = "MaterialProperty:MoisturePenetrationDepth:Settings"
#: Relative humidities of the straight lines that stand for a curve [-].
_POINTS: Final = (0.0, 0.02, 0.05, *(round(0.1 * k, 1) for k in range(1, 8)), 0.75, 0.8, 0.85, 0.9,
                  0.925, 0.95, 0.975, 1.0)  # fmt: skip
#: Air at which EnergyPlus takes the depths of layers: temperature [degC], relative humidity [-], pressure
#: [Pa]; and the periods of both layers [s] (EnergyPlus Engineering Reference, effective moisture penetration
#: depth).
_USUAL: Final = (24.0, 0.45, STANDARD_PRESSURE)
_PERIODS: Final = (24 * 3600.0, 21 * 24 * 3600.0)
#: Enthalpy of vapour by which EnergyPlus divides latent heat: at 0 degC [J/kg], by temperature [J/(kg K)].
_ENTHALPY: Final = (2500940.0, 1858.95)


def describe_humidity(context: Context, air: Mapping[str, float]) -> None:
    """Enter vapour balances, where EnergyPlus solves vapour in the skin of surfaces.

    Parameters
    ----------
    context : Context
        The conversion, with its surfaces, gains and systems.
    air : mapping of str to float
        Usual temperature of each zone by its name in the file, in small letters. [degC]

    Raises
    ------
    InputError
        A material or a schedule that does not exist.
    """
    settings = context.model.of_class(SETTINGS)
    if not settings or not context.has_vapour:
        _note_unused(context)
        return
    humidity = context.section("humidity")
    humidity["materials"], coatings = _materials(context)
    humidity["surfaces"] = _surfaces(context, coatings, set(humidity["materials"]))
    humidity["zones"] = _zones(context, air)
    for key in ("materials", "surfaces", "zones"):
        if not humidity[key]:
            del humidity[key]


@reads(SETTINGS)
def _note_unused(context: Context) -> None:
    settings = context.model.of(SETTINGS)
    context.findings.no_effect(settings, "not needed", "no surface is solved with vapour")


@reads(SETTINGS)
def _materials(context: Context) -> tuple[Section, dict[str, float]]:
    """Sorption by material, and coatings as still air [m]."""
    held: Section = {}
    coatings: dict[str, float] = {}
    for item in context.model.of(SETTINGS):
        name = context.names.entered("materials", item.name)
        material = context.model.named(item.name, "Material")
        if name is None or material is None:
            context.findings.no_effect([item], "not needed", "no surface has this material")
            continue
        sorption = _isotherm(item, material.needed("density"))
        if sorption is None:
            context.findings.left_out(
                item, "a content that does not rise with the humidity", "this material takes up no vapour"
            )
            continue
        resistance = item.needed("water_vapor_diffusion_resistance_factor")
        surface, deep = _depths(item, material.needed("density"), resistance)
        thickness = _thinnest(context, name, material.needed("thickness"))
        held[name] = _within(thickness, sorption, resistance, surface, deep)
        coating = (item.number("coating_layer_thickness") or 0.0) * (
            item.number("coating_layer_water_vapor_diffusion_resistance_factor") or 0.0
        )
        if coating > 0.0:
            coatings[name] = coating
        shorter = (
            f". Its layers of {1e3 * (surface + deep):.3g} mm are deeper than the material: depths are "
            "shorter here, contents and resistance larger by as much: the same is stored and conducted"
            if surface + deep > thickness
            else ""
        )
        context.findings.approximated(
            item,
            "vapour in the skin of surfaces",
            "carried over without its heat of sorption. A wall that is warmed gives off vapour here, and "
            f"keeps it in EnergyPlus: 5 to 7 % relative humidity (docs/humidity.md){shorter}",
        )
    return held, coatings


def _thinnest(context: Context, material: str, thickness: float) -> float:
    """Thickness of the thinnest layer of a material in the skin of a construction. [m]"""
    skins = [
        layer
        for held in context.section("constructions").values()
        for layer in (held["layers"][0], held["layers"][-1])
        if layer["material"] == material
    ]
    return min((float(layer.get("thickness", thickness)) for layer in skins), default=thickness)


def _within(thickness: float, sorption: Section, resistance: float, surface: float, deep: float) -> Section:
    """Sorption with layers that end at the thickness, as the engine ends them and EnergyPlus does not.

    With depths of ``s d``, contents ``c/s`` and a resistance factor ``mu/s`` the stored vapour ``d c`` and
    the resistances ``d mu`` are the same.
    """
    share = min(1.0, thickness / (surface + deep))
    held: Section = dict(sorption)
    if "contents" in held:
        held["contents"] = [round(content / share, 9) for content in held["contents"]]
    if "capacity" in held:
        held["capacity"] = round(held["capacity"] / share, 9)
    held |= {"vapour_resistance": round(resistance / share, 9), "depth": round(share * surface, 9)}
    return held | ({"deep_depth": round(share * deep, 9)} if deep > 0.0 else {})


def _isotherm(item: IdfObject, density: float) -> Section | None:
    """``u = a phi^b + c phi^d`` [kg/kg] as a line or a table [kg/m3]; None where it does not rise."""
    terms = [
        (item.number(f"moisture_equation_coefficient_{factor}") or 0.0,
         item.number(f"moisture_equation_coefficient_{power}") or 0.0)
        for factor, power in (("a", "b"), ("c", "d"))
    ]  # fmt: skip
    terms = [(factor, power) for factor, power in terms if factor != 0.0]
    if any(power < 0.0 for _, power in terms):
        return None
    if terms and all(power == 1.0 for _, power in terms):
        capacity = density * sum(factor for factor, _ in terms)
        return {"capacity": round(capacity, 9)} if capacity > 0.0 else None
    contents = [
        round(density * sum(factor * humidity**power for factor, power in terms), 9) for humidity in _POINTS
    ]
    if any(after <= before for before, after in pairwise(contents)):
        return None
    return {"humidities": list(_POINTS), "contents": contents}


def _depths(item: IdfObject, density: float, resistance: float) -> tuple[float, float]:
    """Depths of the layer at the surface and of that behind it; 0 without the second. [m]"""
    warm, humidity, pressure = _USUAL
    slope = 0.0
    for factor, power in (("a", "b"), ("c", "d")):
        scale = item.number(f"moisture_equation_coefficient_{factor}") or 0.0
        exponent = item.number(f"moisture_equation_coefficient_{power}") or 0.0
        slope += scale * exponent * humidity ** (exponent - 1.0) if scale != 0.0 else 0.0
    permeability = 2.0e-7 * (warm + KELVIN) ** 0.81 / pressure / resistance
    full = float(saturation_pressure(warm))
    depths = []
    for which, period in zip(("surface", "deep"), _PERIODS, strict=True):
        entered = item.number(f"{which}_layer_penetration_depth")
        by_period = (
            math.sqrt(permeability * full * period / (density * slope * math.pi)) if slope > 0 else 0.0
        )
        depths.append(by_period if entered is None else entered)
    return depths[0], depths[1]


def _surfaces(context: Context, coatings: dict[str, float], sorbing: set[str]) -> Section:
    """Surfaces that take up no vapour in EnergyPlus, or have a coating."""
    held: Section = {}
    usual = context.moist.get("", False)
    for name, surface in context.section("surfaces").items():
        layers = context.section("constructions")[surface["construction"]]["layers"]
        faced = [layers[-1]["material"]] if "zone" in surface["inside"] else []
        faced += [layers[0]["material"]] if "zone" in surface["outside"] else []
        if not sorbing.intersection(faced):
            continue
        if not context.moist.get(name, usual):
            held[name] = {"sealed": True}
        elif paints := [coatings[material] for material in faced if material in coatings]:
            held[name] = {"paint": round(max(paints), 9)}
    return held


def _zones(context: Context, air: Mapping[str, float]) -> Section:
    """Sources of vapour, and what dries and humidifies zones."""
    held: Section = {}
    temperatures = {context.names.of("zones", name): value for name, value in air.items()}
    for source in context.vapour:
        peak = max(source.latent.values)
        if peak <= 0.0:
            continue
        schedule, _ = fraction(context, f"{source.item.name} vapour", _share(source.latent, peak))
        enthalpy = _ENTHALPY[0] + _ENTHALPY[1] * temperatures[source.zone]
        gain: Section = {"rate": round(peak / enthalpy, 12)}
        if source.activity is not None:
            # Of EnergyPlus' mass of vapour.
            power = peak * LATENT_HEAT / enthalpy
            gain = {"power": round(power, 6), "activity": round(source.activity, 6)}
        gain |= {} if schedule is None else {"schedule": schedule}
        zone = held.setdefault(source.zone, {})
        name = context.names.of(f"vapour of {source.zone}", source.item.name, source.item.kind)
        zone.setdefault("gains", {})[name] = gain
    for name, plants in _plants(context):
        held.setdefault(name, {}).update(plants)
    _stores(context, held)
    return held


def _share(values: Year, peak: float) -> Year:
    return constant(1.0) if values.constant is not None else combined(lambda value: value / peak, values)


@reads("ZoneCapacitanceMultiplier:ResearchSpecial")
def _stores(context: Context, held: Section) -> None:
    """Vapour that stands in a room, over that of its air."""
    for item in context.model.of("ZoneCapacitanceMultiplier:ResearchSpecial"):
        factor = item.number("humidity_capacity_multiplier") or 1.0
        named = item.text("zone_or_zonelist_name")
        zones = context.zones_of(item, "zone_or_zonelist_name") if named else context.zone_items()
        for zone in zones:
            name = context.names.of("zones", zone.name)
            if factor > 1.0 and name in context.section("zones"):
                held.setdefault(name, {})["storage"] = factor


@reads("ZoneHVAC:IdealLoadsAirSystem", "ZoneControl:Humidistat")
def _plants(context: Context) -> list[tuple[str, Section]]:
    """Drying and humidifying by ideal loads."""
    humidistats = {
        zone.name.casefold(): item
        for item in context.model.of("ZoneControl:Humidistat")
        for zone in context.zones_of(item, "zone_name")
    }
    held = []
    for system in context.model.of("ZoneHVAC:IdealLoadsAirSystem"):
        owner = context.systems.get(system.name)
        if owner is None:
            continue
        name = context.names.of("zones", owner)
        humidistat = humidistats.get(owner.casefold())
        plants: Section = {}
        drying = system.word("dehumidification_control_type") or "constantsensibleheatratio"
        humidifying = system.word("humidification_control_type") or "none"
        if drying == "constantsensibleheatratio" and "cooling" in context.section("zones")[name]:
            share = system.number("cooling_sensible_heat_ratio")
            plants["drying"] = {
                "sensible_heat_ratio": 0.7 if share is None else share,
                "coil_temperature": _coil(context, system),
            }
        if "cooling" in context.section("zones")[name]:
            _note_saturation(context, system)
        for key, word, which in (
            ("drying", drying, "dehumidifying"), ("humidifying", humidifying, "humidifying")
        ):  # fmt: skip
            if word == "humidistat" and humidistat is not None:
                plants[key] = {"relative_humidity": _set_point(context, humidistat, which)}
            elif word == "constantsupplyhumidityratio":
                context.findings.left_out(
                    system,
                    f"{key} by the humidity of the supply air",
                    "other humidities, the same temperatures",
                )
        held.append((name, plants))
    return held


def _note_saturation(context: Context, system: IdfObject) -> None:
    """Note that supply air of EnergyPlus is at most saturated."""
    coldest = system.number("minimum_cooling_supply_air_temperature")
    context.findings.approximated(
        system,
        "supply air that is at most saturated",
        f"in EnergyPlus it dries a damp zone to air saturated at {13.0 if coldest is None else coldest:g} "
        "degC while it cools, which it does not here: up to 20 % more relative humidity in summer",
    )


def _coil(context: Context, system: IdfObject) -> float:
    """Dew point of the driest supply air. [degC]"""
    ratio = system.number("minimum_cooling_supply_air_humidity_ratio")
    altitude = float(context.section("site").get("altitude", 0.0))
    pressure = STANDARD_PRESSURE * standard_density(altitude) / standard_density(0.0)
    percent = relative_humidity(_USUAL[0], 0.0077 if ratio is None else ratio, pressure)
    return round(float(dew_point([_USUAL[0]], [float(percent)])[0]), 4)


def _set_point(context: Context, item: IdfObject, which: str) -> Any:
    """Relative humidity of a humidistat, which EnergyPlus has in per cent."""
    keys = (f"{which}_relative_humidity_setpoint_schedule_name",
            "humidifying_relative_humidity_setpoint_schedule_name")  # fmt: skip
    values = combined(lambda percent: 0.01 * min(max(percent, 0.01), 100.0), year(context, item, *keys))
    schedule, most = fraction(context, f"{item.name} {which}", values)
    return round(most, 9) if schedule is None else {"schedule": schedule}
