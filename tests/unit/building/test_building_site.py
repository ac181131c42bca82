"""The site: time zones, sources of defaults."""

from __future__ import annotations

from typing import Any

import pytest

from building_samples import everything, room
from mascarin.building.parts.site import Site, utc_offset_minutes
from mascarin.errors import InputError


@pytest.mark.parametrize(
    ("text", "minutes"),
    [
        ("UTC", 0),
        ("UTC+4", 240),
        ("UTC-03:30", -210),
        ("UTC+14", 840),
        ("UTC+15", None),
        ("UTC+5:75", None),
        ("UTC4", None),
        ("+4", None),
        ("Europe/Paris", None),
    ],
)
def test_fixed_offsets(text: str, minutes: int | None) -> None:
    assert utc_offset_minutes(text) == minutes


@pytest.mark.parametrize("zone", ["Indian/Reunion", "UTC+4", "UTC", "America/Denver"])
def test_valid_time_zones(zone: str) -> None:
    assert room().replace({"site.timezone": zone}).site.timezone == zone


@pytest.mark.parametrize("zone", ["", "Paris", "UTC+25", "local", "/etc/localtime", "Europe"])
def test_invalid_time_zones(zone: str) -> None:
    with pytest.raises(InputError, match="IANA time zone"):
        room().replace({"site.timezone": zone})


def test_every_default_of_the_site_has_a_source() -> None:
    for building in everything():
        for parameter in building.parameters():
            if parameter.path.startswith(("site.sky", "site.cloud", "site.wind", "site.ground")):
                assert parameter.source or parameter.path == "site.sky.depression", parameter.path


@pytest.mark.parametrize(
    ("site", "kind"),
    [
        ({}, "layer"),
        ({"sky": "martin_berdahl"}, "layer"),
        ({"sky": {"kind": "martin_berdahl", "a": 0.758}}, "layer"),
        ({"sky": "brunt"}, "factor"),
        ({"cloud": {"c1": 0.02}}, "factor"),
        ({"cloud": {"base": 800}}, "layer"),
        ({"cloud": "factor"}, "factor"),
        ({"sky": "brunt", "cloud": "layer"}, "layer"),
    ],
)
def test_the_effect_of_clouds_follows_the_model_of_the_sky(site: dict[str, Any], kind: str) -> None:
    place = {"latitude": 48, "longitude": 2, "altitude": 0, "timezone": "UTC"}
    found = Site(**place, **site)
    assert found.cloud.kind == kind
    assert Site(**found.to_dict()) == found
    assert ("cloud" in found.to_dict()) == ("cloud" in site)


def test_another_sky_takes_its_own_clouds() -> None:
    assert room().site.cloud.kind == "layer"
    assert room().replace({"site.sky": "clark_allen"}).site.cloud.kind == "factor"
