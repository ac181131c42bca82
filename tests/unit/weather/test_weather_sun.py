from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from pvlib import irradiance, solarposition

from mascarin.tables.times import epoch_seconds
from mascarin.weather.derived.sun import SOLAR_CONSTANT, SunPath

PLACES = {
    "Denver": (39.83, -104.65),
    "Saint-Pierre": (-21.34, 55.48),
    "Tromso": (69.65, 18.96),
    "Quito": (-0.18, -78.47),
}


def times(step: str = "37min") -> pd.DatetimeIndex:
    return pd.date_range("2023-12-20", "2025-01-10", freq=step, tz="UTC")


@pytest.mark.parametrize("place", PLACES)
def test_direction_is_pvlibs_true_position_at_any_instant(place: str) -> None:
    latitude, longitude = PLACES[place]
    index = times()
    seconds = epoch_seconds(index)
    path = SunPath.over(latitude, longitude, seconds[0], seconds[-1])
    vector = path.vector(seconds)
    expected = solarposition.get_solarposition(index, latitude, longitude)
    zenith, azimuth = np.radians(expected["zenith"]), np.radians(expected["azimuth"])
    reference = np.stack(
        [np.sin(zenith) * np.sin(azimuth), np.sin(zenith) * np.cos(azimuth), np.cos(zenith)], axis=-1
    )
    assert np.max(np.abs(vector - reference)) < 1e-7
    assert np.max(np.abs(np.linalg.norm(vector, axis=1) - 1.0)) < 1e-12


def test_noon_sun_is_south_in_denver_and_north_in_reunion_in_june() -> None:
    for place, azimuth_sign, height in (("Denver", -1.0, 73.6), ("Saint-Pierre", 1.0, 45.2)):
        latitude, longitude = PLACES[place]
        day = pd.date_range("2024-06-21", periods=1440, freq="1min", tz="UTC")
        vector = SunPath.over(latitude, longitude, *epoch_seconds(day[[0, -1]])).vector(epoch_seconds(day))
        noon = vector[np.argmax(vector[:, 2])]
        assert np.sign(noon[1]) == azimuth_sign
        assert np.degrees(np.arcsin(noon[2])) == pytest.approx(height, abs=0.1)  # 90 - |latitude - 23.44|


def test_sun_rises_in_the_east_and_equinox_has_twelve_hours() -> None:
    latitude, longitude = PLACES["Saint-Pierre"]
    day = pd.date_range("2024-03-20", periods=1440, freq="1min", tz="Indian/Reunion")
    up = SunPath.over(latitude, longitude, *epoch_seconds(day[[0, -1]])).vector(epoch_seconds(day))
    light = up[:, 2] > 0.0
    assert light.sum() / 60.0 == pytest.approx(12.0, abs=0.05)
    assert up[light][0][0] > 0.99
    assert up[light][-1][0] < -0.99


def test_extraterrestrial_irradiance_follows_the_distance() -> None:
    index = times("7h")
    seconds = epoch_seconds(index)
    own = SunPath.over(0.0, 0.0, seconds[0], seconds[-1]).normal_irradiance(seconds)
    expected = irradiance.get_extra_radiation(index, solar_constant=SOLAR_CONSTANT, method="nrel")
    assert np.max(np.abs(own - expected.to_numpy())) < 1e-6
    assert own.max() / own.min() == pytest.approx((1.0167 / 0.9833) ** 2, rel=1e-3)


def test_origin_only_moves_the_zero_of_time() -> None:
    seconds = epoch_seconds(times("13h"))
    plain = SunPath.over(45.0, 5.0, seconds[0], seconds[-1]).vector(seconds)
    moved = SunPath.over(45.0, 5.0, seconds[0], seconds[-1], seconds[0]).vector(seconds - seconds[0])
    assert np.max(np.abs(plain - moved)) < 1e-9


def test_a_yearly_file_and_its_sun_need_one_file_of_pvlib(data_dir: Path) -> None:
    script = (
        "import sys; from pathlib import Path; from mascarin.weather.reading.readers import read_epw;"
        "from mascarin.weather.derived.sun import SunPath;"
        f"year = read_epw(Path({str(data_dir / 'bestest' / '725650TYCST.epw')!r}));"
        "SunPath.over(*year.place[:2], 0.0, 86400.0);"
        "print([name for name in ('pvlib', 'scipy') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
