"""How often intervals and bands of a study contain the truth when the form of the model is not known.

Experiments are simulated on the shipped LGI cell with a model that differs from the one that is calibrated:
other parameters (drawn from their priors, those that are not estimated from their ranges), other forms of
some parts of the model (any of the alternatives of the study), offsets of the sensors drawn at their stated
uncertainty, white noise of 0.1 to 0.3 K, and errors with a correlation time of 3 h. Each is then calibrated
by the study of the cell, with its alternatives.

Run ``python bench/coverage.py [experiments] [first seed]``; the table is printed after each experiment.
"""

from __future__ import annotations

import math
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.errors import InputError
from mascarin.examples import STUDIES
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study import Study
from mascarin.study.combined import combined_intervals, estimates_of
from mascarin.study.model_runs import ModelRuns
from mascarin.study.storage import Workspace
from mascarin.weather import Measurements

Floats = NDArray[np.float64]

OFFSET = 0.15  # K, standard uncertainty in the study
CORRELATED = 0.05  # K, standard deviation of the error with a correlation time of 3 h
CORRELATION = 3.0  # h


def truth(study: Study, rng: np.random.Generator) -> tuple[Any, dict[str, float], dict[str, str]]:
    """Draw the building that makes the data: its form, its parameters, and which forms were chosen."""
    forms = study.forms
    chosen = {part: [None, *known][rng.integers(1 + len(known))] for part, known in forms.parts.items()}
    choice = forms.of(chosen)
    variant = study.variant_of(choice)
    building = study.building_of(variant)
    values: dict[str, float] = {}
    known_parameters = {p.path: p for p in study.problem(variant).parameters}
    for factor in factors_of(building):
        parameter = building.parameter(factor.path)
        low, high = max(parameter.low, parameter.lower), min(parameter.high, parameter.upper)
        sd = 0.25 * (high - low)
        free = known_parameters.get(factor.path)
        if free is not None:
            low, high = free.lower, free.upper
            sd = free.prior[1] if free.prior is not None else 0.25 * (high - low)
        for _ in range(100):
            value = parameter.value + sd * rng.standard_normal()
            if low <= value <= high:
                values[factor.path] = float(value)
                break
    return building, values, {part: form or "as described" for part, form in chosen.items()}


def experiment(study: Study, seed: int) -> tuple[Study, dict[str, float], dict[str, str], float]:
    """A study of simulated data, with the true parameters and forms, and the noise. [K]"""
    rng = np.random.default_rng(seed)
    building, values, chosen = truth(study, rng)
    simulation = study.over_record(building)
    records = simulation.run_vector(simulation.vector(values)).records
    table = study.measurements.data.copy()
    series = study.observation.simulated(simulation.index, records)
    noise = float(rng.uniform(0.1, 0.3))
    phi = math.exp(-study.observation.interval / 3600.0 / CORRELATION)
    rows = table.index.get_indexer(study.observation.times)
    for s, (name, sensor) in enumerate(study.plan.sensors.items()):
        size = len(series)
        drift = lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], rng.standard_normal(size + 300))[300:]
        error = OFFSET * rng.standard_normal() + noise * rng.standard_normal(size) + CORRELATED * drift
        values_now = np.full(len(table), np.nan)
        values_now[rows] = series[:, s] + error
        table[sensor.columns[0]] = values_now
        _ = name
    measured = Measurements.from_table(table, timezone="UTC+4")
    copy = Study.__new__(type(study))
    copy.__setstate__({"sources": replace(study.sources, measurements=measured, quality=[])})
    return copy, values, chosen, noise


