"""The spectrum of one replicate: threshold, peaks and what they are.

In a spectrum of m lines of pure noise, the part of the power on M lines has a Beta(M, m - M) distribution;
averaged over R replicates, Beta(R M, R (m - M)). Thresholds are the values that are exceeded with probability
5 % by any of the lines, or by any of the parameters (Bonferroni).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SIGNIFICANCE_LEVEL: Final = 0.05
"""Probability that any line exceeds the threshold in a spectrum of noise. [-]"""

_MAX_HARMONIC: Final = 6  # highest harmonic that can name a peak
#: Least fraction of the replicates in which a line must be above the threshold.
_MIN_REPLICATE_FRACTION: Final = 0.75
_ALL_PAIRS_UP_TO: Final = 40  # parameters; above, one of a pair must have a strong line of its own
_MAX_STRONG_PARAMETERS: Final = 10

PeakKind = Literal["fundamental", "harmonic", "interaction", "unnamed"]


@dataclass(frozen=True, slots=True)
class Peak:
    """A line above the threshold.

    Attributes
    ----------
    line : int
        Its number. [1/circle]
    power : float
        Its part of the variance in this replicate. [-]
    kind : str
        ``fundamental``, ``harmonic``, ``interaction``, or ``unnamed`` when nothing that would explain it is
        above the threshold in the other replicates.
    label : str
        Its name for a figure: ``a``, ``2 × a``, ``a + b``; empty when unnamed.
    parameters : tuple of str
        The parameters in it.
    weaker_labels : tuple of str
        Labels of weaker explanations that fall on the same line here.
    """

    line: int
    power: float
    kind: PeakKind
    label: str
    parameters: tuple[str, ...]
    weaker_labels: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power over frequency of one replicate.

    Attributes
    ----------
    output : str
        Name of the output.
    replicate : int
        Which replicate.
    power : ndarray, shape (K,)
        Part of the variance on the lines 1 ... K. [-]
    threshold : float
        Value that no line of noise exceeds, with probability 95 %. [-]
    frequencies : ndarray of int, shape (G,)
        Frequency of each parameter. [1/circle]
    names : tuple of str, length G
        The parameters.
    peaks : tuple of Peak
        Lines above the threshold, by rising frequency.
    """

    output: str
    replicate: int
    power: Floats
    threshold: float
    frequencies: Integers
    names: tuple[str, ...]
    peaks: tuple[Peak, ...]

    @staticmethod
    def of(
        spectra: Floats,
        frequencies: Integers,
        runs: int,
        names: Sequence[str],
        *,
        output: str,
        replicate: int,
    ) -> Spectrum:
        """Name the peaks of one replicate by what is above the threshold in most of them.

        Parameters
        ----------
        spectra : ndarray, shape (R, K)
            Part of the variance by replicate and line. [-]
        frequencies : ndarray of int, shape (R, G)
            Frequency of each parameter. [1/circle]
        runs : int
            Runs per replicate. [-]
        names : sequence of str, length G
            The parameters.
        output : str
            Name of the output.
        replicate : int
            Which replicate to show.

        Returns
        -------
        Spectrum
            With its named peaks.
        """
        threshold = line_threshold(spectra.shape[1])
        by_line: dict[int, list[_Component]] = {}
        for component in _components(spectra, frequencies, runs, names, threshold):
            by_line.setdefault(int(component.lines[replicate]), []).append(component)
        power = spectra[replicate]
        peaks = []
        for line in np.flatnonzero(power > threshold) + 1:
            components = sorted(by_line.get(int(line), []), key=lambda component: -component.power)
            peaks.append(_peak(int(line), float(power[line - 1]), components))
        return Spectrum(
            output, replicate, power, threshold, frequencies[replicate], tuple(names), tuple(peaks)
        )


def line_threshold(lines: int, level: float = SIGNIFICANCE_LEVEL) -> float:
    """Return the value that the largest of many lines of noise exceeds with probability `level`.

    Parameters
    ----------
    lines : int
        Number m of lines. [-]
    level : float
        Probability. [-]

    Returns
    -------
    float
        Part of the whole power; the quantile of Beta(1, m - 1) at ``1 - level / m``. [-]
    """
    if lines < 2:
        return 1.0
    return 1.0 - math.pow(level / lines, 1.0 / (lines - 1))


