"""Measured tables on the command line: as weather, as boundary conditions, and from a study."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import mascarin as mc
from mascarin import cli
from study_support import BUILDING, STUDY, Bench, logger_table

ABSENT = ("wind_speed", "wind_direction", "dew_point", "radiation")


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


def expected(bench: Bench) -> dict[str, Any]:
    """The same run in Python."""
    climate = mc.Climate.from_table(
        bench.table, timezone="UTC+1", columns={"air_temperature": "air"}, absent=ABSENT, latitude=45.0,
        longitude=5.0, altitude=200.0,
    )  # fmt: skip
    measured = mc.Measurements.from_table(bench.table, timezone="UTC+1")
    results = mc.simulate(
        mc.load(bench.building), climate, measurements=measured, step="30min", end="2023-03-04",
        outputs=["core.temperature"],
    )  # fmt: skip
    return {"mean": float(results["core.temperature"].mean())}


def run(
    bench: Bench, capsys: pytest.CaptureFixture[str], *words: str, end: str = "2023-03-04"
) -> dict[str, Any]:
    code = cli.main(
        ["run", str(bench.building), *words, "--step", "30min", "--end", end, "--output",
         "core.temperature", "--json"]
    )  # fmt: skip
    printed = capsys.readouterr()
    assert code == 0, printed.err
    found: dict[str, Any] = json.loads(printed.out)["outputs"]["core.temperature"]
    return found


def columns() -> list[str]:
    pairs = ["air_temperature=air", *(f"{name}=none" for name in ABSENT)]
    return [word for pair in pairs for word in ("--column", pair)]


def test_a_table_as_weather_and_boundary(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    found = run(bench, capsys, "--weather", str(bench.table), *columns())
    assert found["mean"] == expected(bench)["mean"]


def test_two_tables_with_their_zone_and_unit(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    whole = pd.read_csv(bench.table, index_col=0, parse_dates=True)
    kelvin = (whole[["air"]] + 273.15).rename(columns={"air": "air (out)"})
    kelvin.index = pd.DatetimeIndex(kelvin.index) - pd.Timedelta(hours=1)
    kelvin.to_csv(bench.folder / "weather.csv", sep=";", decimal=",")
    local = pd.DatetimeIndex(whole.index)
    whole.index = local - pd.Timedelta(hours=1)
    whole.to_csv(bench.table)
    words = [word.replace("=air", "=air (out) [K]") for word in columns()]
    found = run(
        bench, capsys, "--weather", str(bench.folder / "weather.csv"), "--measurements", str(bench.table),
        "--timezone", "UTC", *words, end="2023-03-03 23:00",
    )  # fmt: skip
    whole.index = local
    whole.to_csv(bench.table)
    assert found["mean"] == pytest.approx(expected(bench)["mean"], abs=1e-9)


def test_a_study_gives_weather_and_measurements(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(bench, capsys, "--weather", str(bench.study))["mean"] == expected(bench)["mean"]


def test_a_file_with_the_two_keys_gives_them_too(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    text = STUDY[STUDY.index("climate:") : STUDY.index("measurements:")]
    (bench.folder / "inputs.yaml").write_text(text, encoding="utf-8")
    assert run(bench, capsys, "--weather", str(bench.folder / "inputs.yaml")) == run(
        bench, capsys, "--weather", str(bench.study)
    )


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--column", "air_temperature"], "--column: found 'air_temperature'; expected CHANNEL=COLUMN"),
        (
            [*columns()[2:], "--column", "air_temperature=ari"],
            "no column 'ari' (wanted for air_temperature). Did you mean 'air'",
        ),
        (["--column", "air_temperature=air"], "no column for dew_point"),
        (["--column", "air_temperature=air"], "CHANNEL=none"),
        (["--column", "air_temprature=air"], "'air_temprature' is no climate channel"),
        ([], "with --column"),
    ],
)
def test_what_is_wrong_is_said(
    bench: Bench, words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["run", str(bench.building), "--weather", str(bench.table), *words]) == 2
    assert says in capsys.readouterr().err


def test_measured_boundaries_without_a_table(
    bench: Bench, data_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weather = data_dir / "bestest" / "725650TYCST.epw"
    assert cli.main(["run", str(bench.building), "--weather", str(weather)]) == 2
    assert "--measurements: not given; expected a table with the measured columns" in capsys.readouterr().err


def test_the_outputs_of_a_building_are_listed(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["outputs", str(bench.building), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in rows] == [output.name for output in mc.load(bench.building).outputs()]
    assert cli.main(["outputs", str(bench.building), "wall.insulation_brick*"]) == 0
    out = capsys.readouterr().out
    assert "wall.interface_1_temperature" in out
    assert "wall.insulation_brick_temperature" in out
    assert cli.main(["outputs", str(bench.building), "wal.*"]) == 2
    assert "found no output that fits wal.*" in capsys.readouterr().err


def test_an_unknown_output_says_what_there_is(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--weather", str(bench.study), "--output", "wall.heat"]
    assert cli.main(["run", str(bench.building), *words]) == 2
    said = capsys.readouterr().err
    assert "'mascarin outputs' lists" in said
    assert "wall.outside_temperature" in said
