"""A building in the words of the report's payload."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from mascarin.report.payload import Assumption, BuildingEntry, LayerEntry, SurfaceEntry
from mascarin.report.text import significant, with_unit

if TYPE_CHECKING:
    from mascarin.model import Building

_FILMS = {
    "constant": "constant",
    "linear_wind": "linear in wind",
    "alamdari_hammond": "Alamdari and Hammond",
    "paper_eq5": "eq. 5 as printed",
    "tarp": "TARP",
    "mowitt": "MoWiTT",
    "power": "power law by direction",
}
_SKIES = {
    "martin_berdahl": "Martin and Berdahl, with clouds",
    "clark_allen": "Clark and Allen, with clouds",
    "brunt": "Brunt, with clouds",
    "offset": "a fixed depression below the air",
    "measured": "measured infrared",
}
_DIFFUSE = {"perez": "Perez et al. 1990", "hay_davies": "Hay and Davies", "isotropic": "isotropic"}
_LONGWAVE = {"radiosity": "radiosity, exact", "linearised": "linearised", "none": "none of its own"}


def building_entry(building: Building) -> BuildingEntry:
    """Describe what was modelled.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    BuildingEntry
        For ``study["building"]``.
    """
    site = building.site
    return {
        "name": building.name,
        "site": [
            ["Latitude", with_unit(float(site.latitude), "deg", 4)],
            ["Longitude", with_unit(float(site.longitude), "deg", 4)],
            ["Altitude", with_unit(float(site.altitude), "m")],
            ["Time zone", str(site.timezone)],
        ],
        "zones": [{"name": name, "volume": _plain(zone.volume)} for name, zone in building.zones.items()],
        "constructions": [
            {"name": name, "layers": [_layer(building, layer) for layer in construction.layers]}
            for name, construction in building.constructions.items()
        ],
        "surfaces": [_surface(name, surface) for name, surface in building.surfaces.items()],
        "probes": [
            {"name": name, "surface": probe.surface, "depth": float(probe.depth)}
            for name, probe in building.sensors.items()
        ],
        "choices": _choices(building),
    }


def assumption_entries(building: Building) -> list[Assumption]:
    """List every number of a building that is marked as assumed.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of Assumption
        For ``study["assumptions"]``.
    """
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


def _plain(value: Any) -> Any:
    return None if value is None else float(value)


def _pair(value: Any) -> float | list[float] | None:
    if hasattr(value, "solid"):
        return [float(value.solid), float(value.liquid)]
    return cast("float | None", _plain(value))


def _layer(building: Building, layer: Any) -> LayerEntry:
    material = building.materials[layer.material]
    entry: dict[str, Any] = {"name": layer.name, "material": layer.material, "kind": material.kind}
    for key in (
        "conductivity",
        "density",
        "specific_heat",
        "resistance",
        "latent_heat",
        "melting_temperature",
    ):
        value = _pair(getattr(material, key, None))
        if value is not None:
            entry[key] = value
    if layer.thickness is not None:
        entry["thickness"] = float(layer.thickness)
    return cast("LayerEntry", entry)


def _surface(name: str, surface: Any) -> SurfaceEntry:
    entry: dict[str, Any] = {
        "name": name,
        "construction": surface.construction,
        "area": _plain(surface.area),
        "tilt": _plain(surface.tilt),
        "azimuth": _plain(surface.azimuth),
        "outside": _facing(surface.outside),
        "inside": _facing(surface.inside),
        "film_outside": _film(surface.outside),
        "film_inside": _film(surface.inside),
    }
    if surface.vertices is not None:
        entry["vertices"] = [[float(c) for c in vertex] for vertex in surface.vertices]
    return cast("SurfaceEntry", entry)


def _facing(side: Any) -> str:
    if side.outdoors:
        return "outdoors"
    if side.zone is not None:
        return str(side.zone)
    if side.measured is not None:
        return f"measured {side.measured}"
    return "ground" if side.ground is not None else "adiabatic"


def _film(side: Any) -> str:
    film = side.convection
    if film is None:
        return ""
    if film.kind == "constant":
        return with_unit(float(film.coefficient), "W/(m2 K)")
    if film.kind == "linear_wind":
        return f"{significant(float(film.constant))} + {significant(float(film.wind))} V"
    return _FILMS.get(str(film.kind), str(film.kind))


def _choices(building: Building) -> list[list[str]]:
    sky, diffuse = building.site.sky.kind, building.site.diffuse
    rows = [
        ["Long-wave of the sky", _SKIES.get(sky, sky)],
        ["Diffuse radiation on planes", _DIFFUSE.get(diffuse, diffuse)],
    ]
    for name, zone in building.zones.items():
        kind = zone.longwave.kind
        rows.append([f"Long-wave in {name.replace('_', ' ')}", _LONGWAVE.get(kind, kind)])
    for words, sides in (
        ("Films outdoors", [s.outside for s in building.surfaces.values() if s.outside.outdoors]),
        ("Films in zones", [x for s in building.surfaces.values() for x in (s.outside, s.inside) if x.zone]),
    ):
        kinds = dict.fromkeys(_FILMS.get(side.convection.kind, "") for side in sides if side.convection)
        if kinds:
            rows.append([words, ", ".join(kinds)])
    return rows
