"""RBD-FAST, Sobol's indices and Morris' screening by SALib, on our plans and with our intervals.

SALib draws the samples on the unit cube and gives the indices of each replicate. Ours are the ranges and
distributions, the reduction of series to few numbers, and the intervals: several independent replicates are
made, and the intervals come from leaving out one at a time. SALib's own intervals are not used: its
maintainers disown those of FAST (SALib issues 649 and 684), and a bootstrap of one quasi-random sample takes
for chance what is design.

Series. Shares are sums over time of a part of the variance, divided by the sum of the variance. Such a sum
does not change when the times are rotated into principal components, of which few hold nearly all of the
variance; so each index is computed for these few alone. What they leave out (1e-6 of the variance in the
first replicate) counts as not explained.

References
----------
Herman J., Usher W. (2017), SALib, J. Open Source Softw. 2(9), 97. https://doi.org/10.21105/joss.00097
Tarantola S., Gatelli D., Mara T.A. (2006), RBD-FAST. https://doi.org/10.1016/j.ress.2005.06.003
Tissot J.-Y., Prieur C. (2012), its bias. https://doi.org/10.1016/j.ress.2012.06.010
Saltelli A. et al. (2010), Sobol's indices. https://doi.org/10.1016/j.cpc.2009.09.018
Morris M.D. (1991), elementary effects. https://doi.org/10.1080/00401706.1991.10484804
Sobol' I.M., Kucherenko S. (2009), squared derivatives bound total indices.
https://doi.org/10.1016/j.matcom.2009.01.023
"""

from __future__ import annotations

import importlib
import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.factors import Factor, Floats, check_factors, grouped
from mascarin.sensitivity.jackknife import Ratio, above_zero, interval
from mascarin.sensitivity.result import VARIANCE, Sensitivity
from mascarin.sensitivity.runs import Collector

SalibName = Literal["rbd-fast", "sobol", "morris"]

SQUARES: Final = (
    "part of the squared elementary effects: equal to the share of the variance where the model is linear, a "
    "screening number elsewhere"
)
"""What the share of Morris' method is."""

SAMPLES: Final = {"rbd-fast": 512, "sobol": 64, "morris": 4}
"""Usual size of a replicate: runs, base points, trajectories. [-]"""

_LEVELS: Final = 4
_LEFT_OUT: Final = 1e-6
_ORDER: Final = 4


