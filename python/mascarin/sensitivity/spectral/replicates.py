"""What the spectral analysis keeps of one replicate: the Fourier transform of its outputs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.spectral.designs import Design


@dataclass(frozen=True, eq=False)
class Replicate:
    """Sums over the runs of one replicate.

    Attributes
    ----------
    real : ndarray, shape (G, M, T, S)
        Real parts of the coefficients, turned by the phase of the parameter. [unit of the output]
    power : ndarray, shape (G, T, S)
        Half the squared coefficients, summed over the harmonics; for groups of several factors less the
        noise. [square of the unit]
    raw : ndarray, shape (G, S)
        The same summed over time, without subtraction of noise. [square of the unit]
    mean, variance : ndarray, shape (T, S)
        Mean and variance over the runs. [unit, and its square]
    lines : ndarray, shape (K, S)
        Power of all lines, summed over time. [square of the unit]
    gain : ndarray, shape (G,)
        Fundamental of the search curve of the parameter, divided by its range; NaN for groups of several
        factors. [-]
    """

    real: Floats
    power: Floats
    raw: Floats
    mean: Floats
    variance: Floats
    lines: Floats
    gain: Floats


def transform(plan: Design, replicate: int, y: Floats) -> Replicate:
    """Fourier transform of the outputs of one replicate.

    Parameters
    ----------
    plan : Design
        The runs.
    replicate : int
        Number of the replicate.
    y : ndarray, shape (N, T, S)
        Outputs by run, time and output. [unit of each output]

    Returns
    -------
    Replicate
        What the analysis needs.
    """
    n, m = plan.runs, plan.order
    mean = y.mean(axis=0)
    centred = y - mean
    spectrum = np.fft.rfft(centred, axis=0)[1 : (n - 1) // 2 + 1] * (2.0 / n)
    w = plan.frequencies[replicate]
    single = np.array([plan.members(g)[0] for g in range(len(plan.groups))])
    phase = plan.phases[replicate][single] - 0.5 * np.pi
    harmonics = np.arange(1, m + 1)
    lines = np.outer(w, harmonics)
    turn = np.exp(-1j * np.outer(phase, harmonics))
    coefficients = spectrum[lines - 1] * turn[:, :, None, None]
    squared = spectrum.real**2 + spectrum.imag**2
    power = 0.5 * squared[lines - 1].sum(axis=1)
    raw = power.sum(axis=1)
    sizes = np.bincount(plan.group_of)
    free = np.setdiff1d(np.arange(1, squared.shape[0] + 1), lines)
    floor = 0.5 * m * squared[free - 1].mean(axis=0) if free.size and (sizes > 1).any() else 0.0
    return Replicate(
        real=coefficients.real,
        power=np.where((sizes > 1)[:, None, None], power - floor, power),
        raw=raw,
        mean=mean,
        variance=np.mean(centred**2, axis=0),
        lines=0.5 * squared.sum(axis=1),
        gain=_gains(plan, replicate),
    )


def _gains(plan: Design, replicate: int) -> Floats:
    """Fundamental of the search curve of each single factor over its range; NaN for groups. [-]"""
    gains = np.full(len(plan.groups), np.nan)
    s = 2.0 * np.pi * np.arange(plan.runs) / plan.runs
    for g in range(len(plan.groups)):
        members = plan.members(g)
        if members.size == 1:
            i = int(members[0])
            factor = plan.factors[i]
            angle = plan.frequencies[replicate, g] * s + plan.phases[replicate, i]
            curve = factor.curve(angle)
            fundamental = 2.0 * np.mean(curve * np.cos(angle - 0.5 * np.pi))
            gains[g] = fundamental / (factor.high - factor.low)
    return gains
