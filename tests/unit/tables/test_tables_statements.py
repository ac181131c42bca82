"""What a file says of itself: clock and units above its columns, sums, words for no value."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pandas as pd
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


UNITS_SAID = list(
    itertools.product(
        [None, "degC", "degF", "K"], [None, "degC", "degF"], [None, "degF", "K"], [None, "°C", "°F"],
        [None, "degF"],
    )
)  # fmt: skip


def test_no_statement_of_a_unit_is_silently_overruled(tmp_path: Path) -> None:
    """Name, row of units, lines above, entries and user: all alike are used, contradictions refused."""
    times = pd.date_range("2023-07-13", periods=8, freq="10min")
    warm = np.round(20.0 + 0.5 * np.arange(8), 2)
    written = {"degC": warm, "degF": warm * 1.8 + 32.0, "K": warm + 273.15}
    path = tmp_path / "units.csv"
    refused = 0
    for name, row, above, entry, user in UNITS_SAID:
        said = {name, row, above, {"°C": "degC", "°F": "degF"}.get(str(entry)), user} - {None}
        column = f"T [{name}]" if name else "T"
        ending = f" {entry}" if entry else ""
        values = written[min(map(str, said), default="degC")]
        path.write_text(
            "\n".join(
                [
                    *([f"# {column}: {above}"] if above else []),
                    f"time,{column}",
                    *([f"TS,{row}"] if row else []),
                    *(f"{t:%Y-%m-%d %H:%M},{v:.2f}{ending}" for t, v in zip(times, values, strict=True)),
                ]
            )
            + "\n"
        )
        given = {"column": column, **({"unit": user} if user else {})}
        if len(said) > 1:
            refused += 1
            with pytest.raises(InputError):
                Measurements.from_table(path, timezone="UTC", columns={"x": given})
            continue
        read = Measurements.from_table(path, timezone="UTC", columns={"x": given}).series("x")
        assert read.to_numpy() == pytest.approx(warm, abs=0.01)
    assert refused > 50


@pytest.mark.parametrize("seed", range(4))
def test_drawn_numbers_of_all_marks_are_read_or_refused(seed: int, tmp_path: Path) -> None:
    """Decimal and thousands marks, separators and sizes in any mixture: never another number."""
    rng = np.random.default_rng(seed)
    times = pd.date_range("2023-07-13", periods=30, freq="10min")
    path, right = tmp_path / "marks.csv", 0
    ranges = [(0, 1), (15, 30), (900, 1100), (0, 5000), (-20, 20), (0, 40), (100_000, 120_000)]
    for _ in range(25):
        decimal, digits = str(rng.choice([".", ","])), int(rng.choice([0, 1, 2, 3]))
        groups = str(rng.choice(["", "", ".", " ", "'", ",", "\u202f"]))
        groups = "" if groups == decimal else groups
        separator = str(rng.choice([";", "\t"] if "," in (decimal, groups) else [";", "\t", ","]))
        columns = [np.round(rng.uniform(*ranges[rng.integers(7)], 30), digits) for _ in range(2)]
        texts = [
            [f"{v:,.{digits}f}".replace(",", "G").replace(".", decimal).replace("G", groups) for v in values]
            for values in columns
        ]
        lines = [separator.join(row) for row in zip(times.strftime("%Y-%m-%d %H:%M"), *texts, strict=True)]
        path.write_text("\n".join([separator.join(["time", "A", "B"]), *lines]) + "\n", encoding="utf-8")
        for name, values in zip("AB", columns, strict=True):
            if digits == 0 and groups in (".", ",") and values.min() >= 1000.0:
                continue  # three digits behind one mark in all entries: decimals, as loggers write them
            try:
                read = Measurements.from_table(path, timezone="UTC", columns=[name]).series(name)
            except InputError:
                continue
            right += 1
            assert read.to_numpy() == pytest.approx(values, abs=1e-9), (decimal, groups, separator, digits)
    assert right > 40
