"""Sensors: the columns of a measured table, and the uncertainty of a measured value by the GUM.

The standard uncertainty u is the standard deviation of the error of a measured value; the expanded
uncertainty U = k u with k = 1.96 is the half-width of the interval that contains the true value with a
probability of 95 %, when the error has a normal distribution. Datasheets usually state U.

References
----------
JCGM 100:2008, Evaluation of measurement data: guide to the expression of uncertainty in measurement (GUM),
2.3.1, 2.3.5, 6.2 and table G.1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from mascarin.errors import InputError

COVERAGE_FACTOR: Final = 1.96
"""Expanded over standard uncertainty for a probability of 95 % (normal distribution). [-]"""

DEFAULT_EXPANDED: Final = {"degC": 0.5}
"""Expanded uncertainty of a sensor that states none, by unit; for all other units it has to be stated."""


class SensorLike(Protocol):
    """A measured quantity: columns of a table whose mean or sum one model output is compared with."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the measured table."""
        ...

    @property
    def adds(self) -> bool:
        """Whether the columns are added, not averaged."""
        ...


@dataclass(frozen=True, slots=True)
class SensorUncertainty:
    """Standard uncertainty of the values of one sensor.

    The absolute and the relative part are independent of each other: ``u = sqrt(a^2 + (r value)^2)``.

    Attributes
    ----------
    absolute : float
        Part that is the same for all values, a. [unit of the sensor]
    relative : float
        Part in proportion to the value, r. [-]

    Examples
    --------
    >>> SensorUncertainty.stated("degC", expanded=0.98)
    SensorUncertainty(absolute=0.5, relative=0.0)
    """

    absolute: float
    relative: float = 0.0

    @classmethod
    def stated(
        cls,
        unit: str,
        *,
        standard: float | None = None,
        expanded: float | None = None,
        relative_standard: float | None = None,
        relative_expanded: float | None = None,
        where: str = "sensor",
    ) -> SensorUncertainty:
        """Read an uncertainty that is stated as standard or as expanded uncertainty.

        Parameters
        ----------
        unit : str
            Unit of the sensor.
        standard, expanded : float, optional
            Absolute part; give one of them. Without any uncertainty a sensor in degC has an expanded
            uncertainty of 0.5 degC. [unit]
        relative_standard, relative_expanded : float, optional
            Part in proportion to the measured value; give at most one of them. [-]
        where : str
            Name of the sensor in errors.

        Returns
        -------
        SensorUncertainty

        Raises
        ------
        InputError
            Both of a pair, a negative or infinite value, or none although the unit is not degC.
        """
        absolute = _one_of(where, "", standard, expanded)
        relative = _one_of(where, "relative_", relative_standard, relative_expanded)
        if absolute is None and relative is None and unit not in DEFAULT_EXPANDED:
            raise InputError(
                f"{where}: found no uncertainty, expected one, because the unit is {unit or '-'} and not "
                "degC. Write standard_uncertainty (standard deviation) or expanded_uncertainty (half-width "
                "of the 95 % interval)"
            )
        if absolute is None:
            absolute = DEFAULT_EXPANDED[unit] / COVERAGE_FACTOR if unit in DEFAULT_EXPANDED else 0.0
        return cls(absolute, relative or 0.0)


