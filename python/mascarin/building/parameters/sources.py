"""Sources of the numbers of a building, and of the methods that a run of it uses."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from mascarin.building.base.law_table import DIFFUSE
from mascarin.building.base.leaves import leaves
from mascarin.building.base.number import Number, Remark
from mascarin.building.parameters.text_laws import text_laws
from mascarin.building.parameters.unused_parameters import has_height, sides, without_effect
from mascarin.building.parts.air.air_path import ASHRAE_OPENING, BROWN_SOLVASON
from mascarin.building.parts.air.humidity import EMPD, PSYCHROMETRICS
from mascarin.building.parts.air.vent import ORIFICE, SWAMI_CHANDRA, LowRise
from mascarin.building.parts.air.ventilation import RECOVERY_SOURCE
from mascarin.building.parts.air.zone import TracedSun
from mascarin.building.parts.envelope.convection import SOURCES
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.building.parts.heat_source import SOURCE as HEAT_SOURCE
from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.building.parts.materials.phase_change import FractionsLaw, TableLaw
from mascarin.building.parts.materials.sorption import SorptionLaw
from mascarin.building.parts.measured_sun import obstructed
from mascarin.building.parts.moisture_surfaces import vapour_sides
from mascarin.building.parts.openings.blind import NET_RADIATION
from mascarin.building.parts.openings.glazing import SOURCES as GLASS
from mascarin.building.parts.openings.glazing import FilledGap, SimpleGlazing, TwoSides
from mascarin.building.parts.self_shading import obstructions
from mascarin.building.parts.site import ASHRAE_WIND, CLARK, MARTIN, SkyLaw
from mascarin.building.parts.zone_surfaces import closed

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description

_TIME_STEPS = "Alexander 1977, doi:10.1137/0714068 (time steps: SDIRK2)"
_SUN = "Reda & Andreas 2004, doi:10.1016/j.solener.2003.12.003 (sun position)"
_PVLIB = "Anderson et al. 2023, doi:10.21105/joss.05994 (pvlib, which computes it)"
_SKY_SPLIT = "Walton 1983, NBSIR 83-2655 (split of the sky by height above the horizon)"
_ENCLOSURE = "Hottel & Sarofim 1967, Radiative Transfer, ch. 3 (exchange between the surfaces of a zone)"
_EXACT_VIEW = "Sparrow 1963, doi:10.1115/1.3686058 (view factors of polygons)"
_AREA_VIEW = (
    "Carroll 1980, Proc. 2nd Systems Simulation and Economic Analysis Conference, San Diego "
    "(view factors approximated by areas)"
)
_ATMOSPHERE = "ICAO Doc 7488, Manual of the ICAO Standard Atmosphere (density of the air)"
_IDEAL_LOADS = "Hintermueller, Ito & Kunisch 2002, doi:10.1137/S1052623401383558 (ideal loads)"
_SHADOWS = "Sutherland & Hodgman 1974, doi:10.1145/360767.360802 (shadows and sun patches as polygons)"
_CURVE = "Fritsch & Butland 1984, doi:10.1137/0905021 (monotone interpolation of enthalpy tables)"

#: Marks of a publication in the text beside an assumed number.
_PUBLICATION = re.compile(
    r"\b(1[89]|20)\d\d\b|\bdoi\b|[A-Z]{2,}|\b(table|sec\.|ch\.|fig\.|eq\.) ?\d|(data|product) sheet"
)


def sources(building: Description) -> list[str]:
    """Where the numbers and methods of a building come from, without repetition.

    Listed are the sources of numbers on which a result depends, and of the methods of a run with the default
    scheme. Remarks on defaults are not listed. The text beside a number marked as assumed is listed if it
    names a publication: by a year, a DOI, capital letters such as ISO, a numbered table or section, a data
    sheet.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of str
        Sources of numbers in the order of the description, then of methods.
    """
    return list(dict.fromkeys([*_of_numbers(building), *_of_methods(building)]))


def _of_numbers(building: Description) -> Iterator[str]:
    inactive = without_effect(building)
    if not _sunlit(building):
        inactive |= dict.fromkeys(("site.latitude", "site.longitude"), "no irradiance comes from the climate")
    for path, number, source in leaves(building):
        # A direction that "only decides" between cases still has an effect.
        acts = path not in inactive or inactive[path].startswith("it only decides")
        if acts and _is_source(number, source):
            yield source


def _is_source(number: Number, source: str) -> bool:
    if not source or isinstance(source, Remark):
        return False
    return not number.assumed or _PUBLICATION.search(source) is not None


def _of_methods(building: Description) -> Iterator[str]:
    yield from _of_sun(building)
    yield from _of_sky(building)
    yield from _of_zones(building)
    laws = [side.imposed for surface in building.surfaces.values() for side in surface.sides]
    yield from (source for law in laws if law is not None for source in law.row.sources)
    films = [item.side.convection for item in sides(building)]
    kinds = dict.fromkeys(film.kind for film in films if film is not None)
    yield from (source for kind in kinds for source in SOURCES.get(kind, ()))
    yield from (film.source for film in films if isinstance(film, FormulaLaw) and film.source)
    yield from (law.source for _, law in text_laws(building) if law.source)
    if any(item.windy and has_height(item.side) for item in sides(building)):
        yield ASHRAE_WIND
    yield from _of_air(building)
    if any(source.water or source.thermostat for source in building.heat_sources.values()):
        yield HEAT_SOURCE
    if any(zone.loads for zone in building.zones.values()):
        yield _IDEAL_LOADS
    if building.humidity is not None:
        yield PSYCHROMETRICS
        materials = building.humidity.materials.values()
        yield from (source for law in materials if isinstance(law, SorptionLaw) for source in law.row.sources)
        if any(side.takes_up for side in vapour_sides(building)):
            yield EMPD
    yield from _of_glazings(building)
    if any(window.blind is not None for window in building.windows.values()):
        yield NET_RADIATION
    traced = any(isinstance(zone.sun, TracedSun) for zone in building.zones.values())
    if building.shades or traced or obstructions(building):
        yield _SHADOWS
    if _tabulated(building):
        yield _CURVE
    yield _TIME_STEPS


def _of_air(building: Description) -> Iterator[str]:
    if building.openings:
        yield ASHRAE_OPENING
    if building.vents:
        yield ORIFICE
    if any(isinstance(vent.pressure, LowRise) for vent in building.vents.values()):
        yield SWAMI_CHANDRA
    if any(vent.height is not None for vent in building.vents.values()):
        yield BROWN_SOLVASON
    if any(path.door is not None for path in building.air_paths.values()):
        yield BROWN_SOLVASON
    if any(unit.recovery is not None for unit in building.ventilation_units.values()):
        yield RECOVERY_SOURCE
    tests = [zone.infiltration.blower_door for zone in building.zones.values()]
    yield from (source for test in tests if test is not None for source in test.row.sources)


def _sunlit(building: Description) -> bool:
    return any(item.sunlit for item in sides(building)) or bool(obstructed(building))


def _of_sun(building: Description) -> Iterator[str]:
    if not _sunlit(building):
        return
    yield from (_SUN, _PVLIB, *DIFFUSE[building.site.diffuse].sources)


def _of_sky(building: Description) -> Iterator[str]:
    if not any(item.sees_sky for item in sides(building)):
        return
    sky = building.site.sky
    if isinstance(sky, SkyLaw):
        yield from sky.row.sources
        if not sky.clouded:
            yield CLARK if building.site.cloud.kind == "factor" else MARTIN
    yield _SKY_SPLIT


def _of_zones(building: Description) -> Iterator[str]:
    if building.zones and building.site.air_density is None:
        yield _ATMOSPHERE
    for name, zone in building.zones.items():
        surfaces = building.connections.of(name)
        if zone.longwave.kind == "none" or len(surfaces) < 2:
            continue
        yield _ENCLOSURE
        if zone.view_factors is None:
            yield _EXACT_VIEW if closed(surfaces) else _AREA_VIEW


def _of_glazings(building: Description) -> Iterator[str]:
    for name in dict.fromkeys(window.glazing for window in building.windows.values()):
        glass = building.glazings[name]
        if isinstance(glass, SimpleGlazing):
            yield from (GLASS[key] for key in ("simple", "angle"))
            continue
        coated = [isinstance(pane.reflectance, TwoSides) for pane in glass.panes]
        if glass.angular is None:
            laws = {"panes": not all(coated), "coated": any(coated)}
            yield from (GLASS[key] for key, acts in laws.items() if acts)
        if any(isinstance(gap, FilledGap) for gap in glass.gaps):
            yield GLASS["filled"]


def _tabulated(building: Description) -> bool:
    built = {surface.construction for surface in building.surfaces.values()}
    used = {layer.material for name in built for layer in building.constructions[name].layers}
    materials = (building.materials[name] for name in used)
    return any(
        isinstance(material, PhaseChangeMaterial) and isinstance(material.law, TableLaw | FractionsLaw)
        for material in materials
    )
