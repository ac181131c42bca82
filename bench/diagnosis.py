"""Twelve planted faults, and data without a fault: which cause does the diagnosis of a study name first?

``python bench/diagnosis.py faults [name ...]`` plants faults in the virtual experiment of the LGI cell, one
at a time: in the data (clock, exchanged columns, offset, gain, stuck, filled, noise) or in the study (a fixed
absorptance or conductivity that is wrong, another sky, another outside convection). Each study is calibrated
and diagnosed. Printed are the first cause, and whether it is the planted one. Without names these are the
twelve of ``FAULTS``; those of ``OTHERS`` are named.
``python bench/diagnosis.py clean [first] [count]`` makes data with the model itself, with white noise and
noise with a correlation time of 3 h, by seed, and prints the causes that are named: there should be none.
"""

from __future__ import annotations

import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from mascarin import Study
from mascarin.examples import STUDIES
from mascarin.study.diagnosis_step import diagnosis
from mascarin.study.model_runs import ModelRuns
from mascarin.study.storage import Workspace
from mascarin.validation import Diagnosis
from mascarin.weather import Measurements

Edit = Callable[[pd.DataFrame], None]

SENSORS = ("room_air", "plasterboard_face", "pcm_plasterboard", "pcm_top", "gap_air", "steel_sheet")
DAY = "2010-09-12 10:00"
ROOF = "surfaces.roof.outside"


def clock(column: str, rows: int) -> Edit:
    """The column is late by some rows."""

    def edit(table: pd.DataFrame) -> None:
        table[column] = table[column].shift(rows).bfill()

    return edit


def swap(one: str, other: str) -> Edit:
    """Two columns are exchanged."""

    def edit(table: pd.DataFrame) -> None:
        table[[one, other]] = table[[other, one]].to_numpy()

    return edit


def linear(column: str, gain: float, offset: float) -> Edit:
    """The column has a wrong gain and offset."""

    def edit(table: pd.DataFrame) -> None:
        table[column] = table[column] * gain + offset

    return edit


def stretch(column: str, rows: int, *, line: bool) -> Edit:
    """Some rows repeat a value, or are a straight line."""

    def edit(table: pd.DataFrame) -> None:
        first = table.index.get_loc(pd.Timestamp(DAY, tz=table.index.tz))
        place = table.columns.get_loc(column)
        last = table.iloc[first + rows - 1, place] if line else table.iloc[first, place]
        table.iloc[first : first + rows, place] = np.round(
            np.linspace(table.iloc[first, place], last, rows), 3
        )

    return edit


def noise(columns: tuple[str, ...], sd: float) -> Edit:
    """White noise is added."""

    def edit(table: pd.DataFrame) -> None:
        rng = np.random.default_rng(1)
        for column in columns:
            table[column] = (table[column] + sd * rng.standard_normal(len(table))).round(3)

    return edit


def since(day: str, edit: Edit) -> Edit:
    """A fault from a day on."""

    def later(table: pd.DataFrame) -> None:
        whole = table.copy()
        edit(whole)
        rows = table.index >= pd.Timestamp(day, tz=table.index.tz)
        table.loc[rows] = whole.loc[rows]

    return later


#: name -> (edit of the data, changes of the building, expected kind, expected start of a subject)
FAULTS: dict[str, tuple[Edit | None, Mapping[str, Any], tuple[str, ...], str]] = {
    "clock of the room": (clock("room_air", 4), {}, ("clock",), "room_air"),
    "clock of the sheet": (clock("steel_sheet", 4), {}, ("clock",), "steel"),
    "exchanged columns": (swap("pcm_top", "gap_air"), {}, ("swapped",), "pcm_top"),
    "offset of 1 K": (linear("gap_air", 1.0, 1.0), {}, ("offset",), "gap_air"),
    "gain of 5 %": (linear("pcm_top", 1.05, 0.0), {}, ("gain", "scale"), "pcm_top"),
    "stuck for 12 h": (stretch("gap_air", 48, line=False), {}, ("stuck",), "gap_air"),
    "filled for 6 h": (stretch("pcm_top", 24, line=True), {}, ("interpolated",), "pcm_top"),
    "noise of 0.3 K": (noise(SENSORS, 0.3), {}, ("noise",), "room_air"),
    "absorptance": (None, {f"{ROOF}.absorptance": 0.65}, ("parameter",), f"{ROOF}.absorptance"),
    "conductivity": (
        None, {"materials.plasterboard.conductivity": 0.25}, ("parameter",),
        "materials.plasterboard.conductivity",
    ),
    "sky": (None, {"site.sky": "brunt"}, ("form",), "site.sky"),
    "outside convection": (
        None, {f"{ROOF}.convection": {"kind": "tarp", "roughness": 1.52}}, ("form",), f"{ROOF}.convection",
    ),
}  # fmt: skip


