"""The commands that run a study, or one step of it."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from cyclopts import Parameter

from mascarin.commands.inputs import AsJson
from mascarin.commands.output import print_json, print_table

if TYPE_CHECKING:
    from mascarin.study import Study, StudyResults


_SHOWN: Final = 10
_METRICS: Final = ("rmse", "sd", "bias", "max_error")


def study(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    as_json: AsJson = False,
) -> int:
    """Compare, identify and corroborate on measurements.

    The five steps: compare, find what matters, identify, compare again, corroborate. Survives interruption:
    started again with the same folder it goes on where it was, and ends with the same result. Exits with 1
    when the fitted model misses a criterion.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of a study that comes with Mascarin: wall-bench, lgi.
    out : Path
        Folder for study.json, tables, figures, the report, and unfinished work.
    """
    opened = _open(file)
    findings = opened.run(out, progress=True)
    if as_json:
        print((out / "study.json").read_text(encoding="utf-8"), end="")
    _tell(opened, findings, out)
    return _judge([verdict.to_dict() for verdict in findings.criteria["fitted"]])


def sensitivity(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    method: Literal["spectral", "rbd-fast", "sobol", "morris"] | None = None,
    as_json: AsJson = False,
) -> None:
    """Find which parameters of a study matter.

    Over every parameter that has a range, on the days of the identification. Survives interruption as the
    whole study does, which goes on from what is done here.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of a study that comes with Mascarin.
    out : Path
        Folder for sensitivity.json, a table, figures, and unfinished work.
    method : str
        In the place of the study's; all but spectral need the package SALib.
    """
    from mascarin.study import steps

    content = steps.sensitivity(_open(file), out, method=method)
    if as_json:
        print_json(content)
        return
    rows: list[tuple[str | float, ...]] = []
    for output, found in content["sensitivity"].items():
        ranked = sorted(found.items(), key=lambda item: -(item[1]["share"] or 0.0))
        rows += [
            (output, path, *(round(value[key] or 0.0, 4) for key in ("share", "low", "high")))
            for path, value in ranked[:_SHOWN]
        ]
    print_table(("sensor", "parameter", "share", "low", "high"), rows)


def calibrate(
    file: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    as_json: AsJson = False,
) -> int:
    """Identify the parameters of a study.

    The identification alone, and how close the fitted model is on the days it has not seen. Survives
    interruption as the whole study does, which goes on from what is done here. Exits with 1 when the fitted
    model misses a criterion.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of a study that comes with Mascarin.
    out : Path
        Folder for calibration.json, tables, and unfinished work.
    """
    from mascarin.study import steps

    content = steps.calibration(_open(file), out)
    if as_json:
        print_json(content)
    else:
        keys = ("nominal", "fitted", "low", "high", "unit")
        rows = [
            (path, *("" if found[key] is None else found[key] for key in keys))
            for path, found in content["parameters"].items()
        ]
        print_table(("parameter", *keys), rows)
        print()
        _print_scores(content)
        for note in content["notes"]:
            print(f"note: {note['text']}", file=sys.stderr)
    return _judge(_verdicts(content, "fitted"))


def validate(
    file: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    as_json: AsJson = False,
) -> int:
    """Hold a building as described against measurements.

    Only the comparison of a study: nothing is identified. Exits with 1 when a criterion is missed.

    Parameters
    ----------
    file : str
        Study file (YAML), or the name of a study that comes with Mascarin.
    out : Path
        Folder for validation.json and tables. Default: nothing is written.
    """
    from mascarin.study import steps

    content = steps.validation(_open(file), out)
    if as_json:
        print_json(content)
    else:
        _print_scores(content)
    return _judge(_verdicts(content, "nominal"))


def _open(file: str) -> Study:
    from mascarin.examples import locate
    from mascarin.study import Study

    return Study.from_yaml(locate(file))


def _print_scores(content: Mapping[str, Any]) -> None:
    rows = [
        (sensor, period, model, *(_rounded(found[model][metric]) for metric in _METRICS))
        for sensor, periods in content["sensors"].items()
        for period, found in periods.items()
        for model in content["models"]
    ]
    print_table(("sensor", "period", "model", "rmse", "sd", "bias", "max"), rows)


def _rounded(value: float | None) -> str | float:
    return "" if value is None else round(value, 3)


def _verdicts(content: Mapping[str, Any], model: str) -> list[Mapping[str, Any]]:
    return [verdict for verdict in content["criteria"] if verdict["model"] == model]


def _judge(verdicts: Sequence[Mapping[str, Any]]) -> int:
    """Name the criteria that are missed; the exit code."""
    missed = [verdict for verdict in verdicts if not verdict["passed"]]
    for verdict in missed:
        value, unit = verdict["value"], verdict["unit"]
        found = "nothing to compare" if value is None else f"{value:.3f} {unit.replace('degC', 'K')}"
        where = f"{verdict['sensor']}, {verdict['period']}"
        print(f"missed: {where}: {verdict['name']}; found {found}", file=sys.stderr)
    if verdicts:
        print(f"criteria kept: {len(verdicts) - len(missed)} of {len(verdicts)}", file=sys.stderr)
    return 1 if missed else 0


def _tell(opened: Study, findings: StudyResults, out: Path) -> None:
    """A summary for the person at the terminal."""
    count = len(opened.file.sensors)
    lines = [f"{opened.file.name}: {opened.file.observed}, {count} sensor{'s' * (count != 1)}"]
    if opened.quality:
        lines.append("suspicious stretches:")
        lines += [
            f"  {s.channel}: {s.kind} from {s.start:%Y-%m-%d %H:%M}, {s.detail}" for s in opened.quality
        ]
    lines.append(f"{'sensor':<16}{'period':<16}{'model':<10}{'rmse':>8}{'sd':>8}{'bias':>8}{'max':>8}")
    for run in (findings.nominal, findings.fitted):
        for sensor, periods in run.scores.items():
            lines += [
                f"{sensor:<16}{period:<16}{run.label:<10}{m.rmse:8.3f}{m.sd:8.3f}{m.bias:8.3f}{m.max_error:8.3f}"
                for period, m in periods.items()
            ]
    if findings.aims:
        reached = sum(aim.passed for aim in findings.aims)
        lines.append(f"aims reached: {reached} of {len(findings.aims)}; the report says what the rest lacks")
    lines.append(f"energy closure {findings.fitted.results.energy.closure:.1e}; {findings.seconds:.0f} s")
    lines.append(f"report: {out / 'report.html'}")
    print("\n".join(lines), file=sys.stderr)
