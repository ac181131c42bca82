"""The wall of Anglet with days left out: how much of each day the bands contain that were made without it.

``MASCARIN_DATA=... python bench/wall_days.py`` calibrates the shipped study of the wall six times, each time
without one day of its identification, and compares the bands of that day with what was measured on it.
"""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import pandas as pd

from mascarin import Study
from mascarin.examples import STUDIES
from mascarin.linear_algebra import one_thread
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.model_averaging import combined_intervals
from mascarin.study.steps.model_runs import ModelRuns


def without(day: pd.Timestamp, first: pd.Timestamp, end: pd.Timestamp) -> list[list[str]]:
    """Periods of an identification without a day."""
    after = day + pd.Timedelta(days=1)
    periods = [(first, day), (after, end)]
    return [[f"{start:%Y-%m-%d}", f"{stop:%Y-%m-%d}"] for start, stop in periods if start < stop]


@one_thread()
def left_out(path: Path, day: pd.Timestamp) -> tuple[list[float], list[float], list[float]]:
    """Part of the day inside the bands, their mean half-width and the error, by sensor."""
    text = path.read_text()
    first, end = pd.Timestamp("2024-09-05"), pd.Timestamp("2024-09-11")
    old = '["2024-09-05 00:00", "2024-09-11 00:00"]'
    if text.count(old) != 1:
        raise SystemExit(f"{path}: expected the identification {old} once")
    with tempfile.TemporaryDirectory() as folder:
        study_path = Path(folder) / "study.yaml"
        study_path.write_text(text.replace(old, str(without(day, first, end)).replace("'", '"')))
        building = Path(folder) / "building.yaml"
        building.write_text((path.parent / "building.yaml").read_text())
        study = Study.from_yaml(study_path)
        with Workspace(Path(folder) / "work", study.context.identity()) as workspace:
            combination = ModelRuns(study.context, workspace, False).combination()
        bands, observation = combined_intervals(study.context, combination), study.context.observation
    run = combination.forms[0].run
    expected = observation.simulated(run.results.index, run.results.records) + bands.center
    misses = expected - observation.measured
    local = observation.times.tz_localize(None).normalize()
    use = np.asarray(local == day)[:, None] & np.isfinite(misses)
    inside = use & (np.abs(np.where(use, misses, 0.0)) <= bands.half_width)
    share = inside.sum(axis=0) / use.sum(axis=0)
    half = [float(bands.half_width[use[:, s], s].mean()) for s in range(use.shape[1])]
    error = [float(np.sqrt(np.mean(misses[use[:, s], s] ** 2))) for s in range(use.shape[1])]
    return share.tolist(), half, error


def main() -> None:
    """Print a line for each day, and the mean of all."""
    path = Path(STUDIES["wall-bench"])
    rows = []
    for day in pd.date_range("2024-09-05", "2024-09-10"):
        share, half, error = left_out(path, day)
        rows.append((share, half, error))
        print(f"{day:%Y-%m-%d}: inside {np.round(share, 3)}, half-width {np.round(half, 3)} K, "
              f"error {np.round(error, 3)} K", flush=True)  # fmt: skip
    print(f"all: inside, half-width, error {np.round(np.mean(rows, axis=0), 3).tolist()}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
