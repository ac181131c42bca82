"""The commands that run a study or one of its steps."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal

from cyclopts import Parameter

from mascarin._io.numbers import beside_limit, with_interval
from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import AsJson, Outside
from mascarin.commands.options.output import number, print_json, print_table
from mascarin.validation.days import EXTRAPOLATION_RATIO

if TYPE_CHECKING:
    from mascarin.simulation.checks.warning_kinds import RunWarning
    from mascarin.study import Study, StudyResults
    from mascarin.study.file.study_inputs import StudyInputs
    from mascarin.study_document.analysis import ContradictionEntry
    from mascarin.study_document.comparison import CriterionEntry
    from mascarin.study_document.document import StudyDocument
    from mascarin.study_document.estimates import ParameterEntry
    from mascarin.tables.quality import Stretch
    from mascarin.validation.days import DayChoice


_SHOWN: Final = 10


def study(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    figures: bool = True,
    page: Literal["model", "measured", "none"] = "model",
    allow_outside: Outside = False,
    as_json: AsJson = False,
) -> int:
    """Run a whole study: compare, calibrate, validate.

    Five steps: compare the uncalibrated model with the measurements, sensitivity analysis, calibration,
    comparison of the calibrated model, validation on days that were not used. After an interruption the same
    command continues the work and gives the same result. Exits with 1 when the calibrated model misses a
    criterion, or a run is not sound.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of an example study: wall-bench, lgi, twin-house, twin-house-n2.
    out : Path
        Folder for study.json, tables, figures, the report and intermediate results.
    figures : bool
        Write the figures as files, too; the report does not need them.
    page : str
        Page beside the report, model.html, in which the calibrated building runs: model; measured shows the
        measured values of the sensors, too; none writes no page.
    """
    from mascarin.pages.study.data.folder import read_document
    from mascarin.study.results.document.comparison import run_warnings

    opened = _open(file, allow_outside)
    results = opened.run(out, figures=figures, page=page, progress=True)
    if as_json:
        print((out / "study.json").read_text(encoding="utf-8"), end="")
    lines = run_warnings({"nominal": results.nominal, "fitted": results.fitted, **results.variants})
    if results.sensitivity is not None:
        lines += [line.after("sensitivity analysis") for line in results.sensitivity.warnings]
    _print_warnings([*(contradiction.text for contradiction in results.contradictions), *lines])
    content = read_document(out)
    _print_summary(opened, results, content, out)
    sound = all(entry.sound for entry in results.transfer.values())
    return _exit_code(_verdicts(content, "fitted"), lines, sound=sound)


def sensitivity(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    method: Literal["spectral", "rbd-fast", "sobol", "morris"] | None = None,
    allow_outside: Outside = False,
    as_json: AsJson = False,
) -> int:
    """Run the sensitivity analysis of a study.

    Varies every parameter that has a range, on the days of the calibration. After an interruption the same
    command continues the work; the whole study uses its results. Exits with 1 when a run is not sound: a
    balance of it does not close, or a temperature has no cause.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of an example study.
    out : Path
        Folder for sensitivity.json, a table, figures and intermediate results.
    method : str
        Method to use instead of the one in the study; all but spectral need the package SALib.
    """
    from mascarin.study import single_steps

    content = single_steps.sensitivity(_open(file, allow_outside).context, out, method=method)
    _print_warnings(content.warnings)
    code = exit_code(warnings=_of_the_runs(content))
    if as_json:
        print_json(content.to_dict())
        return code
    rows: list[tuple[str | float, ...]] = []
    for output, indices in content.sensitivity.items():
        ranked = sorted(indices.items(), key=lambda item: -(item[1].share or 0.0))
        rows += [
            (output, path, *(round(end or 0.0, 4) for end in (value.share, value.low, value.high)))
            for path, value in ranked[:_SHOWN]
        ]
    print_table(("sensor", "parameter", "S1", "low", "high"), rows)
    return code


def calibrate(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    allow_outside: Outside = False,
    as_json: AsJson = False,
) -> int:
    """Calibrate the parameters of a study.

    The calibration alone, and the errors of the calibrated model on days that were not used. After an
    interruption the same command continues the work; the whole study uses its results. Exits with 1 when the
    calibrated model misses a criterion, or a run is not sound.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of an example study.
    out : Path
        Folder for calibration.json, tables and intermediate results.
    """
    from mascarin.study import single_steps

    content = single_steps.calibration(_open(file, allow_outside).context, out)
    _print_warnings([*_texts(content.contradictions), *content.warnings])
    if as_json:
        print_json(content.to_dict())
    else:
        rows = [
            (
                path,
                "" if estimate.nominal is None else number(estimate.nominal),
                *_with_interval(estimate),
                estimate.unit or "",
            )
            for path, estimate in content.parameters.items()
        ]
        print_table(("parameter", "nominal", "fitted", "low", "high", "unit"), rows)
        print()
        _print_scores(content)
        for note in content.notes:
            print(f"note: {note.text}", file=sys.stderr)
    return _exit_code(_verdicts(content, "fitted"), _of_the_runs(content), sound=_sound(content))


def validate(
    file: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    allow_outside: Outside = False,
    as_json: AsJson = False,
) -> int:
    """Compare the uncalibrated model with measurements.

    Only the first step of a study: nothing is calibrated. A building that extends the calibrated.yaml of
    another study has bands from its posterior; where it extrapolates, a warning says so. Exits with 1 when a
    criterion is missed, or the run is not sound.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of an example study.
    out : Path
        Folder for validation.json, series.csv (measured, predicted, band and residual of each sensor) and
        tables. Default: nothing is written.
    """
    from mascarin.study import single_steps

    content = single_steps.validation(_open(file, allow_outside).context, out).content
    _print_warnings([*_texts(content.contradictions), *content.warnings])
    if as_json:
        print_json(content.to_dict())
    else:
        _print_scores(content.without_repeated_periods())
    return _exit_code(_verdicts(content, "nominal"), _of_the_runs(content), sound=_sound(content))


def _open(file: str, allow_outside: bool) -> Study:
    """Open a study, and say on standard error what is suspicious in its tables and what is left out."""
    from mascarin.building.engine_input import measured_columns
    from mascarin.commands.options.tables import show_columns
    from mascarin.examples import locate
    from mascarin.study import Study

    opened = Study.from_yaml(locate(file), allow_outside=allow_outside)
    for inputs in (opened.context.inputs, *opened.context.inputs.others.values()):
        sensors = {name for entry in inputs.plan.sensors.values() for name in entry.columns}
        show_columns(inputs.climate, inputs.measurements, sensors | set(measured_columns(inputs.building)))
        said = dict.fromkeys((*inputs.climate.provenance, *inputs.measurements.provenance))
        lines = [note for note in said if ": warning: " in note]
        if inputs.quality:
            of_experiment = f" of {inputs.experiment}" if inputs.experiment else ""
            lines.append(f"suspicious periods in the measurements{of_experiment}:")
            lines += [f"  {line}" for line in _suspicious(inputs)]
        if lines:
            print("\n".join(lines), file=sys.stderr)
    return opened


def _suspicious(inputs: StudyInputs) -> Iterator[str]:
    """Suspicious periods in words: one line for those of one column and kind."""
    groups: dict[tuple[str, str, bool], list[Stretch]] = {}
    for stretch in inputs.quality:
        left_out = inputs.leaves_out(stretch)
        groups.setdefault((stretch.channel, stretch.kind, left_out), []).append(stretch)
    for (channel, kind, left_out), stretches in groups.items():
        first, end = stretches[0], "; left out of all comparisons" if left_out else ""
        if len(stretches) == 1:
            yield f"{channel}: {kind} from {first.start:%Y-%m-%d %H:%M}, {first.detail}{end}"
            continue
        last, longest = stretches[-1], max(stretches, key=lambda stretch: stretch.count)
        yield (
            f"{channel}: {kind} {len(stretches)} times from {first.start:%Y-%m-%d %H:%M} to "
            f"{last.end:%Y-%m-%d %H:%M}, {sum(stretch.count for stretch in stretches)} values; the longest "
            f"from {longest.start:%Y-%m-%d %H:%M}, {longest.detail}{end}"
        )


def _with_interval(estimate: ParameterEntry) -> tuple[str, str, str]:
    """Estimate and interval of a parameter, which may not be stated."""
    if estimate.fitted is None:
        return "", "", ""
    shown = with_interval(estimate.fitted, estimate.low, estimate.high)
    return shown if estimate.stated else (shown[0], "not stated", "")


def _texts(contradictions: Sequence[ContradictionEntry]) -> list[str]:
    """What the model or the study contradicts, in sentences."""
    return [contradiction.text for contradiction in contradictions]


def _print_warnings(lines: Sequence[str]) -> None:
    """Warnings of the runs, on standard error."""
    for line in lines:
        print(f"warning: {line}", file=sys.stderr)


def _of_the_runs(content: StudyDocument) -> list[RunWarning]:
    """Warnings with their kind, which says whether a run is sound."""
    from mascarin.simulation.checks.warning_kinds import RunWarning

    return [line for line in content.warnings if isinstance(line, RunWarning)]


def _print_scores(content: StudyDocument) -> None:
    rows = [
        (sensor, period, model, *(_rounded(value) for value in (m.rmse, m.sd, m.bias, m.max_error)))
        for sensor, periods in content.sensors.items()
        for period, scores in periods.items()
        for model, m in scores.models.items()
    ]
    print_table(("sensor", "period", "model", "rmse", "sd", "bias", "max"), rows)
    experiments = [
        (name, sensor, period, model, *(_rounded(value) for value in (m.rmse, m.sd, m.bias, m.max_error)))
        for name, entry in content.transfer.items()
        for sensor, periods in entry.sensors.items()
        for period, both in periods.items()
        for model, m in (("described", both.described), ("calibrated", both.calibrated))
        if m.n
    ]
    if experiments:
        print()
        print_table(("experiment", "sensor", "period", "model", "rmse", "sd", "bias", "max"), experiments)


def _rounded(value: float | None) -> str | float:
    return "" if value is None else round(value, 3)


def _sound(content: StudyDocument) -> bool:
    """Whether all runs are sound, those of other experiments included."""
    return content.sound and all(entry.sound for entry in content.transfer.values())


def _verdicts(content: StudyDocument, model: str) -> list[CriterionEntry]:
    """Criteria of a model, counted as in the report: periods of the same days once."""
    return [c for c in content.without_repeated_periods().criteria if c.model == model]


def _exit_code(
    verdicts: Sequence[CriterionEntry], warnings: Sequence[RunWarning], *, sound: bool = True
) -> int:
    """Print the criteria that are missed; return the exit code."""
    missed = [verdict for verdict in verdicts if not verdict.passed]
    for verdict in missed:
        value, unit = verdict.value, verdict.unit
        measured = "no common values"
        if value is not None and verdict.limit is not None:
            measured = f"{beside_limit(value, verdict.limit, least=3)[0]} {unit.replace('degC', 'K')}"
        where = f"{verdict.sensor}, {verdict.period}"
        print(f"missed: {where}: {verdict.name}; found {measured}", file=sys.stderr)
    if verdicts:
        print(f"criteria met: {len(verdicts) - len(missed)} of {len(verdicts)}", file=sys.stderr)
    return exit_code(warnings=warnings, sound=sound, missed=len(missed))


def day_lines(choice: DayChoice) -> list[str]:
    """Whether the other days are like those of the calibration, and which days would tell most.

    Parameters
    ----------
    choice : DayChoice
        The days compared.

    Returns
    -------
    list of str
        Lines for the terminal; none where no day is proposed.
    """
    if not choice.proposed:
        return []
    far, unused = int(choice.extrapolated.sum()), int((~choice.used).sum())
    verb = "is an extrapolation" if far < 2 else "are extrapolations"
    counted = f"{far or 'none'} of {unused} days that the calibration did not use {verb}"
    if far:
        ratio = f"{EXTRAPOLATION_RATIO:g} times that of the days used"
        counted += f": there the variance of the prediction from the parameters is more than {ratio}"
    named = ", ".join(choice.days[day] for day in choice.proposed)
    return [counted, f"days that would tell most about the parameters, if measured or calibrated on: {named}"]


def _print_summary(opened: Study, results: StudyResults, content: StudyDocument, out: Path) -> None:
    """Print a summary on standard error; what it counts are the entries of the report."""
    shown = content.without_repeated_periods()
    count = len(opened.plan.sensors)
    lines = [f"{opened.plan.name}: {opened.plan.observed}, {count} sensor{'s' * (count != 1)}"]
    lines.append(f"{'sensor':<16}{'period':<16}{'model':<10}{'rmse':>8}{'sd':>8}{'bias':>8}{'max':>8}")
    for run in (results.nominal, results.fitted):
        for sensor, periods in run.scores.items():
            lines += [
                f"{sensor:<16}{period:<16}{run.label:<10}{m.rmse:8.3f}{m.sd:8.3f}{m.bias:8.3f}{m.max_error:8.3f}"
                for period, m in periods.items()
                if period in shown.periods
            ]
    for house in results.transfer.values():
        for sensor, spans in house.sensors.items():
            lines += [
                f"{sensor:<16}{period:<16}{model:<10}{m.rmse:8.3f}{m.sd:8.3f}"
                f"{m.bias:8.3f}{m.max_error:8.3f}  {house.building}"
                for period, both in spans.items()
                for model, m in (("described", both.described), ("calibrated", both.calibrated))
            ]
    lines += [f"{path} is {where}" for path, where in results.calibration.on_bound.items()]
    if shown.aims:
        reached = sum(aim.passed for aim in shown.aims)
        missed = "; the report shows the others" if reached < len(shown.aims) else ""
        lines.append(f"aims reached: {reached} of {len(shown.aims)}{missed}")
    if results.diagnosis.causes:
        lines.append("causes of the remaining error:")
        lines += [f"  {number}. {cause.text}" for number, cause in enumerate(results.diagnosis.causes, 1)]
    lines += day_lines(results.days)
    residual = results.fitted.results.energy.closure
    lines.append(f"relative energy-balance residual {residual:.1e}; {results.seconds:.0f} s")
    lines.append(f"report: {out / 'report.html'}")
    live = content.live
    if live.file:
        lines.append(f"the calibrated building runs in: {out / live.file}")
    elif live.refusal:
        lines.append(f"no page in which the calibrated building runs: {live.refusal}")
    print("\n".join(lines), file=sys.stderr)
