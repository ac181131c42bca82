"""Reconstruct a quantity inside the intervals of its source, such that every mean is kept.

A `PiecewiseProfile` is linear between evenly spaced nodes inside each source interval. It may jump
from one interval to the next. Its means over any span follow exactly from the nodes.

A mean is reconstructed as `k(t) shape(t)`: the shape follows the sun (or is constant), and the
index k is linear between the edges and the middle of the interval. At an edge, k is the same on both
sides; in the middle, k follows from the mean of the interval. Where that would be negative, k is lowered
at the edges; where it would be too large, k is moved towards a constant. The means are kept in each case.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mascarin.tables.arrays import Array, Flags

_FINEST = 300.0
_FLAT_BELOW = 0.2
_TIME_TOLERANCE = 1e-6


@dataclass(frozen=True)
class PiecewiseProfile:
    """A piecewise linear quantity over time.

    Attributes
    ----------
    start : float
        Start of the first source interval [s].
    interval : float
        Length of a source interval [s].
    nodes : ndarray, shape (intervals, m + 1)
        Values at evenly spaced nodes of each interval, both ends included.
    before : int
        Intervals between `start` and the first one with nodes: a part of a profile has the bits of the whole.
    """

    start: float
    interval: float
    nodes: Array
    before: int = 0

    def at(self, time: Array) -> Array:
        """Value at a time; at a shared edge that of the interval that ends there.

        Parameters
        ----------
        time : ndarray, shape (...,)
            Time, same zero as `start` [s].
        """
        count, pieces = self.nodes.shape[0], self.nodes.shape[1] - 1
        position = (np.asarray(time, dtype=np.float64) - self.start) / self.interval
        row = np.ceil(position - _TIME_TOLERANCE / self.interval).astype(np.int64) - 1
        row = np.clip(row, self.before, self.before + count - 1)
        inner = np.clip(position - row, 0.0, 1.0) * pieces
        node = np.minimum(inner.astype(np.int64), pieces - 1)
        weight = inner - node
        nodes, before = self.nodes.ravel(), (row - self.before) * (pieces + 1) + node
        return np.asarray((1.0 - weight) * nodes.take(before) + weight * nodes.take(before + 1))

    def means(self, edges: Array) -> Array:
        """Mean over each span between consecutive edges.

        Parameters
        ----------
        edges : ndarray, shape (n + 1,)
            Increasing times inside the profile, same zero as `start` [s].

        Returns
        -------
        ndarray, shape (n,)
            Means, exact for the profile.
        """
        count, pieces = self.nodes.shape[0], self.nodes.shape[1] - 1
        width = self.interval / pieces
        inside = self.start + width * (self.before * pieces + np.arange(count * pieces + 1))
        inside = inside[(inside > edges[0]) & (inside < edges[-1])]
        cuts = np.sort(np.concatenate([edges, inside]), kind="stable")  # quick for two that are sorted
        # Each once; `numpy.unique` would import masked arrays.
        cuts = cuts[np.concatenate([[True], np.diff(cuts) > 0.0])]
        # On a piece without a node inside, the mean of a linear function is its value in the middle.
        # The middle is never an edge, so the one-sided choice in `at` does not matter.
        integral = self.at(0.5 * (cuts[1:] + cuts[:-1])) * np.diff(cuts)
        first = np.searchsorted(cuts, edges[:-1])
        return np.asarray(np.add.reduceat(integral, first) / np.diff(edges))


def pieces_for(interval: float) -> int:
    """Number of pieces of one source interval: even, none longer than 5 min.

    Parameters
    ----------
    interval : float
        Length of a source interval [s].
    """
    return 2 * max(1, int(np.ceil(interval / (2.0 * _FINEST) - 1e-9)))


def node_times(start: float, interval: float, count: int, pieces: int, before: int = 0) -> Array:
    """Times of all nodes, without those of some intervals at the start.

    Returns
    -------
    ndarray, shape (count, pieces + 1)
        Times, same zero as `start` [s].
    """
    rows = np.arange(before, before + count)
    return start + interval * (rows[:, None] + np.arange(pieces + 1)[None, :] / pieces)


def trapezoid_weights(pieces: int) -> Array:
    """Weights of the nodes in an interval's mean; they sum to one. Shape (pieces + 1,)."""
    weights = np.full(pieces + 1, 1.0 / pieces)
    weights[[0, -1]] *= 0.5
    return weights


