"""What can be said about a building before it is run: zones, U values, mesh, time constants, assumptions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from mascarin.building.air import SPECIFIC_HEAT, density
from mascarin.building.convection import Constant
from mascarin.building.derived import enclosure, faces_of
from mascarin.building.glazing import face_resistance
from mascarin.building.inactive import faces as exposed
from mascarin.building.leaves import leaves
from mascarin.building.material import PhaseChangeMaterial, Resistance, phase
from mascarin.building.mesh import Mesh, choose
from mascarin.building.phase_change import CUT, ClosedLaw, FractionLaw, FractionsLaw, TanhLaw
from mascarin.building.phase_change_rules import unordered_slopes
from mascarin.building.rules import shaded
from mascarin.building.zone_surfaces import closed, zone_faces
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building.building import Building
    from mascarin.building.material import Material
    from mascarin.building.surface import Side, Surface
    from mascarin.building.window import Window

#: SDIRK2 keeps the maximum principle only for steps below so many times the smallest time constant.
SDIRK2_BOUND = 2.4
#: Diffusivities of what walls are made of, from dense polymers to copper and silver [m2/s].
_DIFFUSIVITIES = (1e-8, 2e-4)
#: Film resistances of ISO 6946:2017, table 7 [m2 K/W]: heat upwards, horizontal, downwards; and outdoors.
_ISO_UP, _ISO_LEVEL, _ISO_DOWN, _ISO_OUTDOORS = 0.10, 0.13, 0.17, 0.04


def check(building: Building, step_seconds: float = 900.0) -> list[str]:
    """Describe a building in lines of text.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step of the runs to come. [s]

    Returns
    -------
    list of str
        Zones, surfaces with U values, constructions with their mesh, time constants; then warnings and
        assumptions, each of which starts with its word.
    """
    mesh = choose(building, step_seconds)
    return [
        f"{building.name}: {_count(len(building.zones), 'zone')}, "
        f"{_count(len(building.surfaces), 'surface')}, {_count(len(building.parameters()), 'parameter')}",
        *_zones(building),
        *_in_zones(building),
        *_surfaces(building),
        *_windows(building),
        *_constructions(building, mesh),
        *_melting(building),
        *(f"warning: {text}" for text in warnings(building, mesh, step_seconds)),
        *(f"assumed: {text}" for text in assumptions(building)),
    ]


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


# --- what there is ------------------------------------------------------------------------------------------


def _zones(building: Building) -> Iterator[str]:
    for name, zone in building.zones.items():
        surfaces = [building.surfaces[surface] for surface, _ in faces_of(name, building.surfaces)]
        area = sum(surface.area or 0.0 for surface in surfaces)
        shell = [surface for surface in surfaces if not surface.internal_mass]
        names = {surface for surface, side in faces_of(name, building.surfaces) if side == "inside"}
        total = sum(_own_area(building, surface) * u_value(building, surface) for surface in shell)
        glazed = [window for window in building.windows.values() if window.surface in names]
        total += sum(float(window.area or 0.0) * window_u_value(building, window) for window in glazed)
        heavy = density(building.site)
        air = zone.infiltration.constant * (zone.volume or 0.0) * heavy * SPECIFIC_HEAT / 3600.0
        yield (
            f"zone {name}: {zone.volume:g} m3, {_count(len(surfaces), 'face')} of {area:.2f} m2, "
            f"UA {total:.2f} W/K by the U values below, "
            f"infiltration {air:.2f} W/K (air of {heavy:.3f} kg/m3), {_exchange(building, name)}"
        )


def _in_zones(building: Building) -> Iterator[str]:
    """What heats and airs the zones, as it is described."""
    heat = density(building.site) * SPECIFIC_HEAT
    for name, zone in building.zones.items():
        for key, gain in zone.gains.items():
            words = f"{gain.power:g} W, {100 * gain.radiative:g} % radiated"
            yield f"zone {name}: gain {key} of {words}{_scheduled(gain.schedule)}"
        for key, air in zone.ventilation.items():
            flow = float(air.flow or 0.0) + float(air.air_changes or 0.0) * float(zone.volume or 0.0) / 3600.0
            yield f"zone {name}: ventilation {key} of {flow * heat:.2f} W/K{_scheduled(air.schedule)}"
        for which, plant in zone.plants.items():
            given = plant.setpoint.schedule
            target = f"{plant.setpoint.temperature:g} degC" if given is None else f"schedule {given}"
            most = "without limit" if plant.capacity is None else f"at most {plant.capacity:g} W"
            yield f"zone {name}: {which} to {target}, {most}{_scheduled(plant.schedule)}"
    for name, path in building.air_paths.items():
        ends = " and ".join(path.between)
        yield f"air path {name}: {path.flow * heat:.2f} W/K between {ends}{_scheduled(path.schedule)}"
    for name, opening in building.openings.items():
        yield f"opening {name}: {opening.area:g} m2 in {opening.zone}{_scheduled(opening.schedule)}"


def _scheduled(schedule: str | None) -> str:
    return "" if schedule is None else f", by schedule {schedule}"


def _own_area(building: Building, surface: Surface) -> float:
    """What the windows leave of a surface [m2]."""
    inside = (window for window in building.windows.values() if building.surfaces[window.surface] is surface)
    return float(surface.area or 0.0) - sum(float(window.area or 0.0) for window in inside)


def _exchange(building: Building, zone: str) -> str:
    longwave = building.zones[zone].longwave.kind
    if longwave == "none":
        return "no long-wave exchange"
    if building.zones[zone].view_factors is not None:
        return f"long-wave {longwave} with the given view factors"
    if closed(zone_faces(zone, building.surfaces, building.windows)):
        return f"long-wave {longwave} with exact view factors"
    return f"long-wave {longwave} with view factors approximated by areas"


def _surfaces(building: Building) -> Iterator[str]:
    for name, surface in building.surfaces.items():
        yield (
            f"surface {name}: {surface.construction}, {surface.area:.2f} m2, tilt {surface.tilt:g}, "
            f"azimuth {surface.azimuth:g}, {_facing(surface.outside)} -> {_facing(surface.inside)}, "
            f"U {u_value(building, surface):.3f} W/(m2 K), {_film_words(building, surface)}"
        )


def _windows(building: Building) -> Iterator[str]:
    for name, window in building.windows.items():
        u = window_u_value(building, window)
        frame = f", frame {100.0 * window.frame.fraction:g} %" if window.frame is not None else ""
        yield (
            f"window {name}: {window.glazing} in {window.surface}, {window.area:.2f} m2{frame}, "
            f"U {u:.3f} W/(m2 K), ISO 6946 films"
        )


def window_u_value(building: Building, window: Window) -> float:
    """Thermal transmittance of a window with its frame, with the films of ISO 6946.

    Gaps that are no given conductances are taken at 0 degC outside and 20 degC inside: conduction of the gas
    and radiation, without convection.

    Parameters
    ----------
    building : Building
        The building.
    window : Window
        One of its windows.

    Returns
    -------
    float
        U value. [W/(m2 K)]
    """
    resistance = face_resistance(building.glazings[window.glazing])
    glass = 1.0 / (_ISO_OUTDOORS + resistance + _ISO_LEVEL)
    if window.frame is None:
        return glass
    share = float(window.frame.fraction)
    return (1.0 - share) * glass + share * float(window.frame.u_value)


def _facing(side: Side) -> str:
    return side.zone or (f"measured {side.measured}" if side.measured else side.faces)


def _constructions(building: Building, mesh: Mesh) -> Iterator[str]:
    for name, construction in building.constructions.items():
        layers = [f"{layer.name} {mesh.nodes[name, layer.name]}" for layer in construction.layers]
        least = time_constant(building, name, mesh)
        text = f", smallest time constant {least:.0f} s" if math.isfinite(least) else ""
        yield f"construction {name}: nodes {', '.join(layers)}{text}"


def _melting(building: Building) -> Iterator[str]:
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
        if material.hysteresis is not None and material.cooling is not None:
            yield f"material {name}: {_two_curves(material, material.hysteresis.model, *material.cooling)}"


def _two_curves(material: PhaseChangeMaterial, model: str, cooling: FractionLaw, centre: float) -> str:
    (low, high), (start, end) = material.melting, cooling.reach
    text = (
        f"{model}, melts from {low:.2f} to {high:.2f} degC, freezes from {centre + end:.2f} to "
        f"{centre + start:.2f} degC"
    )
    if any(isinstance(law, ClosedLaw) and law.tails for law in (material.law, cooling)):
        text += f"; tails below {100 * CUT:g} % are cut off and the rest is scaled to 0..1"
    return text


def u_value(building: Building, surface: Surface) -> float:
    """Thermal transmittance between the two sides.

    A film is taken as described where it is a constant that stands for all heat exchanged on its side;
    else, also where it varies or radiation is exchanged apart from it, the film of ISO 6946 is taken.

    Parameters
    ----------
    building : Building
        The building.
    surface : Surface
        One of its surfaces.

    Returns
    -------
    float
        U value; infinite where nothing resists, 0 where a side is adiabatic. [W/(m2 K)]
    """
    layers = building.constructions[surface.construction].layers
    resistance = sum(_resistance(building.materials[layer.material], layer.thickness) for layer in layers)
    resistance += sum(_film(building, side, surface)[0] for side in surface.sides)
    return 1.0 / resistance if resistance > 0.0 else math.inf


def _resistance(material: Material, thickness: float | None) -> float:
    if isinstance(material, Resistance):
        return float(material.resistance)
    return (thickness or 0.0) / phase(material.conductivity, "solid")


_ISO, _DESCRIBED, _NONE, _CLOSED = "ISO 6946", "described", "no", "adiabatic"


def _film(building: Building, side: Side, surface: Surface) -> tuple[float, str]:
    """Resistance of a film [m2 K/W], and where it was taken from."""
    if side.adiabatic:
        return math.inf, _CLOSED
    if side.convection is None:
        return 0.0, _NONE
    if isinstance(side.convection, Constant) and _stands_alone(building, side):
        conductance = side.convection.coefficient * (side.area_factor or 1.0)
        return (1.0 / conductance if conductance > 0.0 else math.inf), _DESCRIBED
    return _iso_film(side, surface), _ISO


def _stands_alone(building: Building, side: Side) -> bool:
    """Tell whether no radiation is exchanged beside the film."""
    if side.zone is not None:
        return building.zones[side.zone].longwave.kind == "none"
    return not side.outdoors or (side.longwave is not None and side.longwave.kind == "none")


def _film_words(building: Building, surface: Surface) -> str:
    outside, inside = (_film(building, side, surface)[1] for side in surface.sides)
    if _CLOSED in (outside, inside):
        return "adiabatic"
    if outside == inside:
        return f"{outside} films"
    return f"{outside} film outside, {inside} film inside"


def _iso_film(side: Side, surface: Surface) -> float:
    if side.convection is None:
        return 0.0
    if side.outdoors:
        return _ISO_OUTDOORS
    tilt = float(surface.tilt or 0.0)
    # Heat is taken to flow outwards, as in the heating season.
    return _ISO_UP if tilt < 30.0 else _ISO_DOWN if tilt > 150.0 else _ISO_LEVEL


def time_constant(building: Building, construction: str, mesh: Mesh) -> float:
    """Smallest time constant of a construction's nodes: heat capacity over the conductances to both sides.

    Parameters
    ----------
    building : Building
        The building.
    construction : str
        Name of the construction.
    mesh : Mesh
        Its nodes.

    Returns
    -------
    float
        Infinite where nothing stores heat. [s]
    """
    links: list[float] = [0.0]  # resistance between neighbouring nodes, first and last to the faces
    capacities: list[float] = []
    for layer in building.constructions[construction].layers:
        material, nodes = building.materials[layer.material], mesh.nodes[construction, layer.name]
        if isinstance(material, Resistance):
            links[-1] += float(material.resistance)
            continue
        thickness = (layer.thickness or 0.0) / nodes
        half = 0.5 * thickness / phase(material.conductivity, "solid")
        capacity = phase(material.density, "solid") * phase(material.specific_heat, "solid") * thickness
        for _ in range(nodes):
            links[-1] += half
            capacities.append(capacity)
            links.append(half)
    films = _strongest_films(building, construction)
    links[0], links[-1] = links[0] + films[0], links[-1] + films[1]
    return min(
        (
            capacity / (1.0 / before + 1.0 / after)
            for capacity, before, after in zip(capacities, links, links[1:], strict=False)
        ),
        default=math.inf,
    )


def _strongest_films(building: Building, construction: str) -> tuple[float, float]:
    """Least film resistance outside and inside over the surfaces of a construction [m2 K/W]."""
    built = [surface for surface in building.surfaces.values() if surface.construction == construction]
    outside = [_nominal_film(surface.outside, surface) for surface in built]
    inside = [_nominal_film(surface.inside, surface) for surface in built]
    return (min(outside, default=_ISO_OUTDOORS), min(inside, default=_ISO_LEVEL))


def _nominal_film(side: Side, surface: Surface) -> float:
    if side.adiabatic:
        return math.inf
    if isinstance(side.convection, Constant) and side.convection.coefficient > 0.0:
        return 1.0 / side.convection.coefficient
    return _iso_film(side, surface)


# --- what to watch out for ----------------------------------------------------------------------------------


def warnings(building: Building, mesh: Mesh, step_seconds: float) -> Iterator[str]:
    """What deserves a second look: the mesh, the step, areas and volumes that do not fit together."""
    yield from mesh.warnings
    quick = [
        name
        for name in building.constructions
        if step_seconds > SDIRK2_BOUND * time_constant(building, name, mesh)
    ]
    if quick:
        yield (
            f"a step of {step_seconds:g} s is above {SDIRK2_BOUND} times the smallest time constant of "
            f"{', '.join(quick)}: SDIRK2 may overshoot there after a jump (backward-euler never does)"
        )
    yield from _odd_materials(building)
    yield from _odd_melting(building)
    yield from _odd_volumes(building)
    yield from _odd_faces(building)
    yield from _odd_areas(building)
    yield from _unshaded(building)


def _odd_materials(building: Building) -> Iterator[str]:
    """Find properties that do not go together, as when one of them is in another unit."""
    low, high = _DIFFUSIVITIES
    for name, material in building.materials.items():
        if isinstance(material, Resistance):
            continue
        for state in ("solid", "liquid") if isinstance(material, PhaseChangeMaterial) else ("solid",):
            conductivity, weight, heat = (
                phase(value, state)
                for value in (material.conductivity, material.density, material.specific_heat)
            )
            diffusivity = conductivity / (weight * heat)
            where = f"materials.{name}" + (f" ({state})" if isinstance(material, PhaseChangeMaterial) else "")
            if conductivity > 1.0 and weight < 100.0:
                yield (
                    f"{where}: nothing of {weight:g} kg/m3 conducts {conductivity:g} W/(m K): "
                    "write the conductivity in W/(m K), not mW/(m K), and the density in kg/m3"
                )
            elif not low <= diffusivity <= high:
                yield (
                    f"{where}: a diffusivity of {diffusivity:.2g} m2/s lies outside {low:g} to {high:g}: "
                    "check the units of conductivity [W/(m K)], density [kg/m3] and specific_heat [J/(kg K)]"
                )


def _odd_melting(building: Building) -> Iterator[str]:
    """Find small cycles that would make entropy vanish, and densities that make the liquid much thicker."""
    for name, material in building.materials.items():
        if not isinstance(material, PhaseChangeMaterial):
            continue
        odd = unordered_slopes(material)
        if odd is not None:
            yield (
                f"materials.{name}.hysteresis: between {odd[0]:.2f} and {odd[1]:.2f} degC the heating curve "
                "flattens faster than the cooling curve: with curve_scale a small cycle there would melt "
                "colder than it freezes. Take curves of one shape and width, or curve_switch"
            )
        solid, liquid = (phase(material.density, state) for state in ("solid", "liquid"))
        if abs(solid / liquid - 1.0) > 0.25:
            yield (
                f"materials.{name}.density: {solid:g} kg/m3 solid, {liquid:g} kg/m3 liquid: the layer keeps "
                f"its mass and would be {100 * (solid / liquid - 1.0):+.0f} % thicker when molten"
            )


def _odd_faces(building: Building) -> Iterator[str]:
    """Find zones one face of which is larger than all others together: no closed shape has such a face."""
    for name in building.zones:
        areas = {
            surface: float(building.surfaces[surface].area or 0.0)
            for surface, _ in faces_of(name, building.surfaces)
            if not building.surfaces[surface].internal_mass
        }
        if not areas:
            continue
        largest = max(areas, key=lambda surface: areas[surface])
        others = sum(areas.values()) - areas[largest]
        if areas[largest] > others * (1.0 + 1e-6):
            yield (
                f"zones.{name}: the faces cannot enclose it, {largest} has {areas[largest]:.2f} m2 and the "
                f"others together {others:.2f} m2: add the missing faces, correct the area, or split "
                f"{largest} if it stands for several walls"
            )


def _odd_volumes(building: Building) -> Iterator[str]:
    for name, zone in building.zones.items():
        volume = float(zone.volume or 0.0)
        area = sum(building.surfaces[surface].area or 0.0 for surface, _ in faces_of(name, building.surfaces))
        least = (36.0 * math.pi * volume**2) ** (1.0 / 3.0)
        if area < least:
            yield (
                f"zones.{name}: {area:.2f} m2 of faces cannot enclose {volume:g} m3 "
                f"(a sphere needs {least:.2f} m2): faces are missing, or the volume is too large"
            )
        faces = enclosure(name, building.surfaces)
        if faces is not None:
            from mascarin.building.geometry import volume as enclosed

            try:
                drawn = enclosed(faces)
            except InputError as error:
                yield f"zones.{name}: {error}"
                continue
            if abs(drawn - volume) > 0.02 * volume:
                yield f"zones.{name}: {volume:g} m3 are given, the vertices enclose {drawn:.2f} m3"


def _unshaded(building: Building) -> Iterator[str]:
    bare = shaded(building)[1] if building.shades else []
    if bare:
        yield f"shades: without vertices, {', '.join(bare)} lie in full sun"


def _odd_areas(building: Building) -> Iterator[str]:
    from mascarin.building.derived import drawn_areas

    for name, drawn in drawn_areas(building.surfaces).items():
        area = float(building.surfaces[name].area or 0.0)
        if abs(area - drawn) > 0.01 * drawn:
            yield f"surfaces.{name}: {area:.2f} m2 are given, the vertices enclose {drawn:.2f} m2"


# --- what rests on what -------------------------------------------------------------------------------------


def assumptions(building: Building) -> Iterator[str]:
    """What nobody measured: numbers marked as assumed, and model choices made for the user."""
    for path, number, source in leaves(building):
        if number.assumed:
            unit = number.quantity.unit if number.quantity else ""
            yield f"{path} = {number:g} {unit} ({source or 'no source'})"
    outdoors = [face.side for face in exposed(building) if face.side.outdoors]
    if outdoors and "sky" not in building.site.model_fields_set:
        yield "site.sky: martin_berdahl, because none is written"
    if any(not side.irradiance for side in outdoors) and "diffuse" not in building.site.model_fields_set:
        yield "site.diffuse: perez, because none is written"
    for name in building.zones:
        faces = zone_faces(name, building.surfaces, building.windows)
        if any(face.window is not None for face in faces) and building.zones[name].sun is None:
            yield f"zones.{name}.sun: area (sun spread over all faces, some of it lost through the glass)"
        if "approximated" in _exchange(building, name):
            yield f"zones.{name}: every face sees every other one by its area, except those in one plane"
