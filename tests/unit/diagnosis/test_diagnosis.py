"""Planted causes are named with their size; without a cause the rate of accusations is as stated."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from diagnosis_support import (
    COVARIANCE,
    DAYS,
    LAW,
    NAMES,
    PYRANOMETER,
    SIMULATED,
    STEP,
    N,
    U,
    drawn,
    given,
    slots,
)
from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.diagnosis.causes import CauseEstimate, covariance_of, diagnose, log_prior, scores_of
from mascarin.diagnosis.hypotheses import Cause
from mascarin.diagnosis.joint_causes import subsets_of
from mascarin.diagnosis.likelihood_ratio import Scores, Simulator, p_value
from mascarin.diagnosis.sensor_faults import shifted, white_noise
from mascarin.diagnosis.step_changes import Hypotheses
from mascarin.tables.quality.filled_values import copied, interpolated

Floats = NDArray[np.float64]


@cache
def _tools() -> tuple[Hypotheses, DayGaussian, Scores]:
    """Candidates, distribution, and scores of residuals of zero."""
    base = given()
    hypotheses = Hypotheses(base.candidates, base.data.grid, base.days)
    gaussian = COVARIANCE.gaussian(base.data, base.days)
    return hypotheses, gaussian, scores_of(base, hypotheses, gaussian)


def _evidence(errors: Floats) -> Floats:
    """Largest evidence of residuals (D, H * S, m), shape (m,)."""
    hypotheses, gaussian, zero = _tools()
    return np.asarray(zero.evidence(hypotheses.scores(gaussian.solve(errors))).max(axis=0))


@cache
def _simulated() -> Floats:
    hypotheses, gaussian, zero = _tools()
    return Simulator(gaussian, hypotheses, np.inf).largest(zero, 1999, np.random.default_rng(1))


def _named(fault: Floats | float, seed: int, draws: int = 199) -> tuple[CauseEstimate, ...]:
    return diagnose(drawn(seed, fault), COVARIANCE, draws=draws).findings


def _change(what: str, s: int) -> Floats:
    """A fault of sensor s, by day and slot."""
    change, m, other = np.zeros((N, 3)), SIMULATED, (s + 1) % 3
    match what:
        case "offset":
            change[:, s] = 6.0 * U[s]
        case "drift":
            change[:, s] = 10.0 * U[s] * np.linspace(-0.5, 0.5, N)
        case "step":
            change[N // 2 :, s] = 5.0 * U[s]
        case "gain":
            change[:, s] = 0.08 * m[:, s]
        case "clock":
            change[:, s] = shifted(m[:, s], 3600.0, STEP) - m[:, s]
        case "swapped":
            change[:, s], change[:, other] = m[:, other] - m[:, s], m[:, s] - m[:, other]
    return slots(change)


def test_without_a_cause_the_rate_of_accusations_is_the_level() -> None:
    base, rng, count = given(), np.random.default_rng(5), 600
    records = [COVARIANCE.draw(base.data, base.days, rng) for _ in range(count)]
    largest = _evidence(np.stack(records, axis=2))
    found = [p_value(float(one), _simulated()) for one in largest]
    for level in (0.05, 0.2):
        below = int(np.count_nonzero(np.array(found) < level))
        assert stats.binomtest(below, count, level).pvalue > 0.01, (level, below)


def test_planted_faults_are_named_first() -> None:
    kinds, hits, wrong = ("offset", "drift", "step", "gain", "clock", "swapped"), 0, []
    for k, what in enumerate(kinds):
        for s in range(3):
            found = _named(_change(what, s), 100 + 10 * k + s)
            right = bool(found) and found[0].candidate.what == what
            right = right and NAMES[s] in found[0].candidate.subject
            hits += right
            wrong += [] if right else [(what, NAMES[s], [one.candidate.label for one in found])]
    assert hits >= 0.8 * 18, wrong


def test_sizes_and_times_of_faults() -> None:
    step = _named(_change("step", 0), 1)[0]
    assert step.value == pytest.approx(0.75, abs=3.0 * step.error)
    assert abs(step.candidate.start - 24.0 * DAYS / 2) <= 12.0
    clock = _named(_change("clock", 1), 2)[0]
    assert clock.value == pytest.approx(60.0, abs=3.0 * clock.error)
    swap = _named(_change("swapped", 1), 3)[0]
    assert swap.candidate.subject == ("wall", "roof")
    assert swap.told
    gain = _named(_change("gain", 2), 4)[0]
    assert gain.value == pytest.approx(8.0, abs=3.0 * gain.error)


def test_a_cause_in_the_model_or_an_input_is_not_put_on_a_sensor() -> None:
    for seed in range(4):
        law = _named(slots(LAW), 20 + seed)[0]
        assert (law.candidate.group, law.candidate.detail, law.told) == ("form", "brunt", True)
        sun = _named(slots(0.6 * PYRANOMETER), 30 + seed)[0]
        assert sun.candidate.subject == ("global_horizontal",)
        assert sun.value == pytest.approx(6.0, abs=4.0 * sun.error)


def test_what_an_uncertain_number_or_a_stated_offset_explains_is_no_cause() -> None:
    effects = given().data.effects[:, :, :5]  # of one standard deviation of their priors
    limit = float(np.quantile(_simulated(), 0.95))
    assert (_evidence(2.0 * effects) < limit).all()
    # An offset of 6 is one.
    assert (_evidence(6.0 * effects[:, :, 2:]) > limit).all()


def test_two_candidates_that_act_alike_are_not_told_apart() -> None:
    one = drawn(7, slots(LAW))
    law = next(c for c in one.candidates if c.group == "form")
    twin = replace(law, group="path", what="path", subject=("room",), detail="air change with outdoors")
    both = replace(one, candidates=(*one.candidates, twin))
    found = diagnose(both, COVARIANCE, draws=199).findings
    assert len(found) == 1
    assert not found[0].told
    assert {found[0].candidate.group, *(other.group for other in found[0].others)} == {"form", "path"}
    assert found[0].certainty == pytest.approx(0.5, abs=0.1)


def test_two_causes_that_are_both_there_are_no_alternatives_of_each_other() -> None:
    both = _change("offset", 0) + 1.18 * _change("offset", 2)
    apart = diagnose(drawn(11, both), COVARIANCE, draws=199).findings
    assert [finding.told for finding in apart[:2]] == [True, True]
    assert {finding.candidate.subject for finding in apart[:2]} == {("room",), ("roof",)}
    # Among single causes neither has the probability at which one is told.
    scores = scores_of(drawn(11, both), _tools()[0], _tools()[1])
    evidence = scores.evidence()
    best = [evidence[[k for k, c in enumerate(given().candidates) if c.key == ("data", name)]].max()
            for name in ("room", "roof")]  # fmt: skip
    assert abs(best[0] - best[1]) < 2.0


def test_the_search_ends_at_a_fault_that_has_bent_the_fit() -> None:
    # A drift beside exchanged columns; where the estimates have made more of these, it may come from them.
    found = {}
    for size in (1.0, 1.7):
        fault = size * _change("swapped", 1) + 2.0 * _change("drift", 0)
        found[size] = [
            one.candidate.what for one in diagnose(drawn(13, fault), COVARIANCE, draws=199).findings
        ]
    assert found[1.0][:2] == ["swapped", "drift"]
    assert found[1.7] == ["swapped"]


def test_a_value_without_a_meaning_is_no_cause() -> None:
    experiment = drawn(12, _change("offset", 0))
    offset = next(c for c in experiment.candidates if c.key == ("data", "room") and c.what == "offset")
    # The absorptance would have to be negative.
    absorptance = replace(
        offset,
        group="parameter",
        what="parameter",
        subject=("absorptance",),
        sd=1.0,
        signature=-offset.signature,
    )
    for limits, accused in (((-np.inf, np.inf), False), ((-0.2, np.inf), True)):
        both = replace(experiment, candidates=(*experiment.candidates, replace(absorptance, limits=limits)))
        finding = diagnose(both, COVARIANCE, draws=199).findings[0]
        assert finding.told is accused, limits
        subjects = [candidate.subject for candidate in (finding.candidate, *finding.others)]
        assert ("absorptance",) in subjects or accused


def test_limits_of_a_size_by_quadrature() -> None:
    one = Scores(
        np.array([3.0]), np.array([2.0]), np.array([0.5]), np.array([2.0]), np.zeros(1),
        limits=np.array([[-1.0, 0.8]]),
    )  # fmt: skip
    size = np.linspace(-1.0, 0.8, 20001)
    density = stats.norm(0.5, 2.0).pdf(size)
    prior = density / np.trapezoid(density, size)
    likelihood = np.exp(3.0 * size - size**2)
    whole = np.trapezoid(prior * likelihood, size)
    assert one.log_bayes_factors()[0] == pytest.approx(np.log(whole), abs=1e-6)
    mean = np.trapezoid(size * prior * likelihood, size) / whole
    assert one.estimate(0)[0] == pytest.approx(mean, abs=1e-6)
    assert one.log_bayes_factors(np.array([[3.0, -40.0]]))[0, 0] == pytest.approx(np.log(whole), abs=1e-6)


def test_subsets_of_candidates_by_their_densities() -> None:
    # Three candidates on four values with errors of 1.
    rng = np.random.default_rng(6)
    g, r, prior = rng.normal(size=(4, 3)), rng.normal(size=4) + 2.0, np.log([0.2, 0.3, 0.1])
    scores = Scores(g.T @ r, np.sum(g**2, axis=0), np.zeros(3), np.ones(3), prior)
    subsets = subsets_of(scores, (0, 1, 2), g.T @ g, np.zeros(3))
    logarithms = [
        stats.multivariate_normal(cov=np.eye(4) + g[:, some] @ g[:, some].T).logpdf(r) + prior[some].sum()
        for some in subsets.members
    ]
    expected = np.exp(logarithms - np.max(logarithms))
    assert subsets.probability == pytest.approx(expected / expected.sum())


def test_no_certainty_beyond_the_draws_and_the_weight_of_the_model() -> None:
    one = replace(drawn(8, 5.0 * _change("offset", 0)), model_weight=0.6)
    found = diagnose(one, COVARIANCE, draws=99)
    assert found.p == found.findings[0].p == pytest.approx(0.01)
    assert found.findings[0].certainty == 0.6


def test_an_offset_is_found_with_sizes_that_are_estimated_from_the_same_record() -> None:
    one = drawn(9, _change("offset", 1) * 1.5)
    found = diagnose(one, covariance_of(one), draws=199)
    assert found.findings[0].candidate.subject == ("wall",)
    # The part of the error that repeats has not grown to explain the offset.
    assert found.covariance.sizes.hour[1, 1] < 0.3**2


def test_one_candidate_by_hand() -> None:
    # Two values with errors of 1 and a signature of 1: score 3, information 2, prior of the size N(0, 2^2).
    one = Scores(np.array([3.0]), np.array([2.0]), np.zeros(1), np.array([2.0]), np.zeros(1))
    covariance = np.eye(2) + 4.0 * np.ones((2, 2))
    r = np.array([1.0, 2.0])
    by_density = stats.multivariate_normal(cov=covariance).logpdf(r) - stats.multivariate_normal(
        cov=np.eye(2)
    ).logpdf(r)
    assert one.log_bayes_factors()[0] == pytest.approx(by_density)
    assert one.estimate(0) == pytest.approx((3.0 / 2.25, 2.25**-0.5))
    # With the candidate in the covariance nothing is left of it that a second one of the kind could explain.
    left = one.given(0, np.array([2.0]))
    inverse = np.linalg.inv(covariance)
    assert left.score[0] == pytest.approx(np.ones(2) @ inverse @ r)
    assert left.information[0] == pytest.approx(np.ones(2) @ inverse @ np.ones(2))


def test_scores_and_information_of_all_beginnings_are_those_of_their_signatures() -> None:
    hypotheses, gaussian, zero = _tools()
    error = COVARIANCE.draw(given().data, given().days, np.random.default_rng(3))
    scores = hypotheses.scores(gaussian.solve(error)[:, :, None])[:, 0]
    for k in [0, len(hypotheses.whole) - 1, *np.linspace(len(hypotheses.whole), hypotheses.count - 1, 9)]:
        signature = hypotheses.candidate(int(k)).signature
        weighted = gaussian.solve(signature)
        assert scores[int(k)] == pytest.approx(float(np.sum(weighted * error)), rel=1e-6, abs=1e-6)
        assert zero.information[int(k)] == pytest.approx(float(np.sum(weighted * signature)), rel=1e-6)


def test_information_is_that_of_the_dense_covariance_where_the_columns_are_large() -> None:
    """Known effects that take nearly all: what is left is not lost to round-off."""
    hypotheses, gaussian, _ = _tools()
    wide = replace(gaussian, columns=100.0 * gaussian.columns)
    columns = wide.columns.reshape(wide.present.size, -1)
    root = np.linalg.cholesky(wide.blocks[0])
    white = np.linalg.solve(root, columns.reshape(*wide.columns.shape)).reshape(columns.shape)
    span, size, _ = np.linalg.svd(white, full_matrices=False)
    found = hypotheses.information(wide)
    for k in [*range(len(hypotheses.whole)), len(hypotheses.whole) + 3, hypotheses.count - 1]:
        signature = np.linalg.solve(root, hypotheses.candidate(k).signature[:, :, None]).ravel()
        along = span.T @ signature
        across = signature - span @ along
        expected = float(across @ across + np.sum(along**2 / (1.0 + size**2)))
        alone = float(signature @ signature)  # from which the known effects take nearly everything
        assert found[k] == pytest.approx(expected, rel=1e-4, abs=1e-6 * alone)


def test_what_is_named_is_within_the_records_that_are_simulated_next() -> None:
    # Scores given a candidate are those with its column in the covariance.
    hypotheses, gaussian, zero = _tools()
    error = COVARIANCE.draw(given().data, given().days, np.random.default_rng(4))
    scores = replace(zero, score=hypotheses.scores(gaussian.solve(error)[:, :, None])[:, 0])
    signature, k = hypotheses.candidate(0).signature, 0
    left = scores.given(k, hypotheses.scores(gaussian.solve(signature)[:, :, None])[:, 0])
    wide = np.concatenate([gaussian.columns, scores.sd[k] * signature[:, :, None]], axis=2)
    other = replace(gaussian, columns=wide)
    assert left.score == pytest.approx(hypotheses.scores(other.solve(error)[:, :, None])[:, 0], abs=1e-5)
    assert left.information == pytest.approx(hypotheses.information(other), rel=1e-5, abs=1e-6)


def test_prior_probabilities_sum_up_to_one() -> None:
    assert np.exp(log_prior(given().candidates)).sum() == pytest.approx(1.0)


def test_a_cause_is_stored_and_read() -> None:
    cause = Cause("data", "step", ("room",), "room: a step", 0.5, 0.1, "K", 0.01, 0.7, 12.0, False, ("x",))
    assert Cause.from_dict(cause.to_dict()) == cause


@pytest.mark.parametrize("sd", [0.08, 0.3])
def test_the_floor_of_white_noise(sd: float) -> None:
    found, error = white_noise(sd * np.random.default_rng(5).normal(size=N) + SIMULATED[:, 0], STEP)
    assert found == pytest.approx(sd, abs=max(4.0 * error, 0.1 * sd))


def test_filled_stretches() -> None:
    rng = np.random.default_rng(2)
    values = np.round(SIMULATED[:, 0] + 0.05 * rng.normal(size=N), 2)
    assert interpolated(values) == copied(values, STEP) == []
    line = values.copy()
    line[430:455] = np.round(np.linspace(line[430], line[454], 25), 2)
    assert [run[:2] for run in interpolated(line)] == [(431, 454)]
    repeated = values.copy()
    repeated[500:524] = repeated[404:428]
    assert [run[:2] for run in copied(repeated, STEP)] == [(500, 524)]
    # Hourly values that were interpolated everywhere are usual.
    hourly = np.interp(np.arange(N), np.arange(0, N, 4), values[::4])
    assert interpolated(np.round(hourly, 4)) == []
