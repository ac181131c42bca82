"""Calibration of a study."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.calibration import Calibration, CalibrationProblem, SearchOptions, solve
from mascarin.calibration.base.building_problem import problem_of
from mascarin.study.file.free_parameters import fit_parameters

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.measurements.observation import Observation
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.file.description import IdentificationPlan, Sensor


#: Work that is lost at most when a study is killed. [s]
CHUNK_SECONDS: Final = 1.0
_MOST: Final = 64
_PACK: Final = 8


def problem(
    simulation: Simulation,
    observation: Observation,
    rows: npt.NDArray[np.bool_],
    use: npt.NDArray[np.bool_],
    sensors: Mapping[str, Sensor],
    plan: IdentificationPlan,
) -> CalibrationProblem:
    """The calibration problem of a plan.

    Parameters
    ----------
    simulation : Simulation
        Covers the warm-up and the identification period.
    observation : Observation
        Measured series.
    rows : ndarray of bool, shape (n,)
        Instants from the first to the last of the identification.
    use : ndarray of bool, shape (n, S)
        Values of each sensor that are used.
    sensors : mapping of str to Sensor
        Uncertainties, and which sensors are used.
    plan : IdentificationPlan
        Parameters and method.

    Raises
    ------
    InputError
        A parameter or a sensor that cannot be used.
    """
    return problem_of(
        simulation,
        observation,
        rows,
        fit_parameters(simulation.building, plan),
        {
            name: sensor.uncertainty(simulation.building.output(sensor.output).unit, f"sensors.{name}")
            for name, sensor in sensors.items()
            if sensor.use
        },
        independent_weight(plan, observation.interval),
        only=use,
    )


def independent_weight(plan: IdentificationPlan, interval: float) -> float:
    """Weight of a sample if samples closer together than some time count as one.

    Parameters
    ----------
    plan : IdentificationPlan
        Has the time after which samples count as independent.
    interval : float
        Spacing of the samples. [s]
    """
    if plan.independent is None:
        return 1.0
    return min(1.0, interval / seconds_of(plan.independent, "identification.independent"))


def identify(
    simulation: Simulation,
    stated: CalibrationProblem,
    plan: IdentificationPlan,
    *,
    record: Path | None,
    progress: Callable[[int, float], object] | None = None,
    tolerance: float | None = None,
) -> Calibration:
    """Carry out the calibration of a plan.

    Parameters
    ----------
    simulation : Simulation
        The model of the problem.
    stated : CalibrationProblem
        From `problem`.
    plan : IdentificationPlan
        Method and its options.
    record : Path, optional
        File that stores every evaluation.
    progress : callable, optional
        Called with the number of evaluations and the lowest cost so far.
    tolerance : float, optional
        Replaces that of least squares. [-]
    """
    found = solve(
        stated,
        method=plan.method,
        cost=plan.cost,
        seed=plan.seed,
        options=SearchOptions(
            starts=plan.starts,
            tolerance=SearchOptions().tolerance if tolerance is None else tolerance,
            slopes=plan.slopes,
            sequences=plan.sequences,
            agree=plan.agree,
            evaluations=plan.budget,
            moves=plan.moves,
        ),
        record=record,
        batch=_batch(simulation),
        on_batch=progress,
    )
    return replace(found, nominal_building=simulation.building)


def _batch(simulation: Simulation) -> int:
    """Number of evaluations to store at once; it has no influence on the result."""
    size = (len(simulation.compiled.forcing), simulation.compiled.plan.n_cells)
    if size not in _BATCHES:
        _BATCHES[size] = _measured_batch(simulation)
    return _BATCHES[size]


#: Numbers of evaluations, by number of steps and of cells.
_BATCHES: Final[dict[tuple[int, int], int]] = {}


def _measured_batch(simulation: Simulation) -> int:
    """Number of evaluations that take about `CHUNK_SECONDS`."""
    began = time.monotonic()
    simulation.ensemble(np.tile(simulation.vector({}), (_PACK, 1)))
    seconds = max(time.monotonic() - began, 1e-6)
    return int(np.clip(_PACK * CHUNK_SECONDS / seconds, 1, _MOST))
