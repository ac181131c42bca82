"""Means over other intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


def means(stamps: Array, values: Array, times: Array) -> Array:
    """Means over the intervals that end at the times, of a flux recorded at the end of each step."""
    # A recorded flux is that of the step that it ends.
    heat = np.concatenate([[0.0], np.cumsum(values[1:] * np.diff(stamps))])
    heat_at = np.interp(times, stamps, heat)
    return np.concatenate([values[:1], np.diff(heat_at) / np.diff(times)])


def state_means(stamps: Array, values: Array, times: Array) -> Array:
    """Means over the intervals that end at the times, of a state on straight lines between its records."""
    # Two rising runs: a stable sort merges them.
    points = np.sort(np.concatenate([stamps, times]), kind="stable")
    points = points[np.append(True, np.diff(points) > 0.0)]
    level = np.interp(points, stamps, values)
    sums = np.concatenate([[0.0], np.cumsum(0.5 * (level[1:] + level[:-1]) * np.diff(points))])
    sums_at = np.interp(times, points, sums)
    return np.concatenate([values[:1], np.diff(sums_at) / np.diff(times)])
