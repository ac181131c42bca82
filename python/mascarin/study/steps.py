"""One step of a study alone: the same inputs, the same work, the same pieces of the result.

Unfinished work is kept where the whole study keeps it: a study goes on from what a step has done.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mascarin.study.description import SensitivityPlan
from mascarin.study.document import (
    analysed_hours,
    comparison,
    estimates,
    foreseen,
    header,
    importance,
    profile_entries,
)
from mascarin.study.outputs import criteria_table, fit_figures, metrics_table, quality_table, write_tables
from mascarin.study.pipeline import Study, Teller
from mascarin.study.prediction_intervals import answers, band, band_words
from mascarin.study.storage import Workspace, write_whole

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.sensitivity import MethodName


def sensitivity(
    study: Study, out: Path, *, method: MethodName | None = None, quiet: bool = False
) -> dict[str, Any]:
    """Which parameters matter.

    Parameters
    ----------
    study : Study
        Without a ``sensitivity`` of its own it gets the usual one.
    out : Path
        Folder for sensitivity.json, tables/sensitivity.csv and the figures.
    method : str, optional
        In the place of the study's, with the usual number of samples.
    quiet : bool
        No progress on stderr.

    Returns
    -------
    dict
        What sensitivity.json holds.

    Raises
    ------
    InputError
        The method cannot do what the study asks for.
    """
    from mascarin.sensitivity.files import save_all

    with Workspace(out, study.inputs()) as workspace:
        # A default of pydantic's own, so that every other key is the usual one.
        plan = study.file.sensitivity or SensitivityPlan.model_validate({})
        if method is not None and method != plan.method:
            plan = plan.model_copy(update={"method": method, "samples": None, "order": None})
        found = study.screened(plan, workspace, Teller(quiet))
        hours = analysed_hours(study, found)
        drawn = [
            path for name in found.outputs for path in save_all(found, name, out / "figures", name, hours)
        ]
        content = {**header(study, "sensitivity"), **importance(study, found)}
        _write(workspace, "sensitivity", content, {"sensitivity": found.table()}, drawn)
    return content


def calibration(study: Study, out: Path, *, quiet: bool = False) -> dict[str, Any]:
    """The parameters that bring the model closest to the measurements, and how close that is on other days.

    Parameters
    ----------
    study : Study
        Says what to identify.
    out : Path
        Folder for calibration.json, its tables and figures.
    quiet : bool
        No progress on stderr.

    Returns
    -------
    dict
        What calibration.json holds.
    """
    _ = study.sought
    with Workspace(out, study.inputs()) as workspace:
        nominal = study.nominal()
        fitted, fit = study.fitted(workspace, Teller(quiet))
        models, verdicts = {"nominal": nominal, "fitted": fitted}, study.judged(nominal, fitted)
        found = band(study, fitted, fit, answers(study, fitted, fit))
        profiles = study.profiled(fit, Teller(quiet))
        content = {
            **header(study, "calibrate"),
            **comparison(models, verdicts),
            **estimates(study, fit),
            **profile_entries(profiles),
            **foreseen(study, found),
            "notes": [
                {"title": "The estimates", "text": text}
                for text in (
                    *fit.warnings,
                    *(p.words for p in profiles if p.words),
                    *band_words(study, found),
                )
            ],
        }
        tables = {
            "parameters": fit.table(),
            "evaluations": fit.evaluations(),
            "calibration_metrics": metrics_table([nominal, fitted]),
            "calibration_criteria": criteria_table(verdicts),
            "quality": quality_table(study.quality),
        }
        _write(workspace, "calibration", content, tables, fit_figures(fit, profiles, out / "figures"))
    return content


def validation(study: Study, out: Path | None) -> dict[str, Any]:
    """The building as described against the measurements.

    Parameters
    ----------
    study : Study
        Its identification is not carried out.
    out : Path, optional
        Folder for validation.json and its tables; without it nothing is written.

    Returns
    -------
    dict
        What validation.json holds.
    """
    if out is None:
        return _validated(study)[0]
    with Workspace(out, study.inputs()) as workspace:  # refuses what is no folder before anything is run
        content, tables = _validated(study)
        _write(workspace, "validation", content, tables)
    return content


def _validated(study: Study) -> tuple[dict[str, Any], dict[str, pd.DataFrame]]:
    nominal = study.nominal()
    verdicts = study.judged(nominal)
    tables = {
        "validation_metrics": metrics_table([nominal]),
        "validation_criteria": criteria_table(verdicts),
        "quality": quality_table(study.quality),
    }
    return {**header(study, "validate"), **comparison({"nominal": nominal}, verdicts)}, tables


def _write(
    workspace: Workspace,
    name: str,
    content: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    further: Iterable[Path] = (),
) -> None:
    result = workspace.out / f"{name}.json"
    written = [*write_tables(workspace.out / "tables", tables), *further, result]
    write_whole(result, as_json(content))
    workspace.settle(name, written)


def as_json(content: Mapping[str, Any]) -> str:
    """The text of a result file."""
    return json.dumps(content, indent=1, allow_nan=False) + "\n"
