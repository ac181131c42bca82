"""What vapour balances add to a run: the same building with and without humidity, in turn.

    python bench/humidity_cost.py [--rounds 40]

prints the processor time of both [ms], the least of all rounds, and what humidity adds [%]. `box` is one
zone with walls that take up vapour, people and infiltration; `dried` has ideal drying as well.
`reunion-house` has three zones in a pressure network. Runs start from given temperatures, so that both have
the same steps.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import page

from mascarin.building import Building, load
from mascarin.examples import FOLDER, box, box_climate
from mascarin.simulation import Simulation
from mascarin.weather import Climate

PEOPLE = {"gains": {"people": {"power": 60}}}
DRIED = PEOPLE | {"drying": {"relative_humidity": 0.5}}
STEP = "15min"
CLIMATE = "tampa"
#: Parts of names of materials, and what they take up vapour like.
LIKE = {"plaster": "gypsum", "ply": "plywood", "wood": "wood", "concrete": "concrete"}


def damp(building: Building, *, dried: bool) -> Building:
    """With sources in all zones and with sorption; the first zone is dried."""
    materials = {
        name: like for name in building.materials for part, like in reversed(LIKE.items()) if part in name
    }
    zones = dict.fromkeys(building.zones, PEOPLE)
    if dried:
        zones[next(iter(zones))] = DRIED
    return building.replace({"humidity": {"materials": materials, "zones": zones}})


def house() -> tuple[Building, Climate, dict[str, Any]]:
    """A house of three zones in July of a hot humid place."""
    climate = Climate.shipped(CLIMATE, elsewhere=True)
    site = climate.site
    there = {f"site.{key}": getattr(site, key) for key in ("latitude", "longitude", "altitude")}
    building = load(FOLDER / "reunion_house" / "building.yaml")
    building = building.replace({**there, "site.timezone": climate.timezone})
    year = climate.index[len(climate.index) // 2].year
    return building, climate, {"start": f"{year}-07-01", "end": f"{year}-07-31", "initial": 25.0}


def cases() -> dict[str, tuple[Building, Building, Climate, dict[str, Any]]]:
    """Building without and with humidity, climate and options by name."""
    of_box, (of_house, climate, options) = (box(), box_climate(), {"initial": 20.0}), house()
    return {
        "box": (of_box[0], damp(of_box[0], dried=False), *of_box[1:]),
        "box, dried": (of_box[0], damp(of_box[0], dried=True), *of_box[1:]),
        "reunion-house, dried": (of_house, damp(of_house, dried=True), climate, options),
    }


def seconds(simulation: Simulation) -> float:
    """Processor time of one run [s]."""
    start = time.process_time()
    simulation.run({})
    return time.process_time() - start


def main() -> None:
    """Measure and print."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--rounds", type=int, default=40)
    rounds = options.parse_args().rounds
    lines = []
    for name, (dry, wet, climate, given) in cases().items():
        outputs = [f"{next(iter(dry.zones))}.air_temperature"]
        both = [Simulation(one, climate, step=STEP, outputs=outputs, **given) for one in (dry, wet)]
        times = [[seconds(one) for one in both] for _ in range(rounds)]
        without, full = (min(column) for column in zip(*times, strict=True))
        cells = [f"{1e3 * without:.3f}", f"{1e3 * full:.3f}", f"{100 * (full / without - 1):.0f}"]
        lines.append([name, *cells])
    print(page.table(["building", "without [ms]", "with humidity [ms]", "more [%]"], lines))


if __name__ == "__main__":
    main()
