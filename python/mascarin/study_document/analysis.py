"""Residuals, causes of the remaining error, choice of days and phase change, in the results of a study."""

from __future__ import annotations

from typing import Any

from mascarin.study_document.entry import Num, ResultEntry


class DailyCycleEntry(ResultEntry):
    """Mean day, measured and simulated."""

    measured_amplitude: Num | None = None
    measured_peak: Num | None = None
    """[h]"""
    simulated_amplitude: Num | None = None
    simulated_peak: Num | None = None
    delay_minutes: Num | None = None


class ResidualEntry(ResultEntry):
    """Statistics of the residual of one sensor."""

    unit: str = ""
    white: bool | None = None
    """Whether the cumulative periodogram stays within its band."""
    period: str | None = None
    n: int | None = None
    effective_n: Num | None = None
    acf_lags: list[Num] = []
    """[h]"""
    acf: list[Num | None] = []
    acf_band: Num | None = None
    periodogram_frequency: list[Num] = []
    """[1/day]"""
    periodogram_cumulative: list[Num | None] = []
    """0 to 1."""
    periodogram_band: Num | None = None
    hour_mean: list[Num | None] = []
    """24 means, in the unit of the sensor."""
    hour_sd: list[Num | None] = []
    hour_share: Num | None = None
    """Part of the variance that the hour of the day explains."""
    correlation: dict[str, Num | None] = {}
    """Correlation with sun, wind, outdoor air, ... by channel label."""
    correlation_band: Num | None = None
    correlation_lag: dict[str, Num | None] = {}
    """How long the residual comes after the channel. [h]"""
    cross_lags: list[Num] = []
    """[h]"""
    cross_correlation: dict[str, list[Num | None]] = {}
    """Correlation with each channel at each lag."""
    daily_cycle: DailyCycleEntry | None = None


class SourceStep(ResultEntry):
    """A parameter that is changed besides those before."""

    path: str = ""
    changes: dict[str, Num] = {}
    """By path. [ranges]"""
    sd: dict[str, Num | None] = {}


class AllParameters(ResultEntry):
    """All parameters changed."""

    parameters: int = 0
    sd: dict[str, Num | None] = {}


class ErrorSourcesEntry(ResultEntry):
    """Sources of remaining error, parameter by parameter; ``sd`` is by sensor."""

    sd: dict[str, Num | None] = {}
    """Of the fitted model."""
    period: str = ""
    steps: list[SourceStep] = []
    all_parameters: AllParameters | None = None


class TableEntry(ResultEntry):
    """Any further table."""

    title: str = ""
    caption: str = ""
    columns: list[str] = []
    rows: list[list[Any]] = []
    uncertainty: dict[str, str] = {}
    """Columns whose digits another column decides: name of the column -> that of its standard uncertainty."""
    significant: list[str] = []
    """Columns whose numbers span decades, shown with two significant digits each."""
    section: str = "comparison"
    """Identifier of the section it belongs to."""


class CauseEntry(ResultEntry):
    """A cause of the remaining error, with its evidence."""

    group: str = ""
    what: str = ""
    subject: list[str] = []
    text: str = ""
    value: Num | None = None
    error: Num | None = None
    unit: str = ""
    p: Num | None = None
    certainty: Num | None = None
    log_bayes_factor: Num | None = None
    told: bool | None = None
    same: list[Any] = []


class DiagnosisEntry(ResultEntry):
    """Causes in their order, and what is expected without them."""

    causes: list[CauseEntry] = []
    noise: dict[str, Num | None] = {}
    p: Num | None = None
    candidates: int | None = None
    draws: int | None = None
    table: TableEntry | None = None


class DayRange(ResultEntry):
    """Range of a driver in the calibration and on the other days."""

    calibration: list[Num] = []
    others: list[Num] = []
    outside: Num = 0.0


class DaysEntry(ResultEntry):
    """Leverage and expected information of each day, and a table of the most important ones."""

    days: list[str] = []
    used: list[bool] = []
    leverage: list[Num | None] = []
    ratio: list[Num | None] = []
    information: list[Num | None] = []
    reduction: list[Num | None] = []
    outside: dict[str, list[Num | None]] = {}
    ranges: dict[str, DayRange] = {}
    proposed: list[str] = []
    table: TableEntry | None = None


class LayerDay(ResultEntry):
    """A day of a phase-change layer."""

    label: str = ""
    temperature: list[Num] = []
    enthalpy: list[Num] = []


class PhaseChangeEntry(ResultEntry):
    """States of a phase-change layer."""

    label: str = ""
    column: str | None = None
    """Series column with the liquid fraction over time."""
    hysteresis: bool | None = None
    """Whether the material freezes along another curve than it melts, or has a state of its own; not known in
    files of earlier versions."""
    own_path: str = ""
    """What a law with a state does beside its curve; absent with two curves or none."""
    temperature: list[Num] = []
    """Mean temperature of the two surfaces of the layer at each time [degC]."""
    enthalpy: list[Num] = []
    """Mean enthalpy of the layer at each time [kJ/kg]."""
    days: list[LayerDay] = []
    law_temperature: list[Num] = []
    law_enthalpy: list[Num] = []
    rows: list[list[str]] = []
    """Facts as rows of name and value."""


class QualityEntry(ResultEntry):
    """Suspicious values of a measured column."""

    channel: str = ""
    kind: str = ""
    start: str | None = None
    end: str | None = None
    count: int = 0
    detail: str = ""
    masked: bool = False
    """Whether they are left out of all comparisons."""
    compared: bool = True
    """Whether the column is that of a sensor; others are inputs of the model. Not known in files of earlier
    versions."""


class NoteEntry(ResultEntry):
    """A remark of the analysis."""

    title: str = ""
    text: str = ""


class ContradictionEntry(NoteEntry):
    """By what the calibrated model contradicts its data or what is known."""

    kind: str = ""
    subject: str = ""
    factor: Num | None = None
