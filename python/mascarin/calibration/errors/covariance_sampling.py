"""A sample of the sizes of the errors of a model given the measurements: how well few days tell them.

`mascarin.calibration.errors.discrepancy` finds the most probable sizes. Five days leave them doubtful by a
factor of two, and the estimates of the parameters with them. Here the sizes are drawn from their distribution
given the measurements (Gibbs sampling): in turn the errors given the sizes, which are normal, and the sizes
given the errors. The prior of each covariance has standard deviations with half-t distributions, which allow
an error to vanish and to be large, and correlations that are equally likely.

The block of a day is diagonal in the common eigenvectors of its two parts, which makes a move cheap. Values
that are not there are drawn with the errors.

References
----------
Huang A., Wand M.P. (2013), Simple marginally noninformative prior distributions for covariance matrices,
Bayesian Analysis 8, 439. https://doi.org/10.1214/13-BA815
Gelman A. (2006), Prior distributions for variance parameters in hierarchical models, Bayesian Analysis 1,
515. https://doi.org/10.1214/06-BA117A
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.discrepancy import (
    CORRELATION_HOURS,
    DayData,
    Discrepancy,
    Indices,
    SizeLimits,
    at_least,
    columns_of,
    drift_kernel,
    root_of,
    together,
)

Floats = NDArray[np.float64]

#: Degrees of freedom of the half-t distributions.
_FREEDOM: Final = 2.0
#: Part of a variance that round-off may hide in a sum of squares. [-]
_ROUND_OFF: Final = 1e-12
#: Part of each variance that a sensor has for itself at least. Fewer errors than sensors allow covariances
#: that are singular to round-off, and so are then the equations of the next move. [-]
_OWN_PART: Final = 1e-6
#: Moves before the sample, moves of the sample, and every which of them is kept.
_BURN_IN: Final = 100
_MOVES: Final = 300
_THINNING: Final = 3
_SEED: Final = 21


@dataclass(frozen=True, eq=False)
class CovarianceSample:
    """Sizes of the errors, and the coefficients of the shared effects given each of them.

    Attributes
    ----------
    covariances : tuple of tuple of Discrepancy, length K
        Drawn sizes, of each experiment.
    mean : ndarray, shape (K, q)
        Mean of the coefficients given them: known effects in standard deviations of their priors [-], then
        the errors that repeat, by experiment, function and sensor [unit of the sensor].
    covariance : ndarray, shape (K, q, q)
        Their covariance.
    """

    covariances: tuple[tuple[Discrepancy, ...], ...]
    mean: Floats
    covariance: Floats

    @classmethod
    def of_covariances(cls, data: Sequence[DayData], covariances: Sequence[Discrepancy]) -> CovarianceSample:
        """Sizes that are known, of each experiment."""
        from scipy import linalg

        gaussian = together(data, covariances)
        parts = [
            np.eye(data[0].effects.shape[2]),
            *(
                np.kron(np.eye(part.basis.shape[2]), root_of(each.hour))
                for part, each in zip(data, covariances, strict=True)
            ),
            *(root_of(each.alike * each.day) for each in covariances if each.alike),
        ]
        turn = linalg.block_diag(*parts)
        mean = turn @ gaussian.coefficients([part.error for part in data])
        return cls((tuple(covariances),), mean[None], (turn @ gaussian.covariance @ turn.T)[None])

    @property
    def typical(self) -> tuple[Discrepancy, ...]:
        """Sizes with the mean of every variance, of each experiment."""
        return tuple(_typical(draws) for draws in zip(*self.covariances, strict=True))


def _typical(draws: Sequence[Discrepancy]) -> Discrepancy:
    mean_of = {name: np.mean([getattr(draw, name) for draw in draws], axis=0) for name in _PARTS}
    hours = [draw.correlation_hours for draw in draws]
    return replace(draws[0], **mean_of, correlation_hours=max(set(hours), key=hours.count))


_PARTS: Final = ("hour", "day", "drift", "white")


def sample_covariances(
    data: Sequence[DayData], first: Sequence[Discrepancy], sizes: Sequence[SizeLimits]
) -> CovarianceSample:
    """Draw sizes of the errors, the same numbers in every call.

    Parameters
    ----------
    data : sequence of DayData
        Errors and known effects of each experiment; the effects have common coefficients.
    first : sequence of Discrepancy
        Where to begin, such as the most probable sizes.
    sizes : sequence of SizeLimits
        Their scale is that of the half-t prior of each standard deviation.

    Returns
    -------
    CovarianceSample

    Examples
    --------
    Errors of 0.2 of every slot of 20 days, alone:

    >>> from mascarin.calibration.errors.day_blocks import DayGrid
    >>> from mascarin.calibration.errors.discrepancy import hour_basis
    >>> grid = DayGrid(np.zeros(0, int), np.zeros(0, int), 20, 8, 3.0)
    >>> basis = np.broadcast_to(hour_basis(np.arange(8) * 3.0), (20, 8, 5))
    >>> error = 0.2 * np.random.default_rng(1).normal(size=(20, 8))
    >>> data = DayData(grid, error, np.zeros((20, 8, 0)), basis, np.ones((20, 8), dtype=bool), np.zeros(1))
    >>> small = 1e-4 * np.eye(1)
    >>> first = Discrepancy(small, small, small, np.array([0.04]), np.zeros(1), 4.0)
    >>> one = np.ones(1)
    >>> sample = sample_covariances([data], [first], [SizeLimits(0.1 * one, one)])
    >>> bool(0.15 < np.sqrt(sample.typical[0].white[0]) < 0.23)
    True
    """
    rng, columns = np.random.default_rng(_SEED), columns_of(data, first)
    chains = [_Chain(*each, rng) for each in zip(data, first, sizes, strict=True)]
    covariances, mean, covariance = [], [], []
    for move in range(_BURN_IN + _MOVES):
        now = tuple(chain.covariances for chain in chains)
        middle, root = _moved(chains, columns, rng)
        if move >= _BURN_IN and (move - _BURN_IN) % _THINNING == 0:
            covariances.append(now)
            mean.append(middle)
            covariance.append(root @ root.T)
    return CovarianceSample(tuple(covariances), np.array(mean), np.array(covariance))


def _moved(
    chains: Sequence[_Chain], columns: Sequence[Indices], rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Draw the errors of all experiments, then the sizes.

    Returns
    -------
    ndarray, shape (q,)
        Mean of the coefficients given the sizes before.
    ndarray, shape (q, q)
        A root of their covariance.
    """
    from scipy.linalg import lapack

    turned = [chain.turned_now() for chain in chains]
    said = [chain.information(part) for chain, part in zip(chains, turned, strict=True)]
    precision, right = said[0]
    if len(chains) > 1:
        size = 1 + max(int(column.max()) for column in columns)
        precision, right = np.zeros((size, size)), np.zeros(size)
        for column, (information, values) in zip(columns, said, strict=True):
            precision[np.ix_(column, column)] += information
            right[column] += values
    effect_count = chains[0].effect_count
    # Each experiment alone has the prior of the common coefficients.
    precision[:effect_count, :effect_count] -= (len(chains) - 1.0) * np.eye(effect_count)
    lower = _cholesky(0.5 * (precision + precision.T))
    root = np.asarray(lapack.dtrtri(lower, lower=True)[0].T, dtype=np.float64)
    middle = root @ (root.T @ right)
    shared = middle + root @ rng.standard_normal(middle.size)
    for chain, part, column in zip(chains, turned, columns, strict=True):
        chain.draw(part, shared[column])
    return middle, root


