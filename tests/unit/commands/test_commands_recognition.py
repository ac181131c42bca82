"""A file of another kind, given to any command, is named, with a command that takes it."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin import cli
from mascarin.building.files.recognition import described

BUILDING = "name: hut\nsite: {latitude: 1, longitude: 2, altitude: 3, timezone: UTC}\nsurfaces: {}\n"
#: As `mascarin new` writes it: parameters without a value.
STUDY = """
name: hut
building: building.yaml
identification:
  parameters:
    materials.a.conductivity:
    materials.b.density:
"""
DESIGN = "name: hut\nbuilding: building.yaml\nobjectives: {hot: {kind: hours}}\n"
TABLE = "time,T_in,T_out\n2024-01-01 00:00,20.1,3.2\n2024-01-01 00:10,20.2,3.1\n"
WEATHER = "LOCATION,Oz,,,TMY,0,1,2,3,4\n"
IDF = "Version,25.2;\nBuilding, box, 0;\n"

FILES = {
    "building.yaml": (BUILDING, "a building"),
    "study.yaml": (STUDY, "a study"),
    "design.yaml": (DESIGN, "a design study"),
    "logger.csv": (TABLE, "a table"),
    "oz.epw": (WEATHER, "a weather file"),
    "box.idf": (IDF, "a model of EnergyPlus"),
}
#: Commands that read a file, what they read, and further arguments.
COMMANDS = {
    "check": ("building.yaml", ""),
    "view": ("building.yaml", "-o out.html"),
    "parameters": ("building.yaml", ""),
    "outputs": ("building.yaml", ""),
    "run": ("building.yaml", "--weather shipped:tampa"),
    "sweep": ("building.yaml", "--weather shipped:tampa --draw 4 --objective max:a.b -o out"),
    "page": ("building.yaml", "--weather shipped:tampa -o out.html"),
    "explore": ("building.yaml", "--weather shipped:tampa --no-open"),
    "fmu": ("building.yaml", "--weather shipped:tampa -o out.fmu"),
    "validate": ("study.yaml", ""),
    "study": ("study.yaml", "-o out"),
    "sensitivity": ("study.yaml", "-o out"),
    "calibrate": ("study.yaml", "-o out"),
    "genopt": ("study.yaml", "-o out"),
    "design": ("design.yaml", "-o out"),
    "convert": ("box.idf", "-o out.yaml"),
    "weather": ("oz.epw", ""),
    "optimize": ("", ""),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_file_of_another_kind_is_named(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    own, options = COMMANDS[command]
    for name, (content, _) in FILES.items():
        Path(name).write_text(content, encoding="utf-8")
    for name, (_, what) in FILES.items():
        if name == own:
            continue
        assert cli.main([command, name, *options.split()]) == 2, name
        message = capsys.readouterr().err
        assert f"found {what}" in message.replace("found: ", "found "), message
        # One message for the file, and a command of Mascarin that exists.
        assert message.count("expected") == 1, message
        assert "'mascarin " in message


def test_a_description_is_not_taken_for_a_table(tmp_path: Path) -> None:
    for text in (BUILDING, "name: a, b\n", "a: [1, 2, 3]\nb: [1, 2, 3]\n", ""):
        file = tmp_path / "file.txt"
        file.write_text(text, encoding="utf-8")
        assert described(file) is None
