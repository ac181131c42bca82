"""Phase-change layers in a study: the law's curve in closed form, and where a run was."""

from __future__ import annotations

import numpy as np
import pytest

from mascarin.building import load
from mascarin.building.gamma import peak_capacity
from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, solve
from mascarin.examples import STUDIES
from mascarin.simulation.simulation import Simulation
from mascarin.study.context.phase_change import law_curve, melting_layers, path
from mascarin.study.steps.derived_quantities import latent_heat_used
from mascarin.weather import Climate, Measurements

CELL = load(STUDIES["lgi"].with_name("building.yaml"))
TABLE = STUDIES["lgi"].with_name("lgi_virtual.csv")


def test_the_curve_holds_the_latent_heat_and_the_peak_of_the_law() -> None:
    (layer,) = melting_layers(CELL)
    assert (layer.surface, layer.layer, layer.material) == ("ceiling", "energain", "energain")
    assert layer.surfaces == ("ceiling.outside_temperature", "ceiling.interface_1_temperature")
    curve = law_curve(layer.of(CELL), 23.4 - 8.0, 23.4 + 8.0)
    assert curve is not None
    temperature, enthalpy = curve
    # From wholly solid to wholly liquid: 8 K of the one, the latent heat, 8 K of the other.
    assert enthalpy[-1] - enthalpy[0] == pytest.approx(8 * 3.134 + 71.0 + 8 * 2.833, rel=1e-6)
    # The specific heat in the middle; width 1 K is gamma 0.04 with a step of 0.01 K.
    peak = np.gradient(enthalpy, temperature, edge_order=2).max() * 1000.0
    assert peak == pytest.approx(peak_capacity(0.04, (3134.0, 2833.0), 71000.0, 0.01), rel=0.01)


def test_a_layer_at_one_temperature_is_on_its_law() -> None:
    """At the start of a run all has one temperature, and the engine's enthalpy is the curve's."""
    (layer,) = melting_layers(CELL)
    columns = ("air_temperature", "relative_humidity", "wind_speed", "wind_direction", "pressure")
    names = ("outdoor_air", *columns[1:])
    climate = Climate.from_table(
        TABLE,
        timezone="UTC+4",
        columns=dict(zip(columns, names, strict=True))
        | {k: k for k in ("global_horizontal", "diffuse_horizontal")},
        latitude=-21.34,
        longitude=55.48,
        altitude=55.0,
    )
    for start in (18.0, 23.4, 25.0):
        results = Simulation(
            CELL,
            climate,
            start="2010-08-10",
            end="2010-08-10T00:15",
            outputs=list(layer.outputs),
            initial=start,
            measurements=Measurements.from_table(TABLE, timezone="UTC+4", columns=["slab_underside"]),
        ).run()
        _, enthalpy = path(results, CELL, layer)
        curve = law_curve(layer.of(CELL), start, start + 1.0)
        assert curve is not None
        assert enthalpy[0] == pytest.approx(curve[1][0], abs=1e-9)


def test_the_latent_heat_of_a_day_is_the_range_of_its_liquid_fraction() -> None:
    """By hand from the run; the interval is that of the latent heat, which changes the fraction as well."""
    (layer,) = melting_layers(CELL)
    columns = {"air_temperature": "outdoor_air", "wind_speed": "wind_speed", "pressure": "pressure"}
    columns |= {
        k: k for k in ("relative_humidity", "wind_direction", "global_horizontal", "diffuse_horizontal")
    }
    climate = Climate.from_table(
        TABLE, timezone="UTC+4", columns=columns, latitude=-21.34, longitude=55.48, altitude=55.0
    )
    latent = "materials.energain.latent_heat"
    simulation = Simulation(
        CELL, climate, step="30min", start="2010-08-10", end="2010-08-13", outputs=list(layer.outputs),
        initial=23.0, ranges={latent: (60000.0, 80000.0)},
        measurements=Measurements.from_table(TABLE, timezone="UTC+4", columns=["slab_underside"]),
    )  # fmt: skip
    measured = 71000.0 + 3000.0 * np.random.default_rng(1).standard_normal(48)
    fit = solve(
        CalibrationProblem(
            (FitParameter(latent, 60000.0, 80000.0, nominal=71000.0),),
            (FitSensor("calorimeter", measured, 3000.0, unit="J/kg"),),
            lambda x: np.tile(x[:, :, None], (1, 48, 1)),
        )
    )
    results = simulation.run(fit.values)
    (found,) = latent_heat_used(simulation, results, fit)
    names = [output.name for output in results.outputs]
    fraction = results.records[:, names.index(layer.liquid_fraction)]
    day = np.asarray((results.index.tz_localize(None) - results.index[0].tz_localize(None)).days)
    mean = np.mean([np.ptp(fraction[day == d]) for d in range(3)])
    (part,) = (p for p in CELL.constructions["ceiling"].layers if p.material == "energain")
    volume = float(part.thickness or 0.0) * float(CELL.surfaces["ceiling"].area or 0.0)
    assert found.name == "latent heat used per day, ceiling"
    assert found.value == pytest.approx(mean * volume * 855.0 * fit.x[0] / 3600.0, rel=1e-6)
    assert found.low < found.value < found.high
    assert found.high - found.low < 0.2 * found.value
