"""Units by exponents of base units, a factor and an offset, as the Functional Mock-up Interface has them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

from mascarin.physics import KELVIN

_SIGNS: Final = re.compile(r"\s*([A-Za-z%]+|[0-9]+|[()/ ])")


@dataclass(frozen=True)
class BaseUnit:
    """A unit in base units: ``base = factor * value + offset``.

    Attributes
    ----------
    exponents : dict of str to int
        Exponent of each base unit of the standard, such as ``{"kg": 1, "s": -3, "K": -1}``.
    factor, offset : float
        From the unit to the base units.
    """

    exponents: dict[str, int] = field(default_factory=dict)
    factor: float = 1.0
    offset: float = 0.0

    def power(self, exponent: int) -> BaseUnit:
        """The unit to a power."""
        raised = {base: exponent * power for base, power in self.exponents.items()}
        return BaseUnit(raised, self.factor**exponent)

    def times(self, other: BaseUnit) -> BaseUnit:
        """The product of two units."""
        bases = [*self.exponents, *(base for base in other.exponents if base not in self.exponents)]
        exponents = {base: self.exponents.get(base, 0) + other.exponents.get(base, 0) for base in bases}
        return BaseUnit(
            {base: exponent for base, exponent in exponents.items() if exponent}, self.factor * other.factor
        )


_SYMBOLS: Final = {
    "m": BaseUnit({"m": 1}),
    "kg": BaseUnit({"kg": 1}),
    "s": BaseUnit({"s": 1}),
    "K": BaseUnit({"K": 1}),
    "J": BaseUnit({"kg": 1, "m": 2, "s": -2}),
    "W": BaseUnit({"kg": 1, "m": 2, "s": -3}),
    "Pa": BaseUnit({"kg": 1, "m": -1, "s": -2}),
    "g": BaseUnit({"kg": 1}, 1e-3),
    "h": BaseUnit({"s": 1}, 3600.0),
    "d": BaseUnit({"s": 1}, 86400.0),
    "deg": BaseUnit({"rad": 1}, math.pi / 180.0),
    "tenths": BaseUnit({}, 0.1),
}


def base_unit(unit: str) -> BaseUnit | None:
    """A unit in base units.

    Parameters
    ----------
    unit : str
        Such as ``W/(m2 K)``.

    Returns
    -------
    BaseUnit or None
        None where a part of it is not known.

    Examples
    --------
    >>> base_unit("W/(m2 K)").exponents
    {'kg': 1, 's': -3, 'K': -1}
    >>> base_unit("1/h").factor == 1.0 / 3600.0
    True
    """
    if unit == "degC":
        return BaseUnit({"K": 1}, offset=KELVIN)
    signs = [match[1] for match in _SIGNS.finditer(unit)]
    if "".join(signs).replace(" ", "") != unit.replace(" ", ""):
        return None
    try:
        return _product(iter(signs))
    except (KeyError, StopIteration):
        return None


def _product(signs: Iterator[str]) -> BaseUnit:
    """Read factors up to the end or a closing bracket."""
    product, last, below = BaseUnit(), BaseUnit(), False
    for sign in signs:
        if sign == ")":
            break
        if sign == "/":
            below = True
        elif sign == " ":
            continue
        elif sign.isdigit() and last.exponents:
            # An exponent: the factor itself has been counted once.
            product = product.times(last.power(int(sign) - 1))
        elif sign != "1":
            last = _product(signs) if sign == "(" else _SYMBOLS[sign]
            last = last.power(-1) if below else last
            product = product.times(last)
    return product