@dataclass(frozen=True, eq=False)
class SalibPlan:
    """Runs of a method of SALib.

    Attributes
    ----------
    method : str
        ``rbd-fast``, ``sobol`` or ``morris``.
    factors : tuple of Factor, length P
        What varies.
    groups : tuple of str, length G
        What is judged.
    group_of : ndarray of int, shape (P,)
        Group of each factor.
    replicates : int
        Number of independent samples. [-]
    size : int
        RBD-FAST: runs of a replicate; Sobol: its base points, G + 2 runs each; Morris: its trajectories,
        G + 1 runs each. [-]
    order : int
        RBD-FAST: harmonics counted as a parameter's own. [-]
    seed : int
        Of the random numbers.
    """

    method: SalibName
    factors: tuple[Factor, ...]
    groups: tuple[str, ...]
    group_of: NDArray[np.int64]
    replicates: int
    size: int
    order: int
    seed: int

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the factors, the columns of the samples."""
        return tuple(factor.path for factor in self.factors)

    @property
    def runs(self) -> int:
        """Runs per replicate. [-]"""
        return (
            self.size
            * {"rbd-fast": 1, "sobol": len(self.groups) + 2, "morris": len(self.groups) + 1}[self.method]
        )

    def __len__(self) -> int:
        """Number of runs in all replicates. [-]"""
        return self.replicates * self.runs

    def samples(self, replicate: int) -> Floats:
        """Parameter values of one replicate, shape (N, P). [unit of each parameter]

        Raises
        ------
        InputError
            When a distribution of the user gives no finite value.
        """
        u = self.unit_samples(replicate)
        values = np.column_stack([factor.quantile(u[:, i]) for i, factor in enumerate(self.factors)])
        bad = np.argwhere(~np.isfinite(values))
        if bad.size:
            row, i = bad[0]
            msg = (
                f"{self.factors[i].path}: its distribution gives {values[row, i]} at the probability "
                f"{u[row, i]:g}; a distribution must be finite from 0 to 1"
            )
            raise InputError(msg)
        return values

    def unit_samples(self, replicate: int) -> Floats:
        """The same as probabilities, on the unit cube. [-]"""
        # A generator of our own: with a seed of 0, or none, SALib would draw from numpy's global state.
        rng = np.random.default_rng([self.seed, replicate])
        if self.method == "rbd-fast":
            drawn = _salib("sample.latin").sample(self.problem, self.size, seed=rng)
        elif self.method == "sobol":
            drawn = _salib("sample.sobol").sample(self.problem, self.size, calc_second_order=False, seed=rng)
        else:
            drawn = _salib("sample.morris").sample(self.problem, self.size, num_levels=_LEVELS, seed=rng)
        return np.asarray(drawn, dtype=np.float64)

    @property
    def problem(self) -> dict[str, Any]:
        """The factors as SALib names them; a fresh one, for SALib writes into it."""
        problem: dict[str, Any] = {
            "num_vars": len(self.factors),
            "names": list(self.paths),
            "bounds": [[0.0, 1.0]] * len(self.factors),
        }
        if len(self.groups) < len(self.factors):
            problem["groups"] = [self.groups[g] for g in self.group_of]
        return problem

    def collector(self, outputs: Sequence[str], units: Sequence[str] | None = None) -> SalibCollector:
        """What takes the outputs of the runs and analyses them."""
        return SalibCollector(self, outputs, units=units)


def plan(
    factors: Sequence[Factor],
    method: SalibName,
    *,
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
) -> SalibPlan:
    """Runs of a method of SALib.

    Parameters
    ----------
    factors : sequence of Factor
        What varies.
    method : str
        ``rbd-fast``, ``sobol`` or ``morris``.
    replicates : int
        Number of independent samples, at least 3. [-]
    samples : int, optional
        Size of a replicate, see `SalibPlan`; for Sobol a power of 2. [-]
    order : int, optional
        RBD-FAST: harmonics counted as a parameter's own, 4 when absent. [-]
    seed : int
        Of the random numbers.

    Raises
    ------
    InputError
        SALib is not installed; numbers or groups that the method cannot use.
    """
    _salib("sample")
    checked = check_factors(factors)
    names, group_of = grouped(checked)
    if replicates < 3:
        msg = f"replicates: found {replicates}, expected at least 3: intervals come from their spread"
        raise InputError(msg)
    harmonics = _ORDER if order is None else order
    size = samples if samples is not None else SAMPLES[method]
    if method == "rbd-fast":
        if len(names) < len(checked):
            msg = "rbd-fast judges single parameters; leave the groups out, or choose spectral, sobol, morris"
            raise InputError(msg)
        if harmonics < 1 or size <= 4 * harmonics**2:
            msg = (
                f"samples: found {size} runs for {harmonics} harmonics, expected more than 4 M^2 = "
                f"{4 * harmonics**2}"
            )
            raise InputError(msg)
    elif order is not None:
        msg = f"order: the method {method} has no harmonics; leave it out"
        raise InputError(msg)
    if method == "sobol" and (size < 2 or size & (size - 1)):
        msg = f"samples: found {size}, expected a power of 2: Sobol's sequence is balanced at those alone"
        raise InputError(msg)
    if method == "morris" and (size < 2 or len(names) < 2):
        msg = f"morris: found {size} trajectories of {len(names)} parameters, expected at least 2 of 2"
        raise InputError(msg)
    return SalibPlan(method, checked, names, group_of, replicates, size, harmonics, seed)


@dataclass(frozen=True, eq=False)
class _Part:
    """What is kept of one replicate: `first`, `total` (G, S) parts of `variance` (S,), `effect` (G, S)."""

    first: Floats
    total: Floats
    variance: Floats
    effect: Floats


class SalibCollector(Collector[SalibPlan, Sensitivity]):
    """Takes the outputs of a plan's runs as they come and keeps the indices of each replicate.

    Parameters
    ----------
    plan : SalibPlan
        The runs.
    outputs : sequence of str, length S
        Output names.
    units : sequence of str, length S, optional
        Their units.
    """

    def __init__(
        self, plan: SalibPlan, outputs: Sequence[str], *, units: Sequence[str] | None = None
    ) -> None:
        super().__init__(plan, outputs, units=units)
        self._estimator = _ESTIMATORS[plan.method](plan)
        self._bases: list[Floats] = []
        self._parts: list[_Part] = []
        self._scale = np.zeros(len(self.outputs))

    def _take(self, replicate: int, y: Floats) -> None:
        if not self._bases:
            self._bases = [_components(y[:, :, s]) for s in range(len(self.outputs))]
        u = self.plan.unit_samples(replicate)
        columns = [self._estimator.part(u, y[:, :, s], self._bases[s]) for s in range(len(self.outputs))]
        first, total, variance, effect = (np.stack(values, axis=-1) for values in zip(*columns, strict=True))
        self._scale = np.maximum(self._scale, np.abs(y).max(axis=(0, 1)))
        self._parts.append(_Part(first, total, variance, effect))

    def _result(self, confidence: float) -> Sensitivity:
        plan, parts = self.plan, self._parts
        strict = 1.0 - (1.0 - confidence) / len(plan.groups)
        variance = Ratio.mean(np.stack([part.variance for part in parts]))
        # Rounding is no variance.
        still = variance.value <= (1e-12 * self._scale) ** 2 + np.finfo(float).tiny
        first = Ratio.mean(np.stack([part.first for part in parts]))
        shares = [np.where(still, 0.0, array) for array in interval(first, variance, confidence)]
        sure = ~still & above_zero(first, variance, strict)
        totals: list[Floats] = []
        if plan.method == "sobol":
            total = Ratio.mean(np.stack([part.total for part in parts]))
            totals = [np.where(still, 0.0, array) for array in interval(total, variance, confidence)]
        return Sensitivity(
            method=plan.method,
            names=plan.groups,
            outputs=self.outputs,
            units=self.units,
            share=shares[0],
            low=shares[1],
            high=shares[2],
            effect=np.mean([part.effect for part in parts], axis=0),
            significant=sure & (shares[0] > 1e-12),
            confidence=confidence,
            runs=len(plan),
            seed=plan.seed,
            warnings=tuple(
                f"'{output}' does not depend on any of the varied parameters"
                for output, none in zip(self.outputs, still, strict=True)
                if none
            ),
            measure=SQUARES if plan.method == "morris" else VARIANCE,
            total=totals[0] if totals else None,
            total_low=totals[1] if totals else None,
            total_high=totals[2] if totals else None,
        )


class _Estimator(ABC):
    """Indices of one replicate and output."""

    def __init__(self, plan: SalibPlan) -> None:
        self.plan = plan

    @abstractmethod
    def part(self, u: Floats, y: Floats, basis: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """First-order and total part (G,), variance () and effect (G,) of outputs y (N, T)."""

    def _slopes(self, u: Floats, y: Floats) -> Floats:
        """Change of the mean over time over the range, by regression on one parameter; NaN for groups."""
        slopes = np.full(len(self.plan.groups), np.nan)
        mean = y.mean(axis=1)
        for g in np.flatnonzero(np.bincount(self.plan.group_of) == 1):
            i = int(np.flatnonzero(self.plan.group_of == g)[0])
            factor = self.plan.factors[i]
            x = factor.quantile(u[:, i])
            centred = x - x.mean()
            slopes[g] = (factor.high - factor.low) * float(centred @ mean) / float(centred @ centred)
        return slopes


class _RbdFast(_Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        first = np.zeros(len(self.plan.groups))
        for component in (y @ basis).T:
            found = _salib("analyze.rbd_fast").analyze(
                self.plan.problem, u, component, M=self.plan.order, num_resamples=2, seed=_unused()
            )
            first += np.array(found["S1"], dtype=np.float64) * component.var()
        return first, first, np.asarray(y.var(axis=0).sum()), self._slopes(u, y)


class _Sobol(_Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        # The rows of a base point: A, then A with one column of B each, then B.
        step = len(self.plan.groups) + 2
        free = np.r_[np.arange(0, len(y), step), np.arange(step - 1, len(y), step)]
        first, total = np.zeros(step - 2), np.zeros(step - 2)
        for component in (y @ basis).T:
            if np.ptp(component) == 0.0:
                continue
            found = _salib("analyze.sobol").analyze(
                self.plan.problem, component, calc_second_order=False, num_resamples=2, seed=_unused()
            )
            size = component[free].var()
            first += np.asarray(found["S1"]) * size
            total += np.asarray(found["ST"]) * size
        return first, total, np.asarray(y[free].var(axis=0).sum()), self._slopes(u[free], y[free])


class _Morris(_Estimator):
    def part(self, u: Floats, y: Floats, basis: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        single = np.bincount(self.plan.group_of) == 1
        squares = (self._squares if single.all() else self._squares_of_groups)(u, y @ basis)
        effect = np.array(self._effects(u, y.mean(axis=1))["mu"], dtype=np.float64)
        # The effects of a group's members have signs of their own.
        effect[~single] = np.nan
        return squares, squares, np.asarray(squares.sum()), effect

    def _squares(self, u: Floats, components: Floats) -> Floats:
        """Mean squared effect (G,), summed over the components (N, K), from mean and spread."""
        if not components.shape[1]:
            return np.zeros(len(self.plan.groups))
        count = self.plan.size
        found = [self._effects(u, component) for component in components.T]
        mean, spread = (np.array([f[key] for f in found], dtype=np.float64) for key in ("mu", "sigma"))
        return np.asarray(np.sum(mean**2 + spread**2 * (count - 1) / count, axis=0))

    def _squares_of_groups(self, u: Floats, components: Floats) -> Floats:
        """The same from one trajectory after the other: groups have no spread in SALib."""
        step, count = len(self.plan.groups) + 1, self.plan.size
        squares = np.zeros(step - 1)
        for k in range(count):
            rows = slice(k * step, (k + 1) * step)
            for component in components[rows].T:
                squares += np.array(self._effects(u[rows], component)["mu_star"]) ** 2 / count
        return squares

    def _effects(self, u: Floats, y: Floats) -> Any:
        with warnings.catch_warnings():
            # The spread of the effects of a single trajectory, which is not used.
            warnings.simplefilter("ignore", RuntimeWarning)
            return _salib("analyze.morris").analyze(
                self.plan.problem, u, y, num_resamples=2, num_levels=_LEVELS, seed=_unused()
            )


_ESTIMATORS: Final[dict[SalibName, type[_Estimator]]] = {
    "rbd-fast": _RbdFast,
    "sobol": _Sobol,
    "morris": _Morris,
}


def _components(y: Floats) -> Floats:
    """Orthonormal directions (T, K) in time that hold all but a millionth of the variance of y (N, T)."""
    centred = y - y.mean(axis=0)
    value, vector = np.linalg.eigh(centred.T @ centred)
    value, vector = np.maximum(value[::-1], 0.0), vector[:, ::-1]
    total = float(value.sum())
    if total <= 0.0:
        return np.asarray(vector[:, :0])
    kept = int(np.searchsorted(np.cumsum(value), (1.0 - _LEFT_OUT) * total)) + 1
    return np.asarray(vector[:, : min(kept, value.size)])


def _unused() -> np.random.Generator:
    """Random numbers for intervals of SALib's that are not used."""
    return np.random.default_rng(1)


def _salib(module: str) -> Any:
    """A module of SALib.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        return importlib.import_module(f"SALib.{module}")
    except ImportError as error:
        msg = "this method needs the package SALib: pip install 'mascarin[sensitivity]'"
        raise InputError(msg) from error
