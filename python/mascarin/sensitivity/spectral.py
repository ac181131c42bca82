r"""Spectral sensitivity: every parameter swings at its own frequency, and the answer shows who was heard.

In each replicate parameter i follows its search curve at an integer frequency :math:`w_i` with a random
phase :math:`\phi_i` while the run number k goes once round the circle, :math:`s_k = 2 \pi k / N`. The
Fourier transform of an output over the runs then holds the part that i alone causes on the lines
:math:`w_i, 2 w_i, \dots, M w_i`. Frequencies are dealt out anew, at random, in every replicate: a harmonic or
an interaction that happens to fall on somebody else's line in one replicate does not in the next.

The estimate goes one step further than averaging. All search curves are even about an angle of pi/2, so what
parameter i alone causes has, once turned back by its own phase, real Fourier coefficients :math:`a_{i,m}`
that are the same in every replicate. Whatever else falls on these lines carries the independent phase of
another parameter and averages to zero. Hence the product of the coefficients of two *different* replicates
is an unbiased estimate of :math:`a_{i,m}^2`, and

.. math:: share_i = \frac{\sum_t \sum_m \overline{a^{(r)} a^{(s)}}_{r \ne s} / 2}{\sum_t V}

with V likewise free of bias. Intervals come from leaving out one replicate at a time (see `jackknife`); a
parameter is called significant when its share is above zero with all parameters looked at together
(Bonferroni). The plain share of the method, the power on the lines of i over the variance, is kept as
`raw_share`, with the threshold below which noise would stay; it holds what falls on these lines by
coincidence too.

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
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.factors import Factor, Floats, check_factors, grouped, unit_factors
from mascarin.sensitivity.jackknife import Ratio, above_zero, interval
from mascarin.sensitivity.result import Sensitivity
from mascarin.sensitivity.runs import Collector
from mascarin.sensitivity.spectrum import Peak, Spectrum, power_threshold

Complexes = NDArray[np.complex128]
Integers = NDArray[np.int64]

SMALLEST_SPREAD: Final = 32
"""With few parameters frequencies are drawn from 1 to this, to leave room between them. [-]"""

_CANDIDATES: Final = 16
_SPACED_UP_TO: Final = 40  # groups; above, every choice of frequencies is crowded


@dataclass(frozen=True, eq=False)
class Design:
    """Which runs to make.

    Attributes
    ----------
    factors : tuple of Factor, length P
        What varies.
    groups : tuple of str, length G
        What is judged: a group of factors, or a factor of no group by its path.
    group_of : ndarray of int, shape (P,)
        Group of each factor.
    order : int
        Number M of harmonics counted as the parameter's own. [-]
    runs : int
        Runs N per replicate. [-]
    frequencies : ndarray of int, shape (R, G)
        Frequency of each group in each replicate. [1/circle]
    phases : ndarray, shape (R, P)
        Phase of each factor in each replicate. [rad]
    seed : int
        Of the random numbers.
    """

    factors: tuple[Factor, ...]
    groups: tuple[str, ...]
    group_of: Integers
    order: int
    runs: int
    frequencies: Integers
    phases: Floats
    seed: int

    @property
    def method(self) -> str:
        """Name of the method."""
        return "spectral"

    @property
    def replicates(self) -> int:
        """Number of replicates. [-]"""
        return int(self.frequencies.shape[0])

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the factors, the columns of the samples."""
        return tuple(factor.path for factor in self.factors)

    def __len__(self) -> int:
        """Number of runs in all replicates. [-]"""
        return self.replicates * self.runs

    def samples(self, replicate: int) -> Floats:
        """Parameter values of one replicate.

        Returns
        -------
        ndarray, shape (N, P)
            [unit of each parameter]
        """
        s = 2.0 * np.pi * np.arange(self.runs) / self.runs
        w = self.frequencies[replicate][self.group_of]
        columns = [
            factor.swing(w[i] * s + self.phases[replicate, i]) for i, factor in enumerate(self.factors)
        ]
        return np.column_stack(columns)

    def all_samples(self) -> Floats:
        """Parameter values of all runs, replicate after replicate.

        Returns
        -------
        ndarray, shape (R * N, P)
            [unit of each parameter]
        """
        return np.concatenate([self.samples(r) for r in range(self.replicates)])

    def members(self, group: int) -> Integers:
        """Positions of the factors of one group."""
        return np.flatnonzero(self.group_of == group)

    def collector(self, outputs: Sequence[str], units: Sequence[str] | None = None) -> Accumulator:
        """What takes the outputs of the runs and analyses them."""
        return Accumulator(self, outputs, units=units)


