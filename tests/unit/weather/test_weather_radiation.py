from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from pvlib import atmosphere, clearsky, solarposition

from mascarin.tables.profile import trapezoid_weights
from mascarin.tables.times import epoch_seconds
from mascarin.weather.derived.radiation import clear_beam, direct_by_closure, from_instants, from_means
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.records.channels import Basis

LATITUDE, LONGITUDE, DAYS = -21.34, 55.48, 12


class ClearSky:
    """A clear sky by the minute (Ineichen, turbidity 3.5), and its means."""

    def __init__(self) -> None:
        index = pd.date_range("2010-09-15", periods=DAYS * 1440 + 1, freq="1min", tz="Indian/Reunion")
        self.seconds = epoch_seconds(index) - epoch_seconds(index[:1])
        zenith = solarposition.get_solarposition(index, LATITUDE, LONGITUDE)["zenith"]
        mass = atmosphere.get_absolute_airmass(atmosphere.get_relative_airmass(zenith))
        sky = clearsky.ineichen(zenith, mass, 3.5, altitude=55.0, dni_extra=1361.0).fillna(0.0)
        self.direct, self.diffuse = sky["dni"].to_numpy(), sky["dhi"].to_numpy()
        up = np.maximum(np.cos(np.radians(zenith.to_numpy())), 0.0)
        self.total = self.direct * up + self.diffuse
        span = epoch_seconds(index[[0, -1]])
        self.sun = SunPath.over(LATITUDE, LONGITUDE, span[0], span[1], span[0])

    def means(self, values: np.ndarray, minutes: int) -> np.ndarray:
        return np.asarray((0.5 * (values[1:] + values[:-1])).reshape(-1, minutes).mean(axis=1))


@pytest.fixture(scope="module")
def clear() -> ClearSky:
    return ClearSky()


def reconstruction_errors(clear: ClearSky, minutes: int, basis: Basis) -> dict[str, float]:
    """Root mean square difference from the true time series [W/m2]; also checks the means."""
    means = {name: clear.means(getattr(clear, name), minutes) for name in ("direct", "diffuse", "total")}
    sky = from_means(clear.sun, 0.0, 60.0 * minutes, means["direct"], means["diffuse"], means["total"], basis)
    names = {"direct": sky.direct_normal, "diffuse": sky.diffuse_horizontal, "total": sky.global_horizontal}
    kept = ("diffuse", "total") if basis == "global+diffuse" else ("direct", "diffuse")
    edges = 60.0 * minutes * np.arange(len(means["direct"]) + 1)
    for name in kept:
        assert np.max(np.abs(names[name].means(edges) - means[name])) < 1e-10
        assert names[name].nodes.min() >= 0.0
    return {
        name: float(np.sqrt(np.mean((profile.at(clear.seconds) - getattr(clear, name)) ** 2)))
        for name, profile in names.items()
    }


@pytest.mark.parametrize("basis", ["direct+diffuse", "global+diffuse", "all"])
def test_reconstruction_converges_to_the_true_course(clear: ClearSky, basis: Basis) -> None:
    hourly = reconstruction_errors(clear, 60, basis)
    quarter = reconstruction_errors(clear, 15, basis)
    assert hourly["total"] < 3.0
    assert hourly["diffuse"] < 1.5
    assert hourly["direct"] < 9.0
    for name in hourly:
        assert quarter[name] < 0.2 * hourly[name]


def test_hourly_steps_would_be_an_order_of_magnitude_worse(clear: ClearSky) -> None:
    flat = np.repeat(clear.means(clear.total, 60), 60)
    middle = 0.5 * (clear.total[1:] + clear.total[:-1])
    stairs = float(np.sqrt(np.mean((flat - middle) ** 2)))
    assert stairs > 15.0 * reconstruction_errors(clear, 60, "global+diffuse")["total"]


def test_global_is_direct_times_height_plus_diffuse_at_every_node(clear: ClearSky) -> None:
    direct, diffuse, total = (clear.means(x, 60) for x in (clear.direct, clear.diffuse, clear.total))
    bases: tuple[Basis, ...] = ("direct+diffuse", "global+diffuse", "all")
    for basis in bases:
        sky = from_means(clear.sun, 0.0, 3600.0, direct, diffuse, total, basis)
        times = 3600.0 * np.arange(len(total))[:, None] + 300.0 * np.arange(13)
        up = np.maximum(clear.sun.vector(times)[..., 2], 0.0)
        closure = sky.direct_normal.nodes * up + sky.diffuse_horizontal.nodes - sky.global_horizontal.nodes
        assert np.max(np.abs(closure)) < 1e-10


