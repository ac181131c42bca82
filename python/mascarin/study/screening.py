"""The sensitivity step of a study: runs in chunks of about a second, each kept as soon as it is done."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.climate.table import seconds_of
from mascarin.errors import InputError, SolverError
from mascarin.sensitivity.factors import Factor
from mascarin.sensitivity.spectral import Accumulator, Design, SpectralSensitivity, design

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.model import Building
    from mascarin.progress import Progress
    from mascarin.simulation import Simulation
    from mascarin.study.description import SensitivityPlan
    from mascarin.study.keeping import Workspace
    from mascarin.study.places import Places

    Array = npt.NDArray[np.float64]

#: At most so much work is lost when a study is killed. [s]
CHUNK_SECONDS: Final = 1.0
_FIRST_CHUNK: Final = 8
_NAME: Final = "sensitivity"


def check_plan(building: Building, plan: SensitivityPlan, places: Places) -> None:
    """Refuse what a plan says about parameters that are none, or cannot be so.

    Raises
    ------
    InputError
        Unknown or structural path, a range the wrong way round or beyond what the parameter can be.
    """
    for path, (low, high) in plan.ranges.items():
        with places.blame("sensitivity", "ranges", path):
            parameter = building.parameter(path)
            if parameter.structural:
                raise InputError(f"is structural ({parameter.reason}) and cannot be varied; leave it out")
            if not parameter.lower <= low < high <= parameter.upper:
                raise InputError(
                    f"found [{low:g}, {high:g}] {parameter.unit}, expected a lower and a higher value from "
                    f"{parameter.lower:g} to {parameter.upper:g}; correct the range"
                )
    for path in plan.leave_out:
        with places.blame("sensitivity", "leave_out"):
            building.parameter(path)
    with places.blame("sensitivity"):
        factors(building, plan)


def factors(building: Building, plan: SensitivityPlan) -> list[Factor]:
    """All parameters that act and have a range, with the study's own ranges in place of the building's.

    A number that the description knows to be idle (a wind exponent where no film depends on wind) takes no
    part: its share is zero, and an estimate could only add noise to that.

    Raises
    ------
    InputError
        A path does not exist.
    """
    ranges = {building.parameter(path).path: span for path, span in plan.ranges.items()}
    fixed = {building.parameter(path).path for path in plan.leave_out}
    found = []
    for parameter in building.parameters():
        low, high = ranges.get(parameter.path, (parameter.low, parameter.high))
        if parameter.reason is None and parameter.path not in fixed and low < high:
            found.append(Factor(parameter.path, low, high, parameter.unit))
    if not found:
        raise InputError(
            "found no parameter with a range, expected at least one; give ranges: {path: [low, high]}"
        )
    return found


def screen(
    simulation: Simulation,
    plan: SensitivityPlan,
    chosen: list[Factor],
    lead_seconds: float,
    names: tuple[str, ...],
    workspace: Workspace,
    progress: Progress,
) -> SpectralSensitivity:
    """Make the runs of the spectral design and analyse them.

    Parameters
    ----------
    simulation : Simulation
        Covers the lead and the period that is analysed.
    plan : SensitivityPlan
        Replicates, order, seed.
    chosen : list of Factor
        What varies.
    lead_seconds : float
        Run before the outputs are analysed. [s]
    names : tuple of str
        Names of the outputs, in the order of the simulation.
    workspace : Workspace
        Keeps finished chunks.
    progress : Progress
        Is told how far it is.

    Raises
    ------
    SolverError
        A run failed; the text names its parameters.
    """
    runs = design(chosen, replicates=plan.replicates, order=plan.order, seed=plan.seed)
    accumulator = Accumulator(runs, names, units=[output.unit for output in simulation.outputs])
    done = np.zeros(len(runs), dtype=bool)
    for first, values in workspace.kept(_NAME):
        accumulator.add(first, values)
        done[first : first + len(values)] = True
    positions = [simulation.position(path) for path in runs.paths]
    every = max(1, round(seconds_of(plan.interval) / simulation.step_seconds))
    pace = _Pace()
    for first, samples in _missing(runs, done, pace):
        began = time.monotonic()
        vectors = np.tile(simulation.vector({}), (len(samples), 1))
        vectors[:, positions] = samples
        records, _, failures = simulation.ensemble(
            vectors, record_from=round(lead_seconds / simulation.step_seconds), record_every=every
        )
        if failures:
            worst = failures[0]
            raise SolverError(
                f"sensitivity: run {first + worst.member} failed: {worst.reason} Its parameters: "
                + ", ".join(f"{p}={v:g}" for p, v in zip(runs.paths, samples[worst.member], strict=True))
            )
        workspace.keep(_NAME, first, records)
        accumulator.add(first, records)
        done[first : first + len(samples)] = True
        pace.learn(len(samples), time.monotonic() - began)
        progress.update(int(done.sum()), len(runs))
    return accumulator.result()


class _Pace:
    """How many runs fill a chunk, in whole packs of lanes where they fit; learnt from the last one."""

    def __init__(self) -> None:
        self.size = _FIRST_CHUNK

    def learn(self, runs: int, seconds: float) -> None:
        wanted = runs * CHUNK_SECONDS / max(seconds, 1e-3)
        whole = 8 * round(wanted / 8) if wanted >= 8 else int(wanted)
        self.size = int(np.clip(whole, 1, 2048))


def _missing(runs: Design, done: npt.NDArray[np.bool_], pace: _Pace) -> Iterator[tuple[int, Array]]:
    """Runs that have not been made, in consecutive pieces of one replicate."""
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
