"""Frequent mistakes in descriptions: the message says what to write."""

from __future__ import annotations

from typing import Any

import pytest

import mascarin as mc
from mascarin.errors import InputError

CUBE = {
    "floor": [[0, 0, 0], [0, 4, 0], [5, 4, 0], [5, 0, 0]],
    "roof": [[0, 0, 3], [5, 0, 3], [5, 4, 3], [0, 4, 3]],
    "south": [[0, 0, 0], [5, 0, 0], [5, 0, 3], [0, 0, 3]],
    "north": [[5, 4, 0], [0, 4, 0], [0, 4, 3], [5, 4, 3]],
    "east": [[5, 0, 0], [5, 4, 0], [5, 4, 3], [5, 0, 3]],
    "west": [[0, 4, 0], [0, 0, 0], [0, 0, 3], [0, 4, 3]],
}
OUTSIDE: dict[str, Any] = {"outdoors": True, "convection": 20, "emissivity": 0.9, "absorptance": 0.6}
INSIDE = {"zone": "room", "convection": 3, "emissivity": 0.9}


def cube(*reverse: str, room: dict[str, Any] | None = None, **outside: Any) -> mc.Building:
    """A closed room; some surfaces have their vertices in reverse order."""
    return mc.Building.from_dict(
        {
            "site": {"latitude": 45, "longitude": 5, "altitude": 200, "timezone": "UTC+1"},
            "materials": {"brick": {"conductivity": 0.8, "density": 1700, "specific_heat": 850}},
            "constructions": {"wall": {"layers": [{"material": "brick", "thickness": 0.2}]}},
            "zones": {"room": room or {}},
            "surfaces": {
                name: {
                    "construction": "wall",
                    "vertices": points[::-1] if name in reverse else points,
                    "outside": outside if outside and name == "south" else OUTSIDE,
                    "inside": INSIDE,
                }
                for name, points in CUBE.items()
            },
        }
    )


@pytest.mark.parametrize(
    ("outside", "says"),
    [
        ({"ground": 24}, ["outside.ground", "the number 24", "'ground: {temperature: 24}'"]),
        ({"temperature": 24}, ["outside.temperature", "'ground: {temperature: 24}'", "'measured: COLUMN'"]),
        ({**OUTSIDE, "emissivity": 0}, ["outside.emissivity", "found: 0.0", "'longwave: none'"]),
        (
            {**OUTSIDE, "convection": {"measured": "h"}},
            ["outside.convection", "without a kind", "constant, alamdari_hammond, doe2", "'convection: 8'"],
        ),
        ({"ground": {"measured": "T"}}, ["ground.measured", "'measured: COLUMN' in the side"]),
    ],
)
def test_what_to_write_on_a_side(outside: dict[str, Any], says: list[str]) -> None:
    with pytest.raises(InputError) as error:
        cube(**outside)
    for part in ["surfaces.south.", *says]:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("room", "says"),
    [
        ({"temperature": 24}, ["zones.room.temperature", "'held: 24'"]),
        ({"setpoint": 24}, ["zones.room.setpoint", "'heating: {setpoint: 20}'"]),
        ({"heating": {"setpoint": {"measured": "T"}}}, ["setpoint.measured", "{schedule: NAME}"]),
    ],
)
def test_what_to_write_in_a_zone(room: dict[str, Any], says: list[str]) -> None:
    with pytest.raises(InputError) as error:
        cube(room=room)
    for part in says:
        assert part in str(error.value)


def test_what_is_advised_is_accepted() -> None:
    cube(ground={"temperature": 24})
    cube(ground={"mean": 24.0, "amplitude": 4.0})
    cube(**{**OUTSIDE, "convection": {"kind": "tarp"}})
    cube(room={"heating": {"setpoint": 24}, "cooling": {"setpoint": 24}})
    cube(**OUTSIDE, longwave="none")


@pytest.mark.parametrize("reverse", [("roof",), ("south", "north"), ("floor", "east", "west")])
def test_reversed_vertices_are_named(reverse: tuple[str, ...]) -> None:
    """Either the reversed surfaces or, where they are the majority, still those that point outwards."""
    assert cube().parameter("zones.room.volume").value == pytest.approx(60.0)
    names = ", ".join(name for name in CUBE if name in reverse)
    with pytest.raises(InputError, match=f"the vertices of {names} are in the reverse order") as error:
        cube(*reverse)
    assert f"Reverse the order of those of {names}" in str(error.value)


def test_all_reversed_vertices_are_said() -> None:
    with pytest.raises(InputError, match=r"Reverse the order of the vertices of every surface"):
        cube(*CUBE)


def test_reversed_vertices_are_refused_where_the_volume_is_given() -> None:
    """View factors are exact, so that a run refuses them; `check` says it before, with the cause."""
    with pytest.raises(InputError, match="the vertices of roof are in the reverse order"):
        cube("roof", room={"volume": 60}).check()


def test_open_rooms_are_not_called_reversed() -> None:
    building = cube(room={"volume": 60}).to_dict()
    del building["surfaces"]["roof"]
    del building["zones"]["room"]["volume"]
    with pytest.raises(InputError, match="do not enclose the zone: 4 open edges"):
        mc.Building.from_dict(building)
