"""A room held at 30 degC on a slab of 144 m2 by ISO 13370, beside outdoor air of 10 degC."""

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
        if len(row) > max(columns.values()) and row[1] in _CASES
    }
