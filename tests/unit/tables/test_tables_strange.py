"""Strange files are read rightly, or refused with a remedy that works on the file; never read wrongly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import Measurements
from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from strange_files import FILES, TIMES, WARM, Strange


def _judge(file: Strange, path: Path, options: dict[str, Any], column: str) -> None:
    given = {"columns": [column], **options}
    series = Measurements.from_table(path, timezone=file.zone, **given).series(column)
    values, tolerance = file.columns[column]
    truth = dict(zip(epoch_seconds(file.times.tz_localize("UTC")).tolist(), values.tolist(), strict=True))
    expected = np.array([truth.get(second, np.inf) for second in epoch_seconds(series.index).tolist()])  # type: ignore[arg-type]
    assert np.array_equal(
        np.isnan(series.to_numpy()) & np.isfinite(expected), np.zeros(len(series), bool)
    ) or ("missing" in options)
    there = np.isfinite(series.to_numpy())
    assert there.sum() > 40
    assert series.to_numpy()[there] == pytest.approx(expected[there], abs=tolerance)


@pytest.mark.parametrize("name", FILES)
def test_a_strange_file_is_read_or_refused(name: str, tmp_path: Path) -> None:
    file, path = FILES[name], tmp_path / name
    path.write_bytes(file.content)
    for column in file.columns:
        if not file.refused:
            _judge(file, path, file.options, column)
            continue
        with pytest.raises(InputError) as refusal:
            Measurements.from_table(path, timezone=file.zone, columns=[column], **file.options)
        text = str(refusal.value)
        assert file.refused in text
        assert name in text
        assert "expected" in text
        assert file.remedy is not None
        content, options = file.remedy(file.content, file.options)
        mended = tmp_path / f"mended_{name}"
        mended.write_bytes(content)
        _judge(file, mended, options, column)


def test_a_lettered_sensor_has_no_unit(tmp_path: Path) -> None:
    """Beside temp_A to temp_E, temp_F is a sensor; alone it is in degF."""
    path = tmp_path / "rooms.csv"
    letters = "ABCDEF"
    path.write_text(
        "time," + ",".join(f"temp_{letter}" for letter in letters) + "\n"
        + "".join(f"2023-07-13 {hour:02d}:00,{','.join(['20.5'] * 6)}\n" for hour in range(6))
    )  # fmt: skip
    read = Measurements.from_table(path, timezone="UTC")
    assert all(read.series(f"temp_{letter}").iloc[0] == 20.5 for letter in letters)
    path.write_text("time,temp_F\n" + "".join(f"2023-07-13 {hour:02d}:00,68\n" for hour in range(6)))
    assert Measurements.from_table(path, timezone="UTC").series("temp_F").iloc[0] == pytest.approx(20.0)


def test_numbers_below_the_others_are_no_codes(tmp_path: Path) -> None:
    """A power that runs down to -999 W has this value."""
    path = tmp_path / "power.csv"
    path.write_text(
        "time,P (W)\n" + "".join(f"2023-07-13 {k:02d}:00,{-800 - 199 * k // 6}\n" for k in range(7))
    )
    assert Measurements.from_table(path, timezone="UTC").series("P (W)").iloc[-1] == -999.0


def test_cells_of_a_workbook(tmp_path: Path) -> None:
    """Remarks on a sheet of their own, dates and times in two columns."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["remarks"])
    sheet = book.create_sheet("Data")
    sheet.append(["Date", "Time", "T [°C]"])
    for stamp, value in zip(TIMES, WARM, strict=True):
        sheet.append([stamp.date(), stamp.time(), float(value)])
    book.save(tmp_path / "book.xlsx")
    read = Measurements.from_table(tmp_path / "book.xlsx", timezone="UTC")
    assert read.series("T [°C]").to_numpy() == pytest.approx(WARM)
    index = pd.DatetimeIndex(read.series("T [°C]").index)
    assert epoch_seconds(index).tolist() == epoch_seconds(TIMES.tz_localize("UTC")).tolist()


def test_a_name_above_two_columns_is_said(tmp_path: Path) -> None:
    path = tmp_path / "twice.csv"
    path.write_text("time,T,T\n" + "".join(f"2023-07-13 {k:02d}:00,{20 + k},{30 + k}\n" for k in range(6)))
    read = Measurements.from_table(path, timezone="UTC")
    assert (read.series("T").iloc[0], read.series("T.1").iloc[0]) == (20.0, 30.0)
    assert any("the second one is called 'T.1'" in note for note in read.provenance)
