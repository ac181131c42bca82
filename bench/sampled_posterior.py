"""Sampled posteriors beside linearized ones: intervals of 95 %, R-hat, effective sizes and processor time.

``python bench/sampled_posterior.py wall`` makes the wall of ``tests/support/study_support.py`` with offsets
of 0.1 K of its two sensors. ``python bench/sampled_posterior.py FOLDER`` calibrates FOLDER/study.yaml, which
has no ``posterior`` of its own, without its ``alternatives``; FlexHouse needs its table first:
``python bench/sampled_posterior.py flexhouse HOUSES FOLDER`` makes FOLDER from ``HOUSES/flexhouse_PRBS1.csv``
and ``HOUSES/flexhouse``.
"""

from __future__ import annotations

import re
import sys
import tempfile
import time
import warnings
from pathlib import Path

import pandas as pd

from mascarin import Study
from mascarin.calibration import Calibration
from mascarin.linear_algebra import one_thread
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.model_runs import ModelRuns

TESTS = Path(__file__).resolve().parent.parent / "tests"


def wall(folder: Path) -> None:
    """Write the wall whose truths are known."""
    sys.path.insert(0, str(TESTS / "support"))
    import study_support

    (folder / "building.yaml").write_text(study_support.BUILDING)
    study_support.logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    (folder / "study.yaml").write_text(study_support.STUDY.replace("offset: 0,", "offset: 0.1,"))


def flexhouse(houses: Path, folder: Path) -> None:
    """Write the study of FlexHouse with its table: stamps in whole minutes, heat and sun in watts."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("building.yaml", "study.yaml"):
        (folder / name).write_text((houses / "flexhouse" / name).read_text())
    table = pd.read_csv(houses / "flexhouse_PRBS1.csv")
    start = pd.to_datetime(table.TimeDate).dt.floor("min") - pd.Timedelta("1min")
    columns = {"Ta": table.Ta, "sun": 1000.0 * table.Ps.clip(lower=0.0), "heat": 1000.0 * table.Ph}
    columns["yTi"] = table.yTi
    pd.DataFrame({"time": start.dt.strftime("%Y-%m-%d %H:%M"), **columns}).to_csv(
        folder / "data.csv", index=False
    )


@one_thread()
def calibrated(path: Path, posterior: str) -> tuple[Calibration, float]:
    """Calibration of a study with a kind of posterior, and its processor time. [s]"""
    text = re.sub(r"(?m)^alternatives:\n(?:[ \n#].*\n?|\n)*", "", path.read_text())
    if text.count("identification:\n  ") != 1 or "posterior:" in text:
        raise SystemExit(f"{path}: expected one block identification, without posterior")
    start = time.process_time()
    study_path = path.parent / f"{posterior}.yaml"
    study_path.write_text(
        text.replace("identification:\n  ", f"identification:\n  posterior: {posterior}\n  ")
    )
    study = Study.from_yaml(study_path)
    with (
        tempfile.TemporaryDirectory() as work,
        Workspace(Path(work), study.context.identity()) as workspace,
    ):
        combination = ModelRuns(study.context, workspace, False).combination()
    return combination.forms[0].fit, time.process_time() - start


def compare(path: Path) -> None:
    """Print both posteriors of a study."""
    linearized, seconds = calibrated(path, "linearized")
    fit, sampled_seconds = calibrated(path, "sampled")
    chains = fit.posterior
    if chains is None:
        raise SystemExit(f"{path}: expected a sampled posterior")
    reduction, bulk, tail = chains.convergence.T
    for k, name in enumerate(chains.names):
        print(f"{name}: R-hat {reduction[k]:.4f}, sizes {bulk[k]:.0f} {tail[k]:.0f}", end="")
        if k < linearized.low.size:
            print(f"; linearized {linearized.low[k]:.4g} to {linearized.high[k]:.4g}, "
                  f"sampled {fit.low[k]:.4g} to {fit.high[k]:.4g}", end="")  # fmt: skip
        print()
    print(f"accepted {chains.accepted:.2f}, diverged {chains.diverged}; "
          f"{seconds:.1f} s linearized, {sampled_seconds:.1f} s sampled")  # fmt: skip
    print(*chains.warnings, sep="\n")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    if sys.argv[1] == "wall":
        with tempfile.TemporaryDirectory() as folder:
            wall(Path(folder))
            compare(Path(folder) / "study.yaml")
    elif sys.argv[1] == "flexhouse":
        flexhouse(Path(sys.argv[2]), Path(sys.argv[3]))
        compare(Path(sys.argv[3]) / "study.yaml")
    else:
        compare(Path(sys.argv[1]) / "study.yaml")
