from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from mascarin import cli
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
        (["600"], "--weather: not given"),
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
