from __future__ import annotations

import json
from pathlib import Path

import pytest

from mascarin import cli
from mascarin.ensemble import Store
from test_commands_run import BOX, PERIOD

FILM = "surfaces.facade.inside.convection.coefficient"


@pytest.fixture
def call(data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Words that sweep the box for a day in Denver, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    Path("box.yaml").write_text(BOX, encoding="utf-8")
    weather = str(data_dir / "bestest" / "725650TYCST.epw")
    return ["sweep", "box.yaml", "--weather", weather, *PERIOD, "-o", "swept"]


def test_drawn_members_and_their_objectives(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--draw", "12", "--vary", FILM, "--objective", "max:room.air_temperature"]
    assert cli.main([*call, *words, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["members"], found["failed"], found["seed"]) == (12, {}, 1)
    assert found["closure"] < 1e-10
    row = found["objectives"]["max:room.air_temperature"]
    assert row["min"] < row["mean"] < row["max"]
    table = Store(Path("swept")).table()
    assert len(table) == 12
    assert table["max:room.air_temperature"].max() == row["max"]
    assert cli.main([*call, *words]) == 0
    assert "12 members" in capsys.readouterr().out


def test_members_from_a_table(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    Path("members.csv").write_text(f"{FILM}\n2.0\n3.0\n", encoding="utf-8")
    words = ["--samples", "members.csv", "--output", "room.air_temperature", "--step", "1h"]
    assert cli.main([*call, *words]) == 0
    assert Store(Path("swept")).dataset()["room.air_temperature"].shape == (2, 25)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--objective", "max:room.air_temperature"], "either --samples FILE or --draw NUMBER"),
        (["--draw", "4"], "either --objective"),
        (["--draw", "4", "--objective", "mx:room.air_temperature"], "Did you mean 'max'"),
        (["--draw", "4", "--objective", "max:room.air_temperatur"], "room.air_temperature"),
        (["--draw", "0", "--objective", "max:room.air_temperature"], "expected 1 or more"),
        (["--samples", "none.csv", "--objective", "max:room.air_temperature"], "cannot be read"),
        (
            ["--draw", "4", "--vary", "zones.rom.volume", "--objective", "max:room.air_temperature"],
            "zones.room",
        ),
    ],
)
def test_refusals(call: list[str], words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([*call, *words]) == cli.EXIT_INPUT
    assert says in capsys.readouterr().err
    assert not Path("swept").exists()
