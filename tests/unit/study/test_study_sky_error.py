"""Errors of a modelled sky in the bands of a study, against the balance of a surface in closed form."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building.reading import parse
from mascarin.physics import KELVIN, STEFAN_BOLTZMANN
from mascarin.study.steps import sky_error
from mascarin.study.steps.sky_error import CALIBRATED, PUBLISHED, sky_effect

SHEET = """
site: {latitude: 28, longitude: -82.5, altitude: 6, timezone: UTC-5, sky: SKY, cloud: {c1: 0, c2: 0, c3: 0}}
materials: {steel: {conductivity: 50, density: 7800, specific_heat: 450}}
constructions: {sheet: {layers: [{material: steel, thickness: 0.0005}]}}
surfaces:
  roof:
    construction: sheet
    area: 10
    tilt: 0
    outside: {outdoors: true, convection: 12, emissivity: 0.9, absorptance: 0.7}
    inside: {adiabatic: true}
"""


def effect_of(sky: str, calibrated: list[str], monkeypatch: pytest.MonkeyPatch) -> tuple[Any, Any]:
    """Effect on a sheet that is insulated below, and its temperatures. [K], [degC]"""
    building = parse(SHEET.replace("SKY", sky), "roof.yaml")
    simulation = mc.Simulation(
        building,
        mc.Climate.shipped("tampa"),
        start="2001-06-01",
        end="2001-06-08",
        outputs=["roof.outside_temperature"],
        step="15min",
    )

    def series(study: Any, run: Any, vectors: Any) -> Any:
        return np.array([run.run_vector(vector).records for vector in vectors])

    monkeypatch.setattr(sky_error, "kept_series", series)
    base = simulation.vector({})
    effect = sky_effect(SimpleNamespace(), simulation, base, calibrated)  # type: ignore[arg-type]
    return effect, simulation.run_vector(base).records


@pytest.mark.parametrize(
    ("sky", "calibrated", "error"),
    [
        ("martin_berdahl", [], PUBLISHED),
        ("brunt", ["materials.steel.density"], PUBLISHED),
        ("clark_allen", ["site.sky.a"], CALIBRATED),
        ("{kind: offset, depression: 11}", ["site.sky.depression"], CALIBRATED),
    ],
)
def test_the_effect_is_that_of_so_much_infrared_radiation(
    sky: str, calibrated: list[str], error: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    effect, temperature = effect_of(sky, calibrated, monkeypatch)
    # A sheet without mass: absorbed radiation over the sum of both coefficients.
    coefficient = 12.0 + 4.0 * 0.9 * STEFAN_BOLTZMANN * (temperature + KELVIN) ** 3
    expected = 0.9 * error / coefficient
    assert np.mean(effect[96:]) == pytest.approx(np.mean(expected[96:]), rel=0.05)


def test_a_measured_sky_has_no_such_error(monkeypatch: pytest.MonkeyPatch) -> None:
    effect, _ = effect_of("measured", [], monkeypatch)
    assert effect is None
