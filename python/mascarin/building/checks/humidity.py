"""How the humidity must fit the rest of a building, and what is worth saying about it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

from mascarin.building.base.leaves import leaves
from mascarin.building.base.number import quantity_of
from mascarin.building.base.part import fault
from mascarin.building.parameters.set_point_pairs import first_crossing
from mascarin.building.parts.air.humidity import (
    CoolingCoil,
    Humidistat,
    Humidity,
    VapourGain,
    ZoneHumidity,
)
from mascarin.building.parts.air.zone import Gain
from mascarin.building.parts.materials.material import Resistance
from mascarin.building.parts.moisture_surfaces import vapour_sides
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.parts.description import Description

Faults = Iterator["InitErrorDetails"]

#: Names in one line of text at most.
_NAMED = 6

#: Difference of the heat of people in two sections that is none: enthalpies of vapour, by which programs
#: divide latent heat, differ from 2.45 to 2.55 MJ/kg. [-]
_SAME_PEOPLE: Final = 0.05
#: What gains without a schedule follow.
_ALWAYS: Final = "no schedule"


def humidity_faults(building: Description) -> Faults:
    """Errors between the humidity and the rest of a building."""
    humidity = building.humidity
    if humidity is None:
        return
    yield from _materials_hold_moisture(building, humidity)
    yield from _units_can_recover(building, humidity)
    for name, zone in humidity.zones.items():
        yield from _plants_can_act(building, name, zone)


def _materials_hold_moisture(building: Description, humidity: Humidity) -> Faults:
    for name in humidity.materials:
        if isinstance(building.materials[name], Resistance):
            yield fault(
                ("humidity", "materials", name),
                f"'{name}', a resistance without thickness",
                "a material with a density",
                "Remove it here, or give the material conductivity, density and specific_heat.",
            )


def _units_can_recover(building: Description, humidity: Humidity) -> Faults:
    for name in humidity.recovery:
        location = ("humidity", "recovery", name)
        unit = building.ventilation_units.get(name)
        if unit is None:
            hint = did_you_mean(name, building.ventilation_units)
            yield fault(
                location,
                f"'{name}'",
                "the name of a unit under 'ventilation_units:'",
                hint or "Add the unit there.",
            )
        elif not unit.supply or not unit.exhaust:
            yield fault(
                location,
                "recovery of vapour in a unit that does not both supply and extract air",
                "a unit with supply and exhaust",
                "Remove it, or add the other flow.",
            )


def _plants_can_act(building: Description, name: str, zone: ZoneHumidity) -> Faults:
    location = ("humidity", "zones", name)
    if isinstance(zone.drying, CoolingCoil) and building.zones[name].cooling is None:
        yield fault(
            (*location, "drying"),
            "a cooling coil in a zone without cooling",
            "cooling of the zone",
            f"Add 'zones.{name}.cooling:', or dry to a set point: 'drying: {{relative_humidity: 0.6}}'.",
        )
    for which, plant in zone.plants.items():
        yield from _schedules_are_humidities(building, (*location, which), plant)
    dry, wet = zone.plants.get("drying"), zone.plants.get("humidifying")
    if dry is None or wet is None or dry.setpoint[0] != wet.setpoint[0]:
        return
    key, high, low = dry.setpoint[0], dry.setpoint[1], wet.setpoint[1]
    crossing = first_crossing(building, (low.constant, low.schedule), (high.constant, high.schedule))
    if crossing is not None:
        when, least, most = crossing
        always = low.constant is not None and high.constant is not None
        yield fault(
            (*location, "humidifying", key),
            f"{least:g}, above {most:g} of drying{'' if always else f', on {when}'}",
            "a set point of humidifying that is not above that of drying",
            "Exchange the two, or leave one out." if always else "Lower the one or raise the other.",
        )


def _schedules_are_humidities(building: Description, location: tuple[str, ...], plant: Humidistat) -> Faults:
    """Values of schedules that are no humidity of the kind, or dry the air to nothing."""
    key, setpoint = plant.setpoint
    if setpoint.schedule is None:
        return
    schedule = building.schedules[setpoint.schedule]
    quantity = quantity_of(type(setpoint).model_fields["constant"])
    if schedule.kind != setpoint.SCHEDULED or quantity is None:
        return  # the kind is compared with the use of all schedules
    most, drying = quantity.limits.upper, location[-1] == "drying"
    values = [float(number) for _, number, _ in leaves(schedule)]
    wrong = [value for value in values if value > most or (drying and value <= 0.0)]
    if wrong:
        yield fault(
            (*location, key, "schedule"),
            f"'{setpoint.schedule}' with {wrong[0]:g}",
            f"values {'above' if drying else 'from'} 0, up to {most:g} [{quantity.unit}]",
            "Correct them. To turn the plant off, give its capacity a schedule: 'schedule:' beside it.",
        )


def humidity_lines(building: Description) -> Iterator[str]:
    """The humidity in lines of text, for `Building.check`."""
    humidity = building.humidity
    if humidity is None:
        return
    sides = list(vapour_sides(building))
    taking = sorted({side.surface for side in sides if side.takes_up})
    yield (
        f"humidity: {len(building.zones)} vapour balances, {_listed(taking) or 'no surface'} "
        f"take{'s' if len(taking) == 1 or not taking else ''} up vapour"
    )
    for name, zone in humidity.zones.items():
        for key, gain in zone.gains.items():
            words = f"{gain.power:g} W" if gain.power is not None else gain.in_words("kg/s")
            people = "" if gain.activity is None else f" from people at {gain.activity:g} W each, latent part"
            yield f"zone {name}: vapour of {key}, {words}{people}"
        for which in ("drying", "humidifying"):
            plant = getattr(zone, which)
            if plant is not None:
                yield f"zone {name}: {which} by {plant.words}"


def humidity_warnings(building: Description) -> Iterator[str]:
    """What is likely to be an oversight."""
    humidity = building.humidity
    if humidity is None:
        return
    yield from _people_differ(building, humidity)
    sides = list(vapour_sides(building))
    unknown = {side.material: side.surface for side in sides if not side.takes_up and not side.sealed}
    if unknown:
        yield (
            f"humidity: no sorption data of {_listed(list(unknown))}, the material at surfaces such as "
            f"{next(iter(unknown.values()))}: these take up no vapour, and the humidity of the room "
            "swings more. Add 'humidity.materials: {NAME: gypsum}' (or plaster, concrete, brick, wood, "
            "plywood, carpet, or own numbers), or 'humidity.surfaces: {NAME: {sealed: true}}'"
        )
    reached = {side.material for side in sides}
    hidden = [name for name in humidity.materials if name not in reached]
    if hidden:
        yield (
            f"humidity.materials: {_listed(hidden)} is at no surface in a zone; only the material at the "
            "surface takes up vapour. Remove it there"
        )
    taking = {side.surface for side in sides if side.takes_up}
    painted = [
        name for name, entry in humidity.surfaces.items() if entry.paint is not None and name not in taking
    ]
    if painted:
        yield f"humidity.surfaces: paint of {_listed(painted)} has no effect: the surface takes up no vapour"


def _people_differ(building: Description, humidity: Humidity) -> Iterator[str]:
    """Zones whose people give other heat as heat than as vapour."""
    for name, zone in building.zones.items():
        sources = humidity.zones[name].gains.values()
        if any(gain.activity is not None and gain.column is not None for gain in zone.gains.values()):
            continue
        heat = sum(float(gain.power or 0.0) for gain in zone.gains.values() if gain.activity is not None)
        vapour = sum(float(gain.power or 0.0) for gain in sources if gain.activity is not None)
        if abs(heat - vapour) > _SAME_PEOPLE * max(heat, vapour):
            yield (
                f"zone {name}: people give {heat:g} W in zones.{name}.gains and {vapour:g} W in "
                f"humidity.zones.{name}.gains: their sensible heat and their vapour do not belong together. "
                "State the same power and activity in both"
            )
            continue
        courses = [_people_by_schedule(building, gains) for gains in (zone.gains.values(), sources)]
        different = [
            schedule
            for schedule in sorted({*courses[0], *courses[1]})
            if abs(courses[0].get(schedule, 0.0) - courses[1].get(schedule, 0.0)) > _SAME_PEOPLE * heat
        ]
        if different:
            yield (
                f"zone {name}: people follow other schedules in zones.{name}.gains than in "
                f"humidity.zones.{name}.gains ({_listed(different)}): their sensible heat and their vapour "
                "do not come at the same time. State the same schedule in both"
            )


def _people_by_schedule(building: Description, gains: Iterable[Gain | VapourGain]) -> dict[str, float]:
    """Heat of people by what they follow. [W]"""
    heat: dict[str, float] = {}
    for gain in gains:
        if gain.activity is None:
            continue
        course = _ALWAYS if gain.schedule is None else _first_alike(building, gain.schedule)
        heat[course] = heat.get(course, 0.0) + float(gain.power or 0.0)
    return heat


def _first_alike(building: Description, name: str) -> str:
    """The first schedule of a building with the values of another one."""
    return next(other for other, course in building.schedules.items() if course == building.schedules[name])


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(names[:_NAMED]) + more
