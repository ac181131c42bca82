"""Warnings of a calibration: what limits the use of its estimates, in sentences."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin._io.numbers import in_percent
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.uncertainty import AT_BOUND, Uncertainty

Floats = NDArray[np.float64]

_CORRELATED: Final = 0.95  # correlation from which two estimates are hardly determined one by one
_COLLINEAR: Final = 0.999
_UNDETERMINED: Final = 0.8  # part of the range that an interval may cover
_NARROW: Final = 0.05  # part of the range below which an interval is narrow, whatever it is correlated with


def warnings(
    problem: CalibrationProblem,
    z: Floats,
    uncertainty: Uncertainty,
    residuals: Floats,
    jacobian: Floats,
    beside: str = "",
) -> list[str]:
    """Describe what limits the use of the estimates.

    Parameters
    ----------
    problem, z, found, residuals, jacobian
        As for `estimate`, and its result.
    beside : str
        What was taken off the residuals, in words.

    Returns
    -------
    list of str
        Sentences.
    """
    names = problem.paths
    inactive = _inactive(problem, jacobian)
    texts = [f"{names[i]} has no effect on the compared sensors: fix it" for i in np.flatnonzero(inactive)]
    covered = uncertainty.high - uncertainty.low
    correlated = _correlated(names, uncertainty.correlation, inactive | (covered < _NARROW))
    texts += correlated.values()
    named = {i for pair in correlated for i in pair}
    texts += [
        f"{name} is not determined by these data: its interval covers {in_percent(float(covered[k]))} of the "
        f"range searched; fix it, or measure a quantity that it affects"
        for k, name in enumerate(names)
        if covered[k] > _UNDETERMINED and not inactive[k] and k not in named
    ]
    total = sum(uncertainty.effective_samples)
    if total < 3.0 * len(names):
        texts.append(
            f"{len(names)} parameters were estimated from residuals worth only {total:.0f} independent "
            f"samples: estimate fewer, or compare a longer period"
        )
    texts += _biased(problem, residuals, uncertainty, beside)
    return texts


def on_bounds(
    problem: CalibrationProblem, z: Floats, slope: Floats, uncertainty: Uncertainty
) -> dict[str, str]:
    """Give a reason for every estimate on a bound.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    z : ndarray, shape (P,)
        The estimates, as positions between 0 and 1. [-]
    slope : ndarray, shape (P,)
        Derivative of the cost by z.
    uncertainty : Uncertainty
        Result of `estimate`.

    Returns
    -------
    dict of str to str
        Reason by path.
    """
    reasons = {}
    for i, p in enumerate(problem.parameters):
        low, high = z[i] <= AT_BOUND, z[i] >= 1.0 - AT_BOUND
        if not (low or high):
            continue
        side, bound = ("lower", p.lower) if low else ("upper", p.upper)
        unit = "" if p.unit == "-" else p.unit
        where = f"on its {side} bound {bound:g} {unit}".rstrip()
        outward = slope[i] > 0.0 if low else slope[i] < 0.0
        if uncertainty.high[i] - uncertainty.low[i] > _UNDETERMINED:
            reason = "the data do not determine it, and the search ended there"
        elif outward:
            more = "less" if low else "more"
            reason = (
                f"the minimum lies beyond, at {more} than the range allows: the bound is wrong, or the "
                f"parameter compensates for an error of the model"
            )
        else:
            reason = "within the uncertainty, the data fit best at this end of the range"
        reasons[p.path] = f"{where}: {reason}"
    return reasons


def _inactive(problem: CalibrationProblem, jacobian: Floats) -> NDArray[np.bool_]:
    """Parameters whose whole range changes no sensor by a noticeable part of its uncertainty."""
    scale = np.where(problem.mask, problem.sigma, np.inf)[:, :, None]
    return np.asarray(np.max(np.abs(jacobian) / scale, axis=(0, 1)) < 1e-9)


def _correlated(
    names: tuple[str, ...], correlation: Floats, aside: NDArray[np.bool_]
) -> dict[tuple[int, int], str]:
    """Sentences on pairs with correlated estimates, the strongest correlation first, without those aside."""
    pairs = [
        (i, k)
        for i in range(len(names))
        for k in range(i)
        if abs(correlation[i, k]) >= _CORRELATED and not (aside[i] or aside[k])
    ]
    texts = {}
    for i, k in sorted(pairs, key=lambda pair: -abs(correlation[pair])):
        c = correlation[i, k]
        verb = "cannot" if abs(c) >= _COLLINEAR else "can hardly"
        texts[i, k] = f"{names[k]} and {names[i]} {verb} be distinguished (correlation {c:+.3f}): fix one"
    return texts


def _biased(
    problem: CalibrationProblem, residuals: Floats, uncertainty: Uncertainty, beside: str
) -> list[str]:
    """Sensors whose residuals have a mean that their scatter does not explain."""
    texts = []
    for s, sensor in enumerate(problem.sensors):
        r = residuals[sensor.mask, s]
        bias, spread = float(r.mean()), float(r.std())
        if (
            abs(bias) > 3.0 * spread / math.sqrt(max(uncertainty.effective_samples[s], 1.0))
            and abs(bias) > 1e-9
        ):
            unit = sensor.unit.replace("degC", "K")
            texts.append(
                f"'{sensor.name}' has a bias of {bias:+.2g} {unit} at the estimates{beside}; the intervals "
                "do not cover its cause"
            )
    return texts
