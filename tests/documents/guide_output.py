"""The output that docs/engine.md adds, in the package whose engine has it: ``guide_output.py FOLDER``.

`test_docs_engine.py` runs it with the copy of the package in front of the path. The output enters
everywhere: the list, a run, derivatives both ways, a sweep, a sensitivity analysis, a page, a unit for
co-simulation and the reference.
"""

from __future__ import annotations

import sys
from pathlib import Path

import fmpy
import numpy as np

import mascarin as mc
from mascarin.building.parts.site_air import heat_capacity
from mascarin.ensemble.objectives import Statistic
from mascarin.examples import box, box_climate
from mascarin.fmu import export
from mascarin.pages.run import page as run_page
from mascarin.simulation import Mean
from sitepages import outputs

NAME, AIR = "room.air_heat_content", "room.air_temperature"
VOLUME = "zones.room.volume"


def main(folder: Path) -> None:
    building, climate = box(), box_climate()
    output = building.output(NAME)
    assert (output.unit, output.label, output.mean) == ("J", "Heat content of the air", False)
    assert f"| `ZONE.{output.kind}` | J | Heat content of the air of a zone above 0 degC |" in outputs.page()

    simulation = mc.Simulation(building, climate, step="1h", initial=20.0, outputs=[NAME, AIR])
    run = simulation.run()
    content, air = run.records.T
    capacity = content[0] / air[0]
    volume = building.parameter(VOLUME).value
    assert abs(capacity / (heat_capacity(building.site) * float(volume)) - 1.0) < 1e-9
    np.testing.assert_allclose(content, capacity * air, rtol=1e-12)

    path = "surfaces.facade.outside.absorptance"
    _, slopes = simulation.jacobian_vector([path])
    np.testing.assert_allclose(slopes[0, :, 0], capacity * slopes[0, :, 1], rtol=1e-10, atol=1e-6)
    at = building.parameter(path).value
    ends = [simulation.run({path: at + change}).records[:, 0] for change in (1e-4, -1e-4)]
    np.testing.assert_allclose(slopes[0, :, 0], (ends[0] - ends[1]) / 2e-4, rtol=1e-4, atol=1.0)
    means = [
        mc.gradient(building, climate, Mean(name), step="1h", initial=20.0, outputs=[name])
        for name in (NAME, AIR)
    ]
    by_path = [mean.slopes[path] for mean in means]
    assert abs(by_path[0] / (capacity * by_path[1]) - 1.0) < 1e-9

    swept = mc.sweep(building, climate, {path: [0.3, 0.6, 0.9]}, step="1h", outputs=[NAME])
    assert swept[NAME].shape[0] == 3
    assert Statistic.read(f"max:{NAME}").output == NAME
    found = mc.sensitivity_analysis(
        building, climate, vary=[path, "zones.room.infiltration"], step="1h", outputs=[NAME], replicates=3
    )
    assert list(found.outputs) == [NAME]

    page = run_page.render(run, run_page.Notes())
    assert "Heat content of the air" in page
    assert NAME in page

    unit = folder / "box.fmu"
    export(simulation, unit)
    described = fmpy.read_model_description(str(unit))
    variable = next(one for one in described.modelVariables if one.name == NAME)
    assert variable.description == "Heat content of the air of a zone above 0 degC"
    hours = len(content) - 1
    told = fmpy.simulate_fmu(str(unit), stop_time=3600.0 * hours, output_interval=3600.0, output=[NAME])
    assert np.array_equal(told[NAME], content)
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
