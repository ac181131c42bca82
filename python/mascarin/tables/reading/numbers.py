"""Numbers as files write them: decimal and thousands marks of each column, and words for no value."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines

if TYPE_CHECKING:
    import pandas as pd

EMPTY: Final = frozenset(
    {"", "na", "nan", "n/a", "null", "none", "-", "--", "---", "----", "#n/a", "#n/v", "#nv"}
    | {"err", "no data", "nodata"}
)
"""Entries that mean that there is no value; in small letters."""

CODES: Final = (-999.0, -999.9, -999.99, -6999.0, -7999.0, -9999.0, -9999.9, -99999.0, -888.88)
"""Numbers that loggers and services write where nothing was measured."""

WITH_CODE: Final = re.compile(r"[-+]\d{4},\d")
"""Values of NOAA's integrated surface data: tenths and a code of quality, such as +0180,1."""
#: Marks between groups of three digits that are never decimal: blanks of any width, apostrophes.
_GROUPS: Final = re.compile(r"(?<=\d)['\u2019\u00a0\u202f\u2009 ](?=\d{3}(?!\d))")
_NUMBER: Final = re.compile(r"[-+\u2212]?(?:\d+(?:[.,]\d*)*|[.,]\d+)(?:[eEdD][-+]?\d+)?")
#: Values from which on a number without a mark shows that there are no groups of thousands.
_GROUPED: Final = 1000.0
#: Entries of a long column that are looked at first.
_SAMPLE: Final = 10_000
#: Difference of the sizes, as a logarithm, that decides between two readings: a factor of five.
_CLEAR: Final = math.log(5.0)


def parse_numbers(
    series: pd.Series[Any],
    decimal: str,
    lines: Lines,
    where: str,
    *,
    stated: bool = False,
    evident: bool = False,
) -> Array:
    """A column as numbers, cell by cell.

    Parameters
    ----------
    series : pandas.Series
        As read: numbers, or texts.
    decimal : str
        Decimal mark of the file, for entries that could be read in two ways.
    lines : ndarray, shape (n,)
        Line of each row.
    where : str
        File and column, for errors.
    stated : bool
        Whether the user states the decimal mark.
    evident : bool
        Whether other entries of the file can have this mark alone.

    Returns
    -------
    ndarray, shape (n,)
        NaN where there is no value.

    Raises
    ------
    InputError
        An entry is no number, or infinite, or can be read in two ways.
    """
    import pandas as pd

    if pd.api.types.is_numeric_dtype(series.dtype):
        plain = series.dtype == np.float64
        values = series.to_numpy(dtype=np.float64, copy=True, **({} if plain else {"na_value": np.nan}))
    else:
        values = _of_texts(series, decimal, stated, evident, lines, where)
    infinite = np.isinf(values)
    if infinite.any():
        raise InputError(
            f"{where}, line {lines[int(np.argmax(infinite))]}: found an infinite value, expected a number; "
            "repair it, or name it in missing: ['inf', '-inf']."
        )
    return values


def _of_texts(
    series: pd.Series[Any], decimal: str, stated: bool, evident: bool, lines: Lines, where: str
) -> Array:
    import pandas as pd

    codes, uniques = pd.factorize(series)
    texts = ["" if isinstance(entry, float) and np.isnan(entry) else str(entry).strip() for entry in uniques]
    plain = [_GROUPS.sub("", text) for text in texts]
    coded = [text for text in plain if WITH_CODE.fullmatch(text)]
    if coded and len(coded) == sum(text.lower() not in EMPTY for text in plain):
        raise InputError(
            f"{where}, line {_line(series, coded[0], lines)}: found {coded[0]!r}, a number and a code of "
            "quality as in the integrated surface data of NOAA; expected one number: write the number alone "
            "in a column of its own, or get the data as hourly CSV with one value in a column."
        )
    written = [text for text in plain if _NUMBER.fullmatch(text)]
    other = "," if decimal == "." else "."
    if stated or (evident and _can_be_thousands(written, other)):
        mark, groups = decimal, other
    else:
        mark, groups = marks_of(written, decimal, lambda text: _line(series, text, lines), where)
    numbers = np.full(len(texts) + 1, np.nan)  # the last one is that of missing entries
    for k, text in enumerate(plain):
        if text.lower() in EMPTY or text.lower() in ("inf", "-inf"):
            numbers[k] = float(text) if "inf" in text.lower() else np.nan
        elif _NUMBER.fullmatch(text):
            numbers[k] = _number(text, mark, groups)
        if np.isnan(numbers[k]) and text.lower() not in EMPTY:
            bad = np.flatnonzero(codes == k)
            count = sum(int(np.sum(codes == j)) for j, other in enumerate(plain) if _is_bad(other))
            raise InputError(
                f"{where}, line {lines[int(bad[0])]}: found {texts[k]!r}, expected a number "
                f"({max(count, len(bad))} such entries); repair it, or name it in missing: [{texts[k]!r}]."
            )
    return numbers[codes]


