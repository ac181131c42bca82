"""The command that runs many members of a building."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from mascarin.commands.inputs import AsJson, Settings, Step, read_building, seconds
from mascarin.commands.output import print_json, print_table
from mascarin.commands.run import read_weather
from mascarin.errors import InputError, SolverError

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.ensemble import Store


def sweep(
    building: Path,
    /,
    *,
    weather: Path,
    out: Annotated[Path, Parameter(alias="-o")],
    samples: Path | None = None,
    draw: int | None = None,
    seed: int = 1,
    vary: Annotated[list[str] | None, Parameter(negative="")] = None,
    objectives: Annotated[list[str] | None, Parameter(name="--objective", negative="")] = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    start: str | None = None,
    end: str | None = None,
    step: Step = "15min",
    workers: int | None = None,
    settings: Settings = None,
    as_json: AsJson = False,
) -> None:
    """Run many members of a building into a folder.

    Stopped and called again, it goes on where it was.

    Parameters
    ----------
    building : Path
        Description of a building.
    weather : Path
        Weather file: EPW, or TMY3 as CSV.
    out : Path
        Folder for the results (Parquet) and their manifest: new, empty, or of the same ensemble.
    samples : Path
        Table of the members, CSV or Parquet: a column for each parameter path, a row for each member.
    draw : int
        Draw so many members instead, as a Latin hypercube over the ranges of the parameters.
    seed : int
        Seed of the draw.
    vary : list of str
        Parameters to draw; may be given again. Default: all that are not structural.
    objectives : list of str
        Keep a number of each member: min:, mean:, max: or sd: and an output, or hours above:LIMIT: or
        below:LIMIT:, such as max:room.air_temperature or above:26:room.air_temperature; may be given again.
    outputs : list of str
        Keep the series of these outputs instead; may be given again.
    start : str
        First moment, local time. Default: where the weather starts.
    end : str
        Last moment. Default: where the weather ends.
    workers : int
        Processes that share the work. Default: the threads of this one.
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
    kept = {text: Statistic.read(text) for text in objectives or ()}
    with Progress("members") as progress:
        store = sweep_into(
            out,
            described,
            read_weather(weather),
            table,
            outputs=outputs or list(dict.fromkeys(statistic.output for statistic in kept.values())),
            objectives=kept,
            step=seconds(step),
            start=start,
            end=end,
            workers=workers,
            seed=None if samples is not None else seed,
            progress=progress,
        )
    _print(store, as_json)


def _samples(
    building: Building, file: Path | None, draw: int | None, seed: int, vary: list[str] | None
) -> pd.DataFrame:
    if (file is None) == (draw is None):
        raise InputError("expected either --samples FILE or --draw NUMBER")
    if file is not None:
        return _read(file)
    from mascarin.ensemble import latin_hypercube

    return latin_hypercube(building, draw or 0, seed=seed, paths=vary)


def _read(file: Path) -> pd.DataFrame:
    import pandas as pd

    try:
        match file.suffix.lower():
            case ".csv":
                return pd.read_csv(file)
            case ".parquet":
                return pd.read_parquet(file)
    except (OSError, ValueError, ImportError) as error:
        raise InputError(f"--samples: '{file}' cannot be read: {error}") from None
    raise InputError(f"--samples: found '{file}'; expected a file ending in .csv or .parquet")


def _print(store: Store, as_json: bool) -> None:
    table = store.table()
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
        "objectives": {name: {"min": low, "mean": mean, "max": high} for name, low, mean, high in rows},
        "store": str(store.path),
        **{key: store.manifest[key] for key in ("mascarin_version", "identity", "samples", "seed")},
    }
    if as_json:
        print_json(result)
        return
    if rows:
        print_table(("objective", "min", "mean", "max"), rows)
    print(f"{result['members']} members, largest closure {result['closure']:.1e}; in {store.path}")
    if len(failed):
        # Said on standard error as well as kept: a failure is no result.
        print(
            f"{len(failed)} members failed; the first, {failed.index[0]}: {failed.iloc[0]}", file=sys.stderr
        )
