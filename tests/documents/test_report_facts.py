"""Every sentence of a report depends on facts: all of them are read in opposite studies.

A clause of the report that no opposite changes is an explanation of a table or a figure, and stands in
`EXPLANATIONS`, or it states a fact whatever the study has found, and is a fault.
"""

from __future__ import annotations

import typing
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np
import pytest

import report_facts
from mascarin.pages.study.data.series import Column, Series
from mascarin.study_document import analysis, building, comparison, estimates
from mascarin.study_document.document import LivePageEntry, StudyDocument
from mascarin.study_document.entry import ResultEntry
from report_facts import Page, all_changed, changed, opposite, page_of, removed

#: Clauses with fewer words are names and numbers of tables.
FEWEST_WORDS: Final = 3
#: How to read what is shown: the same in every study that has the section.
EXPLANATIONS: Final = {
    "": {
        "This file needs no network.",
        "Curves are drawn by uPlot.",
        "Skip to the content",
        # From the title of the study, which every study has.
        "a phase-change ceiling under a dark steel roof",
    },
    "carpets": {
        "A horizontal stripe is an error that occurs every day at the same hour.",
        "Error by date and hour",
        "a column is a day, with midnight at the bottom and noon in the middle.",
        "each picture shows the whole record:",
        "the simulated value is too high;",
    },
    "comparison": {
        "Percentages refer to the range of the measured values in the period (maximum minus minimum)."
    },
    "criteria": {
        "The bar shows the metric relative to its limit;",
        "a model meets a criterion if the magnitude of the metric does not exceed the limit.",
        "the mark is the limit.",
    },
    "curves": {
        "Drag across the curves to zoom in, double-click to zoom out.",
        "The figures below show the short periods;",
        "zooming needs JavaScript.",
    },
    "energy": {
        "Energy balance of the run",
        "Heat flows into the building over the whole run, positive into the building.",
    },
    "model": {
        "Figure shows the layers;",
        "Layers of the constructions",
        "Widths increase with the thickness, but not in proportion, so that thin layers are visible.",
        "the outside is on the left.",
    },
    "phase-change": {
        "the enthalpy is the mean over the layer.",
    },
    "residuals": {
        "white noise stays inside the bands of the autocorrelation and of the cumulative periodogram, whose "
        "frequencies are on a logarithmic axis, and does not correlate with any weather channel.",
    },
}
#: Yes or no that the study itself puts into tables and notes, with the reason why no section asks for it.
SAID_ELSEWHERE: Final = {
    (analysis.CauseEntry, "told"): "the table of causes and the note say it",
    (building.AssumptionEntry, "assumed"): "only assumed values are listed",
    (comparison.TransferEntry, "sound"): "part of `sound` of the whole document",
    (analysis.DaysEntry, "used"): "the table of days has those that were not used",
    (estimates.ProfileEntry, "bounded"): "the words of the profile say it",
}


def with_facts(document: StudyDocument, kind: type[ResultEntry], facts: dict[str, Any]) -> StudyDocument:
    """The study with some facts of all entries of a kind stated otherwise."""
    if kind is StudyDocument:
        return document.model_copy(update=facts)

    def otherwise(stated: dict[str, Any]) -> dict[str, Any]:
        return stated | facts

    return typing.cast("StudyDocument", changed(document, kind, "", otherwise, stated=False))


def with_gap(series: Series) -> Series:
    """The series a day later, with measured values missing, of one model only."""
    columns = {
        key: Column(np.where(np.arange(len(c.values)) < 9, np.nan, c.values), c.label, c.unit)
        if key.startswith("observed/")
        else c
        for key, c in series.columns.items()
        if not key.startswith("nominal/")
    }
    return replace(series, start="2010-08-02T00:00", columns=columns)


@pytest.fixture(scope="module")
def example() -> tuple[StudyDocument, Series]:
    content, series = report_facts.complete()
    return StudyDocument.read(content), series


@pytest.fixture(scope="module")
def base(example: tuple[StudyDocument, Series]) -> Page:
    return page_of(*example)


