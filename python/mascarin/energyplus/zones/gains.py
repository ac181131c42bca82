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
#: Activities that a building may state. [W]
_ACTIVITIES: Final = (70.0, 500.0)
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
        Sensible heat; of people all heat. [W]
    radiative : float
        Radiative fraction. [-]
    activity : float or None
        Heat of the activity of a person, where the power is all heat of people. [W]
    """

    item: IdfObject
    name: str
    power: Year
    radiative: float
    activity: float | None = None


@reads(*KINDS)
def describe_gains(context: Context, zones: dict[str, Zone]) -> None:
    """Enter all internal gains.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.

    Raises
    ------
    InputError
        A zone or schedule that does not exist.
    """
    by_zone: dict[str, list[Heat]] = {key: [] for key in zones}
    for item in context.model.of("People"):
        for zone in _zones(context, item, zones):
            by_zone[zone.item.name.casefold()].append(_people(context, item, zone))
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


def _people(context: Context, item: IdfObject, zone: Zone) -> Heat:
    count = _number_of_people(context, item, zone)
    present = year(context, item, "number_of_people_schedule_name")
    activity = year(context, item, "activity_level_schedule_name", default=120.0)
    share = item.number("sensible_heat_fraction")
    released = combined(lambda presence, heat: count * presence * heat, present, activity)
    radiative = item.number("fraction_radiant") or 0.0
    if share is not None:
        sensible_share = share
        power = combined(lambda heat: heat * sensible_share, released)
        latent = combined(lambda heat: max(heat * (1.0 - sensible_share), 0.0), released)
        context.vapour.append(Vapour(item, zone.name, latent))
        return Heat(item, item.name, power, radiative)
    active = [heat for heat in activity.values if heat > 0.0] or [120.0]
    usual = min(max(sum(active) / len(active), _ACTIVITIES[0]), _ACTIVITIES[1])
    if min(active) != max(active) or usual != active[0]:
        context.findings.approximated(
            item,
            "an activity that changes, or is outside of the tables of people",
            f"its heat follows the schedule; the sensible part of it is that of {usual:.0f} W a person",
        )
    if not context.has_vapour:
        context.findings.approximated(
            item,
            "latent heat of people",
            "moisture is left out; their sensible heat follows the air temperature",
        )
    context.vapour.append(Vapour(item, zone.name, released, usual))
    return Heat(item, item.name, released, radiative, usual)


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
        if heat.activity is not None:
            gains[name]["activity"] = round(heat.activity, 6)
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
