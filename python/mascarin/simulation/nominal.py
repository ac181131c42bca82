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
    steps = max(round(seconds / simulation.step_seconds), int(simulation.compiled.settings["warmup_steps"]))
    return of_nominal(_shortened(simulation, steps))


def _shortened(simulation: Simulation, steps: int) -> Simulation:
    """The same over fewer steps."""
    forcing = simulation.compiled.forcing
    if steps >= len(forcing):
        return simulation
    times = simulation.times
    last = times.first + steps * simulation.step_seconds
    shorter = copy.copy(simulation)
    shorter.compiled = replace(simulation.compiled, forcing=forcing[:steps])
    shorter.times = Times(times.first, last, simulation.step_seconds, times.zone)
    return shorter
