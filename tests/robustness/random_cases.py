"""A random case: a building, its weather, the options of its run, and the parameters of an ensemble."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import random_buildings
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.simulation.simulation import Simulation
from random_draw import Draw
from random_weather import Weather, weather

Array = npt.NDArray[np.float64]

#: Sections whose numbers belong together.
TOGETHER = ("glazings.", "materials.", "windows.")
#: Trials for a member whose parameters can stand together.
TRIALS = 8


@dataclass
class Case:
    """A building in its weather."""

    seed: int
    tree: dict[str, Any]
    weather: Weather

    @property
    def options(self) -> dict[str, Any]:
        """Options of the run."""
        return self.weather.options

    def building(self) -> Building:
        """The building.

        Raises
        ------
        InputError
            The description cannot be used.
        """
        return Building.from_dict(self.tree)

    def simulation(self, building: Building) -> Simulation:
        """The run of all outputs.

        Raises
        ------
        InputError
            The building and its weather do not fit.
        """
        names = [output.name for output in building.outputs()]
        return Simulation(
            building, self.weather.climate(), measurements=self.weather.measurements(), outputs=names,
            **self.options,
        )  # fmt: skip

    def vectors(self, simulation: Simulation) -> Array:
        """Unlike members: some parameters anywhere in their plausible ranges, shape (members, P)."""
        draw = Draw(f"members {self.seed}")
        varying = [
            parameter
            for parameter in simulation.building.parameters()
            if parameter.varies and not parameter.members
        ]
        chosen = draw.some(varying, least=1)[: draw.whole(1, 12)] if varying else []
        rows = []
        for _ in range(draw.of(3, 3, 4, 5, 6, 7, 8, 9, 11, 16, 17, 19)):
            for _ in range(TRIALS):
                values = {
                    parameter.path: draw.number(parameter.low, parameter.high)
                    for parameter in chosen
                    if draw.chance(0.8)
                }
                row = _possible(simulation, values)
                if row is not None:
                    break
            rows.append(simulation.values if row is None else row)
        return np.array(rows)


def _possible(simulation: Simulation, values: dict[str, float]) -> Array | None:
    """A parameter vector, or None where the values cannot stand together."""
    try:
        # Checked as descriptions are where values belong together: optics of panes, curves of materials.
        if any(path.startswith(TOGETHER) for path in values):
            simulation.building.with_values(values)
        vector = simulation.vector(values)
        simulation._require_possible(vector[None, :])
    except InputError:
        return None
    return vector


def case(seed: int) -> Case:
    """The case of a seed."""
    outdoors = weather(seed)
    return Case(seed, random_buildings.description(seed, outdoors), outdoors)