def design(
    factors: int | Sequence[Factor],
    *,
    replicates: int = 8,
    order: int | None = None,
    runs: int | None = None,
    frequencies: Sequence[int] | None = None,
    seed: int = 0,
) -> Design:
    """Make a replicated design with random frequencies and phases.

    Parameters
    ----------
    factors : int or sequence of Factor
        What varies; a number stands for as many parameters on [0, 1].
    replicates : int
        Number of independent repetitions, at least 3; the intervals come from their spread. [-]
    order : int, optional
        Number M of harmonics that count as a parameter's own: 4 up to 50 parameters (or groups), above
        that 2. A parameter that acts through its square alone needs 2, one that acts through the fourth
        harmonic 4. [-]
    runs : int, optional
        Runs per replicate. When absent as many as the frequencies need, ``2 M w_max + 1``. [-]
    frequencies : sequence of int, optional
        The frequencies to deal out, one per parameter or group. When absent they are drawn from 1 up to
        what `runs` allows (their number, or 32 for few parameters).
    seed : int
        Of the random numbers; the same seed gives the same design.

    Returns
    -------
    Design

    Raises
    ------
    InputError
        When there are fewer than 3 replicates, runs too few for the frequencies, or frequencies that are
        not distinct positive integers.
    """
    chosen = unit_factors(factors) if isinstance(factors, int) else factors
    checked = check_factors(chosen)
    groups, group_of = grouped(checked)
    if replicates < 3:
        msg = f"replicates: found {replicates}, expected at least 3: intervals come from their spread"
        raise InputError(msg)
    m = order if order is not None else (4 if len(groups) <= 50 else 2)
    if m < 1:
        msg = f"order: found {m}, expected at least 1 harmonic"
        raise InputError(msg)
    pool = _pool(len(groups), len(groups) < len(checked), m, runs, frequencies)
    n = runs if runs is not None else 2 * m * int(pool.max()) + 1
    rng = np.random.default_rng(seed)
    dealt = np.stack([_deal(pool, len(groups), m, rng) for _ in range(replicates)])
    phases = _phases(group_of, replicates, rng)
    return Design(checked, groups, group_of, m, n, dealt, phases, seed)


@dataclass(frozen=True, kw_only=True, eq=False)
class SpectralSensitivity(Sensitivity):
    """Result of the spectral method: shares over time as well, and the spectra they stand on.

    Attributes
    ----------
    design : Design
        The runs.
    raw_share : ndarray, shape (G, S)
        Power on the M lines of a parameter over the variance, mean of the replicates; holds whatever else
        falls on these lines. [-]
    threshold : float
        What `raw_share` exceeds by chance with probability 5 % for any of the parameters, if the spectrum
        were noise. [-]
    effect_rms : ndarray, shape (G, S)
        Root mean square over time of the effect; shows parameters whose effect changes sign during the day.
        [unit of the output]
    share_t, low_t, high_t, effect_t : ndarray, shape (G, T, S)
        As the attributes without suffix, at each time; NaN where the output does not vary. [-]
    mean_t, variance_t : ndarray, shape (T, S)
        Mean and variance of each output over the runs. [unit of the output, and its square]
    spectra : ndarray, shape (R, K, S)
        Power on the lines 1 ... K, K = (N - 1) // 2, over the variance, both summed over time. [-]
    """

    design: Design
    raw_share: Floats
    threshold: float
    effect_rms: Floats
    share_t: Floats
    low_t: Floats
    high_t: Floats
    effect_t: Floats
    mean_t: Floats
    variance_t: Floats
    spectra: Floats

    def spectrum(self, output: str, replicate: int = 0) -> Spectrum:
        """Spectrum of one replicate with its threshold and named peaks.

        A peak gets a name only if the same fundamental, harmonic or interaction stands above the threshold
        in at least three quarters of the replicates, wherever it falls there.

        Raises
        ------
        InputError
            When there is no such output or replicate.
        """
        s = self.output_index(output)
        if not 0 <= replicate < self.design.replicates:
            msg = f"replicate {replicate}: there are replicates 0 to {self.design.replicates - 1}"
            raise InputError(msg)
        return Spectrum.of(
            self.spectra[:, :, s],
            self.design.frequencies,
            self.design.runs,
            self.groups_shown,
            output=output,
            replicate=replicate,
        )

    def peaks(self, output: str, replicate: int = 0) -> list[Peak]:
        """Lines of one replicate above the threshold, from the lowest frequency, named where they survive."""
        return list(self.spectrum(output, replicate).peaks)

    @property
    def groups_shown(self) -> tuple[str, ...]:
        """Names of the groups, in the order of the frequencies."""
        return self.design.groups

    def _columns(self) -> list[str]:
        return [*super()._columns(), "effect_rms", "raw_share"]

    def _row(self, i: int, s: int) -> tuple[object, ...]:
        return (*super()._row(i, s), float(self.effect_rms[i, s]), float(self.raw_share[i, s]))


