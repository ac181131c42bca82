"""The law that docs/engine.md adds, in the package whose engine has it: ``guide_law.py FOLDER``.

`test_docs_engine.py` runs it with the copy of the package in front of the path. The law enters
everywhere: objects, a file, limits, sources, runs, derivatives both ways, a sweep, a sensitivity analysis, a
calibration, the alternatives of a study, a page, a unit for co-simulation and the reference.
"""

from __future__ import annotations

import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest

import mascarin as mc
from mascarin.building.parameters import sources
from mascarin.building.parts.envelope import convection
from mascarin.examples import box, box_climate
from mascarin.figures import text
from mascarin.fmu import export
from mascarin.measurements import Sensor
from mascarin.pages.run import page as run_page
from mascarin.simulation import Mean
from mascarin.study.diagnosis.other_laws import forms
from sitepages import assemble, keys, laws
from sitepages.snippets import Snippets

SIDE = "surfaces.facade.inside.convection"
FACTOR, EXPONENT = f"{SIDE}.factor", f"{SIDE}.exponent"
NAME, SURFACE, AIR = "facade.inside_convection", "facade.inside_temperature", "room.air_temperature"


def described() -> None:
    khalifa = vars(mc.building)["Khalifa"]
    law = khalifa(factor=1.1)
    assert (law.kind, float(law.factor), float(law.exponent)) == ("khalifa", 1.1, 0.24)
    assert repr(khalifa()) == "Khalifa(factor=1, exponent=0.24)"
    assert ">>> Khalifa()" in (khalifa.__doc__ or "")
    assert "Khalifa" in mc.building.__all__
    assert "khalifa" in convection.SOURCES
    assert text.choice("khalifa") == "Khalifa and Marshall"
    with pytest.raises(mc.InputError, match="at most 1"):
        khalifa(exponent=1.2)
    part = next(part for part in keys.parts() if part.__name__ == "Khalifa")
    assert keys.title(part) == "Khalifa and Marshall"
    assert [key.name for key in keys.keys_of(part)] == ["kind", "factor", "exponent"]
    assert Snippets(assemble.DOCS).of(part, "exponent") == "exponent: 0.24"
    vars(laws)["PHYSICS"] = Path(mc.__file__).parents[2] / "crates" / "engine" / "src" / "physics"
    assert "### Khalifa and Marshall" in laws.page()


def main(folder: Path) -> None:
    described()
    other, climate = box(), box_climate()
    building = other.replace({SIDE: "khalifa"})
    assert building.to_dict()["surfaces"]["facade"]["inside"]["convection"] == "khalifa"
    assert any("Khalifa" in source for source in sources.sources(building))
    assert (SIDE, "khalifa") in {(part, kind) for part, kind, _ in forms(other, {"facade"})}
    exponent = building.parameter(EXPONENT)
    assert (exponent.low, exponent.high, exponent.upper) == (0.2, 0.33, 1.0)

    names = [NAME, SURFACE, AIR]
    simulation = mc.Simulation(building, climate, step="1h", initial=20.0, outputs=names)
    run = simulation.run()
    coefficient, surface, air = run.records.T
    # The coefficient is smooth below differences of 0.01 K.
    expected = 2.30 * ((surface - air) ** 2 + 1e-4) ** 0.12
    np.testing.assert_allclose(coefficient[1:], expected[1:], rtol=1e-9)

    paths = [FACTOR, EXPONENT]
    _, slopes = simulation.jacobian_vector(paths)
    for index, path in enumerate(paths):
        at = float(building.parameter(path).value)
        ends = [simulation.run({path: at + change}).records for change in (1e-5, -1e-5)]
        np.testing.assert_allclose(slopes[index], (ends[0] - ends[1]) / 2e-5, rtol=1e-4, atol=1e-5)
    mean = mc.gradient(building, climate, Mean(AIR), step="1h", initial=20.0, outputs=[AIR])
    for index, path in enumerate(paths):
        assert abs(mean.slopes[path] / np.mean(slopes[index, :, 2]) - 1.0) < 1e-6

    swept = mc.sweep(other, climate, {SIDE: ["tarp", "khalifa"]}, step="1h", outputs=[AIR])
    assert swept[AIR].shape[0] == 2
    analysis = mc.sensitivity_analysis(building, climate, vary=paths, step="1h", outputs=[AIR], replicates=3)
    assert list(analysis.outputs) == [AIR]

    truth = {FACTOR: 1.2, EXPONENT: 0.3}
    measured = mc.simulate(building, climate, step="1h", outputs=[SURFACE, AIR], parameters=truth)
    columns = {SURFACE: "T_surface", AIR: "T_air"}
    logger = mc.Measurements.from_table(
        measured.to_dataframe()[[SURFACE, AIR]].rename(columns=columns), timezone="UTC-07:00"
    )
    # Exact readings: no offset is to be estimated.
    sensors = {
        name: Sensor(column, standard_uncertainty=0.01, offset=0.0) for name, column in columns.items()
    }
    fit = mc.calibrate(building, climate, logger, sensors=sensors, vary=paths, step="1h", warm_up="1d")
    for path, value in truth.items():
        assert abs(fit.values[path] - value) < 1e-2, fit.values

    page = run_page.render(run, run_page.Notes())
    assert NAME in page

    unit = folder / "box.fmu"
    export(simulation, unit)
    hours = len(air) - 1
    series = fmpy.simulate_fmu(str(unit), stop_time=3600.0 * hours, output_interval=3600.0, output=[NAME])
    assert np.array_equal(series[NAME], coefficient)
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
