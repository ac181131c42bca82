"""Long-wave exchange of the six surfaces of a room, by view factors."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, Tree, simulated
from mascarin.verification.suites.catalogue.rp1052.room import (
    CLOSED,
    indoors,
    numbers,
    outdoors,
    site,
    steady_air,
)
from mascarin.verification.suites.verdict import VerdictLine, around

#: Film inside by the ratio of length to width [W/(m2 K)]: that of test 1.
_FILMS: Final = {1: 2.88, 2: 2.84, 5: 2.81, 10: 2.80, 20: 2.79}
#: Emissivity of the wall outdoors, of that opposite, and of the others, by test. [-]
_EMISSIVITIES: Final = {1: (0.9, 0.1, 0.3), 2: (0.9, 0.1, 0.1), 3: (0.9, 0.9, 0.9)}
_WIDTH: Final = 3.0
_OUTSIDE_FILM: Final = 10.22
#: [K], and of the load [-].
_SURFACE, _OF_LOAD = 0.05, 0.005
#: The wall that faces outdoors, that opposite, and the others.
_WALLS: Final = ("south", "north", "west", "east", "roof", "floor")


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Three sets of emissivities for five lengths."""
    for test, emissivities in _EMISSIVITIES.items():
        table = numbers(data, f"Test_IntRad-Test_{test}-cond_1000__Data", range(1, 14), 3)
        for row in table:
            ratio = int(row[0])
            if ratio not in _FILMS:
                continue
            outputs = ["room.net_load", *(f"{name}.inside_temperature" for name in _WALLS)]
            building = data.building(_tree(ratio, emissivities))
            _, run = simulated(building, steady_air(40.0, 30), outputs, "15min", "repeat")
            last = run.iloc[-1]
            outer, opposite, *sides = (float(last[f"{name}.inside_temperature"]) for name in _WALLS)
            values = outer, -float(last["room.net_load"]), opposite, float(np.mean(sides))
            quantities = ("wall outdoors", "load", "wall opposite", "others")
            references, programs = row[8:12], row[1:5]
            case = f"IntRad {test}, ratio {ratio}"
            for quantity, value, reference, program in zip(
                quantities, values, references, programs, strict=True
            ):
                load = quantity == "load"
                tolerance = _OF_LOAD * reference if load else _SURFACE
                limits = around(float(reference), float(tolerance))
                peers = {"EnergyPlus": float(program)}
                unit = "W" if load else "degC"
                yield VerdictLine(case, quantity, unit, value, float(reference), limits, peers)


def _tree(ratio: int, emissivities: tuple[float, float, float]) -> Tree:
    x, y, z = _WIDTH, _WIDTH * ratio, _WIDTH
    corners = {
        "south": [[0, 0, z], [0, 0, 0], [x, 0, 0], [x, 0, z]],
        "north": [[x, y, z], [x, y, 0], [0, y, 0], [0, y, z]],
        "west": [[0, y, z], [0, y, 0], [0, 0, 0], [0, 0, z]],
        "east": [[x, 0, z], [x, 0, 0], [x, y, 0], [x, y, z]],
        "roof": [[0, y, z], [0, 0, z], [x, 0, z], [x, y, z]],
        "floor": [[0, 0, 0], [0, y, 0], [x, y, 0], [x, 0, 0]],
    }
    by_wall = dict(zip(_WALLS, (*emissivities[:2], *4 * [emissivities[2]]), strict=True))
    surfaces = {
        name: {
            "construction": "wall",
            "vertices": vertices,
            "outside": outdoors(_OUTSIDE_FILM) if name == "south" else CLOSED,
            "inside": indoors(_FILMS[ratio], by_wall[name]),
        }
        for name, vertices in corners.items()
    }
    return {
        "name": "enclosure",
        "site": site(),
        "materials": {"plate": {"conductivity": 1000, "density": 1, "specific_heat": 100}},
        "constructions": {"wall": {"layers": [{"material": "plate", "thickness": 0.1}]}},
        "zones": {"room": {"volume": x * y * z, "longwave": "radiosity", "held": 20.0}},
        "surfaces": surfaces,
    }
