"""Random and extreme weather with the measured columns that random buildings name, by a seed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from mascarin._io.durations import seconds_of
from mascarin.weather import Climate, Measurements
from mascarin.weather.records.channels import UNITS
from random_draw import Draw
from random_schedules import COLUMNS

Array = npt.NDArray[np.float64]

#: Solar constant [W/m2] (Kopp & Lean 2011, doi:10.1029/2010GL045777).
SOLAR_CONSTANT = 1361.0
SIGMA = 5.670374419e-8

#: By kind of weather: latitude [deg], altitude [m], mean of the air [degC], its swing over a day [K],
#: dew-point depression [K], wind [m/s], cloud cover [tenths]; each from a lowest to a highest value.
KINDS: dict[str, tuple[tuple[float, float], ...]] = {
    "temperate": ((35, 60), (0, 800), (-5, 22), (2, 9), (1, 9), (0, 8), (0, 10)),
    "polar night": ((72, 89), (0, 2500), (-60, -25), (0, 5), (0, 8), (0, 25), (0, 10)),
    "polar day": ((70, 89), (0, 500), (-10, 10), (0, 5), (0, 8), (0, 15), (0, 10)),
    "desert": ((12, 33), (0, 900), (24, 38), (8, 16), (12, 45), (0, 10), (0, 2)),
    "cyclone": ((8, 24), (0, 200), (23, 30), (0, 2), (0, 0.4), (20, 80), (9, 10)),
    "high": ((-20, 36), (3500, 4500), (-8, 12), (6, 14), (5, 25), (0, 18), (0, 6)),
    "constant": ((30, 60), (0, 500), (-20, 40), (0, 0), (0, 20), (0, 12), (0, 10)),
    "jumps": ((30, 60), (0, 500), (-5, 20), (0, 6), (0, 12), (0, 20), (0, 10)),
    "south": ((-55, -18), (0, 1500), (0, 28), (2, 9), (1, 9), (0, 12), (0, 10)),
    "shifted": ((30, 55), (0, 500), (0, 25), (2, 9), (1, 9), (0, 8), (0, 4)),
}
ZONES = (
    "UTC",
    "UTC+4",
    "UTC-07:30",
    "Europe/Paris",
    "America/Denver",
    "Australia/Lord_Howe",
    "Asia/Kathmandu",
)
STEPS = ("1min", "2min", "5min", "10min", "15min", "15min", "30min", "1h", "1h", "2h", "3h")


@dataclass
class Weather:
    """The weather of a case, and the options of its run."""

    kind: str
    place: dict[str, Any]
    frame: pd.DataFrame
    measured: pd.DataFrame
    infrared: bool
    only_global: bool
    options: dict[str, Any] = field(default_factory=dict)
    #: Extraterrestrial irradiance normal to the beam [W/m2].
    extraterrestrial: float = SOLAR_CONSTANT

    def climate(self) -> Climate:
        """The climate; radiation need not follow the sun."""
        names = [str(name) for name in self.frame]
        absent = [name for name in ("global_horizontal",) if self.only_global and name not in names]
        return Climate.from_table(
            self.frame,
            timezone=str(self.place["timezone"]),
            columns={name: _stated(name) for name in names},
            absent=absent,
            altitude=float(self.place["altitude"]),
            check_sun=False,
        )

    def measurements(self) -> Measurements:
        """The measured columns."""
        return Measurements.from_table(self.measured, timezone=str(self.place["timezone"]))


def weather(seed: int) -> Weather:
    """Weather and options of a run by the seed of the case."""
    draw = Draw(f"weather {seed}")
    kind = draw.one(sorted(KINDS))
    latitudes, altitudes, *air = KINDS[kind]
    latitude = draw.number(*latitudes) * (draw.of(1, -1) if kind.startswith("polar") else 1)
    place = {
        "latitude": latitude,
        "longitude": draw.number(-180.0, 180.0),
        "altitude": draw.number(*altitudes),
        "timezone": draw.one(ZONES),
    }
    options, seconds = _options(draw)
    spacing = draw.of(600, 1800, 3600, 3600, 10800)
    start = _start(draw, kind, latitude)
    rows = math.ceil(seconds / spacing) + 3
    index = pd.date_range(start, periods=rows, freq=f"{spacing}s", tz="UTC")
    begin = start + pd.Timedelta(seconds=draw.of(0, spacing))
    options |= {
        "start": f"{begin.isoformat()}+00:00",
        "end": f"{(begin + pd.Timedelta(seconds=seconds)).isoformat()}+00:00",
    }
    frame, normal = _channels(draw, kind, place, index, air)
    infrared, only_global = "infrared" in frame, "direct_normal" not in frame
    measured = _columns(draw, frame, index)
    return Weather(kind, place, frame, measured, infrared, only_global, options, normal)


def _options(draw: Draw) -> tuple[dict[str, Any], float]:
    """Step, scheme and start of a run, and its length [s]."""
    step = draw.one(STEPS)
    seconds = seconds_of(step)
    count = draw.whole(20, 70) if seconds > 200.0 else draw.whole(60, 140)
    initial: Any = draw.of(draw.number(-30.0, 5.0), draw.number(5.0, 28.0), draw.number(28.0, 60.0))
    if draw.chance(0.1):
        initial = {"zones": {"z0": draw.number(-20.0, 50.0)}, "default": draw.number(0.0, 30.0)}
    options: dict[str, Any] = {"step": step, "initial": initial}
    if draw.chance(0.35 if seconds > 500.0 else 0.1):
        # A period that is much shorter than a day has no state that repeats in a heavy building.
        options |= {"initial": "repeat", "first_period": "1d" if seconds > 500.0 else "6h"}
        count = max(count, int(seconds_of(options["first_period"]) / seconds))
    usual = ["sdirk2"] * 3 + ["linearly-implicit", "backward-euler"] * 2
    options["scheme"] = draw.one([*usual, "apparent-capacity"])
    return options, seconds * count


def _start(draw: Draw, kind: str, latitude: float) -> pd.Timestamp:
    """Start of the weather: winter for a polar night, summer for a polar day, any day else."""
    year = draw.of(2001, 2019, 2024)
    north_winter = kind == "polar night"
    if kind in ("polar night", "polar day"):
        winter = north_winter == (latitude > 0.0)
        day = draw.whole(330, 380) if winter else draw.whole(150, 200)
    else:
        day = draw.of(draw.whole(0, 364), draw.whole(0, 364), 59, 88, 300, 364)
    return pd.Timestamp(f"{year}-01-01") + pd.Timedelta(days=day, hours=draw.whole(0, 23))


def _height(index: pd.DatetimeIndex, place: dict[str, Any], minutes: float) -> Array:
    """Sine of the height of the sun (Cooper 1969; equation of time neglected: a few minutes)."""
    day = index.day_of_year.to_numpy() + index.hour.to_numpy() / 24.0
    tilt = np.radians(23.45) * np.sin(2.0 * np.pi * (284.0 + day) / 365.0)
    hour = (
        index.hour.to_numpy() + (index.minute.to_numpy() + minutes) / 60.0 + float(place["longitude"]) / 15.0
    )
    angle = np.pi * (hour - 12.0) / 12.0
    phi = math.radians(float(place["latitude"]))
    return np.asarray(math.sin(phi) * np.sin(tilt) + math.cos(phi) * np.cos(tilt) * np.cos(angle))


def _channels(
    draw: Draw, kind: str, place: dict[str, Any], index: pd.DatetimeIndex, air: list[tuple[float, float]]
) -> tuple[pd.DataFrame, float]:
    """Channels of the climate, and the extraterrestrial irradiance [W/m2]."""
    mean, swing, depression, wind, cloud = (draw.number(*span) for span in air)
    hours = np.arange(len(index)) * (index[1] - index[0]).total_seconds() / 3600.0
    local = 2.0 * np.pi * (hours + index[0].hour + float(place["longitude"]) / 15.0 - 9.0) / 24.0
    steady = kind == "constant"
    wave = np.zeros(len(index)) if steady else np.sin(0.37 * hours) * np.cos(0.11 * hours + 1.0)
    warm = mean + swing * np.sin(local) + (0.0 if steady else 2.0) * wave
    jump = np.zeros(len(index))
    if kind == "jumps":
        for _ in range(draw.whole(1, 3)):
            jump[draw.whole(1, len(index) - 1) :] += draw.of(-30.0, 30.0)
    warm = np.clip(warm + np.clip(jump, -40.0, 40.0), -88.0, 60.0)
    dew = np.clip(warm - np.maximum(depression * (1.0 + 0.5 * wave), 0.0), -99.0, 44.0)
    covered = np.clip(cloud + (0.0 if steady else 2.0) * wave, 0.0, 10.0)
    # A drop of the wind to nothing in some cases, gusts in others.
    speed = np.clip(
        wind * (1.0 + 0.8 * wave) * (1.0 if steady or not draw.chance(0.2) else wave > 0.0), 0.0, 105.0
    )
    frame = pd.DataFrame(
        {
            "air_temperature": warm,
            "dew_point": dew,
            "cloud_cover": covered,
            "wind_speed": speed,
            "wind_direction": np.full(len(index), 225.0) if steady else (40.0 + 37.0 * hours) % 360.0,
        },
        index=index,
    )
    normal = SOLAR_CONSTANT * (1.0 + 0.033 * math.cos(2.0 * math.pi * index[0].day_of_year / 365.0))
    direct, diffuse, total = _radiation(draw, kind, place, index, covered, normal)
    if draw.chance(0.25):
        frame["global_horizontal"] = total
    else:
        frame["direct_normal"], frame["diffuse_horizontal"] = direct, diffuse
        if draw.chance(0.5):
            frame["global_horizontal"] = total
    if draw.chance(0.5):
        clear = 0.711 + 0.0056 * dew + 0.73e-4 * dew**2
        sky = np.clip(clear + (1.0 - clear) * 0.8 * covered / 10.0, 0.4, 1.0)
        frame["infrared"] = np.clip(sky * SIGMA * (warm + 273.15) ** 4, 25.0, 790.0)
    if draw.chance(0.5):
        low = 8000.0 if kind == "cyclone" else 1500.0
        level = 101_325.0 * (1.0 - 2.25577e-5 * float(place["altitude"])) ** 5.25588
        frame["pressure"] = level - (0.0 if steady else low * (0.5 + 0.5 * wave))
    return frame, normal


def _radiation(
    draw: Draw, kind: str, place: dict[str, Any], index: pd.DatetimeIndex, covered: Array, normal: float
) -> tuple[Array, Array, Array]:
    """Beam, diffuse and global irradiance as means of the intervals; with shifted clocks by up to 90 min."""
    shift = draw.of(50.0, -50.0, draw.number(-90.0, 90.0)) if kind == "shifted" else 0.0
    spacing = (index[1] - index[0]).total_seconds() / 60.0
    if kind == "constant":
        level = draw.of(0.0, draw.number(0.0, 300.0))
        return np.zeros(len(index)), np.full(len(index), level), np.full(len(index), level)
    parts = []
    for part in (0.125, 0.375, 0.625, 0.875):
        up = np.maximum(_height(index, place, part * spacing + shift), 0.0)
        degrees = np.degrees(np.arcsin(up))
        mass = 1.0 / (up + 0.15 * (degrees + 3.885) ** -1.253)
        mass = mass * math.exp(-float(place["altitude"]) / 8400.0)
        beam = normal * 0.7 ** (mass**0.678) * (1.0 - covered / 10.0) ** 0.75 * (up > 0.0)
        scattered = (0.09 + 0.02 * covered) * normal * up
        parts.append((beam, scattered, beam * up + scattered))
    direct, diffuse, total = (np.mean([part[k] for part in parts], axis=0) for k in range(3))
    return np.asarray(direct), np.asarray(diffuse), np.asarray(total)


def _stated(channel: str) -> dict[str, str]:
    """A column of a channel with its unit: what is drawn is extreme, and no unit would be likely."""
    return {"column": channel, "unit": "%" if channel == "relative_humidity" else UNITS[channel]}


def _columns(draw: Draw, frame: pd.DataFrame, index: pd.DatetimeIndex) -> pd.DataFrame:
    """Every measured column, between the two values that `COLUMNS` gives it."""
    hours = np.arange(len(index)) * (index[1] - index[0]).total_seconds() / 3600.0
    light = frame["diffuse_horizontal"] if "diffuse_horizontal" in frame else 0.4 * frame["global_horizontal"]
    columns = {}
    for name, (low, high) in COLUMNS.items():
        wave = 0.5 + 0.5 * np.sin(draw.number(0.1, 3.0) * hours + draw.number(0.0, 6.0))
        way = draw.whole(0, 3)
        share = (
            wave if way < 2 else np.round(wave) if way == 2 else np.full(len(index), draw.number(0.0, 1.0))
        )
        if name.startswith("G_"):
            columns[name] = np.minimum(np.asarray(light) * (0.5 + 2.0 * share), high)
        elif name == "rain":
            columns[name] = np.where(share > 0.8, high * share, 0.0)
        else:
            columns[name] = low + (high - low) * share
    return pd.DataFrame(columns, index=index)
