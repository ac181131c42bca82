"""Weights of several forms of a model by the density of days that were left out of their calibration.

Each day of the identification is predicted from all others; a form that predicts it well has a large density
there. The weights are those of pseudo Bayesian model averaging with a Bayesian bootstrap over the days: few
days do not tell how much better one form is than another, and the bootstrap makes the weights as equal as
that doubt requires.

References
----------
Yao Y., Vehtari A., Simpson D., Gelman A. (2018), Using stacking to average Bayesian predictive distributions,
Bayesian Analysis 13, 917, section 3.4 (pseudo-BMA+). https://doi.org/10.1214/17-BA1091
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LARGEST_LOSS: Final = 3.0
"""Log density of all days left out by which the form that is used may be behind the best one. [-]"""

LEAST_SHARE: Final = 0.05
"""Weight of the form that is used, at least, relative to the largest weight. [-]"""

SMALL_ON_A_DAY: Final = 0.5
"""Difference of the log density of one day between forms that predict it equally well. [-]"""

_REPLICATES: Final = 4000
_SEED: Final = 20


def pseudo_bma_weights(by_day: Floats) -> Floats:
    """Weigh forms of a model.

    Parameters
    ----------
    by_day : ndarray, shape (K, D)
        Log density of each day given all other days, by form.

    Returns
    -------
    ndarray, shape (K,)
        Weights that sum up to 1. [-]

    Examples
    --------
    Two forms that predict all days equally well count the same:

    >>> pseudo_bma_weights(np.zeros((2, 5)))
    array([0.5, 0.5])
    """
    rng = np.random.default_rng(_SEED)
    days = by_day.shape[1]
    share = rng.dirichlet(np.ones(days), size=_REPLICATES)
    total = days * share @ by_day.T
    weight = np.exp(total - total.max(axis=1, keepdims=True))
    weight /= weight.sum(axis=1, keepdims=True)
    mean = weight.mean(axis=0)
    return np.asarray(mean / mean.sum())


def used_form(by_day: Floats, weights: Floats, complexity: Sequence[tuple[int, ...]]) -> int:
    """Choose the form to use: that of the highest weight, or a simpler one that predicts every day as well.

    Only forms count whose log density of all days together is at most `LARGEST_LOSS` behind the highest and
    whose weight is at least `LEAST_SHARE` of the largest. Of them the one of the highest weight is used. A
    simpler one of them takes its place if its density differs by at most `SMALL_ON_A_DAY` on every day.

    Parameters
    ----------
    by_day : ndarray, shape (K, D)
        Log density of each day given all other days, by form.
    weights : ndarray, shape (K,)
        From `pseudo_bma_weights`. [-]
    complexity : sequence of tuple of int, length K
        Of each form, such as its number of free numbers; the smaller the simpler. [-]

    Returns
    -------
    int
        Number of the form.

    Examples
    --------
    The simpler form is used where all days are predicted equally well, not where one day tells them apart:

    >>> by_day = np.array([[1.0, 2.0, 3.0], [1.2, 2.2, 3.1]])
    >>> used_form(by_day, pseudo_bma_weights(by_day), [(2,), (3,)])
    0
    >>> by_day = np.array([[1.0, 2.0, 3.0], [1.2, 2.2, 5.0]])
    >>> used_form(by_day, pseudo_bma_weights(by_day), [(2,), (3,)])
    1
    """
    total = by_day.sum(axis=1)
    eligible = np.flatnonzero(within_reach(by_day, weights, int(total.argmax())))
    best = int(max(eligible, key=lambda k: (weights[k], total[k])))
    alike = np.abs(by_day[eligible] - by_day[best]).max(axis=1) <= SMALL_ON_A_DAY
    return int(min(eligible[alike], key=lambda k: (complexity[k], -weights[k], k)))


def within_reach(by_day: Floats, weights: Floats, best: int) -> NDArray[np.bool_]:
    """Mark the forms that the days do not tell from one of them.

    Parameters
    ----------
    by_day : ndarray, shape (K, D)
        Log density of each day given all other days, by form.
    weights : ndarray, shape (K,)
        From `pseudo_bma_weights`. [-]
    best : int
        Number of the form that the others are compared with.

    Returns
    -------
    ndarray of bool, shape (K,)
        Forms at most `LARGEST_LOSS` behind in log density and with at least `LEAST_SHARE` of its weight.

    Examples
    --------
    >>> within_reach(np.array([[0.0], [-1.0], [-4.0]]), np.array([0.72, 0.27, 0.01]), 0)
    array([ True,  True, False])
    """
    total = by_day.sum(axis=1)
    behind = total[best] - total
    return np.asarray((behind <= LARGEST_LOSS) & (weights >= LEAST_SHARE * weights[best]))


def weighted_quantiles(samples: list[Floats], weights: Floats, levels: Floats) -> Floats:
    """Compute quantiles of a mixture of samples.

    Parameters
    ----------
    samples : list of ndarray
        Values of each part of the mixture. [unit]
    weights : ndarray
        Weight of each part. [-]
    levels : ndarray, shape (L,)
        Probabilities. [-]

    Returns
    -------
    ndarray, shape (L,)
        [unit]

    Examples
    --------
    >>> weighted_quantiles([np.array([1.0, 2.0]), np.array([9.0])], np.array([0.8, 0.2]), np.array([0.5]))
    array([2.])
    """
    values = np.concatenate(samples)
    mass = np.concatenate([np.full(s.size, w / s.size) for s, w in zip(samples, weights, strict=True)])
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(mass[order]) / mass.sum()
    index = np.searchsorted(reached, levels - 1e-12)
    return np.asarray(values[order][np.minimum(index, values.size - 1)])
