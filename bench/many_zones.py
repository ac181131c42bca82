"""Buildings of many rooms: processor time and memory over the number of rooms, beside EnergyPlus.

    python bench/many_zones.py --energyplus PROGRAM --write docs/speed.md

A row of N rooms, and an office of rooms on several storeys (no chain: a room touches up to five others), free
and with ideal loads. Both programs get the same polygons, layers, panes, laws of convection (TARP inside, ISO
15099 at panes, DOE-2 outside), mass of outdoor air and infrared radiation of the sky, 15 min steps and one
thread. The time is that of the processor for the whole process, start included; beside it the parts of
Mascarin, and the same with the linearly implicit scheme. Leave the machine alone meanwhile.
(`bench/energyplus.py` says where to get EnergyPlus.)
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from page import publish, table

DATA = Path(os.environ.get("MASCARIN_DATA") or Path(__file__).parents[2] / "shared" / "data")
WEATHER = DATA / "weather" / "USA_CO_Golden-NREL.724666_TMY3.epw"
LENGTHS = (5.0, 4.0, 3.0)
"""Of a room to the east, to the north and upwards [m]."""
SOLIDS = {
    "insulation": (0.035, 25.0, 1400.0, 0.10),
    "concrete": (1.6, 2300.0, 900.0, 0.18),
    "brick": (0.6, 1600.0, 900.0, 0.12),
}
"""Conductivity [W/(m K)], density [kg/m3], specific heat [J/(kg K)], thickness [m]."""
CONSTRUCTIONS = {"shell": ("insulation", "concrete"), "partition": ("brick",), "slab": ("concrete",)}
HEATING, COOLING = 20.0, 26.0
PANE = {
    "thickness": 0.003048,
    "conductivity": 1.0,
    "emissivity": 0.84,
    "transmittance": 0.834,
    "reflectance": 0.075,
}
"""Each of the two panes. By U value and solar heat gain alone each program makes another window."""
GAP = 0.012
"""Width of the air between the panes [m]."""
AIR_CHANGES = 0.5
"""Outdoor air of a room by volume at the density of the site, at 15 degC [1/h]."""
STANDARD_AIR = 293.15 / 288.15
"""Density of air at 15 degC over that at 20 degC, to which EnergyPlus is told to count its volumes."""

Corner = tuple[float, float, float]
Cell = tuple[int, int, int]


@dataclass(frozen=True)
class Face:
    """A wall, floor or ceiling.

    Its corners run counter-clockwise as seen from behind; it has a room before it, and one or nothing behind.
    """

    name: str
    construction: str
    corners: list[Corner]
    room: str
    behind: str | None
    adiabatic: bool = False
    window: list[Corner] | None = None


@dataclass(frozen=True)
class Grid:
    """Rooms in rows, columns and storeys."""

    counts: Cell

    @property
    def rooms(self) -> list[str]:
        """Names of all rooms."""
        return [self.name(cell) for cell in np.ndindex(*self.counts)]

    @staticmethod
    def name(cell: Cell) -> str:
        """Name of a room."""
        return "r" + "_".join(str(k) for k in cell)

    def faces(self) -> Iterator[Face]:
        """All faces; those between two rooms once."""
        for cell in np.ndindex(*self.counts):
            for axis in range(3):
                for end in (0, 1):
                    yield from self._face(cell, axis, end)

    def _face(self, cell: Cell, axis: int, end: int) -> Iterator[Face]:
        other = tuple(k + (2 * end - 1) * (a == axis) for a, k in enumerate(cell))
        inside = all(0 <= k < most for k, most in zip(other, self.counts, strict=True))
        if inside and end == 0:
            return  # the face of the room before it
        corners = _rectangle(cell, axis, end)
        name = f"{self.name(cell)}_{'xyz'[axis]}{end}"
        construction = ("slab" if axis == 2 else "partition") if inside else "shell"
        window = _window(cell, end) if axis == 1 and not inside else None
        behind = self.name(other) if inside else None
        adiabatic = not inside and axis == 2 and end == 0
        yield Face(name, construction, corners, self.name(cell), behind, adiabatic, window)


def _rectangle(cell: Cell, axis: int, end: int) -> list[Corner]:
    """The face of a room at an end of an axis, counter-clockwise as seen from outside of the room."""
    a, b = [k for k in range(3) if k != axis]
    if (axis == 1) != (end == 0):
        a, b = b, a
    corners = []
    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
        steps = {axis: end, a: u, b: v}
        corners.append(tuple(float((cell[k] + steps[k]) * LENGTHS[k]) for k in range(3)))
    return corners


def _window(cell: Cell, end: int) -> list[Corner]:
    (x, y, z), (wide, deep, _) = (k * length for k, length in zip(cell, LENGTHS, strict=True)), LENGTHS
    y += deep * end
    west, east = (x + 1.0, x + wide - 1.0) if end == 0 else (x + wide - 1.0, x + 1.0)
    return [(west, y, z + 0.8), (east, y, z + 0.8), (east, y, z + 2.4), (west, y, z + 2.4)]


def description(grid: Grid, loads: bool) -> dict[str, Any]:
    """The building as Mascarin reads it."""
    room: dict[str, Any] = {
        "infiltration": AIR_CHANGES,
        "sun": "geometry",
        "gains": {"use": {"power": 150, "schedule": "day"}},
    }
    if loads:
        room |= {"heating": {"setpoint": HEATING}, "cooling": {"setpoint": COOLING}}
    doe2 = {"kind": "doe2", "roughness": "rough"}
    outside = {"outdoors": True, "convection": doe2, "emissivity": 0.9, "absorptance": 0.6}
    inside = {"convection": "tarp", "emissivity": 0.9, "absorptance": 0.6}
    hours = [{"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}, {"at": "18:00", "value": 0}]
    faces = list(grid.faces())
    return {
        "name": f"grid of {len(grid.rooms)} rooms",
        "site": {
            "latitude": 39.74,
            "longitude": -105.18,
            "altitude": 1829,
            "timezone": "UTC-7",
            "ground_reflectance": 0.2,
            "wind": {"terrain": "open"},
            "sky": "measured",
            "diffuse": "perez",
            "self_shading": False,
        },
        "materials": {
            k: dict(zip(("conductivity", "density", "specific_heat"), v, strict=False))
            for k, v in SOLIDS.items()
        },
        "constructions": {
            name: {"layers": [{"material": m, "thickness": SOLIDS[m][3]} for m in layers]}
            for name, layers in CONSTRUCTIONS.items()
        },
        "glazings": {
            "pane": {"kind": "panes", "panes": [PANE, PANE], "gaps": [{"gas": "air", "thickness": GAP}]}
        },
        "schedules": {"day": {"kind": "fraction", "days": {"all": hours}}},
        "zones": dict.fromkeys(grid.rooms, room),
        "surfaces": {
            face.name: {
                "construction": face.construction,
                "vertices": face.corners,
                "inside": inside | {"zone": face.room},
                "outside": _behind(face, outside, inside),
            }
            for face in faces
        },
        "windows": {
            f"{face.name}_window": {
                "surface": face.name,
                "glazing": "pane",
                "vertices": face.window,
                "outside": {"convection": doe2 | {"roughness": "very_smooth"}},
                # So does EnergyPlus at windows, whatever algorithm the zone has.
                "inside": {"convection": "iso15099"},
            }
            for face in faces
            if face.window is not None
        },
    }


def _behind(face: Face, outside: dict[str, Any], inside: dict[str, Any]) -> dict[str, Any]:
    if face.adiabatic:
        return {"adiabatic": True}
    return outside if face.behind is None else inside | {"zone": face.behind}


def model(grid: Grid, loads: bool, days: int) -> dict[str, Any]:
    """The building as EnergyPlus reads it, in its JSON."""
    last = time.gmtime(86400 * (days - 1))  # 1970 is no leap year
    names = [
        f"{month}_ground_reflectance"
        for month in (
            "january",
            "february",
            "march",
            "april",
            "may",
            "june",
            "july",
            "august",
            "september",
            "october",
            "november",
            "december",
        )
    ]
    whole: dict[str, Any] = {
        "Version": {"v": {"version_identifier": "25.2"}},
        "SimulationControl": {
            "c": {
                "run_simulation_for_sizing_periods": "No",
                "run_simulation_for_weather_file_run_periods": "Yes",
            }
        },
        "Building": {
            "b": {
                "terrain": "Country",
                "loads_convergence_tolerance_value": 0.04,
                "solar_distribution": "FullInteriorAndExterior",
                "temperature_convergence_tolerance_value": 0.004,
                "maximum_number_of_warmup_days": 60,
                "minimum_number_of_warmup_days": 6,
            }
        },
        "SurfaceConvectionAlgorithm:Inside": {"i": {"algorithm": "TARP"}},
        "SurfaceConvectionAlgorithm:Outside": {"o": {"algorithm": "DOE-2"}},
        # Sun and shadows of each day: by default those of one day hold for 20.
        "ShadowCalculation": {"s": {"shading_calculation_update_frequency": 1}},
        "Timestep": {"t": {"number_of_timesteps_per_hour": 4}},
        "RunPeriod": {
            "p": {
                "begin_month": 1,
                "begin_day_of_month": 1,
                "end_month": last.tm_mon,
                "end_day_of_month": last.tm_mday,
                "use_weather_file_daylight_saving_period": "No",
            }
        },
        "Site:GroundReflectance": {"g": dict.fromkeys(names, 0.2)},
        "GlobalGeometryRules": {
            "r": {
                "starting_vertex_position": "LowerLeftCorner",
                "vertex_entry_direction": "Counterclockwise",
                "coordinate_system": "World",
            }
        },
        "Schedule:Constant": {
            name: {"hourly_value": value}
            for name, value in (("always", 1), ("heat", HEATING), ("cool", COOLING), ("dual", 4))
        },
        "Schedule:Compact": {
            "day": {
                "data": [
                    {"field": text}
                    for text in (
                        "Through: 12/31",
                        "For: AllDays",
                        "Until: 8:00",
                        0,
                        "Until: 18:00",
                        1,
                        "Until: 24:00",
                        0,
                    )
                ]
            }
        },
        "Material": {
            k: {
                "roughness": "Rough",
                "conductivity": c,
                "density": d,
                "specific_heat": h,
                "thickness": t,
                "thermal_absorptance": 0.9,
                "solar_absorptance": 0.6,
                "visible_absorptance": 0.6,
            }
            for k, (c, d, h, t) in SOLIDS.items()
        },
        **_glass(),
        "Construction": {
            **{k: dict(zip(("outside_layer", "layer_2"), v, strict=False)) for k, v in CONSTRUCTIONS.items()},
            "pane": {"outside_layer": "glass", "layer_2": "gap", "layer_3": "glass"},
        },
        "Output:Variable": {
            "air": {"variable_name": "Zone Mean Air Temperature", "reporting_frequency": "Hourly"}
        },
        "Zone": {room: {"volume": float(np.prod(LENGTHS))} for room in grid.rooms},
        "ZoneInfiltration:DesignFlowRate": {
            f"air {room}": {
                "zone_or_zonelist_or_space_or_spacelist_name": room,
                "schedule_name": "always",
                "design_flow_rate_calculation_method": "AirChanges/Hour",
                "air_changes_per_hour": AIR_CHANGES * STANDARD_AIR,
                "constant_term_coefficient": 1,
                "density_basis": "Standard",
            }
            for room in grid.rooms
        },
        "OtherEquipment": {
            f"use {room}": {
                "zone_or_zonelist_or_space_or_spacelist_name": room,
                "schedule_name": "day",
                "design_level_calculation_method": "EquipmentLevel",
                "design_level": 150,
            }
            for room in grid.rooms
        },
    }
    for face in grid.faces():
        _add_face(whole, face)
    if loads:
        whole["ThermostatSetpoint:DualSetpoint"] = {
            "both": {
                "heating_setpoint_temperature_schedule_name": "heat",
                "cooling_setpoint_temperature_schedule_name": "cool",
            }
        }
        for room in grid.rooms:
            _add_loads(whole, room)
    return whole


def _glass() -> dict[str, Any]:
    """The two layers of the windows."""
    optics = {
        f"{side}_side_{kind}_reflectance_at_normal_incidence": PANE["reflectance"]
        for side in ("front", "back")
        for kind in ("solar", "visible")
    }
    optics |= {
        f"{kind}_transmittance_at_normal_incidence": PANE["transmittance"] for kind in ("solar", "visible")
    }
    infrared = {
        f"{side}_side_infrared_hemispherical_emissivity": PANE["emissivity"] for side in ("front", "back")
    }
    glass = {"optical_data_type": "SpectralAverage", "infrared_transmittance_at_normal_incidence": 0.0}
    glass |= {"thickness": PANE["thickness"], "conductivity": PANE["conductivity"]}
    return {
        "WindowMaterial:Glazing": {"glass": glass | optics | infrared},
        "WindowMaterial:Gas": {"gap": {"gas_type": "Air", "thickness": GAP}},
    }


def _add_face(whole: dict[str, Any], face: Face) -> None:
    level = {"x": "Wall", "y": "Wall", "z": "Roof" if face.behind is None else "Ceiling"}[face.name[-2]]
    level = "Floor" if face.name.endswith("z0") else level
    surfaces = whole.setdefault("BuildingSurface:Detailed", {})

    def surface(room: str, corners: list[Corner], level: str, behind: str | None) -> dict[str, Any]:
        where = {
            "outside_boundary_condition": "Outdoors",
            "sun_exposure": "SunExposed",
            "wind_exposure": "WindExposed",
        }
        if face.adiabatic:
            where = {
                "outside_boundary_condition": "Adiabatic",
                "sun_exposure": "NoSun",
                "wind_exposure": "NoWind",
            }
        if behind is not None:
            where = {
                "outside_boundary_condition": "Surface",
                "outside_boundary_condition_object": behind,
                "sun_exposure": "NoSun",
                "wind_exposure": "NoWind",
            }
        vertices = [
            dict(zip((f"vertex_{axis}_coordinate" for axis in "xyz"), corner, strict=True))
            for corner in corners
        ]
        return {
            "surface_type": level,
            "construction_name": face.construction,
            "zone_name": room,
            "number_of_vertices": len(corners),
            "vertices": vertices,
            **where,
        }

    if face.behind is None:
        surfaces[face.name] = surface(face.room, face.corners, level, None)
    else:
        back = f"{face.name} back"
        surfaces[face.name] = surface(face.room, face.corners, level, back)
        surfaces[back] = surface(
            face.behind, face.corners[::-1], "Floor" if level == "Ceiling" else level, face.name
        )
    if face.window is not None:
        corners = {
            f"vertex_{k}_{axis}_coordinate": x
            for k, corner in enumerate(face.window, 1)
            for axis, x in zip("xyz", corner, strict=True)
        }
        whole.setdefault("FenestrationSurface:Detailed", {})[f"{face.name} window"] = {
            "surface_type": "Window",
            "construction_name": "pane",
            "building_surface_name": face.name,
            "number_of_vertices": 4,
            **corners,
        }


def _add_loads(whole: dict[str, Any], room: str) -> None:
    """Ideal loads of a zone, with the objects that EnergyPlus wants around them."""
    parts = {
        "ZoneControl:Thermostat": {
            "zone_or_zonelist_name": room,
            "control_type_schedule_name": "dual",
            "control_1_object_type": "ThermostatSetpoint:DualSetpoint",
            "control_1_name": "both",
        },
        "ZoneHVAC:EquipmentConnections": {
            "zone_name": room,
            "zone_conditioning_equipment_list_name": f"list {room}",
            "zone_air_inlet_node_or_nodelist_name": f"inlet {room}",
            "zone_air_node_name": f"node {room}",
            "zone_return_air_node_or_nodelist_name": f"outlet {room}",
        },
        "ZoneHVAC:EquipmentList": {
            "load_distribution_scheme": "SequentialLoad",
            "equipment": [
                {
                    "zone_equipment_object_type": "ZoneHVAC:IdealLoadsAirSystem",
                    "zone_equipment_name": f"ideal {room}",
                    "zone_equipment_cooling_sequence": 1,
                    "zone_equipment_heating_or_no_load_sequence": 1,
                }
            ],
        },
        "ZoneHVAC:IdealLoadsAirSystem": {"zone_supply_air_node_name": f"inlet {room}"},
    }
    called = {"ZoneHVAC:EquipmentList": f"list {room}", "ZoneHVAC:IdealLoadsAirSystem": f"ideal {room}"}
    for kind, part in parts.items():
        whole.setdefault(kind, {})[called.get(kind, f"{kind} {room}")] = part


# --- Running ------------------------------------------------------------------------------------------------

CHILD = """
import json, sys, time
marks = [time.process_time()]
import mascarin as mc, numpy as np
from mascarin.simulation import Simulation
folder, weather, days, scheme = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
marks.append(time.process_time())
building = mc.load(folder + "/building.yaml")
marks.append(time.process_time())
climate = mc.Climate.from_epw(weather, typical=True)
marks.append(time.process_time())
names = [f"{zone}.air_temperature" for zone in building.zones]
end = {} if days >= 365 else {"end": str(np.datetime64("2001-01-01") + days)}
options = {"step": "15min", "start": "2001-01-01", "scheme": scheme, **end}
simulation = Simulation(building, climate, outputs=names, **options)
marks.append(time.process_time())
run = simulation.run()
marks.append(time.process_time())
np.save(folder + "/mascarin.npy", run.records)
parts = dict(zip(("import", "load", "weather", "compile", "run"), np.diff(marks)))
# Of this program alone: the usage that a parent reads contains what the parent had when it started the child.
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
parts["memory"] = int(status["VmHWM"].split()[0]) / 1024.0
json.dump(parts, open(folder + "/parts.json", "w"))
"""


def measured(words: list[str], folder: Path) -> float:
    """Processor time of a program. [s]"""
    with (folder / "log.txt").open("w") as log:
        environment = os.environ | {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}
        process = subprocess.Popen(words, cwd=folder, stdout=log, stderr=log, env=environment)  # noqa: S603
        _, status, used = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{words[0]} failed:\n{(folder / 'log.txt').read_text()[-2000:]}")
    return used.ru_utime + used.ru_stime


@dataclass(frozen=True)
class Result:
    """What one building took in both programs, and how far apart the airs are.

    `quick` and `quick_run`: the whole process and the run with the linearly implicit scheme.
    """

    rooms: int
    loads: bool
    ours: float
    parts: dict[str, float]
    quick: float
    quick_run: float
    theirs: float
    difference: float


def compare(grid: Grid, loads: bool, days: int, weather: Path, energyplus: Path | None) -> Result:
    """Run one building in both programs."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / "building.yaml").write_text(_yaml(description(grid, loads)))
        words = [sys.executable, "-c", CHILD, str(folder), str(weather), str(days)]
        quick = measured([*words, "linearly-implicit"], folder)
        quick_run = json.loads((folder / "parts.json").read_text())["run"]
        ours = measured([*words, "sdirk2"], folder)
        parts = json.loads((folder / "parts.json").read_text())
        theirs = difference = float("nan")
        if energyplus is not None:
            (folder / "in.epJSON").write_text(json.dumps(model(grid, loads, days)))
            words = [
                str(energyplus),
                "-w",
                str(weather),
                "-d",
                str(folder / "out"),
                str(folder / "in.epJSON"),
            ]
            theirs = measured(words, folder)
            air = _hourly(folder / "out" / "eplusout.eso", grid.rooms)
            mine = _hourly_means(np.load(folder / "mascarin.npy"))
            difference = float(np.sqrt(np.mean((mine - air[:, : mine.shape[1]]) ** 2)))
    return Result(len(grid.rooms), loads, ours, parts, quick, quick_run, theirs, difference)


