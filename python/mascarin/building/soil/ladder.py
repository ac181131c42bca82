"""A block of soil reduced to a ladder of a few cells.

The response of the floor to the zone is that of resistances and heat capacities only. Such a response is
that of a row of cells, each with a heat capacity and a resistance to the next (Cauer's first form), which
is a wall for the engine: symmetric, stable, and with a heat content. A rational Krylov space makes it
exact, with its slope, at a set of rates from decades to minutes; the Lanczos method makes the space a row.

Sources: Cauer 1926, doi:10.1007/BF01662000 (ladders); Ruhe 1984, doi:10.1016/0024-3795(84)90221-0 (rational
Krylov spaces); Lanczos 1950, doi:10.6028/jres.045.026; Odabasioglu, Celik and Pileggi 1998,
doi:10.1109/43.712097 (projected networks stay passive).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.soil.finite_volumes import FiniteVolumes, SoilGeometry
from mascarin.errors import SolverError

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Rates at which the ladder has the response of the finite volumes [1/s]: the steady state, and from forty
#: years to ten minutes.
_SLOWEST, _FASTEST, _RATES = 1.0 / (40.0 * 3.15e7), 1.0 / 600.0, 11
#: Part of the resistance of the soil that the last cell has behind it at least: the rounding of a cell of
#: the heat capacity of a kilometre of soil would be in the energy balance. [-]
_LAST: Final = 0.02
#: Part of the largest direction of the space below which another one counts as none. [-]
_DEPENDENT: Final = 1e-9


@dataclass(frozen=True)
class SoilLadder:
    """A row of cells below a floor, from the floor down.

    Attributes
    ----------
    resistances : tuple of float
        From the lower side of the construction to the first cell, between cells, and from the last one to
        what lies behind; one more than there are cells. [m2 K/W]
    capacities : tuple of float
        Of the cells. [J/(m2 K)]
    shares : tuple of float
        Heat into each cell by the outdoor air, for each degree that it is warmer than what lies behind.
        [W/(m2 K)]
    loss : float
        Steady heat from the zone for each degree that it is warmer than outdoors and the deep soil, through
        film and construction. [W/(m2 K)]
    loss_to_deep : float
        The part of it that the deep soil takes. [W/(m2 K)]
    inside : float
        Of film and construction, as the ladder was made. [W/(m2 K)]
    """

    resistances: tuple[float, ...]
    capacities: tuple[float, ...]
    shares: tuple[float, ...]
    loss: float
    loss_to_deep: float
    inside: float

    @property
    def without_last(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Resistances and heat capacities without the last cells, which next to nothing lies behind.

        Their heat capacity, that of a kilometre of soil, is far larger than what the floor feels of it: its
        rounding would be in the energy balance. The steady state stays as it is.
        """
        resistances, capacities = list(self.resistances), list(self.capacities)
        total = sum(resistances)
        while len(capacities) > 1 and resistances[-1] < _LAST * total:
            capacities.pop()
            resistances[-2:] = [resistances[-2] + resistances[-1]]
        return tuple(resistances), tuple(capacities)


@lru_cache(maxsize=64)
def ladder_of(block: SoilGeometry) -> SoilLadder:
    """Reduce a block of soil.

    Parameters
    ----------
    block : SoilGeometry
        The block.

    Returns
    -------
    SoilLadder
        Its cells for each square metre of the surface towards the zone.
    """
    volumes = FiniteVolumes(block)
    rates = np.concatenate([[0.0], np.geomspace(_SLOWEST, _FASTEST, _RATES)])
    space, steady = _space(volumes, rates)
    conduction = space.T @ volumes.image(space)
    inner, outer = space.T @ volumes.inside, space.T @ volumes.outside
    diagonal, beside, vectors = _lanczos(0.5 * (conduction + conduction.T), inner)
    area = block.area
    conductance = float(volumes.inside.sum())
    capacities, conductances = _ladder(diagonal, beside, (conductance, float(np.linalg.norm(inner))))
    # Neighbours of a row have opposite signs in the vectors.
    signs = (-1.0) ** np.arange(len(capacities))
    shares = signs * np.sqrt(capacities) * (vectors.T @ outer)
    resistances = area / conductances
    # Film and construction are no part of the soil.
    resistances[0] -= 1.0 / block.inside
    loss = conductance - float(volumes.inside @ steady)
    return SoilLadder(
        tuple(resistances.tolist()),
        tuple((capacities / area).tolist()),
        tuple((shares / area).tolist()),
        loss / area,
        float(volumes.deep @ steady) / area,
        block.inside,
    )


def _space(volumes: FiniteVolumes, rates: Array) -> tuple[Array, Array]:
    """Space of the temperatures by one degree in the zone that grows at each of some rates, 0 first.

    Its fields have a heat content of one, and none in common (Gram and Schmidt, twice). The steady one
    comes beside.
    """
    # Times the root of the heat capacity, fields without a common heat content are at right angles.
    root = np.sqrt(volumes.capacities)
    scaled = np.zeros((len(root), len(rates)), order="F")
    conduction = np.zeros((len(rates), len(rates)))
    count, steady = 0, np.zeros(0)
    for rate in map(float, rates):
        fields = scaled[:, :count]
        guess = None
        if count:
            # The best combination of the fields so far.
            matrix = conduction[:count, :count] + rate * np.eye(count)
            guess = fields @ np.linalg.solve(matrix, fields.T @ (volumes.inside / root)) / root
        field = volumes.solve(volumes.inside, rate, guess)
        steady = field if rate == 0.0 else steady
        field = root * field
        size = float(np.linalg.norm(field))
        for _ in range(2):
            field -= fields @ (fields.T @ field)
        length = float(np.linalg.norm(field))
        if length > _DEPENDENT * size:
            scaled[:, count] = field / length
            image = volumes.image(scaled[:, count] / root) / root
            count += 1
            conduction[:count, count - 1] = conduction[count - 1, :count] = scaled[:, :count].T @ image
    return scaled[:, :count] / root[:, None], steady


def _lanczos(matrix: Array, start: Array) -> tuple[Array, Array, Array]:
    """The matrix as a row: its diagonal, what is beside it, and the vectors from the start on."""
    size = len(matrix)
    vectors = np.zeros((size, size))
    diagonal, beside = np.zeros(size), np.zeros(size)
    vectors[:, 0] = start / np.linalg.norm(start)
    for k in range(size):
        image = matrix @ vectors[:, k]
        diagonal[k] = vectors[:, k] @ image
        for _ in range(2):
            image -= vectors[:, : k + 1] @ (vectors[:, : k + 1].T @ image)
        beside[k] = np.linalg.norm(image)
        if k + 1 < size:
            vectors[:, k + 1] = image / beside[k]
    return diagonal, beside[:-1], vectors


def _ladder(diagonal: Array, beside: Array, port: tuple[float, float]) -> tuple[Array, Array]:
    """Heat capacities [J/K] and conductances [W/K] of a row, from the port on."""
    conductance, coupling = port
    capacity = (conductance / coupling) ** 2
    capacities, conductances = [capacity], [conductance]
    for k, rate in enumerate(diagonal):
        conductance = rate * capacity - conductance
        if not conductance > 0.0:
            raise SolverError(
                f"soil: cell {k + 1} of the ladder has a conductance of {conductance:g} W/K, expected one "
                "above 0. Give sizes of the block that are closer to each other"
            )
        conductances.append(conductance)
        if k < len(beside):
            capacity = conductance**2 / (capacity * float(beside[k]) ** 2)
            capacities.append(capacity)
    return np.array(capacities), np.array(conductances)