@dataclass(frozen=True, eq=False)
class _Turned:
    """Columns and values of an experiment in coordinates in which they are independent.

    `columns` (D, H, S, q), `values` (D, H, S), `ones` (H, S, S): a constant of a day; `weight` (H, S): the
    precision; `slow_part` (H, S): variance of the slow part; `turn` (S, S), `noise` (S,): back to sensors;
    `weighted_ones` (H * S, S), `day_covariance` (S, S): weighted constants of a day and their covariance, the
    same on all days.
    """

    columns: Floats
    values: Floats
    ones: Floats
    weight: Floats
    slow_part: Floats
    turn: Floats
    noise: Floats
    weighted_ones: Floats
    day_covariance: Floats


class _Chain:
    """State of the sampling of one experiment: sizes, and the values that are not there.

    Arrays of values have the shape (D, H, S): days, slots of a day, sensors.
    """

    def __init__(
        self, data: DayData, first: Discrepancy, sizes: SizeLimits, rng: np.random.Generator
    ) -> None:
        self.covariances, self.scale, self.limit, self.least = first, sizes.scale, sizes.limit, sizes.least
        self.rng = rng
        grid, self.sensors = data.grid, data.sensors
        self.shape = (grid.days, grid.slots, self.sensors)
        self.there = data.present.reshape(self.shape)
        self.value = np.where(self.there, data.error.reshape(self.shape), 0.0)
        self.effect_count = data.effects.shape[2]
        self.functions = data.basis.shape[2]
        eye = np.eye(self.sensors)
        level = np.broadcast_to(
            np.tile(eye, (grid.slots, 1)), (grid.days, grid.slots * self.sensors, self.sensors)
        )
        columns = [data.effects, data.repeating(eye), *([level] if first.alike else [])]
        self.columns = np.concatenate(columns, axis=2).reshape(*self.shape, -1)
        # Eigenvectors of the correlation within a day, and the columns in them, by correlation time.
        self.kernels = {h: drift_kernel(grid, h) for h in CORRELATION_HOURS}
        self.spectra = {h: _eigenvectors(kernel) for h, kernel in self.kernels.items()}
        self.turned = {h: _along_slots(vector.T, self.columns) for h, (_, vector) in self.spectra.items()}

    def turned_now(self) -> _Turned:
        """Columns and values with the sizes as they are."""
        covariances = self.covariances
        value, vector = self.spectra[covariances.correlation_hours]
        noise = np.sqrt(covariances.white)
        strength, turn = _eigenvectors(covariances.drift / np.outer(noise, noise))
        to_sensor = turn.T / noise  # from sensors to values of variance 1 + the product of the eigenvalues
        slow_part = np.outer(value, np.maximum(strength, 0.0))  # (H, S)
        columns = np.einsum(
            "js,dhsq->dhjq", to_sensor, self.turned[covariances.correlation_hours], optimize=True
        )
        values = _along_slots(vector.T, self.value) @ to_sensor.T
        ones = vector.T.sum(axis=1)[:, None, None] * to_sensor[None]  # (H, S, S): a constant of a day
        weight = 1.0 / (1.0 + slow_part)
        weighted_ones = (ones * weight[:, :, None]).reshape(-1, self.sensors)
        day_covariance = np.linalg.inv(
            np.linalg.inv(covariances.day) + ones.reshape(-1, self.sensors).T @ weighted_ones
        )
        return _Turned(
            columns, values, ones, weight, slow_part, turn, noise, weighted_ones, np.asarray(day_covariance)
        )

    def draw(self, turned: _Turned, shared: Floats) -> None:
        """Draw the errors given the coefficients (q,) of this experiment, then its sizes."""
        vector = self.spectra[self.covariances.correlation_hours][1]
        noise, slow_part, weight = turned.noise, turned.slow_part, turned.weight
        remaining = turned.values - turned.columns @ shared
        of_day = self._days(turned, remaining)
        remaining = remaining - np.einsum("hjs,ds->dhj", turned.ones, of_day, optimize=True)
        noise_of_slow = self.rng.standard_normal(remaining.shape) * np.sqrt(slow_part * weight)
        slow = slow_part * weight * remaining + noise_of_slow
        back = turned.turn * noise[:, None]
        slow = _along_slots(vector, slow) @ back.T
        remaining = _along_slots(vector, remaining) @ back.T
        white = np.where(self.there, remaining - slow, self.rng.standard_normal(remaining.shape) * noise)
        self.value = np.where(self.there, self.value, self.value - remaining + slow + white)
        self._draw_sizes(shared, of_day, slow, white)

    def information(self, turned: _Turned) -> tuple[Floats, Floats]:
        """Precision of the coefficients (q, q) with their prior, and what it makes of their mean (q,)."""
        covariances, columns, weight = self.covariances, turned.columns, turned.weight
        precision = np.zeros((columns.shape[3],) * 2)
        end = self.effect_count + self.functions * self.sensors
        precision[: self.effect_count, : self.effect_count] = np.eye(self.effect_count)
        precision[self.effect_count : end, self.effect_count : end] = np.kron(
            np.eye(self.functions), np.linalg.inv(covariances.hour)
        )
        if covariances.alike:
            precision[end:, end:] = np.linalg.inv(covariances.alike * covariances.day)
        root = np.sqrt(weight)
        scaled = (columns * root[None, :, :, None]).reshape(-1, columns.shape[3])
        precision += scaled.T @ scaled
        right = scaled.T @ (turned.values * root).ravel()
        weighted_ones, day_covariance = turned.weighted_ones, turned.day_covariance
        with_columns = (
            np.swapaxes(columns.reshape(len(columns), -1, columns.shape[3]), 1, 2) @ weighted_ones
        )  # (D, q, S)
        with_values = turned.values.reshape(len(columns), -1) @ weighted_ones
        tall = np.swapaxes(with_columns, 1, 2).reshape(-1, columns.shape[3])  # (D * S, q)
        lifted = (day_covariance @ np.swapaxes(with_columns, 1, 2)).reshape(tall.shape)
        precision -= tall.T @ lifted
        right -= lifted.T @ with_values.ravel()
        return precision, right

    def _days(self, turned: _Turned, residual: Floats) -> Floats:
        """Draw the constants of days (D, S) given what the coefficients leave."""
        weighted_ones, day_covariance = turned.weighted_ones, turned.day_covariance
        spread = root_of(day_covariance)
        day_means = residual.reshape(len(residual), -1) @ weighted_ones @ day_covariance
        return np.asarray(day_means + self.rng.standard_normal(day_means.shape) @ spread.T)

    def _draw_sizes(self, shared: Floats, of_day: Floats, slow: Floats, white: Floats) -> None:
        covariances, end = self.covariances, self.effect_count + self.functions * self.sensors
        repeating = shared[self.effect_count : end].reshape(self.functions, self.sensors)
        of_days, days = of_day.T @ of_day, len(of_day)
        if covariances.alike:
            level = shared[end:]
            of_days, days = of_days + np.outer(level, level) / covariances.alike, days + 1
        hours = self._correlation(slow)
        value, vector = self.spectra[hours]
        turned = _along_slots(vector.T, slow) / np.sqrt(value)[None, :, None]
        squares = np.einsum("dhs,dht->st", turned, turned, optimize=True)
        self.covariances = replace(
            covariances,
            hour=self._covariance(covariances.hour, repeating.T @ repeating, self.functions),
            day=self._covariance(covariances.day, of_days, days),
            drift=at_least(
                self._covariance(covariances.drift, squares, slow.shape[0] * slow.shape[1]), self.least
            ),
            white=self._variance(white),
            correlation_hours=hours,
        )

    def _covariance(self, now: Floats, squares: Floats, count: int) -> Floats:
        """Draw a covariance (S, S) given the sum of squares of as many errors."""
        rate = _FREEDOM * np.diag(np.linalg.inv(now)) + self.scale**-2
        inverse = self.rng.gamma(0.5 * (_FREEDOM + len(now)), 1.0, len(now)) / rate
        total = squares + 2.0 * _FREEDOM * np.diag(inverse)
        draw = inverse_wishart(self.rng, total, _FREEDOM + len(now) - 1.0 + count)
        shrink = np.minimum(1.0, self.limit / np.sqrt(np.diag(draw)))
        limited = draw * np.outer(shrink, shrink)
        return np.asarray(limited + _OWN_PART * np.diag(np.diag(limited)))

    def _variance(self, white: Floats) -> Floats:
        """Draw the variances of independent errors."""
        rate = _FREEDOM / self.covariances.white + self.scale**-2
        inverse = self.rng.gamma(0.5 * (_FREEDOM + 1.0), 1.0, rate.size) / rate
        count = white.shape[0] * white.shape[1]
        total = 0.5 * np.sum(white**2, axis=(0, 1)) + _FREEDOM * inverse
        draw = total / self.rng.gamma(0.5 * (_FREEDOM + count), 1.0, rate.size)
        return np.asarray(np.minimum(draw, self.limit**2))

    def _correlation(self, slow: Floats) -> float:
        """Draw the correlation time given the slow errors."""
        inverse = np.linalg.inv(self.covariances.drift)
        logs = []
        for value, vector in self.spectra.values():
            turned = _along_slots(vector.T, slow) / np.sqrt(value)[None, :, None]
            square = float(np.sum((turned @ inverse) * turned))
            logs.append(-0.5 * (square + slow.shape[0] * slow.shape[2] * float(np.log(value).sum())))
        weight = np.exp(np.array(logs) - max(logs))
        return float(self.rng.choice(list(self.spectra), p=weight / weight.sum()))


