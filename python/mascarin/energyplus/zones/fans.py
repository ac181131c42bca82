"""Fans of an air flow network, whose flow is given: ventilation units that the network balances."""

from __future__ import annotations

from typing import Final

from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined
from mascarin.energyplus.zones.draughts import density_of
from mascarin.energyplus.zones.zones import Zone

SPECIFIED: Final = "AirflowNetwork:MultiZone:SpecifiedFlowRate"
EXHAUST: Final = "AirflowNetwork:MultiZone:Component:ZoneExhaustFan"
FANS: Final = (SPECIFIED, EXHAUST)
_FAN: Final = "Fan:ZoneExhaust"
#: Density that a flow of mass is written with [kg/m3]; the flow is the mass over it.
_OF_MASS: Final = 1.2


@reads(SPECIFIED)
def specified_flow(context: Context, component: IdfObject, share: float, ends: tuple[Zone, ...]) -> None:
    """Enter a flow that EnergyPlus holds in a linkage: from the zone outdoors, or to the other zone.

    Parameters
    ----------
    context : Context
        The conversion.
    component : IdfObject
        The flow.
    share : float
        What it is multiplied by: the opening factor of the surface. [-]
    ends : tuple of Zone
        The zone, and the one beyond; one alone where it leads outdoors.
    """
    flow = component.needed("air_flow_value") * share
    mass = component.word("air_flow_units") != "volumetricflow"
    if flow == 0.0:
        return
    # A volume is one of the air where it comes from.
    source = "zone" if flow > 0.0 or len(ends) > 1 else "outdoors"
    part: Section = {
        "flow": round(abs(flow) / (_OF_MASS if mass else 1.0), 9),
        "density": _OF_MASS if mass else source,
    }
    if len(ends) > 1:
        between = [end.name for end in (ends if flow > 0.0 else ends[::-1])]
        name = context.names.new("air_paths", component.name)
        context.section("air_paths")[name] = {"between": between, "one_way": True, **part}
    else:
        _unit(context, component, "exhaust" if flow > 0.0 else "supply", ends[0], part)
    _balanced_by_vents(context, ends)


@reads(EXHAUST, _FAN)
def exhaust_fan(
    context: Context, component: IdfObject, share: float, zone: Zone
) -> tuple[float, float, Year] | None:
    """Enter an exhaust fan of a zone.

    Parameters
    ----------
    context : Context
        The conversion.
    component : IdfObject
        The fan in the network.
    share : float
        What its leak is multiplied by: the crack factor of the surface. [-]
    zone : Zone
        Its zone.

    Returns
    -------
    tuple of (float, float, Year) or None
        Its leak while it stands still: flow at 1 Pa [kg/s], exponent, and when; None where it always runs.
    """
    fan = context.model.require(component, "name", _FAN, name=component.name)
    for key in ("pressure_rise", "fan_total_efficiency", "*_node_name", "end_use_subcategory"):
        fan.fields.pass_over(key)
    on = year(context, fan, "availability_schedule_name")
    values = combined(
        lambda available, flow: flow if available > 0.0 else 0.0,
        on, year(context, fan, "flow_fraction_schedule_name"),
    )  # fmt: skip
    if fan.word("system_availability_manager_coupling_mode") == "coupled":
        context.findings.approximated(fan, "a fan that runs with a system", "it runs by its own schedules")
    schedule, most = fraction(context, f"{component.name} on", values)
    flow = (fan.number("maximum_flow_rate") or 0.0) * most
    if flow > 0.0:
        part: Section = {"flow": round(flow, 9), "density": density_of(context, fan, usual="standard")}
        part |= {} if schedule is None else {"schedule": schedule}
        _unit(context, component, "exhaust", zone, part)
        _balanced_by_vents(context, (zone,))
    off = combined(lambda value: float(value <= 0.0), values)
    key = "when_the_zone_exhaust_fan_is_off_at_reference_conditions"
    leak = component.number(f"air_mass_flow_coefficient_{key}") or 0.0
    exponent = component.number("air_mass_flow_exponent_when_the_zone_exhaust_fan_is_off") or 0.65
    return None if off.constant == 0.0 or leak == 0.0 else (leak * share, exponent, off)


def _unit(context: Context, component: IdfObject, way: str, zone: Zone, part: Section) -> None:
    name = context.names.new("ventilation_units", component.name)
    context.section("ventilation_units")[name] = {way: {zone.name: part}}


def _balanced_by_vents(context: Context, ends: tuple[Zone, ...]) -> None:
    for zone in ends:
        context.section("zones")[zone.name]["makeup_air"] = "vents"


def check_makeup(context: Context) -> None:
    """Let leaks balance the fans of zones that no vent joins with outdoors."""
    vents = context.section("vents").values()
    joined = {vent["zone"] for vent in vents if "zone" in vent}
    pairs = [set(vent["between"]) for vent in vents if "between" in vent]
    while True:
        wider = joined.union(*(pair for pair in pairs if joined & pair))
        if wider == joined:
            break
        joined = wider
    for name, zone in context.section("zones").items():
        if zone.get("makeup_air") == "vents" and name not in joined:
            zone["makeup_air"] = "outdoors"


def still(context: Context, name: str, off: Year) -> Section:
    """Schedule of a leak that is there while a fan stands still; none where that is always."""
    schedule, _ = fraction(context, f"{name} still", off)
    return {} if schedule is None else {"schedule": schedule}
