"""The description for the engine is complete: every number of the building, every number of the engine."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from building_samples import EVERYTHING, everything, room
from mascarin.building import json_schema
from mascarin.building.base.law_table import CONVECTION, IMPOSED, LEAKAGE, SKY
from mascarin.building.base.leaves import steps
from mascarin.building.base.number import Number
from mascarin.building.base.part import Part
from mascarin.building.parts.materials.formula import Formula
from mascarin.building.reading import parse
from mascarin.errors import InputError

# Keys of the border whose integers are no parameters.
STRUCTURAL = {
    "material",
    "nodes",
    "construction",
    "zone",
    "reference_zone",
    "surface",
    "channel",
    "irradiance",
    "schedule",
    "between",
    "from",
    "to",
    "continuity",
    "side",
    "control",
    "heat",
}


def described(building: Any) -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads(building.to_engine().json)
    return loaded


def ids(node: Any, key: str = "") -> Iterator[tuple[str, int]]:
    """Every parameter id in the description, with the key it stands under."""
    if isinstance(node, dict):
        for name, piece in node.items():
            if (name not in STRUCTURAL and name != "parameters") or isinstance(piece, dict):
                yield from ids(piece, name)
    elif isinstance(node, list):
        for piece in node:
            yield from ids(piece, key)
    elif isinstance(node, int) and not isinstance(node, bool):
        yield key, node


def test_every_parameter_is_an_id_of_the_engine_and_back() -> None:
    for building in everything():
        engine = building.to_engine()
        varying = [p.path for p in building.parameters() if not p.structural]
        assert engine.paths == varying
        # Errors of the weather change the forcing: the engine gets their values and does not use them.
        used = {at for at, path in enumerate(varying) if not path.startswith("weather.")}
        assert {index for _, index in ids(json.loads(engine.json))} == used


def test_paths_and_values_are_those_of_the_parameters() -> None:
    building = everything()[0]
    engine = building.to_engine()
    assert engine.values.dtype == np.float64
    assert dict(zip(engine.paths, engine.values, strict=True)) == {
        p.path: p.value for p in building.parameters() if not p.structural
    }
    stated = json.loads(engine.json)["parameters"]
    assert [entry["path"] for entry in stated] == engine.paths
    assert [entry["value"] for entry in stated] == list(engine.values)


def numeric_in_schema() -> set[tuple[str, str]]:
    """(Part, field) of every number in the JSON Schema."""

    def holds_number(node: Any) -> bool:
        if isinstance(node, dict):
            return "unit" in node or any(holds_number(piece) for piece in node.values())
        return isinstance(node, list) and any(holds_number(piece) for piece in node)

    found = set()
    for name, schema in json_schema()["$defs"].items():
        form = schema.get("anyOf", [schema])[0]  # parts with a short form have the mapping first
        found |= {(name, key) for key, value in form.get("properties", {}).items() if holds_number(value)}
    return found - {("Ground", "temperature")}  # a short way to write mean


def numeric_in(part: Any, owner: tuple[str, str] = ("", "")) -> Iterator[tuple[str, str]]:
    """(Part, field) of every number in a part."""
    if isinstance(part, Number):
        yield owner
        return
    for key, piece in steps(part):
        if isinstance(part, Formula) and key in part.numbers:
            continue  # numbers of a formula have names of the user
        yield from numeric_in(piece, (type(part).__name__, key) if isinstance(part, Part) else owner)


def test_every_number_of_the_schema_is_a_parameter_and_back() -> None:
    assert {place for building in everything() for place in numeric_in(building)} == numeric_in_schema()


def test_keys_are_those_of_the_engine(repository: Path) -> None:
    """Every field of the engine's description that holds parameters is filled by one of the samples."""
    folder = repository / "crates" / "engine" / "src" / "input" / "description"
    source = "\n".join(file.read_text(encoding="utf-8") for file in sorted(folder.glob("*.rs")))
    # A field that serde renames counts by its name in the JSON.
    source = re.sub(r'#\[serde\(rename = "(\w+)"\)\]\s*\w+:', r"\1:", source)
    fields = set(re.findall(r"(?:pub |\b)(\w+): (?:Option<|Vec<)*\[?ParamId", source))
    fields.add("cloud")  # its factor is a list of ids without names
    # Numbers of published laws have the names of the table.
    tables = (CONVECTION, IMPOSED, LEAKAGE, SKY)
    fields |= {number.name for table in tables for row in table.values() for number in row.numbers}
    assert {key for building in everything() for key, _ in ids(described(building))} == fields


def test_kinds_are_those_of_the_engine() -> None:
    building = described(everything()[0])
    assert [material["kind"] for material in building["materials"]] == [
        "solid",
        "resistance",
        "pcm",
        "pcm",
        "pcm",
        "rated",
    ]
    laws = [[m["law"] for m in described(b)["materials"][2:5]] for b in everything()]
    kinds = {tuple(law["kind"] for law in three) for three in laws}
    assert kinds == {
        ("melting", "melting", "tabulated"),
        ("melting", "melting", "melting"),
        ("history", "melting", "history"),
        ("history", "history", "melting"),
    }
    curves = [
        curve
        for three in laws
        for law in three
        for curve in ([law["curve"]] if "curve" in law else law.get("curves", []))
    ]
    assert {curve["kind"] for curve in curves} == {
        "tanh_gamma", "tanh_width", "smooth_step", "gaussian", "gumbel", "linear", "triangle", "fractions",
        "text",
    }  # fmt: skip
    assert [one["glazing"]["kind"] for one in building["constructions"] if "glazing" in one] == [
        "panes",
        "panes",
        "simple",
    ]
    assert [zone["longwave"]["kind"] for zone in building["zones"]] == ["radiosity", "linearised", "none"]
    facings = {side["facing"]["kind"] for s in building["surfaces"] for side in (s["outside"], s["inside"])}
    assert facings == {"outdoors", "zone", "imposed", "measured", "adiabatic"}


