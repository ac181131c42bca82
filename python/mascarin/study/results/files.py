"""Writes the results of a study: study.json, tables and figures."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin._io import atomic
from mascarin.calibration import plot_profiles
from mascarin.figures import days as day_figures
from mascarin.figures.files import save
from mascarin.pages.study.data.folder import read_folder
from mascarin.pages.study.figures.figure_files import Once, write_figures
from mascarin.sensitivity.files import save_all
from mascarin.study.carried.calibrated_building import FILE
from mascarin.study.context.step_cache import written_once
from mascarin.study.context.storage import RUN, WRITTEN
from mascarin.study.results.document.sensitivity import analyzed_hours
from mascarin.study.results.document.whole import document
from mascarin.study.results.live_page import PageContent, write_page
from mascarin.study.results.tables import tables_of, write_tables
from mascarin.study.steps.calibration_result import building_with_posterior
from mascarin.study.steps.comfort import comfort_figures, comfort_table, rated
from mascarin.study_document.document import StudyDocument
from mascarin.validation.days import EXTRAPOLATION_RATIO

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mascarin.calibration import Calibration, Profile
    from mascarin.calibration.base.result import PlotKind
    from mascarin.study.context.storage import Workspace
    from mascarin.study.steps.findings import Findings


def write_all(
    findings: Findings, workspace: Workspace, *, figures: bool = True, page: PageContent = "model"
) -> list[Path]:
    """Write everything but the report into the folder of the study.

    Parameters
    ----------
    findings : Findings
        The results.
    workspace : Workspace
        The folder.
    figures : bool
        Whether figures are written.
    page : str
        What the page beside the report has: ``model``, ``measured`` or ``none``.

    Returns
    -------
    list of Path
        All results, the report among them: `Workspace.record` takes them when it is there.
    """
    out = workspace.out
    comfort = rated(findings)
    of_comfort = {"comfort": comfort_table(comfort)} if comfort else {}
    tables = write_tables(out / "tables", {**tables_of(findings), **of_comfort})
    atomic.write(out / "study.json", as_json(document(findings)))
    calibrated = building_with_posterior(
        findings.context,
        findings.fitted,
        findings.calibration,
        findings.prediction_intervals,
        findings.combination,
    )
    calibrated.to_yaml(out / FILE)
    live = None if page == "none" else write_page(findings.context, calibrated, out, page)
    facts = [run_facts(findings), *([] if live is None else [StudyDocument(live=live)])]
    atomic.write(out / RUN, as_json(StudyDocument.joined(*facts)))
    return [
        out / FILE,
        *([] if live is None or not live.file else [out / live.file]),
        *chains_file(findings.calibration, out),
        *(_all_figures(findings, workspace) if figures else []),
        *(comfort_figures(comfort, out / "figures") if figures else []),
        *tables,
        *(out / name for name in WRITTEN),
    ]


def chains_file(fit: Calibration, out: Path) -> list[Path]:
    """Write the chains of a sampled posterior, for ArviZ; none of a linearized one."""
    return [] if fit.posterior is None else [fit.posterior.to_netcdf(out / "posterior.nc")]


def _all_figures(findings: Findings, workspace: Workspace) -> list[Path]:
    """Write every figure, once for the same results."""
    folder = workspace.out / "figures"
    folder.mkdir(parents=True, exist_ok=True)

    def once(name: str, write: Callable[[], Sequence[Path]]) -> list[Path]:
        return written_once(workspace, (str(workspace.out), name, findings.calibration.x.tolist()), write)

    return [
        *write_figures(folder, *read_folder(workspace.out), once),
        *_sensitivity_figures(findings, folder, once),
        *once("days", lambda: [save(_days(findings), folder / "days.svg")]),
        *once("fit", lambda: fit_figures(findings.calibration, findings.profiles, folder)),
    ]


def run_facts(findings: Findings) -> StudyDocument:
    """Date and run time, which differ between two runs of the same study; all results are the same."""
    return StudyDocument(
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        run_time=round(findings.seconds, 1),
        processors=os.cpu_count(),
    )


def as_json(content: StudyDocument) -> str:
    """The text of a result file."""
    return json.dumps(content.to_dict(), indent=1, allow_nan=False) + "\n"


def fit_figures(fit: Calibration, profiles: Sequence[Profile], folder: Path) -> list[Path]:
    """Write the figures of a calibration: cost of the evaluations, minima and profiles.

    Parameters
    ----------
    fit : Calibration
        The calibration.
    profiles : sequence of Profile
        May be empty.
    folder : Path
        Where to write.
    """

    def drawn(kind: PlotKind) -> Figure:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        fit.plot(kind, ax=figure.subplots())
        return figure

    figures = {"identification-course": drawn("convergence")}
    if len(fit.minima) > 1:
        figures["identification-minima"] = drawn("minima")
    if profiles:
        figures["identification-profiles"] = plot_profiles(profiles)
    return [save(figure, folder / f"{name}.svg") for name, figure in figures.items()]


def _sensitivity_figures(findings: Findings, folder: Path, once: Once) -> list[Path]:
    """Figures of the sensitivity analysis of each sensor, if there is one."""
    analysis = findings.sensitivity
    if analysis is None:
        return []
    hours = analyzed_hours(findings.context, analysis)
    written = []
    for name in findings.context.observation.names:

        def draw(name: str = name) -> list[Path]:
            return list(save_all(analysis, name, folder, name, hours))

        written += once(f"sensitivity {name}", draw)
    return written


def _days(findings: Findings) -> Figure:
    """Leverage of each day, and the information that it would add."""
    from matplotlib.figure import Figure
    from pandas import to_datetime

    choice = findings.days
    dates = to_datetime(list(choice.days))
    figure = Figure(figsize=(9.0, 4.5), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    day_figures.leverage(upper, dates, choice.ratio, choice.used, choice.proposed, EXTRAPOLATION_RATIO)
    day_figures.information(lower, dates, choice.information, choice.used, choice.proposed)
    upper.legend(fontsize="small", ncols=4, frameon=False)
    lower.set_xlabel(f"local time ({findings.context.climate.timezone})")
    return figure
