"""Heat loss coefficient of a house from a short heating test: a stochastic model of low order.

Two states, the air with what follows it quickly and the envelope, exchange heat with each other and with
outdoors,

    Ci dTi = ((Te - Ti) / Rie + Ai I + P) dt + s1 Ci dw1
    Ce dTe = ((Ti - Te) / Rie + (To - Te) / Reo + Ae I) dt + s2 Ce dw2
    y = Ti + noise

and both are driven by noise: what the model does not know of (wind, other rooms, the ground) acts on the
states and lasts, so that errors are not taken for independent ones. The likelihood follows from a Kalman
filter, exact for inputs that are constant over an interval. The heat loss coefficient is ``1 / (Rie + Reo)``.

References
----------
Madsen H., Holst J. (1995), Estimation of continuous-time models for the heat dynamics of a building, Energy
and Buildings 22, 67. https://doi.org/10.1016/0378-7788(94)00904-X
Bacher P., Madsen H. (2011), Identifying suitable models for the heat dynamics of buildings, Energy and
Buildings 43, 1511. https://doi.org/10.1016/j.enbuild.2011.02.005
Van Loan C.F. (1978), Computing integrals involving the matrix exponential, IEEE Trans. Autom. Control 23.
https://doi.org/10.1109/TAC.1978.1101743
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError, SolverError

Floats = NDArray[np.float64]

#: Names of the parameters, all estimated as logarithms but the last.
_NAMES: Final = ("ci", "ce", "rie", "reo", "ai", "ae", "noise_i", "noise_e", "noise_y", "te")
_COUNT: Final = len(_NAMES)
#: Fewest samples, and shortest test. [-], [h]
_FEWEST: Final = 48
_SHORTEST: Final = 24.0
#: Shares of the resistance between air and envelope, and time constants [h], from which searches start.
_STARTS: Final = ((0.1, 20.0), (0.3, 40.0), (0.1, 60.0), (0.3, 10.0))
#: Step of differences of the logarithms.
_STEP: Final = 1e-4
_CURVATURE_STEP: Final = 1e-2
#: Standard deviation of the weak normal prior of each logarithm about its start. [-]
_WEAK: Final = 4.0
#: The covariance of the filter counts as steady when it changes by less. [-]
_STEADY: Final = 1e-10
#: Samples of the coarse record. [-]
_COARSE: Final = 100
#: Cost of parameters for which there is no likelihood.
_IMPOSSIBLE: Final = 1e12


@dataclass(frozen=True, eq=False)
class HeatingTest:
    """What a heating test tells, each number with its standard error.

    Attributes
    ----------
    heat_loss_coefficient : tuple of float
        From inside to outdoors. [W/K]
    solar_aperture : tuple of float
        Area that, times the irradiance, is the heat that the sun brings: inside and in the envelope, the
        latter as far as it reaches the air. [m2]
    capacity : tuple of float
        Effective heat capacity, of air and envelope. [Wh/K]
    time_constants : tuple of tuple of float
        Short and long. [h]
    log_likelihood : float
        [-]
    errors : ndarray, shape (n,)
        Measured minus predicted one interval ahead, in their standard deviations: white noise of a standard
        deviation of 1 if the model is right. [-]

    Examples
    --------
    >>> one = HeatingTest((50.0, 2.5), (1.0, 0.2), (4000.0, 300.0), ((2.0, 0.1), (60.0, 5.0)), -10.0,
    ...     np.zeros(2))
    >>> one.interval()
    (45.1, 54.9)
    """

    heat_loss_coefficient: tuple[float, float]
    solar_aperture: tuple[float, float]
    capacity: tuple[float, float]
    time_constants: tuple[tuple[float, float], tuple[float, float]]
    log_likelihood: float
    errors: Floats

    @property
    def autocorrelation(self) -> float:
        """Correlation of an error with the next one; beyond 2 over the root of n two states are too few. [-]

        Then means over longer intervals help: of what lasts for minutes the model knows nothing.
        """
        return float(np.sum(self.errors[1:] * self.errors[:-1]) / np.sum(self.errors**2))

    def interval(self, factor: float = 1.96) -> tuple[float, float]:
        """Return the interval of the heat loss coefficient of 95 %, or of another coverage factor. [W/K]"""
        value, error = self.heat_loss_coefficient
        return round(value - factor * error, 6), round(value + factor * error, 6)


def heating_test(
    inside: ArrayLike, outdoors: ArrayLike, power: ArrayLike, irradiance: ArrayLike, *, interval: float
) -> HeatingTest:
    """Estimate the heat loss coefficient from a heating test.

    Parameters
    ----------
    inside : array_like, shape (n,)
        Measured air temperature. [degC]
    outdoors : array_like, shape (n,)
        Outdoor air temperature, mean over the interval after each instant. [degC]
    power : array_like, shape (n,)
        Heating power and all other gains, mean over the interval. [W]
    irradiance : array_like, shape (n,)
        Of the sun on any plane, mean over the interval. [W/m2]
    interval : float
        Between the samples. [s]

    Returns
    -------
    HeatingTest

    Raises
    ------
    InputError
        Too few samples, gaps, or a house that was never heated.
    SolverError
        No search ended at a maximum.

    Examples
    --------
    A house with 100 W/K, without noise of its states, heated every other day:

    >>> hours = np.arange(0.0, 144.0, 0.5)
    >>> power = 2000.0 * (hours % 48.0 < 24.0)
    >>> inside = np.empty(hours.size)
    >>> air, wall = 10.0, 10.0
    >>> for k in range(hours.size):
    ...     inside[k] = air
    ...     for _ in range(60):  # steps of 30 s
    ...         flow = (air - wall) * 400.0
    ...         air += (power[k] - flow) / 1000.0 / 120.0
    ...         wall += (flow - (wall - 5.0) * 400.0 / 3.0) / 5000.0 / 120.0
    >>> noise = np.random.default_rng(2).normal(0.0, 0.02, hours.size)
    >>> still, dark = np.full(hours.size, 5.0), np.zeros(hours.size)
    >>> found = heating_test(inside + noise, still, power, dark, interval=1800.0)
    >>> abs(found.heat_loss_coefficient[0] - 100.0) < 3.0 * found.heat_loss_coefficient[1] < 6.0
    True
    """
    y, inputs = _checked(inside, outdoors, power, irradiance, interval)
    hours = interval / 3600.0
    starts = [_start(y, inputs, share, time_constant) for share, time_constant in _STARTS]
    # A coarse record finds the region, all samples the maximum in it.
    together = max(1, y.size // _COARSE)
    coarse = _thinned(y, inputs, together)
    trials = [(_searched(start, *coarse, hours * together), start) for start in starts]
    trial, start = min(trials, key=lambda series: float(series[0].fun))
    estimate = trial if together == 1 else _searched(start, y, inputs, hours, trial.x)
    if not np.isfinite(estimate.fun) or estimate.fun >= _IMPOSSIBLE:
        raise SolverError(
            "heating test: no search ended at a maximum of the likelihood; check units and gaps"
        )
    solution = estimate.x
    covariance = np.linalg.pinv(_curvature(solution, start, y, inputs, hours), hermitian=True)
    log_likelihood, errors = _filtered(solution[None], y, inputs, hours)
    values = _derived(solution[None])[0]
    moved = solution + _STEP * np.concatenate([np.eye(_COUNT), -np.eye(_COUNT)])
    slopes = (_derived(moved[:_COUNT]) - _derived(moved[_COUNT:])) / (2.0 * _STEP)
    sd = np.sqrt(np.maximum(np.einsum("ik,ij,jk->k", slopes, covariance, slopes), 0.0))
    pairs = [(float(value), float(error)) for value, error in zip(values, sd, strict=True)]
    return HeatingTest(
        pairs[0], pairs[1], pairs[2], (pairs[3], pairs[4]), float(log_likelihood[0]), errors[:, 0]
    )


def _checked(
    inside: ArrayLike, outdoors: ArrayLike, power: ArrayLike, irradiance: ArrayLike, interval: float
) -> tuple[Floats, Floats]:
    """Measured series, and inputs (n, 3): outdoor air [degC], irradiance [W/m2], power [W]."""
    y = np.asarray(inside, dtype=np.float64)
    inputs = [np.asarray(series, dtype=np.float64) for series in (outdoors, irradiance, power)]
    for name, series in zip(("inside", "outdoors", "irradiance", "power"), (y, *inputs), strict=True):
        if series.shape != y.shape or y.ndim != 1:
            raise InputError(
                f"{name}: found shape {series.shape}, expected {y.shape}, that of 'inside'; use one"
            )
        if not np.isfinite(series).all():
            gaps = int(np.count_nonzero(~np.isfinite(series)))
            raise InputError(f"{name}: found {gaps} gaps, expected none; fill short ones, or use a part")
    if y.size < _FEWEST or y.size * interval < 3600.0 * _SHORTEST:
        raise InputError(
            f"heating test: found {y.size} samples in {y.size * interval / 3600.0:.3g} h, expected at least "
            f"{_FEWEST} over {_SHORTEST:g} h; use a longer record"
        )
    if not np.ptp(inputs[2]) > 0.0:
        raise InputError("power: found a constant, expected power that is switched; heat for a day or two")
    return y, np.stack(inputs, axis=1)


def _start(y: Floats, inputs: Floats, share: float, time_constant: float) -> Floats:
    """Where a search begins: the loss from means, everything else from it."""
    outdoors, _, power = inputs.T
    loss = max(float(np.mean(power)) / max(float(np.mean(y - outdoors)), 1.0), 1.0)
    resistance = 1.0 / loss
    envelope = loss * time_constant
    logs = np.log([
        0.1 * envelope, envelope, share * resistance, (1.0 - share) * resistance, 1.0, 1.0, 0.05, 0.05, 0.03,
    ])  # fmt: skip
    return np.append(logs, float(y[0] + share * (outdoors[0] - y[0])))


def _thinned(y: Floats, inputs: Floats, together: int) -> tuple[Floats, Floats]:
    """Every so many samples, and the means of the inputs between them."""
    count = y.size // together
    return y[: count * together : together], inputs[: count * together].reshape(count, together, 3).mean(
        axis=1
    )


def _searched(start: Floats, y: Floats, inputs: Floats, hours: float, first: Floats | None = None) -> Any:
    """Maximum of the likelihood near a start, or near another first vector."""
    from scipy import optimize

    def cost(vector: Floats) -> tuple[float, Floats]:
        moved = vector + _STEP * np.concatenate([np.zeros((1, _COUNT)), np.eye(_COUNT), -np.eye(_COUNT)])
        values = _costs(moved, start, y, inputs, hours)
        return float(values[0]), (values[1 : _COUNT + 1] - values[_COUNT + 1 :]) / (2.0 * _STEP)

    bounds = [(series - 8.0, series + 8.0) for series in start[:-1]]
    ends = (float(y.min() - 30.0), float(y.max() + 30.0))
    options = {"maxiter": 300, "ftol": 1e-11}
    begun = start if first is None else first
    return optimize.minimize(
        cost,
        begun,
        jac=True,
        method="L-BFGS-B",
        bounds=[*bounds, ends],
        options=options,  # type: ignore[call-overload]
    )


def _costs(vectors: Floats, start: Floats, y: Floats, inputs: Floats, hours: float) -> Floats:
    """Minus the log density of parameter vectors (M, P), shape (M,)."""
    weak = 0.5 * np.sum(((vectors - start) / _WEAK) ** 2, axis=1)
    with np.errstate(all="ignore"):
        values = weak - _filtered(vectors, y, inputs, hours)[0]
    return np.where(np.isfinite(values), values, _IMPOSSIBLE)


def _curvature(vector: Floats, start: Floats, y: Floats, inputs: Floats, hours: float) -> Floats:
    """Second derivatives of the cost, without directions of negative curvature."""
    h, eye = _CURVATURE_STEP, np.eye(_COUNT)
    pairs = [(i, j) for i in range(_COUNT) for j in range(i, _COUNT)]
    moved = [
        vector + h * (a * eye[i] + b * eye[j]) for i, j in pairs for a in (1.0, -1.0) for b in (1.0, -1.0)
    ]
    values = _costs(np.array(moved), start, y, inputs, hours).reshape(-1, 4)
    estimate = np.zeros((_COUNT, _COUNT))
    for (i, j), (both, plus, minus, neither) in zip(pairs, values, strict=True):
        estimate[i, j] = estimate[j, i] = (both - plus - minus + neither) / (4.0 * h * h)
    value, vector = np.linalg.eigh(estimate)
    return np.asarray((vector * np.maximum(value, _WEAK**-2)) @ vector.T)


def _discrete(vectors: Floats, hours: float) -> tuple[Floats, Floats, Floats]:
    """Transition (M, 2, 2), effect of inputs (M, 2, 3), covariance of the noise (M, 2, 2) of an interval."""
    from scipy.linalg import expm

    ci, ce, rie, reo, ai, ae, noise_i, noise_e = np.exp(vectors[:, :8]).T
    count = len(vectors)
    a, b, q = np.zeros((count, 2, 2)), np.zeros((count, 2, 3)), np.zeros((count, 2, 2))
    a[:, 0, 0], a[:, 0, 1] = -1.0 / (rie * ci), 1.0 / (rie * ci)
    a[:, 1, 0], a[:, 1, 1] = 1.0 / (rie * ce), -(1.0 / rie + 1.0 / reo) / ce
    b[:, 0, 1], b[:, 0, 2] = ai / ci, 1.0 / ci
    b[:, 1, 0], b[:, 1, 1] = 1.0 / (reo * ce), ae / ce
    q[:, 0, 0], q[:, 1, 1] = noise_i**2, noise_e**2
    with_inputs, with_noise = np.zeros((count, 5, 5)), np.zeros((count, 4, 4))
    with_inputs[:, :2, :2], with_inputs[:, :2, 2:] = a, b
    with_noise[:, :2, :2], with_noise[:, :2, 2:] = -a, q
    with_noise[:, 2:, 2:] = np.swapaxes(a, 1, 2)
    exponential, parts = expm(with_inputs * hours), expm(with_noise * hours)
    transition = np.swapaxes(parts[:, 2:, 2:], 1, 2)
    return transition, exponential[:, :2, 2:], transition @ parts[:, :2, 2:]


def _filtered(vectors: Floats, y: Floats, inputs: Floats, hours: float) -> tuple[Floats, Floats]:
    """Log likelihoods (M,) and standardized errors of prediction (n, M) by Kalman filters side by side."""
    f, g, q = _discrete(vectors, hours)
    noise = np.exp(2.0 * vectors[:, 8])
    driven = np.einsum("mij,kj->kim", g, inputs)
    x0, x1 = np.full(len(vectors), y[0]), vectors[:, 9].copy()
    p00, p01, p11 = noise.copy(), np.zeros_like(noise), np.full_like(noise, 0.5)
    errors, total = np.empty((y.size, len(vectors))), np.zeros(len(vectors))
    steady, s = False, noise
    for k in range(y.size):
        if k:
            x0, x1 = (
                f[:, 0, 0] * x0 + f[:, 0, 1] * x1 + driven[k - 1, 0],
                f[:, 1, 0] * x0 + f[:, 1, 1] * x1 + driven[k - 1, 1],
            )
        if not steady:
            if k:
                before = p00
                upper, two = f[:, 0, 0] * p00 + f[:, 0, 1] * p01, f[:, 0, 0] * p01 + f[:, 0, 1] * p11
                three, four = f[:, 1, 0] * p00 + f[:, 1, 1] * p01, f[:, 1, 0] * p01 + f[:, 1, 1] * p11
                p00 = upper * f[:, 0, 0] + two * f[:, 0, 1] + q[:, 0, 0]
                p01 = upper * f[:, 1, 0] + two * f[:, 1, 1] + q[:, 0, 1]
                p11 = three * f[:, 1, 0] + four * f[:, 1, 1] + q[:, 1, 1]
            previous, s = s, p00 + noise
            gain0, gain1 = p00 / s, p01 / s
            p00, p01, p11 = p00 - gain0 * p00, p01 - gain0 * p01, p11 - gain1 * p01
            if k:
                steady = bool(np.max(np.abs(p00 - before) / s + np.abs(s - previous) / s) < _STEADY)
            root, log = np.sqrt(s), np.log(2.0 * np.pi * s)
        error = y[k] - x0
        x0, x1 = x0 + gain0 * error, x1 + gain1 * error
        errors[k] = error / root
        total -= 0.5 * (log + errors[k] ** 2)
    return total, errors


def _derived(vectors: Floats) -> Floats:
    """Loss [W/K], aperture [m2], capacity [Wh/K], short and long time constant [h]; shape (M, 5)."""
    ci, ce, rie, reo, ai, ae = np.exp(vectors[:, :6]).T
    trace = 1.0 / (rie * ci) + (1.0 / rie + 1.0 / reo) / ce
    determinant = 1.0 / (rie * ci * reo * ce)
    root = np.sqrt(np.maximum(0.25 * trace**2 - determinant, 0.0))
    fast = 0.5 * trace + root
    aperture = ai + ae * reo / (rie + reo)
    return np.stack([1.0 / (rie + reo), aperture, ci + ce, 1.0 / fast, fast / determinant], axis=1)
