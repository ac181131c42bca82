from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pvlib.irradiance import erbs, get_extra_radiation

from mascarin.physics import dew_point
from mascarin.weather import Climate
from mascarin.weather.derived.derive import cloud_cover, diffuse_erbs
from mascarin.weather.derived.radiation import BEAM_CEILING, clear_beam, direct_by_closure
from mascarin.weather.derived.sun import SunPath


def test_dew_point_of_saturated_air_is_its_temperature() -> None:
    air = np.array([-20.0, 0.0, 25.0, 40.0])
    assert dew_point(air, np.full(4, 100.0)) == pytest.approx(air, abs=1e-10)


def test_dew_point_at_half_saturation() -> None:
    # 25 degC, 50 %: psychrometric tables give 13.9 degC; 30 degC, 70 %: 23.9 degC.
    assert dew_point(np.array([25.0, 30.0]), np.array([50.0, 70.0])) == pytest.approx(
        [13.86, 23.93], abs=0.03
    )
    assert np.isfinite(dew_point(np.array([25.0]), np.array([0.0]))[0])


def test_erbs_is_pvlibs_with_our_extraterrestrial_irradiance() -> None:
    day = np.array([10.0, 100.0, 200.0, 300.0])
    total = np.array([100.0, 350.0, 600.0, 900.0])
    up = np.array([0.4, 0.6, 0.8, 0.95])
    extra = np.asarray(get_extra_radiation(day))
    expected = erbs(total, np.degrees(np.arccos(up)), day)["dhi"]
    assert diffuse_erbs(total, up, extra) == pytest.approx(expected, rel=1e-10)


def test_erbs_limits() -> None:
    extra = np.full(3, 1361.0)
    diffuse = diffuse_erbs(np.array([20.0, 5.0, -1.0]), np.array([0.02, 0.0, 0.0]), extra)
    assert diffuse == pytest.approx([20.0, 5.0, -1.0])  # low sun: no beam
    overcast = diffuse_erbs(np.array([50.0]), np.array([0.9]), extra[:1])
    assert overcast[0] == pytest.approx(50.0 * (1.0 - 0.09 * 50.0 / (1361.0 * 0.9)))


def clear_sky(up: np.ndarray) -> np.ndarray:
    """Haurwitz's clear sky by hand; nothing below the horizon. [W/m2]"""
    return np.where(up > 0.0, 1098.0 * up * np.exp(-0.057 / np.maximum(up, 1e-3)), 0.0)


def test_cloud_cover_inverts_kimball() -> None:
    up = np.maximum(np.sin(np.linspace(-np.pi, 3.0 * np.pi, 96)), 0.0)
    total = clear_sky(up) * (0.29 + 0.71 * (1.0 - 0.75))
    tenths = cloud_cover(total, up, 3600.0)
    assert tenths == pytest.approx(np.full(96, 7.5), abs=1e-9)
    assert cloud_cover(np.zeros(10), np.zeros(10), 3600.0) == pytest.approx(np.zeros(10))
    assert cloud_cover(3.0 * total, up, 3600.0).max() == 0.0


def test_cloud_cover_is_linear_through_the_night() -> None:
    up = np.array([0.5, 0.5, 0.0, 0.0, 0.0, 0.5, 0.5])
    clear = float(clear_sky(up)[0])
    tenths = cloud_cover(np.array([clear, clear, 0.0, 0.0, 0.0, 0.25 * clear, 0.25 * clear]), up, 3600.0)
    assert tenths == pytest.approx([0.0, 0.0, 2.5, 5.0, 7.5, 10.0, 10.0])


SITES = {
    "Hamburg": (53.6, 10.0, 16.0),
    "Denver": (39.8, -104.6, 1650.0),
    "Saint-Denis": (-20.9, 55.5, 10.0),
    "Singapore": (1.35, 103.8, 20.0),
    "Nairobi": (-1.3, 36.8, 1700.0),
}


