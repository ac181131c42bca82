"""The building of a study, as the report shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mascarin.building import Building


def building_entry(building: Building) -> dict[str, Any]:
    """Site, zones, constructions, surfaces and modeling choices."""
    site = building.site
    return {
        "name": building.name,
        "site": [
            ["latitude", f"{float(site.latitude):g} deg"],
            ["longitude", f"{float(site.longitude):g} deg"],
            ["altitude", f"{float(site.altitude):g} m"],
            ["time zone", str(site.timezone)],
        ],
        "zones": [
            {"name": name, "volume": float(zone.volume or 0.0)} for name, zone in building.zones.items()
        ],
        "constructions": [
            {"name": name, "layers": [_layer(building, layer) for layer in construction.layers]}
            for name, construction in building.constructions.items()
        ],
        "surfaces": [_surface(name, surface) for name, surface in building.surfaces.items()],
        "windows": [{"name": name, "surface": window.surface} for name, window in building.windows.items()],
        "doors": [list(path.between) for path in building.air_paths.values() if path.door is not None],
        "probes": [
            {"name": name, "surface": sensor.surface, "depth": float(sensor.depth)}
            for name, sensor in building.sensors.items()
        ],
        "choices": [["sky", site.sky.kind], ["diffuse radiation", site.diffuse]]
        + [[f"long-wave exchange in {name}", zone.longwave.kind] for name, zone in building.zones.items()],
    }


def _layer(building: Building, layer: Any) -> dict[str, Any]:
    material = building.materials[layer.material]
    entry: dict[str, Any] = {"name": layer.name, "material": layer.material, "kind": material.kind}
    if layer.thickness is not None:
        entry["thickness"] = float(layer.thickness)
    for key in (
        "conductivity",
        "density",
        "specific_heat",
        "resistance",
        "latent_heat",
        "melting_temperature",
    ):
        value = getattr(material, key, None)
        if value is not None:
            entry[key] = _one_or_two(value)
    return entry


def _one_or_two(value: Any) -> float | list[float]:
    if hasattr(value, "solid"):
        return [float(value.solid), float(value.liquid)]
    return float(value)


def _surface(name: str, surface: Any) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": name,
        "construction": surface.construction,
        "area": float(surface.area),
        "tilt": float(surface.tilt),
        "azimuth": float(surface.azimuth),
        "outside": _facing(surface.outside),
        "inside": _facing(surface.inside),
    }
    if surface.vertices is not None:
        entry["vertices"] = [[float(x) for x in vertex] for vertex in surface.vertices]
    for key, side in (("film_outside", surface.outside), ("film_inside", surface.inside)):
        if side.convection is not None:
            entry[key] = side.convection.kind
    return entry


def _facing(side: Any) -> str:
    if side.zone is not None:
        return str(side.zone)
    if side.measured is not None:
        columns = [side.measured] if isinstance(side.measured, str) else list(side.measured)
        return columns[0] if len(columns) == 1 else f"mean of {' and '.join(columns)}"
    return "ground" if side.ground is not None else str(side.faces)


def assumptions(building: Building) -> list[dict[str, Any]]:
    """Assumed values with their ranges and sources."""
    return [
        {
            "path": p.path,
            "value": p.value,
            "unit": p.unit,
            "low": p.low,
            "high": p.high,
            "source": p.source or "",
            "assumed": True,
        }
        for p in building.parameters()
        if p.assumed
    ]
