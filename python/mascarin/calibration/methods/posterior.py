"""Sample of the posterior distribution of the parameters, by emcee.

The likelihood of independent errors gives intervals that are much too narrow where errors are autocorrelated.
Here its shape is kept, but it is scaled about its maximum z0. Its curvature at z0 then gives the covariance
estimated from the autocorrelated residuals. At a position z the likelihood is evaluated at
``z0 + C (z - z0)``. C is the symmetric matrix for which ``C H C`` is the inverse of that covariance, and H is
the curvature for independent errors. Priors, and the uniform prior over the range, are not scaled.

References
----------
Goodman J., Weare J. (2010), Comm. App. Math. Comp. Sci. 5, 65. https://doi.org/10.2140/camcos.2010.5.65
Foreman-Mackey D. et al. (2013), emcee, PASP 125, 306. https://doi.org/10.1086/670067
Ribatet M., Cooley D., Davison A.C. (2012), Statistica Sinica 22, 813 (adjusted likelihood).
https://doi.org/10.5705/ss.2009.248
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.uncertainty import symmetric_power
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.calibration.base.evaluations import Evaluator
    from mascarin.calibration.base.problem import CalibrationProblem
    from mascarin.calibration.base.result import Calibration
    from mascarin.calibration.base.search_options import SearchOptions

Floats = NDArray[np.float64]

METHOD: Final = (
    "quantiles of a posterior sample (emcee), its likelihood scaled to the covariance estimated from the "
    "autocorrelated residuals; the estimates are the most probable values"
)
"""How the intervals are computed, for reports."""

_BURN_IN: Final = 0.2  # part of the moves that is discarded
_LONG_ENOUGH: Final = 50.0  # autocorrelation times
_MIN_WALKERS: Final = 32
_MAX_START_SPREAD: Final = 0.2  # of the range, standard deviation of the first positions


def sampled(fit: Calibration, evaluator: Evaluator, options: SearchOptions) -> Calibration:
    """Replace the intervals and correlations of a calibration by those of a posterior sample.

    Parameters
    ----------
    fit : Calibration
        By least squares, at the most probable values.
    evaluator : Evaluator
        Evaluates and keeps the record.
    options : SearchOptions
        Number of walkers and moves.

    Returns
    -------
    Calibration

    Raises
    ------
    InputError
        The package emcee is not installed, or there are too few walkers.
    """
    emcee = _emcee()
    problem = fit.problem
    count = len(problem.parameters)
    walkers = options.walkers if options.walkers is not None else max(2 * count, _MIN_WALKERS)
    if walkers < 2 * count:
        msg = f"walkers: found {walkers}, expected at least {2 * count} for {count} parameters"
        raise InputError(msg)
    target = _Posterior(fit, evaluator)
    sampler = emcee.EnsembleSampler(walkers, count, target, vectorize=True)
    first = emcee.State(
        target.first_positions(walkers, fit.seed),
        random_state=np.random.RandomState(fit.seed % 2**32).get_state(),
    )
    sampler.run_mcmc(first, options.moves)
    discard = int(_BURN_IN * options.moves)
    chain = np.asarray(sampler.get_chain(discard=discard, flat=True), dtype=np.float64)
    times = np.asarray(sampler.get_autocorr_time(discard=discard, quiet=True, tol=0.0), dtype=np.float64)
    return _with_sample(fit, evaluator, problem, chain, times, options.moves - discard)


class _Posterior:
    """Logarithm of the density at positions between 0 and 1."""

    def __init__(self, fit: Calibration, evaluator: Evaluator) -> None:
        self._problem = fit.problem
        self._evaluator = evaluator
        self._covariance = fit.uncertainty.covariance
        self._center = fit.problem.positions(fit.x)
        self._stretch = fit.uncertainty.stretch
        self._highest = float(evaluator.of_sensors(fit.x[None]).sum())

    def __call__(self, z: Floats) -> Floats:
        """Return the log density at positions (M, P), shape (M,)."""
        density = np.full(len(z), -np.inf)
        inside = np.all((z >= 0.0) & (z <= 1.0), axis=1)
        if inside.any():
            valid = z[inside]
            stretched = np.clip(self._center + (valid - self._center) @ self._stretch, 0.0, 1.0)
            data = self._evaluator.of_sensors(self._problem.values(stretched)).sum(axis=1) - self._highest
            prior = self._evaluator.cost.prior_residuals(self._problem.values(valid))
            log_density = -data - 0.5 * np.sum(prior**2, axis=1)
            density[inside] = np.where(np.isfinite(log_density), log_density, -np.inf)
        return density

    def first_positions(self, walkers: int, seed: int) -> Floats:
        """Draw the first positions of the walkers: about the maximum, within the range."""
        sd = np.sqrt(np.diag(self._covariance))
        shrink = np.minimum(1.0, _MAX_START_SPREAD / np.maximum(sd, 1e-300))
        root = symmetric_power(self._covariance * np.outer(shrink, shrink), 0.5)
        normal = np.random.default_rng([seed, walkers]).standard_normal((walkers, self._center.size))
        z = self._center + normal @ root
        # Reflected at the bounds, so that no two walkers are on the same bound.
        return np.asarray(np.clip(1.0 - np.abs(1.0 - np.abs(z)), 1e-6, 1.0 - 1e-6))


def _with_sample(
    fit: Calibration,
    evaluator: Evaluator,
    problem: CalibrationProblem,
    chain: Floats,
    times: Floats,
    moves: int,
) -> Calibration:
    tail = 0.5 * (1.0 - fit.confidence)
    low, high = np.quantile(chain, [tail, 1.0 - tail], axis=0)
    correlation = np.atleast_2d(np.corrcoef(chain, rowvar=False))
    longest = float(np.max(times)) if np.isfinite(times).all() else float("inf")
    notes = list(fit.warnings)
    if moves < _LONG_ENOUGH * longest:
        notes.append(
            f"the posterior sample is short: {moves} moves are {moves / longest:.0f} autocorrelation times, "
            f"expected {_LONG_ENOUGH:.0f} at least; increase moves"
        )
    walkers = len(chain) // moves
    return replace(
        fit,
        low=problem.values(low[None])[0],
        high=problem.values(high[None])[0],
        correlation=np.asarray(correlation, dtype=np.float64),
        uncertainty=replace(
            fit.uncertainty,
            low=low,
            high=high,
            sd=chain.std(axis=0),
            correlation=np.asarray(correlation, dtype=np.float64),
            covariance=np.atleast_2d(np.cov(chain, rowvar=False)),
        ),
        uncertainty_method=METHOD,
        reason=f"{fit.reason}; {walkers} walkers moved {moves} times each",
        samples=problem.values(chain),
        trace=evaluator.trace(),
        warnings=tuple(notes),
    )


def _emcee() -> Any:
    try:
        import emcee
    except ImportError as error:
        msg = "the method 'emcee' needs the package emcee: pip install 'mascarin[bayes]'"
        raise InputError(msg) from error
    return emcee
