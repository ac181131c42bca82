"""A room with a phase-change ceiling, and a small study of its designs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

BUILDING = """
name: room
site: {latitude: 27.97, longitude: -82.53, altitude: 6, timezone: UTC-5}
materials:
  board: {conductivity: 0.2, density: 800, specific_heat: 1000}
  pcm: {product: RT28HC}
constructions:
  wall: {layers: [{material: board, thickness: 0.02}]}
  ceiling:
    layers: [{material: board, thickness: 0.01}, {material: pcm, thickness: 0.01}]
zones: {room: {volume: 30, infiltration: {constant: {value: 1, range: [0.5, 2]}}}}
openings: {window: {zone: room, area: 0.4, height: 0.4, wind_coefficient: 0.2}}
surfaces:
  ceiling: {construction: ceiling, area: 10, tilt: 0,
            outside: {outdoors: true, convection: 15, emissivity: 0.9, absorptance: 0.6},
            inside: {zone: room, convection: 2, emissivity: 0.9}}
  walls: {construction: wall, area: 30, tilt: 90, azimuth: 180,
          outside: {outdoors: true, convection: 15, emissivity: 0.9,
                    absorptance: {value: 0.5, range: [0.3, 0.7]}},
          inside: {zone: room, convection: 3, emissivity: 0.9}}
"""

STUDY = """
name: room
building: building.yaml
climates: {tampa: {epw: "shipped:tampa", start: 07-01, end: 07-03}}
step: 1h
variables:
  product: {material: pcm, products: [RT25HC, RT28HC]}
  thickness: {path: constructions.ceiling.layers.pcm.thickness, values: [0.005, 0.02]}
  place:
    variants:
      inside: {}
      outside:
        constructions.ceiling.layers: [{material: pcm, thickness: 0.01}, {material: board, thickness: 0.01}]
objectives:
  hot: {kind: degree_hours, zones: [room], above: 27}
  latent: {kind: latent_use, layer: ceiling.pcm}
  cycles: {kind: cycle_days, layer: ceiling.pcm, change: 0.2}
  mass: {kind: mass, layers: [ceiling.pcm]}
  cost: {kind: cost, per_kg: {ceiling.pcm: 2}, products: {RT25HC: 3}, choices: {place: {outside: 100}}}
  cooling: {kind: cooling_energy, zones: [room], setpoint: 25}
uncertainty:
  parameters: [zones.room.infiltration.constant, surfaces.walls.outside.absorptance]
  samples: 6
  designs: 3
"""


def written(folder: Path, **changes: Any) -> Path:
    """Write building and design file, with other values of some keys (None: without), into a folder."""
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    yaml = YAML(typ="safe")
    content = yaml.load(STUDY)
    for key, value in changes.items():
        if value is None:
            content.pop(key)
        else:
            content[key] = value
    with (folder / "design.yaml").open("w", encoding="utf-8") as file:
        yaml.dump(content, file)
    return folder / "design.yaml"
