"""Uncertainty of a measured value by the GUM.

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
from dataclasses import dataclass
from typing import Final

from mascarin.errors import InputError

COVERAGE_FACTOR: Final = 1.96
"""Expanded over standard uncertainty for a probability of 95 % (normal distribution). [-]"""

DEFAULT_EXPANDED: Final = {"degC": 0.5}
"""Expanded uncertainty of a sensor that states none, by unit; for all other units it has to be stated."""


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

    @property
    def expanded(self) -> float:
        """Half-width of the interval of 95 %, without the relative part. [unit of the sensor]"""
        return COVERAGE_FACTOR * self.absolute

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
