"""The No-U-Turn sampler: Hamiltonian Monte Carlo whose paths end where they turn back.

A state moves along the gradient of the log density; the path doubles forward or backward until its ends
approach each other, and one of its points is drawn, each with the same probability. With this last rule a
move is reversible, so that it can propose states for another density (`delayed acceptance`). The step is that
of dual averaging.

References
----------
Hoffman M.D., Gelman A. (2014), The No-U-Turn sampler, J. Mach. Learn. Res. 15, 1593 (algorithms 3 and 6).
https://jmlr.org/papers/v15/hoffman14a.html
Christen J.A., Fox C. (2005), Markov chain Monte Carlo using an approximation, J. Comput. Graph. Stat. 14,
795. https://doi.org/10.1198/106186005X76983
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Density = Callable[[Floats], tuple[float, Floats]]
"""From a state (q,) to the log density up to a constant and its gradient (q,)."""

#: Loss of energy from which a path is given up.
_LARGEST_LOSS: Final = 1000.0
#: Doublings of a path at most.
_DEEPEST: Final = 8
#: Parameters of dual averaging, as in the reference.
_GAMMA, _FIRST, _KAPPA = 0.05, 10.0, 0.75


@dataclass
class StepSize:
    """Step of the paths, adapted until its mean acceptance is as wanted.

    Attributes
    ----------
    step : float
        Of the next path. [-]
    target : float
        Mean acceptance. [-]
    """

    step: float = 0.5
    target: float = 0.8
    _mean: float = field(default=0.0, repr=False)
    _log_mean: float = field(default=0.0, repr=False)
    _count: int = field(default=0, repr=False)
    _toward: float = field(default=math.log(5.0), repr=False)

    def adapt(self, acceptance: float) -> None:
        """Take the acceptance of a path into account."""
        self._count += 1
        weight = 1.0 / (self._count + _FIRST)
        self._mean = (1.0 - weight) * self._mean + weight * (self.target - acceptance)
        log_step = self._toward - math.sqrt(self._count) / _GAMMA * self._mean
        share = self._count**-_KAPPA
        self._log_mean = share * log_step + (1.0 - share) * self._log_mean
        self.step = math.exp(min(max(log_step, -12.0), 2.0))

    def settle(self) -> None:
        """Take the mean of the steps that were tried."""
        self.step = math.exp(min(max(self._log_mean, -12.0), 2.0))


@dataclass
class _Tree:
    """A piece of a path: its two ends (state, momentum, gradient), a point of it, and how many there are."""

    first: tuple[Floats, Floats, Floats]
    last: tuple[Floats, Floats, Floats]
    point: Floats
    points: int
    goes_on: bool
    acceptance: float
    states: int
    diverged: bool = False


@dataclass(frozen=True, eq=False)
class Move:
    """One move of a chain.

    Attributes
    ----------
    state : ndarray, shape (q,)
        Where it ended.
    acceptance : float
        Mean acceptance along the path, which adapts the step. [-]
    diverged : bool
        Whether the path lost its energy: the step is too long for a narrow place.
    """

    state: Floats
    acceptance: float
    diverged: bool


def moved(density: Density, state: Floats, step: float, rng: np.random.Generator) -> Move:
    """Move a state; the masses are 1, so that all directions should have about the same scale.

    Parameters
    ----------
    density : callable
        Log density and gradient.
    state : ndarray, shape (q,)
        Where the chain is.
    step : float
        Length of a step in time. [-]
    rng : Generator
        Source of random numbers.

    Examples
    --------
    A standard normal distribution:

    >>> rng, x, sample = np.random.default_rng(1), np.zeros(1), []
    >>> for _ in range(2000):
    ...     x = moved(lambda x: (-0.5 * float(x @ x), -x), x, 0.9, rng).state
    ...     sample.append(x[0])
    >>> bool(abs(np.std(sample) - 1.0) < 0.08)
    True
    """
    log_density, gradient = density(state)
    momentum = rng.standard_normal(state.size)
    energy = log_density - 0.5 * float(momentum @ momentum)
    path = _Path(density, step, rng, energy, energy + math.log(rng.random() or 1e-300))
    end = (state, momentum, gradient)
    tree = _Tree(end, end, state, 1, True, 0.0, 0)
    for depth in range(_DEEPEST):
        forward = rng.random() < 0.5
        branch = path.built(tree.last if forward else tree.first, forward, depth)
        if branch.goes_on and rng.random() < branch.points / (tree.points + branch.points):
            tree.point = branch.point
        path.join(tree, branch, forward)
        if not tree.goes_on:
            break
    return Move(tree.point, tree.acceptance / max(tree.states, 1), tree.diverged)


class _Path:
    """Builds the halves of a path."""

    def __init__(
        self, density: Density, step: float, rng: np.random.Generator, energy: float, slice_: float
    ) -> None:
        self._density, self._step, self._rng = density, step, rng
        self._energy, self._slice = energy, slice_

    def built(self, end: tuple[Floats, Floats, Floats], forward: bool, depth: int) -> _Tree:
        """Return 2**depth further states from an end."""
        if depth == 0:
            return self._leaf(end, self._step if forward else -self._step)
        tree = self.built(end, forward, depth - 1)
        if tree.goes_on:
            branch = self.built(tree.last if forward else tree.first, forward, depth - 1)
            if branch.points and self._rng.random() < branch.points / (tree.points + branch.points):
                tree.point = branch.point
            self.join(tree, branch, forward)
        return tree

    def join(self, tree: _Tree, branch: _Tree, forward: bool) -> None:
        """Add a branch to the tree that it grows from."""
        if forward:
            tree.last = branch.last
        else:
            tree.first = branch.first
        away = tree.last[0] - tree.first[0]
        turned = float(away @ tree.first[1]) < 0.0 or float(away @ tree.last[1]) < 0.0
        tree.goes_on = branch.goes_on and not turned
        tree.points += branch.points
        tree.acceptance += branch.acceptance
        tree.states += branch.states
        tree.diverged |= branch.diverged

    def _leaf(self, end: tuple[Floats, Floats, Floats], step: float) -> _Tree:
        """Return the next state (leapfrog)."""
        state, momentum, gradient = end
        momentum = momentum + 0.5 * step * gradient
        state = state + step * momentum
        log_density, gradient = self._density(state)
        momentum = momentum + 0.5 * step * gradient
        energy = log_density - 0.5 * float(momentum @ momentum)
        energy = energy if math.isfinite(energy) else -math.inf
        diverged = energy < self._slice - _LARGEST_LOSS
        acceptance = math.exp(min(energy - self._energy, 0.0))
        reached = (state, momentum, gradient)
        inside = int(energy >= self._slice)
        return _Tree(reached, reached, state, inside, not diverged, acceptance, 1, diverged)
