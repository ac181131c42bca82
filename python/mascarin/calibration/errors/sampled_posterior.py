"""Parameters and errors of sensors drawn from their posterior by a gradient sampler, with the model itself.

A polynomial through runs of the model gives the density and its gradient for next to nothing: there the
No-U-Turn sampler moves. Each of its moves is a proposal for the density with the model itself, which is run
for it (delayed acceptance). What is drawn is then the posterior of the model, whatever the polynomial is; a
bad one only takes longer. The first moves are those of the linear model about the estimates; the polynomial
is fitted to what they and the next moves of the warm-up ran, and does not change after that.

The density is the mean over a sample of the sizes of the errors of the model, made with the linear model,
which are weighted by their prior.

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
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy
from mascarin.calibration.sampling.marginals import Marginals
from mascarin.calibration.sampling.nuts import StepSize, moved
from mascarin.calibration.sampling.posterior_sample import PosteriorSample
from mascarin.calibration.sampling.response_surface import response_surface

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

Simulate = Callable[[Floats], Floats]
"""From positions (M, P) to the series of the model (M, T, S); NaN where it cannot be run."""

#: Sizes of the errors of the model over which the density is a mean.
_SIZES: Final = 32
#: Parts of the warm-up. Before each but the first a polynomial is fitted to all runs so far, and scales are
#: those of the states of the part before.
_PARTS: Final = (0.25, 0.25, 0.25, 0.25)
#: Moves with the polynomial for each run of the model.
_MOVES: Final = 2
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
    model_count : int
        How many of them, from the first, the model depends on. [-]
    """

    low: Floats
    high: Floats
    normal: Flags
    first: Floats
    model_count: int


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
        Part of the proposals from the polynomial that the model accepts. [-]
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
    model = _Model(data, sizes, coefficients)
    surface, scales = _Surface(model), _Scales.of_sample(coefficients, coefficients.first)
    chains = [_Chain(coefficients, scales, k, lengths) for k in range(lengths.chains)]
    ends = np.cumsum([round(part * lengths.warmup) for part in _PARTS])
    runs: list[tuple[Floats, Floats]] = []
    states: list[Floats] = []
    draws, densities, accepted, tried, diverged = [], [], 0, 0, 0
    for number in range(lengths.warmup + lengths.draws):
        if number in ends[:-1]:
            surface = model.surface(runs)
            scales, states = _Scales.of_sample(coefficients, np.array(states)), []
            for chain in chains:
                chain.adapt_again()
        proposals = np.array([chain.propose(surface, scales) for chain in chains])
        differences = misfit(proposals)
        exact = model.log_densities(proposals, differences)
        taken = [chain.decide(density) for chain, density in zip(chains, exact, strict=True)]
        if number < lengths.warmup:
            usable = np.isfinite(exact)
            runs.append((proposals[usable], differences[usable]))
            states += [chain.coefficients for chain in chains]
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
        (ends[0] - shift) / scale, (ends[1] - shift) / scale, normal, (first - shift) / scale, count
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


