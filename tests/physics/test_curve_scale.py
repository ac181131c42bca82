"""Hysteresis of measured curves of different shapes: `curve_scale` converges in random walls."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mascarin.building import Building
from mascarin.simulation.run import simulate
from mascarin.weather import Climate

OUTSIDE = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}
INSIDE = {"zone": "room", "convection": "tarp", "emissivity": 0.9, "absorptance": 0.5}


def _table(rng: np.random.Generator, middle: float) -> dict[str, Any]:
    """A measured curve of four to eight points with several bends."""
    count = int(rng.integers(4, 9))
    temperatures = np.sort(rng.uniform(-4, 4, count)) + middle + np.arange(count) * 0.05
    fractions = np.concatenate([[0], np.sort(rng.uniform(0, 1, count - 2)), [1]])
    return {"kind": "fractions", "temperatures": temperatures.tolist(), "fractions": fractions.tolist()}


def _room(rng: np.random.Generator) -> Building:
    """A room behind four walls with a measured material, some of them heated and cooled."""
    heating = _table(rng, 23)
    same, apart = rng.random() < 0.5, float(rng.uniform(0.2, 3))
    colder = [at - apart for at in heating["temperatures"]]
    cooling = heating | {"temperatures": colder} if same else _table(rng, 21 - apart)
    latent_heat, thickness = float(rng.uniform(5e4, 2e5)), float(rng.uniform(0.004, 0.03))
    room = {
        "volume": 50,
        "infiltration": float(rng.uniform(0.2, 5)),
        "gains": {"people": {"power": float(rng.uniform(0, 1500)), "radiative": 0.5}},
    }
    if rng.random() < 0.4:
        room |= {"heating": {"setpoint": 20}, "cooling": {"setpoint": 25}}
    return Building.from_dict(
        {
            "name": "measured",
            "site": {"latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"},
            "materials": {
                "pcm": {
                    "kind": "pcm", "conductivity": [0.2, 0.18], "density": [850, 850],
                    "specific_heat": [2000, 2500], "latent_heat": latent_heat, "law": heating,
                    "hysteresis": {"model": "curve_scale", "law": cooling},
                },
                "board": {"conductivity": 0.16, "density": 950, "specific_heat": 840},
                "wool": {"conductivity": 0.04, "density": 30, "specific_heat": 1000},
            },
            "constructions": {
                "wall": {
                    "layers": [
                        {"material": "wool", "thickness": 0.05},
                        {"material": "pcm", "thickness": thickness},
                        {"material": "board", "thickness": 0.01},
                    ]
                }
            },
            "zones": {"room": room},
            "surfaces": {
                f"s{k}": {
                    "construction": "wall", "area": 15, "tilt": 90, "azimuth": 90 * k,
                    "outside": OUTSIDE, "inside": INSIDE,
                }
                for k in range(4)
            },
        }
    )  # fmt: skip


# With a fraction that jumps, and a split of the enthalpy that is not convex, none of these converged.
@pytest.mark.parametrize("seed", [8, 13, 22, 23, 28, 38, 39, 41, 46])
def test_measured_curves_of_different_shapes_converge(seed: int) -> None:
    rng = np.random.default_rng(seed)
    building = _room(rng)
    step = str(rng.choice(["5min", "15min", "1h", "3h"]))
    scheme: Any = str(rng.choice(["sdirk2", "backward-euler"]))
    run = simulate(
        building, Climate.shipped("golden"), start="2001-06-01", end="2001-06-15", step=step, scheme=scheme,
        outputs=["room.air_temperature"],
    )  # fmt: skip
    assert run.energy.closes
