"""Convection and melting as text: the runs of built-in laws, parameters by path, faults with their place."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from fmu_support import instance
from mascarin.building import Building, FormulaLaw
from mascarin.ensemble import sweep
from mascarin.errors import InputError
from mascarin.examples import STUDIES, box, box_climate
from mascarin.fmu import export
from mascarin.measurements import Sensor
from mascarin.simulation.simulation import Simulation
from mascarin.study import Study
from mascarin.verification.analytical import setup

TARP = (
    "f*if(abs(upward) < 1e-6, 1.31, if(dT*upward > 0, 9.482/(7.238 - abs(upward)), "
    "1.810/(1.382 + abs(upward))))*abs(dT)^(1/3)"
)
MOWITT = "f*sqrt((0.84*abs(dT)^(1/3))^2 + (if(windward, 3.26*V^0.89, 3.55*V^0.617))^2)"
OUTSIDE = "surfaces.facade.outside.convection"
OWN = {
    "formula": "c*abs(dT)^n + b*V^m",
    "c": {"value": 2.3, "range": [1, 4], "limits": [0, 20], "unit": "W/(m2 K^(1+n))"},
    "n": {"value": 0.33, "range": [0.2, 0.4]},
    "b": {"value": 3.1, "unit": "W/(m2 K (m/s)^m)", "range": [2, 4], "source": "fig. 3"},
    "m": 0.8,
    "valid": "abs(dT) < 30 and V < 12",
    "source": "a paper of 2020",
}


def with_formulas(building: Building) -> Building:
    """The same building with TARP and MoWiTT as text."""
    changes: dict[str, Any] = {}
    for name, surface in building.surfaces.items():
        for word, side in (("outside", surface.outside), ("inside", surface.inside)):
            law = {"tarp": TARP, "mowitt": MOWITT}.get(getattr(side.convection, "kind", ""))
            if law is not None:
                assert law is MOWITT or not side.outdoors
                number = {"value": float(side.convection.factor), "range": [0.4, 2.5]}  # type: ignore[union-attr]
                changes[f"surfaces.{name}.{word}.convection"] = {"formula": law, "f": number}
    assert len(changes) == 25
    return building.replace(changes)


@pytest.fixture(scope="module")
def cell() -> Study:
    return Study(STUDIES["lgi"])


def two_days(cell: Study, building: Building) -> Simulation:
    names = [output.name for output in building.outputs() if output.unit == "degC"]
    return Simulation(
        building, cell.climate, start="2010-09-20", end="2010-09-22", outputs=names,
        measurements=cell.measurements, initial=23.0,
    )  # fmt: skip


def box_with(law: Any) -> Building:
    return box().replace({OUTSIDE: law})


def box_run(building: Building, **options: Any) -> Simulation:
    return Simulation(
        building, box_climate(), step="1h", initial=20.0,
        outputs=["room.air_temperature", "facade.outside_temperature", "facade.outside_convection"],
        **options,
    )  # fmt: skip


def test_the_lgi_cell_with_its_laws_as_text_runs_as_with_the_built_in_ones(cell: Study) -> None:
    built_in, text = (two_days(cell, one).run() for one in (cell.building, with_formulas(cell.building)))
    assert np.abs(text.records - built_in.records).max() < 1e-9
    assert not [line for line in text.warnings if "valid" in line]


def test_derivatives_by_the_numbers_of_a_law_agree_with_differences() -> None:
    run = box_run(box_with(OWN))
    paths = [f"{OUTSIDE}.{name}" for name in "cnbm"]
    slopes = run.jacobian_vector(paths)[1]
    assert np.abs(slopes).max(axis=(1, 2)).min() > 1e-3
    for k, path in enumerate(paths):
        nudge = 1e-4 * run.building.parameter(path).value
        low, high = (
            run.jacobian_vector(paths, run.vector({path: run.building.parameter(path).value + sign * nudge}))[
                0
            ]
            for sign in (-1, 1)
        )
        quotient = (high - low) / (2.0 * nudge)
        assert np.abs(quotient - slopes[k]).max() < 1e-4 * np.abs(slopes[k]).max()


def test_members_of_a_sweep_have_the_bits_of_runs_alone() -> None:
    building = box_with(OWN)
    values = np.linspace(1.0, 4.0, 11)
    samples = {f"{OUTSIDE}.c": values, f"{OUTSIDE}.n": np.linspace(0.2, 0.4, 11)}
    options: dict[str, Any] = {"outputs": ["facade.outside_temperature"], "step": "1h", "initial": 20.0}
    found = sweep(building, box_climate(), samples, **options)["facade.outside_temperature"].to_numpy()
    for member in (0, 4, 10):
        one = building.with_values({path: column[member] for path, column in samples.items()})
        alone = mc.simulate(one, box_climate(), **options)
        assert np.array_equal(found[member], alone.records[:, 0])


def test_numbers_are_parameters_with_unit_range_limits_and_source() -> None:
    building = box_with(OWN)
    c, n, b, m = (building.parameter(f"{OUTSIDE}.{name}") for name in "cnbm")
    assert (c.unit, c.low, c.high, c.lower, c.upper, c.varies) == (
        "W/(m2 K^(1+n))",
        1.0,
        4.0,
        0.0,
        20.0,
        True,
    )
    assert (n.unit, m.varies, m.source) == ("-", False, "a paper of 2020")
    assert "give a range" in str(m.reason) or "width" in str(m.reason)
    assert b.source == "fig. 3"
    assert building.with_values({c.path: 3.0}).parameter(c.path).unit == c.unit
    with pytest.raises(InputError, match="at least 0 and at most 20"):
        building.with_values({c.path: 21.0})
    assert "a paper of 2020" in building.sources()
    assert Building.from_dict(building.to_dict()) == building
    assert building.to_dict()["surfaces"]["facade"]["outside"]["convection"]["c"]["unit"] == "W/(m2 K^(1+n))"


def test_shape_gives_length_and_perimeter() -> None:
    building = box_with({"formula": "2*(abs(dT)/length)^0.25 + 0.1*perimeter"})
    area = float(building.surfaces["facade"].area or 0.0)
    assert building.parameter(f"{OUTSIDE}.length").value == pytest.approx(area**0.5)
    assert building.parameter(f"{OUTSIDE}.perimeter").value == pytest.approx(4.0 * area**0.5)
    given = box_with({"formula": "2*(abs(dT)/length)^0.25", "length": 2.5})
    assert given.parameter(f"{OUTSIDE}.length").value == 2.5


def test_two_numbers_are_calibrated_on_data_made_by_the_law() -> None:
    building, climate = box_with(OWN), box_climate()
    truth = {f"{OUTSIDE}.c": 3.1, f"{OUTSIDE}.b": 2.4}
    output = "facade.outside_temperature"
    run = mc.simulate(building.with_values(truth), climate, step="1h", outputs=[output])
    noise = 0.002 * np.random.default_rng(3).normal(size=len(run.records))
    table = pd.DataFrame({"T": run.records[:, 0] + noise}, index=run.index)
    found = mc.calibrate(
        building, climate, mc.Measurements.from_table(table, timezone="UTC-07:00"), step="1h", warm_up="1d",
        sensors={output: Sensor("T", standard_uncertainty=0.002)}, vary=list(truth),
    )  # fmt: skip
    for k, (path, value) in enumerate(truth.items()):
        assert found.low[k] < value < found.high[k]
        assert found.values[path] == pytest.approx(value, rel=0.1)  # noqa: PD011


def test_a_sensitivity_names_the_numbers() -> None:
    found = mc.sensitivity_analysis(
        box_with(OWN), box_climate(), outputs=["facade.outside_temperature"], method="morris", step="1h",
        vary=[f"{OUTSIDE}.c", f"{OUTSIDE}.b"],
    )  # fmt: skip
    assert set(found.ranking("facade.outside_temperature", 2)) == {f"{OUTSIDE}.c", f"{OUTSIDE}.b"}


def test_a_co_simulation_unit_has_the_law(tmp_path: Path) -> None:
    run = box_run(box_with(OWN | {"valid": "abs(dT) < 2"}))
    export(run, tmp_path / "box.fmu", parameters=[f"{OUTSIDE}.c"])
    values = {f"{OUTSIDE}.c": 3.5}
    expected = run.run(values).records
    names = [output.name for output in run.outputs]
    with instance(tmp_path / "box.fmu") as unit:
        unit.start(**values)
        found = unit.run(names, 0, len(expected) - 1, 3600.0)
        unit.slave.terminate()
        assert any("law of convection does not hold" in text for _, text in unit.heard)
    assert np.abs(found - expected[1:]).max() < 1e-9


def test_a_run_outside_of_the_validity_warns() -> None:
    inside = box_run(box_with(OWN)).run()
    assert not [line for line in inside.warnings if "valid" in line]
    found = [
        line for line in box_run(box_with(OWN | {"valid": "abs(dT) < 2"})).run().warnings if "valid" in line
    ]
    assert len(found) == 1
    assert found[0].startswith("surface facade (outside)")
    differences = inside["facade.outside_temperature"].to_numpy()[1:]
    air = box_run(box_with(OWN)).weather("air_temperature")[1:]
    steps = int(np.sum(np.abs(differences - air) >= 2.0))
    assert f"at the end of {steps} steps" in found[0]


@pytest.mark.parametrize("count", [1, 2, 9, 20])
def test_members_outside_of_the_validity_are_counted(count: int) -> None:
    """Steps of each member, in lanes and alone, are those of a run of it."""
    simulation = box_run(box_with(OWN | {"valid": "abs(dT) < 4 and V < 12"}))
    path = "surfaces.facade.outside.absorptance"
    values = np.linspace(0.05, 0.95, count)
    run = simulation.ensemble(np.array([simulation.vector({path: value}) for value in values]))
    for value, steps in zip(values, run.beyond, strict=True):
        lines = [line for line in simulation.run({path: value}).warnings if "valid" in line]
        assert bool(lines) == bool(steps)
        assert all(f"at the end of {steps:.0f} step" in line for line in lines)
    if count == 20:
        assert run.beyond.min() == 0.0 < run.beyond.max()


def test_sweep_and_sensitivity_say_how_many_members_leave_the_validity() -> None:
    building = box_with(OWN | {"valid": "abs(dT) < 4 and V < 12"})
    path = "surfaces.facade.outside.absorptance"
    options: Any = {"step": "1h", "outputs": ["room.air_temperature"], "initial": 20.0}
    swept = mc.sweep(building, box_climate(), {path: [0.05, 0.5, 0.95]}, **options)
    assert any("members: a law written as text is outside of its 'valid'" in line for line in swept.warnings)
    analysis = mc.sensitivity_analysis(building, box_climate(), vary={path: (0.05, 0.95)}, **options)
    assert any(
        "members: a law written as text is outside of its 'valid'" in line for line in analysis.warnings
    )


def test_values_outside_of_the_ranges_are_checked() -> None:
    building = box_with({"formula": "8 + k*dT", "k": {"value": 0.01, "range": [0, 0.05]}})
    with pytest.raises(InputError, match=r"member 1\), with k = -0.5"):
        sweep(
            building,
            box_climate(),
            {f"{OUTSIDE}.k": [0.02, -0.5]},
            outputs=["room.air_temperature"],
            step="1h",
        )


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ('{formula: "c*abs(dT)^(1/3", c: 2}', r"file.yaml:%d:%d: surfaces.facade.outside.convection.formula"),
        ('{formula: "2*abs(dTT)"}', "name 'dTT' (column 7 of the text)"),
        ('{formula: "2,3*dT"}', "decimals with a point"),
        ('{formula: "c*abs(dT)^-0.5", c: 2}', "found: inf W/(m2 K) at dT = 0.000 K (column 10 of the text)"),
        ('{formula: "c*(62 - abs(dT))", c: 2}', "expected: a heat flow that rises with dT"),
        ('{formula: "3 + V*0", c: 2}', "the number 'c', which the formula does not use"),
        ('{formula: "2", valid: "abs(dT) < "}', "convection.valid"),
        ('{formula: "c", c: {value: 2, unit: 3}}', "Write the unit in quotes"),
        ('{formula: "c", c: {value: 2, limits: [3, 4]}}', "at least 3 and at most 4"),
        ('{formula: "c", c: two}', "convection.c"),
        ('{formula: "c", c: {value: 2, rnge: [1, 3]}}', "range"),
        ('{formula: "T*2"}', "Write Ts for the surface"),
        ('{formula: "3*dT", if: 2}', "'if' for a number"),
        ('{formula: "c + k*V", c: {value: 2, unit: "W/(m2 K)"}, k: {value: 3, unit: "m/s"}}', "beside"),
        ('{formula: "c", c: {value: 2, unit: "kW/(m2 K)"}}', "found: 'kW'"),
    ],
)
def test_faults_name_file_line_and_column(tmp_path: Path, law: str, words: str) -> None:
    text = (Path(mc.__file__).parent / "examples" / "box.yaml").read_text("utf-8")
    lines = text.splitlines()
    place = next(k for k, line in enumerate(lines) if re.search(r"convection: 1\d|convection: \d", line))
    before, _, after = lines[place].partition("convection: ")
    rest = re.sub(r"^[\d.]+", "", after)
    lines[place] = f"{before}convection: {law}{rest}"
    file = tmp_path / "file.yaml"
    file.write_text("\n".join(lines), "utf-8")
    with pytest.raises(InputError) as error:
        mc.load(file)
    if "%d" in words:
        column = len(before) + len('convection: {formula: "') + len("c*abs(dT)^(1/3") + 1
        words = words % (place + 1, column)
    assert words in str(error.value), str(error.value)


def test_wind_is_refused_where_there_is_none() -> None:
    with pytest.raises(InputError, match="No wind reaches this side"):
        box().replace({"surfaces.facade.inside.convection": {"formula": "2 + V"}})


def test_a_law_gives_its_coefficients() -> None:
    law = FormulaLaw(**OWN)
    assert law.coefficient([8.0, -8.0], 2.0) == pytest.approx(2.3 * 8.0**0.33 + 3.1 * 2.0**0.8)
    with pytest.raises(InputError, match="formula: column 1"):
        FormulaLaw(formula="dTT").coefficient(2.0)


BOARD = """\
name: board
site: {latitude: 48, longitude: 2, altitude: 100, timezone: UTC}
materials:
  wax: {kind: pcm, conductivity: 0.2, density: 850, specific_heat: [2000, 2200], latent_heat: 120000,
        melting_temperature: {value: 23.5, range: [22, 25]}, law: %s}
