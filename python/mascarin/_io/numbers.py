"""Digits of numbers for people: as many as their uncertainty, or the distance to a limit, supports.

Terminal, report and descriptions of objects take their digits from here; files keep the full numbers.
"""

from __future__ import annotations

import math
from typing import Final

_FIGURES: Final = 2
"""Significant digits of an uncertainty: at most two (JCGM 100:2008, Guide to the expression of uncertainty in
measurement, 7.2.6)."""
_MOST: Final = 15
"""Decimals that a double precision number can hold below 1."""


def decimals_for(uncertainty: float) -> int:
    """Decimals at which an uncertainty has two significant digits; negative for tens and hundreds.

    Parameters
    ----------
    uncertainty : float
        Above zero, such as the half-width of an interval.

    Returns
    -------
    int
        As the second argument of `round`.

    Examples
    --------
    >>> decimals_for(0.043), decimals_for(250.0)
    (3, -1)
    """
    size = math.floor(math.log10(uncertainty))
    # 0.0996 has the two digits 0.10.
    if round(uncertainty, _FIGURES - 1 - size) >= 10.0 ** (size + 1):
        size += 1
    return min(_MOST, _FIGURES - 1 - size)


def with_uncertainty(value: float, uncertainty: float) -> str:
    """A value with the digits that its standard uncertainty supports.

    Parameters
    ----------
    value : float
        May be NaN.
    uncertainty : float
        Two of its digits count; where it is 0 or NaN, the value has four.

    Examples
    --------
    >>> with_uncertainty(0.17701, 0.06436), with_uncertainty(2.0, 0.0)
    ('0.177', '2')
    """
    if not (uncertainty > 0.0 and math.isfinite(uncertainty)):
        return significant(value)
    return fixed(value, decimals_for(uncertainty))


def with_interval(value: float, low: float | None, high: float | None) -> tuple[str, str, str]:
    """A value and the ends of its interval, with the digits that the width of the interval supports.

    Parameters
    ----------
    value : float
        Estimate.
    low, high : float or None
        Ends of its interval; None or NaN where there is none.

    Returns
    -------
    tuple of str
        Value, low, high; the ends are empty where there is no interval. All have the same decimals.

    Examples
    --------
    >>> with_interval(24.0, 23.96, 24.043)
    ('24.000', '23.960', '24.043')
    >>> with_interval(21.4567, None, None)
    ('21.46', '', '')
    """
    if low is None or high is None or not (math.isfinite(low) and math.isfinite(high)):
        return significant(value), "", ""
    half = 0.5 * (high - low)
    if not (half > 0.0 and math.isfinite(half)):
        return significant(value), significant(low), significant(high)
    decimals = decimals_for(half)
    return fixed(value, decimals), fixed(low, decimals), fixed(high, decimals)


def beside_limit(value: float, limit: float, least: int = 2) -> tuple[str, str]:
    """A value and its limit with so many decimals that one sees on which side the value is.

    Parameters
    ----------
    value : float
        Compared by its size.
    limit : float
        Limit of the size, above zero; it is written with all its digits.
    least : int
        Fewest decimals.

    Returns
    -------
    tuple of str
        Value and limit.

    Examples
    --------
    >>> beside_limit(0.25004, 0.25)
    ('0.25004', '0.25')
    >>> beside_limit(0.3, 0.25)
    ('0.30', '0.25')
    """
    digits = repr(float(limit)).partition(".")[2] if abs(limit) < 1e15 and "e" not in repr(limit) else ""
    shown = fixed(limit, max(least, len(digits.rstrip("0")))) if digits else f"{limit:g}"
    decimals = least
    size = abs(value)
    if math.isfinite(value) and size != limit:
        # The rounded value differs from the limit and lies on the side of the value.
        while decimals < _MOST and (
            round(size, decimals) == limit or (round(size, decimals) > limit) != (size > limit)
        ):
            decimals += 1
    return fixed(value, decimals), shown


def in_percent(share: float) -> str:
    """A share in percent that is never rounded to nothing or to all. [%]

    Parameters
    ----------
    share : float
        From 0 to 1. [-]

    Examples
    --------
    >>> [in_percent(share) for share in (0.0, 0.004, 0.256, 0.999, 1.0)]
    ['0 %', '0.4 %', '25.6 %', '99.9 %', '100 %']
    >>> in_percent(0.000123), in_percent(1.0 - 1e-6)
    ('0.012 %', '99.9999 %')
    """
    percent = 100.0 * share
    if percent in (0.0, 100.0) or not math.isfinite(percent):
        return f"{percent:g} %"
    if 0.1 <= percent <= 99.9:
        return f"{percent:.3g} %" if percent >= 10.0 else f"{percent:.2g} %"
    if percent < 0.1:
        return f"{percent:.2g} %"
    return f"{100.0 - float(f'{100.0 - percent:.1g}'):.10g} %"


def significant(value: float, digits: int = 4) -> str:
    """A number with so many significant digits, without trailing zeros.

    Parameters
    ----------
    value : float
        May be NaN.
    digits : int
        Significant digits.

    Examples
    --------
    >>> significant(0.000123456), significant(2400.0)
    ('0.0001235', '2400')
    """
    return f"{value:.{digits}g}" if abs(value) < 10.0**digits or not math.isfinite(value) else f"{value:.6g}"


def fixed(value: float, decimals: int) -> str:
    """A number with so many decimals; negative ones round to tens and hundreds; never a negative zero.

    Parameters
    ----------
    value : float
        May be NaN.
    decimals : int
        As the second argument of `round`.

    Examples
    --------
    >>> fixed(-0.001, 2), fixed(2467.0, -1)
    ('0.00', '2470')
    """
    rounded = round(value, decimals) if math.isfinite(value) else value
    return f"{rounded + 0.0:.{max(0, decimals)}f}"
