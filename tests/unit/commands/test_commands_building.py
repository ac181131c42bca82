from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

import mascarin as mc
from mascarin import cli
from mascarin.examples import FOLDER

WALL = """\
name: Bench
site: {latitude: 43.48, longitude: -1.52, altitude: 50, timezone: Europe/Paris}
materials:
  concrete: {conductivity: {value: 1.75, range: [1.2, 2.3], source: "ISO 10456:2007"}, density: 2400,
             specific_heat: {value: 880, assumed: true}}
constructions: {wall: {layers: [{material: concrete, thickness: 0.2}]}}
surfaces:
  facade: {construction: wall, area: 7, tilt: 90, azimuth: 180,
           outside: {measured: T_out, convection: 20}, inside: {measured: T_in, convection: 8}}
"""


@pytest.fixture
def wall(tmp_path: Path) -> str:
    path = tmp_path / "wall.yaml"
    path.write_text(WALL, encoding="utf-8")
    return str(path)


def run(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Standard output of a command that succeeds and has nothing else to say."""
    code = cli.main(words)
    out, err = capsys.readouterr()
    assert (code, err) == (0, "")
    return out


def test_schema_accepts_a_building_and_refuses_a_wrong_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    validator = jsonschema.Draft202012Validator(json.loads(run(capsys, "schema")))
    building: dict[str, Any] = YAML(typ="safe").load(WALL)
    validator.validate(building)
    building["surfaces"]["facade"]["colour"] = "blue"
    assert not validator.is_valid(building)


def test_check_describes_the_building(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    out = run(capsys, "check", wall)
    assert out.startswith("Bench: 0 zones, 1 surface")
    assert "assumed: materials.concrete.specific_heat = 880 J/(kg K)" in out


def test_check_says_once_what_several_parts_have_alike(capsys: pytest.CaptureFixture[str]) -> None:
    house = str(FOLDER / "reunion_house" / "building.yaml")
    out = run(capsys, "check", house)
    lines = [line for line in out.splitlines() if line.startswith("assumed: ")]
    assert "assumed: vents.{living_north_jalousie, living_south_jalousie, bedroom_north_jalousie, " in out
    assert "assumed: zones.{living, bedroom}.capacity_factor = 3 (" in out
    assert "assumed: zones.attic.capacity_factor = 1 (" in out
    # Every number that is assumed is in one line, and no line is there twice.
    assert len(lines) == len(set(lines)) < 100
    listed = 0
    for line in lines:
        path = line.removeprefix("assumed: ").split(" = ")[0]
        listed += path.count(",") + 1 if " = " in line else 0
    assert listed == sum(number.assumed for number in mc.load(house).parameters())


def test_check_as_json_separates_assumptions_from_findings(
    wall: str, capsys: pytest.CaptureFixture[str]
) -> None:
    found = json.loads(run(capsys, "check", wall, "--json", "--step", "1h"))
    assert found["summary"][0].startswith("Bench: ")
    assert any(text.startswith("materials.concrete.specific_heat = 880") for text in found["assumed"])
    assert not any(text.startswith(("assumed", "warning")) for text in found["summary"])


def test_check_sees_another_value(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    # Doubling the thickness adds 0.2 m / 1.75 W/(m K) of resistance.
    words = ["check", wall, "--set", "constructions.wall.layers.concrete.thickness=0.4"]
    thin, thick = (
        float(re.findall(r"U ([0-9.]+) W", out)[0])
        for out in (run(capsys, "check", wall), run(capsys, *words))
    )
    assert 1.0 / thick - 1.0 / thin == pytest.approx(0.2 / 1.75, rel=2e-3)


def test_parameters_table(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    header, *rows = run(capsys, "parameters", wall, "materials.*").splitlines()
    assert header.split() == ["path", "value", "unit", "low", "high", "note"]
    assert [row.split()[0] for row in rows] == [
        "materials.concrete.conductivity",
        "materials.concrete.density",
        "materials.concrete.specific_heat",
    ]
    assert rows[0].split()[1:] == ["1.75", "W/(m", "K)", "1.2", "2.3"]


def test_parameters_as_json(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    rows = {row["path"]: row for row in json.loads(run(capsys, "parameters", wall, "--json"))}
    conductivity = rows["materials.concrete.conductivity"]
    assert (conductivity["value"], conductivity["low"], conductivity["high"]) == (1.75, 1.2, 2.3)
    assert conductivity["source"] == "ISO 10456:2007"
    assert conductivity["upper"] is None or conductivity["upper"] > 2.3
    assert rows["site.latitude"]["structural"]


def test_another_value_keeps_its_range_but_not_its_source(
    wall: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["materials.concrete.conductivity", "--json", "--set", "materials.concrete.conductivity=2"]
    (row,) = json.loads(run(capsys, "parameters", wall, *words))
    assert (row["value"], row["low"], row["high"], row["source"]) == (2.0, 1.2, 2.3, None)


def test_varying_parameters_only(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    every = json.loads(run(capsys, "parameters", wall, "--json"))
    varying = json.loads(run(capsys, "parameters", wall, "--json", "--varying"))
    assert 0 < len(varying) < len(every)
    assert all(row["low"] < row["high"] and row["reason"] is None for row in varying)


def test_cite(wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert "ISO 10456:2007" in run(capsys, "cite", wall).splitlines()
    assert "ISO 10456:2007" in json.loads(run(capsys, "cite", wall, "--json"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["check", "{}", "--step", "0"], "--step: found '0'"),
        (["check", "{}", "--step", "2 weeks"], "such as 900, 15min or 1h"),
        (["check", "{}", "--set", "surfaces.facade.area"], "expected PATH=NUMBER"),
        (["check", "{}", "--set", "surfaces.facade.area=big"], "found 'surfaces.facade.area=big'"),
        (["check", "{}", "--set", "surfaces.facade.aera=3"], "surfaces.facade.area"),
        (["check", "{}", "--set", "surfaces.facade.area=-3"], "surfaces.facade.area"),
        (["parameters", "{}", "materials.concrete.density_"], "'materials.concrete.density'"),
        (["check", "nowhere.yaml"], "nowhere.yaml"),
        (["cite", "nowhere.yaml"], "nowhere.yaml"),
    ],
)
def test_bad_input(words: list[str], said: str, wall: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([word.format(wall) for word in words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert said in err


def test_a_fault_in_the_file_is_shown_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "wall.yaml"
    path.write_text(WALL.replace("area: 7", "area: -7"), encoding="utf-8")
    assert cli.main(["check", str(path)]) == 2
    assert f"{path}:8: surfaces.facade.area" in capsys.readouterr().err
