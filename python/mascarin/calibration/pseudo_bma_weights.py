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

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MIN_CLEAR_DIFFERENCE: Final = 4.0
"""Difference of the log density of all days below which no form is clearly better; odds of 55 to 1. [-]"""

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


def most_parsimonious(by_day: Floats, changes: list[int]) -> int:
    """Choose the form to use: the simplest one that is not clearly worse than the best.

    A form is clearly worse if the best one predicts the days left out better by more than two standard errors
    of the difference, and by more than `MIN_CLEAR_DIFFERENCE`.

    Parameters
    ----------
    by_day : ndarray, shape (K, D)
        Log density of each day given all other days, by form.
    changes : list of int, length K
        In how many parts each form differs from the model as described. [-]

    Returns
    -------
    int
        Number of the form.

    References
    ----------
    Hastie T., Tibshirani R., Friedman J. (2009), The Elements of Statistical Learning, 7.10 (the simplest
    model within the standard error of the best). https://doi.org/10.1007/978-0-387-84858-7

    Examples
    --------
    >>> most_parsimonious(np.array([[1.0, 2.0, 3.0], [3.0, 1.0, 3.5], [9.0, 11.0, 12.0]]), [0, 1, 1])
    2
    >>> most_parsimonious(np.array([[1.0, 2.0, 3.0], [3.0, 1.0, 3.5]]), [0, 1])
    0
    """
    total = by_day.sum(axis=1)
    best = int(total.argmax())
    days = by_day.shape[1]
    less = by_day[best] - by_day
    doubt = 2.0 * math.sqrt(days) * less.std(axis=1, ddof=1) if days > 1 else np.full(len(by_day), np.inf)
    candidates = np.flatnonzero(less.sum(axis=1) <= np.maximum(doubt, MIN_CLEAR_DIFFERENCE))
    return int(min(candidates, key=lambda k: (changes[k], -total[k])))


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
