"""The results of a study: tables, report, and short descriptions."""

from __future__ import annotations

from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mascarin._io import display
from mascarin.errors import InputError, did_you_mean
from mascarin.pages import study as reports
from mascarin.pages.study.data.folder import read_series
from mascarin.study.results.document.whole import document
from mascarin.study.results.files import run_facts
from mascarin.study.results.tables import metrics_table, tables_of
from mascarin.study.steps.calibration_result import building_with_posterior
from mascarin.study.steps.findings import Findings
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building


@dataclass(frozen=True, eq=False, repr=False)
class StudyResults(Findings):
    """The results of a study, one attribute for each step.

    Attributes
    ----------
    nominal, fitted : ModelRun
        The model before and after the calibration: ``results``, ``scores``, ``simulation``.
    variants : dict of str to ModelRun
        Other choices of model.
    sensitivity : Sensitivity or None
        The sensitivity analysis, if the study has one.
    calibration : Calibration
        The calibrated parameters with their uncertainty.
    criteria : dict of str to list of Verdict
        Criteria of the nominal and of the fitted model.
    aims : list of Verdict
        Desired limits, and whether the fitted model meets them.
    residuals : dict of str to ResidualAnalysis
        Analysis of the residuals of each sensor on the blind days.
    error_sources : ErrorSources or None
        Parameters that would explain the remaining error on the blind days.
    diagnosis : Diagnosis
        Causes of the difference between the fitted model and the measurements: data, parameters, forms.
    days : DayChoice
        How far each day is outside of what the identification has excited, and which to use next.
    prediction_intervals : PredictionIntervals
        Prediction intervals of the fitted model, with their coverage.
    profiles : list of Profile
        Profile likelihood of every parameter, if the study asks for it.
    notes : list of str
        Diagnosis of the residuals in words.
    quality : list of Stretch
        Suspicious values of the measured columns.
    seconds : float
        Run time. [s]
    combination : Combination or None
        Forms of the model with their weights, where errors of sensors and model are estimated.
    contradictions : list of Contradiction
        By what the calibrated model contradicts its own data or what is known; read them first.
    context : StudyContext
        The study.

    Examples
    --------
    >>> from mascarin import Study
    >>> from mascarin.examples import synthetic_wall
    >>> wall = synthetic_wall()
    >>> study = Study(
    ...     building=wall.building,
    ...     climate=wall.climate,
    ...     measurements=wall.measurements,
    ...     sensors={
    ...         "joint": {
    ...             "column": "joint",
    ...             "output": "wall.interface_1_temperature",
    ...             "expanded_uncertainty": 0.1,
    ...         }
    ...     },
    ...     periods={"identification": ("2023-03-03", "2023-03-06")},
    ...     parameters=["materials.insulation.conductivity", "surfaces.wall.outside.absorptance"],
    ...     criteria=[{"metric": "rmse", "limit": 0.2}],
    ...     step="1h",
    ... )
    >>> results = study.run()
    >>> results.passed
    True
    >>> round(results.calibration.values["materials.insulation.conductivity"], 3)
    0.033
    >>> results.to_dataframe("parameters")["parameter"].tolist()
    ['materials.insulation.conductivity', 'surfaces.wall.outside.absorptance']
    """

    def to_dataframe(self, table: str = "metrics") -> pd.DataFrame:
        """One table of the results.

        Parameters
        ----------
        table : str
            ``metrics``, ``parameters``, ``evaluations``, ``criteria``, ``quality``, ``causes``,
            ``days``, ``series``, or ``sensitivity`` if the study has a sensitivity analysis.

        Returns
        -------
        pandas.DataFrame
            The table, as written to the folder ``tables``.

        Raises
        ------
        InputError
            There is no such table.
        """
        tables = tables_of(self)
        if table not in tables:
            raise InputError(
                f"table: found '{table}', expected one of {', '.join(tables)}. {did_you_mean(table, tables)}"
            )
        return tables[table]

    def to_dict(self) -> dict[str, Any]:
        """All results but the series as plain values: the content of ``study.json``.

        Returns
        -------
        dict
            Ready for JSON.
        """
        return document(self).to_dict()

    @property
    def building(self) -> Building:
        """The calibrated building with its posterior; ``to_yaml`` writes it for other buildings to extend."""
        return building_with_posterior(
            self.context, self.fitted, self.calibration, self.prediction_intervals, self.combination
        )

    def report(self, path: str | Path = "report.html") -> Path:
        """Write the report: one HTML file that needs no network.

        Parameters
        ----------
        path : str or Path
            File to write; its folder exists.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        OSError
            The file cannot be written.
        """
        content = StudyDocument.joined(document(self), run_facts(self))
        table = StringIO(self.to_dataframe("series").to_csv(index=False, lineterminator="\n"))
        return reports.write(Path(path), content, read_series(table, "series", content))

    def __repr__(self) -> str:
        return display.text(self._title(), self._rows())

    def _repr_html_(self) -> str:
        tables = {
            "Metrics": metrics_table([self.nominal, self.fitted]),
            "Calibrated parameters": self.calibration.to_dataframe(),
        }
        return display.page(self._title(), self._rows(), tables=tables)

    def _title(self) -> str:
        return f"StudyResults '{self.context.plan.name}'"

    def _rows(self) -> list[tuple[str, str]]:
        judged = self.criteria["fitted"]
        rows = [
            ("criteria", f"{sum(verdict.passed for verdict in judged)} of {len(judged)} met"),
            ("calibrated", f"{len(self.calibration.problem.parameters)} parameters"),
            *(("read first", statement.text) for statement in self.contradictions),
            ("energy balance", f"relative residual {self.fitted.results.energy.closure:.1e}"),
        ]
        for sensor, periods in self.fitted.scores.items():
            values = ", ".join(f"{name} {metrics.rmse:.3g}" for name, metrics in periods.items())
            rows.append((sensor, f"RMSE {values}"))
        if self.variants:
            rows.append(("variants", ", ".join(self.variants)))
        return rows
