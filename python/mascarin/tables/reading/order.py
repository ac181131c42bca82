"""Order of the stamps of a table: from first to last, and what changes of the clock show in it."""

from __future__ import annotations

from datetime import tzinfo
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.reading.rows import has_words
from mascarin.tables.timezones import fixed_offset, zone_name

if TYPE_CHECKING:
    import pandas as pd


def first_to_last(
    frame: pd.DataFrame, lines: Lines, where: str
) -> tuple[pd.DataFrame, Lines, tuple[str, ...]]:
    """Rows of a table that begins with the latest ones, as services write it, turned round.

    Parameters
    ----------
    frame : pandas.DataFrame
        Indexed by stamps.
    lines : ndarray, shape (n,)
        Line of each row.
    where : str
        File, for the note.

    Returns
    -------
    frame, lines
        Turned round where every stamp is before that of the row above it; otherwise as they are.
    notes : tuple of str
        What was done.
    """
    if len(frame) < 3 or frame.index.is_monotonic_increasing:
        return frame, lines, ()
    if not frame.index.is_monotonic_decreasing or not frame.index.is_unique:
        return frame, lines, ()
    return (
        frame.iloc[::-1],
        lines[::-1],
        (f"{where}: the rows begin with the latest: they were turned round.",),
    )


def clock_changes(index: pd.DatetimeIndex, where: str, zone: tzinfo) -> list[str]:
    """Sentences on the changes of the clock inside a record."""
    if zone.utcoffset(None) is not None:  # a clock that never changes
        return []
    naive = index.tz_localize(None).to_numpy()
    offset = (naive - index.tz_convert("UTC").tz_localize(None).to_numpy()) / np.timedelta64(60, "s")
    changes = [int(k) for k in np.flatnonzero(np.diff(offset))]
    return [
        f"{where}: clocks of {zone_name(zone)} go {'forward' if offset[k + 1] > offset[k] else 'back'} by "
        f"{abs(offset[k + 1] - offset[k]):g} min between {index[k]:%Y-%m-%d %H:%M} and "
        f"{index[k + 1]:%Y-%m-%d %H:%M}."
        for k in changes
    ]


def skipped_hour(index: pd.DatetimeIndex, extra: Array, where: str, zone: tzinfo) -> list[str]:
    """A warning where a single hour is missing at the time at which clocks go forward in many zones."""
    if not fixed_offset(zone):
        return []
    # On a Sunday between midnight and 4 h, in March, April, September or October.
    stamps = [
        index[row]
        for row in np.flatnonzero(extra == 3600.0).tolist()
        if (stamp := index[row + 1]).weekday() == 6 and stamp.hour <= 4 and stamp.month in (3, 4, 9, 10)
    ]
    return [
        f"{where}: warning: one hour is missing after {stamps[0]:%Y-%m-%d %H:%M}, when clocks go forward in "
        "many "
        f"zones. If the clock of the file follows daylight saving time, {zone_name(zone)} is the wrong zone: "
        "state the zone of the place, such as Europe/Paris."
        for _ in stamps[:1]
    ]


