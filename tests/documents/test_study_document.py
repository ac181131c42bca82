"""Parts of ``study.json`` from results that are made here."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pandas as pd
import pytest

from mascarin.building import load
from mascarin.examples import STUDIES
from mascarin.sensitivity import Factor
from mascarin.sensitivity.spectral import analyze, design
from mascarin.simulation import Simulation
from mascarin.study.context.context import StudyContext
from mascarin.study.context.phase_change import melting_layers
from mascarin.study.results.document.phase_change import phase_change
from mascarin.study.results.document.sensitivity import importance
from mascarin.study.steps.findings import ModelRun
from mascarin.weather import Climate, Measurements


def test_frequencies_are_those_of_the_groups() -> None:
    factors = [
        Factor("a", 0.0, 1.0, group="walls"),
        Factor("b", 0.0, 1.0, group="walls"),
        Factor("c", 0.0, 1.0),
        Factor("d", 0.0, 1.0),
    ]
    plan = design(factors, seed=3)
    x = plan.all_samples()
    # Each output depends on one group only, so that its strongest line is the frequency of that group.
    results = {"of_walls": x[:, 0] + x[:, 1], "of_c": x[:, 2], "of_d": x[:, 3]}
    found = {name: analyze(plan, y, names=[name]) for name, y in results.items()}
    days = (pd.Timestamp("2023-03-01", tz="UTC"), pd.Timestamp("2023-03-02", tz="UTC"))
    study = cast("StudyContext", SimpleNamespace(periods=SimpleNamespace(identification=days)))
    for output, group in (("of_walls", "walls"), ("of_c", "c"), ("of_d", "d")):
        content = importance(study, found[output])
        power = content["spectra"][output]["power"]
        strongest = content["spectra"][output]["frequencies"][power.index(max(power))]
        assert list(content["frequencies"]) == ["walls", "c", "d"]
        assert content["frequencies"][group] == strongest


def test_the_states_of_a_phase_change_layer_are_those_of_the_run() -> None:
    cell = load(STUDIES["lgi"].with_name("building.yaml"))
    table = STUDIES["lgi"].with_name("lgi_virtual.csv")
    columns = ("relative_humidity", "wind_speed", "wind_direction", "pressure", "global_horizontal")
    climate = Climate.from_table(
        table,
        timezone="UTC+4",
        columns={"air_temperature": "outdoor_air", "diffuse_horizontal": "diffuse_horizontal"}
        | {name: name for name in columns},
        latitude=-21.34,
        longitude=55.48,
        altitude=55.0,
    )
    (layer,) = melting_layers(cell)
    simulation = Simulation(
        cell,
        climate,
        start="2010-08-10",
        end="2010-08-14",
        step="1h",
        outputs=list(layer.outputs),
        initial=23.4,
        measurements=Measurements.from_table(table, timezone="UTC+4", columns=["slab_underside"]),
    )
    run = cast("ModelRun", SimpleNamespace(simulation=simulation, results=simulation.run()))
    compared_from = run.results.index[0] + pd.Timedelta(days=1)
    study = cast("StudyContext", SimpleNamespace(periods=SimpleNamespace(compared_from=compared_from)))
    (found,) = phase_change(study, run)
    assert found["label"] == "ceiling: energain"
    fraction = run.results[layer.liquid_fraction].to_numpy()
    rows = dict(found["rows"])
    assert float(rows["liquid fraction at the start"]) == pytest.approx(fraction[0], abs=5e-4)
    assert float(rows["smallest liquid fraction"]) == pytest.approx(fraction.min(), abs=5e-4)
    assert float(rows["mean liquid fraction"]) == pytest.approx(fraction.mean(), abs=5e-4)
    # Three days remain after the first, which is not compared.
    assert {day["label"].split(", ")[0] for day in found["days"]} == {
        "coldest", "warmest", "largest change of enthalpy",
    }  # fmt: skip
    assert all(len(day["enthalpy"]) == 24 for day in found["days"])
    spread = {day["label"].split(",")[0]: np.ptp(day["enthalpy"]) for day in found["days"]}
    assert spread["largest change of enthalpy"] == max(spread.values())
    assert float(rows["largest change of enthalpy within a day"].split()[0]) == pytest.approx(
        max(spread.values()), abs=0.6
    )
    mean = {day["label"].split(",")[0]: np.mean(day["enthalpy"]) for day in found["days"]}
    assert mean["coldest"] < mean["warmest"]
    # The material has no hysteresis: every state of the layer is on its law, but for the mean over the layer.
    law = np.interp(found["temperature"], found["law_temperature"], found["law_enthalpy"])
    assert np.abs(law - found["enthalpy"]).max() < 0.1 * np.ptp(found["law_enthalpy"])
