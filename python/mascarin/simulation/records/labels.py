"""Labels of results: times in xarray and NetCDF, and what describes a run for a reader."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from mascarin.simulation.records.provenance import Provenance, words_of

if TYPE_CHECKING:
    import pandas as pd


#: Attribute ``long_name`` of the coordinates of time, in memory and in files.
TIME_NAMES: Final = {"time": "time (UTC)", "local_time": "local time (zone: attribute timezone)"}


def time_coordinates(index: pd.DatetimeIndex) -> dict[str, Any]:
    """Coordinates of xarray for stamps with a time zone.

    Parameters
    ----------
    index : pandas.DatetimeIndex, shape (rows,)
        Local times with their zone.

    Returns
    -------
    dict
        ``time``: UTC, without a zone; ``local_time`` along it: the local clock, without a zone. Their
        attribute ``long_name`` says so. The zone itself belongs into the attribute ``timezone``.
    """
    return {
        "time": ("time", index.tz_convert("UTC").tz_localize(None), {"long_name": TIME_NAMES["time"]}),
        "local_time": ("time", index.tz_localize(None), {"long_name": TIME_NAMES["local_time"]}),
    }


def rows(
    names: Sequence[str], index: pd.DatetimeIndex, notes: Provenance, residual: float, warnings: Sequence[str]
) -> list[tuple[str, str]]:
    """What describes results for a reader: title and value of each line.

    Parameters
    ----------
    names : sequence of str
        The outputs.
    index : pandas.DatetimeIndex
        Local times.
    notes : Provenance
        What the run was made from.
    residual : float
        Relative residual of the energy balance. [-]
    warnings : sequence of str
        Warnings of the run.
    """
    shown = ", ".join(names[:3]) + (f", ... {len(names) - 3} more" if len(names) > 3 else "")
    source = notes.climate.get("file")
    lines = [
        ("climate", str(source) if source else "table"),
        ("period", f"{index[0]:%Y-%m-%d %H:%M} to {index[-1]:%Y-%m-%d %H:%M} {index.tz}"),
        ("step", f"{notes.step_seconds:g} s, {notes.scheme}, {len(index)} rows"),
        *([] if notes.steps is None else [("steps", words_of(notes.steps))]),
        ("start", notes.start),
        (f"{len(names)} outputs", shown),
        ("energy balance", f"relative residual {residual:.1e}"),
    ]
    changed = [f"{path} = {value:g}" for path, value in notes.changed.items()]
    if changed:
        lines.append(("parameters", ", ".join(changed)))
    return [*lines, *(("warning", warning) for warning in warnings)]
