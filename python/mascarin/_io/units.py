"""Units as people read them: on pages, in figures and in tables for the terminal.

Files and the description keep the plain form, such as ``W/(m2 K)`` and ``degC``.
"""

from __future__ import annotations

import re
from typing import Final

_SYMBOLS: Final = {"degC": "°C", "deg": "°", "-": ""}
_POWERS: Final = str.maketrans("23", "²³")
_POWER: Final = re.compile(r"(?<=m)[23](?![0-9])")


def shown(raw: str) -> str:
    """A unit with its signs.

    Parameters
    ----------
    raw : str
        Plain form.

    Returns
    -------
    str
        The same with powers and signs; empty for the unit one.

    Examples
    --------
    >>> shown("W/(m2 K)"), shown("degC"), shown("-")
    ('W/(m² K)', '°C', '')
    """
    if raw in _SYMBOLS:
        return _SYMBOLS[raw]
    return _POWER.sub(lambda match: match[0].translate(_POWERS), raw)


def difference(raw: str) -> str:
    """Unit of a difference, with its signs: K for temperatures.

    Parameters
    ----------
    raw : str
        Plain form of the unit of the values.

    Examples
    --------
    >>> difference("degC"), difference("W/m2")
    ('K', 'W/m²')
    """
    return "K" if raw in ("degC", "°C") else shown(raw)


def bracketed(name: str, unit: str) -> str:
    """A name with its unit in brackets, for the axis of a figure or the head of a column.

    Parameters
    ----------
    name : str
        What is shown; may be empty.
    unit : str
        With its signs, from `shown` or `difference`.

    Examples
    --------
    >>> bracketed("error", "K"), bracketed("factor", "")
    ('error [K]', 'factor')
    """
    return f"{name} [{unit}]".strip() if unit else name
