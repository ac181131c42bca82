"""What reading a weather file gave, kept in the cache folder of the user."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin._io.sealed.cache import FOLDER, MOST, Cached, cache_folder, cached
from mascarin.errors import InputError
from mascarin.tables.reading import table
from mascarin.weather import Climate, Measurements
from mascarin.weather.checks import once, sun_check
from mascarin.weather.reading import readers, shipped

PLACE = (39.74, -105.18)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache, and a process that has checked nothing."""
    monkeypatch.setattr(once, "_SAID", {})
    monkeypatch.delenv("MASCARIN_CACHE")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    return cache_folder() / FOLDER


def same(one: Climate, other: Climate) -> bool:
    return (
        all(np.array_equal(one.record.columns[k], other.record.columns[k], equal_nan=True) for k in one.kinds)
        and (one.grid, one.site, one.provenance, one.sha256)
        == (other.grid, other.site, other.provenance, other.sha256)
        and np.array_equal(one.record.lines, other.record.lines)
    )


def test_a_file_is_read_once_and_gives_the_same(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = Climate.shipped("golden")
    first.completed()
    assert len(list(folder.iterdir())) == 3  # the year, that its clock is right, what is too bright
    monkeypatch.setattr(readers, "content", None)
    monkeypatch.setattr(sun_check, "SunPath", None)
    monkeypatch.setattr(once, "_SAID", {})  # as in another process
    again = Climate.shipped("golden")
    again.completed()
    assert same(first, again)
    # Values that are kept can be changed as those that are read.
    again.record.columns["air_temperature"][0] += 1.0
    assert same(first, Climate.shipped("golden"))


@pytest.mark.parametrize("damage", ["cut", "changed", "foreign", "empty"])
def test_a_damaged_file_is_read_anew_and_replaced(folder: Path, damage: str) -> None:
    first = Climate.shipped("golden")
    (file,) = folder.iterdir()
    good = file.read_bytes()
    middle = len(good) // 2
    flipped = good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1 :]
    file.write_bytes({"cut": good[:-9], "changed": flipped, "foreign": b"PK\3\4" * 99, "empty": b""}[damage])
    assert same(first, Climate.shipped("golden"))
    assert file.read_bytes() == good


def test_another_file_of_the_same_name_is_read(folder: Path, tmp_path: Path) -> None:
    text = shipped.content(shipped.found("shipped:golden")).decode()
    file = tmp_path / "here.epw"
    file.write_text(text, encoding="utf-8")
    before = Climate.from_epw(file)
    lines = text.splitlines()
    fields = lines[8].split(",")
    fields[6] = "33.5"
    file.write_text("\n".join([*lines[:8], ",".join(fields), *lines[9:]]), encoding="utf-8")
    after = Climate.from_epw(file)
    assert after.record.columns["air_temperature"][1] == 33.5 != before.record.columns["air_temperature"][1]


def test_what_is_refused_is_not_kept(folder: Path) -> None:
    climate = Climate.shipped("golden")
    for _ in range(2):
        with pytest.raises(InputError, match="does not follow the sun"):
            sun_check.check_clock(climate.record, PLACE[0], PLACE[1] + 60.0)


def test_a_folder_that_cannot_be_written_costs_nothing(folder: Path) -> None:
    folder.parent.mkdir(parents=True)
    folder.write_text("a file", encoding="utf-8")
    assert Climate.shipped("golden").grid.count == 8760
    assert folder.read_text(encoding="utf-8") == "a file"


def test_the_oldest_are_removed(folder: Path) -> None:
    for number in range(MOST + 3):
        cached((number,), [readers], partial(Cached, {"n": number}))
    assert len(list(folder.iterdir())) == MOST


