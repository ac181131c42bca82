"""Columns of a table: which quantity they hold, in which unit, and how they are converted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array
from mascarin.tables.units import CONVERTED, FACTORS, HEATS, StatedUnit, conversion, parse_unit, units_of


@dataclass(frozen=True)
class Column:
    """A column of a table: its name, its unit and how it is converted.

    Parameters
    ----------
    column : str
        Name of the column.
    unit : str, optional
        Unit in the file (a key of `FACTORS` or `ENERGIES`); without one that which the file states, else the
        quantity's own unit.
    scale, offset : float
        Applied after the unit: value = scale x + offset.
    kind : str, optional
        `instant` or `mean`; without one the quantity's usual kind.
    overrule : bool
        Whether the unit holds although the file states another one.

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
    overrule: bool = False

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
            unknown = set(given) - {"column", "unit", "scale", "offset", "kind", "overrule"}
            if unknown or "column" not in given:
                raise InputError(
                    f"{where}: found {dict(given)!r}, expected a column's name or a mapping with 'column' "
                    "and optionally 'unit', 'scale', 'offset', 'kind', 'overrule'."
                )
            kind = given.get("kind")
            if kind not in (None, "instant", "mean"):
                raise InputError(f"{where}: kind is {kind!r}, expected 'instant' or 'mean'.")
            scale, offset = float(given.get("scale", 1.0)), float(given.get("offset", 0.0))
            overrule = given.get("overrule", False)
            if not isinstance(overrule, bool):
                raise InputError(f"{where}: overrule is {overrule!r}, expected true or false.")
            return cls(str(given["column"]), given.get("unit"), scale, offset, kind, overrule)
        raise InputError(f"{where}: found {given!r}, expected a column's name or a mapping with 'column'.")

    def settled(
        self, stated: StatedUnit | None, target: str, interval: float, names: Sequence[str], where: str
    ) -> Column:
        """The column with the unit that holds: the user's, else that of the file.

        Parameters
        ----------
        stated : StatedUnit or None
            What the file states.
        target : str
            Wanted unit; empty where the use of the column is not known.
        interval : float
            Length of an interval, for energies [s].
        names : sequence of str
            Names of the columns of the file.
        where : str
            Place of the column, for the error.

        Returns
        -------
        Column
            The same; its unit is None where nobody states one.

        Raises
        ------
        InputError
            The file and the user, or the file and the quantity, contradict each other; both are named.
        """
        if self.unit is not None:
            plain = parse_unit(self.unit)
            column = replace(self, unit=plain) if self.unit not in FACTORS and plain is not None else self
            if stated is None or self.overrule or _same(column.unit, stated.unit, interval):
                return column
            raise InputError(
                f"{where}: found the unit {self.unit!r}, but {stated.place} says {stated.text!r} for the "
                f"column {self.column!r}; expected the same. Leave the unit out to use that of the file, or "
                f"write {self._forced(self.unit)} where the file is wrong."
            )
        if stated is None:
            return self
        plain_factors = self.scale == 1.0 and self.offset == 0.0
        if not target and (FACTORS.get(stated.unit, ("W/m2",))[0] not in CONVERTED or
                           conversion(stated.unit, "", interval) is None):  # fmt: skip
            return self
        factors = conversion(stated.unit, target, interval)
        if factors is None:
            if stated.unit == "deg":  # the sign of degrees alone
                return self
            likely = [name for name in names if name != self.column][:12]
            raise InputError(
                f"{where}: {stated.place} says {stated.text!r} for the column {self.column!r}, expected one "
                f"of {', '.join(units_of(target))}. Name another column (there are {', '.join(likely)}), or "
                f"write {self._forced(target)} where the file is wrong."
            )
        if plain_factors or factors == (1.0, 0.0):
            return replace(self, unit=stated.unit)
        if np.allclose((self.scale, self.offset), factors, rtol=1e-3, atol=1e-3):
            return self  # the user converts by hand
        raise InputError(
            f"{where}: found scale {self.scale:g} and offset {self.offset:g}, but {stated.place} says "
            f"{stated.text!r} for the column {self.column!r}, which is converted by {factors[0]:g} and "
            f"{factors[1]:g}; expected one of the two. Write unit: {stated.unit} where scale and "
            "offset are applied after the conversion, or "
            f"{self._forced(target or FACTORS[stated.unit][0])} where the file is wrong."
        )

    def _forced(self, unit: str) -> str:
        return f"{{column: {self.column!r}, unit: {unit!r}, overrule: true}}"

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
        if self.unit is not None and self.unit != unit:
            factors = conversion(self.unit, unit, interval)
            if factors is None:
                raise InputError(
                    f"{where}: unit {self.unit!r} of column {self.column!r} cannot be turned into "
                    f"{unit}; expected one of {', '.join(units_of(unit))}, or give scale and offset instead."
                )
            values = values * factors[0] + factors[1]
        if self.scale == 1.0 and self.offset == 0.0:
            return values
        return values * self.scale + self.offset

    def line(
        self, name: str, unit: str, values: Array, stated: StatedUnit | None,
        words: Mapping[str, int] = MappingProxyType({}),
    ) -> str:  # fmt: skip
        """What was read, in one line.

        Parameters
        ----------
        name : str
            Quantity, or name of the column.
        unit : str
            Unit of the values; empty where it is not known.
        values : ndarray, shape (n,)
            After the conversion.
        stated : StatedUnit or None
            What the file states.
        words : mapping of str to int
            Words for no value, and how often they stand in the column.

        Returns
        -------
        str
            Name, unit in the file, conversion, range, missing values, and whether all are equal.
        """
        input_unit = self.unit or ""
        after = unit or (
            FACTORS[input_unit][0]
            if input_unit in FACTORS
            else "W"
            if input_unit in HEATS
            else "W/m2"
            if input_unit
            else ""
        )
        parts = [f"column {self.column!r}" if self.column != name else "column"]
        by = f" ({stated.place})" if stated is not None and not self.overrule else " (as stated)"
        if self.unit is not None and self.unit != after:
            parts.append(f"{self.unit}{by} converted to {after}")
        elif self.unit is not None:
            parts.append(f"{after}{by}")
        elif stated is not None:
            parts.append(f"{stated.text} ({stated.place})")
        else:
            parts.append(f"taken as {unit}, no unit is stated" if unit else "no unit is stated")
        if self.scale != 1.0 or self.offset != 0.0:
            parts.append(f"times {self.scale:g} plus {self.offset:g}")
        valid = values[~np.isnan(values)]
        if not len(valid):
            return f"{name}: {', '.join(parts)}; no values."
        low, high = float(valid.min()), float(valid.max())
        extent = f"constant {low:.4g}" if low == high else f"{low:.4g} .. {high:.4g}"
        absent = len(values) - len(valid)
        listed = ", ".join(f"{count} {word!r}" for word, count in words.items())
        counted = f" ({listed})" if listed else ""
        return f"{name}: {', '.join(parts)}; {extent}{' ' * bool(after)}{after}, {absent} missing{counted}."


def _same(unit: str | None, other: str, interval: float) -> bool:
    """Whether two units are converted alike, such as hPa and mbar."""
    if unit == other or unit is None:
        return True
    mine, theirs = (
        (FACTORS[name][0] if name in FACTORS else name, conversion(name, "", interval))
        for name in (unit, other)
    )
    return mine == theirs and mine[1] is not None
