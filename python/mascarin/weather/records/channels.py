"""The channels of a climate: names, units, kinds and hard limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from mascarin.tables.record import Kind

Basis = Literal["direct+diffuse", "global+diffuse", "all"]
"""Irradiances whose means are kept. With `all`, the global one is kept as far as the beam allows."""


@dataclass(frozen=True)
class Channel:
    """One quantity of a climate.

    Attributes
    ----------
    name : str
        Name, the same as in the engine.
    unit : str
        Unit in which the engine takes it.
    kind : str
        How weather files give it, unless the user states otherwise.
    low, high : float
        Values outside of these are wrong anywhere outdoors. [unit]
    description : str
        What it is.
    """

    name: str
    unit: str
    kind: Kind
    low: float
    high: float
    description: str


_TABLE: Final = (
    Channel("air_temperature", "degC", "instant", -90.0, 80.0, "dry-bulb temperature of the air"),
    Channel("dew_point", "degC", "instant", -115.0, 65.0, "dew-point temperature"),
    Channel("cloud_cover", "tenths", "instant", 0.0, 10.0, "part of the sky covered by cloud"),
    Channel("infrared", "W/m2", "mean", 20.0, 800.0, "long-wave radiation from the sky on the horizontal"),
    Channel("wind_speed", "m/s", "instant", 0.0, 110.0, "wind speed at the mast"),
    Channel(
        "wind_direction", "deg", "instant", 0.0, 360.0, "where the wind blows from, clockwise from north"
    ),
    Channel("pressure", "Pa", "instant", 30000.0, 115000.0, "atmospheric pressure at the station's height"),
    Channel("direct_normal", "W/m2", "mean", -20.0, 1500.0, "beam irradiance on a plane facing the sun"),
    Channel("diffuse_horizontal", "W/m2", "mean", -20.0, 1200.0, "sky irradiance on the horizontal"),
    Channel("global_horizontal", "W/m2", "mean", -20.0, 2000.0, "beam and sky irradiance on the horizontal"),
    Channel("direct_normal_extra", "W/m2", "instant", 1300.0, 1420.0, "extraterrestrial normal irradiance"),
    Channel("sun_east", "-", "instant", -1.0, 1.0, "unit vector to the sun, east"),
    Channel("sun_north", "-", "instant", -1.0, 1.0, "unit vector to the sun, north"),
    Channel("sun_up", "-", "instant", -1.0, 1.0, "unit vector to the sun, up"),
    Channel("day_of_year", "d", "instant", 0.0, 367.0, "time since 1 January 00:00, local"),
)

_POSITION: Final = (
    Channel("sun_elevation", "deg", "instant", -90.0, 90.0, "angle of the sun above the level horizon"),
    Channel("sun_azimuth", "deg", "instant", 0.0, 360.0, "where the sun stands, clockwise from north"),
)

CHANNELS: Final[tuple[str, ...]] = tuple(channel.name for channel in _TABLE)
"""Names of the climate channels in the order of the forcing's last axis."""

BY_NAME: Final[dict[str, Channel]] = {channel.name: channel for channel in (*_TABLE, *_POSITION)}
"""The channels by name, and the columns of a stated position of the sun."""

LIMITS: Final[dict[str, tuple[float, float]]] = {
    name: (channel.low, channel.high) for name, channel in BY_NAME.items()
}
"""Lowest and highest possible value of each channel. [unit of the channel]"""

UNITS: Final[dict[str, str]] = {name: channel.unit for name, channel in BY_NAME.items()}
"""Unit of each channel."""

SOURCE_CHANNELS: Final[tuple[str, ...]] = CHANNELS[:10]
"""Channels that come from a weather file; the others follow from place and time."""

SUN_POSITION: Final[tuple[str, ...]] = tuple(channel.name for channel in _POSITION)
"""Columns of a table that state the position of the sun; the engine takes it as a vector."""

RADIATION: Final[tuple[str, ...]] = ("direct_normal", "diffuse_horizontal", "global_horizontal")
"""The three short-wave channels."""

TEMPERATURES: Final = (-90.0, 150.0)
"""Limits of a measured temperature of a boundary. [degC]"""

IRRADIANCES: Final = (-50.0, 2000.0)
"""Limits of a measured irradiance on a plane. [W/m2]"""

COEFFICIENTS: Final = (0.0, 2000.0)
"""Limits of a measured heat transfer coefficient. [W/(m2 K)]"""