def require_order(
    frame: pd.DataFrame, gaps: Array, index: pd.DatetimeIndex, lines: Lines, where: str, zone: tzinfo
) -> None:
    """Refuse stamps that do not increase.

    Parameters
    ----------
    frame : pandas.DataFrame
        Columns beside the stamps.
    gaps : ndarray, shape (n - 1,)
        Steps. [s]
    index : pandas.DatetimeIndex
        Stamps.
    lines : ndarray, shape (n,)
        Line of each row.
    where : str
        File, for errors.
    zone : datetime.tzinfo
        Zone of the stamps.

    Raises
    ------
    InputError
        A stamp is repeated, or comes after a later one.
    """
    wrong = np.flatnonzero(gaps <= 0.0)
    if not len(wrong):
        _require_one_record(gaps, index, lines, where)
        return
    row = int(wrong[0])
    disorder = "is repeated" if gaps[row] == 0.0 else f"comes after {index[row]:%Y-%m-%d %H:%M:%S}"
    hint = "remove or sort the rows."
    series = _names_of_series(frame) if gaps[row] == 0.0 else ""
    if series:
        hint = f"column {series!r} names several series below each other: write a file for each of them."
    elif gaps[row] == -3600.0 or (gaps[row] < 0.0 and np.any(gaps == -gaps[row])):
        hint = (
            f"if the clock of the file follows daylight saving time, {zone_name(zone)} is the wrong "
            "zone: state the zone of the place, such as Europe/Paris, where the rows of the doubled hour are "
            "taken in order; otherwise remove or sort the rows."
        )
    elif _is_half_a_clock(gaps):
        hint = "the clock has 12 hours and no AM or PM: export the file with them, or with 24 hours."
    raise InputError(
        f"{where}:{lines[row + 1]}: time {index[row + 1]:%Y-%m-%d %H:%M:%S} {disorder}, expected increasing "
        f"times ({len(wrong)} such rows in all); {hint}"
    )


#: Longest gap of a record: loggers that lose their power begin again in 1970, 1980 or 2000. [s]
_LONGEST_GAP: Final = 5.0 * 365.0 * 86400.0


def _require_one_record(gaps: Array, index: pd.DatetimeIndex, lines: Lines, where: str) -> None:
    """Refuse a gap of years inside a record."""
    row = int(np.argmax(gaps)) if len(gaps) else 0
    if len(gaps) and gaps[row] > _LONGEST_GAP and gaps[row] > 100.0 * float(np.median(gaps)):
        raise InputError(
            f"{where}:{lines[row + 1]}: time {index[row + 1]:%Y-%m-%d %H:%M:%S} comes "
            f"{gaps[row] / (365.0 * 86400.0):.0f} years after {index[row]:%Y-%m-%d %H:%M:%S}, expected one "
            "record: the clock of the logger was probably not set: remove the rows on the wrong side."
        )


def _is_half_a_clock(gaps: Array) -> bool:
    """Whether the stamps go back by twelve hours, less a step, twice a day."""
    usual = float(np.median(gaps))
    return bool(np.any(np.abs(gaps[gaps < 0.0] + 12.0 * 3600.0 - usual) < 1.0))


def _names_of_series(frame: pd.DataFrame) -> str:
    """Name of the column whose words tell rows with the same stamp apart; empty where there is none."""
    if not frame.columns.is_unique:
        return ""
    for name in frame.columns:
        if has_words(frame[name]) and 1 < frame[name].nunique() <= max(2, len(frame) // 3):
            return str(name)
    return ""


def with_missing_rows(
    frame: pd.DataFrame, lines: Lines, steps_before: tuple[Lines, Array], times: pd.DatetimeIndex
) -> tuple[pd.DataFrame, Lines]:
    """Insert empty rows, of line 0, where a row is several steps after the one before it.

    Parameters
    ----------
    frame : pandas.DataFrame
        The rows, whose index is not used.
    lines : ndarray, shape (n,)
        Line of each row in its file.
    steps_before : tuple of two ndarrays
        Rows before which there is more than one step, and how many. [-]
    times : pandas.DatetimeIndex
        Times of all rows, those that are missing too.
    """
    steps = np.ones(len(frame), dtype=np.int64)
    steps[0] = 0
    rows, counts = steps_before
    steps[rows] = counts
    positions = np.cumsum(steps)
    row_at = np.full(len(times), -1, dtype=np.int64)
    row_at[positions] = np.arange(len(frame))
    all_lines = np.zeros(len(times), dtype=np.int64)
    all_lines[positions] = lines
    # Rows by their number: a search for each stamp among all others takes longer than the reading.
    frame = frame.reset_index(drop=True).reindex(row_at)
    return frame.set_axis(times, axis=0), all_lines
