"""What reading a weather file gave, kept in the cache folder of the user."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.weather import Climate, readers, shipped, sun_check
from mascarin.weather.data import cache_folder
from mascarin.weather.kept import FOLDER, MOST, Kept, kept

PLACE = (39.74, -105.18)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache."""
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
    assert len(list(folder.iterdir())) == 2  # the year, and that its clock is right
    monkeypatch.setattr(readers, "content", None)
    monkeypatch.setattr(sun_check, "SunPath", None)
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
        kept((number,), [readers], partial(Kept, {"n": number}))
    assert len(list(folder.iterdir())) == MOST


def test_it_can_be_turned_off(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")
    Climate.shipped("golden").completed()
    assert not folder.exists()
