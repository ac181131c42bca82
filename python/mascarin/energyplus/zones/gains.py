"""Internal heat gains: people, lights, equipment."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from mascarin.energyplus.model.context import Context, Vapour
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined, constant
from mascarin.energyplus.zones.zones import Zone

_EQUIPMENT: Final = (
    "ElectricEquipment",
    "GasEquipment",
    "HotWaterEquipment",
    "SteamEquipment",
    "OtherEquipment",
)
KINDS: Final = ("People", "Lights", *_EQUIPMENT)
_ZONE_KEYS: Final = (
    "zone_or_zonelist_or_space_or_spacelist_name",
    "zone_or_zonelist_name",
    "zone_name",
)


@dataclass(frozen=True)
class Heat:
    """Heat of one object in one zone.

    Attributes
    ----------
    item : IdfObject
        The object.
    name : str
        Its name in the zone.
    power : Year
        Sensible heat. [W]
    radiative : float
        Radiative fraction. [-]
    """

    item: IdfObject
    name: str
    power: Year
    radiative: float


@reads(*KINDS)
def describe_gains(context: Context, zones: dict[str, Zone], air: dict[str, Year]) -> None:
    """Enter all internal gains.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    air : dict of str to Year
        Temperature of each at which the sensible heat of people is taken. [degC]

    Raises
    ------
    InputError
        A zone or schedule that does not exist.
    """
    by_zone: dict[str, list[Heat]] = {key: [] for key in zones}
    for item in context.model.of("People"):
        for zone in _zones(context, item, zones):
            by_zone[zone.item.name.casefold()].append(
                _people(context, item, zone, air[zone.item.name.casefold()])
            )
    for item in context.model.of("Lights"):
        for zone in _zones(context, item, zones):
            by_zone[zone.item.name.casefold()].append(_lights(context, item, zone, zones))
    for item in context.model.of(*_EQUIPMENT):
        if not any(item.text(key) for key in _ZONE_KEYS):
            context.findings.no_effect([item], "equipment without a zone", "its heat is outside of the zones")
            continue
        for zone in _zones(context, item, zones):
            by_zone[zone.item.name.casefold()].append(_equipment(context, item, zone, zones))
    for key, heats in by_zone.items():
        _enter(context, zones[key], heats)


def _zones(context: Context, item: IdfObject, zones: dict[str, Zone]) -> list[Zone]:
    """Zones of an object; a zone with the floor area of the space, where the object names a space."""
    held = []
    for zone_item, space in context.places_of(item, *_ZONE_KEYS):
        zone = zones.get(zone_item.name.casefold())
        if zone is None:
            continue
        if space is not None:
            entered_area = space.number("floor_area")
            area = entered_area or zone.spaces.get(space.name.casefold())
            zone = zone if area is None else replace(zone, floor=area)
        held.append(zone)
    return held


def people_in(context: Context, zone: Zone, zones: dict[str, Zone]) -> float:
    """Number of people in a zone at a schedule of 1."""
    return sum(
        _number_of_people(context, item, zone)
        for item in context.model.of("People")
        if any(other.name == zone.name for other in _zones(context, item, zones))
    )


def _number_of_people(context: Context, item: IdfObject, zone: Zone) -> float:
    method = item.word("number_of_people_calculation_method")
    if method.startswith("people/"):
        return zone.floor * _level(context, item, "people_per_floor_area", "people_per_zone_floor_area")
    if method.startswith("area/"):
        area = _level(context, item, "floor_area_per_person", "zone_floor_area_per_person")
        return zone.floor / area if area > 0.0 else 0.0
    return _level(context, item, "number_of_people")


def _level(context: Context, item: IdfObject, *keys: str) -> float:
    """Size of a gain; 0 where the file leaves it blank, as in EnergyPlus."""
    level = item.number(*keys)
    if level is None:
        context.findings.approximated(item, f"no value of {keys[0]}", "0 is used, as in EnergyPlus")
    return level or 0.0


def sensible(activity: float, air: float) -> float:
    """Sensible heat of a person by the heat of its activity and the air temperature. [W]

    A fit of the tables of the ASHRAE Handbook of Fundamentals, as in the EnergyPlus Engineering Reference
    (internal gains, people).
    """
    m, t = activity, air
    heat = (
        6.461927 + 0.946892 * m + 0.0000255737 * m**2 + 7.139322 * t - 0.0627909 * t * m
        + 0.0000589172 * t * m**2 - 0.198550 * t**2 + 0.000940018 * t**2 * m - 0.00000149532 * t**2 * m**2
    )  # fmt: skip
    return min(max(heat, 0.0), activity)


def _slope(activity: float, air: float) -> float:
    """Relative change of the sensible heat of a person for a kelvin. [1/K]"""
    middle = sensible(activity, air)
    return (sensible(activity, air + 0.5) - sensible(activity, air - 0.5)) / middle if middle > 0.0 else 0.0


def _people(context: Context, item: IdfObject, zone: Zone, air: Year) -> Heat:
    count = _number_of_people(context, item, zone)
    present = year(context, item, "number_of_people_schedule_name")
    activity = year(context, item, "activity_level_schedule_name", default=120.0)
    share = item.number("sensible_heat_fraction")
    released = combined(lambda presence, heat: count * presence * heat, present, activity)
    if share is None:
        power = combined(
            lambda presence, heat, room: count * presence * sensible(heat, room), present, activity, air
        )
        low, high = min(air.values), max(air.values)
        slopes = (_slope(max(activity.mean(), 1.0), room) for room in (low, high))
        change = " to ".join(dict.fromkeys(f"{100.0 * slope:+.0f}" for slope in slopes))
        used = f"{low:.1f} degC" if low == high else f"{low:.1f} to {high:.1f} degC, by season,"
        context.findings.approximated(
            item,
            "sensible heat that EnergyPlus changes with the air temperature",
            f"that at {used} is used; in EnergyPlus it changes by {change} % for each kelvin of difference"
            + ("" if context.has_vapour else "; moisture is left out"),
        )
    else:
        sensible_share = share
        power = combined(lambda presence, heat: count * presence * heat * sensible_share, present, activity)
    latent = combined(lambda total, heat: max(total - heat, 0.0), released, power)
    context.vapour.append(Vapour(item, zone.name, latent))
    return Heat(item, item.name, power, item.number("fraction_radiant") or 0.0)


def _design_level(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> float:
    method = item.word("design_level_calculation_method")
    if method in ("watts/area", "power/area"):
        keys = ("watts_per_floor_area", "watts_per_zone_floor_area", "power_per_floor_area")
        return _level(context, item, *keys, "power_per_zone_floor_area") * zone.floor
    if method in ("watts/person", "power/person"):
        level = _level(context, item, "watts_per_person", "power_per_person")
        return level * people_in(context, zone, zones)
    return _level(context, item, "design_level", "lighting_level")


def _lights(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> Heat:
    level, on = _design_level(context, item, zone, zones), year(context, item, "schedule_name")
    taken = item.number("return_air_fraction") or 0.0
    radiant, visible = (item.number(f"fraction_{part}") or 0.0 for part in ("radiant", "visible"))
    if taken > 0.0 and _still_return(context, zone):
        # Without flow in the return air, this heat stays in the zone.
        taken = 0.0
    if taken > 0.0:
        context.findings.approximated(
            item, f"{taken:.0%} of its heat in the return air", "this part does not enter the zone"
        )
    if visible > 0.0:
        context.findings.approximated(
            item, "visible radiation", "it is absorbed as long-wave radiation is: none leaves by the windows"
        )
    remaining_share = max(1.0 - taken, 1e-9)
    power = combined(lambda share: level * share * remaining_share, on)
    return Heat(item, item.name, power, min((radiant + visible) / remaining_share, 1.0))


@reads("ZoneHVAC:EquipmentConnections", "HVACTemplate:Zone:IdealLoadsAirSystem")
def _still_return(context: Context, zone: Zone) -> bool:
    """Whether a zone is conditioned, and no air loop of the file draws return air."""
    if context.model.has("AirLoopHVAC"):
        return False
    name = zone.item.name.casefold()
    connections = context.model.of("ZoneHVAC:EquipmentConnections", "HVACTemplate:Zone:IdealLoadsAirSystem")
    return any(item.word("zone_name") == name for item in connections)


def _equipment(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> Heat:
    level, on = _design_level(context, item, zone, zones), year(context, item, "schedule_name")
    latent, radiant, lost = (item.number(f"fraction_{part}") or 0.0 for part in ("latent", "radiant", "lost"))
    if latent > 0.0:
        context.vapour.append(Vapour(item, zone.name, combined(lambda share: level * share * latent, on)))
        moisture = "a source of vapour" if context.has_vapour else "moisture is left out"
        context.findings.approximated(item, f"{latent:.0%} latent heat", f"{moisture}: it heats nothing")
    remaining_share = max(1.0 - latent - lost, 0.0)
    power = combined(lambda share: level * share * remaining_share, on)
    return Heat(item, item.name, power, min(radiant / remaining_share, 1.0) if remaining_share > 0.0 else 0.0)


def _enter(context: Context, zone: Zone, heats: list[Heat]) -> None:
    """Gains of a zone; a negative one takes heat away."""
    gains: dict[str, dict[str, object]] = {}
    for heat in [part for net in heats for part in _of_one_sign(net)]:
        schedule, most = fraction(context, f"{heat.name} power", _relative(heat.power))
        power = most * _peak(heat.power)
        if power == 0.0:
            continue
        name = context.names.of(f"gains of {zone.name}", heat.name, heat.item.kind)
        gains[name] = {"power": round(power, 6)}
        if heat.radiative > 0.0:
            gains[name]["radiative"] = round(heat.radiative, 6)
        if schedule is not None:
            gains[name]["schedule"] = schedule
    if gains:
        context.section("zones")[zone.name]["gains"] = gains


def _of_one_sign(heat: Heat) -> list[Heat]:
    """A gain; one that also takes heat away in two parts, since fractions are not negative."""
    if min(heat.power.values) >= 0.0 or max(heat.power.values) <= 0.0:
        return [heat]
    return [
        replace(heat, power=combined(lambda value: max(value, 0.0), heat.power)),
        replace(heat, name=f"{heat.name} taken", power=combined(lambda value: min(value, 0.0), heat.power)),
    ]


def _peak(power: Year) -> float:
    """The largest power, with its sign. [W]"""
    return max(power.values, key=abs)


def _relative(power: Year) -> Year:
    """A power over its largest value; 1 where it is constant."""
    peak = _peak(power)
    if power.constant is not None or peak == 0.0:
        return constant(1.0)
    return combined(lambda value: value / peak, power)
