"""The diagnosis: which causes the residuals name, and when they cannot tell.

Faults of sensors, of measured inputs and of the model compete on equal terms. A cause is named if the largest
evidence of all candidates is reached in few simulated records without any cause. Of what is wrong (a sensor,
an input, a number, a law) only that is said to be told whose probability among all candidates is large; else
the answer is that the measurements cannot tell, with the candidates that remain.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.diagnosis.error_covariance import ErrorCovariance, estimate_error_covariance
from mascarin.diagnosis.hypotheses import Candidate, DiagnosisInput
from mascarin.diagnosis.joint_causes import subsets_of
from mascarin.diagnosis.likelihood_ratio import Scores, Simulator, p_value
from mascarin.diagnosis.step_changes import Hypotheses

Floats = NDArray[np.float64]

#: A cause is named below this family-wise p value. [-]
LEVEL: Final = 0.05
#: Simulated records without any cause. [-]
DRAWS: Final = 999
#: What is wrong is told from all else with this probability; candidates are listed until they have the other.
_DISTINCT_PROBABILITY: Final = 0.8
_LISTED: Final = 0.95
#: With one form of the model an error of it that is no candidate is as probable as those that are. [-]
_UNNAMED: Final = 0.5
#: Largest number of causes, and of candidates that are listed.
_MOST_CAUSES: Final = 5
_MOST_LISTED: Final = 6
_SEED: Final = 41
#: A size that is known before differs from the estimate by no more than this. [standard deviations]
_FAR: Final = 3.0
#: Faults over the whole record beside which the sizes of the errors are estimated, and how large they may be,
#: in standard deviations of their prior.
_BROAD: Final = ("offset", "gain", "drift", "clock")
_BROAD_SIZE: Final = 3.0


@dataclass(frozen=True, eq=False)
class CauseEstimate:
    """A candidate with its evidence.

    Attributes
    ----------
    candidate : Candidate
        The most probable one.
    value, error : float
        Estimate and standard error. [unit of the candidate]
    p : float
        Family-wise p value. [-]
    certainty : float
        Probability among the candidates that what it names is wrong, not above the weight of the model. [-]
    log_bayes_factor : float
        Against no cause. [-]
    told : bool
        Whether it is told from all other candidates.
    others : tuple of Candidate
        What else it may be, the most probable first.
    """

    candidate: Candidate
    value: float
    error: float
    p: float
    certainty: float
    log_bayes_factor: float
    told: bool
    others: tuple[Candidate, ...] = ()


@dataclass(frozen=True, eq=False)
class CauseSearch:
    """Findings, and the p value of the first candidate also where none is named.

    Attributes
    ----------
    findings : tuple of CauseEstimate
        Those that are told first, else in the order in which they were found.
    p : float
        Of the largest evidence of all candidates. [-]
    candidates, draws : int
        Numbers of candidates and of simulated records. [-]
    covariance : ErrorCovariance
        Of the errors of the model.
    """

    findings: tuple[CauseEstimate, ...]
    p: float
    candidates: int
    draws: int
    covariance: ErrorCovariance


def log_prior(candidates: Sequence[Candidate]) -> list[float]:
    """Return the prior probabilities of candidates, as logarithms; their sum is 1.

    Sensors and the model with its inputs are equally likely to be wrong. Kinds of one group, what is wrong of
    one kind, and sizes of one fault share their probability evenly; so do the times at which one begins.

    Parameters
    ----------
    candidates : sequence of Candidate
        What may be the cause.

    Returns
    -------
    list of float
        Of the candidates, then of those that begin within the record, all their times together. [-]

    Examples
    --------
    >>> ones = np.ones((1, 1))
    >>> data = [Candidate("data", "offset", (name,), ones) for name in ("a", "b")]
    >>> np.exp(log_prior([*data, Candidate("form", "form", ("sky",), ones)])).round(2).tolist()
    [0.25, 0.25, 0.5]
    """
    later = [(candidate, candidate.later) for candidate in candidates if candidate.later]
    paths = [
        (
            "data" if candidate.group == "data" else "model",
            candidate.group,
            what,
            (*candidate.subject, candidate.detail),
            k,
        )
        for k, (candidate, what) in enumerate(
            [*((candidate, candidate.what) for candidate in candidates), *later]
        )
    ]
    children: dict[tuple[object, ...], set[object]] = defaultdict(set)
    for path in paths:
        for level in range(len(path)):
            children[path[:level]].add(path[level])
    return [-sum(math.log(len(children[p[:level]])) for level in range(len(p))) for p in paths]


def scores_of(inputs: DiagnosisInput, hypotheses: Hypotheses, gaussian: DayGaussian) -> Scores:
    """Compute what the residuals say of all candidates.

    Parameters
    ----------
    inputs : DiagnosisInput
        Residuals and candidates.
    hypotheses : Hypotheses
        The candidates with their beginnings.
    gaussian : DayGaussian
        Distribution of the residuals without a cause.

    Returns
    -------
    Scores
    """
    residuals = np.where(gaussian.present, inputs.data.error, 0.0)
    prior = log_prior(inputs.candidates)
    if len(hypotheses.families) == 0:
        prior = prior[: len(inputs.candidates)]  # a record too short for a beginning
    return Scores(
        hypotheses.scores(gaussian.solve(residuals)[:, :, None])[:, 0],
        hypotheses.information(gaussian),
        hypotheses.spread([candidate.mean for candidate in inputs.candidates]),
        hypotheses.spread([candidate.sd for candidate in inputs.candidates]),
        hypotheses.spread(prior, times=True),
        limits=np.stack(
            [hypotheses.spread([candidate.limits[end] for candidate in inputs.candidates]) for end in (0, 1)],
            axis=1,
        ),
    )


def covariance_of(inputs: DiagnosisInput) -> ErrorCovariance:
    """Estimate the covariance of the errors beside faults of sensors.

    First beside those that a sensor may have over the whole record, then beside the most probable beginning
    of a fault within the record as well: a step is no error that changes from day to day.

    Parameters
    ----------
    inputs : DiagnosisInput
        Residuals and candidates.

    Returns
    -------
    ErrorCovariance
    """
    broad = [
        _BROAD_SIZE * candidate.sd * candidate.signature
        for candidate in inputs.candidates
        if candidate.what in _BROAD and candidate.group == "data" and candidate.mean == 0.0
    ]
    columns = np.stack(broad, axis=2) if broad else np.zeros((*inputs.data.error.shape, 0))

    def estimated(beside: Floats) -> ErrorCovariance:
        return estimate_error_covariance(
            inputs.data, inputs.days, beside, scale=inputs.scale, limit=inputs.limit
        )

    first = estimated(columns)
    hypotheses = Hypotheses(inputs.candidates, inputs.data.grid, inputs.days)
    if not hypotheses.families:
        return first
    scores = scores_of(inputs, hypotheses, first.gaussian(inputs.data, inputs.days))
    begun = np.arange(hypotheses.count) >= len(inputs.candidates)
    best = int(np.argmax(np.where(begun, scores.log_bayes_factors(), -np.inf)))
    fault = hypotheses.candidate(best)
    step = _BROAD_SIZE * (fault.sd + abs(fault.mean)) * fault.signature
    return estimated(np.concatenate([columns, step[:, :, None]], axis=2))


def diagnose(
    given: DiagnosisInput, covariance: ErrorCovariance | None = None, *, draws: int = DRAWS
) -> CauseSearch:
    """Name the causes of the difference between a model and measurements, if there are any.

    Parameters
    ----------
    given : DiagnosisInput
        Residuals, what is known of the errors, and candidates.
    covariance : ErrorCovariance, optional
        Of the errors; estimated from the residuals when absent.
    draws : int
        Number of simulated records without any cause. [-]

    Returns
    -------
    Result
        Without findings where nothing is significant.

    Examples
    --------
    A sensor that reads 1 K too high for ten days, its stated uncertainty is 0.1 K:

    >>> from mascarin.calibration.errors.day_blocks import DayGrid
    >>> from mascarin.calibration.errors.discrepancy import DayData, Discrepancy, hour_basis
    >>> hours = np.arange(240.0)
    >>> grid = DayGrid.of(hours, interval=1.0, sensors=1)
    >>> present = np.ones((10, 24), dtype=bool)
    >>> basis = hour_basis(hours).reshape(10, 24, -1)
    >>> noise = np.random.default_rng(1).normal(0.0, 0.1, (10, 24))
    >>> data = DayData(grid, 1.0 + noise, np.full((10, 24, 1), 0.1), basis, present, np.array([0.01]))
    >>> small = 1e-3 * np.eye(1)
    >>> known = ErrorCovariance(Discrepancy(small, small, small, np.array([0.01]), np.array([0.01]), 4.0))
    >>> offset = Candidate("data", "offset", ("room",), np.ones((10, 24)), sd=0.5, unit="K")
    >>> stated = np.array([0.1])
    >>> given = DiagnosisInput(data, np.arange(10.0), ("room",), stated, stated, (offset,))
    >>> found = diagnose(given, known).findings[0]
    >>> found.candidate.what, round(found.value), found.p, found.told
    ('offset', 1, 0.001, True)
    """
    covariance = covariance or covariance_of(given)
    if not given.candidates:
        return CauseSearch((), 1.0, 0, 0, covariance)
    hypotheses = Hypotheses(given.candidates, given.data.grid, given.days)
    gaussian = covariance.gaussian(given.data, given.days)
    scores = scores_of(given, hypotheses, gaussian)
    simulator, rng = Simulator(gaussian, hypotheses, covariance.freedom), np.random.default_rng(_SEED)
    findings: list[CauseEstimate] = []
    first_p = 1.0
    while len(findings) < _MOST_CAUSES:
        p = p_value(float(scores.evidence().max()), simulator.largest(scores, draws, rng))
        first_p = first_p if findings else p
        if p >= LEVEL:
            break
        numbers, columns, finding = _finding(given, hypotheses, gaussian, scores, p)
        findings.append(finding)
        if not finding.told and any(
            candidate.group == "data" for candidate in (finding.candidate, *finding.others)
        ):
            break  # what is left depends on which of them it is
        if _bends_the_fit(scores, numbers[0], finding):
            break  # what is left is that of a fit to faulty data
        # An error of the model that is not told may be any of these; a fault of a sensor has to remain
        # beside all of them.
        for k, column in zip(numbers, columns.T, strict=True):
            scores = scores.given(k, column)
    findings.sort(key=lambda cause: not cause.told)
    return CauseSearch(tuple(findings), first_p, hypotheses.count, draws, covariance)


def _bends_the_fit(scores: Scores, k: int, finding: CauseEstimate) -> bool:
    """Whether a fault of known size, as of exchanged columns, has another one about the fitted model."""
    size_is_known = finding.candidate.group == "data" and scores.mean[k] != 0.0
    return size_is_known and abs(scores.estimate(k)[0] - scores.mean[k]) > _FAR * scores.sd[k]


def _finding(
    inputs: DiagnosisInput, hypotheses: Hypotheses, gaussian: DayGaussian, scores: Scores, p: float
) -> tuple[list[int], Floats, CauseEstimate]:
    """The most probable candidate and its alternatives: numbers, columns of ``G' C^-1 G``, and words."""
    evidence = scores.evidence()
    share = np.exp(evidence - evidence.max())
    share /= share.sum()
    key_of = [hypothesis.key for hypothesis in inputs.candidates]
    keys = [*key_of, *(key_of[k] for k, slots in hypotheses.families for _ in slots)]
    of_key: dict[tuple[str, ...], float] = defaultdict(float)
    best: dict[tuple[str, ...], int] = {}
    for k, key in enumerate(keys):
        of_key[key] += float(share[k])
        if key not in best or share[k] > share[best[key]]:
            best[key] = k
    order = sorted(of_key, key=lambda key: -of_key[key])
    listed, total = [order[0]], of_key[order[0]]
    for key in order[1:]:
        if total >= _LISTED or len(listed) > _MOST_LISTED:
            break
        total += of_key[key]
        listed.append(key)
    numbers = [best[key] for key in listed]
    signatures = np.stack([hypotheses.candidate(k).signature for k in numbers], axis=2)
    columns = hypotheses.scores(gaussian.solve(np.where(gaussian.present[:, :, None], signatures, 0.0)))
    # A candidate stands for all that say the same of what is wrong.
    weights = np.log([of_key[key] / share[k] for key, k in zip(listed, numbers, strict=True)])
    subsets = subsets_of(scores, numbers, columns, weights)
    # What is there beside the first one is a cause of its own and no alternative.
    instead = [0, *(m for m in range(1, len(numbers)) if subsets.beside(m, 0) < _LISTED)]
    probability = total * subsets.included(0)
    k = numbers[0]
    candidate = hypotheses.candidate(k)
    size, error = scores.estimate(k)
    tells = candidate.group == "data" or inputs.forms > 1
    return [numbers[m] for m in instead], columns[:, instead], CauseEstimate(
        candidate,
        candidate.known + candidate.scale * size,
        abs(candidate.scale) * error,
        p,
        min(probability * (1.0 - p), inputs.model_weight if tells else min(inputs.model_weight, _UNNAMED)),
        float(scores.log_bayes_factors()[k]),
        probability >= _DISTINCT_PROBABILITY and tells,
        tuple(hypotheses.candidate(numbers[m]) for m in instead[1:]),
    )  # fmt: skip