def without_codes(values: Array) -> tuple[Array, dict[str, int]]:
    """Values without the numbers that stand for none, such as -999, and how often each was found.

    A code is one where it is below all other values by five times their range.

    Parameters
    ----------
    values : ndarray, shape (n,)
        As read, NaN where empty.

    Examples
    --------
    >>> without_codes(np.array([20.5, -999.0, 21.0]))
    (array([20.5,  nan, 21. ]), {'-999': 1})
    >>> without_codes(np.array([-1050.0, -999.0, -900.0]))[1]
    {}
    """
    lowest = float(np.nanmin(values)) if np.any(np.isfinite(values)) else 0.0
    if lowest not in CODES:
        return values, {}
    codes = np.isin(values, CODES)
    measured = values[np.isfinite(values) & ~codes]
    if not len(measured) or lowest > measured.min() - 5.0 * np.ptp(measured) or measured.min() < -300.0:
        return values, {}
    names, counts = np.unique(values[codes], return_counts=True)
    code_counts = {
        f"{name:g}": int(count) for name, count in zip(names.tolist(), counts.tolist(), strict=True)
    }
    return np.where(codes, np.nan, values), code_counts


def _is_bad(text: str) -> bool:
    return text.lower() not in EMPTY and not _NUMBER.fullmatch(text)


def _line(series: pd.Series[Any], text: str, lines: Lines) -> int:
    cleaned = series.astype(str).str.strip().str.replace(_GROUPS, "", regex=True)
    return int(lines[int(np.argmax((cleaned == text).to_numpy()))])


def _number(text: str, mark: str, groups: str) -> float:
    plain = text.replace("\u2212", "-").replace("D", "e").replace("d", "e")  # exponents of Fortran
    if groups in plain and groups:
        if not re.fullmatch(
            rf"[-+]?\d{{1,3}}(?:{re.escape(groups)}\d{{3}})+(?:{re.escape(mark)}\d*)?", plain
        ):
            return float("nan")
        plain = plain.replace(groups, "")
    try:
        return float(plain.replace(mark, "."))
    except ValueError:
        return float("nan")


def _can_be_thousands(texts: Sequence[str], mark: str) -> bool:
    """Whether a mark stands between groups of thousands in all entries that have it."""
    pattern = rf"[-+\u2212]?[1-9]\d{{0,2}}(?:{re.escape(mark)}\d{{3}})+"
    return all(re.fullmatch(pattern, text) for text in texts if mark in text)


_POINTS: Final = [
    "N",
    "NNE",
    "NE",
    "ENE",
    "E",
    "ESE",
    "SE",
    "SSE",
    "S",
    "SSW",
    "SW",
    "WSW",
    "W",
    "WNW",
    "NW",
    "NNW",
]


def points_as_degrees(series: pd.Series[Any]) -> pd.Series[Any]:
    """Points of the compass as directions; any other column as it is.

    Parameters
    ----------
    series : pandas.Series
        As read.

    Returns
    -------
    pandas.Series
        Degrees clockwise from north where every entry is one of the 16 English points, a word for no value,
        or missing. [deg]

    Examples
    --------
    >>> import pandas as pd
    >>> points_as_degrees(pd.Series(["N", "ESE", "---"])).tolist()
    [0.0, 112.5, nan]
    """
    import pandas as pd

    if pd.api.types.is_numeric_dtype(series.dtype):
        return series
    degrees = {point: 22.5 * k for k, point in enumerate(_POINTS)}
    texts = series.astype("object").where(series.notna(), "").astype(str).str.strip()
    direction_of = {text: degrees.get(text.upper()) for text in texts.unique()}
    if not any(value is not None for value in direction_of.values()):
        return series
    if any(value is None and text.lower() not in EMPTY for text, value in direction_of.items()):
        return series
    return texts.map(lambda text: np.nan if direction_of[text] is None else direction_of[text]).astype(
        np.float64
    )


