"""Buildings from objects, to and from files and mappings; how they are shown."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

import mascarin as mc
from building_samples import EVERYTHING, everything, room
from mascarin.building.parts.materials.phase_change import TableLaw
from mascarin.building.reading import parse
from mascarin.errors import InputError
from strategies_building import descriptions

b = mc.building


def cell(**changes: Any) -> mc.Building:
    """A closed room made from objects."""
    outdoors = b.Side(outdoors=True, convection="tarp", emissivity=0.9, absorptance=0.6)
    parts: dict[str, Any] = {
        "name": "cell",
        "site": b.Site(latitude=48, longitude=2, altitude=100, timezone="Europe/Paris"),
        "materials": {
            "concrete": b.Solid(conductivity=1.75, density=2240, specific_heat=900),
            "pcm": b.PhaseChangeMaterial.from_product("RT25HC"),
        },
        "constructions": {
            "wall": b.Construction(
                layers=[
                    b.Layer(material="concrete", thickness=0.2),
                    b.Layer(name="lining", material="pcm", thickness=0.01),
                ]
            )
        },
        "zones": {"room": b.Zone(volume=30, infiltration=0.5)},
        "surfaces": {
            "south": b.Surface(
                construction="wall",
                area=16,
                tilt=90,
                azimuth=180,
                outside=outdoors,
                inside=b.Side(zone="room", convection=3, emissivity=0.9),
            )
        },
    }
    return mc.Building(**(parts | changes))


def notes(building: mc.Building) -> list[tuple[Any, ...]]:
    return [(p.path, p.value, p.low, p.high, p.source, p.assumed, p.reason) for p in building.parameters()]


def test_objects_make_the_same_building_as_a_file() -> None:
    text = """
name: cell
site: {latitude: 48, longitude: 2, altitude: 100, timezone: Europe/Paris}
materials: {concrete: {conductivity: 1.75, density: 2240, specific_heat: 900}, pcm: {product: RT25HC}}
constructions:
  wall: {layers: [{material: concrete, thickness: 0.2}, {name: lining, material: pcm, thickness: 0.01}]}
zones: {room: {volume: 30, infiltration: 0.5}}
surfaces:
  south:
    {construction: wall, area: 16, tilt: 90, azimuth: 180,
     outside: {outdoors: true, convection: tarp, emissivity: 0.9, absorptance: 0.6},
     inside: {zone: room, convection: 3, emissivity: 0.9}}
