"""Ensembles: many members of one building in one climate."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.ensemble.members import Members
from mascarin.ensemble.members import members as read_members
from mascarin.ensemble.store import Store
from mascarin.ensemble.work import Objective, Piece, Recipe
from mascarin.ensemble.workers import elsewhere, here
from mascarin.errors import InputError, SolverError

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building
    from mascarin.simulation.initial import Initial
    from mascarin.simulation.simulation import Scheme, Simulation
    from mascarin.weather import Climate, Measurements


def sweep(
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    *,
    outputs: Sequence[str],
    objectives: Mapping[str, Objective] | None = None,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    measurements: Measurements | None = None,
    workers: int | Executor | None = None,
    report: Callable[[int], object] | None = None,
) -> xr.Dataset:
    """Run a building once for every row of samples; a member's bits do not depend on the others.

    Parameters
    ----------
    building, climate, outputs, step, start, end, scheme, initial, measurements
        As in `Simulation`.
    samples : mapping or pandas.DataFrame
        Path -> values, one for each member, shape (M,). A structural parameter may vary too, and so may a
        whole part of the description (``surfaces.roof.outside.convection: [tarp, mowitt]``): members of
        the same shape are run together. [unit of each]
    objectives : mapping of str to callable, optional
        What to keep of each member instead of its series: functions of a Dataset of the outputs over (member,
        time) that give one number a member, such as ``lambda run: run["room.air_temperature"].max("time")``.
        With workers they must be functions of a module, which can travel.
    workers : int or concurrent.futures.Executor, optional
        Processes of this machine, or an executor: of dask.distributed (``client.get_executor()``), of
        mpi4py.futures, or any other. Default: the threads of this process.
    report : callable, optional
        Called with the number of members done.

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

    found = read_members(building, samples)
    recipe = _recipe(
        building, climate, found, outputs=outputs, objectives=objectives, step=step, start=start, end=end,
        scheme=scheme, initial=initial, measurements=measurements,
    )  # fmt: skip
    whole, closure, failures = _gathered(found, _pieces(recipe, found, [(0, found.count)], workers, report))
    if len(failures) == found.count:
        raise SolverError(f"all {found.count} members failed; the first: {failures[0]}")
    return (
        _dataset(recipe, found, whole)
        .assign(closure=xr.DataArray(closure, dims="member"))
        .assign_attrs(failures=[f"member {member}: {reason}" for member, reason in sorted(failures.items())])
    )


def sweep_into(
    store: Path,
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    *,
    outputs: Sequence[str],
    objectives: Mapping[str, Objective] | None = None,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    measurements: Measurements | None = None,
    workers: int | Executor | None = None,
    seed: int | None = None,
    report: Callable[[int], object] | None = None,
) -> Store:
    """Run an ensemble into a folder; killed at any moment and called again it goes on where it was.

    Parameters
    ----------
    store : Path
        Folder: new, empty, or with the same ensemble half done.
    building, climate, samples, outputs, objectives, step, start, end, scheme, initial, measurements, workers
        As in `sweep`.
    seed : int, optional
        Seed that the samples come from, for the manifest.
    report : callable, optional
        Called with the number of members done, those of earlier calls included.

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
    found = read_members(building, samples)
    recipe = _recipe(
        building, climate, found, outputs=outputs, objectives=objectives, step=step, start=start, end=end,
        scheme=scheme, initial=initial, measurements=measurements,
    )  # fmt: skip
    kept = Store.begin(store, _manifest(recipe, found, seed))
    before = kept.done
    tell = None if report is None else (lambda done: report(before + done))
    for piece in _pieces(recipe, found, kept.gaps(), workers, tell):
        kept.add(piece, found.part(piece.first, piece.first + len(piece.closure)))
    kept.finish()
    return kept


def _recipe(building: Building, climate: Climate, members: Members, **options: Any) -> Recipe:
    """What the members share, with its hash. The first shape is compiled, so that faults show at once."""
    recipe = Recipe(
        building=building,
        climate=climate,
        ranges=members.ranges,
        objectives=dict(options.pop("objectives") or {}),
        outputs=tuple(options.pop("outputs")),
        identity="",
        **options,
    )
    clash = set(recipe.objectives) & {"member", "closure", "failure", "samples"}
    if clash:
        raise InputError(f"objectives: '{clash.pop()}' is the name of something else; choose another")
    import hashlib

    whole = hashlib.sha256(recipe.compiled(_first_shape(members)).identity.encode())
    whole.update(repr([sorted(recipe.ranges.items()), list(recipe.objectives)]).encode())
    return replace(recipe, identity=whole.hexdigest())


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

    from mascarin.ensemble.work import dataset

    simulation = _first(recipe, members)
    if recipe.objectives:
        columns = {name: ("member", values[:, k]) for k, name in enumerate(recipe.objectives)}
        data = xr.Dataset(columns, attrs={"timezone": str(simulation.index.tz)})
    else:
        data = dataset(simulation.outputs, simulation.index, values)
    data = data.assign_coords(member=np.arange(members.count))
    if members.shapes:
        everything: dict[str, Any] = {**members.numbers, **members.shapes}
        return data.assign({f"sample: {path}": ("member", column) for path, column in everything.items()})
    samples = xr.DataArray(np.column_stack(list(members.numbers.values())), dims=("member", "parameter"))
    return data.assign_coords(parameter=members.paths).assign(samples=samples)


def _manifest(recipe: Recipe, members: Members, seed: int | None) -> dict[str, Any]:
    from mascarin import __version__
    from mascarin.weather import summary

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
        "outputs": list(recipe.outputs),
        "objectives": list(recipe.objectives),
        "kept": dict.fromkeys(recipe.objectives, "") if recipe.objectives else units,
        "step_seconds": simulation.step_seconds,
        "scheme": recipe.scheme,
        "timezone": str(simulation.index.tz),
        "time": [] if recipe.objectives else [str(time) for time in times],
    }
