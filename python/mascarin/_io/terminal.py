"""Text for a terminal: no name in a file can act on it."""

from __future__ import annotations

import re
from typing import Final

#: Control characters but tab and line feed; marks that change the direction of text or that nobody sees.
#: Unicode 15, chapter 23; Boucher & Anderson 2021, Trojan Source, arXiv:2111.00169.
_HIDDEN: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ufeff\ufff9-\ufffb"
    "\ud800-\udfff"  # parts of names that are not UTF-8
    "\U000e0000-\U000e007f]"
)


def printable(text: str) -> str:
    r"""Text with its control characters and hidden marks in the form ``\u001b``.

    The form is that of JSON, so that a JSON text still says the same.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    str
        Text that a terminal shows as it is.

    Examples
    --------
    >>> printable("room\x1b[31m")
    'room\\u001b[31m'
    """
    return _HIDDEN.sub(_escaped, text)


def _escaped(match: re.Match[str]) -> str:
    units = match[0].encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[k]:02x}{units[k + 1]:02x}" for k in range(0, len(units), 2))
