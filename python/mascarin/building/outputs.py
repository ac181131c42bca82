"""The results that a run of a building can give, by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from mascarin.building.material import PhaseChangeMaterial
from mascarin.building.part import worked_out
from mascarin.building.surface import Side
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building.description import Description
    from mascarin.building.window import WindowOutside

Kind = Literal[
    "air_temperature",
    "mean_radiant_temperature",
    "operative_temperature",
    "globe_temperature",
    "face_temperature",
    "face_flux",
    "interface_temperature",
    "layer_flux",
    "layer_temperature",
    "liquid_fraction",
    "layer_enthalpy",
    "sensor",
    "heating_load",
    "cooling_load",
    "net_load",
    "air_changes",
    "incident_solar",
    "transmitted_solar",
    "zone_transmitted_solar",
    "zone_lost_solar",
    "solar_transmittance",
    "absorbed_solar",
    "net_longwave",
    "convection",
    "sky_temperature",
    "humidity_ratio",
    "relative_humidity",
    "dew_point",
    "wet_bulb",
    "latent_cooling",
    "latent_heating",
    "surface_humidity",
    "condensation",
    "vent_inflow",
    "vent_outflow",
    "vent_open",
    "control_open",
]

_ZONE_KINDS: tuple[Kind, ...] = (
    "air_temperature",
    "mean_radiant_temperature",
    "operative_temperature",
    "globe_temperature",
)
#: Humidities of the air of a zone, and their units.
_HUMIDITIES: dict[Kind, str] = {
    "humidity_ratio": "kg/kg",
    "relative_humidity": "-",
    "dew_point": "degC",
    "wet_bulb": "degC",
}
#: Ends of the names of outputs that a building has only with humidity.
_DAMP = (
    *_HUMIDITIES,
    "latent_cooling_load",
    "latent_heating_load",
    "inside_relative_humidity",
    "outside_relative_humidity",
    "inside_condensation",
    "outside_condensation",
)
#: Units of means over the interval that ends at the time of the record.
_MEANS = ("W", "W/m2")
#: Kinds that are means or states at the time of the record, whatever their unit.
_BY_KIND = {"solar_transmittance": True, "net_longwave": False}
_SIDES = ("outside", "inside")


@dataclass(frozen=True)
class Output:
    """A result of a run.

    The mean radiant temperature of a zone is the mean of its surface temperatures, weighted by area; it does
    not use view factors to a point or emissivities. The operative temperature is the mean of air and
    mean radiant temperature; the globe temperature is that of a black globe of 0.15 m between the two.

    Heating and cooling loads are ideal loads, neither below 0, as means over the step that ends at the
    record; the net load is heating less cooling. Air changes include infiltration, ventilation, openings and
    the outdoor air of ventilation units.

    Solar radiation is the mean over the step that ends at the record: incident on a surface or window after
    shading [W/m2], transmitted by a window or by all windows of a zone, and lost by a zone through its
    windows [W]; absorbed by a side of a surface, or by all panes of a window [W/m2]. The solar transmittance
    of a window is what it transmits over what is incident on its glass, 0 without sun. A window between two
    zones transmits into the zone of its inside, less what it transmits the other way.

    In a building with humidity, the relative humidity at a side is that of the air of the zone at the
    temperature of the surface; condensation is 1 where the surface has dew or frost, else 0. The
    latent loads are what ideal drying takes away and ideal humidifying adds, neither below 0, as means over
    the step.

    The long-wave radiation that a side gains from its surroundings [W/m2] and its convective heat transfer
    coefficient [W/(m2 K)] are those at the time of the record.

    Attributes
    ----------
    name : str
        Its name.
    unit : str
        Its unit.
    kind : str
        What it is.
    zone, surface, sensor, vent, control : int or None
        Position of the zone, surface, sensor, vent or control in the description.
    side : int or None
        0 for the outside, 1 for the inside.
    layer : int or None
        Position of the layer, counted from outside.
    interface : int or None
        Number of layers outside the interface, at least 1.
    aliases : tuple of str
        Other names.

    Examples
    --------
    >>> from mascarin import examples
    >>> import mascarin as mc
    >>> mc.load(examples.FOLDER / "lgi" / "building.yaml").output("room.air_temperature").unit
    'degC'
    """

    name: str
    unit: str
    kind: Kind
    zone: int | None = None
    surface: int | None = None
    side: int | None = None
    layer: int | None = None
    interface: int | None = None
    sensor: int | None = None
    vent: int | None = None
    control: int | None = None
    aliases: tuple[str, ...] = ()

    @property
    def mean(self) -> bool:
        """Whether a record is the mean over the interval before it, and not a state at its time."""
        return _BY_KIND.get(self.kind, self.unit in _MEANS)

    @property
    def place(self) -> dict[str, int]:
        """Positions that are set for this kind, by name."""
        keys = ("zone", "surface", "side", "layer", "interface", "sensor", "vent", "control")
        return {key: value for key in keys if (value := getattr(self, key)) is not None}


def outputs(building: Description) -> list[Output]:
    """All results of a building: zones, surfaces, sensors, in the order of the description."""
    return list(worked_out(building, "_outputs", lambda: _found(building)))


def _found(building: Description) -> list[Output]:
    found = [
        Output(f"{name}.{kind}", "degC", kind, zone=index)
        for index, name in enumerate(building.zones)
        for kind in _ZONE_KINDS
    ]
    for index, (name, zone) in enumerate(building.zones.items()):
        for which in zone.loads:
            kind: Kind = "heating_load" if which == "heating" else "cooling_load"
            found.append(Output(f"{name}.{kind}", "W", kind, zone=index))
        if zone.loads:
            found.append(Output(f"{name}.net_load", "W", "net_load", zone=index))
        found.append(Output(f"{name}.air_changes", "1/h", "air_changes", zone=index))
        found += _of_humidity(building, index, name)
    lit = _lit_zones(building)
    for index, name in enumerate(building.surfaces):
        found += _of_surface(building, index, name)
        if building.surfaces[name].outside.outdoors:
            found.append(Output(f"{name}.incident_solar", "W/m2", "incident_solar", surface=index))
        found += _of_sides(building, index, name, lit)
        found += _of_damp_sides(building, index, name, name)
    found += _of_windows(building)
    found += _of_vents(building)
    found.append(Output("sky_temperature", "degC", "sky_temperature"))
    for index, name in enumerate(building.sensors):
        found.append(Output(f"{name}.temperature", "degC", "sensor", sensor=index))
    return found


def _of_vents(building: Description) -> Iterator[Output]:
    """Flows through the openings of the pressure network, how far they are open, and the controls."""
    for index, name in enumerate(building.vents):
        yield Output(f"{name}.inflow", "m3/s", "vent_inflow", vent=index)
        yield Output(f"{name}.outflow", "m3/s", "vent_outflow", vent=index)
        yield Output(f"{name}.open", "-", "vent_open", vent=index)
    for index, name in enumerate(building.controls):
        yield Output(f"{name}.open", "-", "control_open", control=index)


def _of_humidity(building: Description, index: int, name: str) -> Iterator[Output]:
    """Humidity of a zone and the latent loads of its ideal plants."""
    if building.humidity is None:
        return
    for kind, unit in _HUMIDITIES.items():
        yield Output(f"{name}.{kind}", unit, kind, zone=index)
    zone = building.humidity.zones.get(name)
    if zone is not None and zone.drying is not None:
        yield Output(f"{name}.latent_cooling_load", "W", "latent_cooling", zone=index)
    if zone is not None and zone.humidifying is not None:
        yield Output(f"{name}.latent_heating_load", "W", "latent_heating", zone=index)


def _of_damp_sides(building: Description, index: int, name: str, surface: str) -> Iterator[Output]:
    """Humidity at the sides of a surface, or of a window in it, that face zones."""
    if building.humidity is None:
        return
    for number, (word, side) in enumerate(zip(_SIDES, building.surfaces[surface].sides, strict=True)):
        if side.zone is not None:
            make = partial(Output, surface=index, side=number)
            yield make(f"{name}.{word}_relative_humidity", "-", "surface_humidity")
            yield make(f"{name}.{word}_condensation", "-", "condensation")


def _lit_zones(building: Description) -> set[str | None]:
    """Zones that the sun enters through windows."""
    walls = [building.surfaces[window.surface] for window in building.windows.values()]
    return {side.zone for wall in walls for side in wall.sides} - {None}


def _of_windows(building: Description) -> Iterator[Output]:
    first = len(building.surfaces)
    for index, name in enumerate(building.windows, start=first):
        for side, word in enumerate(_SIDES):
            yield Output(f"{name}.{word}_temperature", "degC", "face_temperature", surface=index, side=side)
        window = building.windows[name]
        wall = building.surfaces[window.surface]
        if wall.outside.outdoors:
            yield Output(f"{name}.incident_solar", "W/m2", "incident_solar", surface=index)
        yield Output(f"{name}.transmitted_solar", "W", "transmitted_solar", surface=index)
        if wall.outside.outdoors:
            yield Output(f"{name}.solar_transmittance", "-", "solar_transmittance", surface=index)
        yield Output(f"{name}.absorbed_solar", "W/m2", "absorbed_solar", surface=index, side=0)
        outside = window.outside if wall.outside.outdoors else wall.outside
        exchanged = (_radiates(building, outside), _radiates(building, wall.inside))
        for side, word in enumerate(_SIDES):
            if exchanged[side]:
                yield Output(f"{name}.{word}_longwave", "W/m2", "net_longwave", surface=index, side=side)
            yield Output(f"{name}.{word}_convection", "W/(m2 K)", "convection", surface=index, side=side)
        yield from _of_damp_sides(building, index, name, window.surface)
    lit = _lit_zones(building)
    for index, name in enumerate(building.zones):
        if name in lit:
            yield Output(f"{name}.transmitted_solar", "W", "zone_transmitted_solar", zone=index)
            yield Output(f"{name}.lost_solar", "W", "zone_lost_solar", zone=index)


def named(building: Description, names: Iterable[str]) -> list[Output]:
    """Results by their names or other names of them; see `Building.output`."""
    known: dict[str, Output] = {}
    for output in reversed(outputs(building)):
        known.update(dict.fromkeys((*output.aliases, output.name), output))
    return [_known(known, name, damp=building.humidity is not None) for name in names]


def _known(known: Mapping[str, Output], name: str, *, damp: bool) -> Output:
    if name not in known:
        if not damp and str(name).partition(".")[2] in _DAMP:
            raise InputError(
                f"{name}: found a building without 'humidity:', expected one with it. Add 'humidity: {{}}' "
                "to the building: the air of its zones then has a vapour balance"
            )
        owner, _, what = str(name).partition(".")
        own = [one for one in known if one.partition(".")[0] == owner]
        near = [one for one in own if what and what in one.partition(".")[2]]
        hint = did_you_mean(name, known) or (f"'{owner}' has {', '.join(near or own[:8])}." if own else "")
        raise InputError(
            f"{name}: found no such output; expected one of the {len(known)} of this building, which "
            "'mascarin "
            f"outputs' lists. {hint}".rstrip()
        )
    return known[name]


def _of_sides(building: Description, index: int, name: str, lit: Set[str | None]) -> Iterator[Output]:
    """Solar and long-wave radiation and convection at the two sides of a surface; zones with windows."""
    for number, (word, side) in enumerate(zip(_SIDES, building.surfaces[name].sides, strict=True)):
        make = partial(Output, surface=index, side=number)
        if side.sunlit or side.irradiance is not None or (side.zone is not None and side.zone in lit):
            yield make(f"{name}.{word}_absorbed_solar", "W/m2", "absorbed_solar")
        if _radiates(building, side):
            yield make(f"{name}.{word}_longwave", "W/m2", "net_longwave")
        if side.convection is not None and (side.outdoors or side.zone is not None):
            yield make(f"{name}.{word}_convection", "W/(m2 K)", "convection")


def _radiates(building: Description, side: Side | WindowOutside) -> bool:
    """Whether long-wave radiation is exchanged beside the convection."""
    if isinstance(side, Side) and side.zone is not None:
        return building.zones[side.zone].longwave.kind != "none"
    return bool(side.outdoors) and (side.longwave is None or side.longwave.kind != "none")


def _of_surface(building: Description, index: int, name: str) -> Iterator[Output]:
    layers = building.constructions[building.surfaces[name].construction].layers
    for side, word in enumerate(_SIDES):
        yield Output(f"{name}.{word}_temperature", "degC", "face_temperature", surface=index, side=side)
    for number, (outer, inner) in enumerate(pairwise(layers), start=1):
        yield Output(
            f"{name}.interface_{number}_temperature",
            "degC",
            "interface_temperature",
            surface=index,
            interface=number,
            aliases=(f"{name}.{outer.name}_{inner.name}_temperature",),
        )
    for side, word in enumerate(_SIDES):
        yield Output(f"{name}.{word}_flux", "W/m2", "face_flux", surface=index, side=side)
    for position, layer in enumerate(layers):
        kinds: list[tuple[str, str, Kind]] = [("flux", "W/m2", "layer_flux")]
        if isinstance(building.materials[layer.material], PhaseChangeMaterial):
            kinds += [
                ("temperature", "degC", "layer_temperature"),
                ("liquid_fraction", "-", "liquid_fraction"),
                ("enthalpy", "J/m3", "layer_enthalpy"),
            ]
        for word, unit, kind in kinds:
            yield Output(f"{name}.{layer.name}_{word}", unit, kind, surface=index, layer=position)
