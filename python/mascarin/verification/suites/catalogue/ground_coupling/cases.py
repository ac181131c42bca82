"""A room held at 30 degC on a slab, by ISO 13370 and on a block of soil, beside outdoor air of 10 degC."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

#: Slab [m2], wall [m], air of the room and outdoors [degC].
_AREA, _WALL, _INSIDE, _OUTDOORS = 144.0, 0.24, 30.0, 10.0
#: Heat capacity of the soil by volume [J/(m3 K)]: 1490 kg/m3 and 1800 J/(kg K).
_HEAT_CAPACITY: Final = 1490.0 * 1800.0
_STRONG, _WEAK, _WINDY = 100.0, 7.95, 11.95
#: Film that makes the ground as warm as the air. [W/(m2 K)]
_SURFACE_AIR: Final = 1e5
#: Of what the authors of VA114 calculated by the standard. [-]
_OF_FORMULA: Final = 0.005
_NUMERICAL: Final = ("TRNSYS", "FLUENT", "MATLAB")
_HOURS: Final = 24 * 60


@dataclass(frozen=True)
class Case:
    """A case.

    Parameters
    ----------
    inside, outside : float or None
        Film inside, and on the ground outdoors; None where the ground is as warm as the air. [W/(m2 K)]
    conductivity : float
        Of the soil. [W/(m K)]
    aspect : float
        Length over width. [-]
    yearly : bool
        Whether the answer is the heat of a year [kWh], in which the swing outdoors adds to nothing, or that
        of a steady state [W].
    """

    inside: float
    outside: float | None
    conductivity: float = 1.9
    aspect: float = 1.0
    yearly: bool = False

    @property
    def tree(self) -> Tree:
        """Describe the room and its floor, before it is put on the ground; the slab is of the soil."""
        floor = {
            "construction": "floor",
            "area": _AREA,
            "tilt": 180,
            "outside": {"ground": {"mean": _OUTDOORS}},
            "inside": {"zone": "room", "convection": self.inside, "emissivity": 0.9},
        }
        return {
            "name": "ground",
            "site": {"latitude": 25.8, "longitude": -80.3, "altitude": 0, "timezone": "UTC-5"},
            "materials": {"plate": {"conductivity": 1000, "density": 1000, "specific_heat": 1000}},
            "constructions": {"floor": {"layers": [{"material": "plate", "thickness": 0.001}]}},
            "zones": {"room": {"volume": 388.8, "longwave": "none", "held": _INSIDE}},
            "surfaces": {"floor": floor},
        }


@dataclass(frozen=True)
class BlockCase:
    """A case on a block of soil.

    Parameters
    ----------
    inside, outside : float
        Film inside, and on the ground outdoors. [W/(m2 K)]
    size : (float, float)
        Length and width of the floor. [m]
    far, depth : float
        Soil beside the walls, and down to the deep temperature. [m]
    conductivity : float
        Of the soil. [W/(m K)]
    yearly : bool
        As of `Case`.
    """

    inside: float
    outside: float
    size: tuple[float, float] = (12.0, 12.0)
    far: float = 15.0
    depth: float = 15.0
    conductivity: float = 1.9
    yearly: bool = False

    @property
    def tree(self) -> Tree:
        """Describe the room, its floor and the soil below it."""
        length, width = self.size
        tree = Case(self.inside, None).tree
        tree["surfaces"]["floor"] |= {"area": length * width, "outside": {"soil": "below"}}
        tree["zones"]["room"]["volume"] = 2.7 * length * width
        tree["soil_blocks"] = {
            "below": {
                "length": length,
                "width": width,
                "wall_thickness": _WALL,
                "conductivity": self.conductivity,
                "heat_capacity": _HEAT_CAPACITY,
                "inside_film": self.inside,
                "outdoor_film": self.outside,
                "far": self.far,
                "depth": self.depth,
                "deep_temperature": _OUTDOORS,
                "before": {"mean": _OUTDOORS},
            }
        }
        return tree


_BLOCKS: Final = {
    "GC30b": BlockCase(_STRONG, _STRONG),
    "GC30c": BlockCase(_WEAK, _SURFACE_AIR, far=8.0),
    "GC60b": BlockCase(_WEAK, _STRONG),
    "GC65b": BlockCase(_WEAK, _WINDY),
    "GC40b": BlockCase(_STRONG, _STRONG, yearly=True),
    "GC45b": BlockCase(_STRONG, _STRONG, size=(36.0, 4.0), yearly=True),
    "GC50b": BlockCase(_STRONG, _STRONG, size=(80.0, 80.0), yearly=True),
    "GC55b": BlockCase(_STRONG, _STRONG, depth=2.0, yearly=True),
    "GC70b": BlockCase(_WEAK, _WINDY, yearly=True),
    "GC80b": BlockCase(_STRONG, _STRONG, conductivity=0.5, yearly=True),
    "GC40c": BlockCase(_WEAK, _SURFACE_AIR, far=8.0, yearly=True),
    "GC45c": BlockCase(_WEAK, _SURFACE_AIR, size=(36.0, 4.0), far=8.0, yearly=True),
    "GC80c": BlockCase(_WEAK, _SURFACE_AIR, far=8.0, conductivity=0.85, yearly=True),
}

_CASES: Final = {
    "GC30b": Case(_STRONG, _STRONG),
    "GC30c": Case(_WEAK, None),
    "GC60b": Case(_WEAK, _STRONG),
    "GC65b": Case(_WEAK, _WINDY),
    "GC40b": Case(_STRONG, _STRONG, yearly=True),
    "GC45b": Case(_STRONG, _STRONG, aspect=9.0, yearly=True),
    "GC70b": Case(_WEAK, _WINDY, yearly=True),
    "GC80b": Case(_STRONG, _STRONG, conductivity=0.5, yearly=True),
    "GC40c": Case(_WEAK, None, yearly=True),
    "GC45c": Case(_WEAK, None, aspect=9.0, yearly=True),
    "GC80c": Case(_WEAK, None, conductivity=0.85, yearly=True),
}


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Heat of the floor beside the formula of the standard, and beside numerical models."""
    formula = _table(data, "Whole_Bldg_Program_XComp", {"VA114": 4, "SUNREL-GC": 3, "EnergyPlus": 8})
    numerical = _table(data, "Numerical_Model_XComp", dict(zip(_NUMERICAL, (2, 3, 4), strict=True)))
    for name, case in _CASES.items():
        unit = "kWh" if case.yearly else "W"
        value = _heat(data, case)
        reference = formula[name]["VA114"]
        limits = around(reference, _OF_FORMULA * reference)
        yield VerdictLine(name, "floor, by ISO 13370", unit, value, reference, limits)
        verified = list(numerical[name].values())
        peers = numerical[name] | formula[name]
        limits = min(verified), max(verified)
        yield VerdictLine(
            name, "floor, numerical models", unit, value, float(np.mean(verified)), limits, peers
        )
    for name, block in _BLOCKS.items():
        verified = list(numerical[name].values())
        yield VerdictLine(
            name,
            "floor, block of soil",
            "kWh" if block.yearly else "W",
            _heat_of_block(data, block),
            float(np.mean(verified)),
            (min(verified), max(verified)),
            numerical[name] | formula.get(name, {}),
        )


