"""Rooms whose air is held, joined by openings with a power law."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

#: Air of 15 degC at sea level, that of the site. [kg/m3]
_DENSITY: Final = 101325.0 / (287.042 * 288.15)
_DISCHARGE: Final = 0.6
#: Of the analytical mass flow. [-]
_TOLERANCE: Final = 0.005
#: Programs of Haghighat and Megri.
_PROGRAMS: Final = ("COMIS", "AIRNET", "CONTAM1b", "BUS", "CBSAIR")


@dataclass(frozen=True)
class Link:
    """An opening between two zones, or a zone and outdoors.

    Parameters
    ----------
    zones : tuple of str
        One or two.
    conductance : float
        Discharge coefficient times area. [m2]
    elevation : float
        [m]
    coefficient : float
        Wind pressure coefficient of an opening to outdoors. [-]
    exponent : float
        Of the pressure difference. [-]
    """

    zones: tuple[str, ...]
    conductance: float
    elevation: float
    coefficient: float = 0.0
    exponent: float = 0.5

    def tree(self, wind: float) -> Tree:
        """Describe it."""
        opening: Tree = {
            "area": self.conductance / _DISCHARGE,
            "exponent": self.exponent,
            "discharge": _DISCHARGE,
            "elevation": self.elevation,
        }
        if len(self.zones) == 2:
            return opening | {"between": list(self.zones)}
        table = {"kind": "table", "coefficients": [self.coefficient], "height": 10.0}
        return opening | {"zone": self.zones[0], "azimuth": 0, "pressure": table if wind else "none"}


def flows(
    data: CaseData, temperatures: Mapping[str, float], links: Mapping[str, Link], outdoors: float, wind: float
) -> dict[str, float]:
    """Mass flow of each link in the steady state. [kg/s]

    Parameters
    ----------
    temperatures : mapping of str to float
        Of the air of each zone. [degC]
    links : mapping of str to Link
        The openings.
    outdoors : float
        [degC]
    wind : float
        At 10 m. [m/s]
    """
    closed = {"adiabatic": True}
    wall = {"construction": "wall", "area": 10, "tilt": 90, "azimuth": 0, "outside": closed}
    tree: Tree = {
        "name": "network",
        "site": {"latitude": 45, "longitude": 0, "altitude": 0, "timezone": "UTC+0"},
        "materials": {"wool": {"conductivity": 0.04, "density": 30, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "wool", "thickness": 0.1}]}},
        "zones": {
            name: {"volume": 100, "longwave": "none", "held": value} for name, value in temperatures.items()
        },
        "surfaces": {
            f"wall_{name}": {**wall, "inside": {"zone": name, "convection": 3, "emissivity": 0.9}}
            for name in temperatures
        },
        "vents": {name: link.tree(wind) for name, link in links.items()},
    }
    weather = {"air_temperature": np.full(30, outdoors), "wind_speed": np.full(30, wind)}
    outputs = [f"{name}.{way}" for name in links for way in ("inflow", "outflow")]
    climate = CasePlace(45.0, 0.0, "UTC").climate(weather)
    _, table = simulated(data.building(tree), climate, outputs, "15min", "repeat")
    last = table.iloc[-1]
    return {name: _DENSITY * float(max(last[f"{name}.inflow"], last[f"{name}.outflow"])) for name in links}


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """The IEA cases, then the links of four zones."""
    yield from _iea(data)
    yield from _four_zones(data)


#: Openings of 0.1 m2 with a discharge coefficient of 0.7; wind pressure coefficients at inlet and outlet.
_CONDUCTANCE: Final = 0.7 * 0.1
_INLET, _OUTLET = 0.6, -0.4
#: Temperatures of the zones and outdoors [degC], wind [m/s].
_CASES: Final[dict[str, tuple[tuple[float, ...], float, float]]] = {
    "MA101": ((20.0,), 20.0, 2.0),
    "MA102": ((20.0,), 0.0, 0.0),
    "MA103": ((20.0,), 0.0, 2.0),
    "MA301": ((20.0, 20.0, 20.0), 20.0, 2.0),
    "MA302": ((15.0, 20.0, 25.0), 0.0, 0.0),
    "MA303": ((15.0, 20.0, 25.0), 0.0, 2.0),
    "MA304": ((20.0, 30.0, 20.0), 30.0, 0.8),
}


def _iea(data: CaseData) -> Iterator[VerdictLine]:
    rows = csv.reader(io.StringIO(data.text("Sheet1.csv")))
    numbers: dict[str, tuple[float, float]] = {}
    for row in rows:
        if row and row[0].strip() in _CASES and len(row) > 3 and _is_flow(row[2]) and _is_flow(row[3]):
            numbers.setdefault(row[0].strip(), (float(row[2]), float(row[3])))
    for case, (zones, outdoors, wind) in _CASES.items():
        reference, program = numbers[case]
        names = "abc"[: len(zones)]
        flow = max(
            flows(data, dict(zip(names, zones, strict=True)), _row_of_zones(names), outdoors, wind).values()
        )
        limits = around(reference, _TOLERANCE * reference)
        yield VerdictLine(case, "mass flow", "kg/s", flow, reference, limits, {"EnergyPlus": program})


def _row_of_zones(names: str) -> dict[str, Link]:
    """Low inlet, openings between zones that follow each other, high outlet."""
    heights = (1.0, 1.7)
    links = {"inlet": Link((names[0],), _CONDUCTANCE, 0.5, _INLET)}
    for first, second, height in zip(names, names[1:], heights, strict=False):
        links[f"{first}{second}"] = Link((first, second), _CONDUCTANCE, height)
    return links | {"outlet": Link((names[-1],), _CONDUCTANCE, 2.2, _OUTLET)}


#: Zones, flow coefficient [m3/(s Pa^n)] at 1.204 kg/m3, exponent, elevation [m], wind pressure [Pa].
_LINKS: Final[Sequence[tuple[tuple[str, ...], float, float, float, float]]] = (
    (("z1",), 0.005, 0.65, 5.0, 11.0),
    (("z3",), 0.008, 0.65, 1.0, 3.7),
    (("z2",), 0.007, 0.65, 5.0, -7.3),
    (("z4",), 0.009, 0.65, 2.0, -4.9),
    (("z1", "z2"), 0.015, 0.5, 5.5, 0.0),
    (("z1", "z3"), 0.02, 0.5, 3.0, 0.0),
    (("z2", "z4"), 0.02, 0.5, 3.0, 0.0),
    (("z3", "z4"), 0.015, 0.5, 1.5, 0.0),
)
_STATED_DENSITY: Final = 1.204


def _four_zones(data: CaseData) -> Iterator[VerdictLine]:
    table = csv.DictReader(io.StringIO(data.text("../nist_airflow/table_3.csv")))
    programs = {row["Name"]: {p: abs(float(row[f"FlowRate_{p}"])) for p in _PROGRAMS} for row in table}
    wind = 10.0
    links = {}
    for number, (zones, coefficient, exponent, elevation, pressure) in enumerate(_LINKS, 1):
        # An opening has its flow at 4 Pa; the wind blows with the outdoor air, of 0 degC.
        conductance = coefficient / (math.sqrt(2.0 / _STATED_DENSITY) * 4.0 ** (0.5 - exponent))
        of_wind = pressure / (0.5 * _DENSITY * 288.15 / 273.15 * wind**2)
        links[f"link{number}"] = Link(zones, conductance, elevation, of_wind, exponent)
    temperatures = {"z1": 23.0, "z2": 23.0, "z3": 21.0, "z4": 21.0}
    for number, flow in enumerate(flows(data, temperatures, links, 0.0, wind).values(), 1):
        peers = programs[f"Link_{number}"]
        # The numbers are printed with four digits.
        limits = 0.999 * min(peers.values()), 1.001 * max(peers.values())
        yield VerdictLine(f"link {number}", "mass flow", "kg/s", flow, peers["AIRNET"], limits, peers)


def _is_flow(cell: str) -> bool:
    """A decimal number; the conditions of the cases stand in rows of the same names."""
    try:
        return "." in cell and math.isfinite(float(cell))
    except ValueError:
        return False
