"""The command that converts a model of EnergyPlus."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from mascarin._io import atomic
from mascarin._io.locks import writing
from mascarin.commands.options.inputs import AsJson
from mascarin.commands.options.output import print_json, print_table
from mascarin.commands.view import require_html
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.energyplus import Conversion


def convert(
    model: Path,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    weather: Path | None = None,
    force: bool = False,
    compare: Path | None = None,
    report: Path | None = None,
    as_json: AsJson = False,
) -> int:
    """Convert a model of EnergyPlus to a building.

    Reads IDF and epJSON files of EnergyPlus 8.9 and later; EnergyPlus itself is not needed. Lists object by
    object what is not carried over, and what this does to the results; the same list is in the comments of
    the file. Ends with exit code 1 where something that changes the results was left out. With --compare the
    building is simulated beside a run of EnergyPlus with the same model and weather: air temperatures, loads
    and sun of the zones by month, with the known causes of differences.

    Parameters
    ----------
    model : Path
        Model of EnergyPlus: .idf or .epJSON.
    out : Path
        File for the building. Default: the name of the model with .yaml, in the current folder.
    weather : Path
        Weather file (EPW) that gives the site: for a model without Site:Location, or of another place; or
        shipped:NAME of a climate that comes with Mascarin, such as shipped:tampa.
    force : bool
        Write over a building file that was changed since it was converted.
    compare : Path
        Folder where EnergyPlus has left eplusout.csv or eplusout.eso of this model; needs --weather.
    report : Path
        Page (HTML) of the comparison: all zones and months; needs --compare.
    """
    from mascarin.energyplus import convert as converted
    from mascarin.energyplus import report as as_report
    from mascarin.energyplus import run_options, terminal_lines, was_edited, yaml_text

    _check_options(compare, weather, report)
    target = Path(f"{model.stem}.yaml") if out is None else out
    if target.suffix.lower() not in (".yaml", ".yml"):
        raise InputError(f"--out: found '{target}'; expected a file that ends with .yaml")
    with writing(target), writing(report):
        if not force and was_edited(target):
            raise InputError(
                f"{target}: found a building that was changed since it was converted, or never was; "
                "expected a new file. Give another name with --out, or write over it with --force"
            )
        conversion = converted(model, weather=weather)
        compared: dict[str, Any] = {}
        if compare is not None and weather is not None:
            compared = _compared(conversion, compare, weather, page=report, printed=not as_json)
        atomic.write(target, yaml_text(conversion))
    if as_json:
        print_json(as_report(conversion) | {"building": str(target)} | compared)
    elif not compared:
        print("\n".join(terminal_lines(conversion)))
    print(f"wrote {target}; mascarin run {target} --weather EPW {run_options(conversion)}", file=sys.stderr)
    return 0 if conversion.complete else 1


def _check_options(compare: Path | None, weather: Path | None, report: Path | None) -> None:
    if compare is not None and weather is None:
        raise InputError(
            "--compare: found no --weather; expected the weather file (EPW) of that run. Name it"
        )
    if report is not None and compare is None:
        raise InputError("--report: found no --compare; expected a run of EnergyPlus. Name its folder")
    require_html("--report", report)


def _compared(
    conversion: Conversion, folder: Path, weather: Path, *, page: Path | None, printed: bool
) -> dict[str, Any]:
    """Compare with a run of EnergyPlus, print and write what is asked for; the comparison as JSON."""
    from mascarin.energyplus.comparison import compare
    from mascarin.energyplus.comparison.tables import comparison_report, header, tables

    comparison = compare(conversion, folder, weather)
    if printed:
        for name, lines, more in tables(comparison):
            print(f"{name}, Mascarin less EnergyPlus {comparison.run.version}".rstrip())
            print_table(header(comparison), lines)
            print(f"and {more} zones more: --json, --report\n" if more else "")
        for title, texts in (
            ("Known causes of differences:", comparison.causes),
            ("Notes:", comparison.notes),
        ):
            if texts:
                print("\n".join([title, *(f"  {text}" for text in texts)]))
    if page is not None:
        from mascarin.pages.run.peer import write

        print(f"wrote {write(page, comparison)}", file=sys.stderr)
    return {"comparison": comparison_report(comparison)}
