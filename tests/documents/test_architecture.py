"""Packages import only from packages before them, and no modules import each other in a circle."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "mascarin"

# From first to last (docs/architecture.md). Entries of one line may use each other, without circles.
ORDER = [
    {"errors", "engine_errors", "linear_algebra", "physics", "progress", "_engine", "_io"},
    {"study_document"},
    {"figures"},
    {"tables"},
    {"materials"},
    {"building"},
    {"weather"},
    {"comfort"},
    {"simulation", "energyplus"},
    {"measurements"},
    {"ensemble", "fmu"},
    {"sensitivity", "optimization", "validation"},
    {"calibration"},
    {"diagnosis"},
    {"verification"},
    {"examples", "templates"},
    {"pages", "pages.frame", "pages.study", "pages.run", "pages.suites"},
    {"pages.view", "pages.explore"},
    {"pages.live"},
    {"study"},
    {"design.evaluation", "design.variants"},
    {"pages.design"},
    {"design"},
    {"genopt"},
    {"commands", "cli", "__main__"},
]
LEVEL = {name: level for level, names in enumerate(ORDER) for name in names}

MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py")
MOST_LINES_OF_A_FILE = 500
MOST_LINES_OF_A_FUNCTION = 60
REASON = "Long because "


def dotted(path: Path) -> str:
    """Name of the module in the file `path`."""
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULE_FILES = {dotted(path): path for path in MODULES}
NAMES = set(MODULE_FILES)


def package_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def level_of(name: str) -> int:
    """Level of a module without ``mascarin.``: that of the longest entry of ORDER that holds it."""
    parts = name.split(".")
    entries = (".".join(parts[:length]) for length in range(len(parts), 0, -1))
    return next(LEVEL[entry] for entry in entries if entry in LEVEL)


@cache
def imported(path: Path) -> frozenset[str]:
    """Modules of the package that a module imports: anywhere in it, in functions and for types as well."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}:{node.lineno}: a relative import; write the whole name"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                found.add(inner if inner in NAMES else node.module or "")
    return frozenset(name for name in found if name.startswith("mascarin."))


def circles(graph: dict[str, frozenset[str]]) -> list[list[str]]:
    """Groups of modules that reach each other (strongly connected components, Tarjan 1972)."""
    order: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(name: str) -> None:
        order[name] = lowest[name] = len(order)
        stack.append(name)
        for other in sorted(graph[name] & graph.keys()):
            if other not in order:
                visit(other)
                lowest[name] = min(lowest[name], lowest[other])
            elif other in stack:
                lowest[name] = min(lowest[name], order[other])
        if lowest[name] == order[name]:
            group = stack[stack.index(name) :]
            del stack[stack.index(name) :]
            if len(group) > 1 or name in graph[name]:
                found.append(sorted(group))

    for name in sorted(graph):
        if name not in order:
            visit(name)
    return found


@pytest.mark.parametrize("path", MODULES, ids=dotted)
def test_a_package_imports_only_from_packages_before_it(path: Path) -> None:
    package = package_of(path)
    assert package in LEVEL, f"'{package}' has no place in ORDER and in docs/architecture.md"
    level = level_of(dotted(path).removeprefix("mascarin."))
    others = {name.removeprefix("mascarin.") for name in imported(path)}
    later = {other for other in others if level_of(other) > level}
    assert not later, f"'{package}' imports {sorted(later)}, which come after it"


def test_no_modules_import_each_other_in_a_circle() -> None:
    assert circles({dotted(path): imported(path) for path in MODULES}) == []


MOST_FILES_OF_A_FOLDER = 15


def room_of(name: str) -> str:
    """The folder of a module below the package; modules beside the packages are rooms of their own."""
    parts = name.split(".")[1:]
    is_package = MODULE_FILES[name].name == "__init__.py"
    return ".".join(parts if is_package or len(parts) == 1 else parts[:-1])


def rooms() -> dict[str, frozenset[str]]:
    """For each folder, the folders that its modules import."""
    graph: dict[str, set[str]] = {}
    for name, path in MODULE_FILES.items():
        room = room_of(name)
        others = {room_of(other) for other in imported(path) if other in MODULE_FILES}
        graph.setdefault(room, set()).update(others - {room})
    return {room: frozenset(others) for room, others in graph.items()}


def test_no_folders_import_each_other_in_a_circle() -> None:
    assert circles(rooms()) == []


def test_a_folder_has_few_files() -> None:
    counts: dict[str, int] = {}
    for name, path in MODULE_FILES.items():
        counts[room_of(name)] = counts.get(room_of(name), 0) + (path.name != "__init__.py")
    full = {room: count for room, count in counts.items() if count > MOST_FILES_OF_A_FOLDER}
    assert not full, (
        f"more than {MOST_FILES_OF_A_FOLDER} files: split the folder, or put the new file elsewhere"
    )


def test_circles_are_found() -> None:
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": {"e"}}
    assert circles({name: frozenset(others) for name, others in graph.items()}) == [["a", "b", "c"], ["e"]]


@pytest.mark.parametrize("path", MODULES, ids=dotted)
def test_files_and_functions_are_short_or_say_why_not(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    if len(lines) > MOST_LINES_OF_A_FILE:
        assert any(REASON in line for line in lines[:12]), f"{path.name} has {len(lines)} lines and no reason"
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        length = (node.end_lineno or node.lineno) - node.lineno + 1 - docstring_lines(node)
        if length > MOST_LINES_OF_A_FUNCTION:
            inside = lines[node.lineno - 2 : node.end_lineno]
            assert any(REASON in line for line in inside), f"{path.name}: {node.name} has {length} lines"


def docstring_lines(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    first = node.body[0]
    if ast.get_docstring(node) is None or first.end_lineno is None:
        return 0
    return first.end_lineno - first.lineno + 1


@pytest.mark.parametrize("path", MODULES, ids=dotted)
def test_no_module_reads_private_names_of_another(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    own = {"self", "cls"}
    imports = {
        alias.asname or alias.name.split(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mascarin"):
            private = [a.name for a in node.names if a.name.startswith("_") and a.name not in PRIVATE_MODULES]
            assert not private, f"{path.name}:{node.lineno} imports {private}"
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            hidden = node.attr.startswith("_") and not node.attr.startswith("__")
            name = node.value.id
            public = f"{name}.{node.attr}" in DOCUMENTED
            assert public or not (hidden and name in imports - own), (
                f"{path.name}:{node.lineno}: {name}.{node.attr}"
            )


PRIVATE_MODULES = {"_engine", "_io", "__version__"}
# Names with an underscore that the library documents for its users.
DOCUMENTED = {"os._exit"}


def test_every_package_is_described() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    for package in {package_of(path) for path in MODULES}:
        assert f"`{package}/`" in text or f"`{package}.py`" in text, package


def test_the_engine_does_not_use_python() -> None:
    manifest = (ROOT / "crates" / "engine" / "Cargo.toml").read_text(encoding="utf-8")
    assert "pyo3" not in manifest
    for path in (ROOT / "crates" / "engine" / "src").rglob("*.rs"):
        text = path.read_text(encoding="utf-8")
        for word in ("pyo3", "std::fs", "std::time::SystemTime"):
            assert word not in text, f"{path.name} uses {word}"
