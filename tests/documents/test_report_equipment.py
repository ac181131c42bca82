"""The model section of a report has all that a building states.

Every key of every building of the crossing tests is left out once: the words of the section change, or the
key stands in `LEFT_OUT` with the reason. A section that no building has fails
`test_crossing.test_every_section_and_output_kind_belongs_to_a_feature`.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from fnmatch import fnmatchcase
from typing import Any, Final

import pytest

from crossing_features import FEATURES, building, description
from mascarin.building import Building
from mascarin.building.parts.description import Description
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.sections import model
from mascarin.study.results.document.building import building_entry
from mascarin.study.results.document.equipment import SECTIONS, equipment
from mascarin.study_document.document import StudyDocument

#: Keys without words in the section, with the reason.
LEFT_OUT: Final = {
    "*.range": "ranges stand with the assumed values and with the parameters",
    "surfaces.*.absorptance": "numbers of a side stand in the description",
    "surfaces.*.emissivity": "numbers of a side stand in the description",
    "defaults.*": "what it fills in is shown where it acts, and a description may state it again",
    "site.sky.kind": "a sky with a formula is a sky as text in any case",
    "posterior.stated": "the same as the default",
}
#: Features whose sides come from `defaults`, which fill in what is left out.
BY_DEFAULTS: Final = {"boundaries and densities": "surfaces.*"}


def words(described: dict[str, Any]) -> str:
    return building_entry(Building.from_dict(described)).model_dump_json()


def paths(node: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*path, key)
            yield from paths(value, (*path, key))


def without(tree: dict[str, Any], path: tuple[str, ...]) -> dict[str, Any]:
    rest = copy.deepcopy(tree)
    node = rest
    for key in path[:-1]:
        node = node[key]
    del node[path[-1]]
    return rest


def test_every_section_has_rows_or_a_place_of_its_own() -> None:
    assert set(SECTIONS) == set(Description.model_fields), (
        "a section of a building that the report does not know: give its parts a word in SECTIONS of "
        "equipment.py, or rows in _of_building, or say in SECTIONS by an empty word that another table has it"
    )


@pytest.mark.parametrize("feature", FEATURES)
def test_every_key_of_a_building_has_words(feature: str) -> None:
    tree = description(feature)
    stated, silent = words(tree), []
    compared = 0
    for path in paths(tree):
        try:
            other = words(without(tree, path))
        except InputError:
            continue  # a building without it is none
        compared += 1
        key = ".".join(path)
        excused = (*LEFT_OUT, *([BY_DEFAULTS[feature]] if feature in BY_DEFAULTS else []))
        if other == stated and not any(fnmatchcase(key, pattern) for pattern in excused):
            silent.append(key)
    assert compared > 3
    assert silent == []


def test_the_page_has_every_row() -> None:
    for feature in FEATURES:
        entry = building_entry(building(feature))
        shown = model.content(StudyDocument(building=entry), Series("2001-07-02T00:00", 3600.0, {}))
        assert shown is not None
        assert len(shown["equipment"]) == len(entry.equipment)


def test_units_and_heat_sources_have_rows() -> None:
    changed = box().replace(
        {
            "ventilation_units": {"fan": {"supply": {"room": 0.01}, "exhaust": {"room": 0.01}}},
            "constructions.facade": {
                "layers": [
                    {"material": "concrete", "thickness": 0.1},
                    {"material": "concrete", "thickness": 0.1, "name": "inner"},
                ]
            },
            "surfaces.facade.construction": "facade",
            "heat_sources": {"foil": {"surface": "facade", "after": "concrete", "electric": {"power": 50}}},
        }
    )
    rows = dict(equipment(changed))
    assert (
        rows["ventilation unit fan"] == "supply to room (flow 0.01 m3/s), exhaust from room (flow 0.01 m3/s)"
    )
    assert rows["heat source foil"] == "electric, in facade after concrete, power 50 W/m2"


@pytest.mark.parametrize(
    ("feature", "row", "expected"),
    [
        ("controls", "control warmth", "zone room, indoor (open 27 degC, close 25 degC)"),
        ("controls", "vent grille", "0.05 m2 between room and hall, elevation 1 m"),
        ("controls", "infiltration of room", "constant 0.5 1/h, schedule half, control mild"),
        ("openings", "opening slit", "0.02 m2 of room to outdoors, height 0.5 m"),
        ("loads", "cooling of room", "ideal, setpoint 25 degC, capacity 1500 W"),
        (
            "thermal bridges",
            "thermal bridge corner of room",
            "to outdoors, psi 0.1 W/(m K), length 3 m, dimensions internal, excess: south 0.2 m2",
        ),
        ("humidity", "humidity of room",
         "vapour balance, gains: people 60 W, drying relative humidity 0.6, humidifying (relative humidity "
         "0.4, capacity 50 W)"),
        ("blinds", "schedule noon", "fraction, profiles of days from 0 to 1"),
        ("weather errors", "weather",
         "clock 120 s, columns: radiation gain 1.03, air_temperature offset -0.3"),
        ("shades", "shade overhang", "4 vertices"),
        ("measured columns", "outside of south",
         "longwave linearised (reference 25 degC), irradiance G_south"),
    ],
)  # fmt: skip
def test_rows_read_as_words(feature: str, row: str, expected: str) -> None:
    assert dict(equipment(building(feature)))[row] == expected
