"""What a new user does first, with an installed package and no other files; fails where a number is wrong.

``python packaging/quick_start.py`` runs it with the package that is installed.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import mascarin as mc
from mascarin.examples import box, clear_days, synthetic_wall
from mascarin.validation import Sensor


def main() -> None:
    """A run, a calibration, and the command line."""
    climate = clear_days(39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=3, altitude=1650)
    run = mc.simulate(box(), climate, step="1h")
    assert run.energy.closes, run.energy.relative_residual
    wall = synthetic_wall()
    fitted = mc.calibrate(
        wall.building,
        wall.climate,
        wall.measurements,
        sensors={"wall.interface_1_temperature": Sensor("joint", expanded_uncertainty=0.1)},
        vary=["materials.insulation.conductivity", "surfaces.wall.outside.absorptance"],
        start="2023-03-05",
        end="2023-03-08",
        step="1h",
    )
    conductivity = fitted.values["materials.insulation.conductivity"]
    assert abs(conductivity - 0.033) < 0.0005, conductivity
    with tempfile.TemporaryDirectory() as folder:
        cell = Path(folder) / "cell"
        command = [sys.executable, "-m", "mascarin.cli"]
        subprocess.run([*command, "init", str(cell)], check=True)
        subprocess.run(
            [*command, "check", str(cell / "building.yaml")], check=True, stdout=subprocess.DEVNULL
        )
    print(f"mascarin {mc.__version__}: conductivity {conductivity:.4f} W/(m K), expected 0.033")


if __name__ == "__main__":
    main()
