"""Docstrings of the public interface: complete, checked by numpydoc, with examples that run."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import pytest
from numpydoc.validate import validate

import mascarin

PACKAGES = [
    "building", "calibration", "ensemble", "materials", "optimization", "sensitivity", "simulation",
    "validation", "weather",
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


@pytest.mark.parametrize("name", PUBLIC)
def test_docstrings_are_complete(name: str) -> None:
    found = [
        f"{item}: {code} {text}"
        for item in [name, *members(name, PUBLIC[name])]
        for code, text in validate(item)["errors"]
        if code in CHECKS
    ]
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
