"""The command that runs public test suites."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from mascarin._io import atomic, identity
from mascarin._io.locks import writing_into
from mascarin.commands.options.inputs import AsJson, Flag
from mascarin.commands.options.output import json_text, number, print_json, print_table
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.verification.suites.running import SuiteResult
    from mascarin.verification.suites.suite import Suite

PAGE, NUMBERS = "suites.html", "suites.json"


def suites(
    *names: str,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    html: Annotated[bool, Flag] = False,
    list_suites: Annotated[bool, Flag, Parameter(name="--list")] = False,
    as_json: AsJson = False,
) -> int:
    """Run public test suites beside other programs.

    Each number has a verdict: inside, miss, known miss with its cause, ambiguous specification, or not
    expressible. Exits with 1 for a miss that nobody has written down, or for one that has grown. The
    reference numbers are read in the folder that MASCARIN_DATA names; a suite whose numbers are not there is
    not run, and the command exits with 2 where it was asked for by name, or where none was run.
    docs/suites.md describes them.

    Parameters
    ----------
    names : str
        Names of suites, such as simquality. Default: all of them.
    out : Path
        Folder for the numbers (suites.json) and a page with tables (suites.html).
    html : bool
        Write the page into the present folder, where no --out is given.
    list_suites : bool
        Only list the suites, with their source.

    Returns
    -------
    int
        0, or 1 for a new or a worse miss.
    """
    from mascarin.progress import Progress
    from mascarin.verification.suites.running import run
    from mascarin.verification.suites.suite import chosen

    selection = chosen(names)
    if list_suites:
        return _list(selection, as_json=as_json)
    folder = Path() if out is None and html else out
    if folder is not None and (folder.is_file() or not folder.absolute().parent.is_dir()):
        raise InputError(f"--out: found '{folder}'; expected a folder, or a name in a folder that exists")
    files = () if folder is None else (folder / PAGE, folder / NUMBERS)
    with writing_into(folder), identity.outputs(*files):
        with Progress("suites") as progress:
            results = run(selection, progress)
        if folder is not None:
            _write(folder, names, results)
    if as_json:
        print_json([result.to_dict() for result in results])
    else:
        _print(results)
    for result in results:
        print(f"{result.suite.name}: {result.summary}", file=sys.stderr)
    missing = [result.missing for result in results if result.missing]
    # By name each is asked for; without a name one at least of those that need data has to be run.
    if missing and (names or len(missing) == sum(bool(result.suite.data) for result in results)):
        raise InputError(missing[0])
    return 1 if any(result.failed for result in results) else 0


def _list(selection: Sequence[Suite], *, as_json: bool) -> int:
    rows = [(suite.name, suite.title, suite.licence, suite.source) for suite in selection]
    header = ("suite", "title", "licence", "source")
    if as_json:
        print_json([dict(zip(header, row, strict=True)) for row in rows])
    else:
        print_table(header, rows)
    return 0


def _write(folder: Path, names: Sequence[str], results: Sequence[SuiteResult]) -> None:
    from mascarin.pages.suites.suites import write

    command = " ".join(("mascarin suites", *names))
    print(f"wrote {write(folder / PAGE, results, {'Command': command})}", file=sys.stderr)
    atomic.write(folder / NUMBERS, json_text([result.to_dict() for result in results]))


def _print(results: Sequence[SuiteResult]) -> None:
    rows = []
    for result in results:
        for line in result.lines:
            low, high = line.limits if line.limits is not None else ("", "")
            rank = "" if line.rank is None else f"{line.rank[0]} of {line.rank[1]}"
            cells = (_cell(line.value), _cell(line.reference), _cell(low), _cell(high))
            rows.append(
                (result.suite.name, line.case, line.quantity, line.unit, *cells, rank, line.verdict.value)
            )
    print_table(("suite", "case", "quantity", "unit", "value", "reference", "min", "max", "rank", ""), rows)


def _cell(value: float | str) -> str:
    if isinstance(value, str) or value != value:
        return ""
    return number(value)
