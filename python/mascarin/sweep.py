"""Ensembles: many parameter vectors of one building in one climate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from mascarin.errors import InputError, SolverError
from mascarin.simulation import Simulation

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.climate import Climate, Measurements
    from mascarin.model import Building

    Array = npt.NDArray[np.float64]


def sweep(
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    *,
    outputs: Sequence[str],
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    scheme: Literal["sdirk2", "backward-euler", "apparent-capacity"] = "sdirk2",
    initial: Literal["repeat"] | float = "repeat",
    measurements: Measurements | None = None,
    report: Callable[[int], object] | None = None,
) -> xr.Dataset:
    """Run a building once for every row of samples; a member's bits do not depend on the others.

    Parameters
    ----------
    building, climate, outputs, step, start, end, scheme, initial, measurements
        As in `Simulation`.
    samples : mapping or pandas.DataFrame
        Path -> values, one for each member, shape (M,). [unit of each]
    report : callable, optional
        Called with the number of members done.

    Returns
    -------
    xarray.Dataset
        Each output over (member, time), the samples over (member, parameter), and `closure` [-]; NaN for a
        member that failed, with its reason in the attribute `failures`.

    Raises
    ------
    InputError
        Unknown or structural path, columns of different lengths, a value that the parameter cannot have.
    SolverError
        Every member failed.
    """
    import xarray as xr

    columns = {str(path): np.asarray(values, dtype=np.float64) for path, values in samples.items()}
    _check(building, columns)
    simulation = Simulation(
        building,
        climate,
        step=step,
        start=start,
        end=end,
        outputs=outputs,
        scheme=scheme,
        initial=initial,
        measurements=measurements,
        ranges={path: (float(values.min()), float(values.max())) for path, values in columns.items()},
    )
    members = len(next(iter(columns.values())))
    vectors = np.tile(simulation.vector({}), (members, 1))
    for path, values in columns.items():
        vectors[:, simulation.position(path)] = values
    records, closure, failures = simulation.ensemble(vectors, report=report)
    if len(failures) == members:
        raise SolverError(f"all {members} members failed; the first: {failures[0].reason}")
    times = simulation.index.tz_convert("UTC").tz_localize(None)
    data = {
        output.name: xr.DataArray(records[:, :, k], dims=("member", "time"), attrs={"units": output.unit})
        for k, output in enumerate(simulation.outputs)
    }
    data["samples"] = xr.DataArray(np.column_stack(list(columns.values())), dims=("member", "parameter"))
    data["closure"] = xr.DataArray(closure, dims="member")
    attributes = {
        "failures": [f"member {failure.member}: {failure.reason}" for failure in failures],
        "timezone": str(simulation.index.tz),
    }
    return xr.Dataset(
        data,
        coords={"time": times, "member": np.arange(members), "parameter": list(columns)},
        attrs=attributes,
    )


def _check(building: Building, columns: Mapping[str, Array]) -> None:
    if not columns:
        raise InputError("samples: no columns; give values by parameter path")
    lengths = {path: values.shape for path, values in columns.items()}
    if len(set(lengths.values())) > 1 or any(len(shape) != 1 or shape[0] == 0 for shape in lengths.values()):
        raise InputError(f"samples: shapes {lengths}; expected one vector of the same length for every path")
    for path, values in columns.items():
        parameter = building.parameter(path)
        bad = np.flatnonzero(~((values >= parameter.lower) & (values <= parameter.upper)))
        if bad.size:
            raise InputError(
                f"samples: {path} of member {bad[0]} is {values[bad[0]]:g} {parameter.unit}; expected a "
                f"value from {parameter.lower:g} to {parameter.upper:g}"
            )
