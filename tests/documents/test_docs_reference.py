"""The generated reference: every key that the code accepts and every output has an entry."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, get_args

import pytest
from ruamel.yaml import YAML

import mascarin as mc
from mascarin import examples
from mascarin.building.base.number import Number, Quantity, quantity_of
from mascarin.building.base.part import Part
from mascarin.building.outputs.kinds import KINDS
from sitepages import api, assemble, commands, keys, outputs
from sitepages.snippets import Snippets, classes

BUILDINGS = Path(mc.__file__).parent / "verification" / "bestest" / "buildings"


@pytest.fixture(scope="module")
def snippets() -> Snippets:
    return Snippets(assemble.DOCS)


@pytest.fixture(scope="module")
def page(snippets: Snippets) -> str:
    return keys.page(snippets)


def schema_keys(schema: dict[str, Any]) -> set[tuple[str, str]]:
    """Keys of the JSON Schema, which pydantic makes by itself: name of the part, key."""
    parts = {"Description": schema, **schema["$defs"]}
    return {(name, key) for name, part in parts.items() for key in all_properties(part)}


def all_properties(part: dict[str, Any]) -> dict[str, Any]:
    found = dict(part.get("properties", {}))
    for form in part.get("anyOf", ()):
        found |= form.get("properties", {})
    return found


def test_every_key_of_the_schema_has_an_entry() -> None:
    listed = {(part.__name__, key.name) for part in keys.parts() for key in keys.keys_of(part)}
    assert listed == schema_keys(mc.building.json_schema())


def test_every_entry_has_a_text_and_every_number_a_unit() -> None:
    for part in keys.parts():
        for key in keys.keys_of(part):
            assert key.meaning, f"{part.__name__}.{key.name}: no text"
            if key.name not in part.model_fields:  # a short form
                continue
            field = part.model_fields[key.name]
            if Number in set(all_types(field.annotation)):
                assert key.unit, f"{part.__name__}.{key.name}: a number without a unit"
                assert key.range, f"{part.__name__}.{key.name}: a number without the rule of its range"
            assert not {int, float} & set(all_types(field.annotation)), f"{part.__name__}.{key.name}: no unit"


def all_types(annotation: Any) -> list[Any]:
    """Types of an annotation, without what is inside of parts and of words."""
    if isinstance(annotation, type):
        return [annotation]
    pieces = [piece for piece in get_args(annotation) if not isinstance(piece, str | Quantity)]
    return [kind for piece in pieces for kind in all_types(piece)]


def test_every_leaf_has_an_example_that_the_code_accepts(snippets: Snippets) -> None:
    for part in keys.parts():
        for name, field in part.model_fields.items():
            if not keys.is_leaf(field):
                continue
            example = snippets.of(part, name)
            assert example, f"{part.__name__}.{name}: write an example in docs/site/more_keys.yaml"
            value = YAML(typ="safe").load(example)[name]
            quantity = keys.nested_quantity(field.annotation) or quantity_of(field)
            if quantity is not None and isinstance(value, int | float):
                assert quantity.read(value) == value


def test_words_of_an_example_are_those_of_the_code(snippets: Snippets) -> None:
    site = next(part for part in keys.parts() if part.__name__ == "Site")
    assert snippets.of(site, "latitude") == "latitude: 39.83"
    for part in keys.parts():
        for name, field in part.model_fields.items():
            if name == "kind":
                assert snippets.of(part, name).removeprefix("kind: ") in get_args(field.annotation)


def test_the_entry_of_a_key_has_unit_limits_default_range_and_example(page: str) -> None:
    row = next(line for line in page.splitlines() if line.startswith("| `ground_reflectance` "))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1] == "number [-], at least 0 and at most 1"
    assert cells[2] == "`0.2` (Liu & Jordan 1963, doi:10.1016/0038-092X(63)90006-9)"
    assert "*Range:* 0.1 to 0.35 (wet asphalt to dry concrete" in cells[3]
    assert re.fullmatch(r"`ground_reflectance: 0\.\d+`", cells[4])


def test_links_of_the_page_lead_to_its_sections(page: str) -> None:
    anchors = set(re.findall(r"^\((key-[\w-]+)\)=$", page, re.MULTILINE))
    assert len(anchors) == len(keys.parts())
    assert set(re.findall(r"\]\(#(key-[\w-]+)\)", page)) <= anchors


def test_every_kind_of_output_is_described_as_buildings_have_it() -> None:
    seen = set()
    files = [examples.FOLDER / "lgi" / "building.yaml", BUILDINGS / "600.yaml", BUILDINGS / "960.yaml"]
    plants = {"drying": {"relative_humidity": 0.7}, "humidifying": {"relative_humidity": 0.3}}
    damp = mc.load(files[-1]).replace({"humidity": {"zones": {"back": plants}}, "zones.back.air_gradient": 1})
    vents = {"flap": {"zone": "back", "area": 0.1, "elevation": 1, "pressure": "none"}}
    controls = {"night": {"zone": "back", "indoor": {"open": 24, "close": 22}}}
    derived = {"doubled": "2*back.air_temperature"}
    layers = {name: damp.constructions[wall.construction].layers for name, wall in damp.surfaces.items()}
    wall = next(name for name, listed in layers.items() if len(listed) > 1)
    pipes = {"flow": 0.1, "supply": 30, "effectiveness": 0.5}
    sources = {"pipes": {"surface": wall, "after": layers[wall][0].name, "water": pipes}}
    more = {"vents": vents, "controls": controls, "derived_outputs": derived, "heat_sources": sources}
    aired = damp.replace(more)
    for building in [*map(mc.load, files), aired]:
        for output in building.outputs():
            one = KINDS[output.kind]
            seen.add(output.kind)
            assert output.unit == one.unit, output.name
            assert any(fits(output.name, pattern) for pattern in one.patterns), output.name
    assert seen >= set(KINDS) - {"sensor"}
    assert all(f"`{KINDS[kind].patterns[0]}`" in outputs.page() for kind in KINDS)


def fits(name: str, pattern: str) -> bool:
    """Whether a name is one of a pattern, in which words in capitals stand for names."""
    text = "".join(r"\w+" if word.isupper() else re.escape(word) for word in re.split(r"([A-Z]+)", pattern))
    return re.fullmatch(text, name) is not None


def test_a_command_is_listed_with_its_options() -> None:
    run = commands.command_text("run")
    assert run.startswith("```console\nmascarin run --weather PATH")
    assert "Ends with exit code 1 where a balance does not close or a temperature has no cause." in run
    assert "`--weather PATH`" in run
    assert "**[required]**" in run
    assert "*[default: 15min]*" in run
    with pytest.raises(LookupError):
        commands.command_text("walk")


def test_public_names_of_python_are_listed() -> None:
    text = "\n".join(api.pages().values())
    for name in (
        "mascarin.simulation.simulate",
        "mascarin.building.Zone",
        "mascarin.study.StudyResults",
        "mascarin.design.run_design",
        "mascarin.comfort.assess",
        "mascarin.energyplus.convert",
        "mascarin.fmu.export",
        "mascarin.calibration.calibrate",
    ):
        assert re.search(rf"^\.\. auto\w+:: {re.escape(name)}$", text, re.MULTILINE), name


def test_every_page_is_in_the_table_of_contents_once() -> None:
    index = (assemble.DOCS / "index.md").read_text(encoding="utf-8")
    listed = [page for section in assemble.sections(index) for page in section.pages]
    pages = {path.stem for path in assemble.DOCS.glob("*.md")}
    pages |= {name.removesuffix(".md") for name in assemble.FROM_ROOT}
    notebooks = {f"notebooks/{path.stem}" for path in (assemble.DOCS / "notebooks").glob("*.ipynb")}
    assert sorted(set(listed)) == sorted((pages - {"index"}) | notebooks)


def test_links_and_captions_of_the_site() -> None:
    text = "[c](../CHANGELOG.md#a) [p](python.md)\n\n<!-- file: a.yaml -->\n```yaml\na: 1\n```\n"
    assert assemble.site_text(text) == (
        "[c](CHANGELOG.md#a) [p](python.md)\n\n```{code-block} yaml\n:caption: a.yaml\n\na: 1\n```\n"
    )
    assert assemble.site_text("[a](docs/architecture.md)", from_root=True) == "[a](architecture.md)"


def test_a_mapping_is_read_as_the_part_that_has_its_keys() -> None:
    zones = mc.Building.model_fields["surfaces"].annotation
    kinds: list[type[Part]] = list(classes(zones))
    assert [kind.__name__ for kind in kinds] == ["Surface"]
