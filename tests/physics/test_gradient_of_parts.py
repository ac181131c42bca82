"""Slopes in reverse mode over steps that are solved in parts while the sun sets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.simulation.preparation.objectives import Mean
from random_weather import weather


def sheet() -> Building:
    """A room behind a sheet that follows its air at once; its inner side gets no sun."""
    outside = {"outdoors": True, "convection": 20, "absorptance": 0.5, "longwave": "none"}
    inside = {"zone": "z0", "convection": 5, "emissivity": 0.9, "absorptance": 0.5}
    return Building.from_dict(
        {
            "name": "sheet",
            "site": {"latitude": 49.19, "longitude": -6.788, "altitude": 409,
                     "timezone": "Australia/Lord_Howe"},
            "materials": {"m": {"conductivity": 0.5, "density": 800, "specific_heat": 900}},
            "constructions": {"w": {"layers": [{"material": "m", "thickness": 0.02}]}},
            "zones": {"z0": {"volume": 50}},
            "surfaces": {
                "s0": {"construction": "w", "area": 20, "tilt": 90, "azimuth": 0,
                       "outside": outside, "inside": inside},
            },
        }
    )  # fmt: skip


def slopes_of_mean(series: np.ndarray[Any, Any]) -> list[float]:
    """Slopes of `Mean`, which weighs all records alike."""
    return [float(slope) for slope in series.mean(axis=1)]


@pytest.mark.parametrize("scheme", ["sdirk2", "linearly-implicit", "backward-euler"])
@pytest.mark.parametrize("step", ["1h", "2h", "3h"])
def test_slopes_of_parts_at_sunset_are_those_forward(scheme: Any, step: str) -> None:
    """A sun of zero that no part makes anew led to places of other numbers, and the engine stopped."""
    climate = weather(5).climate()
    simulation = mc.Simulation(
        sheet(), climate, outputs=["z0.air_temperature"], step=step, initial=20.0, scheme=scheme,
        start="2019-03-30T05:00:00+00:00", end="2019-03-30T11:00:00+00:00",
    )  # fmt: skip
    gradient = simulation.gradient(Mean("z0.air_temperature"))
    forward = simulation.jacobian(list(simulation.paths))["d z0.air_temperature"]
    expected = dict(zip(simulation.paths, slopes_of_mean(forward.to_numpy()), strict=True))
    for path, slope in expected.items():
        assert gradient.slopes[path] == pytest.approx(slope, rel=1e-8, abs=1e-10), path
    assert max(map(abs, expected.values())) > 0.0
