"""Intervals from replicates: coverage for any tails of the deviations."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.sensitivity.base.jackknife import Ratio, above_zero, interval

Floats = NDArray[np.float64]


def ratio(values: Floats) -> tuple[Ratio, Ratio]:
    """Replicates (R, n) of n indices with a denominator of one."""
    return Ratio.mean(values), Ratio.mean(np.ones_like(values))


def deviations(kind: str, replicates: int, count: int) -> Floats:
    """Symmetric deviations; the heavy ones are large in one replicate of twenty."""
    rng = np.random.default_rng(4)
    normal = rng.normal(0.0, 0.01, (replicates, count))
    if kind == "normal":
        return normal
    return np.asarray(normal * np.where(rng.random((replicates, count)) < 0.05, 30.0, 1.0))


@pytest.mark.parametrize("replicates", [6, 8, 16])
@pytest.mark.parametrize("kind", ["normal", "heavy"])
def test_95_percent_contain_the_true_value_for_any_tails(kind: str, replicates: int) -> None:
    index, low, high = interval(*ratio(0.4 + deviations(kind, replicates, 20_000)), 0.95)
    inside = np.mean((low <= 0.4) & (high >= 0.4))
    assert 0.940 < inside < 0.960
    assert np.all((low <= index) & (index <= high))


def test_ends_are_means_of_subsets_of_known_rank() -> None:
    """Two of the 15 means of four values lie outside at 1 - 2 * 2 / 16 = 75 %."""
    values = np.array([0.1, 0.2, 0.4, 0.8])[:, None]
    _, low, high = interval(*ratio(values), 0.75)
    assert low[0] == pytest.approx((0.1 + 0.2) / 2)
    assert high[0] == pytest.approx((0.4 + 0.8) / 2)


def test_few_replicates_have_students_interval() -> None:
    values = np.array([0.2, 0.3, 0.4])[:, None]
    index, low, high = interval(*ratio(values), 0.95)
    assert (index[0], low[0], high[0]) == pytest.approx(
        (0.3, 0.3 - 4.3026527 * 0.1 / 3**0.5, 0.3 + 4.3026527 * 0.1 / 3**0.5)
    )


def test_noise_is_rarely_significant() -> None:
    for kind in ("normal", "heavy"):
        assert np.mean(above_zero(*ratio(deviations(kind, 8, 20_000)), 0.99)) < 0.0125
    assert above_zero(*ratio(0.4 + deviations("normal", 8, 100)), 0.9999).all()
