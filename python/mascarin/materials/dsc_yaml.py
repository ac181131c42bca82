"""A measured material as text of a building file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def to_yaml(name: str, material: Mapping[str, Any], comments: Sequence[str] = ()) -> str:
    """A material as text of a building file, with comments above it.

    Parameters
    ----------
    name : str
        Its name there.
    material : mapping
        As `DscMaterial.description` gives it.
    comments : sequence of str
        Lines to put above.
    """
    lines = [*(f"# {text}" for text in comments), "materials:", f"  {name}:"]
    for key, value in material.items():
        lines += _entry(key, value, 4)
    for key in ("conductivity", "density"):
        if key not in material:
            lines.append(f"    # {key}:   a calorimeter does not measure it: add it")
    return "\n".join(lines) + "\n"


def _entry(key: str, value: Any, indent: int) -> list[str]:
    blank = " " * indent
    if isinstance(value, dict):
        return [f"{blank}{key}:", *(line for k, v in value.items() for line in _entry(k, v, indent + 2))]
    if isinstance(value, list):
        return [f"{blank}{key}: [{', '.join(f'{x:.10g}' for x in value)}]"]
    return [f'{blank}{key}: "{value}"' if key == "source" else f"{blank}{key}: {value}"]
