"""Heat of water in zones: losses of tanks, and use of warm water."""

from __future__ import annotations

import math
from datetime import date, timedelta
from typing import Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import DAYS, Year, combined, constant, year_of
from mascarin.energyplus.zones.zones import Zone

_MIXED: Final = ("WaterHeater:Mixed", "ThermalStorage:ChilledWater:Mixed")
_LAYERED: Final = (
    "WaterHeater:Stratified",
    "ThermalStorage:ChilledWater:Stratified",
    "ThermalStorage:HotWater:Stratified",
)
#: Set points of a tank by the names of its classes.
_SET_POINTS: Final = (
    "setpoint_temperature_schedule_name",
    "heater_1_setpoint_temperature_schedule_name",
    "top_setpoint_temperature_schedule_name",
)
#: Density [kg/m3] and specific heat [J/(kg K)] of water in the use of water, as in EnergyPlus.
_WATER: Final = (999.9, 4180.0)
#: Temperature of the mains where the file says nothing, as in EnergyPlus [degC].
_MAINS: Final = 10.0
#: A year without a leap day, for the weeks of the temperature of the mains.
_YEAR: Final = 2017
#: Height over diameter of a tank whose height is not stated [-].
_SLENDER: Final = 1.0


def describe_water(context: Context, zones: dict[str, Zone], air: dict[str, float]) -> None:
    """Enter what tanks and the use of water give to zones.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    air : dict of str to float
        Usual temperature of each. [degC]

    Raises
    ------
    InputError
        A zone or schedule that does not exist.
    """
    _tanks(context, zones, air)
    _uses(context, zones, air)


@reads(*_MIXED, *_LAYERED)
def _tanks(context: Context, zones: dict[str, Zone], air: dict[str, float]) -> None:
    for item in context.model.of(*_MIXED, *_LAYERED):
        if item.word("ambient_temperature_indicator") != "zone":
            context.findings.no_effect([item], "not needed", "its losses are outside of the zones")
            continue
        owner = context.model.require(item, "ambient_temperature_zone_name", "Zone")
        zone = zones.get(owner.name.casefold())
        if zone is None:
            continue
        if not any(item.text(key) for key in _SET_POINTS):
            context.findings.left_out(
                item, "a tank without a set point", "the heat between this tank and its zone is missing"
            )
            continue
        conductance = _loss(item)
        band = item.number("deadband_temperature_difference", "heater_1_deadband_temperature_difference")
        kind = -1.0 if "chilled" in item.kind.casefold() else 1.0
        water = combined(
            lambda point, half=0.5 * kind * (band or 0.0): point - half, year(context, item, *_SET_POINTS)
        )
        context.findings.approximated(
            item,
            f"losses of {conductance:.3g} W/K to zone '{owner.name}'",
            "the tank is in the middle of its dead band: temperatures within some tenths of a kelvin; "
            "its parasitic heat is left out",
        )
        _enter(context, item, zone, combined(lambda _, g=conductance: g, water), water, air)


def _loss(item: IdfObject) -> float:
    """Conductance between a tank and its zone. [W/K]"""
    share = item.number("off_cycle_loss_fraction_to_zone", "skin_loss_fraction_to_zone")
    share = 1.0 if share is None else share
    coefficient = item.number(
        "off_cycle_loss_coefficient_to_ambient_temperature", "heat_gain_coefficient_from_ambient_temperature"
    )
    if item.kind in _MIXED:
        return share * (coefficient or 0.0)
    skin = item.number(
        "uniform_skin_loss_coefficient_per_unit_area_to_ambient_temperature",
        "uniform_skin_loss_coefficient_per_unit_area_to_ambient_temperature",
        "heat_gain_coefficient_from_ambient_temperature",
    )
    volume, height = item.number("tank_volume") or 0.0, item.number("tank_height") or 0.0
    if height <= 0.0:
        height = (4.0 * volume * _SLENDER**2 / math.pi) ** (1.0 / 3.0)
    base = volume / max(height, 1e-9)
    around = 2.0 * math.sqrt(math.pi * base) * height
    nodes = sum(item.number(f"node_{k}_additional_loss_coefficient") or 0.0 for k in range(1, 13))
    return share * ((skin or 0.0) * (2.0 * base + around) + nodes)


@reads("WaterUse:Equipment")
def _uses(context: Context, zones: dict[str, Zone], air: dict[str, float]) -> None:
    for item in context.model.of("WaterUse:Equipment"):
        if not item.text("zone_name"):
            context.findings.no_effect([item], "not needed", "water outside of the zones")
            continue
        owner = context.model.require(item, "zone_name", "Zone")
        zone = zones.get(owner.name.casefold())
        if zone is None:
            continue
        if item.text("latent_fraction_schedule_name"):
            latent = year(context, item, "latent_fraction_schedule_name")
            if max(latent.values) > 0.0:
                context.findings.left_out(item, "vapour of the water", "no moisture enters the zone")
        if not item.text("sensible_fraction_schedule_name"):
            context.findings.no_effect([item], "not needed", "its water gives no heat to the zone")
            continue
        flow = item.number("peak_flow_rate") or 0.0
        capacity = flow * _WATER[0] * _WATER[1]
        conductance = combined(
            lambda on, share, capacity=capacity: capacity * on * share,
            year(context, item, "flow_rate_fraction_schedule_name"),
            year(context, item, "sensible_fraction_schedule_name"),
        )
        water = _mixed_temperature(context, item)
        _enter(context, item, zone, conductance, water, air)


