"""What a calibration found: the section `posterior` of the building that a study has calibrated.

The numbers belong together, so that the section has a checksum: one that was edited, or merged with another
one, is refused. It changes no run; bands of a comparison are made with it.
"""

from __future__ import annotations

import hashlib
import json
import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from pydantic import Field, model_validator

from mascarin.building.base.part import Part, fault, insist

if TYPE_CHECKING:
    from typing import Self

    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_EXPECTED: Final = "the section as a study has written it"
_REMEDY: Final = "Copy it from calibrated.yaml again, or remove the key 'posterior' with all below it."


class SensorPosterior(Part):
    """A sensor of the identification: its range, and the errors of sensor and model there."""

    output: str = Field(description="Output of the model")
    unit: str = Field(description="Unit of the output")
    range: tuple[float, float] = Field(description="Simulated range in the identification [unit]")
    repeating: float = Field(
        ge=0, description="Standard deviation of the error of the model that repeats every day [unit]"
    )
    daily: float = Field(
        ge=0, description="Standard deviation of the error of the model that differs from day to day [unit]"
    )
    independent: float = Field(
        ge=0, description="Standard deviation of what differs from value to value [unit]"
    )
    limit: float = Field(
        ge=0, description="Largest standard deviation of an error of the model that the study allows [unit]"
    )
    errors: dict[str, tuple[float, float]] = Field(
        default_factory=dict,
        description="Estimated errors of the sensor, in stated standard uncertainties: mean and standard "
        "deviation [-]",
    )


class Posterior(Part):
    """Parameters and errors given the measurements of a study, written by Mascarin."""

    study: str = Field(description="Study that made it")
    mascarin: str = Field(description="Version of Mascarin that made it")
    confidence: float = Field(gt=0, lt=1, description="Confidence of intervals and bands [-]")
    days: int = Field(ge=1, description="Days of the identification")
    stated: bool = Field(
        True, description="Whether bands are to be stated: false where the model contradicts its own data"
    )
    intervals: dict[str, tuple[float, float, float]] = Field(
        description="Parameter -> estimate and ends of its interval [unit of each]"
    )
    numbers: dict[str, float] = Field(
        default_factory=dict,
        description="Number that was not estimated -> value as described [unit of each]",
    )
    sample: str = Field(
        description="Sample of all parameters and numbers together: a line of their paths, then one line of "
        "values each"
    )
    sensors: dict[str, SensorPosterior] = Field(description="Sensors of the identification by name")
    weather: dict[str, tuple[float, float]] = Field(
        default_factory=dict,
        description="Range of the daily means of the weather in the identification, by channel",
    )
    checksum: str = Field(description="SHA-256 of all of the above")

    @classmethod
    def sealed(cls, **fields: Any) -> Self:
        """The section with its checksum; the fields are those of the class."""
        return cls(**fields, checksum=cls.model_construct(**fields, checksum="").digest)

    @model_validator(mode="after")
    def _untouched(self) -> Self:
        if self.checksum != self.digest:
            insist(fault((), "a posterior that was edited or merged", _EXPECTED, _REMEDY))
        if self._table is None:
            insist(fault(("sample",), "no table of these parameters", _EXPECTED, _REMEDY))
        return self

    @property
    def digest(self) -> str:
        """SHA-256 of all but the checksum."""
        content = self.model_dump(mode="json", exclude={"checksum"})
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the parameters, then of the numbers that were not estimated."""
        return (*self.intervals, *self.numbers)

    @property
    def draws(self) -> Array:
        """Sample of parameters and numbers, shape (n, P + K). [unit of each]"""
        return np.array(self._table)

    @cached_property
    def _table(self) -> tuple[tuple[float, ...], ...] | None:
        """The numbers of the sample; None where it is no such table. No array: parts are compared."""
        first, *lines = self.sample.splitlines() or [""]
        if first.split(",") != list(self.paths) or not lines:
            return None
        try:
            rows = tuple(tuple(float(entry) for entry in line.split(",")) for line in lines)
        except ValueError:
            return None
        sound = all(len(row) == len(self.paths) and all(map(math.isfinite, row)) for row in rows)
        return rows if sound else None


def table_of(paths: tuple[str, ...], values: Array) -> str:
    r"""Write a sample as the text of the field `sample`, with six digits.

    Parameters
    ----------
    paths : tuple of str
        Parameters.
    values : ndarray, shape (n, P)
        The sample. [unit of each]

    Examples
    --------
    >>> table_of(("zones.room.volume",), np.array([[30.0], [31.5]]))
    'zones.room.volume\n30\n31.5\n'
    """
    lines = [",".join(paths), *(",".join(f"{value:.6g}" for value in row) for row in values.tolist())]
    return "\n".join(lines) + "\n"
