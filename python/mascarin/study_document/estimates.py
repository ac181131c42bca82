"""Calibrated parameters, errors of sensors and model, and sensitivity, in the results of a study."""

from __future__ import annotations

from typing import Any

from mascarin.study_document.entry import Num, ResultEntry


class ParameterEntry(ResultEntry):
    """A parameter that was identified (or only declared, without ``fitted``)."""

    nominal: Num | None = None
    fitted: Num | None = None
    low: Num | None = None
    high: Num | None = None
    """Ends of the 95 % interval of the fitted value."""
    unit: str | None = ""
    interval: list[Num | None] = []
    range: list[Num] = []
    """Lowest and highest value that was allowed."""
    label: str | None = None
    stated: bool = True
    """Whether the interval is to be used."""
    at_bound: bool = False
    reason: str = ""
    """Why the estimate is on a bound, or is not identifiable."""
    source: str | None = None
    reference_nominal: Num | None = None
    reference_fitted: Num | None = None
    """What a publication gives for the same quantity before and after its own identification."""


class CorrelationEntry(ResultEntry):
    """Correlation between the estimates."""

    paths: list[str] = []
    matrix: list[list[Num | None]] = []


class CoefficientsEntry(ResultEntry):
    """Effective mean convective coefficients."""

    period: str = ""
    unit: str = "W/(m2 K)"
    models: dict[str, dict[str, Num]] = {}
    """model -> law -> value."""


class ReferenceValue(ResultEntry):
    """A parameter of a publication in the building as described."""

    value: Num | None = None
    unit: str = ""


class ProfileEntry(ResultEntry):
    """Profile likelihood of a parameter."""

    unit: str = ""
    values: list[Num | None] = []
    rise: list[Num | None] = []
    limit: Num | None = None
    low: Num | None = None
    high: Num | None = None
    bounded: list[bool] = []
    """Whether the interval ends inside of the range, below and above."""


class FormEntry(ResultEntry):
    """A form of the model."""

    label: str = ""
    choice: dict[str, Any] = {}
    free_numbers: int = 0
    weight: Num = 0.0
    left_out: list[Num] = []
    """Log density of each day left out. [-]"""


class SensorErrorEntry(ResultEntry):
    """An estimated error of a sensor."""

    estimate: Num = 0.0
    standard_uncertainty: Num = 0.0
    stated: Num = 0.0


class ModelErrorEntry(ResultEntry):
    """Standard deviations of the errors of the model for a sensor. [unit of the sensor]"""

    repeating: Num = 0.0
    day: Num = 0.0
    within_day: Num = 0.0
    independent: Num = 0.0
    limit: Num = 0.0


class DerivedEntry(ResultEntry):
    """A quantity that follows from the estimates, with its interval."""

    name: str = ""
    unit: str = ""
    value: Num | None = None
    low: Num | None = None
    high: Num | None = None


class ShareEntry(ResultEntry):
    """First-order index of a parameter for an output: the part of the variance that it causes."""

    share: Num | None = None
    low: Num | None = None
    high: Num | None = None
    effect: Num | None = None
    """Signed change of the output from the low to the high end of the range, in the output's unit."""


class PeakEntry(ResultEntry):
    """A peak of a spectrum."""

    frequency: Num = 0
    power: Num = 0.0
    path: str = ""
    harmonic: int = 1


class SpectrumEntry(ResultEntry):
    """Spectrum of an output over the design's runs."""

    frequencies: list[Num] = []
    power: list[Num] = []
    """Part of the variance at each frequency [-]."""
    threshold: Num = 0.0
    """Values below it are not significant."""
    peaks: list[PeakEntry] = []


class DaySharesEntry(ResultEntry):
    """First-order indices over the hours of the day."""

    hours: list[Num] = []
    paths: list[str] = []
    share: list[list[Num]] = []
    """One row per path, one column per hour."""
