"""What comparing designs costs: the light house over a summer of 120 days, all products, several climates.

Two grids: 1000 designs in one climate, and all products x 10 thicknesses in three climates. Both are made of
products, each of which is compiled by itself: one of them is run, then the first N; the difference is taken
for each of the others. Processor time of all processes counts, with objectives, store and report.

    python bench/design.py [--products 3] [--workers 2]
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

import yaml

from mascarin.design import read_design, run_design
from mascarin.examples import FOLDER
from mascarin.materials.library import products as library

ASKED = {"1000 designs": 180.0, "products x thicknesses x climates": 240.0}  # s on two cores
SUMMER = {"start": "06-01", "end": "09-29"}
THICKNESS = "constructions.ceiling_pcm.layers.pcm.thickness"


def products() -> list[str]:
    """Products with all data that a layer needs."""
    return [name for name, product in library().items() if not product.missing]


def grid(climates: list[str], names: list[str], steps: int, roofs: int, variants: bool) -> dict[str, Any]:
    """A design file."""
    variables: dict[str, Any] = {
        "product": {"material": "pcm", "products": names},
        "thickness": {"path": THICKNESS, "range": [0.005, 0.02], "steps": steps},
    }
    if roofs > 1:
        path = "surfaces.roof_*.outside.absorptance"
        variables["roof"] = {"path": path, "range": [0.2, 0.8], "steps": roofs}
    if variants:
        always = {"schedules.windows": {"kind": "fraction", "value": 1}}
        variables["windows"] = {"variants": {"open at night": {}, "always open": always}}
    return {
        "name": "bench",
        "building": "building.yaml",
        "climates": {name: {"epw": f"shipped:{name}", **SUMMER} for name in climates},
        "step": "15min",
        "variables": variables,
        "objectives": {
            "discomfort": {"kind": "degree_hours", "zones": ["living"], "above": 28, "air_speed": 0.9},
            "latent": {"kind": "latent_use", "layer": "living_ceiling.pcm"},
            "mass": {"kind": "mass", "layers": ["living_ceiling.pcm"]},
        },
    }


def processor_time() -> float:
    """Of this process and those that it has waited for. [s]"""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def measured(design: dict[str, Any], workers: int) -> tuple[float, float]:
    """Processor time and time by the clock of a whole study. [s]"""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(FOLDER / "reunion_house" / "building.yaml", folder)
        (folder / "design.yaml").write_text(yaml.safe_dump(design), encoding="utf-8")
        inputs = read_design(folder / "design.yaml")
        before, started = processor_time(), time.perf_counter()
        results = run_design(inputs, folder / "out", workers=workers)
        assert results.to_dataframe()["closure"].max() < 1e-9
        return processor_time() - before, time.perf_counter() - started


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--products", type=int, default=3, help="products that are run, two at least")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    options = parser.parse_args()
    every = products()
    grids = {
        "1000 designs": (lambda names: grid(["tampa"], names, 20, 5, variants=True), 5),
        "products x thicknesses x climates": (
            lambda names: grid(["tampa", "golden", "washington"], names, 10, 1, variants=False),
            len(every),
        ),
    }
    for name, (make, count) in grids.items():
        one, some = (measured(make(every[:n]), options.workers) for n in (1, options.products))
        each = (some[0] - one[0]) / (options.products - 1)
        whole = one[0] + each * (count - 1)
        print(
            f"{name}: {one[0]:.1f} s of processor time with one product ({one[1]:.0f} s by the clock), "
            f"{each:.1f} s for each more; all {count}: {whole:.0f} s, {whole / 2:.0f} s on two free cores "
            f"(asked: {ASKED[name]:.0f} s); load {os.getloadavg()[0]:.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
