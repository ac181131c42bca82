"""What a study leaves behind: study.json, tables, figures, curves and the report."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.study.document import analysed_hours, document
from mascarin.study.pipeline import DRIVERS
from mascarin.study.storage import Workspace, write_whole

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.calibration import Fit, Profile
    from mascarin.study.pipeline import Findings, ModelRun, Study
    from mascarin.validation.criteria import Verdict
    from mascarin.weather.quality import Stretch


#: When a study was run, and how long it took.
RUN: Final = "run.json"


def write_all(study: Study, findings: Findings, workspace: Workspace) -> None:
    """Write everything but the report into the study's folder; each file appears when it is complete.

    Parameters
    ----------
    study : Study
        The inputs.
    findings : Findings
        What was found.
    workspace : Workspace
        The folder.
    """
    out = workspace.out
    written = [
        *_figures(study, findings, _folder(out / "figures")),
        *fit_figures(findings.fit, findings.profiles, out / "figures"),
        *_tables(study, findings, _folder(out / "tables")),
        *(out / name for name in ("study.json", RUN, "report.html")),
    ]
    write_whole(out / "study.json", json.dumps(document(study, findings), indent=1, allow_nan=False) + "\n")
    write_whole(out / RUN, json.dumps(_run(findings), indent=1) + "\n")
    workspace.settle("study", written)


def _run(findings: Findings) -> dict[str, Any]:
    """What is another each time a study is run, apart from the results, which are the same to the byte."""
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "run_time": round(findings.seconds, 1),
        "processors": os.cpu_count(),
    }


def _folder(path: Path) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    return path


def _tables(study: Study, findings: Findings, folder: Path) -> list[Path]:
    tables = {
        "metrics": metrics_table(list(_runs(findings))),
        "parameters": findings.fit.table(),
        "evaluations": findings.fit.evaluations(),
        "criteria": criteria_table(findings.verdicts),
        "quality": quality_table(findings.quality),
        "series": _series(study, findings),
    }
    if findings.sensitivity is not None:
        tables["sensitivity"] = findings.sensitivity.table()
    return write_tables(folder, tables)


def fit_figures(fit: Fit, profiles: Sequence[Profile], folder: Path) -> list[Path]:
    """The course of the search, where its sequences ended, and the profiles, as far as there are any.

    Parameters
    ----------
    fit : Fit
        The identification.
    profiles : sequence of Profile
        Perhaps none.
    folder : Path
        Where to.
    """
    from mascarin.calibration import plots
    from mascarin.figures.files import save

    figures = {"identification-course": plots.course(fit)}
    if len(fit.minima) > 1:
        figures["identification-minima"] = plots.minima(fit)
    if profiles:
        figures["identification-profiles"] = plots.profiles(profiles)
    return [save(figure, folder / f"{name}.svg") for name, figure in figures.items()]


def write_tables(folder: Path, tables: Mapping[str, pd.DataFrame]) -> list[Path]:
    """Write tables as CSV; each appears when it is complete.

    Parameters
    ----------
    folder : Path
        Where to; made when it is missing.
    tables : mapping of str to DataFrame
        By name without ending.

    Returns
    -------
    list of Path
        The files.
    """
    _folder(folder)
    for name, table in tables.items():
        write_whole(folder / f"{name}.csv", table.to_csv(index=False, lineterminator="\n"))
    return [folder / f"{name}.csv" for name in tables]


def metrics_table(runs: Sequence[ModelRun]) -> pd.DataFrame:
    """One row for each model, sensor and period."""
    import pandas as pd

    return pd.DataFrame(
        [
            {"sensor": sensor, "period": period, "model": run.label, **metrics.to_dict()}
            for run in runs
            for sensor, periods in run.scores.items()
            for period, metrics in periods.items()
        ]
    )


def criteria_table(verdicts: Mapping[str, Sequence[Verdict]]) -> pd.DataFrame:
    """One row for each model, criterion, sensor and period."""
    import pandas as pd

    columns = ["model", "name", "sensor", "period", "metric", "value", "limit", "unit", "passed"]
    rows = [{"model": model, **verdict.to_dict()} for model, found in verdicts.items() for verdict in found]
    return pd.DataFrame(rows, columns=columns)


def quality_table(stretches: Sequence[Stretch]) -> pd.DataFrame:
    """One row for each suspicious stretch."""
    import pandas as pd

    return pd.DataFrame(
        [(s.channel, s.kind, s.start, s.end, s.count, s.detail) for s in stretches],
        columns=["channel", "kind", "start", "end", "count", "detail"],
    )


def _runs(findings: Findings) -> Iterator[ModelRun]:
    yield from (findings.nominal, findings.fitted)
    yield from findings.variants.values()


def _series(study: Study, findings: Findings) -> Any:
    """Measured and simulated series, weather and states at the instants of the comparison."""
    import pandas as pd

    observation = study.observation
    table = pd.DataFrame({"time": observation.times.map(lambda stamp: stamp.isoformat())})
    for s, name in enumerate(observation.names):
        table[f"{name}.measured"] = observation.measured[:, s]
    for run in _runs(findings):
        simulated = observation.simulated(run.results.index, run.results.records)
        for s, name in enumerate(observation.names):
            table[f"{name}.{run.label}"] = np.round(simulated[:, s], 6)
    for s, name in enumerate(observation.names):
        table[f"{name}.band"] = np.round(findings.band.half_width[:, s], 6)
    fitted = findings.fitted
    for channel in DRIVERS.values():
        values = observation.sampled(fitted.results.index, fitted.simulation.weather(channel))
        if np.ptp(values) > 0.0:
            table[f"weather.{channel}"] = np.round(values, 4)
    for k, output in enumerate(fitted.results.outputs):
        if output.kind == "liquid_fraction":
            values = observation.sampled(fitted.results.index, fitted.results.records[:, k])
            table[f"state.{output.name}"] = np.round(values, 6)
    return table


def _figures(study: Study, findings: Findings, folder: Path) -> list[Path]:
    from mascarin.figures.files import save
    from mascarin.sensitivity.files import save_all

    observation = study.observation
    models = {
        run.label: observation.simulated(run.results.index, run.results.records)
        for run in (findings.nominal, findings.fitted)
    }
    drawn = []
    for s, name in enumerate(observation.names):
        curves = {label: values[:, s] for label, values in models.items()}
        drawn.append(save(_comparison(study, s, curves), folder / f"{name}.svg"))
        if findings.sensitivity is not None:
            hours = analysed_hours(study, findings.sensitivity)
            drawn += save_all(findings.sensitivity, name, folder, name, hours)
    return drawn


def _comparison(study: Study, s: int, models: dict[str, Any]) -> Any:
    """Measured and simulated curves with the sensor's band; the error below."""
    from matplotlib.figure import Figure

    observation = study.observation
    name = observation.names[s]
    sensor, measured = study.file.sensors[name], observation.measured[:, s]
    local = observation.times.tz_localize(None)
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    upper.fill_between(
        local,
        measured - sensor.uncertainty,
        measured + sensor.uncertainty,
        color="0.85",
        lw=0,
        label="sensor band",
    )
    upper.plot(local, measured, color="0.2", lw=1.0, label=study.file.observed)
    for (label, values), colour in zip(models.items(), ("#0072b2", "#d55e00"), strict=True):
        upper.plot(local, values, lw=1.0, color=colour, label=label)
        lower.plot(local, values - measured, lw=0.9, color=colour)
    first, last = (stamp.tz_localize(None) for stamp in study.identification)
    for axes in (upper, lower):
        axes.axvspan(first, last, color="#009e73", alpha=0.08, lw=0, label="identification")
        axes.grid(alpha=0.3)
    upper.set_title(sensor.label or name, loc="left", fontsize=11)
    upper.set_ylabel("degC")
    upper.legend(fontsize="small", ncols=5, loc="upper left", bbox_to_anchor=(0.0, -0.02), frameon=False)
    lower.axhline(0.0, color="0.2", lw=0.8)
    lower.set_ylabel("simulated - observed [K]")
    lower.set_xlabel(f"local time ({study.climate.timezone})")
    return figure
