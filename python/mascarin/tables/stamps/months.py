"""Dates with names of months, or with signs for year, month and day, as dates of numbers."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import pandas as pd

#: Beginnings of the names of months that are not those in English: German, French, Spanish, Italian, Dutch,
#: Portuguese; accents left out.
_MONTHS: Final = {
    1: "jän jaen januar janv ene gen janu", 2: "feb fév fev fevr févr",
    3: "mär mrz maer mars marz mar maart mrt",
    4: "apr avr abr", 5: "mai may mag mei maj", 6: "juni juin jun giu", 7: "juli juil jul lug",
    8: "aug août aout ago", 9: "sep sept set", 10: "okt oct ott out", 11: "nov", 12: "dez déc dec dic",
}  # fmt: skip
_NUMBERS: Final = {word: number for number, words in _MONTHS.items() for word in words.split()}
_NAMED: Final = (
    r"^(?P<day>\d{1,2})\.?[ /-]+(?:de )?(?P<month>[^\W\d_]{3,10})\.?[ /-]+(?:de )?(?P<year>\d{4})"
    r"(?P<rest>.*)$"
)
_ENGLISH: Final = frozenset(
    ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"]
)
#: Signs behind year, month and day of Chinese and Japanese spreadsheets.
_SIGNED: Final = re.compile(r"^\d{2,4}年\d{1,2}月\d{1,2}日")


def with_numbers_of_months(written: pd.Series[Any]) -> pd.Series[Any]:
    """Stamps whose months are names of other languages than English, or signs, as numbers.

    Parameters
    ----------
    written : pandas.Series
        Texts.

    Examples
    --------
    >>> import pandas as pd
    >>> with_numbers_of_months(pd.Series(["13. Juli 2023 00:10", "1. August 2023 00:20"])).tolist()
    ['13.7.2023 00:10', '1.8.2023 00:20']
    >>> with_numbers_of_months(pd.Series(["2023年7月13日 0:10"])).tolist()
    ['2023-7-13 0:10']
    """
    if not len(written):
        return written
    first = str(written.iloc[0])
    if _SIGNED.match(first):
        plain = written.str.replace("[年月]", "-", regex=True)
        return plain.str.replace("日 *", " ", regex=True).str.strip()
    match = re.match(_NAMED, first)
    if match is None or match["month"].lower() in _ENGLISH:
        return written
    parts = written.str.extract(_NAMED)
    if parts["month"].isna().any():
        return written
    months = {name: _number_of(name) for name in parts["month"].unique().tolist()}
    if not all(months.values()):
        return written
    numbers = parts["month"].map(months).astype(str)
    return parts["day"] + "." + numbers + "." + parts["year"] + parts["rest"]


def _number_of(name: str) -> int:
    """Number of a month by the longest beginning of its name that is known; 0 for other words."""
    low = name.lower()
    return next((_NUMBERS[low[:k]] for k in range(len(low), 2, -1) if low[:k] in _NUMBERS), 0)