@pytest.fixture(scope="module")
def opposites(example: tuple[StudyDocument, Series]) -> list[Page]:
    """Reports of studies that differ in all numbers, words or yes and no, or lack a part."""
    document, series = example
    kinds: list[Callable[[Any], bool]] = [
        lambda value: isinstance(value, bool),
        lambda value: isinstance(value, int | float) and not isinstance(value, bool),
        lambda value: isinstance(value, str),
    ]
    studies = [all_changed(document, is_kind) for is_kind in kinds]
    studies += [removed(document, StudyDocument, key) for key in document.model_fields_set - {"title"}]
    studies += [removed(document, kind, key) for kind, key in PARTS]
    studies.append(with_facts(document, StudyDocument, {"sensitivity_design": [["method", "morris"]]}))
    one_sensor = {key: document.sensor_info[key] for key in report_facts.SENSORS[:1]}
    single = document.model_copy(
        update={
            "sensor_info": one_sensor,
            "criteria": document.criteria[:1],
            **{
                part: {key: entry for key, entry in getattr(document, part).items() if key in one_sensor}
                for part in ("sensors", "residuals", "spectra", "day_shares", "sensitivity")
            },
        }
    )
    return [*(page_of(study, series) for study in studies), page_of(single, with_gap(series))]


#: Parts of entries without which a section is still there.
PARTS: Final[tuple[tuple[type[ResultEntry], str], ...]] = (
    (analysis.PhaseChangeEntry, "law_temperature"),
    (analysis.PhaseChangeEntry, "days"),
    (building.SurfaceEntry, "vertices"),
    (comparison.SensorEntry, "uncertainty"),
    (estimates.ParameterEntry, "low"),
    (analysis.ResidualEntry, "daily_cycle"),
    (analysis.ResidualEntry, "hour_mean"),
    (analysis.PhaseChangeEntry, "hysteresis"),
)


def test_no_sentence_is_the_same_whatever_was_found(base: Page, opposites: list[Page]) -> None:
    constant: dict[str, set[str]] = {}
    for section, clauses in base.clauses.items():
        shown = [page.clauses[section] for page in opposites if section in page.clauses]
        assert len(shown) > 3, section
        same = {clause for clause in clauses if all(clause in words for words in shown)}
        sentences = {clause for clause in same if len(clause.split()) >= FEWEST_WORDS}
        constant |= {section: sentences} if sentences else {}
    assert constant == EXPLANATIONS


def yes_or_no() -> list[tuple[type[ResultEntry], str]]:
    """All facts of the results that are true or false."""
    modules = (analysis, building, comparison, estimates)
    kinds = [kind for module in modules for kind in vars(module).values() if isinstance(kind, type)]
    return [
        (kind, key)
        for kind in dict.fromkeys((*kinds, StudyDocument, LivePageEntry))
        if issubclass(kind, ResultEntry)
        for key, field in kind.model_fields.items()
        if bool in (field.annotation, *typing.get_args(field.annotation))
    ]


@pytest.mark.parametrize(("kind", "key"), yes_or_no(), ids=lambda value: getattr(value, "__name__", value))
def test_each_yes_or_no_changes_the_words_of_a_report(
    example: tuple[StudyDocument, Series], base: Page, kind: type[ResultEntry], key: str
) -> None:
    if (kind, key) in SAID_ELSEWHERE:
        return
    document, series = example
    entries = [entry for entry in report_facts.instances(document) if type(entry) is kind]
    assert any(entry.states(key) for entry in entries), "the example does not state it"
    other = changed(document, kind, key, lambda facts: {**facts, key: opposite(facts[key])})
    assert page_of(other, series).clauses != base.clauses


