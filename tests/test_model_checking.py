"""What is said about a building before it runs."""

from __future__ import annotations

import math

import pytest

from mascarin.model import Building, check
from mascarin.model.checking import time_constant, u_value
from mascarin.model.mesh import choose
from mascarin.model.reading import parse
from model_samples import EVERYTHING, ROOM, everything, room


def test_u_value_of_a_wall() -> None:
    """0.2 m of concrete at 1.75 W/(m K) between the film resistances 0.04 and 0.13 m2K/W of ISO 6946."""
    building = room()
    assert u_value(building, building.surfaces["south"]) == pytest.approx(1 / (0.04 + 0.2 / 1.75 + 0.13))


def test_u_value_of_a_floor_on_the_ground() -> None:
    building = everything()[0]
    layers = 0.1 / 1.75 + 0.15 + 0.02 / 1.75
    assert u_value(building, building.surfaces["floor"]) == pytest.approx(1 / (layers + 0.17))


def test_smallest_time_constant() -> None:
    """Nine equal nodes: those inside have neighbours on both sides."""
    building = room()
    nodes = choose(building, 900).nodes["wall", "concrete"]
    width = 0.2 / nodes
    inner = 2240 * 900 * width / (2 * 1.75 / width)
    outer = 2240 * 900 * width / (1.75 / width + 1 / (0.5 * width / 1.75 + 1 / 15))
    assert time_constant(building, "wall", choose(building, 900)) == pytest.approx(min(inner, outer))


def test_the_lines() -> None:
    lines = check(room(), 900)
    assert lines[0] == "room: 1 zone, 2 surfaces, 38 parameters"
    assert lines[1].startswith("zone room: 30 m3, 2 faces of 66.00 m2, UA ")
    assert "infiltration 5.05 W/K" in lines[1]
    assert "view factors approximated by areas" in lines[1]
    assert lines[2].startswith(
        "surface south: wall, 16.00 m2, tilt 90, azimuth 180, outdoors -> room, U 3.518 "
    )
    assert lines[4].startswith("construction wall: nodes concrete 9, smallest time constant ")


def noted(building: Building, word: str, step: float = 900.0) -> list[str]:
    return [line for line in check(building, step) if line.startswith(f"{word}:")]


def test_a_step_that_may_overshoot() -> None:
    building = room()
    least = time_constant(building, "wall", choose(building, 900))
    assert any("SDIRK2 may overshoot" in line for line in noted(building, "warning"))
    coarse = building.replace({"constructions.wall.layers.concrete.nodes": 1})
    assert not any("SDIRK2" in line for line in noted(coarse, "warning"))
    assert math.isfinite(least)


def test_faces_that_cannot_enclose_the_volume() -> None:
    small = parse(ROOM.replace("area: 50", "area: 5"), "x")
    assert any(
        "21.00 m2 of faces cannot enclose 30 m3 (a sphere needs 46.69 m2)" in w
        for w in noted(small, "warning")
    )
    assert not any("enclose" in w for w in noted(room(), "warning"))


def test_vertices_that_contradict_what_is_written() -> None:
    text = EVERYTHING.replace("    vertices: [[0, 0, 3]", "    area: 8\n    vertices: [[0, 0, 3]")
    assert any(
        "8.00 m2 are given, the vertices enclose 9.12 m2" in w for w in noted(parse(text, "x"), "warning")
    )


def test_assumptions_are_listed() -> None:
    told = noted(room(), "assumed")
    assert any("site.sky: martin_berdahl" in line for line in told)
    assert any("site.diffuse: perez" in line for line in told)
    assert any("zones.room: every face sees every other one" in line for line in told)
    assert any("zones.room.capacity_factor = 1 -" in line for line in told)


def test_sources_are_those_of_numbers_and_correlations() -> None:
    found = everything()[0].sources()
    assert "a table" in found
    assert any("Alamdari" in source for source in found)
    assert any("Walton" in source for source in found)
    assert any("Yazdanian" in source for source in found)
    assert any("Martin & Berdahl" in source for source in found)
    assert len(set(found)) == len(found)
    assert not any("Yazdanian" in source for source in room().sources())


def test_melting_is_shown_by_its_width() -> None:
    lines = check(everything()[0], 900)
    assert "material wax: 71000 J/kg about 23.4 degC, half-width 1 K" in lines
    assert "material salt: 150000 J/kg about 27 degC, half-width 1.5 K" in lines
    assert "material curve: melts between 20 and 22 degC, by its table" in lines
