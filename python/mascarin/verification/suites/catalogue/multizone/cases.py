"""MZ320: three zones in a row, steady, that exchange heat through two walls."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

#: Films on both sides of common walls and inside, and outdoors. [W/(m2 K)]
_FILM, _OUTSIDE = 8.29, 30.48722
#: Walls of 0.15 m: conductivity of common walls and of walls outdoors. [W/(m K)]
_CONDUCTIVITIES: Final = {"common": 1.2, "outer": 0.24}
_THICKNESS: Final = 0.15
#: Areas of walls outdoors of each zone, and of a common wall. [m2]
_AREAS: Final = {"a": 150.0, "b": 128.4, "c": 150.0}
_COMMON: Final = 21.6
#: Gains [W], and temperature at which the third zone is held [degC].
_GAINS: Final = {"a": 2500.0, "b": 1000.0}
_HELD, _OUTDOORS = 15.0, 20.0
#: Analytical solution: air of two zones [degC], cooling of the third [W]; and the range of nine programs.
_ANSWERS: Final = {
    "a.air_temperature": ("air of zone A", "degC", 31.057855, (30.99, 31.93)),
    "b.air_temperature": ("air of zone B", "degC", 24.797706, (24.65, 24.80)),
    "c.cooling_load": ("cooling of zone C", "W", 1541.3038, (1517.0, 1546.0)),
}
_OF_VALUE: Final = 0.002


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Air of two zones and the load of the third."""
    climate = CasePlace(25.8, -80.27, "Etc/GMT+5").climate({"air_temperature": np.full(40, _OUTDOORS)})
    _, table = simulated(data.building(_tree()), climate, list(_ANSWERS), "15min", "repeat")
    for output, (quantity, unit, reference, (low, high)) in _ANSWERS.items():
        value = float(table[output].iloc[-1])
        limits = around(reference, _OF_VALUE * reference)
        note = f"nine programs: {low:g} to {high:g} {unit}"
        yield VerdictLine("MZ320", quantity, unit, value, reference, limits, note=note)


def _tree() -> Tree:
    outdoors = {
        "outdoors": True, "convection": _OUTSIDE, "emissivity": 0.9, "absorptance": 0, "longwave": "none",
    }  # fmt: skip
    vertical = {"tilt": 90, "azimuth": 0}

    def faces(zone: str) -> Tree:
        return {"zone": zone, "convection": _FILM, "emissivity": 0.9}

    surfaces: Tree = {
        f"outer_{zone}": {
            "construction": "outer", "area": area, **vertical, "outside": outdoors, "inside": faces(zone),
        }
        for zone, area in _AREAS.items()
    }  # fmt: skip
    for first, second in ("ab", "bc"):
        common = {"construction": "common", "area": _COMMON, **vertical}
        surfaces[f"common_{first}{second}"] = common | {"outside": faces(first), "inside": faces(second)}
    zones: Tree = {
        zone: {"volume": 129.6, "longwave": "none", "gains": {"steady": {"power": power}}}
        for zone, power in _GAINS.items()
    }
    zones["c"] = {"volume": 129.6, "longwave": "none", "cooling": {"setpoint": _HELD}}
    return {
        "name": "MZ320",
        "site": {"latitude": 25.8, "longitude": -80.27, "altitude": 2, "timezone": "UTC-5"},
        "materials": {
            name: {"conductivity": value, "density": 1400, "specific_heat": 1000}
            for name, value in _CONDUCTIVITIES.items()
        },
        "constructions": {
            name: {"layers": [{"material": name, "thickness": _THICKNESS}]} for name in _CONDUCTIVITIES
        },
        "zones": zones,
        "surfaces": surfaces,
    }
