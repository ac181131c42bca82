"""Single steps of a study: sensitivity analysis, calibration, comparison of the uncalibrated model.

Intermediate results are stored as by the whole study, which uses what a single step has computed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin._io import atomic
from mascarin.sensitivity.files import save_all
from mascarin.study.carried.calibrated_building import FILE
from mascarin.study.carried.validation import Validation
from mascarin.study.context.storage import Workspace
from mascarin.study.file.description import SensitivityPlan
from mascarin.study.results.document.comparison import comparison
from mascarin.study.results.document.errors import error_entries, error_tables, error_words, mixed_forms
from mascarin.study.results.document.estimates import estimates, profile_entries
from mascarin.study.results.document.header import header
from mascarin.study.results.document.sensitivity import analyzed_hours, importance
from mascarin.study.results.document.whole import ESTIMATES, contradictions
from mascarin.study.results.files import as_json, chains_file, fit_figures
from mascarin.study.results.tables import (
    criteria_table,
    estimates_table,
    metrics_table,
    quality_table,
    validation_series,
    write_tables,
)
from mascarin.study.steps.calibration_result import building_with_posterior, calibrated
from mascarin.study.steps.model_runs import ModelRuns, judged, nominal
from mascarin.study.steps.prediction_intervals import interval_entries, interval_table, interval_words
from mascarin.study.steps.predictive_checks import statements
from mascarin.study.transfer.bands import bands_of
from mascarin.study.transfer.comparison import described_entries, identified_entries, transfer_table
from mascarin.study_document.analysis import NoteEntry, TableEntry
from mascarin.study_document.comparison import TransferEntry
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.progress import ProgressOption
    from mascarin.sensitivity import MethodName
    from mascarin.study.context.context import StudyContext


def sensitivity(
    study: StudyContext, out: Path, *, method: MethodName | None = None, progress: ProgressOption = True
) -> StudyDocument:
    """Sensitivity analysis.

    Parameters
    ----------
    study : StudyContext
        If it has no ``sensitivity``, the defaults are used.
    out : Path
        Folder for sensitivity.json, tables/sensitivity.csv and the figures.
    method : str, optional
        Replaces that of the study, with the default number of samples.
    progress : bool, callable or None
        Where progress is shown; see `mascarin.progress.ProgressOption`.

    Returns
    -------
    StudyDocument
        What sensitivity.json holds.

    Raises
    ------
    InputError
        The method does not support the plan of the study.
    """
    with Workspace(out, study.identity()) as workspace:
        # An empty plan takes the default of every key.
        plan = study.plan.sensitivity or SensitivityPlan.model_validate({})
        if method is not None and method != plan.method:
            plan = plan.model_copy(update={"method": method, "samples": None, "order": None})
        found = ModelRuns(study, workspace, progress).sensitivity(plan)
        hours = analyzed_hours(study, found)
        drawn = [
            path for name in found.outputs for path in save_all(found, name, out / "figures", name, hours)
        ]
        content = StudyDocument.joined(
            header(study, "sensitivity"),
            importance(study, found),
            StudyDocument(warnings=[*found.warnings]),
        )
        _write(workspace, "sensitivity", content, {"sensitivity": found.table()}, drawn)
    return content


def calibration(study: StudyContext, out: Path, *, progress: ProgressOption = True) -> StudyDocument:
    """Calibration, and the comparison before and after it.

    Parameters
    ----------
    study : StudyContext
        Has an identification.
    out : Path
        Folder for calibration.json, its tables and figures.
    progress : bool, callable or None
        Where progress is shown; see `mascarin.progress.ProgressOption`.

    Returns
    -------
    StudyDocument
        What calibration.json holds.
    """
    _ = study.inputs.calibration_plan
    with Workspace(out, study.identity()) as workspace:
        runs = ModelRuns(study, workspace, progress)
        before = nominal(study)
        with study.keeping(workspace):
            found = calibrated(study, runs)
        fitted, fit, intervals, profiles = found.run, found.fit, found.intervals, found.profiles
        models, verdicts = {"nominal": before, "fitted": fitted}, judged(study, before, fitted)
        notes = (
            *fit.warnings,
            *(p.words for p in profiles if p.words),
            *error_words(study, found.combination),
            *interval_words(study, intervals),
        )
        content = StudyDocument.joined(
            header(study, "calibrate"),
            comparison(models, verdicts),
            estimates(study, fit, stated=intervals.stated),
            profile_entries(profiles),
            error_entries(study, found.combination),
            StudyDocument(
                contradictions=contradictions(found.contradictions),
                band=interval_entries(study, intervals),
                tables=[
                    interval_table(study, intervals, mixed_forms(found.combination)),
                    *error_tables(study, found.combination),
                    *_experiments(study, identified_entries(study, found)),
                ],
                transfer=identified_entries(study, found),
                notes=[NoteEntry(title=ESTIMATES, text=text) for text in notes],
            ),
        )
        tables = {
            "parameters": estimates_table(fit),
            "evaluations": fit.evaluations(),
            "calibration_metrics": metrics_table([before, fitted]),
            "calibration_criteria": criteria_table(verdicts),
            "quality": quality_table(study.quality),
        }
        calibrated_file = out / FILE
        building_with_posterior(study, fitted, fit, intervals, found.combination).to_yaml(calibrated_file)
        further = [calibrated_file, *chains_file(fit, out), *fit_figures(fit, profiles, out / "figures")]
        _write(workspace, "calibration", content, tables, further)
    return content


def validation(study: StudyContext, out: Path | None) -> Validation:
    """Comparison of the uncalibrated model with the measurements.

    Parameters
    ----------
    study : StudyContext
        Its calibration is not carried out.
    out : Path, optional
        Folder for validation.json, series.csv and the tables; without it nothing is written.

    Returns
    -------
    Validation
        What validation.json and series.csv hold.
    """
    if out is None:
        return _validated(study)[0]
    with Workspace(out, study.identity()) as workspace:  # raises before the run if the folder cannot be used
        validated, tables = _validated(study)
        series = out / "series.csv"
        atomic.write(series, validated.to_dataframe().to_csv(index=False, lineterminator="\n"))
        _write(workspace, "validation", validated.content, tables, [series])
    return validated


def _validated(study: StudyContext) -> tuple[Validation, dict[str, pd.DataFrame]]:
    run = nominal(study)
    verdicts = judged(study, run)
    tables = {
        "validation_metrics": metrics_table([run]),
        "validation_criteria": criteria_table(verdicts),
        "quality": quality_table(study.quality),
    }
    bands, words = bands_of(study, run)
    described = described_entries(study)
    content = StudyDocument.joined(
        header(study, "validate"),
        comparison({"nominal": run}, verdicts),
        StudyDocument(
            contradictions=contradictions((*words, *statements(study))),
            transfer=described,
            tables=_experiments(study, described),
        ),
    )
    series = validation_series(study, run)
    if bands is not None:
        units = [output.unit for output in run.results.outputs]
        entries = bands.entries(study.observation, study.used)
        content = StudyDocument.joined(content, StudyDocument(band=entries))
        series = bands.beside(series, study.observation.names, units)
    return Validation(content, series), tables


def _experiments(study: StudyContext, entries: Mapping[str, TransferEntry]) -> list[TableEntry]:
    """The table of the experiments, where the study has any."""
    return [transfer_table(study, entries)] if entries else []


def _write(
    workspace: Workspace,
    name: str,
    content: StudyDocument,
    tables: Mapping[str, pd.DataFrame],
    further: Iterable[Path] = (),
) -> None:
    result = workspace.out / f"{name}.json"
    written = [*write_tables(workspace.out / "tables", tables), *further, result]
    atomic.write(result, as_json(content))
    workspace.record(name, written)
