"""Effects of all parameters on the sensors, linearized at a parameter vector."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study.context.step_cache import kept_series

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext

    Array = npt.NDArray[np.float64]

#: Step of the differences, as a part of the range.
STEP: Final = 0.05
_CHUNK: Final = 32


class Effects:
    """Differences of runs in which one parameter is changed, extrapolated to its whole range.

    Runs side by side: for hundreds of parameters quicker than exact derivatives. Where errors of sensors and
    model are estimated, the bands have made these runs with the step of the study. Otherwise they take that
    of the sensitivity analysis; the error of a long step is nearly the same in both runs of a difference.

    Parameters
    ----------
    study : StudyContext
        Has the folder where runs are kept.
    simulation : Simulation
        The model.
    base : ndarray, shape (n, S)
        Its series at the instants of the comparison, without a change. [unit of each sensor]
    values : ndarray, shape (P,)
        Its parameter vector. [unit of each]
    """

    def __init__(self, study: StudyContext, simulation: Simulation, base: Array, values: Array) -> None:
        self._study, self._simulation = study, simulation
        if not study.estimates_errors:
            self._simulation = study.models.with_coarse_step(simulation)
        self._base, self._values = base, values
        if self._simulation is not simulation:
            self._base = kept_series(study, self._simulation, values[None])[0]
        self._factors = factors_of(simulation.building)
        self.room: dict[str, tuple[float, float]] = {}

    @property
    def count(self) -> int:
        """Number of parameters."""
        return len(self._factors)

    def each(self, progress: Callable[[int, int], object]) -> Iterator[tuple[str, Array]]:
        """Change of the simulated series for a change of each parameter by its range.

        Parameters
        ----------
        progress : callable
            Called with the number of runs done and their total.

        Yields
        ------
        str
            Path. Parameters whose run failed or that have no effect are left out. `room` contains for each
            the largest change down and up, in ranges.
        ndarray, shape (n, S)
            Change. [unit of each sensor]
        """
        done = 0
        for paths, steps, samples in self._chunks():
            series = kept_series(self._study, self._simulation, samples)
            for path, step, moved in zip(paths, steps, series, strict=True):
                effect = (moved - self._base) / step
                # Long steps may end before the last instants: no effect is known there.
                effect[~np.isfinite(self._base)] = 0.0
                if np.isfinite(effect).all() and np.abs(effect).max() > 0.0:
                    yield path, effect
            done += len(paths)
            progress(done, len(self._factors))

    def _chunks(self) -> Iterator[tuple[list[str], list[float], Array]]:
        """Paths, signed steps [ranges] and parameter vectors, in chunks."""
        for first in range(0, len(self._factors), _CHUNK):
            chosen = self._factors[first : first + _CHUNK]
            samples, steps = [], []
            for factor in chosen:
                span = factor.high - factor.low
                value = self._simulation.value_in(self._values, factor.path)
                step = STEP if value + STEP * span <= factor.high else -STEP
                moved = np.array([[value + step * span]])
                samples.append(self._simulation.varied([factor.path], moved, self._values)[0])
                steps.append(step)
                self.room[factor.path] = (
                    min(0.0, (factor.low - value) / span), max(0.0, (factor.high - value) / span),
                )  # fmt: skip
            yield [factor.path for factor in chosen], steps, np.array(samples)
