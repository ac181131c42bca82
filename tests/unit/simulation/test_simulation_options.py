"""The options of a run: the same names, types, defaults and order in every function."""

from __future__ import annotations

import inspect
import pickle
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.ensemble import latin_hypercube, sweep_into
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.simulation import CompiledRun, Mean, RunOptions
from mascarin.simulation.preparation.options import TABLE

PATH = "surfaces.facade.outside.absorptance"
AIR = "room.air_temperature"
SHORT: dict[str, Any] = {"step": "1h", "outputs": [AIR]}

#: Name, type and default of each option, in order.
OPTIONS = [
    ("parameters", "Mapping[str, float] | None", None),
    ("outputs", "Sequence[str] | None", None),
    ("start", "TimeLike | None", None),
    ("end", "TimeLike | None", None),
    ("step", "str | float", "15min"),
    ("scheme", "Scheme", "sdirk2"),
    ("initial", "Initial", "repeat"),
    ("first_period", "str | float", "1d"),
    ("measurements", "Measurements | None", None),
    ("progress", "ProgressOption", None),
]
FUNCTIONS = [mc.simulate, mc.Simulation, mc.sweep, sweep_into, mc.jacobian, mc.gradient]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_options_are_the_same_in_every_function(function: Callable[..., Any]) -> None:
    found = [
        (p.name, p.annotation, p.default)
        for p in inspect.signature(function).parameters.values()
        if p.name in TABLE and p.kind is p.KEYWORD_ONLY
    ]
    # A simulation is compiled quickly; its methods have the option progress.
    assert found == (OPTIONS[:-1] if function is mc.Simulation else OPTIONS)
    text = " ".join((function.__doc__ or "").split())
    assert "<run options>" not in text
    for name, _, _ in found:
        kind, description = TABLE[name]
        assert f" {name} : {kind} {description}" in text


def test_options_are_kept_in_one_place() -> None:
    assert [name for name, _, _ in OPTIONS] == list(TABLE)
    kept = [(field.name, field.type, field.default) for field in fields(RunOptions)]
    assert kept == OPTIONS[:-1]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_further_arguments_are_given_by_name(function: Callable[..., Any]) -> None:
    parameters = inspect.signature(function).parameters.values()
    positional = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    third = {"sweep": ["samples"], "sweep_into": ["samples"], "jacobian": ["vary"], "gradient": ["objective"]}
    found = [name for name in positional if name != "store"]
    assert found == ["building", "climate", *third.get(function.__name__, [])]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"scheme": "sdirk"}, "Did you mean 'sdirk2'"),
        ({"outputs": AIR}, "expected a list: ['room.air_temperature']"),
        ({"parameters": [1.0]}, "found list, expected values by path"),
        ({"parameters": {"surfaces.facade.outside.absorptanc": 0.5}}, f"Did you mean '{PATH}'"),
        ({"parameters": {PATH: "dark"}}, "found 'dark', expected a number"),
        ({"parameters": {PATH: True}}, "found True, expected a number"),
        ({"parameters": {PATH: 1.5}}, "absorptance"),
    ],
)
def test_impossible_options_are_refused(options: dict[str, Any], words: str) -> None:
    for function, more in (
        (mc.simulate, ()),
        (mc.sweep, ({"zones.room.volume": [27.0]},)),
        (mc.jacobian, ([PATH],)),
        (mc.gradient, (Mean(AIR),)),
    ):
        with pytest.raises(InputError) as caught:
            function(box(), box_climate(), *more, **{**SHORT, **options})
        assert words in str(caught.value)


def test_parameters_equal_a_building_with_these_values() -> None:
    changed = box().replace({PATH: 0.9})
    by_option = mc.simulate(box(), box_climate(), parameters={PATH: 0.9}, **SHORT)
    by_building = mc.simulate(changed, box_climate(), **SHORT)
    by_path = mc.Simulation(box(), box_climate(), **SHORT).run({PATH: 0.9})
    assert by_option.records.tobytes() == by_building.records.tobytes() == by_path.records.tobytes()
    assert by_option.provenance.changed == by_path.provenance.changed == {PATH: 0.9}
    assert by_building.provenance.changed == {}
    nominal = mc.simulate(box(), box_climate(), **SHORT)
    assert by_option.records.max() > nominal.records.max() + 0.5  # a darker facade
    # The option comes first, then the values of a single run.
    both = mc.Simulation(box(), box_climate(), parameters={"zones.room.volume": 40.0}, **SHORT).run(
        {PATH: 0.9}
    )
    assert both.provenance.changed == {"zones.room.volume": 40.0, PATH: 0.9}


