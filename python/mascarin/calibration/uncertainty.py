"""How certain a fit is, when its residuals are not independent.

At the minimum the estimates answer a small change of the residuals linearly, with the Jacobian J of the
simulated series and the weights W of the squares: ``B J' W dr`` with ``B = (J' W J)^-1``. Their covariance
is therefore ``B (J' W Omega W J) B``, where Omega is the covariance of the residuals. Residuals of thermal
models are strongly autocorrelated, and those of neighbouring sensors resemble each other; taking Omega as
diagonal gives intervals that are many times too narrow. Here each sensor's residuals are described by an
autoregressive model (order by BIC), with correlated innovations between sensors, which gives Omega.

Omega is itself estimated, from residuals of which the fit has already swallowed a part, so that a standard
deviation from it scatters and is a little small. How much is found by simulation: errors are drawn from the
fitted autoregressive models, put through the linearised fit and the same estimate. With the known standard
deviation of what was drawn, the errors that are so many *estimated* standard deviations wide hold it with a
probability that can be computed; where 95 % need more of them than Student's quantile, that many are taken
(a bootstrap-t).

References
----------
Seber G.A.F., Wild C.J. (1989), Nonlinear Regression, chapter 6 (autocorrelated errors).
https://doi.org/10.1002/0471725315
Efron B., Tibshirani R.J. (1993), An Introduction to the Bootstrap, chapter 12 (bootstrap-t).
https://doi.org/10.1201/9780429246593
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.problem import CalibrationProblem
from mascarin.calibration.series import Autoregression, fit_autoregressions

Floats = NDArray[np.float64]

METHOD: Final = (
    "covariance of the estimates from the Jacobian, with the residuals' own autocorrelation (one "
    "autoregressive model per sensor, order by BIC) and correlation between sensors; the quantile from "
    "simulated fits to errors of these models (bootstrap-t), at least Student's with the effective number of "
    "independent residuals"
)
"""How the intervals are made, for reports."""

FREE: Final = 1e3
"""Standard deviation given to directions that the data do not see, in ranges of the parameters. [-]"""

_ALIKE = 0.95  # correlation from which two parameters are called hard to tell apart
_SAME = 0.999
_UNDETERMINED = 0.8  # share of the range that an interval may cover
_SETTLED = 0.05  # share of the range below which an interval is narrow, whatever it goes with
_AT_BOUND = 1e-4  # of the range
_DRAWN: Final = 40  # simulated fits
_SEED: Final = 20


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """What is known about the estimates, at positions z between 0 and 1 of their ranges.

    Attributes
    ----------
    low, high : ndarray, shape (P,)
        Interval, within [0, 1]. [-]
    sd : ndarray, shape (P,)
        Standard deviation in ranges. [-]
    correlation : ndarray, shape (P, P)
        Between the estimates. [-]
    effective_samples : tuple of float, length S
        Number of independent residuals of each sensor. [-]
    order : tuple of int, length S
        Order of each sensor's autoregressive model. [-]
    freedom : float
        Degrees of freedom of Student's quantile. [-]
    quantile : ndarray, shape (P,)
        Half-width of the intervals in standard deviations. [-]
    covariance : ndarray, shape (P, P)
        Of the estimates, in ranges. [-]
    information : ndarray, shape (P, P)
        That independent errors of the stated uncertainty would have, priors included. [-]
    error : tuple of float, length S
        Standard deviation of each sensor's errors about the model. [unit]
    stretch : ndarray, shape (P, P)
        By how much to draw positions towards the estimates so that the likelihood of independent errors
        gets the covariance of the data without priors; symmetric. [-]
    """

    low: Floats
    high: Floats
    sd: Floats
    correlation: Floats
    effective_samples: tuple[float, ...]
    order: tuple[int, ...]
    freedom: float
    quantile: Floats
    covariance: Floats
    information: Floats
    error: tuple[float, ...]
    stretch: Floats


def estimate(
    problem: CalibrationProblem,
    z: Floats,
    residuals: Floats,
    jacobian: Floats,
    weights: Floats,
    *,
    priors: Floats,
    blind_to_bias: bool,
    confidence: float,
) -> Uncertainty:
    """Intervals and correlations at a minimum.

    Parameters
    ----------
    problem : CalibrationProblem
        What was fitted.
    z : ndarray, shape (P,)
        The estimates, as positions between 0 and 1. [-]
    residuals : ndarray, shape (T, S)
        0 where nothing is compared. [unit]
    jacobian : ndarray, shape (T, S, P)
        Derivative of the residuals by z. [unit]
    weights : ndarray, shape (T, S)
        Weights of the squares, see `Cost.weights`.
    priors : ndarray, shape (P,)
        Inverse variance of the prior of z, 0 without one; counts only with weights of the likelihood. [-]
    blind_to_bias : bool
        Whether the cost takes off each sensor's mean.
    confidence : float
        Of the intervals. [-]

    Returns
    -------
    Uncertainty
    """
    from scipy import stats

    mask = problem.mask
    j = np.where(mask[:, :, None], jacobian, 0.0)
    if blind_to_bias:
        j = np.where(mask[:, :, None], j - j.sum(axis=0) / mask.sum(axis=0)[:, None], 0.0)
    r = np.where(mask, residuals, np.nan)
    models = tuple(fit_autoregressions(r.T))
    wj = weights[:, :, None] * j
    information = np.einsum("tsp,tsq->pq", wj, j) + np.diag(priors)
    effective = tuple(m.effective_samples for m in models)
    freedom = max(sum(effective) - z.size, 1.0)
    # The fit has swallowed a part of the errors, as many independent ones as there are parameters. A prior
    # is data with known, independent error: it enters the middle as it enters the information.
    swallowed = max(sum(effective), 1.0) / freedom
    noise = _Noise.of(r, models, swallowed)
    middle = noise.middle(wj) + np.diag(priors)
    covariance = _sandwich(information, middle)
    inside = (z > _AT_BOUND) & (z < 1.0 - _AT_BOUND)
    sd = np.sqrt(np.diag(covariance))
    quantile = np.full(z.size, float(stats.t.ppf(0.5 + 0.5 * confidence, freedom)))
    # A parameter held by its bound is not free to trade off against the others.
    free = np.flatnonzero(inside) if inside.any() else np.arange(z.size)
    block = np.ix_(free, free)
    sd[free] = np.sqrt(np.diag(_sandwich(information[block], middle[block])))
    drawn = _drawn_quantile(noise, j[..., free], wj[..., free], priors[free], mask, confidence)
    quantile[free] = np.maximum(quantile[free], drawn)
    reach = quantile * sd
    return Uncertainty(
        low=np.clip(z - reach, 0.0, 1.0),
        high=np.clip(z + reach, 0.0, 1.0),
        sd=sd,
        correlation=_correlation(covariance),
        effective_samples=effective,
        order=tuple(m.order for m in models),
        freedom=freedom,
        quantile=quantile,
        covariance=covariance,
        information=information,
        error=tuple(
            math.sqrt(max(m.variance, 0.0) * swallowed + float(np.nanmean(r[:, s])) ** 2)
            for s, m in enumerate(models)
        ),
        stretch=_stretch(information - np.diag(priors), middle - np.diag(priors)),
    )


def warnings(
    problem: CalibrationProblem, z: Floats, found: Uncertainty, residuals: Floats, jacobian: Floats
) -> list[str]:
    """What a reader of the estimates must know, in words.

    Parameters
    ----------
    problem, z, found, residuals, jacobian
        As for `estimate`, and what it returned.

    Returns
    -------
    list of str
    """
    names = problem.paths
    idle = _idle(problem, jacobian)
    texts = [f"{names[i]} changes none of the compared sensors: fix it" for i in np.flatnonzero(idle)]
    covered = found.high - found.low
    alike = _alike(names, found.correlation, idle | (covered < _SETTLED))
    texts += alike.values()
    told = {i for pair in alike for i in pair}
    texts += [
        f"{name} is not determined by these data: its interval covers {100.0 * covered[k]:.0f} % of the "
        f"range searched; fix it, or measure what it acts on"
        for k, name in enumerate(names)
        if covered[k] > _UNDETERMINED and not idle[k] and k not in told
    ]
    total = sum(found.effective_samples)
    if total < 3.0 * len(names):
        texts.append(
            f"{len(names)} parameters were fitted to residuals worth only {total:.0f} independent samples: "
            f"fit fewer, or compare a longer period"
        )
    texts += _biased(problem, residuals, found)
    return texts


def on_bounds(problem: CalibrationProblem, z: Floats, slope: Floats, found: Uncertainty) -> dict[str, str]:
    """Parameters that ended on a bound, each with a reason.

    Parameters
    ----------
    problem : CalibrationProblem
        What was fitted.
    z : ndarray, shape (P,)
        The estimates, as positions between 0 and 1. [-]
    slope : ndarray, shape (P,)
        Derivative of the cost by z.
    found : Uncertainty
        What `estimate` returned.

    Returns
    -------
    dict of str to str
        Reason by path.
    """
    reasons = {}
    for i, p in enumerate(problem.parameters):
        low, high = z[i] <= _AT_BOUND, z[i] >= 1.0 - _AT_BOUND
        if not (low or high):
            continue
        side, bound = ("lower", p.lower) if low else ("upper", p.upper)
        where = f"on its {side} bound {bound:g} {p.unit}".rstrip()
        outward = slope[i] > 0.0 if low else slope[i] < 0.0
        if found.high[i] - found.low[i] > _UNDETERMINED:
            reason = "the data do not determine it, and the search ended there"
        elif outward:
            more = "less" if low else "more"
            reason = (
                f"the data ask for {more} than the range allows: the bound is wrong, or the parameter makes "
                f"up for something the model lacks"
            )
        else:
            reason = "the minimum lies there within its uncertainty"
        reasons[p.path] = f"{where}: {reason}"
    return reasons


@dataclass(frozen=True, eq=False)
class _Noise:
    """Errors of all sensors: one autoregressive model each, with correlated innovations.

    Attributes
    ----------
    models : tuple of Autoregression, length S
        Of each sensor.
    innovation : ndarray, shape (S, S)
        Covariance of the innovations. [unit^2]
    memory : int
        Number of samples after which an innovation has died away. [-]
    """

    models: tuple[Autoregression, ...]
    innovation: Floats
    memory: int

    @staticmethod
    def of(r: Floats, models: tuple[Autoregression, ...], factor: float = 1.0) -> _Noise:
        """Errors like the residuals r (T, S), NaN for gaps; their variance times a factor."""
        memory = min(max((m.memory() for m in models), default=0), 20 * r.shape[0])
        noise = _Noise(models, np.eye(len(models)), memory)
        impulse = np.zeros((r.shape[0] + memory, len(models)))
        impulse[0] = 1.0
        return _Noise(models, factor * _innovations(r, models, noise.answer(impulse)), memory)

    def answer(self, innovations: Floats) -> Floats:
        """Series (T, S, ...) that innovations of the same shape give."""
        from scipy.signal import lfilter

        series = np.empty_like(innovations)
        for s, model in enumerate(self.models):
            denominator = np.concatenate([[1.0], -model.coefficients])
            series[:, s] = lfilter([1.0], denominator, innovations[:, s], axis=0)
        return series

    def middle(self, wj: Floats) -> Floats:
        """``J' W Omega W J`` from weighted derivatives (T, S, P).

        Omega of one sensor is ``innovation * Psi Psi'`` with Psi the response to an innovation; the product
        with Psi' is the recursion run backwards in time, and goes on before the first sample until it has
        died away.
        """
        filtered = self.answer(np.concatenate([wj[::-1], np.zeros((self.memory, *wj.shape[1:]))]))
        shape = (-1, wj.shape[2])
        mixed = np.einsum("su,tuq->tsq", self.innovation, filtered)
        return np.asarray(filtered.reshape(shape).T @ mixed.reshape(shape))

    def draw(self, times: int, count: int) -> Floats:
        """Random errors, shape (T, S, count), always the same ones. [unit]"""
        value, vector = np.linalg.eigh(self.innovation)
        root = vector * np.sqrt(np.maximum(value, 0.0))
        normal = np.random.default_rng(_SEED).standard_normal((times + self.memory, len(self.models), count))
        return self.answer(np.einsum("su,tuk->tsk", root, normal))[self.memory :]


def _drawn_quantile(
    noise: _Noise, j: Floats, wj: Floats, priors: Floats, mask: NDArray[np.bool_], confidence: float
) -> Floats:
    """Size of error over standard deviation that simulated fits keep at the confidence, shape (P,). [-]"""
    if not np.any(np.diag(noise.innovation) > 0.0):
        return np.zeros(j.shape[2])
    information = np.einsum("tsp,tsq->pq", wj, j) + np.diag(priors)
    inverse, _ = _inverted(information)
    true = _diagonal(inverse, noise.middle(wj) + np.diag(priors))
    errors = noise.draw(j.shape[0], _DRAWN)
    beside = np.random.default_rng(_SEED + 1).standard_normal((priors.size, _DRAWN))
    moved = -inverse @ (np.einsum("tsp,tsk->pk", wj, errors) + np.sqrt(priors)[:, None] * beside)
    left = errors + np.einsum("tsp,pk->tsk", j, moved)
    ratio = np.ones_like(moved)
    seen = np.where(mask[:, :, None], left, np.nan)
    sensors = mask.shape[1]
    fitted = fit_autoregressions(seen.reshape(len(seen), -1).T)
    for k in range(_DRAWN):
        r = seen[:, :, k]
        models = tuple(fitted[s * _DRAWN + k] for s in range(sensors))
        effective = max(sum(m.effective_samples for m in models), 1.0)
        found = _Noise.of(r, models, effective / max(effective - priors.size, 1.0))
        variance = _diagonal(inverse, found.middle(wj) + np.diag(priors))
        ratio[:, k] = np.sqrt(np.divide(variance, true, out=np.ones_like(true), where=true > 0.0))
    return _widened(ratio, confidence)


def _diagonal(inverse: Floats, middle: Floats) -> Floats:
    return np.asarray(np.einsum("ip,pq,iq->i", inverse, middle, inverse))


def _widened(ratio: Floats, confidence: float) -> Floats:
    """Quantile of a normal variable in units of a standard deviation that scatters, rows of (P, K). [-]"""
    from scipy.special import ndtr

    low, high = np.zeros(len(ratio)), np.full(len(ratio), 1e3)
    # Bisection: the probability rises with the quantile.
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = np.mean(2.0 * ndtr(middle[:, None] * ratio) - 1.0, axis=1)
        low, high = np.where(inside < confidence, middle, low), np.where(inside < confidence, high, middle)
    return np.asarray(high)


def _innovations(r: Floats, models: tuple[Autoregression, ...], responses: Floats) -> Floats:
    """Covariance of the innovations of all sensors, from that of the residuals; shape (S, S). [unit^2]"""
    size = np.sqrt([max(m.innovation, 0.0) for m in models])
    there = np.isfinite(r)
    pairs = there.T.astype(np.float64) @ there
    mean = np.where(there, r, 0.0).sum(axis=0) / np.maximum(np.diag(pairs), 1.0)
    centred = np.where(there, r - mean, 0.0)
    together = centred.T @ centred / np.maximum(pairs, 1.0)
    scale = np.outer(size, size) * (responses.T @ responses)
    known = (scale > 0.0) & (pairs >= 3.0)
    correlation = np.clip(np.divide(together, scale, out=np.zeros_like(scale), where=known), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    # Estimated pair by pair, so not always a covariance: take the nearest one.
    value, vector = np.linalg.eigh(correlation)
    correlation = (vector * np.maximum(value, 0.0)) @ vector.T
    return np.asarray(correlation * np.outer(size, size))


def _inverted(information: Floats) -> tuple[Floats, Floats]:
    """Inverse of the information where the data see something, and the directions that they do not see."""
    value, vector = np.linalg.eigh(information)
    largest = float(value.max(initial=0.0))
    seen = value > max(1e-13 * largest, np.finfo(float).tiny)
    inverse = np.where(seen, 1.0 / np.where(seen, value, 1.0), 0.0)
    return np.asarray((vector * inverse) @ vector.T), np.asarray(vector[:, ~seen])


def _sandwich(information: Floats, middle: Floats) -> Floats:
    """``B middle B``, ``B = information^-1``; what the data do not see gets the variance `FREE` squared."""
    b, unseen = _inverted(information)
    covariance = b @ middle @ b + FREE**2 * unseen @ unseen.T
    return np.asarray(0.5 * (covariance + covariance.T))


def symmetric_power(matrix: Floats, exponent: float) -> Floats:
    """Power of a symmetric matrix without negative eigenvalues. [-]"""
    value, vector = np.linalg.eigh(matrix)
    floor = np.finfo(float).eps * max(float(value.max(initial=0.0)), np.finfo(float).tiny)
    return np.asarray((vector * np.maximum(value, floor) ** exponent) @ vector.T)


def _stretch(information: Floats, middle: Floats) -> Floats:
    """Symmetric C with ``C information C`` the inverse of the sandwich: a geometric mean of matrices."""
    wanted = symmetric_power(_sandwich(information, middle), -1.0)
    # Where the data see nothing the likelihood is flat and any finite stretch will do.
    root = symmetric_power(information + np.eye(len(information)), 0.5)
    back = symmetric_power(information + np.eye(len(information)), -0.5)
    return np.asarray(back @ symmetric_power(root @ wanted @ root, 0.5) @ back)


def _correlation(covariance: Floats) -> Floats:
    sd = np.sqrt(np.diag(covariance))
    sd = np.where(sd > 0.0, sd, 1.0)
    correlation = np.clip(covariance / np.outer(sd, sd), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    return np.asarray(correlation)


def _idle(problem: CalibrationProblem, jacobian: Floats) -> NDArray[np.bool_]:
    """Parameters whose whole range moves no sensor by a noticeable part of its uncertainty."""
    scale = np.where(problem.mask, problem.sigma, np.inf)[:, :, None]
    return np.asarray(np.max(np.abs(jacobian) / scale, axis=(0, 1)) < 1e-9)


def _alike(
    names: tuple[str, ...], correlation: Floats, aside: NDArray[np.bool_]
) -> dict[tuple[int, int], str]:
    """Sentences on pairs that act alike, the most alike first; parameters set aside are in none."""
    pairs = [
        (i, k)
        for i in range(len(names))
        for k in range(i)
        if abs(correlation[i, k]) >= _ALIKE and not (aside[i] or aside[k])
    ]
    texts = {}
    for i, k in sorted(pairs, key=lambda pair: -abs(correlation[pair])):
        c = correlation[i, k]
        verb = "cannot" if abs(c) >= _SAME else "can hardly"
        texts[i, k] = f"{names[k]} and {names[i]} {verb} be told apart (correlation {c:+.3f}): fix one"
    return texts


def _biased(problem: CalibrationProblem, residuals: Floats, found: Uncertainty) -> list[str]:
    """Sensors whose residuals keep a mean that their scatter does not explain."""
    texts = []
    for s, sensor in enumerate(problem.sensors):
        r = residuals[sensor.mask, s]
        bias, spread = float(r.mean()), float(r.std())
        if abs(bias) > 3.0 * spread / math.sqrt(max(found.effective_samples[s], 1.0)) and abs(bias) > 1e-9:
            unit = sensor.unit.replace("degC", "K")
            texts.append(
                f"'{sensor.name}' keeps a bias of {bias:+.2g} {unit}; the intervals do not cover what "
                "causes it"
            )
    return texts