def _yaml(parts: dict[str, Any]) -> str:
    """A mapping as YAML, a line for each object."""
    lines = []
    for part, entries in parts.items():
        if not isinstance(entries, dict) or part == "site":
            lines.append(f"{part}: {json.dumps(entries)}")
            continue
        lines += [f"{part}:", *(f"  {name}: {json.dumps(entry)}" for name, entry in entries.items())]
    return "\n".join(lines) + "\n"


def _hourly_means(records: Any) -> Any:
    """Means over hours of airs on straight lines between quarters of an hour, shape (rooms, hours). [degC]"""
    middle = 0.5 * (records[1:] + records[:-1])
    return middle[: len(middle) // 4 * 4].reshape(-1, 4, middle.shape[1]).mean(axis=1).T


def _hourly(file: Path, rooms: list[str]) -> Any:
    """Hourly temperatures of EnergyPlus, a row for each room."""
    codes: dict[str, str] = {}
    series: dict[str, list[float]] = {room.upper(): [] for room in rooms}
    header = True
    for line in file.read_text().splitlines():
        words = line.split(",")
        if header:
            header = not line.startswith("End of Data Dictionary")
            if len(words) > 3 and words[3].startswith("Zone Mean Air Temperature"):
                codes[words[0]] = words[2]
        elif words[0] in codes:
            series[codes[words[0]]].append(float(words[1]))
    return np.array([series[room.upper()] for room in rooms])


def exponent(results: list[Result], value: Any) -> float:
    """Power of the number of rooms that a time grows with."""
    x, y = (np.log([f(r) for r in results]) for f in (lambda r: r.rooms, value))
    return float(np.polyfit(x, y, 1)[0])


def main() -> None:
    """Measure, print, write."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--weather", type=Path, default=WEATHER, help="EPW file of Golden, Colorado")
    options.add_argument("--energyplus", type=Path)
    options.add_argument("--rooms", type=int, nargs="*", default=[2, 8, 32, 128, 512])
    options.add_argument("--days", type=int, default=365)
    options.add_argument("--write", type=Path)
    given = options.parse_args()
    grids = [("row", Grid((n, 1, 1))) for n in given.rooms] + [("office", Grid((10, 2, 5)))]
    lines, rows = [], []
    for loads in (False, True):
        for kind, grid in grids:
            found = compare(grid, loads, given.days, given.weather.resolve(), given.energyplus)
            rows += [found] if kind == "row" else []
            ready = found.parts["load"] + found.parts["compile"]
            lines.append(
                [
                    f"{kind}, {found.rooms} rooms",
                    "ideal loads" if loads else "free",
                    f"{found.ours:.1f} s",
                    f"{ready:.1f} s",
                    f"{found.parts['run']:.2f} s",
                    f"{found.parts['memory']:.0f} MB",
                    f"{found.theirs:.1f} s",
                    f"{found.theirs / found.ours:.1f}",
                    f"{found.quick_run:.2f} s",
                    f"{found.theirs / found.quick:.1f}",
                    f"{found.difference:.2f} K",
                ]
            )
            print("  ".join(lines[-1]), file=sys.stderr, flush=True)
    head = [
        "building",
        "operation",
        "Mascarin",
        "load, compile",
        "run",
        "memory",
        "EnergyPlus",
        "ratio",
        "run, linearly implicit",
        "ratio",
        "airs apart (rms)",
    ]
    text = table(head, lines)
    for loads in (False, True):
        large = [r for r in rows if r.loads is loads and r.rooms >= 8]
        if len(large) > 1:
            powers = [
                exponent(large, f) for f in (lambda r: r.parts["run"], lambda r: r.ours, lambda r: r.theirs)
            ]
            what = "with ideal loads" if loads else "free"
            text += (
                f"\n\nFrom {large[0].rooms} to {large[-1].rooms} rooms {what}: the run grows with N to the "
                f"power {powers[0]:.2f}, the whole process {powers[1]:.2f}, EnergyPlus {powers[2]:.2f}."
            )
    publish("many zones", text, given.write)


if __name__ == "__main__":
    main()
