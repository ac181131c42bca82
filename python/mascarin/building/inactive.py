"""Numbers that no result of a building depends on, and why.

A sensitivity analysis leaves them out, and the parameter table says why moving them would change nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mascarin.building.convection import (
    AlamdariHammond,
    Doe2,
    Iso15099,
    LinearWind,
    Mowitt,
    PaperEq5,
    Power,
    Tarp,
)
from mascarin.building.derived import faces_of
from mascarin.building.glazing import FilledGap, GivenGap, PaneEmissivities, PaneGlazing
from mascarin.building.leaves import leaves
from mascarin.building.surface import NoLongwave, Side, Surface
from mascarin.building.window import WindowInside, WindowOutside, windows_of
from mascarin.building.zone import GivenSun
from mascarin.building.zone_surfaces import closed, zone_faces

if TYPE_CHECKING:
    from mascarin.building.description import Description

Reasons = Iterator[tuple[str, str]]


@dataclass(frozen=True)
class Face:
    """One side of a surface and the tilt of its own normal [deg]."""

    path: str
    side: Side | WindowOutside | WindowInside
    tilt: float

    @property
    def windy(self) -> bool:
        """Whether its film depends on wind."""
        film = self.side.convection
        if not self.side.exposed.wind:
            return False
        if isinstance(film, Power):
            return film.upward.c > 0.0 or film.downward.c > 0.0
        return isinstance(film, LinearWind | Tarp | Mowitt | Doe2)

    @property
    def sunlit(self) -> bool:
        """Whether it takes its irradiance from the climate."""
        return self.side.sunlit

    @property
    def sees_sky(self) -> bool:
        """Whether it exchanges long-wave with the sky."""
        if isinstance(self.side, WindowInside) or not self.side.outdoors:
            return False
        view = (1.0 if self.tilt < 180.0 else 0.0) if self.side.sky_view is None else self.side.sky_view
        return self.side.exposed.sky and not isinstance(self.side.longwave, NoLongwave) and view > 0.0


def has_height(side: Side | WindowOutside | WindowInside) -> bool:
    """Tell whether a side says how high it lies above ground."""
    return not isinstance(side, WindowInside) and side.height is not None


def without_effect(building: Description) -> dict[str, str]:
    """Paths of the numbers that do not act in this building, each with the reason."""
    every = faces(building)
    found = dict(_unused(building))
    found.update(_in_site(building, every))
    for face in every:
        found.update(_on_side(face))
    found.update(_behind_walls(building))
    for name, surface in building.surfaces.items():
        found.update(_in_direction(building, name, surface))
    found.update(_between_faces(building))
    found.update(_in_air(building))
    return found


def faces(building: Description) -> list[Face]:
    """Both sides of every surface, in the order of the description."""
    walls = [face for name, surface in building.surfaces.items() for face in _faces(name, surface)]
    return [*walls, *(face for name in building.windows for face in _window_faces(building, name))]


def _window_faces(building: Description, name: str) -> Iterator[Face]:
    window = building.windows[name]
    tilt = float(building.surfaces[window.surface].tilt or 0.0)
    yield Face(f"windows.{name}.outside", window.outside, tilt)
    yield Face(f"windows.{name}.inside", window.inside, 180.0 - tilt)


def _behind_walls(building: Description) -> Reasons:
    """Find absorptances that no sun reaches, and heights of gaps that there are none of."""
    for zone in building.zones:
        faces = zone_faces(zone, building.surfaces, building.windows)
        lit = any(face.window is not None for face in faces)
        given = isinstance(building.zones[zone].sun, GivenSun)
        for face in faces:
            path = f"surfaces.{face.name}.{face.side}.absorptance"
            if face.surface is not None and (not lit or given):
                yield path, "no sun enters the zone" if not lit else "the zone's shares are given"
    for name, glazing in building.glazings.items():
        zones = [
            building.zones[str(building.surfaces[window.surface].inside.zone)]
            for window in building.windows.values()
            if window.glazing == name
        ]
        reason = "the shares of the sun are given where this glazing is"
        if (
            zones
            and all(isinstance(zone.sun, GivenSun) for zone in zones)
            and isinstance(glazing, PaneGlazing)
        ):
            yield f"glazings.{name}.panes.{len(glazing.panes) - 1}.reflectance.inside", reason
    for name, window in building.windows.items():
        glass = building.glazings[window.glazing]
        gaps = glass.gaps if isinstance(glass, PaneGlazing) else ()
        if not any(isinstance(gap, FilledGap) for gap in gaps):
            yield f"windows.{name}.cavity_height", "no gap of this window is filled with gas"


def _faces(name: str, surface: Surface) -> Iterator[Face]:
    tilt = float(surface.tilt or 0.0)
    yield Face(f"surfaces.{name}.outside", surface.outside, tilt)
    yield Face(f"surfaces.{name}.inside", surface.inside, 180.0 - tilt)


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
    """Find emissivities that face nothing but gaps of a given conductance."""
    given = [isinstance(gap, GivenGap) for gap in glazing.gaps]
    for index, pane in enumerate(glazing.panes):
        faces = {"outside": index > 0 and given[index - 1], "inside": index < len(given) and given[index]}
        if isinstance(pane.emissivity, PaneEmissivities):
            idle = [f".{face}" for face, still in faces.items() if still]
        else:
            idle = [""] if all(faces.values()) else []
        for which in idle:
            yield f"{path}.panes.{index}.emissivity{which}", "the conductance of the gap is given"


def _in_site(building: Description, every: list[Face]) -> Reasons:
    site = building.site
    seeing = [face for face in every if face.sees_sky]
    if not any(face.sunlit and face.tilt > 0.0 for face in every):
        yield "site.ground_reflectance", "no face takes its irradiance from the climate and sees the ground"
    if not seeing:
        yield from _all_of("site.sky", site.sky, "no face exchanges long-wave with the sky")
    if not seeing or site.sky.kind in ("measured", "offset"):
        yield from _all_of("site.cloud", site.cloud, "no emissivity of the sky is used")
    if not any(face.windy and has_height(face.side) for face in every):
        reason = "no film depends on wind at the height of its face: mast wind is used as it is"
        yield from _all_of("site.wind", site.wind, reason)
    if not building.zones:
        reason = "there is no zone whose air has a density"
        yield from ((f"site.{key}", reason) for key in ("altitude", "air_density"))
    elif site.air_density is not None:
        yield "site.altitude", "the density of the air is written"


def _on_side(face: Face) -> Reasons:
    side, path = face.side, face.path
    if side.ground is not None and side.ground.amplitude == 0.0:
        yield f"{path}.ground.coldest_day", "the amplitude is 0"
    if not face.windy:
        yield f"{path}.height", "the film does not depend on wind"
    if not isinstance(side, WindowInside) and side.outdoors and isinstance(side.longwave, NoLongwave):
        yield f"{path}.emissivity", "longwave is none"
        if side.irradiance is not None:
            yield f"{path}.sky_view", "longwave is none and the irradiance is measured"
    windless = not side.exposed.wind
    if isinstance(side.convection, LinearWind) and windless:
        yield f"{path}.convection.wind", "there is no wind on this side"
    if isinstance(side.convection, Tarp) and side.outdoors and windless:
        yield from (
            (f"{path}.convection.{key}", "there is no wind on this side")
            for key in ("roughness", "perimeter")
        )
    if isinstance(side.convection, Doe2) and windless:
        yield f"{path}.convection.roughness", "there is no wind on this side"
    if isinstance(side.convection, Power):
        yield from _in_power(face, side.convection)


def _in_power(face: Face, film: Power) -> Reasons:
    for direction, law in (("upward", film.upward), ("downward", film.downward)):
        path = f"{face.path}.convection.{direction}"
        # A vertical face always takes the upward law.
        if direction == "downward" and face.tilt == 90.0:
            yield from _all_of(path, law, "the face is vertical")
            continue
        if law.b == 0.0:
            yield f"{path}.n", "b is 0"
        if not face.side.exposed.wind:
            yield from ((f"{path}.{key}", "there is no wind on this side") for key in ("c", "m"))
        elif law.c == 0.0:
            yield f"{path}.m", "c is 0"


def _in_direction(building: Description, name: str, surface: Surface) -> Reasons:
    """Tilt and azimuth act through sun, sky and wind; through buoyancy and view they only choose a case."""
    faces = list(_faces(name, surface))
    for window, _ in windows_of(name, building.windows):
        faces += _window_faces(building, window)
    sunlit = any(face.sunlit for face in faces)
    seen = any(side.zone is not None and _by_direction(building, side.zone) for side in surface.sides)
    buoyant = any(isinstance(face.side.convection, AlamdariHammond | PaperEq5 | Power) for face in faces)
    reasons = ["which faces of a zone lie in one plane"] if seen else []
    if surface.tilt in (0.0, 180.0):
        yield f"surfaces.{name}.azimuth", "a horizontal surface has no direction"
    elif not (
        sunlit or any(face.windy and isinstance(face.side.convection, Tarp | Mowitt | Doe2) for face in faces)
    ):
        yield f"surfaces.{name}.azimuth", _only(reasons)
    skyward = any(face.sees_sky and _sky_by_tilt(face) for face in faces)
    tilted = any(isinstance(face.side.convection, Tarp | Doe2 | Iso15099) for face in faces)
    if not (sunlit or skyward or tilted):
        yield (
            f"surfaces.{name}.tilt",
            _only([*reasons, *(["vertical or horizontal film"] if buoyant else [])]),
        )


def _sky_by_tilt(face: Face) -> bool:
    return not isinstance(face.side, WindowInside) and face.side.sky_view is None


def _only(choices: list[str]) -> str:
    return f"it only decides: {', '.join(choices)}" if choices else "neither sun, sky, wind nor zone see it"


def _by_direction(building: Description, zone: str) -> bool:
    """Tell whether the view factors of a zone are approximated from areas, tilts and azimuths."""
    if isinstance(building.zones[zone].longwave, NoLongwave) or building.zones[zone].view_factors is not None:
        return False
    return not closed(zone_faces(zone, building.surfaces, building.windows))


def _between_faces(building: Description) -> Reasons:
    for name, zone in building.zones.items():
        faces = faces_of(name, building.surfaces)
        lone = len(zone_faces(name, building.surfaces, building.windows)) == 1
        reason = "the zone has no long-wave exchange" if isinstance(zone.longwave, NoLongwave) else ""
        reason = reason or ("no other face exchanges with it" if lone else "")
        if reason:
            yield from ((f"surfaces.{surface}.{side}.emissivity", reason) for surface, side in faces)
            yield f"zones.{name}.longwave.reference", reason


def _in_air(building: Description) -> Reasons:
    for name, zone in building.zones.items():
        for gain, numbers in zone.gains.items():
            if numbers.power == 0.0:
                yield f"zones.{name}.gains.{gain}.radiative", "the power is 0"
    for name, opening in building.openings.items():
        if opening.discharge == 0.0:
            yield f"openings.{name}.height", "the discharge is 0"
        if opening.height == 0.0:
            yield f"openings.{name}.discharge", "the height is 0"


def _all_of(path: str, part: Any, reason: str) -> Reasons:
    yield from ((leaf, reason) for leaf, _, _ in leaves(part, path))
