"""Test functions 3 to 9: conduction, storage, ventilation, absorbed sun, windows, gains, shading."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.catalogue.simquality.rooms import (
    INSULATED,
    SURFACES,
    VOLUME,
    Layers,
    air_alone,
    construction,
    epw,
    indoors,
    materials,
    outdoors,
    room,
    site,
    with_sun,
)
from mascarin.verification.suites.catalogue.simquality.score import Reference
from mascarin.verification.suites.verdict import VerdictLine

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_FOLDERS: Final = {
    "TF03": "TF03-Waermeleitung",
    "TF04": "TF04-WaermeleitungSpeicherung",
    "TF05": "TF05-Lueftung",
    "TF06": "TF06-WaermeleitungStrahlung",
    "TF07": "TF07-Fenster",
    "TF08": "TF08-InterneLasten",
    "TF09": "TF09-Verschattung",
}
_PROGRAMS: Final = ("TRNSYS", "IDAICE", "TAS", "NANDRAD", "THERAKLES", "ETU", "Aixlib")
#: Score from which a series is "good", and the largest one.
_GOOD: Final = (80.0, 100.0)
_AIR: Final = "room.air_temperature"
_STEP: Final = "10min"
_UNINSULATED: Final[Layers] = (("stone", 0.2),)
#: Dry air of 15 degC at sea level [kg/m3] and its heat [J/(kg K)], those of a site at altitude 0.
_DENSITY, _SPECIFIC_HEAT = 101325.0 / (287.042 * 288.15), 1006.0
#: Area [m2] and transmittance [W/(m2 K)] of the window between its surfaces.
_WINDOW_AREA, _WINDOW_CONDUCTANCE = 5.04, 2.60355
#: Part of the sun behind a window that heats the air, see the settings of the suite. [-]
_SUN_TO_AIR: Final = 0.5


@dataclass(frozen=True)
class Judge:
    """Makes lines of the series of a test function."""

    function: str
    reference: Reference
    peers: dict[str, dict[str, float]]

    @classmethod
    def of(cls, data: CaseData, function: str) -> Judge:
        """Read the reference and the scores of other programs."""
        peers: dict[str, dict[str, float]] = {}
        rows = csv.DictReader(io.StringIO(data.text("all_tools_scores.tsv")), delimiter="\t")
        for row in rows:
            score = float(row["SimQ-Score [%]"])  # negative: no result
            if row["Test Case"][:2] == function[2:] and row["ToolID"] in _PROGRAMS and score >= 0.0:
                peers.setdefault(row["Variable"], {})[row["ToolID"]] = score
        return cls(function, Reference.read(data, _FOLDERS[function]), peers)

    def line(self, case: str, variable: str, hours: Array, values: Array) -> VerdictLine:
        """Score of a series."""
        score = self.reference.score(variable, hours, values)
        peers = self.peers.get(variable, {})
        return VerdictLine(f"{self.function}.{case}", f"score of {variable}", "-", score, 100.0, _GOOD, peers)


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """All test functions."""
    for function, run in _RUNS.items():
        yield from run(data, Judge.of(data, function))


def _conduction(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    walls: dict[int, Layers] = {
        1: _UNINSULATED,
        2: (("insulation", 0.1),),
        3: (("stone", 0.2), ("insulation", 0.1), ("board", 0.005)),
        4: INSULATED,
    }
    climate = air_alone(epw(data, "SIMQ_TF03_Klima")[:, 0], 300)
    for number, layers in walls.items():
        building = data.building(room(layers, volume=0.01))
        hours, table = simulated(building, climate, [_AIR], "5min", 20.0)
        yield judge.line(str(number), f"Variante {number}", hours, table[_AIR].to_numpy())


def _storage(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    runs: dict[int, tuple[Tree, str, int, float]] = {
        1: (_half_closed(), "SIMQ_TF04_Sprung", 1500, 20.0),
        2: (_stone_under_roof(), "SIMQ_TF04_Periodisch", 1500, 20.0),
        3: (_two_rooms(), "SIMQ_TF04_Periodisch", 1500, 20.0),
        4: (_two_rooms(), "SIMQ_TF04_Potsdam", 5300, 5.0),
    }
    for number, (tree, weather, end, initial) in runs.items():
        rooms = list(tree["zones"])
        outputs = [f"{zone}.air_temperature" for zone in rooms]
        climate = air_alone(epw(data, weather)[:, 0], end)
        hours, table = simulated(data.building(tree), climate, outputs, _STEP, initial)
        for zone, output in zip("AB", outputs, strict=False):
            yield judge.line(str(number), f"Variante {number} Raum {zone}", hours, table[output].to_numpy())


def _half_closed() -> Tree:
    """Three surfaces of insulation to outdoors, three of stone that nothing leaves."""
    tree = room((("insulation", 0.1),))
    half = (("stone", 0.1),)
    tree["materials"] |= materials(half)
    tree["constructions"]["closed"] = construction(half)
    for name in ("north", "south", "floor"):
        tree["surfaces"][name] |= {"construction": "closed", "outside": {"adiabatic": True}}
    return tree


def _stone_under_roof() -> Tree:
    """Five surfaces of stone under an insulated roof."""
    tree = room(_UNINSULATED)
    roof = (("insulation", 0.1),)
    tree["materials"] |= materials(roof)
    tree["constructions"]["roof"] = construction(roof)
    tree["surfaces"]["roof"]["construction"] = "roof"
    return tree


def _two_rooms() -> Tree:
    """A room insulated inside and one insulated outside, with a wall of stone between them."""
    inner = (("stone", 0.2), ("insulation", 0.1), ("board", 0.005))
    surfaces: Tree = {}
    for zone, wall, common in (("a", "inner", "west"), ("b", "outer", "east")):
        for name, (area, tilt, azimuth) in SURFACES.items():
            if name != common:
                surfaces[f"{name}_{zone}"] = {
                    "construction": wall, "area": area, "tilt": tilt, "azimuth": azimuth,
                    "outside": outdoors(), "inside": indoors(zone),
                }  # fmt: skip
    area, tilt, azimuth = SURFACES["west"]
    surfaces["between"] = {
        "construction": "between", "area": area, "tilt": tilt, "azimuth": azimuth,
        "outside": indoors("b"), "inside": indoors("a"),
    }  # fmt: skip
    walls = {"inner": inner, "outer": INSULATED, "between": _UNINSULATED}
    return {
        "name": "simquality",
        "site": site(),
        "materials": materials(*walls.values()),
        "constructions": {name: construction(layers) for name, layers in walls.items()},
        "zones": {zone: {"volume": VOLUME, "longwave": "none"} for zone in "ab"},
        "surfaces": surfaces,
    }


def _ventilation(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    outdoor = epw(data, "SIMQ_TF04_Potsdam")[:, 0]
    outdoor[:468] = 5.0  # the hours before the air of Potsdam begins
    night: Tree = {
        "kind": "fraction",
        "seasons": [
            {"until": "05-31", "days": _days((0, 0.25))},
            {"until": "09-30", "days": _days((0, 1.0), (6, 0.25), (20, 1.0))},
            {"until": "12-31", "days": _days((0, 0.25))},
        ],
    }
    units = {"unit": {"air_changes": 2.0, "schedule": "night"}}
    zones: dict[int, tuple[Tree, Tree]] = {
        1: ({}, {}),
        2: ({"infiltration": 2.0}, {}),
        3: ({"ventilation": units}, {"schedules": {"night": night}}),
    }
    layers: Layers = (("good_insulation", 0.3), ("stone", 0.2))
    for number, (zone, more) in zones.items():
        building = data.building(room(layers, zone=zone, **more))
        hours, table = simulated(building, air_alone(outdoor, 5300), [_AIR], _STEP, 5.0)
        air = table[_AIR].to_numpy()
        yield judge.line(str(number), f"Variante {number} Raumlufttemperatur", hours, air)
        if number == 1:
            continue
        rate = np.full(len(hours), 2.0) if number == 2 else _night_rate(hours)
        outside = np.interp(hours, np.arange(len(outdoor) + 1), np.r_[outdoor[0], outdoor])
        heat = _DENSITY * _SPECIFIC_HEAT * VOLUME / 3600.0 * rate * (outside - air)
        hour, mean = _hourly_between(hours, heat)
        yield judge.line(str(number), f"Variante {number} Lueftungswaermestrom", hour, mean)


def _night_rate(hours: Array) -> Array:
    """Air changes of case 3: in summer more at night. [1/h]"""
    day, hour = hours // 24, hours % 24
    summer, dark = (day >= 151) & (day < 273), (hour < 6) | (hour >= 20)
    return np.where(summer & dark, 2.0, 0.5)


def _days(*changes: tuple[int, float]) -> Tree:
    return {"all": [{"at": f"{hour:02d}:00", "value": value} for hour, value in changes]}


def _absorbed_sun(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    words = {
        "Dach": "roof", "Boden": "floor", "Nordwand": "north", "Ostwand": "east", "Südwand": "south",
        "Westwand": "west",
    }  # fmt: skip
    climate = with_sun(epw(data, "SIMQ_TF06_Klima"), 8400)
    walls: dict[int, Layers] = {1: _UNINSULATED, 2: (("insulation", 0.1),)}
    for number, layers in walls.items():
        outputs = [
            f"{name}.{output}"
            for name in words.values()
            for output in ("outside_absorbed_solar", "inside_temperature")
        ]
        building = data.building(room(layers, absorptance=0.6))
        hours, table = simulated(building, climate, [_AIR, *outputs], _STEP, 20.0)
        line = partial(judge.line, str(number))
        yield line(f"Variante {number} Raumlufttemperatur", hours, table[_AIR].to_numpy())
        for word, name in words.items():
            sun = _hourly_of_steps(hours, table[f"{name}.outside_absorbed_solar"].to_numpy())
            yield line(f"Variante {number} abs. Strahlung {word}", *sun)
            surface = table[f"{name}.inside_temperature"].to_numpy()
            yield line(f"Variante {number} Oberflächen-Temp. {word}", hours, surface)


def _windows(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    angles = {
        1: ([0, 90], [0.0, 0.0]),
        2: ([0, 90], [0.6, 0.6]),
        3: (list(range(0, 100, 10)), [0.6, 0.6, 0.6, 0.6, 0.588, 0.564, 0.516, 0.414, 0.222, 0.0]),
    }
    inside, outside, sun = (
        f"window.{name}" for name in ("inside_temperature", "outside_temperature", "transmitted_solar")
    )
    for number, (incidence, transmittance) in angles.items():
        weather = epw(data, f"SIMQ_TF07_Klima{'ABC'[number - 1]}")
        climate = air_alone(weather[:, 0], 4400) if number == 1 else with_sun(weather, 4400)
        building = data.building(_with_window(incidence, transmittance))
        hours, table = simulated(building, climate, [_AIR, inside, outside, sun], _STEP, 20.0)
        line = partial(judge.line, str(number))
        yield line(f"Variante 7.{number} Raumlufttemperatur", hours, table[_AIR].to_numpy())
        conducted = _WINDOW_CONDUCTANCE * (table[outside] - table[inside]).to_numpy()
        yield line(f"Variante 7.{number} Wärmeleitung Fenster", *_hourly_of_steps(hours, conducted))
        if number > 1:
            through = table[sun].to_numpy() / _WINDOW_AREA
            yield line(f"Variante 7.{number} Trans.Strahlung Fenster", *_hourly_of_steps(hours, through))


def _with_window(angles: list[int], transmittance: list[float]) -> Tree:
    """A window of one pane that transmits what a table says and absorbs nothing."""
    pane = {"thickness": 0.01, "conductivity": 0.01 * _WINDOW_CONDUCTANCE, "emissivity": 0.84}
    angular = {"angles": angles, "transmittance": transmittance, "absorptance": [[0.0] * len(angles)]}
    window = {
        "surface": "south",
        "glazing": "pane",
        "area": _WINDOW_AREA,
        "outside": {"convection": 8.0, "longwave": "none"},
        "inside": {"convection": 2.5},
    }
    areas = {name: area for name, (area, _, _) in SURFACES.items()}
    areas["south"] -= _WINDOW_AREA
    total = sum(areas.values())
    shares = {name: area / total for name, area in areas.items()}
    zone = {"solar_to_air": _SUN_TO_AIR, "sun": {"kind": "shares", "shares": shares}}
    glazings = {"pane": {"kind": "panes", "panes": [pane], "angular": angular}}
    return room(INSULATED, zone=zone, glazings=glazings, windows={"window": window})


def _gains(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    constant, off = _days((0, 1.0)), _days((0, 0.0))
    powers = [0] * 6 + [25, 58, 83, 83, 83, 67, 67, 83, 83, 83, 58, 25] + [0] * 6
    daily = _days(*((hour, power / 83) for hour, power in enumerate(powers)))
    climate = air_alone(epw(data, "SimQuality_TF08_Klima")[:, 0], 3000)
    # Power [W], radiative part [-], course of a day.
    cases = {1: (400, 0.0, constant), 2: (400, 1.0, constant), 3: (830, 0.0, daily), 4: (830, 1.0, daily)}
    for number, (power, radiative, days) in cases.items():
        seasons = [{"until": "01-31", "days": off}, {"until": "12-31", "days": days}]
        zone = {"gains": {"machine": {"power": power, "radiative": radiative, "schedule": "on"}}}
        schedules = {"on": {"kind": "fraction", "seasons": seasons}}
        building = data.building(room(INSULATED, zone=zone, schedules=schedules))
        surface = "north.inside_temperature"
        hours, table = simulated(building, climate, [_AIR, surface], _STEP, 20.0)
        dot = "." if number == 4 else " "  # the name in the reference
        line = partial(judge.line, str(number))
        yield line(f"Variante 8.{number}{dot}Raumlufttemperatur", hours, table[_AIR].to_numpy())
        yield line(f"Variante 8.{number} Oberflächentemperatur", hours, table[surface].to_numpy())


#: A wall in the place of a window, and what shades it: corners. [m]
_WALL: Final = ((1, 0, 0.5), (3, 0, 0.5), (3, 0, 2.5), (1, 0, 2.5))
_OVERHANG: Final = ((0, -1, 3), (0, 0, 3), (4, 0, 3), (4, -1, 3))
_WEST_FIN: Final = ((0, -1, 3), (0, 0, 3), (0, 0, 0), (0, -1, 0))
_EAST_FIN: Final = ((4, 0, 3), (4, -1, 3), (4, -1, 0), (4, 0, 0))
_SHADED: Final[dict[int, tuple[Any, tuple[Any, ...]]]] = {
    1: (_WALL, (_OVERHANG,)),
    2: (_WALL, (_WEST_FIN, _EAST_FIN)),
    3: (_WALL, (_WEST_FIN, _OVERHANG, _EAST_FIN)),
    4: (
        ((2, -7, 0), (7, -7, 0), (7, -7, 5), (2, -7, 5)),
        (((12, -12, 10), (-3, -12, 10), (-3, -12, 0), (12, -12, 0)),),
    ),
    5: (
        ((2, -1, 0.5), (2, 1, 0.5), (2, 1, 2.5), (2, -1, 2.5)),
        (
            ((2, 2, 3), (3, 2, 3), (3, 2, 0), (2, 2, 0)),
            ((3, -2, 0), (2, -2, 0), (2, -2, 3), (3, -2, 3)),
            ((3, -2, 3), (2, -2, 3), (2, 2, 3), (3, 2, 3)),
        ),
    ),
    6: (
        ((2, -12, 0), (2, -7, 0), (2, -7, 5), (2, -12, 5)),
        (((7, -2, 10), (7, -17, 10), (7, -17, 0), (7, -2, 0)),),
    ),
}


def _shading(data: CaseData, judge: Judge) -> Iterator[VerdictLine]:
    first, days = 3552 - 24, 3  # [h], around the day of the reference
    count = days * 24 * 6
    radiation = {"direct_normal": 1000.0, "diffuse_horizontal": 0.0, "global_horizontal": 0.0}
    start = np.datetime64("2001-01-01T00") + np.timedelta64(first, "h")
    site_of_case = CasePlace(50.0, 14.27, start=str(start), step="10min")
    columns = {name: np.full(count, value) for name, value in {"air_temperature": 20.0, **radiation}.items()}
    climate = site_of_case.climate(columns, instant=tuple(radiation))
    output = "wall.incident_solar"
    for number, (wall, shades) in _SHADED.items():
        tree = _shaded(wall, shades)
        hours, shaded = simulated(data.building(tree), climate, [output], "1min", 20.0)
        _, free = simulated(data.building({**tree, "shades": {}}), climate, [output], "1min", 20.0)
        sun = free[output].to_numpy()
        fraction = np.where(sun > 1.0, shaded[output].to_numpy() / np.maximum(sun, 1.0), 0.0)
        # A mean of the minute that ends at its stamp.
        yield judge.line(str(number), f"Variante 9.{number} Sonnenlichtfaktor", hours + first, fraction)


def _shaded(wall: Any, shades: tuple[Any, ...]) -> Tree:
    """A wall behind obstacles; a second one gives the room a surface."""
    closed = {"adiabatic": True}
    other = {"construction": "wall", "area": 1, "tilt": 90, "azimuth": 0}
    return {
        "name": "simquality",
        "site": {
            "latitude": 50.0, "longitude": 14.27, "altitude": 0, "timezone": "UTC+1", "diffuse": "isotropic",
            "ground_reflectance": 0,
        },
        "materials": materials(_UNINSULATED),
        "constructions": {"wall": construction(_UNINSULATED)},
        "zones": {"room": {"volume": VOLUME, "longwave": "none"}},
        "surfaces": {
            "wall": {
                "construction": "wall", "vertices": _corners(wall),
                "outside": outdoors(1.0), "inside": closed,
            },
            "other": {**other, "outside": closed, "inside": indoors("room")},
        },
        "shades": {f"shade_{k}": {"vertices": _corners(shade)} for k, shade in enumerate(shades)},
    }  # fmt: skip


def _corners(polygon: Any) -> list[list[float]]:
    return [[float(number) for number in corner] for corner in polygon]


def _hourly_of_steps(hours: Array, values: Array) -> tuple[Array, Array]:
    """Means of the hour that ends at each stamp, of means of steps."""
    count = round(1.0 / (hours[1] - hours[0]))
    complete = (len(values) - 1) // count * count
    means = values[1 : complete + 1].reshape(-1, count).mean(axis=1)
    return np.arange(1.0, len(means) + 1.0), means


def _hourly_between(hours: Array, values: Array) -> tuple[Array, Array]:
    """Means of the hour that ends at each stamp, of values at the stamps with straight lines between them."""
    middle = np.r_[0.0, 0.5 * (values[1:] + values[:-1])]
    return _hourly_of_steps(hours, middle)


_RUNS: Final[dict[str, Callable[[CaseData, Judge], Iterator[VerdictLine]]]] = {
    "TF03": _conduction,
    "TF04": _storage,
    "TF05": _ventilation,
    "TF06": _absorbed_sun,
    "TF07": _windows,
    "TF08": _gains,
    "TF09": _shading,
}
