"""Buildings made step by step, as a user does: parts are added, changed, removed and put in another order.

After any such history the building is compiled and run, and what must hold for every building is checked:
see `fuzz_buildings`. Hypothesis finds a short history that breaks it.
"""

from __future__ import annotations

import random
from typing import Any

import hypothesis
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    precondition,
    rule,
    run_state_machine_as_test,
)

import fuzz_buildings

SEEDS = st.integers(0, 2**32 - 1)
#: Parts that a building may have; more only take longer.
MOST = 8


class Buildings(RuleBasedStateMachine):
    """Any building, with sources, windows, loads and materials that melt."""

    passive = False

    @initialize(seed=SEEDS)
    def begin(self, seed: int) -> None:
        """One to three zones with a floor, a roof and a facade each."""
        self.draw = random.Random(seed)
        self.ways = fuzz_buildings.Ways(melting=not self.passive, passive=self.passive)
        self.tree: dict[str, Any] = fuzz_buildings.description(self.draw, self.ways)
        self.weather = fuzz_buildings.climate()

    def _zones(self) -> list[str]:
        return list(self.tree["zones"])

    @precondition(lambda self: len(self.tree["materials"]) < MOST)
    @rule(seed=SEEDS)
    def add_material(self, seed: int) -> None:
        """A material, and a construction of it alone."""
        draw = random.Random(seed)
        name = f"m{len(self.tree['materials'])}"
        melts = self.ways.melting and draw.random() < 0.5
        self.tree["materials"][name] = fuzz_buildings.melting(draw) if melts else fuzz_buildings.solid(draw)
        self.tree["constructions"][f"of_{name}"] = {"layers": [fuzz_buildings.layer(draw, name, "l0")]}

    @precondition(lambda self: len(self.tree["surfaces"]) < 2 * MOST)
    @rule(seed=SEEDS)
    def add_wall(self, seed: int) -> None:
        """A wall outdoors, or a mass within a zone."""
        draw = random.Random(seed)
        zone = draw.choice(self._zones())
        mass = draw.random() < 0.3
        outside = fuzz_buildings.passive_outside if self.passive else fuzz_buildings.outdoors
        self.tree["surfaces"][f"wall{len(self.tree['surfaces'])}_{zone}"] = {
            "construction": draw.choice(list(self.tree["constructions"])),
            "area": round(draw.uniform(1.0, 30.0), 3), "tilt": 90, "azimuth": draw.choice((0, 90, 213.4)),
            "outside": fuzz_buildings.inside(draw, zone) if mass else outside(draw),
            "inside": fuzz_buildings.inside(draw, zone),
            **({"internal_mass": True} if mass else {}),
        }  # fmt: skip

    @rule(seed=SEEDS)
    def change_a_construction(self, seed: int) -> None:
        """Another construction of a surface."""
        draw = random.Random(seed)
        surface = draw.choice(list(self.tree["surfaces"].values()))
        surface["construction"] = draw.choice(list(self.tree["constructions"]))

    @rule(seed=SEEDS)
    def change_a_zone(self, seed: int) -> None:
        """Another volume, with or without infiltration, loads and gains."""
        draw = random.Random(seed)
        zone = self.tree["zones"][draw.choice(self._zones())]
        zone["volume"] = round(draw.uniform(5.0, 300.0), 3)
        zone["infiltration"] = round(draw.uniform(0.0, 3.0), 3)
        for key in ("heating", "cooling", "gains"):
            zone.pop(key, None)
        if not self.passive and draw.random() < 0.5:
            zone["heating"] = {"setpoint": 20, "capacity": draw.choice((50, 5000))}
            zone["gains"] = {"lamp": {"power": draw.choice((0, 300)), "radiative": 0.4}}

    @rule(seed=SEEDS)
    def remove_a_surface(self, seed: int) -> None:
        """One that is not the only one of a zone, without its windows."""
        draw = random.Random(seed)
        names = [name for name in self.tree["surfaces"] if name.startswith("wall")]
        if names:
            del self.tree["surfaces"][draw.choice(names)]

    @rule(seed=SEEDS)
    def change_the_order(self, seed: int) -> None:
        """The same building with its objects in another order."""
        self.tree = fuzz_buildings.shuffled(self.tree, random.Random(seed))

    def run_it(self, seed: int) -> None:
        """Compile and run it, and check what must hold."""
        found = fuzz_buildings.Found()
        fuzz_buildings.check(self.tree, self.weather, random.Random(seed), found, passive=self.passive)
        assert found.faults == []
        # Nothing here is invalid: a refusal would be a defect of this machine or of the reader.
        assert found.refused == 0, self.tree

    @rule(seed=SEEDS)
    def run(self, seed: int) -> None:
        """Run it before further changes."""
        self.run_it(seed)

    def teardown(self) -> None:
        """Every history ends with a run."""
        if hasattr(self, "tree"):
            self.run_it(0)


class PassiveBuildings(Buildings):
    """Buildings without sources, to which the maximum principle applies."""

    passive = True


def explore(machine: type[Buildings], seed: int, histories: int) -> None:
    """Follow some histories of at most ten changes; an error shows the shortest that breaks a law."""

    class Seeded(machine):  # type: ignore[misc, valid-type]
        pass

    settings = hypothesis.settings(
        max_examples=histories, stateful_step_count=10, deadline=None, database=None,
        suppress_health_check=list(hypothesis.HealthCheck),
    )  # fmt: skip
    run_state_machine_as_test(hypothesis.seed(seed)(Seeded), settings=settings)
