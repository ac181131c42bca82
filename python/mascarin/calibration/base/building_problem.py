"""Calibration problems of buildings: parameters by path, and the model that simulates the sensors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin._io.arguments import bounds_of
from mascarin.calibration.base.problem import CalibrationProblem, FitParameter, FitSensor
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.measurements.observation import Observation
    from mascarin.measurements.uncertainty import SensorUncertainty
    from mascarin.simulation.simulation import Simulation

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]


#: Calls whose series are kept: a point, and those about it.
_LATEST: Final = 2


def fit_parameter(
    building: Building,
    path: str,
    bounds: tuple[float | None, float | None] = (None, None),
    prior: float | None = None,
    *,
    start: float | None = None,
    scale: Literal["linear", "log"] = "linear",
) -> FitParameter:
    """Describe a parameter of a building as one to estimate.

    Parameters
    ----------
    building : Building
        Has the value, unit, limits and range of the parameter.
    path : str
        Path of the parameter.
    bounds : pair of float or None
        Lowest and highest value; those of the range of the parameter where None. [unit]
    prior : float, optional
        Standard deviation of a normal prior about the value in the building. [unit]
    start : float, optional
        Where the search begins; the value in the building when absent. [unit]
    scale : str
        ``linear`` or ``log``: how distances are measured in the search.

    Returns
    -------
    FitParameter

    Raises
    ------
    InputError
        Unknown or structural path, or bounds outside of the possible values.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import FOLDER
    >>> cell = mc.load(FOLDER / "lgi" / "building.yaml")
    >>> fit_parameter(cell, "surfaces.roof.outside.absorptance", (0.2, 0.9)).upper
    0.9
    """
    parameter = building.parameter(path)
    if parameter.structural:
        raise InputError(
            f"{path}: is structural ({parameter.reason}) and cannot be estimated; choose another parameter"
        )
    entered_bounds: Any = bounds  # of any type, where no type checker has looked
    pair = (
        list(entered_bounds)
        if isinstance(entered_bounds, Iterable) and not isinstance(entered_bounds, str)
        else [entered_bounds]
    )
    own_range = (parameter.low, parameter.high)
    if len(pair) == len(own_range):
        pair = [value if end is None else end for end, value in zip(pair, own_range, strict=True)]
    low, high = bounds_of(path, pair)
    return FitParameter(
        path=parameter.path,
        lower=parameter.inside(low),
        upper=high,
        nominal=parameter.value,
        unit=parameter.unit,
        limits=(parameter.lower if parameter.above is None else parameter.above, parameter.upper),
        prior=None if prior is None else (parameter.value, prior),
        start=start,
        scale=scale,
    )


@dataclass(frozen=True, eq=False)
class BuildingModel:
    """Simulated series of the sensors of a building, as a function of some parameters.

    Attributes
    ----------
    simulation : Simulation
        Its outputs are those of the sensors of the observation, in their order.
    observation : Observation
        Instants of the comparison.
    paths : tuple of str
        Parameters that vary.
    rows : ndarray of int, shape (T,)
        Instants to compare.
    columns : tuple of int, length S
        Sensors to compare.
    """

    simulation: Simulation
    observation: Observation
    paths: tuple[str, ...]
    rows: npt.NDArray[np.int64]
    columns: tuple[int, ...]
    #: Series of the last calls: the first linearization with errors is that of the intervals without them.
    _latest: dict[bytes, Array] = field(default_factory=dict, init=False, repr=False)

    def __call__(self, x: Array) -> Array:
        """Simulate parameter vectors (M, P), shape (M, T, S); the same ones once more are not run.

        The array is read-only. [unit of each sensor]
        """
        key = np.ascontiguousarray(x).tobytes()
        if key not in self._latest:
            vectors = self.simulation.varied(self.paths, x)
            records, _, _ = self.simulation.ensemble(vectors)
            series = self._compared(records)
            series.flags.writeable = False
            while len(self._latest) >= _LATEST:
                self._latest.pop(next(iter(self._latest)))
            self._latest[key] = series
        return self._latest[key]

    def slopes(self, x: Array) -> Array:
        """Differentiate the series at a parameter vector (P,), shape (T, S, P). [unit of each]"""
        vector = self.simulation.varied(self.paths, x[None, :])[0]
        following = self.simulation.followers(self.paths)
        _, derivatives = self.simulation.jacobian_vector([*self.paths, *following.values()], vector)
        by_parameter = derivatives[: len(self.paths)]
        for path, further in zip(following, derivatives[len(self.paths) :], strict=True):
            by_parameter[self._owner(path)] += further
        # Instants and means are linear in the records, and so are their derivatives.
        return np.moveaxis(self._compared(by_parameter), 0, -1)

    def _owner(self, path: str) -> int:
        """Position of the parameter that a number belongs to: its own, or one that ties it."""
        parameters = [
            self.simulation.building.parameter(path_of_parameter) for path_of_parameter in self.paths
        ]
        return next(
            k for k, parameter in enumerate(parameters) if path in (parameter.path, *parameter.members)
        )

    @cached_property
    def _observation_compared(self) -> Observation:
        """The observation at the instants and of the sensors to compare."""
        observation, columns = self.observation, list(self.columns)
        return replace(
            observation,
            times=observation.times[self.rows],
            measured=observation.measured[self.rows][:, columns],
            kinds=tuple(observation.kinds[s] for s in columns),
            names=tuple(observation.names[s] for s in columns),
        )

    def _compared(self, records: Array) -> Array:
        return self._observation_compared.simulated(self.simulation.index, records[..., list(self.columns)])


def problem_of(
    simulation: Simulation,
    observation: Observation,
    use: Flags,
    parameters: Sequence[FitParameter],
    uncertainties: Mapping[str, SensorUncertainty],
    weight: float = 1.0,
    *,
    only: Flags | None = None,
) -> CalibrationProblem:
    """Make a calibration problem from a simulation and its measured series.

    Parameters
    ----------
    simulation : Simulation
        Its outputs are those of the sensors of the observation, in their order.
    observation : Observation
        Measured series.
    use : ndarray of bool, shape (n,)
        Instants to compare.
    parameters : sequence of FitParameter
        Parameters to estimate.
    uncertainties : mapping of str to SensorUncertainty
        Standard uncertainty of the sensors to compare, by name.
    weight : float
        How many times each sample counts. [-]
    only : ndarray of bool, shape (n, S), optional
        Values of each sensor to compare, of those at these instants; all when absent.

    Returns
    -------
    CalibrationProblem

    Raises
    ------
    InputError
        A parameter or a sensor that cannot be used.
    """
    columns = tuple(s for s, name in enumerate(observation.names) if name in uncertainties)
    rows = np.flatnonzero(use)
    paths = tuple(parameter.path for parameter in parameters)
    for path in paths:
        simulation.value_in(simulation.values, path)  # refuses structural parameters
    model = BuildingModel(simulation, observation, paths, rows, columns)
    sensors = tuple(
        FitSensor(
            observation.names[s],
            observation.measured[rows, s],
            standard_uncertainty=uncertainties[observation.names[s]].absolute,
            relative_standard_uncertainty=uncertainties[observation.names[s]].relative,
            unit=simulation.outputs[s].unit,
            use=None if only is None else only[rows, s],
            weight=weight,
        )
        for s in columns
    )
    return CalibrationProblem(
        tuple(parameters),
        sensors,
        model,
        identity=simulation.identity,
        step=observation.interval,
        slopes=model.slopes,
    )
