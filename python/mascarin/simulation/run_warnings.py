"""Warnings of runs, in one place: every entrance that runs a building gives them.

Another check of a run joins in `collected`, one of members of an ensemble in `of_members`; every entrance
then gives its warnings.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.simulation.checks.formula_laws import range_warnings
from mascarin.simulation.checks.judgement import ensemble_warnings
from mascarin.simulation.checks.step_check import LARGE

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.simulation.checks.energy import EnergyLedger
    from mascarin.simulation.checks.judgement import Judgement
    from mascarin.simulation.checks.vapour import VapourLedger
    from mascarin.simulation.records.blocks import Watch

    Array = npt.NDArray[np.float64]

#: Words of the warnings of `EnergyLedger`, `Judgement`, `ensemble_warnings` and `of_nominal` that say that a
#: run is not sound or has failed. Warnings travel as texts: through files, kept results and other processes.
_UNSOUND: Final = re.compile(
    r"energy balance (does|of \d+ of \d+ members does) not close|do not use (these|their) results|"
    r"a run with the values of the building failed"
)


def collected(
    energy: EnergyLedger,
    vapour: VapourLedger | None,
    watch: Watch,
    *,
    step_seconds: float,
    building: Sequence[str] = (),
    judged: Iterable[str] = (),
) -> tuple[str, ...]:
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
    judged : iterable of str
        Further warnings, of checks that the engine makes of a run.

    Returns
    -------
    tuple of str
        The balances, further checks, layers that do not melt, steps too long for the air of a zone; last
        those about the building.
    """
    lines = [*energy.warnings(), *(vapour.warnings(step_seconds) if vapour is not None else ()), *judged]
    lines += [*watch.melting.warnings(), *watch.bends.warnings(step_seconds)]
    return tuple(dict.fromkeys((*lines, *building)))


def of_engine(
    judgement: Judgement,
    raw: Mapping[str, Any],
    dated: Callable[[str], str],
    step_seconds: float,
    scheme: str,
) -> list[str]:
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
    list of str
        A temperature without a cause, laws that were used where they do not hold.
    """
    return [*judgement.warnings(step_seconds, scheme), *range_warnings(raw, dated)]


def of_members(
    closure: Array,
    outside: Array,
    step_errors: Array,
    *,
    step_seconds: float,
    first: int = 0,
    precision: str = "double",
) -> list[str]:
    """Warnings about members of an ensemble, each for all members that it holds for.

    Parameters
    ----------
    closure : ndarray, shape (members,)
        Relative energy-balance residual; NaN for a member that failed. [-]
    outside : ndarray, shape (members,)
        How far temperatures are beyond their causes; NaN for a member that failed. [K]
    step_errors : ndarray, shape (members,)
        Error of an air by the time step; NaN where no air was recorded. [K]
    step_seconds : float
        Time step. [s]
    first : int
        Number of the first member.
    precision : str
        Of the members: ``double`` or ``single``.

    Returns
    -------
    list of str
        One line for each kind of warning.

    Examples
    --------
    >>> of_members(np.zeros(2), np.zeros(2), np.array([0.1, 0.5]), step_seconds=3600.0)[0][:74]
    '1 of 2 members: the time step of 60 min is too long for the air of a zone,'
    """
    lines = ensemble_warnings(closure, outside, first, precision)
    late = np.flatnonzero(step_errors >= LARGE)
    if late.size:
        worst = int(np.nanargmax(step_errors))
        lines.append(
            f"{late.size} of {len(step_errors)} members: the time step of {step_seconds / 60.0:g} min is too "
            f"long for the air of a zone, whose temperature is wrong by about {step_errors[worst]:.1g} K "
            f"(root mean square) in member {first + worst}: take a shorter step"
        )
    return lines


def says_unsound(warnings: Iterable[str]) -> bool:
    """Whether a warning says that a run is not sound or has failed.

    Parameters
    ----------
    warnings : iterable of str
        Warnings of runs, of members of ensembles, or of the run with the values of the building.

    Examples
    --------
    >>> says_unsound(["roof: 70.0 degC ...: do not use these results. Take a step of 15 min"])
    True
    >>> says_unsound(["roof: the layer pcm stayed solid"])
    False
    """
    return any(_UNSOUND.search(line) for line in warnings)


def of_base(warnings: Sequence[str]) -> list[str]:
    """Warnings of a run with the values of the building, as an ensemble says them."""
    return [f"with the values of the building: {text}" for text in warnings]
