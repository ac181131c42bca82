"""Runs whose forcing is worked out in blocks of steps, beside runs with all steps in one piece."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from crossing_entrances import Bench
from crossing_features import END, FEATURES, START, description
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.simulation.preparation import engine_run, prepare
from mascarin.simulation.preparation.options import Scheme
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.tables.forcing_blocks import ForcingBlocks

Make = Callable[[], Simulation]


@pytest.fixture
def blocks_of_48(monkeypatch: pytest.MonkeyPatch) -> Callable[[Make], Simulation]:
    """Compiles a run whose forcing has blocks of 48 steps."""

    def compiled(make: Make) -> Simulation:
        with monkeypatch.context() as patch:
            patch.setattr(prepare, "SMALL", 0)
            patch.setattr(prepare, "STEPS", 48)
            return make()

    return compiled


def _required_equal(in_blocks: Simulation, in_one_piece: Simulation, file: Path) -> None:
    """Bits of all records, and equality of all else that a run says."""
    stored, run = in_blocks.run_into(file), in_one_piece.run()
    series = Results.open(file)
    assert np.array_equal(series.records.view(np.int64), run.records.view(np.int64))
    assert series == run
    assert stored.finished.energy == run.energy
    assert stored.finished.vapour == run.vapour
    assert stored.finished.judgement == run.judgement
    assert stored.finished.warnings == run.warnings
    assert stored.finished.provenance == run.provenance


@pytest.mark.parametrize("feature", FEATURES)
@pytest.mark.parametrize("scheme", ["sdirk2", "backward-euler"])
def test_blocks_of_steps_have_the_bits_of_one_piece(
    feature: str, scheme: Scheme, blocks_of_48: Callable[[Make], Simulation], tmp_path: Path
) -> None:
    """Six blocks of steps, of which the first has a repeated period."""
    bench = Bench(tmp_path / feature, description(feature))

    def make() -> Simulation:
        return Simulation(
            bench.building, bench.climate, measurements=bench.measurements, start=START, end=END,
            step="5min", scheme=scheme, first_period="4h",
        )  # fmt: skip

    in_one_piece, in_blocks = make(), blocks_of_48(make)
    count = len(list(in_blocks.compiled.forcing_blocks.blocks()))
    # Errors of the weather that are parameters change all steps.
    assert count == (1 if bench.building.weather is not None else -(-in_one_piece.compiled.steps // 48))
    _required_equal(in_blocks, in_one_piece, tmp_path / "run.nc")
    _required_equal(in_blocks, in_one_piece, tmp_path / "run.csv")


def _box() -> Simulation:
    return Simulation(box(), box_climate(), step="15min", first_period="6h")


@pytest.fixture
def box_in_blocks(blocks_of_48: Callable[[Make], Simulation]) -> Simulation:
    return blocks_of_48(_box)


def test_a_run_in_memory_takes_the_blocks_once(box_in_blocks: Simulation) -> None:
    """A second run finds all steps in memory."""
    passes = []
    forcing = box_in_blocks.compiled.forcing_blocks
    begin = forcing._blocks

    def counted() -> Iterator[np.ndarray]:
        passes.append(1)
        return begin()

    forcing._blocks = counted
    first, second, third = (box_in_blocks.run() for _ in range(3))
    assert first == second == third == _box().run()
    assert len(passes) == 2


def test_what_needs_all_steps_gets_them(box_in_blocks: Simulation) -> None:
    in_one_piece = _box()
    unpickled = pickle.loads(pickle.dumps(box_in_blocks.compiled))  # noqa: S301 (its own bytes)
    assert unpickled.forcing.tobytes() == in_one_piece.compiled.forcing.tobytes()
    assert box_in_blocks.identity == in_one_piece.identity
    vectors = in_one_piece.vector({})[None]
    assert np.array_equal(box_in_blocks.ensemble(vectors).records, in_one_piece.ensemble(vectors).records)


def test_a_first_period_longer_than_a_block_needs_all_steps(
    box_in_blocks: Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert box_in_blocks.compiled.settings["warmup_steps"] == 24
    monkeypatch.setattr(engine_run, "STEPS", 23)
    _required_equal(box_in_blocks, _box(), tmp_path / "run.nc")
    assert len(list(box_in_blocks.compiled.forcing_blocks.blocks())) == 1


def test_an_error_of_a_later_block_ends_the_run(box_in_blocks: Simulation, tmp_path: Path) -> None:
    compiled = box_in_blocks.compiled
    blocks = list(compiled.forcing_blocks.blocks())

    def broken() -> Iterator[np.ndarray]:
        yield np.concatenate(blocks[:3])
        raise InputError("no weather")

    compiled.__dict__["forcing_blocks"] = ForcingBlocks(compiled.forcing_blocks.shape, broken)
    with pytest.raises(InputError, match="no weather"):
        box_in_blocks.run_into(tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("later", [0, 2])
def test_blocks_with_too_few_or_too_many_steps_are_refused(box_in_blocks: Simulation, later: int) -> None:
    compiled = box_in_blocks.compiled
    blocks = list(compiled.forcing_blocks.blocks())
    given = [np.concatenate(blocks[:3]), *[np.concatenate(blocks)] * later]
    compiled.__dict__["forcing_blocks"] = ForcingBlocks(compiled.forcing_blocks.shape, lambda: iter(given))
    with pytest.raises(InputError, match=f"has {later and compiled.steps} steps, expected 1 to"):
        box_in_blocks.run()
