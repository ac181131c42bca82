"""The work of one worker: a chunk of members, run and reduced to what is kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import _engine
from mascarin.ensemble.members import variant
from mascarin.errors import InputError, MascarinError
from mascarin.simulation.checks.step_check import member_errors
from mascarin.simulation.records.labels import time_coordinates
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building, Output
    from mascarin.ensemble.members import Members
    from mascarin.simulation.preparation.options import Precision, RunOptions
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

Objective = Callable[["xr.Dataset"], Any]

CLOSURE: Final = {"units": "1", "long_name": "relative energy-balance residual"}
"""Attributes of the variable ``closure``."""

#: Series that are kept in memory at once before they are reduced to objectives. [bytes]
_IN_MEMORY: Final = 64 * 2**20
#: Members that the engine runs at once, in single precision; half as many in double.
_PACK: Final = 16
#: Weather of the compiled buildings that a worker keeps for the next chunks. [bytes]
_MOST_COMPILED: Final = 256 * 2**20


@dataclass(frozen=True)
class EnsembleInputs:
    """All that the members have in common; it is sent to every worker.

    Attributes
    ----------
    building : Building
        The building; values that all members have in common are in it.
    climate : Climate
        Its weather.
    options : RunOptions
        Options of the runs.
    ranges : mapping of str to (float, float)
        Ranges of the samples, so that every worker chooses the same mesh. [unit of each]
    objectives : mapping of str to callable
        What is kept of each member instead of its series: functions of a Dataset over (member, time).
    precision : str
        Of the runs: ``double`` or ``single``.
    identity : str
        Hash of all this; a worker finds its compiled buildings by it.
    """

    building: Building
    climate: Climate
    options: RunOptions
    ranges: Mapping[str, tuple[float, float]]
    objectives: Mapping[str, Objective]
    precision: Precision
    identity: str

    def compiled(self, structure: Mapping[str, Any]) -> Simulation:
        """Compile the building with a structure in the climate."""
        building = variant(self.building, structure) if structure else self.building
        return Simulation(building, self.climate, **self.options.keywords(), ranges=self.ranges)

    def simulation(self, structure: Mapping[str, Any]) -> Simulation:
        """The same, kept for the next chunk."""
        key = (self.identity, repr(sorted(structure.items())))
        if key not in _COMPILED:
            self.keep(structure, self.compiled(structure))
        _COMPILED.move_to_end(key)
        return _COMPILED[key]

    def keep(self, structure: Mapping[str, Any], simulation: Simulation) -> None:
        """Keep what was compiled for a structure; those of the oldest chunks are dropped."""
        _COMPILED[self.identity, repr(sorted(structure.items()))] = simulation
        held = sum(simulation.compiled.forcing_blocks.nbytes for simulation in _COMPILED.values())
        while held > _MOST_COMPILED and len(_COMPILED) > 1:
            held -= _COMPILED.popitem(last=False)[1].compiled.forcing_blocks.nbytes


_COMPILED: OrderedDict[tuple[str, str], Simulation] = OrderedDict()


@dataclass(frozen=True)
class Chunk:
    """Results of a chunk of members.

    Attributes
    ----------
    first : int
        Its first member.
    recorded : ndarray, shape (members, rows, outputs) or (members, objectives)
        Series, or objectives where there are some; NaN for a member that failed. [unit of each]
    closure : ndarray, shape (members,)
        Relative energy-balance residual. [-]
    outside : ndarray, shape (members,)
        How far temperatures are beyond their causes, see `Judgement`. [K]
    failures : mapping of int to str
        Members that failed, counted from the start of the ensemble, and why.
    step_errors : ndarray, shape (members,)
        Error of an air by the time step, as of `mascarin.simulation.checks.step_check`; NaN where none was
        recorded. [K]
    beyond : ndarray, shape (members,)
        Steps in which a law written as text did not hold, see `EnsembleRun`.
    """

    first: int
    recorded: Array
    closure: Array
    outside: Array
    failures: Mapping[int, str]
    step_errors: Array
    beyond: Array

    @property
    def judged(self) -> tuple[Array, Array, Array, Array]:
        """By what members are judged, in the order of `of_members`."""
        return self.closure, self.outside, self.step_errors, self.beyond


def run_chunk(
    inputs: EnsembleInputs, members: Members, first: int, report: Callable[[int], object] | None = None
) -> Chunk:
    """Run a chunk of members.

    Parameters
    ----------
    inputs : EnsembleInputs
        What they have in common.
    members : Members
        The chunk.
    first : int
        Position of its first member in the ensemble.
    report : callable, optional
        Called with the number of members done.
    """
    values: Array | None = None
    closure, outside, step_errors, beyond = np.full((4, members.count), np.nan)
    failures: dict[int, str] = {}
    done = 0
    for structure, rows in members.groups():
        try:
            simulation = inputs.simulation(structure)
        except MascarinError as error:
            # Such as a period that the climate of another place does not cover: the others go on.
            failures |= {first + row: str(error) for row in rows}
            continue
        for batch in _batches(inputs, simulation, rows):
            vectors = _vectors(simulation, members, batch)
            before = done
            call = None if report is None else (lambda count, _, before=before: report(before + count))
            run = simulation.ensemble(vectors, precision=inputs.precision, progress=call)
            objectives = _reduced(inputs, simulation, run.records)
            if values is None:
                values = np.full((members.count, *objectives.shape[1:]), np.nan)
            values[batch], closure[batch], outside[batch] = objectives, run.residuals, run.outside
            beyond[batch] = run.beyond
            # The error of steps that are chosen is estimated before the run.
            if simulation.sequence is None:
                step_errors[batch] = member_errors(
                    simulation.building, simulation.outputs, run.records, simulation.scheme
                )
            failures |= {first + batch[failure.member]: failure.reason for failure in run.failures}
            for failure in run.failures:
                values[batch[failure.member]] = np.nan
            done += len(batch)
    if values is None:
        width = len(inputs.objectives) if inputs.objectives else 0
        values = np.full((members.count, width), np.nan)
    return Chunk(first, values, closure, outside, dict(sorted(failures.items())), step_errors, beyond)


def attributes(name: str, unit: str) -> dict[str, str]:
    """Attributes of a variable: its name, and its unit where it has one."""
    return {"long_name": name, **({"units": unit} if unit else {})}


def dataset(outputs: list[Output], index: pd.DatetimeIndex, records: Array) -> xr.Dataset:
    """Series by name over (member, time); times as in all results."""
    import xarray as xr

    from mascarin.simulation.records.series import RunDataset

    return RunDataset(
        {
            output.name: xr.DataArray(
                records[:, :, k],
                dims=("member", "time"),
                attrs=attributes(output.name, output.unit),
            )
            for k, output in enumerate(outputs)
        },
        coords=time_coordinates(index),
        attrs={"timezone": str(index.tz)},
    )


def _batches(inputs: EnsembleInputs, simulation: Simulation, rows: list[int]) -> list[list[int]]:
    """Members that are run at once: all, or as many as have room in memory with their series."""
    size = len(rows)
    if inputs.objectives:
        row = 8 * len(simulation.index) * len(simulation.outputs)
        size = max(_IN_MEMORY // row // _PACK * _PACK, _PACK)
    return [rows[k : k + size] for k in range(0, len(rows), size)]


def _vectors(simulation: Simulation, members: Members, rows: list[int]) -> Array:
    vectors = np.tile(simulation.values, (len(rows), 1))
    for path, column in members.numbers.items():
        simulation.assign(vectors, path, column[rows])
    return vectors


def _reduced(inputs: EnsembleInputs, simulation: Simulation, records: Array) -> Array:
    """Series, or the objectives calculated from them."""
    if not inputs.objectives:
        return records
    series = dataset(simulation.outputs, simulation.index, records)
    columns = []
    for name, objective in inputs.objectives.items():
        try:
            column = np.asarray(objective(series), dtype=np.float64)
        except _engine.EngineDefect:
            raise
        except Exception as error:  # a function of the user can raise anything
            raise InputError(f"objective '{name}' failed: {error!r}") from error
        if column.shape != (len(records),):
            raise InputError(
                f"objective '{name}': found a result of shape {column.shape}, expected one number for each "
                f"of {len(records)} members: reduce over time, for example with .max('time')"
            )
        columns.append(column)
    return np.stack(columns, axis=-1)
