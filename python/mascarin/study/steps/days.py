"""Choice of days of a study: what the calibration has excited, and which days to use or measure next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin.study.steps.residuals import drivers
from mascarin.study_document.analysis import TableEntry
from mascarin.validation.days import EXTRAPOLATION_RATIO, DayChoice, choose_days

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import ModelRun, PredictionIntervals

    Array = npt.NDArray[np.float64]

_STATES = ("layer_temperature", "liquid_fraction")


def days(
    setup: StudyContext, run: ModelRun, fit: Calibration, slope: Array, intervals: PredictionIntervals
) -> DayChoice:
    """Compare the days of the record.

    Parameters
    ----------
    setup : StudyContext
        The study.
    run : ModelRun
        The fitted model.
    fit : Calibration
        Its calibration: priors and effective samples.
    slope : ndarray, shape (P, n, S)
        Derivatives of the series by the calibrated parameters, in ranges. [unit of each sensor]
    intervals : PredictionIntervals
        Gives the standard deviation of the model error.
    """
    observation, local = setup.observation, setup.observation.times.tz_localize(None)
    number = np.asarray((local.normalize() - local[0].normalize()).days)
    first = local[0].normalize()
    labels = [f"{first + one:%Y-%m-%d}" for one in _whole_days(int(number[-1]) + 1)]
    states = {
        output.name: observation.sampled(run.results.index, run.results.records[:, k])
        for k, output in enumerate(run.results.outputs)
        if output.kind in _STATES
    }
    known = {sensor.name: k for k, sensor in enumerate(fit.problem.sensors)}
    seen = setup.during["identification"]
    samples = (np.isfinite(observation.measured) & setup.used["identification"]).sum(axis=0)
    effective = fit.uncertainty.effective_samples
    weight = np.array(
        [
            min(1.0, effective[known[name]] / max(samples[s], 1)) if name in known else 0.0
            for s, name in enumerate(observation.names)
        ]
    )
    precision = np.array(
        [0.0 if p.prior is None else ((p.upper - p.lower) / p.prior[1]) ** 2 for p in fit.problem.parameters]
    )
    # Every day counts as measured: the question is what a day would tell.
    return choose_days(
        slope, intervals.error, labels, number, seen, precision=precision, weight=weight,
        drivers={**drivers(setup), **states},
    )  # fmt: skip


def days_table(found: DayChoice) -> TableEntry:
    """The proposed and the farthest days, as a table of the report."""
    ratio = found.ratio
    far = sorted(np.flatnonzero(found.extrapolated).tolist(), key=lambda d: -ratio[d])[:5]
    rows = []
    for d in dict.fromkeys((*found.proposed, *far)):
        outside = [name for name, part in found.outside.items() if part[d] > 0.0]
        place = found.proposed.index(d) + 1 if d in found.proposed else None
        rows.append(
            [
                found.days[d],
                "" if place is None else f"{place}",
                float(found.information[d]),
                100.0 * float(found.reduction[d]),
                float(ratio[d]) if np.isfinite(ratio[d]) else None,
                ", ".join(outside) or "none",
            ]
        )
    return TableEntry(
        title="Choice of days",
        caption=(
            "Days to identify or measure on next, in their order: each adds the most information to the days "
            "before it (D-optimal). The gain is the fall of the logarithm of the volume of the confidence "
            "region; the reduction is that of the variance of the predictions on all days that were not used "
            "[%]. The leverage is the variance of the prediction from the estimated parameters, relative to "
            f"the days of the identification; days above {EXTRAPOLATION_RATIO:g} are extrapolations."
        ),
        columns=["day", "order", "gain", "reduction", "leverage", "drivers outside of the identification"],
        rows=rows,
        section="comparison",
    )


def day_words(found: DayChoice) -> list[str]:
    """How far the other days lie outside, and which to use next, in words."""
    texts = []
    count, others = int(found.extrapolated.sum()), int((~found.used).sum())
    if count:
        texts.append(
            f"{count} of {others} days that were not used for the calibration "
            f"{'is an extrapolation: its' if count == 1 else 'are extrapolations: their'} "
            f"leverage is more than {EXTRAPOLATION_RATIO:g} times that of the identification."
        )
    texts += [
        f"{one.name}: {in_percent(one.outside)} of the other instants are outside of the range of the "
        f"identification, {one.low:.4g} to {one.high:.4g}; they reach from {one.other_low:.4g} to "
        f"{one.other_high:.4g}."
        for one in found.ranges
        if one.outside > 0.0
    ]
    if found.proposed:
        named = ", ".join(found.days[d] for d in found.proposed)
        texts.append(f"Days with the largest expected information, to identify or measure on next: {named}.")
    return texts


def _whole_days(count: int) -> Any:
    import pandas as pd

    return pd.to_timedelta(np.arange(count), unit="D")
