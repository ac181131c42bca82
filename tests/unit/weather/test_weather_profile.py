from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mascarin.tables.profile import PiecewiseProfile, index_nodes, pieces_for, steady, trapezoid_weights

MEANS = st.lists(st.floats(0.0, 1000.0), min_size=3, max_size=30)


def node_means(nodes: np.ndarray) -> np.ndarray:
    return np.asarray(nodes @ trapezoid_weights(nodes.shape[1] - 1))


def test_pieces_are_even_and_no_longer_than_five_minutes() -> None:
    for interval, pieces in ((60.0, 2), (600.0, 2), (900.0, 4), (3600.0, 12), (10800.0, 36)):
        assert pieces_for(interval) == pieces


def test_value_at_a_jump_is_that_of_the_interval_that_ends() -> None:
    profile = PiecewiseProfile(0.0, 10.0, np.array([[1.0, 2.0, 3.0], [7.0, 8.0, 9.0]]))
    assert profile.at(np.array([0.0, 5.0, 10.0, 10.1, 20.0])) == pytest.approx([1.0, 2.0, 3.0, 7.02, 9.0])


def test_means_over_spans_that_fit_nothing() -> None:
    profile = PiecewiseProfile(0.0, 10.0, np.array([[0.0, 0.0, 4.0], [4.0, 2.0, 0.0]]))
    # By hand: 0 .. 7.5 has a triangle of 2 x 2.5 / 2; 7.5 .. 20 the rest of 10 + 20.
    assert profile.means(np.array([0.0, 7.5, 20.0])) == pytest.approx([2.5 / 7.5, 27.5 / 12.5], rel=1e-14)


@given(MEANS)
@settings(max_examples=60, deadline=None)
def test_steady_keeps_means_signs_and_continuity(means: list[float]) -> None:
    target = np.array(means)
    nodes = steady(target, 6, positive=True)
    assert np.max(np.abs(node_means(nodes) - target)) < 1e-10
    assert nodes.min() >= 0.0
    assert np.max(np.abs(nodes[1:, 0] - nodes[:-1, -1])) < 1e-10


@given(MEANS)
@settings(max_examples=60, deadline=None)
def test_shaped_reconstruction_keeps_means_and_signs(means: list[float]) -> None:
    target = np.array(means)
    shape = np.random.default_rng(len(means)).uniform(0.0, 1.0, (len(means), 5))
    shape[::3] = 0.0
    nodes = shape * index_nodes(target, shape, largest=1.2)
    expected = np.where(shape.any(axis=1), target, 0.0)
    assert np.max(np.abs(node_means(nodes) - expected)) < 1e-9
    assert nodes.min() >= 0.0


def test_a_linear_series_is_reconstructed_from_its_means() -> None:
    edges = np.arange(21.0)
    nodes = steady(0.5 * (edges[1:] + edges[:-1]), 4, positive=False)
    inner = nodes[1:-1]
    expected = np.arange(1.0, 19.0)[:, None] + np.arange(5) / 4
    assert np.max(np.abs(inner - expected)) < 1e-12


def test_a_lone_interval_is_not_blown_up_beyond_its_limit() -> None:
    means = np.array([0.0, 0.9, 0.0])
    nodes = index_nodes(means, np.ones((3, 5)), largest=1.2)
    assert nodes.max() == pytest.approx(1.2)
    assert node_means(nodes) == pytest.approx(means)
