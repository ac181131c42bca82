"""The command that runs a study."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from mascarin.commands.inputs import AsJson

if TYPE_CHECKING:
    from mascarin.study import Findings, Study


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
    from mascarin.examples import locate
    from mascarin.study import Study

    opened = Study(locate(file))
    findings = opened.run(out)
    _report(out)
    if as_json:
        print((out / "study.json").read_text(encoding="utf-8"), end="")
    _tell(opened, findings, out)
    return 0 if findings.passed else 1


def _report(out: Path) -> None:
    """Make the report from what the study left in its folder."""
    from mascarin.report import write
    from mascarin.report.folder import read_folder

    write(out / "report.html", *read_folder(out))


def _tell(opened: Study, findings: Findings, out: Path) -> None:
    """A summary for the person at the terminal."""
    lines = [f"{opened.file.name}: {opened.file.observed}, {len(opened.file.sensors)} sensors"]
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
    verdicts = findings.verdicts["fitted"]
    if verdicts:
        kept = sum(verdict.passed for verdict in verdicts)
        lines.append(f"criteria kept: {kept} of {len(verdicts)}")
    lines.append(f"energy closure {findings.fitted.results.energy.closure:.1e}; {findings.seconds:.0f} s")
    lines.append(f"report: {out / 'report.html'}")
    print("\n".join(lines), file=sys.stderr)
