"""The JSON Schema accepts what the reader accepts and refuses what it refuses."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import mascarin
from building_samples import EVERYTHING, ROOM, room
from mascarin.building import json_schema, parameter_table
from mascarin.building.reading import plain

EXAMPLES = sorted((Path(mascarin.__file__).parent / "examples").glob("*/building.yaml"))


@cache
def validator() -> jsonschema.Draft202012Validator:
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def errors(text: str) -> list[str]:
    return [error.json_path for error in validator().iter_errors(plain(text, "x"))]


def test_samples_are_valid_by_the_schema() -> None:
    assert errors(ROOM) == []
    assert errors(EVERYTHING) == []


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.parent.name)
def test_examples_are_valid_by_the_schema(path: Path) -> None:
    assert errors(path.read_text(encoding="utf-8")) == []
    assert mascarin.load(path).to_engine(900).paths


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("thickness: 0.2", "thickness: -0.2"),
        ("volume: 30", "volum: 30"),
        ("volume: 30", 'volume: "30 m3"'),
        ("convection: 15", "convection: {kind: trap}"),
        ("latitude: 48", "latitude: 91"),
        ("adiabatic: true", "adiabatic: false"),
    ],
)
def test_errors_are_found_by_the_schema(old: str, new: str) -> None:
    assert errors(ROOM.replace(old, new))


def numbers(node: Any) -> list[dict[str, Any]]:
    if isinstance(node, list):
        return [found for piece in node for found in numbers(piece)]
    if not isinstance(node, dict):
        return []
    # A part may have a key that is called unit, too.
    own = [node] if isinstance(node.get("unit"), str) else []
    return own + [found for piece in node.values() for found in numbers(piece)]


def test_every_number_of_the_schema_has_unit_meaning_and_range() -> None:
    found = numbers(json_schema())
    assert len(found) > 90
    for number in found:
        assert number["unit"]
        assert number["description"]
        assert number["default_range"]["reason"]


def test_defaults_are_in_the_schema() -> None:
    site = json_schema()["$defs"]["Site"]["properties"]
    assert site["ground_reflectance"]["default"] == 0.2
    assert json.dumps(json_schema())


def test_the_parameter_table() -> None:
    rows = parameter_table(room())
    assert len(rows) == len(room().parameters())
    row = next(row for row in rows if row["path"] == "zones.room.volume")
    assert (row["value"], row["unit"], row["low"], row["high"]) == (30.0, "m3", 28.5, 31.5)
