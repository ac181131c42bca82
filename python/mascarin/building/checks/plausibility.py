"""Warnings about probable errors in a building: units, areas, volumes and mesh."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from mascarin.building.checks.consistency import shaded
from mascarin.building.checks.dimensions import dimension_warnings
from mascarin.building.checks.humidity import humidity_warnings
from mascarin.building.geometry import volume as enclosed_volume
from mascarin.building.parts.defaults import drawn_areas, enclosure
from mascarin.building.parts.description import Description
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phase_change import TableLaw
from mascarin.building.parts.materials.phase_change_checks import unordered_slopes
from mascarin.building.parts.materials.phases import phase
from mascarin.errors import InputError
from mascarin.materials.library import curves, product

#: Thermal diffusivities of building materials, from dense polymers to copper and silver [m2/s].
_DIFFUSIVITIES = (1e-8, 2e-4)
#: Radiative part of an ideal load above which one without a capacity may heat or cool surfaces without bound.
_MAX_RADIATIVE = 0.8


def warnings(building: Description, mesh: Iterable[str]) -> Iterator[str]:
    """Warnings: those about the mesh, and areas and volumes that do not fit together."""
    yield from mesh
    yield from _implausible_materials(building)
    yield from _implausible_melting(building)
    yield from _implausible_volumes(building)
    yield from _implausible_enclosures(building)
    yield from _implausible_areas(building)
    yield from dimension_warnings(building)
    yield from _unlimited_radiation(building)
    yield from _unshaded(building)
    yield from humidity_warnings(building)


def _implausible_materials(building: Description) -> Iterator[str]:
    """Properties that do not fit together, as when one of them is in another unit."""
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
                    f"{where}: no material of {weight:g} kg/m3 conducts {conductivity:g} W/(m K): "
                    "write the conductivity in W/(m K), not mW/(m K), and the density in kg/m3"
                )
            elif not low <= diffusivity <= high:
                yield (
                    f"{where}: a diffusivity of {diffusivity:.2g} m2/s lies outside {low:g} to {high:g}: "
                    "check the units of conductivity [W/(m K)], density [kg/m3] and specific_heat [J/(kg K)]"
                )


def _implausible_melting(building: Description) -> Iterator[str]:
    """Small cycles that would destroy entropy, and densities that make the liquid much thicker."""
    for name, material in building.materials.items():
        if not isinstance(material, PhaseChangeMaterial):
            continue
        odd = unordered_slopes(material)
        if odd is not None:
            yield (
                f"materials.{name}.hysteresis: between {odd[0]:.2f} and {odd[1]:.2f} degC the heating curve "
                "flattens faster than the cooling curve: with curve_scale a small cycle there would melt "
                "at a lower temperature than it freezes. Take curves of one shape and width, or curve_switch"
            )
        unused = _unused_curve(material)
        if unused is not None:
            yield f"materials.{name}: {unused}"
        solid, liquid = (phase(material.density, state) for state in ("solid", "liquid"))
        if abs(solid / liquid - 1.0) > 0.25:
            yield (
                f"materials.{name}.density: {solid:g} kg/m3 solid, {liquid:g} kg/m3 liquid: the layer keeps "
                f"its mass and would be {100 * (solid / liquid - 1.0):+.0f} % thicker when molten"
            )


def _unused_curve(material: PhaseChangeMaterial) -> str | None:
    """What is ignored of a product that freezes by another curve than it melts by; None where nothing is."""
    entry = None if material.product is None else product(material.product)
    if entry is None or entry.heating is None or entry.cooling is None or material.hysteresis is not None:
        return None
    used = material.law.curve if isinstance(material.law, TableLaw) else None
    if used is None:
        return None  # a law of the user
    other, does = ("cooling", "freezes") if used == "heating" else ("heating", "melts")
    halves = {name: curve.temperature_at(0.5) for name, curve in curves(entry)}
    return (
        f"{entry.name} {does} by its {other} curve (half at {halves[other]:.1f} degC), which is not used: it "
        f"melts and freezes by its {used} curve (half at {halves[used]:.1f} degC). For both curves write "
        "'hysteresis: {model: curve_switch}' and no law"
    )


def _implausible_enclosures(building: Description) -> Iterator[str]:
    """Zones with a surface larger than all others together: no closed shape has one."""
    for name in building.zones:
        areas = {
            surface: float(building.surfaces[surface].area or 0.0)
            for surface, _ in building.connections.sides(name)
            if not building.surfaces[surface].internal_mass
        }
        if not areas:
            continue
        largest = max(areas, key=lambda surface: areas[surface])
        other_areas = sum(areas.values()) - areas[largest]
        if areas[largest] > other_areas * (1.0 + 1e-6):
            yield (
                f"zones.{name}: the surfaces cannot enclose it, {largest} has {areas[largest]:.2f} m2, all "
                f"others together {other_areas:.2f} m2: add the missing surfaces, correct the area, or split "
                f"{largest} if it represents several walls"
            )


def _implausible_volumes(building: Description) -> Iterator[str]:
    for name, zone in building.zones.items():
        volume = float(zone.volume or 0.0)
        area = sum(building.surfaces[surface].area or 0.0 for surface, _ in building.connections.sides(name))
        least = (36.0 * math.pi) ** (1.0 / 3.0) * volume ** (2.0 / 3.0)
        if area < least:
            yield (
                f"zones.{name}: {area:.2f} m2 of surfaces cannot enclose {volume:g} m3 "
                f"(a sphere needs {least:.2f} m2): surfaces are missing, or the volume is too large"
            )
        is_stated = zone.volume is None or not zone.volume.derived
        outline_list = enclosure(building.connections.sides(name), building.surfaces) if is_stated else None
        if outline_list is not None:
            try:
                enclosed = enclosed_volume(outline_list)
            except InputError as error:
                yield f"zones.{name}: {error}"
                continue
            if abs(enclosed - volume) > 0.02 * volume:
                yield f"zones.{name}: {volume:g} m3 are given, the vertices enclose {enclosed:.2f} m3"


def _unshaded(building: Description) -> Iterator[str]:
    bare = shaded(building)[1] if building.shades else []
    if bare:
        yield f"shades: without effect on {', '.join(bare)}, which have no vertices"


def _implausible_areas(building: Description) -> Iterator[str]:
    for name, outline_area in drawn_areas(building.surfaces).items():
        area = float(building.surfaces[name].area or 0.0)
        if abs(area - outline_area) > 0.01 * outline_area:
            yield f"surfaces.{name}: {area:.2f} m2 are given, the vertices enclose {outline_area:.2f} m2"


def _unlimited_radiation(building: Description) -> Iterator[str]:
    """Ideal loads that give nearly all as radiation, of any power: the air takes the small rest of it."""
    for name, zone in building.zones.items():
        for kind, load in (("heating", zone.heating), ("cooling", zone.cooling)):
            radiative = 0.0 if load is None or load.radiative is None else float(load.radiative)
            if load is None or load.capacity is not None or radiative <= _MAX_RADIATIVE:
                continue
            watts = 1.0 / max(1.0 - radiative, 1e-3)
            yield (
                f"zones.{name}.{kind}: {100 * radiative:.0f} % of it is radiation and it has no "
                f"capacity: 1 W at the air needs {watts:.0f} W. It gives at most what surfaces at "
                "20 degC emit, 419 W/m2 of black ones. Give a capacity [W]"
            )