def judge(study: Study, values: dict[str, float], chosen: dict[str, str]) -> dict[str, Any]:
    """Calibrate one experiment and compare with the truth."""
    with tempfile.TemporaryDirectory() as folder, Workspace(Path(folder), study.inputs()) as workspace:
        found = ModelRuns(study, workspace, False).combination()
    fit, intervals = estimates_of(study, found), combined_intervals(study, found)
    best = dict(found.forms[0].choice)
    held = {}
    for i, path in enumerate(fit.problem.paths):
        changed = [
            part
            for part, known in study.forms.parts.items()
            for form in known.values()
            if best.get(part, "as described") != chosen[part]
            and any(path.startswith(f"{place}.") for place in form.changes)
        ]
        # A parameter of another law than the true one has no true value.
        if path in values and not changed:
            held[path] = bool(fit.low[i] <= values[path] <= fit.high[i])
    scores = {}
    sd = (fit.high - fit.low) / 2.0
    for i, path in enumerate(fit.problem.paths):
        if path in held:
            scores[path] = float((values[path] - 0.5 * (fit.low[i] + fit.high[i])) / sd[i])
    weight = sum(
        w for f, w in zip(found.forms, found.weights, strict=True)
        if {**dict.fromkeys(chosen, "as described"), **dict(f.choice)} == chosen
    )  # fmt: skip
    return {
        "held": held,
        "blind": dict(zip(study.observation.names, intervals.coverage["blind"].tolist(), strict=True)),
        "half": dict(zip(study.observation.names, intervals.half_width.mean(axis=0).tolist(), strict=True)),
        "sd": [periods["blind"].sd for periods in found.forms[0].run.scores.values()],
        "rms": float(np.sqrt(np.mean(np.square(list(scores.values()))))),
        "weight": float(weight),
        "best": best,
    }


def main() -> None:
    """Print the table after each experiment."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    study = Study.from_yaml(sys.argv[3] if len(sys.argv) > 3 else STUDIES["lgi"])
    held: dict[str, list[bool]] = defaultdict(list)
    blind: dict[str, list[float]] = defaultdict(list)
    for seed in range(first, first + count):
        began = time.monotonic()
        try:
            made, values, chosen, noise = experiment(study, seed)
            result = judge(made, values, chosen)
        except InputError as error:
            sys.stdout.write(f"experiment {seed}: {error}\n")
            continue
        for path, inside in result["held"].items():
            held[path].append(inside)
        for name, part in result["blind"].items():
            blind[name].append(part)
        missed = [path for path, inside in result["held"].items() if not inside]
        inside = f"{sum(result['held'].values())} of {len(result['held'])} parameters inside"
        parts = [round(100 * part) for part in result["blind"].values()]
        half = [round(width, 2) for width in result["half"].values()]
        sys.stdout.write(
            f"experiment {seed}: {chosen}, noise {noise:.2f} K; "
            f"used {result['best'] or 'as described'}, "
            f"weight of the true form {result['weight']:.2f}; {inside}, "
            f"missed {missed}, distance over half-width "
            f"{result['rms']:.2f} (rms); blind {parts} %, half-width {half} K, scatter "
            f"{np.round(result['sd'], 2).tolist()} K; {time.monotonic() - began:.0f} s\n"
        )
        sys.stdout.flush()
    every = [inside for flags in held.values() for inside in flags]
    sys.stdout.write(f"\nparameters: {100 * np.mean(every):.1f} % of {len(every)}\n\n")
    sys.stdout.write("| parameter | inside | of |\n|---|---|---|\n")
    for path, flags in sorted(held.items(), key=lambda item: np.mean(item[1])):
        sys.stdout.write(f"| `{path}` | {100 * np.mean(flags):.0f} % | {len(flags)} |\n")
    sys.stdout.write(f"\nblind values: {100 * np.mean(list(blind.values())):.1f} %\n\n")
    sys.stdout.write("| sensor | blind values inside | worst experiment |\n|---|---|---|\n")
    for name, parts in blind.items():
        sys.stdout.write(f"| {name} | {100 * np.mean(parts):.1f} % | {100 * min(parts):.0f} % |\n")


if __name__ == "__main__":
    main()
