"""What a run has done that its surroundings cannot cause; see docs/engine.md, "What is impossible"."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np

from mascarin._io.sealed.own_files import json_of
from mascarin.simulation.checks.energy import balance_warnings
from mascarin.simulation.checks.step_check import STEPS
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: The longest step that is recommended, as a part of the step that was taken. [-]
_SHORTER: Final = 0.25
#: SDIRK2: its diagonal coefficient, the step over the time constant of a part up to which the part does not
#: overshoot, and the largest overshoot of a part, over the jump that it follows; see docs/engine.md. [-]
_DIAGONAL: Final = 1.0 - 0.5**0.5
_MONOTONE_UP_TO: Final = 1.0 + 2.0**0.5
_LARGEST: Final = 0.5 * (2.0**0.5 - 1.0)
#: The scheme that does not overshoot.
_MONOTONE: Final = "backward-euler"


@dataclass(frozen=True)
class Judgement:
    """Temperatures of a run against all that could cause them.

    Parameters
    ----------
    outside : float
        How far a temperature was below the lowest, or above the highest, of the start and of all temperatures
        that acted on the building, beyond what is allowed; zero in a sound run. [K]
    place : str
        Part of the building where that was largest; empty in a sound run.
    when : str
        Step of that, with its time.
    temperature : float
        The temperature there. [degC]
    bound : float
        The lowest or highest of its causes. [degC]
    span : float
        From the lowest to the highest of its causes. [K]

    Examples
    --------
    >>> Judgement().sound
    True
    """

    outside: float = 0.0
    place: str = ""
    when: str = ""
    temperature: float = 0.0
    bound: float = 0.0
    span: float = 0.0

    @property
    def sound(self) -> bool:
        """Whether every temperature has a cause."""
        return self.outside <= 0.0

    @classmethod
    def read(cls, raw: Mapping[str, Any], dated: Callable[[str], str]) -> Self:
        """Make one from what the engine returns of a run.

        Parameters
        ----------
        raw : mapping
            ``outside`` [K] and ``outlier``: step, place, temperature and bound [degC], range of the
            causes [K], or None.
        dated : callable
            Adds the time to a text that names a step.
        """
        if raw["outlier"] is None:
            return cls()
        step, place, *numbers = raw["outlier"]
        return cls(float(raw["outside"]), place, dated(f"step {step}"), *map(float, numbers))

    def warnings(self, step_seconds: float, scheme: str) -> list[RunWarning]:
        """One line where a temperature has no cause, else nothing.

        Parameters
        ----------
        step_seconds : float
            Time step of the run. [s]
        scheme : str
            Time-stepping scheme of the run.
        """
        if self.sound:
            return []
        side, cause = ("below", "lowest") if self.temperature < self.bound else ("above", "highest")
        beyond = abs(self.temperature - self.bound)
        text = (
            f"{self.place}: {self.temperature:.1f} degC in {self.when} lies {side} all that acts on it "
            f"(the {cause} is {self.bound:.1f} degC), by {beyond:.2g} K: do not use these results. Take a "
            f"step of {_shorter(step_seconds, beyond, self.span):g} min"
            f"{'' if scheme == _MONOTONE else f', or the scheme {_MONOTONE}'}"
        )
        return [RunWarning(text, WarningKind.CAUSE)]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)

    @classmethod
    def from_json(cls, text: str | None) -> Self | None:
        """Make one from what a file holds of `to_dict`; None where it holds nothing.

        Parameters
        ----------
        text : str or None
            JSON.
        """
        if text is None:
            return None
        values = json_of(text)
        outside, temperature, bound = (float(values[key]) for key in ("outside", "temperature", "bound"))
        # Files of versions before this number have none.
        span = float(values.get("span", 0.0))
        return cls(outside, str(values["place"]), str(values["when"]), temperature, bound, span)


JUDGED: Final = ("closure", "outside")
"""Names of what says whether a member of an ensemble is sound."""
OUTSIDE: Final = {"units": "K", "long_name": "temperatures beyond their causes"}
"""Attributes of the variable ``outside``."""


def ensemble_warnings(
    residuals: Array, outside: Array, first: int = 0, precision: str = "double"
) -> list[RunWarning]:
    """What is not sound in the members of an ensemble: a line for each kind, or nothing.

    Parameters
    ----------
    residuals : ndarray, shape (members,)
        Relative energy-balance residual of each member; NaN for one that failed. [-]
    outside : ndarray, shape (members,)
        `Judgement.outside` of each member; NaN for one that failed. [K]
    first : int
        Number of the first member.
    precision : str
        Of the members: ``double`` or ``single``.

    Examples
    --------
    >>> ensemble_warnings(np.zeros(3), np.array([0.0, np.nan, 2.5]))[0][:53]
    '1 of 3 members: temperatures lie outside of everythin'
    """
    lines = balance_warnings(residuals, first, precision)
    members = np.flatnonzero(outside > 0.0)
    if not members.size:
        return lines
    worst = int(np.nanargmax(outside))
    text = (
        f"{members.size} of {len(outside)} members: temperatures lie outside of everything that acts on the "
        f"building, by {outside[worst]:.2g} K more than is allowed (member {first + worst}): do not use "
        "their results. Take a shorter step, which a run of this member alone names, or the scheme "
        "backward-euler"
    )
    return [*lines, RunWarning(text, WarningKind.CAUSE)]


def all_sound(table: Mapping[str, Any] | Any, precision: str = "double") -> bool:
    """Whether every member of an ensemble is sound.

    Parameters
    ----------
    table : pandas.DataFrame or mapping
        Columns ``closure`` and ``outside``, as `sweep` has them.
    precision : str
        Of the members: ``double`` or ``single``.

    Examples
    --------
    >>> all_sound({"closure": np.zeros(2), "outside": np.array([0.0, 3.0])})
    False
    """
    closure, outside = (np.asarray(table[name], dtype=np.float64) for name in JUDGED)
    return not ensemble_warnings(closure, outside, precision=precision)


def _shorter(step_seconds: float, beyond: float, span: float) -> float:
    """The step without overshoot [min], for a part that went beyond its causes, which have a span [K].

    Of the two time constants of a part that overshoot this much, the shorter one counts.
    """
    part = _SHORTER
    if span > 0.0:
        # |R(z)| = ((sqrt 2 - 1) z - 1)/(1 + g z)^2 of the step over the time constant, z, solved for z.
        share = min(beyond / span, _LARGEST)
        linear = 2.0 * (_LARGEST - _DIAGONAL * share)
        root = max(linear**2 - 4.0 * _DIAGONAL**2 * share * (1.0 + share), 0.0) ** 0.5
        part = min(part, _MONOTONE_UP_TO * 2.0 * _DIAGONAL**2 * share / (linear + root))
    minutes = step_seconds / 60.0 * part
    return next((float(step) for step in STEPS if step <= minutes), minutes)