class _Model:
    """The density of the data with the model itself, over the sizes of the errors."""

    def __init__(self, data: DayData, sizes: Sequence[Discrepancy], coefficients: Coefficients) -> None:
        count = coefficients.low.size
        chosen = [sizes[k] for k in np.linspace(0, len(sizes) - 1, min(_SIZES, len(sizes))).astype(int)]
        integrated_out = replace(data, effects=data.effects[:, :, count:])
        self.gaussians = [integrated_out.gaussian(size) for size in chosen]
        self.columns = np.where(data.present[:, :, None], data.effects[:, :, :count], 0.0)
        self.error, self.model_count = data.error, coefficients.model_count
        nothing = np.zeros(data.error.shape)
        # The sizes are drawn from their distribution given the data: weights that make it the prior.
        marginal = np.array([data.gaussian(size).log_density(data.error) for size in chosen])
        self.level = np.array([gaussian.log_density(nothing) for gaussian in self.gaussians]) - marginal
        self.spread = np.sqrt(
            np.mean([np.diagonal(gaussian.blocks, 0, 1, 2) for gaussian in self.gaussians], axis=0)
        )

    def surface(self, runs: Sequence[tuple[Floats, Floats]]) -> _Surface:
        """Density with a polynomial through runs, coefficients (M, q) and differences (M, D, n)."""
        points, misfit = (np.concatenate(part) for part in zip(*runs, strict=True))
        # Fewer runs than a straight line has terms: the linear model says more.
        return _Surface(self, points, misfit) if len(points) > self.model_count + 1 else _Surface(self)

    def log_densities(self, coefficients: Floats, misfit: Floats) -> Floats:
        """Log densities (M,) of coefficients (M, q) whose series differ from the linear model (M, D, n)."""
        usable = np.asarray(np.isfinite(misfit).all(axis=(1, 2)))
        away = self.error[:, :, None] - self.columns @ coefficients.T
        away = away - np.moveaxis(np.where(usable[:, None, None], misfit, 0.0), 0, -1)
        squares = np.array(
            [np.einsum("dnm,dnm->m", away, gaussian.solve(away)) for gaussian in self.gaussians]
        )
        return np.where(usable, _log_mean(self.level[:, None] - 0.5 * squares)[0], -math.inf)


class _Surface:
    """The same density with a polynomial through runs of the model; without runs that of the linear model.

    For each of the sizes it is a quadratic form of the coefficients and of the shares of the directions in
    which the polynomial moves the series.
    """

    def __init__(self, model: _Model, points: Floats | None = None, misfit: Floats | None = None) -> None:
        self._count, self._surface, self._flat = model.model_count, None, 1.0
        columns = model.columns
        if points is not None and misfit is not None and self._count:
            scaled = (misfit / model.spread).reshape(len(misfit), -1)
            self._surface = response_surface(points[:, : self._count], scaled)
            self._flat = self._surface.flatness
            directions = self._surface.directions.T.reshape(*model.error.shape, -1) * model.spread[:, :, None]
            columns = np.concatenate([columns, directions], axis=2)
        weighted = [gaussian.solve(columns) for gaussian in model.gaussians]
        self._precision = np.array(
            [np.einsum("dnp,dnq->pq", columns, solved, optimize=True) for solved in weighted]
        )
        self._slope = np.array([np.einsum("dnp,dn->p", solved, model.error) for solved in weighted])
        squares = [float(np.sum(model.error * gaussian.solve(model.error))) for gaussian in model.gaussians]
        self._level = model.level - 0.5 * np.array(squares)

    def log_density(self, a: Floats) -> tuple[float, Floats]:
        """Log density of the data, and its gradient by the coefficients (q,)."""
        all_shares = a
        if self._surface is not None:
            shares, derivative = self._surface.at(a[: self._count])
            all_shares = np.concatenate([a, shares])
        pull = (self._precision @ all_shares).reshape(self._slope.shape)
        log_density, weights = _log_mean(self._level + self._slope @ all_shares - 0.5 * (pull @ all_shares))
        steep = weights @ (self._slope - pull)
        gradient = steep[: a.size].copy()
        if self._surface is not None:
            gradient[: self._count] += derivative @ steep[a.size :]
        return self._flat * float(log_density), self._flat * gradient


