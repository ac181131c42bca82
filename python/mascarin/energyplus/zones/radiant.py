"""Radiant systems in layers: electric mats in a plane of a construction, and water as radiant loads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from mascarin.energyplus.envelope.glazings import construction_of
from mascarin.energyplus.envelope.idf_surfaces import IdfOpening, IdfSurface
from mascarin.energyplus.envelope.materials import layers_of
from mascarin.energyplus.envelope.surfaces import Surfaces
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, temperature, year
from mascarin.energyplus.model.year import Year, combined
from mascarin.energyplus.zones.equipment import Plant
from mascarin.energyplus.zones.zones import Zone

MAT: Final = "ZoneHVAC:LowTemperatureRadiant:Electric"
_VARIABLE: Final = "ZoneHVAC:LowTemperatureRadiant:VariableFlow"
_CONSTANT: Final = "ZoneHVAC:LowTemperatureRadiant:ConstantFlow"
#: Classes whose water warms or cools a plane.
PANELS: Final = (_VARIABLE, _CONSTANT)
_DESIGNS: Final = tuple(f"{kind}:Design" for kind in PANELS)
#: Coefficients at a panel: radiation, and all heat of a floor, wall and ceiling by what it does [W/(m2 K)]
#: (EN ISO 11855-2; Babiak, Olesen & Petras 2007, REHVA Guidebook 7).
_RADIATED: Final = 5.5
_ALL_HEAT: Final = {
    "heating": {"floor": 11.0, "wall": 8.0, "ceiling": 6.0},
    "cooling": {"floor": 7.0, "wall": 8.0, "ceiling": 11.0},
}
#: Classes that put a plane into a construction, which they name, or which they are.
PLANE: Final = "ConstructionProperty:InternalHeatSource"
_OLDER_PLANE: Final = "Construction:InternalSource"
_GROUP: Final = "ZoneHVAC:LowTemperatureRadiant:SurfaceGroup"
#: Narrowest throttling range of EnergyPlus, which takes it in place of a smaller one [K].
_LEAST_RANGE: Final = 0.5
#: Temperatures that turn a mat there: the air here.
_OF_THE_ROOM: Final = ("operativetemperature", "meanradianttemperature")


@dataclass(frozen=True)
class Envelope:
    """What a radiant system lies in.

    Attributes
    ----------
    surfaces : dict of str to IdfSurface
        Surfaces of the file by name in small letters.
    openings : list of IdfOpening
        Windows and doors in them.
    done : Surfaces
        What has become of them.
    """

    surfaces: dict[str, IdfSurface]
    openings: list[IdfOpening]
    done: Surfaces


class _NotCarried(Exception):
    """Why a system is not carried over."""


@reads(PLANE, _OLDER_PLANE)
def describe_mats(
    context: Context, zones: dict[str, Zone], systems: dict[str, list[IdfObject]], envelope: Envelope
) -> set[str]:
    """Enter the heat sources of the mats that can be described.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    systems : dict of str to list of IdfObject
        Equipment of each zone.
    envelope : Envelope
        The surfaces.

    Returns
    -------
    set of str
        Names of the systems that are carried over.
    """
    carried = set()
    for key, zone in zones.items():
        for system in systems.get(key, []):
            if system.kind == MAT and _entered(context, zone, system, envelope):
                carried.add(system.name)
    planes = context.model.of(PLANE)
    for item in (*planes, *context.model.of(_OLDER_PLANE)):
        # Both sides of a surface between zones state the plane: one of them is used.
        for pattern in (
            "construction_name",
            "*_present_after_*",
            "temperature_calculation_*",
            "two_dimensional_*",
            "tube_spacing",
        ):
            item.fields.pass_over(pattern)
        if item.number("dimensions_for_the_ctf_calculation") == 2.0:
            context.findings.approximated(
                item, "heat between tubes in two dimensions", "a plane of one temperature in their place"
            )
    if planes and not carried:
        context.findings.no_effect(
            planes, "a plane in a construction", "nothing that is carried over releases heat in it"
        )
    return carried


@reads(MAT)
def _entered(context: Context, zone: Zone, system: IdfObject, envelope: Envelope) -> bool:
    """Whether a mat is a heat source in all its surfaces; none of it is entered otherwise."""
    try:
        power = _power(system, zone)
        thermostat = _thermostat(context, zone, system)
        planes = [
            (surface, share, _plane(context, surface, envelope))
            for surface, share in _surfaces(context, system, envelope)
        ]
    except _NotCarried as reason:
        context.findings.approximated(system, str(reason), "ideal heating in place of the mat")
        return False
    on = year(context, system, "availability_schedule_name")
    schedule, _ = fraction(context, f"{system.name} on", combined(lambda value: float(value > 0.0), on))
    for surface, share, (placed, layer) in planes:
        openings = [opening for opening in envelope.openings if opening.base.item is surface.item]
        area = g.area_of(surface.points) - sum(g.area_of(o.points) * o.copies for o in openings)
        mat: Section = {"power": round(power * share / area, 6)}
        if schedule is not None:
            mat["schedule"] = schedule
        name = context.names.of(
            "heat_sources", f"{system.name} {surface.item.name}" if len(planes) > 1 else system.name
        )
        context.section("heat_sources")[name] = {
            "surface": placed,
            "after": layer,
            "electric": mat,
            "thermostat": thermostat,
        }
    return True


def _power(system: IdfObject, zone: Zone) -> float:
    """Design power. [W]"""
    system.fields.pass_over("zone_name")
    method = system.word("heating_design_capacity_method")
    if method == "capacityperfloorarea":
        per_area = system.number("heating_design_capacity_per_floor_area")
        if per_area is not None:
            return per_area * zone.floor
    capacity = system.number("heating_design_capacity")
    if method not in ("", "heatingdesigncapacity") or capacity is None:
        raise _NotCarried("a mat that EnergyPlus sizes from design days")
    return capacity


def _thermostat(context: Context, zone: Zone, system: IdfObject) -> Section:
    """Its control, with half of the power at the set point."""
    kind = system.word("temperature_control_type")
    if kind in _OF_THE_ROOM:
        context.findings.approximated(system, f"a control by {kind}", "the air of the zone in its place")
    elif kind not in ("", "meanairtemperature"):
        raise _NotCarried(f"a mat that is turned by {kind}")
    most = max(system.number("heating_throttling_range") or 0.0, _LEAST_RANGE)
    # With 'zero', nothing is left at the set point; here it is where half of the power is.
    moved = 0.5 * most if system.word("setpoint_control_type") == "zeroflowpower" else 0.0
    points = combined(
        lambda value: value - moved, year(context, system, "heating_setpoint_temperature_schedule_name")
    )
    setpoint = temperature(context, f"{system.name} set point", points)
    return {
        "zone": zone.name,
        "setpoint": {"schedule": setpoint} if isinstance(setpoint, str) else setpoint,
        "range": most,
        "mode": "heating",
    }


@reads(_GROUP)
def _surfaces(context: Context, system: IdfObject, envelope: Envelope) -> Iterator[tuple[IdfSurface, float]]:
    """Surfaces of a system, each with its share of the power."""
    name = system.word("surface_name_or_radiant_surface_group_name")
    group = context.model.named(name, _GROUP)
    rows = [(name, 1.0)]
    if group is not None:
        rows = [
            (
                str(row.get("surface_name", "")).strip().casefold(),
                float(row.get("flow_fraction_for_surface", 0.0)),
            )
            for row in group.rows("surface_fractions")
        ]
    for key, share in rows:
        surface = envelope.surfaces.get(key)
        if surface is None:
            raise _NotCarried(f"a surface '{key}', which is no surface of the file")
        yield surface, share


def _plane(context: Context, surface: IdfSurface, envelope: Envelope) -> tuple[str, str]:
    """Surface of the description, and the layer behind whose inner side the plane is."""
    key = surface.item.name.casefold()
    placed = envelope.done.placed.get(key)
    if placed is None:
        raise _NotCarried(f"a plane in '{surface.item.name}', which is not carried over")
    construction = construction_of(context, surface.item)
    item = construction
    if construction.kind != _OLDER_PLANE:
        items = [
            held
            for held in context.model.of(PLANE)
            if held.word("construction_name") == construction.name.casefold()
        ]
        if not items:
            raise _NotCarried(f"a surface '{surface.item.name}' without a plane in its construction")
        item = items[0]
    number = int(
        item.needed("thermal_source_present_after_layer_number", "source_present_after_layer_number")
    )
    entered = context.section("surfaces")[placed]
    layers = context.section("constructions")[entered["construction"]]["layers"]
    count = len(layers_of(context, construction))
    if "adiabatic" in entered["outside"]:
        raise _NotCarried(f"a plane in '{surface.item.name}', which is adiabatic")
    if len(layers) != count or not 1 <= number < count:
        raise _NotCarried(f"a plane after layer {number} of '{construction.name}'")
    # From the other side, the layers run the other way.
    layer = layers[count - number - 1 if key in envelope.done.reversed_names else number - 1]
    return placed, layer.get("name", layer["material"])


@reads(*PANELS, *_DESIGNS)
def panel_loads(
    context: Context, system: IdfObject, envelope: Envelope
) -> dict[str, tuple[Year, Plant]] | None:
    """Heating and cooling by water in a surface, as ideal loads that are partly radiated.

    Parameters
    ----------
    context : Context
        The conversion.
    system : IdfObject
        The panel.
    envelope : Envelope
        The surfaces.

    Returns
    -------
    dict of str to tuple of (Year, Plant), or None
        Set point [degC] and load of heating and of cooling; None where it is not turned by the room.
    """
    design = context.model.named(system.text("design_object"), *_DESIGNS) or system
    for item in (system, design):
        for pattern in ("hydronic_*", "*_flow*", "*_capacity*", "rated_*", "motor_*", "*_inefficiencies_*",
                        "*_water_*", "*_circuit*", "*_range", "condensation_*", "fluid_*", "changeover_*",
                        "setpoint_control_type", "zone_name", "running_mean_*"):  # fmt: skip
            item.fields.pass_over(pattern)
    kind = design.word("temperature_control_type")
    if kind not in ("", "meanairtemperature", *_OF_THE_ROOM):
        context.findings.left_out(system, f"a panel that is turned by {kind}", "it heats and cools nothing")
        return None
    if kind in _OF_THE_ROOM:
        context.findings.approximated(system, f"a control by {kind}", "the air of the zone in its place")
    context.findings.left_out(
        system,
        "water in a surface",
        "ideal loads, partly radiated, hold its set points: neither its limits nor what the surface stores "
        "and loses. In two example files 1.3 to 2.0 K, and 12 to 31 % less heat",
    )
    on = year(context, system, "availability_schedule_name")
    shape = _panel_shape(context, system, envelope)
    loads = {}
    for which, all_heat in _ALL_HEAT.items():
        points = _panel_points(context, system, design, which)
        if points is not None:
            loads[which] = points, Plant(on, radiative=_RADIATED / all_heat[shape])
    return loads


def _panel_points(context: Context, system: IdfObject, design: IdfObject, which: str) -> Year | None:
    """Temperature about which the flow, or the temperature of the water, changes; None where it does not."""
    if system.kind == _VARIABLE:
        key = f"{which}_control_temperature_schedule_name"
        return year(context, design, key) if design.text(key) else None
    keys = [f"{which}_{end}_control_temperature_schedule_name" for end in ("low", "high")]
    if not all(system.text(key) for key in keys):
        return None
    low, high = (year(context, system, key) for key in keys)
    return combined(lambda first, second: 0.5 * (first + second), low, high)


def _panel_shape(context: Context, system: IdfObject, envelope: Envelope) -> str:
    """What a panel lies in: the first of its surfaces."""
    for surface, _ in _surfaces(context, system, envelope):
        return "ceiling" if surface.shape == "roof" else surface.shape
    return "floor"
