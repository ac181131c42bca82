"""What a run was made from: version, building, climate, options and counters of the solver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Self

from mascarin import __version__
from mascarin._io.durations import length_words
from mascarin._io.sealed import own_files

_KEYS: Final = {"version": "mascarin_version", "building_hash": "building_sha256"}
_TYPES: Final[dict[str, type | tuple[type, ...]]] = {
    "mascarin_version": str,
    "building": str,
    "building_sha256": str,
    "climate": dict,
    "measurements": (dict, type(None)),
    "step_seconds": (int, float),
    "steps": (dict, type(None)),
    "scheme": str,
    "start": str,
    "changed": dict,
    "newton_iterations": int,
    "nested_stages": int,
    "halved_steps": int,
    "reversals": int,
}


@dataclass(frozen=True)
class Provenance:
    """What a run was made from.

    Parameters
    ----------
    building : str
        Name of the building.
    building_hash : str
        SHA-256 of the description that the engine read.
    climate : dict
        File, hash, period and conversions of the climate.
    step_seconds : float
        Time step. [s]
    scheme : str
        Time-stepping scheme.
    start : str
        How the run was started.
    changed : mapping of str to float
        Parameters that differ from the description. [unit of each]
    newton_iterations : int
        Newton iterations over all stages.
    nested_stages : int
        Stages that only the nested iteration of Casulli & Zanolli solved.
    halved_steps : int
        Steps, or parts of steps, that had to be halved: they did not converge, or carried the air of a zone
        more than 0.5 K beyond what acts on it.
    reversals : int
        How often a phase-change cell with hysteresis melted and froze within one step: its history, which is
        updated at the end of a step, contains only the sum. A shorter step makes it smaller.
    version : str
        Version of Mascarin.
    measurements : dict or None
        File, hash, period, columns and conversions of the measured table; None where none was given.
    steps : dict or None
        Steps that were chosen: tolerance, number, lengths, estimated error and sequence, see `StepSequence`;
        None where all are of one length.
    """

    building: str
    building_hash: str
    climate: Mapping[str, Any]
    step_seconds: float
    scheme: str
    start: str
    changed: Mapping[str, float]
    newton_iterations: int
    nested_stages: int = 0
    halved_steps: int = 0
    reversals: int = 0
    version: str = field(default=__version__)
    measurements: Mapping[str, Any] | None = None
    steps: Mapping[str, Any] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "mascarin_version": self.version,
            "building": self.building,
            "building_sha256": self.building_hash,
            "climate": dict(self.climate),
            "measurements": None if self.measurements is None else dict(self.measurements),
            "step_seconds": self.step_seconds,
            **({} if self.steps is None else {"steps": dict(self.steps)}),
            "scheme": self.scheme,
            "start": self.start,
            "changed": dict(self.changed),
            "newton_iterations": self.newton_iterations,
            "nested_stages": self.nested_stages,
            "halved_steps": self.halved_steps,
            "reversals": self.reversals,
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Make one from the values of `to_dict`.

        Parameters
        ----------
        values : mapping
            The values.

        Raises
        ------
        DamagedError
            A value is missing, or of another type.
        """
        own_files.require(
            values, _TYPES, further=("nested_stages", "halved_steps", "reversals", "measurements", "steps")
        )
        names = {_KEYS.get(name, name): name for name in cls.__dataclass_fields__}
        return cls(**{names[key]: value for key, value in values.items() if key in names})


def words_of(steps: Mapping[str, Any]) -> str:
    """What `StepSequence.to_dict` says, in a line for people.

    Parameters
    ----------
    steps : mapping
        The values.
    """
    shortest, longest, records = (
        length_words(steps[key]) for key in ("shortest_s", "longest_s", "record_interval_s")
    )
    fixed = steps["steps_of_the_shortest_length"]
    return (
        f"{steps['steps']} of {shortest} to {longest}, records every {records}; estimated error of a step "
        f"{steps['estimated_error_K']:.2g} K at most (tolerance {steps['tolerance_K']:g} K); steps of "
        f"{shortest} alone would be {fixed}, {fixed / steps['steps']:.1f} times as many"
    )
