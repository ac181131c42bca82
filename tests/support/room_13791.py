"""The rooms of EN ISO 13791 calculated a second time, by a network of heat flows in numpy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from mascarin.verification.suites.catalogue.en_iso_13791 import whole
from mascarin.verification.suites.catalogue.en_iso_13791.whole import Case

Array = npt.NDArray[np.float64]

#: Step [s], volumes of a layer, and 4 sigma T^3 of 27 degC [W/(m2 K)].
STEP, VOLUMES, RADIATIVE = 300.0, 4, 4.0 * 5.67e-8 * 300.15**3
AIR_HEAT = 1.2 * 1006.0


@dataclass
class Network:
    """Nodes with capacities [J/K] that exchange heat with each other and with outdoors [W/K]."""

    capacities: list[float] = field(default_factory=list)
    links: list[tuple[int, int, float]] = field(default_factory=list)
    outdoors: dict[int, float] = field(default_factory=dict)

    def node(self, capacity: float = 1e-3) -> int:
        self.capacities.append(capacity)
        return len(self.capacities) - 1

    def wall(self, layers: whole.Layers, area: float) -> tuple[int, int]:
        """Surfaces before the first and behind the last layer."""
        first = last = self.node()
        for name, thickness in layers:
            conductivity, density, heat = whole._MATERIALS[name]
            depth = thickness / VOLUMES
            for _ in range(VOLUMES):
                middle, after = self.node(area * depth * density * heat), self.node()
                half = area * conductivity / (0.5 * depth)
                self.links += [(last, middle, half), (middle, after, half)]
                last = after
        return first, last

    def matrix(self) -> Array:
        size = len(self.capacities)
        matrix = np.zeros((size, size))
        for one, other, conductance in self.links:
            matrix[one, one] += conductance
            matrix[other, other] += conductance
            matrix[one, other] -= conductance
            matrix[other, one] -= conductance
        for node, conductance in self.outdoors.items():
            matrix[node, node] += conductance
        return matrix


def operative(case: Case, to_air: float) -> Array:
    """Operative temperature over the last day, at the ends of steps. [degC]"""
    net = Network()
    air, star = net.node(AIR_HEAT * 55.44), net.node()
    sides: list[tuple[int, float, float]] = []
    heat: dict[int, list[tuple[float, str]]] = {}

    def outside(node: int, area: float, absorptance: float, plane: str) -> None:
        net.outdoors[node] = 13.5 * area
        heat.setdefault(node, []).append((absorptance * area, plane))

    facade = 3.6 * 2.8 - case.window
    face, inner = net.wall(whole._FACADE, facade)
    outside(face, facade, 0.6, "west")
    sides.append((inner, facade, 2.5))
    sides.append((net.wall(whole._PARTITION, whole._PARTITIONS)[1], whole._PARTITIONS, 2.5))
    top, under = net.wall(case.slab, 19.8)
    sides.append((top, 19.8, 0.7))
    if case.under_roof:
        sky, ceiling = net.wall(whole._ROOF, 19.8)
        outside(sky, 19.8, 0.9, "level")
        sides.append((ceiling, 19.8, 5.0))
    else:
        sides.append((under, 19.8, 5.0))
    through = _window(net, case, sides, heat)
    for node, area, film in sides:
        net.links += [(node, air, film * area), (node, star, RADIATIVE * area * 0.9 / (1.0 - 0.9 * 0.1))]
    opaque = [(node, area) for node, area, _ in sides[:-1]]
    shared = sum(area for _, area in opaque)
    # By area: what meets the glass is absorbed, leaves, or returns.
    glass, reflected = case.window / (case.window + shared), _back(case)
    light = through * (1.0 - to_air) / (1.0 - glass * reflected)
    for node, area in opaque:
        heat.setdefault(node, []).append((light * (1.0 - glass) * area / shared, "west"))
    heat.setdefault(sides[-1][0], []).append((light * glass * 0.08, "west"))
    heat.setdefault(air, []).append((through * to_air, "west"))
    return _repeated(net, case, air, sides, heat, [(node, area / shared) for node, area in opaque])


def _back(case: Case) -> float:
    """Reflectance of the glass for light from inside. [-]"""
    return 0.08 if case.panes == 1 else 0.08 + 0.84**2 * 0.08 / (1.0 - 0.08**2)


def _window(
    net: Network,
    case: Case,
    sides: list[tuple[int, float, float]],
    heat: dict[int, list[tuple[float, str]]],
) -> float:
    """Add glass and blind; sun that passes per irradiance. [m2]"""
    area, pane, blind = case.window, (0.84, 0.08), (0.2, 0.5)
    slats, outer = net.node(), net.node()
    net.outdoors[slats] = 13.5 * area
    net.links.append((slats, outer, area / 0.08))
    again = 1.0 - pane[1] ** 2
    if case.panes == 1:
        through, absorbed = pane[0], [0.08]
        nodes = [outer]
    else:
        inner = net.node()
        net.links.append((outer, inner, area / 0.173))
        through = pane[0] ** 2 / again
        absorbed = [0.08 * (1.0 + pane[0] * pane[1] / again), 0.08 * pane[0] / again]
        nodes = [outer, inner]
    sides.append((nodes[-1], area, 2.5))
    reaching = blind[0] / (1.0 - blind[1] * _back(case))
    for node, part in zip(nodes, absorbed, strict=True):
        heat.setdefault(node, []).append((reaching * part * area, "west"))
    of_slats = (1.0 - blind[0] - blind[1]) * (1.0 + reaching * _back(case))
    heat.setdefault(slats, []).append((of_slats * area, "west"))
    return reaching * through * area


def _repeated(
    net: Network,
    case: Case,
    air: int,
    sides: list[tuple[int, float, float]],
    heat: dict[int, list[tuple[float, str]]],
    shares: list[tuple[int, float]],
) -> Array:
    count = int(86400 / STEP)
    hour = (np.arange(count) + 1.0) * STEP / 3600.0
    at = np.arange(25)

    def hourly(values: npt.ArrayLike) -> Array:
        numbers = np.asarray(values, dtype=np.float64)
        day: Array = np.interp(hour, at, np.concatenate(([numbers[-1]], numbers)))
        return day

    within = np.minimum((hour - 1e-6).astype(int), 23)
    gains = np.array(whole._GAINS)[within] * 19.8
    changes = np.array(whole._AIR[case.name[4]])[within]
    outdoor = hourly(case.day.air)
    sun = {"west": hourly(case.day.on_facade), "level": hourly(case.day.on_roof)}
    flows = np.zeros((count, len(net.capacities)))
    for node, conductance in net.outdoors.items():
        flows[:, node] += conductance * outdoor
    for node, parts in heat.items():
        for part, plane in parts:
            flows[:, node] += part * sun[plane]
    flows[:, air] += 0.5 * gains
    for node, share in shares:
        flows[:, node] += 0.5 * gains * share
    exchange = AIR_HEAT * 55.44 / 3600.0 * changes
    flows[:, air] += exchange * outdoor
    capacity = np.diag(net.capacities) / STEP
    solvers = {}
    for rate in np.unique(exchange):
        matrix = net.matrix()
        matrix[air, air] += rate
        solvers[rate] = np.linalg.inv(capacity + matrix)
    areas = np.array([area for _, area, _ in sides])
    nodes = [node for node, _, _ in sides]
    held = capacity.diagonal()[:, None]
    # A day maps the state at its begin, and 1, to that at its end: the day that repeats is its fixed point.
    size = len(net.capacities)
    state = np.eye(size, size + 1)
    for step in range(count):
        state = held * state
        state[:, -1] += flows[step]
        state = solvers[exchange[step]] @ state
    start = np.linalg.solve(np.eye(size) - state[:, :size], state[:, -1])
    result = np.empty(count)
    for step in range(count):
        start = solvers[exchange[step]] @ (held[:, 0] * start + flows[step])
        result[step] = 0.5 * start[air] + 0.5 * start[nodes] @ areas / areas.sum()
    return result
