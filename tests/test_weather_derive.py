from __future__ import annotations

import numpy as np
import pytest
from pvlib.irradiance import erbs, get_extra_radiation

from mascarin.weather.derive import cloud_cover, dew_point, diffuse_erbs


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


def test_cloud_cover_inverts_kasten_and_czeplak() -> None:
    up = np.maximum(np.sin(np.linspace(-np.pi, 3.0 * np.pi, 96)), 0.0)
    oktas = 6.0
    total = clear_sky(up) * (1.0 - 0.75 * (oktas / 8.0) ** 3.4)
    tenths = cloud_cover(total, up, 3600.0)
    assert tenths == pytest.approx(np.full(96, 7.5), abs=1e-9)
    assert cloud_cover(np.zeros(10), np.zeros(10), 3600.0) == pytest.approx(np.zeros(10))
    assert cloud_cover(2.0 * total, up, 3600.0).min() == 0.0


def test_cloud_cover_is_linear_through_the_night() -> None:
    up = np.array([0.5, 0.5, 0.0, 0.0, 0.0, 0.5, 0.5])
    clear = float(clear_sky(up)[0])
    tenths = cloud_cover(np.array([clear, clear, 0.0, 0.0, 0.0, 0.25 * clear, 0.25 * clear]), up, 3600.0)
    assert tenths == pytest.approx([0.0, 0.0, 2.5, 5.0, 7.5, 10.0, 10.0])
