"""YAML by libyaml and by ruamel.yaml: the same nodes, or ruamel.yaml alone."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

import mascarin
from mascarin.building.files import yaml_nodes
from mascarin.building.files.yaml_document import plain
from mascarin.building.files.yaml_nodes import Reader, compose

#: Pieces of which texts are made, among them those that YAML 1.1 and 1.2 read in different ways.
PIECES = [
    *("- ", "? ", ": ", ", ", "a: ", "b:", "{", "}", "[", "]", "\n", "\n  ", "\n- ", "#c", " # c\n"),
    *("&a ", "*a", "&b-c\n", "*b-c", "&a:", "! ", "!!str ", "!x ", "<<: *a", "---\n", "...\n"),
    *(
        "yes",
        "null",
        "~",
        "''",
        '"',
        "'",
        '"x\\/y"',
        '"\\x41"',
        "017",
        "0o17",
        "1_000",
        "71e3",
        "True",
        "nULL",
        "-1.5E-3",
        "1e+",
        "12:30",
    ),
    *("\t", "\x85", "\u2028", "\r", ">-\n  a\n", "|#", "|\n  a\n", "a:b", "=", "é", "-", "\\", "%", "@"),
    *("%YAML 1.1\n", ".5", "`", "*", "&", "w_*.x", "a&b.c", "*a.b"),
]


def reader() -> YAML:
    return YAML(typ="safe", pure=True)


def tree(node: Any, above: tuple[int, ...] = ()) -> Any:
    """What a description is read from: kinds, tags, texts and lines; the line of nothing is not used."""
    if node is None or id(node) in above:
        return None
    tag = str(node.tag)
    head = (node.id, tag, 0 if tag.endswith(":null") else node.start_mark.line)
    inside = (*above, id(node))
    if node.id == "scalar":
        return (*head, node.value)
    if node.id == "sequence":
        return (*head, *(tree(item, inside) for item in node.value))
    return (*head, *((tree(key, inside), tree(value, inside)) for key, value in node.value))


def outcome(text: str, read: Any) -> Any:
    try:
        return tree(read(text))
    except (YAMLError, ValueError, RecursionError) as error:
        return type(error)


def same(text: str) -> bool:
    return bool(outcome(text, lambda t: compose(Reader(), t)) == outcome(text, lambda t: reader().compose(t)))


@pytest.mark.filterwarnings("ignore::ruamel.yaml.error.ReusedAnchorWarning")
@given(st.lists(st.sampled_from(PIECES), min_size=1, max_size=14).map("".join))
def test_the_nodes_of_any_text_are_those_of_ruamel(text: str) -> None:
    assert same(text)


def shipped() -> list[Path]:
    package = Path(mascarin.__file__).parent
    return sorted(package.rglob("*.yaml"))


@pytest.mark.parametrize("path", shipped(), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_shipped_files_are_read_the_same(path: Path) -> None:
    assert same(path.read_text(encoding="utf-8"))


def test_a_description_is_read_by_the_c_library(monkeypatch: pytest.MonkeyPatch) -> None:
    path = next(path for path in shipped() if path.stem == "building" and path.parent.name == "lgi")
    own = Reader()
    monkeypatch.setattr(own.yaml, "compose", lambda _: pytest.fail("read by the scanner in Python"))
    assert compose(own, path.read_text(encoding="utf-8")) is not None


def test_plain_words_need_no_ruamel(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would take longer to import than a description to read."""
    monkeypatch.setattr(Reader, "yaml", property(lambda _: pytest.fail("ruamel.yaml was asked")))
    text = "{a: true, b: False, c: null, d: 1.5, e: -71e-3, f: 2.5E+4, g: tarp, h: north, i: 12, j: '017'}"
    tags = [value.tag.rpartition(":")[2] for _, value in compose(Reader(), text).value]
    assert tags == ["bool", "bool", "null", "float", "float", "float", "str", "str", "int", "str"]
    assert plain(text.replace("c: null, ", ""), "words.yaml") == {
        "a": True, "b": False, "d": 1.5, "e": -0.071, "f": 25000.0, "g": "tarp", "h": "north", "i": 12,
        "j": "017",
    }  # fmt: skip


@pytest.mark.parametrize(
    "word",
    ["true", "True", "TRUE", "tRUE", "False", "null", "Null", "nULL", "n", "y", "yes", "on", "nan", "inf",
     "", "~", "15min", "15 min", "3d", "0d", "12:30:00Z", "1f", "1e5f", "2010-08-02",
     "2010-8-2", "2010-08-02 12:00", "2010-08-02t12:00:00z", "0x1F",
     "0o17", "0b1", "1z", ".inf", "-.INF", ".nan", "-x", "=", "-", "1,5", "1/h", "1_000",
     "1e5", "-1.e5", "1e", "1e+", "e5", "+1e5", "1_0e5", "1.5E-3", "0e0", "00e1"],
)  # fmt: skip
def test_words_are_those_of_ruamel(word: str) -> None:
    assert same(f"a: {word}")
    assert same(f"a: '{word}'")


def test_without_the_c_library_ruamel_reads_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "yaml.cyaml", None)
    root = compose(Reader(), "a: 71e3")
    assert root is not None
    assert root.value[0][1].tag == "tag:yaml.org,2002:float"


def test_values_inside_each_other_are_counted_before_python_gives_up() -> None:
    """A hundred thousand lists in lists end in an error of Python, not of the process."""
    with pytest.raises((RecursionError, YAMLError)):
        compose(Reader(), "[" * 100_000)


@pytest.mark.parametrize("text", ["wall_*.outside: 1", "{a_*.b: [x&y/z]}", "- roof*!"])
def test_a_star_in_a_word_is_no_alias(text: str) -> None:
    assert yaml_nodes._surely_read(text)
    assert same(text)