class Accumulator(Collector[Design, SpectralSensitivity]):
    """Takes the outputs of a design's runs as they come and keeps only what the analysis needs.

    What stays of a replicate are the coefficients of the parameters' own lines (``8 G M T S`` bytes).

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
        self._done: list[_Replicate] = []

    def _take(self, replicate: int, y: Floats) -> None:
        self._done.append(_transform(self.plan, replicate, y))

    def _result(self, confidence: float) -> SpectralSensitivity:
        return _analyse(self.plan, self._done, self.outputs, self.units, confidence)


def analyse(
    design: Design,
    outputs: ArrayLike,
    *,
    names: Sequence[str] | None = None,
    units: Sequence[str] | None = None,
    confidence: float = 0.95,
) -> SpectralSensitivity:
    """Analyse outputs that are all at hand.

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
    """
    y = np.asarray(outputs, dtype=np.float64)
    y = y.reshape((*y.shape, *(1,) * (3 - y.ndim)))
    labels = tuple(names) if names is not None else tuple(f"y{k + 1}" for k in range(y.shape[2]))
    accumulator = Accumulator(design, labels, units=units)
    accumulator.add(0, y)
    return accumulator.result(confidence=confidence)


# --- design -------------------------------------------------------------------------------------------


def _pool(
    count: int, grouped: bool, order: int, runs: int | None, frequencies: Sequence[int] | None
) -> Integers:
    """The frequencies that may be dealt out."""
    if frequencies is not None:
        pool = np.asarray(frequencies, dtype=np.int64)
        if pool.ndim != 1 or pool.size < count or np.unique(pool).size != pool.size or pool.min() < 1:
            msg = (
                f"frequencies: expected {count} or more distinct positive integers, found {list(frequencies)}"
            )
            raise InputError(msg)
    else:
        spread = max(count, SMALLEST_SPREAD)
        if grouped:
            # The noise under a group is read off lines that belong to nobody: leave some.
            spread = max(spread, (5 * count + 3) // 4)
        if runs is not None:
            spread = max(count, (runs - 1) // (2 * order))
        pool = np.arange(1, spread + 1)
    largest = int(pool.max())
    if runs is not None and runs < 2 * order * largest + 1:
        msg = (
            f"runs: {runs} per replicate are too few for {count} parameters with {order} harmonics: the "
            f"largest frequency {largest} needs {2 * order * largest + 1} (2 M w_max + 1); give more runs, a "
            f"lower order, or group parameters"
        )
        raise InputError(msg)
    return pool


def _deal(pool: Integers, count: int, order: int, rng: np.random.Generator) -> Integers:
    """A random frequency for each group; where there is a choice, the least crowded of some random ones."""
    if pool.size == count or count > _SPACED_UP_TO:
        return rng.permutation(pool)[:count]
    candidates = [rng.permutation(pool)[:count] for _ in range(_CANDIDATES)]
    crowds = [_crowding(w, order) for w in candidates]
    return candidates[int(np.argmin(crowds))]


def _crowding(w: Integers, order: int) -> float:
    """How many harmonics and low-order interactions fall on a parameter's own lines. [-]"""
    own = np.outer(np.arange(1, order + 1), w).ravel()
    lines = np.unique(own)
    crowd = 3.0 * (own.size - lines.size)
    i, j = np.triu_indices(w.size, 1)
    for a in (1, 2):
        for b in (1, 2):
            both = np.concatenate([a * w[i] + b * w[j], np.abs(a * w[i] - b * w[j])])
            crowd += float(np.isin(both, lines).sum()) / (a * b)
    return crowd


