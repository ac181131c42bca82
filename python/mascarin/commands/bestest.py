"""The command that compares the cases of Standard 140 with six programs."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from mascarin._io import identity
from mascarin._io.locks import writing_into
from mascarin.commands.options.inputs import AsJson, Flag, Step, seconds
from mascarin.commands.options.output import number, print_json, print_table
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.verification.bestest.catalogue import Case
    from mascarin.verification.bestest.quantities import BestestQuantity
    from mascarin.verification.bestest.reference import Range

    Ranges = Mapping[tuple[str, str], Range]

PAGE = "bestest.html"
SUFFIXES = (".yaml", ".yml")


def bestest(
    *cases: str,
    weather: Path | None = None,
    ranges: Path | None = None,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    step: Step = "15min",
    workers: int = 2,
    list_cases: Annotated[bool, Flag, Parameter(name="--list")] = False,
    as_json: AsJson = False,
) -> int:
    """Compare the cases of ASHRAE Standard 140 with six programs.

    Runs the building thermal fabric cases (BESTEST) with the weather of Denver, and compares loads, peaks,
    free-floating temperatures and solar radiation with the results of six programs. Exits with 1 if a number
    is outside their range. docs/bestest.md describes the cases and the choices that the standard leaves open.

    Parameters
    ----------
    cases : str
        Numbers of cases, such as 600 900FF, and your own building files (.yaml), which are run in the
        same way and compared with --ranges. Default: all 39 cases.
    weather : Path
        The standard's weather file, 725650TYCST.epw. Default: that of the folder MASCARIN_DATA or of the
        cache, else it is downloaded once.
    ranges : Path
        CSV file with ranges for your own building files: columns case (name of the file), quantity (such as
        annual_heating, or room.peak_cooling), unit, min and max, or one column for each program.
    out : Path
        Folder for a page with charts, hourly days and tables (bestest.html).
    workers : int
        Number of cases that run at the same time.
    list_cases : bool
        Only list the cases: the change from the base case, and the building file.

    Returns
    -------
    int
        0, or 1 if a number is outside.
    """
    from mascarin.verification.bestest.catalogue import CASES, chosen
    from mascarin.verification.bestest.reference import read_ranges

    own_files = [Path(word) for word in dict.fromkeys(cases) if word.endswith(SUFFIXES)]
    chosen_cases = chosen([word for word in cases if not word.endswith(SUFFIXES)] if cases else list(CASES))
    if list_cases:
        return _list(chosen_cases, as_json=as_json)
    _require_possible_folder(out)
    ranges_read = read_ranges(ranges) if ranges is not None else None
    _require_own(own_files, ranges_read)
    if workers < 1:
        raise InputError(f"--workers: found {workers}; expected 1 or more")
    with writing_into(out), identity.outputs(*(() if out is None else (out / PAGE,))):
        rows_found = _compared(cases, own_files, chosen_cases, ranges_read, weather, out, step, workers)
    if as_json:
        print_json([row.to_dict() for row in rows_found])
    else:
        _print(rows_found)
    held = [row.passed for row in rows_found if row.passed is not None]
    outside = held.count(False)
    of = "the six programs" if ranges_read is None else "the six programs, or of --ranges"
    print(f"{len(held) - outside} of {len(held)} numbers inside the range of {of}", file=sys.stderr)
    return 1 if outside else 0


def _compared(
    words: Sequence[str], own_files: Sequence[Path], chosen_cases: Sequence[Case], own_ranges: Ranges | None,
    weather: Path | None, out: Path | None, step: str, workers: int,
) -> list[BestestQuantity]:  # fmt: skip
    """Run the cases, and write the page."""
    from mascarin.progress import Progress
    from mascarin.verification.bestest.quantities import quantities, quantities_of
    from mascarin.verification.bestest.running import run
    from mascarin.verification.bestest.weather import read

    climate = read(weather)
    started = time.monotonic()
    with Progress("cases") as progress:
        years, hours = run(
            chosen_cases, climate, files=own_files, step=seconds(step), workers=workers, progress=progress
        )
    took = time.monotonic() - started
    rows_found = [row for case in chosen_cases for row in quantities(years, case)]
    rows_found += [
        row for file, series in hours.items() for row in quantities_of(str(file), series, own_ranges)
    ]
    _warn_unused(rows_found, own_ranges)
    if out is not None:
        from mascarin.pages.suites.bestest import write

        facts = {
            "Command": " ".join(("mascarin bestest", *words, "--weather", climate.file, "--step", step)),
            "Weather": f"{climate.file}, SHA-256 {climate.sha256}",
            "Time step": step,
            "Took": f"{took:.0f} s",
        }
        print(f"wrote {write(out / PAGE, rows_found, years, facts)}", file=sys.stderr)
    return rows_found


def _list(cases: Sequence[Case], *, as_json: bool) -> int:
    rows = [(case.name, case.base, case.change, str(case.file)) for case in cases]
    if as_json:
        print_json([dict(zip(("case", "base", "change", "file"), row, strict=True)) for row in rows])
    else:
        print_table(("case", "base", "change", "file"), rows)
    return 0


def _require_own(own_files: Sequence[Path], own_ranges: Ranges | None) -> None:
    """Refuse ranges of cases that are not run, before the simulations start."""
    from mascarin.verification.bestest.quantities import case_names

    names = {name for file in own_files for name in case_names(str(file))}
    for case, _ in own_ranges or ():
        if case not in names:
            raise InputError(
                f"--ranges: found the case '{case}'; expected one of the building files of this command: "
                f"{', '.join(map(str, own_files)) or 'none was given'}. {did_you_mean(case, names)}".rstrip()
            )


def _warn_unused(rows: Sequence[BestestQuantity], own_ranges: Ranges | None) -> None:
    """Say which ranges were compared with nothing."""
    used = {id(row.range) for row in rows}
    for (case, quantity), limits in (own_ranges or {}).items():
        if id(limits) not in used:
            names = [row.quantity for row in rows if row.range is None]
            print(
                f"warning: --ranges: {case} has no quantity '{quantity}'; expected one of "
                f"{', '.join(dict.fromkeys(names))}",
                file=sys.stderr,
            )


def _require_possible_folder(out: Path | None) -> None:
    """Refuse a folder that cannot be made, before the simulations start."""
    if out is not None and (out.is_file() or not out.parent.is_dir()):
        raise InputError(f"--out: found '{out}'; expected a folder, or a name in a folder that exists")


def _print(rows: Sequence[BestestQuantity]) -> None:
    lines = [
        (
            row.case,
            row.quantity,
            row.unit,
            number(row.value),
            row.when,
            *_range_cells(row.range),
            _verdict(row.passed),
        )
        for row in rows
    ]
    print_table(("case", "quantity", "unit", "value", "hour", "min", "mean", "max", ""), lines)


def _range_cells(theirs: Range | None) -> tuple[str, str, str]:
    return ("", "", "") if theirs is None else (number(theirs.low), number(theirs.mean), number(theirs.high))


def _verdict(passed: bool | None) -> str:
    return "" if passed is None else "inside" if passed else "OUTSIDE"
