"""
A model of EnergyPlus
=====================

:func:`mascarin.energyplus.convert` makes a building from an IDF or epJSON file, and lists what it does not
carry over. Needs ``pip install 'mascarin[energyplus]'``; EnergyPlus itself is not needed.
"""

import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.energyplus import convert
from mascarin.examples import clear_days

# %%
# A box of one zone as epJSON.

corners = {
    "floor": [(0, 0, 0), (0, 6, 0), (8, 6, 0), (8, 0, 0)],
    "roof": [(0, 0, 3), (8, 0, 3), (8, 6, 3), (0, 6, 3)],
    "south": [(0, 0, 0), (8, 0, 0), (8, 0, 3), (0, 0, 3)],
    "north": [(8, 6, 0), (0, 6, 0), (0, 6, 3), (8, 6, 3)],
    "east": [(8, 0, 0), (8, 6, 0), (8, 6, 3), (8, 0, 3)],
    "west": [(0, 6, 0), (0, 0, 0), (0, 0, 3), (0, 6, 3)],
}


def surface(name, points):
    """A surface as an object of EnergyPlus."""
    kind = {"floor": "Floor", "roof": "Roof"}.get(name, "Wall")
    ground = (
        {"outside_boundary_condition": "Adiabatic"}
        if name == "floor"
        else {"outside_boundary_condition": "Outdoors"}
    )
    sun = "NoSun" if name == "floor" else "SunExposed"
    wind = "NoWind" if name == "floor" else "WindExposed"
    vertices = [
        {f"vertex_{axis}_coordinate": value for axis, value in zip("xyz", point, strict=True)}
        for point in points
    ]
    return {
        "surface_type": kind, "construction_name": "shell", "zone_name": "room",
        **ground, "sun_exposure": sun, "wind_exposure": wind, "number_of_vertices": 4, "vertices": vertices,
    }  # fmt: skip


model = {
    "Version": {"Version 1": {"version_identifier": "25.2"}},
    "Building": {"box": {"north_axis": 0}},
    "GlobalGeometryRules": {
        "rules": {
            "coordinate_system": "World",
            "starting_vertex_position": "LowerLeftCorner",
            "vertex_entry_direction": "Counterclockwise",
        }
    },
    "Site:Location": {
        "Denver": {"latitude": 39.83, "longitude": -104.65, "time_zone": -7, "elevation": 1650}
    },
    "Material": {
        "concrete": {
            "roughness": "Rough", "thickness": 0.2, "conductivity": 1.75, "density": 2240,
            "specific_heat": 900,
        }
    },
    "Construction": {"shell": {"outside_layer": "concrete"}},
    "Zone": {"room": {}},
    "BuildingSurface:Detailed": {name: surface(name, points) for name, points in corners.items()},
}  # fmt: skip
file = Path(tempfile.mkdtemp()) / "box.epJSON"
file.write_text(json.dumps(model), encoding="utf-8")

found = convert(file)
print(found.building)
for finding in found.findings:
    print(finding)

# %%
# The building runs as any other.

climate = clear_days(39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=4, mean=22, altitude=1650)
zone = next(iter(found.building.zones))
run = mc.simulate(found.building, climate, start="2024-07-02", outputs=[f"{zone}.air_temperature"])
figure, axes = plt.subplots(layout="constrained")
run.plot(ax=axes)
