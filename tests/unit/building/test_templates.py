"""Rooms, houses, cells and walls from a few words; keys that many parts share."""

from __future__ import annotations

import itertools
import random
import shlex
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.materials.library import products
from mascarin.templates import Room, building_of
from mascarin.templates.place import place_of
from mascarin.templates.short_texts import common_materials, layers_of
from mascarin.weather.reading.shipped import SHIPPED, content

ISSUE = (
    "new room 4x3x2.8 --roof steel --gap ventilated --ceiling 'plasterboard 12.5mm + SP24E 15mm' "
    "--window south:1.2x1.0 --place saint-denis"
)


def test_three_commands_simulate_a_ventilated_roof(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(shlex.split(ISSUE)) == 0
    said = capsys.readouterr().err
    (command,) = [line.strip() for line in said.splitlines() if "mascarin run" in line]
    words = shlex.split(command)[1:]
    assert cli.main([*words, "--start", "02-01", "--end", "02-04"]) == 0
    assert (tmp_path / "room" / "run.html").is_file()
    assert cli.main(["check", "room/building.yaml"]) == 0
    lines = (tmp_path / "room" / "building.yaml").read_text().splitlines()
    assert "mascarin new room 4x3x2.8 --roof steel" in lines[1]
    assert len(lines) < 80
    # Nothing is overwritten.
    assert cli.main(shlex.split(ISSUE)) == 2


def test_the_room_is_the_one_that_was_asked_for() -> None:
    room = mc.new_room(
        "5x4x3", gap="closed", ceiling="plasterboard 20mm + RT25HC 10mm", windows=["west:1.5x1.2"],
        walls="brick 200mm", place="tampa",
    )  # fmt: skip
    assert float(room.zones["room"].volume or 0.0) == pytest.approx(60.0)
    assert float(room.zones["gap"].volume or 0.0) == pytest.approx(20.0 * 0.25)
    areas = {name: float(surface.area or 0.0) for name, surface in room.surfaces.items()}
    assert areas["west"] == pytest.approx(4.0 * 3.0)  # with its window
    assert areas["south"] == pytest.approx(15.0)
    assert room.surfaces["west"].azimuth == pytest.approx(270.0)
    assert room.windows["west_window"].area == pytest.approx(1.8)
    layers = room.constructions["ceiling"].layers
    assert [layer.material for layer in layers] == ["rt25hc", "plasterboard"]  # from outside to inside
    assert room.surfaces["ceiling"].outside.zone == "gap"
    assert room.parameter("constructions.wall.layers.brick.thickness").value == pytest.approx(0.2)


def test_drawn_rooms_run_with_closed_balances() -> None:
    """Every common material and many products, sizes, places and recipes that no other test names."""
    rng = random.Random(45)
    common, pcms = [*common_materials()], [*products()]
    rng.shuffle(common)
    rng.shuffle(pcms)
    climates = itertools.cycle(["tampa", "golden", "chicago", "saint-denis", "tucson"])
    for k in range(0, len(common), 4):
        four = [common[(k + j) % len(common)] for j in range(4)]
        gap = rng.choice(["none", "closed", "ventilated"])
        recipes = [name for name in ("cool-roof", "night-ventilation") if rng.random() < 0.5]
        recipes += ["radiant-foil"] * (gap != "none" and rng.random() < 0.5)
        room = Room(
            f"{rng.uniform(2, 9):.2f}x{rng.uniform(2, 6):.2f}x{rng.uniform(2.2, 4):.2f}",
            roof=four[0],
            ceiling=f"{four[1]} + {pcms[k]} {rng.randint(5, 25)}mm",
            walls=f"{four[2]} 8cm + {four[3]}",
            gap=gap,
            windows=(f"{rng.choice(['south', 'east', 'north', 'west'])}:0.9x0.7", "north:0.6x0.6"),
            place=next(climates),
            rooms=rng.choice([1, 1, 2]),
            recipes=tuple(recipes),
        )
        building = building_of(room)
        climate = mc.Climate.shipped(room.place)
        year = climate.index[0].year
        run = mc.simulate(building, climate, start=f"{year}-03-01", end=f"{year}-03-03")
        assert run.energy.closes, room
        for zone in building.zones:
            assert np.isfinite(run[f"{zone}.air_temperature"].to_numpy()).all()


def test_rooms_of_a_house_share_walls() -> None:
    house = building_of(Room("9x4x2.6", rooms=3, place="tampa"))
    assert [*house.zones] == ["room_1", "room_2", "room_3"]
    between = house.surfaces["room_1_room_2"]
    assert (between.outside.zone, between.inside.zone) == ("room_1", "room_2")
    assert float(between.area or 0.0) == pytest.approx(4.0 * 2.6)
    assert "room_2_west" not in house.surfaces
    assert sum(float(zone.volume or 0.0) for zone in house.zones.values()) == pytest.approx(9 * 4 * 2.6)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("new room 4x3", "size: found '4x3'; expected length x width x height"),
        ("new room 4,5x3x2", "Write decimals with a point"),
        ("new room 400x3x2", "a length of 400 m; expected 0.5 to 100 m"),
        ("new room 4x3x2.8 --place paris", "--place: found 'paris'; expected one of saint-denis, tampa"),
        ("new room 4x3x2.8 --walls ''", "--walls: found an empty text"),
        ("new room 4x3x2.8 --ceiling plasterboard+", "found an empty layer"),
        ("new room 4x3x2.8 --gap ventilated", "without a ceiling below it"),
        ("new room 4x3x2.8 --ceiling RT25HC", "without a thickness; expected one, such as 'RT25HC 10mm'"),
        ("new room 4x3x2.8 --ceiling 'plasterbord 12mm'", "Did you mean 'plasterboard'"),
        ("new room 4x3x2.8 --ceiling 'plasterboard 12'", "expected a thickness in mm, cm, m"),
        ("new room 4x3x2.8 --ceiling 'plasterboard 12m'", "a layer of 12 m"),
        ("new room 4x3x2.8 --ceiling 'plasterboard 0mm'", "a layer of 0 m; expected 0.1 mm to 2 m"),
        ("new room 4x3x2.8 --ceiling 'plasterboard -3mm'", "expected a thickness in mm, cm, m"),
        ("new room 4x3x2.8 --ceiling 'plasterboard 12,5mm'", "Write decimals with a point"),
        ("new room 4x3x2.8 --ceiling 'plaster board 12mm'", "Did you mean 'plasterboard'"),
        ("new room 4x0x2.8", "found a width of 0 m; expected 0.5 to 100 m"),
        ("new room 13ftx10ftx9ft", "expected length x width x height in m"),
        ("new room 4x3x2.8 --window south", "expected a wall and a size, such as south:1.2x1.0"),
        ("new room 4x3x2.8 --window soth:1x1", "Did you mean 'south'"),
        ("new room 4x3x2.8 --window south:5x1", "expected at most 3.90 m"),
        ("new room 4x3x2.8 --recipe night-ventilation", "without a window"),
        ("new room 4x3x2.8 --recipe radiant-foil", "without a gap"),
        ("new room 4x3x2.8 --rooms 3", "--rooms: found it for a room, which has no such option"),
        ("new wall 'brick' --outside T", "--inside: found none"),
        ("new wall 'brick 20cm' --inside T --outside U --sensor V=300mm", "below the 200 mm of the wall"),
    ],
)
def test_what_cannot_be_made_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: str, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(shlex.split(words)) == 2
    assert said in capsys.readouterr().err
    assert not any(tmp_path.iterdir())