def test_structural_parameters_can_be_given_too() -> None:
    turned = mc.simulate(box(), box_climate(), parameters={"surfaces.facade.azimuth": 0.0}, **SHORT)
    assert turned.records.max() < mc.simulate(box(), box_climate(), **SHORT).records.max() - 0.5


def test_derivatives_at_other_values() -> None:
    climate = box_climate()
    simulation = mc.Simulation(box(), climate, **SHORT)
    slopes = simulation.jacobian([PATH], {PATH: 0.8})
    again = mc.jacobian(box(), climate, [PATH], parameters={PATH: 0.8}, **SHORT)
    np.testing.assert_array_equal(slopes[f"d {AIR}"], again[f"d {AIR}"])
    low, high = (simulation.run({PATH: 0.8 + nudge}).records[:, 0] for nudge in (-1e-3, 1e-3))
    quotient = (high - low) / 2e-3
    np.testing.assert_allclose(slopes[f"d {AIR}"].to_numpy()[0], quotient, rtol=1e-3, atol=1e-4)
    gradient = simulation.gradient(Mean(AIR), {PATH: 0.8})
    assert gradient.slopes[PATH] == pytest.approx(float(slopes[f"d {AIR}"].mean()), rel=1e-9)
    assert slopes["time"].size == slopes["local_time"].size == 73


# --- progress ---


def test_progress_is_called_with_done_and_total() -> None:
    calls: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> None:
        calls.append((done, total))

    mc.simulate(box(), box_climate(), progress=progress, **SHORT)
    assert (calls[0], calls[-1]) == ((0, 72), (72, 72))
    calls.clear()
    mc.sweep(box(), box_climate(), {PATH: np.linspace(0.2, 0.9, 20)}, progress=progress, **SHORT)
    assert calls[-1] == (20, 20)
    assert {total for _, total in calls} == {20}
    calls.clear()
    mc.jacobian(box(), box_climate(), [PATH, "zones.room.volume"], progress=progress, **SHORT)
    assert (calls[0], calls[-1]) == ((0, 2), (2, 2))
    calls.clear()
    mc.gradient(box(), box_climate(), Mean(AIR), progress=progress, **SHORT)
    assert calls == [(0, 2), (1, 2), (2, 2)]


def test_an_error_in_the_progress_function_stops_the_work() -> None:
    def impatient(_done: int, _total: int) -> None:
        raise RuntimeError("enough")

    samples = latin_hypercube(box(), 64, seed=1)
    with pytest.raises(RuntimeError, match="enough"):
        mc.sweep(box(), box_climate(), samples, progress=impatient, **SHORT)


# --- pickling ---


def test_a_simulation_can_be_pickled() -> None:
    simulation = mc.Simulation(box(), box_climate(), **SHORT)
    before = simulation.run()
    copied: mc.Simulation = pickle.loads(pickle.dumps(simulation))  # noqa: S301 (own data)
    assert copied.run() == before
    assert copied.identity == simulation.identity


def test_a_compiled_run_is_text_and_arrays() -> None:
    simulation = mc.Simulation(box(), box_climate(), **SHORT)
    compiled = simulation.compiled
    header = compiled.header()
    again = CompiledRun.read(header, compiled.forcing, compiled.values)
    for other in (again, pickle.loads(pickle.dumps(compiled))):  # noqa: S301 (own data)
        records, raw = other.run(other.values)
        assert records.tobytes() == simulation.run().records.tobytes()
        assert raw["closure"] == simulation.run().energy.relative_residual
        members, residuals, failures = other.ensemble(np.tile(other.values, (3, 1)))
        assert members[1].tobytes() == records.tobytes()
        assert residuals[2] == raw["closure"]
        assert failures == []
    assert "plan" not in compiled.__getstate__()
    assert compiled.dated("step 3 did not converge") == "step 3 from 2001-07-01 03:00:00 did not converge"


def test_a_simulation_has_a_short_description() -> None:
    text = repr(mc.Simulation(box(), box_climate(), **SHORT))
    assert text == ("<Simulation of 'box', 2001-07-01 00:00 to 2001-07-04 00:00, step 3600 s, 1 outputs>")


def test_a_record_that_ends_within_a_step_is_run_to_its_last_whole_step() -> None:
    climate = box_climate()
    plain = mc.simulate(box(), climate, step="1h")
    seven = mc.simulate(box(), climate, step="7h")
    length = (plain.index[-1] - plain.index[0]) // pd.Timedelta("7h")
    assert length * pd.Timedelta("7h") < plain.index[-1] - plain.index[0]
    assert seven.index[-1] == plain.index[0] + length * pd.Timedelta("7h")
    with pytest.raises(InputError, match="not a whole number of steps"):
        mc.simulate(box(), climate, end=plain.index[-1], step="7h")