def test_radiation_is_continuous_except_at_the_horizon(clear: ClearSky) -> None:
    direct, diffuse, total = (clear.means(x, 60) for x in (clear.direct, clear.diffuse, clear.total))
    nodes = from_means(
        clear.sun, 0.0, 3600.0, direct, diffuse, total, "global+diffuse"
    ).global_horizontal.nodes
    assert np.max(np.abs(nodes[1:, 0] - nodes[:-1, -1])) < 4.0


def test_of_three_given_means_all_are_kept_where_a_beam_can(clear: ClearSky) -> None:
    """An even beam over hours: its means of all three come back, which a clear sky's course would miss."""
    up = np.maximum(clear.sun.vector(clear.seconds)[..., 2], 0.0)
    even = np.where(up > 0.0, 400.0, 0.0)
    direct, diffuse, total = (clear.means(x, 60) for x in (even, clear.diffuse, even * up + clear.diffuse))
    edges = 3600.0 * np.arange(len(direct) + 1)
    missed = {}
    bases: tuple[Basis, Basis] = ("direct+diffuse", "all")
    for basis in bases:
        sky = from_means(clear.sun, 0.0, 3600.0, direct, diffuse, total, basis)
        assert sky.direct_normal.means(edges) == pytest.approx(direct, abs=1e-9)
        missed[basis] = np.abs(sky.global_horizontal.means(edges) - total)
    # What is left stems from the nodes every 5 min, one of which is the first in the sun.
    assert missed["direct+diffuse"].max() > 8.0
    assert missed["all"].max() < 2.0
    assert missed["all"].mean() < 0.25 * missed["direct+diffuse"].mean()


def test_beam_in_the_sunrise_hour_comes_after_sunrise(clear: ClearSky) -> None:
    direct = clear.means(clear.direct, 60)
    nodes = from_means(
        clear.sun, 0.0, 3600.0, direct, 0.0 * direct, direct, "direct+diffuse"
    ).direct_normal.nodes
    times = 3600.0 * np.arange(len(direct))[:, None] + 300.0 * np.arange(13)
    up = clear.sun.vector(times)[..., 2]
    sunrise = np.flatnonzero((up[:, 0] <= 0.0) & (up[:, -1] > 0.0))
    assert len(sunrise) == DAYS
    assert np.all(nodes[sunrise][up[sunrise] <= 0.0] == 0.0)
    assert nodes[sunrise] @ trapezoid_weights(12) == pytest.approx(direct[sunrise], abs=1e-10)


def test_what_cannot_be_beam_is_kept_as_diffuse(clear: ClearSky) -> None:
    """Global 40 W/m2 above diffuse at night: kept in the integral, but not as a beam."""
    zero = np.zeros(24)
    total = zero.copy()
    total[1] = 40.0
    sky = from_means(clear.sun, 0.0, 3600.0, zero, zero, total, "global+diffuse")
    edges = 3600.0 * np.arange(25)
    assert sky.global_horizontal.means(edges) == pytest.approx(total, abs=1e-12)
    assert np.all(sky.direct_normal.nodes == 0.0)
    assert sky.moved[1] == 40.0


def test_negative_night_offset_keeps_its_mean(clear: ClearSky) -> None:
    diffuse = np.full(24, -2.0)
    sky = from_means(clear.sun, 0.0, 3600.0, diffuse, diffuse, diffuse, "direct+diffuse")
    edges = 3600.0 * np.arange(25)
    assert sky.diffuse_horizontal.means(edges) == pytest.approx(diffuse, abs=1e-12)
    assert sky.direct_normal.means(edges) == pytest.approx(diffuse, abs=1e-12)


def test_instants_close_at_their_stamps(clear: ClearSky) -> None:
    every = slice(None, None, 15)
    sky = from_instants(
        clear.sun, 0.0, 900.0, clear.direct[every], clear.diffuse[every], clear.total[every], "global+diffuse"
    )
    at = clear.seconds[every]
    assert sky.global_horizontal.at(at) == pytest.approx(clear.total[every], abs=1e-10)
    high = clear.total[every] > 100.0
    assert sky.direct_normal.at(at)[high] == pytest.approx(clear.direct[every][high], rel=1e-4)


def test_clear_beam_and_closure_near_the_horizon() -> None:
    up = np.array([-0.1, 0.0, 0.05, 0.5, 1.0])
    beam = clear_beam(up)
    assert beam[:2] == pytest.approx([0.0, 0.0])
    assert beam[-1] == pytest.approx(0.7, abs=1e-3)  # one air mass
    assert beam[3] == pytest.approx(0.7 ** (2.0**0.678), rel=5e-3)
    # 30 W/m2 of beam on the horizontal with the sun at 0.06 deg would be 30 kW/m2.
    direct = direct_by_closure(np.array([35.0]), np.array([5.0]), np.array([0.001]), np.array([15.0]))
    assert direct[0] == 30.0
