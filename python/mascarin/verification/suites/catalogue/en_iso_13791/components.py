"""Conduction after a step, long-wave exchange of a room, and sunlit parts of windows."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around, largest

#: [K], and of the sunlit part of a window [-].
TOLERANCE: Final = 0.5
_SUNLIT: Final = 0.05
_AIR: Final = "room.air_temperature"
_CLOSED: Final = {"adiabatic": True}
#: Conductivity [W/(m K)], density [kg/m3] and specific heat [J/(kg K)].
_MATERIALS: Final = {
    "stone": (1.2, 2000, 1000),
    "insulation": (0.04, 50, 1000),
    "board": (0.14, 800, 1500),
}
#: Layers from outside to inside: material and thickness [m].
_WALLS: Final[dict[str, Sequence[tuple[str, float]]]] = {
    "COND-1": (("stone", 0.2),),
    "COND-2": (("insulation", 0.1),),
    "COND-3": (("stone", 0.2), ("insulation", 0.1), ("board", 0.005)),
    "COND-4": (("board", 0.005), ("insulation", 0.1), ("stone", 0.2)),
}
#: Length, width and height of the rooms with long-wave exchange [m]; in the last one the wall outdoors ends
#: at half its height.
_ROOMS: Final = {
    "IntRad-1": (1.0, 1.0, 1.0),
    "IntRad-2": (4.0, 6.0, 3.0),
    "IntRad-3": (30.0, 3.0, 3.0),
    "IntRad-4": (4.0, 6.0, 3.0),
}
#: Heat that the wall outdoors absorbs at its inside [W/m2], resistances of this wall and of others [m2 K/W].
_HEAT, _OUTER, _INNER = 100.0, 0.2, 1.0
_OUTSIDE_FILM: Final = 13.5

#: Corners of a plane. [m]
Corners = Sequence[tuple[float, float, float]]

_FRONT: Final[Corners] = ((1, 0, 0.5), (3, 0, 0.5), (3, 0, 2.5), (1, 0, 2.5))
_WEST_FIN: Final[Corners] = ((0, -1, 3), (0, 0, 3), (0, 0, 0), (0, -1, 0))
_EAST_FIN: Final[Corners] = ((4, 0, 3), (4, -1, 3), (4, -1, 0), (4, 0, 0))
_ABOVE: Final[Corners] = ((0, -1, 3), (0, 0, 3), (4, 0, 3), (4, -1, 3))
#: A window and the planes before it.
_SHADES: Final[dict[str, tuple[Corners, Sequence[Corners]]]] = {
    "Shade-1": (_FRONT, (_ABOVE,)),
    "Shade-2": (_FRONT, (_WEST_FIN, _EAST_FIN)),
    "Shade-3": (_FRONT, (_WEST_FIN, _ABOVE, _EAST_FIN)),
    "Shade-4": (
        ((2, -7, 0), (7, -7, 0), (7, -7, 5), (2, -7, 5)),
        (((12, -12, 10), (-3, -12, 10), (-3, -12, 0), (12, -12, 0)),),
    ),
    "Shade-5": (
        ((2, -1, 0.5), (2, 1, 0.5), (2, 1, 2.5), (2, -1, 2.5)),
        (
            ((2, 2, 3), (3, 2, 3), (3, 2, 0), (2, 2, 0)),
            ((3, -2, 0), (2, -2, 0), (2, -2, 3), (3, -2, 3)),
            ((3, -2, 3), (2, -2, 3), (2, 2, 3), (3, 2, 3)),
        ),
    ),
    "Shade-6": (
        ((2, -12, 0), (2, -7, 0), (2, -7, 5), (2, -12, 5)),
        (((7, -2, 10), (7, -17, 10), (7, -17, 0), (7, -2, 0)),),
    ),
}


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Conduction, long-wave exchange, shades."""
    table = list(csv.DictReader(io.StringIO(data.text("reference.csv"))))
    for case, layers in _WALLS.items():
        yield from _conduction(data, case, layers, [row for row in table if row["case"] == case])
    for case in _ROOMS:
        (row,) = (row for row in table if row["case"] == case.replace("-", ""))
        reference, program = float(row["reference"]), float(row["energyplus_8"])
        limits = around(reference, TOLERANCE)
        yield VerdictLine(
            case, "room air", "degC", _radiant(data, case), reference, limits, {"EnergyPlus 8": program}
        )
    for case in _SHADES:
        yield _shade(data, case, [row for row in table if row["case"] == case])


def _description(site: Tree, surfaces: Tree, layers: Sequence[tuple[str, float]], **more: Any) -> Tree:
    keys = ("conductivity", "density", "specific_heat")
    names = dict.fromkeys(name for name, _ in layers)
    return {
        "name": "component",
        "site": {"altitude": 0, **site},
        "materials": {name: dict(zip(keys, _MATERIALS[name], strict=True)) for name in names},
        "constructions": {
            "wall": {"layers": [{"material": name, "thickness": depth} for name, depth in layers]}
        },
        "zones": {"room": {"volume": 0.01, "longwave": "none"}},
        "surfaces": surfaces,
        **more,
    }


