"""Errors about an output name what the user wrote, never the temporary file in its place."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import Any

import pytest

import mascarin as mc
from mascarin import cli
from mascarin._io import atomic
from mascarin.errors import InputError
from mascarin.examples import box, box_climate

PERIOD = ("--weather", "shipped:golden", "--start", "2001-01-01", "--end", "2001-01-02", "--step", "1h")
COMMANDS = {
    "run.nc": ("run", "{box}", *PERIOD, "-o"),
    "run.csv": ("run", "{box}", *PERIOD, "-o"),
    "run.parquet": ("run", "{box}", *PERIOD, "--interval", "2h", "-o"),
    "page.html": ("run", "{box}", *PERIOD, "--report"),
    "unit.fmu": ("fmu", "{box}", *PERIOD, "-o"),
    "live.html": ("page", "{box}", *PERIOD, "-o"),
    "view.html": ("view", "{box}", "-o"),
    "year.epw": ("weather", "shipped:golden", "--epw"),
    "explored.yaml": ("explore", "{box}", "--weather", "shipped:golden", "-o"),
}


@pytest.mark.parametrize("name", list(COMMANDS))
def test_a_folder_in_the_place_of_an_output(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target, described = tmp_path / name, tmp_path / "box.yaml"
    target.mkdir()
    box().to_yaml(described)
    words = [word.format(box=described) for word in COMMANDS[name]]
    assert cli.main([*words, str(target)]) == 2
    said = capsys.readouterr().err
    assert str(target) in said
    assert "folder" in said
    assert atomic.PART not in said
    assert sorted(tmp_path.iterdir()) == sorted([target, described])


def test_a_folder_in_the_place_of_an_output_in_python(tmp_path: Path) -> None:
    run = mc.simulate(box(), box_climate(), step="1h")
    for name in ("run.nc", "run.csv", "run.parquet"):
        target = tmp_path / name
        target.mkdir()
        with pytest.raises(InputError, match=rf"{name}: found a folder, expected a file to write"):
            run.write(target)


@pytest.mark.parametrize("error", [
    OSError(errno.ENOSPC, "No space left on device"),
    PermissionError(errno.EACCES, "Permission denied"),
])  # fmt: skip
@pytest.mark.parametrize("way", [atomic.replacing, atomic.drafted])
def test_an_error_while_a_file_is_written_names_it(
    way: Any, error: OSError, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "run.csv"
    target.write_text("before", encoding="utf-8")
    with pytest.raises(type(error)) as caught, way(target):
        raise error
    assert caught.value.filename == str(target)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OSError, match=r"run\.csv") as seen, way(Path("run.csv")):
        raise OSError(errno.ENOSPC, "No space left on device", str(next(Path().glob(".run.csv*"))))
    assert seen.value.filename == "run.csv"
    assert target.read_text(encoding="utf-8") == "before"
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"]


def test_the_words_of_a_library_name_the_file(tmp_path: Path) -> None:
    target = tmp_path / "run.nc"
    with pytest.raises(ValueError, match="unable to create") as caught, atomic.drafted(target) as draft:
        raise ValueError(f"unable to create file (name = '{draft}', errno = 28)")
    assert str(caught.value) == f"unable to create file (name = '{target}', errno = 28)"


def test_an_error_about_another_file_keeps_its_name(tmp_path: Path) -> None:
    other = tmp_path / "weather.csv"
    with pytest.raises(FileNotFoundError) as caught, atomic.replacing(tmp_path / "run.csv"):
        other.open()
    assert caught.value.filename == str(other)
