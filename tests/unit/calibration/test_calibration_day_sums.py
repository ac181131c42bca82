"""Sums over the days of a distribution are those of dense matrices; draws do not hang on round-off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.calibration.errors.covariance_sampling import sample_covariances
from mascarin.calibration.errors.day_blocks import DayGaussian, DayGrid, Experiments
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy, SizeLimits, hour_basis
from mascarin.linear_algebra import inverted

Floats = NDArray[np.float64]

_DAYS, _SIZE, _COLUMNS, _SAME = 4, 6, 5, 2


def _example(missing: bool, same: bool) -> DayGaussian:
    """Days with one block; with `same` the last two columns are the same on all days."""
    rng = np.random.default_rng(5)
    half = rng.normal(size=(_SIZE, _SIZE))
    present = np.ones((_DAYS, _SIZE), dtype=np.bool_)
    if missing:
        present[1, 2:4] = False
        present[3, 0] = False
    columns = rng.normal(size=(_DAYS, _SIZE, _COLUMNS))
    if same:
        columns[:, :, -_SAME:] = columns[0, :, -_SAME:]
    blocks = np.broadcast_to(half @ half.T + np.eye(_SIZE), (_DAYS, _SIZE, _SIZE))
    return DayGaussian(blocks, columns, present, changing=_COLUMNS - _SAME if same else None)


def _inverse(gaussian: DayGaussian) -> Floats:
    """Inverse of the whole covariance, zero where nothing is there, shape (D * n, D * n)."""
    there = gaussian.present.ravel()
    columns = gaussian.columns.reshape(there.size, -1)
    whole = columns @ columns.T
    for d, block in enumerate(gaussian.blocks):
        rows = slice(d * _SIZE, (d + 1) * _SIZE)
        whole[rows, rows] += block
    inverse = np.zeros_like(whole)
    inverse[np.ix_(there, there)] = np.linalg.inv(whole[np.ix_(there, there)])
    return inverse


@pytest.mark.parametrize("missing", [False, True])
@pytest.mark.parametrize("same", [False, True])
def test_sums_over_days_are_those_of_the_dense_inverse(missing: bool, same: bool) -> None:
    gaussian = _example(missing, same)
    inverse = _inverse(gaussian)
    blocks = [inverse[d * _SIZE : (d + 1) * _SIZE, d * _SIZE : (d + 1) * _SIZE] for d in range(_DAYS)]
    assert gaussian.inverse_blocks == pytest.approx(np.array(blocks), rel=1e-9, abs=1e-11)
    assert gaussian.sum_of_inverse_blocks == pytest.approx(np.sum(blocks, axis=0), rel=1e-9, abs=1e-11)
    values = np.random.default_rng(6).normal(size=(_DAYS, _SIZE, 3))
    flat = values.reshape(-1, 3)
    assert gaussian.quadratic(values) == pytest.approx(flat.T @ inverse @ flat, rel=1e-9)
    assert gaussian.solve(values).reshape(-1, 3) == pytest.approx(inverse @ flat, rel=1e-9, abs=1e-11)
    alike = np.broadcast_to(values[:1], values.shape)
    flat = alike.reshape(-1, 3)
    assert gaussian.quadratic(alike, constant=True) == pytest.approx(flat.T @ inverse @ flat, rel=1e-9)


def test_what_other_experiments_add_is_that_of_all_days_together() -> None:
    whole = _example(missing=True, same=False)
    parts = [
        DayGaussian(whole.blocks[days], whole.columns[days], whole.present[days])
        for days in (slice(0, 2), slice(2, 4))
    ]
    together = Experiments(parts)
    values = np.random.default_rng(7).normal(size=(_DAYS, _SIZE))
    values = np.where(whole.present, values, 0.0)
    assert together.log_density([values[:2], values[2:]]) == pytest.approx(
        whole.log_density(values), rel=1e-12
    )
    sums = sum(part.sum_of_inverse_blocks for part in together.parts)
    assert sums == pytest.approx(whole.sum_of_inverse_blocks, rel=1e-9, abs=1e-11)


def test_inverses_of_matrices_that_are_not_positive_to_round_off() -> None:
    indefinite = np.array([[1.0, 2.0], [2.0, 1.0]])
    found = inverted(np.stack([indefinite, np.array([[2.0, 0.5], [0.5, 1.0]])]))
    assert found[0] == pytest.approx(np.array([[-1.0, 2.0], [2.0, -1.0]]) / 3.0)
    assert found[1] == pytest.approx(np.array([[1.0, -0.5], [-0.5, 2.0]]) / 1.75)


def test_draws_of_sizes_do_not_hang_on_round_off() -> None:
    """Sizes that differ in their last digits give the same draws to nine digits, on any machine."""
    rng, days, slots, sensors = np.random.default_rng(9), 5, 12, 3
    grid = DayGrid(np.zeros(0, np.int64), np.zeros(0, np.int64), days, slots, 2.0)
    hours = np.arange(slots, dtype=np.float64) * 2.0
    basis = np.repeat(np.repeat(hour_basis(hours), sensors, axis=0)[None], days, axis=0)
    error = rng.normal(size=(days, slots * sensors)) * 0.2 + rng.normal(size=(days, 1)) * 0.3
    effects = rng.normal(size=(days, slots * sensors, 2))
    present = np.ones(error.shape, dtype=np.bool_)
    data = DayData(grid, error, effects, basis, present, np.zeros(sensors))
    one = 0.04 * np.eye(sensors)
    first = Discrepancy(one, one, one, np.full(sensors, 0.04), np.zeros(sensors), 4.0, 1.0)
    sizes = [SizeLimits(np.full(sensors, 0.2), np.full(sensors, 2.0))]
    drawn = sample_covariances([data], [first], sizes)
    nearly = replace(first, drift=first.drift * (1.0 + 1e-13))
    again = sample_covariances([data], [nearly], sizes)
    assert again.mean == pytest.approx(drawn.mean, rel=1e-8, abs=1e-9)
