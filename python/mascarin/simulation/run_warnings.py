"""Warnings of runs, in one place: every entrance that runs a building gives them.

Another check of a run joins in `collected`, one of members of an ensemble in `of_members`; every entrance
then gives its warnings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.simulation.checks.formula_laws import member_range_warnings, range_warnings
from mascarin.simulation.checks.judgement import ensemble_warnings
from mascarin.simulation.checks.step_check import LARGE
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind, of_kind

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.simulation.checks.energy import EnergyLedger
    from mascarin.simulation.checks.judgement import Judgement
    from mascarin.simulation.checks.vapour import VapourLedger
    from mascarin.simulation.records.blocks import Watch

    Array = npt.NDArray[np.float64]


def collected(
    energy: EnergyLedger,
    vapour: VapourLedger | None,
    watch: Watch,
    *,
    step_seconds: float,
    building: Sequence[str] = (),
    judged: Iterable[RunWarning] = (),
) -> tuple[RunWarning, ...]:
    """All warnings of one run.

    Parameters
    ----------
    energy : EnergyLedger
        Its energy balance.
    vapour : VapourLedger or None
        Its vapour balance.
    watch : Watch
        What was watched in its records.
    step_seconds : float
        Time step. [s]
    building : sequence of str
        Warnings about the building, which every run of it has.
    judged : iterable of RunWarning
        Further warnings, of checks that the engine makes of a run.

    Returns
    -------
    tuple of RunWarning
        The balances, further checks, layers that do not melt, steps too long for the air of a zone; last
        those about the building.
    """
    lines = [*energy.warnings(), *(vapour.warnings(step_seconds) if vapour is not None else ()), *judged]
    lines += [*of_kind(WarningKind.LATENT, watch.melting.warnings()), *watch.bends.warnings(step_seconds)]
    return tuple(dict.fromkeys((*lines, *of_kind(WarningKind.BUILDING, building))))


def of_engine(
    judgement: Judgement,
    raw: Mapping[str, Any],
    dated: Callable[[str], str],
    step_seconds: float,
    scheme: str,
) -> list[RunWarning]:
    """Warnings of checks that the engine makes of a run.

    Parameters
    ----------
    judgement : Judgement
        Temperatures against their causes.
    raw : mapping
        What the engine returns of the run.
    dated : callable
        Adds the time to a text that names a step.
    step_seconds : float
        Time step. [s]
    scheme : str
        Time-stepping scheme.

    Returns
    -------
    list of RunWarning
        A temperature without a cause, laws that were used where they do not hold.
    """
    return [
        *judgement.warnings(step_seconds, scheme),
        *of_kind(WarningKind.VALIDITY, range_warnings(raw, dated)),
    ]


def of_members(
    closure: Array,
    outside: Array,
    step_errors: Array,
    beyond: Array,
    *,
    step_seconds: float,
    first: int = 0,
    precision: str = "double",
) -> list[RunWarning]:
    """Warnings about members of an ensemble, each for all members that it holds for.

    Parameters
    ----------
    closure : ndarray, shape (members,)
        Relative energy-balance residual; NaN for a member that failed. [-]
    outside : ndarray, shape (members,)
        How far temperatures are beyond their causes; NaN for a member that failed. [K]
    step_errors : ndarray, shape (members,)
        Error of an air by the time step; NaN where no air was recorded. [K]
    beyond : ndarray, shape (members,)
        Steps in which a law written as text did not hold; NaN for a member that failed.
    step_seconds : float
        Time step. [s]
    first : int
        Number of the first member.
    precision : str
        Of the members: ``double`` or ``single``.

    Returns
    -------
    list of RunWarning
        One line for each kind of warning.

    Examples
    --------
    >>> zeros, errors = np.zeros(2), np.array([0.1, 0.5])
    >>> of_members(zeros, zeros, errors, zeros, step_seconds=3600.0)[0][:74]
    '1 of 2 members: the time step of 60 min is too long for the air of a zone,'
    """
    lines = [*ensemble_warnings(closure, outside, first, precision), *member_range_warnings(beyond, first)]
    late = np.flatnonzero(step_errors >= LARGE)
    if late.size:
        worst = int(np.nanargmax(step_errors))
        text = (
            f"{late.size} of {len(step_errors)} members: the time step of {step_seconds / 60.0:g} min is too "
            f"long for the air of a zone, whose temperature is wrong by about {step_errors[worst]:.1g} K "
            f"(root mean square) in member {first + worst}: take a shorter step"
        )
        lines.append(RunWarning(text, WarningKind.STEP))
    return lines


def of_base(warnings: Sequence[RunWarning]) -> list[RunWarning]:
    """Warnings of a run with the values of the building, as an ensemble says them."""
    return [line.after("with the values of the building") for line in warnings]
