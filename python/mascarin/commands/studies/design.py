"""The command that compares designs of a building."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import AsJson, Flag, Outside
from mascarin.commands.options.output import print_json, print_table

if TYPE_CHECKING:
    from mascarin.design import DesignInputs, DesignResults


def design(
    file: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    workers: int | None = None,
    check: Annotated[bool, Flag] = False,
    allow_outside: Outside = False,
    as_json: AsJson = False,
) -> int:
    """Compare designs: which product, how much, where.

    Runs all designs in all climates, compares the best over samples of what is uncertain, and writes
    tables and a report. After an interruption the same command continues and gives the same files. Ends with
    exit code 1 where a run failed or is not sound: a balance of it does not close, or a temperature has
    no cause.

    Parameters
    ----------
    file : str
        Design file (YAML), or the name of an example: reunion-house.
    out : Path
        Folder for report.html, designs.csv, designs.parquet, ranking.csv, samples.csv, design.json and the
        runs.
    workers : int
        Number of processes. Default: all cores where there is much to do.
    check : bool
        Only check the file, and print what would be run.
    """
    from mascarin.design import read_design, run_design
    from mascarin.errors import InputError
    from mascarin.examples import locate_design
    from mascarin.progress import Progress

    if out is None and not check:
        raise InputError("--out: a folder for the results is needed, such as -o designs, or --check")
    inputs = read_design(locate_design(file), allow_outside=allow_outside)
    if out is None or check:
        return _print_plan(inputs, as_json)
    with Progress("members") as progress:
        results = run_design(inputs, out, workers=workers, progress=progress)
    return _print(results, out, as_json)


def _print_plan(inputs: DesignInputs, as_json: bool) -> int:
    """Print what would be run."""
    from mascarin.design import planned_runs

    plan = planned_runs(inputs)
    if as_json:
        print_json(plan)
        return 0
    print_table(("variable", "options"), [(name, str(count)) for name, count in plan["variables"].items()])
    print(
        f"{plan['designs']} designs in {len(plan['climates'])} climates ({', '.join(plan['climates'])}), "
        f"{plan['compared']} of them with {plan['samples']} samples of {plan['uncertain']} uncertain "
        f"parameters: "
        f"{plan['runs']} runs"
    )
    return 0


def _print(results: DesignResults, out: Path, as_json: bool) -> int:
    """Print the ranking; the exit code."""
    from mascarin.simulation.checks.judgement import all_sound

    summary = results.summary()
    sound = all(all_sound(table) for table in (results.sampled, results.nominal))
    code = exit_code(warnings=results.warnings, sound=sound, failed=summary["failed"])
    if summary["failed"]:
        print(f"{summary['failed']} runs failed; reasons are in designs.csv and samples.csv", file=sys.stderr)
    for line in results.warnings:
        print(f"warning: {line}", file=sys.stderr)
    if as_json:
        print_json({**summary, "folder": str(out)})
        return code
    for climate, rows in summary["ranking"].items():
        print(f"{climate}: {summary['ranked_by']}, {summary['unit']}")
        table = [
            (str(number), row["chosen"], row["mean"], row["spread"], row["verdict"])
            for number, row in enumerate(rows, start=1)
        ]
        print_table(("rank", "design", "mean", "sd", ""), table)
    print(f"report: {out / 'report.html'}")
    return code
