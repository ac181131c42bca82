from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from mascarin.errors import InputError
from mascarin.sensitivity.base.factors import Factor
from mascarin.sensitivity.spectral import SpectralSensitivity, analyze, design
from mascarin.sensitivity.spectral.spectrum import line_threshold, power_threshold


def _result(order: int = 8) -> SpectralSensitivity:
    factors = [Factor(name, -1.0, 1.0, distribution="sine") for name in "abcd"]
    plan = design(factors, order=order, seed=3)
    a, b, c, _ = plan.all_samples().T
    return analyze(plan, a + 0.8 * b**2 + b * c, names=["room"])


def test_peaks_are_named_in_every_replicate() -> None:
    result = _result()
    for replicate in range(result.design.replicates):
        w = dict(zip("abcd", result.design.frequencies[replicate], strict=True))
        found = {peak.line: peak for peak in result.peaks("room", replicate)}
        lines = {w["a"]: "a", 2 * w["b"]: "2 × b", w["b"] + w["c"]: "b + c", abs(w["b"] - w["c"]): "b − c"}
        for line, label in lines.items():
            assert label in (found[line].label, *found[line].weaker_labels)
    # Nothing is put down to d, whatever falls on its line.
    assert all("d" not in peak.parameters for r in range(8) for peak in result.peaks("room", r))


def test_powers_of_the_peaks() -> None:
    result = _result()
    # Variances: a 1/2; 0.8 b**2 at 2 b with 0.4**2 / 2; b c on two lines of amplitude 1/2.
    total = 0.5 + 0.08 + 0.25
    by_label = {peak.label: peak for peak in result.peaks("room")}
    assert by_label["a"].kind == "fundamental"
    assert by_label["a"].power == pytest.approx(0.5 / total, rel=0.02)
    assert by_label["2 × b"].kind == "harmonic"
    assert by_label["2 × b"].power == pytest.approx(0.08 / total, rel=0.02)
    assert by_label["b + c"].kind == "interaction"
    assert by_label["b + c"].parameters == ("b", "c")
    assert by_label["b + c"].power == pytest.approx(0.125 / total, rel=0.02)


def test_a_line_above_the_threshold_in_one_replicate_has_no_name() -> None:
    result = _result()
    result.spectra[0, 99, 0] = 0.5
    peak = next(peak for peak in result.peaks("room") if peak.line == 100)
    assert (peak.kind, peak.label) == ("unnamed", "")


def test_lines_above_half_the_runs_are_found_at_their_alias() -> None:
    factors = [Factor(name, -1.0, 1.0, distribution="sine") for name in "ab"]
    plan = design(factors, order=1, frequencies=[90, 100], runs=202, seed=0)
    a, b = plan.all_samples().T
    result = analyze(plan, a + a * b)
    labels = {peak.label: peak.line for peak in result.peaks("y1")}
    assert labels["a + b"] == 202 - 190


def test_thresholds_are_quantiles_of_beta_distributions() -> None:
    assert line_threshold(400) == pytest.approx(stats.beta.isf(0.05 / 400, 1, 399))
    assert power_threshold(2, 801) == pytest.approx(stats.beta.isf(0.05, 2, 398))
    assert power_threshold(2, 801, replicates=8, parameters=200) < power_threshold(2, 801, parameters=200)
    assert power_threshold(2, 5) == 1.0


def test_unknown_output_or_replicate() -> None:
    result = _result()
    with pytest.raises(InputError, match="'rooom'"):
        result.peaks("rooom")
    with pytest.raises(InputError, match="replicates 0 to 7"):
        result.peaks("room", 8)
    assert np.all(result.spectra.sum(axis=1) <= 1.0 + 1e-12)
