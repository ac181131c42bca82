"""Conduction in a block of soil by finite volumes: ``C dT/dt = -K T + sum b_port T_port``, symmetric.

A quarter of a rectangle (or half of a strip) is calculated; its planes of symmetry and its far sides let no
heat through. The soil touches the zone (floor, and walls of a basement), the outdoor air and, where it is
given, the deep soil. The ground under the walls touches nothing.

Source: Patankar 1980, Numerical Heat Transfer and Fluid Flow, ch. 4 (finite volumes, conductances in series).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin.building.soil.grid import COARSE, FINE, axis
from mascarin.errors import SolverError

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]
    Fields = Callable[[Array], Array]
    Flags = npt.NDArray[np.bool_]

#: Relative residual at which a solution is taken, and the iterations after which none is.
_RESIDUAL: Final = 1e-7
_MOST: Final = 2000
#: Rate that is none [1/s]: once in the age of the earth.
_NEVER: Final = 1e-16


@dataclass(frozen=True)
class SoilGeometry:
    """A block of soil below and around a rectangle.

    Parameters
    ----------
    length, width : float
        Of the floor between its walls; `length` is infinite for a strip. [m]
    wall : float
        Thickness of the walls on the ground. [m]
    basement : float
        Depth of the floor below the ground; 0 for a slab on the ground. [m]
    far, depth : float
        Soil beside the walls and below the ground. [m]
    conductivity, capacity : float
        Of the soil. [W/(m K)], [J/(m3 K)]
    inside, outside : float
        From the zone to the soil through film and construction, and from the soil to the outdoor air.
        [W/(m2 K)]
    deep : bool
        Whether the bottom has a given temperature; else it lets no heat through.
    horizontal, vertical : (float, float)
        Insulation below the floor along its edge, its reach; down along the outer side of the walls, its
        depth; and their resistances. [m], [m2 K/W]
    contact : {"both", "floor", "walls"}
        What of a basement touches the soil; nothing passes the rest.
    """

    length: float
    width: float
    wall: float
    basement: float
    far: float
    depth: float
    conductivity: float
    capacity: float
    inside: float
    outside: float
    deep: bool
    horizontal: tuple[float, float] = (0.0, 0.0)
    vertical: tuple[float, float] = (0.0, 0.0)
    contact: Literal["floor", "walls", "both"] = "both"

    @property
    def strip(self) -> bool:
        """Whether it is a strip without ends."""
        return bool(np.isinf(self.length))

    @property
    def layered(self) -> bool:
        """Whether conduction is the same everywhere, so that only the top is not that of a half-space."""
        return self.basement == 0.0 and self.vertical[0] * self.vertical[1] == 0.0

    @property
    def area(self) -> float:
        """Of what touches the soil: floor, walls, or both; of a strip for each metre. [m2, m2/m]"""
        if self.strip:
            floor, walls = self.width, 2.0 * self.basement
        else:
            floor, walls = self.length * self.width, 2.0 * (self.length + self.width) * self.basement
        return {"floor": floor, "walls": walls, "both": floor + walls}[self.contact]


@dataclass(frozen=True)
class _Axes:
    """Widths and middles of the cells along x and y, from the middle of the floor, and down."""

    widths: tuple[Array, Array, Array]
    middles: tuple[Array, Array, Array]

    @classmethod
    def of(cls, block: SoilGeometry) -> _Axes:
        """Choose the cells of a block."""
        across = _horizontal(block, block.width)
        along = (np.ones(1), np.zeros(1)) if block.strip else _horizontal(block, block.length)
        bends = [0.0, block.basement, block.vertical[0]]
        size = FINE if block.layered else COARSE
        down = axis(sorted({0.0, block.basement, block.vertical[0], block.depth}), bends, size)
        return cls((across[0], along[0], down[0]), (across[1], along[1], down[1]))


def _horizontal(block: SoilGeometry, size: float) -> tuple[Array, Array]:
    inner, outer = 0.5 * size, 0.5 * size + block.wall
    edges = {0.0, inner, outer, outer + block.far}
    reach = block.horizontal[0]
    if 0.0 < reach < inner:
        edges.add(inner - reach)
    cells = FINE if block.layered else COARSE
    return axis(sorted(edges), [inner, outer, inner - reach], cells)


class FiniteVolumes:
    """The equations of a block, and their solution.

    Parameters
    ----------
    block : SoilGeometry
        The block.

    Attributes
    ----------
    capacities : ndarray
        Of the cells. [J/K]
    inside, outside, deep : ndarray
        Conductance of each cell to the zone, the outdoor air and the deep soil. [W/K]
    """

    def __init__(self, block: SoilGeometry) -> None:
        self.block = block
        self._axes = _Axes.of(block)
        self._shape = tuple(len(widths) for widths in self._axes.widths)
        x, y, z = self._axes.middles
        inner = (np.abs(x) < 0.5 * block.width)[:, None]
        outer = (np.abs(x) < 0.5 * block.width + block.wall)[:, None]
        if not block.strip:
            inner = inner & (y < 0.5 * block.length)[None, :]
            outer = outer & (y < 0.5 * block.length + block.wall)[None, :]
        self._soil = ~(inner[:, :, None] & (z < block.basement)[None, None, :])
        # A quarter of a rectangle, or half a strip, stands for all of it.
        self._parts = 2.0 if block.strip else 4.0
        links = [self._links(direction, outer) for direction in range(3)]
        self.inside, self.outside, self.deep = self._ports(inner, outer)
        self.matrix = self._assemble(links)
        self.capacities = self._parts * block.capacity * self._volumes()[self._soil]
        # The top is part of what is solved where it is all that is not separable.
        top = 0.0 if block.layered else self._top()
        self._separable = _Separable(self._axes.widths, block, self._parts, top)

    def _top(self) -> float:
        """Mean conductance of the top of the grid to the zone and the outdoor air. [W/(m2 K)]"""
        conductance = float(self.inside.sum() + self.outside.sum())
        return conductance / (self._parts * float(self._faces(2)[:, :, 0].sum()))

    def _volumes(self) -> Array:
        dx, dy, dz = self._axes.widths
        return np.asarray(dx[:, None, None] * dy[None, :, None] * dz[None, None, :])

    def _faces(self, direction: int) -> Array:
        """Areas of the cells across a direction. [m2]"""
        widths = list(self._axes.widths)
        widths[direction] = np.ones_like(widths[direction])
        dx, dy, dz = widths
        return np.asarray(dx[:, None, None] * dy[None, :, None] * dz[None, None, :])

    def _links(self, direction: int, outer: Flags) -> tuple[Array, Flags]:
        """Conductance between neighbours in a direction, and where both are soil."""
        widths = self._axes.widths[direction]
        shape = [1, 1, 1]
        shape[direction] = -1
        resistance = (0.5 * (widths[:-1] + widths[1:]) / self.block.conductivity).reshape(shape)
        resistance = np.broadcast_to(resistance, _before(self._volumes(), direction).shape).copy()
        depth, insulation = self.block.vertical
        if insulation > 0.0 and direction < 2:
            crosses = _before(outer[:, :, None], direction) & ~_after(outer[:, :, None], direction)
            resistance[crosses & (self._axes.middles[2] < depth)[None, None, :]] += insulation
        conductance = self._parts * _before(self._faces(direction), direction) / resistance
        both = _before(self._soil, direction) & _after(self._soil, direction)
        return conductance, both

    def _ports(self, inner: Flags, outer: Flags) -> tuple[Array, Array, Array]:
        """Conductances of the cells to the zone, the outdoor air and the deep soil. [W/K]"""
        block, z = self.block, self._axes.middles[2]
        zone, air, deep = (np.zeros(self._shape) for _ in range(3))
        half = [0.5 * widths / block.conductivity for widths in self._axes.widths]
        air[:, :, 0] = np.where(outer, 0.0, self._faces(2)[:, :, 0] / (1.0 / block.outside + half[2][0]))
        below = int(np.searchsorted(z, block.basement))
        covered = inner & ~self._beyond_edge_insulation()
        resistance = 1.0 / block.inside + np.where(covered, block.horizontal[1], 0.0)
        floor = self._faces(2)[:, :, below] / (resistance + half[2][below])
        zone[:, :, below] += np.where(inner & (block.contact != "walls"), floor, 0.0)
        directions = (0, 1) if block.basement > 0.0 and not block.strip else (0,)
        for direction in directions if block.contact != "floor" else ():
            # The first cells beyond the inner side of the walls of a basement.
            beside = ~_before(self._soil, direction) & _after(self._soil, direction)
            shape = [1, 1, 1]
            shape[direction] = -1
            wall = 1.0 / block.inside + half[direction].reshape(shape)
            beyond = _after(self._faces(direction) / wall, direction)
            _after(zone, direction)[...] += np.where(beside, beyond, 0.0)
        if block.deep:
            deep[:, :, -1] = self._faces(2)[:, :, -1] / half[2][-1]
        zone, air, deep = (self._parts * port[self._soil] for port in (zone, air, deep))
        return zone, air, deep

    def _beyond_edge_insulation(self) -> Flags:
        """Cells, seen from above, that no insulation along the edge of the floor covers."""
        reach, block = self.block.horizontal[0], self.block
        x, y, _ = self._axes.middles
        core = (x < 0.5 * block.width - reach)[:, None]
        return core if block.strip else core & (y < 0.5 * block.length - reach)[None, :]

    def _assemble(self, links: list[tuple[Array, Flags]]) -> Any:
        """The matrix of conduction, ports included."""
        from scipy import sparse

        number = np.cumsum(self._soil.ravel()).reshape(self._shape) - 1
        size = int(self._soil.sum())
        diagonal = self.inside + self.outside + self.deep
        rows: list[Any] = []
        columns: list[Any] = []
        values: list[Any] = []
        for direction, (conductance, both) in enumerate(links):
            cell, other = (part(number, direction)[both] for part in (_before, _after))
            through = conductance[both]
            rows += [cell, other]
            columns += [other, cell]
            values += [-through, -through]
            diagonal = diagonal + np.bincount(cell, through, size) + np.bincount(other, through, size)
        rows.append(np.arange(size))
        columns.append(np.arange(size))
        values.append(diagonal)
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        return sparse.csr_matrix(entries, shape=(size, size))

    def image(self, fields: Array) -> Array:
        """``K`` times fields of temperatures. [W]"""
        return np.asarray(self.matrix @ fields)

    def solve(self, heat: Array, rate: float = 0.0, guess: Array | None = None) -> Array:
        """Solve ``(K + rate C) T = heat`` by conjugate gradients.

        Parameters
        ----------
        heat : ndarray
            Heat into the cells. [W]
        rate : float
            Of the exponential that the solution follows; 0 is the steady state. [1/s]
        guess : ndarray, optional
            Temperatures that the search begins at; none: zero. [K]

        Returns
        -------
        ndarray
            Temperatures. [K]

        References
        ----------
        Hestenes and Stiefel 1952, doi:10.6028/jres.049.044.
        """
        if self.block.layered:
            return self._by_surface(heat, rate, guess)
        inverse = self._separable.of_rate(rate)
        grid = np.zeros(self._shape)

        def eased(residual: Array) -> Array:
            grid[self._soil] = residual
            return np.asarray(inverse(grid)[self._soil])

        def image(field: Array) -> Array:
            return self.image(field) + rate * self.capacities * field

        return _conjugate(heat, (image, eased), guess)

    def _by_surface(self, heat: Array, rate: float, guess: Array | None) -> Array:
        """Temperatures of a block that heat enters by its top alone, from those of the top."""
        shape = self._shape
        # A block that nothing holds but its top has no response to heat that never changes.
        rate = rate if self.block.deep else max(rate, _NEVER)
        touching = (self.inside + self.outside).reshape(shape)[:, :, 0]
        entering = heat.reshape(shape)[:, :, 0]
        response, resists, eased = self._separable.surface(rate, float(touching.sum()))
        first = None if guess is None else guess.reshape(shape)[:, :, 0]

        def image(top: Array) -> Array:
            return resists(top) + touching * top

        top = _conjugate(entering, (image, eased), first)
        return response(resists(top)).ravel()


def _conjugate(heat: Array, functions: tuple[Fields, Fields], guess: Array | None) -> Array:
    """Solve a symmetric system, given as a function with one that eases it, by conjugate gradients."""
    image, eased = functions
    enough = _RESIDUAL**2 * float(np.vdot(heat, eased(heat)))
    solution = np.zeros_like(heat) if guess is None else guess.copy()
    residual = heat - image(solution)
    direction = better = eased(residual)
    square = float(np.vdot(residual, better))
    for _ in range(_MOST):
        if square <= enough:
            return solution
        along = image(direction)
        step = square / float(np.vdot(direction, along))
        solution = solution + step * direction
        residual = residual - step * along
        better = eased(residual)
        following = float(np.vdot(residual, better))
        direction = better + following / square * direction
        square = following
    raise SolverError(
        f"soil: {_MOST} iterations left a residual of {(square / enough) ** 0.5 * _RESIDUAL:.1e}; expected "
        f"{_RESIDUAL:g}. Give sizes of the block that are closer to each other"
    )


def _before(values: Any, direction: int) -> Any:
    """All but the last along a direction."""
    if values.shape[direction] == 1:
        return values if direction == 2 else values[(slice(None),) * direction + (slice(0, 0),)]
    return values[(slice(None),) * direction + (slice(None, -1),)]


def _after(values: Any, direction: int) -> Any:
    """All but the first along a direction."""
    if values.shape[direction] == 1:
        return values if direction == 2 else values[(slice(None),) * direction + (slice(0, 0),)]
    return values[(slice(None),) * direction + (slice(1, None),)]


class _Separable:
    """Inverse of a block of soil that touches the same at all of its top: a sum over the three directions.

    Source: Lynch, Rice and Thomas 1964, doi:10.1007/BF01386067 (direct solution by tensor products).
    """

    def __init__(
        self, widths: tuple[Array, Array, Array], block: SoilGeometry, parts: float, top: float
    ) -> None:
        self._block, self._parts = block, parts
        ends = [(0.0, 0.0), (0.0, 0.0), (top, 0.0)]
        if block.deep:
            ends[2] = (ends[2][0], block.conductivity / (0.5 * float(widths[2][-1])))
        modes = [_modes(cells, block.conductivity, end) for cells, end in zip(widths, ends, strict=True)]
        (a, self._x), (b, self._y), (c, self._z) = modes
        self._rates = a[:, None, None] + b[None, :, None] + c[None, None, :]

    def of_rate(self, rate: float) -> Fields:
        """The inverse for a rate [1/s], as a function of a grid."""
        factor = 1.0 / (self._parts * (self._rates + rate * self._block.capacity))

        x, y, z = self._x, self._y, self._z
        flat = (len(x), len(y) * len(z))

        def inverse(grid: Array) -> Array:
            modal = (x.T @ grid.reshape(flat)).reshape(grid.shape)
            modal = (y.T @ (modal @ z)) * factor
            modal = y @ (modal @ z.T)
            return np.asarray((x @ modal.reshape(flat)).reshape(grid.shape))

        return inverse

    def surface(self, rate: float, touching: float) -> tuple[Fields, Fields, Fields]:
        """Functions of heat into the top, and of its temperatures, for a rate [1/s].

        The temperatures of the block by heat; the heat that the top takes; and its temperatures where it
        touches the same everywhere, ``touching`` in all. [W/K]
        """
        x, y, z = self._x, self._y, self._z
        factor = 1.0 / (self._parts * (self._rates + rate * self._block.capacity))
        takes = 1.0 / (factor @ z[0] ** 2)
        across, along = (1.0 / (modes**2).sum(axis=1) for modes in (x, y))
        mean = touching / (float(across.sum()) * float(along.sum()))
        cells = across[:, None] * along[None, :]

        def response(heat: Array) -> Array:
            modal = (x.T @ heat @ y)[:, :, None] * factor * z[0]
            modal = y @ (modal @ z.T)
            return np.asarray((x @ modal.reshape(len(x), -1)).reshape(modal.shape[0], *modal.shape[1:]))

        def resists(top: Array) -> Array:
            return np.asarray(cells * (x @ (takes * (x.T @ (cells * top) @ y)) @ y.T))

        def eased(heat: Array) -> Array:
            return np.asarray(x @ ((x.T @ heat @ y) / (takes + mean)) @ y.T)

        return response, resists, eased


def _modes(widths: Array, conductivity: float, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Eigenvalues [W/(m3 K)] and modes of conduction along a row of cells, with what its ends touch."""
    from scipy.linalg import eigh_tridiagonal

    links = conductivity / (0.5 * (widths[:-1] + widths[1:]))
    diagonal = np.zeros(len(widths))
    diagonal[:-1] += links
    diagonal[1:] += links
    diagonal[0] += ends[0]
    diagonal[-1] += ends[1]
    root = np.sqrt(widths)
    if len(widths) == 1:
        return diagonal / widths, np.ones((1, 1)) / root[:, None]
    values, vectors = eigh_tridiagonal(diagonal / widths, -links / (root[:-1] * root[1:]))
    return np.maximum(values, 0.0), vectors / root[:, None]
