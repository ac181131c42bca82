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


#: Classes of one name in several places, and why: other names of classes stand once.
SAME_NAME = {
    # Words of GenOpt, whose files and terms genopt/ keeps.
    "Algorithm": "genopt: methods of the program, and those that an export offers",
    "Context": "genopt: where a search runs; energyplus: where an object is read",
    "Evaluator": "genopt: runs of the program in place of those of the engine",
    "Number": "genopt: a number of a settings file",
    "Objective": "genopt: an objective of a project file",
    "Options": "genopt: of a run and of an export",
    # Words of the program EnergyPlus, whose model energyplus/ keeps.
    "DataFile": "energyplus: data sets of windows; weather: known files",
    "Findings": "energyplus: what is not carried over; study: results of the steps",
    "Frame": "energyplus: coordinates; building: the frame of a window",
    "Zone": "energyplus: a zone of the model that is read",
    # Kinds of a file, named as their key there.
    "Comfort": "design: the objective `comfort` of a file",
    "Cost": "design: the objective `cost` of a file; calibration: a cost of the deviations",
    "Heat": "design: the objective `heat` of a file; energyplus: heat of a gain",
    "Uncertainty": "design: the key `uncertainty` of a file; calibration: that of the estimates",
    "Variable": "design: the key `variables`; fmu and genopt: the word of their standard",
    # Words of a field that has no other.
    "Building": "building: the class; parameters: what ties need of it, without a circle",
    "Case": "each suite of tests has cases with data of its own; genopt: the case of an export",
    "Channel": "fmu: the unit's inputs; weather: a column of the weather",
    "Column": "tables: a column of a file; pages.study: a curve of the report (public)",
    "Evaluation": "optimization: a value of an objective (public); comfort: of an index (public)",
    "Grid": "optimization: a search on a grid (public); tables: regular times",
    "Place": "templates, building outputs and weather: a site or a zone by their words",
    "PublishedLaw": "building: the base of laws of convection, and what makes their classes",
    "Record": "tables: a regular record; genopt: a record of its runs",
    "Runs": "design: runs of designs; sensitivity: runs of a sample",
}


def test_a_class_name_stands_once() -> None:
    """Two classes of one name are one idea in two places, or one of them has the wrong name."""
    places: dict[str, list[str]] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(path.relative_to(PACKAGE).as_posix())
    twice = {name: files for name, files in places.items() if len(files) > 1}
    assert {name: files for name, files in twice.items() if name not in SAME_NAME} == {}
    assert set(SAME_NAME) <= set(twice), "names of this list that stand once: take them out"
    assert all(len(files) == len(set(files)) for files in twice.values()), "twice in one file"
