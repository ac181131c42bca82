"""Columns of a table: which quantity they hold, in which unit, and how they are converted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from mascarin.errors import InputError
from mascarin.physics import KELVIN
from mascarin.tables.arrays import Array

FACTORS: Mapping[str, tuple[str, float, float]] = {
    "degC": ("degC", 1.0, 0.0),
    "K": ("degC", 1.0, -KELVIN),
    "degF": ("degC", 5.0 / 9.0, -160.0 / 9.0),
    "W/m2": ("W/m2", 1.0, 0.0),
    "kW/m2": ("W/m2", 1000.0, 0.0),
    "m/s": ("m/s", 1.0, 0.0),
    "km/h": ("m/s", 1.0 / 3.6, 0.0),
    "knot": ("m/s", 1852.0 / 3600.0, 0.0),
    "Pa": ("Pa", 1.0, 0.0),
    "hPa": ("Pa", 100.0, 0.0),
    "mbar": ("Pa", 100.0, 0.0),
    "kPa": ("Pa", 1000.0, 0.0),
    "%": ("%", 1.0, 0.0),
    "1": ("%", 100.0, 0.0),
    "tenths": ("tenths", 1.0, 0.0),
    "oktas": ("tenths", 1.25, 0.0),
    "deg": ("deg", 1.0, 0.0),
}
"""Units that a column may have: (unit after conversion, factor, offset)."""

ENERGIES: Mapping[str, float] = {
    "J/cm2": 1e4,
    "J/m2": 1.0,
    "kJ/m2": 1e3,
    "MJ/m2": 1e6,
    "Wh/m2": 3600.0,
    "kWh/m2": 3.6e6,
}
"""Energies per interval, in J/m2; divided by the interval they become W/m2."""


@dataclass(frozen=True)
class Column:
    """A column of a table: its name, its unit and how it is converted.

    Parameters
    ----------
    column : str
        Name of the column.
    unit : str, optional
        Unit in the file (a key of `FACTORS` or `ENERGIES`); without one the quantity's own unit.
    scale, offset : float
        Applied after the unit: value = scale x + offset.
    kind : str, optional
        `instant` or `mean`; without one the quantity's usual kind.

    Examples
    --------
    >>> from mascarin.weather import Climate, Column
    >>> import pandas as pd
    >>> index = pd.date_range("2024-06-01", periods=3, freq="1h", tz="UTC")
    >>> kelvin = Climate.from_table(
    ...     pd.DataFrame({"T": [293.15, 294.15, 295.15]}, index=index),
    ...     columns={"air_temperature": Column("T", unit="K")},
    ...     absent=["radiation", "dew_point", "wind_speed", "wind_direction"],
    ... )
    >>> kelvin.to_dataframe()["air_temperature"].round(2).tolist()
    [20.0, 21.0, 22.0]
    """

    column: str
    unit: str | None = None
    scale: float = 1.0
    offset: float = 0.0
    kind: Literal["instant", "mean"] | None = None

    @classmethod
    def of(cls, given: object, where: str) -> Column:
        """Column from its short form.

        Parameters
        ----------
        given : Column, str or mapping
            A column, its name, or a mapping with the attributes as keys.
        where : str
            Place of the column, for the error.

        Returns
        -------
        Column
            The column.

        Raises
        ------
        InputError
            A key is unknown, or the name is missing.
        """
        if isinstance(given, Column):
            return given
        if isinstance(given, str):
            return cls(given)
        if isinstance(given, Mapping):
            unknown = set(given) - {"column", "unit", "scale", "offset", "kind"}
            if unknown or "column" not in given:
                raise InputError(
                    f"{where}: found {dict(given)!r}, expected a column's name or a mapping with 'column' "
                    "and optionally 'unit', 'scale', 'offset', 'kind'."
                )
            kind = given.get("kind")
            if kind not in (None, "instant", "mean"):
                raise InputError(f"{where}: kind is {kind!r}, expected 'instant' or 'mean'.")
            scale, offset = float(given.get("scale", 1.0)), float(given.get("offset", 0.0))
            return cls(str(given["column"]), given.get("unit"), scale, offset, kind)
        raise InputError(f"{where}: found {given!r}, expected a column's name or a mapping with 'column'.")

    def convert(self, values: Array, unit: str, interval: float, where: str) -> Array:
        """Values in the wanted unit.

        Parameters
        ----------
        values : ndarray, shape (n,)
            As read.
        unit : str
            Wanted unit.
        interval : float
            Length of an interval, for energies [s].
        where : str
            For the error.

        Raises
        ------
        InputError
            The column's unit cannot be converted to the wanted one.
        """
        if self.unit is not None:
            if self.unit in ENERGIES and unit == "W/m2":
                values = values * (ENERGIES[self.unit] / interval)
            elif self.unit in FACTORS and (not unit or FACTORS[self.unit][0] == unit):
                _, factor, offset = FACTORS[self.unit]
                values = values * factor + offset
            elif self.unit != unit:
                known = [name for name, entry in FACTORS.items() if entry[0] == unit]
                known += list(ENERGIES) if unit == "W/m2" else []
                raise InputError(
                    f"{where}: unit {self.unit!r} of column {self.column!r} cannot be turned into "
                    f"{unit}; expected one of {', '.join(known)}, or give scale and offset instead."
                )
        return values * self.scale + self.offset

    def sentence(self, name: str, unit: str) -> str:
        """What was done, for the provenance; empty where nothing was.

        Parameters
        ----------
        name : str
            Quantity.
        unit : str
            Its unit.
        """
        parts = []
        if self.unit is not None and self.unit != unit:
            parts.append(f"{self.unit} to {unit}")
        if self.scale != 1.0 or self.offset != 0.0:
            parts.append(f"times {self.scale:g} plus {self.offset:g}")
        return f"{name}: column {self.column!r} converted, {', '.join(parts)}." if parts else ""
