"""Steps of a period, and the times inside each step at which the engine takes its values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import tzinfo
from typing import Final

import numpy as np

from mascarin._io import memory
from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array, Halvings
from mascarin.tables.timezones import seconds_at

#: Most steps of a run: a year in steps of 1.6 s. More are a mistake in the unit, and take hours.
MOST_STEPS: Final = 20_000_000
#: Memory for a stage of a step while the forcing is made: some twenty channels and as many intermediate
#: results of eight bytes (measured: 480). [B]
BYTES: Final = 500

_GAMMA: Final = 1.0 - 0.5 * float(np.sqrt(2.0))

STAGES: Final[dict[str, tuple[tuple[float, ...], tuple[float, ...]]]] = {
    "sdirk2": ((_GAMMA, 1.0), (1.0 - _GAMMA, _GAMMA)),
    "linearly-implicit": ((_GAMMA, 1.0), (1.0 - _GAMMA, _GAMMA)),
    "backward-euler": ((1.0,), (1.0,)),
    "apparent-capacity": ((1.0,), (1.0,)),
}
"""Stage times as parts of a step, and stage weights, of each scheme."""


@dataclass(frozen=True)
class PartOfPeriod:
    """What steps that are a part of a period know of the whole.

    Attributes
    ----------
    begin, end : float
        Start of the first and end of the last step of the period, from its start. [s]
    sums : dict
        What is added up from the start of the period on, where the part before ended: whoever adds it up
        knows the key. The parts of a period share it, and are taken in their order.
    """

    begin: float
    end: float
    sums: dict[tuple[object, ...], tuple[int, Array]] = field(default_factory=dict)


@dataclass(frozen=True)
class Steps:
    """Steps over a period, of equal length or parts of it.

    Times count from the start of the period, so that sums over a year keep their precision.

    Attributes
    ----------
    first, last : float
        Start and end of the period, seconds since 1970-01-01 UTC. [s]
    edges : ndarray, shape (steps + 1,)
        Ends of the steps, from the start of the period. [s]
    stage : ndarray, shape (steps, stages)
        Times of the stages, from the start of the period. [s]
    weights : tuple of float
        Weights of the stages in the mean over a step. [-]
    part : PartOfPeriod or None
        The period, where these are not all of its steps: values have the same bits as those of all steps.
    """

    first: float
    last: float
    edges: Array
    stage: Array
    weights: tuple[float, ...]
    part: PartOfPeriod | None = None

    @property
    def begin(self) -> float:
        """Start of the first step of the period, from its start. [s]"""
        return float(self.edges[0]) if self.part is None else self.part.begin

    @property
    def opens(self) -> bool:
        """Whether the period begins with these steps."""
        return bool(self.edges[0] == self.begin)

    @classmethod
    def parts(
        cls, zone: tzinfo, start: object, end: object, step_seconds: float, scheme: str, size: int
    ) -> Iterator[Steps]:
        """Steps from start to end, a part after the other; parameters and errors of `over`.

        Parameters
        ----------
        size : int
            Most steps of a part.

        Yields
        ------
        Steps
            A part. The one before has to be used, or not, when the next one is.
        """
        nodes, weights = _stages(scheme)
        first, last = seconds_at(start, zone, "start"), seconds_at(end, zone, "end")
        count = _count(first, last, step_seconds, len(nodes), size)
        period = PartOfPeriod(0.0, step_seconds * count)
        for row in range(0, count, size):
            edges = step_seconds * np.arange(row, min(row + size, count) + 1)
            stage = edges[:-1, None] + step_seconds * np.array(nodes)
            yield cls(first, last, edges, stage, weights, period)

    @classmethod
    def over(
        cls,
        zone: tzinfo,
        start: object,
        end: object,
        step_seconds: float,
        scheme: str,
        halvings: Halvings | None = None,
    ) -> Steps:
        """Steps from start to end.

        Parameters
        ----------
        zone : datetime.tzinfo
            Zone of stamps without an offset.
        start, end : str, datetime or pandas.Timestamp
            Period; a whole number of steps.
        step_seconds : float
            Step. [s]
        scheme : str
            A key of `STAGES`.
        halvings : ndarray of uint8, shape (steps,), optional
            How often the step is halved for each step that is taken. Default: never.

        Raises
        ------
        InputError
            The scheme is unknown, or the period is not a whole number of steps.
        ValueError
            Halved steps that do not fill the period.
        """
        nodes, weights = _stages(scheme)
        first = seconds_at(start, zone, "start")
        last = seconds_at(end, zone, "end")
        count = _count(first, last, step_seconds, len(nodes))
        if halvings is None:
            edges = step_seconds * np.arange(count + 1)
            return cls(first, last, edges, edges[:-1, None] + step_seconds * np.array(nodes), weights)
        lengths = step_seconds * np.exp2(-np.asarray(halvings, dtype=np.float64))
        edges = np.concatenate([[0.0], np.cumsum(lengths)])
        if abs(edges[-1] - step_seconds * count) > 1e-6:
            raise ValueError(f"steps over {edges[-1]} s, expected {step_seconds * count} s")
        return cls(first, last, edges, edges[:-1, None] + lengths[:, None] * np.array(nodes), weights)


def _stages(scheme: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if scheme not in STAGES:
        raise InputError(f"scheme: no scheme {scheme!r}. {did_you_mean(scheme, STAGES)}")
    return STAGES[scheme]


def _count(first: float, last: float, step: float, stages: int, most: int = MOST_STEPS) -> int:
    """Number of steps, of which so many are made at a time."""
    if not step > 0.0:
        raise InputError(f"step: found {step!r} s, expected a positive length.")
    ratio = (last - first) / step
    least = (last - first) / MOST_STEPS
    if ratio > MOST_STEPS:
        raise InputError(
            f"step: {last - first:.6g} s in steps of {step:.6g} s are {ratio:.3g} steps, which would take "
            f"{memory.amount(ratio * stages * BYTES)} of memory; expected at most {MOST_STEPS:.0e} steps. "
            f"Take a step of {least:.3g} s or more, or a shorter period"
        )
    count = round(ratio)
    memory.require(
        min(count, most) * stages * BYTES,
        f"step: {count} steps of {step:.6g} s",
        "take a longer step or a shorter period",
    )
    if count < 1 or abs(count * step - (last - first)) > 1e-6:
        raise InputError(
            f"period: {last - first:.12g} s from start to end is not a whole number of steps of {step:g} s, "
            "at least one; move the end or change the step."
        )
    return count
