"""Paths with a star: tied parameters, and parameters written out one by one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building, load
from mascarin.building.parameters.ties import with_ties
from mascarin.ensemble import latin_hypercube
from mascarin.errors import InputError
from mascarin.examples import FOLDER, box, box_climate
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.simulation.simulation import Simulation
from mascarin.study import Study
from mascarin.weather import Measurements
from study_support import BUILDING, drivers, open_climate

LEAKAGE = "zones.*.infiltration.constant"
CONDUCTIVITY = "materials.*.conductivity"
#: Both conductivities are larger by this factor than described.
FACTOR = 1.25


@pytest.fixture(scope="module")
def cell() -> Building:
    return load(FOLDER / "lgi" / "building.yaml")


@pytest.fixture(scope="module")
def wall(tmp_path_factory: pytest.TempPathFactory) -> Building:
    path = tmp_path_factory.mktemp("wall") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return load(path)


def simulated(building: Building, **options: Any) -> Simulation:
    table = drivers(4)
    return Simulation(
        building,
        open_climate(table),
        step="30min",
        outputs=["wall.interface_1_temperature", "core.temperature"],
        measurements=Measurements.from_table(table, timezone="UTC+1"),
        **options,
    )


def study_of(wall: Building, parameters: dict[str, Any], **options: Any) -> Study:
    """A study of data from a wall whose conductivities are larger by `FACTOR`."""
    table = drivers(7)
    climate = open_climate(table)
    logger = Measurements.from_table(table, timezone="UTC+1")
    larger = ("materials.insulation.conductivity", "materials.brick.conductivity")
    true = wall.with_values({path: FACTOR * wall.parameter(path).value for path in larger})
    run = Simulation(
        true, climate, step="10min", outputs=["wall.interface_1_temperature"], measurements=logger
    ).run()
    noise = np.random.default_rng(3).normal(0.0, 0.02, len(run.records))
    table = table.assign(joint=(run.records[:, 0] + noise)[: len(table)])
    return Study(
        building=wall,
        climate=climate,
        measurements=Measurements.from_table(table, timezone="UTC+1"),
        sensors={
            "joint": {
                "column": "joint",
                "output": "wall.interface_1_temperature",
                "standard_uncertainty": 0.05,
            }
        },
        periods={"identification": ("2023-03-02", "2023-03-05")},
        parameters=parameters,
        step="10min",
        **options,
    )


def test_the_jacobian_of_a_factor_is_the_sum_over_its_members(wall: Building) -> None:
    simulation = simulated(with_ties(wall, {CONDUCTIVITY: "factor"}))
    members = [wall.parameter(f"materials.{name}.conductivity") for name in ("insulation", "brick")]
    vector = simulation.vector({CONDUCTIVITY: 1.1})
    for member in members:
        assert vector[simulation.position(member.path)] == pytest.approx(1.1 * member.value, rel=1e-15)
    assert simulation.value_in(vector, CONDUCTIVITY) == pytest.approx(1.1, rel=1e-15)
    _, slopes = simulation.jacobian_vector([CONDUCTIVITY, *(m.path for m in members)], vector)
    parts = sum(m.value * slopes[1 + k] for k, m in enumerate(members))
    np.testing.assert_allclose(slopes[0], parts, rtol=1e-12, atol=1e-12)
    step = 1e-4
    moved = simulation.varied([CONDUCTIVITY], np.array([[1.1 + step], [1.1 - step]]))
    records, _, _ = simulation.ensemble(moved)
    differences = (records[0] - records[1]) / (2.0 * step)
    assert np.abs(differences).max() > 0.1
    np.testing.assert_allclose(slopes[0], differences, atol=2e-4 * np.abs(differences).max())


def test_a_common_value_is_given_to_all(cell: Building) -> None:
    pattern = "surfaces.wall_*.outside.absorptance"
    paths = [p.path for p in cell.parameters() if p.path.startswith("surfaces.wall_")]
    walls = [path for path in paths if path.endswith("outside.absorptance")]
    equal = cell.with_values(dict.fromkeys(walls, 0.5))
    tied = with_ties(equal, {pattern: "value"})
    assert tied.parameter(pattern).value == 0.5
    assert tied.parameter(pattern).members == tuple(walls)
    changed = tied.with_values({pattern: 0.55})
    assert {changed.parameter(path).value for path in walls} == {0.55}
    with pytest.raises(InputError, match=r"expected equal values.*tie them by a factor"):
        with_ties(cell.with_values({walls[0]: 0.31}), {pattern: "value"})


def test_a_building_writes_and_reads_its_ties(cell: Building, tmp_path: Path) -> None:
    tied = with_ties(cell, {LEAKAGE: "factor"})
    tied.to_yaml(tmp_path / "cell.yaml")
    again = load(tmp_path / "cell.yaml")
    assert again.ties == {LEAKAGE: "factor"}
    assert again == tied
    room = "zones.room.infiltration.constant"
    assert again.parameter(room).reason == f"follows {LEAKAGE}"
    before = cell.parameter(room).value
    assert again.with_values({LEAKAGE: 3.0}).parameter(room).value == pytest.approx(3.0 * before)


def test_limits_of_a_factor_keep_all_members_possible(cell: Building) -> None:
    pattern = "surfaces.wall_*.outside.absorptance"
    tied = with_ties(cell, {pattern: "factor"})
    highest = tied.parameter(pattern).upper
    values = [cell.parameter(path).value for path in tied.parameter(pattern).members]
    assert max(highest * value for value in values) == pytest.approx(1.0)
    assert all(highest * value <= 1.0 for value in values)


def test_a_pattern_that_matches_nothing_names_the_nearest(cell: Building, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"Did you mean 'zones\.\*\.infiltration\.constant'"):
        with_ties(cell, {"zones.*.infiltraton.constant": "factor"})
    file = tmp_path / "cell.yaml"
    file.write_text(cell.to_yaml() + "ties:\n  zones.*.leakage: factor\n", encoding="utf-8")
    line = len(file.read_text(encoding="utf-8").splitlines())
    with pytest.raises(InputError, match=rf"cell.yaml:{line}: ties.zones.\*.leakage"):
        load(file)


@pytest.mark.parametrize(
    ("pattern", "how", "says"),
    [
        ("site.*", "factor", "site.latitude, which is structural"),
        ("zones.*.volume", "value", "expected equal values"),
        ("materials.*.melting_temperature", "factor", "a temperature in degC"),
    ],
)
def test_numbers_that_cannot_be_tied(cell: Building, pattern: str, how: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        with_ties(cell, {pattern: how})


def test_a_number_is_in_one_tie_only(cell: Building) -> None:
    with pytest.raises(InputError, match="expected each number once"):
        with_ties(cell, {LEAKAGE: "factor", "zones.room.infiltration.*": "factor"})


def test_sensitivity_and_samples_vary_a_tie_as_one(cell: Building) -> None:
    tied = with_ties(cell, {LEAKAGE: "factor"})
    factors = factors_of(tied, only=[LEAKAGE])
    assert [factor.path for factor in factors] == [LEAKAGE]
    assert not {f.path for f in factors_of(tied)} & set(tied.parameter(LEAKAGE).members)
    alone = factors_of(cell, only=[LEAKAGE], ranges={LEAKAGE: (0.1, 0.2)})
    assert {(f.path, f.low, f.high) for f in alone} == {
        ("zones.room.infiltration.constant", 0.1, 0.2),
        ("zones.air_gap.infiltration.constant", 0.1, 0.2),
    }
    drawn = latin_hypercube(tied, 3, seed=1)
    assert LEAKAGE in drawn
    assert not set(drawn) & set(tied.parameter(LEAKAGE).members)


def test_a_sweep_gives_a_tied_value_to_all_members() -> None:
    building = with_ties(box(), {"materials.*.density": "factor"})
    samples = {"materials.*.density": [0.5, 1.0]}
    options: dict[str, Any] = {"outputs": ["room.air_temperature"], "step": "1h", "end": None}
    tied = mc.sweep(building, box_climate(), samples, **options)["room.air_temperature"]
    density = box().parameter("materials.concrete.density").value
    plain = mc.sweep(
        box(), box_climate(), {"materials.concrete.density": [0.5 * density, density]}, **options
    )["room.air_temperature"]
    np.testing.assert_array_equal(tied, plain)


def test_a_study_estimates_the_factor_of_a_tie(wall: Building) -> None:
    study = study_of(wall, {CONDUCTIVITY: {"tie": True, "low": 0.6, "high": 1.6}})
    results = study.run()
    fit = results.calibration
    assert fit.problem.paths == (CONDUCTIVITY,)
    assert fit.values[CONDUCTIVITY] == pytest.approx(FACTOR, abs=0.02)
    assert fit.low[0] < FACTOR < fit.high[0]
    brick = "materials.brick.conductivity"
    found = fit.building.parameter(brick).value
    assert found == pytest.approx(fit.values[CONDUCTIVITY] * wall.parameter(brick).value)
    assert results.to_dict()["parameters"][CONDUCTIVITY]["nominal"] == 1.0


@pytest.mark.parametrize(
    ("area", "low", "high"), [(0.004, 15.0, 15.2), (4.0, 17.0, 23.0), (4000.0, 24.8, 25.0)]
)
def test_a_tied_convection_law_has_one_mean_coefficient(
    wall: Building, area: float, low: float, high: float
) -> None:
    """Of two walls with 15 and 25 W/(m2 K), by the heat that they exchange: by their areas, too."""
    one = wall.to_dict()["surfaces"]["wall"]
    other = {**one, "area": area, "outside": {**one["outside"], "convection": 25.0}}
    both = wall.replace({"surfaces.other": other})
    factor = "surfaces.*.outside.convection.coefficient"
    results = study_of(both, {factor: {"tie": "factor", "low": 0.5, "high": 2.0}}).run()
    models = results.to_dict()["coefficients"]["models"]
    nominal, fitted = (models[name]["surfaces.*.outside.convection"] for name in ("nominal", "fitted"))
    assert low < nominal < high
    assert fitted / nominal == pytest.approx(results.calibration.values[factor], rel=0.02)


def test_exact_slopes_of_a_tie_agree_with_differences(wall: Building) -> None:
    problem = study_of(wall, {CONDUCTIVITY: {"tie": True, "low": 0.6, "high": 1.6}}).context.problem()
    step, x = 1e-4, np.array([1.1])
    residuals = problem.residuals(np.array([x + step, x - step]))
    differences = (residuals[0] - residuals[1]) / (2.0 * step)
    np.testing.assert_allclose(
        problem.jacobian(x)[:, :, 0], differences, atol=2e-4 * np.abs(differences).max()
    )


def test_a_pattern_without_a_tie_stands_for_each(wall: Building) -> None:
    study = study_of(wall, {CONDUCTIVITY: None, "materials.brick.conductivity": {"low": 0.4, "high": 1.0}})
    sought = study.context.inputs.calibration_plan.parameters
    assert list(sought) == ["materials.insulation.conductivity", "materials.brick.conductivity"]
    assert sought["materials.brick.conductivity"].low == 0.4  # type: ignore[union-attr]


def test_a_study_refuses_patterns_by_line(wall: Building) -> None:
    with pytest.raises(InputError, match=r"identification\.parameters.*found nothing in the building"):
        study_of(wall, {"materials.*.conductivty": None})
    with pytest.raises(InputError, match="found a tie of one number"):
        study_of(wall, {"materials.brick.conductivity": {"tie": True}})


def test_a_study_varies_only_what_it_names(wall: Building) -> None:
    study = study_of(
        wall,
        {CONDUCTIVITY: {"tie": "factor"}},
        sensitivity={"only": [CONDUCTIVITY, "surfaces.*.outside.absorptance"], "replicates": 3},
    )
    found = study.run().sensitivity
    assert found is not None
    assert set(found.names) == {CONDUCTIVITY, "surfaces.wall.outside.absorptance"}


def test_parts_are_replaced_by_pattern(cell: Building) -> None:
    changed = cell.replace({"surfaces.wall_*.outside.convection": "tarp"})
    kinds = {n: s.outside.convection.kind for n, s in changed.surfaces.items() if s.outside.convection}
    assert {kinds[n] for n in kinds if n.startswith("wall_")} == {"tarp"}
    assert kinds["roof"] == cell.surfaces["roof"].outside.convection.kind  # type: ignore[union-attr]
