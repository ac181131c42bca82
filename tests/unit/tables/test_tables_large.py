"""Large files are read in pieces, their stamps at once: all is as if they were read line by line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin import InputError, Measurements
from mascarin.tables.reading import files
from mascarin.tables.stamps import clocks
from mascarin.tables.stamps.digit_groups import date_parts

ROWS = 20_000
"""Rows of more than one piece of pandas."""

STAMPS = pd.date_range("2022-01-01", periods=ROWS, freq="30s")
ISO = [f"{stamp:%Y-%m-%d %H:%M:%S},{k % 97 / 4:.2f},{k % 50}" for k, stamp in enumerate(STAMPS)]
EUROPEAN = [f"{stamp:%d.%m.%Y %H:%M:%S};{k % 97},{k % 10};{k % 50}" for k, stamp in enumerate(STAMPS)]
TWO = [f"{stamp:%d.%m.%Y};{stamp:%H:%M:%S};{k % 97 / 4:.2f}" for k, stamp in enumerate(STAMPS)]
AMERICAN = [
    f"{stamp.month}/{stamp.day}/{stamp.year} {(stamp.hour + 11) % 12 + 1}:{stamp:%M:%S} "
    f"{'PM' if stamp.hour > 11 else 'AM'},{k % 97 / 4:.2f}"
    for k, stamp in enumerate(STAMPS)
]  # fmt: skip


def late(rows: list[str], change: Callable[[str], str]) -> list[str]:
    """The rows with a change near their end."""
    return [*rows[:-50], change(rows[-50]), *rows[-49:]]


TABLES = {
    "plain": ("time,T,n", ISO),
    "units": ("time,T,G\n,degF,W/m2", ISO),
    "a word late": ("time,T,n", late(ISO, lambda row: row.rsplit(",", 1)[0] + ",---")),
    "no number": ("time,T,n", late(ISO, lambda row: row.rsplit(",", 1)[0] + ",abc")),
    "a blank late": ("time,T,n", late(ISO, lambda row: row.rsplit(",", 1)[0] + ", NAN")),
    "a quotation": ("time,T,n", late(ISO, lambda row: row.rsplit(",", 1)[0] + ', "3"')),
    "no time": ("time,T,n", late(ISO, lambda row: row[row.index(",") :])),
    "a wrong time": ("time,T,n", late(ISO, lambda row: "x" + row)),
    "30 February": ("time,T,n", late(ISO, lambda row: "2022-02-30" + row[10:])),
    "an offset": ("time,T,n", late(ISO, lambda row: row.replace(",", "+00:00,", 1))),
    "24:00": ("time,T,n", [row.replace("2022-01-02 00:00:00", "2022-01-01 24:00:00") for row in ISO]),
    "an entry too many": ("time,T,n", late(ISO, lambda row: row + ",3")),
    "empty rows": ("time,T,n", [*ISO[:9000], ",,", *ISO[9000:]]),
    "missing rows": ("time,T,n", [*ISO[:4000], *ISO[4100:9000], *ISO[9001:]]),
    "every other row": ("time,T,n", [*ISO[:3000], *ISO[3000::2]]),
    "twice": ("time,T,n", [*ISO[:9000], ISO[8999], *ISO[9000:]]),
    "latest first": ("time,T,n", ISO[::-1]),
    "cut": ("time,T,n", [*ISO, "2022-01-07 22:40:00"]),
    "a clock of its own": ("time,t,T", [f"{row.split(',')[0]},{row}" for row in ISO]),
    "midnight": ("date,time,T", [f"{row[:10]} 00:00:00,{row[11:24]}" for row in ISO]),
    "european": ("time;T;n", EUROPEAN),
    "two columns": ("Date;Time;T", TWO),
    "american": ("time,T", AMERICAN),
    "a wrong day": ("Date;Time;T", late(TWO, lambda row: "32" + row[2:])),
    "a wrong hour": ("Date;Time;T", late(TWO, lambda row: row.replace(";22:", ";25:"))),
    "a fraction": ("time;T;n", late(EUROPEAN, lambda row: row.replace(";", ".5;", 1))),
    "another order": ("time;T;n", late(EUROPEAN, lambda row: f"2022-01-07{row[10:]}")),
}  # fmt: skip


def result(path: Path) -> object:
    """All that a table gave, or its refusal."""
    try:
        record = Measurements.from_table(path, timezone="UTC")._record
    except InputError as error:
        return str(error)
    numbers = {name: values.tobytes() for name, values in record.columns.items()}
    return numbers, record.lines.tobytes(), record.provenance, record.kinds, record.closing, record.grid


@pytest.mark.parametrize("name", TABLES)
def test_a_large_file_is_read_as_line_by_line(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")
    head, rows = TABLES[name]
    path = tmp_path / "logger.csv"
    path.write_text("\n".join([head, *rows]) + "\n" * (name != "cut"))
    monkeypatch.setattr(files, "_LARGE", 1000)
    fast = result(path)
    monkeypatch.setattr(files, "_LARGE", 10**9)
    monkeypatch.setattr(clocks, "date_parts", lambda text: None)
    assert fast == result(path)


def test_stamps_with_the_day_first_are_read_at_once() -> None:
    """They are those of strptime; what is not of one form is left to the reader that looks at each."""
    for form in ("%d.%m.%Y %H:%M:%S", "%d/%m/%Y %H:%M", "%m/%d/%y %I:%M:%S %p", "%d-%m-%Y"):
        written = pd.Series(pd.date_range("2023-12-30", periods=4000, freq="1h").strftime(form))
        parts = date_parts(written)
        assert parts is not None
        expected = pd.to_datetime(written, format=form)
        day, month = (parts.b, parts.a) if form.startswith("%m") else (parts.a, parts.b)
        np.testing.assert_array_equal(day, expected.dt.day)
        np.testing.assert_array_equal(month, expected.dt.month)
        np.testing.assert_array_equal(parts.c % 100, expected.dt.year % 100)
        np.testing.assert_array_equal(parts.seconds, (expected - expected.dt.normalize()).dt.total_seconds())
        for wrong in (
            "",
            "2023-12-30 01:00:00",
            "1.1.2023 24:00:00",
            "1.1.2023 1:00:00 ",
            "x",
            "1.2.3.4 5:06",
        ):
            assert date_parts(pd.concat([written, pd.Series([wrong])])) is None


def test_the_stamps_of_a_large_file_are_read_with_its_numbers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No text is made of them, unless the user says how they are to be read."""
    head, rows = TABLES["plain"]
    path = tmp_path / "logger.csv"
    path.write_text("\n".join([head, *rows]))
    monkeypatch.setattr(files, "_LARGE", 1000)
    kinds = {
        name: files.read_frame(path, path.read_bytes(), None, None, None, name).frame.dtypes.iloc[0].kind
        for name in ("", "time", "other", None)
    }
    assert kinds[""] == "M"
    assert kinds["time"] == "M"
    assert kinds["other"] != "M"
    assert kinds[None] != "M"
