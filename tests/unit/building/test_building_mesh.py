"""The mesh: as many volumes as the step resolves, at the worst end of the ranges."""

from __future__ import annotations

import pytest

from building_samples import ROOM, everything, room
from mascarin.building import Building
from mascarin.building.engine_input.mesh import (
    LEAST_IN_PCM,
    MOST_FOR_MELTING,
    MOST_IN_LAYER,
    choose,
    diffusion_count,
)
from mascarin.building.reading import parse

# Layers of the test cell of Guichard et al., and node counts that were found to be enough for 0.002 K.
LAYERS = [
    ("fibre-cement", 0.005, 0.58, 1900 * 1000, 1),
    ("polyurethane", 0.070, 0.028, 30 * 1470, 4),
    ("concrete", 0.080, 1.75, 2240 * 900, 4),
    ("polystyrene", 0.060, 0.040, 20 * 1450, 3),
    ("plasterboard", 0.0125, 0.16, 800 * 1090, 2),
    ("steel", 0.001, 45, 7800 * 480, 1),
]


@pytest.mark.parametrize(("name", "thickness", "conductivity", "capacity", "nodes"), LAYERS)
def test_node_counts_of_a_known_cell(
    name: str, thickness: float, conductivity: float, capacity: float, nodes: int
) -> None:
    assert diffusion_count(thickness, conductivity, capacity, 900.0) == nodes, name


def test_a_shorter_step_needs_more_volumes() -> None:
    """A depth is sqrt(2 alpha dt/pi): a quarter of the step needs twice the volumes."""
    alpha = 1e-6
    thickness = 10 * (2 * alpha * 900 / 3.141592653589793) ** 0.5
    assert diffusion_count(thickness, alpha, 1.0, 900.0) == 10
    assert diffusion_count(thickness, alpha, 1.0, 225.0) == 20


def test_the_mesh_resolves_the_worst_end_of_a_range() -> None:
    building, layer = room(), ("wall", "concrete")
    nominal = choose(building, 900).nodes[layer]
    assert nominal == 9
    worse = {
        "materials.concrete.conductivity": (0.5, 2.0),
        "materials.concrete.density": (2000.0, 2600.0),
        "constructions.wall.layers.concrete.specific_heat": (800.0, 1100.0),
        "constructions.wall.layers.concrete.thickness": (0.15, 0.25),
    }
    assert choose(building, 900, worse).nodes[layer] == diffusion_count(0.25, 0.5, 2600 * 1100, 900) == 25
    for path, ends in worse.items():
        assert choose(building, 900, {path: ends}).nodes[layer] > nominal, path
    assert choose(building, 900, {"zones.room.volume": (1.0, 99.0)}).nodes[layer] == nominal


def wax(changes: dict[str, object]) -> tuple[int, tuple[str, ...]]:
    mesh = choose(everything()[0].replace(changes), 900)
    return mesh.nodes["ceiling", "wax"], mesh.warnings


def test_a_phase_change_layer() -> None:
    assert wax({})[0] == LEAST_IN_PCM
    # 20 W/m2 over 5.26 mm at 0.18 W/(m K) are 0.58 K; gamma 0.5 is a half-width of 0.08 K.
    assert wax({"materials.wax.law.gamma": 0.5})[0] == 8
    assert wax({"materials.wax.law.gamma": 100})[0] == MOST_FOR_MELTING
    ranges = {"materials.wax.law.gamma": (0.01, 0.5)}
    assert choose(everything()[0], 900, ranges).nodes["ceiling", "wax"] == 8
    assert wax({"constructions.ceiling.layers.wax.nodes": 3}) == (
        3,
        ("constructions.ceiling.layers.wax.nodes: 3 given, 4 would resolve a step of 900 s",),
    )


def test_latent_heat_does_not_change_the_mesh() -> None:
    assert wax({"materials.wax.latent_heat": 1e6})[0] == wax({"materials.wax.latent_heat": 1e4})[0]


def test_a_resistance_has_no_nodes() -> None:
    assert choose(everything()[0], 900).nodes["wall", "gap"] == 0


def thick(text: str) -> Building:
    return parse(ROOM.replace("thickness: 0.2", text), "room.yaml")


def test_too_many_volumes_are_limited_with_a_warning() -> None:
    mesh = choose(thick("thickness: 3"), 900)
    assert mesh.nodes["wall", "concrete"] == MOST_IN_LAYER
    assert mesh.warnings == (
        "constructions.wall.layers.concrete: 135 nodes would resolve a step of 900 s, 60 taken; "
        "split the layer or set its nodes",
    )
    assert choose(thick("thickness: 3, nodes: 200"), 900).nodes["wall", "concrete"] == 200
    assert not choose(thick("thickness: 3, nodes: 200"), 900).warnings