def inverse_wishart(rng: np.random.Generator, total: Floats, freedom: float) -> Floats:
    """Draw a covariance from an inverse Wishart distribution (Bartlett's decomposition).

    Parameters
    ----------
    rng : Generator
        Source of random numbers.
    total : ndarray, shape (S, S)
        Scale matrix. [unit^2]
    freedom : float
        Degrees of freedom, more than S - 1. [-]

    Returns
    -------
    ndarray, shape (S, S)
        [unit^2]

    Examples
    --------
    >>> drawn = inverse_wishart(np.random.default_rng(1), np.eye(1), 1e6)
    >>> bool(abs(drawn[0, 0] - 1e-6) < 1e-8)
    True
    """
    size = len(total)
    lower = np.tril(rng.standard_normal((size, size)), -1)
    lower[np.diag_indices(size)] = np.sqrt(rng.chisquare(freedom - np.arange(size)))
    part = np.linalg.solve(lower, _cholesky(0.5 * (total + total.T)).T)
    draw = part.T @ part
    return np.asarray(0.5 * (draw + draw.T))


def _cholesky(total: Floats) -> Floats:
    """Lower factor of a sum of squares or of a precision, which may be singular to round-off.

    Fewer errors than sensors make a singular sum. What the prior adds to its diagonal is lost where the
    errors are large: then that much is added in units of each row that round-off cannot hide it.
    """
    try:
        return np.asarray(np.linalg.cholesky(total))
    except np.linalg.LinAlgError:
        scale = np.sqrt(np.diag(total))
        alike = total / np.outer(scale, scale)
        lift = len(total) * _ROUND_OFF - min(float(np.linalg.eigvalsh(alike)[0]), 0.0)
        return np.asarray(scale[:, None] * np.linalg.cholesky(alike + lift * np.eye(len(total))))


def _eigenvectors(symmetric: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues (n,) and eigenvectors (n, n), the largest component of each positive.

    Errors are drawn along them. Signs that depend on round-off would give other draws of the same
    distribution on other machines.
    """
    value, vectors = np.linalg.eigh(symmetric)
    largest = np.abs(vectors).argmax(axis=0)
    return value, vectors * np.sign(vectors[largest, np.arange(len(value))])


def _along_slots(matrix: Floats, values: Floats) -> Floats:
    """Multiply values (D, H, ...) with a matrix (H, H) along the slots of the day."""
    flat = values.reshape(*values.shape[:2], -1)
    return np.asarray((matrix @ flat).reshape(values.shape))
