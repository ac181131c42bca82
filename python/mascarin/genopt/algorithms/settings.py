"""Settings of the section Algorithm: which values each key can have."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from mascarin.errors import did_you_mean
from mascarin.genopt.files.numbers import parse_double
from mascarin.genopt.files.syntax import Entry, Report


@dataclass(frozen=True)
class Number:
    """Limits of a numeric setting.

    Parameters
    ----------
    integer : bool
        Whether it is an integer.
    low, high : float
        Limits.
    open_low, open_high : bool
        Whether a limit itself is excluded.
    """

    integer: bool = False
    low: float = -math.inf
    high: float = math.inf
    open_low: bool = False
    open_high: bool = False

    def problem(self, value: float) -> str:
        """Return what is wrong with a value; empty when nothing is."""
        if value < self.low or (self.open_low and value == self.low):
            return f"expected {'more than' if self.open_low else 'at least'} {self.low:g}"
        if value > self.high or (self.open_high and value == self.high):
            return f"expected {'less than' if self.open_high else 'at most'} {self.high:g}"
        return ""


_COUNT = Number(integer=True, low=1)
_INTEGER = Number(integer=True)
_NOT_NEGATIVE = Number(low=0)
_POSITIVE = Number(low=0, open_low=True)
_FRACTION = Number(low=0, high=1, open_low=True, open_high=True)
_PULL = Number(low=0, high=4, open_low=True, open_high=True)

_NUMBERS = {
    "Seed": _INTEGER,
    "MultiStartSeed": _INTEGER,
    "NumberOfInitialPoint": _COUNT,
    "Zeta": _NOT_NEGATIVE,
    "Alpha": _FRACTION,
    "MeshSizeDivider": Number(integer=True, low=2),
    "InitialMeshSizeExponent": Number(integer=True, low=0),
    "MeshSizeExponentIncrement": _COUNT,
    "NumberOfStepReduction": _COUNT,
    "NeighborhoodSize": _COUNT,
    "NumberOfParticle": Number(integer=True, low=2),
    "NumberOfGeneration": _COUNT,
    "CognitiveAcceleration": _PULL,
    "SocialAcceleration": _PULL,
    "MaxVelocityGainContinuous": Number(),
    "MaxVelocityDiscrete": _POSITIVE,
    "ConstrictionGain": Number(low=0, high=1, open_low=True),
    "InitialInertiaWeight": _POSITIVE,
    "FinalInertiaWeight": _NOT_NEGATIVE,
    "Accuracy": _POSITIVE,
    "StepSizeFactor": _POSITIVE,
    "BlockRestartCheck": Number(integer=True, low=0),
    "Beta": _FRACTION,
    "Gamma": _POSITIVE,
    "K0": _INTEGER,
    "KStar": _INTEGER,
    "LMax": Number(integer=True, low=0),
    "Kappa": Number(integer=True, low=0),
    "EpsilonM": _POSITIVE,
    "EpsilonX": _POSITIVE,
    "AbsDiffFunction": _POSITIVE,
    "IntervalReduction": _FRACTION,
    "Sigma": _POSITIVE,
    "PopulationSize": Number(integer=True, low=4),
    "MaxEvaluations": _COUNT,
}
_BOOLEANS = {"ModifyStoppingCriterion", "StopAtError"}
_WORDS = {"MultiStart": ["Uniform"], "NeighborhoodTopology": ["gbest", "lbest", "vonNeumann"]}


class Keys(dict[str, Any]):
    """Checked settings of the section by key."""


def checked(entries: dict[str, Entry], report: Report, *, extension: bool) -> Keys:
    """Check the values of the section.

    Parameters
    ----------
    entries : dict of str to Entry
        Entries by key.
    report : Report
        Takes errors and notes.
    extension : bool
        Whether GenOpt has no algorithm of this name.

    Returns
    -------
    Keys
        Numbers, booleans and words by key.
    """
    keys = Keys()
    for key, entry in entries.items():
        if key in _NUMBERS:
            value = _number(entry, _NUMBERS[key], report, extension=extension)
            if value is not None:
                keys[key] = value
        elif key in _BOOLEANS:
            if entry.value not in ("true", "false"):
                report.error(entry.location, f"'{key}' is '{entry.value}'; expected true or false")
            keys[key] = entry.value == "true"
        else:
            if key in _WORDS and entry.value not in _WORDS[key]:
                hint = did_you_mean(entry.value, _WORDS[key])
                report.error(
                    entry.location, f"'{key}' is '{entry.value}', which is not known. {hint}".rstrip()
                )
            keys[key] = entry.value
    if "FinalInertiaWeight" in keys and keys["FinalInertiaWeight"] > keys.get("InitialInertiaWeight", 0.0):
        report.error(
            entries["FinalInertiaWeight"].location, "'FinalInertiaWeight' is above 'InitialInertiaWeight'"
        )
    return keys


def _number(entry: Entry, rule: Number, report: Report, *, extension: bool) -> float | int | None:
    """A number within its limits."""
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.location, f"'{entry.key}' is '{entry.value}'; expected a number")
        return None
    if entry.has_exponent and not extension:
        report.beyond(
            entry.location,
            f"'{entry.raw}' is read as a number with a unit in this section",
            f'write {entry.value} or "{entry.raw}"',
        )
    if rule.integer:
        if value != int(value):
            report.notes.append(f"{entry.location}: '{entry.key} = {entry.value}' is cut to {int(value)}")
        value = int(value)
    problem = rule.problem(value)
    if problem:
        report.error(entry.location, f"'{entry.key}' is {entry.value}; {problem}")
        return None
    return value


def check_groups(entries: dict[str, Entry], report: Report) -> None:
    """Check optional keys that need each other or exclude each other.

    Parameters
    ----------
    entries : dict of str to Entry
        Entries by key.
    report : Report
        Takes errors.
    """
    seed = "MultiStartSeed" if "NumberOfParticle" in entries else "Seed"
    for first, partners in (("MultiStart", [seed, "NumberOfInitialPoint"]), ("Zeta", ["Phi"])):
        if first in entries:
            for key in partners:
                if key not in entries:
                    report.error(entries[first].location, f"'{first}' also needs '{key}'")
    for key, first in (("NumberOfInitialPoint", "MultiStart"), ("Phi", "Zeta"), ("Alpha", "Zeta")):
        if key in entries and first not in entries and "K0" not in entries:
            report.error(entries[key].location, f"'{key}' needs '{first}' in front")
    if "AbsDiffFunction" in entries and "IntervalReduction" in entries:
        report.error(
            entries["IntervalReduction"].location, "give 'AbsDiffFunction' or 'IntervalReduction', not both"
        )
