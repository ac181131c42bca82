"""Profile likelihood: how much worse the fit becomes when one parameter is fixed.

Where a profile is a parabola, the interval from the covariance is right; where it is flat on one side, the
data bound the parameter on the other side only. The likelihood is that of independent errors, scaled
parameter by parameter so that its curvature at the minimum gives the covariance estimated from the
autocorrelated residuals; the limit is the square of the quantile of the intervals.

All points of all profiles are minimized side by side, each with its own Jacobian, which is first that at the
minimum and is updated at every step (Broyden).

References
----------
Raue A. et al. (2009), Bioinformatics 25, 1923. https://doi.org/10.1093/bioinformatics/btp358
Broyden C.G. (1965), Math. Comp. 19, 577. https://doi.org/10.1090/S0025-5718-1965-0198670-6
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.cost import Cost
from mascarin.calibration.errors.joint_estimation import METHOD
from mascarin.calibration.methods.least_squares import derivative, scale_of
from mascarin.errors import InputError, did_you_mean
from mascarin.figures import calibration as figures

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mascarin.calibration.base.result import Calibration

Floats = NDArray[np.float64]

_GRID_REACH: Final = 1.6  # intervals to each side
_MAX_EXTENSIONS: Final = 8  # of a grid whose profile stays below the limit
_MAX_STEPS: Final = 25
_MIN_GAIN: Final = 1e-3  # change of the deviance below which a point ends, in squared quantiles
_DIFFERENCE: Final = 1e-4


@dataclass(frozen=True, eq=False)
class Profile:
    """Profile likelihood of one parameter.

    Attributes
    ----------
    path, unit : str
        The parameter.
    estimate : float
        Its estimate. [unit]
    values : ndarray, shape (K,)
        Where it was fixed, ascending. [unit]
    rise : ndarray, shape (K,)
        Twice the decrease of the log-likelihood there, scaled for the autocorrelation. [-]
    parameter_values : ndarray, shape (K, P)
        All parameters there. [unit of each]
    limit : float
        Of the rise within the interval. [-]
    low, high : float
        Interval; the end of the range where the profile stays below the limit up to it. [unit]
    open_low, open_high : bool
        Whether the interval ends only because the range does.

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, profiles, solve
    >>> measured = 20.0 + 0.1 * np.random.default_rng(1).normal(size=48)
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 10.0, 30.0),),
    ...     (FitSensor("room", measured, 0.1),),
    ...     lambda x: np.tile(x[:, :, None], (1, 48, 1)),
    ... )
    >>> one = profiles(solve(problem))[0]
    >>> one.open_low, one.open_high
    (False, False)
    """

    path: str
    unit: str
    estimate: float
    values: Floats
    rise: Floats
    parameter_values: Floats
    limit: float
    low: float
    high: float
    open_low: bool
    open_high: bool

    @property
    def words(self) -> str:
        """Statement of the profile; empty when the data bound the parameter on both sides."""
        if self.open_low and self.open_high:
            return f"{self.path}: the data bound it on neither side"
        if self.open_low or self.open_high:
            side, end = ("below", self.low) if self.open_low else ("above", self.high)
            where = f"{end:g} {self.unit}".rstrip(" -")
            return (
                f"{self.path}: the data do not bound it {side}; the interval ends with the range at {where}"
            )
        return ""

    def plot(self, *, ax: Axes) -> Axes:
        """Draw the profile with its limit and interval.

        Parameters
        ----------
        ax : matplotlib.axes.Axes
            Where to draw.

        Returns
        -------
        matplotlib.axes.Axes
        """
        figures.profile(
            ax,
            self.values,
            self.rise,
            limit=self.limit,
            low=self.low,
            high=self.high,
            estimate=self.estimate,
        )
        ax.set_title(self.path, fontsize=8, loc="left")
        ax.set_xlabel(f"[{self.unit or '-'}]", fontsize=8)
        return ax


def plot_profiles(profiles: Sequence[Profile], *, columns: int = 3) -> Figure:
    """Draw several profiles in one figure.

    Parameters
    ----------
    profiles : sequence of Profile
        From `profiles`.
    columns : int
        Panels side by side. [-]

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each profile.

    Raises
    ------
    InputError
        There is no profile.

    Examples
    --------
    >>> one = Profile(
    ...     "level", "m", 2.0, np.array([1.0, 2.0, 3.0]), np.array([4.0, 0.0, 4.0]), np.zeros((3, 1)),
    ...     limit=3.84, low=1.02, high=2.98, open_low=False, open_high=False,
    ... )
    >>> len(plot_profiles([one]).axes)
    1
    """
    from mascarin.figures.shown import new_figure

    if not profiles:
        raise InputError("found no profile to draw, expected at least one")
    columns = min(columns, len(profiles))
    rows = math.ceil(len(profiles) / columns)
    figure = new_figure(3.2 * columns, 2.4 * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, profile in zip(panels, profiles, strict=False):
        profile.plot(ax=axes)
    for axes in panels[len(profiles) :]:
        axes.set_visible(False)
    for k in range(0, len(profiles), columns):
        panels[k].set_ylabel("increase of the deviance", fontsize=8)
    return figure


def profiles(
    fit: Calibration, paths: Sequence[str] | None = None, *, points: int = 11, batch: int = 64
) -> list[Profile]:
    """Compute profile likelihoods about the minimum of a calibration.

    Parameters
    ----------
    fit : Calibration
        By any method with the cost ``nll``.
    paths : sequence of str, optional
        Parameters; all when absent.
    points : int
        Number of values at which each is fixed. [-]
    batch : int
        Largest number of parameter vectors in one call of the model. [-]

    Returns
    -------
    list of Profile
        In the order of the paths.

    Raises
    ------
    InputError
        Another cost than ``nll``, a calibration together with errors of sensors, an unknown parameter, or
        fewer than 5 points.

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, solve
    >>> measured = 20.0 + 0.1 * np.random.default_rng(1).normal(size=48)
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 10.0, 30.0),),
    ...     (FitSensor("room", measured, 0.1),),
    ...     lambda x: np.tile(x[:, :, None], (1, 48, 1)),
    ... )
    >>> found = profiles(solve(problem))[0]
    >>> bool(found.low < 20.0 < found.high), found.words
    (True, '')
    """
    if fit.cost_name != "nll":
        msg = f"a profile needs a likelihood: found the cost '{fit.cost_name}', expected 'nll'"
        raise InputError(msg)
    if fit.uncertainty_method.startswith(METHOD):
        raise InputError(
            "a profile holds the errors of the sensors and of the model at zero: found a calibration "
            "together with these errors, expected one without; its intervals account for them already. For a "
            "profile state offset=0 for every sensor"
        )
    if points < 5:
        msg = f"points: found {points}, expected at least 5"
        raise InputError(msg)
    fitted_paths = fit.problem.paths
    profiled = fitted_paths if paths is None else tuple(paths)
    for path in profiled:
        if path not in fitted_paths:
            raise InputError(f"profile: '{path}' was not estimated. {did_you_mean(path, fitted_paths)}")
    search = _Search(fit, batch)
    fixed = [fitted_paths.index(path) for path in profiled]
    grids = [_grid(fit, i, points) for i in fixed]
    pieces = [(np.empty(0), np.empty((0, len(fitted_paths))), np.empty(0))] * len(fixed)
    for _ in range(_MAX_EXTENSIONS):
        z, rise = search.minima(np.repeat(fixed, [grid.size for grid in grids]), np.concatenate(grids))
        ends = np.cumsum([grid.size for grid in grids])[:-1]
        parts = zip(grids, np.split(z, ends), np.split(rise, ends), strict=True)
        pieces = [_joined(old, new) for old, new in zip(pieces, parts, strict=True)]
        grids = [_further(fit, i, *piece) for i, piece in zip(fixed, pieces, strict=True)]
        if not any(grid.size for grid in grids):
            break
    return [_profile(fit, i, *piece) for i, piece in zip(fixed, pieces, strict=True)]


_Piece = tuple[Floats, Floats, Floats]
"""Fixed positions of a parameter (K,), all positions there (K, P), and the rise (K,)."""


def _joined(old: _Piece, new: _Piece) -> _Piece:
    """Join both in ascending order of the fixed position."""
    order = np.argsort(np.concatenate([old[0], new[0]]), kind="stable")
    a, b, c = (np.concatenate(pair)[order] for pair in zip(old, new, strict=True))
    return a, b, c


def _further(fit: Calibration, i: int, grid: Floats, _: Floats, rise: Floats) -> Floats:
    """Points at twice the distance, where a profile is below the limit and the range has not ended."""
    center = float(fit.problem.positions(fit.x)[i])
    limit = float(fit.uncertainty.quantile[i] ** 2)
    return np.array(
        [
            min(max(center + 2.0 * (grid[end] - center), 0.0), 1.0)
            for end in (0, -1)
            if rise[end] <= limit and 0.0 < grid[end] < 1.0
        ]
    )


def _grid(fit: Calibration, i: int, points: int) -> Floats:
    """Fixed positions of a parameter: about the estimate, to beyond its interval."""
    center = float(fit.problem.positions(fit.x)[i])
    uncertainty = fit.uncertainty
    reach = _GRID_REACH * float(uncertainty.quantile[i]) * math.sqrt(max(uncertainty.covariance[i, i], 0.0))
    reach = min(max(reach, 1e-9), 1.0)
    side = np.linspace(0.0, 1.0, points // 2 + 1)[1:]
    grid = np.concatenate([center - reach * side[::-1], [center], center + reach * side])
    return np.unique(np.clip(grid, 0.0, 1.0))


class _Search:
    """Minimizes over the other parameters at many points at once."""

    def __init__(self, fit: Calibration, batch: int) -> None:
        problem = fit.problem
        self._problem, self._batch = problem, batch
        self._cost = Cost(problem, "nll")
        self._scale = scale_of(problem)
        self._center = problem.positions(fit.x)
        self._limit = fit.uncertainty.quantile**2
        _, jacobian = derivative(problem, self._center, _DIFFERENCE)
        self._r = self._weighted(self._center[None])[0]
        data = jacobian[problem.mask] * self._scale[:, None]
        priors = self._cost.prior_slopes(self._center)
        self._j = np.concatenate([data, priors])
        information = self._j.T @ self._j
        variance = np.diag(np.linalg.pinv(information))
        # By how much the autocorrelation reduces the information on each parameter.
        self._weight = variance / np.maximum(np.diag(fit.uncertainty.covariance), 1e-300)
        self._lowest = float(self._r @ self._r)

    def minima(self, fixed: NDArray[np.int64], fixed_values: Floats) -> tuple[Floats, Floats]:
        """Return positions (N, P) of the lowest cost with one parameter fixed, and the scaled rise (N,)."""
        count = len(fixed)
        z = np.tile(self._center, (count, 1))
        jacobians = np.tile(self._j, (count, 1, 1))
        rows = np.arange(count)
        moved = np.zeros_like(z)
        moved[rows, fixed] = fixed_values - self._center[fixed]
        for k in range(count):
            free = self._free_indices(int(fixed[k]))
            follow = -np.linalg.lstsq(self._j[:, free], self._j[:, fixed[k]])[0] * moved[k, fixed[k]]
            moved[k, free] = np.clip(z[k, free] + follow, 0.0, 1.0) - z[k, free]
        z = z + moved
        z[rows, fixed] = fixed_values
        r = self._weighted(z)
        for k in range(count):
            _update(jacobians[k], r[k] - self._r, moved[k])
        damping = np.zeros(count)
        active = np.ones(count, dtype=np.bool_)
        for _ in range(_MAX_STEPS):
            todo = np.flatnonzero(active)
            if not todo.size:
                break
            trial = np.array([self._step(z[k], r[k], jacobians[k], int(fixed[k]), damping[k]) for k in todo])
            trial_residuals = self._weighted(trial)
            for n, k in enumerate(todo.tolist()):
                step = trial[n] - z[k]
                if np.any(step != 0.0) and np.isfinite(trial_residuals[n]).all():
                    _update(jacobians[k], trial_residuals[n] - r[k], step)
                gain = float(r[k] @ r[k] - trial_residuals[n] @ trial_residuals[n]) * self._weight[fixed[k]]
                if gain > 0.0:
                    z[k], r[k] = trial[n], trial_residuals[n]
                    damping[k] /= 10.0
                else:
                    damping[k] = max(10.0 * damping[k], 1e-3)
                improved = gain > _MIN_GAIN * self._limit[fixed[k]]
                active[k] = improved or (gain <= 0.0 and 0.0 < damping[k] < 1.0)
        risen = (np.einsum("ni,ni->n", r, r) - self._lowest) * self._weight[fixed]
        # A value at which the model cannot be run is outside.
        return z, np.where(np.isnan(risen), np.inf, np.maximum(risen, 0.0))

    def _step(self, z: Floats, r: Floats, jacobian: Floats, fixed: int, damping: float) -> Floats:
        """Take a damped Gauss-Newton step within the range; what would leave it at a bound stays."""
        slope = jacobian.T @ r
        free = self._free_indices(fixed)
        stuck = ((z <= 0.0) & (slope > 0.0)) | ((z >= 1.0) & (slope < 0.0))
        free = free[~stuck[free]]
        square = jacobian[:, free].T @ jacobian[:, free]
        damped = square + damping * np.diag(np.diag(square))
        new = z.copy()
        new[free] = np.clip(z[free] - np.linalg.pinv(damped, hermitian=True) @ slope[free], 0.0, 1.0)
        return new

    def _free_indices(self, fixed: int) -> NDArray[np.int64]:
        return np.delete(np.arange(self._center.size), fixed)

    def _weighted(self, z: Floats) -> Floats:
        """Return residuals over their uncertainty, then those of the priors, for positions (N, P)."""
        batches = []
        for first in range(0, len(z), self._batch):
            x = self._problem.values(z[first : first + self._batch])
            data = self._problem.residuals(x)[:, self._problem.mask] * self._scale
            batches.append(np.concatenate([data, self._cost.prior_residuals(x)], axis=1))
        return np.concatenate(batches)


def _update(jacobian: Floats, change: Floats, step: Floats) -> None:
    """Update the Jacobian in place by Broyden's formula."""
    square = float(step @ step)
    if square > 0.0:
        jacobian += np.outer((change - jacobian @ step) / square, step)


