"""Designs of the spectral method: frequencies and phases, drawn at random in every replicate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.base.factors import Factor, Floats, check_factors, grouped, unit_factors

Integers = NDArray[np.int64]

MIN_SPREAD: Final = 32
"""With few parameters frequencies are drawn from 1 to this number, so that lines are far apart. [-]"""

_MAX_CANDIDATES: Final = 16
_SPACED_UP_TO: Final = 40  # groups; above, every choice of frequencies is crowded


@dataclass(frozen=True, eq=False)
class Design:
    """The runs of a spectral analysis.

    Attributes
    ----------
    factors : tuple of Factor, length P
        What varies.
    groups : tuple of str, length G
        Groups of factors that are analyzed together; a factor without a group is one by its path.
    group_of : ndarray of int, shape (P,)
        Group of each factor.
    order : int
        Number M of harmonics that are attributed to a parameter. [-]
    runs : int
        Runs N per replicate. [-]
    frequencies : ndarray of int, shape (R, G)
        Frequency of each group in each replicate. [1/circle]
    phases : ndarray, shape (R, P)
        Phase of each factor in each replicate. [rad]
    seed : int
        Seed of the random numbers.
    """

    factors: tuple[Factor, ...]
    groups: tuple[str, ...]
    group_of: Integers
    order: int
    runs: int
    frequencies: Integers
    phases: Floats
    seed: int

    @property
    def method(self) -> str:
        """Name of the method."""
        return "spectral"

    @property
    def replicates(self) -> int:
        """Number of replicates. [-]"""
        return int(self.frequencies.shape[0])

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the factors, the columns of the samples."""
        return tuple(factor.path for factor in self.factors)

    def __len__(self) -> int:
        """Number of runs in all replicates. [-]"""
        return self.replicates * self.runs

    def samples(self, replicate: int) -> Floats:
        """Compute the parameter values of one replicate.

        Returns
        -------
        ndarray, shape (N, P)
            [unit of each parameter]
        """
        s = 2.0 * np.pi * np.arange(self.runs) / self.runs
        w = self.frequencies[replicate][self.group_of]
        columns = [
            factor.curve(w[i] * s + self.phases[replicate, i]) for i, factor in enumerate(self.factors)
        ]
        return np.column_stack(columns)

    def all_samples(self) -> Floats:
        """Compute the parameter values of all runs, replicate after replicate.

        Returns
        -------
        ndarray, shape (R * N, P)
            [unit of each parameter]
        """
        return np.concatenate([self.samples(r) for r in range(self.replicates)])

    def members(self, group: int) -> Integers:
        """Return the positions of the factors of one group."""
        return np.flatnonzero(self.group_of == group)


def design(
    factors: int | Sequence[Factor],
    *,
    replicates: int = 8,
    order: int | None = None,
    runs: int | None = None,
    frequencies: Sequence[int] | None = None,
    seed: int = 0,
) -> Design:
    """Make a replicated design with random frequencies and phases.

    Parameters
    ----------
    factors : int or sequence of Factor
        What varies; a number makes that many parameters on [0, 1].
    replicates : int
        Number of independent repetitions, at least 3; the intervals come from their spread. [-]
    order : int, optional
        Number M of harmonics that are attributed to a parameter: 4 up to 50 parameters (or groups), 2
        above. A parameter that acts only through its square needs 2, one that acts through its fourth
        power 4. [-]
    runs : int, optional
        Runs per replicate. Default: as many as the frequencies need, ``2 M w_max + 1``. [-]
    frequencies : sequence of int, optional
        The frequencies to assign, one per parameter or group. Default: drawn from 1 up to the largest
        that `runs` allows (the number of parameters, or 32 for few parameters).
    seed : int
        Seed of the random numbers; the same seed gives the same design.

    Returns
    -------
    Design
        The runs.

    Raises
    ------
    InputError
        Fewer than 3 replicates, too few runs for the frequencies, or frequencies that are not distinct
        positive integers.

    Examples
    --------
    >>> plan = design(3, replicates=4)
    >>> plan.runs, len(plan), plan.paths
    (257, 1028, ('x1', 'x2', 'x3'))
    """
    chosen = unit_factors(factors) if isinstance(factors, int) else factors
    checked = check_factors(chosen)
    groups, group_of = grouped(checked)
    if replicates < 3:
        msg = f"replicates: found {replicates}, expected at least 3: intervals come from their spread"
        raise InputError(msg)
    m = order if order is not None else (4 if len(groups) <= 50 else 2)
    if m < 1:
        msg = f"order: found {m}, expected at least 1 harmonic"
        raise InputError(msg)
    pool = _pool(len(groups), len(groups) < len(checked), m, runs, frequencies)
    n = runs if runs is not None else 2 * m * int(pool.max()) + 1
    rng = np.random.default_rng(seed)
    assigned = np.stack([_assigned(pool, len(groups), m, rng) for _ in range(replicates)])
    phases = _phases(group_of, replicates, rng)
    return Design(checked, groups, group_of, m, n, assigned, phases, seed)


