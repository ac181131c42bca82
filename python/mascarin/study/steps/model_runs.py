"""The models of a study: the building as described, calibrated, and its variants."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.sealed import own_files
from mascarin.calibration import profiles
from mascarin.calibration.base.evaluations import ForeignRecordError
from mascarin.calibration.base.joined_problem import of_experiment, shares_of
from mascarin.progress import Progress, reporting
from mascarin.simulation.nominal import of_nominal
from mascarin.simulation.run_warnings import of_base
from mascarin.study.context.calibration import identify
from mascarin.study.context.forms import label
from mascarin.study.context.step_cache import kept
from mascarin.study.file.factors import factors
from mascarin.study.steps.error_model import with_errors
from mascarin.study.steps.findings import Combination, FormFit, ModelRun
from mascarin.study.steps.sensitivity import analyze
from mascarin.validation.criteria import judge

if TYPE_CHECKING:
    from mascarin.calibration import Calibration, CalibrationProblem, Profile
    from mascarin.calibration.base.joined_problem import Share
    from mascarin.progress import ProgressOption, Report
    from mascarin.sensitivity import Sensitivity
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.forms import Choice
    from mascarin.study.context.storage import Workspace
    from mascarin.study.file.description import SensitivityPlan, Variant
    from mascarin.validation.criteria import Verdict


#: Tolerance of the search of a form of the model, whose estimates are made better with its errors.
_TOLERANCE: Final = 1e-3


class ModelRuns:
    """Runs and calibrations of the models of a study; each is done once.

    Parameters
    ----------
    setup : StudyContext
        The study.
    workspace : Workspace
        Folder of the intermediate results.
    progress : bool, callable or None
        Where progress is shown.
    """

    def __init__(self, setup: StudyContext, workspace: Workspace, progress: ProgressOption = None) -> None:
        self._setup = setup
        self._workspace = workspace
        self._progress = progress
        self._fits: dict[str | None, Calibration] = {}
        self._calibrated: dict[str | None, tuple[ModelRun, Calibration]] = {}

    def sensitivity(self, plan: SensitivityPlan) -> Sensitivity:
        """The sensitivity analysis in the identification period.

        Parameters
        ----------
        plan : SensitivityPlan
            What is varied, and how often.
        """
        setup, key = self._setup, ("analysis", plan.model_dump_json())
        with reporting(self._progress, "sensitivity analysis") as report:

            def make() -> Sensitivity:
                simulation, lead = setup.models.for_sensitivity()
                chosen = factors(setup.building, plan)
                names = setup.observation.names
                analysis = analyze(simulation, plan, chosen, lead, names, self._workspace, report)
                return replace(analysis, warnings=(*analysis.warnings, *of_base(of_nominal(simulation))))

            return kept(setup.workspace, key, make)

    def fitted(self) -> tuple[ModelRun, Calibration]:
        """The calibrated model and its calibration.

        If the study names candidates, the one with the lowest cost in the identification period is taken.
        """
        runs = {name: self.candidate(name) for name in self._setup.inputs.candidates}
        chosen = min(runs, key=lambda name: runs[name][1].cost)
        run, fit = runs[chosen]
        note = "after the calibration; its parameters are the same on all other days"
        if len(runs) > 1:
            what = "the building as described" if chosen is None else f"'{chosen}'"
            note += f"; of {len(runs)} candidates {what} has the lowest cost in the identification period"
        return replace(run, label="fitted", note=note), fit

    def profiled(self, fit: Calibration) -> list[Profile]:
        """Profile likelihoods, if the study asks for them."""
        if not self._setup.inputs.calibration_plan.profiles:
            return []
        with reporting(self._progress, "profile likelihoods") as report:
            found = profiles(fit)
            report(len(found), len(found))
        return found

    def candidate(self, name: str | None) -> tuple[ModelRun, Calibration]:
        """A calibrated variant, or the calibrated building as described for None."""
        if name not in self._calibrated:
            note = "the building as described" if name is None else self._note(name)
            label = "as described" if name is None else name
            self._calibrated[name] = self._identified(label, name, note)
        return self._calibrated[name]

    def variants(self) -> dict[str, ModelRun]:
        """Other choices of model; also the building as described, if a candidate has a lower cost."""
        found, candidates = {}, self._setup.inputs.candidates
        if len(candidates) > 1:
            base, fit = self.candidate(None)
            if any(self.candidate(name)[1].cost < fit.cost for name in candidates[1:]):
                found[base.label] = base
        for name, variant in self._setup.plan.variants.items():
            found[name] = self._variant(name, variant)
        return found

    def _note(self, name: str) -> str:
        variant = self._setup.plan.variants[name]
        return variant.note or ", ".join(f"{path}: {value}" for path, value in variant.changes.items())

    def combination(self) -> Combination:
        """All forms of the model, each calibrated together with the errors of sensors and model.

        Of many alternatives those that differ in one part are calibrated first, then those that differ in
        one part from the best form of every part.
        """
        forms = self._setup.variants.forms
        found = {choice: self._form(choice) for choice in forms.combinations()}
        density = {choice: float(form.joint.by_day.sum()) for choice, form in found.items()}
        best = {
            part: max((None, *known), key=lambda form: density.get(forms.of({part: form}), -np.inf))
            for part, known in forms.parts.items()
        }
        center = forms.of(best)
        if center not in found:
            found |= {
                choice: self._form(choice)
                for choice in (center, *forms.beside(center))
                if choice not in found
            }
        return Combination.of(list(found.values()))

    def _form(self, choice: Choice) -> FormFit:
        """One form of the model, its search started at the estimates of the building as described."""
        setup, name = self._setup, self._setup.variants.variant_of(choice)
        first = None if name is None else self._plain(None)
        plain = self._plain(name, first, roughly=True)
        with reporting(self._progress, f"errors of sensors and model ({label(choice)})"):
            # The problem holds the model, and the trace all evaluations: both are there already.
            key = ("form", label(choice), plain.x.tolist(), plain.cost)
            known = (plain.problem, plain.trace, plain.nominal_building)
            fit, joints, unknown = kept(setup.workspace, key, lambda: with_errors(setup, name, plain), known)
        note = "the building as described" if name is None else label(choice)
        experiments = setup.experiments.items()
        own = {}
        for (each, context), share, joint, told in zip(
            experiments, shares_of(fit.problem), joints, unknown, strict=True
        ):
            run, fit_of_it = _of_experiment(context, fit, share, name, label(choice), note)
            own[each] = FormFit(choice, run, fit_of_it, joint.of_parameters(share.columns), told)
        return replace(own[setup.inputs.experiment], together={n: own[n] for n in setup.together})

    def _identified(self, label: str, variant: str | None, note: str) -> tuple[ModelRun, Calibration]:
        fit = self._plain(variant, self._beside(variant))
        return _of_experiment(self._setup, fit, shares_of(fit.problem)[0], variant, label, note)

    def _beside(self, variant: str | None) -> Calibration | None:
        """The calibration of the building as described, where a variant has the same parameters."""
        beside = variant is not None and not self._setup.plan.variants[variant].alone
        return self._fits.get(None) if beside else None

    def together(self) -> dict[str, tuple[ModelRun, Calibration]]:
        """The calibrated building in the other experiments, without errors of sensors and model."""
        fit, setup, note = self._plain(None), self._setup, "after the calibration of all experiments"
        shares = shares_of(fit.problem)[1:]
        return {
            name: _of_experiment(context, fit, share, None, "fitted", note)
            for (name, context), share in zip(setup.together.items(), shares, strict=True)
        }

    def plain(self) -> Calibration:
        """The calibration of the building as described, without errors of sensors and model."""
        return self._plain(None)

    def _plain(
        self, variant: str | None, first: Calibration | None = None, *, roughly: bool = False
    ) -> Calibration:
        """A calibration, its search started at the estimates of another one if there is one.

        `roughly`: one search with the tolerance of a form, whose estimates are made better with its errors.
        """
        if variant in self._fits:
            return self._fits[variant]
        setup, label = self._setup, "as described" if variant is None else variant
        stated, plan, tolerance = setup.problem(variant), setup.inputs.calibration_plan, None
        if first is not None:
            stated = _starting(stated, first)
            if roughly:
                plan, tolerance = plan.model_copy(update={"starts": 1}), _TOLERANCE
        simulation = setup.models.for_calibration(variant)
        with reporting(self._progress, f"calibration ({label})") as report:
            record = self._workspace.path(f"evaluations-{_safe(label)}.jsonl")

            def search() -> Calibration:
                return identify(
                    simulation, stated, plan, record=record, progress=_searching(report), tolerance=tolerance
                )

            def make() -> Calibration:
                try:
                    return search()
                except ForeignRecordError:
                    # The folder is our own: what is in the place of the record came from somewhere else.
                    warnings.warn(
                        f"{record}: found something else than the record of this calibration; it is removed, "
                        "and everything in it is computed again",
                        stacklevel=2,
                    )
                    own_files.remove(record)
                    return search()

            # The record has the evaluations; the search through them and the intervals take seconds as well.
            what = (stated.fingerprint(), stated.parameters, plan.model_dump_json(), tolerance)
            key = ("calibration", label, *what)
            self._fits[variant] = kept(setup.workspace, key, make, (stated, simulation.building))
        return self._fits[variant]

    def _variant(self, name: str, variant: Variant) -> ModelRun:
        if variant.identify:
            return self.candidate(name)[0]
        simulation = self._setup.models.over_record(name)
        return compared(self._setup, name, simulation, simulation.values, None, self._note(name))


def _of_experiment(
    context: StudyContext, fit: Calibration, share: Share, variant: str | None, label: str, note: str
) -> tuple[ModelRun, Calibration]:
    """The run of an experiment with the estimates of all, and the calibration as it has it."""
    whole = context.models.over_record(variant)
    own = of_experiment(fit, share, context.variants.building_of(variant))
    return compared(context, label, whole, whole.vector(own.values), own, note), own


def _starting(problem: CalibrationProblem, first: Calibration) -> CalibrationProblem:
    """The same problem, its search started at the estimates of another one for the same parameters."""
    known = first.values
    parameters = tuple(
        replace(p, start=min(max(known[p.path], p.lower), p.upper)) if p.path in known else p
        for p in problem.parameters
    )
    return replace(problem, parameters=parameters)


def nominal(setup: StudyContext) -> ModelRun:
    """The model as described, over the whole record."""
    return compared(setup, "nominal", setup.models.nominal, setup.models.nominal.values, None, "as described")


def compared(
    setup: StudyContext, label: str, simulation: Simulation, values: Any, fit: Calibration | None, note: str
) -> ModelRun:
    """Run a model over the whole record and compare it with the measurements."""
    results = simulation.run_vector(values)
    return ModelRun(label, simulation, results, setup.scores(results), fit, note)


def judged(setup: StudyContext, *runs: ModelRun) -> dict[str, list[Verdict]]:
    """The criteria, model by model."""
    where = f"{setup.places.file}: criteria"
    return {run.label: judge(setup.plan.criteria, run.scores, where=where) for run in runs}


def _searching(report: Report) -> Callable[[int, float], object]:
    """Progress of a search, whose number of evaluations is not known before."""
    shown: object = report
    progress = shown if isinstance(shown, Progress) else None

    def searching(done: int, lowest: float) -> None:
        if progress is None:
            report(done, 0)
        else:
            progress.update(done, 0, f"{done} evaluations, lowest cost {lowest:.6g}")

    return searching


def _safe(name: str) -> str:
    """A short file name that differs for different labels."""
    return hashlib.sha256(name.encode()).hexdigest()[:12]
