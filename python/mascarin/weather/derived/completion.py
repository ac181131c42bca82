"""Derive the irradiances and the cloud cover that were not measured, from those that were and the sun."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.grid import Grid
from mascarin.tables.profile import node_times, pieces_for, trapezoid_weights
from mascarin.tables.record import Kind
from mascarin.weather.derived import derive
from mascarin.weather.derived.radiation import clear_beam, direct_by_closure
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.derived.sun_position import Sun, states_position, sun_over
from mascarin.weather.records.channels import RADIATION, Basis
from mascarin.weather.records.record import WeatherRecord


def complete(record: WeatherRecord, latitude: float, longitude: float) -> WeatherRecord:
    """Derive the missing irradiances and the cloud cover; see `Climate.completed`.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    WeatherRecord
        With all irradiances and cloud cover; the provenance states how they were derived.
    """
    missing = [name for name in (*RADIATION, "cloud_cover") if name not in record.columns]
    if not missing:
        return record
    grid = record.grid
    kind: Kind = next((record.kinds[name] for name in RADIATION if name in record.kinds), "mean")
    up, extra, clear = _sun_means(record, latitude, longitude, kind)
    columns = dict(record.columns)
    notes: list[str] = []
    basis = _fill_radiation(columns, up, extra, clear, record.file, notes)
    if "cloud_cover" not in columns:
        total = columns["global_horizontal"]
        columns["cloud_cover"] = (
            derive.cloud_cover(total, up, grid.interval) if total.any() else np.zeros(grid.count)
        )
        notes.append(
            f"{record.file}: cloud cover estimated from global irradiance (Kimball 1928 with Haurwitz's "
            "clear sky, G/G_clear = 1 - 0.71 N), interpolated through the night."
            if total.any()
            else f"{record.file}: cloud cover was not measured and cannot be estimated; clear sky assumed."
        )
    kinds: dict[str, Kind] = dict(record.kinds)
    kinds.update(dict.fromkeys(RADIATION, kind))
    kinds.setdefault("cloud_cover", "instant")
    closing = dict(record.closing)
    for name in missing:
        if kinds[name] == "instant":
            closing.setdefault(name, float(columns[name][-1]))
    return replace(
        record, columns=columns, kinds=kinds, closing=closing,
        provenance=(*record.provenance, *notes), basis=basis,
    )  # fmt: skip


def extraterrestrial_horizontal(
    record: WeatherRecord, latitude: float, longitude: float, kind: Kind
) -> Array:
    """Extraterrestrial irradiance on the horizontal.

    Parameters
    ----------
    record : WeatherRecord
        Whose rows are meant.
    latitude, longitude : float
        Positive north and east. [deg]
    kind : str
        `mean` over each interval, or `instant`, at its start.

    Returns
    -------
    ndarray, shape (rows,)
        One for each row. [W/m2]
    """
    up, extra, _ = _sun_means(record, latitude, longitude, kind)
    return np.asarray(up * extra)


def _sun_means(
    record: WeatherRecord, latitude: float, longitude: float, kind: str
) -> tuple[Array, Array, Array]:
    """Mean sine of elevation, extraterrestrial and clear beam of each interval, or at its start."""
    grid = record.grid
    if not states_position(record):
        return _means_at_place(latitude, longitude, grid, kind)
    return _means_of(sun_over(record, latitude, longitude, (grid.start, grid.end)), grid, kind)


@lru_cache(maxsize=2)  # runs that differ in the gain of an irradiance have the same sun
def _means_at_place(latitude: float, longitude: float, grid: Grid, kind: str) -> tuple[Array, Array, Array]:
    return _means_of(SunPath.over(latitude, longitude, grid.start, grid.end), grid, kind)


def _means_of(sun: Sun, grid: Grid, kind: str) -> tuple[Array, Array, Array]:
    starts = grid.start + grid.interval * np.arange(grid.count)
    if kind == "instant":
        up = np.maximum(sun.vector(starts)[:, 2], 0.0)
        extra = sun.normal_irradiance(starts)
        return up, extra, extra * clear_beam(up)
    pieces = pieces_for(grid.interval)
    weights = trapezoid_weights(pieces)
    up = np.maximum(sun.vector(node_times(grid.start, grid.interval, grid.count, pieces))[..., 2], 0.0)
    extra = sun.normal_irradiance(starts + 0.5 * grid.interval)
    return up @ weights, extra, extra * (clear_beam(up) @ weights)


def _fill_radiation(
    columns: dict[str, Array], up: Array, extra: Array, clear: Array, where: str, notes: list[str]
) -> Basis:
    names = {name for name in RADIATION if name in columns}
    if "global_horizontal" not in names:
        columns["global_horizontal"] = columns["direct_normal"] * up + columns["diffuse_horizontal"]
        notes.append(f"{where}: global irradiance from direct and diffuse.")
        return "direct+diffuse"
    total = columns["global_horizontal"]
    if "diffuse_horizontal" not in names and "direct_normal" in names:
        columns["diffuse_horizontal"] = np.maximum(total - columns["direct_normal"] * up, 0.0)
        notes.append(f"{where}: diffuse irradiance from global and direct, not below zero.")
        return "direct+diffuse"
    if "diffuse_horizontal" not in names:
        columns["diffuse_horizontal"] = derive.diffuse_erbs(total, up, extra)
        if total.any():
            notes.append(
                f"{where}: diffuse irradiance estimated from global (Erbs et al. 1982, made for hours)."
            )
    if "direct_normal" in names:
        return "all" if len(names) == len(RADIATION) else "direct+diffuse"
    columns["direct_normal"] = direct_by_closure(total, columns["diffuse_horizontal"], up, clear)
    if total.any():
        notes.append(
            f"{where}: direct normal irradiance from global and diffuse by closure; at most twice "
            "a clear sky's beam, what exceeds it stays in the diffuse."
        )
    return "global+diffuse"
