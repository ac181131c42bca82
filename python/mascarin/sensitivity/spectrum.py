"""The spectrum of one replicate: threshold, peaks and what they are.

If a spectrum of m lines were noise, the share of M lines taken together would follow a Beta(M, m - M)
distribution; averaged over R replicates, Beta(R M, R (m - M)). Thresholds are the values that this exceeds
with probability 5 % for any of the lines, or any of the parameters (Bonferroni).
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

CHANCE: Final = 0.05
"""Probability that anything at all exceeds a threshold in a spectrum of noise. [-]"""

_HARMONICS: Final = 6  # looked for when peaks are named, beyond those that count as the parameter's own
_SURVIVES: Final = 0.75  # share of the replicates in which a line must stand out
_ALL_PAIRS_UP_TO: Final = 40  # parameters; above, one of a pair must stand out by itself
_LOUDEST: Final = 10

PeakKind = Literal["fundamental", "harmonic", "interaction", "unnamed"]


@dataclass(frozen=True, slots=True)
class Peak:
    """A line above the threshold.

    Attributes
    ----------
    line : int
        Its number. [1/circle]
    power : float
        Its share of the variance in this replicate. [-]
    kind : str
        ``fundamental``, ``harmonic``, ``interaction``, or ``unnamed`` when nothing that would explain it
        stands out in the other replicates.
    label : str
        What it is, for a figure: ``a``, ``2 × a``, ``a + b``; empty when unnamed.
    parameters : tuple of str
        The parameters in it.
    others : tuple of str
        Labels of weaker explanations that fall on the same line here.
    """

    line: int
    power: float
    kind: PeakKind
    label: str
    parameters: tuple[str, ...]
    others: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power over frequency in one replicate.

    Attributes
    ----------
    output : str
        Name of the output.
    replicate : int
        Which replicate.
    power : ndarray, shape (K,)
        Share of the variance on the lines 1 ... K. [-]
    threshold : float
        What no line of noise exceeds, with probability 95 %. [-]
    frequencies : ndarray of int, shape (G,)
        Where each parameter's fundamental is. [1/circle]
    names : tuple of str, length G
        The parameters.
    peaks : tuple of Peak
        Lines above the threshold by rising frequency.
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
        """Name the peaks of one replicate by what stands out in all of them.

        Parameters
        ----------
        spectra : ndarray, shape (R, K)
            Share of the variance by replicate and line. [-]
        frequencies : ndarray of int, shape (R, G)
            Where each parameter's fundamental is. [1/circle]
        runs : int
            Runs per replicate. [-]
        names : sequence of str, length G
            The parameters.
        output : str
            Name of the output.
        replicate : int
            Which replicate to show.
        """
        threshold = line_threshold(spectra.shape[1])
        explained: dict[int, list[_Sound]] = {}
        for sound in _heard(spectra, frequencies, runs, names, threshold):
            explained.setdefault(int(sound.lines[replicate]), []).append(sound)
        power = spectra[replicate]
        peaks = []
        for line in np.flatnonzero(power > threshold) + 1:
            sounds = sorted(explained.get(int(line), []), key=lambda sound: -sound.power)
            peaks.append(_peak(int(line), float(power[line - 1]), sounds))
        return Spectrum(
            output, replicate, power, threshold, frequencies[replicate], tuple(names), tuple(peaks)
        )


def line_threshold(lines: int, chance: float = CHANCE) -> float:
    """What the largest of many lines of noise exceeds with probability `chance`.

    Parameters
    ----------
    lines : int
        Number m of lines. [-]
    chance : float
        [-]

    Returns
    -------
    float
        Share of the whole power; the quantile of Beta(1, m - 1) at ``1 - chance / m``. [-]
    """
    if lines < 2:
        return 1.0
    return 1.0 - math.pow(chance / lines, 1.0 / (lines - 1))


def power_threshold(
    order: int, runs: int, replicates: int = 1, parameters: int = 1, chance: float = CHANCE
) -> float:
    """What the power on the own lines of any parameter exceeds by chance with probability `chance`.

    Parameters
    ----------
    order : int
        Lines M per parameter. [-]
    runs : int
        Runs N per replicate. [-]
    replicates : int
        Number of replicates R averaged. [-]
    parameters : int
        Number of parameters looked at. [-]
    chance : float
        [-]

    Returns
    -------
    float
        Share of the variance. [-]
    """
    from scipy import stats

    lines = (runs - 1) // 2
    if lines <= order:
        return 1.0
    tail = chance / parameters
    return float(stats.beta.isf(tail, replicates * order, replicates * (lines - order)))


@dataclass(frozen=True, eq=False)
class _Sound:
    """Something that stands out in most replicates: its line in each and its mean power."""

    kind: PeakKind
    label: str
    parameters: tuple[str, ...]
    lines: Integers
    power: float


def _heard(
    spectra: Floats, frequencies: Integers, runs: int, names: Sequence[str], threshold: float
) -> Iterator[_Sound]:
    """Fundamentals, harmonics and interactions that stand out in most replicates."""
    # Line 0 and, with an even number of runs, the last one are not in the spectrum.
    padded = np.pad(spectra, ((0, 0), (1, runs // 2 - spectra.shape[1])))
    rows = np.arange(spectra.shape[0])[:, None]
    needed = math.ceil(_SURVIVES * spectra.shape[0])

    def standing(lines: Integers) -> tuple[Integers, Integers, Floats]:
        folded = _folded(lines, runs)
        found = padded[rows, folded]
        survivors = np.flatnonzero((found > threshold).sum(axis=0) >= needed)
        return survivors, folded, found.mean(axis=0)

    loudness = np.zeros(len(names))
    for harmonic in range(1, _HARMONICS + 1):
        survivors, lines, power = standing(harmonic * frequencies)
        for i in survivors:
            loudness[i] += power[i]
            kind: PeakKind = "fundamental" if harmonic == 1 else "harmonic"
            label = _times(harmonic, names[i])
            yield _Sound(kind, label, (names[i],), lines[:, i], float(power[i]))
    first, second = _pairs(loudness)
    if not first.size:
        return
    for a, b, sign in itertools.product((1, 2), (1, 2), (1, -1)):
        survivors, lines, power = standing(a * frequencies[:, first] + sign * b * frequencies[:, second])
        for p in survivors:
            i, j = names[first[p]], names[second[p]]
            label = f"{_times(a, i)} {'+' if sign > 0 else '−'} {_times(b, j)}"
            yield _Sound("interaction", label, (i, j), lines[:, p], float(power[p]))


def _pairs(loudness: Floats) -> tuple[Integers, Integers]:
    """Pairs of parameters whose interaction is looked for."""
    first, second = np.triu_indices(loudness.size, 1)
    if loudness.size > _ALL_PAIRS_UP_TO:
        loud = np.zeros(loudness.size, dtype=np.bool_)
        loud[np.argsort(-loudness)[:_LOUDEST]] = True
        loud &= loudness > 0.0
        keep = loud[first] | loud[second]
        first, second = first[keep], second[keep]
    return first.astype(np.int64), second.astype(np.int64)


def _folded(lines: Integers, runs: int) -> Integers:
    """Where a frequency shows among the lines 0 ... N // 2 when only N runs see it."""
    rest = np.mod(np.abs(lines), runs)
    folded: Integers = np.minimum(rest, runs - rest)
    return folded


def _times(factor: int, name: str) -> str:
    return name if factor == 1 else f"{factor} × {name}"


def _peak(line: int, power: float, sounds: Sequence[_Sound]) -> Peak:
    if not sounds:
        return Peak(line, power, "unnamed", "", ())
    best = sounds[0]
    return Peak(line, power, best.kind, best.label, best.parameters, tuple(s.label for s in sounds[1:]))
