"""Errors of a model about its measurements: their parts, estimated by marginal likelihood.

What a model misses is described by normal distributions, with one covariance between sensors for each part:

- an error that repeats at the same hour of every day (a smooth function of the hour: a constant and two
  harmonics);
- an error that changes from day to day: one constant for each day, and an error that is correlated over some
  hours within the day;
- an error of each slot of the day that is independent of all others.

Beside them are errors whose size is stated, not estimated: offsets of sensors and the like. The parameters of
the model count as unknown with their prior, so that what they can explain is not taken for an error: the
sizes maximize the density of the data with parameters and offsets integrated out, linearized at the estimates
(type II likelihood). Each covariance has a weak inverse-Wishart prior and an upper limit.

References
----------
Kennedy M.C., O'Hagan A. (2001), J. R. Stat. Soc. B 63, 425. https://doi.org/10.1111/1467-9868.00294
Brynjarsdottir J., O'Hagan A. (2014), Inverse Problems 30, 114007 (what a discrepancy may absorb).
https://doi.org/10.1088/0266-5611/30/11/114007
Zhou H., Hu L., Zhou J., Lange K. (2019), MM algorithms for variance components models, J. Comput. Graph.
Stat. 28, 350. https://doi.org/10.1080/10618600.2018.1529601
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGaussian, DayGrid, Experiments

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]

CORRELATION_HOURS: Final = (1.5, 4.0, 10.0)
"""Correlation times of the error within a day that are compared. [h]"""

#: Part of the variance of the error by hour that is in the constant and in each harmonic, from slow to fast.
_SPECTRUM: Final = (0.5, 0.3, 0.2)
#: Degrees of freedom of the prior of each covariance: worth so many days.
_PRIOR_WEIGHT: Final = 1.0
_MAX_ITERATIONS: Final = 60
_TRIAL_ITERATIONS: Final = 12
_MAX_CHANGE: Final = 1e-3


def hour_basis(hours: Floats) -> Floats:
    """Evaluate the functions of which an error by hour consists.

    Parameters
    ----------
    hours : ndarray, shape (T,)
        Local time. [h]

    Returns
    -------
    ndarray, shape (T, 5)
        A constant and two harmonics of the day; the squares of each row sum up to 1. [-]

    Examples
    --------
    >>> basis = hour_basis(np.array([0.0, 5.0]))
    >>> bool(np.allclose(np.sum(basis**2, axis=1), 1.0))
    True
    """
    angle = np.asarray(hours)[:, None] * np.pi / 12.0
    parts = [np.full((len(angle), 1), np.sqrt(_SPECTRUM[0]))]
    for k, part in enumerate(_SPECTRUM[1:], start=1):
        parts.append(np.sqrt(part) * np.concatenate([np.cos(k * angle), np.sin(k * angle)], axis=1))
    return np.concatenate(parts, axis=1)


@dataclass(frozen=True, eq=False)
class Discrepancy:
    """Sizes of the errors of a model.

    Attributes
    ----------
    hour, day, drift : ndarray, shape (S, S)
        Covariance between sensors of the error that repeats every day, of the constant of a day, and of the
        error that is correlated within a day. [unit of the sensors]
    white : ndarray, shape (S,)
        Variance of the error of a slot that is independent of all others. [unit^2]
    within : ndarray, shape (S,)
        Variance of samples about the mean of their slot. [unit^2]
    correlation_hours : float
        Correlation time of the error within a day. [h]
    alike : float
        Variance of what the constants of all days have in common, over that of a single day about it, see
        `alike_days`. [-]

    Examples
    --------
    >>> one = np.eye(1)
    >>> Discrepancy(0.04 * one, 0.01 * one, 0.01 * one, np.array([0.02]), np.array([0.01]), 4.0).spread
    array([0.3])
    """

    hour: Floats
    day: Floats
    drift: Floats
    white: Floats
    within: Floats
    correlation_hours: float
    alike: float = 0.0

    @property
    def spread(self) -> Floats:
        """Standard deviation of a sample about the model, without parameters and sensors, (S,). [unit]"""
        return np.asarray(np.sqrt(np.diag(self.hour) + self.new_day))

    @property
    def new_day(self) -> Floats:
        """Variance of what differs on each day, for a sample, shape (S,). [unit^2]"""
        day = (1.0 + self.alike) * np.diag(self.day)
        return np.asarray(day + np.diag(self.drift) + self.white + self.within)

    @property
    def independent(self) -> Floats:
        """Variance of what differs from value to value, shape (S,). [unit^2]"""
        return np.asarray(self.white + self.within)

    def block(self, grid: DayGrid) -> Floats:
        """Return the covariance of one day (H * S, H * S), without the error that repeats. [unit^2]"""
        kernel, size = drift_kernel(grid, self.correlation_hours), grid.slots * self.white.size
        of_slots = kernel[:, None, :, None] * self.drift[None, :, None, :] + self.day[None, :, None, :]
        block = of_slots.reshape(size, size)
        block[np.diag_indices(size)] += np.tile(self.white, grid.slots)
        return np.asarray(block)


def alike_days(days: int, persistence: float) -> float:
    """Compute how much of the error of a day consecutive days have in common.

    Weather lasts for some days, and so do errors that depend on it. Consecutive days therefore differ less
    than days of other weeks will. With correlations ``exp(-lag / persistence)``, whose mean over all pairs of
    days is c, the common part has the variance ``c / (1 - c)`` times that of a day about it.

    Parameters
    ----------
    days : int
        Number of consecutive days. [-]
    persistence : float
        Correlation time of the errors of days. [d]

    Returns
    -------
    float
        [-]

    Examples
    --------
    >>> round(alike_days(5, 5.0), 2), alike_days(1, 5.0)
    (2.16, 0.0)
    """
    if days < 2 or persistence <= 0.0:
        return 0.0
    lag = np.arange(1, days)
    mean = float(np.sum((days - lag) * np.exp(-lag / persistence)) / np.sum(days - lag))
    return mean / (1.0 - mean)


def drift_kernel(grid: DayGrid, hours: float) -> Floats:
    """Correlation between the slots of a day, shape (H, H), read-only. [-]"""
    return _kernel(grid.slots, grid.slot_hours, hours)


@lru_cache(maxsize=16)
def _kernel(slots: int, slot_hours: float, hours: float) -> Floats:
    apart = np.abs(np.subtract.outer(np.arange(slots), np.arange(slots))) * slot_hours
    kernel = np.asarray(np.exp(-apart / hours))
    kernel.flags.writeable = False  # asked for in each iteration
    return kernel


@dataclass(frozen=True, eq=False)
class DayData:
    """Means of one identification by day and slot, linearized at some estimates.

    Attributes
    ----------
    grid : DayGrid
        Days and slots.
    error : ndarray, shape (D, H * S)
        Measured minus simulated, with the parameters at the means of their priors. [unit]
    effects : ndarray, shape (D, H * S, q)
        Effects of parameters and sensors, for one standard deviation of their priors. [unit]
    basis : ndarray, shape (D, H * S, m)
        Functions of the error that repeats, at each value. [-]
    present : ndarray of bool, shape (D, H * S)
        Values that are there.
    within : ndarray, shape (S,)
        Variance of samples about the mean of their slot. [unit^2]
    """

    grid: DayGrid
    error: Floats
    effects: Floats
    basis: Floats
    present: Flags
    within: Floats

    @property
    def sensors(self) -> int:
        """Number of sensors S."""
        return self.within.size

    @cached_property
    def functions(self) -> Floats:
        """Columns of the error that repeats for each function and sensor, (D, H * S, m * S). [-]"""
        return self.repeating(np.eye(self.sensors))

    @cached_property
    def regular(self) -> bool:
        """Whether everything is there, and the error that repeats has the same columns on all days."""
        return bool(self.present.all() and (self.basis == self.basis[:1]).all())

    def repeating(self, root: Floats) -> Floats:
        """Columns of the error that repeats, (D, H * S, m * S), from a root of its covariance (S, S)."""
        days, size, functions = self.basis.shape
        rows = np.tile(root, (self.grid.slots, 1))  # sensor of each value, shape (H * S, S)
        wide = self.basis[:, :, :, None] * rows[None, :, None, :]
        return np.asarray(wide.reshape(days, size, functions * self.sensors))

    def gaussian(self, covariances: Discrepancy) -> DayGaussian:
        """Return the distribution of the errors; shared effects: known, repeating, level of all days."""
        shared = [self.effects, self.repeating(root_of(covariances.hour))]
        if covariances.alike:
            rows = np.tile(root_of(covariances.alike * covariances.day), (self.grid.slots, 1))
            shared.append(np.broadcast_to(rows, (self.grid.days, *rows.shape)))
        columns = np.concatenate(shared, axis=2)
        block = covariances.block(self.grid)
        blocks, changing = np.broadcast_to(block, (self.grid.days, *block.shape)), self.effects.shape[2]
        return DayGaussian(blocks, columns, self.present, changing=changing if self.regular else None)


def columns_of(data: Sequence[DayData], covariances: Sequence[Discrepancy]) -> list[Indices]:
    """Positions of the coefficients of each experiment among those of all, each shape (q of it,).

    The known effects are common to all; then come the errors that repeat, experiment by experiment, and the
    levels of all days, where they have one.
    """
    effect_count = data[0].effects.shape[2]
    repeating = [part.basis.shape[2] * part.sensors for part in data]
    levels = [part.sensors if each.alike else 0 for part, each in zip(data, covariances, strict=True)]
    ends = np.cumsum([effect_count, *repeating, *levels])
    count = len(data)
    return [
        np.concatenate(
            [
                np.arange(effect_count),
                np.arange(ends[k], ends[k + 1]),
                np.arange(ends[count + k], ends[count + k + 1]),
            ]
        )
        for k in range(count)
    ]


def together(data: Sequence[DayData], covariances: Sequence[Discrepancy]) -> Experiments:
    """Return the distribution of the errors of experiments that share their known effects.

    Parameters
    ----------
    data : sequence of DayData
        Of each experiment; all have the same known effects, zero where an experiment has none of it.
    covariances : sequence of Discrepancy
        Of each.
    """
    alone = [part.gaussian(each) for part, each in zip(data, covariances, strict=True)]
    if len(alone) == 1:
        return Experiments(alone)
    columns_by_part = columns_of(data, covariances)
    size = 1 + max(int(part_columns.max()) for part_columns in columns_by_part)
    wide = []
    for gaussian, part_columns in zip(alone, columns_by_part, strict=True):
        columns = np.zeros((*gaussian.columns.shape[:2], size))
        columns[:, :, part_columns] = gaussian.columns
        wide.append(replace(gaussian, columns=columns, changing=None))
    return Experiments(wide)


@dataclass(frozen=True, eq=False)
class SizeLimits:
    """What is known of the sizes of the errors of the model of an experiment.

    Attributes
    ----------
    scale : ndarray, shape (S,)
        Standard deviation of each part about which its weak prior is. [unit]
    limit : ndarray, shape (S,)
        Largest standard deviation of each part. [unit]
    least : float or ndarray, shape (S,)
        Smallest standard deviation of the error that is correlated within a day. [unit]
    """

    scale: Floats
    limit: Floats
    least: Floats | float = 0.0


def estimate_discrepancy(
    data: DayData,
    *,
    scale: Floats,
    limit: Floats,
    least: Floats | float = 0.0,
    persistence: float = 0.0,
    first: Discrepancy | None = None,
) -> Discrepancy:
    """Estimate the sizes of the errors by marginal likelihood.

    Parameters
    ----------
    data : DayData
        Errors and known effects.
    scale : ndarray, shape (S,)
        Standard deviation of each part about which its weak prior is. [unit]
    limit : ndarray, shape (S,)
        Largest standard deviation of each part. [unit]
    least : float or ndarray, shape (S,)
        Smallest standard deviation of the error that is correlated within a day. [unit]
    persistence : float
        Correlation time of the errors of days, see `alike_days`. [d]
    first : Discrepancy, optional
        An estimate from nearly the same errors: where to begin, with its correlation time.

    Returns
    -------
    Discrepancy
        That with the largest density over the correlation times `CORRELATION_HOURS`.
    """
    sizes = SizeLimits(scale, limit, least)
    beginning = None if first is None else [first]
    return estimate_together([data], [sizes], persistence=persistence, first=beginning)[0]


def estimate_together(
    data: Sequence[DayData],
    sizes: Sequence[SizeLimits],
    *,
    persistence: float = 0.0,
    first: Sequence[Discrepancy] | None = None,
) -> list[Discrepancy]:
    """Estimate the sizes of the errors of experiments that share their known effects.

    Parameters
    ----------
    data, sizes : sequence of DayData, and of SizeLimits
        Of each experiment.
    persistence : float
        Correlation time of the errors of days, see `alike_days`. [d]
    first : sequence of Discrepancy, optional
        Estimates from nearly the same errors, see `estimate_discrepancy`.

    Returns
    -------
    list of Discrepancy
        Those with the largest density over the correlation times `CORRELATION_HOURS`, one for all.
    """
    if first is not None:
        return _maximized(data, first, sizes, _MAX_ITERATIONS)
    best, density = None, -np.inf
    errors = [part.error for part in data]
    for hours in CORRELATION_HOURS:
        start = [
            Discrepancy(
                np.diag(each.scale**2),
                np.diag(each.scale**2),
                np.diag(each.scale**2),
                each.scale**2,
                part.within,
                hours,
                alike_days(part.grid.days, persistence),
            )
            for part, each in zip(data, sizes, strict=True)
        ]
        candidate = _maximized(data, start, sizes, _TRIAL_ITERATIONS)
        reached = together(data, candidate).log_density(errors)
        if best is None or reached > density:
            best, density = candidate, reached
    assert best is not None  # noqa: S101 (there are correlation times)
    return _maximized(data, best, sizes, _MAX_ITERATIONS)


def _maximized(
    data: Sequence[DayData],
    covariances: Sequence[Discrepancy],
    sizes: Sequence[SizeLimits],
    iterations: int,
) -> list[Discrepancy]:
    """Improve all sizes together, step by step, until none changes."""
    now, errors = list(covariances), [part.error for part in data]
    for _ in range(iterations):
        gaussian = together(data, now)
        weighted = gaussian.solve(errors)
        steps = [
            _improved(data_of_part, part, solved, before, each)
            for data_of_part, part, solved, before, each in zip(
                data, gaussian.parts, weighted, now, sizes, strict=True
            )
        ]
        now = [after for after, _ in steps]
        if max(moved for _, moved in steps) < _MAX_CHANGE:
            break
    return now


def _improved(
    data: DayData, now: DayGaussian, solved: Floats, covariances: Discrepancy, sizes: SizeLimits
) -> tuple[Discrepancy, float]:
    """Better sizes of one experiment, and how far they moved, in scales. [-]"""
    grid, sensors, scale, limit = data.grid, data.sensors, sizes.scale, sizes.limit
    drift = drift_kernel(grid, covariances.correlation_hours)
    kernels = {"day": np.ones_like(drift), "drift": drift}
    prior = _PRIOR_WEIGHT * np.diag(scale**2)
    weighted = solved.reshape(grid.days, grid.slots, sensors)
    inverse = now.sum_of_inverse_blocks.reshape(grid.slots, sensors, grid.slots, sensors)
    improved: dict[str, Any] = {}
    of_hour = (solved.ravel() @ data.functions.reshape(solved.size, -1)).reshape(-1, sensors)
    spread = now.quadratic(data.functions, constant=data.regular)
    for name, kernel in kernels.items():
        square = (np.swapaxes(weighted, 1, 2) @ (kernel @ weighted)).sum(axis=0)
        trace = np.einsum("hsgt,hg->st", inverse, kernel)
        if name == "day" and covariances.alike:
            # The first function of the error by hour is a constant, that of the common level.
            level = covariances.alike / _SPECTRUM[0]
            square = square + level * np.outer(of_hour[0], of_hour[0])
            trace = trace + level * spread[:sensors, :sensors]
        improved[name] = _step(getattr(covariances, name), square, trace, prior, limit)
    improved["drift"] = at_least(improved["drift"], sizes.least)
    count = of_hour.shape[0]
    trace = np.einsum("kskt->st", spread.reshape(count, sensors, count, sensors))
    improved["hour"] = _step(covariances.hour, of_hour.T @ of_hour, trace, prior, limit)
    curvature = np.einsum("hshs->s", inverse) + _PRIOR_WEIGHT / covariances.white
    squares = np.sum(weighted**2, axis=(0, 1)) + _PRIOR_WEIGHT * scale**2 / covariances.white**2
    improved["white"] = np.minimum(covariances.white * np.sqrt(squares / curvature), limit**2)
    moved = max(
        float(
            np.max(np.abs(np.sqrt(_diagonal(value)) - np.sqrt(_diagonal(getattr(covariances, name)))) / scale)
        )
        for name, value in improved.items()
    )
    return replace(covariances, **improved), moved


def _step(covariance: Floats, square: Floats, trace: Floats, prior: Floats, limit: Floats) -> Floats:
    """Improve one covariance: minimize ``tr(C^-1 A) + tr(M C)``, which touches the density from below."""
    inverse = np.linalg.inv(covariance)
    first = covariance @ square @ covariance + prior
    second = trace + _PRIOR_WEIGHT * 0.5 * (inverse + inverse.T)
    root = np.linalg.cholesky(0.5 * (second + second.T))
    value, vector = np.linalg.eigh(root.T @ first @ root)
    middle = (vector * np.sqrt(np.maximum(value, 0.0))) @ vector.T
    back = np.linalg.inv(root)
    improved = back.T @ middle @ back
    improved = 0.5 * (improved + improved.T)
    shrink = np.minimum(1.0, limit / np.sqrt(np.diag(improved)))
    return np.asarray(improved * np.outer(shrink, shrink))


def at_least(covariance: Floats, least: Floats | float) -> Floats:
    """Raise the variances of a covariance (S, S) to the square of `least`, a float or (S,). [unit^2]

    Examples
    --------
    >>> at_least(np.diag([1.0, 9.0]), np.array([2.0, 2.0])).tolist()
    [[4.0, 0.0], [0.0, 9.0]]
    """
    return np.asarray(covariance + np.diag(np.maximum(least**2 - np.diag(covariance), 0.0)))


def root_of(covariance: Floats) -> Floats:
    """Compute the lower root of a covariance (S, S), which may be singular. [unit]

    Parameters
    ----------
    covariance : ndarray, shape (S, S)
        [unit^2]

    Returns
    -------
    ndarray, shape (S, S)

    Examples
    --------
    >>> root_of(np.array([[4.0]])).round(6)
    array([[2.]])
    """
    return np.linalg.cholesky(covariance + 1e-12 * np.trace(covariance) * np.eye(len(covariance)))


def _diagonal(value: Floats) -> Floats:
    return np.diag(value) if value.ndim == 2 else value