def _profile(fit: Calibration, i: int, grid: Floats, z: Floats, rise: Floats) -> Profile:
    parameter = fit.problem.parameters[i]
    limit = float(fit.uncertainty.quantile[i] ** 2)
    middle = int(np.argmin(rise))
    low, open_low = _crossing(grid[middle::-1], rise[middle::-1], limit)
    high, open_high = _crossing(grid[middle:], rise[middle:], limit)
    return Profile(
        path=parameter.path,
        unit=parameter.unit,
        estimate=float(fit.x[i]),
        values=np.array([parameter.value(float(v)) for v in grid]),
        rise=rise,
        parameter_values=fit.problem.values(z),
        limit=limit,
        low=parameter.value(low),
        high=parameter.value(high),
        open_low=open_low,
        open_high=open_high,
    )


def _crossing(grid: Floats, rise: Floats, limit: float) -> tuple[float, bool]:
    """Where the profile crosses the limit, going outward; the root of the rise is nearly linear."""
    above = np.flatnonzero(rise > limit)
    if not above.size:
        return float(grid[-1]), True
    k = int(above[0])
    if k == 0:
        return float(grid[0]), False
    a, b = math.sqrt(rise[k - 1]), math.sqrt(rise[k])
    part = (math.sqrt(limit) - a) / (b - a)
    return float(grid[k - 1] + part * (grid[k] - grid[k - 1])), False
