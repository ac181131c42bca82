"""Evidence for causes: Bayes factors, and the distribution of the largest one without any cause.

A cause adds its signature g times a size to residuals that are normal with the covariance C. All that the
residuals say of it are the score ``s = g' C^-1 r`` and the information ``v = g' C^-1 g``. With a normal prior
of the size, mean m and standard deviation d, the Bayes factor against no cause is

    log B = ((s + m / d^2)^2 / (v + 1 / d^2) - (m / d)^2 - log(1 + v d^2)) / 2

A size may have limits, beyond which it has no meaning. The prior is then the same normal distribution within
them, and ``log B`` has added the logarithm of what part of the posterior lies within them, less that of the
prior (Gelfand et al. 1992).

The largest of many dependent Bayes factors is simulated: records without a cause are drawn from C, and the
part of them whose largest one reaches the observed one is its p value, whatever the number of candidates, of
times among them, and their dependence.

References
----------
Kass R.E., Raftery A.E. (1995), Bayes factors, J. Am. Stat. Assoc. 90, 773.
https://doi.org/10.1080/01621459.1995.10476572
Gelfand A.E., Smith A.F.M., Lee T.-M. (1992), Bayesian analysis of constrained parameter and truncated data
problems, J. Am. Stat. Assoc. 87, 523. https://doi.org/10.1080/01621459.1992.10475235
Westfall P.H., Young S.S. (1993), Resampling-based multiple testing, Wiley (maximum statistics).
Davison A.C., Hinkley D.V. (1997), Bootstrap Methods and their Application, 4.2 (p values of simulations).
https://doi.org/10.1017/CBO9780511802843
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.diagnosis.step_changes import Hypotheses

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

#: Records that are simulated at once.
_CHUNK: Final = 100


@dataclass(frozen=True, eq=False)
class Scores:
    """What residuals say of all candidates.

    Attributes
    ----------
    score : ndarray, shape (K,)
        ``G' C^-1 r``. [-]
    information : ndarray, shape (K,)
        Diagonal of ``G' C^-1 G``. [-]
    mean, sd : ndarray, shape (K,)
        Priors of the sizes. [-]
    log_prior : ndarray, shape (K,)
        Logarithm of the probability of each candidate before the data, over that of none. [-]
    named : tuple of (int, ndarray)
        Candidates that count as there, and their columns of ``G' C^-1 G``, each given those before it. Their
        sizes are normal, without limits.
    limits : ndarray, shape (K, 2), optional
        Smallest and largest sizes that have a meaning; absent: none has limits. [-]

    Examples
    --------
    One candidate whose signature is 1 in 100 values with errors of 1, and a mean of the values of 0.5:

    >>> one = Scores(np.array([50.0]), np.array([100.0]), np.zeros(1), np.ones(1), np.zeros(1))
    >>> estimate, error = one.estimate(0)
    >>> round(estimate, 3), round(error, 3)
    (0.495, 0.1)
    >>> one.evidence().round(2)
    array([10.07])
    """

    score: Floats
    information: Floats
    mean: Floats
    sd: Floats
    log_prior: Floats
    named: tuple[tuple[int, Floats], ...] = ()
    limits: Floats | None = None

    def log_bayes_factors(self, scores: Floats | None = None) -> Floats:
        """Return the logarithms of the Bayes factors, of other scores (K, n) if there are any. [-]"""
        score = self.score if scores is None else scores
        shape = (-1, *(1,) * (score.ndim - 1))
        precision, mean = (self.sd**-2.0).reshape(shape), self.mean.reshape(shape)
        v = self.information.reshape(shape)
        square = (score + mean * precision) ** 2 / (v + precision)
        log_factors = np.asarray(0.5 * (square - mean**2 * precision - np.log1p(v / precision)))
        for k in self._limited:
            low, high = self._ends[k]
            total = self.information[k] + self.sd[k] ** -2.0
            middle, root = (score[k] + self.mean[k] / self.sd[k] ** 2) / total, total**0.5
            log_factors[k] += log_mass((low - middle) * root, (high - middle) * root)
            log_factors[k] -= log_mass(*((np.array([low, high]) - self.mean[k]) / self.sd[k]))
        return log_factors

    @property
    def _ends(self) -> Floats:
        """Limits of all candidates, shape (K, 2)."""
        return np.tile([-np.inf, np.inf], (self.sd.size, 1)) if self.limits is None else self.limits

    @cached_property
    def _limited(self) -> Integers:
        """Numbers of the candidates with limits."""
        return np.flatnonzero(np.isfinite(self._ends).any(axis=1))

    def evidence(self, scores: Floats | None = None) -> Floats:
        """Return the Bayes factors times the prior probabilities, as logarithms. [-]"""
        log_factors = self.log_bayes_factors(scores)
        return log_factors + self.log_prior.reshape(-1, *(1,) * (log_factors.ndim - 1))

    def estimate(self, k: int) -> tuple[float, float]:
        """Return the size of a candidate and its standard error, within its limits. [-]"""
        from scipy import stats

        precision = self.sd[k] ** -2.0
        total = float(self.information[k] + precision)
        middle, error = float(self.score[k] + self.mean[k] * precision) / total, total**-0.5
        low, high = (self._ends[k] - middle) / error
        if np.isinf(low) and np.isinf(high):
            return middle, error
        within = stats.truncnorm(low, high, loc=middle, scale=error)
        return float(within.mean()), float(within.std())

    def gain(self, k: int, column: Floats) -> float:
        """Part of a score that a candidate of unknown size takes from it. [-]"""
        return float(self.sd[k] ** 2 / (1.0 + self.sd[k] ** 2 * column[k]))

    def among(self, numbers: Sequence[int]) -> Scores:
        """Return the scores of those that are named and of a few others, in this order.

        Parameters
        ----------
        numbers : sequence of int
            The others.
        """
        rows = [*(k for k, _ in self.named), *numbers]
        return Scores(
            self.score[rows],
            self.information[rows],
            self.mean[rows],
            self.sd[rows],
            self.log_prior[rows],
            tuple((row, column[rows]) for row, (_, column) in enumerate(self.named)),
            self._ends[rows],
        )

    def given(self, k: int, column: Floats) -> Scores:
        """Return the scores of all candidates if candidate k is there, with a size that is not known.

        Parameters
        ----------
        k : int
            The candidate.
        column : ndarray, shape (K,)
            Its column of ``G' C^-1 G``, without any candidate. [-]
        """
        for number, named_column in self.named:
            column = column - named_column * self.gain(number, named_column) * column[number]
        gain, score = self.gain(k, column), self.score - self.mean[k] * column
        return replace(
            self,
            score=score - column * gain * score[k],
            information=np.maximum(self.information - gain * column**2, 0.0),
            named=(*self.named, (k, column)),
        )


@dataclass(frozen=True, eq=False)
class Simulator:
    """Records without any cause but those that are named.

    Attributes
    ----------
    gaussian : DayGaussian
        Distribution of the residuals.
    hypotheses : Hypotheses
        All candidates.
    freedom : float
        Degrees of freedom of the sizes of the errors: each record has errors that are larger or smaller
        together, as little is known of their size. [-]
    """

    gaussian: DayGaussian
    hypotheses: Hypotheses
    freedom: float

    def largest(self, scores: Scores, draws: int, rng: np.random.Generator) -> Floats:
        """Simulate the largest evidence of all candidates.

        Parameters
        ----------
        scores : Scores
            Gives priors and informations, and what is named already.
        draws : int
            Number of simulated records. [-]
        rng : numpy.random.Generator
            Random numbers.

        Returns
        -------
        ndarray, shape (draws,)
            [-]
        """
        root = np.linalg.cholesky(self.gaussian.blocks[0])
        present, columns = self.gaussian.present, self.gaussian.columns
        largest_evidence = np.empty(draws)
        for first in range(0, draws, _CHUNK):
            count = min(_CHUNK, draws - first)
            errors = np.einsum(
                "nm,dmk->dnk", root, rng.standard_normal((*present.shape, count)), optimize=True
            )
            errors += columns @ rng.standard_normal((columns.shape[2], count))
            weighted = self.gaussian.solve(np.where(present[:, :, None], errors, 0.0))
            simulated = self.hypotheses.scores(weighted)
            for k, column in scores.named:
                size = scores.sd[k] * rng.standard_normal(count)
                simulated = simulated + column[:, None] * size
                simulated -= column[:, None] * (scores.gain(k, column) * simulated[k])
            if np.isfinite(self.freedom):
                simulated *= np.sqrt(self.freedom / rng.chisquare(self.freedom, count))
            largest_evidence[first : first + count] = scores.evidence(simulated).max(axis=0)
        return largest_evidence


def log_mass(low: Floats, high: Floats) -> Floats:
    """Compute the logarithm of the part of a standard normal distribution between two numbers. [-]

    Parameters
    ----------
    low, high : ndarray
        With ``low < high``; may be infinite. [-]

    Examples
    --------
    >>> log_mass(np.array([-np.inf, 6.0]), np.array([0.0, np.inf])).round(2)
    array([ -0.69, -20.74])
    """
    from scipy.special import log_ndtr

    # In the lower half the differences of both are exact.
    swap = np.asarray(low) > 0.0
    low, high = np.where(swap, -high, low), np.where(swap, -np.asarray(low), high)
    above = log_ndtr(high)
    return np.asarray(above + np.log1p(-np.exp(np.minimum(log_ndtr(low) - above, -1e-300))))


def p_value(observed: float, simulated: Floats) -> float:
    """Part of simulated records that reach an observed statistic; never below 1 / (records + 1).

    Parameters
    ----------
    observed : float
        [-]
    simulated : ndarray, shape (n,)
        The statistic without any cause. [-]

    Returns
    -------
    float
        [-]

    Examples
    --------
    >>> p_value(9.0, np.arange(9.0))
    0.1
    """
    return float(1 + np.count_nonzero(simulated >= observed)) / (simulated.size + 1)
