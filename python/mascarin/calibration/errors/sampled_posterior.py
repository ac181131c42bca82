"""Parameters and errors of sensors drawn from their posterior by a gradient sampler, with the model itself.

About the estimates the model is linear in its parameters, and the density and its gradient cost next to
nothing: there the No-U-Turn sampler moves. Each of its moves is a
proposal for the density with the model itself, which is run once for it (delayed acceptance). Sizes of the
errors of the model are drawn from a sample of their distribution given the measurements, made with the linear
model, and accepted likewise. What is drawn is then the posterior of the model, whatever the linear one is; a
bad one only takes longer.

Errors that repeat, those of days and numbers that are not estimated are integrated out in closed form.

References
----------
`mascarin.calibration.sampling.nuts`
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy
from mascarin.calibration.sampling.nuts import StepSize, moved
from mascarin.calibration.sampling.posterior_sample import PosteriorSample

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

Simulate = Callable[[Floats], Floats]
"""From positions (M, P) to the series of the model (M, T, S); NaN where it cannot be run."""

#: Sizes of the errors of the model between which a chain moves.
_SIZES: Final = 32
#: Parts of the warm-up: with the scales of the linear model, and with those of its chains.
_PARTS: Final = (0.6, 0.4)
#: By how much the first states are further apart than the sample from which they are drawn.
_APART: Final = 1.5


@dataclass(frozen=True, slots=True)
class ChainLengths:
    """How long is sampled.

    Attributes
    ----------
    chains : int
        Number of chains, which are run side by side in one batch. [-]
    draws : int
        Draws of each that are used. [-]
    warmup : int
        Draws before. [-]
    seed : int
        Of the random numbers.

    Examples
    --------
    >>> ChainLengths().chains
    16
    """

    chains: int = 16
    draws: int = 500
    warmup: int = 200
    seed: int = 1


@dataclass(frozen=True, eq=False)
class Coefficients:
    """What is drawn: positions of parameters and errors of sensors, in standard deviations of their priors.

    Attributes
    ----------
    low, high : ndarray, shape (q,)
        Ends of each. [-]
    normal : ndarray of bool, shape (q,)
        Whether its prior is normal; else every value is equally likely. [-]
    first : ndarray, shape (n, q)
        A sample about which the chains begin. [-]
    """

    low: Floats
    high: Floats
    normal: Flags
    first: Floats


@dataclass(frozen=True, eq=False)
class Chains:
    """What was drawn.

    Attributes
    ----------
    draws : ndarray, shape (C, N, q)
        Coefficients. [-]
    log_density : ndarray, shape (C, N)
        Up to a constant. [-]
    accepted : float
        Part of the proposals that the model accepts. [-]
    diverged : int
        Paths that lost their energy.
    """

    draws: Floats
    log_density: Floats
    accepted: float
    diverged: int


def sampled(
    data: DayData,
    sizes: Sequence[Discrepancy],
    coefficients: Coefficients,
    misfit: Simulate,
    lengths: ChainLengths,
) -> Chains:
    """Draw coefficients from their posterior.

    Parameters
    ----------
    data : DayData
        Errors and effects of the linear model; the first q effects are those that are drawn.
    sizes : sequence of Discrepancy
        Sample of the sizes of the errors of the model given the measurements, for the linear model.
    coefficients : Coefficients
        What is drawn.
    misfit : callable
        From coefficients (M, q) to the difference of the model from the linear one by day and slot
        (M, D, n). [unit]
    lengths : ChainLengths
        How long is sampled.
    """
    count = coefficients.low.size
    chosen = [sizes[k] for k in np.linspace(0, len(sizes) - 1, min(_SIZES, len(sizes))).astype(int)]
    integrated_out = replace(data, effects=data.effects[:, :, count:])
    linear = [_Linear(integrated_out.gaussian(size), data, count) for size in chosen]
    marginal = np.array([data.gaussian(size).log_density(data.error) for size in chosen])
    chains = [_Chain(linear, marginal, coefficients, k, lengths) for k in range(lengths.chains)]
    first = int(_PARTS[0] * lengths.warmup)
    draws, densities, accepted, tried, diverged = [], [], 0, 0, 0
    pooled: list[Floats] = []
    for number in range(lengths.warmup + lengths.draws):
        proposals = np.array([chain.propose() for chain in chains])
        away = misfit(proposals)
        taken = [chain.decide(difference) for chain, difference in zip(chains, away, strict=True)]
        if number < lengths.warmup:
            pooled += [chain.state for chain in chains]
        if number == first - 1:
            scale = _scale_of(np.array(pooled[len(pooled) // 3 :]), chains[0].scale)
            for chain in chains:
                chain.rescale(scale)
        if number == lengths.warmup - 1:
            for chain in chains:
                chain.settle()
        if number >= lengths.warmup:
            accepted, tried = accepted + sum(taken), tried + len(taken)
            diverged += sum(chain.diverged for chain in chains)
            draws.append([chain.coefficients for chain in chains])
            densities.append([chain.log_density for chain in chains])
    return Chains(
        np.swapaxes(np.array(draws), 0, 1),
        np.array(densities).T,
        accepted / max(tried, 1),
        diverged,
    )


def chains_of(
    problem: CalibrationProblem,
    data: DayData,
    sizes: Sequence[Discrepancy],
    first: Floats,
    ends: tuple[Floats, Floats],
    priors: tuple[Floats, Floats],
    of_sensors: tuple[str, ...],
    departure: Simulate,
    lengths: ChainLengths,
) -> PosteriorSample:
    """Chains of parameters and errors of sensors, with the model itself.

    Parameters
    ----------
    problem, data, sizes, lengths
        As for `sampled`.
    first : ndarray, shape (n, q)
        Positions and errors of sensors about which the chains begin. [-]
    ends : tuple of ndarray, shape (q,)
        Lowest and highest of each. [-]
    priors : tuple of ndarray, shape (P,)
        Mean and standard deviation of each position before the data. [-]
    of_sensors : tuple of str
        Names of the errors of sensors.
    departure : callable
        From positions (M, P) to the difference of the model from the linear one (M, T, S). [unit]
    """
    center, spread = priors
    count, mask = center.size, problem.mask
    shift, scale = np.zeros(ends[0].size), np.ones(ends[0].size)
    shift[:count], scale[:count] = center, spread

    def misfit(coefficients: Floats) -> Floats:
        z = np.clip(coefficients[:, :count] * spread + center, 0.0, 1.0)
        away = np.where(mask, departure(z), 0.0)
        return np.array([data.grid.means(series, mask)[0] for series in away])

    normal = np.array([p.prior is not None for p in problem.parameters] + [True] * len(of_sensors))
    coefficients = Coefficients(
        (ends[0] - shift) / scale, (ends[1] - shift) / scale, normal, (first - shift) / scale
    )
    chains = sampled(data, sizes, coefficients, misfit, lengths)
    values = chains.draws * scale + shift
    flat = values[:, :, :count].reshape(-1, count)
    values[:, :, :count] = problem.values(flat).reshape(values[:, :, :count].shape)
    return PosteriorSample(
        (*problem.paths, *of_sensors),
        (*(p.unit for p in problem.parameters), *("-" for _ in of_sensors)),
        values,
        chains.log_density,
        chains.accepted,
        chains.diverged,
    )


def coefficients_of(problem: CalibrationProblem, chains: PosteriorSample) -> Floats:
    """Draws of all chains as positions and errors of sensors, shape (n, q). [-]"""
    flat = chains.draws.reshape(-1, len(chains.names)).copy()
    count = len(problem.parameters)
    flat[:, :count] = [problem.positions(row) for row in flat[:, :count]]
    return flat


class _Linear:
    """The linear model for one of the sizes of the errors: a quadratic form of the coefficients."""

    def __init__(self, gaussian: DayGaussian, data: DayData, count: int) -> None:
        columns = np.where(data.present[:, :, None], data.effects[:, :, :count], 0.0)
        self.gaussian, self.columns, self.error = gaussian, columns, data.error
        weighted = gaussian.solve(columns)
        self.precision = np.einsum("dnp,dnq->pq", columns, weighted, optimize=True)
        self.slope = np.einsum("dnp,dn->p", weighted, data.error, optimize=True)
        self.level = gaussian.log_density(data.error)

    def log_density(self, a: Floats) -> tuple[float, Floats]:
        """Log density of the data with the linear model, and its gradient by the coefficients."""
        pull = self.precision @ a
        return self.level + float(a @ self.slope) - 0.5 * float(a @ pull), self.slope - pull

    def correction(self, a: Floats, misfit: Floats) -> float:
        """Log density of the data with the model itself minus that with the linear one."""
        if not np.isfinite(misfit).all():
            return -math.inf
        weighted = self.gaussian.solve(misfit)
        linear = self.error - self.columns @ a
        return float(np.sum((linear - 0.5 * misfit) * weighted))


class _Chain:
    """One chain. A state is the logit of the coefficients within their ends, in units of their spread."""

    def __init__(
        self,
        linear: list[_Linear],
        marginal: Floats,
        coefficients: Coefficients,
        number: int,
        lengths: ChainLengths,
    ) -> None:
        self._linear, self._marginal, self._all = linear, marginal, coefficients
        self._rng = np.random.default_rng([lengths.seed, number])
        self._width = coefficients.high - coefficients.low
        self.scale = _first_scale(linear[0], coefficients)
        sample = coefficients.first
        middle = np.median(sample, axis=0)
        begin = middle + _APART * (sample[int(self._rng.integers(len(sample)))] - middle)
        self.state = self._logit(begin)
        self._size = int(self._rng.integers(len(linear)))
        self._step = StepSize()
        self._adapts, self.diverged = True, False
        self._misfit: Floats | None = None
        self._proposal = self.state

    @property
    def coefficients(self) -> Floats:
        """The coefficients of the state."""
        return self._values(self.state)

    @property
    def log_density(self) -> float:
        """Log density of the state with the model itself, up to a constant."""
        assert self._misfit is not None  # noqa: S101 (asked for after the first move)
        linear, a = self._linear[self._size], self.coefficients
        return linear.log_density(a)[0] + self._prior(a) + linear.correction(a, self._misfit)

    def propose(self) -> Floats:
        """Move with the linear model; the coefficients where it ended."""
        root = self.scale
        start = self.state

        def density(v: Floats) -> tuple[float, Floats]:
            log_density, gradient = self._density(start + root @ v)
            return log_density, root.T @ gradient

        move = moved(density, np.zeros(start.size), self._step.step, self._rng)
        if self._adapts:
            self._step.adapt(move.acceptance)
        self.diverged = move.diverged
        self._proposal = start + root @ move.state
        return self._values(self._proposal)

    def decide(self, misfit: Floats) -> bool:
        """Accept the proposal or not, then perhaps another size of the errors; whether it was accepted."""
        linear = self._linear[self._size]
        proposed = linear.correction(self._values(self._proposal), misfit)
        current = -math.inf if self._misfit is None else linear.correction(self.coefficients, self._misfit)
        taken = self._misfit is None or math.log(self._rng.random() or 1e-300) < proposed - current
        if taken:
            self.state, self._misfit = self._proposal, misfit
        other = int(self._rng.integers(len(self._linear)))
        ratio = self._weight(other) - self._weight(self._size)
        if math.log(self._rng.random() or 1e-300) < ratio:
            self._size = other
        return taken

    def _weight(self, size: int) -> float:
        """Log density of the data given the state, over that by which the sizes were drawn."""
        assert self._misfit is not None  # noqa: S101 (set by `decide`)
        linear, a = self._linear[size], self.coefficients
        return linear.log_density(a)[0] + linear.correction(a, self._misfit) - float(self._marginal[size])

    def rescale(self, root: Floats) -> None:
        """Take other scales, and adapt the step again."""
        self.scale, self._step = root, StepSize(self._step.step)

    def settle(self) -> None:
        """End the adaptation."""
        self._step.settle()
        self._adapts = False

    def _density(self, u: Floats) -> tuple[float, Floats]:
        """Log density of a state with the linear model, and its gradient."""
        share = _sigmoid(u)
        a = self._all.low + self._width * share
        log_density, gradient = self._linear[self._size].log_density(a)
        pull = np.where(self._all.normal, a, 0.0)
        change = self._width * share * (1.0 - share)
        # The logit stretches what is near an end: its derivative belongs to the density.
        stretch = float(np.sum(np.log(np.maximum(share * (1.0 - share), 1e-300))))
        return (
            log_density - 0.5 * float(pull @ pull) + stretch,
            (gradient - pull) * change + 1.0 - 2.0 * share,
        )

    def _prior(self, a: Floats) -> float:
        normal = a[self._all.normal]
        return -0.5 * float(normal @ normal)

    def _values(self, u: Floats) -> Floats:
        return np.asarray(self._all.low + self._width * _sigmoid(u))

    def _logit(self, a: Floats) -> Floats:
        share = np.clip((a - self._all.low) / self._width, 0.01, 0.99)
        return np.asarray(np.log(share / (1.0 - share)))


def _sigmoid(u: Floats) -> Floats:
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * u)))


def _first_scale(linear: _Linear, coefficients: Coefficients) -> Floats:
    """A root of the covariance of the states as the linear model has it, about the middle of the sample."""
    precision = linear.precision + np.diag(np.where(coefficients.normal, 1.0, 0.0))
    width = coefficients.high - coefficients.low
    share = np.clip((np.median(coefficients.first, axis=0) - coefficients.low) / width, 0.1, 0.9)
    change = width * share * (1.0 - share)
    # The logit of a uniform distribution has a variance of pi^2 / 3.
    precision = precision * np.outer(change, change) + 0.3 * np.eye(width.size)
    return np.asarray(np.linalg.cholesky(np.linalg.inv(precision)))


def _scale_of(states: Floats, before: Floats) -> Floats:
    """A root of the covariance of states (n, q), drawn to that of before where there are few."""
    count, size = states.shape
    share = count / (count + 10.0 * size)
    covariance = share * np.atleast_2d(np.cov(states, rowvar=False)) + (1.0 - share) * before @ before.T
    return np.asarray(np.linalg.cholesky(covariance + 1e-9 * np.eye(size)))
