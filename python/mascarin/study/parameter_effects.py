"""Effects of all parameters on the sensors, linearized at the fitted model."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study.kept import kept_series

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.setup import Setup
    from mascarin.validation.observation import Observation

    Array = npt.NDArray[np.float64]

#: Step of the differences, as a part of the range.
STEP: Final = 0.05
_CHUNK: Final = 32


class Effects:
    """Differences of runs in which one parameter is changed, extrapolated to its whole range.

    Parameters
    ----------
    study : Setup
        Has the folder where runs are kept.
    simulation : Simulation
        The model.
    results : Results
        The unchanged run of the same simulation.
    values : ndarray, shape (P,)
        Its parameter vector. [unit of each]
    """

    def __init__(self, study: Setup, simulation: Simulation, results: Results, values: Array) -> None:
        self._study = study
        self._simulation, self._results, self._values = simulation, results, values
        self._factors = factors_of(simulation.building)
        self.room: dict[str, tuple[float, float]] = {}

    @property
    def count(self) -> int:
        """Number of parameters."""
        return len(self._factors)

    def found(
        self,
        observation: Observation,
        use: npt.NDArray[np.bool_],
        progress: Callable[[int, int], object],
    ) -> dict[str, Array]:
        """Change of the simulated series for a change of the parameter by its range.

        Parameters
        ----------
        observation : Observation
            Gives the instants.
        use : ndarray of bool, shape (n,)
            Instants to keep.
        progress : callable
            Called with the number of runs done and their total.

        Returns
        -------
        dict of str to ndarray, shape (instants, S)
            By path; parameters whose run failed are left out. `room` contains for each the largest change
            down and up, in ranges. [unit of each sensor]
        """
        sensors, index = len(observation.names), self._results.index
        base, done = observation.simulated(index, self._results.records[..., :sensors])[use], 0
        effects: dict[str, Array] = {}
        for paths, steps, samples in self._chunks():
            series = kept_series(self._study, self._simulation, samples)[:, use]
            for path, step, moved in zip(paths, steps, series, strict=True):
                effect = (moved - base) / step
                if np.isfinite(effect).all() and np.abs(effect).max() > 0.0:
                    effects[path] = effect
            done += len(paths)
            progress(done, len(self._factors))
        return effects

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