@dataclass(frozen=True)
class Sensor:
    """A measured series: column and uncertainty.

    Give the uncertainty as standard or as expanded uncertainty; a sensor in degC may leave it out and then
    has an expanded uncertainty of 0.5 degC.

    Attributes
    ----------
    column : str or sequence of str
        Column of the measured table, or several whose mean is taken.
    expanded_uncertainty : float, optional
        Half-width of the interval of 95 % (GUM, coverage factor 1.96). [unit of the output]
    standard_uncertainty : float, optional
        Standard deviation of the error of a measured value. [unit of the output]
    relative_expanded_uncertainty, relative_standard_uncertainty : float, optional
        Further part in proportion to the measured value, such as 0.05 for a heat flux meter. [-]
    output : str, optional
        Output of the model; the key of the sensor in ``sensors=`` when absent.
    offset, common : float, optional
        Standard uncertainty of a constant added to all readings of this sensor, and of one that all sensors
        with a ``common`` share, such as that of a logger. [unit of the output]
    gain : float
        Standard uncertainty of a part of the distance from `reference` that is added to it. [-]
    reference : float
        Reading at which a gain has no effect. [unit of the output]
    clock : str or float, optional
        Standard uncertainty of the time by which the clock of the logger is fast, such as ``5min``. [s]
    depth : float, optional
        Standard uncertainty of the depth of a sensor in a wall. [m]
    repeatability : float, optional
        Standard deviation of repeated readings under the same conditions. [unit of the output]

    Raises
    ------
    InputError
        Standard and expanded uncertainty together, or a value that is not positive.

    Examples
    --------
    >>> Sensor("T_room", expanded_uncertainty=0.3).columns
    ('T_room',)
    >>> Sensor(["T_1", "T_2"], standard_uncertainty=0.1).uncertainty("degC").absolute
    0.1
    """

    column: str | Sequence[str]
    expanded_uncertainty: float | None = None
    standard_uncertainty: float | None = None
    relative_expanded_uncertainty: float | None = None
    relative_standard_uncertainty: float | None = None
    output: str | None = None
    offset: float | None = None
    common: float = 0.0
    gain: float = 0.0
    reference: float = 0.0
    clock: str | float | None = None
    depth: float | None = None
    repeatability: float | None = None

    def __post_init__(self) -> None:
        for key in ("offset", "common", "gain", "depth", "repeatability"):
            value = getattr(self, key)
            if value is not None and not 0.0 <= value < math.inf:
                raise InputError(
                    f"sensor of column {', '.join(self.columns)}: found {key} {value:g}, expected a positive "
                    "number; give the magnitude"
                )
        self.uncertainty("degC")

    @property
    def states_errors(self) -> bool:
        """Whether it says which errors the readings share."""
        shared = (self.offset, self.common, self.gain, self.clock, self.depth)
        return any(part is not None and part != 0.0 for part in shared)

    @property
    def _standard(self) -> float | None:
        """Standard uncertainty of a reading: as stated, else from its parts. [unit of the output]"""
        if self.standard_uncertainty is not None or self.expanded_uncertainty is not None:
            return self.standard_uncertainty
        return math.hypot(self.offset or 0.0, self.common, self.repeatability or 0.0) or None

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the measured table whose mean is taken."""
        return (self.column,) if isinstance(self.column, str) else tuple(self.column)

    @property
    def adds(self) -> bool:
        """Never: the mean is taken."""
        return False

    def uncertainty(self, unit: str, where: str = "") -> SensorUncertainty:
        """Return the standard uncertainty of the measured values.

        Parameters
        ----------
        unit : str
            Unit of the output.
        where : str
            Name of the sensor in errors.

        Returns
        -------
        SensorUncertainty

        Raises
        ------
        InputError
            None is stated although the unit is not degC.
        """
        return SensorUncertainty.stated(
            unit,
            standard=self._standard,
            expanded=self.expanded_uncertainty,
            relative_standard=self.relative_standard_uncertainty,
            relative_expanded=self.relative_expanded_uncertainty,
            where=where or f"sensor of column {', '.join(self.columns)}",
        )


def _one_of(where: str, kind: str, standard: float | None, expanded: float | None) -> float | None:
    """Standard uncertainty from one of the two forms; None where neither is given."""
    if standard is not None and expanded is not None:
        raise InputError(
            f"{where}: found {kind}standard_uncertainty {standard:g} and {kind}expanded_uncertainty "
            f"{expanded:g}, expected one of them; leave one out"
        )
    for name, value in (("standard", standard), ("expanded", expanded)):
        if value is not None and not (0.0 <= value < math.inf):
            raise InputError(
                f"{where}: found {kind}{name}_uncertainty {value:g}, expected a positive number; give the "
                "magnitude"
            )
    return standard if expanded is None else expanded / COVERAGE_FACTOR
