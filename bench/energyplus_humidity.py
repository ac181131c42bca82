"""Humidity of rooms in Mascarin and EnergyPlus, with the same penetration depths, sources and flows of air.

The cell of `cell.py` without phase change: two zones, a source of vapour by day, sorption in proportion to
the relative humidity in all materials that face a zone, one layer or two. EnergyPlus 25.2 runs its model of
effective moisture penetration depth with conduction transfer functions and steps of a minute.

    python bench/energyplus_humidity.py --energyplus PATH [--days 56] [--rules]

prints the root mean square of the difference of the relative humidities of the zones [%], after days in
which the programs forget their different starts. At a constant temperature both solve the same equations.
With the measured weather they do not: EnergyPlus keeps the vapour density in the pores from step to step and
finds the content from it at the new temperature (`CalcMoistureBalanceEMPD`), so that a wall that is warmed
loses content without giving off vapour. Mascarin keeps the content. With `--rules`, the room is calculated
again by both rules, from temperatures, flows and coefficients of EnergyPlus.

A surface that uses that model in EnergyPlus and whose inner layer has no sorption ends the program with a
segmentation fault (issue 10777 of EnergyPlus, repaired after 25.2): such surfaces use transfer functions.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import cell
import numpy as np
import pandas as pd

import energyplus
import mascarin as mc
from mascarin.building import Building
from mascarin.building.geometry import parents
from mascarin.building.parts.defaults import outlines
from mascarin.building.parts.moisture_surfaces import vapour_sides
from mascarin.physics import relative_humidity, saturation_pressure, vapour_pressure

SETTLING = 28  # days left out of the comparison
PER_HOUR = 60
#: Moisture content at a relative humidity of 1 [kg/m3], vapour resistance factor [-], depths [m].
#: Both depths fit into the thinnest layer: Mascarin ends a layer of moisture there, EnergyPlus does not.
CAPACITY, RESISTANCE, DEPTHS = 40.0, 8.0, (0.002, 0.003)
#: Latent heat of the source [W]; EnergyPlus divides it by the enthalpy of vapour [J/kg].
POWER, ENTHALPY = 25.0, 2.5009e6 + 1858.95 * 24.0
#: Of air, sky and ground in the comparison at a constant temperature [degC].
STEADY = 24.0
#: The source acts from 8 to 20 h.
DAY = [{"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}, {"at": "20:00", "value": 0}]
#: The same materials take up vapour on the sides of zones; steel does not.
DRY = ("steel",)


def weather(steady: bool) -> pd.DataFrame:
    """The weather of the cell; or with its vapour, without the sun, at a constant temperature."""
    measured = cell.table()
    if not steady:
        return measured
    full = saturation_pressure(measured["outdoor_air"]) / saturation_pressure(STEADY)
    given = {"relative_humidity": np.minimum(99.0, measured["relative_humidity"] * full)}
    constant = {"outdoor_air": STEADY, "infrared": cell.SIGMA * (STEADY + 273.15) ** 4}
    return measured.assign(**given, **constant, global_horizontal=0.0, diffuse_horizontal=0.0)


def building(deep: bool, steady: bool) -> Building:
    """The cell without phase change, with vapour balances."""
    ground = {"surfaces.floor.outside": {"ground": {"mean": STEADY}}} if steady else {}
    plain = cell.building().replace(
        {"materials.energain": {"conductivity": 0.2, "density": 900, "specific_heat": 2000}} | ground
    )
    probe = plain.replace({"humidity": {}})
    names = {side.material for side in vapour_sides(probe) if side.density > 0.0}
    depths = {"depth": DEPTHS[0]} | ({"deep_depth": DEPTHS[1]} if deep else {})
    sorption = {"capacity": CAPACITY, "vapour_resistance": RESISTANCE} | depths
    source = {"rate": POWER / ENTHALPY, "schedule": "day"}
    return plain.replace(
        {
            "schedules.day": {"kind": "fraction", "days": {"all": DAY}},
            "humidity": {
                "materials": {name: sorption for name in sorted(names) if name not in DRY},
                "zones": {"room": {"gains": {"people": source}}},
            },
        }
    )


def model(damp: Building, end: str, deep: bool, names: list[str]) -> dict[str, Any]:
    """The same for EnergyPlus."""
    written = energyplus.write_model(damp, energyplus.Scheme(PER_HOUR, ()), cell.START, end, names)
    written["HeatBalanceAlgorithm"] = {
        "algorithm": {"algorithm": "MoisturePenetrationDepthConductionTransferFunction"}
    }
    settings = written.setdefault("MaterialProperty:MoisturePenetrationDepth:Settings", {})
    # A material there belongs to one layer of one surface.
    taking = {f"{side.surface} {side.layer}" for side in vapour_sides(damp) if side.takes_up}
    # Surfaces that take up nothing must not use its model of moisture: it reads data that they do not have.
    words = ("outside", "inside")
    plain = [(side.surface, words[side.side]) for side in vapour_sides(damp) if not side.takes_up]
    for surface, side in plain:
        called = energyplus.face_name(surface, side)
        written.setdefault("SurfaceProperty:HeatTransferAlgorithm", {})[f"{called} dry"] = {
            "surface_name": called,
            "algorithm": "ConductionTransferFunction",
        }
    for name in sorted(taking):
        material = written["Material"][name]
        settings[name] = {
            "water_vapor_diffusion_resistance_factor": RESISTANCE,
            "moisture_equation_coefficient_a": CAPACITY / material["density"],
            "moisture_equation_coefficient_b": 1.0,
            "moisture_equation_coefficient_c": 0.0,
            "moisture_equation_coefficient_d": 1.0,
            "surface_layer_penetration_depth": DEPTHS[0],
            "deep_layer_penetration_depth": DEPTHS[1] if deep else 0.0,
            "coating_layer_thickness": 0.0,
            "coating_layer_water_vapor_diffusion_resistance_factor": 0.0,
        }
    course = ["Until: 08:00", 0.0, "Until: 20:00", 1.0, "Until: 24:00", 0.0]
    fields = ["Through: 12/31", "For: AllDays", *course]
    written["Schedule:Compact"] = {"day": {"data": [{"field": field} for field in fields]}}
    written["OtherEquipment"] = {
        "people": {
            "zone_or_zonelist_or_space_or_spacelist_name": "room",
            "schedule_name": "day",
            "design_level_calculation_method": "EquipmentLevel",
            "design_level": POWER,
            "fraction_latent": 1.0,
            "fraction_radiant": 0.0,
            "fraction_lost": 0.0,
        }
    }
    return written


def compare(program: Path, days: int, deep: bool, steady: bool) -> dict[str, float]:
    """Root mean square and largest difference of the relative humidity of each zone [%]."""
    damp = building(deep, steady)
    end = str((pd.Timestamp(cell.START) + pd.Timedelta(days=days)).date())
    climate = cell.climate(weather(steady))
    energyplus.OUTPUTS["relative_humidity"] = "Zone Air Relative Humidity"
    zones = list(damp.zones)
    names = [f"{zone}.{kind}" for zone in zones for kind in ("relative_humidity", "air_temperature")]
    ours = mc.simulate(
        damp, climate, step=3600 // PER_HOUR, outputs=names, start=cell.START, end=end, initial=24.0
    ).every("1h").to_dataframe()  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "weather.epw"
        energyplus.write_weather(file, climate, damp, cell.START, end, PER_HOUR)
        written = model(damp, end, deep, names)
        theirs = energyplus.run(program, Path(folder) / "run", written, file).records
    found: dict[str, float] = {}
    for zone in zones:
        # An hourly record there is the mean of the steps of the hour.
        mine = 100.0 * ours[f"{zone}.relative_humidity"].to_numpy()
        mine = 0.5 * (mine[1:] + mine[:-1])
        other = theirs[f"{zone}.relative_humidity"].to_numpy()[: len(mine)]
        difference = (mine - other)[24 * SETTLING :]
        warm = ours[f"{zone}.air_temperature"].to_numpy()
        warmer = 0.5 * (warm[1:] + warm[:-1]) - theirs[f"{zone}.air_temperature"].to_numpy()[: len(mine)]
        found[f"{zone}: rms"] = float(np.sqrt(np.mean(difference**2)))
        found[f"{zone}: largest"] = float(np.abs(difference).max())
        found[f"{zone}: swing there"] = float(np.ptp(other[24 * SETTLING :]))
        found[f"{zone}: temperature rms [K]"] = float(np.sqrt(np.mean(warmer[24 * SETTLING :] ** 2)))
    return found


SHOWN = {
    "wall": "Surface Inside Face Temperature",
    "film": "Surface Inside Face Convection Heat Transfer Coefficient",
    "air": "Zone Mean Air Temperature",
    "ratio": "Zone Air Humidity Ratio",
    "flow": "Zone Infiltration Mass Flow Rate",
    "outdoors": "Site Outdoor Air Humidity Ratio",
}
"""What the humidity of the room follows from."""
VAPOUR = 461.52  # gas constant [J/(kg K)]


def rules(program: Path, days: int) -> dict[str, float]:
    """Relative humidity of the room by both rules for its walls, less those of the programs (rms) [%]."""
    damp, climate = building(deep=False, steady=False), cell.climate(weather(steady=False))
    end = str((pd.Timestamp(cell.START) + pd.Timedelta(days=days)).date())
    name = "room.relative_humidity"
    ours = mc.simulate(
        damp, climate, step=3600 // PER_HOUR, outputs=[name], start=cell.START, end=end, initial=24.0
    ).to_dataframe()[name].to_numpy()  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        energyplus.write_weather(place / "weather.epw", climate, damp, cell.START, end, PER_HOUR)
        written = model(damp, end, False, ["room.air_temperature"])
        written["Output:Variable"] = {
            key: {"variable_name": variable, "reporting_frequency": "Timestep"}
            for key, variable in SHOWN.items()
        }
        (place / "in.epJSON").write_text(json.dumps(written))
        words = [str(program), "-w", "weather.epw", "-d", "out", "in.epJSON"]
        subprocess.run(words, cwd=place, check=True, capture_output=True)  # noqa: S603
        table = pd.read_csv(place / "out" / "eplusout.csv")
    taking = [s for s in vapour_sides(damp) if s.takes_up and _in_room(damp, s.surface, s.side)]
    walls = [energyplus.face_name(s.surface, ("outside", "inside")[s.side]) for s in taking]
    areas = np.array([_net(damp, s.surface) for s in taking])
    theirs = _percent(_column(table, "room", "ratio"), _column(table, "room", "air"), damp)
    found, first = {}, 24 * PER_HOUR * 5
    for rule in ("density", "content"):
        mine = _percent(_ratios(table, walls, areas, damp, rule), _column(table, "room", "air"), damp)
        for other, series in (("EnergyPlus", theirs), ("Mascarin", 100.0 * ours[1 : len(mine) + 1])):
            size = min(len(mine), len(series))
            gap = (mine[:size] - series[:size])[first:]
            found[f"{rule} kept, less {other}"] = float(np.sqrt(np.mean(gap**2)))
    return found


def _in_room(damp: Building, surface: str, side: int) -> bool:
    end = damp.surfaces[surface].inside if side else damp.surfaces[surface].outside
    return end.zone == "room"


def _net(damp: Building, surface: str) -> float:
    """Area without doors [m2]."""
    polygons = outlines(damp.surfaces)
    names = list(polygons)
    above = parents(list(polygons.values()))
    inner = [n for n, k in zip(names, above, strict=True) if k is not None and names[k] == surface]
    return float(polygons[surface].area - sum(polygons[n].area for n in inner))


def _column(table: pd.DataFrame, where: str, key: str) -> Any:
    start = f"{where}:{SHOWN[key]}".upper()
    return table[next(c for c in table if c.strip().upper().startswith(start))].to_numpy()


def _pressure(damp: Building) -> float:
    return float(101325.0 * (1.0 - 2.25577e-5 * float(damp.site.altitude)) ** 5.25588)


def _percent(ratio: Any, air: Any, damp: Building) -> Any:
    return relative_humidity(air, ratio, _pressure(damp))


def _ratios(table: pd.DataFrame, walls: list[str], areas: Any, damp: Building, rule: str) -> Any:
    """Humidity ratio of the room, with the content of walls or the density in their pores kept."""
    air, flow, ratio = (_column(table, "room", key) for key in ("air", "flow", "ratio"))
    outdoors = _column(table, "environment", "outdoors")
    wall, film = (np.array([_column(table, name, key) for name in walls]) for key in ("wall", "film"))
    pressure, volume, step = _pressure(damp), float(damp.zones["room"].volume), 3600.0 / PER_HOUR
    kelvin, warm = wall + 273.15, air + 273.15
    full = saturation_pressure(wall) / (VAPOUR * kelvin)
    diffusivity = 2.0e-7 * kelvin**0.81 / pressure / RESISTANCE * VAPOUR * kelvin
    hours = np.arange(len(air)) // PER_HOUR % 24
    source = np.where((hours >= 8) & (hours < 20), POWER / (2500940.0 + 1858.95 * air), 0.0)
    now, found = ratio[0], np.empty(len(air))
    humidity = float(vapour_pressure(now, pressure)) / VAPOUR / warm[0] / full[:, 0]
    for k in range(len(air)):
        if rule == "density" and k:
            humidity = humidity * full[:, k - 1] / full[:, k]
        density = pressure / (287.055 * warm[k] * (1.0 + 1.6078 * now))
        transfer = film[:, k] / (density * (1006.0 + 1860.0 * now))
        there = float(vapour_pressure(now, pressure)) / (VAPOUR * warm[k])
        flux = (humidity * full[:, k] - there) / (0.5 * DEPTHS[0] / diffusivity[:, k] + 1.0 / transfer)
        humidity = np.minimum(humidity - step * flux / (CAPACITY * DEPTHS[0]), 1.0)
        gained = flow[k] * (outdoors[k] - now) + source[k] + float(areas @ flux)
        now += step * gained / (density * volume)
        found[k] = now
    return found


def main() -> None:
    """Print the differences for one layer and for two."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--energyplus", help="the program, or the folder of its environment")
    parser.add_argument("--days", type=int, default=56)
    parser.add_argument("--rules", action="store_true", help="the room by the rules of both programs")
    chosen = parser.parse_args()
    program = energyplus.program_of(chosen.energyplus)
    if chosen.rules:
        for name, value in rules(program, chosen.days).items():
            print(f"  {name:<32}{value:8.3f}", flush=True)
        return
    for steady in (True, False):
        for deep in (False, True):
            layers = "two layers" if deep else "one layer"
            print(f"{layers}, {'constant temperature' if steady else 'measured weather'}", flush=True)
            for name, value in compare(program, chosen.days, deep, steady).items():
                print(f"  {name:<32}{value:8.3f}", flush=True)


if __name__ == "__main__":
    main()
