"""Diagnosis: sentences about the residuals of a model and their possible causes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

import numpy as np

from mascarin.validation.residuals import ResidualAnalysis

# Smaller effects than these are not mentioned.
_CORRELATION: Final = 0.3
_HOURS: Final = 0.25  # part of the variance
_RATIO: Final = 0.1  # of the measured amplitude
_LAG: Final = 20.0  # min

_HINTS: Final = {
    "sun": (
        "too much solar heat is absorbed or stored (absorptance, shading, heat transfer coefficients)",
        "too little solar heat is absorbed or stored (absorptance, shading, heat transfer coefficients)",
    ),
    "wind": (
        "outside convection or infiltration removes too little heat in wind",
        "outside convection or infiltration removes too much heat in wind",
    ),
    "outdoor air": (
        "the coupling to the outdoor air is too strong (insulation, infiltration, heat capacity)",
        "the coupling to the outdoor air is too weak (insulation, infiltration, heat capacity)",
    ),
}
"""Possible causes of a positive and of a negative correlation, by name of the driver."""


def diagnose(analyses: Iterable[ResidualAnalysis]) -> list[str]:
    """Describe the errors of a model in sentences.

    Parameters
    ----------
    analyses : iterable of ResidualAnalysis
        One for each sensor.

    Returns
    -------
    list of str
        Sentences, each beginning with the name of its sensor; white noise has a sentence as well.

    Examples
    --------
    >>> import numpy as np
    >>> from mascarin.validation.residuals import analyze_residuals
    >>> hour = np.arange(960) / 4.0
    >>> measured = 20.0 + 3.0 * np.cos((hour - 15.0) / 12.0 * np.pi)
    >>> noise = 0.2 * np.random.default_rng(3).normal(size=hour.size)
    >>> found = analyze_residuals(measured, measured + noise, step=900.0, hour=hour % 24.0, sensor="room")
    >>> diagnose([found])
    ['room: the residuals are white noise: they show no error of the model.']
    """
    sentences = []
    for e in analyses:
        texts = [*_bias_words(e), *_cycle_words(e), *_driver_words(e), *_hour_words(e)]
        if not texts and not e.white:
            texts = [_autocorrelation_words(e)]
        if not texts:
            texts = ["the residuals are white noise: they show no error of the model"]
        sentences += [f"{e.sensor}: {text}." for text in texts]
    return sentences


def _bias_words(e: ResidualAnalysis) -> list[str]:
    if abs(e.bias) <= 3.0 * e.sd / math.sqrt(max(e.effective_samples, 1.0)) or abs(e.bias) < 0.5 * e.sd:
        return []
    side = "above" if e.bias > 0.0 else "below"
    return [f"the model is {abs(e.bias):.2g} {_of_difference(e)} {side} the measurement on average"]


def _cycle_words(e: ResidualAnalysis) -> list[str]:
    if e.measured is None or e.simulated is None:
        return []
    texts = []
    difference = e.simulated.amplitude - e.measured.amplitude
    noticeable = max(_RATIO * e.measured.amplitude, 0.5 * e.sd)
    clear = min(e.measured.amplitude, e.simulated.amplitude) > e.sd
    if abs(difference) > noticeable:
        side, cause = (
            ("larger", "too little heat storage, or too strong coupling")
            if difference > 0.0
            else ("smaller", "too much heat storage or damping")
        )
        texts.append(
            f"the simulated daily amplitude is {side} than the measured one, {e.simulated.amplitude:.2g} "
            f"instead of {e.measured.amplitude:.2g} {_of_difference(e)}: {cause}"
        )
    if clear and abs(e.delay) > _LAG:
        late = "late" if e.delay > 0.0 else "early"
        # A delay alone has several causes; those of the remaining error are told apart by their fit.
        texts.append(
            f"the simulated daily peak is {abs(e.delay):.0f} min {late}: a heat capacity, or the clock "
            "of the sensor"
        )
    return texts


def _driver_words(e: ResidualAnalysis) -> list[str]:
    texts = []
    for link in e.correlations:
        if not (link.significant and abs(link.correlation) >= _CORRELATION):
            continue
        delay = f", delay {link.lag:.2g} h" if link.lag > 0.0 else ""
        text = f"the error is correlated with the {link.driver} ({link.correlation:+.2f}{delay})"
        hint = _HINTS.get(link.driver)
        texts.append(text if hint is None else f"{text}: {hint[0 if link.correlation > 0.0 else 1]}")
    return texts


def _hour_words(e: ResidualAnalysis) -> list[str]:
    if e.hour_share < max(_HOURS, e.hour_limit):
        return []
    highest, lowest = int(np.nanargmax(e.hour_mean)), int(np.nanargmin(e.hour_mean))
    return [
        f"the hour of the day explains {100.0 * e.hour_share:.0f} % of the variance of the error, from "
        f"{e.hour_mean[lowest]:+.2g} at {lowest} h to {e.hour_mean[highest]:+.2g} {_of_difference(e)} "
        f"at {highest} h"
    ]


def _autocorrelation_words(e: ResidualAnalysis) -> str:
    below = np.flatnonzero(e.acf < math.exp(-1.0))
    if below.size and e.acf[1] > e.acf_limit:
        lasts = f", with a correlation time of about {e.lags[below[0]]:.2g} h"
    else:
        lasts = ""
    return (
        f"the residuals are autocorrelated{lasts}, but correlated with none of the drivers: {e.n} values are "
        f"worth {e.effective_samples:.0f} independent ones"
    )


def _of_difference(e: ResidualAnalysis) -> str:
    """Return the unit of a difference: kelvins for temperatures."""
    return e.unit.replace("degC", "K")