def power_threshold(
    order: int, runs: int, replicates: int = 1, parameters: int = 1, level: float = SIGNIFICANCE_LEVEL
) -> float:
    """Return the value that the power on the lines of any parameter exceeds by chance.

    Parameters
    ----------
    order : int
        Lines M per parameter. [-]
    runs : int
        Runs N per replicate. [-]
    replicates : int
        Number of replicates R averaged. [-]
    parameters : int
        Number of parameters tested. [-]
    level : float
        Probability. [-]

    Returns
    -------
    float
        Part of the variance. [-]
    """
    from scipy import stats

    lines = (runs - 1) // 2
    if lines <= order:
        return 1.0
    tail = level / parameters
    return float(stats.beta.isf(tail, replicates * order, replicates * (lines - order)))


@dataclass(frozen=True, eq=False)
class _Component:
    """A fundamental, harmonic or interaction above the threshold in most replicates.

    `lines` (R,) is its line in each replicate, `power` its mean power.
    """

    kind: PeakKind
    label: str
    parameters: tuple[str, ...]
    lines: Integers
    power: float


def _components(
    spectra: Floats, frequencies: Integers, runs: int, names: Sequence[str], threshold: float
) -> Iterator[_Component]:
    """Fundamentals, harmonics and interactions that are above the threshold in most replicates."""
    # Line 0 and, with an even number of runs, the last one are not in the spectrum.
    padded = np.pad(spectra, ((0, 0), (1, runs // 2 - spectra.shape[1])))
    rows = np.arange(spectra.shape[0])[:, None]
    needed = math.ceil(_MIN_REPLICATE_FRACTION * spectra.shape[0])

    def significant(lines: Integers) -> tuple[Integers, Integers, Floats]:
        folded = _folded(lines, runs)
        powers = padded[rows, folded]
        columns = np.flatnonzero((powers > threshold).sum(axis=0) >= needed)
        return columns, folded, powers.mean(axis=0)

    strength = np.zeros(len(names))
    for harmonic in range(1, _MAX_HARMONIC + 1):
        columns, lines, power = significant(harmonic * frequencies)
        for i in columns:
            strength[i] += power[i]
            kind: PeakKind = "fundamental" if harmonic == 1 else "harmonic"
            label = _times(harmonic, names[i])
            yield _Component(kind, label, (names[i],), lines[:, i], float(power[i]))
    first, second = _pairs(strength)
    if not first.size:
        return
    for a, b, sign in itertools.product((1, 2), (1, 2), (1, -1)):
        columns, lines, power = significant(a * frequencies[:, first] + sign * b * frequencies[:, second])
        for p in columns:
            i, j = names[first[p]], names[second[p]]
            label = f"{_times(a, i)} {'+' if sign > 0 else '−'} {_times(b, j)}"
            yield _Component("interaction", label, (i, j), lines[:, p], float(power[p]))


def _pairs(strength: Floats) -> tuple[Integers, Integers]:
    """Pairs of parameters whose interactions are considered."""
    first, second = np.triu_indices(strength.size, 1)
    if strength.size > _ALL_PAIRS_UP_TO:
        strong = np.zeros(strength.size, dtype=np.bool_)
        strong[np.argsort(-strength)[:_MAX_STRONG_PARAMETERS]] = True
        strong &= strength > 0.0
        keep = strong[first] | strong[second]
        first, second = first[keep], second[keep]
    return first.astype(np.int64), second.astype(np.int64)


def _folded(lines: Integers, runs: int) -> Integers:
    """Line among 0 ... N // 2 on which a frequency appears with N runs (aliasing)."""
    remainder = np.mod(np.abs(lines), runs)
    folded: Integers = np.minimum(remainder, runs - remainder)
    return folded


def _times(factor: int, name: str) -> str:
    return name if factor == 1 else f"{factor} × {name}"


def _peak(line: int, power: float, components: Sequence[_Component]) -> Peak:
    if not components:
        return Peak(line, power, "unnamed", "", ())
    best = components[0]
    return Peak(line, power, best.kind, best.label, best.parameters, tuple(c.label for c in components[1:]))
