"""A room imports only from the rooms before it (docs/architecture.md)."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "mascarin"

# From first to last; rooms on one line may use each other.
ORDER = [
    {"errors", "progress", "_engine"},
    {"materials"},
    {"model"},
    {"climate"},
    {"simulation", "results", "start", "state_space"},
    {"sweep", "derivatives"},
    {"sensitivity", "optimise", "calibration", "validation"},
    {"genopt"},
    {"examples"},
    {"study"},
    {"coupling"},
    {"report"},
    {"commands", "cli"},
]
LEVEL = {room: level for level, rooms in enumerate(ORDER) for room in rooms}

MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py")


def room_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def full_name(path: Path, dots: int, module: str | None) -> str:
    """Name of the module that ``from <dots><module> import`` in the file `path` speaks of."""
    if dots == 0:
        return module or ""
    package = ["mascarin", *path.relative_to(PACKAGE).parts[:-1]]
    return ".".join([*package[: len(package) - dots + 1], *([module] if module else [])])


def imported_rooms(path: Path) -> set[str]:
    """Rooms that the module imports, anywhere in it, for types alone included."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            origin = full_name(path, node.level, node.module)
            names |= {f"{origin}.{alias.name}" for alias in node.names}
    parts = [name.split(".") for name in names]
    return {part[1] for part in parts if part[0] == "mascarin" and len(part) > 1 and part[1] in LEVEL}


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_room_imports_only_from_rooms_before_it(path: Path) -> None:
    room = room_of(path)
    assert room in LEVEL, f"'{room}' is not in the plan: give it a place here and in docs/architecture.md"
    later = {other for other in imported_rooms(path) if LEVEL[other] > LEVEL[room]}
    assert not later, f"'{room}' imports {sorted(later)}, which come after it"


def test_relative_imports_are_understood() -> None:
    path = PACKAGE / "model" / "mesh.py"
    assert full_name(path, 0, "mascarin.errors") == "mascarin.errors"
    assert full_name(path, 1, "site") == "mascarin.model.site"
    assert full_name(path, 2, "climate") == "mascarin.climate"
    assert full_name(path, 2, None) == "mascarin"


def test_every_room_is_described() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    for room in {room_of(path) for path in MODULES}:
        assert f"`{room}/`" in text or f"`{room}.py`" in text


def test_the_engine_knows_no_python() -> None:
    manifest = (ROOT / "crates" / "engine" / "Cargo.toml").read_text(encoding="utf-8")
    assert "pyo3" not in manifest
    for path in (ROOT / "crates" / "engine" / "src").rglob("*.rs"):
        text = path.read_text(encoding="utf-8")
        for word in ("pyo3", "std::fs", "std::time::SystemTime"):
            assert word not in text, f"{path.name} uses {word}"