constructions: {wall: {layers: [{material: wax, thickness: 0.02}]}}
surfaces:
  w: {construction: wall, area: 1, tilt: 90, outside: {measured: air, convection: 20},
      inside: {adiabatic: true}}
"""
LOGISTIC = (
    '{formula: "1/(1 + exp(-2*(T - Tm)/w))", w: {value: 0.8, unit: K, range: [0.5, 1.2]}, '
    "range: [-18, 18], source: own}"
)


def board(law: str, folder: Path) -> Building:
    file = folder / "board.yaml"
    file.write_text(BOARD % law, "utf-8")
    return mc.load(file)


def melting(building: Building, **options: Any) -> Simulation:
    hours = np.arange(73)
    climate = setup.climate(3600.0, {"air": 23.0 + 6.0 * np.sin(hours * np.pi / 12.0)})
    outputs = ["w.inside_temperature", "w.outside_flux"]
    return Simulation(building, climate, step="15min", outputs=outputs, initial=20.0, **options)


def test_tanh_as_text_melts_as_the_built_in_law(tmp_path: Path) -> None:
    built_in, text = (melting(board(law, tmp_path)).run() for law in ("{kind: tanh, width: 0.8}", LOGISTIC))
    assert np.ptp(built_in["w.inside_temperature"].to_numpy()) > 3.0
    assert np.abs(text.records[:, 0] - built_in.records[:, 0]).max() < 1e-6
    assert text.energy.closes


def test_derivatives_of_a_melting_curve_as_text(tmp_path: Path) -> None:
    run = melting(board(LOGISTIC, tmp_path))
    paths = ["materials.wax.law.w", "materials.wax.melting_temperature"]
    slopes = run.jacobian_vector(paths)[1]
    for k, path in enumerate(paths):
        value = run.building.parameter(path).value
        low, high = (
            run.jacobian_vector(paths, run.vector({path: value + sign * 1e-5}))[0] for sign in (-1, 1)
        )
        quotient = (high - low) / 2e-5
        assert np.abs(slopes[k]).max() > 0.01
        assert np.abs(quotient - slopes[k]).max() < 1e-4 * np.abs(slopes[k]).max()


def test_members_of_a_sweep_of_a_melting_curve_have_the_bits_of_runs_alone(tmp_path: Path) -> None:
    building = board(LOGISTIC, tmp_path)
    run = melting(building)
    widths = np.linspace(0.5, 1.2, 9)
    vectors = np.array([run.vector({"materials.wax.law.w": width}) for width in widths])
    found = run.ensemble(vectors).records
    for member in (0, 5, 8):
        alone = run.run({"materials.wax.law.w": widths[member]}).records
        assert np.array_equal(found[member], alone)


def test_a_melting_curve_with_two_steps_and_hysteresis(tmp_path: Path) -> None:
    double = (
        '{formula: "s*(0.5 + 0.5*tanh((T - Tm + 2)/w)) + (1 - s)*(0.5 + 0.5*tanh((T - Tm - 2)/w))", s: 0.3, '
        "w: 0.3, range: [-6, 6]}"
    )
    frozen = double + ", hysteresis: {model: curve_switch, freezing_temperature: 22}"
    for text in (double, frozen):
        run = melting(board(text, tmp_path)).run()
        assert run.energy.closes
    law = board(double, tmp_path).materials["wax"].law  # type: ignore[union-attr]
    assert law.fraction(0.0) == pytest.approx(0.3, abs=1e-6)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ('{formula: "1/(1 + exp(-(T - Tm)/w))", w: 1, range: [-2, 2]}', "an end of the range"),
        ('{formula: "1/(1 + exp((T - Tm)/w))", w: 1, range: [-8, 8]}', "an end of the range"),
        (
            '{formula: "1/(1 + exp(-(T - Tm)/q))", w: 1, range: [-8, 8]}',
            "the name 'q' (column 22 of the text)",
        ),
        (
            '{formula: "1/(1 + exp(-(T - Tm)/w))", w: {value: 1, range: [0.2, 6]}, range: [-8, 8]}',
            "with w = 6",
        ),
        ('{formula: "1/(1 + exp(-(T - Tm)/w))", w: 1, range: [8, -8]}', "Swap them"),
        ('{formula: "1/(1 + exp(-(T - Tm)/w))", w: 1}', "Add 'range:'"),
    ],
)
def test_curves_that_are_none_are_refused(tmp_path: Path, law: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        board(law, tmp_path)
    assert words in str(error.value), str(error.value)
    assert "board.yaml:5" in str(error.value) or "board.yaml:4" in str(error.value)
