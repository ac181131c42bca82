"""Annotated CSV of InfluxDB, as its page, its command line and a pivoted query write it."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from mascarin import Measurements
from mascarin.errors import InputError

RANGE = "2024-01-01T00:00:00Z,2024-01-02T00:00:00Z"
HEAD = (
    "#group,false,false,true,true,false,false,true,true,true\n"
    "#datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,double,string,string,string\n"
    "#default,_result,,,,,,,,\n"
)
NAMES = ",result,table,_start,_stop,_time,_value,_field,_measurement,sensor\n"
TIMES = [f"2024-01-01T00:{minute:02d}:00Z" for minute in range(0, 60, 10)]


def block(table: int, field: str, sensor: str, first: float, *, head: str = HEAD) -> str:
    rows = [f",,{table},{RANGE},{t},{first + k},{field},lab,{sensor}" for k, t in enumerate(TIMES)]
    return head + NAMES + "\n".join(rows) + "\n"


@pytest.mark.parametrize("head", [HEAD, ""])
def test_a_column_for_each_series(head: str, tmp_path: Path) -> None:
    blocks = [
        block(0, "temperature_degF", "attic", 50.0, head=head),
        block(1, "temperature_degF", "room", 70.0, head=head),
        block(2, "humidity", "room", 40.0, head=head),
    ]
    file = tmp_path / "export.csv"
    file.write_text("\n".join(blocks), encoding="utf-8")
    read = Measurements.from_table(file, timezone="UTC")
    assert sorted(read.data.columns) == ["attic temperature_degF", "humidity", "room temperature_degF"]
    assert read.grid.interval == 600.0
    # The unit in the name of the field is used.
    attic = read.series("attic temperature_degF")
    assert attic.iloc[0] == pytest.approx(10.0)
    assert attic.index[1] == pd.Timestamp("2024-01-01 00:10", tz="UTC")


def test_after_a_pivot(tmp_path: Path) -> None:
    rows = [f",,0,{t},lab,{20 + k},{40 + k}" for k, t in enumerate(TIMES)]
    head = ",result,table,_time,_measurement,temperature,humidity\n"
    file = tmp_path / "export.csv"
    file.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    read = Measurements.from_table(file, timezone="UTC")
    assert read.series("temperature").tolist() == [20, 21, 22, 23, 24, 25]
    assert read.series("humidity").iloc[-1] == 45


def test_what_cannot_be_a_series_is_refused_by_line(tmp_path: Path) -> None:
    text = block(0, "temperature", "room", 20.0)
    twice = text + text.splitlines()[-1].replace("25.0", "26.0") + "\n"
    cases = {
        twice: r"export.csv:11: found a second value of 'temperature' at 2024-01-01T00:50:00Z",
        text.replace("_time", "when"): r"export.csv:4: found the columns .*expected '_time'",
        HEAD + NAMES: "without values",
    }
    for content, said in cases.items():
        (tmp_path / "export.csv").write_text(content, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            Measurements.from_table(tmp_path / "export.csv", timezone="UTC")
