"""Quantities over time that a building takes from measured columns, without a schedule of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Final, Literal

from pydantic import AfterValidator

from mascarin.building.base.number import problem

CourseKind = Literal[
    "temperature",
    "power",
    "heat_flux",
    "flow",
    "air_change",
    "temperature_gradient",
    "vapour",
    "water_flow",
    "rain",
    "relative_humidity",
    "humidity_ratio",
]


def _named(columns: str | tuple[str, ...]) -> str | tuple[str, ...]:
    if not columns:
        raise problem(
            "no column",
            "the name of a measured column, or a list of names",
            "Name one, or leave the key out.",
        )
    return columns


#: A measured column, or several of which the mean is used.
Columns = Annotated[str | tuple[str, ...], AfterValidator(_named)]

#: Units that a column may have, by what it means: the factor to the unit of the engine.
POWER_UNITS: Final[Mapping[str, float]] = {"W": 1.0, "kW": 1000.0}
FLOW_UNITS: Final[Mapping[str, float]] = {"m3/s": 1.0, "m3/h": 1.0 / 3600.0, "L/s": 1e-3}
VAPOUR_UNITS: Final[Mapping[str, float]] = {"kg/s": 1.0, "kg/h": 1.0 / 3600.0, "g/h": 1e-3 / 3600.0}
WATER_UNITS: Final[Mapping[str, float]] = {"kg/s": 1.0, "kg/h": 1.0 / 3600.0}
_UNITS: Final[Mapping[str, Mapping[str, float]]] = {
    "temperature": {"degC": 1.0},
    "power": POWER_UNITS,
    "heat_flux": {"W/m2": 1.0, "kW/m2": 1000.0},
    "flow": FLOW_UNITS,
    "air_change": {"1/h": 1.0},
    "temperature_gradient": {"K/m": 1.0},
    "vapour": VAPOUR_UNITS,
    "water_flow": WATER_UNITS,
    "rain": {"mm/h": 1.0},
    "relative_humidity": {"-": 1.0, "%": 0.01},
    "humidity_ratio": {"kg/kg": 1.0, "g/kg": 1e-3},
}


@dataclass(frozen=True)
class ColumnCourse:
    """A measured column, or the mean of several, as a course over time.

    Attributes
    ----------
    kind : str
        What it is: a temperature is used with its value at an instant, a power or flow with its mean over a
        step.
    columns : tuple of str
        Names of the columns; their mean is used.
    unit : str
        Unit of the columns.
    schedule : str or None
        Schedule of the fraction that multiplies them, such as a phase of an experiment; None: always all.

    Examples
    --------
    >>> ColumnCourse("flow", ("supply",), "m3/h").name
    'supply [m3/h]'
    """

    kind: CourseKind
    columns: tuple[str, ...]
    unit: str
    schedule: str | None = None

    @property
    def name(self) -> str:
        """The columns, their unit and their schedule."""
        mean = "mean of " if len(self.columns) > 1 else ""
        scheduled = f", schedule {self.schedule}" if self.schedule is not None else ""
        return f"{mean}{' and '.join(self.columns)} [{self.unit}]{scheduled}"

    @property
    def scale(self) -> float:
        """Factor from the unit of the columns to that of the engine."""
        return _UNITS[self.kind][self.unit]


def temperature_course(columns: str | tuple[str, ...]) -> ColumnCourse:
    """Course of a measured temperature, or of the mean of several."""
    return ColumnCourse("temperature", (columns,) if isinstance(columns, str) else columns, "degC")
