"""Candidates that begin within the record: an offset, a clock, exchanged columns from some time on.

Every slot of the record is tried as the beginning, as a candidate of its own. What the choice of the time is
worth is therefore within the distribution of the largest evidence (`mascarin.diagnosis.likelihood_ratio`),
and nothing is corrected for it afterwards. With the weighted residuals ``w = C^-1 r`` the scores of all
beginnings are sums from the end of the record; so are their informations, for the inverse of the covariance
is that of the blocks of the days less a matrix of low rank.

References
----------
Hinkley D.V. (1970), Inference about the change-point in a sequence of random variables, Biometrika 57, 1.
https://doi.org/10.1093/biomet/57.1.1
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGaussian, DayGrid
from mascarin.diagnosis.hypotheses import Candidate

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

#: Neither part of the record is shorter than a day, nor than this part of it. [-]
_MIN_PART: Final = 0.04
#: Largest number of beginnings of a clock or of exchanged columns, and of an offset.
_FEW_TIMES: Final = 96
_MOST_TIMES: Final = 2000


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """All candidates: those over the whole record, then those with each beginning.

    Attributes
    ----------
    whole : tuple of Candidate, length W
        Over the whole record.
    grid : DayGrid
        Days and slots.
    days : ndarray, shape (D,)
        Number of each day. [-]

    Examples
    --------
    >>> grid = DayGrid.of(np.arange(240.0), interval=1.0, sensors=1)
    >>> offset = Candidate("data", "offset", ("room",), np.ones((10, 24)), later="step")
    >>> every = Hypotheses((offset,), grid, np.arange(10.0))
    >>> every.count, every.candidate(1).what, every.candidate(1).start
    (194, 'step', 24.0)
    >>> every.scores(np.ones((10, 24, 1)))[[0, 1, 193], 0].tolist()
    [240.0, 216.0, 24.0]
    """

    whole: tuple[Candidate, ...]
    grid: DayGrid
    days: Floats

    @cached_property
    def _hours(self) -> Floats:
        """Beginning of every slot, shape (D * H,). [h]"""
        return (self.days[:, None] * 24.0 + np.arange(self.grid.slots) * self.grid.slot_hours).ravel()

    @cached_property
    def _inside(self) -> Integers:
        """Slots at which something may begin."""
        first, last = self._hours[0], self._hours[-1] + self.grid.slot_hours
        edge = max(24.0, _MIN_PART * (last - first))
        inside = (self._hours >= first + edge) & (self._hours <= last - edge)
        return np.flatnonzero(inside).astype(np.int64)

    @cached_property
    def families(self) -> tuple[tuple[int, Integers], ...]:
        """Candidates that may begin within the record: their number, and the slots."""
        families = []
        for k, candidate in enumerate(self.whole):
            if candidate.later and self._inside.size:
                most = _MOST_TIMES if candidate.what == "offset" else _FEW_TIMES
                stride = math.ceil(self._inside.size / most)
                families.append((k, self._inside[::stride]))
        return tuple(families)

    @cached_property
    def _first(self) -> Integers:
        """Number of the first candidate of each family, and of all."""
        sizes = [len(self.whole), *(slots.size for _, slots in self.families)]
        return np.cumsum(sizes).astype(np.int64)

    @property
    def count(self) -> int:
        """Number of all candidates."""
        return int(self._first[-1])

    def candidate(self, k: int) -> Candidate:
        """Return a candidate; with its signature and beginning, if it begins within the record."""
        if k < len(self.whole):
            return self.whole[k]
        family = int(np.searchsorted(self._first, k, side="right")) - 1
        number, slots = self.families[family]
        slot, candidate = int(slots[k - self._first[family]]), self.whole[number]
        after = np.arange(self._hours.size).reshape(self.grid.days, -1) >= slot
        of_values = np.repeat(after, candidate.signature.shape[1] // self.grid.slots, axis=1)
        assert candidate.later is not None  # noqa: S101 (families have one)
        start = float(self._hours[slot])
        return replace(
            candidate,
            what=candidate.later,
            signature=np.where(of_values, candidate.signature, 0.0),
            start=start,
        )

    def spread(self, values: Sequence[float], times: bool = False) -> Floats:
        """Return values of the candidates over the whole record for all candidates; shape (K,).

        Parameters
        ----------
        values : sequence of float, length W + F
            Of the candidates over the whole record, then of the families; or W values, which families take
            from theirs.
        times : bool
            Whether the number of beginnings is taken from the value of a family, as a logarithm.
        """
        spread_values: list[float] = list(values[: len(self.whole)])
        for f, (number, slots) in enumerate(self.families):
            value = values[len(self.whole) + f] if len(values) > len(self.whole) else values[number]
            spread_values += [value - (math.log(slots.size) if times else 0.0)] * slots.size
        return np.array(spread_values)

    def scores(self, weighted: Floats) -> Floats:
        """Multiply all signatures with weighted residuals (D, H * S, m), shape (K, m). [-]"""
        size = weighted.shape[0] * weighted.shape[1]
        flat = weighted.reshape(size, -1)
        parts = [self._signatures.T @ flat]
        for number, slots in self.families:
            parts.append(_from_end(self._of_slots(number, flat))[slots])
        return np.concatenate(parts)

    def _of_slots(self, number: int, values: Floats) -> Floats:
        """Products of a signature with values (D * H * S, m), summed over the sensors, shape (D * H, m)."""
        signature = self._signatures[:, number].reshape(self._hours.size, -1)
        by_sensor = values.reshape(*signature.shape, -1)
        total = np.zeros((len(signature), values.shape[1]))
        # That of a fault of a sensor is zero for all others.
        for s in np.flatnonzero(signature.any(axis=0)):
            total += signature[:, s, None] * by_sensor[:, s]
        return total

    @cached_property
    def _signatures(self) -> Floats:
        """Signatures over the whole record, shape (D * H * S, W). [unit]"""
        return np.stack([candidate.signature.ravel() for candidate in self.whole], axis=1)

    def information(self, gaussian: DayGaussian) -> Floats:
        """Compute the information of every candidate, shape (K,). [-]

        Parameters
        ----------
        gaussian : DayGaussian
            Distribution of the residuals without a cause.
        """
        present = gaussian.present
        # C^-1 = inverses of the blocks - shared shared', which is how the distribution has it.
        shared = gaussian.weighted_columns @ np.linalg.cholesky(gaussian.covariance)
        inverse = gaussian.inverses_of_days
        shape, flat = present.shape, shared.reshape(present.size, -1)
        signatures = self._signatures.reshape(*shape, -1)
        information = [
            np.einsum("dnk,dnk->k", signatures, inverse @ signatures)
            - np.sum((flat.T @ self._signatures) ** 2, axis=0)
        ]
        for number, slots in self.families:
            signature = self._signatures[:, number]
            across = self._of_slots(number, flat)
            square = np.sum(_from_end(across)[slots] ** 2, axis=1)
            information.append(
                _blocks_from_end(inverse, signature.reshape(shape), self.grid.slots)[slots] - square
            )
        return np.asarray(np.maximum(np.concatenate(information), 0.0))


def _from_end(values: Floats) -> Floats:
    """Sums from each row to the last."""
    sums: Floats = np.cumsum(values[::-1], axis=0)[::-1]
    return sums


def _blocks_from_end(inverse: Floats, signature: Floats, slots: int) -> Floats:
    """Quadratic forms (D * H,) of a signature (D, H * S) from each slot on with blocks (D, H * S, H * S)."""
    days = len(signature)
    both = signature[:, :, None] * inverse * signature[:, None, :]
    of_slot = both.reshape(days, slots, -1, slots, signature.shape[1] // slots).sum(axis=(2, 4))
    sums = np.cumsum(np.cumsum(of_slot[:, ::-1, ::-1], axis=1), axis=2)[:, ::-1, ::-1]
    within = np.einsum("dhh->dh", sums)
    later = np.append(_from_end(within[:, 0])[1:], 0.0)
    return np.asarray(within + later[:, None]).ravel()