def _conduction(
    data: CaseData, case: str, layers: Sequence[tuple[str, float]], rows: list[dict[str, str]]
) -> Iterator[VerdictLine]:
    wall = {
        "construction": "wall",
        "area": 10,
        "tilt": 90,
        "azimuth": 0,
        "outside": {"measured": "step", "convection": 8.0},
        "inside": {"zone": "room", "convection": 2.5, "emissivity": 0.9},
    }
    site = {"latitude": 52.0, "longitude": -0.5, "timezone": "UTC"}
    # Hourly values: the air rises over the first hour.
    columns = {"air_temperature": np.full(124, 20.0), "step": np.r_[20.0, np.full(123, 30.0)]}
    climate = CasePlace(52.0, -0.5, "UTC").climate(columns, extra=["step"])
    building = data.building(_description(site, {"wall": wall}, layers))
    hours, run = simulated(building, climate, [_AIR], "5min", 20.0)
    for row in rows:
        after = float(row["at"].split()[0])
        value = float(np.interp(after, hours, run[_AIR].to_numpy()))
        reference, program = float(row["reference"]), float(row["energyplus_8"])
        limits = around(reference, TOLERANCE)
        yield VerdictLine(
            case, f"room air, {row['at']}", "degC", value, reference, limits, {"EnergyPlus 8": program}
        )


def _radiant(data: CaseData, case: str) -> float:
    """Air of a room [degC]: what the wall absorbs inside is the heat of air outside that is warmer by it."""
    x, y, z = _ROOMS[case]
    corners = {
        "south": [[0, 0, z], [0, 0, 0], [x, 0, 0], [x, 0, z]],
        "north": [[x, y, z], [x, y, 0], [0, y, 0], [0, y, z]],
        "west": [[0, y, z], [0, y, 0], [0, 0, 0], [0, 0, z]],
        "east": [[x, 0, z], [x, 0, 0], [x, y, 0], [x, y, z]],
        "roof": [[0, y, z], [0, 0, z], [x, 0, z], [x, y, z]],
        "floor": [[0, 0, 0], [0, y, 0], [x, y, 0], [x, 0, 0]],
    }
    if case == "IntRad-4":
        half = 0.5 * z
        corners["south"] = [[0, 0, half], [0, 0, 0], [x, 0, 0], [x, 0, half]]
        corners["above"] = [[0, 0, z], [0, 0, half], [x, 0, half], [x, 0, z]]
    surfaces = {
        name: {
            "construction": "outer" if name == "south" else "inner",
            "vertices": vertices,
            "outside": {"measured": "warm" if name == "south" else "room", "convection": _OUTSIDE_FILM},
            "inside": {"zone": "room", "convection": 2.5, "emissivity": 0.9},
        }
        for name, vertices in corners.items()
    }
    site = {"latitude": 52.0, "longitude": -0.5, "timezone": "UTC"}
    tree = _description(site, surfaces, ())
    tree["materials"] = {
        name: {"kind": "resistance", "resistance": value}
        for name, value in (("outer", _OUTER), ("inner", _INNER))
    }
    tree["constructions"] = {name: {"layers": [{"material": name}]} for name in ("outer", "inner")}
    tree["zones"]["room"] = {"volume": math.prod((x, y, z)), "longwave": "radiosity"}
    count = 100
    columns = {
        "air_temperature": np.full(count, 20.0),
        "warm": np.full(count, 30.0 + _HEAT * (_OUTER + 1.0 / _OUTSIDE_FILM)),
        "room": np.full(count, 20.0),
    }
    climate = CasePlace(52.0, -0.5, "UTC").climate(columns, extra=["warm", "room"])
    _, run = simulated(data.building(tree), climate, [_AIR], "15min", "repeat")
    return float(run[_AIR].iloc[-1])


def _shade(data: CaseData, case: str, rows: list[dict[str, str]]) -> VerdictLine:
    window, planes = _SHADES[case]
    count = 9 * 60
    dark = np.zeros(count)
    columns = {
        "air_temperature": np.full(count, 20.0),
        "direct_normal": np.full(count, 1000.0),
        "diffuse_horizontal": dark,
        "global_horizontal": dark,
    }
    # All cases end at noon or later in the day.
    climate = CasePlace(52.0, -0.5, "UTC", "2001-06-15 06:00", "1min").climate(
        columns, instant=list(columns)[1:]
    )
    irradiance = []
    for shades in (planes, ()):
        face = [list(map(float, corner)) for corner in window]
        outside = {"outdoors": True, "convection": _OUTSIDE_FILM, "emissivity": 0.9, "absorptance": 1.0}
        plain = {"construction": "wall", "area": 1, "tilt": 90, "azimuth": 0, "outside": _CLOSED}
        surfaces = {
            "wall": {
                "construction": "wall",
                "vertices": face,
                "outside": outside | {"longwave": "none"},
                "inside": _CLOSED,
            },
            "other": plain | {"inside": {"zone": "room", "convection": 2.5, "emissivity": 0.9}},
        }
        site = {"latitude": 52.0, "longitude": -0.5, "timezone": "UTC", "ground_reflectance": 0}
        tree = _description(site | {"diffuse": "isotropic"}, surfaces, _WALLS["COND-1"])
        if shades:
            tree["shades"] = {
                f"shade{number}": {"vertices": [list(map(float, corner)) for corner in plane]}
                for number, plane in enumerate(shades)
            }
        hours, run = simulated(data.building(tree), climate, ["wall.incident_solar"], "1min", 20.0)
        irradiance.append(run["wall.incident_solar"].to_numpy())
    behind, free = irradiance
    sunlit = np.where(free > 1.0, behind / np.maximum(free, 1.0), 0.0)
    stamps = [row["at"].split()[1].split(":") for row in rows]
    times = np.array([float(hour) + float(minute) / 60.0 for hour, minute, _ in stamps])
    values = np.interp(times, hours + 6.0 - 0.5 / 60.0, sunlit)
    references = [float(row["reference"]) for row in rows]
    return largest(case, f"sunlit part, worst of {len(times)}", "-", (times, values, references), _SUNLIT)
