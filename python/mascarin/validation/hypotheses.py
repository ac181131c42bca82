"""Causes of the difference between a model and measurements, each with its evidence."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

Group = Literal["data", "parameter", "form"]
What = Literal[
    "stuck", "forward_filled", "interpolated", "copied", "swapped", "clock", "offset", "gain", "scale",
    "drift", "place", "noise", "parameter", "form",
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
    "place": "place of the sensor",
    "noise": "white noise",
    "parameter": "value of a parameter",
    "form": "form of the model",
}


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause with its evidence.

    Attributes
    ----------
    group : str
        ``data``, ``parameter`` or ``form``.
    what : str
        What it is, such as ``clock``; see `WORDS`.
    subject : tuple of str
        Sensors, or the path of a parameter or of a part of the building.
    text : str
        The statement, with what to check.
    value, error : float
        Estimate and its standard error; NaN where it is no number. [unit]
    unit : str
        Of the estimate.
    p : float
        Probability of such an improvement by chance: the larger one of a likelihood-ratio test and of a test
        of its consistency over the days, for all causes that were tried together; NaN for a finding in the
        table alone. [-]
    share : float
        Part of the remaining sum of squares that it takes away, over all sensors; the calibrated parameters
        are adjusted again with and without it. NaN for values that are left out already. [-]
    deviance : float
        By how much it lowers the deviance. [-]
    same : tuple of str
        Other causes that the measurements cannot distinguish from it.

    Examples
    --------
    >>> Cause("data", "clock", ("room",), "room: late", 60.0, 1.0, "min", 1e-9, 0.8, 900.0).to_dict()["unit"]
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
    share: float = math.nan
    deviance: float = math.nan
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
            "share": _number(self.share),
            "deviance": _number(self.deviance),
            "same": list(self.same),
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Cause:
        """Read what `to_dict` returns."""
        numbers = {
            key: math.nan if content[key] is None else float(content[key])
            for key in ("value", "error", "p", "share", "deviance")
        }
        return cls(
            content["group"], content["what"], tuple(content["subject"]), content["text"],
            unit=content["unit"], same=tuple(content["same"]), **numbers,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Causes in their order: data, then parameters and forms of the model.

    Attributes
    ----------
    causes : tuple of Cause
        Empty where nothing is significant.
    noise : dict of str to float
        White noise of each sensor, which no model takes away. [unit of each]
    remaining : float
        Part of the sum of squares that is left after all causes. [-]

    Examples
    --------
    >>> Diagnosis((), {"room": 0.08}, 1.0).first is None
    True
    """

    causes: tuple[Cause, ...]
    noise: dict[str, float]
    remaining: float

    @property
    def first(self) -> Cause | None:
        """The first cause; None where there is none."""
        return self.causes[0] if self.causes else None

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file."""
        return {
            "causes": [cause.to_dict() for cause in self.causes],
            "noise": {name: _number(value) for name, value in self.noise.items()},
            "remaining": _number(self.remaining),
        }


def _number(value: float) -> float | None:
    return float(f"{value:.6g}") if math.isfinite(value) else None