#: Kind of entry, facts, section, what is said before, and what is said then.
FACTS: Final[list[tuple[type[ResultEntry], dict[str, Any], str, str, str]]] = [
    (analysis.QualityEntry, {"masked": False}, "data", "excluded", "included"),
    (analysis.QualityEntry, {"masked": True, "compared": True}, "data", "included", "excluded"),
    (analysis.QualityEntry, {"kind": "missing"}, "data", "included", "no value"),
    (StudyDocument, {"quality": []}, "data", "excluded", "None was found."),
    (analysis.PhaseChangeEntry, {"hysteresis": True}, "phase-change", "has no hysteresis", "heating curve"),
    (analysis.PhaseChangeEntry, {"hysteresis": False, "own_path": ""}, "phase-change", "heating curve",
     "has no hysteresis"),
    (analysis.ResidualEntry, {"white": True}, "residuals", "leaves its band",
     "Room air and Steel sheet stays"),
    (analysis.ResidualEntry, {"white": False}, "residuals", "stays inside its band", "leaves its band"),
    (analysis.ResidualEntry, {"correlation_band": 1.0}, "residuals", "correlate with the weather",
     "No residual correlates"),
    (comparison.BandEntry, {"stated": False}, "curves", "are expected inside", "not to be used"),
    (comparison.BandEntry, {"confidence": 0.8}, "curves", "95\u00a0%".replace("\u00a0", " "), "80 %"),
    (estimates.ParameterEntry, {"stated": False}, "parameters", "with the 95 % confidence interval",
     "not stated"),
    (estimates.ParameterEntry, {"fitted": None}, "sensitivity", "a dot marks", "largest indices."),
    (estimates.SpectrumEntry, {"threshold": 0.0}, "sensitivity", "above the dashed line", "numbered peaks"),
    (estimates.SpectrumEntry, {"peaks": []}, "sensitivity", "numbered peaks", "There are no peaks."),
    (StudyDocument, {"sensitivity_design": [["method", "morris"]]}, "sensitivity", "First-order index S1 [%]",
     "elementary effect"),
    (StudyDocument, {"sensitivity_design": [["index", "total index"]]}, "sensitivity",
     "First-order index S1 [%]", "Total index [%]"),
    (StudyDocument, {"sound": False}, "", "", "Not sound."),
    (StudyDocument, {"contradictions": []}, "summary", "contradicts its data", "no contradiction"),
    (StudyDocument, {"sensitivity": {}}, "summary", "10 of 11 calibrated parameters that matter most",
     "The first 10 of 11 calibrated parameters"),
    (comparison.CriterionEntry, {"passed": False}, "summary", "meets all 6", "meets none of 6"),
    (building.LayerEntry, {"kind": "solid"}, "model", "Layers with dots", ""),
    (comparison.SensorEntry, {"output": "elsewhere.air_temperature"}, "model", "Numbered dots", ""),
    (analysis.ErrorSourcesEntry, {"steps": []}, "error-sources", "were not calibrated",
     "No parameter reduces"),
    (analysis.ErrorSourcesEntry, {"all_parameters": None}, "error-sources", "An error that remains with all",
     ""),
    (StudyDocument, {"diagnosis": analysis.DiagnosisEntry()}, "error-sources", "The causes that", ""),
    (StudyDocument, {"models": {"nominal": comparison.ModelEntry(label="nominal")}, "sensors": {}}, "",
     "by the fitted model", "by the nominal model"),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "facts", "section", "before", "after"), FACTS)
def test_opposite_facts_are_said(
    example: tuple[StudyDocument, Series],
    base: Page,
    kind: type[ResultEntry],
    facts: dict[str, Any],
    section: str,
    before: str,
    after: str,
) -> None:
    document, series = example
    words, other = base.words(section), page_of(with_facts(document, kind, facts), series).words(section)
    if before:
        assert before in words
        assert before not in other
    assert after in other


def test_a_parameter_that_was_calibrated_was_not_well_determined(
    example: tuple[StudyDocument, Series],
) -> None:
    document, series = example
    path = next(iter(document.parameters))
    step = analysis.SourceStep(path=path, changes={path: 0.2}, sd={})
    study = document.model_copy(update={"shortfall": document.shortfall.model_copy(update={"steps": [step]})})
    words = page_of(study, series).words("error-sources")
    assert "was calibrated, but not well determined." in words
    assert "not calibrated." not in words


def test_periods_of_the_same_days_count_once(example: tuple[StudyDocument, Series]) -> None:
    document, series = example
    blind, corroboration = document.periods["blind"], document.periods["corroboration"]
    only_blind = document.criteria[0].model_copy(update={"period": "blind", "name": "only on blind days"})
    twice = [
        *document.criteria,
        *(c.model_copy(update={"period": "blind"}) for c in document.criteria if c.period == "corroboration"),
        only_blind,
    ]
    same = document.model_copy(
        update={
            "periods": {**document.periods, "blind": blind.model_copy(update={"spans": corroboration.spans})},
            "criteria": twice,
        }
    )
    shown = same.without_repeated_periods()
    assert list(shown.periods) == ["identification", "corroboration"]
    # What is judged on the blind days alone is not lost: it names the period that is shown.
    assert len(shown.criteria) == len(document.criteria) + 1
    assert shown.criteria[-1].period == "corroboration"
    assert {entry.period for entry in shown.residuals.values()} == {"corroboration"}
    assert shown.shortfall.period == "corroboration"
    assert page_of(shown, series).words("residuals").count(", corroboration") == len(shown.residuals)
    assert document.without_repeated_periods() is document
