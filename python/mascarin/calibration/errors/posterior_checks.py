"""Checks of a calibration against its own data: what contradicts the model of the errors.

Intervals hold if the errors are as assumed. Each check compares a number that the assumptions predict with
the one found: offsets of sensors with their stated uncertainties, the size and the order of what each day
differs from its prediction by the other days, estimates with the ends of their ranges and with the values
that a material of their name has. A contradiction is said first, and widens the intervals by the ratio of
what was found to what was assumed (Birge ratio); beyond `LARGEST_FACTOR` no interval is stated.

References
----------
Gelman A., Meng X.-L., Stern H. (1996), Posterior predictive assessment of model fitness via realized
discrepancies, Statistica Sinica 6, 733.
Birge R.T. (1932), The calculation of errors by the method of least squares, Physical Review 40, 207.
https://doi.org/10.1103/PhysRev.40.207
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.bounded_coefficients import LARGEST_ERROR
from mascarin.materials.iso_10456 import unusual

if TYPE_CHECKING:
    from mascarin.calibration.base.problem import FitParameter
    from mascarin.calibration.base.result import Calibration
    from mascarin.calibration.errors.joint_posterior import JointPosterior

Floats = NDArray[np.float64]

LARGEST_FACTOR: Final = 3.0
"""Intervals that would have to be wider by more than this are not stated. [-]"""

NOT_STATED: Final = "not stated: the model contradicts the data of its own identification"

#: Stated uncertainties from which an error of a sensor contradicts them. [-]
_MOST_STATED: Final = LARGEST_ERROR
#: The same for combinations of numbers that are not estimated, of which there are many.
_MOST_DESCRIBED: Final = 3.0
#: Ratio of the errors of a calibrated model and of the description, below which they are equal: a description
#: that is right already cannot be improved. [-]
_FARTHER: Final = 1.01
#: Probability below which a day, or the order of errors, is not as assumed.
_RARE: Final = 1e-3
#: Correlation of neighbours below which it is of no importance, however certain. [-]
_SLIGHT: Final = 0.3
#: Mean square of what a day differs from its prediction, below which it is of no importance. [-]
_SLIGHTLY_LARGER: Final = 2.0


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Something by which a calibration contradicts its data or what is known.

    Attributes
    ----------
    kind : str
        ``offset``, ``day``, ``autocorrelation``, ``coverage``, ``bound``, ``material``, ``period``, ``fit``
        or ``statement``.
    subject : str
        Which sensor, day or parameter.
    text : str
        In a sentence.
    factor : float
        By which intervals have to be wider for it; 1 if they need not be. [-]
    """

    kind: str
    subject: str
    text: str
    factor: float = 1.0

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "kind": self.kind,
            "subject": self.subject,
            "text": self.text,
            "factor": float(f"{self.factor:.4g}"),
        }


def widening(contradictions: Sequence[Contradiction]) -> float:
    """Return the factor of all intervals for some contradictions; infinite where none is to be stated.

    Examples
    --------
    >>> widening([]), widening([Contradiction("offset", "room", "", 1.5)])
    (1.0, 1.5)
    >>> widening([Contradiction("offset", "room", "", 4.0)])
    inf
    """
    factor = max([1.0, *(entry.factor for entry in contradictions)])
    return factor if factor <= LARGEST_FACTOR else math.inf


def widened(low: Floats, x: Floats, high: Floats, ends: Floats, factor: float) -> tuple[Floats, Floats]:
    """Make intervals wider about their estimates, within the ranges.

    Parameters
    ----------
    low, x, high : ndarray, shape (P,)
        Intervals and estimates. [unit of each]
    ends : ndarray, shape (2, P)
        Ranges. [unit of each]
    factor : float
        From `widening`; infinite gives the whole ranges. [-]

    Returns
    -------
    tuple of ndarray, shape (P,)
        Lower and upper ends. [unit of each]

    Examples
    --------
    >>> one = np.ones(1)
    >>> widened(0.8 * one, one, 1.4 * one, np.array([[0.5], [2.0]]), 2.0)
    (array([0.6]), array([1.8]))
    """
    if not math.isfinite(factor):
        return ends[0].copy(), ends[1].copy()
    return np.maximum(x - factor * (x - low), ends[0]), np.minimum(x + factor * (high - x), ends[1])


