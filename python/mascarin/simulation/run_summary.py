"""What is known of a run when it has finished, beside its series; and a run whose series are in a file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Final

from mascarin.simulation.checks.warning_kinds import RunWarning, kinds_of

if TYPE_CHECKING:
    from pathlib import Path

    from mascarin.building import Output
    from mascarin.simulation.checks.energy import EnergyLedger
    from mascarin.simulation.checks.judgement import Judgement
    from mascarin.simulation.checks.vapour import VapourLedger
    from mascarin.simulation.preparation.initial_state import InitialTemperatures
    from mascarin.simulation.records.provenance import Provenance
    from mascarin.simulation.records.times import Times

_FORMAT: Final = 1
#: A first period that is repeated more often, and makes more than this part of all steps, is pointed out.
_MANY_CYCLES: Final = 4
_LARGE_SHARE: Final = 0.5


@dataclass(frozen=True)
class Finished:
    """What is known of a run when it has finished.

    Parameters
    ----------
    energy : EnergyLedger
        The energy balance.
    provenance : Provenance
        Version, inputs and options.
    warnings : tuple of RunWarning
        Warnings about the run.
    vapour : VapourLedger or None
        The vapour balance of a building with humidity.
    judgement : Judgement or None
        Temperatures against their causes; None for a run of an earlier version.
    """

    energy: EnergyLedger
    provenance: Provenance
    warnings: tuple[RunWarning, ...] = ()
    vapour: VapourLedger | None = None
    judgement: Judgement | None = None

    @property
    def sound(self) -> bool:
        """Whether the balances of heat and vapour close and every temperature has a cause."""
        closed = self.energy.closes and (self.vapour is None or self.vapour.closes)
        return closed and (self.judgement is None or self.judgement.sound)

    def attributes(self, outputs: Sequence[Output], timezone: str) -> dict[str, Any]:
        """Version, provenance, energy balance and outputs, as files hold them.

        Parameters
        ----------
        outputs : sequence of Output
            What was recorded.
        timezone : str
            Zone of the local clock.
        """
        return {
            "mascarin_version": self.provenance.version,
            "mascarin_format": _FORMAT,
            "timezone": timezone,
            "provenance": json.dumps(self.provenance.to_dict()),
            "energy": json.dumps(self.energy.to_dict()),
            **({} if self.vapour is None else {"vapour": json.dumps(self.vapour.to_dict())}),
            **({} if self.judgement is None else {"judgement": json.dumps(self.judgement.to_dict())}),
            "warnings": json.dumps(list(self.warnings)),
            "warning_kinds": json.dumps(kinds_of(self.warnings)),
            "outputs": json.dumps([asdict(output) for output in outputs]),
        }


@dataclass(frozen=True)
class StoredRun:
    """A run whose series were written to a file while it went on; `Results.open` reads them.

    Parameters
    ----------
    path : Path
        The file.
    outputs : sequence of Output
        What was recorded.
    times : Times
        Times of the records.
    finished : Finished
        Energy balance, provenance and warnings.
    """

    path: Path
    outputs: Sequence[Output]
    times: Times
    finished: Finished


def start_note(
    initial: float | InitialTemperatures | None,
    settings: Mapping[str, Any],
    repeated_seconds: float,
    steps: int,
    raw: Mapping[str, Any],
) -> str:
    """How the state at the start of a run was made, in words.

    Parameters
    ----------
    initial : float, Profile or None
        The temperature or state that was stated; None where the first hours were repeated.
    settings : mapping
        Those of the engine.
    repeated_seconds : float
        Length of the first period. [s]
    steps : int
        Steps of the run.
    raw : mapping
        What the engine says of the run.
    """
    if isinstance(initial, float):
        return f"{initial:g} degC everywhere"
    if initial is not None:
        return initial.words
    hours = repeated_seconds / 3600.0
    note = (
        f"first {hours:g} h repeated {raw['cycles']} times until nothing changed "
        f"by more than {settings['warmup_tolerance']:g} K (last change {raw['settled']:.4f} K)"
    )
    repeated = raw["cycles"] * settings["warmup_steps"]
    share = repeated / (repeated + steps)
    if raw["cycles"] < _MANY_CYCLES or share < _LARGE_SHARE:
        return note
    return f"{note}: {100.0 * share:.0f} % of all steps of the run. A stated start (initial) would save them"
