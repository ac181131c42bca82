"""Numbers without effect are named with the reason, and no others."""

from __future__ import annotations

import pytest

from mascarin.model import Building
from model_samples import everything, room


def idle(building: Building) -> dict[str, str]:
    return {p.path: p.reason for p in building.parameters() if p.reason and not p.structural}


def test_in_a_room() -> None:
    assert set(idle(room())) == {
        *(f"site.wind.{key}" for key in ("mast_height", "mast_exponent", "mast_layer", "exponent", "layer")),
    }


def test_in_everything() -> None:
    assert set(idle(everything()[0])) == {
        "surfaces.ceiling.azimuth",
        "surfaces.ceiling.inside.convection.downward.c",
        "surfaces.ceiling.inside.convection.downward.m",
        "surfaces.ceiling.inside.convection.upward.c",
        "surfaces.ceiling.inside.convection.upward.m",
        "surfaces.east.outside.emissivity",
        "surfaces.floor.azimuth",
        "surfaces.floor.inside.convection.wind",
        "surfaces.held.azimuth",
        "surfaces.held.tilt",
    }


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"site.sky": "offset"}, "site.cloud.c1"),
        ({"surfaces.south.outside.longwave": "none"}, "site.sky.a"),
        ({"surfaces.south.outside.longwave": "none"}, "surfaces.south.outside.emissivity"),
        ({"surfaces.south.outside.irradiance": "G"}, "site.ground_reflectance"),
        ({"surfaces.south.tilt": 0}, "site.ground_reflectance"),
        ({"surfaces.south.tilt": 0}, "surfaces.south.azimuth"),
        ({"surfaces.south.outside.height": 2}, "surfaces.south.outside.height"),
        ({"zones.room.longwave": "none"}, "surfaces.rest.inside.emissivity"),
    ],
)
def test_a_choice_puts_numbers_out_of_work(changes: dict[str, object], path: str) -> None:
    assert path in idle(room().replace(changes))
    assert path not in idle(room())


def test_a_height_and_a_wind_correlation_put_the_profile_to_work() -> None:
    building = room().replace(
        {"surfaces.south.outside.convection": "mowitt", "surfaces.south.outside.height": 2}
    )
    assert idle(building) == {}
