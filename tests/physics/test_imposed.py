"""Temperatures that surroundings impose on a side: soil at a depth."""

from __future__ import annotations

import math

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.physics import imposed_temperature

SOIL = {"mean": 12.0, "amplitude": 10.0, "depth": 1.5, "diffusivity": 6e-7, "coldest_day": 30.0}


def box_on(side: dict[str, object]) -> Building:
    tree = box().to_dict()
    tree["surfaces"]["facade"]["outside"] = side
    return Building.from_dict(tree)


def test_soil_is_the_wave_of_a_half_infinite_solid() -> None:
    x = 1.5 * math.sqrt(math.pi / (365.0 * 86400.0 * 6e-7))
    for day in (1.0, 100.0, 250.0):
        wave = 10.0 * math.exp(-x) * math.cos(2.0 * math.pi * (day - 30.0) / 365.0 - x)
        assert imposed_temperature("soil", SOIL, day, 0.0) == pytest.approx(12.0 - wave, abs=1e-12)
    with pytest.raises(InputError, match="soil"):
        imposed_temperature("soil", {"mean": 12.0}, 1.0, 0.0)


def test_soil_at_the_surface_of_the_ground_is_the_ground() -> None:
    """At depth zero, of a side with its temperature and of the ends of a run: the same as ``ground``."""
    names = ["room.air_temperature", "facade.outside_temperature"]
    ground = {key: SOIL[key] for key in ("mean", "amplitude", "coldest_day")}
    sides = ({"imposed": {"kind": "soil", **SOIL, "depth": 0.0}}, {"ground": ground})
    one, other = (
        mc.simulate(box_on(dict(side)), box_climate(), step="1h", initial=20.0, outputs=names).records
        for side in sides
    )
    assert np.abs(one - other).max() < 1e-9


def test_a_description_of_soil_survives_and_is_checked() -> None:
    building = box_on({"imposed": {"kind": "soil", **SOIL}})
    assert Building.from_dict(building.to_dict()) == building
    assert building.parameter("surfaces.facade.outside.imposed.depth").unit == "m"
    with pytest.raises(InputError, match="diffusivity"):
        box_on({"imposed": {"kind": "soil", **SOIL, "diffusivity": -1.0}})
    with pytest.raises(InputError, match="convection"):
        box_on({"imposed": {"kind": "soil", **SOIL}, "convection": "mowitt"})
