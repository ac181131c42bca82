"""The parts of a description that have an output, by the words of the engine's table (`Of` in ``row.rs``)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

from mascarin.building.base.part import cached_on
from mascarin.building.parts.envelope.surface import Side
from mascarin.building.parts.materials.material import PhaseChangeMaterial

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.openings.window import WindowOutside

SIDES: Final = ("outside", "inside")


class Place(NamedTuple):
    """Where an output is read.

    Attributes
    ----------
    positions : mapping of str to int
        Positions in the description, by name.
    words : mapping of str to str
        What the words in capitals of a name stand for.
    """

    positions: Mapping[str, int]
    words: Mapping[str, str]


def owners(building: Description) -> dict[str, list[str]]:
    """Names of the parts of each sort, in the order of the description."""
    return {
        "ZONE": list(building.zones),
        "SURFACE": list(building.surfaces),
        "WINDOW": list(building.windows),
        "VENT": list(building.vents),
        "CONTROL": list(building.controls),
        "SOURCE": list(building.heat_sources),
        "": [""],
        "SENSOR": list(building.sensors),
    }


def places(building: Description, owner: str, index: int, name: str, of: str) -> Iterator[Place]:
    """Places of a part that have an output.

    Parameters
    ----------
    building : Description
        The building.
    owner : str
        What the part is, such as ZONE.
    index : int
        Its position.
    name : str
        Its name.
    of : str
        The parts that have the output, such as ``heated_zone``.
    """
    if owner == "ZONE":
        locations = [Place({"zone": index}, {})] if _ZONES[of](building, name) else []
    elif of == "derived":
        locations = [
            Place({"derived": number}, {"NAME": word}) for number, word in enumerate(building.derived_outputs)
        ]
    elif of == "water_source":
        is_water = building.heat_sources[name].water is not None
        locations = [Place({"source": index}, {})] if is_water else []
    elif owner == "SURFACE":
        locations = list(_of_surface(building, index, name, of))
    elif owner == "WINDOW":
        locations = list(_of_window(building, len(building.surfaces) + index, name, of))
    else:
        locations = [Place({owner.lower(): index} if owner else {}, {})]
    for location in locations:
        yield Place(location.positions, {**location.words, owner: name})


def _has_humidity(building: Description, zone: str, plant: str = "") -> bool:
    if building.humidity is None:
        return False
    settings = building.humidity.zones.get(zone)
    return not plant or getattr(settings, plant, None) is not None


_ZONES: Final[Mapping[str, Callable[[Description, str], bool]]] = {
    "zone": lambda building, zone: True,
    "heated_zone": lambda building, zone: "heating" in building.zones[zone].loads,
    "cooled_zone": lambda building, zone: "cooling" in building.zones[zone].loads,
    "conditioned_zone": lambda building, zone: bool(building.zones[zone].loads),
    "sunlit_zone": lambda building, zone: zone in _lit_zones(building),
    "stratified_zone": lambda building, zone: building.zones[zone].air_gradient is not None,
    "humid_zone": lambda building, zone: _has_humidity(building, zone),
    "dried_zone": lambda building, zone: _has_humidity(building, zone, "drying"),
    "humidified_zone": lambda building, zone: _has_humidity(building, zone, "humidifying"),
}


def _lit_zones(building: Description) -> set[str | None]:
    """Zones that the sun enters through windows."""

    def found() -> set[str | None]:
        walls = [building.surfaces[window.surface] for window in building.windows.values()]
        return {side.zone for wall in walls for side in wall.sides} - {None}

    return cached_on(building, "_lit_zones", found)


def _radiates(building: Description, side: Side | WindowOutside) -> bool:
    """Whether long-wave radiation is exchanged beside the convection."""
    if isinstance(side, Side) and side.zone is not None:
        return building.zones[side.zone].longwave.kind != "none"
    return bool(side.outdoors) and (side.longwave is None or side.longwave.kind != "none")


def _is_lit(building: Description, side: Side) -> bool:
    return bool(side.sunlit) or side.irradiance is not None or (side.zone in _lit_zones(building))


_SURFACE_SIDES: Final[Mapping[str, Callable[[Description, Side], bool]]] = {
    "side": lambda building, side: True,
    "sunlit_side": _is_lit,
    "radiating_side": _radiates,
    "convective_side": lambda building, side: (
        side.convection is not None and (bool(side.outdoors) or side.zone is not None)
    ),
    "humid_side": lambda building, side: building.humidity is not None and side.zone is not None,
}


def _of_surface(building: Description, index: int, name: str, of: str) -> Iterator[Place]:
    surface = building.surfaces[name]
    if of in _SURFACE_SIDES:
        for number, side in enumerate(surface.sides):
            if _SURFACE_SIDES[of](building, side):
                yield Place({"surface": index, "side": number}, {"SIDE": SIDES[number]})
        return
    layers = building.constructions[surface.construction].layers
    if of == "outdoor_surface" and surface.outside.outdoors:
        yield Place({"surface": index}, {})
    elif of == "interface":
        for number, (outer, inner) in enumerate(pairwise(layers), start=1):
            words = {"N": str(number), "LAYER_LAYER": f"{outer.name}_{inner.name}"}
            yield Place({"surface": index, "interface": number}, words)
    elif of in ("layer", "melting_layer"):
        for number, layer in enumerate(layers):
            if of == "layer" or isinstance(building.materials[layer.material], PhaseChangeMaterial):
                yield Place({"surface": index, "layer": number}, {"LAYER": layer.name})


def _of_window(building: Description, index: int, name: str, of: str) -> Iterator[Place]:
    window = building.windows[name]
    wall = building.surfaces[window.surface]
    outdoors = bool(wall.outside.outdoors)
    if of == "window" or (of in ("outdoor_surface", "outdoor_window") and outdoors):
        yield Place({"surface": index}, {})
    elif of == "sunlit_side":  # all panes together
        yield Place({"surface": index, "side": 0}, {})
    elif of in _SURFACE_SIDES:
        outside = window.outside if outdoors else wall.outside
        for number, side in enumerate((outside, wall.inside)):
            if of == "radiating_side" and not _radiates(building, side):
                continue
            if of == "humid_side" and (building.humidity is None or wall.sides[number].zone is None):
                continue
            yield Place({"surface": index, "side": number}, {"SIDE": SIDES[number]})
