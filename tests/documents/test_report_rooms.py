"""The plan of the rooms in a report."""

from __future__ import annotations

import re
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest

from mascarin import load
from mascarin.examples import FOLDER
from mascarin.pages.study.figures import rooms
from mascarin.study.results.document.building import building_entry
from mascarin.study_document.building import BuildingEntry
from mascarin.study_document.document import StudyDocument


def wall(inside: str, outside: str, azimuth: float, area: float = 10.0) -> dict[str, Any]:
    name = f"{inside}-{outside}-{azimuth:g}"
    return {
        "name": name, "inside": inside, "outside": outside, "azimuth": azimuth, "area": area, "tilt": 90.0,
    }  # fmt: skip


def house() -> dict[str, Any]:
    """Two rooms to the north, two to the south; inner walls with an azimuth that says nothing."""
    facades = {"nw": (0.0, 270.0), "ne": (0.0, 90.0), "sw": (180.0, 270.0), "se": (180.0, 90.0)}
    walls = [wall(zone, "outdoors", azimuth) for zone, azimuths in facades.items() for azimuth in azimuths]
    inner = [("nw", "ne"), ("nw", "sw"), ("ne", "se"), ("sw", "se")]
    return {
        "zones": [{"name": name, "volume": 40.0} for name in facades],
        "surfaces": walls + [wall(one, other, 0.0) for one, other in inner],
        "windows": [{"name": "w", "surface": "sw-outdoors-180"}],
        "doors": [["nw", "sw"]],
    }


def test_rooms_stand_at_the_side_of_their_facades_and_do_not_overlap() -> None:
    found = rooms.plan(BuildingEntry.model_validate(house()))
    assert found is not None
    assert not found.exact
    centre = {name: outline.mean(axis=0) for name, outline in found.outlines.items()}
    for west, east in (("nw", "ne"), ("sw", "se")):
        assert centre[east][0] - centre[west][0] > 3.9  # squares of 4 m x 4 m side by side
    for south, north in (("sw", "nw"), ("se", "ne")):
        assert centre[north][1] - centre[south][1] > 3.9
    for one, other in combinations(centre, 2):
        assert np.abs(centre[one] - centre[other]).max() > 3.99


def test_floors_with_vertices_are_drawn_as_they_are() -> None:
    building = house()
    corners = {"nw": (0, 5), "ne": (6, 5), "sw": (0, 0), "se": (6, 0)}
    for zone, (x, y) in corners.items():
        floor = [[x, y, 0], [x, y + 5, 0], [x + 6, y + 5, 0], [x + 6, y, 0]]
        below = wall(zone, "ground", 0.0, area=30.0)
        building["surfaces"].append({**below, "tilt": 180.0, "vertices": floor})
    found = rooms.plan(BuildingEntry.model_validate(building))
    assert found is not None
    assert found.exact
    assert found.outlines["ne"][:, :2].tolist() == [[6, 5], [6, 10], [12, 10], [12, 5]]


def test_the_drawing_has_names_errors_windows_and_doors() -> None:
    study = {
        "building": house(),
        "models": {"nominal": {}, "fitted": {}},
        "sensor_info": {
            "air": {"label": "Living <room>", "output": "sw.air_temperature", "unit": "degC"},
            "power": {"label": "Heater", "output": "sw.net_load", "unit": "W"},
        },
        "sensors": {
            "air": {"corroboration": {"n": 9, "fitted": {"n": 9, "rmse": 0.214, "bias": -0.1}}},
            "power": {"corroboration": {"n": 9, "fitted": {"n": 9, "rmse": 50.0, "bias": -17.4}}},
        },
        "periods": {"corroboration": {"label": "Free float"}},
    }
    drawing, _, period = rooms.plan_drawing(StudyDocument.read(study)) or pytest.fail("no plan")
    assert period == "Free float"
    assert re.findall(r">([^<>]+)</text>", drawing)[:6] == [
        "nw", "ne", "Living &lt;room&gt;", "0.21 K", "−17 W", "se",
    ]  # fmt: skip
    (window,) = re.findall(r'<line[^>]*class="room-window"', drawing)
    assert drawing.count('class="room-door"') == 1
    x1, y1, x2, y2 = (float(value) for value in re.findall(r'[xy][12]="([0-9.]+)"', window))
    assert y1 == pytest.approx(y2)  # in the south wall
    assert abs(x2 - x1) > 50.0


@pytest.mark.parametrize("count", [1, 41])
def test_no_plan_of_one_room_or_of_too_many(count: int) -> None:
    names = [f"z{k}" for k in range(count)]
    walls = [wall(one, other, 0.0) for one, other in pairwise(names)]
    building = {"zones": [{"name": name, "volume": 40.0} for name in names], "surfaces": walls}
    assert rooms.plan(BuildingEntry.model_validate(building)) is None


def test_rooms_above_each_other_have_no_plan() -> None:
    building = {
        "zones": [{"name": "room", "volume": 27.0}, {"name": "gap", "volume": 2.0}],
        "surfaces": [wall("room", "outdoors", 0.0), {**wall("room", "gap", 0.0), "tilt": 0.0}],
    }
    assert rooms.plan(BuildingEntry.model_validate(building)) is None


def test_the_rooms_of_the_twin_house_stand_as_they_do_there() -> None:
    building = building_entry(load(FOLDER / "twin_house" / "building.yaml"))
    found = rooms.plan(building)
    assert found is not None
    x, y = (
        {name: float(outline[:, axis].mean()) for name, outline in found.outlines.items()} for axis in (0, 1)
    )
    assert x["kitchen"] < x["doorway"] < x["bedroom"]
    assert x["living"] < x["corridor"] < x["bath"]
    assert y["child"] < y["bath"] < y["bedroom"]
    assert y["living"] < min(y["kitchen"], y["doorway"])
    # A side that faces the mean of two columns says so.
    assert "mean of attic_east_AT and attic_west_AT" in {one.outside for one in building.surfaces}
