"""Runs of a compiled building by parameter vectors, for the package's own use: checked arrays in and out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError
from mascarin.simulation.checks.formula_laws import require_laws
from mascarin.simulation.preparation.engine_run import MEMORY, CompiledRun
from mascarin.simulation.preparation.limits import (
    ParameterLimits,
    require_control_times,
    require_set_points_apart,
)

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.progress import Report
    from mascarin.simulation.preparation.options import Precision
    from mascarin.simulation.preparation.run_results import EnsembleRun, Trajectory
    from mascarin.simulation.records.times import Times

    Array = npt.NDArray[np.float64]


class VectorRuns:
    """Runs by parameter vectors; `Simulation` adds compilation, and runs by values with their paths.

    Attributes
    ----------
    building : Building
        The building.
    compiled : CompiledRun
        What the engine gets.
    channels : tuple of str
        Channels of the forcing after those of the climate.
    times : Times
        Times of the records: the start, then the end of every step.
    step_seconds : float
        Time step. [s]
    """

    building: Building
    compiled: CompiledRun
    channels: tuple[str, ...]
    times: Times
    step_seconds: float

    @property
    def index(self) -> pd.DatetimeIndex:
        """Times of the records in local time, shape (rows,): the start, then the end of every step."""
        return self.times.index

    @property
    def start(self) -> pd.Timestamp:
        """Start of the period, in local time of the climate."""
        return self.index[0]

    @property
    def end(self) -> pd.Timestamp:
        """End of the period, in local time of the climate."""
        return self.index[-1]

    @property
    def paths(self) -> list[str]:
        """Path of each parameter, in the order of a parameter vector."""
        return list(self.compiled.paths)

    @property
    def values(self) -> Array:
        """Parameter vector of the building, shape (P,). [unit of each]"""
        return self.compiled.values  # noqa: PD011 (no pandas object)

    def vector(self, parameters: Mapping[str, float]) -> Array:
        """The parameter vector with some values replaced.

        Parameters
        ----------
        parameters : mapping of str to float
            Values by path. [unit of each]

        Returns
        -------
        ndarray, shape (P,)
            Values in the order of `paths`. [unit of each]

        Raises
        ------
        InputError
            Unknown path; the text names the nearest ones.
        """
        vector = self.values.copy()
        for path, value in parameters.items():
            self.assign(vector, path, value)
        return vector

    def assign(self, vectors: Array, path: str, values: Array | float) -> None:
        """Write values of one parameter into vectors, tied parameters into all that they stand for.

        Parameters
        ----------
        vectors : ndarray, shape (..., P)
            Changed in place. [unit of each]
        path : str
            The parameter.
        values : float or ndarray, shape (...)
            Its values. [unit]
        """
        for position, weight in self.spread_of(path):
            vectors[..., position] = values if weight is None else weight * values

    def value_in(self, vector: Array, path: str) -> float:
        """Value of one parameter in a vector, that of a tied one from the first that it stands for. [unit]

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        path : str
            The parameter.
        """
        position, weight = next(entry for entry in self.spread_of(path) if entry[1] != 0.0)
        value = float(vector[position])
        return value if weight is None else value / weight

    def spread_of(self, path: str) -> list[tuple[int, float | None]]:
        """Positions of what a path stands for; a factor has the value of the building that it multiplies.

        Parameters
        ----------
        path : str
            The parameter.

        Returns
        -------
        list of (int, float or None)
            Position in a parameter vector, and what a value is multiplied by there; None: by nothing.
        """
        parameter = self.building.parameter(path)
        if not parameter.members:
            return [(self.position(path), None)]
        positions = [self.position(member) for member in parameter.members]
        by_factor = self.building.ties[parameter.path] == "factor"
        return [(position, float(self.values[position]) if by_factor else None) for position in positions]

    def varied(self, paths: Sequence[str], values: Array, base: Array | None = None) -> Array:
        """Parameter vectors with some parameters varied.

        Equal set points of heating and cooling in one zone are one parameter here: where only one of the two
        is varied, the other one follows.

        Parameters
        ----------
        paths : sequence of str, length K
            Paths of the parameters that vary.
        values : ndarray, shape (M, K)
            Their values. [unit of each]
        base : ndarray, shape (P,), optional
            Vector of the others; default that of the building. [unit of each]

        Returns
        -------
        ndarray, shape (M, P)
            One parameter vector a row. [unit of each]

        Raises
        ------
        InputError
            Unknown or structural path.
        """
        vectors = np.tile(self.values if base is None else base, (len(values), 1))
        for k, path in enumerate(paths):
            self.assign(vectors, path, values[:, k])
        for path, other in self.followers(paths).items():
            vectors[:, self.position(other)] = vectors[:, self.position(path)]
        return vectors

    def followers(self, paths: Sequence[str]) -> dict[str, str]:
        """Parameters that follow varied ones: varied path -> path of the equal set point."""
        # The package imports pydantic, which an evaluation for GenOpt does without.
        from mascarin.building.parameters.set_point_pairs import tied_set_points

        tied = tied_set_points(self.building)
        named = [self.building.parameter(path) for path in paths] if tied else []
        full = [path for parameter in named for path in parameter.members or (parameter.path,)]
        return {path: tied[path] for path in full if path in tied and tied[path] not in full}

    def position(self, path: str) -> int:
        """Position of a path in a parameter vector.

        Raises
        ------
        InputError
            Unknown path, or a structural one, which needs another compiled building.
        """
        parameter = self.building.parameter(path)
        if parameter.members:
            raise InputError(
                f"{path}: found a tied parameter, which stands for {len(parameter.members)} numbers; "
                f"expected one number, such as {parameter.members[0]}"
            )
        if parameter.path not in self._positions:
            raise InputError(
                f"{path}: is structural ({parameter.reason}); give it in the building, for example with "
                "replace()"
            )
        return self._positions[parameter.path]

    def ensemble(
        self,
        vectors: Array,
        *,
        record_from: int = 0,
        record_every: int = 1,
        precision: Precision = "double",
        progress: Report | None = None,
    ) -> EnsembleRun:
        """Check the vectors and run them by `CompiledRun.ensemble`, which explains arguments and results.

        Raises
        ------
        InputError
            The vectors do not have a column for each parameter, or hold an impossible value.
        """
        members: Array = np.ascontiguousarray(vectors, dtype=np.float64)
        self._require_possible(members)
        return self.compiled.ensemble(
            members, record_from=record_from, record_every=record_every, precision=precision,
            progress=progress,
        )  # fmt: skip

    def jacobian_vector(
        self,
        vary: Sequence[str],
        vector: Array | None = None,
        *,
        record_from: int = 0,
        record_every: int = 1,
        progress: Report | None = None,
    ) -> tuple[Array, Array]:
        """Check the vector and derive by paths: `CompiledRun.jacobian`, which explains the other arguments.

        The result is the derivative of the discrete solution, the repeated first period included, not a
        difference quotient. At a switch (the end of a melting range, a wind that changes sides) it is the
        derivative of the branch that the run took.

        Parameters
        ----------
        vary : sequence of str
            Paths of the parameters to derive by.
        vector : ndarray, shape (P,), optional
            Parameter vector; default that of the building. [unit of each]

        Raises
        ------
        InputError
            A path that is unknown or structural, or no path.
        SolverError
            A step or the repeated first period did not converge.
        """
        if not vary:
            raise InputError(
                "derivatives: no parameters; give at least one path, as `mascarin parameters` lists"
            )
        # The numbers that a tied parameter stands for change together.
        directions = [
            [(position, 1.0 if weight is None else weight) for position, weight in self.spread_of(path)]
            for path in vary
        ]
        return self.compiled.jacobian(
            directions,
            self._checked(vector),
            record_from=record_from,
            record_every=record_every,
            progress=progress,
        )

    def trajectory(
        self,
        vector: Array | None = None,
        *,
        record_from: int = 0,
        record_every: int = 1,
        memory: int = MEMORY,
    ) -> Trajectory:
        """Check the vector, by default that of the building, and run it by `CompiledRun.trajectory`."""
        return self.compiled.trajectory(
            self._checked(vector), record_from=record_from, record_every=record_every, memory=memory
        )

    @cached_property
    def _positions(self) -> dict[str, int]:
        return {path: index for index, path in enumerate(self.compiled.paths)}

    def _checked(self, vector: Array | None) -> Array:
        checked: Array = np.array(self.values if vector is None else vector, dtype=np.float64)
        self._require_possible(checked[None, :])
        return checked

    def _require_possible(self, vectors: Array) -> None:
        """Refuse parameter vectors of the wrong length, or with a value that its parameter cannot have."""
        self._limits.require(vectors)
        require_set_points_apart(
            self.building, vectors, self.compiled.forcing_blocks, positions=self._positions,
            channels=self.channels, times=self.times, begin_of=self.compiled.begin_of,
        )  # fmt: skip
        require_laws(self.building, vectors, positions=self._positions)
        if self.building.controls:
            self._require_control_times(vectors)

    def _require_control_times(self, vectors: Array) -> None:
        """Refuse minimum times of controls that are longer than the run."""
        seconds = self.times.last - self.times.first
        require_control_times(self.building, vectors, positions=self._positions, seconds=seconds)

    @cached_property
    def _limits(self) -> ParameterLimits:
        return ParameterLimits([self.building.parameter(path) for path in self.compiled.paths])
