"""Humidity of rooms in Mascarin and EnergyPlus, with the same penetration depths, sources and flows of air.

The cell of `cell.py` without phase change: two zones, a source of vapour by day, sorption in proportion to
the relative humidity in all materials that face a zone, one layer or two. EnergyPlus 25.2 runs its model of
effective moisture penetration depth with conduction transfer functions and steps of a minute.

    python bench/energyplus_humidity.py --energyplus PATH [--days 28]

prints the root mean square of the difference of the relative humidities of the zones [%], after days in
which the programs forget their different starts.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

import cell
import energyplus
import numpy as np
import pandas as pd

import mascarin as mc
from mascarin.building import Building
from mascarin.building.vapour_sides import vapour_sides

SETTLING = 7  # days left out of the comparison
PER_HOUR = 60
#: Moisture content at a relative humidity of 1 [kg/m3], vapour resistance factor [-], depths [m].
CAPACITY, RESISTANCE, DEPTHS = 12.0, 8.0, (0.006, 0.012)
#: Latent heat of the source [W]; EnergyPlus divides it by the enthalpy of vapour [J/kg].
POWER, ENTHALPY = 60.0, 2.5009e6 + 1858.95 * 24.0
#: The source acts from 8 to 20 h.
DAY = [{"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}, {"at": "20:00", "value": 0}]
#: The same materials take up vapour on the sides of zones; steel does not.
DRY = ("steel",)


def building(deep: bool) -> Building:
    """The cell without phase change, with vapour balances."""
    plain = cell.building().replace(
        {"materials.energain": {"conductivity": 0.2, "density": 900, "specific_heat": 2000}}
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


def compare(program: Path, days: int, deep: bool) -> dict[str, float]:
    """Root mean square and largest difference of the relative humidity of each zone [%]."""
    damp = building(deep)
    end = str((pd.Timestamp(cell.START) + pd.Timedelta(days=days)).date())
    weather = cell.climate(cell.table())
    energyplus.OUTPUTS["relative_humidity"] = "Zone Air Relative Humidity"
    zones = list(damp.zones)
    names = [f"{zone}.{kind}" for zone in zones for kind in ("relative_humidity", "air_temperature")]
    ours = mc.simulate(
        damp, weather, step=3600 // PER_HOUR, outputs=names, start=cell.START, end=end, initial=24.0
    ).every("1h").to_dataframe()  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "weather.epw"
        energyplus.write_weather(file, weather, damp, cell.START, end, PER_HOUR)
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


def main() -> None:
    """Print the differences for one layer and for two."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--energyplus", help="the program, or the folder of its environment")
    parser.add_argument("--days", type=int, default=28)
    chosen = parser.parse_args()
    program = energyplus.program_of(chosen.energyplus)
    for deep in (False, True):
        print("two layers" if deep else "one layer")
        for name, value in compare(program, chosen.days, deep).items():
            print(f"  {name:<32}{value:8.3f}")


if __name__ == "__main__":
    main()
