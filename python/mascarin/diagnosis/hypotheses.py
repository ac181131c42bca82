"""Causes of the difference between a model and measurements: candidates, and what is said of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.discrepancy import DayData

Floats = NDArray[np.float64]

Group = Literal["data", "input", "parameter", "form", "path"]
What = Literal[
    "stuck", "forward_filled", "interpolated", "copied", "swapped", "clock", "offset", "gain", "scale",
    "drift", "step", "clock_step", "swap_step", "place", "noise", "parameter", "form", "path",
]  # fmt: skip

#: Kinds in words, for tables.
WORDS: Final[dict[str, str]] = {
    "stuck": "stuck values",
    "forward_filled": "repeated values",
    "interpolated": "interpolated values",
    "copied": "copied values",
    "swapped": "exchanged columns",
    "clock": "clock",
    "offset": "offset",
    "gain": "gain",
    "scale": "gain about the mean",
    "drift": "drift",
    "step": "step of the offset",
    "clock_step": "step of the clock",
    "swap_step": "columns exchanged from some time on",
    "place": "place of the sensor",
    "noise": "white noise",
    "parameter": "value outside of its range",
    "form": "law",
    "path": "missing heat flow",
}
#: Groups in words.
GROUPS: Final[dict[str, str]] = {
    "data": "sensor",
    "input": "measured input of the model",
    "parameter": "model",
    "form": "model",
    "path": "model",
}


@dataclass(frozen=True, eq=False)
class Candidate:
    """A possible cause with its signature.

    Attributes
    ----------
    group, what : str
        See `WORDS` and `GROUPS`.
    subject : tuple of str
        Sensors, weather channel, or the path of a parameter or of a part of the building.
    signature : ndarray, shape (D, H * S)
        By how much it changes measured minus simulated values for a size of 1: means by day, slot and sensor,
        as in `DayData`. [unit of the sensors]
    mean, sd : float
        Prior of its size if it is there. [-]
    scale : float
        What a size of 1 is in `unit`. [unit]
    unit : str
        Of the estimate.
    detail : str
        Kind of a law, place next to a sensor, and the like.
    later : str or None
        What it is if it begins within the record; None: it is there in the whole record or not at all.
    start : float
        From when on, from the midnight before the record; NaN: in the whole record. [h]
    known : float
        Value at a size of 0. [unit]
    limits : tuple of float
        Smallest and largest size that has a meaning, as no absorptance is negative; the prior is zero beyond.
        [-]

    Examples
    --------
    >>> Candidate("data", "offset", ("room",), np.ones((3, 24)), sd=0.5, unit="K").key
    ('data', 'room')
    """

    group: Group
    what: What
    subject: tuple[str, ...]
    signature: Floats
    mean: float = 0.0
    sd: float = 1.0
    scale: float = 1.0
    unit: str = ""
    detail: str = ""
    later: What | None = None
    start: float = math.nan
    known: float = 0.0
    limits: tuple[float, float] = (-math.inf, math.inf)

    @property
    def key(self) -> tuple[str, ...]:
        """What is wrong if it is the cause: the sensors, or the input, number or law."""
        return (self.group, *self.subject)

    @property
    def label(self) -> str:
        """In words."""
        return f"{' and '.join(self.subject)} ({self.detail or WORDS[self.what]})"


@dataclass(frozen=True, eq=False)
class DiagnosisInput:
    """What a diagnosis is made of: residuals, what is known of the errors, and candidates.

    Attributes
    ----------
    data : DayData
        Residuals (measured minus simulated) of all compared days by day and slot, with the effects of the
        uncertain numbers of the model and of the stated errors of the sensors, each for one standard
        deviation of its prior.
    days : ndarray, shape (D,)
        Number of each day; days may be missing. [-]
    sensors : tuple of str
        Names.
    scale : ndarray, shape (S,)
        Stated standard uncertainty of each sensor. [unit of each]
    limit : ndarray, shape (S,)
        Largest standard deviation of each part of the error of the model. [unit of each]
    candidates : tuple of Candidate
        What may be the cause.
    model_weight : float
        Weight of the form of the model that is used: no statement is more certain. [-]
    forms : int
        Number of forms of the model that were calibrated. With one only, an error of the model that is no
        candidate acts like those of inputs, numbers and laws: none of these is told. [-]
    """

    data: DayData
    days: Floats
    sensors: tuple[str, ...]
    scale: Floats
    limit: Floats
    candidates: tuple[Candidate, ...]
    model_weight: float = 1.0
    forms: int = 2


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause with its evidence.

    Attributes
    ----------
    group : str
        ``data`` (a sensor), ``input`` (a measured input), ``parameter``, ``form`` or ``path`` (the model).
    what : str
        What it is, such as ``clock``; see `WORDS`.
    subject : tuple of str
        Sensors, weather channel, or the path of a parameter or of a part of the building.
    text : str
        The statement, with what to check.
    value, error : float
        Estimate and its standard error; NaN where it is no number. [unit]
    unit : str
        Of the estimate.
    p : float
        Part of simulated records without any cause in which some candidate explains as much: family-wise p
        value; NaN for a finding in the table alone. It is not the probability that there is no cause. [-]
    certainty : float
        Probability that the cause is this one, if it is one of the candidates; not above the weight of the
        form of the model that is used. NaN for a finding in the table alone. [-]
    log_bayes_factor : float
        Natural logarithm of the density of the measurements with it over that without it. [-]
    told : bool
        Whether the measurements tell it from all other candidates; if not, it is the most probable of `same`.
    same : tuple of str
        Other causes that the measurements do not distinguish from it.

    Examples
    --------
    >>> Cause("data", "clock", ("room",), "room: late", 60.0, 1.0, "min", 0.001, 0.9).to_dict()["unit"]
    'min'
    """

    group: Group
    what: What
    subject: tuple[str, ...]
    text: str
    value: float = math.nan
    error: float = math.nan
    unit: str = ""
    p: float = math.nan
    certainty: float = math.nan
    log_bayes_factor: float = math.nan
    told: bool = True
    same: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file, with six digits."""
        return {
            "group": self.group,
            "what": self.what,
            "subject": list(self.subject),
            "text": self.text,
            "value": _number(self.value),
            "error": _number(self.error),
            "unit": self.unit,
            "p": _number(self.p),
            "certainty": _number(self.certainty),
            "log_bayes_factor": _number(self.log_bayes_factor),
            "told": self.told,
            "same": list(self.same),
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Cause:
        """Read what `to_dict` returns."""
        numbers = {
            key: math.nan if content[key] is None else float(content[key])
            for key in ("value", "error", "p", "certainty", "log_bayes_factor")
        }
        return cls(
            content["group"], content["what"], tuple(content["subject"]), content["text"],
            unit=content["unit"], told=bool(content["told"]), same=tuple(content["same"]), **numbers,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Causes in the order of their evidence.

    Attributes
    ----------
    causes : tuple of Cause
        Empty where nothing is significant. Findings in the table come first.
    noise : dict of str to float
        White noise of each sensor, which no model takes away. [unit of each]
    p : float
        Family-wise p value of the first cause, also where none is named; NaN without a test. [-]
    candidates : int
        Number of candidates that were compared. [-]
    draws : int
        Number of simulated records; no p value is below 1 over one more than this. [-]

    Examples
    --------
    >>> Diagnosis((), {"room": 0.08}).first is None
    True
    """

    causes: tuple[Cause, ...]
    noise: dict[str, float]
    p: float = math.nan
    candidates: int = 0
    draws: int = 0

    @property
    def first(self) -> Cause | None:
        """The first cause; None where there is none."""
        return self.causes[0] if self.causes else None

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file."""
        return {
            "causes": [cause.to_dict() for cause in self.causes],
            "noise": {name: _number(value) for name, value in self.noise.items()},
            "p": _number(self.p),
            "candidates": self.candidates,
            "draws": self.draws,
        }


def _number(value: float) -> float | None:
    return float(f"{value:.6g}") if math.isfinite(value) else None