def with_wider_intervals(fit: Calibration, factor: float) -> Calibration:
    """Make the intervals of a calibration wider.

    Parameters
    ----------
    fit : Calibration
        The calibration.
    factor : float
        From `widening`; infinite gives the whole ranges, and says that no interval is stated. [-]
    """
    if factor == 1.0:
        return fit
    parameters = fit.problem.parameters
    ends = np.array([[p.lower for p in parameters], [p.upper for p in parameters]])
    low, high = widened(fit.low, fit.x, fit.high, ends, factor)
    said = (
        NOT_STATED if math.isinf(factor) else f"made {factor:.2g} times wider for what contradicts the model"
    )
    return replace(fit, low=low, high=high, uncertainty_method=f"{fit.uncertainty_method}; {said}")


def judged(
    fit: Calibration, joint: JointPosterior, stated: Mapping[str, float], days: Sequence[str]
) -> Calibration:
    """Say what contradicts a calibration first among its warnings, and make its intervals as wide as needed.

    Parameters
    ----------
    fit : Calibration
        The calibration.
    joint, stated, days
        As for `of_errors`.
    """
    contradictions = of_errors(joint, [sensor.name for sensor in fit.problem.sensors], stated, days)
    contradictions += of_estimates(fit.problem.parameters, fit.x, fit.on_bound)
    texts = (entry.text for entry in contradictions)
    return replace(with_wider_intervals(fit, widening(contradictions)), warnings=(*texts, *fit.warnings))


def of_errors(
    joint: JointPosterior, sensors: Sequence[str], stated: Mapping[str, float], days: Sequence[str]
) -> list[Contradiction]:
    """Check the estimated errors of sensors and days.

    Parameters
    ----------
    joint : JointPosterior
        Parameters and errors.
    sensors : sequence of str, length S
        Names of the sensors.
    stated : mapping of str to float
        Standard uncertainty of each error of a sensor, by its name in ``joint.names``. [unit of each]
    days : sequence of str, length D
        Names of the days.
    """
    return [*_offsets(joint, stated), *_days(joint, days), *_order(joint, sensors)]


def of_fit(
    described: Mapping[str, float], calibrated: Mapping[str, float], stated: Mapping[str, float]
) -> list[Contradiction]:
    """Check whether the calibrated model follows the data of its identification better than as described.

    Where it does not, the errors of model and sensors explain what the parameters should: the curves of the
    calibrated model are no better, whatever the bands contain.

    Parameters
    ----------
    described, calibrated : mapping of str to float
        Root mean square error in the identification by sensor. [unit]
    stated : mapping of str to float
        Standard uncertainty of each sensor, by which they are weighed. [unit]

    Examples
    --------
    >>> found = of_fit({"room": 0.6, "gap": 6.7}, {"room": 0.7, "gap": 6.8}, {"room": 0.25, "gap": 0.25})
    >>> found[0].text.partition(":")[0]
    'the calibrated model is farther from the data of its identification than the model as described'
    >>> of_fit({"room": 0.6, "gap": 6.7}, {"room": 0.7, "gap": 3.0}, {"room": 0.25, "gap": 0.25})
    []
    >>> of_fit({"room": 0.600}, {"room": 0.603}, {"room": 0.25})
    []
    """
    names = [name for name in described if stated.get(name, 0.0) > 0.0 and name in calibrated]
    before, after = (
        sum((errors[name] / stated[name]) ** 2 for name in names) for errors in (described, calibrated)
    )
    if not after > _FARTHER**2 * before:
        return []
    worst = max(names, key=lambda name: (calibrated[name] - described[name]) / stated[name])
    text = (
        "the calibrated model is farther from the data of its identification than the model as described: "
        f"{math.sqrt(after / before):.2f} times, most in {worst} (root mean square {described[worst]:.2g} as "
        f"described, {calibrated[worst]:.2g} calibrated). Errors of model and sensors explain what the "
        "parameters do not: look at the causes of the remaining error, and for what the description lacks"
    )
    return [Contradiction("fit", worst, text)]


