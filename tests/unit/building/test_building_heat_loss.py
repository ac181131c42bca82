"""Heat loss coefficient and effective capacity of buildings that are calculated by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.building import Building, load
from mascarin.building.heat_loss import heat_loss

ROOM = """\
name: room
site: {latitude: 45, longitude: 5, altitude: 0, timezone: UTC+1, air_density: 1.2, air_specific_heat: 1000}
materials:
  insulation: {conductivity: 0.04, density: 50, specific_heat: 1000}
  brick: {conductivity: 0.5, density: 1500, specific_heat: 800}
constructions:
  wall: {layers: [{material: insulation, thickness: 0.1}, {material: brick, thickness: 0.2}]}
  mass: {layers: [{material: brick, thickness: 0.1}]}
zones:
  room:
    volume: 60
    capacity_factor: 2
    longwave: {kind: none}
    infiltration: {constant: 0.3, wind: 0.05, temperature: 0.01}
    thermal_bridges: {corner: {psi: 0.1, length: 5}}
surfaces:
  facade:
    construction: wall
    area: 20
    tilt: 90
    azimuth: 180
    outside: {outdoors: true, convection: 20, emissivity: 0.9, absorptance: 0.5}
    inside: {zone: room, convection: 8}
  cellar:
    construction: wall
    area: 10
    tilt: 180
    outside: {measured: ground, convection: 6}
    inside: {zone: room, convection: 8}
  partition:
    construction: mass
    area: 15
    tilt: 90
    azimuth: 0
    internal_mass: true
    outside: {zone: room, convection: 8}
    inside: {zone: room, convection: 8}
"""
#: Convection and black radiation of 5.1 W/(m2 K) (ISO 6946) outside. [m2 K/W]
OUTSIDE = 1.0 / (20.0 + 0.9 * 5.1)


def _room(folder: Path) -> Building:
    path = folder / "room.yaml"
    path.write_text(ROOM, encoding="utf-8")
    return load(path)


def test_the_heat_loss_coefficient_of_a_room_by_hand(tmp_path: Path) -> None:
    found = heat_loss(_room(tmp_path))
    layers = 0.1 / 0.04 + 0.2 / 0.5
    facade = 1.0 / (OUTSIDE + layers + 1.0 / 8.0)
    cellar = 1.0 / (1.0 / 6.0 + layers + 1.0 / 8.0)
    # Infiltration at 4 m/s and 10 K: 0.3 + 0.2 + 0.1 air changes per hour.
    expected = {
        "outdoors": 20.0 * facade, "measured": 10.0 * cellar, "thermal bridges": 0.5,
        "infiltration": 1200.0 * 60.0 * 0.6 / 3600.0,
    }  # fmt: skip
    assert found.destinations == pytest.approx(expected)
    assert found.total == pytest.approx(sum(expected.values()))
    assert found.u_values == pytest.approx({"facade": facade, "cellar": cellar})


def test_the_effective_capacity_is_what_a_degree_stores_in_the_steady_state(tmp_path: Path) -> None:
    found = heat_loss(_room(tmp_path))
    stored = 1200.0 * 60.0 * 2.0 + 15.0 * 0.1 * 1500.0 * 800.0  # air, and the partition as a whole
    for area, film in ((20.0, OUTSIDE), (10.0, 1.0 / 6.0)):
        total = film + 2.5 + 0.4 + 1.0 / 8.0
        stored += area * 0.1 * 50.0 * 1000.0 * (film + 1.25) / total
        stored += area * 0.2 * 1500.0 * 800.0 * (film + 2.5 + 0.2) / total
    assert found.capacity == pytest.approx(stored / 3600.0)
    assert found.time_constant == pytest.approx(found.capacity / found.total)


def test_the_solar_aperture_of_a_room_by_hand(tmp_path: Path) -> None:
    """The facade passes the part of the absorbed heat that its inner resistances leave."""
    room = _room(tmp_path)
    facade = 1.0 / (OUTSIDE + 0.1 / 0.04 + 0.2 / 0.5 + 1.0 / 8.0)
    assert heat_loss(room).apertures == pytest.approx({"opaque": 0.5 * facade * OUTSIDE * 20.0})
    described = room.to_dict()
    for surface in described["surfaces"].values():
        surface["inside"]["absorptance"] = 0.6
    described["surfaces"]["partition"]["outside"]["absorptance"] = 0.6
    glazed = Building.from_dict(
        described
        | {
            "glazings": {"double": {"kind": "simple", "u_value": 1.1, "solar_heat_gain": 0.6}},
            "windows": {
                "south": {
                    "surface": "facade", "glazing": "double", "area": 5,
                    "outside": {"convection": 20}, "inside": {"convection": 8},
                }
            },
        }
    )  # fmt: skip
    apertures = heat_loss(glazed).apertures
    assert apertures["opaque"] == pytest.approx(0.5 * facade * OUTSIDE * 15.0)
    assert apertures["windows"] == pytest.approx(0.6 * 5.0, rel=0.02)  # as the engine rates the glass
