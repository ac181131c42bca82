"""Error of the flows through vents by the length of the step, against steps of one minute.

    python bench/openings_steps.py [--json FILE]

The house of docs/openings.md with its windows always open, three days in Tampa: with wind, and with stack
alone. Flows belong to the temperatures at the beginning of a step.
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import mascarin as mc

PAGE = Path(__file__).resolve().parent.parent / "docs" / "openings.md"
NAMES = ("living.air_temperature", "south_window.inflow")


def house() -> dict[str, Any]:
    """The house of the page, without its control."""
    found = re.search(r"```yaml\n(name: two rooms.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "house.yaml"
        file.write_text(found[1], encoding="utf-8")
        plain: dict[str, Any] = mc.load(str(file)).to_dict()
    plain.pop("controls")
    for name in ("south_window", "north_window"):
        plain["vents"][name].pop("control")
    return plain


def hourly(building: mc.Building, climate: mc.Climate, step: str) -> Any:
    """The values at every hour."""
    results = mc.simulate(
        building, climate, start="2001-04-10", end="2001-04-13", outputs=list(NAMES), step=step
    )
    return results.to_dataframe().resample("1h").first()[list(NAMES)].iloc[1:]


def main() -> None:
    """Print the errors."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    climate = mc.Climate.shipped("tampa", elsewhere=True)
    found: dict[str, dict[str, list[float]]] = {}
    for case in ("wind", "stack alone"):
        plain = house()
        if case == "stack alone":
            for name in ("south_window", "north_window"):
                plain["vents"][name]["pressure"] = "none"
        building = mc.Building.from_dict(plain)
        exact = hourly(building, climate, "1min")
        found[case] = {}
        for step in ("5min", "15min", "30min", "1h"):
            error = hourly(building, climate, step) - exact
            rms = np.sqrt((error**2).mean())
            flow = float(rms[NAMES[1]] / exact[NAMES[1]].mean())
            found[case][step] = [float(rms[NAMES[0]]), flow]
            print(f"{case:<12} {step:>6}: air {rms[NAMES[0]]:.3f} K, flow {100 * flow:.1f} % rms")
    if chosen.json:
        chosen.json.write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
