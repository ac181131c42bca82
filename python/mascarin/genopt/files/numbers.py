"""Numbers as GenOpt writes, reads and rounds them."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable

_JAVA_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[fFdD]?\Z")
_SINGLE = struct.Struct("<f")
_MAX_EXACT = 1e22


def double_text(value: float) -> str:
    """Write a double: decimal between 0.001 and 10 million, else with an exponent like ``1.0E-4``.

    Parameters
    ----------
    value : float
        Any number, infinite or undefined ones included.

    Returns
    -------
    str
        The shortest digits from which the number can be read again.
    """
    return _layout(value, repr)


def single_text(value: float) -> str:
    """Write the nearest single-precision number, in the form of `double_text`.

    Parameters
    ----------
    value : float
        Any number.

    Returns
    -------
    str
        The shortest digits from which the single-precision number can be read again.
    """
    return _layout(_to_single(value), _single_digits)


def single(value: float) -> float:
    """Round a value to the decimal text of its nearest single-precision number.

    Mesh points that differ by arithmetic noise become equal, and 0.3 stays 0.3.

    Parameters
    ----------
    value : float
        A finite number.

    Returns
    -------
    float
        The rounded number, about seven digits.
    """
    return float(_single_digits(_to_single(value)))


def single_rounding(value: float, _index: int) -> float:
    """Round a coordinate as GenOpt does, for the option `rounding` of searches on a mesh.

    Parameters
    ----------
    value : float
        A finite number.
    _index : int
        Number of the coordinate, not used.

    Returns
    -------
    float
        See `single`.
    """
    return single(value)


def parse_double(text: str) -> float | None:
    """Read a number in Java's form.

    Parameters
    ----------
    text : str
        What was read; blanks around it are ignored.

    Returns
    -------
    float or None
        The number, also infinite or NaN; None where the text is not a number.
    """
    word = text.strip()
    if _JAVA_NUMBER.match(word):
        return float(word.rstrip("fFdD"))
    special = {"NaN": math.nan, "Infinity": math.inf, "+Infinity": math.inf, "-Infinity": -math.inf}
    return special.get(word)


def normalised(text: str) -> str:
    """Write an unquoted value as GenOpt does: whole numbers without a fraction, others as `double_text`."""
    value = parse_double(text) if not text.endswith(tuple("fFdD")) else None
    if value is None or not math.isfinite(value):
        return text
    return str(int(value)) if value == int(value) and abs(value) < _MAX_EXACT else double_text(value)


def _to_single(value: float) -> float:
    """Nearest single-precision number."""
    try:
        return float(_SINGLE.unpack(_SINGLE.pack(value))[0])
    except OverflowError:
        return math.copysign(math.inf, value)


def _single_digits(value: float) -> str:
    """Shortest digits of a number that is single precision already."""
    for precision in range(1, 10):
        text = f"{value:.{precision}g}"
        if _to_single(float(text)) == value:
            return text
    return repr(value)


def _layout(value: float, digits_of: Callable[[float], str]) -> str:
    """Digits in Java's layout."""
    if math.isnan(value):
        return "NaN"
    sign = "-" if math.copysign(1.0, value) < 0 else ""
    size = abs(value)
    if math.isinf(size):
        return sign + "Infinity"
    if size == 0.0:
        return sign + "0.0"
    text = digits_of(size)
    mantissa, _, exponent = text.partition("e")
    integer, _, fraction = mantissa.partition(".")
    digits = (integer + fraction).lstrip("0")
    point = len(integer) + int(exponent or 0)
    if integer.strip("0") == "":
        point = len(digits) - len(fraction) + int(exponent or 0)
    digits = digits.rstrip("0") or "0"
    if 1e-3 <= size < 1e7:
        if point <= 0:
            return f"{sign}0.{'0' * -point}{digits}"
        return f"{sign}{digits[:point].ljust(point, '0')}.{digits[point:] or '0'}"
    return f"{sign}{digits[0]}.{digits[1:] or '0'}E{point - 1}"
