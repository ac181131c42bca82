"""Gaussian errors that are independent from day to day, beside effects that all days share.

A series is averaged over slots of the day (usually hours), which gives one block of ``H * S`` values for each
day: H slots of S sensors. The covariance of all values is

    Omega = blockdiag(B_1 .. B_D) + U U'

with one block for each day, and columns U of effects with a standard normal coefficient each: parameters
times the standard deviation of their prior, offsets of sensors, errors that repeat every day. Its inverse
follows from that of the blocks (Woodbury), so that the work grows with the number of days, not with its cube.

References
----------
Hager W.W. (1989), Updating the inverse of a matrix, SIAM Review 31, 221. https://doi.org/10.1137/1031049
Sundararajan S., Keerthi S.S. (2001), Neural Computation 13, 1103 (density of what is left out, from the
inverse of the covariance). https://doi.org/10.1162/08997660151134343
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.linear_algebra import inverted

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Length of a slot that is tried, the shortest first. [h]
_SLOTS: Final = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0)
#: Largest size of a block. With more days blocks are smaller, so that the work stays the same.
_MAX_DAY_SIZE: Final = 144
_WORK: Final = 4e7


@dataclass(frozen=True, eq=False)
class DayGrid:
    """Days and slots of the day of regular samples.

    Attributes
    ----------
    day, slot : ndarray of int, shape (T,)
        Of each sample, from 0. [-]
    days, slots : int
        Number of days D and of slots of a day H. [-]
    slot_hours : float
        Length of a slot. [h]

    Examples
    --------
    >>> grid = DayGrid.of(np.arange(0.0, 48.0, 0.5), interval=0.5, sensors=1)
    >>> grid.days, grid.slots
    (2, 24)
    """

    day: NDArray[np.int64]
    slot: NDArray[np.int64]
    days: int
    slots: int
    slot_hours: float

    @staticmethod
    def of(hours: Floats, *, interval: float, sensors: int) -> DayGrid:
        """Divide samples into days and slots.

        Parameters
        ----------
        hours : ndarray, shape (T,)
            Local time from any midnight. [h]
        interval : float
            Time between samples. [h]
        sensors : int
            Number of sensors; with many, the slots are longer. [-]

        Returns
        -------
        DayGrid
        """
        number = np.floor(hours / 24.0 + 1e-9).astype(np.int64)
        names, day = np.unique(number, return_inverse=True)
        long_enough = [length for length in _SLOTS if length >= interval - 1e-9] or [min(interval, 24.0)]
        most = min(_MAX_DAY_SIZE, (_WORK / names.size) ** (1.0 / 3.0))
        small = [length for length in long_enough if 24.0 / length * sensors <= most]
        length = (small or long_enough[-1:])[0]
        slots = math.ceil(24.0 / length - 1e-9)
        of_day = hours - 24.0 * number
        slot = np.clip(np.floor(of_day / length + 1e-9), 0, slots - 1).astype(np.int64)
        return DayGrid(day.astype(np.int64), slot, int(names.size), slots, length)

    def means(self, values: Floats, mask: Flags) -> tuple[Floats, NDArray[np.int64]]:
        """Average over the samples of each slot that are there.

        Parameters
        ----------
        values : ndarray, shape (T, S) or (T, S, Q)
            Any finite number where the mask is False. [unit]
        mask : ndarray of bool, shape (T, S)
            Samples that are there.

        Returns
        -------
        ndarray, shape (D, H * S) or (D, H * S, Q)
            Means, 0 in slots without a sample. [unit]
        ndarray of int, shape (D, H * S)
            Number of samples. [-]
        """
        sensors = mask.shape[1]
        wide = mask.reshape(*mask.shape, *(1,) * (values.ndim - 2))
        count, total = self._total(mask.astype(np.int64)), self._total(np.where(wide, values, 0.0))
        divisor = np.maximum(count, 1).reshape(*count.shape, *(1,) * (values.ndim - 2))
        size = self.slots * sensors
        mean = (total / divisor).reshape(self.days, size, *values.shape[2:])
        return mean, count.reshape(self.days, size)

    def _total(self, values: NDArray[Any]) -> NDArray[Any]:
        """Sum samples (T, ...) over the slots, shape (D, H, ...)."""
        number = self.day * self.slots + self.slot
        order = np.argsort(number, kind="stable")
        first = np.flatnonzero(np.diff(number[order], prepend=-1))
        total = np.zeros((self.days * self.slots, *values.shape[1:]), dtype=values.dtype)
        if first.size:
            total[number[order[first]]] = np.add.reduceat(values[order], first, axis=0)
        return total.reshape(self.days, self.slots, *values.shape[1:])

    def within(self, values: Floats, mask: Flags) -> Floats:
        """Return the mean square of the distances of samples (T, S) from the means of their slots, (S,)."""
        mean, _ = self.means(values, mask)
        sensors = mask.shape[1]
        deviation = values - mean.reshape(self.days, self.slots, sensors)[self.day, self.slot]
        square = np.where(mask, deviation**2, 0.0).sum(axis=0)
        return np.asarray(square / np.maximum(mask.sum(axis=0), 1))


Days = slice | NDArray[np.int64]


@lru_cache(maxsize=16)
def _different(present: bytes, days: int) -> tuple[Flags, tuple[Days, ...]]:
    """Different rows of what is there (D, n), and the days that have each; asked for in each iteration."""
    patterns, which = np.unique(
        np.frombuffer(present, dtype=np.bool_).reshape(days, -1), axis=0, return_inverse=True
    )
    if len(patterns) == 1:
        return patterns, (slice(None),)
    return patterns, tuple(np.flatnonzero(which.reshape(-1) == k) for k in range(len(patterns)))


@dataclass(frozen=True, eq=False)
class DayGaussian:
    """A normal distribution of values by day, with effects that the days share.

    Attributes
    ----------
    blocks : ndarray, shape (D, n, n)
        Covariance within each day, without the shared effects. [unit^2]
    columns : ndarray, shape (D, n, q)
        Shared effects for a coefficient of one standard deviation. [unit]
    present : ndarray of bool, shape (D, n)
        Values that are there; the others count as if they did not exist.
    elsewhere : ndarray, shape (q, q), optional
        Precision of the coefficients from the values of other experiments, see `Experiments`. [-]
    changing : int, optional
        Number of the first columns that may differ between days; all columns when absent. [-]

    Examples
    --------
    A bias of 1 that all days share, and errors of 1 of each value:

    >>> found = DayGaussian(np.ones((2, 1, 1)), np.ones((2, 1, 1)), np.ones((2, 1), dtype=bool))
    >>> round(found.log_density(np.zeros((2, 1))), 3)  # -log(3) / 2 - log(2 pi)
    -2.387
    """

    blocks: Floats
    columns: Floats
    present: Flags
    elsewhere: Floats | None = None
    changing: int | None = None

    @cached_property
    def _alike(self) -> tuple[Floats, Flags, tuple[Days, ...]]:
        """Different blocks, with ones on the diagonal where nothing is there, and the days that have each.

        Most days have the same block and the same values, so that one inverse serves them all.
        """
        if self.blocks.strides[0] == 0:
            patterns, groups = _different(self.present.tobytes(), len(self.present))
            blocks = np.broadcast_to(self.blocks[0], (len(patterns), *self.blocks.shape[1:]))
        else:
            patterns, blocks = self.present, self.blocks
            groups = tuple(slice(k, k + 1) for k in range(len(patterns)))
        if patterns.all():
            return blocks, patterns, groups
        both = patterns[:, :, None] & patterns[:, None, :]
        eye = np.eye(blocks.shape[1])
        return np.where(both, blocks, np.where(patterns[:, :, None], 0.0, eye)), patterns, groups

    @cached_property
    def _inverses(self) -> Floats:
        """Inverses of the different blocks, zero where nothing is there, shape (k, n, n)."""
        blocks, patterns, _ = self._alike
        inverses = inverted(blocks)
        return inverses if patterns.all() else inverses * (patterns[:, :, None] & patterns[:, None, :])

    def _weighted(self, values: Floats, changing: int | None = None) -> Floats:
        """Multiply values (D, n, k) with the inverses of the blocks. [1/unit^2]

        `changing`: number of the first columns that differ between days; all when absent.
        """
        weighted, first = np.empty(values.shape), values.shape[2] if changing is None else changing
        for inverse, days in zip(self._inverses, self._alike[2], strict=True):
            part = values[days]
            weighted[days, :, :first] = inverse @ part[:, :, :first]
            if first < values.shape[2]:
                weighted[days, :, first:] = inverse @ part[0, :, first:]
        return weighted

    @cached_property
    def _added(self) -> tuple[Floats, Floats]:
        """``B^-1 U``, and ``U' B^-1 U``: what these values add to the precision of the coefficients."""
        present = self.present[:, :, None]
        used = self.columns if present.all() else np.where(present, self.columns, 0.0)
        weighted = self._weighted(used, self.changing)
        return weighted, summed(used, weighted)

    @cached_property
    def _shared(self) -> tuple[Floats, Floats]:
        """``B^-1 U``, and ``I + U' B^-1 U``: the precision of the coefficients after the data."""
        weighted, added = self._added
        precision = np.eye(len(added)) + added
        if self.elsewhere is not None:
            precision = precision + self.elsewhere
        return weighted, 0.5 * (precision + precision.T)

    def with_elsewhere(self, elsewhere: Floats) -> DayGaussian:
        """The same distribution with the precision (q, q) that other experiments add. [-]"""
        other = replace(self, elsewhere=elsewhere)
        # Nothing of these depends on the other experiments.
        other.__dict__.update(
            {name: self.__dict__[name] for name in ("_alike", "_inverses", "_added") if name in self.__dict__}
        )
        return other

    @property
    def weighted_columns(self) -> Floats:
        """Columns times the inverses of the blocks, zero where nothing is there, shape (D, n, q). [1/unit]"""
        return self._added[0]

    @property
    def information(self) -> Floats:
        """What these values add to the precision of the coefficients, shape (q, q). [-]"""
        return self._added[1]

    def projected(self, values: Floats) -> Floats:
        """Multiply values (D, n) with ``U' B^-1``, shape (q,): what they say of the coefficients. [-]"""
        return np.asarray(np.einsum("dnq,dn->q", self._added[0], values))

    @cached_property
    def own_log_determinant(self) -> float:
        """Logarithm of the determinant of the blocks alone. [-]"""
        blocks, _, groups = self._alike
        values = np.linalg.slogdet(blocks)[1]
        return float(sum(len(self.present[days]) * value for days, value in zip(groups, values, strict=True)))

    @cached_property
    def covariance(self) -> Floats:
        """Covariance of the coefficients after the data, shape (q, q). [-]"""
        inverse = inverted(self._shared[1][None])[0]
        return np.asarray(0.5 * (inverse + inverse.T))

    @property
    def precision(self) -> Floats:
        """Inverse of `covariance`, shape (q, q). [-]"""
        return self._shared[1]

    def coefficients(self, values: Floats) -> Floats:
        """Return the mean of the coefficients given values (D, n), shape (q,). [-]"""
        return np.asarray(self.covariance @ self.projected(values))

    def solve(self, values: Floats, beside: Floats | None = None) -> Floats:
        """Multiply values (D, n) or (D, n, k) with the inverse of the covariance. [1/unit]

        Values of other experiments are zero, unless `beside` (q,) is what they say of the coefficients.
        """
        wide = values if values.ndim == 3 else values[:, :, None]
        weighted = self._shared[0]
        inner = summed(weighted, wide)
        if beside is not None:
            inner = inner + beside[:, None]
        solution = self._weighted(wide) - weighted @ (self.covariance @ inner)
        return np.asarray(solution if values.ndim == 3 else solution[:, :, 0])

    def quadratic(self, values: Floats, *, constant: bool = False) -> Floats:
        """Compute ``V' Omega^-1 V`` of values (D, n, k), zero elsewhere; `constant`: those of all days."""
        inner, weighted = summed(self._shared[0], values), self._weighted(values, 0 if constant else None)
        return np.asarray(summed(values, weighted) - inner.T @ self.covariance @ inner)

    @property
    def inverses_of_days(self) -> Floats:
        """Inverses of the blocks alone, zero where nothing is there, shape (D, n, n). [1/unit^2]"""
        inverses = np.empty(self.blocks.shape)
        for inverse, days in zip(self._inverses, self._alike[2], strict=True):
            inverses[days] = inverse
        return inverses

    @cached_property
    def inverse_blocks(self) -> Floats:
        """Blocks of the days of the inverse of the whole covariance, shape (D, n, n). [1/unit^2]"""
        weighted = self._shared[0]
        return np.asarray(self.inverses_of_days - (weighted @ self.covariance) @ np.swapaxes(weighted, 1, 2))

    @cached_property
    def sum_of_inverse_blocks(self) -> Floats:
        """Sum of `inverse_blocks` over the days, shape (n, n). [1/unit^2]"""
        size = self.present.shape[1]
        total = np.zeros((size, size))
        for inverse, days in zip(self._inverses, self._alike[2], strict=True):
            total += len(self.present[days]) * inverse
        explained = self._shared[0] @ np.linalg.cholesky(self.covariance)
        by_value = np.swapaxes(explained, 0, 1).reshape(size, -1)
        return np.asarray(total - by_value @ by_value.T)

    def log_density(self, values: Floats) -> float:
        """Return the logarithm of the density of values (D, n)."""
        logdet = self.own_log_determinant + float(np.linalg.slogdet(self._shared[1])[1])
        square = float(np.sum(values * self.solve(values)))
        return -0.5 * (square + logdet + int(self.present.sum()) * math.log(2.0 * math.pi))

    def left_out(self, values: Floats, beside: Floats | None = None) -> Floats:
        """Return the log density of each day given all other days, shape (D,), from values (D, n)."""
        return self._of_days_left_out(values, beside)[0]

    def whitened(self, values: Floats, beside: Floats | None = None) -> Floats:
        """Return what each day differs from its prediction by all other days, from values (D, n).

        Returns
        -------
        ndarray, shape (D, n)
            Independent and of variance 1 if the distribution is right; NaN where nothing is there. [-]
        """
        return self._of_days_left_out(values, beside)[1]

    def days_left_out(
        self, values: Floats, sensors: int, beside: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """Return how far each day is from its prediction by all others, and the standard deviation of that.

        Returns
        -------
        tuple of ndarray, shape (D, n / sensors, sensors)
            NaN where nothing is there. [unit]
        """
        weighted = self.solve(values, beside)
        away, spread = np.full(values.shape, np.nan), np.full(values.shape, np.nan)
        for d, present in enumerate(self.present):
            rows = np.flatnonzero(present)
            covariance = inverted(self.inverse_blocks[d][np.ix_(rows, rows)][None])[0]
            away[d, rows], spread[d, rows] = covariance @ weighted[d, rows], np.sqrt(np.diag(covariance))
        shape = (len(values), -1, sensors)
        return away.reshape(shape), spread.reshape(shape)

    def _of_days_left_out(self, values: Floats, beside: Floats | None) -> tuple[Floats, Floats]:
        weighted, density = self.solve(values, beside), np.zeros(len(values))
        whitened = np.full(values.shape, np.nan)
        for d, present in enumerate(self.present):
            rows = np.flatnonzero(present)
            root = np.linalg.cholesky(self.inverse_blocks[d][np.ix_(rows, rows)])
            white = np.linalg.solve(root, weighted[d, rows])
            logdet = 2.0 * float(np.log(np.diag(root)).sum())
            density[d] = -0.5 * (white @ white - logdet + rows.size * math.log(2.0 * math.pi))
            whitened[d, rows] = white
        return density, whitened


@dataclass(frozen=True, eq=False)
class Experiments:
    """Normal distributions of the values of several experiments, whose effects share their coefficients.

    Parameters
    ----------
    alone : sequence of DayGaussian
        Each with the columns of all coefficients.

    Attributes
    ----------
    parts : tuple of DayGaussian
        Each beside the other ones.

    Examples
    --------
    Two records of a bias of 1 that both share are as one with the days of both:

    >>> day = DayGaussian(np.ones((1, 1, 1)), np.ones((1, 1, 1)), np.ones((1, 1), dtype=bool))
    >>> round(Experiments([day, day]).log_density([np.zeros((1, 1))] * 2), 3)
    -2.387
    """

    alone: Sequence[DayGaussian]
    parts: tuple[DayGaussian, ...] = field(init=False)

    def __post_init__(self) -> None:
        parts = tuple(self.alone)
        if len(parts) > 1:
            total = np.sum([part.information for part in parts], axis=0)
            parts = tuple(part.with_elsewhere(total - part.information) for part in parts)
        object.__setattr__(self, "parts", parts)

    @property
    def covariance(self) -> Floats:
        """Covariance of the coefficients after all data, shape (q, q). [-]"""
        return self.parts[0].covariance

    @property
    def precision(self) -> Floats:
        """Inverse of `covariance`, shape (q, q). [-]"""
        return self.parts[0].precision

    def beside(self, values: Sequence[Floats]) -> list[Floats | None]:
        """What the values of all other experiments say of the coefficients, for each; None if it is alone."""
        if len(self.parts) == 1:
            return [None]
        said = [
            part.projected(values_of_part) for part, values_of_part in zip(self.parts, values, strict=True)
        ]
        return [np.sum([*said[:k], *said[k + 1 :]], axis=0) for k in range(len(said))]

    def coefficients(self, values: Sequence[Floats]) -> Floats:
        """Return the mean of the coefficients given the values of all experiments, shape (q,). [-]"""
        said = [
            part.projected(values_of_part) for part, values_of_part in zip(self.parts, values, strict=True)
        ]
        return np.asarray(self.covariance @ np.sum(said, axis=0))

    def solve(self, values: Sequence[Floats]) -> list[Floats]:
        """Multiply values with the inverse of the covariance. [1/unit]"""
        each = zip(self.parts, values, self.beside(values), strict=True)
        return [part.solve(values_of_part, beside) for part, values_of_part, beside in each]

    def log_density(self, values: Sequence[Floats]) -> float:
        """Return the logarithm of the density of the values of all experiments."""
        logdet = sum(part.own_log_determinant for part in self.parts)
        logdet += float(np.linalg.slogdet(self.precision)[1])
        square = sum(
            float(np.sum(values_of_part * solved))
            for values_of_part, solved in zip(values, self.solve(values), strict=True)
        )
        count = sum(int(part.present.sum()) for part in self.parts)
        return -0.5 * (square + logdet + count * math.log(2.0 * math.pi))


def summed(first: Floats, second: Floats) -> Floats:
    """Sum of the products ``A_d' B_d`` over days.

    Parameters
    ----------
    first, second : ndarray, shape (D, n, j) and (D, n, k)
        The matrices A and B.

    Returns
    -------
    ndarray, shape (j, k)

    Examples
    --------
    >>> summed(np.ones((2, 3, 1)), np.full((2, 3, 1), 2.0))
    array([[12.]])
    """
    flat = first.reshape(-1, first.shape[2])
    return np.asarray(flat.T @ second.reshape(-1, second.shape[2]))
