"""The building of a study, as the report shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from mascarin.study.results.document.equipment import equipment
from mascarin.study_document.building import (
    AssumptionEntry,
    BuildingEntry,
    ConstructionEntry,
    LayerEntry,
    ProbeEntry,
    SurfaceEntry,
    WindowEntry,
    ZoneEntry,
)

if TYPE_CHECKING:
    from mascarin.building import Building

#: Properties of a material that are shown.
_PROPERTIES: Final = (
    "conductivity",
    "density",
    "specific_heat",
    "resistance",
    "latent_heat",
    "melting_temperature",
)


def building_entry(building: Building) -> BuildingEntry:
    """Site, zones, constructions, surfaces and modeling choices."""
    site = building.site
    return BuildingEntry(
        name=building.name,
        site=[
            ["latitude", f"{float(site.latitude):g} deg"],
            ["longitude", f"{float(site.longitude):g} deg"],
            ["altitude", f"{float(site.altitude):g} m"],
            ["time zone", str(site.timezone)],
        ],
        zones=[
            ZoneEntry(name=name, volume=float(zone.volume or 0.0)) for name, zone in building.zones.items()
        ],
        constructions=[
            ConstructionEntry(name=name, layers=[_layer(building, layer) for layer in construction.layers])
            for name, construction in building.constructions.items()
        ],
        surfaces=[_surface(name, surface) for name, surface in building.surfaces.items()],
        windows=[WindowEntry(name=name, surface=window.surface) for name, window in building.windows.items()],
        equipment=equipment(building),
        doors=[list(path.between) for path in building.air_paths.values() if path.door is not None],
        probes=[
            ProbeEntry(name=name, surface=sensor.surface, depth=float(sensor.depth))
            for name, sensor in building.sensors.items()
        ],
        choices=[["sky", site.sky.kind], ["diffuse radiation", site.diffuse]]
        + [[f"long-wave exchange in {name}", zone.longwave.kind] for name, zone in building.zones.items()],
    )


def _layer(building: Building, layer: Any) -> LayerEntry:
    material = building.materials[layer.material]
    stated = {key: getattr(material, key, None) for key in _PROPERTIES}
    properties = {key: _one_or_two(value) for key, value in stated.items() if value is not None}
    if layer.thickness is not None:
        properties["thickness"] = float(layer.thickness)
    return LayerEntry(name=layer.name, material=layer.material, kind=material.kind, **properties)


def _one_or_two(value: Any) -> float | list[float]:
    if hasattr(value, "solid"):
        return [float(value.solid), float(value.liquid)]
    return float(value)


def _surface(name: str, surface: Any) -> SurfaceEntry:
    films = {"film_outside": surface.outside.convection, "film_inside": surface.inside.convection}
    stated: dict[str, Any] = {key: film.kind for key, film in films.items() if film is not None}
    if surface.vertices is not None:
        stated["vertices"] = [[float(x) for x in vertex] for vertex in surface.vertices]
    return SurfaceEntry(
        name=name,
        construction=surface.construction,
        area=float(surface.area),
        tilt=float(surface.tilt),
        azimuth=float(surface.azimuth),
        outside=_facing(surface.outside),
        inside=_facing(surface.inside),
        **stated,
    )


def _facing(side: Any) -> str:
    if side.zone is not None:
        return str(side.zone)
    if side.measured is not None:
        columns = [side.measured] if isinstance(side.measured, str) else list(side.measured)
        return columns[0] if len(columns) == 1 else f"mean of {' and '.join(columns)}"
    return "ground" if side.ground is not None else str(side.faces)


def assumptions(building: Building) -> list[AssumptionEntry]:
    """Assumed values with their ranges and sources."""
    return [
        AssumptionEntry(
            path=p.path,
            value=p.value,
            unit=p.unit,
            low=p.low,
            high=p.high,
            source=p.source or "",
            assumed=True,
        )
        for p in building.parameters()
        if p.assumed
    ]
