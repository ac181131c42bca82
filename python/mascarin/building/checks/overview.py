"""A building in lines of text: zones, U values, mesh, time constants, then warnings and assumptions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from mascarin._io.memory import uncollected
from mascarin.building.checks.conductances import conductance_lines, infiltration_rate, window_conductance
from mascarin.building.checks.dimensions import dimension_lines
from mascarin.building.checks.forced_convection import forced_convection_lines
from mascarin.building.checks.humidity import humidity_lines
from mascarin.building.checks.plausibility import warnings
from mascarin.building.checks.u_values import (
    described_u_value,
    described_window_u_value,
    resistance_words,
    time_constant,
    u_value,
    window_u_value,
)
from mascarin.building.engine_input.mesh import Mesh, choose
from mascarin.building.engine_input.ratings import WindowRating, require_accepted, window_ratings
from mascarin.building.parameters.parameter import parameters
from mascarin.building.parameters.unused_parameters import sides as every_side
from mascarin.building.parts.air.air_path import AirPath
from mascarin.building.parts.air.ventilation import VentilationUnit
from mascarin.building.parts.air.zone import Zone
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.measured_values import Driven
from mascarin.building.parts.envelope.surface import Side
from mascarin.building.parts.materials.closed_law import CUT, ClosedLaw
from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.building.parts.materials.phase_change import FractionLaw, FractionsLaw, TanhLaw
from mascarin.building.parts.measured_sun import measured_lines
from mascarin.building.parts.openings.glazing import Glazing, SimpleGlazing
from mascarin.building.parts.openings.window import WindowOutside
from mascarin.building.parts.self_shading import in_words
from mascarin.building.parts.site import wind_factor
from mascarin.building.parts.site_air import density, heat_capacity
from mascarin.building.parts.zone_surfaces import closed

#: SDIRK2 satisfies the maximum principle for steps below this many times the smallest time constant.
SDIRK2_BOUND = 2.4


@uncollected()
def check(building: Description, step_seconds: float = 900.0) -> list[str]:
    """Describe a building in lines of text.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step of the runs. [s]

    Returns
    -------
    list of str
        Zones, surfaces with U values, constructions with their mesh, time constants; then warnings and
        assumptions, which start with ``warning:`` and ``assumed:``.

    Raises
    ------
    InputError
        A run would refuse the building, whatever the weather.

    Examples
    --------
    >>> from mascarin import examples
    >>> from mascarin.building import load
    >>> check(load(examples.FOLDER / "lgi" / "building.yaml"))[0]
    'LGI cell: 2 zones, 13 surfaces, 334 parameters'
    """
    require_accepted(building, step_seconds)
    mesh, ratings = choose(building, step_seconds), window_ratings(building, step_seconds)
    return [
        f"{building.name}: {_count(len(building.zones), 'zone')}, "
        f"{_count(len(building.surfaces), 'surface')}, {_count(len(parameters(building)), 'parameter')}",
        *dimension_lines(building),
        *_zones(building),
        *_in_zones(building),
        *_surfaces(building),
        *_windows(building, ratings),
        *_blinds(building, ratings),
        *_constructions(building, mesh, step_seconds),
        *conductance_lines(building),
        *_winds(building),
        *humidity_lines(building),
        *_melting(building),
        *(f"shading: {words}" for words in [in_words(building)] if words),
        *measured_lines(building),
        *(f"warning: {text}" for text in warnings(building, mesh.warnings)),
        *(f"assumed: {text}" for text in assumptions(building)),
    ]


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _zones(building: Description) -> Iterator[str]:
    for name, zone in building.zones.items():
        names = dict(building.connections.sides(name))
        surfaces = [building.surfaces[surface] for surface, _ in building.connections.sides(name)]
        area = sum(surface.area or 0.0 for surface in surfaces)
        shell = [
            (_own_area(building, surface), building.surfaces[surface])
            for surface, _ in building.connections.sides(name)
            if not building.surfaces[surface].internal_mass
        ]
        total = sum(net_area * u_value(building, surface) for net_area, surface in shell)
        glazed = [pane for wall in names for pane in building.connections.windows_in(wall).values()]
        total += sum(float(window.area or 0.0) * window_u_value(building, window) for window in glazed)
        meant = sum(net_area * described_u_value(building, surface) for net_area, surface in shell)
        meant += sum(window_conductance(building, window) for window in glazed)
        heavy = density(building.site)
        air = infiltration_rate(zone) * float(zone.volume or 0.0) * heat_capacity(building.site) / 3600.0
        yield (
            f"zone {name}: {zone.volume:g} m3, {_count(len(surfaces), 'surface')} of {area:.2f} m2, "
            f"UA {total:.2f} W/K by the U values below{_other_ua(total, meant)}, "
            f"infiltration {air:.2f} W/K (air of {heavy:.3f} kg/m3), {_exchange(building, name)}"
        )


def _other_ua(by_iso: float, described: float) -> str:
    same = math.isclose(by_iso, described, rel_tol=5e-4)
    return "" if same else f" ({described:.2f} W/K with the coefficients described)"


def _in_zones(building: Description) -> Iterator[str]:
    """Gains, ventilation and ideal loads of the zones, and the air between zones."""
    heat = heat_capacity(building.site)
    for name, zone in building.zones.items():
        for key, gain in zone.gains.items():
            people = (
                "" if gain.activity is None else f" from people at {gain.activity:g} W each, sensible part"
            )
            words = f"{gain.in_words('W')}{people}, {100 * gain.radiative:g} % radiated"
            yield f"zone {name}: gain {key} of {words}{_scheduled(gain.schedule)}"
        for key, air in zone.ventilation.items():
            flow = float(air.flow or 0.0) + float(air.air_changes or 0.0) * float(zone.volume or 0.0) / 3600.0
            steered = _scheduled(air.schedule) + _controlled(air.control)
            words = f"{flow * heat:.2f} W/K{_of_air(air)}{steered}"
            yield f"zone {name}: ventilation {key} of {words}"
        if zone.air_gradient is not None:
            gradient = zone.air_gradient
            yield f"zone {name}: air gradient of {gradient.in_words('K/m')}{_scheduled(gradient.schedule)}"
        for which, loads in zone.loads.items():
            target = loads.setpoint.words
            most = "without limit" if loads.capacity is None else f"at most {loads.capacity:g} W"
            yield f"zone {name}: {which} to {target}, {most}{_scheduled(loads.schedule)}"
        yield from _bridges(name, zone)
        leaks = zone.infiltration
        if leaks.density is not None or leaks.schedule is not None or leaks.control is not None:
            steered = _scheduled(leaks.schedule) + _controlled(leaks.control)
            yield f"zone {name}: infiltration{_of_air(leaks)}{steered}"
        test = leaks.blower_door
        if test is not None:
            yield f"zone {name}: infiltration of a pressure test, n50 {test.n50:g} 1/h ({test.kind})"
    for name, path in building.air_paths.items():
        ends = (
            f"from {' to '.join(path.between)}" if path.one_way else f"between {' and '.join(path.between)}"
        )
        steered = _scheduled(path.schedule) + _controlled(path.control)
        yield f"air path {name}: {_flow(path, heat)} {ends}{steered}"
    for name, unit in building.ventilation_units.items():
        yield from _unit(name, unit, heat)
    for name, opening in building.openings.items():
        steered = _scheduled(opening.schedule) + _controlled(opening.control)
        yield f"opening {name}: {opening.area:g} m2 in {opening.zone}{steered}"
    yield from _vents(building)
    yield from _heat_sources(building)
    yield from forced_convection_lines(building)


def _vents(building: Description) -> Iterator[str]:
    for name, vent in building.vents.items():
        ends = f"between {' and '.join(vent.between)}" if vent.between else f"from {vent.zone} to outdoors"
        wind = f", wind pressure {vent.pressure.kind}" if vent.pressure is not None else ""
        steered = _scheduled(vent.schedule) + _controlled(vent.control)
        yield f"vent {name}: {vent.area:g} m2 {ends} at {vent.elevation:g} m{wind}{steered}"
    for name, control in building.controls.items():
        bands = ", ".join(f"{key} {band.open:g} and {band.close:g}" for key, band in control.conditions)
        times = "".join(
            f", {which} for at least {time:g} min"
            for which, time in (("open", control.minimum_open_time), ("closed", control.minimum_closed_time))
            if time is not None
        )
        other = "" if control.reference_zone is None else f" (difference to {control.reference_zone})"
        yield f"control {name} in {control.zone}{other} opens and closes at {bands}{times}"


def _heat_sources(building: Description) -> Iterator[str]:
    for name, source in building.heat_sources.items():
        _, part = source.driven
        what = f"electric, {part.in_words('W/m2')}"
        if (water := source.water) is not None:
            exchange = (
                f"effectiveness {water.effectiveness:g}"
                if water.effectiveness is not None
                else f"{water.conductance:g} W/(m2 K)"
            )
            what = f"water, {part.in_words('kg/s')} at {water.supply.words}, {exchange}"
        steered = _scheduled(getattr(part, "schedule", None)) + _controlled(source.control)
        if (thermostat := source.thermostat) is not None:
            steered += (
                f", {thermostat.mode} by {thermostat.zone} at {thermostat.setpoint.words} "
                f"within {thermostat.range:g} K"
            )
        yield f"heat source {name} in {source.surface} after {source.after}: {what}{steered}"


def _controlled(control: str | None) -> str:
    return "" if control is None else f", by control {control}"


def _bridges(name: str, zone: Zone) -> Iterator[str]:
    for key, bridge in zone.thermal_bridges.items():
        to = bridge.zone or " and ".join(bridge.measured_columns) or bridge.faces
        yield f"zone {name}: thermal bridge {key} of {bridge.conductance:.3f} W/K to {to}"


def _flow(flow: Driven, heat: float) -> str:
    """A flow of air in words; ``heat``: that of a cubic metre of air [J/(m3 K)]."""
    if isinstance(flow, AirPath) and flow.door is not None:
        door = flow.door
        return f"door of {door.width:g} m x {door.height:g} m, {100 * door.open:g} % open,"
    words = f"{flow.number * heat:.2f} W/K" if flow.column is None else f"flow of column {flow.column}"
    return words + _of_air(flow)


def _of_air(part: Any) -> str:
    """The air that a flow is a volume of, where it is not that of the site."""
    density = getattr(part, "density", None)
    if density is None or density.kind == "site":
        return ""
    return f" at the density of the site, counted as a volume of {density.words}"


def _unit(name: str, unit: VentilationUnit, heat: float) -> Iterator[str]:
    for word, flows in (("supplies to", unit.supply), ("extracts from", unit.exhaust)):
        for zone, flow in flows.items():
            yield f"ventilation unit {name}: {word} {zone}: {_flow(flow, heat)}{_scheduled(flow.schedule)}"
    if unit.supply:
        supplied = "outdoor air" if unit.temperature is None else f"air of {unit.temperature.words}"
        recovery = "" if unit.recovery is None else f", heat recovery {unit.recovery:g}"
        yield f"ventilation unit {name}: {supplied}{recovery}"


def _scheduled(schedule: str | None) -> str:
    return "" if schedule is None else f", by schedule {schedule}"


def _own_area(building: Description, surface: str) -> float:
    """Area of a surface without its windows [m2]."""
    inside = building.connections.windows_in(surface).values()
    return float(building.surfaces[surface].area or 0.0) - sum(float(window.area or 0.0) for window in inside)


def _exchange(building: Description, zone: str) -> str:
    longwave = building.zones[zone].longwave.kind
    if longwave == "none":
        return "no long-wave exchange"
    if building.zones[zone].view_factors is not None:
        return f"long-wave {longwave} with the given view factors"
    if closed(building.connections.of(zone)):
        return f"long-wave {longwave} with exact view factors"
    return f"long-wave {longwave} with view factors approximated by areas"


def _surfaces(building: Description) -> Iterator[str]:
    for name, surface in building.surfaces.items():
        yield (
            f"surface {name}: {surface.construction}, {surface.area:.2f} m2, tilt {surface.tilt:g}, "
            f"azimuth {surface.azimuth:g}, {_facing(surface.outside)} -> {_facing(surface.inside)}, "
            f"U {u_value(building, surface):.3f} W/(m2 K), {resistance_words(building, surface)}"
            f"{_as_described(u_value(building, surface), described_u_value(building, surface))}"
        )


def _windows(building: Description, ratings: Mapping[str, WindowRating]) -> Iterator[str]:
    for name, window in building.windows.items():
        u = window_u_value(building, window)
        frame = f", frame {100.0 * window.frame.fraction:g} %" if window.frame is not None else ""
        yield (
            f"window {name}: {window.glazing} in {window.surface}, {window.area:.2f} m2{frame}, "
            f"U {u:.3f} W/(m2 K), surface resistances of ISO 6946"
            f"{_as_described(u, described_window_u_value(building, window), ' of the glass')}"
        )
    for name, rating in ratings.items():
        yield (
            f"window {name}: glass of U {rating.u_value:.2f} W/(m2 K) and solar heat gain "
            f"{rating.solar_heat_gain:.3f} by EN 673 and EN 410, solar transmittance "
            f"{rating.transmittance:.3f}, {rating.diffuse_transmittance:.3f} of diffuse radiation"
            f"{_how_known(building.glazings[building.windows[name].glazing])}"
        )


def _blinds(building: Description, ratings: Mapping[str, WindowRating]) -> Iterator[str]:
    """What closes the blinds of windows, and the U value of the glass behind them."""
    if all(window.blind is None for window in building.windows.values()):
        return
    for name, rating in ratings.items():
        blind = building.windows[name].blind
        if blind is None:
            continue
        resistance = float(blind.resistance or 0.0) * float(blind.cover)
        yield (
            f"window {name}: blind {blind.words}; "
            f"U of the glass {rating.u_value:.2f} W/(m2 K) open, "
            f"{1.0 / (1.0 / rating.u_value + resistance):.2f} closed"
        )


def _how_known(glazing: Glazing) -> str:
    """How well the solar transmittance is known, where it follows from U value and solar heat gain."""
    if not isinstance(glazing, SimpleGlazing) or glazing.transmittance is not None:
        return ""
    return (
        "; the transmittances are estimated from U value and solar heat gain: within 1 % for glass without a "
        "coating, but coated products of one rating differ by 10 %, so give the 'transmittance' of the data "
        "sheet (direct solar transmittance of EN 410)"
    )


def _as_described(by_iso: float, described: float, what: str = "") -> str:
    """U value by the coefficients described, where it is another one."""
    return "" if math.isclose(by_iso, described, rel_tol=5e-4) else f"; U {described:.3f}{what} as described"


def _winds(building: Description) -> Iterator[str]:
    """Heights of the sides outdoors, and the wind there."""
    sides: list[tuple[str, Side | WindowOutside]] = [
        *((f"surface {name}", surface.outside) for name, surface in building.surfaces.items()),
        *(
            (f"window {name}", window.outside)
            for name, window in building.windows.items()
            if building.surfaces[window.surface].outside.outdoors
        ),
    ]
    for name, side in sides:
        if not (side.outdoors and side.exposed.wind):
            continue
        if side.height is None:
            yield f"{name}: no height, wind as at the mast"
            continue
        factor = wind_factor(building.site.wind, side.height)
        yield f"{name}: {side.height:.2f} m high, {factor:.2f} of the wind at the mast"


def _facing(side: Side) -> str:
    return side.zone or side.in_words()


def _constructions(building: Description, mesh: Mesh, step_seconds: float) -> Iterator[str]:
    for name, construction in building.constructions.items():
        layers = [f"{layer.name} {mesh.nodes[name, layer.name]}" for layer in construction.layers]
        least = time_constant(building, name, mesh)
        text = f", smallest time constant {least:.0f} s" if math.isfinite(least) else ""
        if step_seconds > SDIRK2_BOUND * least:
            text += f" (after a jump, steps above {SDIRK2_BOUND * least:.0f} s may overshoot for a step)"
        yield f"construction {name}: nodes {', '.join(layers)}{text}"


def _melting(building: Description) -> Iterator[str]:
    for name, material in building.materials.items():
        if not isinstance(material, PhaseChangeMaterial):
            continue
        law, (low, high) = material.law, material.melting
        if isinstance(law, ClosedLaw):
            latent, width = material.latent_heat or 0.0, law.half_width
            about = f"{latent:g} J/kg about {material.melting_temperature or 0.0:g} degC"
            by = "" if isinstance(law, TanhLaw) else f" ({law.kind})"
            yield f"material {name}: {about}, half-width {width:g} K{by}"
        else:
            latent_text = f"{material.latent_heat:g} J/kg, " if isinstance(law, FractionsLaw) else ""
            yield f"material {name}: {latent_text}melts between {low:g} and {high:g} degC, by its table"
        if material.two_curves is not None and material.cooling is not None:
            yield f"material {name}: {_two_curves(material, material.two_curves.model, *material.cooling)}"
        if material.one_curve is not None:
            yield f"material {name}: {material.one_curve.said(material.reference)}"


def _two_curves(material: PhaseChangeMaterial, model: str, cooling: FractionLaw, centre: float) -> str:
    (low, high), (start, end) = material.melting, cooling.reach
    text = (
        f"{model}, melts from {low:.2f} to {high:.2f} degC, freezes from {centre + end:.2f} to "
        f"{centre + start:.2f} degC"
    )
    if any(isinstance(law, ClosedLaw) and law.tails for law in (material.law, cooling)):
        text += f"; tails below {100 * CUT:g} % are cut off and the rest is scaled to 0..1"
    return text


def assumptions(building: Description) -> Iterator[str]:
    """Assumed values: numbers marked as assumed, and models chosen because none is given."""
    # What several parts have alike is said once: surfaces.{north, south}.inside.emissivity = 0.9.
    names: dict[tuple[str, str, str], list[str]] = {}
    for number in parameters(building):
        if number.assumed:
            unit = "" if number.unit == "-" else f" {number.unit}"
            section, name, *keys = number.path.split(".")
            value = f"{number.value:g}{unit} ({number.source or 'no source'})"
            names.setdefault((section, "".join(f".{key}" for key in keys), value), []).append(name)
    for (section, tail, value), alike in names.items():
        name = alike[0] if len(alike) == 1 else f"{{{', '.join(alike)}}}"
        yield f"{section}.{name}{tail} = {value}"
    outdoors = [item.side for item in every_side(building) if item.side.outdoors]
    if outdoors and "sky" not in building.site.model_fields_set:
        yield "site.sky: infrared of the weather file, else martin_berdahl, because none is given"
    if any(not side.irradiance for side in outdoors) and "diffuse" not in building.site.model_fields_set:
        yield "site.diffuse: perez, because none is given"
    for name in building.zones:
        surfaces = building.connections.of(name)
        if any(item.window is not None for item in surfaces) and building.zones[name].sun is None:
            yield f"zones.{name}.sun: area (solar radiation over all surfaces, part of it lost through glass)"
        if "approximated" in _exchange(building, name):
            yield f"zones.{name}: view factors by areas, zero between surfaces in one plane"