def marks_of(texts: Sequence[str], decimal: str, line_of: Any, where: str) -> tuple[str, str]:
    """Decimal and thousands mark of a column, from all of its entries.

    Parameters
    ----------
    texts : sequence of str
        Entries that are numbers, without blanks and apostrophes between groups.
    decimal : str
        Decimal mark of the file.
    line_of : callable
        Line of an entry, for errors.
    where : str
        File and column, for errors.

    Returns
    -------
    (str, str)
        Decimal mark and thousands mark; the second is empty where there is none.

    Raises
    ------
    InputError
        Two readings are possible, or none.

    Examples
    --------
    >>> marks_of(["1.234,5", "998"], ".", None, ""), marks_of(["20.125", "20.250"], ".", None, "")
    ((',', '.'), ('.', ''))
    >>> marks_of(["998", "1.500"], ",", None, ""), marks_of(["0,125", "1,500"], ",", None, "")
    ((',', '.'), (',', ''))
    """
    both = [text for text in texts if "." in text and "," in text]
    if both:
        mark = "," if both[0].rfind(",") > both[0].rfind(".") else "."
        return mark, "." if mark == "," else ","
    texts_with = {mark: [text for text in texts if mark in text] for mark in ".,"}
    readings = {mark: _reading(entries, texts, mark) for mark, entries in texts_with.items() if entries}
    if not readings:
        return decimal, ""
    if len(readings) == 1:
        ((mark, reading),) = readings.items()
        other = "," if mark == "." else "."
        if reading == "thousands":
            return other, mark
        if reading == "open":
            if decimal == other:
                return other, mark
            _refuse(texts_with[mark], texts, mark, line_of, where)
        return mark, ""
    decimals = [mark for mark, reading in readings.items() if reading == "decimal"]
    if len(decimals) == 1:
        return decimals[0], "," if decimals[0] == "." else "."
    first, second = texts_with["."][0], texts_with[","][0]
    raise InputError(
        f"{where}: found {first!r} in line {line_of(first)} and {second!r} in line {line_of(second)}, whose "
        "marks contradict each other; expected one decimal mark in a column. Write the numbers of one of the "
        "two kinds anew in the file, or name them in missing."
    )


def _reading(entries: Sequence[str], texts: Sequence[str], mark: str) -> str:
    """Whether a mark is decimal, stands between thousands, or both are possible."""
    escaped = re.escape(mark)
    if any(text.count(mark) > 1 for text in entries):
        return "thousands"
    if not all(re.fullmatch(rf"[-+\u2212]?[1-9]\d{{0,2}}{escaped}\d{{3}}", text) for text in entries):
        return "decimal"
    plain = [abs(float(text)) for text in texts if re.fullmatch(r"[-+]?\d+", text) and float(text)]
    if not plain:
        return "decimal"  # three decimals in every entry are usual in loggers
    if max(plain) >= _GROUPED:
        # No groups in one entry: either the mark is decimal, or two programs wrote the column.
        return "open"
    # The values of a column are of one size: 998 beside 1.500 are thousands, 100 beside 99.876 are decimals.
    usual = float(np.median([float(re.sub(r"[^\d]", "", text)) for text in entries]))
    apart = math.log(usual / float(np.median(plain)))
    as_thousands, as_decimals = abs(apart), abs(apart - math.log(1000.0))
    if as_thousands < as_decimals - _CLEAR:
        return "thousands"
    return "decimal" if as_decimals < as_thousands - _CLEAR else "open"


def _refuse(entries: Sequence[str], texts: Sequence[str], mark: str, line_of: Any, where: str) -> None:
    plain = max((text for text in texts if mark not in text), key=len)
    raise InputError(
        f"{where}: found {entries[0]!r} in line {line_of(entries[0])} beside {plain!r} in line "
        f"{line_of(plain)}: {mark!r} can stand before decimals or between thousands; expected entries that "
        f"allow one reading. State decimal: {mark!r} where it stands before decimals, or decimal: "
        f"{'.' if mark == ',' else ','!r} where it stands between thousands."
    )


def suspicious_decimals(values: Array) -> bool:
    """Whether numbers that were read with a decimal mark could be whole numbers with groups of thousands.

    Parameters
    ----------
    values : ndarray, shape (n,)
        As read, NaN where missing.

    Returns
    -------
    bool
        There are whole numbers from 100 on, and all others are between 1 and 1000 and have at most three
        decimals.

    Examples
    --------
    >>> suspicious_decimals(np.array([998.0, 1.5, 1.523])), suspicious_decimals(np.array([0.5, 3.0]))
    (True, False)
    """
    if not np.any(np.abs(values) >= 100.0):
        return False
    # Some entries are enough to show that a long column could not.
    if len(values) > _SAMPLE and not _could_be_groups(values[:_SAMPLE]):
        return False
    magnitudes = np.abs(values[np.isfinite(values)])
    is_integer = magnitudes == np.floor(magnitudes)
    return bool(np.any(~is_integer) and np.any(magnitudes[is_integer] >= 100.0)) and _could_be_groups(values)


def _could_be_groups(values: Array) -> bool:
    """Whether all numbers with decimals are between 1 and 1000, and have at most three."""
    magnitudes = np.abs(values[np.isfinite(values)])
    parts = magnitudes[magnitudes != np.floor(magnitudes)]
    thousandths = np.abs(parts * 1e3 - np.round(parts * 1e3)) < 1e-6
    return bool(np.all((parts >= 1.0) & (parts < _GROUPED)) and np.all(thousandths))