@reads("Site:WaterMainsTemperature")
def _mixed_temperature(context: Context, item: IdfObject) -> Year:
    """Temperature of the water at the tap: its target between cold and hot, or cold. [degC]"""
    cold = _cold(context, item)
    if not item.text("target_temperature_schedule_name"):
        return cold
    target = year(context, item, "target_temperature_schedule_name")
    if not item.text("hot_water_supply_temperature_schedule_name"):
        return target
    hot = year(context, item, "hot_water_supply_temperature_schedule_name")
    return combined(lambda aim, low, high: max(min(aim, high), low), target, cold, hot)


def _cold(context: Context, item: IdfObject) -> Year:
    """Temperature of cold water. [degC]"""
    if item.text("cold_water_supply_temperature_schedule_name"):
        return year(context, item, "cold_water_supply_temperature_schedule_name")
    mains = context.model.one("Site:WaterMainsTemperature")
    if mains is not None and mains.word("calculation_method") == "schedule":
        return year(context, mains, "temperature_schedule_name")
    mean = None if mains is None else mains.number("annual_average_outdoor_air_temperature")
    if mains is None or mean is None or mains.word("calculation_method") != "correlation":
        return constant(_MAINS)
    swing = mains.number("maximum_difference_in_monthly_average_outdoor_air_temperatures") or 0.0
    south = float(context.section("site").get("latitude", 0.0)) < 0.0
    factor, shift = mains.number("temperature_multiplier"), mains.number("temperature_offset") or 0.0
    factor = 1.0 if factor is None else factor
    dates = [(date(_YEAR, 1, 1) + timedelta(days=min(day, 364))) for day in range(6, 371, 7)]
    values = [
        factor * mains_temperature(mean, swing, float(when.timetuple().tm_yday - 3), south=south) + shift
        for when in dates
    ]
    return year_of(
        [
            (f"{when:%m-%d}", (((0, round(value, 2)),),) * len(DAYS))
            for when, value in zip(dates, values, strict=True)
        ]
    )


def mains_temperature(mean: float, swing: float, day: float, *, south: bool = False) -> float:
    """Temperature of cold water by the outdoor air of the place. [degC]

    The correlation of EnergyPlus (Engineering Reference, water mains temperatures), in degF: ``T = m + 6 +
    r s/2 sin(0.986 (day - 15 - lag) - 90)`` with ``r = 0.4 + 0.01 (m - 44)`` and ``lag = 35 - (m - 44)``; not
    below 0 degC. Hendron, Anderson, Christensen, Eastment & Reeves 2004, NREL/CP-550-36011.

    Parameters
    ----------
    mean : float
        Mean temperature of the outdoor air over the year. [degC]
    swing : float
        Difference of its warmest and coldest monthly means. [K]
    day : float
        Day of the year. [d]
    south : bool, optional
        Whether the place is south of the equator.

    Examples
    --------
    >>> round(mains_temperature(10.0, 20.0, 48.0), 2), round(mains_temperature(10.0, 0.0, 48.0), 2)
    (8.74, 13.33)
    """
    warm = 1.8 * mean + 32.0
    ratio, lag = 0.4 + 0.01 * (warm - 44.0), 35.0 - (warm - 44.0)
    angle = math.radians(0.986 * (day - 15.0 - lag) + (90.0 if south else -90.0))
    return max((warm + 6.0 + 0.5 * 1.8 * swing * ratio * math.sin(angle) - 32.0) / 1.8, 0.0)


def _enter(
    context: Context, item: IdfObject, zone: Zone, conductance: Year, water: Year, air: dict[str, float]
) -> None:
    """Heat by a conductance to a temperature: a thermal bridge where both are constant, else a gain."""
    section = context.section("zones")[zone.name]
    name = context.names.of(f"gains of {zone.name}", item.name, item.kind)
    if conductance.constant is not None and water.constant is not None:
        if conductance.constant > 0.0:
            section.setdefault("thermal_bridges", {})[name] = {
                "chi": round(conductance.constant, 6),
                "ground": {"temperature": water.constant},
            }
        return
    usual = air[zone.item.name.casefold()]
    power = combined(lambda factor, level: factor * (level - usual), conductance, water)
    peak = max(power.values, key=abs)
    if peak == 0.0:
        return
    context.findings.approximated(
        item,
        f"heat of up to {peak:.0f} W that falls with the temperature of the zone",
        f"that of a zone at {usual:.0f} degC is used: {max(conductance.values):.3g} W less for each kelvin "
        "above",
    )
    share = combined(lambda value: max(value / peak, 0.0), power)
    schedule, most = fraction(
        context, f"{item.name} heat", share if share.constant is None else constant(1.0)
    )
    gain = {"power": round(peak * most, 6)}
    section.setdefault("gains", {})[name] = gain | ({} if schedule is None else {"schedule": schedule})
