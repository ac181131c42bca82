"""One run with the values of the building, for its warnings, beside an ensemble, a search or an export."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import SolverError
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind, of_kind
from mascarin.simulation.records.times import Times
from mascarin.simulation.simulation import Simulation
from mascarin.tables.forcing_blocks import ForcingBlocks

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Length of a short run that checks what is run elsewhere, such as a unit for co-simulation. [s]
SHORT: Final = 30 * 86400.0


def of_nominal(simulation: Simulation, vector: Array | None = None) -> tuple[RunWarning, ...]:
    """Warnings of one run with the values of the building, of which nothing is kept.

    An ensemble, a calibration or a search makes this run beside its own, so that it has the warnings of a
    single run at the cost of one more.

    Parameters
    ----------
    simulation : Simulation
        What is run.
    vector : ndarray, shape (P,), optional
        Other values; default those of the building. [unit of each]

    Returns
    -------
    tuple of RunWarning
        As `Results.warnings`; that the run failed is one of them.
    """
    try:
        return simulation.warnings_at(simulation.values if vector is None else vector)
    except SolverError as error:
        failed = f"a run with the values of the building failed, so that it could not be checked: {error}"
        building = of_kind(WarningKind.BUILDING, simulation.building_warnings)
        return (RunWarning(failed, WarningKind.FAILURE), *building)


def of_short_run(simulation: Simulation, seconds: float = SHORT) -> tuple[RunWarning, ...]:
    """Warnings of a run over the beginning of the period, for what is run elsewhere.

    Parameters
    ----------
    simulation : Simulation
        What is run.
    seconds : float
        Length of the run. [s]
    """
    repeated = simulation.compiled.begin_of(simulation.compiled.settings["warmup_steps"])
    intervals = round(max(seconds, repeated) / simulation.step_seconds)
    return of_nominal(_shortened(simulation, intervals))


def _shortened(simulation: Simulation, intervals: int) -> Simulation:
    """The same over fewer record intervals."""
    compiled = simulation.compiled
    if intervals >= compiled.intervals:
        return simulation
    times = simulation.times
    last = times.first + intervals * simulation.step_seconds
    shorter = copy.copy(simulation)
    steps, settings = intervals, compiled.settings
    if simulation.sequence is not None:
        steps = simulation.sequence.count_in(intervals)
        settings = {**settings, "halvings": settings["halvings"][:steps]}
    forcing = ForcingBlocks.of(compiled.forcing[:steps])
    shorter.compiled = replace(compiled, forcing_blocks=forcing, settings=settings)
    shorter.times = Times(times.first, last, simulation.step_seconds, times.zone)
    return shorter
