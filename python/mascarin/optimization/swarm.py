"""Particle swarms for continuous and discrete parameters, and a swarm followed by a pattern search.

References
----------
Kennedy and Eberhart (1995), doi:10.1109/ICNN.1995.488968.
Kennedy and Eberhart (1997), discrete binary version, doi:10.1109/ICSMC.1997.637339.
Clerc and Kennedy (2002), constriction, doi:10.1109/4235.985692.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from mascarin.errors import InputError
from mascarin.optimization.base import Observer, Optimizer, Steps
from mascarin.optimization.mesh import SufficientDecrease, decimal_rounding, uniform_starts
from mascarin.optimization.pattern import HookeJeeves
from mascarin.optimization.random import Lcg48
from mascarin.optimization.space import Evaluation, Point, Space

Topology = Literal["gbest", "lbest", "vonNeumann"]


@dataclass(frozen=True)
class SwarmRules:
    """How the particles of a swarm move.

    Parameters
    ----------
    topology : str
        Neighborhood of a particle: all (`gbest`), neighbors in a ring (`lbest`) or in a square
        grid (`vonNeumann`).
    neighbors : int
        Reach to either side in a ring [-].
    particles : int
        Number of particles, rounded up to a square in a grid [-].
    generations : int
        Number of generations [-].
    seed : int
        Seed of the random numbers [-].
    cognitive, social : float
        Acceleration towards the best point of the particle and of its neighbors [-].
    speed : float
        Largest step as a part of the range; no limit when not positive [-].
    discrete_speed : float
        Largest bit velocity [-].
    constriction : float, optional
        Gain of the constriction coefficient; inertia is used instead when absent [-].
    inertia : tuple of float
        First and last inertia weight [-].

    References
    ----------
    Clerc and Kennedy (2002), doi:10.1109/4235.985692.

    Examples
    --------
    >>> SwarmRules(particles=10).size
    16
    """

    topology: Topology = "vonNeumann"
    neighbors: int = 1
    particles: int = 16
    generations: int = 30
    seed: int = 1
    cognitive: float = 2.8
    social: float = 1.3
    speed: float = 0.5
    discrete_speed: float = 4.0
    constriction: float | None = 1.0
    inertia: tuple[float, float] = (1.2, 0.0)

    def __post_init__(self) -> None:
        """Refuse impossible settings."""
        topologies = ("gbest", "lbest", "vonNeumann")
        if self.topology not in topologies:
            msg = f"topology '{self.topology}' is not known: expected one of {', '.join(topologies)}"
            raise InputError(msg)
        if self.particles < 2 or self.generations < 1 or self.neighbors < 1:
            msg = (
                f"{self.particles} particles, {self.generations} generations, reach {self.neighbors}: "
                "expected at least 2, 1 and 1"
            )
            raise InputError(msg)

    @property
    def size(self) -> int:
        """Number of particles after rounding up to a square where the topology needs it [-]."""
        if self.topology != "vonNeumann":
            return self.particles
        return (math.isqrt(self.particles - 1) + 1) ** 2

    @property
    def gain(self) -> float:
        """Constriction coefficient [-]."""
        k, phi = self.constriction or 0.0, self.cognitive + self.social
        return 2.0 * k / abs(2.0 - phi - math.sqrt(phi * (phi - 4.0))) if phi > 4.0 else k

    def neighborhood(self, i: int) -> list[int]:
        """Particles in the neighborhood of a particle, in order.

        Parameters
        ----------
        i : int
            Number of the particle, from 0. [-]
        """
        n = self.size
        if self.topology == "gbest":
            return list(range(n))
        if self.topology == "lbest":
            return [j % n for j in range(i - self.neighbors, i + self.neighbors + 1)]
        side = math.isqrt(n)
        row, column = divmod(i, side)
        cells = [(row - 1, column), (row, column - 1), (row, column), (row, column + 1), (row + 1, column)]
        return [(r % side) * side + c % side for r, c in cells]

    def weight(self, generation: int) -> float:
        """Inertia weight of a generation, decreasing linearly. [-]

        Parameters
        ----------
        generation : int
            Number of the generation, from 1. [-]
        """
        first, last = self.inertia
        return first - (first - last) * (generation - 1) / (self.generations - 1)


class ParticleSwarm(Optimizer):
    """Swarm search with constriction or inertia, optionally on a mesh.

    Parameters
    ----------
    space : Space
        Parameters with bounds.
    rules : SwarmRules
        Settings of the swarm.
    mesh : tuple of int, optional
        Divider and exponent of a mesh around the initial point that particles are moved to.
    penalty : bool
        Whether the cost depends on the step number, which then rises with every generation.
    fresh_step : int
        Step number of new particles before their first evaluation [-].
    rounding : callable, optional
        Rounding on the mesh; see `PatternSearch`.
    observer, remember
        See `Optimizer`.

    References
    ----------
    Kennedy and Eberhart (1995), doi:10.1109/ICNN.1995.488968.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.5, 0.5], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> best = minimize(ParticleSwarm(space), lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost < 1e-2
    True
    """

    def __init__(
        self,
        space: Space,
        rules: SwarmRules | None = None,
        *,
        mesh: tuple[int, int] | None = None,
        penalty: bool = False,
        fresh_step: int = 1,
        rounding: Callable[[float, int], float] | None = None,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_bounds()
        space.require_start()
        self.rules = rules or SwarmRules()
        self._grid = mesh
        self._penalty = penalty
        self._fresh = fresh_step
        self._round = rounding or decimal_rounding(space)
        self._random = Lcg48(self.rules.seed)
        # Bits that the Gray code of the largest index takes.
        self._widths = [max(1, (d.size - 1).bit_length()) for d in space.discrete]

    @property
    def expected(self) -> int | None:
        """Upper limit of the number of evaluations [-]."""
        again = self.rules.size * (self.rules.generations - 1) if self._penalty else 0
        return self.rules.size * self.rules.generations + again

    def _search(self) -> Steps:
        """All generations."""
        yield from self._generations()
        self.observer.minimum("Minimum point.")
        return "all generations are done"

    def _generations(self) -> Generator[list[Point], list[Evaluation], Evaluation]:
        """Move the swarm for all generations; the point of lowest cost is returned."""
        rules = self.rules
        points = self._populate()
        velocities = [[0.0] * len(self.space.continuous) for _ in points]
        bits = [[[0.0] * w for w in self._widths] for _ in points]
        personal_best: list[Evaluation] = []
        reported: list[Evaluation] = []
        for generation in range(1, rules.generations + 1):
            if self._penalty and generation > 1:
                self.step_number += 1
                personal_best = yield [replace(e.point, step=self.step_number) for e in personal_best]
            swarm = yield [self._on_mesh(p) for p in points]
            for e in swarm:
                self.observer.sub(e, f"Generation {generation}.")
                self.observer.main(e, f"Generation {generation}.")
            personal_best = [
                a if not personal_best or a.cost < b.cost else b
                for a, b in zip(swarm, personal_best or swarm, strict=True)
            ]
            reported += swarm
            if generation < rules.generations:
                points = self._move_all(swarm, personal_best, velocities, bits, generation)
        # The latest of equals, among those of the last step number.
        last = [e for e in reversed(reported) if e.point.step == reported[-1].point.step]
        return min(last, key=lambda e: e.cost)

    def _populate(self) -> list[Point]:
        """The first generation: the initial point and random ones."""
        points = [self.space.initial]
        for _ in range(self.rules.size - 1):
            x = tuple(c.lower + self._random.uniform() * (c.upper - c.lower) for c in self.space.continuous)
            choices = tuple(self._random.below(d.size) for d in self.space.discrete)
            points.append(Point(x, choices, self._fresh))
        return points

    def _move_all(
        self,
        swarm: Sequence[Evaluation],
        personal_best: Sequence[Evaluation],
        velocities: list[list[float]],
        bits: list[list[list[float]]],
        generation: int,
    ) -> list[Point]:
        """Positions of the next generation."""
        # One pair of draws for the whole swarm.
        to_own = self.rules.cognitive * self._random.uniform()
        to_best = self.rules.social * self._random.uniform()
        moved = []
        for i, e in enumerate(swarm):
            best = min((personal_best[j] for j in self.rules.neighborhood(i)), key=lambda b: b.cost).point
            mine = personal_best[i].point
            x = self._move_one(e.point.x, mine.x, best.x, velocities[i], (to_own, to_best), generation)
            choices = self._flip(e.point.choices, mine.choices, best.choices, bits[i], (to_own, to_best))
            moved.append(replace(e.point, x=x, choices=choices))
        return moved

    def _move_one(
        self,
        x: tuple[float, ...],
        mine: tuple[float, ...],
        best: tuple[float, ...],
        velocity: list[float],
        toward: tuple[float, float],
        generation: int,
    ) -> tuple[float, ...]:
        """Next continuous position; the velocity is changed in place."""
        rules, out = self.rules, []
        for k, c in enumerate(self.space.continuous):
            towards = toward[0] * (mine[k] - x[k]) + toward[1] * (best[k] - x[k])
            if rules.constriction is not None:
                v = rules.gain * (velocity[k] + towards)
            else:
                v = rules.weight(generation) * velocity[k] + towards
            if rules.speed > 0:
                most = rules.speed * (c.upper - c.lower)
                v = min(max(v, -most), most)
            velocity[k] = v
            value = x[k] + v
            while not c.lower <= value <= c.upper:
                value = 2.0 * (c.lower if value < c.lower else c.upper) - value
            out.append(value)
        return tuple(out)

    def _flip(
        self,
        choices: tuple[int, ...],
        mine: tuple[int, ...],
        best: tuple[int, ...],
        velocity: list[list[float]],
        toward: tuple[float, float],
    ) -> tuple[int, ...]:
        """Next discrete position: every bit of the Gray code is drawn again."""
        most, out = self.rules.discrete_speed, []
        for k, d in enumerate(self.space.discrete):
            width = self._widths[k]
            current_bits, personal_bits, best_bits = (_gray(v, width) for v in (choices[k], mine[k], best[k]))
            bits = []
            for b in range(width):
                v = (
                    velocity[k][b]
                    + toward[0] * (personal_bits[b] - current_bits[b])
                    + toward[1] * (best_bits[b] - current_bits[b])
                )
                v = min(max(v, -most), most)
                velocity[k][b] = v
                bits.append(1 if self._random.uniform() < 1.0 / (1.0 + math.exp(-v)) else 0)
            out.append(min(_index(bits), d.size - 1))
        return tuple(out)

    def _on_mesh(self, p: Point) -> Point:
        """The nearest point of the mesh inside the bounds."""
        if self._grid is None:
            return p
        divider, exponent = self._grid
        size, x = 1.0 / math.pow(divider, exponent), []
        for i, c in enumerate(self.space.continuous):
            width = c.step * size
            v = self._round(c.initial + round((p.x[i] - c.initial) / width) * width, i)
            if v < c.lower:
                v = self._round(v + width, i)
            elif v > c.upper:
                v = self._round(v - width, i)
            x.append(v)
        return replace(p, x=tuple(x))


class SwarmThenPattern(ParticleSwarm):
    """A swarm on a mesh, then a Hooke-Jeeves search from its best point with discrete values fixed.

    Parameters
    ----------
    space : Space
        Parameters with bounds, at least one continuous.
    rules : SwarmRules
        The swarm.
    mesh : tuple of int
        Divider and exponent of the mesh [-].
    increment, reductions
        The pattern search; see `PatternSearch`.
    restarts : tuple of int, optional
        Number of starts of the pattern search and seed; the first start is the swarm's best [-].
    sufficient, max_evaluations, text
        The pattern search; see `PatternSearch`.
    penalty, fresh_step, rounding, observer, remember
        See `ParticleSwarm`.

    References
    ----------
    Wetter and Wright (2004), hybrid of swarm and pattern search, doi:10.1016/j.buildenv.2004.01.022.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.5, 0.5], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> search = SwarmThenPattern(space, SwarmRules(generations=5))
    >>> minimize(search, lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points]).cost < 1e-3
    True
    """

    def __init__(
        self,
        space: Space,
        rules: SwarmRules | None = None,
        *,
        mesh: tuple[int, int] = (2, 0),
        increment: int = 1,
        reductions: int = 4,
        restarts: tuple[int, int] | None = None,
        sufficient: SufficientDecrease | None = None,
        max_evaluations: int | None = None,
        text: Callable[[float], str] = repr,
        penalty: bool = False,
        fresh_step: int = 1,
        rounding: Callable[[float, int], float] | None = None,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(
            space,
            rules,
            mesh=mesh,
            penalty=penalty,
            fresh_step=fresh_step,
            rounding=rounding,
            observer=observer,
            remember=remember,
        )
        if not space.continuous:
            msg = "a swarm followed by a pattern search needs at least one continuous parameter"
            raise InputError(msg)
        self._mesh_rule = mesh
        self._increment, self._reductions = increment, reductions
        self._restarts = restarts
        self._sufficient = sufficient
        self._limit = max_evaluations
        self._running: HookeJeeves | None = None
        self._text = text

    @property
    def expected(self) -> int | None:
        """Unknown: the pattern search ends when it is refined enough."""
        return None

    @property
    def remaining(self) -> int | None:
        """Estimate: what is left of the swarm, and the pattern search's own estimate."""
        if self._running is not None:
            return self._running.remaining
        swarm = self.rules.size * self.rules.generations - self._count
        return max(swarm, 0) + (self._reductions + 1) * 2 * len(self.space.continuous)

    def _search(self) -> Steps:
        """The swarm, then the pattern search."""
        best = yield from self._generations()
        self.observer.minimum("Minimum point.")
        self.observer.sub(best, "Minimum point of initialization.")
        self.observer.main(best, "Minimum point of initialization.")
        self.phase = 1
        search = self._pattern(best.point)
        self._running = search
        while points := search.ask():
            self.step_number = search.step_number
            search.tell((yield points))
        self.observer.minimum("Minimum point.")
        return search.reason

    def _pattern(self, start: Point) -> HookeJeeves:
        """The pattern search from the best point of the swarm."""
        divider, exponent = self._mesh_rule
        first = replace(start, step=1)
        starts = [first]
        if self._restarts is not None:
            count, seed = self._restarts
            starts = uniform_starts(
                self.space,
                count,
                seed,
                divider=divider,
                exponent=exponent,
                rounding=self._round,
                first=first,
            )
        return HookeJeeves(
            self.space,
            divider=divider,
            exponent=exponent,
            increment=self._increment,
            reductions=self._reductions,
            starts=starts,
            max_evaluations=self._limit,
            sufficient=self._sufficient,
            penalty=self._penalty,
            rounding=self._round,
            text=self._text,
            observer=self.observer,
            remember=False,
            counted=self._count,
            report_minimum=False,
        )


def _gray(index: int, width: int) -> list[int]:
    """Bits of the Gray code, the highest first."""
    code = index ^ (index >> 1)
    return [(code >> (width - 1 - b)) & 1 for b in range(width)]


def _index(bits: Sequence[int]) -> int:
    """Index of a Gray code."""
    value = running = 0
    for b in bits:
        running ^= b
        value = 2 * value + running
    return value
