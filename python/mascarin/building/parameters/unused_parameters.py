"""Numbers that no result of a building depends on, each with the reason.

A sensitivity analysis leaves them out, and the table of parameters gives the reason.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mascarin.building.base.leaves import leaves
from mascarin.building.parts.air.zone import GivenSun
from mascarin.building.parts.envelope.convection import (
    Convection,
    ConvectionLaw,
    by_wind_direction,
)
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.building.parts.envelope.surface import NoLongwave, Side, Surface
from mascarin.building.parts.measured_sun import paths as obstructed_paths
from mascarin.building.parts.openings.glazing import FilledGap, GivenGap, PaneEmissivities, PaneGlazing
from mascarin.building.parts.openings.window import WindowInside, WindowOutside, outer_side
from mascarin.building.parts.zone_surfaces import closed

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description

Reasons = Iterator[tuple[str, str]]


@dataclass(frozen=True)
class SurfaceSide:
    """One side of a surface, the tilt of its own normal [deg] and its area [m2]."""

    path: str
    side: Side | WindowOutside | WindowInside
    tilt: float
    area: float = 0.0

    @property
    def windy(self) -> bool:
        """Whether its heat transfer coefficient depends on wind."""
        film = self.side.convection
        if not self.side.exposed.wind:
            return False
        if isinstance(film, FormulaLaw):
            return any(film.uses(name) for name in ("V", "windward", "wind_angle"))
        return isinstance(film, ConvectionLaw) and film.windy

    @property
    def sunlit(self) -> bool:
        """Whether its irradiance comes from the climate."""
        return self.side.sunlit

    @property
    def sees_sky(self) -> bool:
        """Whether it exchanges long-wave radiation with the sky."""
        if isinstance(self.side, WindowInside) or not self.side.outdoors:
            return False
        view = (1.0 if self.tilt < 180.0 else 0.0) if self.side.sky_view is None else self.side.sky_view
        return self.side.exposed.sky and not isinstance(self.side.longwave, NoLongwave) and view > 0.0

    @property
    def sees_ground(self) -> bool:
        """Whether sun that the ground reflects reaches it."""
        view = None if isinstance(self.side, WindowInside) else self.side.ground_view
        return self.tilt > 0.0 if view is None else view > 0.0


def has_height(side: Side | WindowOutside | WindowInside) -> bool:
    """Whether a side has a height above ground."""
    return not isinstance(side, WindowInside) and side.height is not None


def without_effect(building: Description) -> dict[str, str]:
    """Paths of the numbers that have no effect in this building, each with the reason."""
    all_sides = sides(building)
    reasons = dict(_unused(building))
    reasons.update(_in_site(building, all_sides))
    parts = obstructed_paths(building)
    for item in all_sides:
        reasons.update(_on_side(item, parts))
    reasons.update(_of_mixing(building, all_sides))
    reasons.update(_behind_walls(building))
    for name, surface in building.surfaces.items():
        reasons.update(_in_direction(building, name, surface))
    reasons.update(_between_faces(building))
    reasons.update(_in_air(building))
    return reasons


def sides(building: Description) -> list[SurfaceSide]:
    """Both sides of every surface, in the order of the description."""
    walls = [item for name, surface in building.surfaces.items() for item in _sides(name, surface)]
    return [*walls, *(item for name in building.windows for item in _window_sides(building, name))]


def _window_sides(building: Description, name: str) -> Iterator[SurfaceSide]:
    window = building.windows[name]
    tilt = float(building.surfaces[window.surface].tilt or 0.0)
    outer = outer_side(window, building.surfaces[window.surface])
    area = float(window.area or 0.0)
    yield SurfaceSide(f"windows.{name}.outside", outer, tilt, area)
    yield SurfaceSide(f"windows.{name}.inside", window.inside, 180.0 - tilt, area)


def _of_mixing(building: Description, all_sides: list[SurfaceSide]) -> Reasons:
    laws = (item.side.convection for item in all_sides)
    if not any(isinstance(law, FormulaLaw) and law.uses("total_air_change") for law in laws):
        for name, zone in building.zones.items():
            if zone.mixing_air_change is not None:
                reason = "no law of convection depends on the air that moves within a zone"
                yield from _all_of(f"zones.{name}.mixing_air_change", zone.mixing_air_change, reason)


def _behind_walls(building: Description) -> Reasons:
    """Absorptances that no sun reaches, and heights of gaps where no gap is filled."""
    for zone in building.zones:
        surfaces = building.connections.of(zone)
        has_glass = any(item.window is not None for item in surfaces)
        sun = building.zones[zone].sun
        is_stated_sun = isinstance(sun, GivenSun)
        if isinstance(sun, GivenSun) and not has_glass:
            yield from _all_of(f"zones.{zone}.sun", sun, "no sun enters the zone")
        for item in surfaces:
            path = f"surfaces.{item.name}.{item.side}.absorptance"
            if item.surface is not None and (not has_glass or is_stated_sun):
                yield (
                    path,
                    "no sun enters the zone"
                    if not has_glass
                    else "the distribution of the sun in the zone is given",
                )
    for name, glazing in building.glazings.items():
        zones = [
            building.zones[str(building.surfaces[window.surface].inside.zone)]
            for window in building.windows.values()
            if window.glazing == name
        ]
        reason = "the distribution of the sun is given where this glazing is"
        if (
            zones
            and all(isinstance(zone.sun, GivenSun) for zone in zones)
            and isinstance(glazing, PaneGlazing)
        ):
            yield f"glazings.{name}.panes.{len(glazing.panes) - 1}.reflectance.inside", reason
    for name, window in building.windows.items():
        if window.blind is not None:
            inside = building.zones[str(building.surfaces[window.surface].inside.zone)].longwave
            law = window.outside.longwave if window.blind.position == "outside" else inside
            if isinstance(law, NoLongwave):
                yield f"windows.{name}.blind.emissivity", "longwave is none"
        glass = building.glazings[window.glazing]
        gaps = glass.gaps if isinstance(glass, PaneGlazing) else ()
        if not any(isinstance(gap, FilledGap) for gap in gaps):
            yield f"windows.{name}.cavity_height", "no gap of this window is filled with gas"


def _sides(name: str, surface: Surface) -> Iterator[SurfaceSide]:
    tilt = float(surface.tilt or 0.0)
    area = float(surface.area or 0.0)
    yield SurfaceSide(f"surfaces.{name}.outside", surface.outside, tilt, area)
    yield SurfaceSide(f"surfaces.{name}.inside", surface.inside, 180.0 - tilt, area)


def _unused(building: Description) -> Reasons:
    built = {surface.construction for surface in building.surfaces.values()}
    contained = {layer.material for name in built for layer in building.constructions[name].layers}
    for name, construction in building.constructions.items():
        if name not in built:
            yield from _all_of(f"constructions.{name}", construction, "no surface is built this way")
    glazed = {window.glazing for window in building.windows.values()}
    for name, glazing in building.glazings.items():
        if name not in glazed:
            yield from _all_of(f"glazings.{name}", glazing, "no window has this glazing")
        elif isinstance(glazing, PaneGlazing):
            yield from _in_glazing(f"glazings.{name}", glazing)
    for name, material in building.materials.items():
        if name not in contained:
            yield from _all_of(f"materials.{name}", material, "no surface contains this material")


def _in_glazing(path: str, glazing: PaneGlazing) -> Reasons:
    """Emissivities next to gaps of a given conductance only."""
    is_stated_gap = [isinstance(gap, GivenGap) for gap in glazing.gaps]
    for index, pane in enumerate(glazing.panes):
        by_side = {
            "outside": index > 0 and is_stated_gap[index - 1],
            "inside": index < len(is_stated_gap) and is_stated_gap[index],
        }
        if isinstance(pane.emissivity, PaneEmissivities):
            inactive = [f".{side}" for side, still in by_side.items() if still]
        else:
            inactive = [""] if all(by_side.values()) else []
        for which in inactive:
            yield f"{path}.panes.{index}.emissivity{which}", "the conductance of the gap is given"


def _in_site(building: Description, all_sides: list[SurfaceSide]) -> Reasons:
    site = building.site
    seeing = [item for item in all_sides if item.sees_sky]
    parts = obstructed_paths(building)
    if not any((item.sunlit or item.path in parts) and item.sees_ground for item in all_sides):
        yield "site.ground_reflectance", "no tilted surface takes its irradiance from the climate"
    if not seeing:
        reason = "no surface exchanges long-wave radiation with the sky"
        yield from _all_of("site.sky", site.sky, reason)
        yield from ((f"site.{key}", reason) for key in ("sky_exponent", "sky_diurnal"))
    if not seeing or site.sky.clouded:
        yield from _all_of("site.cloud", site.cloud, "no emissivity of the sky is used")
    if not any(item.windy and has_height(item.side) for item in all_sides):
        reason = "no surface with a height depends on wind: the wind at the mast is used"
        yield from _all_of("site.wind", site.wind, reason)
    if not building.zones:
        reason = "there is no zone whose air has a density"
        yield from ((f"site.{key}", reason) for key in ("altitude", "air_density"))
    elif site.air_density is not None:
        yield "site.altitude", "the density of the air is given"


def _on_side(item: SurfaceSide, obstructed: set[str]) -> Reasons:
    side, path = item.side, item.path
    if side.ground is not None and side.ground.amplitude == 0.0:
        yield f"{path}.ground.coldest_day", "the amplitude is 0"
    law = item.side.convection
    if not item.windy and not (isinstance(law, FormulaLaw) and law.uses("height")):
        yield f"{path}.height", "the surface heat transfer coefficient does not depend on wind"
    if not isinstance(side, WindowInside) and side.outdoors and isinstance(side.longwave, NoLongwave):
        yield f"{path}.emissivity", "longwave is none"
        measured = side.irradiance is not None and not isinstance(side, WindowOutside)
        if measured and path not in obstructed:
            yield f"{path}.sky_view", "longwave is none and the irradiance is measured"
    if isinstance(side.convection, FormulaLaw):
        only = (name for name in side.convection.numbers if name not in side.convection.names_of_formula)
        yield from ((f"{path}.convection.{name}", "it only says where the law holds") for name in only)
    if isinstance(side.convection, ConvectionLaw):
        yield from _in_law(item, side.convection)


def _in_law(item: SurfaceSide, law: ConvectionLaw) -> Reasons:
    windless = not item.side.exposed.wind
    values = {key: value for key, _, value in law.values()}
    for key, number, _ in law.values():
        way = key.rpartition(".")[0]
        path = f"{item.path}.convection.{key}"
        owner = None if number.of is None else values[f"{way}.{number.of}" if way else number.of]
        # A vertical surface always uses the upward law.
        if way == "downward" and item.tilt == 90.0:
            yield path, "the surface is vertical"
        elif number.wind and windless:
            yield path, "there is no wind on this side"
        elif owner == 0.0:
            yield path, f"{number.of} is 0"


def _in_direction(building: Description, name: str, surface: Surface) -> Reasons:
    """Tilt and azimuth act by sun, sky and wind; for buoyancy and view factors they only choose a case."""
    both = list(_sides(name, surface))
    for window in building.connections.windows_in(name):
        both += _window_sides(building, window)
    parts = obstructed_paths(building)
    sunlit = any(item.sunlit or item.path in parts for item in both)
    by_direction = any(side.zone is not None and _by_direction(building, side.zone) for side in surface.sides)
    buoyant = any(_tilt(item.side.convection) == "cases" for item in both)
    reasons = ["which surfaces of a zone lie in one plane"] if by_direction else []
    if surface.tilt in (0.0, 180.0):
        yield f"surfaces.{name}.azimuth", "a horizontal surface has no direction"
    elif not (sunlit or any(item.windy and by_wind_direction(item.side.convection) for item in both)):
        yield f"surfaces.{name}.azimuth", _only(reasons)
    skyward = any(item.sees_sky and _sky_by_tilt(item) for item in both)
    tilted = any(_tilt(item.side.convection) == "steady" for item in both)
    if not (sunlit or skyward or tilted):
        yield (
            f"surfaces.{name}.tilt",
            _only([*reasons, *(["vertical or horizontal convection"] if buoyant else [])]),
        )


def _tilt(film: Convection | None) -> str:
    """How a coefficient depends on the tilt: none, cases (vertical or horizontal) or steady."""
    if isinstance(film, FormulaLaw):
        return "steady" if any(film.uses(name) for name in ("tilt", "upward")) else "none"
    return film.row.tilt if isinstance(film, ConvectionLaw) else "none"


def _sky_by_tilt(item: SurfaceSide) -> bool:
    return not isinstance(item.side, WindowInside) and item.side.sky_view is None


def _only(choices: list[str]) -> str:
    return (
        f"it only decides: {', '.join(choices)}" if choices else "sun, sky, wind and zone do not depend on it"
    )


def _by_direction(building: Description, zone: str) -> bool:
    """Whether the view factors of a zone are approximated from areas, tilts and azimuths."""
    if isinstance(building.zones[zone].longwave, NoLongwave) or building.zones[zone].view_factors is not None:
        return False
    return not closed(building.connections.of(zone))


def _between_faces(building: Description) -> Reasons:
    for name, zone in building.zones.items():
        zone_sides = building.connections.sides(name)
        lone = len(building.connections.of(name)) == 1
        reason = "the zone has no long-wave exchange" if isinstance(zone.longwave, NoLongwave) else ""
        reason = reason or ("no other surface exchanges with it" if lone else "")
        if reason:
            yield from ((f"surfaces.{surface}.{side}.emissivity", reason) for surface, side in zone_sides)
            yield f"zones.{name}.longwave.reference", reason


def _in_air(building: Description) -> Reasons:
    for name, zone in building.zones.items():
        for gain, numbers in zone.gains.items():
            if numbers.power == 0.0:
                yield f"zones.{name}.gains.{gain}.radiative", "the power is 0"
        for key, bridge in zone.thermal_bridges.items():
            if bridge.ground is not None and bridge.ground.amplitude == 0.0:
                path = f"zones.{name}.thermal_bridges.{key}.ground.coldest_day"
                yield path, "the amplitude is 0"
    for name, opening in building.openings.items():
        if opening.discharge == 0.0:
            yield f"openings.{name}.height", "the discharge is 0"
        if opening.height == 0.0:
            yield f"openings.{name}.discharge", "the height is 0"
    for name, control in building.controls.items():
        if control.minimum_open_time is not None and not control.by_temperature:
            yield f"controls.{name}.minimum_open_time", "wind and rain close at once"


def _all_of(path: str, part: Any, reason: str) -> Reasons:
    yield from ((leaf, reason) for leaf, _, _ in leaves(part, path))
