"""Units of the columns of a calorimeter file: from their names, and checked for plausible values."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from mascarin.errors import InputError
from mascarin.physics import KELVIN

#: Quantity -> unit without blanks, brackets and dots -> factor to SI. Heat flow is per kilogram.
UNITS: Final[dict[str, dict[str, float]]] = {
    "temperature": {"degc": 1.0, "°c": 1.0, "c": 1.0, "k": 1.0, "degf": 1.0, "°f": 1.0},
    "time": {"s": 1.0, "min": 60.0, "h": 3600.0},
    "heat flow": {"mw/mg": 1000.0, "w/g": 1000.0, "mw/g": 1.0, "w/kg": 1.0, "mw": 1e-3, "w": 1.0, "µw": 1e-6},
    "specific heat": {"j/gk": 1000.0, "kj/kgk": 1000.0, "j/kgk": 1.0, "cal/gk": 4184.0, "wh/kgk": 3600.0},
    "enthalpy": {"j/g": 1000.0, "kj/kg": 1000.0, "j/kg": 1.0, "cal/g": 4184.0, "wh/kg": 3600.0},
}
#: Signals before the calibration of the sensitivity, which no file states.
_VOLTAGES: Final = ("µv/mg", "µv", "mv", "mv/mg", "uv/mg", "uv")
#: Units of heat flow that need the mass of the sample.
OF_SAMPLE: Final = ("mw", "w", "µw")
#: Plausible specific heats of solids and liquids [J/(kg K)]: from metals to water, with a margin.
POSSIBLE_HEAT: Final = (200.0, 12000.0)

SIGN: Final = re.compile(
    r"[\s(\[]*\b(?P<kind>exo|endo)(?:therm(?:al|ic)?)?[\s.]*(?P<side>up|down)\b[)\]]?", re.IGNORECASE
)
"""Direction of heat in the name of a column."""

_NAMES: Final = {
    "temperature": ("temp", "temperature", "t", "theta", "sample temperature", "ts"),
    "time": ("time", "zeit"),
    "heat flow": (
        "heat flow",
        "heatflow",
        "dsc",
        "hf",
        "q",
        "phi",
        "unsubtracted heat flow",
        "heat flow rate",
    ),
    "specific heat": ("cp", "c", "specific heat", "heat capacity", "capacity", "apparent capacity", "cp app"),
    "enthalpy": ("enthalpy", "h", "heat content"),
    "direction": ("direction", "segment", "run"),
}


@dataclass(frozen=True)
class DscColumn:
    """One column of the file.

    Attributes
    ----------
    index : int
        Its position, from 0.
    name : str
        Its name in the file.
    quantity : str
        A key of `UNITS`, or ``direction``.
    unit : str or None
        As in `UNITS`; None where the file does not give it.
    direction : str or None
        ``heating`` or ``cooling``, where the name contains it.
    """

    index: int
    name: str
    quantity: str
    unit: str | None
    direction: str | None


def plain_unit(text: str) -> str:
    """A unit without blanks, brackets and powers: ``J/(g·K)``, ``J g^-1 K^-1``, ``J/g/K`` become one."""
    bare = text.casefold().replace("μ", "µ").replace("⁻¹", "-1")
    bare = re.sub(r"^uw", "µw", re.sub(r"[\s()\[\]*·.^]", "", bare))
    bare = re.sub(r"(k?g)-1", r"/\1", bare).replace("k-1", "k")
    return re.sub(r"/(k?g)/?(k|°c|degc)$", r"/\1k", bare)


def column_of(index: int, name: str) -> DscColumn | None:
    """Quantity and unit of a column by its name; None for other columns.

    The unit is in brackets or after a slash: ``cp [J/(g K)]``, ``Temp./°C``, ``DSC/(mW/mg)``.
    """
    text = name.strip().strip('"#').strip()
    plain = SIGN.sub("", text).strip(" ,;")
    match = re.match(r"^(?P<name>[^\[(/]+?)[\s._]*(?:\[(?P<a>.*)\]|\((?P<b>.*)\)|/\s*(?P<c>.+))?$", plain)
    if match is None:
        return None
    words = re.sub(r"[\s._-]+", " ", match["name"]).strip().casefold()
    direction = next((word for word in ("heating", "cooling") if word in words), None)
    if direction is not None:
        words = re.sub(r"\s+", " ", words.replace(direction, "")).strip()
    unit = next((plain_unit(match[key]) for key in "abc" if match[key]), None)
    quantity = next((key for key, names in _NAMES.items() if words in names), None)
    if quantity is None and unit is not None:
        quantity = next(
            (key for key, factors in UNITS.items() if key != "temperature" and unit in factors), None
        )
    if quantity is None:
        return None
    return DscColumn(index, text, quantity, unit, direction)


def check_unit(column: DscColumn, where: str) -> None:
    """Check that a unit belongs to its quantity.

    Raises
    ------
    InputError
        The unit does not; the text has the column, the unit and those that are known.
    """
    factors = UNITS.get(column.quantity, {})
    if column.unit in _VOLTAGES:
        raise InputError(
            f"{where}: column '{column.name}': found the voltage of the sensor ({column.unit}); expected a "
            "heat flow. Apply the sensitivity calibration in the program of the instrument, and export mW/mg "
            "or mW"
        )
    if column.unit is not None and column.unit not in factors:
        raise InputError(
            f"{where}: column '{column.name}': found the unit '{column.unit}' for a {column.quantity}; "
            f"expected one of {', '.join(SHOWN[column.quantity])}"
        )


SHOWN: Final = {
    "temperature": ("degC", "K", "degF"),
    "time": ("s", "min", "h"),
    "heat flow": ("mW/mg", "W/g", "W/kg", "mW"),
    "specific heat": ("J/(g K)", "kJ/(kg K)", "J/(kg K)"),
    "enthalpy": ("J/g", "kJ/kg", "J/kg"),
}
"""Units as they are shown in messages."""


_CHECK: Final = "Check unit, heating rate and mass, and that the file begins and ends outside the melting"


def check_heat(base: float, column: DscColumn, where: str, factor: float) -> None:
    """Check that a sensible specific heat is plausible; otherwise the unit in the file is wrong.

    Parameters
    ----------
    base : float
        Specific heat beside the peak, with the unit that was used [J/(kg K)].
    column : DscColumn
        The column.
    where : str
        The file.
    factor : float
        The factor from the unit of the column to SI.

    Raises
    ------
    InputError
        It is not; the text has the unit that would fit, if there is one.
    """
    low, high = POSSIBLE_HEAT
    if low <= base <= high:
        return
    factors = UNITS[column.quantity]
    fitting = [
        unit
        for unit in SHOWN[column.quantity]
        if plain_unit(unit) not in OF_SAMPLE and low <= base / factor * factors[plain_unit(unit)] <= high
    ]
    unit = column.unit or "no unit"
    advice = f"With {' or '.join(fitting)} it could be" if fitting else _CHECK
    raise InputError(
        f"{where}: column '{column.name}' ({unit}): found a specific heat of {base:.4g} J/(kg K) beside "
        f"the peak; expected {low:g} to {high:g}. {advice}."
    )


def to_celsius(values: list[float], column: DscColumn, where: str) -> list[float]:
    """Temperatures in degC; without a unit, degC or K by their size.

    Raises
    ------
    InputError
        The numbers contradict the unit.
    """
    low, high = min(values), max(values)
    if column.unit in ("degf", "°f"):
        values = [(value - 32.0) / 1.8 for value in values]
        low, high = min(values), max(values)
    kelvin = column.unit == "k" or (column.unit is None and low > 200.0)
    if column.unit == "k" and low < 150.0:
        raise InputError(
            f"{where}: column '{column.name}': found {low:g} to {high:g} K; expected kelvins of a phase "
            "change. They look like degC: write degC in the column's name"
        )
    if column.unit not in ("k", None) and low > 230.0:
        raise InputError(
            f"{where}: column '{column.name}': found {low:g} to {high:g} degC; expected a phase change of a "
            "building material. They look like kelvins: write K in the column's name"
        )
    return [value - KELVIN for value in values] if kelvin else values
