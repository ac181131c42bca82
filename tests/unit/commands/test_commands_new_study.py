"""A study that was copied is the one that comes with Mascarin, without the description of its data."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

from mascarin.building.files.yaml_document import plain
from mascarin.cli import main
from mascarin.examples import DESIGNS, STUDIES


def yaml(path: Path) -> dict[str, Any]:
    return dict(YAML(typ="safe").load(path))


@pytest.mark.parametrize("name", [name for name, file in STUDIES.items() if file.name == "study.yaml"])
def test_every_example_can_be_started_from(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "my own cell"
    assert main(["init", str(folder), "--example", name]) == 0
    said = capsys.readouterr()
    written = [Path(line) for line in said.out.splitlines()]
    source = STUDIES[name].parent
    copies = [path for path in written if not path.name.endswith(".schema.json")]
    assert [path.name for path in copies] == sorted(p.name for p in source.iterdir() if p.is_file())
    for path in copies:
        if path.name != "study.yaml":
            head = b"# yaml-language-server: $schema=building.schema.json\n" * (path.name == "building.yaml")
            assert path.read_bytes() == head + (source / path.name).read_bytes()
    for kind in ("building", "study"):
        text = (folder / f"{kind}.yaml").read_text(encoding="utf-8")
        named = text.partition("\n")[0].partition("$schema=")[2]
        schema = json.loads((folder / named).read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator(schema).validate(plain(text, kind))
    copied, example = yaml(folder / "study.yaml"), yaml(STUDIES[name])
    # What describes the data of the example would be wrong for other data.
    assert copied["about"] == "Describe your data here."
    assert copied["observed"] == "observation"
    assert "reference" not in copied
    assert "observed_note" not in copied
    described = {"name", "about", "observed", "observed_note", "reference", "identification", "variants"}
    assert {k: v for k, v in copied.items() if k not in described} == {
        k: v for k, v in example.items() if k not in described
    }
    assert list(copied["identification"]["parameters"]) == list(example["identification"]["parameters"])
    assert "reference: [" not in (folder / "study.yaml").read_text(encoding="utf-8")
    assert f"mascarin study '{folder / 'study.yaml'}'" in said.err
    # What was copied is understood where it is now.
    assert main(["check", str(folder / "building.yaml")]) == 0


def test_the_designs_of_a_house_can_be_started_from(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "my house"
    assert main(["init", str(folder), "--example", "reunion-house"]) == 0
    said = capsys.readouterr()
    copied, example = yaml(folder / "design.yaml"), yaml(DESIGNS["reunion-house"])
    assert copied["name"] == "New comparison of designs"
    assert copied["about"] == "Describe your building and your question here."
    # The reference building of a comparison is kept: it is no published number.
    described = ("name", "about")
    assert {k: v for k, v in copied.items() if k not in described} == {
        k: v for k, v in example.items() if k not in described
    }
    text = (folder / "design.yaml").read_text(encoding="utf-8")
    assert "reunion-house" not in text
    schema = json.loads((folder / "design.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(plain(text, "design"))
    # Every command that it names works.
    commands = [shlex.split(line.removeprefix("next:").strip()) for line in said.err.splitlines()]
    typed = [words[1:] for words in commands if words[0] == "mascarin"]
    assert [words[0] for words in typed] == ["check", "run", "design", "design"]
    for words in (typed[0], [*typed[1], "--start", "01-10", "--end", "01-11", "--step", "10min"], typed[2]):
        assert main(words) == 0, words
    assert (folder / "run.html").is_file()
    assert "60 designs in 3 climates" in capsys.readouterr().out


def test_nothing_is_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.txt").write_text("kept", encoding="utf-8")
    assert main(["init", str(tmp_path)]) == 2
    assert "is not empty" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
    assert main(["init", str(tmp_path / "mine.txt")]) == 2
    assert "is a file" in capsys.readouterr().err


def test_an_unknown_example_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", str(tmp_path / "new"), "--example", "lgl"]) == 2
    assert "Did you mean 'lgi'?" in capsys.readouterr().err
    assert main(["init", str(tmp_path / "new"), "--example", "palace"]) == 2
    said = capsys.readouterr().err
    assert said.count("wall-bench") == said.count("reunion-house") == 1
    assert not (tmp_path / "new").exists()
