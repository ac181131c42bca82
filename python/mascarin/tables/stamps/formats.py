"""Forms of dates that consist of numbers, and their strptime formats."""

from __future__ import annotations

import re
from typing import Final

DATE: Final = (
    r"^(?P<a>\d{1,4})(?P<mark>[./-])(?P<b>\d{1,2})[./-](?P<c>\d{1,4})"
    r"(?:[ T,]+(?P<hour>\d{1,2})[:.](?P<minute>\d{2})(?:[:.](?P<second>\d{2}(?:[.,]\d+)?))?"
    r"\s*(?P<half>[AaPp])?\.?\s?(?:[Mm]\.?)?)?$"
)
"""Dates in any order, with a time of day of 12 or 24 hours."""
FORMATS: Final = {
    "ymd": "%Y-%m-%d", "dmy": "%d/%m/%Y", "mdy": "%m/%d/%Y",
}  # fmt: skip
"""Strptime formats of the orders of year, month and day."""


def written_format(example: str, order: str) -> str:
    """Strptime format of a stamp.

    Parameters
    ----------
    example : str
        The stamp.
    order : str
        Order of year, month and day: a key of `FORMATS`.

    Examples
    --------
    >>> written_format("11/12/20 16.00", "dmy")
    '%d/%m/%y %H.%M'
    """
    match = re.match(DATE, example)
    if match is None:
        return FORMATS[order]
    mark = match["mark"]
    year = "%Y" if max(len(match["a"]), len(match["c"])) == 4 else "%y"
    date = mark.join({"y": year, "m": "%m", "d": "%d"}[letter] for letter in order)
    if match["hour"] is None:
        return date
    between = example[match.end("hour")]
    clock = ("%I" if match["half"] else "%H") + f"{between}%M" + (f"{between}%S" if match["second"] else "")
    return f"{date} {clock}" + (" %p" if match["half"] else "")
