"""The runs in which all parameters vary may have a longer step than the study."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.simulation.preparation.parameter_vectors import VectorRuns
from mascarin.study import Study
from mascarin.study.context.step_cache import kept_series
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.error_model import RANGES, effects_of_unknowns, unknowns
from mascarin.study.steps.model_runs import ModelRuns
from mascarin.study.steps.parameter_effects import Effects
from study_support import BUILDING, STUDY, Bench, logger_table


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("bench")
    (folder / "building.yaml").write_text(BUILDING, "utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv", index_label="time")
    (folder / "study.yaml").write_text(STUDY, "utf-8")
    return Bench(folder)


def opened(bench: Bench, step: str, identified: str = "") -> Study:
    """The study with a step of the sensitivity analysis, and a further line of the identification."""
    path = bench.folder / f"study-{step}{'-errors' if identified else ''}.yaml"
    text = STUDY.replace("interval: 1h", f"interval: 1h, step: {step}")
    path.write_text(text.replace("  starts: 2\n", f"  starts: 2\n{identified}"), "utf-8")
    return Study.from_yaml(path)


def test_only_the_runs_with_all_parameters_take_the_long_step(bench: Bench) -> None:
    study = opened(bench, "1h")
    simulation, lead = study.context.models.for_sensitivity()
    assert (simulation.step_seconds, lead) == (3600.0, 86400.0)
    assert simulation.index[0] == pd.Timestamp("2023-03-01 00:00", tz=simulation.index.tz)
    models = study.context.models
    assert models.for_calibration().step_seconds == models.over_record().step_seconds == 1800.0
    assert opened(bench, "30min").context.models.for_sensitivity()[0] is not simulation


def test_sensitivities_with_the_long_step_are_those_of_the_short_one(bench: Bench, tmp_path: Path) -> None:
    found = []
    for step in ("30min", "1h"):
        study = opened(bench, step)
        assert study.plan.sensitivity is not None
        with Workspace(tmp_path / step, study.context.identity()) as workspace:
            found.append(ModelRuns(study.context, workspace).sensitivity(study.plan.sensitivity).table())
    fine, coarse = (one.set_index(["output", "parameter"])["share"] for one in found)
    assert np.abs(fine - coarse).max() < 0.02
    assert fine.max() > 0.2


def test_effects_with_the_long_step_are_those_of_the_short_one(bench: Bench) -> None:
    effects = []
    for step in ("30min", "1h"):
        study = opened(bench, step)
        assert not study.context.estimates_errors  # otherwise the step is that of the bands
        simulation = study.context.models.nominal
        values = simulation.vector({})
        base = kept_series(study.context, simulation, values[None])[0]
        effects.append(dict(Effects(study.context, simulation, base, values).each(lambda done, of: None)))
    fine, coarse = effects
    assert set(fine) == set(coarse)
    largest = max(np.abs(one).max() for one in fine.values())
    assert largest > 0.5
    assert max(np.abs(fine[path] - coarse[path]).max() for path in fine) < 0.05 * largest


def test_steps_that_need_the_same_runs_share_them(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    context = opened(bench, "1h", "  discrepancy: {limit: 0.1}\n").context
    assert context.estimates_errors
    simulation, count = context.models.nominal, []
    base = simulation.vector({})
    numbers = unknowns(context, simulation, set())
    ensemble = VectorRuns.ensemble

    def counted(self: VectorRuns, vectors: np.ndarray, **options: Any) -> Any:
        count.append(len(vectors))
        return ensemble(self, vectors, **options)

    monkeypatch.setattr(VectorRuns, "ensemble", counted)
    with Workspace(tmp_path / "work", context.identity()) as workspace, context.keeping(workspace):
        effects = effects_of_unknowns(context, context.observation, simulation, base, numbers)
        assert sum(count) == len(numbers) + 1
        series = kept_series(context, simulation, base[None])[0]
        found = dict(Effects(context, simulation, series, base).each(lambda done, of: None))
        # The depth of the sensor alone: its uncertainty is not stated, so that bands do not have it.
        assert sum(count) == len(numbers) + 1 + 1
    for k, number in enumerate(numbers):
        # `Effects` are those of the whole range, and leave out numbers without effect.
        own = RANGES * found.get(number.path, np.zeros(effects.shape[:2]))
        assert own == pytest.approx(effects[:, :, k], abs=1e-12)
