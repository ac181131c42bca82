from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin._io.durations import seconds_of
from mascarin.errors import InputError
from mascarin.tables.columns import Column
from mascarin.tables.reading.table import read_table
from mascarin.tables.times import epoch_seconds, stamps_of
from mascarin.tables.timezones import parse_timezone

HEADER = "time,T,G\n"


def write(folder: Path, text: str, name: str = "logger.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def rows(stamps: list[str]) -> str:
    return HEADER + "".join(f"{stamp},{k},{2 * k}\n" for k, stamp in enumerate(stamps))


def read(folder: Path, text: str, **options: Any) -> Any:
    return read_table(write(folder, text), **{"timezone": "UTC+4", **options})


def test_plain_table(tmp_path: Path) -> None:
    text = rows(["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 00:30"])
    table = read(tmp_path, text)
    assert table.interval == 900.0
    assert table.numbers("G", "test") == pytest.approx([0.0, 2.0, 4.0])
    assert table.sha256 == hashlib.sha256(text.encode()).hexdigest()
    assert list(table.lines) == [2, 3, 4]
    assert epoch_seconds(table.frame.index)[0] == pd.Timestamp("2024-09-03 20:00", tz="UTC").timestamp()
    assert table.notes[0] == (
        "logger.csv: 3 rows of 15 min, 2024-09-04 00:00 .. 2024-09-04 00:30, time zone UTC+4."
    )


@pytest.mark.parametrize("mark", [";", "\t", "|", ","])
def test_separator_is_found(tmp_path: Path, mark: str) -> None:
    text = rows(["2024-09-04 00:00", "2024-09-04 00:15"]).replace(",", mark)
    assert read(tmp_path, text).numbers("T", "test") == pytest.approx([0.0, 1.0])


def test_decimal_comma_own_format_and_two_time_columns(tmp_path: Path) -> None:
    text = "# made by hand\nday;hour;T\n04/09/2024;00:00;20,5\n04/09/2024;01:00;21,25\n"
    table = read(
        tmp_path, text, skip_lines=1, decimal=",", time=["day", "hour"], time_format="%d/%m/%Y %H:%M"
    )
    assert table.numbers("T", "test") == pytest.approx([20.5, 21.25])
    assert table.lines[0] == 3
    assert table.frame.index[1].month == 9


def test_midnight_as_24_hours(tmp_path: Path) -> None:
    table = read(tmp_path, rows(["2024-09-04 23:00", "2024-09-04 24:00", "2024-09-05 01:00"]))
    assert table.interval == 3600.0


def test_missing_rows_become_nan_and_are_said(tmp_path: Path) -> None:
    table = read(
        tmp_path, rows(["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 01:00", "2024-09-04 01:15"])
    )
    assert np.isnan(table.numbers("T", "test")).tolist() == [False, False, True, True, False, False]
    assert list(table.lines) == [2, 3, 0, 0, 4, 5]
    assert "2 rows are missing, the first after 2024-09-04 00:15" in table.notes[1]


def test_local_clock_with_daylight_saving_is_regular_in_true_time(tmp_path: Path) -> None:
    stamps = ["2024-03-31 00:00", "2024-03-31 01:00", "2024-03-31 03:00", "2024-03-31 04:00"]
    table = read(tmp_path, rows(stamps), timezone="Europe/Paris")
    assert table.interval == 3600.0
    assert len(table.frame) == 4
    assert table.notes[1] == (
        "logger.csv: clocks of Europe/Paris go forward by 60 min between 2024-03-31 01:00 and "
        "2024-03-31 03:00."
    )


def test_offsets_resolve_the_doubled_hour(tmp_path: Path) -> None:
    stamps = [
        "2024-10-27T01:00+02:00",
        "2024-10-27T02:00+02:00",
        "2024-10-27T02:00+01:00",
        "2024-10-27T03:00+01:00",
    ]
    table = read(tmp_path, rows(stamps), timezone="Europe/Paris")
    assert np.diff(epoch_seconds(table.frame.index)) == pytest.approx([3600.0] * 3)


@pytest.mark.parametrize("step", [15, 30, 60])
def test_rows_of_the_doubled_hour_are_taken_in_order(tmp_path: Path, step: int) -> None:
    """A logger on the clock of the wall writes the hour from 2 to 3 twice, one after the other."""
    true = pd.date_range("2024-10-26 22:00", periods=8 * 60 // step, freq=f"{step}min", tz="UTC")
    stamps = true.tz_convert("Europe/Paris").tz_localize(None).strftime("%Y-%m-%d %H:%M").tolist()
    assert len(set(stamps)) == len(stamps) - 60 // step
    table = read(tmp_path, rows(stamps), timezone="Europe/Paris")
    assert epoch_seconds(table.frame.index) == pytest.approx(epoch_seconds(true))
    assert any("go back by 60 min" in note for note in table.notes)


def test_the_doubled_hour_with_rows_missing_in_it(tmp_path: Path) -> None:
    stamps = [f"2024-10-27 {t}" for t in ("01:30", "02:00", "02:30", "02:30", "03:00")]
    table = read(tmp_path, rows(stamps), timezone="Europe/Paris")
    assert np.isnan(table.numbers("T", "test")).tolist() == [False, False, False, True, False, False]


@pytest.mark.parametrize("times", [("02:00", "02:00", "02:30", "02:30"), ("02:00", "02:30")])
def test_a_doubled_hour_without_order_is_refused(tmp_path: Path, times: tuple[str, ...]) -> None:
    stamps = [f"2024-10-27 {t}" for t in ("01:30", *times, "03:00")]
    with pytest.raises(InputError, match=r"has twice the local stamps .*taken in order"):
        read(tmp_path, rows(stamps), timezone="Europe/Paris")


def test_parquet_and_frames(tmp_path: Path) -> None:
    index = pd.date_range("2024-01-01", periods=4, freq="1h", tz="Europe/Paris")
    frame = pd.DataFrame({"T": [1.0, 2.0, np.nan, 4.0]}, index=index)
    frame.to_parquet(tmp_path / "logger.parquet")
    for source in (frame, tmp_path / "logger.parquet"):
        table = read_table(source, timezone="UTC")
        assert table.interval == 3600.0
        assert table.numbers("T", "test") == pytest.approx([1.0, 2.0, np.nan, 4.0], nan_ok=True)
        assert table.frame.index[0].hour == 23


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15"]),
            {"timezone": None},
            "logger.csv: timezone: a time zone is",
        ),
        (rows(["2024-09-04 00:00", "4 Sept 2024"]), {}, "logger.csv:3: time '4 Sept 2024' cannot be read"),
        (rows(["04/09/2024 00:00", "04/09/2024 00:15"]), {}, "logger.csv:2: time .*state time_format"),
        (rows(["12", "13"]), {}, "logger.csv:2: time 12 cannot be read.*state the column of the times"),
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 00:35", "2024-09-04 00:45"]),
            {},
            "logger.csv:4: the step from 2024-09-04 00:15:00 to 2024-09-04 00:35:00 is 1200 s, expected "
            "a multiple",
        ),
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 00:10", "2024-09-04 00:30"]),
            {},
            "logger.csv:4: time 2024-09-04 00:10:00 comes after 2024-09-04 00:15:00",
        ),
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 00:15"]),
            {},
            "logger.csv:4: time 2024-09-04 00:15:00 is repeated",
        ),
        (
            rows(["2024-10-27 01:00", "2024-10-27 02:00", "2024-10-27 03:00"]),
            {"timezone": "Europe/Paris"},
            "has twice the local stamps 2024-10-27 02:00",
        ),
        (
            rows([f"2024-10-27 {t}" for t in ("01:30", "02:00", "02:30", "02:00", "02:30", "03:00")]),
            {},
            "logger.csv:5: .*daylight saving.*Europe/Paris",
        ),
        (rows(["2024-09-04 00:00", "2024-09-04 00:15"]), {"step": "10min"}, "expected a multiple of 600 s"),
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15"]) + "2024-09-04 00:3",
            {},
            "logger.csv:4: the last line has 1 of 3",
        ),
        (
            "time,T\n2024-09-04 00:00,1,2\n2024-09-04 00:15,1,2\n",
            {},
            "logger.csv:2: the row has more entries",
        ),
        ("time,T\n2024-09-04 00:00,1\n2024-09-04 00:15,1,2\n", {}, "Expected 2 fields in line 3, saw 3"),
        (rows(["2024-09-04 00:00"]), {}, "found 1 rows, expected at least two"),
        ("time T\n1 2\n", {}, "no separator found"),
        (
            rows(["2024-09-04 00:00", "2024-09-04 00:15"]),
            {"time": "tim"},
            "no time column 'tim'. Did you mean 'time'",
        ),
    ],
)
def test_unusable_tables_say_where_and_what(
    tmp_path: Path, text: str, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        read(tmp_path, text, **options)


def test_entries_that_are_no_numbers_name_their_line(tmp_path: Path) -> None:
    table = read(tmp_path, "time,T\n2024-09-04 00:00,1\n2024-09-04 00:15,--\n2024-09-04 00:30,1O.5\n")
    with pytest.raises(InputError, match=r"logger.csv: column 'T', line 4: found '1O.5', expected a number"):
        table.numbers("T", "air_temperature")
    with pytest.raises(InputError, match=r"no column 't' \(wanted for air_temperature\). .*T"):
        table.numbers("t", "air_temperature")


def test_codes_for_missing_values(tmp_path: Path) -> None:
    text = "time,T\n2024-09-04 00:00,1\n2024-09-04 00:15,-999\n2024-09-04 00:30,error\n"
    values = read(tmp_path, text, missing=[-999, "error"]).numbers("T", "test")
    assert np.isnan(values).tolist() == [False, True, True]


def test_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_table(tmp_path / "none.csv", timezone="UTC")


def test_units_are_turned_into_ours() -> None:
    one = np.array([1.0])

    def turned(unit: str, wanted: str, interval: float = 3600.0) -> float:
        return float(Column("x", unit=unit).convert(one, wanted, interval, "file")[0])

    assert turned("J/cm2", "W/m2") == pytest.approx(1e4 / 3600.0)
    assert turned("kJ/m2", "W/m2", 900.0) == pytest.approx(1000.0 / 900.0)
    assert turned("Wh/m2", "W/m2", 1800.0) == pytest.approx(2.0)
    assert turned("hPa", "Pa") == 100.0
    assert turned("K", "degC") == pytest.approx(-272.15)
    assert turned("degF", "degC") == pytest.approx(-17.2222, abs=1e-4)
    assert turned("knot", "m/s") == pytest.approx(0.514444, abs=1e-6)
    assert turned("oktas", "tenths") == 1.25
    with pytest.raises(
        InputError, match="unit 'hPa' of column 'x' cannot be turned into degC; expected one of degC"
    ):
        turned("hPa", "degC")


def test_column_forms() -> None:
    assert Column.of("T", "x") == Column("T")
    assert Column.of({"column": "T", "scale": 2, "offset": 1}, "x").convert(
        np.array([3.0]), "degC", 60.0, "x"
    ) == pytest.approx([7.0])
    for wrong in ({"scale": 2}, {"column": "T", "factor": 3}, 5, {"column": "T", "kind": "sum"}):
        with pytest.raises(InputError, match="expected"):
            Column.of(wrong, "columns.air_temperature")


def test_lengths_of_time() -> None:
    assert seconds_of("15min") == 900.0
    assert seconds_of(90) == 90.0
    for wrong in ("a while", 0.0, "-1h"):
        with pytest.raises(InputError, match="step"):
            seconds_of(wrong)


def test_stamps_and_seconds_are_inverse() -> None:
    seconds = np.array([0.0, 1.5, 1.3e9 + 0.25])
    assert epoch_seconds(stamps_of(seconds, parse_timezone("Asia/Kathmandu"))) == pytest.approx(
        seconds, abs=1e-6
    )
