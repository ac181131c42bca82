"""Rooms of two shapes on a hot day that repeats, three constructions and three ventilations."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.catalogue.en_iso_13791.components import TOLERANCE
from mascarin.verification.suites.catalogue.en_iso_13791.days import DAYS, Day
from mascarin.verification.suites.verdict import VerdictLine, around

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

#: Width (of the facade), depth and height. [m]
_WIDTH, _DEPTH, _HEIGHT = 3.6, 5.5, 2.8
_FLOOR: Final = _WIDTH * _DEPTH
_PARTITIONS: Final = (2.0 * _DEPTH + _WIDTH) * _HEIGHT
#: Films: of walls inside, of floors, of ceilings, outside. [W/(m2 K)]
_FILM, _DOWN, _UP, _OUTSIDE = 2.5, 0.7, 5.0, 13.5
#: Conductivity [W/(m K)], density [kg/m3], specific heat [J/(kg K)].
_MATERIALS: Final = {
    "outer": (0.99, 1800, 850),
    "insulation": (0.04, 30, 850),
    "masonry": (0.79, 1600, 850),
    "plaster": (0.70, 1400, 850),
    "gypsum": (0.21, 900, 850),
    "plastic": (0.23, 1500, 1500),
    "cement": (1.4, 2000, 850),
    "wool": (0.04, 50, 850),
    "concrete": (2.1, 2400, 850),
    "acoustic": (0.06, 400, 840),
    "covering": (0.23, 1500, 1300),
}
#: A construction: material and thickness [m].
Layers = Sequence[tuple[str, float]]

#: From outside to inside; floors and roofs from their top.
_FACADE: Final[Layers] = (("outer", 0.115), ("insulation", 0.06), ("masonry", 0.175), ("plaster", 0.015))
#: Half of a symmetric wall.
_PARTITION: Final[Layers] = (("insulation", 0.05), ("gypsum", 0.012))
_SLAB: Final[Layers] = (("plastic", 0.004), ("cement", 0.06), ("wool", 0.04), ("concrete", 0.18))
_SLAB_WITH_CEILING: Final[Layers] = (*_SLAB, ("wool", 0.10), ("acoustic", 0.02))
_ROOF: Final[Layers] = (("covering", 0.004), ("wool", 0.08), ("concrete", 0.20))
#: Heat of persons and equipment by hour [W/m2], half of it radiant.
_GAINS: Final = (*[0.0] * 7, *[1.0] * 4, *[10.0] * 4, *[1.0] * 3, *[15.0] * 4, 10.0, 0.0)
#: Air changes by hour. [1/h]
_AIR: Final = {"a": [1.0] * 24, "b": [10.0] * 6 + [0.5] * 12 + [10.0] * 6, "c": [10.0] * 24}
_QUANTITIES: Final = ("operative, highest", "operative, mean", "operative, lowest")
_STEPS: Final = 288


@dataclass(frozen=True)
class Sunshine:
    """Where the sun behind the window goes, which the public text does not state.

    Parameters
    ----------
    to_air : float
        Part that heats the air at once. [-]
    to_floor : float or None
        Part of the rest on the floor, with a tenth of the remainder on the ceiling and the others by area;
        None: all by area. Not for slabs with both sides in the room, which are no targets of shares. [-]
    """

    to_air: float = 0.1
    to_floor: float | None = None


#: Written down before the cases were run.
SUNSHINE: Final = Sunshine()


@dataclass(frozen=True)
class Case:
    """A case by its name, such as A.1.b: shape, construction, ventilation."""

    name: str

    @property
    def day(self) -> Day:
        """Of its shape."""
        return DAYS[self.name[0]]

    @property
    def window(self) -> float:
        """Area of glass. [m2]"""
        return 3.5 if self.name[0] == "A" else 7.0

    @property
    def panes(self) -> int:
        """Number of panes."""
        return 1 if self.name[0] == "A" else 2

    @property
    def under_roof(self) -> bool:
        """Whether a roof is above; else the floor of the room above is its ceiling."""
        return self.name[2] == "3"

    @property
    def slab(self) -> Layers:
        """Of the floor, from its top."""
        return _SLAB_WITH_CEILING if self.name[2] == "1" else _SLAB

    @property
    def sides(self) -> dict[str, float]:
        """Areas of the sides that look into the room. [m2]"""
        horizontal = ("floor.inside", "roof.inside") if self.under_roof else ("slab.outside", "slab.inside")
        return {
            "window.inside": self.window,
            "facade.inside": _WIDTH * _HEIGHT - self.window,
            "partitions.inside": _PARTITIONS,
            horizontal[0]: _FLOOR,
            horizontal[1]: _FLOOR,
        }

    def tree(self, sunshine: Sunshine) -> Tree:
        """Describe the room."""
        keys = ("conductivity", "density", "specific_heat")
        changes = _AIR[self.name[4]]
        zone: Tree = {
            "volume": _FLOOR * _HEIGHT,
            "longwave": "linearised",
            "solar_to_air": sunshine.to_air,
            "gains": {"use": {"power": 15.0 * _FLOOR, "radiative": 0.5, "schedule": "gains"}},
            "ventilation": {"fan": {"air_changes": max(changes), "schedule": "fan"}},
        }
        if sunshine.to_floor is not None and self.under_roof:
            zone["sun"] = {"kind": "shares", "shares": self._shares(sunshine.to_floor)}
        return {
            "name": self.name,
            "site": {
                "latitude": self.day.latitude, "longitude": 0.0, "altitude": 0, "timezone": "UTC",
                "air_density": 1.2, "ground_reflectance": 0, "diffuse": "isotropic",
            },
            "materials": {name: dict(zip(keys, values, strict=True)) for name, values in _MATERIALS.items()},
            "schedules": {"gains": _schedule(_GAINS), "fan": _schedule(changes)},
            "zones": {"room": zone},
            **self._envelope(),
            **self._glass(),
        }  # fmt: skip

    def _envelope(self) -> Tree:
        closed = {"adiabatic": True}
        vertical = {"tilt": 90, "azimuth": 270}
        # Walls that look the way of the window see none of its sun.
        opposite = {"tilt": 90, "azimuth": 90}
        walls: dict[str, Layers] = {"facade": _FACADE, "partitions": _PARTITION}
        facade = _outdoors(0.6, "west")
        surfaces: Tree = {
            "facade": {"area": _WIDTH * _HEIGHT, **vertical, "outside": facade, "inside": _indoors(_FILM)},
            "partitions": {"area": _PARTITIONS, **opposite, "outside": closed, "inside": _indoors(_FILM)},
        }
        if self.under_roof:
            walls |= {"floor": self.slab[::-1], "roof": _ROOF}
            roof = _outdoors(0.9, "level")
            surfaces |= {
                "floor": {"area": _FLOOR, "tilt": 180, "outside": closed, "inside": _indoors(_DOWN)},
                "roof": {"area": _FLOOR, "tilt": 0, "outside": roof, "inside": _indoors(_UP)},
            }
        else:
            walls["slab"] = self.slab
            slab = {"outside": _indoors(_DOWN), "inside": _indoors(_UP), "internal_mass": True}
            surfaces["slab"] = {"area": _FLOOR, "tilt": 0, **slab}
        return {
            "constructions": {
                name: {
                    "layers": [
                        {"material": material, "thickness": depth, "name": f"layer{number}"}
                        for number, (material, depth) in enumerate(layers)
                    ]
                }
                for name, layers in walls.items()
            },
            "surfaces": {name: {"construction": name, **surface} for name, surface in surfaces.items()},
        }

    def _glass(self) -> Tree:
        transmittance, reflectance, absorptance = 0.84, 0.08, 0.08
        if self.panes == 1:
            through, absorbed = transmittance, [absorptance]
        else:
            again = 1.0 - reflectance**2
            through = transmittance**2 / again
            outer = absorptance * (1.0 + transmittance * reflectance / again)
            absorbed = [outer, transmittance * absorptance / again]
        # The glass has no resistance of its own.
        panes = [{"thickness": 0.001, "conductivity": 100.0, "emissivity": 0.9} for _ in absorbed]
        glazing: Tree = {
            "kind": "panes",
            "panes": panes,
            "angular": {
                "angles": [0, 90],
                "transmittance": [through] * 2,
                "absorptance": [[value] * 2 for value in absorbed],
            },
        }
        if self.panes == 2:
            glazing["gaps"] = [{"conductance": 1.0 / 0.173}]
        blind = {"position": "outside", "transmittance": 0.2, "reflectance": 0.5, "resistance": 0.08}
        window = {
            "surface": "facade",
            "glazing": "glass",
            "area": self.window,
            "blind": blind,
            "outside": {"convection": _OUTSIDE, "longwave": "none", "irradiance": "west"},
            "inside": {"convection": _FILM},
        }
        return {"glazings": {"glass": glazing}, "windows": {"window": window}}

    def _shares(self, to_floor: float) -> dict[str, float]:
        remainder = 1.0 - to_floor
        facade = _WIDTH * _HEIGHT - self.window
        walls = {"facade": facade, "partitions": _PARTITIONS}
        shares = {name: 0.9 * remainder * area / sum(walls.values()) for name, area in walls.items()}
        return shares | {"floor": to_floor, "roof": 0.1 * remainder}

    def operative(self, data: CaseData, sunshine: Sunshine) -> Array:
        """Mean of air and of surfaces by area over the last day. [degC]"""
        outputs = ["room.air_temperature", *(f"{side}_temperature" for side in self.sides)]
        building = data.building(self.tree(sunshine))
        _, table = simulated(building, _climate(self.day), outputs, "5min", "repeat")
        last = table.iloc[-_STEPS:]
        areas = np.array(list(self.sides.values()))
        surfaces = last[outputs[1:]].to_numpy() @ areas / areas.sum()
        operative: Array = 0.5 * last[outputs[0]].to_numpy() + 0.5 * surfaces
        return operative


def lines(data: CaseData, sunshine: Sunshine = SUNSHINE) -> Iterator[VerdictLine]:
    """Highest, mean and lowest operative temperature of each case.

    Parameters
    ----------
    data : CaseData
        Reference numbers.
    sunshine : Sunshine
        Where the sun behind the window goes.
    """
    for file in ("A", "B_2.4mm"):
        for row in csv.reader(io.StringIO(data.text(f"Whole_Calc_Method_Case_{file}.csv"))):
            if not (row and row[0].startswith("Test ")):
                continue
            case = Case(row[0].removeprefix("Test ").strip())
            operative = case.operative(data, sunshine)
            values = operative.max(), operative.mean(), operative.min()
            references, programs = row[2:5], row[6:9]
            for quantity, value, reference, program in zip(
                _QUANTITIES, values, map(float, references), map(float, programs), strict=True
            ):
                limits = around(reference, TOLERANCE)
                peers = {"EnergyPlus 8": program}
                yield VerdictLine(case.name, quantity, "degC", float(value), reference, limits, peers)


def _indoors(film: float) -> Tree:
    return {"zone": "room", "convection": film, "emissivity": 0.9, "absorptance": 1.0}


def _outdoors(absorptance: float, irradiance: str) -> Tree:
    return {
        "outdoors": True, "convection": _OUTSIDE, "emissivity": 0.9, "absorptance": absorptance,
        "longwave": "none", "irradiance": irradiance,
    }  # fmt: skip


def _schedule(hourly: Sequence[float]) -> dict[str, Any]:
    most = max(hourly)
    steps = [{"at": f"{hour:02d}:00", "value": value / most} for hour, value in enumerate(hourly)]
    return {"kind": "fraction", "days": {"all": steps}}


def _climate(day: Day) -> Climate:
    """The day three times; its numbers are values at the ends of hours."""

    def repeated(hourly: Array) -> Array:
        return np.concatenate(([hourly[-1]], np.tile(hourly, 3)))

    west, level = day.on_facade, day.on_roof
    sky = np.maximum(level, np.where(west > 0.0, 5.0, 0.0))
    columns = {
        "air_temperature": repeated(np.array(day.air)),
        "diffuse_horizontal": repeated(sky),
        "global_horizontal": repeated(sky),
        "direct_normal": np.zeros(73),
        "west": repeated(west),
        "level": repeated(level),
    }
    radiation = ("diffuse_horizontal", "direct_normal", "global_horizontal")
    return CasePlace(day.latitude, 0.0, "UTC", "2001-06-15").climate(
        columns, extra=["west", "level"], instant=radiation
    )
