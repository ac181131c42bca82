"""Analysis of the residuals of the calibrated model: their structure, and the sources of remaining error."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.diagnosis.error_sources import ErrorSources, find_error_sources
from mascarin.progress import reporting
from mascarin.study.context.calibration import independent_weight
from mascarin.study.steps.parameter_effects import Effects
from mascarin.validation.residuals import ResidualAnalysis, analyze_residuals

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.progress import ProgressOption
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import ModelRun

#: Weather channels that residuals are correlated with, by words.
DRIVERS: Final = {
    "outdoor air": "air_temperature",
    "sun": "global_horizontal",
    "wind": "wind_speed",
}
#: Sensors with fewer values on the blind days are not analyzed.
FEWEST_EXAMINED: Final = 24
#: Largest number of values for which effects of parameters are kept.
MOST_EFFECTS: Final = 20_000_000
#: Half-width of the 95 % interval of a normal distribution, in standard deviations.
NORMAL_95: Final = 1.96


def drivers(setup: StudyContext) -> dict[str, npt.NDArray[np.float64]]:
    """Weather that acts on the building, at the instants of the comparison, by words for the report."""
    run = setup.models.nominal
    return {
        word: setup.observation.sampled(run.index, run.weather(channel))
        for word, channel in DRIVERS.items()
        if np.ptp(run.weather(channel)) > 0.0
    }


def too_few(setup: StudyContext) -> list[str]:
    """Sensors with too few values on the blind days, in words."""
    return [
        f"{name}: {count} values on the blind days are too few for an analysis of the residuals; at least "
        f"{FEWEST_EXAMINED} are needed."
        for name, count in _blind_values(setup).items()
        if count < FEWEST_EXAMINED
    ]


def examined(setup: StudyContext, run: ModelRun) -> dict[str, ResidualAnalysis]:
    """Structure of the residuals of each sensor on the blind days."""
    observation, local = setup.observation, setup.observation.times.tz_localize(None)
    simulated = observation.simulated(run.results.index, run.results.records)
    hour = np.asarray(local.hour + local.minute / 60.0, dtype=np.float64)
    channels = drivers(setup)
    return {
        name: analyze_residuals(
            observation.measured[:, s],
            simulated[:, s],
            step=observation.interval,
            hour=hour,
            drivers=channels,
            use=setup.used["blind"][:, s],
            sensor=name,
            unit=run.results.outputs[s].unit,
        )
        for name, s in _analyzed(setup).items()
    }


def error_sources(
    setup: StudyContext, run: ModelRun, fit: Calibration, progress: ProgressOption = None
) -> ErrorSources | None:
    """Parameters whose change would explain the remaining error on the blind days."""
    observation, blind, analyzed = setup.observation, setup.during["blind"].copy(), _analyzed(setup)
    if not analyzed:
        return None
    simulated = observation.simulated(run.results.index, run.results.records[..., : len(observation.names)])
    error = simulated - _blind(setup)
    effects = Effects(setup, run.simulation, simulated, run.simulation.vector(fit.values))
    # In a long record every second or third instant contains the same information.
    values = int(blind.sum()) * len(observation.names) * effects.count
    blind &= np.arange(blind.size) % max(1, math.ceil(values / MOST_EFFECTS)) == 0
    with reporting(progress, "sources of remaining error") as report:
        found = {path: effect[blind] for path, effect in effects.each(report)}
    local = observation.times.tz_localize(None)
    columns = list(analyzed.values())
    return find_error_sources(
        {name: error[blind, s] for name, s in analyzed.items()},
        {path: effect[:, columns] for path, effect in found.items()},
        standard_uncertainty=[setup.plan.sensors[name].expanded / NORMAL_95 for name in analyzed],
        allowed=effects.room,
        days=np.asarray((local[blind] - local[0]).days),
        weight=independent_weight(setup.inputs.calibration_plan, observation.interval),
    )


def _blind(setup: StudyContext) -> npt.NDArray[np.float64]:
    """Measured values of the blind days, NaN elsewhere, shape (n, S). [unit of each sensor]"""
    return np.where(setup.used["blind"], setup.observation.measured, np.nan)


def _blind_values(setup: StudyContext) -> dict[str, int]:
    """Number of values of each sensor on the blind days."""
    count = np.isfinite(_blind(setup)).sum(axis=0)
    return dict(zip(setup.observation.names, count.tolist(), strict=True))


def _analyzed(setup: StudyContext) -> dict[str, int]:
    """Sensors with enough values on the blind days, and their columns."""
    enough = (count >= FEWEST_EXAMINED for count in _blind_values(setup).values())
    return {name: s for s, (name, use) in enumerate(zip(_blind_values(setup), enough, strict=True)) if use}
