"""Steps that follow the weather: `step: auto`, its choice, its records and what it refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from crossing_entrances import Bench
from crossing_features import description
from mascarin._io.durations import AutoStep, auto_step, record_seconds
from mascarin.examples import box, box_climate
from mascarin.fmu.export import export
from mascarin.simulation.preparation import step_sequence
from mascarin.simulation.preparation.step_sequence import StepSequence
from mascarin.simulation.records.provenance import words_of
from mascarin.tables.steps import Steps

AIR = "room.air_temperature"
VOLUME = "zones.room.volume"


def room(**changes: Any) -> mc.Building:
    """The shipped box under a thin sheet, with a heater that is switched twice a day."""
    plain = box().to_dict()
    plain["zones"]["room"]["gains"] = {"heater": {"power": 800.0, "schedule": "hours"}}
    plain["schedules"] = {
        "hours": {"kind": "fraction", "days": {"all": [
            {"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}, {"at": "09:00", "value": 0},
            {"at": "19:00", "value": 1}, {"at": "20:00", "value": 0}]}}
    }  # fmt: skip
    plain |= changes
    return mc.Building.from_dict(plain)


def fixed(halvings: int, **options: Any) -> mc.Results:
    """A run with the cells and records of one with chosen steps, its steps of one length."""

    def chosen(auto: AutoStep, interval: float, _run: Any, forcings: Any, *_: Any, **__: Any) -> StepSequence:
        count = len(forcings[0]) << halvings
        return StepSequence(np.full(count, halvings, dtype=np.uint8), interval, auto.tolerance, 0.0)

    with patch.object(step_sequence, "chosen_sequence", chosen):
        return mc.simulate(room(), box_climate(), step="auto every 1h", outputs=[AIR], **options)


@pytest.fixture(scope="module")
def fine() -> np.ndarray:
    """Air temperatures in steps of 56 s."""
    return np.asarray(fixed(6)[AIR])


@pytest.mark.parametrize("tolerance", [0.5, 0.1, 0.05])
def test_errors_are_within_the_tolerance(tolerance: float, fine: np.ndarray) -> None:
    run = mc.simulate(room(), box_climate(), step=f"auto {tolerance}K every 1h", outputs=[AIR])
    assert np.abs(np.asarray(run[AIR]) - fine).max() < tolerance
    steps = run.provenance.steps
    assert steps is not None
    assert steps["estimated_error_K"] <= step_sequence.SHARE * tolerance
    assert run.energy.closure < 1e-12
    # A step of one length that is as short as the shortest one takes more than twice as many.
    assert steps["steps_of_the_shortest_length"] > 2 * steps["steps"]
    assert run.index.freq == pd.Timedelta("1h") or len(run.index) == len(fine)


def test_fewer_steps_for_a_wider_tolerance() -> None:
    counts = [
        len(mc.Simulation(room(), box_climate(), step=f"auto {tolerance}K every 1h").compiled.forcing)
        for tolerance in (0.05, 0.1, 0.5)
    ]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


def test_equal_steps_have_the_bits_of_a_fixed_step() -> None:
    """Steps of a quarter of the interval, records at its ends: those of a run with steps of 15 min."""
    quarter = np.asarray(fixed(2)[AIR])
    plain = mc.simulate(room(), box_climate(), step="15min", outputs=[AIR])
    assert np.array_equal(quarter, np.asarray(plain[AIR])[::4])


def test_means_are_those_of_all_steps_by_length() -> None:
    heated = room(zones={"room": box().to_dict()["zones"]["room"] | {"heating": {"setpoint": 24.0}}})
    run = mc.simulate(heated, box_climate(), step="auto 0.1K every 1h", outputs=["room.heating_load"])
    loads = np.asarray(run["room.heating_load"])[1:]
    assert loads.sum() > 0.0
    assert float(loads.sum() * 3600.0) == pytest.approx(run.energy.into["heating"], rel=1e-12)


def test_members_have_the_bits_of_their_runs_and_the_steps_of_the_base() -> None:
    simulation = mc.Simulation(room(), box_climate(), step="auto 0.1K every 1h", outputs=[AIR])
    vectors = np.tile(simulation.values, (11, 1))
    vectors[:, simulation.position(VOLUME)] = np.linspace(15.0, 90.0, 11)
    together = simulation.ensemble(vectors)
    assert together.failures == []
    for member in (0, 4, 10):
        alone = simulation.run_vector(vectors[member])
        assert np.array_equal(together.records[member, :, 0], np.asarray(alone[AIR]))
        assert alone.provenance.steps == simulation.sequence.to_dict()  # type: ignore[union-attr]
    swept = mc.sweep(
        room(), box_climate(), {VOLUME: vectors[:, simulation.position(VOLUME)]},
        step="auto 0.1K every 1h", outputs=[AIR],
    )  # fmt: skip
    assert swept[AIR].shape == (11, simulation.times.rows)


def test_derivatives_are_those_of_runs_with_the_same_steps() -> None:
    simulation = mc.Simulation(room(), box_climate(), step="auto 0.1K every 1h", outputs=[AIR])
    slopes = np.asarray(simulation.jacobian([VOLUME])[f"d {AIR}"]).ravel()
    volume, step = simulation.building.parameter(VOLUME).value, 0.05
    ends = [
        np.asarray(simulation.run({VOLUME: volume + sign * step})[AIR], dtype=np.float64) for sign in (1, -1)
    ]
    assert slopes == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=2e-3 * np.abs(slopes).max())

    def mean(series: Any) -> tuple[float, dict[str, Any]]:
        return float(series[AIR].mean()), {AIR: np.full(len(series[AIR]), 1.0 / len(series[AIR]))}

    gradient = simulation.gradient(mean).slopes[VOLUME]
    assert gradient == pytest.approx(slopes.mean(), rel=1e-9)


def test_what_was_chosen_is_stored_with_the_results(tmp_path: Path) -> None:
    simulation = mc.Simulation(room(), box_climate(), step="auto 0.1K every 1h", outputs=[AIR])
    simulation.run_into(tmp_path / "run.nc")
    stored = mc.Results.open(tmp_path / "run.nc").provenance.steps
    assert stored is not None
    assert stored == simulation.run().provenance.steps
    halvings = [
        int(part.split("x")[1]) for part in stored["sequence"].split() for _ in range(int(part.split("x")[0]))
    ]
    assert simulation.sequence is not None
    assert halvings == simulation.sequence.halvings.tolist()
    assert "estimated error of a step" in words_of(stored)
    assert simulation.identity != mc.Simulation(room(), box_climate(), step="1h", outputs=[AIR]).identity


def test_forcing_of_unequal_steps() -> None:
    zone = box_climate().grid.zone
    start = pd.Timestamp(box_climate().grid.start, unit="s", tz="UTC")
    end = start + pd.Timedelta("2h")
    steps = Steps.over(zone, start, end, 3600.0, "sdirk2", np.array([0, 1, 2, 2], dtype=np.uint8))
    assert steps.edges.tolist() == [0.0, 3600.0, 5400.0, 6300.0, 7200.0]
    assert steps.stage[:, 1].tolist() == steps.edges[1:].tolist()
    with pytest.raises(ValueError, match="expected"):
        Steps.over(zone, start, end, 3600.0, "sdirk2", np.array([0, 1], dtype=np.uint8))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("auto", AutoStep(0.05, None)),
        ("auto 0.2 K", AutoStep(0.2, None)),
        ("AUTO 1e-2K every 30min", AutoStep(0.01, 1800.0)),
        ("auto every 2h", AutoStep(0.05, 7200.0)),
        ("15min", None),
    ],
)
def test_the_option_is_read(text: str, expected: AutoStep | None) -> None:
    assert auto_step(text) == expected


@pytest.mark.parametrize(
    "text", ["auto 0.02", "automatic", "auto 0K", "auto 50K", "auto 0.1K every day", "auto ..K"]
)
def test_what_cannot_be_read_is_refused(text: str) -> None:
    with pytest.raises(mc.InputError, match="step: found"):
        auto_step(text)


@pytest.mark.parametrize(
    ("step", "options", "words"),
    [
        ("auto every 10min", {}, "between the values of the weather there is nothing to follow"),
        ("auto every 7h", {}, "at most 6 h"),
        ("auto 0.0001K every 1h", {}, "do not meet from"),
        ("auto", {"scheme": "backward-euler"}, "schemes of second order"),
    ],
)
def test_what_cannot_be_met_is_refused_before_the_run(step: str, options: dict[str, Any], words: str) -> None:
    with pytest.raises(mc.InputError, match=words):
        mc.Simulation(room(), box_climate(), step=step, **options)


def test_derived_outputs_of_means_are_refused() -> None:
    heated = room(
        zones={"room": box().to_dict()["zones"]["room"] | {"heating": {"setpoint": 24.0}}},
        derived_outputs={"doubled": {"formula": "2*room.heating_load", "unit": "W"}},
    )
    with pytest.raises(mc.InputError, match="'doubled', which depends on a mean"):
        mc.Simulation(heated, box_climate(), step="auto every 1h", outputs=["doubled"])


def test_what_needs_one_length_says_so() -> None:
    with pytest.raises(mc.InputError, match="expected one length"):
        mc.state_space(box(), step="auto")
    with pytest.raises(mc.InputError, match="expected the interval of the records"):
        record_seconds("auto 0.1K")


def test_a_unit_for_cosimulation_is_refused(tmp_path: Path) -> None:
    simulation = mc.Simulation(room(), box_climate(), step="auto 0.5K every 1h", outputs=[AIR])
    with pytest.raises(mc.InputError, match="its importing program steps it"):
        export(simulation, tmp_path / "unit.fmu")


def test_controls_switch_in_short_steps(tmp_path: Path) -> None:
    """In every hour in which a control has changed its mind there is a step of a minute at most."""
    bench = Bench(tmp_path / "room", description("controls"), step="auto 5K every 1h")
    opened = [output.name for output in bench.building.outputs() if output.kind == "control_open"]
    simulation = bench.simulation(*opened)
    states = np.stack([np.asarray(simulation.run()[name]) for name in opened], axis=1)
    changed = np.flatnonzero((np.diff(states, axis=0) != 0.0).any(axis=1))[1:]
    assert changed.size > 0
    assert simulation.sequence is not None
    edges, lengths = simulation.sequence.edges, simulation.sequence.lengths
    for hour in changed:
        inside = (edges[:-1] >= hour * 3600.0) & (edges[:-1] < (hour + 1) * 3600.0)
        assert lengths[inside].min() <= 60.0
    # Far from them steps are long.
    assert np.count_nonzero(lengths == 3600.0) >= 8