def test_references_are_positions() -> None:
    building = described(everything()[0])
    names = {key: [item["name"] for item in building[key]] for key in ("constructions", "zones", "surfaces")}
    ceiling = building["surfaces"][names["surfaces"].index("ceiling")]
    assert names["constructions"][ceiling["construction"]] == "ceiling"
    assert names["zones"][ceiling["inside"]["facing"]["zone"]] == "room"
    assert names["surfaces"][building["sensors"][0]["surface"]] == "west"
    assert building["channels"] == [
        *("T_out", "G_north", "T_face"),
        *("schedule day", "schedule always", "schedule cool", "schedule warm"),
    ]
    north = building["surfaces"][names["surfaces"].index("north")]["outside"]
    assert (north["facing"]["channel"], north["irradiance"]) == (0, 1)


def test_one_number_for_both_phases_is_one_parameter() -> None:
    salt, wax = described(everything()[0])["materials"][3], described(everything()[0])["materials"][2]
    assert len(set(salt["conductivity"])) == 1
    assert len(set(wax["conductivity"])) == 2


def test_view_weights_from_given_factors_are_reciprocal() -> None:
    building = parse(EVERYTHING, "x")
    attic = described(building)["zones"][1]["view_weights"]
    light = float(building.windows["light"].area or 0)
    roof, ceiling = float(building.surfaces["roof"].area or 0) - light - 1.0, 9.0
    assert attic[0][0] == attic[1][1] == 0.0
    assert attic[0][1] == attic[1][0] == pytest.approx(0.5 * (roof + 0.8 * ceiling))
    assert attic[1][2] == attic[2][1] == pytest.approx(0.5 * (light + 0.1 * ceiling))
    assert described(building)["zones"][0]["view_weights"] == []


CUBE = {
    "floor": [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
    "top": [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    "south": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
    "north": [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
    "east": [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
    "west": [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
}


def cube(**changes: Any) -> str:
    plain = {
        "site": {"latitude": 0, "longitude": 0, "altitude": 0, "timezone": "UTC"},
        "materials": {"m": {"conductivity": 1, "density": 1000, "specific_heat": 1000}},
        "constructions": {"c": {"layers": [{"material": "m", "thickness": 0.1}]}},
        "zones": {"z": {}},
        "surfaces": {
            name: {
                "construction": "c",
                "vertices": vertices,
                "outside": {"adiabatic": True},
                "inside": {"zone": "z", "convection": 3, "emissivity": 0.9},
            }
            for name, vertices in (CUBE | changes).items()
        },
    }
    return json.dumps(plain)  # JSON is YAML


def test_view_weights_of_a_unit_cube() -> None:
    """Opposite squares see 0.199825, neighbours 0.200044 (Howell, configuration factors C-11 and C-14)."""
    building = parse(cube(), "cube.yaml")
    assert building.parameter("zones.z.volume").value == pytest.approx(1.0)
    weights = np.array(described(building)["zones"][0]["view_weights"])
    assert weights[0, 1] == pytest.approx(0.199825, abs=1e-6)
    assert weights[0, 2] == pytest.approx(0.200044, abs=1e-6)
    assert weights.sum(axis=1) == pytest.approx(np.ones(6), abs=1e-9)


def test_a_door_is_subtracted_from_its_wall() -> None:
    door = [[0.2, 0, 0], [0.6, 0, 0], [0.6, 0, 0.5], [0.2, 0, 0.5]]
    building = parse(cube(door=door), "cube.yaml")
    assert building.parameter("surfaces.south.area").value == pytest.approx(0.8)
    weights = np.array(described(building)["zones"][0]["view_weights"])
    assert weights[2, 6] == 0.0
    assert weights.sum(axis=1) == pytest.approx([1, 1, 0.8, 1, 1, 1, 0.2], abs=1e-9)


def test_a_zone_that_is_not_closed_is_an_error() -> None:
    low = [[0, 0, 0.2], [1, 0, 0.2], [1, 1, 0.2], [0, 1, 0.2]]
    with pytest.raises(InputError, match="open edges"):
        parse(cube(top=low), "cube.yaml")


def test_a_zone_that_is_not_convex_needs_its_view_factors() -> None:
    """A pillar in the room hides faces from each other."""
    pillar = [[0.4, 0.4, 0], [0.4, 0.4, 1], [0.4, 0.6, 1], [0.4, 0.6, 0]]
    text = cube(pillar=pillar).replace('"z": {}', '"z": {"volume": 1}')
    with pytest.raises(InputError, match=r"^zones\.z: the zone is not convex"):
        parse(text, "cube.yaml").to_engine()


def test_a_mesh_warning_is_part_of_the_description() -> None:
    building = room().replace({"constructions.wall.layers.concrete.nodes": 2})
    assert building.to_engine(900).notes == (
        "constructions.wall.layers.concrete.nodes: 2 given, 9 would resolve a step of 900 s",
    )


def test_a_range_of_no_parameter_is_an_error() -> None:
    with pytest.raises(InputError, match="found no such parameter"):
        room().to_engine(900, {"materials.wood.density": (1.0, 2.0)})
