"""Plots of records over local time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mascarin._io.arguments import require_type
from mascarin.errors import InputError, did_you_mean
from mascarin.weather.channels import UNITS
from mascarin.weather.record import Record
from mascarin.weather.timezones import zone_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SMALL = (6.0, 1.8)  # inches


def plot(record: Record, names: Sequence[str], ax: Axes | None) -> Axes:
    """Draw columns over local time.

    Parameters
    ----------
    record : Record
        Where the columns are.
    names : sequence of str
        Columns, all in one unit.
    ax : matplotlib.axes.Axes or None
        Where to draw; None makes a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        Where it was drawn.

    Raises
    ------
    InputError
        A column is unknown, or the columns have different units.
    """
    known = [str(name) for name in record.data.columns]
    for name in names:
        if name not in known:
            raise InputError(
                f"{record.file}: no column {name!r} to plot. {did_you_mean(name, known)}".rstrip()
            )
    units = {UNITS.get(name, "") for name in names}
    if len(units) > 1:
        found = ", ".join(f"{name} [{UNITS.get(name, '')}]" for name in names)
        raise InputError(
            f"{record.file}: found columns of several units to plot ({found}), expected one unit; call plot "
            "once for each unit, with an ax for each."
        )
    import matplotlib.dates
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

    if ax is not None:
        require_type("ax", ax, Axes, "axes of matplotlib")
    ax = plt.subplots(layout="constrained")[1] if ax is None else ax
    edges = record.grid.start + record.grid.interval * np.arange(record.grid.count + 1)
    days = matplotlib.dates.date2num(edges.astype("datetime64[s]"))  # type: ignore[no-untyped-call]
    for name in names:
        values = record.data[name].to_numpy(dtype=np.float64)
        if record.kinds[name] == "mean":
            ax.step(days, np.append(values, values[-1:]), where="post", label=name)
        else:
            ax.plot(days, np.append(values, record.closing.get(name, np.nan)), label=name)
    zone = record.grid.zone
    locator = matplotlib.dates.AutoDateLocator(tz=zone)  # type: ignore[no-untyped-call]
    ax.xaxis.set_major_locator(locator)
    formatter = matplotlib.dates.ConciseDateFormatter(locator, tz=zone)  # type: ignore[no-untyped-call]
    ax.xaxis.set_major_formatter(formatter)
    ax.set_xlabel(f"local time ({zone_name(zone)})")
    unit = next(iter(units), "")
    ax.set_ylabel(f"[{unit}]" if unit else "")
    if len(names) > 1:
        ax.legend()
    else:
        ax.set_title("".join(names))
    return ax


def small_figures(record: Record) -> dict[str, Figure]:
    """Small figures of a record for a notebook, by heading: one for each unit, at most four."""
    from matplotlib.figure import Figure

    groups: dict[str, list[str]] = {}
    for name in record.data.columns:
        groups.setdefault(UNITS.get(str(name), ""), []).append(str(name))
    figures = {}
    for unit, names in list(groups.items())[:4]:
        figure = Figure(figsize=_SMALL, layout="constrained")
        plot(record, names[:6], figure.add_subplot())
        figures[", ".join(names[:6]) + (f" [{unit}]" if unit else "")] = figure
    return figures