FEET: Final = {"in": 0.0254, " inch": 0.0254, '"': 0.0254, "''": 0.0254, "ft": 0.3048, " feet": 0.3048}


def test_lengths_in_feet_and_inches_are_refused_with_what_to_write() -> None:
    rng = random.Random(4)
    for name in (*common_materials(), *products()):
        unit = rng.choice([*FEET])
        number = rng.randint(1, 6) if FEET[unit] < 0.1 else rng.choice([0.25, 0.5, 1])
        written = f"{rng.choice([name, name.upper(), name.replace(' ', '_')])} {number}{unit}"
        with pytest.raises(InputError) as refused:
            layers_of(written, "--walls")
        said = str(refused.value)
        assert said.startswith(f"--walls: found '{written}'; expected a thickness in mm, cm, m, such as '")
        (layer,) = layers_of(said.rsplit("such as '", 1)[1].rstrip("'"), "--walls")
        assert layer.thickness == pytest.approx(number * FEET[unit], rel=1e-3)
        (same,) = layers_of(f"{name} 10mm", "--walls")
        assert layer.material == same.material


def test_a_wrong_letter_in_a_material_is_answered_with_the_right_name() -> None:
    rng = random.Random(5)
    names = [*common_materials(), *products()]
    answered = 0
    tried = [name for name in names if len(name) > 5]
    for name in tried:
        k = rng.randrange(1, len(name) - 1)
        wrong = rng.choice([name[:k] + name[k + 1 :], name[:k] + name[k + 1] + name[k] + name[k + 2 :]])
        if wrong.lower() in [other.lower() for other in names]:
            continue
        with pytest.raises(InputError, match="found no material") as refused:
            layers_of(f"{wrong} 10mm", "--walls")
        answered += f"'{name}'" in str(refused.value).rpartition("Did you mean")[2]
    # Products such as RT21HC and RT22HC differ by a letter: a wrong one may be closer to another.
    assert answered >= 0.8 * len(tried)


