"""Parameters: paths, short forms of paths, replacement."""

from __future__ import annotations

import pytest

from building_samples import EVERYTHING, everything, room
from mascarin.building.reading import parse
from mascarin.errors import InputError


def test_a_parameter_has_range_limits_and_source() -> None:
    parameter = everything()[0].parameter("site.altitude")
    assert (parameter.value, parameter.unit, parameter.low, parameter.high) == (55.0, "m", 40.0, 70.0)
    assert (parameter.lower, parameter.upper) == (-500.0, 9000.0)
    assert parameter.source == "a map"
    assert parameter.description.startswith("Altitude")
    assert parameter.range_reason == "given in the description"
    assert not parameter.structural
    assert parameter.varies


def test_the_source_of_a_part_is_that_of_its_numbers() -> None:
    assert room().parameter("materials.concrete.density").source == "a table"


def test_paths_are_unique_and_ranges_contain_the_value() -> None:
    for building in everything():
        parameters = building.parameters()
        assert len({parameter.path for parameter in parameters}) == len(parameters)
        for parameter in parameters:
            assert parameter.lower <= parameter.low <= parameter.value <= parameter.high <= parameter.upper
            assert parameter.unit
            assert parameter.description
            assert parameter.structural <= (parameter.reason is not None)
            assert parameter.low < parameter.high or parameter.reason, parameter.path


def test_a_range_without_width_has_a_reason() -> None:
    building = room().replace({"surfaces.south.inside.convection": 0})
    parameter = building.parameter("surfaces.south.inside.convection.coefficient")
    assert parameter.reason == "its default range has no width: give a range"
    assert not parameter.varies


def test_structural_parameters_have_a_reason() -> None:
    structural = {p.path: p.reason for p in everything()[0].parameters() if p.structural}
    assert structural["site.latitude"] == "acts through the position of the sun in the forcing"
    for path in (
        "surfaces.roof.vertices.2.2",
        "constructions.wall.layers.concrete.nodes",
        "materials.curve.law.enthalpies.3",
        "materials.curve.law.melting_range.0",
        "zones.attic.view_factors.roof.ceiling",
    ):
        assert structural[path]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("constructions.wall.layers.concrete.conductivity", "materials.concrete.conductivity"),
        ("constructions.ceiling.layers.wax.conductivity.solid", "materials.wax.conductivity.solid"),
        ("constructions.ceiling.layers.wax.law.gamma", "materials.wax.law.gamma"),
        ("constructions.wall.layers.lining.density", "materials.concrete.density"),
        ("surfaces.west.inside.convection", "surfaces.west.inside.convection.coefficient"),
        ("zones.attic.infiltration", "zones.attic.infiltration.constant"),
        ("surfaces.floor.outside.ground.temperature", "surfaces.floor.outside.ground.mean"),
    ],
)
def test_short_forms_of_a_path(written: str, meant: str) -> None:
    building = everything()[0]
    assert building.parameter(written).path == meant
    value = building.parameter(meant).value * 1.01
    assert building.replace({written: value}).parameter(meant).value == value


@pytest.mark.parametrize(
    "path", ["materials.concrete.conductivty", "nothing", "", "site", "materials..density"]
)
def test_an_unknown_path_names_the_nearest(path: str) -> None:
    with pytest.raises(InputError, match="found no such parameter") as caught:
        room().parameter(path)
    if path.startswith("materials.concrete"):
        assert "Did you mean 'materials.concrete.conductivity'" in str(caught.value)


def test_replacing_gives_another_building() -> None:
    before = room()
    after = before.replace({"materials.concrete.conductivity": 2.0, "surfaces.south.area": 12})
    assert (before.parameter("surfaces.south.area").value, after.parameter("surfaces.south.area").value) == (
        16,
        12,
    )
    assert after.parameter("materials.concrete.conductivity").value == 2.0
    assert after.parameter("materials.concrete.density") == before.parameter("materials.concrete.density")


def test_a_replaced_number_keeps_its_range() -> None:
    after = everything()[0].replace({"site.altitude": 90})
    assert (after.parameter("site.altitude").low, after.parameter("site.altitude").high) == (40.0, 70.0)


def test_derived_values_follow_structure_and_not_parameters() -> None:
    """A sweep varies one number at a time, and a replacement must do the same."""
    building = parse(EVERYTHING, "x")
    perimeter, length = "surfaces.roof.outside.convection.perimeter", "surfaces.ceiling.inside.convection"
    assert building.replace({"surfaces.roof.area": 5}).parameter(perimeter) == building.parameter(perimeter)
    flat = building.replace(
        {"surfaces.roof.vertices.2.2": 3.0, "surfaces.roof.vertices.3.2": 3.0}
        | {f"windows.light.vertices.{corner}.2": 3.0 for corner in range(4)}
    )
    assert flat.parameter("surfaces.roof.area").value == pytest.approx(9.0)
    assert flat.parameter("surfaces.roof.tilt").value == pytest.approx(0.0)
    assert flat.parameter(perimeter).value == pytest.approx(12.0)
    other = building.replace({length: "alamdari_hammond"})
    assert other.parameter(f"{length}.length").value == pytest.approx(3.0)


def test_none_removes_a_key() -> None:
    wide = room().replace({"surfaces.south.outside.area_factor": 1.2})
    assert (
        wide.replace({"surfaces.south.outside.area_factor": None}).to_engine().json == room().to_engine().json
    )


def test_a_whole_part_may_be_replaced() -> None:
    building = room().replace({"surfaces.south.outside.convection": {"kind": "tarp", "roughness": "smooth"}})
    assert building.parameter("surfaces.south.outside.convection.roughness").value == 1.11
    assert (
        room().replace({"surfaces.south.outside.area_factor": 1.1}).surfaces["south"].outside.area_factor
        == 1.1
    )
    assert (
        room().replace({"zones.room.longwave": "linearised"}).parameter("zones.room.longwave.reference").value
        == 20
    )
    assert room().replace({"surfaces.south.outside.convection": 20}).parameter(
        "surfaces.south.outside.convection.coefficient"
    ).value == 20.0  # fmt: skip


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"materials.concrete.density": -1}, "materials.concrete.density"),
        ({"materials.concrete.density": float("nan")}, "nan"),
        ({"sensors.core.depth": 0.5}, "at most 0.2 m"),
        ({"surfaces.south.colour": 1}, "found no such parameter"),
        (
            {"zones.attic": {"volume": 3, "gains": {"lamp": {"power": 5, "radiative": 0.5}}}},
            "0.5 in a zone that no surface faces",
        ),
        ({"surfaces.south.outside.convection": "trap"}, "Did you mean 'tarp'"),
    ],
)
def test_a_replacement_is_checked_like_a_file(values: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        room().replace(values)
