"""A cell of 16 paths of heat, whose air and guard zones have their measured temperatures."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd

from mascarin.verification.suites.case_data import CaseData, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

#: Guard zone of cell A and of cell B, film inside [W/(m2 K)], tilt [deg]. In B east and west change places.
_PATHS: Final = {
    "ceiling1": ("Tattic", "Tattic", 3.6, 0),
    "ceiling2": ("Tattic", "Tattic", 3.6, 0),
    "floor1": ("Tcellar", "Tcellar", 5.3, 180),
    "floor2": ("Tcellar", "Tcellar", 5.3, 180),
    "floor3": ("Tcellar", "Tcellar", 5.3, 180),
    "north": ("Tnorth", "Tnorth", 10.5, 90),
    "door": ("Tnorth", "Tnorth", 10.5, 90),
    "windowwall": ("Teast", "Twest", 7.0, 90),
    "sidewin1": ("Teast", "Twest", 7.0, 90),
    "sidewin2": ("Teast", "Twest", 7.0, 90),
    "sidewin3": ("Teast", "Twest", 12.0, 90),
    "south": ("Tsouth", "Tsouth", 7.0, 90),
    "swin1": ("Tsouth", "Tsouth", 7.0, 90),
    "swin2": ("Tsouth", "Tsouth", 7.0, 90),
    "swin3": ("Tsouth", "Tsouth", 12.0, 90),
    "party": ("Twest", "Teast", 5.3, 90),
}
_GUARDS: Final = ("Tattic", "Tcellar", "Tnorth", "Teast", "Tsouth", "Twest")
#: Film outside, and inside of the parts of windows that are not insulated. [W/(m2 K)]
_OUTSIDE_FILM, _BARE_FILM = 18.0, 12.0
#: Films by the program: the fan of the heater blows 20.7 air changes an hour from a diffuser at the ceiling.
_FORCED_AIR: Final = {"kind": "fisher_ceiling_diffuser", "mixing": 20.7}
#: Height of the air. [m]
_HEIGHT: Final = 2.565
#: Cases by the program's own films.
_OWN_FILMS: Final = "3"
#: Cases with conductivities of a catalogue and an infiltration [1/h]: by design not in agreement with the
#: cell, so that the program CSE is their reference, with the part that they may deviate [-].
_BY_CATALOGUE: Final = "2"
_INFILTRATION: Final = {"A": 0.05775, "B": 0.02045}
_OF_PROGRAM: Final = 0.01
_LOAD: Final = "cell.net_load"


@dataclass(frozen=True)
class Case:
    """A case by its name, such as ET110A1: insulation of the windows, cell, films."""

    name: str

    @property
    def cell(self) -> str:
        """A or B."""
        return self.name[5]

    @property
    def insulated(self) -> bool:
        """Whether the windows are."""
        return self.name.startswith("ET110")

    @property
    def own_films(self) -> bool:
        """Whether the program computes convection and long-wave exchange."""
        return self.name.endswith(_OWN_FILMS)

    @property
    def by_catalogue(self) -> bool:
        """Whether conductivities are those of a catalogue."""
        return self.name.endswith(_BY_CATALOGUE)

    @property
    def layers(self) -> str:
        """Name of the layers among the facts, where the windows are insulated."""
        return "A2 and B2 (catalogue)" if self.by_catalogue else f"{self.cell}1"

    def tree(self, facts: dict[str, Any]) -> Tree:
        """Describe the cell."""
        materials: Tree = {}
        constructions: Tree = {}
        surfaces: Tree = {}
        for path, (guard_a, guard_b, film, tilt) in _PATHS.items():
            bare = not self.insulated and path != "windowwall" and "win" in path
            layers = facts["paths"][path]["layers"]["ET100 (uninsulated)" if bare else self.layers]
            names = [f"{path}_{number}" for number in range(len(layers))]
            for name, layer in zip(names, layers, strict=True):
                materials[name] = {key: layer[key] for key in ("conductivity", "density", "specific_heat")}
            # The facts list them from inside to outside.
            pairs = zip(reversed(names), reversed(layers), strict=True)
            constructions[path] = {
                "layers": [{"material": name, "thickness": layer["thickness_m"]} for name, layer in pairs]
            }
            inside: Tree = {"zone": "cell", "convection": _BARE_FILM if bare else film, "emissivity": 0.9}
            if self.own_films:
                inside |= {"convection": _FORCED_AIR, "emissivity": _emissivity(facts, path)}
            surfaces[path] = {
                "construction": path,
                "area": facts["paths"][path]["area_m2"],
                "tilt": tilt,
                "outside": {
                    "measured": guard_a if self.cell == "A" else guard_b,
                    "convection": _OUTSIDE_FILM,
                },
                "inside": inside,
            } | ({"azimuth": 0} if tilt == 90 else {})
        leaks = {"infiltration": {"constant": _INFILTRATION[self.cell]}} if self.by_catalogue else {}
        area = sum(surface["area"] for path, surface in surfaces.items() if path.startswith("floor"))
        zone = {
            "volume": area * _HEIGHT,
            "longwave": "linearised" if self.own_films else "none",
            "held": {"column": "Tcell"},
            "gains": {"fan": {"column": "Qfan"}},
            **leaks,
        }
        return {
            "name": self.name,
            "site": {"latitude": 48.37, "longitude": 2.82, "altitude": 104, "timezone": "UTC+1"},
            "materials": materials,
            "constructions": constructions,
            "zones": {"cell": zone},
            "surfaces": surfaces,
        }


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Energy of the heater in the steady hours of each case."""
    facts = json.loads(data.text("facts.json"))
    for row in csv.DictReader(io.StringIO(data.text("steady_state_heater.csv"))):
        case = Case(row["case"])
        numbers = list(row.values())
        hours, uncertainty, program = int(numbers[2]), float(numbers[4]), float(numbers[5])
        records = _records(data, case)
        measured = float(records["Qhtr"].to_numpy()[-hours:].mean())
        heat = float(_heat(data, case, facts, records)[-hours:].mean())
        reference, peers = measured, {"CSE": program}
        tolerance, against = 0.01 * uncertainty, f"measured within {uncertainty:g} %"
        if case.by_catalogue:
            reference, peers = program, {}
            tolerance, against = (
                _OF_PROGRAM,
                f"of CSE; measured {measured:.1f} W, which it contradicts by design",
            )
        limits = around(reference, tolerance * reference)
        note = f"{100.0 * (heat / reference - 1.0):+.2f} %, {against}"
        yield VerdictLine(case.name, "heater, steady hours", "W", heat, reference, limits, peers, note)