def test_places_are_known_however_they_are_written() -> None:
    for name in SHIPPED:
        for written in (name.upper(), name.replace("-", " ").title(), f" {name} ", name.replace("-", "_")):
            assert place_of(written) == place_of(name)


def logger(path: Path) -> None:
    """Twelve days of a wall of polystyrene on concrete, from a run with other numbers than assumed."""
    index = pd.date_range("2024-05-01", periods=12 * 96, freq="15min", tz="UTC")
    hour = np.arange(index.size) * 0.25
    frame = pd.DataFrame(index=index)
    frame["T_out"] = 18.0 + 6.0 * np.sin(2 * np.pi * (hour - 9) / 24) + 2.0 * np.sin(2 * np.pi * hour / 110)
    frame["T_in"] = 22.0 + 0.6 * np.sin(2 * np.pi * (hour - 12) / 24)
    from mascarin.templates.wall import Wall

    wall = Wall("concrete 20cm + polystyrene 6cm", "T_in", "T_out", sensors={"T_face": "inside"}).building()
    truth = wall.with_values({"materials.polystyrene.conductivity": 0.033})
    climate = mc.Climate.from_table(
        frame,
        columns={"air_temperature": "T_out"},
        absent=["wind_speed", "wind_direction", "dew_point", "radiation"],
    )
    run = mc.simulate(
        truth,
        climate,
        measurements=mc.Measurements.from_table(frame),
        outputs=["wall.inside_temperature"],
        step="15min",
    )
    table = run.to_dataframe()["wall.inside_temperature"]
    frame["T_face"] = np.interp(
        index.asi8, pd.DatetimeIndex(table.index).asi8, table
    ) + 0.02 * np.random.default_rng(3).standard_normal(index.size)
    frame.index = index.tz_localize(None)
    frame.rename_axis("time").round(4).to_csv(path)


def test_a_wall_with_a_logger_is_calibrated_as_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    logger(tmp_path / "logger.csv")
    words = (
        "new wall 'concrete 20cm + polystyrene 6cm' --inside T_in --outside T_out --sensor T_face=inside "
        "--data logger.csv --timezone UTC --place tampa -o wall"
    )
    assert cli.main(shlex.split(words)) == 0
    study = (tmp_path / "wall" / "study.yaml").read_text()
    assert len(study.splitlines()) <= 30
    assert cli.main(["study", "wall/study.yaml", "-o", "out"]) == 0
    # Continued from what the command has computed; its figures are there.
    results = mc.Study.from_yaml(tmp_path / "wall" / "study.yaml").run(tmp_path / "out", figures=False)
    fit = results.calibration
    assert fit is not None
    k = fit.problem.paths.index("materials.polystyrene.conductivity")
    assert fit.low[k] <= 0.033 <= fit.high[k]


