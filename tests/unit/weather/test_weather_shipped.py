"""Shipped climates, morphing, EPW writing, and the command that shows a weather file."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.physics import humidity_of_dew_point
from mascarin.weather import SHIPPED, MonthlyChanges, morphed, overview, write_epw
from mascarin.weather.reading.shipped import content


@pytest.fixture(scope="module")
def tampa() -> mc.Climate:
    return mc.Climate.shipped("tampa")


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_file_is_the_published_one(name: str) -> None:
    one = SHIPPED[name]
    assert hashlib.sha256(content(one.path)).hexdigest() == one.sha256


def test_a_shipped_climate_is_the_file_it_was_made_from(tampa: mc.Climate, data_dir: Path) -> None:
    there = mc.Climate.from_epw(data_dir / "weather" / SHIPPED["tampa"].file)
    assert tampa.sha256 == there.sha256
    assert tampa.file == there.file
    assert tampa.grid.periodic
    np.testing.assert_array_equal(tampa.data.to_numpy(), there.data.to_numpy())


def test_months_and_degree_days_are_sums_of_the_file(tampa: mc.Climate) -> None:
    found = overview(tampa, heating_base=18.0, cooling_base=24.0)
    daily = tampa.data["air_temperature"].to_numpy().reshape(365, 24).mean(axis=1)
    assert found.heating_degree_days == pytest.approx(np.maximum(18.0 - daily, 0.0).sum())
    assert found.cooling_degree_days == pytest.approx(np.maximum(daily - 24.0, 0.0).sum())
    january = tampa.data["global_horizontal"].to_numpy()[: 31 * 24].sum() / 1000.0
    assert found.months["global, horizontal [kWh/m2]"].iloc[0] == pytest.approx(january)
    assert len(found.months) == 12


def test_morphing_gives_the_changes_that_were_asked_for(tampa: mc.Climate) -> None:
    changes = MonthlyChanges(
        temperature=[1.0 + 0.1 * m for m in range(12)], daily_maximum=3.0, daily_minimum=1.0, radiation=5.0,
        wind_speed=-10.0,
    )  # fmt: skip
    warmer = morphed(tampa, changes)
    before, after = tampa.data, warmer.data
    month = np.asarray(before.index.month)  # type: ignore[attr-defined]
    shift = (after["air_temperature"] - before["air_temperature"]).groupby(month).mean()
    np.testing.assert_allclose(shift, [1.0 + 0.1 * m for m in range(12)], atol=1e-9)

    def ranges(data: np.ndarray) -> np.ndarray:
        cells = data.reshape(365, 24)
        return np.asarray(cells.max(axis=1) - cells.min(axis=1))

    wider = ranges(after["air_temperature"].to_numpy()) - ranges(before["air_temperature"].to_numpy())
    july = month[::24] == 7
    assert wider[july].mean() == pytest.approx(2.0)  # 3 K at the maximum less 1 K at the minimum
    np.testing.assert_allclose(after["global_horizontal"], 1.05 * before["global_horizontal"])
    np.testing.assert_allclose(after["wind_speed"], 0.9 * before["wind_speed"])
    kept, warmed = (humidity_of_dew_point(d["air_temperature"], d["dew_point"]) for d in (before, after))
    np.testing.assert_allclose(warmed, kept, atol=1e-6)  # the relative humidity stays
    assert after["infrared"].mean() > before["infrared"].mean()
    assert "Belcher" in warmer.provenance[-1]
    assert warmer.sha256 is None


def test_a_written_epw_is_read_back(tampa: mc.Climate, tmp_path: Path) -> None:
    warmer = morphed(tampa, {"temperature": 2.0})
    write_epw(warmer, tmp_path / "warm.epw")
    again = mc.Climate.from_epw(tmp_path / "warm.epw")
    assert again.grid.periodic
    assert again.timezone == warmer.timezone
    for name, digits in (("air_temperature", 0.006), ("dew_point", 0.006), ("global_horizontal", 0.06)):
        np.testing.assert_allclose(again.data[name], warmer.data[name], atol=digits)
    assert again.site is not None
    assert again.site.altitude == 6.0


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("month,temprature\n" + "\n".join(f"{m},1" for m in range(1, 13)), "Did you mean 'temperature'"),
        ("month,temperature\n1,2\n2,2\n", "each month from 1 to 12 once"),
        ("month,temperature\n" + "\n".join(f"{m},290" for m in range(1, 13)), "from -20 to 20 K"),
        ("month,daily_maximum\n" + "\n".join(f"{m},2" for m in range(1, 13)), "expected both"),
        ("month,temperature\n" + "\n".join(f"{m},warm" for m in range(1, 13)), "could not convert"),
    ],
)
def test_changes_that_cannot_be_used_are_refused(
    table: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "changes.csv").write_text(table)
    assert cli.main(["weather", "shipped:tampa", "--morph", str(tmp_path / "changes.csv")]) == 2
    assert said in capsys.readouterr().err


def test_the_command_shows_checks_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["weather", "shipped:golden", "--json", "-o", str(tmp_path / "w")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["file"] == SHIPPED["golden"].file
    assert len(found["months"]) == 12
    assert found["heating_degree_days"]["sum"] > 2000.0
    zones = found["outdoor_hours_in_givoni_zones"]
    assert zones["2 m/s"]["comfortable"] >= zones["0.2 m/s"]["comfortable"]
    names = {path.name for path in (tmp_path / "w").iterdir()}
    assert {"comfort_chart.svg", "air_temperature_carpet.svg", "months.csv"} <= names


def test_gaps_and_stuck_values_are_shown(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = (data_dir / "weather" / SHIPPED["tampa"].file).read_text().splitlines()
    for row in range(3000, 3100):
        fields = lines[row].split(",")
        fields[6] = "31.7"
        lines[row] = ",".join(fields)
    for row in range(5000, 5010):
        fields = lines[row].split(",")
        fields[9] = "999999"
        lines[row] = ",".join(fields)
    (tmp_path / "bad.epw").write_text("\n".join(lines) + "\n")
    assert cli.main(["weather", str(tmp_path / "bad.epw")]) == 0
    out = capsys.readouterr().out
    assert "stuck at 31.7" in out
    assert "10 values missing" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["tampa"], "expected shipped:tampa"),
        (["shipped:tampaa"], "Did you mean 'tampa'"),
        (["no.epw"], "no such file"),
        (["shipped:tampa", "--epw", "out.txt"], "ending in .epw"),
        (["shipped:tampa", "--morph", "no.csv"], "no such file"),
        (["-o", "folder"], "found no weather file"),
    ],
)
def test_weather_that_is_not_there_is_refused(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["weather", *words]) == 2
    assert said in capsys.readouterr().err


def test_the_list_names_every_shipped_climate(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["weather"]) == 0
    out = capsys.readouterr().out
    assert all(f"shipped:{name}" in out for name in SHIPPED)
