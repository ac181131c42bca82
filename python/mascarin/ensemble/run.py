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
from mascarin._io import memory
from mascarin._io.arguments import kind_of, mapping_of
from mascarin._io.locks import FolderLock
from mascarin.ensemble.members import Members
from mascarin.ensemble.members import members as read_members
from mascarin.ensemble.objectives import Statistic
from mascarin.ensemble.store import Store
from mascarin.ensemble.work import (
    CLOSURE,
    Chunk,
    EnsembleInputs,
    Objective,
    attributes,
    dataset,
    run_chunk,
)
from mascarin.ensemble.workers import elsewhere, here
from mascarin.errors import InputError, SolverError
from mascarin.progress import reporting
from mascarin.simulation.checks.judgement import OUTSIDE
from mascarin.simulation.nominal import of_nominal
from mascarin.simulation.preparation.options import RunOptions, described, require_precision
from mascarin.simulation.preparation.prepare import in_climate
from mascarin.simulation.run_warnings import of_base, of_members
from mascarin.simulation.single_precision import Difference, differences, members_to_check, run_in_double
from mascarin.weather import summary, summary_of_measurements

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.simulation.preparation.options import Precision, Scheme, TimeLike
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
    precision: Precision = "double",
    objectives: Mapping[str, Objective | str] | None = None,
    workers: int | Executor | None = None,
) -> xr.Dataset:
    """Run a building once for every row of samples; the results of a member do not depend on the others.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    samples : mapping or pandas.DataFrame
        Values by path, one for each member, shape (M,). A structural parameter may vary too, and so may a
        whole part of the description (``surfaces.roof.outside.convection: [tarp, mowitt]``): members of
        the same structure are run together. [unit of each]
    <run options>
    precision : str
        ``double``, or ``single`` to screen many members: twice as many at a time, within some thousandths of
        a kelvin. The difference is measured in some members.
    objectives : mapping of str to str or callable, optional
        What to keep of each member instead of its series: texts such as ``max:room.air_temperature`` (min,
        mean, max, sd) and ``above:26:room.operative_temperature`` (above, below: hours), or functions of a
        Dataset of the outputs over (member, time) that give one number a member. Outputs of texts are
        recorded without being asked for. With workers, functions must be those of a module.
    workers : int or concurrent.futures.Executor, optional
        Processes of this machine, or an executor: of dask.distributed (``client.get_executor()``), of
        mpi4py.futures, or any other. Default: the threads of this process.

    Returns
    -------
    xarray.Dataset
        Each output over (member, time), or each objective over (member); the samples as ``samples`` over
        (member, parameter), or as ``sample: <path>`` over (member) where they are not all plain numbers;
        ``closure``, the relative energy-balance residual [-]; ``outside``, how far temperatures are beyond
        their causes [K], zero or less in a sound member. NaN for a member that failed, with its reason in the
        attribute ``failures``; the attribute ``warnings`` has what holds for members (an energy balance that
        does not close, temperatures without a cause, a step too long for the air of a zone) and the warnings
        of one more run with the values of the building. In single precision ``single_precision`` says how far
        each output or objective of some members is from double precision. Coordinates ``time`` (UTC) and
        ``local_time``; `sel` takes times with an offset, as that of a run.

    Raises
    ------
    InputError
        Unknown path, columns of different lengths, a value that the parameter cannot have.
    SolverError
        Every member failed, or the workers of a chunk of members died three times.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> samples = {"surfaces.facade.outside.absorptance": [0.3, 0.6, 0.9]}
    >>> found = mc.sweep(box(), box_climate(), samples, step="1h", outputs=["room.air_temperature"])
    >>> found["room.air_temperature"].dims
    ('member', 'time')
    """
    import xarray as xr

    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    inputs, members_read = _prepared(building, climate, samples, options, objectives, precision)
    _require_room(inputs, members_read)
    order = members_read.by_structure()
    with reporting(progress, "members") as report:
        members, judged, failures = _gathered(
            order,
            _chunks(
                inputs,
                members_read.taken(order),
                [(0, members_read.count)],
                workers,
                lambda done: report(done, members_read.count),
            ),
        )
    if len(failures) == members_read.count:
        raise SolverError(f"all {members_read.count} members failed; the first: {failures[0]}")
    first = _first(inputs, members_read)
    return (
        _dataset(inputs, members_read, members)
        .assign(
            closure=xr.DataArray(judged[0], dims="member", attrs=CLOSURE),
            outside=xr.DataArray(judged[1], dims="member", attrs=OUTSIDE),
        )
        .assign_attrs(
            failures=[f"member {member}: {reason}" for member, reason in sorted(failures.items())],
            # Plain texts: files of xarray take no others.
            warnings=[
                *map(str, of_members(*judged, step_seconds=first.step_seconds, precision=precision)),
                *map(str, of_base(of_nominal(first))),
            ],
            **({} if precision == "double" else {"single_precision": _said(inputs, members_read, judged[0])}),
        )
    )


