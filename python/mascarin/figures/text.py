"""Numbers, units and names as a report shows them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from mascarin._io import numbers
from mascarin._io.units import shown
from mascarin.physics import law_titles

#: Kinds of the description in words.
_CHOICES = {
    **{kind: title for kind, title in law_titles("convection").items() if kind != "constant"},
    **law_titles("sky"),
    **law_titles("diffuse"),
    "text": "a formula of its own",
    "radiosity": "radiosity",
    "none": "none",
}
NONE = "–"
#: A parameter path in a longer text.
PATH = re.compile(r"[A-Za-z_][\w-]*(?:\.[\w-]+)+")
#: A DOI in a longer text.
DOI = re.compile(r"doi:\s*(10\.\d{4,9}/[^\s;,]+)")
#: Ends of parameter paths in words.
_ENDINGS = {
    ".convection.factor": ".convection factor",
    ".convection.coefficient": ".convection coefficient",
    ".law.width": ".half-width of the melting range",
    ".infiltration.constant": ".infiltration",
}
MINUS = "−"


def fixed(value: float | None, digits: int = 2, *, sign: bool = False) -> str:
    """Number with fixed decimals, a true minus sign, and a dash for nothing."""
    if value is None or not math.isfinite(value):
        return NONE
    text = f"{value:+.{digits}f}" if sign else f"{value:.{digits}f}"
    if float(text) == 0.0:
        text = text.lstrip("+-")
    return text.replace("-", MINUS)


def significant(value: float | None, digits: int = 3) -> str:
    """Number with so many significant digits, thin spaces between thousands."""
    if value is None or not math.isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -3 or size > 6:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}×10{_superscript(int(exponent))}".replace("-", MINUS)
    decimals = max(0, digits - 1 - size)
    text = f"{round(value, digits - 1 - size):,.{decimals}f}".replace(",", "\u202f")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace("-", MINUS)


def with_interval(value: float | None, low: float | None, high: float | None) -> tuple[str, str]:
    """Estimate, and its interval in words, with the digits that the interval supports."""
    if value is None or not math.isfinite(value):
        return NONE, ""
    if low is None or high is None:
        return significant(value), ""
    shown = [_typographic(number) for number in numbers.with_interval(value, low, high)]
    return shown[0], f"{shown[1]} to {shown[2]}"


def alike(values: Sequence[Any], digits: int = 3) -> list[str]:
    """Values of one kind with the same decimals; the largest has so many digits. Texts stay as they are."""
    finite = [abs(float(v)) for v in values if _is_number(v) and math.isfinite(v)]
    largest = max(finite, default=0.0)
    size = math.floor(math.log10(largest)) if largest > 0.0 else 0
    if finite and not (-3 <= size <= 6):
        return [significant(v, digits) if _is_number(v) else str(v or NONE) for v in values]
    # No more decimals than the values have.
    most = max(0, digits - 1 - size)
    decimals = next((d for d in range(most) if all(round(v, d) == round(v, most) for v in finite)), most)
    return [fixed(float(v), decimals) if _is_number(v) else str(v or NONE) for v in values]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def with_uncertainty(value: float | None, uncertainty: float | None) -> str:
    """Value with the digits that its standard uncertainty supports."""
    if value is None or not math.isfinite(value):
        return NONE
    return _typographic(numbers.with_uncertainty(value, uncertainty or 0.0))


def beside_limit(value: float | None, limit: float | None) -> tuple[str, str]:
    """Value and limit with so many decimals that one sees whether the limit is met."""
    if value is None or limit is None or not math.isfinite(value):
        return NONE, fixed(limit)
    value_text, limit_text = numbers.beside_limit(value, limit)
    return _typographic(value_text), _typographic(limit_text)


def _typographic(number: str) -> str:
    """A number with a true minus sign, and thin spaces between thousands."""
    integer_part, point, decimals = number.partition(".")
    grouped = (
        f"{int(integer_part):,}".replace(",", "\u202f")
        if integer_part.lstrip("-").isdigit()
        else integer_part
    )
    sign = "-" if integer_part.startswith("-0") else ""
    return f"{sign}{grouped}{point}{decimals}".replace("-", MINUS)


def with_unit(value: float | None, raw_unit: str, digits: int = 3) -> str:
    """Number and unit, kept on one line."""
    text, symbol = significant(value, digits), shown(raw_unit)
    if not symbol or text == NONE:
        return text
    return f"{text}{symbol}" if symbol in ("°", "%") else f"{text}\u00a0{symbol}"


def percent(value: float | None, digits: int = 1) -> str:
    """Part of one as a percentage."""
    return NONE if value is None else f"{fixed(100.0 * value, digits)}\u00a0%"


def span(values: Sequence[float]) -> str:
    """Lowest and highest of some numbers, or the one number that all are."""
    low, high = fixed(min(values)), fixed(max(values))
    return low if low == high else f"{low}–{high}"


def span_of(start: datetime, end: datetime) -> str:
    """Span of time in words; whole days by their dates."""
    full_days = start.time() == end.time() and start.hour == start.minute == 0
    if not full_days:
        return f"{day(start)} {start:%H:%M} to {day(end)} {end:%H:%M}"
    last = datetime.fromordinal(end.toordinal() - 1)
    if last.toordinal() <= start.toordinal():
        return day(start)
    if (start.year, start.month) == (last.year, last.month):
        return f"{start.day}–{day(last)}"
    return f"{day(start)} to {day(last)}"


def day(time: datetime) -> str:
    """Date without leading zero, e.g. 5 Oct 2012."""
    return f"{time.day} {time:%b %Y}"


def plain_path(path: str) -> str:
    """Last steps of a parameter path that distinguish it from others: the part, and its property."""
    for ending, words_for_it in _ENDINGS.items():
        path = path.removesuffix(ending) + words_for_it if path.endswith(ending) else path
    words = [
        w for w in path.split(".") if w not in ("constructions", "layers", "materials", "surfaces", "zones")
    ]
    return " · ".join(words).replace("_", " ")


def typeset(words: str) -> str:
    """Plain signs and units in a text by their typographic ones."""
    for plain, sign in (("<=", "≤"), (">=", "≥")):
        words = words.replace(plain, sign)
    words = re.sub(r"(?<=\d) deg\b", "°", words)
    words = re.sub(r"(?<=\d) degC\b", "\u00a0°C", words)
    words = re.sub(r"(?<=\d) (?=m[23]\b)", "\u00a0", words)
    words = re.sub(r"(?<![\w.])m[23](?!\w)", lambda match: shown(match[0]), words)
    return re.sub(r"(^|\s)-(?=\d)", rf"\1{MINUS}", words)


def choice(kind: str) -> str:
    """Kind of a model in words; unknown ones as they are."""
    return _CHOICES.get(kind, kind)


def duration(seconds: float) -> str:
    """Time a run took."""
    if seconds < 60.0:
        return f"{significant(seconds, 2)}\u00a0s"
    minutes, remaining_seconds = divmod(round(seconds), 60)
    return f"{minutes}\u00a0min {remaining_seconds}\u00a0s"


def clock(hours: float | None) -> str:
    """Hour of the day as a time, e.g. 14:30."""
    if hours is None or not math.isfinite(hours):
        return NONE
    minutes = round(60.0 * hours) % 1440
    return f"{minutes // 60}:{minutes % 60:02d}"


def _superscript(number: int) -> str:
    return str(number).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
