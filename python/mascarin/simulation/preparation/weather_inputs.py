"""Gain, offset and clock of the weather as parameters of a run: the forcing for a parameter vector.

The engine knows nothing of them: it gets the forcing that follows from their values. Derivatives by them are
differences of two runs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.steps import Steps
from mascarin.weather import UNITS
from mascarin.weather.checks.sun_check import sun_warnings
from mascarin.weather.instruments.column_errors import ColumnError, CorrectedForcing
from mascarin.weather.records.channels import LIMITS

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building, EngineDescription
    from mascarin.building.parts.site import Site
    from mascarin.simulation.preparation.options import Scheme
    from mascarin.simulation.records.times import Times
    from mascarin.tables.arrays import Halvings
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]

#: Half of the difference over which a derivative by a gain [-] or a clock [s] is taken.
_GAIN: Final = 1e-3
_CLOCK: Final = 30.0
#: The same for an offset, as a part of the largest value of the column. [-]
_OFFSET: Final = 1e-3
#: Limits of a measured column that is no channel of the weather. [unit of the column]
_LIMITS: Final = (-1e4, 1e4)
_KEYS: Final = ("gain", "offset", "clock")
PREFIX: Final = "weather."
"""How paths of these parameters begin."""


def is_of_weather(path: str) -> bool:
    """Whether a parameter acts by the forcing alone, such as ``weather.columns.wind_speed.gain``."""
    return path.startswith(PREFIX)


@dataclass(frozen=True, eq=False)
class WeatherInputs:
    """Parameters of a compiled run that act by its forcing.

    Attributes
    ----------
    corrected : CorrectedForcing
        The forcing as a function of them.
    names : tuple of str, length K
        Columns.
    positions : ndarray of int, shape (3 K + 1,)
        Positions in the parameter vector: gain, offset and clock of each column, then the common clock.
    base : ndarray, shape (3 K + 1,)
        Values for which the forcing of the run was made. [unit of each]
    steps : ndarray, shape (3 K + 1,)
        Half of the difference over which each is derived. [unit of each]
    """

    corrected: CorrectedForcing
    names: tuple[str, ...]
    positions: npt.NDArray[np.int64]
    base: Array
    steps: Array

    def forcing(self, vector: Array, forcing: Array) -> Array:
        """The forcing for a parameter vector.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        forcing : ndarray, shape (steps, stages, channels)
            That of the run, or the beginning of it.

        Raises
        ------
        InputError
            Irradiances of one table have different clocks.
        """
        values = vector[self.positions]
        if np.array_equal(values, self.base):
            return forcing
        before, after = (self.errors(row) for row in (self.base, values))
        return np.asarray(self.corrected.at(forcing, before[0], after[0], (before[1], after[1])))

    def groups(self, vectors: Array) -> Iterator[tuple[npt.NDArray[np.int64], Array]]:
        """Members with the same weather: their rows, and the first of their vectors."""
        _, first, owner = np.unique(
            vectors[:, self.positions], axis=0, return_index=True, return_inverse=True
        )
        for group, row in enumerate(first):
            yield np.flatnonzero(owner.ravel() == group), vectors[row]

    def moves(self, direction: list[tuple[int, float]]) -> bool:
        """Whether a derivative is one by the weather."""
        of_weather = set(self.positions.tolist())
        return any(position in of_weather for position, _ in direction)

    def difference(self, direction: list[tuple[int, float]]) -> float:
        """Half of the difference over which a direction is derived. [unit of its parameter]"""
        step: dict[int, float] = dict(zip(self.positions.tolist(), self.steps.tolist(), strict=True))
        return min(step[p] / max(abs(weight), 1e-12) for p, weight in direction if p in step)

    def errors(self, values: Array) -> tuple[dict[str, ColumnError], float]:
        """Errors by column, and the common clock, from the values of the parameters. [unit of each]"""
        rows = values[:-1].reshape(len(self.names), len(_KEYS)).tolist()
        errors = {name: ColumnError(*row) for name, row in zip(self.names, rows, strict=True)}
        return errors, float(values[-1])


def with_weather_inputs(
    building: Building,
    climate: Climate,
    description: EngineDescription,
    forcing: Array,
    *,
    times: Times,
    scheme: Scheme,
    measurements: Measurements | None,
    halvings: Halvings | None = None,
) -> tuple[Array, WeatherInputs | None]:
    """The forcing with the errors that a building states for its weather, and how it depends on them.

    Parameters
    ----------
    building : Building
        States errors under ``weather``.
    climate : Climate
        The weather.
    description : EngineDescription
        Its parameters and channels.
    forcing : ndarray, shape (steps, stages, channels)
        Without errors. [unit of each channel]
    times, scheme, measurements, halvings
        As of the run.

    Raises
    ------
    InputError
        A column that is not there, a value outside of its limits, or radiation that does not follow the sun.
    """
    if building.weather is None:
        return forcing, None
    names = tuple(building.weather.columns)
    columns = description.channels[: len(description.channels) - len(description.schedules)]
    corrected = corrected_forcing(
        building, climate, columns, names,
        times=times, scheme=scheme, measurements=measurements, halvings=halvings,
    )  # fmt: skip
    paths = [*(f"{PREFIX}columns.{name}.{key}" for name in names for key in _KEYS), f"{PREFIX}clock"]
    positions = np.array([description.paths.index(path) for path in paths], dtype=np.int64)
    steps = np.array([*(step for name in names for step in _steps_of(corrected, name)), _CLOCK])
    right = np.array([*(1.0, 0.0, 0.0) * len(names), 0.0])
    plain = WeatherInputs(corrected, names, positions, right, steps)
    with_errors = plain.forcing(description.values, forcing)
    inputs = replace(plain, base=description.values[positions])
    _require_possible(inputs)
    warnings_of_sun(climate, inputs, building.site)
    return with_errors, inputs


def warnings_of_sun(climate: Climate, inputs: WeatherInputs | None, site: Site) -> tuple[str, ...]:
    """Warnings about the radiation, as corrected, beside the sun of the place.

    Parameters
    ----------
    climate : Climate
        As read.
    inputs : WeatherInputs or None
        What corrects it.
    site : Site
        The place.

    Raises
    ------
    InputError
        The radiation does not follow the sun.
    """
    record = climate.record
    if inputs is not None:
        record = inputs.corrected.sunlit(*inputs.errors(inputs.base))
    return sun_warnings(record, float(site.latitude), float(site.longitude))


def corrected_forcing(
    building: Building,
    climate: Climate,
    columns: Sequence[str],
    names: Sequence[str],
    *,
    times: Times,
    scheme: Scheme,
    measurements: Measurements | None,
    halvings: Halvings | None = None,
) -> CorrectedForcing:
    """The forcing of a run as a function of errors of the weather.

    Parameters
    ----------
    building : Building
        At its site.
    climate : Climate
        The weather.
    columns : sequence of str
        Measured columns of the forcing.
    names : sequence of str
        Columns that have errors.
    times, scheme, measurements, halvings
        As of the run.

    Raises
    ------
    InputError
        A column that is not in the weather, or was not measured.
    """
    return CorrectedForcing(
        climate.record,
        None if measurements is None else measurements.record,
        building.site,
        Steps.over(climate.grid.zone, times.start, times.end, times.step, scheme, halvings),
        columns,
        names,
    )


def _steps_of(corrected: CorrectedForcing, name: str) -> tuple[float, float, float]:
    return _GAIN, _OFFSET * max(corrected.largest(name), 1e-3), _CLOCK


def _require_possible(inputs: WeatherInputs) -> None:
    """Refuse corrected values that no weather has; what was read was checked before."""
    for name, values in inputs.corrected.readings(*inputs.errors(inputs.base)).items():
        low, high = LIMITS.get(name, _LIMITS)
        least, most = float(np.nanmin(values)), float(np.nanmax(values))
        if least < low or most > high:
            raise InputError(
                f"weather.columns.{name}: found corrected values from {least:g} to {most:g}, expected "
                f"{low:g} to {high:g} {UNITS.get(name, '')}: check gain and offset, or remove them".rstrip()
            )
