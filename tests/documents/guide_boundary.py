"""The boundary that docs/engine.md adds, in the package whose engine has it: ``guide_boundary.py FOLDER``.

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
from mascarin.fmu import export
from mascarin.physics import imposed_temperature
from mascarin.simulation import Mean
from sitepages import assemble, keys, laws
from sitepages.snippets import Snippets

SIDE = "surfaces.facade.outside"
FACTOR = f"{SIDE}.imposed.factor"
AIR, SURFACE = "room.air_temperature", "facade.outside_temperature"


def main(folder: Path) -> None:
    unheated = vars(mc.building)["ImposedUnheated"]
    assert "ImposedUnheated(indoor=20, factor=0.5)" in (unheated.__doc__ or "")
    part = next(part for part in keys.parts() if part.__name__ == "ImposedUnheated")
    assert Snippets(assemble.DOCS).of(part, "factor") == "factor: 0.5"
    vars(laws)["PHYSICS"] = Path(mc.__file__).parents[2] / "crates" / "engine" / "src" / "physics"
    assert "An unheated room by a reduction factor" in laws.page()

    tree = box().to_dict()
    side = {"imposed": {"kind": "unheated", "indoor": 20, "factor": 0.8}}
    tree["surfaces"]["facade"]["outside"] = side
    building, climate = mc.Building.from_dict(tree), box_climate()
    assert any("13789" in source for source in sources.sources(building))
    assert building.parameter(FACTOR).unit == "-"
    names = [AIR, SURFACE]
    simulation = mc.Simulation(building, climate, step="1h", initial=20.0, outputs=names)
    run = simulation.run()
    air, surface = run.records.T
    outdoor = simulation.weather("air_temperature")
    np.testing.assert_allclose(surface[1:], 20.0 - 0.8 * (20.0 - outdoor[1:]), atol=1e-9)
    expected = imposed_temperature("unheated", {"indoor": 20.0, "factor": 0.8}, 1.0, 5.0)
    assert abs(expected - 8.0) < 1e-12
    assert run.energy.relative_residual < 1e-9

    _, slopes = simulation.jacobian_vector([FACTOR])
    ends = [simulation.run({FACTOR: 0.8 + change}).records for change in (1e-5, -1e-5)]
    np.testing.assert_allclose(slopes[0], (ends[0] - ends[1]) / 2e-5, rtol=1e-4, atol=1e-5)
    mean = mc.gradient(building, climate, Mean(AIR), step="1h", initial=20.0, outputs=[AIR])
    assert abs(mean.slopes[FACTOR] / np.mean(slopes[0, :, 0]) - 1.0) < 1e-6

    unit = folder / "box.fmu"
    export(simulation, unit)
    hours = len(air) - 1
    series = fmpy.simulate_fmu(str(unit), stop_time=3600.0 * hours, output_interval=3600.0, output=[AIR])
    assert np.array_equal(series[AIR], air)
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