def _offsets(joint: JointPosterior, stated: Mapping[str, float]) -> list[Contradiction]:
    """Errors of sensors that would be larger than stated, and numbers far from the building as described."""
    contradictions, first = [], joint.z.size
    for k, name in enumerate(joint.names):
        if k < joint.unlimited.size:
            away = float(joint.unlimited[k])
            if away == 0.0:
                continue
            size = stated.get(name, 1.0)
            text = (
                f"{name}: the data want {size * away:+.2g}, {abs(away):.1f} times its stated standard "
                f"uncertainty of {size:.2g}, and it is held at {_MOST_STATED:g} times: the sensor is worse "
                "than "
                "stated, or the model has an error that looks like it"
            )
            contradictions.append(Contradiction("offset", name, text, abs(away) / _MOST_STATED))
        elif abs(joint.mean[first + k]) > _MOST_DESCRIBED:
            away = float(abs(joint.mean[first + k]))
            text = (
                f"{name}: {away:.1f} standard uncertainties from the building as described: a number that is "
                "not estimated has another value, or the model has an error that looks like it"
            )
            contradictions.append(Contradiction("offset", name, text, away / _MOST_DESCRIBED))
    return contradictions


def _days(joint: JointPosterior, days: Sequence[str]) -> list[Contradiction]:
    """Days that the other days do not predict as well as they should."""
    from scipy import stats

    contradictions = []
    for name, white in zip(days, joint.whitened, strict=True):
        present = white[np.isfinite(white)]
        if present.size == 0:
            continue
        mean_square = float(np.mean(present**2))
        p = float(stats.chi2.sf(present @ present, present.size)) * len(days)
        if mean_square > _SLIGHTLY_LARGER and p < _RARE:
            text = (
                f"{name}: the other days of the identification predict this day {math.sqrt(mean_square):.1f} "
                "times worse than the errors of all days allow: something differs on it"
            )
            contradictions.append(Contradiction("day", name, text, math.sqrt(mean_square)))
    return contradictions


def _order(joint: JointPosterior, sensors: Sequence[str]) -> list[Contradiction]:
    """Sensors whose errors follow each other for longer than assumed.

    A negative correlation is none: errors are assumed that are larger than the data have, because the error
    within a day has a smallest size (`mascarin.calibration.errors.linear_estimation.LEAST_ERROR`).
    """
    from scipy import stats

    contradictions, limit = [], float(stats.norm.isf(_RARE / max(len(sensors), 1)))
    for s, name in enumerate(sensors):
        first, second = joint.whitened[:, :-1, s], joint.whitened[:, 1:, s]
        present = np.isfinite(first) & np.isfinite(second)
        count = int(present.sum())
        if count < 24:
            continue
        square = float(np.mean(joint.whitened[:, :, s][np.isfinite(joint.whitened[:, :, s])] ** 2))
        correlation = float(np.mean(first[present] * second[present])) / max(square, 1e-300)
        if correlation > max(limit / math.sqrt(count), _SLIGHT):
            text = (
                f"{name}: errors of neighbouring hours are correlated ({correlation:+.2f}) beyond what the "
                "errors of the model account for"
            )
            # Errors that follow each other are worth fewer values: (1 + r) / (1 - r) times fewer.
            lasting = math.sqrt((1.0 + correlation) / (1.0 - min(correlation, 0.95)))
            contradictions.append(Contradiction("autocorrelation", name, text, lasting))
    return contradictions


def of_estimates(
    parameters: Sequence[FitParameter], values: Floats, on_bound: Mapping[str, str]
) -> list[Contradiction]:
    """Check the estimates: on the ends of their ranges, and beside what the named material has.

    Parameters
    ----------
    parameters : sequence of FitParameter
        The parameters.
    values : ndarray, shape (P,)
        Estimates. [unit of each]
    on_bound : mapping of str to str
        Reasons of estimates on the end of their range, by path.
    """
    contradictions = [
        Contradiction("bound", path, f"{path} is {reason}; the intervals of all others depend on this end")
        for path, reason in on_bound.items()
    ]
    for parameter, value in zip(parameters, values.tolist(), strict=True):
        said = unusual(parameter.path, value)
        if said is not None:
            text = (
                f"{parameter.path}: the estimate of {value:.3g} {parameter.unit} is not of this material: "
                f"{said}. "
                "It makes up for an error of the model, or the material is another one"
            )
            contradictions.append(Contradiction("material", parameter.path, text))
    return contradictions
