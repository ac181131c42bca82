"""The model of the sky that docs/engine.md adds, in the package whose engine has it: ``guide_sky.py FOLDER``.

`test_docs_engine.py` runs it with the copy of the package in front of the path.
"""

from __future__ import annotations

import sys
from pathlib import Path

import fmpy
import numpy as np

import mascarin as mc
from mascarin.building.parameters import sources
from mascarin.examples import box, box_climate
from mascarin.figures import text
from mascarin.fmu import export
from mascarin.measurements import Sensor
from mascarin.physics import STEFAN_BOLTZMANN
from mascarin.simulation import Mean
from mascarin.study.diagnosis.other_laws import forms
from sitepages import assemble, keys, laws
from sitepages.snippets import Snippets

PATH = "site.sky.a"
SKY, AIR, ROOF = "sky_temperature", "room.air_temperature", "facade.outside_temperature"


def described() -> None:
    swinbank = vars(mc.building)["SwinbankSky"]
    assert float(swinbank().a) == 9.365e-6
    assert ">>> SwinbankSky()" in (swinbank.__doc__ or "")
    assert text.choice("swinbank") == "Swinbank, with clouds"
    part = next(part for part in keys.parts() if part.__name__ == "SwinbankSky")
    assert keys.title(part) == "Swinbank sky"
    assert Snippets(assemble.DOCS).of(part, "a") == "a: 9.365e-06"
    vars(laws)["PHYSICS"] = Path(mc.__file__).parents[2] / "crates" / "engine" / "src" / "physics"
    assert "### Swinbank" in laws.page()


def main(folder: Path) -> None:
    described()
    other, climate = box(), box_climate()
    building = other.replace({"site.sky": "swinbank"})
    assert building.site.cloud.kind == "factor"
    assert any("Swinbank" in source for source in sources.sources(building))
    assert ("site.sky", "swinbank") in {(part, kind) for part, kind, _ in forms(other, set())}
    assert building.parameter(PATH).unit == "1/K2"

    # Without clouds the emission is a sigma T^6.
    clear = building.replace({"site.cloud": {"kind": "factor", "c1": 0, "c2": 0, "c3": 0}})
    names = [SKY, AIR, ROOF]
    simulation = mc.Simulation(clear, climate, step="1h", initial=20.0, outputs=names)
    run = simulation.run()
    sky = run.records[:, 0] + 273.15
    outdoor = simulation.weather("air_temperature") + 273.15
    expected = 9.365e-6 * STEFAN_BOLTZMANN * outdoor**6
    np.testing.assert_allclose(STEFAN_BOLTZMANN * sky**4, expected, rtol=1e-9)

    _, slopes = simulation.jacobian_vector([PATH])
    ends = [simulation.run({PATH: 9.365e-6 * factor}).records for factor in (1.0 + 1e-5, 1.0 - 1e-5)]
    np.testing.assert_allclose(slopes[0], (ends[0] - ends[1]) / (2e-5 * 9.365e-6), rtol=1e-4, atol=1.0)
    mean = mc.gradient(clear, climate, Mean(AIR), step="1h", initial=20.0, outputs=[AIR])
    assert abs(mean.slopes[PATH] / np.mean(slopes[0, :, 1]) - 1.0) < 1e-6

    measured = mc.simulate(clear, climate, step="1h", outputs=[ROOF], parameters={PATH: 9.2e-6})
    logger = mc.Measurements.from_table(
        measured.to_dataframe()[[ROOF]].rename(columns={ROOF: "T_roof"}), timezone="UTC-07:00"
    )
    sensors = {ROOF: Sensor("T_roof", standard_uncertainty=0.01, offset=0.0)}
    fit = mc.calibrate(clear, climate, logger, sensors=sensors, vary=[PATH], step="1h", warm_up="1d")
    assert abs(fit.values[PATH] / 9.2e-6 - 1.0) < 1e-3, fit.values
    analysis = mc.sensitivity_analysis(clear, climate, vary=[PATH, "site.ground_reflectance"], step="1h",
                                       outputs=[AIR], replicates=3)  # fmt: skip
    assert list(analysis.outputs) == [AIR]

    unit = folder / "box.fmu"
    export(simulation, unit)
    hours = len(outdoor) - 1
    series = fmpy.simulate_fmu(str(unit), stop_time=3600.0 * hours, output_interval=3600.0, output=[AIR])
    assert np.array_equal(series[AIR], run.records[:, 1])
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
