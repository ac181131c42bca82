"""Sensitivity of a building: its parameters as factors, and the runs made."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

from mascarin.errors import InputError, SolverError
from mascarin.sensitivity.factors import DistributionName, Factor
from mascarin.sensitivity.methods import MethodName, plan
from mascarin.sensitivity.result import Sensitivity
from mascarin.simulation.simulation import Simulation
from mascarin.weather.table import seconds_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.simulation.options import TimeLike
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]

_T = TypeVar("_T")
_BATCH = 256


def factors_of(
    building: Building,
    *,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    distributions: Mapping[str, DistributionName] | None = None,
    groups: Mapping[str, Sequence[str]] | None = None,
    leave_out: Sequence[str] = (),
    only: Sequence[str] | None = None,
) -> list[Factor]:
    """All parameters of a building that act and have a range, as factors.

    A number that the description knows to be idle (a wind exponent where no film depends on wind) takes no
    part: its share is zero, and an estimate could only add noise to that.

    Parameters
    ----------
    building : Building
        Gives paths, ranges and units.
    ranges : mapping of str to (float, float), optional
        Ranges in the place of the building's. [unit of each]
    distributions : mapping of str to str, optional
        Distributions; uniform where absent.
    groups : mapping of str to sequence of str, optional
        Name -> paths that are judged together.
    leave_out : sequence of str
        Paths that stay at their value.
    only : sequence of str, optional
        Paths that take part; all when absent.

    Raises
    ------
    InputError
        Unknown or structural path, a range beyond what the parameter can be, a path in two groups, or no
        parameter left.
    """
    spans = {path: checked_range(building, path, span) for path, span in _resolved(building, ranges).items()}
    shapes = _resolved(building, distributions)
    group_of = _members(building, groups or {})
    fixed = {building.parameter(path).path for path in leave_out}
    chosen = None if only is None else {building.parameter(path).path for path in only}
    found = []
    for parameter in building.parameters():
        path = parameter.path
        low, high = spans.get(path, (parameter.low, parameter.high))
        wanted = path not in fixed and (chosen is None or path in chosen)
        if parameter.reason is None and wanted and low < high:
            shape = shapes.get(path, "uniform")
            found.append(Factor(path, low, high, parameter.unit, shape, group_of.get(path)))
    if not found:
        raise InputError(
            "found no parameter with a range, expected at least one; give ranges: {path: [low, high]}"
        )
    return found


def screen(
    building: Building,
    climate: Climate,
    *,
    outputs: Sequence[str],
    method: MethodName = "spectral",
    parameters: Sequence[str] | None = None,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    distributions: Mapping[str, DistributionName] | None = None,
    groups: Mapping[str, Sequence[str]] | None = None,
    leave_out: Sequence[str] = (),
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    interval: str | float = "1h",
    scheme: Literal["sdirk2", "backward-euler", "apparent-capacity"] = "sdirk2",
    measurements: Measurements | None = None,
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
    progress: Callable[[int, int], object] | None = None,
) -> Sensitivity:
    """Find which parameters of a building matter for some of its outputs.

    Parameters
    ----------
    building, climate, outputs, start, end, step, scheme, measurements
        As in `mascarin.simulate`.
    method, replicates, samples, order, seed
        As in `mascarin.sensitivity.plan`.
    parameters : sequence of str, optional
        Paths that take part; every parameter with a range when absent.
    ranges, distributions, groups, leave_out
        As in `factors_of`.
    interval : str or float
        Spacing of the outputs that are analysed. [s]
    progress : callable, optional
        Called with the number of runs done and their total.

    Returns
    -------
    Sensitivity
        Shares with intervals and signed effects.

    Raises
    ------
    InputError
        Anything that cannot be used, before anything is run.
    SolverError
        A run failed; the text names its parameters.
    """
    chosen = factors_of(
        building, ranges=ranges, distributions=distributions, groups=groups, leave_out=leave_out,
        only=parameters,
    )  # fmt: skip
    runs = plan(chosen, method, replicates=replicates, samples=samples, order=order, seed=seed)
    simulation = Simulation(
        building,
        climate,
        step=step,
        start=start,
        end=end,
        outputs=outputs,
        scheme=scheme,
        measurements=measurements,
        ranges={factor.path: (factor.low, factor.high) for factor in chosen},
    )
    every = max(1, round(seconds_of(interval, "interval") / simulation.step_seconds))
    collector = runs.collector(
        [output.name for output in simulation.outputs], [output.unit for output in simulation.outputs]
    )
    for replicate in range(runs.replicates):
        x = runs.samples(replicate)
        for row in range(0, runs.runs, _BATCH):
            first = replicate * runs.runs + row
            collector.add(first, made(simulation, runs.paths, x[row : row + _BATCH], first, every=every))
            if progress is not None:
                progress(min(first + _BATCH, (replicate + 1) * runs.runs), len(runs))
    return collector.result()


def made(
    simulation: Simulation,
    paths: Sequence[str],
    samples: Array,
    first: int,
    *,
    start: int = 0,
    every: int = 1,
) -> Array:
    """Outputs of consecutive runs.

    Parameters
    ----------
    simulation : Simulation
        What is run.
    paths : sequence of str, length P
        Columns of the samples.
    samples : ndarray, shape (m, P)
        Parameter values. [unit of each]
    first : int
        Number of the first run, for messages.
    start, every : int
        First recorded row and spacing of the recorded rows, in steps.

    Returns
    -------
    ndarray, shape (m, T, S)
        [unit of each output]

    Raises
    ------
    SolverError
        A run failed; the text names its parameters.
    """
    vectors = np.tile(simulation.vector({}), (len(samples), 1))
    vectors[:, [simulation.position(path) for path in paths]] = samples
    records, _, failures = simulation.ensemble(vectors, record_from=start, record_every=every)
    if failures:
        worst = failures[0]
        raise SolverError(
            f"sensitivity: run {first + worst.member} failed: {worst.reason} Its parameters: "
            + ", ".join(f"{p}={v:g}" for p, v in zip(paths, samples[worst.member], strict=True))
        )
    return records


def checked_range(building: Building, path: str, span: tuple[float, float]) -> tuple[float, float]:
    """A range, refused when the parameter cannot have it.

    Raises
    ------
    InputError
        Unknown or structural path, a range the wrong way round or beyond what the parameter can be.
    """
    parameter, (low, high) = building.parameter(path), span
    if parameter.structural:
        raise InputError(f"{path}: is structural ({parameter.reason}) and cannot be varied; leave it out")
    if not parameter.lower <= low < high <= parameter.upper:
        raise InputError(
            f"{path}: found [{low:g}, {high:g}] {parameter.unit}, expected a lower and a higher value from "
            f"{parameter.lower:g} to {parameter.upper:g}; correct the range"
        )
    return low, high


def _resolved(building: Building, given: Mapping[str, _T] | None) -> dict[str, _T]:
    """The same by the paths that the building itself uses."""
    return {building.parameter(path).path: value for path, value in (given or {}).items()}


def _members(building: Building, groups: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """Group of each path that is in one."""
    found: dict[str, str] = {}
    for name, paths in groups.items():
        for given in paths:
            path = building.parameter(given).path
            if path in found:
                raise InputError(f"{given}: is in the groups {found[path]} and {name}; expected one of them")
            found[path] = name
    return found
