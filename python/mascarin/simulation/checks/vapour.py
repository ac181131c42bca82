"""The vapour balance of a run of a building with humidity."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Self

from mascarin.simulation.checks.energy import CLOSED
from mascarin.simulation.checks.step_check import STEPS
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

VAPOUR_FLOWS: Final = ("outdoor_air", "interzone", "gains", "humidifying", "drying", "condensation")
"""Flows of vapour into the zones; drying and condensation take vapour away and are negative."""


#: Exchanges of the vapour of an air within a step up to which the scheme by itself keeps the humidity between
#: its causes: 1/(2 g - 1) of SDIRK2, with g = 1 - 1/sqrt(2), as a magnitude [-].
MOST_EXCHANGES: Final = 1.0 + 2.0**0.5
#: Shortest step that is proposed [s].
SHORTEST: Final = 60.0


@dataclass(frozen=True)
class VapourLedger:
    """Vapour by flow over a run, the vapour stored in air and surfaces, and how well they balance.

    Parameters
    ----------
    into : mapping of str to float
        Net vapour into the zones by flow. [kg]
    stored : float
        Rise of the vapour stored in the air and behind surfaces. [kg]
    exchanged : float
        Sum of the magnitudes of all flows. [kg]
    relative_residual : float
        Sum over steps of |stored - into|, over all vapour exchanged. [-]
    corrected : int
        Steps in which the humidity of an air was kept between its causes by more than 0.1 g/kg.
    fastest : float
        Fastest exchange of the vapour of an air in these steps. [1/s]

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> damp = box().replace({"humidity": {"zones": {"room": {"gains": {"people": {"power": 100}}}}}})
    >>> ledger = mc.simulate(damp, box_climate(), step="1h").vapour
    >>> ledger.into["gains"] > 0.0 and ledger.closes
    True
    """

    into: Mapping[str, float]
    stored: float
    exchanged: float
    relative_residual: float
    corrected: int = 0
    fastest: float = 0.0

    @property
    def closes(self) -> bool:
        """Whether the vapour stored is the vapour that flowed in: a residual of 1e-10 at most."""
        return self.relative_residual <= CLOSED

    def warnings(self, step_seconds: float) -> list[RunWarning]:
        """One line each where the balance does not close, saturated air lost vapour, the step is too long.

        Parameters
        ----------
        step_seconds : float
            Time step. [s]
        """
        messages: list[RunWarning] = []
        if self.corrected and self.fastest > 0.0 and step_seconds > SHORTEST:
            longest = min(MOST_EXCHANGES / self.fastest, 0.99 * step_seconds) / 60.0
            better = next((step for step in STEPS if step <= longest), STEPS[-1])
            within = 1.0 / self.fastest / 60.0
            steps = "one step" if self.corrected == 1 else f"{self.corrected} steps"
            text = (
                f"the time step of {step_seconds / 60.0:g} min is too long for the vapour of the air, which "
                f"was exchanged within {within:.2g} min in {steps}: its humidity was kept "
                "between that of the air and of the surfaces that drive it, and is less accurate there; "
                f"take a step of {better} min"
            )
            messages.append(RunWarning(text, WarningKind.STEP))
        if not self.closes:
            text = (
                "the vapour balance does not close: the vapour stored and the vapour that flowed in differ "
                f"by {self.relative_residual:.1e} of all vapour exchanged, expected {CLOSED:g} at most. "
                "Humidities may be wrong by as much or more: take a shorter step"
            )
            messages.append(RunWarning(text, WarningKind.VAPOUR_BALANCE))
        lost = -self.into["condensation"]
        if lost > 0.01 * self.exchanged:
            text = (
                f"the air of zones was saturated: {lost:.3g} kg of vapour condensed, "
                f"{100 * lost / self.exchanged:.0f} % of all vapour exchanged. It is taken away, and its "
                "heat is not given to the room. Check the sources of vapour and the ventilation"
            )
            messages.append(RunWarning(text, WarningKind.SATURATION))
        return messages

    @classmethod
    def read(cls, raw: Mapping[str, Any]) -> Self:
        """Make one from the values that the engine returns.

        Parameters
        ----------
        raw : mapping
            Vapour by flow, ``stored``, ``exchanged`` [kg], ``closure`` [-], ``corrected`` [-] and
            ``fastest`` [1/s].
        """
        into = {flow: float(raw[flow]) for flow in VAPOUR_FLOWS}
        stored, exchanged, residual = (float(raw[key]) for key in ("stored", "exchanged", "closure"))
        corrected, fastest = int(raw["corrected"]), float(raw["fastest"])
        return cls(into, stored, exchanged, residual, corrected, fastest)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Make one from the values of `to_dict`.

        Parameters
        ----------
        values : mapping of str to float
            The values.
        """
        into = {flow: float(values[f"{flow}_kg"]) for flow in VAPOUR_FLOWS}
        stored, exchanged = float(values["stored_kg"]), float(values["exchanged_kg"])
        # Files of versions before these numbers have none.
        corrected, fastest = (
            int(values.get("corrected_steps", 0)),
            float(values.get("fastest_per_second", 0.0)),
        )
        return cls(into, stored, exchanged, float(values["closure"]), corrected, fastest)

    @classmethod
    def from_json(cls, text: str | None) -> Self | None:
        """Read the values of `to_dict`; None where there are none.

        Parameters
        ----------
        text : str or None
            The values as JSON.
        """
        return None if text is None else cls.from_dict(json.loads(text))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        into = {f"{flow}_kg": value for flow, value in self.into.items()}
        return {
            "closure": self.relative_residual,
            "stored_kg": self.stored,
            "exchanged_kg": self.exchanged,
            **into,
            "corrected_steps": self.corrected,
            "fastest_per_second": self.fastest,
        }

    def __repr__(self) -> str:
        return str(self)

    def __str__(self) -> str:
        lines = [f"{flow:<14}{value:>12.4f} kg" for flow, value in self.into.items()]
        residual = f"relative residual of the vapour balance {self.relative_residual:.1e}"
        return "\n".join([*lines, f"{'stored':<14}{self.stored:>12.4f} kg", residual])