@dataclass(frozen=True, eq=False)
class _Scales:
    """States of which the coefficients are functions, so that all directions have about the same scale.

    Attributes
    ----------
    marginals : Marginals
        Of the coefficients: numbers that are about normal.
    middle : ndarray, shape (q,)
        Of the numbers. [-]
    root : ndarray, shape (q, q)
        A root of their covariance. [-]
    """

    marginals: Marginals
    middle: Floats
    root: Floats

    @classmethod
    def of_sample(cls, coefficients: Coefficients, sample: Floats) -> _Scales:
        """Scales of a sample (n, q) of the coefficients."""
        count, size = sample.shape
        marginals = Marginals.of_sample(coefficients.low, coefficients.high, sample)
        numbers = marginals.numbers(sample)
        # With few states the numbers count as independent.
        share = count / (count + 10.0 * size)
        covariance = share * np.atleast_2d(np.cov(numbers, rowvar=False)) + (1.0 - share) * np.eye(size)
        return cls(marginals, numbers.mean(axis=0), np.asarray(np.linalg.cholesky(covariance)))

    def numbers(self, state: Floats) -> Floats:
        """Numbers (q,) of a state."""
        return np.asarray(self.middle + self.root @ state)

    def coefficients(self, state: Floats) -> Floats:
        """Coefficients (q,) of a state."""
        return self.marginals.values(self.numbers(state))

    def state(self, coefficients: Floats) -> Floats:
        """State of coefficients (q,)."""
        return np.asarray(np.linalg.solve(self.root, self.marginals.numbers(coefficients) - self.middle))


class _Chain:
    """One chain."""

    def __init__(
        self, coefficients: Coefficients, scales: _Scales, number: int, lengths: ChainLengths
    ) -> None:
        self._normal = coefficients.normal
        self._rng = np.random.default_rng([lengths.seed, number])
        begin = coefficients.first[int(self._rng.integers(len(coefficients.first)))]
        self.coefficients = scales.coefficients(_APART * scales.state(begin))
        self._step, self._adapts, self.diverged = StepSize(), True, False
        #: Log density of the coefficients with the model itself; before the first run, none.
        self.log_density = -math.inf
        self._proposal, self._gain = self.coefficients, 0.0

    def propose(self, surface: _Surface, scales: _Scales) -> Floats:
        """Move with the polynomial; the coefficients where it ended."""
        start = scales.state(self.coefficients)

        def density(state: Floats) -> tuple[float, Floats]:
            a, change, stretch, steep = scales.marginals.stretched(scales.numbers(state))
            log_density, gradient = self._density(surface, a)
            return log_density + stretch, (gradient * change + steep) @ scales.root

        # Moves that are reversible, one after the other with the same step, are so together.
        state, acceptance, self.diverged = start, 0.0, False
        for _ in range(_MOVES):
            move = moved(density, state, self._step.step, self._rng)
            state, acceptance = move.state, acceptance + move.acceptance / _MOVES
            self.diverged |= move.diverged
        if self._adapts:
            self._step.adapt(acceptance)
        self._proposal = scales.coefficients(state)
        before, after = (self._density(surface, a)[0] for a in (self.coefficients, self._proposal))
        self._gain = after - before
        return self._proposal

    def decide(self, log_density: float) -> bool:
        """Accept the proposal with the log density of its data or not; whether it was accepted."""
        after = log_density + self._prior(self._proposal)
        first = not math.isfinite(self.log_density)
        gain = math.inf if first else after - self.log_density - self._gain
        taken = math.log(self._rng.random() or 1e-300) < gain
        if taken:
            self.coefficients, self.log_density = self._proposal, after
        # A chain that has not yet been where the model can be run goes on, but nothing was accepted.
        return taken and math.isfinite(after)

    def adapt_again(self) -> None:
        """Adapt the step from the start: other scales, another polynomial."""
        self._step = StepSize(self._step.step)

    def settle(self) -> None:
        """End the adaptation."""
        self._step.settle()
        self._adapts = False

    def _density(self, surface: _Surface, a: Floats) -> tuple[float, Floats]:
        """Log density of coefficients with the polynomial, and its gradient."""
        log_density, gradient = surface.log_density(a)
        return log_density + self._prior(a), gradient - np.where(self._normal, a, 0.0)

    def _prior(self, a: Floats) -> float:
        normal = a[self._normal]
        return -0.5 * float(normal @ normal)


def _log_mean(logs: Floats) -> tuple[Floats, Floats]:
    """Logarithm of the mean of exponentials (K, ...) over the first axis, and the part of each in it."""
    highest = logs.max(axis=0)
    parts = np.exp(logs - highest)
    total = parts.sum(axis=0)
    return highest + np.log(total / len(logs)), parts / total
