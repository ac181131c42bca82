"""The modules of the engine import only upwards (docs/architecture.md, docs/engine.md)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "crates" / "engine" / "src"

#: Folders and files at the top of the crate, from first to last: each imports from those before it.
ORDER = [
    "error",
    "number",
    "input",
    "physics",
    "geometry",
    "building",
    "weather",
    "linear",
    "balance",
    "step",
    "run",
    "derivatives",
    "linear_model",
]
LEVEL = {name: level for level, name in enumerate(ORDER)}

#: Lines that a file or a function may have without a reason beside it.
FILE_LINES, FUNCTION_LINES = 500, 60

_COMMENT = re.compile(r"//[^\n]*")
_STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_USE = re.compile(r"\buse\s+(\w+::[^;]+);")
_PATH = re.compile(r"\b((?:crate|super)(?:::\w+)+)")
_TESTS = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*mod (\w+)\s*([{;])")
_FUNCTION = re.compile(r"^( *)(?:pub(?:\([^)]*\))? )?(?:const )?(?:unsafe )?fn (\w+)", re.MULTILINE)


def module_of(file: Path) -> tuple[str, ...]:
    """The module that a file holds: ``linear/mod.rs`` and ``linear.rs`` are both ``("linear",)``."""
    parts = file.relative_to(SOURCE).with_suffix("").parts
    return parts[:-1] if parts[-1] == "mod" else parts


def is_test(file: Path) -> bool:
    return (
        file.stem.split("_")[-1] in ("tests", "testing")
        or file.stem.startswith("test_")
        or "tests" in file.relative_to(SOURCE).parts
    )


def code_of(file: Path) -> str:
    """The text of a file without comments, strings and unit tests."""
    text = file.read_text(encoding="utf-8")
    tests = [match.start() for match in _TESTS.finditer(text) if match[2] == "{"]
    if tests:
        text = text[: min(tests)]
    return _STRING.sub('""', _COMMENT.sub("", text))


FILES = sorted(path for path in SOURCE.rglob("*.rs") if not is_test(path))
BESIDE = sorted(
    file for crate in ("contents", "fmu", "web") for file in (ROOT / "crates" / crate / "src").rglob("*.rs")
)
MODULES = {module_of(file): file for file in FILES if file != SOURCE / "lib.rs"}


def flattened(tree: str) -> list[str]:
    """The paths of a ``use`` tree: ``a::{b, c::d}`` is ``a::b`` and ``a::c::d``."""
    tree = " ".join(tree.split())
    if "{" not in tree:
        return [tree.split(" as ")[0].strip()]
    head, rest = tree.split("{", 1)
    rest = rest[: rest.rindex("}")]
    parts, depth, start = [], 0, 0
    for place, sign in enumerate(rest + ","):
        depth += (sign == "{") - (sign == "}")
        if sign == "," and depth == 0:
            parts.append(rest[start:place].strip())
            start = place + 1
    return [path for part in parts if part for path in flattened(head.strip() + part)]


def resolved(path: str, inside: tuple[str, ...]) -> tuple[str, ...] | None:
    """The deepest module of the crate that a path speaks of, seen from a module."""
    names = path.split("::")
    base = inside
    if names[0] == "crate":
        base, names = (), names[1:]
    elif names[0] not in ("super", "self") and (*inside, names[0]) not in MODULES:
        return None  # another crate, or a name of this file
    else:
        while names and names[0] in ("super", "self"):
            if names[0] == "super":
                base = base[:-1]
            names = names[1:]
    full = (*base, *names)
    for length in range(len(full), 0, -1):
        if full[:length] in MODULES:
            return full[:length]
    return None


def imports_of(module: tuple[str, ...]) -> set[tuple[str, ...]]:
    code = code_of(MODULES[module])
    paths = [path for match in _USE.finditer(code) for path in flattened(match[1])]
    paths += [match[1] for match in _PATH.finditer(_USE.sub("", code))]
    found = {resolved(path, module) for path in paths}
    return {other for other in found if other is not None and other != module}


@pytest.mark.parametrize("module", sorted(MODULES), ids="::".join)
def test_a_module_imports_only_from_folders_before_its_own(module: tuple[str, ...]) -> None:
    assert module[0] in LEVEL, f"'{module[0]}' has no place in ORDER and in docs/architecture.md"
    later = {"::".join(other) for other in imports_of(module) if LEVEL[other[0]] > LEVEL[module[0]]}
    assert not later, f"{'::'.join(module)} imports {sorted(later)}, which come after it"


def test_no_circle() -> None:
    """No module imports one that imports it, on whatever way, inside a folder too."""
    graph = {module: imports_of(module) for module in MODULES}
    state: dict[tuple[str, ...], int] = {}
    circles: list[str] = []

    def visit(module: tuple[str, ...], path: list[tuple[str, ...]]) -> None:
        state[module] = 1
        for other in sorted(graph[module]):
            if state.get(other) == 1:
                circle = [*path[path.index(other) :], other]
                circles.append(" -> ".join("::".join(name) for name in circle))
            elif other not in state:
                visit(other, [*path, other])
        state[module] = 2

    for module in sorted(MODULES):
        if module not in state:
            visit(module, [module])
    assert not circles, "\n".join(circles)


def functions(code: str) -> list[tuple[str, int, int]]:
    """Name, line and number of lines of each function."""
    found = []
    lines = code.split("\n")
    for match in _FUNCTION.finditer(code):
        first = code.count("\n", 0, match.start())
        end = match[1] + "}"
        last = next((at for at in range(first, len(lines)) if lines[at].rstrip() == end), None)
        opened = next(
            (at for at in range(first, len(lines)) if lines[at].rstrip().endswith(("{", ";"))), None
        )
        if last is None or opened is None or lines[opened].rstrip().endswith(";"):
            continue  # a function of one line, or one without a body
        found.append((match[2], first + 1, last - first + 1))
    return found


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(SOURCE)))
def test_files_and_functions_are_short_or_say_why_not(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    lines = text.split("\n")
    if len(lines) > FILE_LINES:
        assert "//! Long because " in text, f"{len(lines)} lines without a reason"
    for name, first, length in functions(text):
        if length > FUNCTION_LINES:
            before = "\n".join(lines[max(0, first - 12) : first])
            assert "Long because " in before, f"{name}, line {first}: {length} lines without a reason"


def test_unsafe_is_in_three_places_only() -> None:
    """Vector instructions of the engine, the C functions of a unit, the exports of the module for pages."""
    word = re.compile(r"\bunsafe\b(?!_code)")
    crates = ROOT / "crates"
    where = {file.relative_to(crates) for file in crates.rglob("*.rs") if word.search(code_of(file))}
    allowed = [
        Path("engine", "src", "number", "simd"),
        Path("fmu", "src", "border"),
        Path("web", "src", "border.rs"),
    ]
    assert not [file for file in where if not any(place in (file, *file.parents) for place in allowed)]
    assert {place for place in allowed for file in where if place in (file, *file.parents)} == set(allowed)


def test_the_border_of_pages_is_unsafe_by_its_exports_only() -> None:
    """It is given no pointers: the attribute of a name is all that is unsafe there."""
    code = code_of(ROOT / "crates" / "web" / "src" / "border.rs")
    assert re.search(r"\bunsafe\b(?!_code)", code.replace("#[unsafe(no_mangle)]", "")) is None
    assert "from_raw_parts" not in code


@pytest.mark.parametrize("file", BESIDE, ids=lambda file: f"{file.parents[1].name} {file.stem}")
def test_files_beside_the_engine_are_short(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert len(text.split("\n")) <= FILE_LINES
    assert not [name for name, _, length in functions(text) if length > FUNCTION_LINES]


def test_only_the_resources_of_a_unit_are_read_from_files() -> None:
    users = [file.name for file in BESIDE if "std::fs" in file.read_text(encoding="utf-8")]
    assert users == ["resources.rs"]
    for crate in ("contents", "fmu", "web"):
        manifest = (ROOT / "crates" / crate / "Cargo.toml").read_text(encoding="utf-8")
        assert "pyo3" not in manifest
        # The C functions of a unit stay out of the module for pages.
        assert crate == "fmu" or "mascarin-fmu" not in manifest


def test_paths_are_understood() -> None:
    assert flattened("crate::a::{b, c::{d, e as f}}") == ["crate::a::b", "crate::a::c::d", "crate::a::c::e"]
    assert resolved("crate::linear::nothing", ("step",)) == ("linear",)
    assert resolved("super::error::EngineError", ("step", "newton")) in {None, ("step",)}
    assert [name for name, *_ in functions("fn a() {\n    1\n}\n")] == ["a"]
