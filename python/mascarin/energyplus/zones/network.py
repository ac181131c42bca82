"""Air flow networks: cracks, openings, the wind on them, and what opens them, as vents and controls."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mascarin.energyplus.envelope.idf_surfaces import IdfOpening, IdfSurface
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined
from mascarin.energyplus.zones.fans import (
    EXHAUST,
    FANS,
    SPECIFIED,
    check_makeup,
    exhaust_fan,
    specified_flow,
    still,
)
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import STANDARD_PRESSURE

_CRACKS: Final = (
    "AirflowNetwork:MultiZone:Surface:Crack",
    "AirflowNetwork:MultiZone:Surface:EffectiveLeakageArea",
)
_OPENINGS: Final = (
    "AirflowNetwork:MultiZone:Component:DetailedOpening", "AirflowNetwork:MultiZone:Component:SimpleOpening",
)  # fmt: skip
_COMPONENTS: Final = (
    *_CRACKS, *_OPENINGS, "AirflowNetwork:MultiZone:Component:HorizontalOpening", *FANS,
)  # fmt: skip
NETWORK: Final = (
    "AirflowNetwork:SimulationControl", "AirflowNetwork:MultiZone:Zone", "AirflowNetwork:MultiZone:Surface",
    *_COMPONENTS, "AirflowNetwork:MultiZone:ReferenceCrackConditions",
    "AirflowNetwork:MultiZone:ExternalNode",
    "AirflowNetwork:MultiZone:WindPressureCoefficientArray",
    "AirflowNetwork:MultiZone:WindPressureCoefficientValues",
)  # fmt: skip
#: Density of air at the reference conditions of cracks, 20 degC at sea level [kg/m3], and the discharge
#: coefficient and pressure [-, Pa] that a leak of Mascarin refers to.
_REFERENCE_DENSITY, _DISCHARGE, _REFERENCE = 1.2041, 0.65, 4.0
#: Least area of a vent [m2], and directions of a table of pressure coefficients.
_LEAST_AREA, _DIRECTIONS = 1e-7, 36
#: Parts into which an opening is divided that closes as it gets colder outdoors.
_PARTS: Final = 4


@dataclass(frozen=True)
class Joint:
    """Where a component of the network lies.

    Attributes
    ----------
    item : IdfObject
        The surface or opening.
    ends : tuple of Zone
        The zone, and the one beyond; one alone where it leads outdoors.
    points : ndarray, shape (n, 3)
        Its corners. [m]
    wall : IdfSurface
        The surface that it is, or lies in.
    """

    item: IdfObject
    ends: tuple[Zone, ...]
    points: g.Array
    wall: IdfSurface

    @property
    def elevation(self) -> float:
        """Of its middle. [m]"""
        return float(0.5 * (self.points[:, 2].min() + self.points[:, 2].max()))


@reads(*NETWORK)
def describe_network(
    context: Context, zones: dict[str, Zone], surfaces: list[IdfSurface], openings: list[IdfOpening]
) -> None:
    """Enter the vents of an air flow network and their controls.

    Raises
    ------
    InputError
        An object that it names does not exist.
    """
    joints = dict(_joints(zones, surfaces, openings))
    if not context.model.of("AirflowNetwork:MultiZone:Surface"):
        for item in context.model.of("AirflowNetwork:SimulationControl"):
            context.findings.left_out(item, "a network without surfaces", "no outdoor air enters any zone")
    lowest = min((float(joint.points[:, 2].min()) for joint in joints.values()), default=0.0)
    for item in context.model.of("AirflowNetwork:MultiZone:Surface"):
        joint = joints.get(item.word("surface_name"))
        if joint is None:
            context.findings.left_out(item, "a surface that joins no air", "no air passes here")
            continue
        component = context.model.require(item, "leakage_component_name", *_COMPONENTS)
        ends: Section = (
            {"zone": joint.ends[0].name}
            if len(joint.ends) == 1
            else {"between": [end.name for end in joint.ends]}
        )
        ends |= {"elevation": round(max(joint.elevation, min(lowest, 0.0)), 6)}
        if len(joint.ends) == 1:
            ends |= _wind(context, item, joint)
        if component.kind in _CRACKS:
            _crack(context, item, ends, *_leak(context, component))
        elif component.kind in _OPENINGS:
            _opening(context, item, joint, component, ends)
        elif component.kind in FANS:
            _fan(context, item, joint, component, ends)
        else:
            context.findings.left_out(item, f"a {component.kind}", "no air passes here")
    check_makeup(context)


def _fan(context: Context, item: IdfObject, joint: Joint, component: IdfObject, ends: Section) -> None:
    """A flow whatever the pressures; an exhaust fan that stands still leaks."""
    share = item.number("window_door_opening_factor_or_crack_factor")
    share = 1.0 if share is None else share
    if component.kind == SPECIFIED:
        specified_flow(context, component, share, joint.ends)
    elif component.kind == EXHAUST:
        leak = exhaust_fan(context, component, share, joint.ends[0])
        if leak is not None:
            flow, exponent, off = leak
            _crack(context, item, ends | still(context, component.name, off), flow / share, exponent)


def _joints(
    zones: dict[str, Zone], surfaces: list[IdfSurface], openings: list[IdfOpening]
) -> Iterator[tuple[str, Joint]]:
    by_name = {surface.item.name.casefold(): surface for surface in surfaces}

    def ends(surface: IdfSurface) -> tuple[Zone, ...] | None:
        own_zone = zones.get(surface.zone.name.casefold())
        if own_zone is None or surface.boundary == "outdoors":
            return None if own_zone is None else (own_zone,)
        other = by_name.get(surface.beyond.casefold())
        name = surface.beyond if surface.boundary == "zone" else "" if other is None else other.zone.name
        beyond = zones.get(name.casefold())
        return None if beyond is None or beyond is own_zone else (own_zone, beyond)

    for surface in surfaces:
        joined = ends(surface)
        if joined is not None:
            yield surface.item.name.casefold(), Joint(surface.item, joined, surface.points, surface)
    for opening in openings:
        joined = ends(opening.base)
        if joined is not None:
            yield opening.item.name.casefold(), Joint(opening.item, joined, opening.points, opening.base)


def _leak(context: Context, item: IdfObject) -> tuple[float, float]:
    """Mass flow at 1 Pa and exponent of a crack. [kg/s, -]"""
    if item.kind.endswith("Crack"):
        _note_reference_air(context, item)
        flow = item.needed("air_mass_flow_coefficient_at_reference_conditions")
        return flow, item.number("air_mass_flow_exponent") or 0.65
    area, pressure = (
        item.needed("effective_leakage_area"),
        item.number("reference_pressure_difference") or 4.0,
    )
    exponent = item.number("air_mass_flow_exponent") or 0.65
    discharge = item.number("discharge_coefficient") or 1.0
    flow = area * discharge * math.sqrt(2.0 * _REFERENCE_DENSITY) * pressure ** (0.5 - exponent)
    return flow, exponent


#: Temperature [degC] and pressure [Pa] of the air for which EnergyPlus takes the coefficient of a crack.
_REFERENCE_AIR: Final = (20.0, STANDARD_PRESSURE)
#: Difference of density below which air passes one way only, that is not worth a word. [kg/m3]
_SMALL_DIFFERENCE: Final = 1e-3


def _note_reference_air(context: Context, component: IdfObject) -> None:
    """The coefficient of a crack is for air of its own conditions, where an object states them.

    A crack that names none has those of the only object (Input Output Reference); of several, none.
    """
    name, kind = (
        component.text("reference_crack_conditions"),
        "AirflowNetwork:MultiZone:ReferenceCrackConditions",
    )
    stated_items = context.model.of(kind)
    item = context.model.named(name, kind) if name else stated_items[0] if len(stated_items) == 1 else None
    if item is None:
        return
    usual, pressure = _REFERENCE_AIR
    temperature = item.number("reference_temperature")
    stated = (
        usual if temperature is None else temperature,
        item.number("reference_barometric_pressure") or pressure,
    )
    item.fields.pass_over("reference_humidity_ratio")
    if abs(stated[0] - usual) > 1.0 or abs(stated[1] / pressure - 1.0) > 0.01:
        context.findings.approximated(
            component,
            f"a crack measured with air of {stated[0]:g} degC and {stated[1]:g} Pa",
            "taken as measured at 20 degC and 101325 Pa: its flow changes with the ratio of the densities",
        )


def _note_two_ways(context: Context, component: IdfObject) -> None:
    least = component.number("minimum_density_difference_for_two_way_flow") or 0.0
    if least > _SMALL_DIFFERENCE:
        context.findings.approximated(
            component,
            f"flow in both directions from a difference of {least:g} kg/m3 on",
            f"from the least difference on here; the difference is that of {least / 1.2 * 293.0:.1f} K",
        )


def _crack(
    context: Context, item: IdfObject, ends: Section, flow: float, exponent: float, length: float = 1.0
) -> None:
    """A leak that passes a mass flow at 1 Pa [kg/s]."""
    share = (item.number("window_door_opening_factor_or_crack_factor") or 1.0) if length == 1.0 else 1.0
    at_reference = _DISCHARGE * math.sqrt(2.0 * _REFERENCE_DENSITY) * _REFERENCE ** (0.5 - exponent)
    area = flow * share * length / at_reference
    if area < _LEAST_AREA:
        return
    _vent(
        context,
        f"{item.text('surface_name')} leak",
        ends | {"area": round(area, 10), "discharge": _DISCHARGE, "exponent": exponent},
    )


def _vent(context: Context, name: str, vent: Section) -> None:
    context.section("vents")[context.names.new("vents", name)] = vent


def _opening(context: Context, item: IdfObject, joint: Joint, component: IdfObject, ends: Section) -> None:
    """A window or door: a leak where it is closed, and what its control opens."""
    height = float(np.ptp(joint.points[:, 2]))
    width = g.area_of(joint.points) / max(height, 1e-9)
    coefficient = component.number("air_mass_flow_coefficient_when_opening_is_closed") or 0.0
    exponent = component.number("air_mass_flow_exponent_when_opening_is_closed") or 0.65
    _crack(context, item, ends, coefficient, exponent, length=2.0 * (width + height))
    share = item.number("window_door_opening_factor_or_crack_factor")
    share = 1.0 if share is None else share
    for part, values, control in _ventings(context, item, joint):
        wide, high, discharge = _opened(context, component, share)
        area = width * wide * height * high * part
        if area < _LEAST_AREA or values.constant == 0.0:
            continue
        schedule, most = fraction(context, f"{joint.item.name} open", values)
        vent = ends | {
            "area": round(area * min(most, 1.0), 9),
            "height": round(height * high, 6),
            "discharge": round(discharge, 6),
        }
        vent |= {} if schedule is None else {"schedule": schedule}
        vent |= {} if control is None else {"control": control}
        _vent(context, f"{joint.item.name} opening", vent)


def _opened(context: Context, component: IdfObject, share: float) -> tuple[float, float, float]:
    """Width and height factors and discharge coefficient at an opening factor, linear between given ones."""
    if component.kind.endswith("SimpleOpening"):
        _note_two_ways(context, component)
        return share, 1.0, component.number("discharge_coefficient") or 1.0
    if component.word("type_of_rectangular_large_vertical_opening_lvo_").startswith("horizontallypivoted"):
        context.findings.approximated(component, "a pivoted window", "a window that is not pivoted")
    rows = [{key: component.number(f"{key}_{k}") or 0.0 for key in (
        "opening_factor", "width_factor_for_opening_factor", "height_factor_for_opening_factor",
        "discharge_coefficient_for_opening_factor")} for k in range(
            1, round(component.number("number_of_sets_of_opening_factor_data") or 2) + 1)]  # fmt: skip
    factors = [row["opening_factor"] for row in rows]

    def at(key: str) -> float:
        values = [row[f"{key}_for_opening_factor"] for row in rows]
        return float(np.interp(share, factors, values))

    return at("width_factor"), at("height_factor"), at("discharge_coefficient")


def _ventings(context: Context, item: IdfObject, joint: Joint) -> Iterator[tuple[float, Year, str | None]]:
    """Parts of an opening, their schedules and controls."""
    source, zone = item, joint.ends[0]
    mode = item.word("ventilation_control_mode")
    if mode in ("", "zonelevel"):
        controlled = [
            other
            for other in context.model.of("AirflowNetwork:MultiZone:Zone")
            if other.word("zone_name") == zone.item.name.casefold()
        ]
        if not controlled:
            return
        source = controlled[0]
        mode = source.word("ventilation_control_mode")
    available = year(context, source, "venting_availability_schedule_name")
    if mode in ("novent", ""):
        return
    if mode == "constant":
        yield 1.0, available, None
        return
    if mode != "temperature":
        context.findings.left_out(
            source, f"opened by {mode}", "its windows stay closed: no air enters by them, warmer zones"
        )
        return
    points = year(
        context,
        source,
        "ventilation_control_zone_temperature_setpoint_schedule_name",
        "ventilation_control_zone_temperature_set_point_schedule_name",
        default=-60.0,
    )
    low, high, least = (
        source.number(key) or 0.0
        for key in (
            "indoor_and_outdoor_temperature_difference_lower_limit_for_maximum_venting_open_factor",
            "indoor_and_outdoor_temperature_difference_upper_limit_for_minimum_venting_open_factor",
            "minimum_venting_open_factor",
        )
    )
    modulated = least < 1.0 and high < 60.0
    if modulated:
        context.findings.approximated(
            source,
            "windows that close as it gets colder outdoors",
            f"in {_PARTS} parts, by the outdoor air that is as much colder than the set point",
        )
    for point in sorted(points.values):
        active = combined(lambda share, now, point=point: share if now == point else 0.0, available, points)
        always: dict[str, float] = {"indoor": point, "difference": 0.0}
        if not modulated:
            yield 1.0, active, _control(context, zone, always)
            continue
        if least > 0.0:
            yield least, active, _control(context, zone, always)
        for k in range(_PARTS):
            colder = low + (k + 0.5) / _PARTS * (high - low)
            limits = always | {"outdoor": point - colder}
            yield (1.0 - least) / _PARTS, active, _control(context, zone, limits)


def _control(context: Context, zone: Zone, limits: dict[str, float]) -> str:
    bands = {
        key: {"open": round(limit, 6), "close": round(limit, 6)}
        for key, limit in limits.items()
        if limit > -60.0
    }
    control: Section = {"zone": zone.name} | bands
    held = context.section("controls")
    for name, other in held.items():
        if other == control:
            return str(name)
    name = context.names.new("controls", f"windows of {zone.name}")
    held[name] = control
    return name


@reads("AirflowNetwork:MultiZone:ExternalNode", "AirflowNetwork:SimulationControl")
def _wind(context: Context, item: IdfObject, joint: Joint) -> dict[str, Any]:
    """Pressure of the wind on an opening."""
    control = context.model.one("AirflowNetwork:SimulationControl")
    azimuth = g.azimuth_of(joint.points) % 360.0
    if control is None or control.word("wind_pressure_coefficient_type") != "input":
        return _by_shape(context, item, control, joint, azimuth)
    # The shape of the building has no effect beside coefficients of the file.
    for pattern in ("building_type", "azimuth_angle_of_long_axis*", "ratio_of_building_width*"):
        control.fields.pass_over(pattern)
    node = context.model.named(item.text("external_node_name"), "AirflowNetwork:MultiZone:ExternalNode")
    if node is None:
        context.findings.left_out(item, "no external node", "no wind reaches it")
        return {"pressure": "none"}
    table = _coefficients(context, node)
    if table is None:
        context.findings.left_out(node, "coefficients by a curve", "no wind reaches its openings")
        return {"pressure": "none"}
    angles, values = table
    relative = node.word("wind_angle_type") == "relative"
    symmetric = node.word("symmetric_wind_pressure_coefficient_curve") == "yes"
    turn = 0.0 if relative else azimuth
    grid = np.arange(_DIRECTIONS) * 360.0 / _DIRECTIONS
    asked = (grid + turn) % 360.0 if not relative else grid
    if symmetric:
        asked = np.minimum(asked, 360.0 - asked)
    coefficients = np.interp(asked, angles, values, period=None if symmetric else 360.0)
    height = node.number("external_node_height") or 0.0
    if control.word("height_selection_for_local_wind_pressure_calculation") == "openingheight":
        height = joint.elevation
    pressure: Section = {"kind": "table", "coefficients": [round(float(value), 6) for value in coefficients]}
    if height > 0.0:
        pressure["height"] = height
    return {"azimuth": round(azimuth, 6), "pressure": pressure}


def _by_shape(
    context: Context, item: IdfObject, control: IdfObject | None, joint: Joint, azimuth: float
) -> dict[str, Any]:
    """Coefficients of a rectangular building of walls."""
    if joint.wall.shape != "wall" or (control is not None and control.word("building_type") == "highrise"):
        context.findings.approximated(
            item, "coefficients of roofs or high buildings", "those of the walls of low ones; none on roofs"
        )
    if joint.wall.shape != "wall":
        return {"pressure": "none"}
    ratio = axis = None
    if control is not None:
        ratio = control.number("ratio_of_building_width_along_short_axis_to_width_along_long_axis")
        axis = control.number("azimuth_angle_of_long_axis_of_building")
    ratio = ratio or 1.0
    # A wall whose normal is across the long axis is a long one.
    across = abs(math.sin(math.radians(azimuth - (axis or 0.0))))
    side_ratio = 1.0 / ratio if across > math.sqrt(0.5) else ratio
    return {
        "azimuth": round(azimuth, 6),
        "pressure": {"kind": "low_rise", "side_ratio": round(side_ratio, 6)},
    }


@reads(
    "AirflowNetwork:MultiZone:WindPressureCoefficientArray",
    "AirflowNetwork:MultiZone:WindPressureCoefficientValues",
)
def _coefficients(context: Context, node: IdfObject) -> tuple[list[float], list[float]] | None:
    """Angles [deg] and coefficients of an external node; None where they are a curve."""
    values = context.model.named(
        node.text("wind_pressure_coefficient_curve_name"),
        "AirflowNetwork:MultiZone:WindPressureCoefficientValues",
    )
    if values is None:
        return None
    array = context.model.one("AirflowNetwork:MultiZone:WindPressureCoefficientArray")
    if array is None:
        return None
    angles, coefficients = [], []
    for k in itertools.count(1):
        angle = array.number(f"wind_direction_{k}")
        value = values.number(f"wind_pressure_coefficient_value_{k}")
        if angle is None or value is None:
            break
        angles.append(angle)
        coefficients.append(value)
    return (angles, coefficients) if angles else None
