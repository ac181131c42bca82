"""Values held at a limit count as inside of it: one rule for comfort, criteria, objectives and quality."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin._io import limits
from mascarin.building.reading import parse
from mascarin.comfort import INDICES, ComfortSettings, Conditions
from mascarin.comfort.assessment import assess
from mascarin.comfort.evaluation import Evaluation, discomfort
from mascarin.design.evaluation.reductions import Beyond, CycleDays, DaysInBin
from mascarin.ensemble.objectives import Statistic
from mascarin.examples import box_climate
from mascarin.physics import humidity_ratio, relative_humidity
from mascarin.validation.comparison import compare
from mascarin.validation.criteria import Criterion, judge
from mascarin.verification.bestest.quantities import COLDEST_BIN, bins

PACKAGE = Path(mc.__file__).parent


def around(limit: float) -> np.ndarray:
    """A limit, and its neighbours of one and ten units in the last place."""
    ulp = np.spacing(limit)
    return np.asarray(limit + ulp * np.array([0.0, -1.0, 1.0, -10.0, 10.0]))


def held(air: np.ndarray, **more: object) -> Conditions:
    return Conditions(air, air, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize("limit", [-5.0, 0.1, 20.0, 26.0, 32.2])
def test_the_rule(limit: float) -> None:
    values = around(limit)
    assert not limits.above(values, limit).any()
    assert not limits.below(values, limit).any()
    assert limits.at_most(values, limit).all()
    assert limits.at_least(values, limit).all()
    assert not limits.excess(values, limit).any()
    assert not limits.shortfall(values, limit).any()
    apart = np.array([limit - 2e-6, limit + 2e-6])
    assert limits.below(apart, limit).tolist() == limits.above(apart, limit).tolist()[::-1] == [True, False]
    assert limits.excess(apart, limit) == pytest.approx([0.0, 2e-6], rel=1e-6)
    assert limits.shortfall(apart, limit) == pytest.approx([2e-6, 0.0], rel=1e-6)
    nan = np.array([np.nan])
    for rule in (limits.above, limits.below, limits.at_most, limits.at_least):
        assert not rule(nan, limit).any()


def test_a_room_held_at_the_limits_is_comfortable() -> None:
    for limit in (20.0, 26.0):
        hours = discomfort(Evaluation(around(limit), 20.0, 26.0), np.ones(5))
        assert (float(hours.hours), float(hours.degree_hours)) == (0.0, 0.0)
    far = discomfort(Evaluation(np.array([19.99, 26.01]), 20.0, 26.0), np.ones(2))
    assert (float(far.hot_hours), float(far.cold_hours)) == (1.0, 1.0)


@pytest.mark.parametrize(
    ("index", "low", "high"), [("adaptive-en", 10.0, 30.0), ("adaptive-ashrae", 10.0, 33.5)]
)
def test_an_adaptive_model_is_valid_at_the_ends_of_its_range(index: str, low: float, high: float) -> None:
    for end in (low, high):
        conditions = held(np.full(5, 24.0), running_mean=around(end), prevailing_mean=around(end))
        assert not np.isnan(INDICES[index].evaluate(conditions).values).any()
    beyond = held(np.full(2, 24.0), running_mean=np.array([low - 1e-3, high + 1e-3]),
                  prevailing_mean=np.array([low - 1e-3, high + 1e-3]))  # fmt: skip
    assert np.isnan(INDICES[index].evaluate(beyond).values).all()


@pytest.mark.parametrize(("mean", "category"), [(15.0, "II"), (21.0, "I"), (27.3, "III")])
def test_a_room_held_at_the_limits_of_en_16798_is_comfortable(mean: float, category: str) -> None:
    index = INDICES["adaptive-en"]
    ends = index.evaluate(held(np.array([24.0]), running_mean=mean), category)
    for end in (float(ends.low), float(np.asarray(ends.high).item())):
        evaluation = index.evaluate(held(around(end), running_mean=mean), category)
        assert not evaluation.excess.any()


def test_the_air_speed_of_the_standards_raises_the_limit_though_its_last_bit_is_missing() -> None:
    highs = (
        INDICES["adaptive-en"].evaluate(held(np.full(5, 28.0), running_mean=20.0, air_speed=around(0.6))).high
    )
    assert np.unique(highs).size == 1


@pytest.mark.parametrize("name", ["pmv", "set", "heat-index", "utci"])
def test_an_index_is_valid_at_the_ends_of_its_ranges(name: str) -> None:
    pytest.importorskip("pythermalcomfort")
    from mascarin.comfort import heat_balance

    ranges = getattr(heat_balance, {"pmv": "_PMV", "set": "_SET", "utci": "_UTCI"}.get(name, "_HEAT_INDEX"))
    index, limits_used = INDICES[name], (10.0, 20.0)
    _, low, high, _ = ranges["air"]
    for end in (low, high):
        radiant = np.full(5, min(max(end, -10.0), 30.0))
        conditions = Conditions(around(end), radiant, 45.0, air_speed=0.9)
        evaluation = index.evaluate(conditions, None if index.categories else limits_used)
        where = evaluation.outside[f"air temperature {'below' if end == low else 'above'} {end:g} degC"]
        assert not where.any()


def test_air_held_at_the_corners_of_givonis_zone_is_comfortable() -> None:
    givoni = INDICES["givoni"]
    humid = relative_humidity(24.0, around(4.0) / 1000.0, 101325.0)
    dry = givoni.evaluate(held(np.full(5, 24.0), relative_humidity=humid))
    assert not np.isnan(dry.values).any()
    wet = givoni.evaluate(held(np.full(5, 22.0), relative_humidity=around(80.0)))
    assert wet.too_humid is not None
    assert not wet.too_humid.any()
    ratio = float(humidity_ratio(29.0, 50.0))
    hot = givoni.evaluate(
        Conditions(around(29.0), around(29.0), relative_humidity(around(29.0), ratio, 101325.0))
    )
    assert not hot.excess.any()


def test_a_room_held_at_a_set_point_is_not_beyond_it() -> None:
    text = """