def _phases(group_of: Integers, replicates: int, rng: np.random.Generator) -> Floats:
    """Random phases; those in a group are spread so that their cross terms cancel over the replicates."""
    phases = rng.uniform(0.0, 2.0 * np.pi, (replicates, group_of.size))
    steps = 2.0 * np.pi * np.arange(replicates) / replicates
    for g in np.unique(group_of):
        members = rng.permutation(np.flatnonzero(group_of == g))
        for k, i in enumerate(members[1:], start=1):
            phases[:, i] = phases[:, members[0]] + rng.uniform(0.0, 2.0 * np.pi) + k * steps
    return np.mod(phases, 2.0 * np.pi)


# --- analysis -----------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Replicate:
    """What is kept of one replicate.

    Attributes: `real` (G, M, T, S) coefficients turned by the parameter's phase; `power` (G, T, S) half the
    squared coefficients summed over the harmonics, less the noise for groups of several; `raw` (G, S) the
    same summed over time, nothing taken off; `mean`, `variance` (T, S); `lines` (K, S) power summed over
    time; `gain` (G,) fundamental of the parameter's own curve over its range.
    """

    real: Floats
    power: Floats
    raw: Floats
    mean: Floats
    variance: Floats
    lines: Floats
    gain: Floats


def _transform(plan: Design, replicate: int, y: Floats) -> _Replicate:
    """Fourier transform of one replicate's outputs (N, T, S)."""
    n, m = plan.runs, plan.order
    mean = y.mean(axis=0)
    centred = y - mean
    spectrum = np.fft.rfft(centred, axis=0)[1 : (n - 1) // 2 + 1] * (2.0 / n)
    w = plan.frequencies[replicate]
    single = np.array([plan.members(g)[0] for g in range(len(plan.groups))])
    phase = plan.phases[replicate][single] - 0.5 * np.pi
    harmonics = np.arange(1, m + 1)
    own = np.outer(w, harmonics)
    turn = np.exp(-1j * np.outer(phase, harmonics))
    coefficients = spectrum[own - 1] * turn[:, :, None, None]
    squared = spectrum.real**2 + spectrum.imag**2
    power = 0.5 * squared[own - 1].sum(axis=1)
    raw = power.sum(axis=1)
    sizes = np.bincount(plan.group_of)
    free = np.setdiff1d(np.arange(1, squared.shape[0] + 1), own)
    floor = 0.5 * m * squared[free - 1].mean(axis=0) if free.size and (sizes > 1).any() else 0.0
    return _Replicate(
        real=coefficients.real,
        power=np.where((sizes > 1)[:, None, None], power - floor, power),
        raw=raw,
        mean=mean,
        variance=np.mean(centred**2, axis=0),
        lines=0.5 * squared.sum(axis=1),
        gain=_gains(plan, replicate),
    )


def _gains(plan: Design, replicate: int) -> Floats:
    """Fundamental of each single parameter's own curve over its range; NaN for groups of several. [-]"""
    gains = np.full(len(plan.groups), np.nan)
    s = 2.0 * np.pi * np.arange(plan.runs) / plan.runs
    for g in range(len(plan.groups)):
        members = plan.members(g)
        if members.size == 1:
            i = int(members[0])
            factor = plan.factors[i]
            angle = plan.frequencies[replicate, g] * s + plan.phases[replicate, i]
            curve = factor.swing(angle)
            fundamental = 2.0 * np.mean(curve * np.cos(angle - 0.5 * np.pi))
            gains[g] = fundamental / (factor.high - factor.low)
    return gains


def _analyse(
    plan: Design,
    parts: Sequence[_Replicate],
    outputs: tuple[str, ...],
    units: tuple[str, ...],
    confidence: float,
) -> SpectralSensitivity:
    """Put the replicates together, one output at a time."""
    count, r = len(plan.groups), plan.replicates
    times = parts[0].mean.shape[0]
    shape, shape_t = (count, len(outputs)), (count, times, len(outputs))
    share, low, high, effect, effect_rms, raw = (np.zeros(shape) for _ in range(6))
    share_t, low_t, high_t, effect_t = (np.zeros(shape_t) for _ in range(4))
    significant = np.zeros(shape, dtype=np.bool_)
    variance_t = np.zeros((times, len(outputs)))
    spectra = np.zeros((r, parts[0].lines.shape[0], len(outputs)))
    coherent = np.bincount(plan.group_of) == 1
    strict = 1.0 - (1.0 - confidence) / count
    gain = np.stack([part.gain for part in parts])
    warnings = []
    for s, output in enumerate(outputs):
        real = np.stack([part.real[..., s] for part in parts])
        power = np.stack([part.power[..., s] for part in parts])
        variance = _variance(
            np.stack([part.variance[:, s] for part in parts]), np.stack([part.mean[:, s] for part in parts])
        )
        scale = max(float(np.abs(part.mean[:, s]).max()) for part in parts)
        floor = (1e-12 * scale) ** 2 + np.finfo(float).tiny
        numerator = _power(real, power, coherent)
        steady = variance.value <= floor
        variance_t[:, s] = np.where(steady, 0.0, variance.value)
        share_t[:, :, s], low_t[:, :, s], high_t[:, :, s] = interval(numerator, variance, confidence)
        for array in (share_t, low_t, high_t):
            array[:, steady, s] = np.nan
        effect_t[:, :, s] = (real[:, :, 0] / gain[:, :, None]).mean(axis=0)
        effect[:, s] = effect_t[:, :, s].mean(axis=1)
        effect_rms[:, s] = np.sqrt(np.mean(effect_t[:, :, s] ** 2, axis=1))
        total = variance.summed()
        if total.value <= floor:
            warnings.append(f"'{output}' does not depend on any of the varied parameters")
            continue
        share[:, s], low[:, s], high[:, s] = interval(numerator.summed(), total, confidence)
        # What is left of a linear model's silence is rounding.
        significant[:, s] = above_zero(numerator.summed(), total, strict) & (share[:, s] > 1e-12)
        plain = np.mean([part.variance[:, s].sum() for part in parts])
        raw[:, s] = np.mean([part.raw[:, s] for part in parts], axis=0) / plain
        spectra[:, :, s] = np.stack([part.lines[:, s] / part.variance[:, s].sum() for part in parts])
    threshold = power_threshold(plan.order, plan.runs, r, count)
    return SpectralSensitivity(
        method="spectral",
        names=plan.groups,
        outputs=outputs,
        units=units,
        share=share,
        low=low,
        high=high,
        effect=effect,
        significant=significant,
        confidence=confidence,
        runs=len(plan),
        seed=plan.seed,
        warnings=tuple(warnings),
        design=plan,
        raw_share=raw,
        threshold=threshold,
        effect_rms=effect_rms,
        share_t=share_t,
        low_t=low_t,
        high_t=high_t,
        effect_t=effect_t,
        mean_t=np.mean([part.mean for part in parts], axis=0),
        variance_t=variance_t,
        spectra=spectra,
    )


def _power(real: Floats, power: Floats, coherent: NDArray[np.bool_]) -> Ratio:
    """Power of each parameter: products of different replicates, or means for groups of several.

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
    """Variance over the parameters' whole space from those within the replicates, each (R, T).

    The mean of a replicate wanders a little with its phases; the variance between the means is the part
    of the whole variance that no replicate sees.
    """
    r = variance.shape[0]
    deviation = (mean - mean.mean(axis=0)) ** 2
    between = deviation.sum(axis=0)
    without = (between - deviation * r / (r - 1)) / (r - 2)
    return Ratio(
        variance.mean(axis=0) + between / (r - 1),
        (variance.sum(axis=0) - variance) / (r - 1) + without,
    )
