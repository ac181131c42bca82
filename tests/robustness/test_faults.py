"""Inputs that broke an earlier version, where the folder ``faults`` is beside the data."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from conftest import DATA, unavailable

from mascarin.cli import main


@pytest.fixture(scope="module")
def faults(data_dir: Path) -> Path:
    """The folder of these inputs; tests of similar ones are in test_refusals."""
    folder = data_dir.parent / "faults"
    if not folder.is_dir():
        unavailable(f"no folder {folder}", DATA)
    return folder


def test_a_damaged_weather_file(faults: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "room.yaml").write_text(
        (faults / "nan_min.yaml").read_text(encoding="utf-8"), encoding="utf-8"
    )
    shutil.copyfile(faults / "tmy-c84161d2.bin", tmp_path / "site.csv")
    words = ["run", str(tmp_path / "room.yaml"), "--weather", str(tmp_path / "site.csv")]
    assert main(words) == 2
    assert "site.csv:" in capsys.readouterr().err


def test_a_damaged_measured_table(faults: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from mascarin.errors import InputError
    from mascarin.weather import Measurements

    with pytest.raises(InputError, match=r"csv_min\.csv:\d+: .* expected"):
        Measurements.from_table(faults / "csv_min.csv", timezone="UTC")


def test_a_damaged_calorimeter_file(faults: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["dsc", str(faults / "dsc_min.csv")]) == 2
    assert "dsc_min.csv:1: row 4, column 'cp cooling [J/(g K)]'" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["window", "wall_and_window"])
def test_a_study_of_a_window(name: str, faults: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", str(faults / "studies" / f"{name}.yaml"), "--allow-outside"]) == 0
    assert "identification" in capsys.readouterr().out
