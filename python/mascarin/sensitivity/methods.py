"""The methods by name, behind one call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from mascarin.errors import InputError, did_you_mean
from mascarin.sensitivity import salib, spectral
from mascarin.sensitivity.factors import Factor
from mascarin.sensitivity.runs import Plan

MethodName = Literal["spectral", "rbd-fast", "sobol", "morris"]

METHODS: Final[tuple[MethodName, ...]] = ("spectral", "rbd-fast", "sobol", "morris")


def plan(
    factors: Sequence[Factor],
    method: MethodName = "spectral",
    *,
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
) -> Plan:
    """Which runs a method needs.

    Parameters
    ----------
    factors : sequence of Factor
        What varies, in which range and with which distribution; those of one group are judged together.
    method : str
        ``spectral`` (ours), or by SALib ``rbd-fast``, ``sobol``, ``morris``.
    replicates : int
        Independent repetitions, at least 3: intervals come from their spread. [-]
    samples : int, optional
        Size of a replicate: runs (spectral, RBD-FAST), base points of G + 2 runs (Sobol), trajectories of
        G + 1 runs (Morris), for G parameters or groups. [-]
    order : int, optional
        Harmonics that count as a parameter's own (spectral, RBD-FAST). [-]
    seed : int
        Of the random numbers; the same seed gives the same runs.

    Returns
    -------
    Plan
        To be handed to `run`, or run by hand and added to its ``collector``.

    Raises
    ------
    InputError
        Unknown method, numbers that it cannot use, SALib not installed.
    """
    if method not in METHODS:
        msg = f"method '{method}' is not known: expected one of {', '.join(METHODS)}. "
        raise InputError(msg + did_you_mean(method, METHODS))
    if method == "spectral":
        return spectral.design(factors, replicates=replicates, order=order, runs=samples, seed=seed)
    return salib.plan(factors, method, replicates=replicates, samples=samples, order=order, seed=seed)
