"""Single runs, derivatives and ensembles through Python, by pytest-benchmark; `make bench` collects it.

Times are processor time of one thread.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest
from engine_speed import MODELS, VARIED, samples, simulation

from mascarin.simulation.simulation import Simulation

DAYS = int(os.environ.get("MASCARIN_BENCH_DAYS", "92"))
MEMBERS, STEPS_A_DAY = 16, 96


@pytest.fixture(scope="module", params=MODELS)
def cell(request: pytest.FixtureRequest) -> Simulation:
    """A model of the LGI cell."""
    return simulation(MODELS[request.param], DAYS)


def test_run(benchmark: Any, cell: Simulation) -> None:
    """A run with its results and energy balance."""
    results = benchmark.pedantic(cell.run, rounds=7, warmup_rounds=1)
    assert results.energy.closure < 1e-10


def test_ensemble(benchmark: Any, cell: Simulation) -> None:
    """An ensemble, daily values kept."""
    benchmark.extra_info["members"] = MEMBERS
    many = samples(cell, MEMBERS)
    _, closure, failures = benchmark.pedantic(
        cell.ensemble, args=(many,), kwargs={"record_every": STEPS_A_DAY}, rounds=3, warmup_rounds=1
    )
    assert not failures
    assert closure.max() < 1e-10


def test_jacobian(benchmark: Any, cell: Simulation) -> None:
    """All series and their derivatives by the parameters that ensembles vary, at most seven."""
    paths = [path for path in VARIED if path in cell.paths]
    benchmark.extra_info["parameters"] = len(paths)
    _, slopes = benchmark.pedantic(cell.jacobian_vector, args=(paths,), rounds=3, warmup_rounds=1)
    assert np.isfinite(slopes).all()


def test_gradient(benchmark: Any, cell: Simulation) -> None:
    """The mean of the first output and its derivatives by all parameters, in reverse mode."""

    def gradient() -> np.ndarray:
        way = cell.trajectory()
        weights = np.zeros((len(cell.index), len(cell.outputs)))
        weights[:, 0] = 1.0 / len(weights)
        return way.pull(weights)

    benchmark.extra_info["parameters"] = len(cell.paths)
    assert np.isfinite(benchmark.pedantic(gradient, rounds=3, warmup_rounds=1)).all()
