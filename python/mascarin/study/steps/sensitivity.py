"""Sensitivity analysis of a study: runs in chunks of about a second, each saved when it is done."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.sensitivity.building_analysis import run_samples
from mascarin.sensitivity.methods import collector
from mascarin.simulation.checks.formula_laws import member_range_warnings
from mascarin.simulation.checks.judgement import ensemble_warnings
from mascarin.study.file.factors import runs_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.progress import Report
    from mascarin.sensitivity import Factor, Sensitivity
    from mascarin.sensitivity.methods import Plan
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.storage import Workspace
    from mascarin.study.file.description import SensitivityPlan

    Array = npt.NDArray[np.float64]

#: Work that is lost at most when a study is killed, where the runs are short. [s]
CHUNK_SECONDS: Final = 1.0
#: The engine solves eight members at once on each processor: fewer would take as long.
_PACK: Final = 8


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
    # Relative energy-balance residual [-], `Judgement.outside` [K] and steps beyond `valid` of each run.
    judged = np.full((3, len(runs)), np.nan)
    for first, arrays in workspace.kept(name):
        values, verdicts = arrays.get("values"), arrays.get("judged")
        if values is None or verdicts is None or verdicts.shape != (3, len(values)):
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
        judged[:, first:last] = run.residuals, run.outside, run.beyond
        workspace.keep(name, first, {"values": run.records, "judged": judged[:, first:last]})
        taken.add(first, run.records)
        done[first:last] = True
        pace.update(len(samples), time.monotonic() - began)
        progress(int(done.sum()), len(runs))
    analysis = taken.result()
    residuals, outside, beyond = judged
    lines = [*ensemble_warnings(residuals, outside), *member_range_warnings(beyond)]
    return replace(analysis, warnings=(*analysis.warnings, *lines))


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
