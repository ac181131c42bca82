"""Records of made skies with a clock that is late: clear, broken, foggy and overcast days."""

from __future__ import annotations

from datetime import UTC

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.grid import Grid
from mascarin.tables.record import Kind
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.records.record import WeatherRecord

NAMES = ("global_horizontal", "direct_normal", "diffuse_horizontal")
#: 2024-01-01 UTC. [s]
FIRST = 1704067200.0


def sky(
    rng: np.random.Generator, latitude: float, longitude: float, kind: str, *, step: float = 1800.0,
    days: int = 10, start: int = 60, late: float = 0.0, names: tuple[str, ...] = NAMES[:1],
) -> WeatherRecord:  # fmt: skip
    """Means over steps of instruments with errors of gain and noise; stamps are `late` [s]."""
    count, sub = int(days * 86400.0 / step), 12
    first = FIRST + 86400.0 * start - round(longitude / 15.0) * 3600.0
    time = first - late + step / sub * (np.arange(count * sub) + 0.5)
    sun = SunPath.over(latitude, longitude, time[0] - 7200.0, time[-1] + 7200.0)
    up = np.maximum(sun.vector(time)[:, 2], 0.0)
    hour = ((time + 240.0 * longitude) % 86400.0) / 3600.0
    day = np.floor((time + 240.0 * longitude) / 86400.0).astype(int)
    day -= day.min()
    of_day = rng.uniform(size=(3, day.max() + 1))[:, day]
    # Air mass by Kasten & Young 1989 (doi:10.1364/AO.28.004735).
    elevation = np.degrees(np.arcsin(up))
    mass = 1.0 / np.maximum(up + 0.50572 * (elevation + 6.07995) ** -1.6364, 0.02)
    beam = 1361.0 * np.exp(-(0.12 + 0.18 * of_day[0]) * 0.9 * mass) * (up > 0.0)
    diffuse = np.where(up > 0.0, (75.0 + 15.0 * of_day[1]) * np.sqrt(up) + 20.0 * up, 0.0)
    block = max(1, int(1800.0 / (step / sub)))
    parts = len(time) // block + 1
    of_block = np.repeat(rng.uniform(size=(2, parts)), block, axis=1)[:, : len(time)]
    if kind in ("broken", "mixed"):
        cover = np.where(of_day[2] < 0.5, 0.0, 0.7) if kind == "mixed" else 0.7
        beam = np.where(of_block[0] < cover, 0.6 * of_block[1], 1.0) * beam
        diffuse = np.where(of_block[0] < cover, 1.8, 1.0) * diffuse
    elif kind == "fog":
        left = 0.3 if rng.random() < 0.5 else np.clip(0.3 + 0.7 * (hour - 6.0) / 6.0, 0.3, 1.0)
        beam, diffuse = (
            np.where(hour < 12.0, left, 1.0) * beam,
            np.where(hour < 12.0, 1.3 * left, 1.0) * diffuse,
        )
    elif kind == "overcast":
        beam, diffuse = 0.0 * beam, 800.0 * up * (0.2 + 0.3 * of_block[0])
    values = {"global_horizontal": beam * up + diffuse, "direct_normal": beam, "diffuse_horizontal": diffuse}
    columns: dict[str, Array] = {}
    for name in names:
        means = values[name].reshape(count, sub).mean(axis=1)
        noise = rng.normal(1.0, 0.015) * (1.0 + rng.normal(0.0, 0.005, count))
        columns[name] = np.maximum(means * noise + rng.normal(0.0, 0.7, count) * (means > 0.0), 0.0)
    kinds: dict[str, Kind] = dict.fromkeys(names, "mean")
    return WeatherRecord(
        columns=columns, kinds=kinds, grid=Grid(first, step, count, UTC), closing={}, file="sky.csv",
        sha256=None, provenance=(), lines=np.arange(count),
    )  # fmt: skip