def _heat_of_block(data: CaseData, case: BlockCase) -> float:
    """Steady heat of the floor on a block of soil [W], or of a year [kWh]."""
    from mascarin import steady

    climate = CasePlace(25.8, -80.3, "Etc/GMT+5").climate({"air_temperature": np.full(_HOURS, _OUTDOORS)})
    state = steady(data.building(case.tree), climate, outputs=["room.net_load"], step="1h")
    heat = state["room.net_load"]
    return 8.76 * heat if case.yearly else heat


def _heat(data: CaseData, case: Case) -> float:
    """Steady heat of the floor [W], or of a year [kWh]."""
    from mascarin.building import Building, Soil, on_ground

    resistance = 0.0 if case.outside is None else 1.0 / case.outside
    building = on_ground(
        Building.from_dict(case.tree),
        "floor",
        area=_AREA,
        aspect=case.aspect,
        wall_thickness=_WALL,
        mean=_OUTDOORS,
        amplitude=0.0,
        coldest_day=0.0,
        soil=Soil(case.conductivity, _HEAT_CAPACITY, "IEA ground coupling"),
        inside_resistance=1.0 / case.inside,
        outside_resistance=resistance,
    )
    climate = CasePlace(25.8, -80.3, "Etc/GMT+5").climate({"air_temperature": np.full(_HOURS, _OUTDOORS)})
    _, table = simulated(data.building(building.to_dict()), climate, ["room.net_load"], "1h", "repeat")
    heat = float(table["room.net_load"].iloc[-1])
    return 8.76 * heat if case.yearly else heat


def _table(data: CaseData, name: str, columns: dict[str, int]) -> dict[str, dict[str, float]]:
    """Numbers of programs by case, where they have one."""
    cells = csv.reader(io.StringIO(data.text(f"{name}.csv")))
    return {
        row[1]: {program: float(row[column]) for program, column in columns.items() if row[column]}
        for row in cells
        if len(row) > max(columns.values()) and row[1] in _BLOCKS | _CASES
    }
