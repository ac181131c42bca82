"""The melting law that docs/engine.md adds, in the package whose engine has it: ``guide_melting.py FOLDER``.

`test_docs_engine.py` runs it with the copy of the package in front of the path. The law enters
everywhere: a run against its closed form, derivatives, a sweep, a sensitivity analysis, a calibration, a unit
for co-simulation and the reference of keys.
"""

from __future__ import annotations

import sys
from pathlib import Path

import fmpy
import numpy as np

import mascarin as mc
from mascarin.fmu import export
from mascarin.measurements import Sensor
from mascarin.verification.analytical import setup
from sitepages import keys
from sitepages.snippets import Snippets

PATH = "materials.wax.hysteresis.delay"
WALL = """\
materials:
  wax: {kind: pcm, conductivity: 60, density: 850, specific_heat: 2000, latent_heat: 120000,
        melting_temperature: 23.5, law: {kind: linear, width: 0.5},
        hysteresis: {model: delay, delay: {value: 1800, range: [900, 3600]}}}
constructions: {wall: {layers: [{material: wax, thickness: 0.02, nodes: 1}]}}
surfaces:
  wall: {construction: wall, area: 1, tilt: 90, outside: {measured: air}, inside: {adiabatic: true}}
"""
FRACTION, TEMPERATURE = "wall.wax_liquid_fraction", "wall.wax_temperature"


def main(folder: Path) -> None:
    building = setup.building(WALL)
    # Its surface jumps to 40 degC: the whole layer follows, and the fraction rises by 1 - exp(-t/tau).
    jump = setup.simulation(
        building,
        setup.climate(7200.0, {"air": setup.steady(40.0)}),
        step=10.0,
        initial=20.0,
        outputs=[FRACTION],
    ).run()
    time = 10.0 * np.arange(len(jump.records))
    assert np.abs(jump.records[:, 0] - (1.0 - np.exp(-time / 1800.0))).max() < 2e-3
    assert jump.energy.closure < 1e-10

    hours = np.arange(49)
    climate = setup.climate(3600.0, {"air": 23.0 + 6.0 * np.sin(hours * np.pi / 12.0)})
    outputs = [FRACTION, "wall.outside_flux"]
    simulation = mc.Simulation(building, climate, step="15min", outputs=outputs, initial=20.0)
    run = simulation.run()
    _, slopes = simulation.jacobian_vector([PATH])
    low, high = (
        simulation.jacobian_vector([PATH], simulation.vector({PATH: 1800 + d}))[0] for d in (-0.01, 0.01)
    )
    np.testing.assert_allclose(slopes[0], (high - low) / 0.02, atol=1e-5 * np.abs(slopes[0]).max())
    delays = np.linspace(900.0, 3600.0, 9)
    swept = simulation.ensemble(np.array([simulation.vector({PATH: delay}) for delay in delays])).records
    assert np.array_equal(swept[4], simulation.run({PATH: delays[4]}).records)
    found = mc.sensitivity_analysis(
        building,
        climate,
        vary=[PATH, "materials.wax.latent_heat"],
        step="15min",
        outputs=[FRACTION],
        replicates=3,
    )
    assert list(found.outputs) == [FRACTION]
    truth = mc.Simulation(building.replace({PATH: 2700}), climate, step="15min", outputs=[FRACTION]).run()
    table = truth.to_dataframe()[[FRACTION]].rename(columns={FRACTION: "fraction"})
    fit = mc.calibrate(
        building, climate, mc.Measurements.from_table(table, timezone="UTC"), vary=[PATH], warm_up="6h",
        sensors={FRACTION: Sensor("fraction", standard_uncertainty=0.01)},
    )  # fmt: skip
    assert abs(fit.values[PATH] - 2700.0) < 5.0

    unit = folder / "wall.fmu"
    export(simulation, unit)
    stop = 900.0 * (len(run.records) - 1)
    told = fmpy.simulate_fmu(str(unit), stop_time=stop, output_interval=900.0, output=[FRACTION])
    assert np.array_equal(told[FRACTION], run.records[:, 0])

    part = next(part for part in keys.parts() if part.__name__ == "Delay")
    snippets = Snippets(Path(keys.__file__).parent.parent.parent)
    assert snippets.of(part, "delay") == "delay: 900"
    assert snippets.of(part, "model") == "model: delay"
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