#: Further faults, not among the twelve.
OTHERS: dict[str, tuple[Edit | None, Mapping[str, Any], tuple[str, ...], str]] = {
    "offset from a day on": (since("2010-09-08", linear("gap_air", 1.0, 0.8)), {}, ("offset",), "gap_air"),
    "exchanged from a day on": (since("2010-09-15", swap("pcm_top", "gap_air")), {}, ("swapped",), "pcm_top"),
    "daylight saving": (since("2010-09-19", clock("room_air", 4)), {}, ("clock",), "room_air"),
    "another unit": (linear("room_air", 1.8, 32.0), {}, ("gain", "scale", "offset"), "room_air"),
}


def study_of(table: pd.DataFrame, changes: Mapping[str, Any]) -> Study:
    """The LGI study with other data or another building; what is changed is not calibrated."""
    base = Study.from_yaml(STUDIES["lgi"])
    plan = base.plan.identification
    assert plan is not None
    kept = plan.model_dump(mode="json", exclude_unset=True)
    parameters = {
        path: entry
        for path, entry in kept.pop("parameters").items()
        if not any(path == key or path.startswith(f"{key}.") for key in changes)
    }
    return Study(
        building=base.building.replace(dict(changes)) if changes else base.building,
        climate=base.climate,
        measurements=Measurements.from_table(table),
        sensors={name: one.model_dump(exclude_unset=True) for name, one in base.plan.sensors.items()},
        periods=base.plan.periods,
        parameters=parameters,
        identification=kept,
        criteria=base.plan.criteria,
        aims=base.plan.aims,
        step=base.plan.step,
    )


def diagnosed(study: Study) -> Diagnosis:
    """Calibrate and diagnose; parameters and forms are always tried."""
    with tempfile.TemporaryDirectory() as folder, Workspace(Path(folder), study.inputs()) as workspace:
        run, fit = ModelRuns(study, workspace).fitted()
        return diagnosis(study, run, fit, workspace, missed=True)


def faults(names: list[str]) -> None:
    """Print the first cause of each planted fault."""
    right = 0
    chosen = names or list(FAULTS)
    for name in chosen:
        edit, changes, kinds, subject = (FAULTS | OTHERS)[name]
        table = Study.from_yaml(STUDIES["lgi"]).measurements.data.copy()
        if edit is not None:
            edit(table)
        began = time.monotonic()
        first = diagnosed(study_of(table, changes)).first
        hit = first is not None and first.what in kinds and any(s.startswith(subject) for s in first.subject)
        right += hit
        said = "nothing" if first is None else first.text
        print_line(f"{'right' if hit else 'WRONG'} | {name} | {time.monotonic() - began:.0f} s | {said}")
    print_line(f"first cause right: {right} of {len(chosen)}")


def clean_table(seed: int) -> pd.DataFrame:
    """Data of the model as described: white noise of 0.08 K, and 0.1 K with a correlation time of 3 h."""
    base = Study.from_yaml(STUDIES["lgi"])
    table = base.measurements.data.copy()
    results = base.simulation.run()
    rng = np.random.default_rng(seed)
    keep = np.exp(-base.measurements.step_seconds / 10800.0)
    for k, sensor in enumerate(base.plan.sensors.values()):
        series = base.observation.sampled(results.index, results.records[:, k])
        slow = np.zeros(series.size)
        drawn = rng.standard_normal((2, series.size))
        slow[0] = 0.1 * drawn[0, 0]
        for t in range(1, series.size):
            slow[t] = keep * slow[t - 1] + 0.1 * np.sqrt(1.0 - keep**2) * drawn[0, t]
        values = pd.Series(series + slow + 0.08 * drawn[1], index=base.observation.times)
        there = table.index.intersection(values.index)
        table.loc[there, sensor.columns[0]] = values.loc[there].round(3)
    return table


def clean(first: int, count: int) -> None:
    """Print the causes that are named in data without a fault."""
    silent = 0
    for seed in range(first, first + count):
        found = diagnosed(study_of(clean_table(seed), {}))
        silent += not found.causes
        said = "; ".join(cause.text for cause in found.causes) or "nothing"
        print_line(f"seed {seed} | {said}")
    print_line(f"no cause named: {silent} of {count}")


def print_line(text: str) -> None:
    """Print at once, so that a run that is stopped has shown what it did."""
    print(text, flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    kind, *rest = sys.argv[1:] or [""]
    if kind == "faults":
        faults(rest)
    elif kind == "clean":
        clean(int(rest[0]) if rest else 0, int(rest[1]) if len(rest) > 1 else 20)
    else:
        print_line(__doc__ or "")
