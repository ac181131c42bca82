"""Normal distributions of several variables within bounds."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Chains side by side, moves of each before they are used, and moves that are kept, every fifth of them.
_CHAINS: Final = 100
_BURN_IN: Final = 60
_SAMPLED_MOVES: Final = 200
_THINNING: Final = 5
_SEED: Final = 20


def within_bounds(mean: Floats, covariance: Floats, low: Floats, high: Floats) -> Floats:
    """Draw from a normal distribution within a box, the same numbers in every call.

    Each variable is drawn in turn from its distribution given all others (Gibbs sampling).

    Parameters
    ----------
    mean : ndarray, shape (P,) or (K, P)
        Without the bounds; may be outside of them. With K of them each has as many draws.
    covariance : ndarray, shape (P, P) or (K, P, P)
        Without the bounds, positive definite.
    low, high : ndarray, shape (P,)
        Bounds.

    Returns
    -------
    ndarray, shape (n, P)
        Sample.

    References
    ----------
    Geweke J. (1991), Efficient simulation from the multivariate normal and Student-t distributions subject to
    linear constraints, Computing Science and Statistics 23, 571.

    Examples
    --------
    A normal distribution above its mean has the mean sqrt(2 / pi):

    >>> sample = within_bounds(np.zeros(1), np.eye(1), np.zeros(1), np.full(1, 40.0))
    >>> bool(abs(sample.mean() - 0.798) < 0.03)
    True
    """
    from scipy.special import ndtr, ndtri

    rng = np.random.default_rng(_SEED)
    size = mean.shape[-1]
    mean = np.atleast_2d(mean)
    repeats = -(-_CHAINS // len(mean))
    mean = np.tile(mean, (repeats, 1))
    covariance = np.tile(covariance.reshape(-1, size, size), (repeats, 1, 1))
    precision = np.linalg.inv(covariance)
    precision = 0.5 * (precision + np.swapaxes(precision, 1, 2))
    sd = 1.0 / np.sqrt(np.einsum("kii->ki", precision))
    ridge = 1e-12 * np.einsum("kii->ki", covariance)[:, :, None] * np.eye(size)
    root = np.linalg.cholesky(covariance + ridge)
    first = np.clip(mean + np.einsum("kij,kj->ki", root, rng.standard_normal(mean.shape)), low, high)
    away, least, most = first - mean, low - mean, high - mean
    # By variable: minus the effect of all others on its mean, in its own standard deviations.
    effects = np.swapaxes(precision * sd[:, :, None], 0, 1) * (1.0 - np.eye(size))[:, None, :]
    by_variable = [
        (np.ascontiguousarray(effects[i]), *(np.ascontiguousarray(each[:, i]) for each in (sd, least, most)))
        for i in range(size)
    ]
    states = []
    for move in range(_BURN_IN + _SAMPLED_MOVES):
        uniform = rng.random((size, len(mean)))
        for i, (effect, spread, lowest, highest) in enumerate(by_variable):
            middle = -np.einsum("kj,kj->k", effect, away)
            first, last = lowest / spread - middle, highest / spread - middle
            # The tail in which both ends are small numbers, so that none is rounded to one.
            flip = first > 0.0
            ends = ndtr(np.where(flip, (-last, -first), (first, last)))
            part = ends[0] + uniform[i] * (ends[1] - ends[0])
            draw = ndtri(np.minimum(np.maximum(part, 1e-300), 1.0 - 1e-16))
            draw = np.minimum(np.maximum(np.where(flip, -draw, draw), first), last)
            away[:, i] = np.minimum(np.maximum(spread * (middle + draw), lowest), highest)
        if move >= _BURN_IN and (move - _BURN_IN) % _THINNING == 0:
            states.append(np.clip(mean + away, low, high))
    return np.concatenate(states)
