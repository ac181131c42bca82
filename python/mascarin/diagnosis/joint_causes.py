"""Several causes at once: which candidates are needed beside each other, and which are alternatives.

Two candidates of similar evidence may explain the same of the residuals, so that one of them is enough, or
each something else, so that both are there. The probability of each among single causes does not tell these
apart. All subsets of the few most probable candidates do: the density of the residuals with a subset is the
product of the Bayes factors of its candidates, each given those before it, and its prior that of theirs.

References
----------
George E.I., McCulloch R.E. (1993), Variable selection via Gibbs sampling, J. Am. Stat. Assoc. 88, 881 (the
probability that a variable is included). https://doi.org/10.1080/01621459.1993.10476353
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mascarin.diagnosis.likelihood_ratio import Scores

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Subsets:
    """All subsets of some candidates, with their probabilities.

    Attributes
    ----------
    members : ndarray of bool, shape (2^m, m)
        Which candidates each has.
    probability : ndarray, shape (2^m,)
        [-]

    Examples
    --------
    Two candidates of which one is enough:

    >>> members = np.array([[False, False], [True, False], [False, True], [True, True]])
    >>> either = Subsets(members, np.array([0.0, 0.6, 0.3, 0.1]))
    >>> round(either.included(0), 2), round(either.beside(1, 0), 2)
    (0.7, 0.14)
    """

    members: Flags
    probability: Floats

    def included(self, k: int) -> float:
        """Return the probability that a candidate is there. [-]"""
        return float(self.probability[self.members[:, k]].sum())

    def beside(self, k: int, other: int) -> float:
        """Return the probability that a candidate is there if another one is. [-]"""
        both = self.members[:, k] & self.members[:, other]
        return float(self.probability[both].sum()) / max(self.included(other), 1e-300)


def subsets_of(scores: Scores, numbers: Sequence[int], columns: Floats, weights: Floats) -> Subsets:
    """Compute the probabilities of all subsets of a few candidates.

    Parameters
    ----------
    scores : Scores
        Of all candidates.
    numbers : sequence of int, length m
        The few.
    columns : ndarray, shape (K, m)
        Their columns of ``G' C^-1 G``, without any candidate. [-]
    weights : ndarray, shape (m,)
        What is added to their prior probabilities, as logarithms. [-]

    Returns
    -------
    Subsets

    Examples
    --------
    Two candidates that act on different values, with the same evidence: both are there, while each has half
    of the probability among single causes.

    >>> one = np.ones(2)
    >>> apart = Scores(50.0 * one, 100.0 * one, 0.0 * one, one, -one)
    >>> both = subsets_of(apart, (0, 1), 100.0 * np.eye(2), 0.0 * one)
    >>> round(both.included(0), 3), round(both.beside(1, 0), 3)
    (1.0, 1.0)
    """
    chosen, first = scores.among(numbers), len(scores.named)
    chosen = replace(chosen, log_prior=chosen.log_prior + np.concatenate([np.zeros(first), weights]))
    rows = [*(k for k, _ in scores.named), *numbers]
    pairs = columns[rows]

    def evidence(
        now: Scores, begin: int, members: tuple[int, ...]
    ) -> Iterator[tuple[tuple[int, ...], float]]:
        yield members, 0.0
        of_each = now.evidence()
        for k in range(begin, len(numbers)):
            for subset, further in evidence(now.given(first + k, pairs[:, k]), k + 1, (*members, k)):
                yield subset, float(of_each[first + k]) + further

    weighed = list(evidence(chosen, 0, ()))
    members = np.zeros((len(weighed), len(numbers)), dtype=bool)
    for row, (subset, _) in zip(members, weighed, strict=True):
        row[list(subset)] = True
    logarithms = np.array([total for _, total in weighed])
    probability = np.exp(logarithms - logarithms.max())
    return Subsets(members, probability / probability.sum())
