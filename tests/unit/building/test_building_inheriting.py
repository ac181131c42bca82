"""Descriptions that extend another one: merge, values by path, chains, circles, and locations of errors."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

import mascarin as mc
from mascarin import cli
from mascarin.building import load
from mascarin.errors import InputError

BASE = """\
name: Cell
site: {latitude: 45, longitude: 5, altitude: 200, timezone: UTC+1}
materials:
  brick: {conductivity: 0.8, density: 1700, specific_heat: 850}
  wool: {conductivity: {value: 0.04, range: [0.03, 0.05]}, density: 30, specific_heat: 1000}
constructions:
  wall:
    layers:
      - {material: wool, thickness: 0.1}
      - {material: brick, thickness: 0.2}
zones:
  room: {volume: 30, infiltration: 0.5, heating: {setpoint: 20}}
surfaces:
  south:
    construction: wall
    area: 10
    tilt: 90
    azimuth: 180
    outside: {outdoors: true, convection: {kind: tarp, roughness: 1.5}, emissivity: 0.9, absorptance: 0.6}
    inside: {zone: room, convection: 3, emissivity: 0.9}
"""


@pytest.fixture
def base(tmp_path: Path) -> Path:
    (tmp_path / "base.yaml").write_text(BASE, encoding="utf-8")
    return tmp_path / "base.yaml"


def variant(base: Path, text: str, name: str = "variant.yaml") -> Path:
    path = base.parent / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def value(file: Path, path: str) -> float:
    return load(file).parameter(path).value


def test_a_variant_is_five_lines(base: Path) -> None:
    file = variant(
        base,
        "extends: base.yaml\n"
        "name: Insulated cell\n"
        "surfaces: {south: {outside: {absorptance: 0.3}}}\n"
        "set:\n"
        "  constructions.wall.layers.wool.thickness: 0.2\n",
    )
    found, plain = load(file), load(base)
    assert found.name == "Insulated cell"
    assert found == plain.replace(
        {"name": "Insulated cell", "surfaces.south.outside.absorptance": 0.3,
         "constructions.wall.layers.wool.thickness": 0.2}
    )  # fmt: skip


def test_nothing_but_the_base_is_the_base(base: Path) -> None:
    assert load(variant(base, "extends: base.yaml\n")) == load(base)


def test_a_number_by_path_keeps_its_range_and_reads_short_forms(base: Path) -> None:
    file = variant(
        base,
        "extends: base.yaml\nset:\n  materials.wool.conductivity: 0.035\n"
        "  zones.room.heating.setpoint: 21\n  surfaces.south.inside.convection: {kind: tarp}\n",
    )
    wool = load(file).parameter("materials.wool.conductivity")
    assert (wool.value, wool.low, wool.high) == (0.035, 0.03, 0.05)
    assert value(file, "zones.room.heating.setpoint.temperature") == 21.0
    assert load(file).surfaces["south"].inside.convection.kind == "tarp"  # type: ignore[union-attr]


def test_another_kind_and_a_list_replace_the_whole(base: Path) -> None:
    file = variant(
        base,
        "extends: base.yaml\n"
        "constructions: {wall: {layers: [{material: brick, thickness: 0.3}]}}\n"
        "surfaces: {south: {outside: {convection: {kind: doe2, roughness: 1.2}}}}\n",
    )
    found = load(file)
    assert [layer.material for layer in found.constructions["wall"].layers] == ["brick"]
    assert found.surfaces["south"].outside.convection.kind == "doe2"  # type: ignore[union-attr]
    assert found.surfaces["south"].outside.emissivity == 0.9


def test_a_key_without_a_value_removes_that_of_the_base(base: Path) -> None:
    file = variant(
        base,
        "extends: base.yaml\nzones: {room: {heating: }}\n"
        "surfaces: {south: {outside: {outdoors: , absorptance: , emissivity: , convection: 9, "
        "measured: T}}}\n",
    )
    found = load(file)
    assert found.zones["room"].heating is None
    assert found.surfaces["south"].outside.measured == "T"


def test_a_chain_and_what_comes_last_wins(base: Path) -> None:
    variant(
        base,
        "extends: ../base.yaml\nname: Middle\nset: {zones.room.volume: 40, zones.room.infiltration: 1.0}\n",
        "more/middle.yaml",
    )
    file = variant(base, "extends: more/middle.yaml\nzones: {room: {volume: 50}}\n")
    assert load(file).name == "Middle"
    assert value(file, "zones.room.volume") == 50.0
    assert value(file, "zones.room.infiltration.constant") == 1.0
    last = variant(base, "extends: variant.yaml\nset: {zones.room.infiltration: 2.0}\n", "last.yaml")
    assert value(last, "zones.room.infiltration.constant") == 2.0
    assert value(last, "zones.room.volume") == 50.0


def test_circles_are_refused(base: Path) -> None:
    variant(base, "extends: two.yaml\n", "one.yaml")
    file = variant(base, "name: Two\nextends: one.yaml\n", "two.yaml")
    with pytest.raises(
        InputError, match=r"one.yaml:1: extends\n  found: a circle, two.yaml -> one.yaml -> two"
    ):
        load(file)
    with pytest.raises(InputError, match=r"a circle, self.yaml -> self.yaml"):
        load(variant(base, "extends: self.yaml\n", "self.yaml"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("extends: bas.yaml\n", r"variant.yaml:1: extends\n  found: no file .*bas.yaml"),
        ("name: x\nextends: [base.yaml, base.yaml]\n", r"variant.yaml:2: extends\n  found: \['base"),
        ("extends: base.yaml\nset: 3\n", r"variant.yaml:2: set\n  found: 3\n  expected: values by path"),
        (
            "extends: base.yaml\nset:\n  zones.room.volumen: 3\n",
            r"variant.yaml:3: set.zones.room.volumen: found no such parameter.*zones.room.volume",
        ),
        (
            "extends: base.yaml\nset:\n  zones.room.infiltration: 0.1\n  zones.room.volume: -3\n",
            r"variant.yaml:4: set.zones.room.volume: ",
        ),
        (
            "extends: base.yaml\nzones:\n  room:\n    volume: -3\n",
            r"variant.yaml:4: zones.room.volume\n  found: -3",
        ),
        (
            "extends: base.yaml\nzones:\n  room:\n    volum: 3\n",
            r"variant.yaml:4: zones.room.volum\n  found: the key",
        ),
    ],
)
def test_errors_name_the_file_and_line_of_the_variant(base: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        load(variant(base, text))


def test_errors_in_the_base_name_the_base(base: Path) -> None:
    base.write_text(BASE.replace("volume: 30", "volume: -30"), encoding="utf-8")
    file = variant(base, "extends: base.yaml\nname: Variant\n")
    with pytest.raises(InputError, match=r"base.yaml:12: zones.room.volume\n  found: -30"):
        load(file)


def test_set_needs_a_base(base: Path) -> None:
    file = variant(base, BASE + "set: {zones.room.volume: 40}\n")
    with pytest.raises(InputError, match=r"variant.yaml:\d+: set\n  found: the key"):
        load(file)


def test_variants_from_the_command_line(base: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = variant(base, "extends: base.yaml\nset: {zones.room.volume: 44}\n")
    assert cli.main(["parameters", str(file), "zones.room.volume"]) == 0
    assert "44" in capsys.readouterr().out


def test_a_study_extends_a_study(tmp_path: Path) -> None:
    from study_support import BUILDING, STUDY, logger_table

    folder = tmp_path / "first"
    folder.mkdir()
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    text = "extends: first/study.yaml\nname: Coarse\nstep: 1h\nsensitivity: {replicates: 4}\n"
    (tmp_path / "coarse.yaml").write_text(text, encoding="utf-8")
    study = mc.Study(tmp_path / "coarse.yaml")
    assert (study.plan.name, study.plan.step) == ("Coarse", "1h")
    assert study.plan.sensitivity is not None
    assert (study.plan.sensitivity.replicates, study.plan.sensitivity.interval) == (4, "1h")
    (tmp_path / "coarse.yaml").write_text(text + "sensors: {joint: {colum: x}}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"coarse.yaml:5: sensors.joint.colum\n"):
        mc.Study(tmp_path / "coarse.yaml")
    (folder / "study.yaml").write_text(STUDY.replace("column: core", "column: cor"), encoding="utf-8")
    (tmp_path / "coarse.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"first/study.yaml:14: sensors.core.column"):
        mc.Study(tmp_path / "coarse.yaml")


def test_the_hash_of_a_study_follows_the_base_of_its_building(tmp_path: Path) -> None:
    from study_support import BUILDING, STUDY, logger_table

    (tmp_path / "base.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "building.yaml").write_text("extends: base.yaml\n", encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(tmp_path / "base.yaml").to_csv(tmp_path / "logger.csv")
    before = mc.Study(tmp_path / "study.yaml").context.inputs.hashes["building"]
    assert before != hashlib.sha256((tmp_path / "building.yaml").read_bytes()).hexdigest()
    (tmp_path / "base.yaml").write_text(BUILDING.replace("area: 4.0", "area: 5.0"), encoding="utf-8")
    assert mc.Study(tmp_path / "study.yaml").context.inputs.hashes["building"] != before
