"""Docstrings of the public interface: complete, checked by numpydoc, with examples that run."""

from __future__ import annotations

import dataclasses
import doctest
import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import pytest
from numpydoc.validate import validate

import mascarin
from mascarin.building.base.part import Part

PACKAGES = [
    "building", "calibration", "comfort", "ensemble", "materials", "optimization", "physics", "sensitivity",
    "simulation", "validation", "weather",
]  # fmt: skip

#: Checks of numpydoc: no docstring, no summary, parameters that are missing, unknown, in another
#: order or without a description.
CHECKS = {"GL08", "SS01", "SS04", "PR01", "PR02", "PR03", "PR07"}
#: Python's own members that classes inherit.
INHERITED = (dict, tuple, Exception)


def public() -> Iterator[tuple[str, Any]]:
    """Public classes and functions, each once, by the name under which it is imported."""
    seen: set[int] = set()
    places = [("mascarin", name) for name in mascarin.__all__]
    for package in PACKAGES:
        module = importlib.import_module(f"mascarin.{package}")
        places += [(module.__name__, name) for name in getattr(module, "__all__", [])]
    for place, name in places:
        value = getattr(importlib.import_module(place), name)
        if (inspect.isclass(value) or inspect.isfunction(value)) and id(value) not in seen:
            seen.add(id(value))
            yield f"{place}.{name}", value


PUBLIC = dict(public())


def members(name: str, value: Any) -> Iterator[str]:
    """Public functions and properties that a class of the package defines."""
    for key, member in vars(value).items() if inspect.isclass(value) else ():
        if not key.startswith("_") and (
            inspect.isfunction(member) or isinstance(member, property | classmethod)
        ):
            yield f"{name}.{key}"


def one_line(item: str, value: Any) -> bool:
    """Whether one line describes a method completely, with its arguments."""
    owner, _, name = item.rpartition(".")
    return owner in PUBLIC and "\n" not in (inspect.getdoc(getattr(value, name)) or "").strip()


def undocumented_fields(value: Any) -> list[str]:
    """Fields of a data class that its section Attributes does not name."""
    text = inspect.getdoc(value) or ""
    sections = re.split(r"\n(Attributes|Parameters)\n-+\n", text)
    documented = "\n".join(sections[1:])
    return [
        field.name
        for field in dataclasses.fields(value)
        if field.init
        and not field.name.startswith("_")
        and not re.search(rf"^.*\b{field.name}\b.* : ", documented, re.M)
    ]


@pytest.mark.parametrize("name", PUBLIC)
def test_docstrings_are_complete(name: str) -> None:
    value = PUBLIC[name]
    found = []
    for item in [name, *members(name, value)]:
        checks = CHECKS - {"PR01"} if one_line(item, value) or dataclasses.is_dataclass(value) else CHECKS
        found += [f"{item}: {code} {text}" for code, text in validate(item)["errors"] if code in checks]
    if dataclasses.is_dataclass(value):
        found += [f"{name}: {field} is not documented" for field in undocumented_fields(value)]
    assert not found, "\n".join(found)


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_name_has_an_example(name: str) -> None:
    value = PUBLIC[name]
    texts = [value.__doc__ or ""]
    if inspect.isclass(value):
        texts += [member.__doc__ or "" for member in vars(value).values() if hasattr(member, "__doc__")]
    if inspect.isclass(value) and issubclass(value, Exception):
        return
    assert any(">>>" in text for text in texts), f"{name} has no example"


def modules() -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(mascarin.__path__, "mascarin."):
        if not found.name.endswith("_engine"):
            yield importlib.import_module(found.name)


@pytest.mark.parametrize("module", list(modules()), ids=lambda module: module.__name__)
def test_examples_run(module: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    monkeypatch.chdir(tmp_path)
    options = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    assert doctest.testmod(module, optionflags=options).failed == 0


def test_a_part_keeps_its_signature_when_it_is_first_used() -> None:
    """Pydantic makes validators, and a signature with the kind, only then."""
    parts = [value for value in PUBLIC.values() if isinstance(value, type) and issubclass(value, Part)]
    assert len(parts) > 50
    for part in parts:
        before = inspect.signature(part)
        part.model_rebuild()
        assert inspect.signature(part) == before
        assert "kind" not in before.parameters
