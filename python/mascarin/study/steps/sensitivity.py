"""Sensitivity analysis of a study: runs in chunks of about a second, each saved when it is done."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.building.parameters.ties import expanded
from mascarin.errors import InputError
from mascarin.sensitivity.building_analysis import checked_range, factors_of, run_samples
from mascarin.sensitivity.methods import collector
from mascarin.sensitivity.methods import plan as design
from mascarin.simulation.checks.judgement import ensemble_warnings

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.progress import Report
    from mascarin.sensitivity import Factor, Sensitivity
    from mascarin.sensitivity.methods import Plan
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.file.description import SensitivityPlan
    from mascarin.study.file.field_types import Duration
    from mascarin.study.file.locations import Places
    from mascarin.study.context.storage import Workspace

    Array = npt.NDArray[np.float64]

#: Work that is lost at most when a study is killed, where the runs are short. [s]
CHUNK_SECONDS: Final = 1.0
#: The engine solves eight members at once on each processor: fewer would take as long.
_PACK: Final = 8


def check_plan(building: Building, plan: SensitivityPlan, places: Places) -> None:
    """Check the parameters of a plan.

    Raises
    ------
    InputError
        Unknown or structural path, a reversed range, a range beyond the limits of the parameter, or an
        interval that is no whole number of steps.
    """
    if plan.step is not None:
        with places.blame("sensitivity", "step"):
            _require_whole(plan.interval, plan.step)
    for path, span in plan.ranges.items():
        with places.blame("sensitivity", "ranges", path):
            for one in expanded(building, [path]):
                checked_range(building, one, span)
    for path in plan.distributions:
        with places.blame("sensitivity", "distributions", path):
            _require_known(building, [path])
    for name, paths in plan.groups.items():
        with places.blame("sensitivity", "groups", name):
            _require_known(building, paths)
    for key in ("only", "leave_out"):
        with places.blame("sensitivity", key):
            _require_known(building, getattr(plan, key) or ())
    with places.blame("sensitivity"):
        runs_of(plan, factors(building, plan))


def _require_whole(interval: Duration, step: Duration) -> None:
    steps = seconds_of(interval) / seconds_of(step)
    if steps < 1.0 or abs(steps - round(steps)) > 1e-9:
        raise InputError(
            f"found {step}, expected a whole part of the interval of the analyzed outputs, {interval}: "
            "for example 30min for 1h"
        )


def _require_known(building: Building, paths: Sequence[str]) -> None:
    for path in expanded(building, paths):
        building.parameter(path)


def factors(building: Building, plan: SensitivityPlan) -> list[Factor]:
    """All active parameters with a range, by the plan.

    Raises
    ------
    InputError
        As for `mascarin.sensitivity.factors_of`.
    """
    return factors_of(
        building,
        ranges=plan.ranges,
        distributions=plan.distributions,
        groups=plan.groups,
        leave_out=plan.leave_out,
        only=plan.only,
    )


def runs_of(plan: SensitivityPlan, chosen: list[Factor]) -> Plan:
    """The runs of a plan.

    Raises
    ------
    InputError
        The method does not support the numbers or groups; SALib is not installed.
    """
    return design(
        chosen,
        plan.method,
        replicates=plan.replicates,
        samples=plan.samples,
        order=plan.order,
        seed=plan.seed,
    )


def analyze(
    simulation: Simulation,
    plan: SensitivityPlan,
    chosen: list[Factor],
    lead_seconds: float,
    names: tuple[str, ...],
    workspace: Workspace,
    progress: Report,
) -> Sensitivity:
    """Carry out the runs and analyze them.

    Parameters
    ----------
    simulation : Simulation
        Covers the warm-up and the analyzed period.
    plan : SensitivityPlan
        Method, replicates, seed.
    chosen : list of Factor
        Parameters that vary.
    lead_seconds : float
        Length of the warm-up. [s]
    names : tuple of str
        Names of the outputs, in the order of the simulation.
    workspace : Workspace
        Stores finished chunks.
    progress : callable
        Called with the number of runs done and their total.

    Raises
    ------
    SolverError
        A run failed; the text names its parameters.
    """
    runs = runs_of(plan, chosen)
    taken = collector(runs, names, [output.unit for output in simulation.outputs])
    done = np.zeros(len(runs), dtype=bool)
    name = f"sensitivity-{plan.method}"
    # Relative energy-balance residual [-] and `Judgement.outside` [K] of each run.
    judged = np.full((2, len(runs)), np.nan)
    for first, arrays in workspace.kept(name):
        values, verdicts = arrays.get("values"), arrays.get("judged")
        if values is None or verdicts is None or verdicts.shape != (2, len(values)):
            continue
        taken.add(first, values)
        last = first + len(values)
        judged[:, first:last] = verdicts
        done[first:last] = True
    skipped = round(lead_seconds / simulation.step_seconds)
    every = max(1, round(seconds_of(plan.interval) / simulation.step_seconds))
    pace = _Pace()
    for first, samples in _missing(runs, done, pace):
        began = time.monotonic()
        run = run_samples(simulation, runs.paths, samples, first, start=skipped, record_every=every)
        last = first + len(samples)
        judged[:, first:last] = run.residuals, run.outside
        workspace.keep(name, first, {"values": run.records, "judged": judged[:, first:last]})
        taken.add(first, run.records)
        done[first:last] = True
        pace.update(len(samples), time.monotonic() - began)
        progress(int(done.sum()), len(runs))
    analysis = taken.result()
    return replace(analysis, warnings=(*analysis.warnings, *ensemble_warnings(*judged)))


class _Pace:
    """Number of runs in a chunk, from the time of the last chunk; whole packs for all processors."""

    def __init__(self) -> None:
        self.least = _PACK * (os.cpu_count() or 1)
        self.size = self.least

    def update(self, runs: int, seconds: float) -> None:
        wanted = runs * CHUNK_SECONDS / max(seconds, 1e-3)
        self.size = self.least * int(np.clip(round(wanted / self.least), 1, 128))


def _missing(runs: Plan, done: npt.NDArray[np.bool_], pace: _Pace) -> Iterator[tuple[int, Array]]:
    """Runs that are not done yet, in consecutive chunks of one replicate."""
    for replicate in range(runs.replicates):
        start = replicate * runs.runs
        samples = runs.samples(replicate)
        row = 0
        while row < runs.runs:
            if done[start + row]:
                row += 1
                continue
            stop = min(row + pace.size, runs.runs)
            taken = done[start + row : start + stop]
            stop = row + (int(np.argmax(taken)) if taken.any() else stop - row)
            yield start + row, samples[row:stop]
            row = stop
