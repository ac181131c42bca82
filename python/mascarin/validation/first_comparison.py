"""A run beside columns of a table: numbers of a first comparison, without a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.validation.comparison import Metrics, compare

if TYPE_CHECKING:
    from mascarin.simulation.results import Results
    from mascarin.weather import Measurements


def first_comparison(
    results: Results, measurements: Measurements, columns: Mapping[str, str]
) -> dict[str, Metrics]:
    """Compare outputs of a run with measured columns, at the times of the run that have a value.

    Parameters
    ----------
    results : Results
        The run.
    measurements : Measurements
        The table; a column of instants is linear between its stamps.
    columns : mapping of str to str
        Output -> column.

    Returns
    -------
    dict of str to Metrics
        By output.

    Raises
    ------
    InputError
        An output was not recorded, or there is no value of its column in the period.
    """
    names = [output.name for output in results.outputs]
    metrics = {}
    for name, column in columns.items():
        if name not in names:
            raise InputError(
                f"--compare: found no output '{name}', expected one that is recorded. "
                f"{did_you_mean(name, names)}".rstrip()
            )
        index = names.index(name)
        measured = measurements.at(column, results.index)
        if not np.isfinite(measured).any():
            grid = measurements.grid
            raise InputError(
                f"{measurements.file}: column {column!r} has no value in the period of the run, expected "
                f"some; the table covers {grid.span()}: choose --start and --end inside"
            )
        metrics[name] = compare(measured, results.records[:, index], unit=results.outputs[index].unit)
    return metrics
