"""Ten exports of loggers, each from the raw file to a first comparison in one command."""

# ruff: noqa: E501 (commands are rows)

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from archive_files import ALL as ARCHIVES
from logger_files import ALL as LOGGERS
from logger_files import TRUE, File, write
from mascarin.cli import main
from mascarin.examples import box

PLACE = {"site.latitude": 39.74, "site.longitude": -105.18, "site.altitude": 1829.0, "site.timezone": "UTC-7"}
ZONE = ["--timezone", "UTC"]
NAMES = (
    "toa5_f.dat", "hobo_us.csv", "hobo_de.csv", "testo_de.csv", "ibutton.csv", "davis.txt", "excel_de.csv",
    "epoch.csv", "netatmo.csv", "tinytag_f.csv",
)  # fmt: skip
FILES = {file.name: file for maker in (*LOGGERS.values(), *ARCHIVES.values()) for file in maker()}


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


@pytest.fixture
def building(tmp_path: Path) -> Path:
    path = tmp_path / "box.yaml"
    box().replace(PLACE).to_yaml(path)
    return path


@pytest.mark.parametrize("name", NAMES)
def test_from_the_raw_file_to_a_comparison(
    name: str, building: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The period is that of the table, and units of the file become those of the output."""
    file: File = FILES[name]
    path = write(file, tmp_path)
    call = [
        "run",
        str(building),
        "--weather",
        "shipped:golden",
        "--measurements",
        str(path),
        "--step",
        "30min",
    ]
    assert main([*call, "--compare", f"room.air_temperature={file.column}", "--json"]) == 0
    told = capsys.readouterr()
    shown = json.loads(told.out)["comparison"]["room.air_temperature"]
    # The second day alone is whole between two midnights, or both are.
    assert shown["n"] in (49, 97)
    assert shown["measured_range"] == pytest.approx(np.ptp(TRUE), abs=0.1)
    assert file.name in told.err
    assert main([*call, "--compare", f"room.air_temperature={file.column}"]) == 0
    assert "simulated minus measured" in capsys.readouterr().out


def test_what_cannot_be_compared_is_refused(
    building: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(FILES["excel_de.csv"], tmp_path)
    call = ["run", str(building), "--weather", "shipped:golden", "--step", "1h", *ZONE]
    for more, said in (
        (["--compare", "room.air_temperature=T °C"], "name it with --measurements"),
        (["--measurements", str(path), "--compare", "room.air_temperature"], "expected OUTPUT=COLUMN"),
        (["--measurements", str(path), "--compare", "rom.air_temperature=T °C"], "Did you mean 'room.air_temperature'"),
        (["--measurements", str(path), "--compare", "room.air_temperature=T"], "no column 'T'"),
        (["--measurements", str(path), "--compare", "room.air_temperature=T °C", "--start", "2023-02-01",
          "--end", "2023-02-02"], "the table covers 2023-07-13"),
    ):  # fmt: skip
        assert main([*call, *more]) == 2
        assert said in capsys.readouterr().err