def _pool(
    count: int, grouped: bool, order: int, runs: int | None, frequencies: Sequence[int] | None
) -> Integers:
    """The frequencies that can be assigned."""
    if frequencies is not None:
        pool = np.asarray(frequencies, dtype=np.int64)
        if pool.ndim != 1 or pool.size < count or np.unique(pool).size != pool.size or pool.min() < 1:
            msg = (
                f"frequencies: expected {count} or more distinct positive integers, found {list(frequencies)}"
            )
            raise InputError(msg)
    else:
        spread = max(count, MIN_SPREAD)
        if grouped:
            # The noise of a group is estimated from lines that belong to no parameter: some must remain.
            spread = max(spread, (5 * count + 3) // 4)
        if runs is not None:
            spread = max(count, (runs - 1) // (2 * order))
        pool = np.arange(1, spread + 1)
    largest = int(pool.max())
    if runs is not None and runs < 2 * order * largest + 1:
        msg = (
            f"runs: {runs} per replicate are too few for {count} parameters with {order} harmonics: the "
            f"largest frequency {largest} needs {2 * order * largest + 1} (2 M w_max + 1); give more runs, a "
            f"lower order, or group parameters"
        )
        raise InputError(msg)
    return pool


def _assigned(pool: Integers, count: int, order: int, rng: np.random.Generator) -> Integers:
    """A random frequency for each group; where there is a choice, the least crowded of several draws."""
    if pool.size == count or count > _SPACED_UP_TO:
        return rng.permutation(pool)[:count]
    candidates = [rng.permutation(pool)[:count] for _ in range(_MAX_CANDIDATES)]
    crowds = [_crowding(w, order) for w in candidates]
    return candidates[int(np.argmin(crowds))]


def _crowding(w: Integers, order: int) -> float:
    """Number of harmonics and low-order interactions that fall on the lines of parameters. [-]"""
    harmonics = np.outer(np.arange(1, order + 1), w).ravel()
    lines = np.unique(harmonics)
    crowd = 3.0 * (harmonics.size - lines.size)
    i, j = np.triu_indices(w.size, 1)
    for a in (1, 2):
        for b in (1, 2):
            both = np.concatenate([a * w[i] + b * w[j], np.abs(a * w[i] - b * w[j])])
            crowd += float(np.isin(both, lines).sum()) / (a * b)
    return crowd


def _phases(group_of: Integers, replicates: int, rng: np.random.Generator) -> Floats:
    """Random phases; those of a group are spaced so that their cross terms cancel over the replicates."""
    phases = rng.uniform(0.0, 2.0 * np.pi, (replicates, group_of.size))
    steps = 2.0 * np.pi * np.arange(replicates) / replicates
    for g in np.unique(group_of):
        members = rng.permutation(np.flatnonzero(group_of == g))
        for k, i in enumerate(members[1:], start=1):
            phases[:, i] = phases[:, members[0]] + rng.uniform(0.0, 2.0 * np.pi) + k * steps
    return np.mod(phases, 2.0 * np.pi)
