"""Write calls of the engine as JSON, from which the campaign and cargo-fuzz start: ``calls.py FOLDER``."""

from __future__ import annotations

import json
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

import fuzz_buildings
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.simulation.preparation.options import SCHEMES
from mascarin.simulation.simulation import Simulation

folder = Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)
weather, written = fuzz_buildings.climate(), 0
for n in range(40):
    draw = random.Random(f"call {n}")
    tree = fuzz_buildings.description(draw, fuzz_buildings.Ways(passive=n % 4 == 0))
    scheme = SCHEMES[n % len(SCHEMES)]
    try:
        simulation = Simulation(
            Building.from_dict(tree), weather, step="1h", end="2001-01-01 04:00", scheme=scheme, initial=15.0
        )
    except InputError:
        continue
    compiled = simulation.compiled
    forcing = compiled.forcing
    call = {
        "description": json.loads(compiled.description),
        "values": compiled.values.tolist(),
        # JSON has no NaN: channels that the building does not need.
        "forcing": [0.0 if value != value else value for value in forcing.ravel().tolist()],
        "stages": forcing.shape[1],
        "channels": forcing.shape[2],
        "dt": 3600.0,
        "scheme": SCHEMES.index(scheme),
        "initial": 15.0,
        "warmup_steps": n % 3,
        "outputs": json.loads(compiled.readings.outputs),
        "record_from": 0,
        "record_every": 1,
    }
    (folder / f"call{n:02d}.json").write_text(json.dumps(call), encoding="utf-8")
    written += 1
print(f"wrote {written} calls to {folder}")
