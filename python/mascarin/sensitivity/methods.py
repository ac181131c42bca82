"""The methods by name: their runs, and the analysis of the outputs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, Literal

from numpy.typing import ArrayLike

from mascarin._io.arguments import whole_number
from mascarin.errors import InputError, did_you_mean
from mascarin.progress import ProgressOption, reporting
from mascarin.sensitivity import salib, spectral
from mascarin.sensitivity.base.factors import Factor, Floats
from mascarin.sensitivity.base.result import Sensitivity
from mascarin.sensitivity.base.runs import Collector, batches

MethodName = Literal["spectral", "rbd-fast", "sobol", "morris"]

METHODS: Final[tuple[MethodName, ...]] = ("spectral", "rbd-fast", "sobol", "morris")

Plan = spectral.Design | salib.SalibPlan
"""The runs of a method: names of parameters, replicates, samples."""

#: More repetitions narrow no interval that anybody reads; each has a design of its own.
MAX_REPLICATES: Final = 1000
#: Runs of an analysis: years of computing time for any building.
MAX_RUNS: Final = 100_000_000


def plan(
    factors: Sequence[Factor],
    method: MethodName = "spectral",
    *,
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
) -> Plan:
    """Plan the runs of a method.

    Parameters
    ----------
    factors : sequence of Factor
        What varies, in which range and with which distribution; factors of one group are analyzed together.
    method : str
        ``spectral``, or by SALib ``rbd-fast``, ``sobol`` or ``morris``.
    replicates : int
        Independent repetitions, at least 3; the intervals come from their spread. [-]
    samples : int, optional
        Size of a replicate: runs (spectral, RBD-FAST), base points of G + 2 runs (Sobol), trajectories of
        G + 1 runs (Morris), for G parameters or groups. [-]
    order : int, optional
        Harmonics that are attributed to a parameter (spectral, RBD-FAST). [-]
    seed : int
        Seed of the random numbers; the same seed gives the same runs.

    Returns
    -------
    Design or SalibPlan
        For `run`, or to be run by other means and added to its `collector`.

    Raises
    ------
    InputError
        Unknown method, numbers that it cannot use, or SALib is not installed.

    Examples
    --------
    >>> runs = plan([Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0)], replicates=4)
    >>> runs.replicates, runs.runs, runs.samples(0).shape
    (4, 257, (257, 2))
    """
    if method not in METHODS:
        msg = f"method: found '{method}', expected one of {', '.join(METHODS)}. "
        raise InputError(f"{msg}{did_you_mean(method, METHODS, known=False)}".rstrip())
    whole_number("replicates", replicates)
    whole_number("seed", seed)
    if samples is not None:
        whole_number("samples", samples, 1)
    if order is not None:
        whole_number("order", order, 1)
    if replicates > MAX_REPLICATES:
        raise InputError(f"replicates: found {replicates}, expected at most {MAX_REPLICATES}")
    # A replicate has at least as many runs as samples, and two for each harmonic.
    least = replicates * max(samples or 1, 2 * (order or 1))
    if least > MAX_RUNS:
        raise InputError(
            f"found {replicates} replicates with samples {samples} and order {order}: {least:.3g} runs or "
            f"more, expected at most {MAX_RUNS:.0e}. Take fewer samples or replicates, or a lower order"
        )
    if method == "spectral":
        return spectral.design(factors, replicates=replicates, order=order, runs=samples, seed=seed)
    return salib.plan(factors, method, replicates=replicates, samples=samples, order=order, seed=seed)


def collector(
    plan: Plan, outputs: Sequence[str], units: Sequence[str] | None = None
) -> Collector[Any, Sensitivity]:
    """Make the collector that takes the outputs of the runs and analyzes them.

    Parameters
    ----------
    plan : Design or SalibPlan
        The runs.
    outputs, units : sequence of str, length S
        Names and units of the outputs.

    Returns
    -------
    Collector
        Takes outputs by ``add(first, values)``; ``result()`` analyzes them.

    Raises
    ------
    InputError
        No output, or another number of units.

    Examples
    --------
    >>> runs = plan([Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0)])
    >>> taken = collector(runs, ["y"])
    >>> for r in range(runs.replicates):
    ...     taken.add(r * runs.runs, runs.samples(r) @ [[1.0], [0.0]])
    >>> taken.result().index[:, 0].round(2).tolist()
    [1.0, 0.0]
    """
    if isinstance(plan, spectral.Design):
        return spectral.SpectralCollector(plan, outputs, units=units)
    return salib.SalibCollector(plan, outputs, units=units)


def run(
    plan: Plan,
    evaluate: Callable[[Floats], ArrayLike],
    *,
    outputs: Sequence[str],
    units: Sequence[str] | None = None,
    batch: int = 256,
    confidence: float = 0.95,
    progress: ProgressOption = None,
) -> Sensitivity:
    """Make the runs of a plan in batches and analyze them.

    Parameters
    ----------
    plan : Design or SalibPlan
        The runs, of any method.
    evaluate : callable
        ``(m, P) -> (m, T, S)``: outputs of a batch of runs.
    outputs, units : sequence of str, length S
        Names and units of the outputs.
    batch : int
        Largest number of runs in a batch. [-]
    confidence : float
        Of the intervals. [-]
    progress : bool or callable, optional
        See `mascarin.progress.ProgressOption`.

    Returns
    -------
    Sensitivity
        Indices with intervals and effects.

    Raises
    ------
    InputError
        Outputs of another shape, or values that are not finite.

    Examples
    --------
    >>> factors = [Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0)]
    >>> found = run(plan(factors), lambda x: x @ [[3.0], [1.0]], outputs=["y"])
    >>> found.ranking("y")
    ['a', 'b']
    """
    taken = collector(plan, outputs, units)
    with reporting(progress, "sensitivity") as report:
        for first, x in batches(plan, batch):
            taken.add(first, evaluate(x))
            report(first + x.shape[0], len(plan))
    return taken.result(confidence=confidence)
