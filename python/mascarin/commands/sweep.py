"""The command that simulates a building with many parameter values."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from mascarin._io import arrow_files
from mascarin._io.regular import require_regular
from mascarin._io.tables import read_csv
from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import (
    AsJson,
    CheckSun,
    Columns,
    MeasuredTable,
    Outside,
    RunStep,
    Settings,
    Shift,
    Stamps,
    Weather,
    Zone,
    read_building,
    step_of,
)
from mascarin.commands.options.output import print_json, print_table
from mascarin.commands.options.places import lines_named
from mascarin.commands.options.tables import run_inputs
from mascarin.errors import InputError, SolverError

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.ensemble import Store


def sweep(
    building: Path,
    /,
    *,
    weather: Weather,
    measurements: MeasuredTable = None,
    columns: Columns = None,
    timezone: Zone = None,
    stamps: Stamps = "start",
    out: Annotated[Path, Parameter(alias="-o")],
    samples: Path | None = None,
    draw: int | None = None,
    seed: int = 1,
    vary: Annotated[list[str] | None, Parameter(negative="")] = None,
    objectives: Annotated[list[str] | None, Parameter(name="--objective", negative="")] = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    start: str | None = None,
    end: str | None = None,
    step: RunStep = "15min",
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"] = "sdirk2",
    precision: Literal["double", "single"] = "double",
    workers: int | None = None,
    settings: Settings = None,
    allow_outside: Outside = False,
    check_sun: CheckSun = True,
    shift: Shift = None,
    as_json: AsJson = False,
) -> int:
    """Simulate a building with many parameter values.

    Each row of the samples is one member of the ensemble. After an interruption the same command continues.
    Ends with exit code 1 where a member failed or is not sound: a balance of it does not close, or a
    temperature has no cause.

    Parameters
    ----------
    building : Path
        Description of a building.
    out : Path
        Folder for the results (Parquet) and their manifest: new, empty, or with the same ensemble.
    samples : Path
        Table of the members, CSV or Parquet: a column for each parameter path, a row for each member.
    draw : int
        Number of members to draw instead, as a Latin hypercube over the ranges of the parameters.
    seed : int
        Seed of the random numbers.
    vary : list of str
        Parameters to draw; can be given several times. Default: all that are not structural.
    objectives : list of str
        One number to keep of each member: min:, mean:, max: or sd: and an output, or the hours above:LIMIT:
        or below:LIMIT:, such as max:room.air_temperature or above:26:room.air_temperature; can be
        given several times.
    outputs : list of str
        Output whose time series is kept instead; can be given several times.
    start : str
        Start of the period, local time. Default: the start of the weather file.
    end : str
        End of the period. Default: the end of the weather file.
    scheme : str
        Time-stepping scheme, as of 'mascarin run'.
    precision : str
        'single' runs twice as many members at once, to screen many; how far their results are from
        double precision is measured in some of them and printed.
    workers : int
        Number of processes. Default: threads of one process.
    """
    from mascarin.ensemble import Statistic, sweep_into
    from mascarin.progress import Progress

    described = read_building(building, settings)
    table = _samples(described, samples, draw, seed, vary)
    if bool(objectives) == bool(outputs):
        raise InputError(
            "expected either --objective (a number of each member) or --output (its series), such as "
            "--objective max:room.air_temperature"
        )
    statistics = {text: Statistic.read(text) for text in objectives or ()}
    climate, measured = run_inputs(
        described, weather, measurements, columns=columns or [], timezone=timezone, stamps=stamps,
        allow_outside=allow_outside, check_sun=check_sun, shift=shift,
    )  # fmt: skip
    with lines_named(building), Progress("members") as progress:
        store = sweep_into(
            out, described, climate, table, measurements=measured, objectives=statistics,
            outputs=outputs or list(dict.fromkeys(statistic.output for statistic in statistics.values())),
            step=step_of(step), scheme=scheme, precision=precision, start=start, end=end, workers=workers,
            seed=None if samples is not None else seed, progress=progress,
        )  # fmt: skip
    return _print(store, as_json)


def _samples(
    building: Building, file: Path | None, draw: int | None, seed: int, vary: list[str] | None
) -> pd.DataFrame:
    if (file is None) == (draw is None):
        raise InputError("expected either --samples FILE or --draw NUMBER")
    if file is not None:
        return _read(file)
    from mascarin.ensemble import latin_hypercube

    return latin_hypercube(building, draw or 0, seed=seed, vary=vary)


def _read(file: Path) -> pd.DataFrame:
    import pandas as pd

    require_regular(file, "a table of samples")
    try:
        match file.suffix.lower():
            case ".csv":
                return read_csv(file)
            case ".parquet":
                with arrow_files.opened(file) as content:
                    return pd.read_parquet(content)
    except (OSError, ValueError, ImportError) as error:
        raise InputError(f"--samples: '{file}' cannot be read: {error}") from None
    raise InputError(f"--samples: found '{file}'; expected a file ending in .csv or .parquet")


def _print(store: Store, as_json: bool) -> int:
    """Print the results; the exit code."""
    table = store.to_dataframe()
    failed = table["failure"].dropna()
    if len(failed) == len(table):
        raise SolverError(f"all {len(table)} members failed; the first: {failed.iloc[0]}")
    rows = [
        (name, float(table[name].min()), float(table[name].mean()), float(table[name].max()))
        for name in store.manifest["objectives"]
    ]
    result: dict[str, Any] = {
        "members": len(table),
        "failed": {str(member): str(reason) for member, reason in failed.items()},
        "closure": float(table["closure"].max()),
        "warnings": store.warnings(),
        "objectives": {name: {"min": low, "mean": mean, "max": high} for name, low, mean, high in rows},
        "precision": store.precision,
        "single_precision": store.manifest.get("single_precision", {}),
        "store": str(store.path),
        **{key: store.manifest[key] for key in ("mascarin_version", "identity", "samples", "seed")},
    }
    for line in result["warnings"]:
        print(f"warning: {line}", file=sys.stderr)
    code = exit_code(warnings=result["warnings"], sound=store.sound(), failed=len(failed))
    if len(failed):
        # Failures are in the results, and shown here so that they are not overlooked.
        print(
            f"{len(failed)} members failed; the first, {failed.index[0]}: {failed.iloc[0]}", file=sys.stderr
        )
    if as_json:
        print_json(result)
        return code
    if rows:
        print_table(("objective", "min", "mean", "max"), rows)
    for line in store.single_precision():
        print(f"single precision: {line}")
    residual = result["closure"]
    print(f"{len(table)} members, largest relative energy-balance residual {residual:.1e}; in {store.path}")
    return code
