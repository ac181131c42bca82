"""Function objects: arithmetic written as nested calls, such as ``add(%x%, multiply(2, %y%))``."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Mapping

from mascarin.errors import InputError, did_you_mean
from mascarin.genopt.files.numbers import parse_double

_TOKEN = re.compile(r"\s*(?:([A-Za-z_]\w*)\s*\(|([(),])|([^\s(),]+))")

_Function = Callable[..., float]


def _power(a: float, b: float) -> float:
    """Power with an infinite or undefined result instead of an error."""
    try:
        result = math.pow(a, b)
    except OverflowError:
        return -math.inf if a < 0 and b % 2 == 1 else math.inf
    except ValueError:
        return math.inf if a == 0 else math.nan
    return result


def _divide(a: float, b: float) -> float:
    """Quotient with an infinite or undefined result instead of an error."""
    if b != 0:
        return a / b
    if a == 0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def _log_of(function: _Function) -> _Function:
    """A logarithm that is minus infinity at zero."""
    return lambda a: -math.inf if a == 0 else function(a)


def _round_half_even(a: float) -> float:
    return float(round(a)) if math.isfinite(a) else a


def _signum(a: float) -> float:
    return a if a == 0 or math.isnan(a) else math.copysign(1.0, a)


_FUNCTIONS: dict[str, tuple[_Function, range]] = {
    "add": (lambda *v: _sum(v), range(2, 7)),
    "subtract": (lambda a, b: a - b, range(2, 3)),
    "multiply": (lambda *v: math.prod(v), range(2, 4)),
    "divide": (_divide, range(2, 3)),
    "log10": (_log_of(math.log10), range(1, 2)),
    "log": (_log_of(math.log), range(1, 2)),
    "log1p": (lambda a: -math.inf if a == -1 else math.log1p(a), range(1, 2)),
    "pow": (_power, range(2, 3)),
    "max": (lambda a, b: math.nan if math.isnan(a + b) else max(a, b), range(2, 3)),
    "min": (lambda a, b: math.nan if math.isnan(a + b) else min(a, b), range(2, 3)),
    "atan2": (math.atan2, range(2, 3)),
    "hypot": (math.hypot, range(2, 3)),
    "copySign": (math.copysign, range(2, 3)),
    "nextAfter": (math.nextafter, range(2, 3)),
    "IEEEremainder": (lambda a, b: math.nan if b == 0 else math.remainder(a, b), range(2, 3)),
    "fma": (lambda a, b, c: a * b + c, range(3, 4)),
    "random": (random.random, range(1)),
    "ceil": (lambda a: float(math.ceil(a)) if math.isfinite(a) else a, range(1, 2)),
    "floor": (lambda a: float(math.floor(a)) if math.isfinite(a) else a, range(1, 2)),
    "rint": (_round_half_even, range(1, 2)),
    "signum": (_signum, range(1, 2)),
    "toDegrees": (math.degrees, range(1, 2)),
    "toRadians": (math.radians, range(1, 2)),
    "nextUp": (lambda a: math.nextafter(a, math.inf), range(1, 2)),
    "nextDown": (lambda a: math.nextafter(a, -math.inf), range(1, 2)),
    "abs": (abs, range(1, 2)),
    **{
        name: (getattr(math, name), range(1, 2))
        for name in (
            "acos",
            "asin",
            "atan",
            "cbrt",
            "cos",
            "cosh",
            "exp",
            "expm1",
            "sin",
            "sinh",
            "sqrt",
            "tan",
            "tanh",
            "ulp",
        )
    },
}


def evaluate(text: str) -> float:
    """Compute the value of a function object without variables.

    Parameters
    ----------
    text : str
        One number, or nested calls with numbers.

    Returns
    -------
    float
        The value; infinite or NaN where it is undefined.

    Raises
    ------
    InputError
        The text is not such an expression.
    """
    position, value = _expression(text, 0)
    if text[position:].strip():
        msg = f"function '{text}': found '{text[position:].strip()}' after the closing bracket; remove it"
        raise InputError(msg)
    return value


def substitute(text: str, values: Mapping[str, str]) -> str:
    """Replace every ``%name%`` in a text.

    Parameters
    ----------
    text : str
        A function object or any other text.
    values : mapping of str to str
        Replacements by name.

    Returns
    -------
    str
        The text with names of `values` replaced, others left as they are.
    """
    for name, value in values.items():
        text = text.replace(f"%{name}%", value)
    return text


def resolve(functions: Mapping[str, str], location: Callable[[str], str]) -> dict[str, str]:
    """Replace references between functions by their text.

    Parameters
    ----------
    functions : mapping of str to str
        Text by name.
    location : callable
        File and line of a function, for messages.

    Returns
    -------
    dict of str to str
        Text by name without references to other functions.

    Raises
    ------
    InputError
        Functions refer to each other in a circle.
    """
    done = dict(functions)
    for name in functions:
        for _ in range(len(functions) + 1):
            # The functions themselves are inserted, not their values: their variables are still open.
            text = substitute(done[name], functions)
            if text == done[name]:
                break
            done[name] = text
        else:
            msg = f"{location(name)}: function '{name}' refers to itself in a circle; break the circle"
            raise InputError(msg)
    return done


def _sum(values: tuple[float, ...]) -> float:
    total = values[0]
    for v in values[1:]:
        total += v
    return total


def _expression(text: str, start: int) -> tuple[int, float]:
    """Read one number or call; return the position after it and its value."""
    match = _TOKEN.match(text, start)
    if match is None:
        msg = f"function '{text}': a number or a call is missing at its end"
        raise InputError(msg)
    name, bracket, word = match.groups()
    if bracket is not None:
        msg = f"function '{text}': found '{bracket}', expected a number or a call"
        raise InputError(msg)
    if word is not None:
        value = parse_double(word)
        if value is None:
            msg = (
                f"function '{text}': '{word}' is neither a number nor a call; functions are written as "
                "nested calls like add(2, multiply(3, %x%)), without operators"
            )
            raise InputError(msg)
        return match.end(), value
    position, arguments = _arguments(text, match.end())
    return position, _call(text, name, arguments)


def _arguments(text: str, position: int) -> tuple[int, list[float]]:
    """Read arguments up to the closing bracket."""
    arguments: list[float] = []
    empty = re.compile(r"\s*\)").match(text, position)
    if empty:
        return empty.end(), arguments
    while True:
        position, value = _expression(text, position)
        arguments.append(value)
        match = re.compile(r"\s*([,)])").match(text, position)
        if match is None:
            msg = f"function '{text}': a comma or a closing bracket is missing after '{text[:position]}'"
            raise InputError(msg)
        position = match.end()
        if match[1] == ")":
            return position, arguments


def _call(text: str, name: str, arguments: list[float]) -> float:
    """Value of a call."""
    if name not in _FUNCTIONS:
        msg = f"function '{text}': '{name}' is not known. {did_you_mean(name, _FUNCTIONS)}"
        raise InputError(msg)
    function, counts = _FUNCTIONS[name]
    if len(arguments) not in counts:
        expected = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
        msg = f"function '{text}': '{name}' takes {expected} arguments, found {len(arguments)}"
        raise InputError(msg)
    try:
        return float(function(*arguments))
    except ValueError:
        return math.nan
    except OverflowError:
        return math.inf
