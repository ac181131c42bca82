"""A study: a building compared with measurements, calibrated, and validated on other days."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from mascarin._io import display
from mascarin.errors import InputError
from mascarin.linear_algebra import one_thread
from mascarin.pages import study
from mascarin.pages.study.data.folder import read_folder
from mascarin.study.context.context import StudyContext
from mascarin.study.context.step_cache import NAME, kept
from mascarin.study.context.storage import Workspace
from mascarin.study.diagnosis.step import diagnosis
from mascarin.study.diagnosis.words import summary
from mascarin.study.file import opening
from mascarin.study.file.writing import study_text, write_study
from mascarin.study.results.document.errors import error_words
from mascarin.study.results.files import write_all
from mascarin.study.results.live_page import PageContent, checked
from mascarin.study.results.results import StudyResults
from mascarin.study.single_steps import validation
from mascarin.study.steps.calibration_result import Calibrated, calibrated
from mascarin.study.steps.checking import check
from mascarin.study.steps.days import days
from mascarin.study.steps.derived_quantities import derived_quantities, latent_heat_used
from mascarin.study.steps.model_runs import ModelRuns, judged, nominal
from mascarin.study.steps.prediction_intervals import interval_words, slopes
from mascarin.study.steps.residuals import error_sources, examined, too_few
from mascarin.study.transfer.comparison import transferred
from mascarin.study_document.comparison import TransferEntry
from mascarin.validation.criteria import judge

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.study.carried.validation import Validation
    from mascarin.study.file.description import Periods, SensitivityPlan, Sensor, StudyPlan, Variant
    from mascarin.tables.quality import Stretch
    from mascarin.validation.criteria import Criterion
    from mascarin.weather import Climate, Measurements

#: Arguments that only a study of objects needs.
_OBJECTS = ("building", "climate", "measurements", "sensors", "periods")


class Study:
    """A study of a building: comparison, sensitivity analysis, calibration and validation.

    All inputs are checked when the study is made, before anything is run.

    Parameters
    ----------
    path : str or Path, optional
        A study file, instead of all other arguments; `from_yaml` is the preferred form.
    building : Building
        The building as described.
    climate : Climate
        The weather.
    measurements : Measurements
        The measured columns of the sensors and of measured boundaries.
    sensors : mapping of str to Sensor or mapping
        Name -> ``column`` of the measurements, ``output`` of the model, and uncertainty.
    periods : Periods or mapping
        ``identification`` and perhaps ``warm_up``, ``corroboration``, ``end``: pairs of local times.
    parameters : sequence of str or mapping, optional
        Paths of the parameters to calibrate, or path -> (low, high), or path -> mapping with ``low``,
        ``high``, ``prior``, ``start``, ``scale``. Without any the study cannot be calibrated.
    criteria, aims : sequence of Criterion or mapping
        Required and desired limits on metrics.
    sensitivity : SensitivityPlan, mapping or True, optional
        Options of the sensitivity analysis; True takes the defaults.
    identification : mapping, optional
        Other options of the calibration, such as ``method``, ``starts`` and ``lead``.
    variants : mapping, optional
        Other choices of model: name -> ``changes`` and more.
    alternatives : mapping, optional
        Parts of the model whose form is not known: name -> forms with ``changes``, or path -> list of values.
    allow_outside : bool
        Whether the file may name files outside its folder and the data folder (MASCARIN_DATA).
    **options
        Further keys of a study file: ``name``, ``about``, ``observed``, ``step``, ``scheme``, ``initial``,
        ``quality``, ``reference``.

    Raises
    ------
    InputError
        Something cannot be used.

    Examples
    --------
    >>> from mascarin import Study
    >>> from mascarin.examples import synthetic_wall
    >>> wall = synthetic_wall()
    >>> study = Study(
    ...     building=wall.building,
    ...     climate=wall.climate,
    ...     measurements=wall.measurements,
    ...     sensors={"joint": {"column": "joint", "output": "wall.interface_1_temperature"}},
    ...     periods={"identification": ("2023-03-03", "2023-03-06")},
    ...     parameters={"materials.insulation.conductivity": (0.02, 0.06)},
    ...     step="1h",
    ... )
    >>> study
    Study 'study'
      building        Synthetic wall
      sensors         joint
      parameters      materials.insulation.conductivity
      identification  2023-03-03 00:00 to 2023-03-06 00:00 (UTC+1)
      record          2023-03-01 00:00 to 2023-03-09 23:00
      step            1h
    """

    def __init__(
        self,
        path: str | Path | None = None,
        *,
        building: Building | None = None,
        climate: Climate | None = None,
        measurements: Measurements | None = None,
        sensors: Mapping[str, Sensor | Mapping[str, Any]] | None = None,
        periods: Periods | Mapping[str, Any] | None = None,
        parameters: Sequence[str] | Mapping[str, Any] = (),
        criteria: Sequence[Criterion | Mapping[str, Any]] = (),
        aims: Sequence[Criterion | Mapping[str, Any]] = (),
        sensitivity: SensitivityPlan | Mapping[str, Any] | bool | None = None,
        identification: Mapping[str, Any] | None = None,
        variants: Mapping[str, Variant | Mapping[str, Any]] | None = None,
        alternatives: Mapping[str, Any] | None = None,
        allow_outside: bool = False,
        **options: Any,
    ) -> None:
        given = dict(zip(_OBJECTS, (building, climate, measurements, sensors, periods), strict=True))
        if path is not None:
            unused = [*(key for key, value in given.items() if value is not None), *options]
            if unused:
                raise InputError(
                    f"study: found a file and {', '.join(unused)}, expected one of the two; leave out the "
                    "file, or write these keys into it"
                )
            inputs = opening.from_file(Path(path), allow_outside=allow_outside)
        else:
            if "experiments" in options:
                raise InputError(
                    "study: found experiments in a study of objects, expected them in a study file, which "
                    "names a building and tables for each: write one, and open it with Study.from_yaml"
                )
            plan = {"sensors": sensors, "periods": periods, "criteria": criteria, "aims": aims, **options}
            if parameters or identification:
                plan["identification"] = opening.identified(parameters, identification or {})
            if sensitivity:
                plan["sensitivity"] = {} if sensitivity is True else sensitivity
            if variants:
                plan["variants"] = variants
            if alternatives:
                plan["alternatives"] = alternatives
            if building is None or climate is None or measurements is None:
                missing = [key for key, value in given.items() if value is None]
                raise InputError(
                    f"study: found no {', '.join(missing)}, expected {', '.join(_OBJECTS)}, or the path of a "
                    "study file; add what is missing"
                )
            inputs = opening.from_objects(building, climate, measurements, plan)
        self.context: StudyContext = StudyContext(inputs)
        check(self.context)

    @property
    def plan(self) -> StudyPlan:
        """What the study does."""
        return self.context.plan

    @property
    def building(self) -> Building:
        """The building as described."""
        return self.context.building

    @property
    def climate(self) -> Climate:
        """The weather."""
        return self.context.climate

    @property
    def measurements(self) -> Measurements:
        """The measured columns to compare with, without those values that the study masks."""
        return self.context.measurements

    @property
    def quality(self) -> list[Stretch]:
        """Suspicious values of the measured columns."""
        return self.context.quality

    @classmethod
    def from_yaml(cls, path: str | Path, *, allow_outside: bool = False) -> Self:
        """Read a study file with the files that it names.

        Parameters
        ----------
        path : str or Path
            The study file.
        allow_outside : bool
            Whether it may name files outside its folder and the data folder (MASCARIN_DATA). Allow it for a
            study that you trust.

        Returns
        -------
        Study
            Checked.

        Raises
        ------
        InputError
            Something cannot be used; file, line and entry are named.

        Examples
        --------
        >>> from mascarin import Study
        >>> from mascarin.examples import STUDIES
        >>> Study.from_yaml(STUDIES["lgi"]).building.name
        'LGI cell'
        """
        return cls(path, allow_outside=allow_outside)

    def with_measurements(self, measurements: Measurements) -> Self:
        """Make the same study of other measurements, such as simulated ones.

        Parameters
        ----------
        measurements : Measurements
            With the columns that the sensors name.

        Returns
        -------
        Study
            Checked.

        Raises
        ------
        InputError
            A column is missing.

        Examples
        --------
        >>> from mascarin import Study
        >>> from mascarin.examples import STUDIES
        >>> from mascarin.weather import Measurements
        >>> study = Study.from_yaml(STUDIES["lgi"])
        >>> warmer = study.measurements.data.assign(room_air=lambda table: table["room_air"] + 1.0)
        >>> other = study.with_measurements(Measurements.from_table(warmer))
        >>> float((other.measurements.data - study.measurements.data)["room_air"].iloc[0].round(6))
        1.0
        """
        other = type(self).__new__(type(self))
        other.context = StudyContext(opening.with_measurements(self.context.inputs, measurements))
        check(other.context)
        return other

    def to_yaml(self, path: str | Path | None = None) -> str:
        """Write the study as a file, which `from_yaml` reads.

        Parameters
        ----------
        path : str or Path, optional
            File to write. For a study of objects the building, the weather and the measurements are written
            beside it as ``building.yaml``, ``climate.csv`` and ``measurements.csv``. Default: nothing is
            written.

        Returns
        -------
        str
            The text of the study file.

        Raises
        ------
        InputError
            The weather is a year of a weather file, which a table cannot represent.
        """
        inputs = self.context.inputs
        return study_text(inputs) if path is None else write_study(inputs, Path(path))

    @one_thread()
    def run(
        self,
        out: str | Path | None = None,
        *,
        figures: bool = True,
        page: PageContent = "model",
        progress: ProgressOption = None,
    ) -> StudyResults:
        """Carry out all steps of the study.

        Parameters
        ----------
        out : str or Path, optional
            Folder for study.json, the tables, figures and the report, and for intermediate results: an
            interrupted study continues from them. Default: nothing is kept on disk.
        figures : bool
            Whether the figures are written as files, too. The report does not need them.
        page : str
            The page beside the report in which the calibrated building runs: ``model``; ``measured`` shows
            the measured values of the sensors, too; ``none`` writes no page.
        progress : bool, callable or None
            True shows progress, None only in notebooks; a callable gets the number of units done and their
            total.

        Returns
        -------
        StudyResults
            The results.

        Raises
        ------
        InputError
            The study has no parameters to calibrate, or the folder cannot be used.
        SolverError
            A run failed.
        """
        context = self.context
        _ = context.inputs.calibration_plan
        content = checked(page)
        if out is None:
            with (
                tempfile.TemporaryDirectory() as folder,
                Workspace(Path(folder), context.identity()) as work,
                context.keeping(work),
            ):
                return all_steps(context, work, progress)
        with Workspace(Path(out), context.identity()) as workspace, context.keeping(workspace):
            results = all_steps(context, workspace, progress)
            written = write_all(results, workspace, figures=figures, page=content)
            study.write(workspace.out / "report.html", *read_folder(workspace.out))
            workspace.record("study", written)
            workspace.drop("sensitivity")
            workspace.drop(NAME)
        return results

    def validate(self, out: str | Path | None = None) -> Validation:
        """Compare the building as described with the measurements; nothing is calibrated.

        A building that extends the ``calibrated.yaml`` of another study has a posterior: its bands are made
        with it, and ``remarks`` says where it extrapolates.

        Parameters
        ----------
        out : str or Path, optional
            Folder for validation.json, series.csv and tables. Default: nothing is written.

        Returns
        -------
        Validation
            Metrics, series and bands.

        Raises
        ------
        InputError
            The folder cannot be used.
        SolverError
            The run failed.
        """
        return validation(self.context, None if out is None else Path(out))

    def __repr__(self) -> str:
        return display.text(f"Study '{self.plan.name}'", self._rows())

    def _repr_html_(self) -> str:
        return display.page(f"Study '{self.plan.name}'", self._rows())

    def _rows(self) -> list[tuple[str, str]]:
        periods = self.context.periods
        first, last = periods.identification
        rows = [
            ("building", self.building.name),
            ("sensors", ", ".join(self.plan.sensors)),
            ("identification", f"{first:%Y-%m-%d %H:%M} to {last:%Y-%m-%d %H:%M} ({self.climate.timezone})"),
            ("record", f"{periods.start:%Y-%m-%d %H:%M} to {periods.end:%Y-%m-%d %H:%M}"),
            ("step", self.plan.step),
        ]
        if self.plan.identification is not None:
            rows.insert(2, ("parameters", ", ".join(self.plan.identification.parameters)))
        others = self.context.inputs.others
        if others:
            rows.append(("experiments", ", ".join((self.context.inputs.experiment, *others))))
        if self.plan.variants:
            rows.append(("variants", ", ".join(self.plan.variants)))
        return rows


def all_steps(context: StudyContext, workspace: Workspace, progress: ProgressOption) -> StudyResults:
    """All steps of a study, one after the other.

    Parameters
    ----------
    context : StudyContext
        Of the study.
    workspace : Workspace
        Where results of steps are kept.
    progress : bool, callable or None
        See `mascarin.progress.ProgressOption`.
    """
    began = time.monotonic()
    runs = ModelRuns(context, workspace, progress)
    before = nominal(context)
    sensitivity = None if context.plan.sensitivity is None else runs.sensitivity(context.plan.sensitivity)
    found = calibrated(context, runs)
    fitted, fit, intervals = found.run, found.fit, found.intervals
    variants = runs.variants()
    at = fit.x.tolist()
    residuals = kept(workspace, ("residuals", at), lambda: examined(context, fitted))
    criteria = judged(context, before, fitted)
    aims = judge(context.plan.aims, fitted.scores, where=f"{context.places.file}: aims")
    asked = [*criteria["fitted"], *aims]
    missed = not asked or not all(verdict.passed for verdict in asked)
    sources = None
    if missed:
        sources = kept(workspace, ("sources", at), lambda: error_sources(context, fitted, fit, progress))
    causes = kept(
        workspace,
        ("diagnosis", at),
        lambda: diagnosis(context, fitted, fit, workspace, combination=found.combination, progress=progress),
    )
    slope = slopes(context, fitted, fit)
    joint = None if found.combination is None else found.combination.forms[0].joint
    return StudyResults(
        context=context,
        nominal=before,
        fitted=fitted,
        variants=variants,
        sensitivity=sensitivity,
        calibration=fit,
        criteria=criteria,
        aims=aims,
        residuals=residuals,
        error_sources=sources,
        diagnosis=causes,
        days=kept(workspace, ("days", at), lambda: days(context, fitted, fit, slope, intervals)),
        prediction_intervals=intervals,
        profiles=found.profiles,
        notes=[
            *too_few(context),
            *error_words(context, found.combination),
            *interval_words(context, intervals),
            *summary(causes),
        ],
        quality=context.quality,
        seconds=time.monotonic() - began,
        combination=found.combination,
        contradictions=found.contradictions,
        transfer=_houses(context, workspace, found),
        derived=kept(
            workspace,
            ("derived", at),
            lambda: [
                *derived_quantities(fit, joint),
                *latent_heat_used(fitted.simulation, fitted.results, fit, joint),
            ],
        ),
    )


def _houses(context: StudyContext, workspace: Workspace, found: Calibrated) -> dict[str, TransferEntry]:
    """Other houses, seasons and phases with the estimates, as plain values in the folder."""
    at = ("transfer", found.fit.x.tolist())
    entries = kept(workspace, at, lambda: {k: v.to_dict() for k, v in transferred(context, found).items()})
    return {name: TransferEntry.model_validate(entry) for name, entry in entries.items()}
