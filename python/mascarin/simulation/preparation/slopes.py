"""Derivatives with their names: of one quantity by all parameters, of series by some."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin._io.arguments import kind_of
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Gradient, series_of
from mascarin.simulation.records.labels import time_coordinates

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Output, Parameter
    from mascarin.simulation.preparation.objectives import Objective
    from mascarin.simulation.preparation.run_results import Trajectory

    Array = npt.NDArray[np.float64]


def gradient_of(
    objective: Objective, trajectory: Trajectory, names: Sequence[str], parameters: Sequence[Parameter]
) -> Gradient:
    """A quantity and its derivatives by all parameters.

    Parameters
    ----------
    objective : callable
        From the series by output to a value and its derivatives by each.
    trajectory : Trajectory
        The run.
    names : sequence of str
        Names of its outputs.
    parameters : sequence of Parameter
        The parameters, in the order of the parameter vector.

    Raises
    ------
    InputError
        The objective needs an output that was not recorded.
    """
    function: Any = objective  # of any type, where no type checker has looked
    result = function(dict(zip(names, trajectory.records.T, strict=True))) if callable(function) else None
    if not (isinstance(result, tuple) and len(result) == 2 and isinstance(result[1], Mapping)):
        shown = kind_of(result if callable(function) else function)
        raise InputError(
            f"objective: found {shown}, expected a function of the series by output that returns the value "
            "and a mapping from output to derivatives"
        )
    value, by_series = result
    weights = np.zeros_like(trajectory.records)
    for name, slopes in by_series.items():
        series_of(dict.fromkeys(names, weights), name)
        weights[:, list(names).index(name)] = slopes
    slopes = trajectory.pull(weights)
    return Gradient(
        value=float(value),
        slopes=dict(zip([p.path for p in parameters], slopes.tolist(), strict=True)),
        units={p.path: p.unit for p in parameters},
        ranges={p.path: (p.low, p.high) for p in parameters},
    )


def labelled_slopes(
    outputs: Sequence[Output],
    index: pd.DatetimeIndex,
    parameters: Mapping[str, str],
    records: Array,
    slopes: Array,
) -> xr.Dataset:
    """Series and their derivatives by name.

    Parameters
    ----------
    outputs : sequence of Output
        What was recorded.
    index : pandas.DatetimeIndex, shape (rows,)
        Times of the records.
    parameters : mapping of str to str
        Unit of each parameter by path.
    records : ndarray, shape (rows, outputs)
        The series. [unit of each output]
    slopes : ndarray, shape (parameters, rows, outputs)
        Their derivatives. [unit of the output / unit of the parameter]
    """
    import xarray as xr

    from mascarin.simulation.records.series import RunDataset

    data = {}
    for k, output in enumerate(outputs):
        attributes = {"units": output.unit, "long_name": output.name}
        data[output.name] = xr.DataArray(records[:, k], dims="time", attrs=attributes)
        attributes = {
            "units": f"{output.unit} / parameter_unit",
            "long_name": f"derivative of {output.name} by the parameter",
        }
        data[f"d {output.name}"] = xr.DataArray(slopes[:, :, k], dims=("parameter", "time"), attrs=attributes)
    units = np.array(list(parameters.values()))
    coordinates = {"parameter": list(parameters), "parameter_unit": ("parameter", units)}
    return RunDataset(
        data, coords={**time_coordinates(index), **coordinates}, attrs={"timezone": str(index.tz)}
    )
