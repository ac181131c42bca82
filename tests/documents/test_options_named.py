"""Options that texts name: each exists, and where a text names the command too, that command has it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import mascarin
from mascarin.cli import GROUPS, build_app

PACKAGE = Path(mascarin.__file__).parent
_OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
_COMMAND = re.compile(r"mascarin ([a-z][a-z-]+)((?:(?!mascarin )[^`\n])*)")
#: Every command has them.
_EVERYWHERE = {"--debug", "--help", "--version"}
#: Properties of style sheets, which begin alike.
_STYLES = ("figures", "pages")


@cache
def options() -> dict[str, set[str]]:
    """Options of each command, those of its subcommands included."""
    by_command = {}
    for command in (command for group in GROUPS.values() for command in group):
        names: set[str] = set()
        apps = [build_app(command.name)[command.name]]
        while apps:
            app = apps.pop()
            if app.default_command is not None:
                names |= {name for argument in app.assemble_argument_collection() for name in argument.names}
            apps += [app[name] for name in app if not name.startswith("-")]
        by_command[command.name] = names
    return by_command


def texts(file: Path) -> Iterator[tuple[int, str]]:
    """Strings of a module or lines of a page, with their line."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".md":
        yield from enumerate(text.split("\n"), 1)
        return
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_options_in_messages_exist() -> None:
    """A remedy that names an option is no remedy where there is none."""
    every = set().union(*options().values()) | _EVERYWHERE
    assert len(every) > 100
    missing = [
        f"{file.relative_to(PACKAGE)}:{line}: {option}"
        for file in sorted(PACKAGE.rglob("*.py"))
        if file.relative_to(PACKAGE).parts[0] not in _STYLES
        for line, text in texts(file)
        for option in _OPTION.findall(text)
        if option not in every
    ]
    assert missing == []


def test_a_command_that_a_text_names_has_the_option(repository: Path) -> None:
    """Package, documentation and README: `mascarin COMMAND ... --option`, up to the end of the phrase."""
    files = [*PACKAGE.rglob("*.py"), *(repository / "docs").rglob("*.md"), repository / "README.md"]
    named, missing = 0, []
    for file in sorted(files):
        for line, text in texts(file):
            for command, rest in _COMMAND.findall(text):
                for option in _OPTION.findall(re.split(r"[.;,:)] |\bor\b", rest)[0]):
                    named += 1
                    if option not in options().get(command, {option}) | _EVERYWHERE:
                        missing.append(f"{file.name}:{line}: mascarin {command} {option}")
    assert named > 100
    assert missing == []


@pytest.mark.parametrize(
    ("command", "option"), [("run", "--weather"), ("genopt", "--algorithm"), ("new", "--ceiling")]
)
def test_options_are_those_of_the_commands(command: str, option: str) -> None:
    """What is searched in is not empty."""
    assert option in options()[command]
    assert "--layers" not in options()[command]
