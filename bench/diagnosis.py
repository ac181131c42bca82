"""Which cause does the diagnosis of a study name first? Experiments without a fault, and with a planted one.

``python bench/diagnosis.py vsim FOLDER PROGRAM [first] [count] [fault ...]`` takes experiments of an
independent program (a folder with ``experiment.py`` and ``vsim.c``, compiled in FOLDER): the LGI cell with
other laws, another mesh and drawn truths. Even seeds have laws that the study names, odd ones do not. Each
experiment is diagnosed as it is (``clean``), and with one fault planted in its table: five stated standard
uncertainties and more. Without names of faults all of ``PLANTED`` are taken in turn, one for each seed. Every
result is a file of FOLDER and is not computed again; the table of all results is printed at the end.

The form of the model is the one that the study with its alternatives uses on the experiment as it is: of a
file of ``bench/coverage_foreign.py`` in FOLDER, or found in the same way (a minute or two), once for each
seed. Estimates are those of a study: parameters together with errors of sensors and model.

``python bench/diagnosis.py arrays [count]`` draws records of three sensors from a known covariance of errors,
estimates the covariance again from each, and counts how often a cause is named.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from mascarin import Study
from mascarin.examples import STUDIES
from mascarin.study.context.storage import Workspace
from mascarin.study.diagnosis.step import diagnosis
from mascarin.study.steps.model_runs import ModelRuns
from mascarin.weather import Climate, Measurements

Edit = Callable[[pd.DataFrame], None]

ZONE = "UTC+4"
#: Stated standard uncertainty of the offset of a sensor in the study. [K]
OFFSET = 0.15
WEATHER = {
    "air_temperature": "outdoor_air",
    "relative_humidity": "relative_humidity",
    "wind_speed": "wind_speed",
    "wind_direction": "wind_direction",
    "pressure": "pressure",
    "global_horizontal": "global_horizontal",
    "diffuse_horizontal": "diffuse_horizontal",
}
PERIODS = {
    "warm_up": ["2023-06-01T00:00", "2023-06-04T00:00"],
    "identification": ["2023-06-14T00:00", "2023-06-19T00:00"],
}
#: The roof of the other program is flat.
BUILDING = {
    "site.timezone": ZONE,
    "surfaces.roof.outside.area_factor": 1.0,
    "surfaces.roof.inside.area_factor": 1.0,
}
LAST = "07-05"
MIDDLE = "2023-06-22"


def _linear(column: str, gain: float, offset: float, since: str | None = None) -> Edit:
    def edit(table: pd.DataFrame) -> None:
        rows = slice(since, None)
        table.loc[rows, column] = table.loc[rows, column] * gain + offset

    return edit


def _drift(column: str, size: float) -> Edit:
    def edit(table: pd.DataFrame) -> None:
        table[column] += size * np.linspace(-0.5, 0.5, len(table))

    return edit


def _late(column: str, rows: int) -> Edit:
    def edit(table: pd.DataFrame) -> None:
        table[column] = table[column].shift(rows).bfill()

    return edit


def _swap(one: str, other: str) -> Edit:
    def edit(table: pd.DataFrame) -> None:
        table[[one, other]] = table[[other, one]].to_numpy()

    return edit


#: name -> (edit of the table, kinds that are right, a sensor or input that is named)
PLANTED: dict[str, tuple[Edit, tuple[str, ...], str]] = {
    "offset": (_linear("gap_air", 1.0, 8.0 * OFFSET), ("offset",), "gap_air"),
    "gain": (_linear("pcm_top", 1.06, 0.0), ("gain", "scale", "offset"), "pcm_top"),
    "drift": (_drift("room_air", 8.0 * OFFSET), ("drift",), "room_air"),
    "step": (_linear("pcm_plasterboard", 1.0, 5.0 * OFFSET, MIDDLE), ("step",), "interface"),
    "clock": (_late("plasterboard_face", 4), ("clock",), "plasterboard"),
    "swap": (_swap("pcm_top", "gap_air"), ("swapped",), "pcm_top"),
    "pyranometer": (_linear("global_horizontal", 0.94, 0.0), ("gain",), "solar radiation"),
}


def experiment(folder: Path, program: Path, seed: int) -> pd.DataFrame:
    """The table of an experiment, made once."""
    table = folder / f"exp{seed}.csv"
    if not table.exists():
        for source in program.iterdir():
            if not (folder / source.name).exists():
                shutil.copy(source, folder / source.name)
        if not (folder / "vsim").exists():
            command = [shutil.which("gcc") or "cc", "-O2", "-o", "vsim", "vsim.c", "-lm"]
            subprocess.run(command, cwd=folder, check=True)  # noqa: S603
        script = (folder / "experiment.py").read_text()
        weather = (program / ".." / ".." / "data" / "weather").resolve()
        lines = [f'W="{weather}/"' if line.startswith("W=") else line for line in script.splitlines()]
        (folder / "run_experiment.py").write_text("\n".join(lines) + "\n")
        named = ["--named"] if seed % 2 == 0 else []
        command = [sys.executable, "run_experiment.py", str(seed), *named, "--last", LAST]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)  # noqa: S603
    return pd.read_csv(table, index_col="time", parse_dates=True)


def form_of(folder: Path, program: Path, seed: int) -> dict[str, str]:
    """The form that a study with alternatives uses: part of the model -> name of the alternative."""
    from coverage_foreign import calibrated
    from coverage_foreign import study_of as with_alternatives

    known, path = folder / f"coverage-5-{seed}.json", folder / f"form-{seed}.json"
    if known.exists():
        return dict(json.loads(known.read_text())["form"])
    if not path.exists():
        _, _, form = calibrated(with_alternatives(folder, program, seed, 5, true_form=False))
        path.write_text(json.dumps(form))
    return dict(json.loads(path.read_text()))


def study_of(table: pd.DataFrame, form: dict[str, str]) -> Study:
    """The LGI study with other data, one form and no variants."""
    base = Study.from_yaml(STUDIES["lgi"])
    plan = base.plan.identification
    assert plan is not None
    kept = plan.model_dump(mode="json", exclude_unset=True)
    table, building = table.tz_localize("Etc/GMT-4"), base.building.replace(BUILDING)
    for part, name in form.items():
        changes = base.plan.alternatives[part][name].model_dump(mode="json", exclude_unset=True)["changes"]
        building = building.replace(changes)
    return Study(
        building=building,
        climate=Climate.from_table(table, columns=WEATHER),
        measurements=Measurements.from_table(table),
        sensors={name: one.model_dump(exclude_unset=True) for name, one in base.plan.sensors.items()},
        periods=PERIODS,
        parameters=kept.pop("parameters"),
        identification=kept,
        step="15min",
    )


def judged(table: pd.DataFrame, form: dict[str, str]) -> dict[str, Any]:
    """Calibrate and diagnose."""
    began = time.process_time()
    study = study_of(table, form)
    with (
        tempfile.TemporaryDirectory() as folder,
        Workspace(Path(folder), study.context.identity()) as workspace,
    ):
        combination = ModelRuns(study.context, workspace).combination()
        used = combination.forms[0]
        result = diagnosis(study.context, used.run, used.fit, workspace, combination=combination)
    return {**result.to_dict(), "processor_seconds": time.process_time() - began}


def tested(content: dict[str, Any]) -> list[dict[str, Any]]:
    """Causes that were tested against simulated records; findings of the table alone are none."""
    return [cause for cause in content["causes"] if cause["p"] is not None]


def vsim(folder: Path, program: Path, first: int, count: int, names: list[str]) -> None:
    """Diagnose experiments, each without a fault and with one."""
    folder.mkdir(parents=True, exist_ok=True)
    kinds = list(PLANTED)
    for seed in range(first, first + count):
        for name in ["clean", *(names or [kinds[seed % len(kinds)]])]:
            path = folder / f"diagnosis-{seed}-{name}.json"
            if path.exists():
                continue
            table = experiment(folder, program, seed)
            if name != "clean":
                PLANTED[name][0](table)
            path.write_text(json.dumps(judged(table, form_of(folder, program, seed)), indent=1))
            show(seed, name, json.loads(path.read_text()))
    summary(folder)


def show(seed: int, name: str, content: dict[str, Any]) -> None:
    """Print what was found."""
    causes = tested(content)
    said = causes[0]["text"] if causes else "nothing"
    print(f"{seed} {name} | p {content['p']:.3g} | {content['processor_seconds']:.0f} s | {said}", flush=True)


def summary(folder: Path) -> None:
    """Print the rates over all results in a folder, with their intervals, and those of each kind."""
    clean, planted, silent, of_kind = [], [], 0, {name: [] for name in PLANTED}
    for path in sorted(folder.glob("diagnosis-*-*.json")):
        _, _, name = path.stem.split("-", 2)
        causes = tested(json.loads(path.read_text()))
        if name == "clean":
            clean.append(any(one["group"] == "data" and one["told"] for one in causes))
        else:
            _, kinds, subject = PLANTED[name]
            right = bool(causes) and causes[0]["what"] in kinds and subject in causes[0]["subject"]
            planted.append(right)
            of_kind[name].append(right)
            silent += not causes
    for title, hits in (("clean, a sensor accused", clean), ("planted, named first", planted)):
        if hits:
            low, high = stats.binomtest(sum(hits), len(hits)).proportion_ci(method="exact")
            print(f"{title}: {sum(hits)} of {len(hits)} (95 %: {100 * low:.0f} to {100 * high:.0f} %)")
    print(f"planted, nothing named: {silent}")
    print("named first, by kind:", ", ".join(f"{k} {sum(v)} of {len(v)}" for k, v in of_kind.items() if v))


def arrays(count: int) -> None:
    """Rate of accusations in drawn records, the covariance of the errors estimated from each."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))
    from diagnosis_support import drawn
    from mascarin.diagnosis import diagnose

    hits = 0
    for seed in range(count):
        found = diagnose(drawn(1000 + seed), draws=399)
        hits += bool(found.findings)
        names = [one.candidate.label for one in found.findings]
        print(f"{seed} | p {found.p:.3g} | {names}", flush=True)
    low, high = stats.binomtest(hits, count).proportion_ci(method="exact")
    print(f"a cause is named: {hits} of {count} (95 %: {100 * low:.0f} to {100 * high:.0f} %)")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    kind, *rest = sys.argv[1:] or [""]
    if kind == "vsim":
        start, number = (int(rest[2]) if len(rest) > 2 else 0), (int(rest[3]) if len(rest) > 3 else 3)
        vsim(Path(rest[0]).resolve(), Path(rest[1]).resolve(), start, number, rest[4:])
    elif kind == "arrays":
        arrays(int(rest[0]) if rest else 40)
    else:
        print(__doc__)
