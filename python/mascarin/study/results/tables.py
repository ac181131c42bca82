"""Results of a study as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin._io import atomic
from mascarin.measurements.uncertainty import COVERAGE_FACTOR
from mascarin.study.steps.residuals import DRIVERS

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.calibration import Calibration
    from mascarin.diagnosis.hypotheses import Diagnosis
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Findings, ModelRun
    from mascarin.tables.quality import Stretch
    from mascarin.validation.criteria import Verdict
    from mascarin.validation.days import DayChoice


def tables_of(findings: Findings) -> dict[str, pd.DataFrame]:
    """All tables by name.

    Parameters
    ----------
    findings : Findings
        The results.

    Returns
    -------
    dict of str to DataFrame
        ``metrics``, ``parameters``, ``evaluations``, ``criteria``, ``quality``, ``causes``,
        ``days``, ``series``, and
        ``sensitivity`` if the study has one.
    """
    tables = {
        "metrics": metrics_table(list(findings.runs())),
        "parameters": estimates_table(findings.calibration),
        "evaluations": findings.calibration.evaluations(),
        "criteria": criteria_table(findings.criteria),
        "quality": quality_table(findings.quality),
        "causes": causes_table(findings.diagnosis),
        "days": days_table(findings.days),
        "series": series_table(findings),
    }
    if findings.sensitivity is not None:
        tables["sensitivity"] = findings.sensitivity.table()
    return tables


def estimates_table(calibration: Calibration) -> pd.DataFrame:
    """One row per parameter: nominal and calibrated value, interval, unit, remark."""
    table = calibration.to_dataframe().reset_index().rename(columns={"estimate": "fitted"})
    return table[["parameter", "nominal", "fitted", "low", "high", "unit", "remark"]]


def write_tables(folder: Path, tables: Mapping[str, pd.DataFrame]) -> list[Path]:
    """Write tables as CSV files.

    Parameters
    ----------
    folder : Path
        Folder; it is created if it does not exist.
    tables : mapping of str to DataFrame
        By name without ending.

    Returns
    -------
    list of Path
        The files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables.items():
        atomic.write(folder / f"{name}.csv", table.to_csv(index=False, lineterminator="\n"))
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
    rows = [{"model": model, **verdict.to_dict()} for model, judged in verdicts.items() for verdict in judged]
    return pd.DataFrame(rows, columns=columns)


def quality_table(stretches: Sequence[Stretch]) -> pd.DataFrame:
    """One row for each sequence of suspicious values."""
    import pandas as pd

    return pd.DataFrame(
        [(s.channel, s.kind, s.start, s.end, s.count, s.detail) for s in stretches],
        columns=["channel", "kind", "start", "end", "count", "detail"],
    )


def causes_table(diagnosis: Diagnosis) -> pd.DataFrame:
    """One row for each cause, in their order."""
    import pandas as pd

    columns = ["group", "what", "subject", "value", "error", "unit", "p", "certainty", "log_bayes_factor"]
    columns += ["told", "same", "text"]
    rows = [
        {**cause.to_dict(), "subject": ", ".join(cause.subject), "same": ", ".join(cause.same)}
        for cause in diagnosis.causes
    ]
    return pd.DataFrame(rows, columns=columns)


def days_table(choice: DayChoice) -> pd.DataFrame:
    """One row for each day: leverage, expected information, and parts outside of the identification."""
    import pandas as pd

    order = {d: k for k, d in enumerate(choice.proposed, start=1)}
    return pd.DataFrame(
        {
            "day": list(choice.days),
            "used": choice.used,
            "leverage": choice.leverage,
            "ratio": choice.ratio,
            "information": choice.information,
            "reduction": choice.reduction,
            "order": [order.get(d, "") for d in range(len(choice.days))],
            **{f"outside {name}": values for name, values in choice.outside.items()},
        }
    )


def validation_series(study: StudyContext, run: ModelRun) -> pd.DataFrame:
    """Measured and predicted series of an uncalibrated model, one row for each instant; units in the header.

    Parameters
    ----------
    study : StudyContext
        The study.
    run : ModelRun
        The model.

    Returns
    -------
    DataFrame
        ``time`` (local, with its offset), then for each sensor its ``period``, ``measured`` and ``predicted``
        value, ``band`` (half-width of the 95 % interval of a measured value, from its stated uncertainty) and
        ``residual`` (predicted minus measured).
    """
    import pandas as pd

    observation = study.observation
    simulated = observation.simulated(run.results.index, run.results.records)
    columns: dict[str, object] = {"time": observation.times.map(lambda stamp: stamp.isoformat())}
    for s, name in enumerate(observation.names):
        unit = run.results.outputs[s].unit
        difference = unit.replace("degC", "K")
        measured, stated = (
            observation.measured[:, s],
            study.plan.sensors[name].uncertainty(unit, f"sensors.{name}"),
        )
        half = COVERAGE_FACTOR * np.hypot(stated.absolute, stated.relative * measured)
        period = np.full(len(measured), "", dtype=object)
        for word in ("blind", "corroboration", "identification"):
            period[study.used[word][:, s]] = word
        columns |= {
            f"{name}.period": period,
            f"{name}.measured [{unit}]": measured,
            f"{name}.predicted [{unit}]": np.round(simulated[:, s], 6),
            f"{name}.band [{difference}]": np.round(half, 6),
            f"{name}.residual [{difference}]": np.round(simulated[:, s] - measured, 6),
        }
    return pd.DataFrame(columns)


def series_table(findings: Findings) -> pd.DataFrame:
    """Measured and simulated series, weather and states at the instants of the comparison."""
    import pandas as pd

    observation = findings.context.observation
    table = pd.DataFrame({"time": observation.times.map(lambda stamp: stamp.isoformat())})
    for s, name in enumerate(observation.names):
        table[f"{name}.measured"] = observation.measured[:, s]
    for run in findings.runs():
        simulated = observation.simulated(run.results.index, run.results.records)
        for s, name in enumerate(observation.names):
            table[f"{name}.{run.label}"] = np.round(simulated[:, s], 6)
    fitted = findings.fitted
    about = observation.simulated(fitted.results.index, fitted.results.records)
    for s, name in enumerate(observation.names):
        if findings.combination is not None:
            expected = about[:, s] + findings.prediction_intervals.center[:, s]
            table[f"{name}.expected"] = np.round(expected, 6)
        table[f"{name}.band"] = np.round(findings.prediction_intervals.half_width[:, s], 6)
    for channel in DRIVERS.values():
        values = observation.sampled(fitted.results.index, fitted.simulation.weather(channel))
        if np.ptp(values) > 0.0:
            table[f"weather.{channel}"] = np.round(values, 4)
    for k, output in enumerate(fitted.results.outputs):
        if output.kind == "liquid_fraction":
            values = observation.sampled(fitted.results.index, fitted.results.records[:, k])
            table[f"state.{output.name}"] = np.round(values, 6)
    return table
