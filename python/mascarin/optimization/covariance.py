"""Evolution strategy with an adapted covariance matrix (CMA-ES), by the package cma.

References
----------
Hansen and Ostermeier (2001), CMA-ES, doi:10.1162/106365601750190398.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from mascarin.errors import InputError
from mascarin.optimization.base import Observer, Optimizer, Steps
from mascarin.optimization.space import Point, Space

_MINIMUM = "Minimum point."


class CovarianceSearch(Optimizer):
    """Evolution strategy with an adapted covariance matrix; needs the package ``cma``.

    Parameters
    ----------
    space : Space
        Continuous parameters; bounds may be missing.
    sigma : float
        First standard deviation, as a part of the range, or in steps where there is no range [-].
    population : int, optional
        Number of points in a generation; chosen by dimension when absent [-].
    max_evaluations : int
        Number of evaluations after which the search stops [-].
    seed : int
        Seed of the random numbers [-].
    finest : float, optional
        Ends the search when its standard deviations are smaller, in ranges or steps; 1e-11 of the first
        when absent [-].
    observer, remember
        See `Optimizer`.

    References
    ----------
    Hansen and Ostermeier (2001), doi:10.1162/106365601750190398.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.5, 0.5], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> search = CovarianceSearch(space, max_evaluations=400)
    >>> best = minimize(search, lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost < 1e-6
    True
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
            msg = "CMA-ES needs at least two parameters; for one, use GoldenSection"
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
        """Generations until the strategy stops or the limit is reached."""
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
            # Only the order of costs matters; an infinite cost becomes the highest of all.
            strategy.tell(
                steps, [e.cost if math.isfinite(e.cost) else worst + abs(worst) + 1 for e in people]
            )
        self.observer.minimum(_MINIMUM)
        return ", ".join(strategy.stop()) or "maximum number of evaluations is reached"

    def _strategy(self) -> Any:
        """The strategy of the package cma, in units of the ranges around the initial point."""
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
        """Parameter values; rounding may not move them outside the bounds."""
        x = [
            min(max(c.initial + float(v) * w, c.lower), c.upper)
            for c, v, w in zip(self.space.continuous, u, self._unit, strict=True)
        ]
        return Point(tuple(x), (), self.step_number)
