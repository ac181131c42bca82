"""Reference of the command line, made from the commands' own options and docstrings."""

from __future__ import annotations

import re

from mascarin.cli import GROUPS, build_app

#: Exit codes of all commands, in the order of the table of docs/architecture.md.
_CODES = (
    ("0", "done"),
    ("1", "done, and a criterion is not met, or the energy balance does not close"),
    ("2", "an input cannot be used"),
    ("3", "the solver failed"),
    ("130, 143", "interrupted, terminated"),
    ("70", "an internal error of Mascarin"),
)


def command_text(name: str) -> str:
    """Usage, description and options of a command, as Markdown."""
    text = str(build_app(name).generate_docs(output_format="markdown", heading_level=2))
    found = re.search(rf"^#+ mascarin {name}$\n(.*?)(?=^#+ mascarin |\Z)", text, re.MULTILINE | re.DOTALL)
    if found is None:
        raise LookupError(f"mascarin {name}: no such section among the documented commands")
    return found[1].strip()


def page() -> str:
    """The page: all commands by group, with all their options."""
    lines = [
        "# Commands",
        "",
        "Every command with its options, as `mascarin COMMAND --help` prints them. Data go to standard "
        "output, messages and progress to standard error.",
        "",
        "| exit code | meaning |",
        "|---|---|",
        *(f"| {code} | {meaning} |" for code, meaning in _CODES),
        "",
        "With `--debug` (or `MASCARIN_DEBUG=1`) an error shows its traceback; every command accepts it.",
        "",
    ]
    for group, commands in GROUPS.items():
        lines += [f"## {group}", ""]
        for command in commands:
            lines += [f"### mascarin {command.name}", "", command_text(command.name), ""]
    return "\n".join(lines) + "\n"