def index_nodes(means: Array, shape: Array, largest: float | None = None) -> Array:
    """The index k at the nodes, such that `k shape` has the given mean in each interval.

    Parameters
    ----------
    means : ndarray, shape (n,)
        Mean of each interval; non-negative where `largest` is given.
    shape : ndarray, shape (n, m + 1)
        Non-negative shape at the nodes.
    largest : float, optional
        k may not exceed this in the middle of an interval, nor fall below zero, except where the
        interval's own mean needs more. None: k has no limits (temperatures) [-].

    Returns
    -------
    ndarray, shape (n, m + 1)
        k; zero in intervals without shape.
    """
    left_tent, middle_tent, right_tent = _tents(shape.shape[1] - 1)
    weights = trapezoid_weights(shape.shape[1] - 1)
    weighted = shape * weights
    total = weighted.sum(axis=1)
    on_left, on_middle, on_right = (weighted @ tent for tent in (left_tent, middle_tent, right_tent))
    has_shape = total > 0.0
    safe = np.where(has_shape, total, 1.0)
    constant = np.where(has_shape, means / safe, 0.0)
    edges = _shared_edges(constant, has_shape)
    if largest is not None:
        edges = _lowered(edges, means, on_left, on_right)
    tented = has_shape & (on_middle > _FLAT_BELOW * total)
    remainder = means - edges[:-1] * on_left - edges[1:] * on_right
    centre = np.where(tented, remainder / np.where(tented, on_middle, 1.0), constant)
    share = np.where(tented, 1.0, 0.0)
    if largest is not None:
        limit = np.maximum(largest, constant)
        over = tented & (centre > limit)
        share = np.where(over, (limit - constant) / np.where(over, centre - constant, 1.0), share)
        centre = np.maximum(centre, 0.0)  # rounding, where the edges were lowered
    flat = (1.0 - share) * constant
    ends = [flat + share * edges[:-1], flat + share * centre, flat + share * edges[1:]]
    return np.asarray(
        sum(end[:, None] * tent for end, tent in zip(ends, (left_tent, middle_tent, right_tent), strict=True))
    )


def steady(means: Array, pieces: int, *, positive: bool) -> Array:
    """Reconstruct means without a shape.

    Parameters
    ----------
    means : ndarray, shape (n,)
        Mean of each interval.
    pieces : int
        Pieces of an interval, even.
    positive : bool
        Whether the quantity cannot be negative.

    Returns
    -------
    ndarray, shape (n, pieces + 1)
        Values at the nodes.
    """
    flat = np.ones((len(means), pieces + 1))
    if not positive or np.any(means < 0.0):
        return index_nodes(means, flat)
    return index_nodes(means, flat, largest=float(np.inf))


def _tents(pieces: int) -> tuple[Array, Array, Array]:
    """Linear functions that are one at the left edge, the middle and the right edge."""
    x = np.arange(pieces + 1) / pieces
    left_tent = np.maximum(0.0, 1.0 - 2.0 * x)
    right_tent = np.maximum(0.0, 2.0 * x - 1.0)
    return left_tent, 1.0 - left_tent - right_tent, right_tent


def _shared_edges(index: Array, has_shape: Flags) -> Array:
    """Mean of the two neighbours' index; where one has no shape, the other's."""
    padded = np.concatenate([[0.0], np.where(has_shape, index, 0.0), [0.0]])
    number = np.concatenate([[0.0], has_shape.astype(np.float64), [0.0]])
    both = number[1:] + number[:-1]
    return np.asarray((padded[1:] + padded[:-1]) / np.where(both > 0.0, both, 1.0))


def _lowered(edges: Array, means: Array, on_left: Array, on_right: Array) -> Array:
    """Lower the edges until the two edges of an interval alone do not exceed its mean."""
    taken = edges[:-1] * on_left + edges[1:] * on_right
    over = taken > means
    factor = np.where(over, means / np.where(over, taken, 1.0), 1.0)
    factor = np.concatenate([[1.0], factor, [1.0]])
    return np.asarray(edges * np.minimum(factor[1:], factor[:-1]))