def test_a_cell_gets_a_study_of_its_logger(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    climate = mc.Climate.shipped("tampa")
    table = climate.to_dataframe().iloc[: 24 * 8]
    frame = pd.DataFrame(
        {
            "T": table["air_temperature"],
            "G": table["global_horizontal"],
            "T_room": table["air_temperature"] + 1.0,
            "v": table["wind_speed"],
            "d": table["wind_direction"],
        },
        index=table.index,
    )
    frame.index = pd.DatetimeIndex(frame.index).tz_localize(None)
    frame.rename_axis("time").to_csv("logger.csv")
    words = (
        "new cell 3x3x2.5 --ceiling 'plasterboard + mineral wool' --place tampa --data logger.csv "
        "--timezone UTC-5 --column air_temperature=T --column global_horizontal=G "
        "--sensor T_room=room.air_temperature"
    )
    assert cli.main(shlex.split(words)) == 0
    text = (tmp_path / "cell" / "study.yaml").read_text()
    assert len(text.splitlines()) <= 35
    assert "# Not measured: still air, 70 % of humidity." in text
    # What is said of the weather follows from what is measured.
    assert cli.main(shlex.split(f"{words} --column wind_speed=v -o windy")) == 0
    text = (tmp_path / "windy" / "study.yaml").read_text()
    assert "# Not measured: wind from north, 70 % of humidity." in text
    # The wind drives air through a ventilated gap; a study without it would be refused.
    vented = f"{words} --gap ventilated -o vented"
    assert cli.main(shlex.split(f"{vented} --column wind_speed=v")) == 2
    assert "found no wind_direction; expected both" in capsys.readouterr().err
    assert cli.main(shlex.split(f"{vented} --column wind_speed=v --column wind_direction=d")) == 0
    assert cli.main(["validate", "vented/study.yaml"]) in (0, 1)
    study = mc.Study.from_yaml(tmp_path / "cell" / "study.yaml")
    assert [*study.plan.sensors] == ["T_room"]
    assert cli.main(shlex.split(words.replace("=T ", "=Tx ") + " -o other")) == 2
    assert cli.main(shlex.split(words.replace("room.air", "rooms.air") + " -o other")) == 2


def test_awkward_names_of_columns_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names that mean something in YAML, and a file whose name ends the comment that it stands in."""
    monkeypatch.chdir(tmp_path)
    logger(tmp_path / "plain.csv")
    frame = pd.read_csv("plain.csv")
    names = {"T_in": "air: inside", "T_out": "#2 {out}", "T_face": "face, [wall]: -"}
    file = "a: log #1.csv"
    frame.rename(columns=names).to_csv(file, index=False)
    words = [
        "new", "wall", "concrete 20cm + polystyrene 6cm",
        "--inside", names["T_in"], "--outside", names["T_out"],
        "--sensor", f"{names['T_face']}=inside", "--data", file, "--timezone", "UTC", "--place", "tampa",
    ]  # fmt: skip
    assert cli.main(words) == 0
    study = mc.Study.from_yaml(tmp_path / "wall" / "study.yaml")
    assert [sensor.columns for sensor in study.plan.sensors.values()] == [(names["T_face"],)]
    climate = tmp_path / "x\nzones: {y: {volume: 1}}.epw"
    climate.write_bytes(content(SHIPPED["tampa"].path))
    assert cli.main(["new", "room", "4x3x2.8", "--place", climate.name, "-o", "r"]) == 0
    assert [*mc.load("r/building.yaml").zones] == ["room"]


HEAD = """
site: {latitude: 48, longitude: 2, altitude: 100, timezone: UTC+1}
materials: {brick: {conductivity: 0.6, density: 1600}, pcm: {product: RT25HC}}
constructions: {wall: {layers: [{material: brick, thickness: 0.2}, {material: pcm, thickness: 0.01}]}}
zones: {room: {volume: 30}}
"""
SHARED = """
defaults:
  outdoors: {convection: mowitt, emissivity: 0.9, absorptance: 0.6}
  indoors: {convection: tarp, emissivity: 0.8}
  materials: {specific_heat: 1000}
  zones: {infiltration: 0.5}
surfaces:
  south: {construction: wall, area: 10, tilt: 90, azimuth: 180}
  north: {construction: wall, area: 10, tilt: 90, azimuth: 0, outside: {outdoors: true, emissivity: 0.5}}
  floor: {construction: wall, area: 10, tilt: 180, outside: {adiabatic: true}}
"""


def test_defaults_are_what_would_have_been_written() -> None:
    written = HEAD.replace("density: 1600", "density: 1600, specific_heat: 1000").replace(
        "volume: 30", "volume: 30, infiltration: 0.5"
    )
    inside = "inside: {zone: room, convection: tarp, emissivity: 0.8}"
    written += "surfaces:\n"
    for name, azimuth, emissivity in (("south", 180, 0.9), ("north", 0, 0.5)):
        written += (
            f"  {name}: {{construction: wall, area: 10, tilt: 90, azimuth: {azimuth}, outside: {{outdoors: "
            f"true, convection: mowitt, emissivity: {emissivity}, absorptance: 0.6}}, {inside}}}\n"
        )
    written += (
        f"  floor: {{construction: wall, area: 10, tilt: 180, outside: {{adiabatic: true}}, {inside}}}\n"
    )
    assert parse(HEAD + SHARED, "a.yaml") == parse(written, "a.yaml")


def test_an_error_in_a_default_has_its_line(tmp_path: Path) -> None:
    file = tmp_path / "room.yaml"
    text = HEAD + SHARED
    for old, new, said in (
        ("mowitt", "mowit", "Did you mean 'mowitt'?"),
        ("emissivity: 0.8", "emissivity: 1.8", "emissivity"),
        ("indoors", "indors", "Did you mean 'indoors'"),
    ):
        file.write_text(text.replace(old, new))
        line = next(k for k, row in enumerate(file.read_text().splitlines(), start=1) if new in row)
        line = line if new != "indors" else next(
            k for k, row in enumerate(text.splitlines(), start=1) if row.startswith("defaults")
        )  # fmt: skip
        with pytest.raises(InputError) as caught:
            mc.load(file)
        assert f"room.yaml:{line}:" in str(caught.value)
        assert said in str(caught.value)


def test_a_base_gives_its_defaults_to_what_extends_it(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(HEAD + SHARED)
    (tmp_path / "more.yaml").write_text(
        "extends: base.yaml\nsurfaces:\n  east: {construction: wall, area: 5, tilt: 90, azimuth: 90}\n"
    )
    more = mc.load(tmp_path / "more.yaml")
    assert more.surfaces["east"].outside.emissivity == pytest.approx(0.9)


def test_every_common_material_is_one_of_its_kind() -> None:
    """Where ISO 10456 tabulates a material of the name, the numbers of the table are among them."""
    from mascarin.materials.iso_10456 import unusual

    for name in common_materials():
        material = layers_of(name, "--roof")[0].material
        for quantity in ("conductivity", "density", "specific_heat"):
            number = material[quantity]
            value = number["value"] if isinstance(number, dict) else number
            assert unusual(f"materials.{name.replace(' ', '_')}.{quantity}", value) is None, name


def test_a_date_without_a_year_is_the_first_one_of_the_climate() -> None:
    climate = mc.Climate.shipped("tampa")
    building = building_of(Room("4x3x2.8", place="tampa"))
    short = mc.simulate(building, climate, start="07-01", end="07-02 12:00")
    long = mc.simulate(building, climate, start="2001-07-01", end="2001-07-02 12:00")
    assert short.index.equals(long.index)
    over = mc.simulate(building, climate, start="12-31", end="01-02")
    assert (over.index[-1] - over.index[0]) == pd.Timedelta(days=2)


def test_the_place_of_a_wall_has_no_effect(tmp_path: Path) -> None:
    """As its description says: temperatures and irradiance are measured."""
    from mascarin.templates.wall import Wall

    hours = np.arange(48)
    index = pd.date_range("2024-05-01", periods=48, freq="1h", tz="UTC")
    columns = {
        "T_out": 18.0 + 6.0 * np.sin(hours / 4.0),
        "T_in": 22.0 + np.cos(hours / 5.0),
        "G": np.maximum(500.0 * np.sin((hours % 24 - 6.0) * np.pi / 12.0), 0.0),
    }
    frame = pd.DataFrame(columns, index=index)
    absent = ["wind_speed", "wind_direction", "dew_point", "radiation"]
    climate = mc.Climate.from_table(frame, columns={"air_temperature": "T_out"}, absent=absent)
    for irradiance in ("G", ""):
        wall = Wall("brick 12cm + polystyrene 6cm", "T_in", "T_out", irradiance=irradiance).building()
        places: tuple[dict[str, float], ...] = (
            {},
            {"site.latitude": 60.0, "site.longitude": 10.0, "site.altitude": 400.0},
        )
        here, far = (
            mc.simulate(
                wall.replace(place),
                climate,
                measurements=mc.Measurements.from_table(frame),
                outputs=["wall.inside_temperature"],
                step="1h",
            ).records
            for place in places
        )
        assert np.array_equal(here, far)