"""
    assert cell() == parse(text, "cell.yaml")
    assert notes(cell()) == notes(parse(text, "cell.yaml"))


def test_a_part_that_is_used_in_two_buildings_derives_again() -> None:
    """The perimeter follows from the area of the surface in each building."""
    path = "surfaces.south.outside.convection.perimeter"
    assert cell().parameter(path).value == pytest.approx(16.0)
    wall = cell().surfaces["south"]
    smaller = cell(surfaces={"south": b.Surface(**{**wall.to_dict(), "area": 9})})
    assert smaller.parameter(path).value == pytest.approx(12.0)
    assert cell(surfaces={"south": wall}) == cell()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: b.Zone(volume=-1), "Zone: volume\n  found: -1"),
        (lambda: b.Zone(volum=1), "Did you mean 'volume'"),  # type: ignore[call-arg]
        (lambda: b.Site(latitude=48, longitude=2, altitude=0, timezone="Paris"), "Europe/Paris"),
        (lambda: cell(zones={}), "expected: the name of a zone under 'zones:'"),
        (lambda: cell(materials={}), "expected: the name of a material"),
        (lambda: mc.Building.from_dict({"name": "x"}), "x: site\n  found: nothing"),
        (lambda: mc.Building.from_dict("x.yaml"), "Read files with Building.from_yaml"),  # type: ignore[arg-type]
        (lambda: room().check("soon"), "expected a positive time"),
    ],
)
def test_errors_say_where_and_what(make: Any, message: str) -> None:
    with pytest.raises(mc.InputError) as caught:
        make()
    assert message in str(caught.value)


@settings(max_examples=25, deadline=None)
@given(descriptions())
def test_any_description_survives_yaml_and_mappings(description: dict[str, Any]) -> None:
    building = mc.Building.from_dict(description)
    for again in (mc.Building.from_dict(building.to_dict()), parse(building.to_yaml(), "again.yaml")):
        assert again == building
        assert notes(again) == notes(building)
        assert again.to_dict() == building.to_dict()


@pytest.mark.parametrize("index", range(3))
def test_every_kind_of_part_survives_yaml(index: int, tmp_path: Path) -> None:
    building = everything()[-1 - index]
    file = tmp_path / "everything.yaml"
    assert building.to_yaml(file) == file.read_text(encoding="utf-8")
    again = mc.load(file)
    assert again == building
    assert notes(again) == notes(building)
    assert again.to_engine().json == building.to_engine().json
    assert again.check() == building.check()


def test_derived_values_are_written_only_where_they_no_longer_follow() -> None:
    """A sweep over the area leaves the perimeter as it was, and so does a replaced value, saved or not."""
    path = "surfaces.south.outside.convection.perimeter"
    assert cell().to_dict()["surfaces"]["south"]["outside"]["convection"] == "tarp"
    larger = cell().with_values({"surfaces.south.area": 25})
    assert larger.parameter(path).value == pytest.approx(16.0)
    again = mc.Building.from_dict(larger.to_dict())
    assert again.parameter(path).value == pytest.approx(16.0)
    assert again == larger


def test_a_replaced_product_melts_as_that_product() -> None:
    other = cell().replace({"materials.pcm.product": "RT21HC"})
    assert other == cell(materials=cell().materials | {"pcm": b.PhaseChangeMaterial.from_product("RT21HC")})
    before, after = cell().materials["pcm"], other.materials["pcm"]
    assert isinstance(before, b.PhaseChangeMaterial)
    assert isinstance(after, b.PhaseChangeMaterial)
    assert after.melting[1] < before.melting[1]
    assert other.to_engine().json != cell().to_engine().json
    assert "RT21HC" in str(other.parameter("materials.pcm.law.enthalpies.3").source)


def test_what_was_given_beside_a_product_stays_when_the_product_is_replaced() -> None:
    given = {"materials.pcm.density.solid": 850, "materials.pcm.law.temperature_shift": 0.5}
    first = cell().with_values(given)
    later = first.replace({"materials.pcm.product": "RT21HC"})
    together = cell().replace({"materials.pcm.product": "RT21HC", **given})
    assert later == together
    assert later.parameter("materials.pcm.density.solid").value == 850
    assert later.parameter("materials.pcm.law.temperature_shift").value == 0.5
    law, own = later.materials["pcm"], b.PhaseChangeMaterial.from_product("RT21HC")
    assert isinstance(law, b.PhaseChangeMaterial)
    assert isinstance(law.law, TableLaw)
    assert isinstance(own.law, TableLaw)
    assert law.law.enthalpies == own.law.enthalpies
    assert later.to_dict()["materials"]["pcm"] == {
        "product": "RT21HC",
        "density": {"solid": 850},
        "law": {"temperature_shift": 0.5},
    }


def test_a_replaced_terrain_gives_its_wind_profile() -> None:
    open_, city = room(), room().replace({"site.wind.terrain": "city"})
    path = "site.wind.exponent"
    assert (open_.parameter(path).value, city.parameter(path).value) == (0.14, 0.33)


def test_a_value_that_was_not_given_can_be_replaced() -> None:
    building = room().with_values({"site.sky.a": 0.7, "site.cloud.base": 900})
    assert building.parameter("site.sky.a").value == 0.7
    assert building.to_dict()["site"]["sky"] == {"kind": "martin_berdahl", "a": 0.7}


def test_a_layer_keeps_its_name_when_its_material_is_replaced() -> None:
    building = parse(EVERYTHING, "x").replace({"constructions.ceiling.layers.curve.material": "wax"})
    assert [layer.name for layer in building.constructions["ceiling"].layers] == ["wax", "salt", "curve"]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"zones.room.volume": "tarp"}, "expected a number"),
        ({"zones.room.longwave": 1}, "found no such parameter"),
        ({"zones.room.volume": -1}, "Volume of air"),
    ],
)
def test_values_are_numbers_of_parameters(values: dict[str, Any], message: str) -> None:
    with pytest.raises(mc.InputError, match=message):
        room().with_values(values)


def test_a_part_and_what_is_in_it_cannot_be_replaced_together() -> None:
    film = "surfaces.south.outside.convection"
    with pytest.raises(mc.InputError, match="Give either the part or what is inside it"):
        room().replace({film: "tarp", f"{film}.coefficient": 2.0})


def test_objects_can_replace_parts() -> None:
    building = room().replace({"surfaces.south.outside.convection": b.Tarp(factor=1.2)})
    assert building.parameter("surfaces.south.outside.convection.factor").value == 1.2
    assert building.parameter("surfaces.south.outside.convection.perimeter").value == pytest.approx(16.0)


def test_buildings_and_parts_are_shown_in_short() -> None:
    building = everything()[0]
    assert repr(building).splitlines()[0] == "Building 'everything'"
    for shown in (repr(building), str(building), *map(str, building.zones.values())):
        assert len(shown.splitlines()) <= 15
    for part in (*building.zones.values(), *building.materials.values(), *building.surfaces.values()):
        assert len(repr(part)) <= 100
    assert "30 m3" in str(room().zones["room"])
    page = building._repr_html_()
    assert page.count("<details>") == 4
    assert "<script" not in parse(EVERYTHING.replace("name: everything", "name: <script>"), "x")._repr_html_()


def test_completion_lists_fields_and_methods_only() -> None:
    names = dir(room())
    assert {"site", "zones", "replace", "with_values", "to_yaml", "check"} <= set(names)
    assert not [
        name for name in names if name.startswith(("_", "model_")) or name in ("json", "copy", "dict")
    ]
    assert {"volume", "infiltration", "to_dict"} <= set(dir(room().zones["room"]))
    # The same before there is an object: ``mc.Building.`` and the tab key.
    assert dir(mc.Building) == names
    assert dir(b.Zone) == dir(room().zones["room"])


def test_equal_buildings_are_the_same_key() -> None:
    building = everything()[0]
    again = mc.Building.from_dict(building.to_dict())
    larger = building.with_values({"zones.room.volume": 41.5})
    assert len({building, again, larger}) == 2
    assert {building: "found"}[again] == "found"
    turned = building.to_dict()
    turned["materials"] = dict(reversed(turned["materials"].items()))
    other = mc.Building.from_dict(turned)
    assert other == building
    assert hash(other) == hash(building)


def test_lists_of_parameters_and_outputs_are_short_and_become_tables() -> None:
    building = everything()[0]
    for listing in (building.parameters(), building.outputs()):
        lines = repr(listing).splitlines()
        assert len(lines) <= 15
        assert lines[0].startswith(f"{len(listing)} ")
        assert listing._repr_html_().startswith("<div>")
        table = listing.to_dataframe()
        assert len(table) == len(listing)
        assert repr(pickle.loads(pickle.dumps(listing))) == repr(listing)  # noqa: S301
    table = building.parameters().to_dataframe()
    for parameter in building.parameters():
        row = table.loc[parameter.path]
        assert (row["value"], row["unit"], row["low"]) == (parameter.value, parameter.unit, parameter.low)
    assert building.outputs().to_dataframe().loc["room.air_temperature", "unit"] == "degC"


def test_a_docstring_has_its_sections_in_the_order_of_numpydoc() -> None:
    text = mc.Building.__doc__ or ""
    places = [text.index(f"\n{name}\n---") for name in ("Parameters", "Raises", "Examples")]
    assert places == sorted(places)


def test_a_step_of_another_type_is_refused() -> None:
    with pytest.raises(
        InputError, match=r"step: found \[\]; expected a positive time such as 900, 15min or 1h"
    ):
        room().check([])  # type: ignore[arg-type]


def test_pickled_buildings_keep_their_notes() -> None:
    building = everything()[0]
    again = pickle.loads(pickle.dumps(building))  # noqa: S301
    assert again == building
    assert notes(again) == notes(building)
    assert again.to_engine().json == building.to_engine().json


def test_every_exported_part_describes_its_fields() -> None:
    for name in b.__all__:
        text = getattr(b, name).__doc__
        assert text, name
        fields = getattr(getattr(b, name), "model_fields", {})
        for field in fields.keys() - {"kind"}:
            assert f"\n{field} : " in text, (name, field)


def test_mappings_of_a_building_cannot_be_changed() -> None:
    building = cell()
    before = building.to_dict()
    changes: list[Callable[[dict[str, Any]], object]] = [
        lambda names: names.__setitem__("x", 1),
        lambda names: names.__delitem__(next(iter(names))),
        lambda names: names.__ior__({"x": 1}),
        lambda names: names.update(x=1),
        lambda names: names.setdefault("x", 1),
        lambda names: names.pop(next(iter(names))),
        lambda names: names.popitem(),
        lambda names: names.clear(),
    ]
    mappings: list[Any] = [getattr(building, name) for name in type(building).model_fields]
    mappings += [next(iter(building.zones.values())).gains]
    mappings = [mapping for mapping in mappings if isinstance(mapping, dict)]
    assert len(mappings) > 5
    for mapping in mappings:
        for change in changes if mapping else changes[:1]:
            with pytest.raises(InputError, match="immutable"):
                change(mapping)
    assert building.to_dict() == before
    for again in (copy.deepcopy(building), pickle.loads(pickle.dumps(building))):  # noqa: S301
        assert again == building
        with pytest.raises(InputError, match="immutable"):
            again.materials.clear()
    # What is made of a mapping is one's own.
    assert {**building.zones, "x": None}.keys() - building.zones.keys() == {"x"}
