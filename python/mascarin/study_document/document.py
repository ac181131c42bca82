"""All results of a study but the series."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Self

from pydantic import SkipValidation, ValidationError

from mascarin.errors import InputError
from mascarin.study_document.analysis import (
    ContradictionEntry,
    DaysEntry,
    DiagnosisEntry,
    ErrorSourcesEntry,
    NoteEntry,
    PhaseChangeEntry,
    QualityEntry,
    ResidualEntry,
    TableEntry,
)
from mascarin.study_document.building import AssumptionEntry, BuildingEntry
from mascarin.study_document.comparison import (
    BandEntry,
    CriterionEntry,
    LedgerEntry,
    MetricValues,
    ModelEntry,
    PeriodEntry,
    PeriodScores,
    ReferenceEntry,
    SensorEntry,
    TransferEntry,
)
from mascarin.study_document.entry import Num, ResultEntry
from mascarin.study_document.estimates import (
    CoefficientsEntry,
    CorrelationEntry,
    DaySharesEntry,
    DerivedEntry,
    FormEntry,
    ModelErrorEntry,
    ParameterEntry,
    ProfileEntry,
    ReferenceValue,
    SensorErrorEntry,
    ShareEntry,
    SpectrumEntry,
)


class ObservedEntry(ResultEntry):
    """What the data are called, such as "virtual experiment"."""

    label: str = "measured"
    note: str = ""


class InputEntry(ResultEntry):
    """A file that the study has read."""

    name: str = ""
    sha256: str = ""
    note: str = ""


class SourceEntry(ResultEntry):
    """Where numbers are from."""

    text: str = ""
    doi: str = ""


class LivePageEntry(ResultEntry):
    """The page beside the report in which the calibrated building runs."""

    file: str = ""
    """Its name in the folder of the study; empty where there is none."""
    period: list[str] = []
    """Start and end of its run, local times, ISO 8601 without offset."""
    sliders: list[str] = []
    """Calibrated parameters with a slider."""
    fixed: list[str] = []
    """Those without one."""
    measured: bool = False
    """Whether it has measured values."""
    refusal: str = ""
    """Why there is no page, with what to do."""


NO_VALUES = MetricValues()
"""Metrics of what was not compared."""


class StudyDocument(ResultEntry):
    """The content of ``study.json``; without the results of some step its part of the report is left out.

    Mappings are shown in the order in which they are given.

    Examples
    --------
    >>> document = StudyDocument.read({"title": "A wall", "models": {"nominal": {}}, "later": 1})
    >>> document.models["nominal"].note, document.to_dict()["later"]
    ('', 1)
    """

    contradictions: list[ContradictionEntry] = []
    """By what the calibrated model contradicts its data or what is known; first in file and report."""
    title: str = ""
    intro: list[str] = []
    """Introduction, in paragraphs."""
    observed: ObservedEntry = ObservedEntry()
    mascarin_version: str = ""
    created: str | None = None
    run_time: Num | None = None
    """[s]"""
    processors: int | None = None
    seed: int | None = None
    live: LivePageEntry = LivePageEntry()
    timezone: str = ""
    command: list[str] = []
    """Commands that give the same results."""
    inputs: list[InputEntry] = []
    versions: dict[str, str] = {}
    warnings: list[Annotated[str, SkipValidation]] = []
    """Warnings of the runs, with the models that have them; in a run they know their kind."""
    sound: bool = True
    """Whether every energy balance closes and every temperature has a cause."""
    sources: list[SourceEntry] = []
    sensor_info: dict[str, SensorEntry] = {}
    periods: dict[str, PeriodEntry] = {}
    models: dict[str, ModelEntry] = {}
    sensors: dict[str, dict[str, PeriodScores]] = {}
    """sensor -> period -> metrics."""
    criteria: list[CriterionEntry] = []
    aims: list[CriterionEntry] = []
    """Desired limits, which are not required."""
    band: dict[str, BandEntry] = {}
    reference: ReferenceEntry = ReferenceEntry()
    reference_values: dict[str, ReferenceValue] = {}
    coefficients: CoefficientsEntry = CoefficientsEntry()
    building: BuildingEntry = BuildingEntry()
    assumptions: list[AssumptionEntry] = []
    quality: list[QualityEntry] = []
    parameters: dict[str, ParameterEntry] = {}
    variant_parameters: dict[str, dict[str, ParameterEntry]] = {}
    """The same of other models that were identified."""
    correlation: CorrelationEntry = CorrelationEntry()
    identification: list[list[str]] = []
    """Rows of name and value about the calibration."""
    profiles: dict[str, ProfileEntry] = {}
    alternatives: list[FormEntry] = []
    sensor_errors: dict[str, SensorErrorEntry] = {}
    model_errors: dict[str, ModelErrorEntry] = {}
    derived: list[DerivedEntry] = []
    shortfall: ErrorSourcesEntry = ErrorSourcesEntry()
    diagnosis: DiagnosisEntry = DiagnosisEntry()
    days: DaysEntry = DaysEntry()
    sensitivity: dict[str, dict[str, ShareEntry]] = {}
    sensitivity_design: list[list[str]] = []
    frequencies: dict[str, int] = {}
    """Frequency of each parameter in the spectra."""
    spectra: dict[str, SpectrumEntry] = {}
    day_shares: dict[str, DaySharesEntry] = {}
    residuals: dict[str, ResidualEntry] = {}
    transfer: dict[str, TransferEntry] = {}
    """Other houses, seasons and phases."""
    start: str | None = None
    """Initial state of the run."""
    ledger: LedgerEntry = LedgerEntry()
    phase_change: list[PhaseChangeEntry] = []
    tables: list[TableEntry] = []
    notes: list[NoteEntry] = []

    @classmethod
    def read(cls, content: Mapping[str, Any] | StudyDocument, where: str = "study") -> StudyDocument:
        """Take plain values as they are in ``study.json``.

        Parameters
        ----------
        content : mapping or StudyDocument
            The values.
        where : str
            Where they are from, for errors.

        Raises
        ------
        InputError
            A value of another type than expected.
        """
        if isinstance(content, StudyDocument):
            return content
        try:
            return cls.model_validate(dict(content))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            path = ".".join(str(part) for part in first["loc"])
            raise InputError(
                f"{where}: {path}: found {first['input']!r:.60}, expected other results of a study "
                f"({first['msg']}); run the study again"
            ) from error

    @classmethod
    def joined(cls, *parts: StudyDocument) -> Self:
        """One document with what some parts state; later parts replace earlier ones."""
        return cls(**{key: getattr(part, key) for part in parts for key in part.model_fields_set})

    def without_repeated_periods(self) -> Self:
        """Leave out periods that hold the same instants as one before them.

        Where no other days are left, the blind days are those of the corroboration: what was compared on
        them would count twice. All that shows or counts results takes them from here.

        Returns
        -------
        StudyDocument
            The same without the repetitions, in periods, metrics, criteria and aims; what is only about a
            period that is left out names the one before it.

        Examples
        --------
        >>> spans = [["2024-05-01T00:00", "2024-05-03T00:00"]]
        >>> periods = {"corroboration": {"spans": spans}, "blind": {"spans": spans}}
        >>> criteria = [{"period": "corroboration"}, {"period": "blind"}]
        >>> document = StudyDocument.read({"periods": periods, "criteria": criteria})
        >>> [criterion.period for criterion in document.without_repeated_periods().criteria]
        ['corroboration']
        """
        name_of: dict[str, str] = {}
        for key, period in self.periods.items():
            same = (name for name in name_of.values() if self.periods[name].spans == period.spans)
            name_of[key] = next(same, key)
        repeated = {key for key, name in name_of.items() if key != name}
        if not repeated:
            return self
        changed = {
            "periods": {key: period for key, period in self.periods.items() if key not in repeated},
            "sensors": {
                sensor: {key: scores for key, scores in periods.items() if key not in repeated}
                for sensor, periods in self.sensors.items()
            },
            "criteria": _once(self.criteria, name_of),
            "aims": _once(self.aims, name_of),
            "residuals": {
                sensor: entry.model_copy(update={"period": name_of.get(entry.period or "", entry.period)})
                for sensor, entry in self.residuals.items()
            },
            "shortfall": self.shortfall.model_copy(
                update={"period": name_of.get(self.shortfall.period, self.shortfall.period)}
            ),
        }
        return self.model_copy(update={key: value for key, value in changed.items() if self.states(key)})

    def metrics(self, sensor: str, period: str | None, model: str | None) -> MetricValues:
        """Metrics of a model; empty where there are none."""
        scores = self.sensors.get(sensor, {}).get(period or "")
        return NO_VALUES if scores is None else scores.models.get(model or "", NO_VALUES)


def _once(limits: Sequence[CriterionEntry], name_of: Mapping[str, str]) -> list[CriterionEntry]:
    """Limits with the periods that are shown, each once."""
    renamed = [c.model_copy(update={"period": name_of.get(c.period, c.period)}) for c in limits]
    keys = [(c.name, c.sensor, c.period, c.metric, c.model, c.limit) for c in renamed]
    return [c for number, c in enumerate(renamed) if keys[number] not in keys[:number]]
