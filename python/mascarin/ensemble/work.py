"""What one worker does: a stretch of members, run and reduced to what is kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import InputError, MascarinError
from mascarin.simulation.labels import time_coordinates
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building, Output
    from mascarin.ensemble.members import Members
    from mascarin.simulation.options import RunOptions
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

Objective = Callable[["xr.Dataset"], Any]

CLOSURE: Final = {"units": "1", "long_name": "relative energy-balance residual"}
"""Attributes of the variable ``closure``."""

#: Series that are held at once before they are reduced to objectives. [bytes]
_HELD: Final = 64 * 2**20
#: Compiled buildings that a worker keeps at hand.
_KEPT: Final = 4


@dataclass(frozen=True)
class Recipe:
    """All that the members have in common; small enough to travel to a worker.

    Attributes
    ----------
    building : Building
        The building; parameters that all members share are in it.
    climate : Climate
        Its weather.
    options : RunOptions
        Options of the runs.
    ranges : mapping of str to (float, float)
        Ranges of the samples, so that every worker chooses the same mesh.
    objectives : mapping of str to callable
        What is kept of each member instead of its series: functions of a Dataset over (member, time).
    identity : str
        Hash of all this; what a worker keeps compiled is known by it.
    """

    building: Building
    climate: Climate
    options: RunOptions
    ranges: Mapping[str, tuple[float, float]]
    objectives: Mapping[str, Objective]
    identity: str

    def compiled(self, shape: Mapping[str, Any]) -> Simulation:
        """The building of a shape in the climate."""
        building = self.building.replace(shape) if shape else self.building
        return Simulation(building, self.climate, **self.options.keywords(), ranges=self.ranges)

    def simulation(self, shape: Mapping[str, Any]) -> Simulation:
        """The same, kept at hand for the next stretch."""
        key = (self.identity, repr(sorted(shape.items())))
        if key not in _COMPILED:
            _COMPILED[key] = self.compiled(shape)
            while len(_COMPILED) > _KEPT:
                _COMPILED.popitem(last=False)
        _COMPILED.move_to_end(key)
        return _COMPILED[key]


_COMPILED: OrderedDict[tuple[str, str], Simulation] = OrderedDict()


@dataclass(frozen=True)
class Piece:
    """Results of a stretch of members.

    Attributes
    ----------
    first : int
        Its first member.
    kept : ndarray, shape (members, rows, outputs) or (members, objectives)
        Series, or objectives where some were asked for; NaN for a member that failed. [unit of each]
    closure : ndarray, shape (members,)
        Energy closure. [-]
    failures : mapping of int to str
        Members that failed, counted from the start of the ensemble, and why.
    """

    first: int
    kept: Array
    closure: Array
    failures: Mapping[int, str]


def run_stretch(
    recipe: Recipe, members: Members, first: int, report: Callable[[int], object] | None = None
) -> Piece:
    """Run a stretch of members.

    Parameters
    ----------
    recipe : Recipe
        What they have in common.
    members : Members
        The stretch.
    first : int
        Place of its first member in the ensemble.
    report : callable, optional
        Called with the number of members done.
    """
    values: Array | None = None
    closure = np.full(members.count, np.nan)
    failures: dict[int, str] = {}
    done = 0
    for shape, places in members.groups():
        try:
            simulation = recipe.simulation(shape)
        except MascarinError as error:
            # Such as a period that another place's climate does not cover: the other shapes go on.
            failures |= {first + place: str(error) for place in places}
            continue
        for batch in _batches(recipe, simulation, places):
            vectors = _vectors(simulation, members, batch)
            before = done
            tell = None if report is None else (lambda count, _, before=before: report(before + count))
            records, closures, failed = simulation.ensemble(vectors, progress=tell)
            kept = _reduced(recipe, simulation, records)
            if values is None:
                values = np.full((members.count, *kept.shape[1:]), np.nan)
            values[batch], closure[batch] = kept, closures
            failures |= {first + batch[failure.member]: failure.reason for failure in failed}
            for failure in failed:
                values[batch[failure.member]] = np.nan
            done += len(batch)
    if values is None:
        width = len(recipe.objectives) if recipe.objectives else 0
        values = np.full((members.count, width), np.nan)
    return Piece(first, values, closure, dict(sorted(failures.items())))


def _batches(recipe: Recipe, simulation: Simulation, places: list[int]) -> list[list[int]]:
    """Members that are run at once: all, or so few that their series fit in memory."""
    size = len(places)
    if recipe.objectives:
        row = 8 * len(simulation.index) * len(simulation.outputs)
        size = max(_HELD // row // 8 * 8, 8)
    return [places[k : k + size] for k in range(0, len(places), size)]


def _vectors(simulation: Simulation, members: Members, places: list[int]) -> Array:
    vectors = np.tile(simulation.values, (len(places), 1))
    for path, column in members.numbers.items():
        vectors[:, simulation.position(path)] = column[places]
    return vectors


def _reduced(recipe: Recipe, simulation: Simulation, records: Array) -> Array:
    """Series, or what the objectives make of them."""
    if not recipe.objectives:
        return records
    series = dataset(simulation.outputs, simulation.index, records)
    columns = []
    for name, objective in recipe.objectives.items():
        try:
            column = np.asarray(objective(series), dtype=np.float64)
        except Exception as error:  # whatever the user's function does
            raise InputError(f"objective '{name}' failed: {error!r}") from error
        if column.shape != (len(records),):
            raise InputError(
                f"objective '{name}': found a result of shape {column.shape}, expected one number for each "
                f"of {len(records)} members: reduce over time, for example with .max('time')"
            )
        columns.append(column)
    return np.stack(columns, axis=-1)


def dataset(outputs: list[Output], index: pd.DatetimeIndex, records: Array) -> xr.Dataset:
    """Series by name over (member, time); times are UTC without a zone."""
    import xarray as xr

    return xr.Dataset(
        {
            output.name: xr.DataArray(
                records[:, :, k],
                dims=("member", "time"),
                attrs={"units": output.unit, "long_name": output.name},
            )
            for k, output in enumerate(outputs)
        },
        coords=time_coordinates(index),
        attrs={"timezone": str(index.tz)},
    )
