"""Population searches: differential evolution and the evolution of a covariance matrix.

References
----------
Storn and Price (1997), Differential evolution, doi:10.1023/A:1008202821328.
Hansen and Ostermeier (2001), CMA-ES, doi:10.1162/106365601750190398.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from mascarin.errors import InputError
from mascarin.optimization.base import Observer, Optimiser, Steps
from mascarin.optimization.random import Lcg48
from mascarin.optimization.space import Evaluation, Point, Space

_MINIMUM = "Minimum point."


class DifferentialEvolution(Optimiser):
    """Population of points that are moved along the differences of others.

    Discrete parameters are moved by the index of their value and rounded.

    Parameters
    ----------
    space : Space
        Parameters with bounds.
    population : int
        Number of points [-].
    generations : int
        Number of generations [-].
    seed : int
        Seed of the random numbers [-].
    weight : float
        Factor of the differences [-].
    crossover : float
        Share of the coordinates that move [-].
    tolerance : float
        Ends the search when the costs of the population differ by less, relative to their mean [-].
    observer, remember
        See `Optimiser`.

    References
    ----------
    Storn and Price (1997), doi:10.1023/A:1008202821328.
    """

    def __init__(
        self,
        space: Space,
        *,
        population: int = 20,
        generations: int = 50,
        seed: int = 1,
        weight: float = 0.7,
        crossover: float = 0.9,
        tolerance: float = 1e-6,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_bounds()
        space.require_start()
        if population < 4 or generations < 1:
            msg = f"a population of {population} in {generations} generations: expected at least 4 and 1"
            raise InputError(msg)
        self._size, self._generations = population, generations
        self._weight, self._crossover, self._tolerance = weight, crossover, tolerance
        self._random = Lcg48(seed)
        self._limits = [(c.lower, c.upper) for c in space.continuous] + [
            # Every value has an interval of the same length.
            (-0.5, d.size - 0.5)
            for d in space.discrete
        ]

    @property
    def expected(self) -> int | None:
        """Upper limit of the number of evaluations [-]."""
        return self._size * self._generations

    def _search(self) -> Steps:
        """All generations."""
        vectors = [self._vector(self.space.initial)] + [
            [low + self._random.uniform() * (high - low) for low, high in self._limits]
            for _ in range(self._size - 1)
        ]
        people = yield [self._point(v) for v in vectors]
        self._report(people, 1)
        reason = "all generations are done"
        for generation in range(2, self._generations + 1):
            if self._settled(people):
                reason = "the costs of the population agree"
                break
            trials = [self._child(i, vectors) for i in range(self._size)]
            found = yield [self._point(v) for v in trials]
            self._report(found, generation)
            for i, e in enumerate(found):
                if e.cost <= people[i].cost:
                    people[i], vectors[i] = e, trials[i]
        self.observer.minimum(_MINIMUM)
        return reason

    def _child(self, i: int, vectors: Sequence[Sequence[float]]) -> list[float]:
        """A trial from three other members."""
        a, b, c = self._others(i)
        forced = self._random.below(len(self._limits))
        out = []
        for k, (low, high) in enumerate(self._limits):
            moved = self._random.uniform() < self._crossover or k == forced
            v = vectors[a][k] + self._weight * (vectors[b][k] - vectors[c][k]) if moved else vectors[i][k]
            # Mirrored at the bounds, so that they do not collect points.
            while not low <= v <= high:
                v = 2.0 * (low if v < low else high) - v if high > low else low
            out.append(v)
        return out

    def _others(self, i: int) -> list[int]:
        """Three different members other than `i`."""
        chosen: list[int] = []
        while len(chosen) < 3:
            k = self._random.below(self._size)
            if k != i and k not in chosen:
                chosen.append(k)
        return chosen

    def _settled(self, people: Sequence[Evaluation]) -> bool:
        """Whether all costs are nearly equal."""
        costs = [e.cost for e in people]
        if not all(map(math.isfinite, costs)):
            return False
        mean = sum(costs) / len(costs)
        return max(costs) - min(costs) <= self._tolerance * max(abs(mean), 1e-300)

    def _vector(self, p: Point) -> list[float]:
        return [*p.x, *map(float, p.choices)]

    def _point(self, v: Sequence[float]) -> Point:
        """A point with discrete coordinates rounded."""
        n = len(self.space.continuous)
        choices = tuple(
            min(max(round(k), 0), d.size - 1) for k, d in zip(v[n:], self.space.discrete, strict=True)
        )
        return Point(tuple(v[:n]), choices, self.step_number)

    def _report(self, people: Sequence[Evaluation], generation: int) -> None:
        for e in people:
            self.observer.sub(e, f"Generation {generation}.")
            self.observer.main(e, f"Generation {generation}.")


class CovarianceSearch(Optimiser):
    """Evolution strategy with an adapted covariance matrix; needs the package ``cma``.

    Parameters
    ----------
    space : Space
        Continuous parameters; bounds may be missing.
    sigma : float
        First standard deviation, as a share of the range or in steps where there is no range [-].
    population : int, optional
        Number of points in a generation; chosen by dimension when absent [-].
    max_evaluations : int
        Number of evaluations after which the search stops [-].
    seed : int
        Seed of the random numbers [-].
    finest : float, optional
        Ends the search when its standard deviations are smaller, in ranges or steps; a hundred-billionth of
        the first when absent [-].
    observer, remember
        See `Optimiser`.

    References
    ----------
    Hansen and Ostermeier (2001), doi:10.1162/106365601750190398.
    """

    def __init__(
        self,
        space: Space,
        *,
        sigma: float = 0.25,
        population: int | None = None,
        max_evaluations: int = 1000,
        seed: int = 1,
        finest: float | None = None,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_continuous(type(self).__name__)
        space.require_start()
        if len(space.continuous) < 2:
            msg = "the evolution of a covariance needs at least two parameters"
            raise InputError(msg)
        self._sigma, self._population = sigma, population
        self._limit, self._seed, self._finest = max_evaluations, seed, finest
        # One unit is the range of a bounded parameter, else its step.
        self._unit = [c.upper - c.lower if c.bounded else c.step for c in space.continuous]

    @property
    def expected(self) -> int | None:
        """Upper limit of the number of evaluations [-]."""
        return self._limit

    def _search(self) -> Steps:
        """Generations until the strategy is satisfied or the limit is reached."""
        strategy = self._strategy()
        generation = 0
        while not strategy.stop() and self._count < self._limit:
            generation += 1
            steps = strategy.ask()
            people = yield [self._point(u) for u in steps]
            for e in people:
                self.observer.sub(e, f"Generation {generation}.")
                self.observer.main(e, f"Generation {generation}.")
            worst = max((e.cost for e in people if math.isfinite(e.cost)), default=0.0)
            # The strategy only ranks; an infinite cost becomes one that is surely the worst.
            strategy.tell(
                steps, [e.cost if math.isfinite(e.cost) else worst + abs(worst) + 1 for e in people]
            )
        self.observer.minimum(_MINIMUM)
        return ", ".join(strategy.stop()) or "maximum number of evaluations is reached"

    def _strategy(self) -> Any:
        """The strategy of the package, in units of the ranges around the initial point."""
        try:
            import cma
        except ImportError as error:
            msg = "this search needs the package cma: pip install 'mascarin[cma]'"
            raise InputError(msg) from error
        import numpy as np

        random = np.random.default_rng(self._seed)
        cs = self.space.continuous
        low = [(c.lower - c.initial) / u for c, u in zip(cs, self._unit, strict=True)]
        high = [(c.upper - c.initial) / u for c, u in zip(cs, self._unit, strict=True)]
        options: dict[str, Any] = {
            "bounds": [low, high],
            "verbose": -9,
            "seed": math.nan,
            "randn": lambda *shape: random.standard_normal(shape),
        }
        if self._finest is not None:
            options["tolx"] = self._finest
        if self._population is not None:
            options["popsize"] = self._population
        return cma.CMAEvolutionStrategy([0.0] * len(cs), self._sigma, options)

    def _point(self, u: Sequence[float]) -> Point:
        """Parameter values, kept within the bounds against rounding."""
        x = [
            min(max(c.initial + float(v) * w, c.lower), c.upper)
            for c, v, w in zip(self.space.continuous, u, self._unit, strict=True)
        ]
        return Point(tuple(x), (), self.step_number)
