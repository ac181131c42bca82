"""What a file says of itself: clock and units above its columns, sums, words for no value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mascarin import Measurements
from mascarin.errors import InputError

ROWS = [
    f"2024-07-01 {k // 4:02d}:{15 * (k % 4):02d},{50.0 + 0.5 * k},{0.25 * (1 + k % 3)}" for k in range(48)
]


def written(folder: Path, head: list[str], rows: list[str] = ROWS, name: str = "logger.csv") -> Path:
    path = folder / name
    path.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")
    return path


def test_units_above_the_names_are_used_and_contradictions_refused(tmp_path: Path) -> None:
    path = written(tmp_path, ["Station: A", "AirT: Deg F", "time,AirT,Heat"])
    read = Measurements.from_table(path, timezone="UTC")
    assert read.series("AirT").iloc[0] == pytest.approx(10.0)
    assert "degF (line 2 above the names) converted to degC" in read.record.origins["AirT"].line
    with pytest.raises(InputError, match="line 2 above the names says 'Deg F'"):
        Measurements.from_table(path, timezone="UTC", columns={"AirT": {"column": "AirT", "unit": "K"}})
    forced = {"AirT": {"column": "AirT", "unit": "degC", "overrule": True}}
    assert Measurements.from_table(path, timezone="UTC", columns=forced).series("AirT").iloc[0] == 50.0


@pytest.mark.parametrize(
    ("head", "hour"),
    [
        (["Time zone: GMT-05:00", "time,AirT,Heat"], 5),
        (["Logger 7, clock in UTC", "time,AirT,Heat"], None),
        (["Timezone;UTC", "time,AirT,Heat"], 0),
        (["time(UTC),AirT,Heat"], 0),
    ],
)
def test_the_clock_above_the_names_is_used(tmp_path: Path, head: list[str], hour: int | None) -> None:
    path = written(tmp_path, head)
    if hour is None:  # no line about a time zone: the user has to state it
        with pytest.raises(InputError, match="timezone"):
            Measurements.from_table(path)
        return
    read = Measurements.from_table(path)
    assert read.index[0].tz_convert("UTC").hour == hour
    turned = Measurements.from_table(path, timezone="America/New_York" if hour else "Europe/Paris")
    assert turned.grid.start == read.grid.start
    if hour:
        with pytest.raises(InputError, match=r"Europe/Paris, but line 1, 'GMT-05:00', says UTC-5"):
            Measurements.from_table(path, timezone="Europe/Paris")


def test_heat_of_an_interval_is_a_mean_power(tmp_path: Path) -> None:
    path = written(tmp_path, ["time,AirT,Heat [kWh]"])
    read = Measurements.from_table(path, timezone="UTC")
    assert read.series("Heat [kWh]").iloc[0] == pytest.approx(1000.0)  # 0.25 kWh in 15 min
    assert read.kinds["Heat [kWh]"] == "mean"
    assert read.kinds["AirT"] == "instant"
    sums = written(tmp_path, ["time,AirT,G (kJ/m2)"], name="sums.csv")
    sun = Measurements.from_table(sums, timezone="UTC", stamps="end")
    assert sun.series("G (kJ/m2)").iloc[0] == pytest.approx(250.0 / 900.0)
    assert sun.kinds["G (kJ/m2)"] == "mean"


def test_the_total_of_a_meter_is_no_heat_of_intervals(tmp_path: Path) -> None:
    rows = [f"2024-07-01 {k // 4:02d}:{15 * (k % 4):02d},20.0,{1200.0 + 0.1 * k:.1f}" for k in range(48)]
    read = Measurements.from_table(written(tmp_path, ["time,AirT,Heat [kWh]"], rows), timezone="UTC")
    assert np.ptp(read.series("Heat [kWh]").to_numpy()) == pytest.approx(4.7)
    assert "the total of a meter in kWh" in read.record.origins["Heat [kWh]"].line
    assert read.record.origins["Heat [kWh]"].unit == "kWh"


def test_words_for_no_value_are_counted_by_column(tmp_path: Path) -> None:
    rows = list(ROWS)
    for k, word in ((3, "---"), (4, "---"), (5, "Err"), (6, "")):
        rows[k] = ",".join([*rows[k].split(",")[:1], word, "0.5"])
    read = Measurements.from_table(written(tmp_path, ["time,AirT,Heat"], rows), timezone="UTC")
    assert "4 missing (2 '---', 1 'Err')" in read.record.origins["AirT"].line
    assert read.record.origins["Heat"].line.endswith("0 missing.")
