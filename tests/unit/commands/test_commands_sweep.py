from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
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
    table = Store(Path("swept")).to_dataframe()
    assert len(table) == 12
    assert table["max:room.air_temperature"].max() == row["max"]
    assert cli.main([*call, *words]) == 0
    assert "12 members" in capsys.readouterr().out


def test_members_whose_balance_does_not_close_give_exit_code_1(
    call: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    # No building is known that this scheme does not close for: the limit is lowered below rounding.
    monkeypatch.setattr("mascarin.simulation.checks.energy.CLOSED", 0.0)
    words = ["--draw", "3", "--vary", FILM, "--objective", "max:room.air_temperature"]
    assert cli.main([*call, *words, "--json"]) == 1
    printed = capsys.readouterr()
    found = json.loads(printed.out)
    assert "warning: the energy balance of 3 of 3 members does not close" in printed.err
    assert found["warnings"][0] in printed.err
    assert cli.main([*call, *words]) == 1


def test_members_from_a_table(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    Path("members.csv").write_text(f"{FILM}\n2.0\n3.0\n", encoding="utf-8")
    words = ["--samples", "members.csv", "--output", "room.air_temperature", "--step", "1h"]
    assert cli.main([*call, *words]) == 0
    assert Store(Path("swept")).to_xarray()["room.air_temperature"].shape == (2, 25)


def test_members_from_parquet_are_those_of_the_csv_file(call: list[str]) -> None:
    # With 17 digits the text of a number is the number.
    samples = pd.DataFrame({FILM: [2.0000000000000004, 0.1 + 0.2]})
    samples.to_parquet("members.parquet")
    samples.to_csv("members.csv", index=False)
    words = ["--objective", "max:room.air_temperature", "--step", "1h"]
    for ending in ("csv", "parquet"):
        assert cli.main([*call[:-1], f"swept{ending}", "--samples", f"members.{ending}", *words]) == 0
    found = [Store(Path(f"swept{ending}")).to_dataframe() for ending in ("csv", "parquet")]
    pd.testing.assert_frame_equal(found[0], found[1], check_exact=True)
    assert found[0][f"sample: {FILM}"].tolist() == samples[FILM].tolist()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--objective", "max:room.air_temperature"], "either --samples FILE or --draw NUMBER"),
        (["--draw", "4"], "either --objective"),
        (["--draw", "4", "--objective", "mx:room.air_temperature"], "Did you mean 'max'"),
        (["--draw", "4", "--objective", "max:room.air_temperatur"], "room.air_temperature"),
        (["--draw", "0", "--objective", "max:room.air_temperature"], "expected 1 or more"),
        (["--samples", "box.yaml", "--objective", "max:room.air_temperature"], "ending in .csv or .parquet"),
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
