"""The identification step of a study: its parameters and sensors as a calibration problem."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin.calibration import CalibrationProblem, Fit, FitParameter, FitSensor, Rules, solve
from mascarin.climate.table import seconds_of
from mascarin.model import Building

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.simulation import Simulation
    from mascarin.study.description import Free, IdentificationPlan, Sensor
    from mascarin.study.observation import Observation

    Array = npt.NDArray[np.float64]

#: A sensor's band is read as 95 % of a normal distribution.
_BAND = 1.96


def fit_parameters(building: Building, plan: IdentificationPlan) -> list[FitParameter]:
    """Parameters with their bounds: the study's, else the building's ranges.

    Raises
    ------
    InputError
        Unknown path, or bounds outside of what the parameter can be.
    """
    return [_parameter(building, path, free) for path, free in plan.parameters.items()]


def _parameter(building: Building, path: str, free: Free | None) -> FitParameter:
    parameter = building.parameter(path)
    low = parameter.low if free is None or free.low is None else free.low
    high = parameter.high if free is None or free.high is None else free.high
    prior = None if free is None or free.prior is None else (parameter.value, free.prior)
    return FitParameter(
        path=parameter.path,
        lower=low,
        upper=high,
        nominal=parameter.value,
        unit=parameter.unit,
        limits=(parameter.lower, parameter.upper),
        prior=prior,
    )


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

    Returns
    -------
    Fit
        Estimates with their uncertainty.
    """
    parameters = fit_parameters(simulation.building, plan)
    positions = [simulation.position(parameter.path) for parameter in parameters]
    taking_part = [s for s, name in enumerate(observation.names) if sensors[name].use]
    rows = np.flatnonzero(use)

    def model(x: Array) -> Array:
        vectors = np.repeat(simulation.values[None, :], len(x), axis=0)
        vectors[:, positions] = x
        records, _, _ = simulation.ensemble(vectors)
        return observation.simulated(simulation.index, records)[:, rows][:, :, taking_part]

    weight = 1.0
    if plan.independent is not None:
        weight = min(1.0, observation.interval / seconds_of(plan.independent, "identification.independent"))
    problem = CalibrationProblem(
        tuple(parameters),
        tuple(
            FitSensor(
                observation.names[s],
                observation.measured[rows, s],
                uncertainty=sensors[observation.names[s]].uncertainty / _BAND,
                unit=simulation.outputs[s].unit,
                weight=weight,
            )
            for s in taking_part
        ),
        model,
        identity=simulation.identity,
        step=observation.interval,
    )
    least_squares = plan.method == "least-squares"
    return solve(
        problem,
        method="least_squares" if least_squares else "pattern_search",
        cost=plan.cost,
        seed=plan.seed,
        rules=Rules(starts=plan.starts, sequences=max(plan.starts, 10), evaluations=plan.budget),
        record=record,
        progress=progress,
    )
