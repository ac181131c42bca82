r"""Spectral sensitivity analysis: every parameter varies at its own frequency over the runs.

In each replicate parameter i follows its search curve at an integer frequency :math:`w_i` with a random
phase :math:`\phi_i`, while the run number k passes once around the circle, :math:`s_k = 2 \pi k / N`. The
Fourier transform of an output over the runs then has the part that is due to i alone on the lines
:math:`w_i, 2 w_i, \dots, M w_i`. Frequencies are assigned again at random in every replicate: a harmonic or
an interaction that falls on the line of another parameter in one replicate does not in the next.

All search curves are even about an angle of pi/2. The part of an output that is due to i alone has therefore,
turned back by the phase of i, real Fourier coefficients :math:`a_{i,m}` that are the same in all replicates.
Everything else on these lines has the independent phase of another parameter and averages to zero. So the
product of the coefficients of two *different* replicates is an unbiased estimate of :math:`a_{i,m}^2`, and
the first-order index is

.. math:: S_{1,i} = \frac{\sum_t \sum_m \overline{a^{(r)} a^{(s)}}_{r \ne s} / 2}{\sum_t V}

with an unbiased variance V. Intervals come from leaving out one replicate at a time (see `jackknife`); a
parameter is called significant when its index is above zero in a test of all parameters (Bonferroni).
The index of the classical method, the power on the lines of i divided by the variance, is kept as
`raw_index`, with the threshold of noise; it includes what falls on these lines by chance.

References
----------
Cukier R.I. et al. (1973), J. Chem. Phys. 59, 3873. https://doi.org/10.1063/1.1680571
Schruben L.W., Cogliano V.J. (1987), Commun. ACM 30, 716. https://doi.org/10.1145/27651.27655
Saltelli A., Tarantola S., Chan K. (1999), Technometrics 41, 39.
https://doi.org/10.1080/00401706.1999.10485594
Tarantola S., Gatelli D., Mara T.A. (2006), Reliab. Eng. Syst. Saf. 91, 717.
https://doi.org/10.1016/j.ress.2005.06.003
Hartigan J.A. (1969), J. Am. Stat. Assoc. 64, 1303 (intervals from subsets of the replicates).
https://doi.org/10.1080/01621459.1969.10501057
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.base.jackknife import Ratio, above_zero, interval
from mascarin.sensitivity.base.runs import Collector
from mascarin.sensitivity.spectral.designs import Design
from mascarin.sensitivity.spectral.replicates import Replicate, transform
from mascarin.sensitivity.spectral.result import SpectralSensitivity
from mascarin.sensitivity.spectral.spectrum import power_threshold
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind


class SpectralCollector(Collector[Design, SpectralSensitivity]):
    """Takes the outputs of the runs of a design in any order and keeps only what the analysis needs.

    Of each replicate it keeps the coefficients on the lines of the parameters (``8 G M T S`` bytes).

    Parameters
    ----------
    design : Design
        The runs.
    outputs : sequence of str, length S
        Output names.
    units : sequence of str, length S, optional
        Their units.
    """

    def __init__(self, design: Design, outputs: Sequence[str], *, units: Sequence[str] | None = None) -> None:
        super().__init__(design, outputs, units=units)
        self._done: list[Replicate] = []

    def _take(self, replicate: int, y: Floats) -> None:
        self._done.append(transform(self.plan, replicate, y))

    def _result(self, confidence: float) -> SpectralSensitivity:
        return _analyzed(self.plan, self._done, self.outputs, self.units, confidence)


def analyze(
    design: Design,
    outputs: ArrayLike,
    *,
    names: Sequence[str] | None = None,
    units: Sequence[str] | None = None,
    confidence: float = 0.95,
) -> SpectralSensitivity:
    """Analyze the outputs of all runs of a design.

    Parameters
    ----------
    design : Design
        The runs.
    outputs : array_like, shape (R * N,), (R * N, T) or (R * N, T, S)
        Outputs by run, time and output, in the order of `Design.all_samples`. [unit of each output]
    names, units : sequence of str, length S, optional
        Names and units of the outputs.
    confidence : float
        Of the intervals. [-]

    Returns
    -------
    SpectralSensitivity
        Indices with intervals, effects and spectra.

    Raises
    ------
    InputError
        Outputs of another shape, or values that are not finite.

    Examples
    --------
    >>> from mascarin.sensitivity.spectral import design
    >>> plan = design(2, seed=1)
    >>> x = plan.all_samples()
    >>> analyze(plan, 3.0 * x[:, 0] + x[:, 1]).index[:, 0].round(2).tolist()
    [0.9, 0.1]
    """
    y = np.asarray(outputs, dtype=np.float64)
    y = y.reshape((*y.shape, *(1,) * (3 - y.ndim)))
    labels = tuple(names) if names is not None else tuple(f"y{k + 1}" for k in range(y.shape[2]))
    accumulator = SpectralCollector(design, labels, units=units)
    accumulator.add(0, y)
    return accumulator.result(confidence=confidence)


def _analyzed(
    plan: Design,
    parts: Sequence[Replicate],
    outputs: tuple[str, ...],
    units: tuple[str, ...],
    confidence: float,
) -> SpectralSensitivity:
    """Put the replicates together."""
    by_output = [_of_output(plan, parts, s, confidence) for s in range(len(outputs))]
    arrays: dict[str, Any] = {
        name: np.stack([output_arrays[name] for output_arrays in by_output], axis=-1) for name in by_output[0]
    }
    constant = arrays.pop("constant")
    return SpectralSensitivity(
        method="spectral",
        names=plan.groups,
        outputs=outputs,
        units=units,
        confidence=confidence,
        runs=len(plan),
        seed=plan.seed,
        warnings=tuple(
            RunWarning(f"'{output}' does not depend on any of the varied parameters", WarningKind.METHOD)
            for output, none in zip(outputs, constant, strict=True)
            if none
        ),
        design=plan,
        threshold=power_threshold(plan.order, plan.runs, plan.replicates, len(plan.groups)),
        mean_t=np.mean([part.mean for part in parts], axis=0),
        **arrays,
    )


def _of_output(plan: Design, parts: Sequence[Replicate], s: int, confidence: float) -> dict[str, Any]:
    """Arrays of output number s, by the names of the attributes; `constant` where nothing changes it."""
    real, power, variances, means = (
        np.stack([getattr(part, name)[..., s] for part in parts])
        for name in ("real", "power", "variance", "mean")
    )
    coherent = np.bincount(plan.group_of) == 1
    gain = np.stack([part.gain for part in parts])
    numerator, variance = _power(real, power, coherent), _variance(variances, means)
    # A variance of rounding errors counts as zero.
    floor = (1e-12 * float(np.abs(means).max())) ** 2 + np.finfo(float).tiny
    steady = variance.value <= floor
    index_t, low_t, high_t = interval(numerator, variance, confidence)
    for array in (index_t, low_t, high_t):
        array[:, steady] = np.nan
    effect_t = (real[:, :, 0] / gain[:, :, None]).mean(axis=0)
    total = variance.summed()
    constant = bool(total.value <= floor)
    lines = np.stack([part.lines[:, s] for part in parts])
    zero = np.zeros(len(plan.groups))
    index, low, high, raw, significant = zero, zero, zero, zero, zero > 0.0
    spectra = np.zeros(lines.shape)
    if not constant:
        index, low, high = interval(numerator.summed(), total, confidence)
        strict = 1.0 - (1.0 - confidence) / len(plan.groups)
        # An index below 1e-12 is rounding.
        significant = above_zero(numerator.summed(), total, strict) & (index > 1e-12)
        sums = [part.variance[:, s].sum() for part in parts]
        raw = np.mean([part.raw[:, s] for part in parts], axis=0) / np.mean(sums)
        spectra = np.stack([line / size for line, size in zip(lines, sums, strict=True)])
    return {
        "index": index,
        "low": low,
        "high": high,
        "effect": effect_t.mean(axis=1),
        "significant": significant,
        "raw_index": raw,
        "effect_rms": np.sqrt(np.mean(effect_t**2, axis=1)),
        "index_t": index_t,
        "low_t": low_t,
        "high_t": high_t,
        "effect_t": effect_t,
        "variance_t": np.where(steady, 0.0, variance.value),
        "spectra": spectra,
        "constant": constant,
    }


def _power(real: Floats, power: Floats, coherent: NDArray[np.bool_]) -> Ratio:
    """Power of each parameter: products of different replicates, or means for groups of several factors.

    `real` has shape (R, G, M, T), `power` (R, G, T).
    """
    r = real.shape[0]
    total = real.sum(axis=0)
    # Mean over the other replicates of the products with replicate k.
    products = 0.5 * np.sum(real * (total - real), axis=2) / (r - 1)
    pairs = products.mean(axis=0)
    mean = power.mean(axis=0)
    mask = coherent[:, None]
    return Ratio(
        np.where(mask, pairs, mean),
        np.where(mask, (r * pairs - 2.0 * products) / (r - 2), (r * mean - power) / (r - 1)),
    )


def _variance(variance: Floats, mean: Floats) -> Ratio:
    """Variance over the whole parameter space from mean and variance of the replicates, each (R, T).

    The mean of a replicate depends slightly on its phases; the variance between the means is the part of the
    whole variance that is not within any replicate.
    """
    r = variance.shape[0]
    deviation = (mean - mean.mean(axis=0)) ** 2
    between = deviation.sum(axis=0)
    without = (between - deviation * r / (r - 1)) / (r - 2)
    return Ratio(
        variance.mean(axis=0) + between / (r - 1),
        (variance.sum(axis=0) - variance) / (r - 1) + without,
    )
