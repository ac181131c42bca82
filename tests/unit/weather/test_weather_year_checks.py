"""Weather files of a year whose columns have another unit than the format fixes, or contradict each other."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from mascarin import Climate, cli
from mascarin.errors import InputError
from mascarin.weather.reading.shipped import content, found

Change = Callable[[list[str]], None]
AIR, DEW, HUMIDITY, PRESSURE, GLOBAL, WIND, COVER = 6, 7, 8, 9, 13, 21, 22


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


def scaled(factor: float, offset: float, *fields: int) -> Change:
    def change(row: list[str]) -> None:
        for field in fields:
            row[field] = f"{float(row[field]) * factor + offset:.4f}"

    return change


def written(folder: Path, change: Change) -> Path:
    lines = content(found("shipped:golden")).decode("utf-8-sig").splitlines()
    rows = [line.split(",") for line in lines[8:]]
    for row in rows:
        change(row)
    path = folder / "year.epw"
    path.write_text("\n".join([*lines[:8], *(",".join(row) for row in rows)]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("change", "back", "likely"),
    [
        (scaled(1.8, 32.0, AIR, DEW), scaled(1.0 / 1.8, -32.0 / 1.8, AIR, DEW), "degF"),
        (scaled(1.0, 273.15, AIR), scaled(1.0, -273.15, AIR), "K"),
        (scaled(0.01, 0.0, PRESSURE), scaled(100.0, 0.0, PRESSURE), "hPa"),
        (scaled(0.001, 0.0, 13, 14, 15), scaled(1000.0, 0.0, 13, 14, 15), "kW/m2"),
    ],
)
def test_values_of_another_unit_are_refused(
    change: Change, back: Change, likely: str, tmp_path: Path
) -> None:
    """The remedy, a converted column, is tried on the file."""
    path = written(tmp_path, change)
    with pytest.raises(InputError, match=rf"year\.epw: .* expected values in .* They look like {likely}"):
        Climate.from_epw(path)

    def both(row: list[str]) -> None:
        change(row)
        back(row)

    assert Climate.from_epw(written(tmp_path, both)).record.warnings == ()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (scaled(3.6, 0.0, WIND), "mean wind of 14."),
        (scaled(0.25, 0.0, 10, 11, 13, 14, 15), "brightest hour of 258 W/m2"),
        (scaled(1.0, 8.0, DEW), "dew point above the air temperature"),
        (scaled(0.01, 0.0, HUMIDITY), "relative humidity that differs by 47 %"),
    ],
)
def test_doubtful_values_are_warnings(
    change: Change, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every run with the file says them, and the command that shows it."""
    path = written(tmp_path, change)
    assert any(said in text for text in Climate.from_epw(path).record.warnings)
    assert cli.main(["weather", str(path)]) == 0
    assert said in capsys.readouterr().out


def test_a_cover_in_per_cent_is_shown_without_a_defect(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["weather", str(written(tmp_path, scaled(10.0, 0.0, COVER, 23)))]) == 0
    assert "suspicious" in capsys.readouterr().out


def test_shipped_years_have_no_doubts() -> None:
    for name in ("tampa", "tucson", "golden", "san-francisco", "washington", "chicago"):
        assert Climate.shipped(name).record.warnings == ()
