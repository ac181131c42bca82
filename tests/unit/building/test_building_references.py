"""Sources of a building."""

from __future__ import annotations

from building_samples import ROOM, everything, room
from mascarin.building import Building
from mascarin.building.reading import parse


def cites(building: Building, *words: str) -> list[bool]:
    return [any(word in source for source in building.sources()) for word in words]


def test_numbers_and_correlations_are_cited_once() -> None:
    found = everything()[0].sources()
    assert {"a table", "a map"} <= set(found)
    assert cites(everything()[0], "Alamdari", "Walton", "Yazdanian", "Guichard", "ASHRAE") == [True] * 5
    assert len(set(found)) == len(found)
    assert cites(room(), "Alamdari", "Yazdanian", "Guichard", "ASHRAE", "WMO-No. 8") == [False] * 5


def test_remarks_are_no_sources() -> None:
    remarks = ("not given", "no furniture", "as published", "as it is", "vertices", "of a square")
    for building in (room(), *everything()):
        assert cites(building, *remarks) == [False] * len(remarks)


def test_of_an_assumed_number_only_a_publication_is_cited() -> None:
    def beside(text: str) -> list[str]:
        noted = f'specific_heat: {{value: 900, assumed: true, source: "{text}"}}'
        return parse(ROOM.replace("specific_heat: 900", noted), "x").sources()

    assert "light board, colour unknown" not in beside("light board, colour unknown")
    assert "no wind was measured: calm to 6 m/s" not in beside("no wind was measured: calm to 6 m/s")
    for text in ("glass, EN 673", "Walton 1983", "paper, table 2", "the maker's data sheet"):
        assert text in beside(text)


def test_only_active_numbers_and_methods_are_cited() -> None:
    """No surface exchanges with the sky, no irradiance comes from the climate, one material is not used."""
    measured = parse(ROOM.replace("absorptance: 0.6", "absorptance: 0.6, irradiance: G"), "x")
    assert cites(measured, "Reda", "Perez", "Kasten", "Liu & Jordan", "Kopp") == [False] * 5
    blind = parse(ROOM.replace("absorptance: 0.6", "absorptance: 0.6, longwave: none"), "x")
    assert cites(blind, "Martin & Berdahl", "Clark", "horizon", "Perez") == [False, False, False, True]
    spare = "  spare: {conductivity: 1, density: 1000, specific_heat: 1000, source: an atlas}\nconstructions:"
    assert not any(cites(parse(ROOM.replace("constructions:", spare), "x"), "an atlas"))
    placed = ROOM.replace("latitude: 48", 'latitude: {value: 48, source: "an atlas"}')
    assert cites(parse(placed, "x"), "an atlas") == [True]
    shaded = placed.replace("absorptance: 0.6", "absorptance: 0.6, irradiance: G")
    assert cites(parse(shaded, "x"), "an atlas") == [False]


def test_the_sun_is_cited_with_the_model_chosen() -> None:
    words = ("Reda", "Perez", "Kasten", "Hay & Davies", "Kopp")
    assert cites(room(), *words) == [True, True, True, False, True]
    assert cites(room().replace({"site.diffuse": "hay_davies"}), *words) == [True, False, False, True, True]
    isotropic = room().replace({"site.diffuse": "isotropic"})
    assert cites(isotropic, *words) == [True, False, False, False, False]
    assert cites(isotropic, "Liu & Jordan 1963, doi:10.1016/0038-092X(63)90006-9 (diffuse") == [True]


def test_the_sky_is_cited_with_its_clouds() -> None:
    words = (
        "Martin & Berdahl",
        "Clark & Allen",
        "Brunt",
        "eq. 6 (vapour pressure",
        "Li, Jiang",
        "ISO 13790",
        "horizon",
    )
    expected = {
        "martin_berdahl": [True, False, False, False, False, False, True],
        "clark_allen": [False, True, False, False, False, False, True],
        "brunt": [False, True, True, True, True, False, True],
        "offset": [False, False, False, False, False, True, True],
        "measured": [False, False, False, False, False, False, True],
    }
    for kind, cited in expected.items():
        assert cites(room().replace({"site.sky": kind}), *words) == cited, kind
    factor = room().replace({"site.cloud": "factor"})
    assert cites(factor, "Martin & Berdahl", "Clark & Allen") == [True, True]


def test_a_sky_model_with_other_coefficients_is_still_cited() -> None:
    sky = {"kind": "martin_berdahl", "a": {"value": 0.76, "source": "a pyrgeometer"}}
    assert cites(room().replace({"site.sky": sky}), "a pyrgeometer", "Martin & Berdahl 1984") == [True, True]


def test_zones_are_cited_with_their_exchange() -> None:
    assert cites(room(), "Hottel", "Carroll", "Sparrow", "ICAO") == [True, True, False, True]
    assert cites(room().replace({"zones.room.longwave": "none"}), "Hottel", "Carroll") == [False, False]
    assert cites(room().replace({"site.air_density": 1.2}), "ICAO") == [False]


def test_methods_of_time_and_of_curves() -> None:
    assert cites(room(), "Alexander 1977", "Fritsch") == [True, False]
    assert cites(everything()[0], "Fritsch & Butland 1984") == [True]
    lined = everything()[0].replace({"constructions.ceiling.layers.curve.material": "wax"})
    assert cites(lined, "Fritsch") == [False]
