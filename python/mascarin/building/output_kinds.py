"""What each kind of output is: the pattern of its name, its unit, its meaning, and where it exists."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mascarin.building.outputs import Kind, Output


class OutputKind(NamedTuple):
    """A kind of output.

    Attributes
    ----------
    pattern : str
        Its names; words in capitals stand for names of the description, N for a number.
    unit : str
        Its unit.
    meaning : str
        What it is.
    exists : str
        For what there is such an output.
    """

    pattern: str
    unit: str
    meaning: str
    exists: str


_ZONES: Final = "every zone"
_HUMID: Final = "every zone of a building with `humidity`"
_OUTDOORS: Final = "every surface and window that faces outdoors"
_SIDES: Final = "SURFACE.outside_{0}, SURFACE.inside_{0}, WINDOW.outside_{0}, WINDOW.inside_{0}"

KINDS: Final[Mapping[Kind, OutputKind]] = {
    "air_temperature": OutputKind("ZONE.air_temperature", "degC", "Temperature of the air", _ZONES),
    "mean_radiant_temperature": OutputKind(
        "ZONE.mean_radiant_temperature",
        "degC",
        "Mean of the surface temperatures of the zone, weighted by area; without view factors to a point and "
        "without emissivities",
        _ZONES,
    ),
    "operative_temperature": OutputKind(
        "ZONE.operative_temperature", "degC", "Mean of the air and the mean radiant temperature", _ZONES
    ),
    "globe_temperature": OutputKind(
        "ZONE.globe_temperature",
        "degC",
        "Temperature of a black globe of 0.15 m between the air and the mean radiant temperature",
        _ZONES,
    ),
    "heating_load": OutputKind(
        "ZONE.heating_load",
        "W",
        "Heat that ideal heating supplies to the air, not below 0",
        "zones with `heating`",
    ),
    "cooling_load": OutputKind(
        "ZONE.cooling_load",
        "W",
        "Heat that ideal cooling takes from the air, not below 0",
        "zones with `cooling`",
    ),
    "net_load": OutputKind(
        "ZONE.net_load",
        "W",
        "Heat that ideal heating brings less what ideal cooling takes",
        "zones with `heating` or `cooling`",
    ),
    "humidity_ratio": OutputKind(
        "ZONE.humidity_ratio", "kg/kg", "Vapour in the air of the zone by mass of dry air", _HUMID
    ),
    "relative_humidity": OutputKind(
        "ZONE.relative_humidity", "-", "Vapour pressure over that of saturated air, over water", _HUMID
    ),
    "dew_point": OutputKind(
        "ZONE.dew_point", "degC", "Temperature at which the air is saturated over water", _HUMID
    ),
    "wet_bulb": OutputKind("ZONE.wet_bulb", "degC", "Temperature of adiabatic saturation of the air", _HUMID),
    "latent_heating": OutputKind(
        "ZONE.latent_heating_load",
        "W",
        "Heat of evaporation of the vapour that humidifying brings",
        "zones with `humidifying` in `humidity`",
    ),
    "latent_cooling": OutputKind(
        "ZONE.latent_cooling_load",
        "W",
        "Heat of condensation of the vapour that drying or the cooling coil takes",
        "zones with `drying` in `humidity`",
    ),
    "surface_humidity": OutputKind(
        _SIDES.format("relative_humidity"),
        "-",
        "Relative humidity of the air of the zone at the temperature of the surface",
        "surfaces in zones of a building with `humidity`",
    ),
    "condensation": OutputKind(
        _SIDES.format("condensation"),
        "-",
        "1 where dew, or below 0.01 degC frost, forms on the surface, else 0",
        "surfaces in zones of a building with `humidity`",
    ),
    "air_changes": OutputKind(
        "ZONE.air_changes",
        "1/h",
        "Outdoor air over the volume of the zone: infiltration, ventilation, openings and ventilation units",
        _ZONES,
    ),
    "zone_transmitted_solar": OutputKind(
        "ZONE.transmitted_solar",
        "W",
        "Solar radiation that enters through all windows of the zone",
        "zones with windows",
    ),
    "zone_lost_solar": OutputKind(
        "ZONE.lost_solar",
        "W",
        "Solar radiation that leaves the zone again through its windows",
        "zones with windows",
    ),
    "face_temperature": OutputKind(
        _SIDES.format("temperature"),
        "degC",
        "Temperature of the surface",
        "both sides of every surface and window",
    ),
    "interface_temperature": OutputKind(
        "SURFACE.interface_N_temperature, or SURFACE.LAYER_LAYER_temperature",
        "degC",
        "Temperature between two layers, counted from outside",
        "surfaces of two or more layers",
    ),
    "face_flux": OutputKind(
        "SURFACE.outside_flux, SURFACE.inside_flux",
        "W/m2",
        "Conduction in the wall at its surface, positive towards the inside",
        "every surface",
    ),
    "layer_flux": OutputKind(
        "SURFACE.LAYER_flux",
        "W/m2",
        "Conduction through the middle of a layer, positive towards the inside",
        "every layer",
    ),
    "layer_temperature": OutputKind(
        "SURFACE.LAYER_temperature", "degC", "Mean temperature of a layer", "layers of phase-change materials"
    ),
    "liquid_fraction": OutputKind(
        "SURFACE.LAYER_liquid_fraction", "-", "Melted part of a layer", "layers of phase-change materials"
    ),
    "layer_enthalpy": OutputKind(
        "SURFACE.LAYER_enthalpy",
        "J/m3",
        "Mean enthalpy of a layer per volume of the solid, zero for the solid at the melting temperature",
        "layers of phase-change materials",
    ),
    "sensor": OutputKind(
        "SENSOR.temperature", "degC", "Temperature at a depth of a wall", "every entry of `sensors`"
    ),
    "incident_solar": OutputKind(
        "SURFACE.incident_solar, WINDOW.incident_solar",
        "W/m2",
        "Solar radiation on the surface, after shading",
        _OUTDOORS,
    ),
    "transmitted_solar": OutputKind(
        "WINDOW.transmitted_solar",
        "W",
        "Solar radiation that the window transmits; between two zones less what it transmits the other way",
        "every window",
    ),
    "solar_transmittance": OutputKind(
        "WINDOW.solar_transmittance",
        "-",
        "Transmitted over incident solar radiation on the glass; 0 without sun",
        "windows that face outdoors",
    ),
    "absorbed_solar": OutputKind(
        "SURFACE.outside_absorbed_solar, SURFACE.inside_absorbed_solar, WINDOW.absorbed_solar",
        "W/m2",
        "Solar radiation that the side of a surface, or all panes of a window, absorb",
        "sides in the sun, surfaces of zones with windows, windows",
    ),
    "net_longwave": OutputKind(
        _SIDES.format("longwave"),
        "W/m2",
        "Long-wave radiation that the side gains from its surroundings",
        "sides with long-wave exchange of their own",
    ),
    "convection": OutputKind(
        _SIDES.format("convection"),
        "W/(m2 K)",
        "Convective heat transfer coefficient",
        "sides that face air outdoors or of a zone",
    ),
    "vent_inflow": OutputKind(
        "VENT.inflow",
        "m3/s",
        "Air that flows into the zone of the vent, or from the second zone to the first, at the density of "
        "the site",
        "every vent",
    ),
    "vent_outflow": OutputKind(
        "VENT.outflow",
        "m3/s",
        "Air that flows out of the zone of the vent, or from the first zone to the second, at the density of "
        "the site",
        "every vent",
    ),
    "vent_open": OutputKind(
        "VENT.open", "-", "Fraction of the area of the vent that its schedule and control open", "every vent"
    ),
    "control_open": OutputKind(
        "CONTROL.open",
        "-",
        "1 where the control lets openings open, else 0, during the step",
        "every control",
    ),
    "sky_temperature": OutputKind(
        "sky_temperature",
        "degC",
        "Temperature of a black sky with the same long-wave emission",
        "every building",
    ),
}
"""Every kind of output, zones first."""


def meaning(output: Output) -> str:
    """What an output is, in one sentence.

    Parameters
    ----------
    output : Output
        The output.
    """
    return KINDS[output.kind].meaning
