"""Examples of keys: found in shipped building files, in the pages of the documentation and in docstrings."""

from __future__ import annotations

import ast
import inspect
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from mascarin import examples
from mascarin.building.base.law_table import CONVECTION, IMPOSED, LEAKAGE, SKY, SORPTION
from mascarin.building.base.part import Part
from mascarin.building.parts.description import Description

_YAML_FENCE = re.compile(
    r"(?:^<!-- file: (?P<file>\S+) -->\n)?^```yaml\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
#: Files of pages whose typing errors a message explains.
_WRONG = "slip.yaml"
_LONGEST = 70


class Snippets:
    """For each key of each part the first example that is short enough.

    Parameters
    ----------
    docs : Path
        Folder of the pages.
    """

    def __init__(self, docs: Path) -> None:
        self._found: dict[tuple[type[Part], str], str] = {}
        for text in _sources(docs):
            try:
                documents = list(YAML(typ="safe").load_all(text))
            except YAMLError:  # a page that shows an error
                continue
            for raw in documents:
                if isinstance(raw, dict):
                    self._take(raw, [Description])

    def of(self, part: type[Part], key: str) -> str:
        """Example of a key as a line of YAML; empty where there is none."""
        if (part, key) not in self._found:
            self._from_docstring(part)
        return self._found.get((part, key), "")

    def _take(self, raw: Any, kinds: list[type[Part]]) -> None:
        """Keep the values of one part, and those of the parts in it."""
        if isinstance(raw, list):
            for piece in raw:
                self._take(piece, kinds)
            return
        if not isinstance(raw, dict):
            return
        part = chosen(raw, kinds)
        if part is None:
            if kinds:  # a mapping of names
                for piece in raw.values():
                    self._take(piece, kinds)
            return
        for key, value in raw.items():
            self._keep(part, key, value)
            if key in part.model_fields:
                self._take(value, list(classes(part.model_fields[key].annotation)))

    def _keep(self, part: type[Part], key: str, value: Any) -> None:
        line = f"{key}: {flow(value)}"
        if (part, key) not in self._found and len(line) <= _LONGEST:
            self._found[part, key] = line

    def _from_docstring(self, part: type[Part]) -> None:
        """Keep the arguments of calls in the examples of a docstring."""
        doc = inspect.getdoc(part) or ""
        code = "\n".join(line[4:] for line in doc.splitlines() if line.startswith((">>> ", "... ")))
        try:
            calls = [node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Call)]
        except SyntaxError:
            return
        for call in calls:
            if isinstance(call.func, ast.Name | ast.Attribute) and ast.unparse(call.func).endswith(
                part.__name__
            ):
                for argument in call.keywords:
                    try:
                        value = ast.literal_eval(argument.value)
                    except ValueError:
                        continue
                    if argument.arg is not None:
                        self._keep(part, argument.arg, value)


def _sources(docs: Path) -> Iterator[str]:
    """Texts of YAML: shipped files first, then pages."""
    for file in sorted(examples.FOLDER.rglob("*.yaml")):
        yield file.read_text(encoding="utf-8")
    cases = examples.FOLDER.parent / "verification" / "bestest" / "buildings"
    for name in ("600", "650", "960"):  # the other cases differ from them in values
        yield (cases / f"{name}.yaml").read_text(encoding="utf-8")
    for page in sorted(docs.glob("*.md")):
        for fence in _YAML_FENCE.finditer(page.read_text(encoding="utf-8")):
            if fence["file"] != _WRONG:
                yield fence["text"]
    yield (docs / "site" / "more_keys.yaml").read_text(encoding="utf-8")
    sides = {
        kind: {"outside": {"convection": {"kind": kind, **row.example}}} for kind, row in CONVECTION.items()
    }
    yield json.dumps({"surfaces": sides})
    for kind, row in SKY.items():
        yield json.dumps({"site": {"sky": {"kind": kind, **row.example}}})
    for kind, row in LEAKAGE.items():
        yield json.dumps(
            {"zones": {"room": {"infiltration": {"blower_door": {"kind": kind, **row.example}}}}}
        )
    for kind, row in IMPOSED.items():
        if kind != "ground":
            yield json.dumps({"surfaces": {"floor": {"outside": {"imposed": {"kind": kind, **row.example}}}}})
    for kind, row in SORPTION.items():
        yield json.dumps({"humidity": {"materials": {"board": {"kind": kind, **row.example}}}})


def classes(annotation: Any) -> Iterator[type[Part]]:
    """Parts that an annotation names."""
    if isinstance(annotation, type) and issubclass(annotation, Part):
        yield annotation
        return
    for piece in get_args(annotation):
        if not isinstance(piece, str):
            yield from classes(piece)


def chosen(raw: dict[str, Any], kinds: list[type[Part]]) -> type[Part] | None:
    """The part that a mapping describes: the kind that it names, else the first that has all its keys."""
    kind = raw.get("kind")
    if kind is not None:
        for part in kinds:
            field = part.model_fields.get("kind")
            if field is not None and kind in get_args(field.annotation):
                return part
    for part in kinds:
        if raw.keys() <= part.model_fields.keys() | {"extends", "set", "kind", "temperature", "held"} and raw:
            return part
    return None


def flow(value: Any) -> str:
    """A value in one line of YAML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(piece)}" for key, piece in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(flow(piece) for piece in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if value is None:
        return "null"
    if isinstance(value, str) and (not re.fullmatch(r"[A-Za-z_][\w ./*+-]*", value)):
        return '"' + value.replace('"', "'") + '"'
    return str(value)
