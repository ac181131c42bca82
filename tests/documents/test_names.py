"""Names of variables say what they hold: words that fit anything are no names."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "mascarin"

#: Words that would fit any variable. Say what it is: errors, a parameter, rows, an index, a location.
EMPTY_WORDS = frozenset([
    "found", "one", "kept", "made", "given", "wanted", "here", "there", "at", "known", "every", "whole",
    "place", "places", "several", "many", "few", "near", "others", "drawn", "seen", "left", "own", "told",
    "rest", "lit",
])  # fmt: skip

#: Packages and rooms without such names; add one when it is free of them.
PACKAGES = (
    "calibration", "design", "energyplus", "figures", "genopt", "optimization", "pages",
    "sensitivity", "validation", "verification", "simulation", "commands", "ensemble", "comfort", "fmu",
    "_io", "building", "materials", "weather", "tables", "measurements", "diagnosis", "templates",
    "study/carried", "study/diagnosis", "study/results",
)  # fmt: skip


#: Names that users or files have: a key of a record, a key of YAML, a field or argument of a public class.
PUBLIC = {
    ("simulation/checks/judgement.py", "place"), ("building/parts/air/schedule.py", "at"),
    ("building/gamma.py", "near"), ("building/parts/self_shading.py", "near"),
    ("diagnosis/causes.py", "given"), ("diagnosis/causes.py", "told"), ("diagnosis/causes.py", "others"),
    ("diagnosis/hypotheses.py", "known"), ("diagnosis/hypotheses.py", "told"),
    ("diagnosis/step_changes.py", "whole"), ("tables/columns.py", "given"), ("tables/units.py", "place"),
    ("templates/new_buildings.py", "place"), ("templates/room.py", "place"),
    ("weather/reading/readers.py", "place"),
}  # fmt: skip


def bound_names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Lines and names of variables, loop variables, fields, arguments and private functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name.startswith("_"):
            yield node.lineno, node.name
        elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar):
            yield node.lineno, node.name or ""


def empty_names(tree: ast.AST) -> list[tuple[int, str]]:
    """Lines and names that are empty words, in capitals or with underscores around them as well."""
    return [(line, name) for line, name in bound_names(tree) if name.strip("_").lower() in EMPTY_WORDS]


@pytest.mark.parametrize("package", PACKAGES)
def test_names_say_what_they_hold(package: str) -> None:
    modules = sorted((PACKAGE / package).rglob("*.py"))
    assert modules, f"no package '{package}': correct the list of this test"
    lines = [
        f"{path.relative_to(PACKAGE)}:{line}: {name}"
        for path in modules
        for line, name in empty_names(ast.parse(path.read_text(encoding="utf-8")))
        if (path.relative_to(PACKAGE).as_posix(), name) not in PUBLIC
    ]
    assert not lines, "name what these hold, such as errors, parameter, index:\n" + "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("found = 1", ["found"]),
        ("rows = [one.name for one in rows]", ["one"]),
        ("for k, place in enumerate(x): pass", ["place"]),
        ("def f(given, *, own=1): ...", ["given", "own"]),
        ("first, *rest = x", ["rest"]),
        ("if (left := x): pass", ["left"]),
        ("_KEPT = 3", ["_KEPT"]),
        ("def _every(): ...", ["_every"]),
        ("class C:\n    seen: int\n    def at(self): ...", ["seen"]),
        ("try: x\nexcept E as told: pass", ["told"]),
        ("f(given=x.found)['one']\nprint(left)", []),
    ],
)
def test_empty_words_are_told_from_names(text: str, names: list[str]) -> None:
    assert sorted(name for _, name in empty_names(ast.parse(text))) == sorted(names)
