"""Tables of a study: settings said once, and suspicious values left out by default."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin import Study, cli
from mascarin.errors import InputError
from study_support import BUILDING, STUDY, Bench, logger_table

MEASURED = "measurements:\n  table: logger.csv\n  timezone: UTC+1\n"


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("table")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return folder / "logger.csv"


@pytest.fixture
def bench(tmp_path: Path, table: Path) -> Bench:
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    shutil.copy(table, tmp_path / "logger.csv")
    return Bench(tmp_path)


@pytest.mark.parametrize(
    "measured", ["", "measurements:\n", "measurements: {}\n", "measurements: {table: logger.csv}\n"]
)
def test_one_table_is_described_once(bench: Bench, measured: str) -> None:
    bench.edit("    table: logger.csv\n    timezone", "    table: logger.csv\n    stamps: end\n    timezone")
    bench.edit(MEASURED, MEASURED + "  stamps: end\n")
    both = Study(bench.study)
    bench.edit(MEASURED + "  stamps: end\n", measured)
    once = Study(bench.study)
    pd.testing.assert_frame_equal(once.measurements.data, both.measurements.data)
    assert once.context.inputs.file_plan.measurements.stamps == "end"


def test_what_the_measurements_say_holds_for_the_weather(bench: Bench) -> None:
    bench.edit("    table: logger.csv\n    timezone: UTC+1\n    columns", "    columns")
    assert Study(bench.study).climate.timezone == "UTC+1"


def test_two_tables_share_nothing(bench: Bench) -> None:
    shutil.copy(bench.table, bench.folder / "other.csv")
    bench.edit(MEASURED, "measurements: {table: other.csv}\n")
    with pytest.raises(InputError, match=r"study.yaml:\d+: measurements.timezone"):
        Study(bench.study)


def test_an_own_value_is_kept_and_compared(bench: Bench) -> None:
    bench.edit(MEASURED, "measurements: {timezone: UTC+2}\n")
    with pytest.raises(InputError, match=r"found UTC\+2, but the climate reads the same table with timezone"):
        Study(bench.study)


def stuck(bench: Bench, first: int, last: int) -> None:
    found = pd.read_csv(bench.table)
    found.loc[first:last, "core"] = float(found["core"].iloc[first])
    found.to_csv(bench.table, index=False)


def test_a_stuck_part_of_a_sensor_is_left_out_by_default(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    bench.edit("quality: {mask: [stuck]}\n", "")
    stuck(bench, 300, 400)
    study = Study(bench.study)
    assert np.flatnonzero(study.measurements.data["core"].isna().to_numpy()).tolist() == list(range(301, 401))
    assert cli.main(["validate", str(bench.study)]) in (0, 1)
    said = capsys.readouterr().err
    assert "core: stuck from 2023-03-03 02:10" in said
    assert "left out of all comparisons" in said


def test_nothing_is_left_out_on_request(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.edit("mask: [stuck]", "mask: []")
    stuck(bench, 300, 400)
    assert not Study(bench.study).measurements.data["core"].isna().any()
    assert cli.main(["validate", str(bench.study)]) in (0, 1)
    said = capsys.readouterr().err
    assert "core: stuck" in said
    assert "left out" not in said


def test_a_sensor_that_is_stuck_most_of_the_time_is_refused_by_default(bench: Bench) -> None:
    bench.edit("quality: {mask: [stuck]}\n", "")
    stuck(bench, 100, 800)
    with pytest.raises(InputError, match=r"over most of the identification.*mask: \[stuck\]"):
        Study(bench.study)


def test_a_warning_about_the_clock_is_on_the_terminal(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    found = pd.read_csv(bench.table, index_col=0, parse_dates=True)
    found.index = found.index + pd.Timedelta(days=24)  # 25 March on; clocks go forward on the 26th
    found = found[(found.index < "2023-03-26 02:00") | (found.index >= "2023-03-26 03:00")]
    found.to_csv(bench.table)
    bench.edit("    table: logger.csv\n", "    table: logger.csv\n    fill_gaps: 2h\n")
    bench.edit(MEASURED, MEASURED + "  fill_gaps: 2h\n")
    text = bench.study.read_text(encoding="utf-8")
    for day, later in {"03-01": "03-25", "03-02": "03-26", "03-06": "03-30", "03-08": "04-01"}.items():
        text = text.replace(f"2023-{day} ", f"2023-{later} ")
    bench.study.write_text(text, encoding="utf-8")
    cli.main(["validate", str(bench.study)])
    assert "warning: one hour is missing after 2023-03-26 01:50" in capsys.readouterr().err
