"""Ensembles: many members of one building in one climate."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin import __version__
from mascarin.ensemble.members import Members
from mascarin.ensemble.members import members as read_members
from mascarin.ensemble.store import Store
from mascarin.ensemble.work import CLOSURE, Objective, Piece, Recipe, dataset
from mascarin.ensemble.workers import elsewhere, here
from mascarin.errors import InputError, SolverError
from mascarin.progress import reporting
from mascarin.simulation.compiling import with_parameters
from mascarin.simulation.options import RunOptions, described
from mascarin.weather import summary

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.simulation.initial import Initial
    from mascarin.simulation.options import Scheme, TimeLike
    from mascarin.simulation.simulation import Simulation
    from mascarin.weather import Climate, Measurements


@described
def sweep(
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    *,
    parameters: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    measurements: Measurements | None = None,
    progress: ProgressOption = None,
    objectives: Mapping[str, Objective] | None = None,
    workers: int | Executor | None = None,
) -> xr.Dataset:
    """Run a building once for every row of samples; a member's bits do not depend on the others.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    samples : mapping or pandas.DataFrame
        Values by path, one for each member, shape (M,). A structural parameter may vary too, and so may a
        whole part of the description (``surfaces.roof.outside.convection: [tarp, mowitt]``): members of
        the same shape are run together. [unit of each]
    <run options>
    objectives : mapping of str to callable, optional
        What to keep of each member instead of its series: functions of a Dataset of the outputs over (member,
        time) that give one number a member, such as ``lambda run: run["room.air_temperature"].max("time")``.
        With workers they must be functions of a module, which can travel.
    workers : int or concurrent.futures.Executor, optional
        Processes of this machine, or an executor: of dask.distributed (``client.get_executor()``), of
        mpi4py.futures, or any other. Default: the threads of this process.

    Returns
    -------
    xarray.Dataset
        Each output over (member, time), or each objective over (member); the samples as ``samples`` over
        (member, parameter), or as ``sample: <path>`` over (member) where they are not all plain numbers;
        `closure` [-]. NaN for a member that failed, with its reason in the attribute `failures`.

    Raises
    ------
    InputError
        Unknown path, columns of different lengths, a value that the parameter cannot have.
    SolverError
        Every member failed, or a stretch of members kills its workers.
    """
    import xarray as xr

    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    recipe, found = _prepared(building, climate, samples, options, objectives)
    with reporting(progress, "members") as report:
        pieces = _pieces(recipe, found, [(0, found.count)], workers, lambda done: report(done, found.count))
        whole, closure, failures = _gathered(found, pieces)
    if len(failures) == found.count:
        raise SolverError(f"all {found.count} members failed; the first: {failures[0]}")
    return (
        _dataset(recipe, found, whole)
        .assign(closure=xr.DataArray(closure, dims="member", attrs=CLOSURE))
        .assign_attrs(failures=[f"member {member}: {reason}" for member, reason in sorted(failures.items())])
    )


@described
def sweep_into(
    store: Path,
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    *,
    parameters: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    measurements: Measurements | None = None,
    progress: ProgressOption = None,
    objectives: Mapping[str, Objective] | None = None,
    workers: int | Executor | None = None,
    seed: int | None = None,
) -> Store:
    """Run an ensemble into a folder; killed at any moment and called again it goes on where it was.

    Parameters
    ----------
    store : Path
        Folder: new, empty, or with the same ensemble half done.
    building, climate, samples, objectives, workers
        As in `sweep`.
    <run options>
    seed : int, optional
        Seed that the samples were drawn with, for the manifest.

    Returns
    -------
    Store
        The complete ensemble. Members that failed are in it with their reason.

    Raises
    ------
    InputError
        As `sweep`; also a folder with something else in it.
    SolverError
        A stretch of members kills its workers; what is finished is kept.
    """
    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    recipe, found = _prepared(building, climate, samples, options, objectives)
    kept = Store.begin(store, _manifest(recipe, found, seed))
    before = kept.done
    with reporting(progress, "members") as report:
        told = lambda done: report(before + done, found.count)  # noqa: E731 (one line, used once)
        for piece in _pieces(recipe, found, kept.gaps(), workers, told):
            kept.add(piece, found.part(piece.first, piece.first + len(piece.closure)))
    kept.finish()
    return kept


def _prepared(
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    options: RunOptions,
    objectives: Mapping[str, Objective] | None,
) -> tuple[Recipe, Members]:
    """What the members share, with its hash, and the members.

    The first shape is compiled, so that what cannot be used is found before anything is run.
    """
    building = with_parameters(building, options.parameters)
    members = read_members(building, samples)
    recipe = Recipe(
        building=building,
        climate=climate,
        options=replace(options, parameters=None),
        ranges=members.ranges,
        objectives=dict(objectives or {}),
        identity="",
    )
    clash = set(recipe.objectives) & {"member", "closure", "failure", "samples"}
    if clash:
        raise InputError(f"objectives: '{clash.pop()}' is the name of something else; choose another")
    whole = hashlib.sha256(recipe.compiled(_first_shape(members)).identity.encode())
    whole.update(repr([sorted(recipe.ranges.items()), list(recipe.objectives)]).encode())
    return replace(recipe, identity=whole.hexdigest()), members


def _first_shape(members: Members) -> dict[str, Any]:
    return {path: values[0] for path, values in members.shapes.items()}


def _first(recipe: Recipe, members: Members) -> Simulation:
    return recipe.simulation(_first_shape(members))


def _pieces(
    recipe: Recipe,
    members: Members,
    gaps: list[tuple[int, int]],
    workers: int | Executor | None,
    report: Callable[[int], object] | None,
) -> Iterator[Piece]:
    if workers is None:
        return here(recipe, members, gaps, report)
    if isinstance(workers, int) and (isinstance(workers, bool) or workers < 1):
        raise InputError(f"workers: found {workers}; expected a number of processes, 1 or more")
    return elsewhere(recipe, members, gaps, workers, report)


def _gathered(members: Members, pieces: Iterator[Piece]) -> tuple[Any, Any, dict[int, str]]:
    """Results of all members in one array."""
    whole: Any = None
    closure = np.full(members.count, np.nan)
    failures: dict[int, str] = {}
    for piece in pieces:
        place = slice(piece.first, piece.first + len(piece.closure))
        if whole is None and piece.kept.size:
            whole = np.full((members.count, *piece.kept.shape[1:]), np.nan)
        if whole is not None and piece.kept.size:
            whole[place] = piece.kept
        closure[place] = piece.closure
        failures |= piece.failures
    return whole, closure, failures


def _dataset(recipe: Recipe, members: Members, values: Any) -> xr.Dataset:
    import xarray as xr

    simulation = _first(recipe, members)
    if recipe.objectives:
        columns = {name: ("member", values[:, k]) for k, name in enumerate(recipe.objectives)}
        data = xr.Dataset(columns, attrs={"timezone": str(simulation.index.tz)})
    else:
        data = dataset(simulation.outputs, simulation.index, values)
    data = data.assign_coords(member=np.arange(members.count)).assign_attrs(mascarin_version=__version__)
    units = {path: _unit(recipe.building, path) for path in members.paths}
    if members.shapes:
        everything: dict[str, Any] = {**members.numbers, **members.shapes}
        found = {
            f"sample: {path}": ("member", column, {"units": units[path]} if units[path] else {})
            for path, column in everything.items()
        }
        return data.assign(found)
    samples = xr.DataArray(np.column_stack(list(members.numbers.values())), dims=("member", "parameter"))
    coordinates = {"parameter": members.paths, "parameter_unit": ("parameter", list(units.values()))}
    return data.assign_coords(coordinates).assign(samples=samples)


def _unit(building: Building, path: str) -> str:
    """Unit of a parameter; none of a whole part."""
    try:
        return building.parameter(path).unit
    except InputError:
        return ""


def _manifest(recipe: Recipe, members: Members, seed: int | None) -> dict[str, Any]:
    simulation = _first(recipe, members)
    units = {output.name: output.unit for output in simulation.outputs}
    times = simulation.index.tz_convert("UTC").tz_localize(None)
    return {
        "mascarin_version": __version__,
        "building": recipe.building.name,
        "climate": summary(recipe.climate),
        "identity": recipe.identity,
        "samples": members.digest(),
        "members": members.count,
        "paths": members.paths,
        "seed": seed,
        "outputs": [output.name for output in simulation.outputs],
        "objectives": list(recipe.objectives),
        "kept": dict.fromkeys(recipe.objectives, "") if recipe.objectives else units,
        "step_seconds": simulation.step_seconds,
        "scheme": recipe.options.scheme,
        "timezone": str(simulation.index.tz),
        "time": [] if recipe.objectives else [str(time) for time in times],
    }
