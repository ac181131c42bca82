"""Defaults that are derived from the rest of a description."""

from __future__ import annotations

import math

import pytest

from building_samples import EVERYTHING, ROOM, everything, room
from mascarin.building import Building
from mascarin.building.parameters.parameter import Parameter
from mascarin.building.reading import parse


def derived(path: str) -> Parameter:
    return everything()[0].parameter(path)


def test_area_and_direction_from_vertices() -> None:
    """A roof 3 m wide that rises 0.5 m to the north over 3 m."""
    slope = math.hypot(3.0, 0.5)
    assert derived("surfaces.roof.area").value == pytest.approx(3.0 * slope)
    assert derived("surfaces.roof.tilt").value == pytest.approx(math.degrees(math.atan2(0.5, 3.0)))
    assert derived("surfaces.roof.azimuth").value == pytest.approx(180.0)
    assert derived("surfaces.roof.area").source == "from the vertices"


def test_a_given_area_replaces_that_of_the_vertices() -> None:
    text = EVERYTHING.replace("    vertices: [[0, 0, 3]", "    area: 8\n    vertices: [[0, 0, 3]")
    assert parse(text, "x").parameter("surfaces.roof.area").value == 8.0


def test_defaults_of_forced_convection() -> None:
    assert derived("surfaces.roof.outside.height").value == pytest.approx(3.25)
    perimeter = 2 * (3.0 + math.hypot(3.0, 0.5))
    assert derived("surfaces.roof.outside.convection.perimeter").value == pytest.approx(perimeter)
    assert derived("surfaces.roof.outside.convection.roughness").value == 1.52
    assert derived("surfaces.roof.outside.convection.roughness").assumed
    building = room().replace({"surfaces.south.outside.convection": "tarp"})
    assert building.parameter("surfaces.south.outside.convection.perimeter").value == pytest.approx(16.0)


def test_a_height_needs_vertices() -> None:
    assert room().surfaces["south"].outside.height is None


@pytest.mark.parametrize(
    ("vertices", "length"),
    [
        ([[0, 0, 1], [4, 0, 1], [4, 0, 3.5], [0, 0, 3.5]], 2.5),  # upright: its height
        ([[0, 0, 1], [4, 0, 1], [4, 2, 1], [0, 2, 1]], 4 * 8 / 12),  # lying: 4 A/P
    ],
)
def test_length_of_buoyant_convection(vertices: list[list[float]], length: float) -> None:
    before = "    area: 50\n    tilt: 90\n    azimuth: 0\n"
    text = ROOM.replace(before, f"    vertices: {vertices}\n")
    text = text.replace(
        "true}\n    inside: {zone: room, convection: 3",
        "true}\n    inside: {zone: room, convection: alamdari_hammond",
    )
    parameter = parse(text, "x").parameter("surfaces.rest.inside.convection.length")
    assert parameter.value == pytest.approx(length)


def test_length_without_vertices_is_the_edge_of_a_square() -> None:
    assert derived("surfaces.ceiling.outside.convection.length").value == pytest.approx(3.0)


def test_terrain_gives_the_profile_at_the_building() -> None:
    assert (derived("site.wind.exponent").value, derived("site.wind.layer").value) == (0.22, 370.0)
    assert (derived("site.wind.mast_exponent").value, derived("site.wind.mast_layer").value) == (0.14, 270.0)
    own = everything()[0].replace({"site.wind": {"terrain": "city", "exponent": 0.3}})
    assert (own.parameter("site.wind.exponent").value, own.parameter("site.wind.layer").value) == (0.3, 460.0)


def test_a_direction_without_effect_need_not_be_given() -> None:
    assert derived("surfaces.floor.azimuth").value == 0.0
    assert derived("surfaces.held.azimuth").reason


@pytest.mark.parametrize(("latitude", "day"), [(48.0, 15.0), (0.0, 15.0), (-20.9, 196.0), (-45.0, 196.0)])
def test_the_ground_is_coldest_in_the_winter_of_its_hemisphere(latitude: float, day: float) -> None:
    """15 January is day 15; 15 July is day 31 + 28 + 31 + 30 + 31 + 30 + 15 = 196."""
    wall = {"construction": "wall", "area": 5.0, "tilt": 180, "inside": {"measured": "T"}}
    building = Building.from_dict(
        {
            "site": {"latitude": latitude, "longitude": 0, "altitude": 0, "timezone": "UTC"},
            "materials": {"concrete": {"conductivity": 1.75, "density": 2400, "specific_heat": 880}},
            "constructions": {"wall": {"layers": [{"material": "concrete", "thickness": 0.2}]}},
            "surfaces": {"floor": {**wall, "outside": {"ground": {"mean": 12, "amplitude": 4}}}},
        }
    )
    found = building.parameter("surfaces.floor.outside.ground.coldest_day")
    assert found.value == day
    assert found.assumed
    assert "coldest_day" not in building.to_dict()["surfaces"]["floor"]["outside"]["ground"]