def test_it_can_be_turned_off(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")
    Climate.shipped("golden").completed()
    assert not folder.exists()
    # In one process a record is checked once all the same; another place is another check.
    monkeypatch.setattr(sun_check, "SunPath", None)
    again = Climate.shipped("golden")
    again.completed()
    with pytest.raises(AttributeError, match="over"):
        sun_check.check_clock(again.record, PLACE[0] + 0.5, PLACE[1])


def test_its_folder_can_be_named(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", str(tmp_path / "mine"))
    first = Climate.shipped("golden")
    assert len(list((tmp_path / "mine" / FOLDER).iterdir())) == 1
    monkeypatch.setattr(readers, "content", None)
    assert same(first, Climate.shipped("golden"))
    assert not folder.exists()


ROWS = """time;T;S;G
2024-03-30 21:00;12,25;1;0
2024-03-30 22:00;12,5;2;0
2024-03-30 23:00;;3;-0,0
2024-03-31 00:00;11,125;4;0
2024-03-31 01:00;10,0;5;0,001
2024-03-31 04:00;9;6;120
"""


def alike(one: Climate | Measurements, other: Climate | Measurements) -> bool:
    """Whether all that two records hold is the same, to the bit."""

    def held(view: Climate | Measurements) -> dict[str, Any]:
        numbers = {"lines": view.record.lines, "knots": view.record.knots, **view.record.columns}
        found = {key: value.tobytes() for key, value in numbers.items() if value is not None}
        names = ("kinds", "grid", "closing", "file", "sha256", "provenance", "assumed", "site", "check_sun")
        return {**found, **{f"field {name}": repr(getattr(view.record, name, None)) for name in names}}

    first, second = held(one), held(other)
    return list(first) == list(second) and first == second


def weather(file: Path, **more: Any) -> Climate:
    options: dict[str, Any] = {
        "timezone": "Europe/Paris",
        "columns": {"air_temperature": "T", "global_horizontal": {"column": "G"}},
        "extra": ["S"],
        "absent": ["dew_point", "wind_speed", "wind_direction"],
    }
    return Climate.from_table(file, **{**options, **more})


@pytest.mark.parametrize("stamps", ["start", "end"])
def test_a_table_is_read_once_and_gives_the_same(
    folder: Path, tmp_path: Path, stamps: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "table.csv"
    file.write_text(ROWS, encoding="utf-8")
    columns = {"surface": "T", "plane": {"column": "S", "scale": 2.0, "kind": "mean"}}

    def both() -> list[Climate | Measurements]:
        measured = Measurements.from_table(file, timezone="Europe/Paris", columns=columns, stamps=stamps)
        return [weather(file, stamps=stamps), measured]

    with monkeypatch.context() as off:
        off.setenv("MASCARIN_CACHE", "off")
        without = both()
    first = both()
    assert len(list(folder.iterdir())) == 2
    monkeypatch.setattr(table, "read_frame", None)
    again = both()
    for one, other, third in zip(without, first, again, strict=True):
        assert alike(one, other)
        assert alike(one, third)


def test_other_options_or_rows_are_read_anew(folder: Path, tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text(ROWS, encoding="utf-8")
    first = weather(file)
    assert not alike(first, weather(file, stamps="end"))
    assert not alike(first, weather(file, timezone="UTC+1"))
    assert not alike(
        first, weather(file, absent={"dew_point": 3.0, "wind_speed": 1.0, "wind_direction": 0.0})
    )
    assert alike(first, weather(file, extra=(name for name in ["S"])))
    file.write_text(ROWS.replace("12,25", "12,75"), encoding="utf-8")
    assert not alike(first, weather(file))


def test_a_table_that_is_refused_is_not_kept(folder: Path, tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text(ROWS.replace("2024-03-31 00:00", "midnight"), encoding="utf-8")
    for _ in range(2):
        with pytest.raises(InputError, match=r"table\.csv:5: time 'midnight'"):
            weather(file)
    assert not folder.exists() or not list(folder.iterdir())


def test_a_large_table_is_not_kept(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mascarin._io.sealed.cache.LARGEST", 10)
    file = tmp_path / "table.csv"
    file.write_text(ROWS, encoding="utf-8")
    weather(file)
    assert not folder.exists() or not list(folder.iterdir())