name: held
site: {latitude: 40, longitude: 0, altitude: 0, timezone: UTC+0}
materials: {board: {conductivity: 0.2, density: 800, specific_heat: 1000}}
constructions: {wall: {layers: [{material: board, thickness: 0.05}]}}
zones: {room: {volume: 30, heating: {setpoint: 20.1}, cooling: {setpoint: 26.3}}}
surfaces:
  wall: {construction: wall, area: 60, tilt: 90, azimuth: 180,
         inside: {zone: room, convection: 3, emissivity: 0.9},
         outside: {outdoors: true, convection: 15, absorptance: 0.6, emissivity: 0.9}}
"""
    outputs = ["room.air_temperature", "room.heating_load"]
    climate = box_climate()
    run = mc.simulate(parse(text, "held.yaml"), climate, outputs=outputs, step="30min")
    air, load = run.records.T
    assert (load[1:] > 0.0).any()
    series = run.to_xarray().expand_dims("member")
    below = float(Statistic.read("below:20.1:room.air_temperature")(series)[0])
    above = float(Statistic.read("above:26.3:room.air_temperature")(series)[0])
    assert (below, above) == (0.0, 0.0)
    assert air[1:].min() == pytest.approx(20.1, abs=1e-9)


def days(values: np.ndarray) -> object:
    import xarray as xr

    time = pd.date_range("2024-01-01", periods=values.shape[1], freq="1h")
    return xr.Dataset(
        {"a": (("member", "time"), values)}, coords={"time": time, "local_time": ("time", time)}
    )


def test_objectives_of_designs_count_a_value_at_the_limit_as_inside() -> None:
    run = days(np.tile(around(26.0), (1, 5)))
    for weighted in (True, False):
        for above in (True, False):
            assert Beyond(("a",), 26.0, above=above, weighted=weighted)(run)[0] == 0.0  # type: ignore[arg-type]
    for change in (0.3, 0.29999999999999993):
        run = days(np.tile(np.linspace(0.0, change, 25), (1, 1)))
        assert CycleDays("a", 0.3)(run)[0] == 1.0  # type: ignore[arg-type]
        assert DaysInBin("a", 3)(run)[0] == 1.0  # type: ignore[arg-type]


def test_a_criterion_is_met_by_a_metric_at_its_limit() -> None:
    for error in [*around(0.3), 20.3 - 20.0]:
        metrics = {"a": {"p": compare([0.0, 1.0], [0.0, 1.0 + error])}}
        assert judge([Criterion(metric="max_error", limit=0.3)], metrics)[0].passed
    apart = {"a": {"p": compare([0.0, 1.0], [0.0, 1.3001])}}
    assert not judge([Criterion(metric="max_error", limit=0.3)], apart)[0].passed


def test_bins_of_standard_140_take_a_temperature_that_is_held() -> None:
    counts = bins(around(20.0))
    assert counts[20 - COLDEST_BIN] == 5.0


def test_values_at_the_ends_of_the_possible_range_are_no_defect() -> None:
    from mascarin.tables.quality.defects import _out_of_range

    assert _out_of_range(around(100.0), (0.0, 100.0)) == []
    assert _out_of_range(np.array([101.0]), (0.0, 100.0)) != []


def test_settings_of_comfort_give_the_same_hours_for_rounded_series() -> None:
    times = pd.date_range("2001-07-01", periods=5, freq="1h", tz="UTC")
    settings = ComfortSettings(index="operative", band=[20, 26])
    for limit in (20.0, 26.0):
        comfort = assess("room", settings, times, around(limit), around(limit))
        assert comfort.hours == comfort.degree_hours == 0.0


#: Modules in which every comparison of a size is with a limit, and what else is compared there.
RATED = {
    "comfort/adaptive.py": {"len(temperatures) >= count"},
    "comfort/givoni.py": set(),
    "comfort/heat_balance.py": set(),
    "comfort/evaluation.py": {"above > 0.0", "beyond > 0.0", "beyond < 0.0"},
    "ensemble/objectives.py": set(),
}


@pytest.mark.parametrize("name", RATED)
def test_no_index_is_compared_with_a_limit_without_the_rule(name: str) -> None:
    tree = ast.parse((PACKAGE / name).read_text(encoding="utf-8"))
    sizes = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
    places = {
        ast.unparse(node)
        for node in ast.walk(tree)
        if isinstance(node, ast.Compare) and any(isinstance(op, sizes) for op in node.ops)
    }
    assert places == RATED[name]
