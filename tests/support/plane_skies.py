"""Drawn records with a tilted plane beside the horizontal: shipped climates, Perez' sky, real instruments."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pandas as pd
import pvlib

from mascarin import Climate
from mascarin.tables.arrays import Array
from mascarin.tables.grid import Grid
from mascarin.weather import Place
from mascarin.weather.checks.plane_shift import MeasuredPlane
from mascarin.weather.records.channels import CHANNELS
from mascarin.weather.records.record import WeatherRecord

CLIMATES = ("tampa", "tucson", "golden", "san-francisco", "washington", "chicago")


@dataclass(frozen=True)
class Drawn:
    """A record of the global irradiance, planes beside it, and the place."""

    record: WeatherRecord
    planes: list[MeasuredPlane]
    site: Place


@cache
def _climate(name: str) -> Climate:
    return Climate.shipped(name)


def drawn(rng: np.random.Generator, late: float, *, azimuths: tuple[float, ...] = ()) -> Drawn:
    """A record whose stamps are late by some minutes.

    Azimuth and tilt are stated with errors of 3 and 1 deg, gains have errors of 5 %, an obstacle may hide
    the sun from a plane in the morning or the evening, and the ground reflects 0.1 to 0.4.
    """
    climate = _climate(str(rng.choice(CLIMATES)))
    assert climate.site is not None
    days, start = int(rng.choice([3, 6, 12, 25])), int(rng.integers(2, 330))
    step = float(rng.choice([60, 300, 600, 900, 1800, 3600]))
    fine = min(step, 300.0)
    days = min(days, 8) if fine < 300.0 else days
    first = pd.Timestamp("2001-01-01") + pd.Timedelta(days=start)
    channels = climate.forcing(climate.site, first, first + pd.Timedelta(days=days), fine).mean(axis=1)
    of = {name: channels[:, k] for k, name in enumerate(CHANNELS)}
    beam, diffuse = np.maximum(of["direct_normal"], 0.0), np.maximum(of["diffuse_horizontal"], 0.0)
    total = beam * np.clip(of["sun_up"], 0.0, 1.0) + diffuse
    per = round(step / fine)

    def measured(values: Array) -> Array:
        means = values[: len(values) // per * per].reshape(-1, per).mean(axis=1)
        noise = rng.uniform(0.95, 1.05) * (1.0 + rng.normal(0.0, 0.01, len(means)))
        return np.asarray(means * noise + rng.normal(0.0, 1.0, len(means)) * (means > 0.0))

    columns = {"global_horizontal": measured(total)}
    sides = azimuths or (float(rng.uniform(0.0, 360.0)),)
    planes = []
    for azimuth in sides:
        tilt = float(rng.choice([90, 90, 60, 30, 15])) if not azimuths else 90.0
        plane = _on_plane(rng, of, beam, diffuse, total, azimuth, tilt, fine)
        stated = azimuth + rng.normal(0.0, 3.0), float(np.clip(tilt + rng.normal(0.0, 1.0), 0.0, 180.0))
        planes.append(MeasuredPlane(f"G_{azimuth:.0f}", measured(plane), *stated))
    begin = first.tz_localize(climate.grid.zone).timestamp() + 60.0 * late
    count = len(columns["global_horizontal"])
    grid = Grid(begin, step, count, climate.grid.zone)
    record = WeatherRecord(
        columns=columns, kinds={"global_horizontal": "mean"}, grid=grid,
        closing={}, file="planes.csv", sha256=None, provenance=(), lines=np.arange(count),
    )  # fmt: skip
    return Drawn(record, planes, climate.site)


def _on_plane(
    rng: np.random.Generator, of: dict[str, Array], beam: Array, diffuse: Array, total: Array,
    azimuth: float, tilt: float, fine: float,
) -> Array:  # fmt: skip
    zenith = np.degrees(np.arccos(np.clip(of["sun_up"], -1.0, 1.0)))
    around = np.degrees(np.arctan2(of["sun_east"], of["sun_north"])) % 360.0
    with np.errstate(all="ignore"):
        mass = pvlib.atmosphere.get_relative_airmass(np.minimum(zenith, 89.5))
        sky = pvlib.irradiance.perez(
            tilt, azimuth, diffuse, beam, of["direct_normal_extra"], zenith, around, mass
        )
    turn, lean = np.radians(azimuth), np.radians(tilt)
    cosine = np.sin(lean) * (np.sin(turn) * of["sun_east"] + np.cos(turn) * of["sun_north"])
    direct = beam * np.maximum(cosine + np.cos(lean) * of["sun_up"], 0.0) * (of["sun_up"] > 0.0)
    hour, obstacle = (np.arange(len(beam)) * fine / 3600.0) % 24.0, rng.random()
    if obstacle < 0.35:
        direct = np.where(hour < rng.uniform(7.0, 11.0), 0.0, direct)
    elif obstacle < 0.45:
        direct = np.where(hour > rng.uniform(13.0, 17.0), 0.0, direct)
    ground = rng.uniform(0.1, 0.4) * total * 0.5 * (1.0 - np.cos(lean))
    return np.asarray(direct + np.nan_to_num(np.asarray(sky)) + ground)
