"""The analysis of the runs of SALib's methods: replicates put together, with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.base.jackknife import Ratio, above_zero, interval, student_reach
from mascarin.sensitivity.base.result import Sensitivity
from mascarin.sensitivity.base.runs import Collector
from mascarin.sensitivity.salib.estimators import ESTIMATORS, ReplicateIndices, components
from mascarin.sensitivity.salib.plans import SalibPlan
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

SQUARES: Final = (
    "part of the squared elementary effects: equal to the first-order index where the model is linear, a "
    "number for ranking elsewhere"
)
"""What the index of Morris' method is."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MorrisSensitivity(Sensitivity):
    """Result of Morris' method: means and spread of the elementary effects.

    An elementary effect is the change of an output, averaged over time, scaled to the whole range of the
    parameter. `index` is the part of the squared effects, summed over time (see `measure`).

    Attributes
    ----------
    mu : ndarray, shape (G, S)
        Mean of the elementary effects; NaN for groups. [unit of the output]
    mu_star : ndarray, shape (G, S)
        Mean of their magnitudes. [unit of the output]
    sigma : ndarray, shape (G, S)
        Their standard deviation; large where the parameter interacts or acts non-linearly; NaN for groups.
        [unit of the output]
    mu_star_conf : ndarray, shape (G, S)
        Half-width of the confidence interval of `mu_star`. [unit of the output]

    References
    ----------
    Morris M.D. (1991), Technometrics 33, 161. https://doi.org/10.1080/00401706.1991.10484804
    Campolongo F. et al. (2007), Environ. Model. Softw. 22, 1509.
    https://doi.org/10.1016/j.envsoft.2006.10.004

    Examples
    --------
    >>> from mascarin.sensitivity import Factor, plan, run
    >>> factors = [Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0)]
    >>> found = run(plan(factors, "morris"), lambda x: x @ [[3.0], [-1.0]], outputs=["y"])
    >>> found.to_dataframe()[["parameter", "mu", "mu_star"]].round(3)
      parameter   mu  mu_star
    0         a  3.0      3.0
    1         b -1.0      1.0
    """

    mu: Floats
    mu_star: Floats
    sigma: Floats
    mu_star_conf: Floats

    @property
    def first_order(self) -> None:
        """None: Morris' method gives no first-order index."""
        return

    def _indices(self) -> Mapping[str, Floats]:
        return {
            "mu": self.mu,
            "mu_star": self.mu_star,
            "sigma": self.sigma,
            "mu_star_conf": self.mu_star_conf,
        }

    def _arrays(self) -> Mapping[str, Floats]:
        return {
            **self._indices(),
            "squared_effects": self.index,
            "squared_effects_low": self.low,
            "squared_effects_high": self.high,
        }

    def _described(self, i: int, s: int) -> str:
        size = f"{self.mu_star[i, s]:.3g} ± {self.mu_star_conf[i, s]:.2g}"
        return f"mu* {size} {self.units[s]}".rstrip()

    @property
    def _label(self) -> str:
        return "part of the squared effects"


class SalibCollector(Collector[SalibPlan, Sensitivity]):
    """Takes the outputs of the runs of a plan in any order and keeps the indices of each replicate.

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
        self._estimator = ESTIMATORS[plan.method](plan)
        self._bases: list[Floats] = []
        self._parts: list[list[ReplicateIndices]] = []
        self._scale = np.zeros(len(self.outputs))

    def _take(self, replicate: int, y: Floats) -> None:
        if not self._bases:
            self._bases = [components(y[:, :, s]) for s in range(len(self.outputs))]
        u = self.plan.unit_samples(replicate)
        self._parts.append(
            [self._estimator.part(u, y[:, :, s], self._bases[s]) for s in range(len(self.outputs))]
        )
        self._scale = np.maximum(self._scale, np.abs(y).max(axis=(0, 1)))

    def _gathered(self, name: str) -> Floats:
        """An attribute of the parts, shape (R, G, S), or (R, S) for the variance."""
        return np.stack([np.stack([getattr(part, name) for part in parts], axis=-1) for parts in self._parts])

    def _result(self, confidence: float) -> Sensitivity:
        plan = self.plan
        strict = 1.0 - (1.0 - confidence) / len(plan.groups)
        variance = Ratio.mean(self._gathered("variance"))
        # A variance of rounding errors counts as zero.
        constant = variance.value <= (1e-12 * self._scale) ** 2 + np.finfo(float).tiny
        first = Ratio.mean(self._gathered("first"))
        indices = [np.where(constant, 0.0, array) for array in interval(first, variance, confidence)]
        certain = ~constant & above_zero(first, variance, strict)
        fields: dict[str, Any] = {
            "method": plan.method,
            "names": plan.groups,
            "outputs": self.outputs,
            "units": self.units,
            "index": indices[0],
            "low": indices[1],
            "high": indices[2],
            "effect": self._gathered("effect").mean(axis=0),
            "significant": certain & (indices[0] > 1e-12),
            "confidence": confidence,
            "runs": len(plan),
            "seed": plan.seed,
            "warnings": tuple(
                RunWarning(f"'{output}' does not depend on any of the varied parameters", WarningKind.METHOD)
                for output, none in zip(self.outputs, constant, strict=True)
                if none
            ),
        }
        if plan.method == "morris":
            fields |= self._elementary_effects(confidence)
            return MorrisSensitivity(**fields, measure=SQUARES)
        if plan.method == "sobol":
            total = interval(Ratio.mean(self._gathered("total")), variance, confidence)
            for name, array in zip(("total", "total_low", "total_high"), total, strict=True):
                fields[name] = np.where(constant, 0.0, array)
        return Sensitivity(**fields)

    def _elementary_effects(self, confidence: float) -> dict[str, Floats]:
        """Mean, mean magnitude and standard deviation of the effects of all trajectories."""
        mu, size, sigma = (self._gathered(name) for name in ("effect", "mean_size", "spread"))
        count = self.plan.size
        n = count * len(mu)
        squares = np.sum((count - 1) * sigma**2 + count * mu**2, axis=0)
        spread = np.sqrt(np.maximum(squares - n * mu.mean(axis=0) ** 2, 0.0) / (n - 1))
        return {
            "mu": mu.mean(axis=0),
            "mu_star": size.mean(axis=0),
            "sigma": spread,
            "mu_star_conf": student_reach(size, confidence),
        }
