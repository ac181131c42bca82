"""Set points of heating and cooling in one zone: equal ones are one parameter, and ranges do not cross."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.ensemble.draw import latin_hypercube
from mascarin.examples import box_climate
from mascarin.sensitivity import factors_of
from mascarin.simulation.unused_parameters import inactive_parameters

HEATING, COOLING = (f"zones.room.{which}.setpoint.temperature" for which in ("heating", "cooling"))


def room(heating: Any = 20, cooling: Any = 20) -> mc.Building:
    """A heated and cooled room."""
    films = {"convection": 3, "emissivity": 0.9}
    return mc.Building.from_dict(
        {
            "name": "Room",
            "site": {"latitude": 47.9, "longitude": 11.7, "altitude": 680, "timezone": "UTC+1"},
            "materials": {"concrete": {"conductivity": 1.75, "density": 2400, "specific_heat": 880}},
            "constructions": {"wall": {"layers": [{"material": "concrete", "thickness": 0.2}]}},
            "zones": {
                "room": {
                    "volume": 27, "infiltration": 0.5, "heating": {"setpoint": heating},
                    "cooling": {"setpoint": cooling},
                }
            },
            "surfaces": {
                "facade": {
                    "construction": "wall", "area": 54, "tilt": 90, "azimuth": 180,
                    "outside": {"outdoors": True, "convection": 20, "emissivity": 0.9, "absorptance": 0.6},
                    "inside": {"zone": "room", **films},
                }
            },
        }
    )  # fmt: skip


def test_equal_set_points_are_one_factor() -> None:
    paths = [factor.path for factor in factors_of(room())]
    assert HEATING in paths
    assert COOLING not in paths
    assert {HEATING, COOLING} <= {factor.path for factor in factors_of(room(cooling=26))}


def test_either_path_stands_for_both_when_it_varies_alone() -> None:
    run = mc.Simulation(room(), box_climate(), step="1h", initial=20.0)
    for path in (HEATING, COOLING):
        vectors = run.varied([path], np.array([[19.0], [21.0]]))
        for other in (HEATING, COOLING):
            assert vectors[:, run.position(other)].tolist() == [19.0, 21.0]


def test_a_held_temperature_depends_on_its_set_point() -> None:
    found = mc.sensitivity_analysis(
        room(), box_climate(), outputs=["room.air_temperature"], method="morris", step="1h", initial=20.0,
        start=box_climate().index[24], vary={HEATING: (19.0, 21.0), "materials.concrete.density": None},
    )  # fmt: skip
    assert found.ranking("room.air_temperature", 1) == [HEATING]


def test_the_default_sensitivity_of_equal_set_points_runs() -> None:
    found = mc.sensitivity_analysis(
        room(), box_climate(), outputs=["room.air_temperature"], method="morris", step="1h", initial=20.0
    )
    assert HEATING in found.ranking("room.air_temperature", 30)


def test_drawn_members_keep_equal_set_points_equal() -> None:
    drawn = latin_hypercube(room(), 20, seed=1)
    pd.testing.assert_series_equal(drawn[HEATING], drawn[COOLING], check_names=False)
    assert drawn[HEATING].between(19.0, 21.0).all()


def test_parameters_without_effect_are_found_for_equal_set_points() -> None:
    assert HEATING not in inactive_parameters(room(), box_climate(), step="1h")


def test_default_ranges_end_between_the_set_points() -> None:
    building = room(20, 21)
    assert (building.parameter(HEATING).low, building.parameter(HEATING).high) == (19.0, 20.5)
    assert (building.parameter(COOLING).low, building.parameter(COOLING).high) == (20.5, 22.0)
    far = room(20, 26)
    assert (far.parameter(HEATING).high, far.parameter(COOLING).low) == (21.0, 25.0)


def test_a_given_range_stays_and_the_other_one_begins_where_it_ends() -> None:
    building = room({"temperature": {"value": 20, "range": [18, 20.8]}}, 21)
    assert (building.parameter(HEATING).low, building.parameter(HEATING).high) == (18.0, 20.8)
    assert building.parameter(COOLING).low == pytest.approx(20.8)


def test_replacing_one_set_point_changes_nothing_else() -> None:
    building = room().replace({COOLING: 26})
    assert building.parameter(HEATING).value == 20.0
    assert building.parameter(COOLING).value == 26.0


def test_a_fit_of_the_heating_set_point_moves_both() -> None:
    climate = box_climate()
    truth = room(21, 21)
    run = mc.Simulation(truth, climate, step="1h", initial=20.0, outputs=["room.air_temperature"])
    table = run.run().to_dataframe()[["room.air_temperature"]].rename(columns={"room.air_temperature": "T"})
    table = table.iloc[1:] + 0.1 * np.random.default_rng(1).standard_normal((len(table) - 1, 1))
    measured = mc.Measurements.from_table(table)
    found = mc.calibrate(
        room(), climate, measured, sensors={"room.air_temperature": "T"}, vary={HEATING: (18.0, 23.0)},
        step="1h", initial=20.0, warm_up="1h",
    )  # fmt: skip
    assert found.building.parameter(HEATING).value == pytest.approx(
        float(table.iloc[1:].mean().iloc[0]), abs=0.02
    )
    assert found.building.parameter(COOLING).value == found.building.parameter(HEATING).value
