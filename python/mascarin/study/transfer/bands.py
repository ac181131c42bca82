"""Bands of a study whose building has the posterior of another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mascarin.calibration.errors.posterior_checks import NOT_STATED, Contradiction
from mascarin.study.carried.bands import carried_bands
from mascarin.study.steps.residuals import DRIVERS

if TYPE_CHECKING:
    from mascarin.study.carried.bands import Bands
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import ModelRun


def bands_of(study: StudyContext, run: ModelRun) -> tuple[Bands | None, list[Contradiction]]:
    """Bands of the posterior that the building has from another study, and where it extrapolates.

    Parameters
    ----------
    study : StudyContext
        The study; its building has perhaps a posterior.
    run : ModelRun
        Its model as described.
    """
    posterior = study.building.posterior
    if posterior is None:
        return None, []
    if not posterior.stated:
        text = f"no bands: those of the study '{posterior.study}' are {NOT_STATED}"
        return None, [Contradiction("period", "posterior", text)]
    observation, outputs, stated = study.observation, [], []
    for s, (name, sensor) in enumerate(study.plan.sensors.items()):
        output = study.building.output(sensor.output)
        sizes = sensor.uncertainty(output.unit, f"sensors.{name}")
        measured = np.abs(observation.measured[:, s])
        size = float(np.mean(measured[np.isfinite(measured)])) if np.isfinite(measured).any() else 0.0
        outputs.append(output.name)
        stated.append(float(np.hypot(sizes.absolute, sizes.relative * size)))
    weather = {
        channel: observation.sampled(run.results.index, run.simulation.weather(channel))
        for channel in DRIVERS.values()
    }
    bands = carried_bands(run.simulation, observation, posterior, outputs, stated, weather)
    return bands, [Contradiction("period", "posterior", text) for text in bands.words]
