"""Outputs of the sun: its position, beam and diffuse radiation on planes, views of sky and ground."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.building.reading import parse
from mascarin.weather import Climate
from test_building_sun_and_films import BOX
from test_measured_obstacles import EDGE, strip, weather

SUN = ["sun_altitude", "sun_azimuth"]


def planes() -> Building:
    return parse(BOX, "box.yaml")


@pytest.fixture(scope="module")
def day() -> Any:
    names = [f"{name}.{kind}" for name in ("roof", "south", "pane") for kind in KINDS]
    return mc.simulate(
        planes(), Climate.shipped("golden"), start="2001-06-20", end="2001-06-22", step="5min", initial=20.0,
        outputs=[*SUN, *names],
    )  # fmt: skip


KINDS = ("incident_solar", "incident_beam", "incident_diffuse", "sky_view_factor", "ground_view_factor")


def test_the_sun_is_highest_in_the_south(day: Any) -> None:
    """Culmination on the longest day: 90 deg less latitude, and the obliquity of 23.44 deg."""
    altitude, azimuth = (day[name].to_numpy() for name in SUN)
    top = int(np.argmax(altitude))
    assert altitude[top] == pytest.approx(90.0 - 39.83 + 23.44, abs=0.05)
    assert azimuth[top] == pytest.approx(180.0, abs=2.0)
    assert altitude.min() < -20.0
    rising = np.flatnonzero(np.diff(np.sign(altitude)) > 0)[0]
    # cos(azimuth) = sin(declination) / cos(latitude) at the horizon.
    expected = np.degrees(np.arccos(np.sin(np.radians(23.44)) / np.cos(np.radians(39.83))))
    assert azimuth[rising] == pytest.approx(expected, abs=1.0)


def test_beams_on_two_planes_are_those_of_the_position(day: Any) -> None:
    """A south wall gets ``cos(azimuth - 180)/tan(altitude)`` of the beam on the level, whatever its power."""
    altitude, azimuth = (np.radians(day[name].to_numpy()) for name in SUN)
    roof, south = (day[f"{name}.incident_beam"].to_numpy() for name in ("roof", "south"))
    ratio = np.cos(azimuth - np.pi) / np.tan(altitude)
    middle = 0.5 * (ratio[1:] + ratio[:-1])
    high = (roof[1:] > 100.0) & (middle > 0.05)
    assert high.sum() > 50
    assert south[1:][high] / roof[1:][high] == pytest.approx(middle[high], abs=4e-3)


def test_parts_add_up(day: Any) -> None:
    for name in ("roof", "south", "pane"):
        whole, beam, diffuse = (day[f"{name}.{kind}"].to_numpy() for kind in KINDS[:3])
        assert beam + diffuse == pytest.approx(whole, abs=1e-9)
        assert beam.min() >= 0.0
        assert diffuse.min() >= 0.0
    assert day["south.incident_beam"].to_numpy() == pytest.approx(day["pane.incident_beam"].to_numpy())
    night = day["sun_altitude"].to_numpy() < -1.0
    assert day["roof.incident_beam"].to_numpy()[night].max() == 0.0


def test_views_are_those_of_the_tilt(day: Any) -> None:
    for name, sky in (("roof", 1.0), ("south", 0.5), ("pane", 0.5)):
        assert day[f"{name}.sky_view_factor"].to_numpy()[-1] == pytest.approx(sky, abs=1e-12)
        assert day[f"{name}.ground_view_factor"].to_numpy()[-1] == pytest.approx(1.0 - sky, abs=1e-12)


def test_recording_them_changes_nothing() -> None:
    options: dict[str, Any] = {"start": "2001-06-20", "end": "2001-06-21", "step": "1h", "initial": 20.0}
    plain = mc.simulate(planes(), Climate.shipped("golden"), outputs=["room.air_temperature"], **options)
    names = ["room.air_temperature", "south.incident_beam", "sun_azimuth"]
    more = mc.simulate(planes(), Climate.shipped("golden"), outputs=names, **options)
    np.testing.assert_array_equal(plain["room.air_temperature"], more["room.air_temperature"])


def test_slopes_of_the_beam_by_a_tilt_agree_with_differences() -> None:
    path, name = "surfaces.south.tilt", "south.incident_beam"
    options: dict[str, Any] = {"start": "2001-06-20", "end": "2001-06-21", "step": "1h", "initial": 20.0}
    simulation = mc.Simulation(planes(), Climate.shipped("golden"), outputs=[name], **options)
    slope = simulation.jacobian([path])[f"d {name}"].sel(parameter=path).to_numpy()
    high, low = (simulation.run({path: 90.0 + sign * 1e-3})[name].to_numpy() for sign in (1, -1))
    assert np.abs(slope).max() > 1.0
    assert slope == pytest.approx((high - low) / 2e-3, abs=1e-3 * np.abs(slope).max())


def test_views_are_those_past_obstacles() -> None:
    """An endless overhang leaves ``cos(edge)/2`` of the sky, and all of the ground; a stated view stays."""
    names = ["wall.sky_view_factor", "wall.ground_view_factor"]
    options: dict[str, Any] = {"step": "1h", "initial": 15.0, "outputs": names}
    run = mc.simulate(strip(), weather(0.0, 100.0), **options)
    assert run[names[0]].to_numpy() == pytest.approx(0.5 * np.cos(EDGE), rel=5e-3)
    assert run[names[1]].to_numpy() == pytest.approx(0.5, abs=1e-12)
    stated = mc.simulate(strip({"sky_view": 0.31}), weather(0.0, 100.0), **options)
    assert stated[names[0]].to_numpy() == pytest.approx(0.31, abs=1e-12)


def test_a_stated_view_of_the_ground_is_that_of_its_reflected_sun() -> None:
    """The roof, level, sees none; with a view of 0.9 it gets ``0.9 r`` of its own irradiance in addition."""
    plain = planes().to_dict()
    plain["site"] |= {"ground_reflectance": 0.2, "diffuse": "isotropic"}
    seeing = planes().to_dict() | {"site": plain["site"]}
    seeing["surfaces"]["roof"]["outside"] = plain["surfaces"]["roof"]["outside"] | {"ground_view": 0.9}
    seeing["windows"]["pane"]["outside"] = plain["windows"]["pane"]["outside"] | {"ground_view": 0.0}
    names = ["roof.incident_solar", "roof.ground_view_factor", "pane.incident_diffuse", "pane.incident_solar"]
    options: dict[str, Any] = {"start": "2001-06-20", "end": "2001-06-21", "step": "1h", "initial": 20.0}
    runs = [
        mc.simulate(Building.from_dict(tree), Climate.shipped("golden"), outputs=names, **options)
        for tree in (plain, seeing)
    ]
    level = runs[0]["roof.incident_solar"].to_numpy()
    more = runs[1]["roof.incident_solar"].to_numpy() - level
    high = level > 100.0
    assert high.sum() > 8
    # The ground has the measured global radiation, the roof that of the sun's position in the hour.
    assert more[high] == pytest.approx(0.9 * 0.2 * level[high], rel=3e-3)
    assert runs[1]["roof.ground_view_factor"].to_numpy()[-1] == 0.9
    lost = runs[0]["pane.incident_diffuse"].to_numpy() - runs[1]["pane.incident_diffuse"].to_numpy()
    assert lost == pytest.approx(0.5 / 0.9 * more, rel=1e-9, abs=1e-9)
