"""Quantities made of the series of a run, and their derivatives."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from mascarin._io import display
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.simulation.checks.warning_kinds import RunWarning

Array = npt.NDArray[np.float64]

#: From the series of each output, shape (T,), a value and its derivative by each of them, shape (T,).
Objective = Callable[[Mapping[str, Array]], tuple[float, Mapping[str, Array]]]


@dataclass(frozen=True)
class Mean:
    """Mean of an output over the records.

    Parameters
    ----------
    output : str
        Name of the output.

    Examples
    --------
    >>> value, slopes = Mean("room.air_temperature")({"room.air_temperature": np.array([20.0, 22.0])})
    >>> value
    21.0
    """

    output: str

    def __call__(self, series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
        """Value [unit of the output] and its derivative by each record [-]."""
        values = series_of(series, self.output)
        return float(values.mean()), {self.output: np.full(len(values), 1.0 / len(values))}


@dataclass(frozen=True)
class SquaredResiduals:
    """Sum of squared residuals, each divided by its standard uncertainty; NaN is left out.

    Parameters
    ----------
    measured : mapping of str to ndarray, shape (T,)
        Measured series by output. [unit of the output]
    uncertainty : mapping of str to float
        Standard uncertainty by output; 1 where it is not given. [unit of the output]

    Examples
    --------
    >>> cost = SquaredResiduals({"room.air_temperature": np.array([20.0, np.nan])})
    >>> cost({"room.air_temperature": np.array([22.0, 25.0])})[0]
    4.0
    """

    measured: Mapping[str, Array]
    uncertainty: Mapping[str, float] | None = None

    def __call__(self, series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
        """Value [-] and its derivative by each record [1/unit of the output]."""
        total, slopes = 0.0, {}
        for output, measured in self.measured.items():
            simulated = series_of(series, output)
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


@dataclass(frozen=True, repr=False)
class Gradient:
    """A quantity and its derivatives by all parameters.

    Parameters
    ----------
    value : float
        The quantity.
    slopes : dict of str to float
        Derivatives by path. [unit of the quantity / unit of the parameter]
    units : dict of str to str
        Unit of each parameter.
    ranges : dict of str to tuple of float
        Range of each parameter.
    warnings : tuple of RunWarning
        Warnings of the run.

    Examples
    --------
    >>> found = Gradient(21.0, {"zones.room.volume": 0.1}, {"zones.room.volume": "m3"},
    ...                  {"zones.room.volume": (20.0, 40.0)})
    >>> float(found.to_dataframe()["over its range"].iloc[0])
    2.0
    """

    value: float
    slopes: dict[str, float]
    units: dict[str, str]
    ranges: dict[str, tuple[float, float]]
    warnings: tuple[RunWarning, ...] = ()

    def to_dataframe(self) -> pd.DataFrame:
        """Derivatives, units, and derivatives times ranges by parameter, the largest effect first."""
        import pandas as pd

        over = {path: slope * np.ptp(self.ranges[path]) for path, slope in self.slopes.items()}
        table = pd.DataFrame(
            {"slope": self.slopes, "parameter unit": self.units, "over its range": over}
        ).rename_axis("parameter")
        return table.sort_values("over its range", key=np.abs, ascending=False)

    def __repr__(self) -> str:
        table = self.to_dataframe()
        columns = (table.index, table["slope"], table["parameter unit"], table["over its range"])
        return display.text(
            self._title(),
            [
                (path, f"{slope:.4g}{'' if unit == '-' else f' per {unit}'}, {over:.4g} over its range")
                for path, slope, unit, over in zip(*columns, strict=True)
            ],
        )

    def _repr_html_(self) -> str:
        return display.page(self._title(), [], tables={"Derivatives": self.to_dataframe()})

    def _title(self) -> str:
        return f"Gradient of a quantity with the value {self.value:.6g} by {len(self.slopes)} parameters"


def series_of(series: Mapping[str, Array], output: str) -> Array:
    """The series of an output.

    Raises
    ------
    InputError
        It was not recorded; the text names the nearest ones.
    """
    try:
        return series[output]
    except KeyError:
        raise InputError(
            f"objective: there is no output {output!r}; expected one of those recorded: "
            f"{', '.join(series)}. {did_you_mean(output, list(series), known=False)}".rstrip()
        ) from None