def _records(data: CaseData, case: Case) -> pd.DataFrame:
    """Hourly means, each of the hour before its stamp. [degC, W]"""
    names = ["time", *_GUARDS, "Tcell", "Qfan", "flow", "Qhtr"]
    text = io.StringIO(data.text(f"{case.name[:6]}_measurements.csv"))
    table = pd.read_csv(text, header=None, skiprows=4, usecols=range(len(names)), names=names)
    table["time"] = pd.to_datetime(table["time"])
    return table.dropna()


def _heat(data: CaseData, case: Case, facts: dict[str, Any], records: pd.DataFrame) -> Any:
    """Heat of the ideal heater, hourly means (n,). [W]"""
    from mascarin.weather import Climate

    count, columns = len(records), [*_GUARDS, "Tcell"]
    index = pd.date_range(
        records["time"].iloc[0] - pd.Timedelta(hours=1), periods=2 * count, freq="30min", tz="Etc/GMT-1"
    )
    middle, half_hours = np.arange(count) + 0.5, np.arange(2 * count) / 2.0
    table = pd.DataFrame(
        {name: np.interp(half_hours, middle, records[name]) for name in columns}, index=index
    )
    table["Qfan"] = np.repeat(records["Qfan"].to_numpy(), 2)
    table["air"] = 10.0
    absent = {"wind_speed": 0.0, "global_horizontal": 0.0, "direct_normal": 0.0, "diffuse_horizontal": 0.0}
    climate = Climate.from_table(
        table,
        columns={"air_temperature": {"column": "air"}},
        extra=[*columns, "Qfan"],
        mean=["Qfan"],
        absent=absent | {"wind_direction": 0.0, "dew_point": -40.0},
        latitude=48.37,
        longitude=2.82,
        check_sun=False,
    )
    building = data.building(case.tree(facts))
    initial = 10.1 if case.insulated else "repeat"
    hours, run = simulated(building, climate, [_LOAD], "10min", initial)
    # The run begins in the middle of the first hour, where the first value stands.
    begin = (run.index[0] - index[0]).total_seconds() / 3600.0
    hour = np.ceil(np.round(hours[1:] + begin, 4) - 1e-6).astype(int) - 1
    means = pd.Series(run[_LOAD].to_numpy()[1:]).groupby(hour).mean()
    return means.reindex(range(count)).bfill().ffill().to_numpy()


def _emissivity(facts: dict[str, Any], path: str) -> float:
    values = facts["emissivity_inside_ET100x3"]
    return float(values["sidewin1, swin1"] if path in ("sidewin1", "swin1") else values[path.rstrip("123")])