@described
def sweep_into(
    store: str | Path,
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
    precision: Precision = "double",
    objectives: Mapping[str, Objective | str] | None = None,
    workers: int | Executor | None = None,
    seed: int | None = None,
    ranges: Mapping[str, tuple[float, float]] | None = None,
) -> Store:
    """Run an ensemble into a folder; called again after it was stopped, it continues.

    The folder is locked while the ensemble runs: a second process stops at once with an error.

    Parameters
    ----------
    store : str or Path
        Folder: new, empty, or with an unfinished ensemble of the same inputs.
    building, climate, samples
        As in `sweep`.
    <run options>
    precision, objectives, workers
        As in `sweep`.
    seed : int, optional
        Seed that the samples were drawn with, for the manifest.
    ranges : mapping of str to tuple of float, optional
        Wider ranges than those of the samples, by path. Stores with the same ranges have the same mesh, so
        that their members can be compared. [unit of each]

    Returns
    -------
    Store
        The complete ensemble, with the reasons of members that failed, and in single precision with the
        difference from double precision in some members.

    Raises
    ------
    InputError
        As `sweep`; also a folder with something else in it, or one that another process is writing to.
    SolverError
        The workers of a chunk of members died three times; finished chunks are kept.

    Examples
    --------
    >>> import tempfile
    >>> from mascarin.ensemble import Statistic, sweep_into
    >>> from mascarin.examples import box, box_climate
    >>> store = sweep_into(
    ...     Path(tempfile.mkdtemp()) / "july",
    ...     box(),
    ...     box_climate(),
    ...     {"zones.room.volume": [20.0, 30.0]},
    ...     objectives={"hottest": Statistic.read("max:room.air_temperature")},
    ...     step="1h",
    ... )
    >>> store.to_dataframe()["hottest"].round(1).size
    2
    """
    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    inputs, members_read = _prepared(building, climate, samples, options, objectives, precision, ranges)
    folder = Path(store)
    Store.require_usable(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with FolderLock(folder), reporting(progress, "members") as report:
        open_store = Store.begin(folder, _manifest(inputs, members_read, seed))
        before = open_store.done

        def count(done: int) -> object:
            return report(before + done, members_read.count)

        for chunk in _chunks(inputs, members_read, open_store.gaps(), workers, count):
            open_store.add(chunk, members_read.part(chunk.first, chunk.first + len(chunk.closure)))
        if not open_store.complete:
            open_store.finish(
                [] if precision == "double" else _differences(inputs, members_read),
                of_base(of_nominal(_first(inputs, members_read))),
            )
    return open_store


def _differences(inputs: EnsembleInputs, members: Members) -> list[Difference]:
    """How far results in single precision are from those in double precision, in some members."""
    some = members.taken(members_to_check(members.count))
    single, double = (
        run_chunk(replace(inputs, precision=precision), some, 0).recorded
        for precision in ("single", "double")
    )
    if inputs.objectives:
        return differences(list(inputs.objectives), [""] * len(inputs.objectives), single, double)
    outputs = _first(inputs, members).outputs
    return differences(
        [output.name for output in outputs], [output.unit for output in outputs], single, double
    )


def _said(inputs: EnsembleInputs, members: Members, closure: npt.NDArray[np.float64]) -> list[str]:
    return [*map(str, _differences(inputs, members)), *run_in_double(closure)]


def _functions(objectives: Mapping[str, Objective | str] | None) -> dict[str, Objective]:
    """Objectives as functions: texts are read."""
    expected = "texts or functions by name: {'peak': 'max:room.air_temperature'}"
    stated = mapping_of("objectives", objectives, expected)
    return {name: Statistic.read(each) if isinstance(each, str) else each for name, each in stated.items()}


def _recorded(
    outputs: Sequence[str] | None, objectives: Mapping[str, Objective], building: Building
) -> Sequence[str] | None:
    """What is recorded: what was asked for, and what statistics need beside it."""
    needed = [each.output for each in objectives.values() if isinstance(each, Statistic)]
    if not needed:
        return outputs
    if outputs is None and len(needed) == len(objectives):
        return list(dict.fromkeys(needed))
    usual = [output.name for output in building.outputs() if output.usual] if outputs is None else outputs
    return list(dict.fromkeys([*usual, *needed]))


def _prepared(
    building: Building,
    climate: Climate,
    samples: Mapping[str, npt.ArrayLike] | pd.DataFrame,
    options: RunOptions,
    objectives: Mapping[str, Objective | str] | None,
    precision: Precision,
    ranges: Mapping[str, tuple[float, float]] | None = None,
) -> tuple[EnsembleInputs, Members]:
    """What the members have in common, with its hash, and the members.

    The first structure is compiled, so that what cannot be used is found before anything is run.
    """
    # Anything with columns: a mapping, a pandas frame, and what has the same methods.
    if not hasattr(samples, "items"):
        raise InputError(
            f"samples: found {kind_of(samples)}, expected values by path, one for each member, such as "
            "{'zones.room.volume': [30, 40]}, or a pandas.DataFrame with paths as columns"
        )
    require_precision(precision, options.scheme)
    functions = _functions(objectives)
    options = replace(options, outputs=_recorded(options.outputs, functions, building))
    building = in_climate(
        building,
        climate,
        measurements=options.measurements,
        parameters=options.parameters,
        varied=[str(path) for path in samples],
    )
    members = read_members(building, samples)
    inputs = EnsembleInputs(
        building=building,
        climate=climate,
        options=replace(options, parameters=None),
        ranges=_joined(members.ranges, ranges or {}),
        objectives=functions,
        precision=precision,
        identity="",
    )
    clash = set(inputs.objectives) & {"member", "closure", "outside", "failure", "samples"}
    if clash:
        raise InputError(f"objectives: '{clash.pop()}' is a variable of every result; choose another name")
    structure = _first_structure(members)
    compiled = inputs.compiled(structure)
    digest = hashlib.sha256(compiled.identity.encode())
    digest.update(repr([sorted(inputs.ranges.items()), list(inputs.objectives), precision]).encode())
    inputs = replace(inputs, identity=digest.hexdigest())
    inputs.keep(structure, compiled)
    return inputs, members


def _joined(
    ranges: Mapping[str, tuple[float, float]], wider: Mapping[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    """Ranges that contain both."""
    joined = {path: tuple(bounds) for path, bounds in ranges.items()}
    for path, (low, high) in wider.items():
        bounds_of_path = joined.get(path, (low, high))
        joined[path] = (min(low, bounds_of_path[0]), max(high, bounds_of_path[1]))
    return {path: (low, high) for path, (low, high) in joined.items()}


def _require_room(inputs: EnsembleInputs, members: Members) -> None:
    """Refuse results of all members that memory does not hold."""
    simulation = _first(inputs, members)
    rows = 1 if inputs.objectives else len(simulation.index)
    columns = len(inputs.objectives) or len(simulation.outputs)
    memory.require(
        2.0 * 8.0 * members.count * rows * columns,  # of the members that ran last, and of all
        f"{members.count} members, each with {rows} x {columns} results,",
        "keep objectives instead of series, or sweep into a folder (sweep_into, 'mascarin sweep')",
    )


def _first_structure(members: Members) -> dict[str, Any]:
    return {path: values[0] for path, values in members.structures.items()}


def _first(inputs: EnsembleInputs, members: Members) -> Simulation:
    return inputs.simulation(_first_structure(members))


def _chunks(
    inputs: EnsembleInputs,
    members: Members,
    gaps: list[tuple[int, int]],
    workers: int | Executor | None,
    report: Callable[[int], object] | None,
) -> Iterator[Chunk]:
    if workers is None:
        return here(inputs, members, gaps, report)
    if isinstance(workers, int) and (isinstance(workers, bool) or workers < 1):
        raise InputError(f"workers: found {workers}; expected a number of processes, 1 or more")
    return elsewhere(inputs, members, gaps, workers, report)


def _gathered(order: Sequence[int], chunks: Iterator[Chunk]) -> tuple[Any, Any, dict[int, str]]:
    """Results of all members, and by what they are judged; chunks have them in another order."""
    array: Any = None
    judged = np.full((4, len(order)), np.nan)
    failures: dict[int, str] = {}
    for chunk in chunks:
        members = order[chunk.first : chunk.first + len(chunk.closure)]
        if array is None and chunk.recorded.size:
            array = np.full((len(order), *chunk.recorded.shape[1:]), np.nan)
        if array is not None and chunk.recorded.size:
            array[members] = chunk.recorded
        judged[:, members] = chunk.judged
        failures |= {order[member]: reason for member, reason in chunk.failures.items()}
    return array, judged, failures


def _dataset(inputs: EnsembleInputs, members: Members, values: Any) -> xr.Dataset:
    import xarray as xr

    simulation = _first(inputs, members)
    if inputs.objectives:
        columns = {name: ("member", values[:, k]) for k, name in enumerate(inputs.objectives)}
        data = xr.Dataset(columns, attrs={"timezone": str(simulation.index.tz)})
    else:
        data = dataset(simulation.outputs, simulation.index, values)
    data = data.assign_coords(member=np.arange(members.count)).assign_attrs(mascarin_version=__version__)
    units = {path: _unit(inputs.building, path) for path in members.paths}
    if members.structures:
        everything: dict[str, Any] = {**members.numbers, **members.structures}
        variables = {
            f"sample: {path}": ("member", column, attributes(path, units[path]))
            for path, column in everything.items()
        }
        return data.assign(variables)
    samples = xr.DataArray(np.column_stack(list(members.numbers.values())), dims=("member", "parameter"))
    coordinates = {"parameter": members.paths, "parameter_unit": ("parameter", list(units.values()))}
    return data.assign_coords(coordinates).assign(samples=samples)


def _unit(building: Building, path: str) -> str:
    """Unit of a parameter; none of a whole part."""
    try:
        return building.parameter(path).unit
    except InputError:
        return ""


def _manifest(inputs: EnsembleInputs, members: Members, seed: int | None) -> dict[str, Any]:
    simulation = _first(inputs, members)
    measured = inputs.options.measurements
    units = {output.name: output.unit for output in simulation.outputs}
    times = simulation.index.tz_convert("UTC").tz_localize(None)
    return {
        "mascarin_version": __version__,
        "building": inputs.building.name,
        "climate": summary(inputs.climate),
        "measurements": None if measured is None else summary_of_measurements(measured),
        "identity": inputs.identity,
        "samples": members.digest(),
        "members": members.count,
        "paths": members.paths,
        "sample_units": {path: _unit(inputs.building, path) for path in members.paths},
        "seed": seed,
        "outputs": [output.name for output in simulation.outputs],
        "objectives": list(inputs.objectives),
        "kept": dict.fromkeys(inputs.objectives, "") if inputs.objectives else units,
        "step_seconds": simulation.step_seconds,
        "scheme": inputs.options.scheme,
        "precision": inputs.precision,
        "timezone": str(simulation.index.tz),
        "time": [] if inputs.objectives else [str(time) for time in times],
    }
