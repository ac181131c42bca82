from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import mascarin as mc
from mascarin import cli
from mascarin.errors import InputError
from mascarin.verification.bestest import weather as bestest_weather
from mascarin.verification.bestest.catalogue import CASES

WEATHER = Path("bestest") / "725650TYCST.epw"


def test_the_cases_are_listed_with_their_files(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bestest", "--list", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["case"] for row in rows] == list(CASES)
    assert all(Path(row["file"]).is_file() for row in rows)
    assert cli.main(["bestest", "640", "--list"]) == 0
    assert "heating set point lowered at night" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["601"], "found '601'"),
        (["600", "--weather", "no.epw"], "found no file 'no.epw'"),
        (["195", "--weather", "no.epw", "--workers", "0"], "--workers: found 0"),
        (["195", "--weather", "no.epw", "-o", "not/there"], "--out: found"),
    ],
)
def test_input_that_cannot_be_run_is_refused_before_the_runs(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["bestest", *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert said in err


def test_a_case_of_the_user_runs_like_the_others(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Case 195 and a copy of its file: the same numbers, with ranges and without; and a page of both."""
    mine = tmp_path / "mine.yaml"
    shutil.copy(CASES["195"].file, mine)
    words = [
        "195",
        str(mine),
        "--weather",
        str(data_dir / WEATHER),
        "--step",
        "1h",
        "-o",
        str(tmp_path / "o"),
    ]
    code = cli.main(["bestest", *words, "--json"])
    rows = json.loads(capsys.readouterr().out)
    held = {row["quantity"]: row for row in rows if row["case"] == "195"}
    own = {row["quantity"]: row for row in rows if row["case"] == str(mine)}
    assert code == (0 if all(row["passed"] for row in held.values()) else 1)
    assert set(held) == {"annual_heating", "annual_cooling", "peak_heating", "peak_cooling"}
    for quantity, row in held.items():
        assert own[f"room.{quantity}"]["value"] == row["value"]
        assert own[f"room.{quantity}"]["passed"] is None
        assert row["min"] < row["expected"] < row["max"]
    # Hours are so much coarser than the cases' quarters of an hour that peaks may leave the range.
    assert held["annual_heating"]["passed"]
    assert held["annual_cooling"]["passed"]
    page = (tmp_path / "o" / "bestest.html").read_text(encoding="utf-8")
    assert "mine.yaml" in page


def test_an_error_in_a_file_of_the_user_names_the_line(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.yaml"
    mine.write_text(CASES["195"].file.read_text("utf-8").replace("volume: 129.6", "volume: -1"), "utf-8")
    assert cli.main(["bestest", str(mine), "--weather", str(data_dir / WEATHER)]) == 2
    assert "zones.room.volume" in capsys.readouterr().err


OWN = "case,quantity,unit,min,max\nmine,annual_heating,MWh,{0},{1}\nmine.yaml,room.peak_heating,kW,0,100\n"


@pytest.mark.parametrize(("low", "high", "code"), [(0, 100, 0), (0, 0.001, 1)])
def test_cases_of_the_user_have_their_own_ranges(
    low: float, high: float, code: int, data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.yaml"
    shutil.copy(CASES["195"].file, mine)
    zone = next(iter(mc.load(mine).zones))
    (tmp_path / "own.csv").write_text(OWN.format(low, high).replace("room.", f"{zone}."), encoding="utf-8")
    words = [str(mine), "--ranges", str(tmp_path / "own.csv"), "--weather", str(data_dir / WEATHER)]
    assert cli.main(["bestest", *words, "--step", "1h", "--json", "-o", str(tmp_path / "o")]) == code
    out, err = capsys.readouterr()
    rows = {row["quantity"]: row for row in json.loads(out)}
    assert rows[f"{zone}.annual_heating"]["passed"] is (code == 0)
    assert (rows[f"{zone}.annual_heating"]["min"], rows[f"{zone}.annual_heating"]["max"]) == (low, high)
    assert rows[f"{zone}.peak_heating"]["passed"] is True
    assert rows[f"{zone}.mean_temperature"]["passed"] is None
    assert f"{2 - code} of 2 numbers inside" in err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "case,quantity,unit\nmine,annual_heating,MWh\n",
            "own.csv:1: found the columns case, quantity, unit",
        ),
        ("case,quantity,unit,min,max\n# x\nmine,annual_heating,MWh,1,two\n", "own.csv:3: max: found 'two'"),
        ("case,quantity,unit,min,max\nmine,annual_heating,MWh,2,1\n", "own.csv:2: found min 2 above max 1"),
        (
            "case,quantity,unit,min,max\nmime,annual_heating,MWh,1,2\n",
            "found the case 'mime'; expected one of",
        ),
    ],
)
def test_ranges_that_cannot_be_used_are_refused_before_the_runs(
    text: str, said: str, data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.yaml"
    shutil.copy(CASES["195"].file, mine)
    (tmp_path / "own.csv").write_text(text, encoding="utf-8")
    words = [str(mine), "--ranges", str(tmp_path / "own.csv"), "--weather", str(data_dir / WEATHER)]
    assert cli.main(["bestest", *words]) == 2
    assert said in capsys.readouterr().err


def test_without_weather_that_of_the_data_folder_is_taken(
    monkeypatch: pytest.MonkeyPatch, data_dir: Path
) -> None:
    monkeypatch.setenv("MASCARIN_DATA", str(data_dir))
    assert bestest_weather.read(None).file == WEATHER.name

    def missing(name: str) -> Path:
        raise InputError(f"data:{name}: cannot be downloaded")

    monkeypatch.setattr(bestest_weather, "data_file", missing)
    with pytest.raises(InputError, match=r"--weather: not given.*BESTEST-GSR.*cannot be downloaded"):
        bestest_weather.read(None)
