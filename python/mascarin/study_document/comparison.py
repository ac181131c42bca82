"""Models compared with measurements, in the results of a study."""

from __future__ import annotations

from mascarin.study_document.entry import Num, ResultEntry


class SensorEntry(ResultEntry):
    """What a sensor is."""

    label: str | None = None
    output: str = ""
    """Name of the model output it is compared with."""
    unit: str = "degC"
    uncertainty: Num = 0.0
    """Half-width of the sensor's band, in its unit."""


class PeriodEntry(ResultEntry):
    """A named part of the record."""

    label: str | None = None
    note: str = ""
    spans: list[list[str]] = []
    """Pairs of local times, start and end, ISO 8601 without offset."""


class ModelEntry(ResultEntry):
    """A model whose results are compared: nominal, fitted, or a variant."""

    label: str | None = None
    note: str = ""


class MetricValues(ResultEntry):
    """Errors of a model for a sensor and period, simulated minus measured; further metrics by their name."""

    n: int = 0
    bias: Num | None = None
    """Mean difference, in the unit of the sensor."""
    sd: Num | None = None
    """Standard deviation of the difference, in the unit of the sensor."""
    rmse: Num | None = None
    mean_error: Num | None = None
    """Mean absolute difference."""
    max_error: Num | None = None
    """Difference of largest size, with its sign."""
    mean_error_percent: Num | None = None
    """In percent of the measured range of the period."""
    max_error_percent: Num | None = None


class PeriodScores(MetricValues):
    """Metrics of the main model in a period, and beside them those of every model under its name."""

    __pydantic_extra__: dict[str, MetricValues | Num | str | None]

    @property
    def models(self) -> dict[str, MetricValues]:
        """Metrics by model."""
        extra = self.model_extra or {}
        return {name: value for name, value in extra.items() if isinstance(value, MetricValues)}


class CriterionEntry(ResultEntry):
    """One test with its limit."""

    name: str = ""
    sensor: str = ""
    period: str = ""
    metric: str = ""
    model: str = ""
    value: Num | None = None
    limit: Num | None = None
    unit: str = ""
    passed: bool = False


class BandEntry(ResultEntry):
    """Prediction interval of a sensor."""

    confidence: Num = 0.95
    """[-]"""
    stated: bool = True
    """Whether it is to be used: false where the model contradicts its own data."""
    half_width: Num | None = None
    """Mean half-width. [unit of the sensor]"""
    parameters: Num | None = None
    """Standard deviation from the estimates. [unit of the sensor]"""
    error: Num | None = None
    """Standard deviation of the error of the model. [unit of the sensor]"""
    extrapolated: Num | None = None
    """Part of the values outside of the range of the identification. [-]"""
    held: dict[str, Num | None] = {}
    """Coverage by period. [-]"""


class LedgerTerm(ResultEntry):
    """One term of the energy balance."""

    label: str = ""
    value: Num | None = None
    """[MJ], positive into the building."""


class LedgerEntry(ResultEntry):
    """Energy balance of a run; heat by each flow is `FLOW_joule`."""

    closure: Num | None = None
    """Relative energy-balance residual. [-]"""
    stored_joule: Num | None = None
    turnover_joule: Num | None = None
    terms: list[LedgerTerm] = []
    model: str | None = None


class PublishedValue(ResultEntry):
    """An identified parameter of a publication."""

    parameter: str = ""
    symbol: str = ""
    before: Num | str | None = None
    after: Num | str | None = None
    unit: str = ""
    delta_t: Num | None = None
    """The values are gamma for it, and the parameter is the half-width of the melting range. [K]"""


class InfluentialEntry(ResultEntry):
    """An influential parameter of a publication."""

    parameter: str = ""
    symbol: str = ""
    frequency: int | str | None = None


class ReferenceEntry(ResultEntry):
    """A publication for comparison."""

    label: str | None = None
    note: str = ""
    tables: dict[str, str] = {}
    """Its tables, by what they hold."""
    influential: list[InfluentialEntry] = []
    parameters: list[PublishedValue] = []
    parameter_note: str = ""
    sensors: dict[str, dict[str, MetricValues]] = {}
    """sensor -> period -> metrics."""


class TransferScores(ResultEntry):
    """A sensor of another house or season in a period, before and after the estimates are put into it."""

    described: MetricValues = MetricValues()
    calibrated: MetricValues = MetricValues()
    held: Num | None = None
    """Part of the values inside of the bands. [-]"""
    unit: str = ""


class TransferEntry(ResultEntry):
    """Another house, season or phase, or one of the experiments of the study."""

    building: str = ""
    role: str = "validation"
    """identification: its data were used; validation: nothing of it was identified."""
    cost: Num | None = None
    """Minus the log-likelihood of its own data at the estimates, as if errors were independent. [-]"""
    words: list[str] = []
    """What limits the comparison, warnings of the runs included."""
    sound: bool = True
    """Whether the energy balances of its runs close and every temperature has a cause."""
    sensors: dict[str, dict[str, TransferScores]] = {}
    """sensor -> period -> scores."""