@pytest.mark.filterwarnings("ignore:.*dayofyear")  # of pvlib
@pytest.mark.parametrize("model", ["haurwitz", "ineichen"])
@pytest.mark.parametrize("day", ["2021-01-15", "2021-04-15", "2021-07-15"])
@pytest.mark.parametrize("site", SITES)
def test_a_clear_sky_of_pvlib_has_few_clouds(site: str, day: str, model: str) -> None:
    """Half-hourly values of a whole day; the inverse of Kasten and Czeplak gave up to 8 tenths."""
    from pvlib.location import Location

    latitude, longitude, altitude = SITES[site]
    times = pd.date_range(day, periods=48, freq="30min", tz="UTC")
    place = Location(latitude, longitude, altitude=altitude)
    extra = {"linke_turbidity": 3.0} if model == "ineichen" else {}
    total = place.get_clearsky(times, model=model, **extra)["ghi"].to_numpy()
    position = place.get_solarposition(times)["zenith"].to_numpy()
    tenths = cloud_cover(total, np.maximum(np.cos(np.radians(position)), 0.0), 1800.0)
    lit = position < 80.0
    assert tenths[lit].mean() < (0.2 if model == "haurwitz" else 2.0)
    assert tenths[lit].max() < (0.5 if model == "haurwitz" else 3.0)


#: Error of the inverse of Kasten and Czeplak by day, root of the mean square [tenths].
BEFORE = {"REU_Saint-Denis": 2.57, "USA_FL_Tampa": 3.20, "USA_IL_Chicago": 2.89}


@pytest.mark.parametrize("name", BEFORE)
def test_estimated_clouds_agree_better_with_observed_ones(name: str, data_dir: Path) -> None:
    """Hours with the sun above 10 deg in years of weather files that have observed opaque clouds."""
    [file] = (data_dir / "weather").glob(f"{name}*.epw")
    head = file.read_text(encoding="utf-8", errors="replace").split("\n")[0].split(",")
    climate = Climate.from_epw(file)
    seen = climate.data["cloud_cover"].to_numpy()
    observed = 0.5 * (seen + np.append(seen[1:], seen[-1]))
    grid = climate.grid
    sun = SunPath.over(float(head[6]), float(head[7]), grid.start, grid.end)
    parts = grid.start + grid.interval * (np.arange(grid.count)[:, None] + (np.arange(12) + 0.5) / 12)
    up = np.maximum(sun.vector(parts)[..., 2], 0.0).mean(axis=1)
    estimated = cloud_cover(climate.data["global_horizontal"].to_numpy(), up, 3600.0)
    error = (estimated - observed)[up > np.sin(np.radians(10.0))]
    assert np.sqrt(np.mean(error**2)) < 0.75 * BEFORE[name]
    assert abs(error.mean()) < 0.9


def test_the_correlation_of_erbs_at_its_borders() -> None:
    """At clearness 0.22 and 0.80 its branches differ by 2.7e-4 of the global irradiance, as published."""
    up, extra = np.full(2, 0.7), np.full(2, 1361.0)
    for border in (0.22, 0.80):
        total = 1361.0 * 0.7 * border * np.array([1.0 - 1e-9, 1.0 + 1e-9])
        before, behind = diffuse_erbs(total, up, extra) / total
        assert abs(before - behind) == pytest.approx(2.7e-4, abs=0.2e-4)
    overcast, clear = diffuse_erbs(1361.0 * 0.7 * np.array([1e-6, 0.9]), up, extra)
    assert overcast / (1361.0 * 0.7e-6) == pytest.approx(1.0, abs=1e-5)
    assert clear / (1361.0 * 0.7 * 0.9) == pytest.approx(0.165)


def test_a_low_sun_leaves_all_of_it_diffuse_or_bounds_the_beam() -> None:
    """Below 3 deg the split is all diffuse; the beam by closure is at most twice that of a clear sky."""
    up = np.sin(np.radians([0.5, 2.999, 3.001, 30.0]))
    total = np.array([80.0, 80.0, 80.0, 900.0])
    diffuse = diffuse_erbs(total, up, np.full(4, 1361.0))
    assert (diffuse[:2] == total[:2]).all()
    clear = 1361.0 * clear_beam(up)
    beam = direct_by_closure(total, diffuse, up, clear)
    assert (beam <= BEAM_CEILING * clear).all()
    assert (clear_beam(np.array([-0.1, 0.0])) == 0.0).all()
    assert clear_beam(np.array([1.0]))[0] == pytest.approx(0.7, abs=1e-3)
