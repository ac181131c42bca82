"""How often intervals and bands of a study contain the truth when the form of the model is not known.

Experiments are simulated on the shipped LGI cell with a model that differs from the one that is calibrated:
other parameters (drawn from their priors, those that are not estimated from their ranges), other forms of
some parts of the model, offsets of the sensors drawn at their stated uncertainty, white noise of 0.1 to
0.3 K, and errors with a correlation time of 3 h. The forms of even seeds are among the alternatives of the
study; those of odd seeds are none of them. Each experiment is then calibrated by the study of the cell, with
its alternatives.

Run ``python bench/coverage.py FOLDER [experiments] [first seed]``. Each result is a file of the folder, and
is not computed again; the table of all results there is printed after each experiment.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.errors import InputError
from mascarin.examples import STUDIES
from mascarin.linear_algebra import one_thread
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study import Study
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.model_averaging import combined_intervals, estimates_of
from mascarin.study.steps.model_runs import ModelRuns
from mascarin.weather import Measurements

Floats = NDArray[np.float64]

OFFSET = 0.15  # K, standard uncertainty in the study
CORRELATED = 0.05  # K, standard deviation of the error with a correlation time of 3 h
CORRELATION = 3.0  # h


#: Coefficients of a flat roof by direction of the wind, c V^m: up to this angle to its axis [deg], c, m.
#: Emmel, Abadie and Mendes 2007, doi:10.1016/j.enbuild.2006.08.001.
ROOF = ((22.5, 5.11, 0.78), (67.5, 4.60, 0.79), (90.0, 3.67, 0.85))
#: Column of the simulated experiment with these coefficients. No alternative of the study names them.
COLUMN = "outside_convection"
GAP = {"kind": "power", "upward": {"b": 1.8, "n": 0.33}, "downward": {"a": 0.3, "b": 0.5, "n": 0.25}}
UNNAMED: dict[str, dict[str, Any]] = {
    "site.cloud": {"site.cloud": {"kind": "layer", "base": 1500.0}},
    "gap": {"surfaces.roof.inside.convection": GAP, "surfaces.ceiling.outside.convection": GAP},
    "melting": {"materials.energain.law": {"kind": "gaussian", "width": 0.8}},
    "site.diffuse": {"site.diffuse": "isotropic"},
}


def truth(
    study: Study, rng: np.random.Generator, named: bool
) -> tuple[Any, dict[str, float], dict[str, str], list[str]]:
    """Draw the building that makes the data: its parameters, the forms chosen, and what they replace."""
    forms = study.context.variants.forms
    changes: dict[str, Any] = {}
    chosen: dict[str, str | None]
    if named:
        chosen = {part: [None, *known][rng.integers(1 + len(known))] for part, known in forms.parts.items()}
        variant = study.context.variants.variant_of(forms.of(chosen))
        building = study.context.variants.building_of(variant)
    else:
        changes = {"surfaces.roof.outside.convection": {"kind": "measured", "column": COLUMN}}
        chosen, variant = {"outside convection": "by direction of the wind"}, None
        for part, forms_of_part in UNNAMED.items():
            if rng.random() < 0.5:
                changes |= forms_of_part
                chosen[part] = "not named"
        building = study.building.replace(changes)
    values: dict[str, float] = {}
    known_parameters = {p.path: p for p in study.context.problem(variant).parameters}
    for factor in factors_of(building):
        parameter = building.parameter(factor.path)
        low, high = max(parameter.low, parameter.lower), min(parameter.high, parameter.upper)
        sd = 0.25 * (high - low)
        free = known_parameters.get(factor.path)
        if any(factor.path.startswith(f"{path}.") for path in changes):
            sd = 0.1 * (high - low)
        elif free is not None:
            low, high = free.lower, free.upper
            sd = free.prior[1] if free.prior is not None else 0.25 * (high - low)
        for _ in range(100):
            value = parameter.value + sd * rng.standard_normal()
            if low <= value <= high:
                values[factor.path] = float(value)
                break
    return building, values, {part: form or "as described" for part, form in chosen.items()}, list(changes)


def by_direction(speed: Floats, direction: Floats) -> Floats:
    """Coefficient of a flat roof whose axis points north, by the wind. [W/(m2 K)]"""
    angle = np.abs((direction + 90.0) % 180.0 - 90.0)
    return np.asarray(np.select([angle <= limit for limit, _, _ in ROOF], [c * speed**m for _, c, m in ROOF]))


def experiment(study: Study, seed: int) -> tuple[Study, dict[str, float], dict[str, str], list[str], float]:
    """A study of simulated data, the true parameters and forms, what forms replace, and the noise. [K]"""
    rng = np.random.default_rng(seed)
    building, values, chosen, changed = truth(study, rng, named=seed % 2 == 0)
    table = study.measurements.data.copy()
    table[COLUMN] = by_direction(table["wind_speed"].to_numpy(), table["wind_direction"].to_numpy())
    driven = study.with_measurements(Measurements.from_table(table, timezone="UTC+4"))
    simulation = driven.context.models.of_building(building)
    records = simulation.run_vector(simulation.vector(values)).records
    series = study.context.observation.simulated(simulation.index, records)
    noise = float(rng.uniform(0.1, 0.3))
    phi = math.exp(-study.context.observation.interval / 3600.0 / CORRELATION)
    rows = table.index.get_indexer(study.context.observation.times)
    for s, sensor in enumerate(study.plan.sensors.values()):
        size = len(series)
        drift = lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], rng.standard_normal(size + 300))[300:]
        error = OFFSET * rng.standard_normal() + noise * rng.standard_normal(size) + CORRELATED * drift
        values_now = np.full(len(table), np.nan)
        values_now[rows] = series[:, s] + error
        table[sensor.columns[0]] = values_now
    measured = Measurements.from_table(table, timezone="UTC+4")
    return study.with_measurements(measured), values, chosen, changed, noise


@one_thread()
def judge(
    study: Study, values: dict[str, float], chosen: dict[str, str], replaced: list[str]
) -> dict[str, Any]:
    """Calibrate one experiment and compare with the truth."""
    with (
        tempfile.TemporaryDirectory() as folder,
        Workspace(Path(folder), study.context.identity()) as workspace,
    ):
        found = ModelRuns(study.context, workspace, False).combination()
    fit, intervals = estimates_of(study.context, found), combined_intervals(study.context, found)
    best = dict(found.forms[0].choice)
    held = {}
    for i, path in enumerate(fit.problem.paths):
        changed = [
            part
            for part, known in study.context.variants.forms.parts.items()
            for form in known.values()
            if best.get(part, "as described") != chosen.get(part, "as described")
            and any(path.startswith(f"{place}.") for place in form.changes)
        ]
        changed += [place for place in replaced if path.startswith(f"{place}.")]
        # A parameter of another law than the true one has no true value.
        if path in values and not changed:
            held[path] = bool(fit.low[i] <= values[path] <= fit.high[i])
    scores = {}
    sd = (fit.high - fit.low) / 2.0
    for i, path in enumerate(fit.problem.paths):
        if path in held:
            scores[path] = float((values[path] - 0.5 * (fit.low[i] + fit.high[i])) / sd[i])
    return {
        "held": held,
        "blind": dict(
            zip(study.context.observation.names, intervals.coverage["blind"].tolist(), strict=True)
        ),
        "half": dict(
            zip(study.context.observation.names, intervals.half_width.mean(axis=0).tolist(), strict=True)
        ),
        "sd": [periods["blind"].sd for periods in found.forms[0].run.scores.values()],
        "rms": float(np.sqrt(np.mean(np.square(list(scores.values()))))),
        "best": best,
    }


def main() -> None:
    """Print the table after each experiment."""
    if len(sys.argv) < 2:
        sys.stdout.write(__doc__ or "")
        return
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 40
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    study = Study.from_yaml(STUDIES["lgi"])
    for seed in range(first, first + count):
        path = folder / f"{seed}.json"
        if path.exists():
            continue
        began = time.monotonic()
        try:
            made, values, chosen, changed, noise = experiment(study, seed)
            result = judge(made, values, chosen, changed)
        except InputError as error:
            sys.stdout.write(f"experiment {seed}: {error}\n")
            continue
        result |= {"forms": chosen, "noise": noise, "seconds": time.monotonic() - began}
        part = path.with_suffix(".part")
        part.write_text(json.dumps(result))
        part.replace(path)
        table(folder)


def table(folder: Path) -> None:
    """Print what all experiments of a folder have found."""
    held: dict[str, list[bool]] = defaultdict(list)
    blind: dict[str, list[float]] = defaultdict(list)
    for path in sorted(folder.glob("*.json"), key=lambda one: int(one.stem)):
        result = json.loads(path.read_text())
        for name, inside in result["held"].items():
            held[name].append(inside)
        for name, share in result["blind"].items():
            blind[name].append(share)
        missed = [name for name, inside in result["held"].items() if not inside]
        sys.stdout.write(
            f"experiment {path.stem}: {result['forms']}, noise {result['noise']:.2f} K; used "
            f"{result['best'] or 'as described'}; {len(result['held']) - len(missed)} of "
            f"{len(result['held'])} parameters inside, missed {missed}; blind "
            f"{[round(100 * share) for share in result['blind'].values()]} %, half-width "
            f"{[round(width, 2) for width in result['half'].values()]} K; {result['seconds']:.0f} s\n"
        )
    every = [inside for flags in held.values() for inside in flags]
    sys.stdout.write(f"\nparameters: {100 * np.mean(every):.1f} % of {len(every)}\n\n")
    sys.stdout.write("| parameter | inside | of |\n|---|---|---|\n")
    for name, flags in sorted(held.items(), key=lambda item: float(np.mean(item[1]))):
        sys.stdout.write(f"| `{name}` | {100 * np.mean(flags):.0f} % | {len(flags)} |\n")
    sys.stdout.write(f"\nblind values: {100 * np.mean(list(blind.values())):.1f} %\n\n")
    sys.stdout.write("| sensor | blind values inside | worst experiment |\n|---|---|---|\n")
    for name, parts in blind.items():
        sys.stdout.write(f"| {name} | {100 * np.mean(parts):.1f} % | {100 * min(parts):.0f} % |\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
