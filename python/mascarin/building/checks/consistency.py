"""How the parts of a building must fit together; each rule yields the errors it finds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from mascarin._io.memory import amount
from mascarin.building.base.law_table import CONVECTION as LAWS
from mascarin.building.base.part import Location, fault
from mascarin.building.checks.air import air_faults
from mascarin.building.checks.derived_outputs import derived_faults
from mascarin.building.checks.forced_convection import forced_convection_faults
from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.checks.humidity import humidity_faults
from mascarin.building.checks.soil import soil_faults
from mascarin.building.checks.windows import windows_lie_in_walls
from mascarin.building.engine_input.series_users import schedule_uses
from mascarin.building.parameters.parameter import parameters
from mascarin.building.parameters.set_point_pairs import first_crossing
from mascarin.building.parameters.ties import faults as tie_faults
from mascarin.building.parts.air.zone import FloorSun, GivenSun, SunShares, TracedSun
from mascarin.building.parts.defaults import shade_outlines
from mascarin.building.parts.envelope.convection import ConvectionLaw, Measured
from mascarin.building.parts.envelope.surface import NoLongwave, Side
from mascarin.building.parts.materials.material import Resistance
from mascarin.building.parts.measured_sun import directions_are_known
from mascarin.building.parts.zone_surfaces import ZoneSurface, floors, surface_names
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.base.number import Number
    from mascarin.building.parts.description import Description

Faults = Iterator["InitErrorDetails"]

#: Largest deviation from one of the row sums of given view factors; the engine corrects the rest [-].
VIEW_FACTOR_TOLERANCE = 0.05
#: Largest deviation from one of the sum of given fractions of the sun; the engine scales them [-].
FRACTION_TOLERANCE = 0.02
#: Surfaces of one zone, glass and frames of windows included. All exchange radiation with each other.
MOST_SURFACES = 2000
#: What one zone of that many surfaces takes, as measured: memory [B] and processor time of a day in steps of
#: 15 min [s], of a run and of its derivatives. All grow with the square of their number, but the time of
#: derivatives with the cube: it is what the limit is for.
_RUN_OF_MOST, _SLOPES_OF_MOST = (230e6, 4.5), (1.2e9, 300.0)


def faults(building: Description) -> Faults:
    """All errors between the parts of a building."""
    yield from _there_are_surfaces(building)
    yield from _one_namespace(building)
    yield from _layers_have_what_they_need(building)
    yield from _radiation_has_surfaces(building)
    yield from _shares_of_set_points_act(building)
    yield from _zones_have_not_too_many_surfaces(building)
    yield from _emissivities_where_exchange_is(building)
    yield from _convection_suits_its_side(building)
    yield from _sensors_inside_walls(building)
    yield from _heat_sources_between_layers(building)
    yield from soil_faults(building)
    yield from _columns_have_one_meaning(building)
    yield from _view_factors_sum_to_one(building)
    yield from _schedules_suit_their_use(building)
    yield from _set_points_apart(building)
    yield from air_faults(building)
    yield from forced_convection_faults(building)
    yield from humidity_faults(building)
    yield from windows_lie_in_walls(building)
    yield from _sun_can_be_absorbed(building)
    yield from _shades_can_act(building)
    yield from directions_are_known(building)


def faults_of_values(building: Description) -> Faults:
    """Errors that show when everything has a value, given or derived: ties, and laws written as text."""
    if building.ties:
        yield from tie_faults(building, parameters(building))
    for side in formula_sides(building):
        yield from side.faults()
    yield from derived_faults(building)


def _there_are_surfaces(building: Description) -> Faults:
    if not building.surfaces:
        yield fault(
            ("surfaces",), "no surfaces", "at least one surface", "Describe the walls under 'surfaces:'."
        )


def _one_namespace(building: Description) -> Faults:
    sections: dict[str, Mapping[str, object]] = {
        "zones": building.zones,
        "surfaces": building.surfaces,
        "windows": building.windows,
        "sensors": building.sensors,
        "vents": building.vents,
        "controls": building.controls,
        "heat_sources": building.heat_sources,
    }
    owner: dict[str, str] = {}
    for section, named in sections.items():
        for name in named:
            if name in owner:
                yield fault(
                    (section, name),
                    f"'{name}' also under '{owner[name]}:'",
                    "a name that no other zone, surface, window, sensor, vent, control or heat source has",
                    "Rename one: results have this name.",
                )
            owner.setdefault(name, section)


def _heat_sources_between_layers(building: Description) -> Faults:
    for name, source in building.heat_sources.items():
        construction = building.surfaces[source.surface].construction
        layers = [layer.name for layer in building.constructions[construction].layers]
        if source.after not in layers[:-1]:
            inner = layers[:-1]
            yield fault(
                ("heat_sources", name, "after"),
                f"'{source.after}'",
                f"a layer of construction '{construction}' with another one behind it: {', '.join(inner)}"
                if inner
                else f"a construction of two layers or more; '{construction}' has one",
                f"Write 'after: {inner[-1]}', or divide the layer that the pipes are in."
                if inner
                else "Divide the layer in two at the depth of the pipes.",
            )


def _layers_have_what_they_need(building: Description) -> Faults:
    for name, construction in building.constructions.items():
        for index, layer in enumerate(construction.layers):
            location = ("constructions", name, "layers", index)
            bare = isinstance(building.materials[layer.material], Resistance)
            if not bare and layer.thickness is None:
                yield fault(
                    (*location, "thickness"),
                    "nothing",
                    "thickness of the layer, above 0 [m]",
                    "Add 'thickness:'.",
                )
            for key in ("thickness", "nodes"):
                if bare and getattr(layer, key) is not None:
                    yield fault(
                        (*location, key),
                        f"'{key}' of '{layer.material}'",
                        "none: the material is a resistance",
                        f"Remove '{key}:', or give the material conductivity, density and specific_heat.",
                    )


def _radiation_has_surfaces(building: Description) -> Faults:
    """A zone that no surface faces is air alone: what is radiated in it would reach nothing."""
    for name, zone in building.zones.items():
        if building.connections.sides(name):
            continue
        parts: dict[str, Number | None] = {f"gains.{key}": gain.radiative for key, gain in zone.gains.items()}
        parts |= {key: plant.radiative for key, plant in zone.loads.items()}
        for key, radiative in parts.items():
            if float(radiative or 0.0) > 0.0:
                yield fault(
                    ("zones", name, *key.split("."), "radiative"),
                    f"{radiative:g} in a zone that no surface faces",
                    "0: nothing is there that radiation could reach",
                    f"Write 'radiative: 0', or add a side with 'zone: {name}'.",
                )


def _shares_of_set_points_act(building: Description) -> Faults:
    """A share of the mean radiant temperature needs set points, and surfaces that radiate."""
    for name, zone in building.zones.items():
        share = zone.setpoint_radiant_share
        if share is None:
            continue
        location = ("zones", name, "setpoint_radiant_share")
        if not zone.loads:
            yield fault(
                location,
                f"{share:g} in a zone without heating and cooling",
                "a set point that it acts on",
                "Add 'heating: {setpoint: 20}', or remove it.",
            )
        elif not building.connections.sides(name):
            yield fault(
                location,
                f"{share:g} in a zone that no surface faces",
                "none: a zone without surfaces has no mean radiant temperature",
                f"Remove it, or add a side with 'zone: {name}'.",
            )


def _zones_have_not_too_many_surfaces(building: Description) -> Faults:
    """Refuse what takes too much memory and time, before anything is made for it."""
    counts = Counter(side.zone for _, side in _sides(building) if side.zone is not None)
    for window in building.windows.values():
        for side in building.surfaces[window.surface].sides:
            if side.zone is not None:
                counts[side.zone] += 1 if window.frame is None else 2
    for zone, count in counts.items():
        if count > MOST_SURFACES:
            times = count / MOST_SURFACES
            size, minutes = amount(_RUN_OF_MOST[0] * times**2), _RUN_OF_MOST[1] * times**2 / 60.0
            more, longer = amount(_SLOPES_OF_MOST[0] * times**2), _SLOPES_OF_MOST[1] * times**3 / 60.0
            yield fault(
                ("zones", zone),
                f"{count} surfaces, all of which exchange radiation: a run would take {size} of memory and "
                f"about {minutes:.2g} min for each day, its derivatives {more} and {longer:.2g} min",
                f"at most {MOST_SURFACES} surfaces in a zone, glass and frames of windows included",
                "Join surfaces of one construction and direction, or split the zone.",
            )


def _sides(building: Description) -> Iterator[tuple[tuple[str, str, str], Side]]:
    for name, surface in building.surfaces.items():
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
            yield ("surfaces", name, which), side


def _emissivities_where_exchange_is(building: Description) -> Faults:
    for location, side in _sides(building):
        if side.zone is None:
            continue
        exchange = not isinstance(building.zones[side.zone].longwave, NoLongwave)
        if exchange and side.emissivity is None:
            yield fault(
                (*location, "emissivity"),
                "nothing",
                f"long-wave emissivity, above 0 and at most 1 [-]: zone '{side.zone}' exchanges radiation",
                f"Add 'emissivity:', or write 'longwave: none' in zone '{side.zone}'.",
            )


def _convection_suits_its_side(building: Description) -> Faults:
    for location, side in _sides(building):
        film = side.convection
        if film is not None and side.imposed is not None and side.imposed.row.gives_coefficient:
            yield fault(
                (*location, "convection"),
                f"a coefficient beside '{side.imposed.kind}'",
                "none: this law gives the coefficient itself",
                "Remove 'convection:'.",
            )
        if not isinstance(film, ConvectionLaw):
            continue
        imposed = side.measured or side.ground or side.imposed or side.scheduled
        if film.row.sides == "air" and imposed:
            yield fault(
                (*location, "convection"),
                f"'{film.row.kind}' on a side facing {side.faces}",
                f"a coefficient for a given temperature: a number, {_for_given_temperatures()}",
                "Write the surface heat transfer coefficient to that air.",
            )
        if film.row.sides == "outdoors" and not side.outdoors:
            yield fault(
                (*location, "convection"),
                f"'{film.row.kind}' on a side facing {side.faces}",
                "a coefficient without wind",
                "Write 'tarp', which has the same buoyant part, or another coefficient without wind.",
            )
        if not side.outdoors:
            for key, number, _ in film.values():
                if number.outdoors:
                    yield fault(
                        (*location, "convection", key),
                        f"'{key}' on a side facing {side.faces}",
                        "none: only the forced part by wind uses it",
                        f"Remove '{key}:'.",
                    )


def _for_given_temperatures() -> str:
    """Kinds of the laws that may stand on a side to a given temperature."""
    return ", ".join(kind for kind, row in LAWS.items() if row.sides == "any" and kind != "constant")


def _sensors_inside_walls(building: Description) -> Faults:
    for name, sensor in building.sensors.items():
        layers = building.constructions[building.surfaces[sensor.surface].construction].layers
        thickness = sum(layer.thickness or 0.0 for layer in layers)
        if sensor.depth > thickness * (1.0 + 1e-9):
            yield fault(
                ("sensors", name, "depth"),
                f"{sensor.depth:g} m",
                f"at most {thickness:g} m, the thickness of '{sensor.surface}'",
                "Depth is measured from the outside.",
            )


def _columns_have_one_meaning(building: Description) -> Faults:
    temperatures = {column for _, side in _sides(building) for column in side.measured_columns}
    for location, side in _sides(building):
        if side.irradiance is not None and side.irradiance in temperatures:
            yield fault(
                (*location, "irradiance"),
                f"'{side.irradiance}', which is a measured temperature elsewhere",
                "a column of irradiance [W/m2]",
                "Name the right column.",
            )
        film = side.convection
        if isinstance(film, Measured) and film.column in temperatures | {side.irradiance}:
            yield fault(
                (*location, "convection", "column"),
                f"'{film.column}', which has another meaning elsewhere",
                "a column of a heat transfer coefficient [W/(m2 K)]",
                "Name the right column.",
            )


def _view_factors_sum_to_one(building: Description) -> Faults:
    for zone in building.zones:
        view_factors = building.zones[zone].view_factors
        if view_factors is None:
            continue
        names = surface_names(building.connections.of(zone))
        for row, factors in view_factors.items():
            location = ("zones", zone, "view_factors", row)
            if row not in names:
                yield fault(location, f"'{row}'", "a surface of this zone", did_you_mean(row, names))
            for column in factors:
                if column not in names:
                    yield fault(
                        (*location, column),
                        f"'{column}'",
                        "a surface of this zone",
                        did_you_mean(column, names),
                    )
            total = sum(factors.values())
            if abs(total - 1.0) > VIEW_FACTOR_TOLERANCE:
                yield fault(
                    location,
                    f"a sum of {total:.3f}",
                    "view factors from one surface that sum to 1",
                    "Complete the row.",
                )
        for name in names:
            if name not in view_factors:
                yield fault(
                    ("zones", zone, "view_factors"),
                    f"no row '{name}'",
                    "a row for each surface",
                    f"Add '{name}:'.",
                )


def _sun_can_be_absorbed(building: Description) -> Faults:
    for zone, definition in building.zones.items():
        surfaces = building.connections.of(zone)
        has_glass = any(item.window is not None for item in surfaces)
        sun = definition.sun
        if isinstance(sun, GivenSun):
            names = [item.name for item in surfaces if item.surface is not None]
            for part, keys in ((sun, ("sun",)), (sun.diffuse, ("sun", "diffuse"))):
                if part is not None:
                    yield from _fractions_sum_to_one(("zones", zone, *keys), part, names)
        if not has_glass:
            continue  # no sun enters: its distribution does no harm
        if isinstance(sun, TracedSun):
            yield from _rays_end_on_surfaces(zone, surfaces)
        if isinstance(sun, FloorSun) and not any(floors(surfaces)):
            yield fault(
                ("zones", zone, "sun"),
                "floor, in a zone without a floor",
                "a surface that faces up into the zone, within 30 deg",
                "Correct 'tilt:' of the floor (180 deg for its inner side up), or write 'sun: area'.",
            )
        if isinstance(sun, GivenSun):
            continue
        for item in surfaces:
            if item.surface is not None and getattr(item.surface, item.side).absorptance is None:
                yield fault(
                    ("surfaces", item.name, item.side, "absorptance"),
                    "nothing",
                    f"solar absorptance, from 0 to 1 [-]: the sun enters zone '{zone}'",
                    "Add 'absorptance:', or give 'shares' under 'sun:' in the zone.",
                )


def _rays_end_on_surfaces(zone: str, surfaces: Sequence[ZoneSurface]) -> Faults:
    bare = ", ".join(f"'{item.name}'" for item in surfaces if item.polygon is None)
    if bare:
        yield fault(
            ("zones", zone, "sun"),
            f"geometry, where {bare} {'have' if ',' in bare else 'has'} no vertices",
            "vertices of every surface and window of the zone, to trace the beam",
            "Add 'vertices:', or write 'sun: area'.",
        )


def shaded(building: Description) -> tuple[list[str], list[str]]:
    """Outdoor surfaces in the sun on which shades act, and those without vertices, on which they cannot."""
    lists: tuple[list[str], list[str]] = ([], [])
    for name, surface in building.surfaces.items():
        if any(side.exposed.sun for side in surface.sides):
            lists[surface.vertices is None].append(name)
    for name, window in building.windows.items():
        if building.surfaces[window.surface].outside.outdoors:
            lists[window.vertices is None].append(name)
    return lists


def _shades_can_act(building: Description) -> Faults:
    if not building.shades:
        return
    shade_outlines(building.shades)
    if not shaded(building)[0]:
        yield fault(
            ("shades", next(iter(building.shades))),
            "a shade where no sunlit surface has vertices",
            "vertices of the walls and windows that it shades",
            "Add 'vertices:' to them, in the same coordinates.",
        )


def _fractions_sum_to_one(location: Location, sun: GivenSun | SunShares, names: list[str]) -> Faults:
    sides = Counter(names)
    masses = [name for name, count in sides.items() if count == 2]
    for name in sun.shares:
        if name in masses:
            yield fault(
                (*location, "shares", name),
                f"'{name}', which has both sides in this zone",
                "the fraction of each side",
                f"Write 'masses: {{{name}: {{outside: 0.1, inside: 0.1}}}}' beside 'shares:'.",
            )
        elif name not in names:
            yield fault(
                (*location, "shares", name), f"'{name}'", "a surface of this zone", did_you_mean(name, names)
            )
    for name in sun.masses:
        if name not in masses:
            yield fault(
                (*location, "masses", name),
                f"'{name}'",
                "a surface with both sides in this zone",
                "Write the fraction of another one under 'shares:'."
                if name in names
                else did_you_mean(name, masses) or "Remove it.",
            )
    of_masses = sum(float(mass.outside) + float(mass.inside) for mass in sun.masses.values())
    total = float(sum(sun.shares.values()) + sun.lost) + of_masses
    if abs(total - 1.0) > FRACTION_TOLERANCE:
        yield fault(
            location,
            f"fractions that sum to {total:.3f}",
            "fractions that, with lost, sum to 1",
            "Complete them.",
        )


def _schedules_suit_their_use(building: Description) -> Faults:
    for name, location, needed in schedule_uses(building):
        kind = building.schedules[name].kind
        if kind != needed:
            yield fault(
                location,
                f"'{name}', a schedule of kind {kind}",
                f"a schedule of kind {needed}",
                f"Name another one, or write 'kind: {needed}' under 'schedules.{name}:'.",
            )


def _set_points_apart(building: Description) -> Faults:
    """Times of a week at which the heating set point is above the cooling set point."""
    for name, zone in building.zones.items():
        if len(zone.loads) < 2:
            continue
        points = [zone.loads[which].setpoint for which in ("heating", "cooling")]
        crossing = first_crossing(building, *((point.temperature, point.schedule) for point in points))
        if crossing is not None:
            when, warm, cold = crossing
            yield fault(
                ("zones", name, "heating", "setpoint"),
                f"heating to {warm:g} degC, above cooling to {cold:g} degC, on {when}",
                "a heating set point at or below the cooling set point at all times",
                "Lower the one or raise the other.",
            )
