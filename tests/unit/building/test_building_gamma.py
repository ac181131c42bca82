"""The published relations for gamma: numbers by hand, and the law of the engine."""

from __future__ import annotations

import numpy as np
import pytest

from mascarin.building.gamma import (
    gamma_equation_3,
    gamma_from_dsc,
    gamma_of_width,
    half_width,
    liquid_fraction,
    peak_capacity,
    two_valued_gamma,
)
from mascarin.errors import InputError

HEATS = (3134.0, 2833.0)
LATENT = 71000.0


def test_widths_of_the_papers_gammas() -> None:
    assert half_width(0.04, 0.01) == pytest.approx(1.0)
    assert half_width(0.01, 0.01) == pytest.approx(4.0)
    assert gamma_of_width(half_width(0.7, 0.02), 0.02) == pytest.approx(0.7)


def test_equation_3_is_not_the_gamma_of_table_4() -> None:
    gamma = gamma_equation_3(LATENT, HEATS[0], 23.4, 0.01)
    assert gamma == pytest.approx(71000.0 / (3134.0 * 23.39))
    assert gamma == pytest.approx(0.97, abs=0.005)
    # It hangs on the zero of the scale: a kelvin higher in degC, another gamma.
    assert gamma_equation_3(LATENT, HEATS[0], 46.79, 0.01) == pytest.approx(gamma / 2.0, rel=1e-3)


def test_gamma_from_the_calorimeters_peak() -> None:
    assert gamma_from_dsc(13000.0, HEATS, LATENT, 0.01) == pytest.approx(0.0113, abs=5e-5)
    assert gamma_from_dsc(13600.0, HEATS, LATENT, 0.01) == pytest.approx(0.0120, abs=5e-5)
    assert peak_capacity(gamma_from_dsc(13000.0, HEATS, LATENT, 0.01), HEATS, LATENT, 0.01) == pytest.approx(
        13000.0
    )
    with pytest.raises(InputError, match="expected more than the mean 2983"):
        gamma_from_dsc(2900.0, HEATS, LATENT, 0.01)


def test_peak_is_the_slope_of_the_enthalpy() -> None:
    t = np.array([23.4 - 1e-4, 23.4 + 1e-4])
    slope = np.diff(liquid_fraction(t, 23.4, 0.04, 0.01))[0] / 2e-4 * LATENT
    assert peak_capacity(0.04, HEATS, LATENT, 0.01) == pytest.approx(0.5 * sum(HEATS) + slope, rel=1e-6)


def test_the_near_gamma_applies_in_a_window_of_two_hundredths_of_a_kelvin() -> None:
    t = np.linspace(20.0, 27.0, 70001)
    gamma = two_valued_gamma(t, 23.4, 0.01, near=0.97, far=0.04)
    assert np.count_nonzero(gamma == 0.97) == pytest.approx(201, abs=1)
    two = liquid_fraction(t, 23.4, gamma, 0.01)
    one = liquid_fraction(t, 23.4, 0.04, 0.01)
    assert np.abs(two - one)[np.abs(t - 23.4) > 0.0101].max() == 0.0
    # Inside it climbs by tanh(0.97/4)/2 instead of tanh(0.04/4)/2, and jumps back at the window's edge.
    assert np.abs(two - one).max() == pytest.approx(
        0.5 * (np.tanh(0.97 / 4.0) - np.tanh(0.04 / 4.0)), rel=0.01
    )


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_values_must_be_positive(value: float) -> None:
    for call in (
        lambda: half_width(value, 0.01),
        lambda: gamma_of_width(1.0, value),
        lambda: gamma_equation_3(value, 3134.0, 23.4, 0.01),
        lambda: two_valued_gamma(20.0, 23.4, 0.01, near=value, far=0.04),
    ):
        with pytest.raises(InputError, match="expected a positive number"):
            call()


def test_fractions_within_the_width() -> None:
    """The shares that the module's text names."""
    for distance, share in ((0.55, 0.50), (1.0, 0.76), (2.0, 0.96)):
        ends = liquid_fraction(np.array([-distance, distance]), 0.0, 0.04, 0.01)
        assert float(ends[1] - ends[0]) == pytest.approx(share, abs=0.006)
