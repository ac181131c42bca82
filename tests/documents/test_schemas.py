"""JSON Schemas of studies and designs: what is shipped is valid, and mistakes are found in an editor."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from mascarin import cli, examples
from mascarin.building import json_schema
from mascarin.building.files.yaml_document import plain
from mascarin.design.schema import design_schema
from mascarin.study.file.schema import study_schema

SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "building": json_schema, "study": study_schema, "design": design_schema
}  # fmt: skip
LGI = "lgi/study.yaml"
HOUSE = "reunion_house/design.yaml"
FILES = sorted(
    path.relative_to(examples.FOLDER).as_posix()
    for kind in ("study", "design")
    for path in examples.FOLDER.glob(f"*/{kind}.yaml")
)


@cache
def validator(kind: str) -> jsonschema.Draft202012Validator:
    schema = SCHEMAS[kind]()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def content(file: str) -> Any:
    return plain((examples.FOLDER / file).read_text(encoding="utf-8"), file)


def errors(file: str, content: Any) -> list[str]:
    return [error.json_path for error in validator(Path(file).stem).iter_errors(content)]


def changed(file: str, path: str, value: Any) -> Any:
    whole = content(file)
    *steps, last = path.split("/")
    part = whole
    for step in steps:
        part = part[int(step)] if isinstance(part, list) else part[step]
    if value is None:
        del part[last]
    else:
        part[last] = value
    return whole


@pytest.mark.parametrize("file", FILES)
def test_what_is_shipped_is_valid(file: str) -> None:
    assert {LGI, HOUSE, "twin_house/study.yaml", "wall_bench/study.yaml"} <= set(FILES)
    assert errors(file, content(file)) == []


@pytest.mark.parametrize(
    ("file", "path", "value"),
    [
        (LGI, "sensor", {}),  # a wrong key
        (LGI, "sensors/room_air/colum", "T"),
        (LGI, "sensors/room_air/expanded_uncertainty", -0.5),
        (LGI, "identification/method", "least-square"),
        (LGI, "periods/identification", ["2010-09-20"]),
        (LGI, "periods", None),
        (LGI, "step", [900]),
        (LGI, "criteria/0/metric", "rms"),
        (HOUSE, "objective", {}),
        (HOUSE, "search", {"method": "gride"}),
        (HOUSE, "climates", None),
        (HOUSE, "uncertainty/samples", 1),
    ],
)
def test_mistakes_are_found(file: str, path: str, value: Any) -> None:
    assert errors(file, changed(file, path, value))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("step", 900),
        ("periods/identification", [["2010-09-20", "2010-09-22"], ["2010-09-23", "2010-09-25"]]),
        ("measurements", {}),
        ("sensors/room_air/uncertainty", 0.5),
        ("comfort", {"room": {"index": "adaptive-ashrae", "category": 80}}),
        ("initial", {"zones": {"room": 25}}),
    ],
)
def test_other_ways_to_write_a_value_are_valid(path: str, value: Any) -> None:
    whole = changed(LGI, path, value)
    if path.endswith("/uncertainty"):
        del whole["sensors"]["room_air"]["expanded_uncertainty"]
    assert errors(LGI, whole) == []


def test_a_table_is_named_once() -> None:
    whole = changed(LGI, "climate/measured/table", None)
    assert errors(LGI, whole) == []
    del whole["measurements"]["table"]
    assert errors(LGI, whole)
    del whole["measurements"]
    assert errors(LGI, whole | {"climate": content(LGI)["climate"]}) == []
    assert errors(LGI, whole | {"climate": {"epw": "shipped:golden"}})


def test_a_file_that_extends_another_is_valid() -> None:
    assert errors(LGI, {"extends": "study.yaml", "step": "1h"}) == []


def keys(schema: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every key of a schema, without the conditions on several keys together."""
    if isinstance(schema, dict):
        for key, entry in schema.get("properties", {}).items():
            yield f"{path}.{key}", entry
            yield from keys(entry, f"{path}.{key}")
        for word, piece in schema.items():
            if word not in ("properties", "allOf"):
                yield from keys(piece, f"{path}/{word}")
    elif isinstance(schema, list):
        for piece in schema:
            yield from keys(piece, path)


@pytest.mark.parametrize("kind", SCHEMAS)
def test_every_key_has_a_description(kind: str) -> None:
    found = list(keys(validator(kind).schema))
    assert len(found) > 80
    assert [path for path, entry in found if not entry.get("description")] == []


def test_the_command_writes_the_schema(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "study.schema.json"
    assert cli.main(["schema", "study", "-o", str(file)]) == 0
    assert capsys.readouterr().out == ""
    assert cli.main(["schema", "study"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(file.read_text(encoding="utf-8"))
    assert cli.main(["schema", "design", "-o", str(tmp_path / "design.yaml")]) == 2
    assert "ends with .json" in capsys.readouterr().err
    assert cli.main(["schema", "studies"]) == 2
    assert "design" in capsys.readouterr().err
