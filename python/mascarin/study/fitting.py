"""The identification step of a study."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin.calibration import Fit, FitParameter, Rules, solve
from mascarin.calibration.buildings import fit_parameter, problem_of
from mascarin.climate.table import seconds_of

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from mascarin.model import Building
    from mascarin.simulation import Simulation
    from mascarin.study.description import IdentificationPlan, Sensor
    from mascarin.validation.observation import Observation


def fit_parameters(building: Building, plan: IdentificationPlan) -> list[FitParameter]:
    """Parameters with their bounds: the study's, else the building's ranges.

    Raises
    ------
    InputError
        Unknown path, or bounds outside of what the parameter can be.
    """
    return [
        fit_parameter(building, path)
        if free is None
        else fit_parameter(building, path, (free.low, free.high), free.prior)
        for path, free in plan.parameters.items()
    ]


def identify(
    simulation: Simulation,
    observation: Observation,
    use: npt.NDArray[np.bool_],
    sensors: Mapping[str, Sensor],
    plan: IdentificationPlan,
    *,
    record: Path | None,
    progress: Callable[[int, float], object] | None = None,
) -> Fit:
    """Find the parameters of a plan.

    Parameters
    ----------
    simulation : Simulation
        Covers the lead and the identification period.
    observation : Observation
        Measured series.
    use : ndarray of bool, shape (n,)
        Instants of the identification period.
    sensors : mapping of str to Sensor
        Uncertainties, and which take part.
    plan : IdentificationPlan
        What to find and how.
    record : Path, optional
        File in which every evaluation is kept.
    progress : callable, optional
        Called with the number of evaluations and the lowest cost so far.
    """
    weight = 1.0
    if plan.independent is not None:
        weight = min(1.0, observation.interval / seconds_of(plan.independent, "identification.independent"))
    problem = problem_of(
        simulation,
        observation,
        use,
        fit_parameters(simulation.building, plan),
        {name: sensor.uncertainty for name, sensor in sensors.items() if sensor.use},
        weight,
    )
    return solve(
        problem,
        method="least_squares" if plan.method == "least-squares" else "pattern_search",
        cost=plan.cost,
        seed=plan.seed,
        rules=Rules(starts=plan.starts, sequences=max(plan.starts, 10), evaluations=plan.budget),
        record=record,
        progress=progress,
    )
