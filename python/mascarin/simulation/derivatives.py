"""Derivatives by parameters: of series, forward; of one quantity made of them, in reverse."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.simulation import MEMORY, Simulation

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from mascarin.building import Building
    from mascarin.simulation.initial import Initial
    from mascarin.weather import Climate, Measurements

Array = npt.NDArray[np.float64]

#: From the series of each output, shape (T,), a value and its derivative by each of them, shape (T,).
Objective = Callable[[Mapping[str, Array]], tuple[float, Mapping[str, Array]]]


@dataclass(frozen=True)
class Mean:
    """Mean of an output over the records.

    Attributes
    ----------
    output : str
        Name of the output.
    """

    output: str

    def __call__(self, series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
        """Value [unit of the output] and its derivative by each record [-]."""
        values = _series(series, self.output)
        return float(values.mean()), {self.output: np.full(len(values), 1.0 / len(values))}


@dataclass(frozen=True)
class SquaredResiduals:
    """Sum of squared residuals, each over its uncertainty; what is not measured (NaN) is left out.

    Attributes
    ----------
    measured : mapping of str to ndarray, shape (T,)
        Measured series by output. [unit of the output]
    uncertainty : mapping of str to float
        By output; 1 where it is not given. [unit of the output]
    """

    measured: Mapping[str, Array]
    uncertainty: Mapping[str, float] | None = None

    def __call__(self, series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
        """Value [-] and its derivative by each record [1/unit of the output]."""
        total, slopes = 0.0, {}
        for output, measured in self.measured.items():
            simulated = _series(series, output)
            if np.shape(measured) != simulated.shape:
                raise InputError(
                    f"objective: {output}: found {np.size(measured)} measured values, expected one for each "
                    f"record ({len(simulated)}); mark what is missing as NaN"
                )
            u = (self.uncertainty or {}).get(output, 1.0)
            residuals = np.nan_to_num((simulated - measured) / u)
            total += float(residuals @ residuals)
            slopes[output] = 2.0 * residuals / u
        return total, slopes


def _series(series: Mapping[str, Array], output: str) -> Array:
    try:
        return series[output]
    except KeyError:
        raise InputError(
            f"objective: there is no output {output!r}; expected one of those asked for: "
            f"{', '.join(series)}. {did_you_mean(output, list(series))}".rstrip()
        ) from None


@dataclass(frozen=True)
class Gradient:
    """A quantity and its derivatives by all parameters.

    Attributes
    ----------
    value : float
        The quantity.
    slopes : dict of str to float
        By parameter path. [unit of the quantity / unit of the parameter]
    units : dict of str to str
        Unit of each parameter.
    ranges : dict of str to tuple of float
        Range of each parameter.
    """

    value: float
    slopes: dict[str, float]
    units: dict[str, str]
    ranges: dict[str, tuple[float, float]]

    def table(self) -> pd.DataFrame:
        """Slopes, units and what each parameter does over its range, the most first."""
        import pandas as pd

        over = {path: slope * np.ptp(self.ranges[path]) for path, slope in self.slopes.items()}
        table = pd.DataFrame(
            {"slope": self.slopes, "parameter unit": self.units, "over its range": over}
        ).rename_axis("parameter")
        return table.sort_values("over its range", key=np.abs, ascending=False)


def gradient(
    building: Building,
    climate: Climate,
    objective: Objective,
    *,
    outputs: Sequence[str],
    values: Mapping[str, float] | None = None,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    scheme: Literal["sdirk2", "backward-euler"] = "sdirk2",
    initial: Initial = "repeat",
    measurements: Measurements | None = None,
    memory: int = MEMORY,
) -> Gradient:
    """One quantity and its derivatives by all parameters, in reverse mode.

    The run is gone back along once, whatever the number of parameters. What comes back is the exact
    derivative of the discrete solution, as `jacobian` gives it; where the model switches (the ends of a
    melting range, a curve of hysteresis, windward and leeward, a plant that sets in or reaches its capacity)
    it is the one-sided slope of the branch taken.

    Parameters
    ----------
    building, climate, outputs, step, start, end, scheme, initial, measurements
        As in `Simulation`.
    objective : callable
        From the series by output to a value and its derivatives by each: `Mean`, `SquaredResiduals` or a
        function of your own.
    values : mapping of str to float, optional
        Where to derive: values that replace nominal ones. [unit of each]
    memory : int
        About how much of the run may be kept: beyond it stretches are run once more on the way back. [B]

    Returns
    -------
    Gradient
        The value and its slopes.

    Raises
    ------
    InputError
        Unknown path, a value that the parameter cannot have, an objective that does not fit the outputs.
    SolverError
        A step did not converge, or the first period did not settle.

    References
    ----------
    Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3 and 12, doi:10.1137/1.9780898717761.
    """
    simulation = Simulation(
        building,
        climate,
        step=step,
        start=start,
        end=end,
        outputs=outputs,
        scheme=scheme,
        initial=initial,
        measurements=measurements,
    )
    trajectory = simulation.trajectory(simulation.vector(values or {}), memory=memory)
    names = [output.name for output in simulation.outputs]
    value, by_series = objective(dict(zip(names, trajectory.records.T, strict=True)))
    weights = np.zeros_like(trajectory.records)
    for name, slopes in by_series.items():
        _series(dict.fromkeys(names, weights), name)
        weights[:, names.index(name)] = slopes
    parameters = [building.parameter(path) for path in simulation.paths]
    slopes = trajectory.pull(weights)
    return Gradient(
        value=float(value),
        slopes=dict(zip(simulation.paths, slopes.tolist(), strict=True)),
        units={p.path: p.unit for p in parameters},
        ranges={p.path: (p.low, p.high) for p in parameters},
    )


def jacobian(
    building: Building,
    climate: Climate,
    parameters: Sequence[str],
    *,
    outputs: Sequence[str],
    values: Mapping[str, float] | None = None,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    scheme: Literal["sdirk2", "backward-euler", "apparent-capacity"] = "sdirk2",
    initial: Initial = "repeat",
    measurements: Measurements | None = None,
    report: Callable[[int], object] | None = None,
) -> xr.Dataset:
    """Series of a building and their derivatives by some parameters, in forward mode.

    Slopes by eight parameters go along one run, side by side: this pays where parameters are few and series
    many. What comes back is the exact derivative of the discrete solution, through phase change, convection
    that depends on temperature and wind, long-wave exchange and the repeated start. Where the model switches
    (the ends of a melting range, windward and leeward) it is the one-sided slope of the branch taken.

    Parameters
    ----------
    building, climate, outputs, step, start, end, scheme, initial, measurements
        As in `Simulation`.
    parameters : sequence of str
        Paths to derive by.
    values : mapping of str to float, optional
        Where to derive: values that replace nominal ones. [unit of each]
    report : callable, optional
        Called with the number of parameters done.

    Returns
    -------
    xarray.Dataset
        Each output over (time), and ``d <output>`` over (parameter, time).
        [unit of the output / unit of the parameter]

    Raises
    ------
    InputError
        Unknown or structural path, a value that the parameter cannot have.
    SolverError
        A step did not converge, or the first period did not settle.

    References
    ----------
    Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3, doi:10.1137/1.9780898717761.
    """
    import xarray as xr

    simulation = Simulation(
        building,
        climate,
        step=step,
        start=start,
        end=end,
        outputs=outputs,
        scheme=scheme,
        initial=initial,
        measurements=measurements,
    )
    paths = [building.parameter(path).path for path in parameters]
    records, slopes = simulation.jacobian(paths, simulation.vector(values or {}), report=report)
    data = {}
    for k, output in enumerate(simulation.outputs):
        data[output.name] = xr.DataArray(records[:, k], dims="time", attrs={"units": output.unit})
        data[f"d {output.name}"] = xr.DataArray(slopes[:, :, k], dims=("parameter", "time"))
    units = np.array([building.parameter(path).unit for path in paths])
    return xr.Dataset(
        data,
        coords={
            "time": simulation.index.tz_convert("UTC").tz_localize(None),
            "parameter": paths,
            "parameter_unit": ("parameter", units),
        },
        attrs={"timezone": str(simulation.index.tz)},
    )
