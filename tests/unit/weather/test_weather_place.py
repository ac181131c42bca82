from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from mascarin.errors import InputError
from mascarin.weather import Climate, Place
from mascarin.weather.checks.place_check import require_place


@dataclass(frozen=True)
class Site:
    """Place of a building."""

    latitude: float = 39.83
    longitude: float = -104.65
    altitude: float = 1650.0
    timezone: str = "America/Denver"


@pytest.fixture(scope="module")
def denver(data_dir: Path) -> Climate:
    return Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw")


@pytest.mark.parametrize(
    "site",
    [
        Site(),
        Site(latitude=41.0, longitude=-103.0, altitude=1300.0),
        Site(timezone="UTC-7"),
        Site(timezone="America/Phoenix"),
        Site(longitude=255.35),
    ],
)
def test_the_same_region_passes(denver: Climate, site: Site) -> None:
    require_place(denver.record, site)


@pytest.mark.parametrize(
    ("site", "words"),
    [
        (
            Site(latitude=-39.83),
            r"^725650TYCST.epw: the weather is of latitude 39.83 deg \(DENVER.*\), the building is at "
            r"latitude -39.83 deg \(opposite sign\).*Correct site: latitude in",
        ),
        (Site(longitude=104.65), "longitude 104.65 deg .opposite sign"),
        (Site(longitude=-108.0), "longitude -108 deg; expected a difference of at most 2 deg"),
        (Site(altitude=165.0), "altitude 1650 m .*, the building is at altitude 165 m; .* at most 500 m"),
        (Site(timezone="UTC+4"), r"clock is UTC-7 .*time zone is UTC\+4 .*expected the same winter time"),
        (Site(timezone="Europe/Paris"), r"Europe/Paris \(winter time UTC\+1\).*Correct site: timezone"),
    ],
)
def test_another_place_is_refused_and_both_are_named(denver: Climate, site: Site, words: str) -> None:
    with pytest.raises(InputError, match=words):
        denver.forcing(site, "2001-01-01", "2001-01-02", 3600.0)


def test_weather_from_elsewhere_can_be_wanted(data_dir: Path) -> None:
    path = data_dir / "bestest" / "725650TYCST.epw"
    moved = Climate.from_epw(path, elsewhere=True)
    site = Site(latitude=36.0, longitude=-106.0, altitude=500.0, timezone="America/Chicago")
    assert moved.forcing(site, "2001-01-01", "2001-01-02", 3600.0).shape[0] == 24
    with pytest.raises(InputError, match="elsewhere=True"):
        Climate.from_epw(path).forcing(site, "2001-01-01", "2001-01-02", 3600.0)


def test_a_table_is_checked_by_its_stated_place(denver: Climate) -> None:
    table = replace(denver.record, of_year=False, site=Place(39.83, -104.65))
    # Its clock may be any, and an altitude that was not stated is not compared.
    require_place(table, Site(timezone="UTC"))
    with pytest.raises(InputError, match="or the latitude given with the table"):
        require_place(table, Site(latitude=-39.83))
    require_place(replace(table, site=None), Site(latitude=-39.83))


def test_places_on_either_side_of_the_date_line_are_near(denver: Climate) -> None:
    fiji = replace(denver.record, site=Place(-17.0, 179.5, 1650.0))
    require_place(fiji, Place(-17.0, -179.5, 1650.0))
