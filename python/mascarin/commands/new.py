"""The command that describes a room, house, cell or wall from a few words."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Final, Literal

from cyclopts import Parameter

from mascarin._io.atomic import write
from mascarin._io.locks import writing_into
from mascarin.errors import InputError

#: Options of each kind, beside the folder.
_ROOM: Final = {"roof", "ceiling", "walls", "floor", "gap", "window", "place", "recipe"}
_OPTIONS: Final = {
    "room": _ROOM,
    "house": {*_ROOM, "rooms"},
    "cell": {*_ROOM, "data", "timezone", "sensor", "column"},
    "wall": {"place", "data", "timezone", "sensor", "inside", "outside", "irradiance"},
}

Words = Annotated[list[str] | None, Parameter(negative="")]


def new(
    kind: Literal["room", "house", "cell", "wall"],
    what: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    roof: str | None = None,
    ceiling: str | None = None,
    walls: str | None = None,
    floor: str | None = None,
    gap: str | None = None,
    window: Words = None,
    recipe: Words = None,
    rooms: int | None = None,
    location: Annotated[str | None, Parameter(name="--place")] = None,
    data: Path | None = None,
    timezone: str | None = None,
    inside: str | None = None,
    outside: str | None = None,
    irradiance: str | None = None,
    column: Words = None,
    sensor: Words = None,
) -> None:
    """Describe a room, house, cell or wall from a few words.

    Writes building.yaml, a short description with comments, and prints the next command. A cell or a wall
    with the data of a logger gets study.yaml as well. Layers are named from inside to outside; a common
    material has a typical thickness. Every number that was not stated is marked as assumed, with a range.

    Parameters
    ----------
    kind : str
        room; house: rooms in a row; cell: a measured room; wall: one wall between two measured temperatures.
    what : str
        Size of the room in m, length (east to west) x width x height, such as 4x3x2.8; or layers of the wall,
        such as 'plasterboard + mineral wool 100mm + brick'.
    out : Path
        The new folder; by default the kind.
    roof : str
        Layers of the roof; steel by default.
    ceiling : str
        Layers below the roof, such as 'plasterboard 12.5mm + SP24E 15mm'; with --gap below the air gap.
    walls : str
        Layers of the walls; plasterboard, mineral wool and fibre cement by default.
    floor : str
        Layers of the floor on the ground; concrete on soil by default.
    gap : str
        Air between roof and ceiling: none, closed or ventilated.
    window : list of str
        Such as south:1.2x1.0; may be repeated.
    recipe : list of str
        cool-roof, radiant-foil, night-ventilation; may be repeated.
    rooms : int
        Number of rooms of a house, 2 by default; they divide the length.
    location : str
        A climate that 'mascarin weather' lists, saint-denis by default, or an EPW file.
    data : Path
        Logger file of a cell or wall; it is copied into the folder.
    timezone : str
        Time zone of its clock, such as UTC+4.
    inside : str
        Column with the air temperature on the inner side of a wall.
    outside : str
        Column with the air temperature on the outer side of a wall.
    irradiance : str
        Column with the solar irradiance on the plane of a wall.
    column : list of str
        Weather of a cell: CHANNEL=COLUMN, such as air_temperature=T_out; may be repeated.
    sensor : list of str
        What is compared: COLUMN=OUTPUT of a cell, such as T_room=room.air_temperature; COLUMN=PLACE of a
        wall: its surface (T_wall=inside), or a depth that is counted from the inner surface (T_mid=55mm); may
        be repeated.
    """
    options = {
        "roof": roof, "ceiling": ceiling, "walls": walls, "floor": floor, "gap": gap, "window": window,
        "recipe": recipe, "rooms": rooms, "place": location, "data": data, "timezone": timezone,
        "inside": inside, "outside": outside, "irradiance": irradiance, "column": column, "sensor": sensor,
    }  # fmt: skip
    stated = {name: value for name, value in options.items() if value is not None}
    beside = [name for name in stated if name not in _OPTIONS[kind]]
    if beside:
        raise InputError(
            f"--{beside[0]}: found it for a {kind}, which has no such option; expected some of "
            f"--{', --'.join(sorted(_OPTIONS[kind]))}"
        )
    for name, value in stated.items():
        if any(not str(text).strip() for text in (value if isinstance(value, list) else [value])):
            raise InputError(f"--{name}: found an empty text; expected one with words. Leave the option out")
    files, weather = (_wall if kind == "wall" else _room)(kind, what, stated)
    _write(out or Path(kind), files, data, weather)


def _room(kind: str, size: str, stated: Mapping[str, object]) -> tuple[dict[str, str], str]:
    """Files of a room, a house or a cell, and its weather."""
    from mascarin.templates.new_buildings import building_of
    from mascarin.templates.place import place_of
    from mascarin.templates.room import Room
    from mascarin.templates.room_text import text_of

    fields = {
        name: value
        for name, value in stated.items()
        if name in ("roof", "ceiling", "walls", "floor", "gap", "place")
    }
    room = Room(
        size,
        windows=tuple(_texts(stated, "window")),
        recipes=tuple(_texts(stated, "recipe")),
        rooms=int(str(stated.get("rooms", 2))) if kind == "house" else 1,
        command=" ".join(["mascarin new", kind, size, *_words(stated)]),
        **{name: str(value) for name, value in fields.items()},
    )
    building_of(room)
    files = {"building.yaml": text_of(room)}
    if kind == "cell":
        from mascarin.templates.cell import cell_study

        record = _record(stated)
        columns = _pairs(_texts(stated, "column"), "--column")
        files["study.yaml"] = cell_study(room, record, columns, _pairs(_texts(stated, "sensor"), "--sensor"))
    return files, place_of(room.place).weather


def _wall(_: str, layers: str, stated: Mapping[str, object]) -> tuple[dict[str, str], str]:
    """Files of a wall; without data its description alone."""
    from mascarin.templates.place import coordinates_of
    from mascarin.templates.wall import Wall

    sides = {}
    for name in ("inside", "outside"):
        if name not in stated:
            raise InputError(
                f"--{name}: found none; expected the column of the air temperature on this side, such as "
                f"--{name} T_{name}"
            )
        sides[name] = str(stated[name])
    latitude, longitude, altitude, zone = coordinates_of(str(stated.get("place", "saint-denis")))
    wall = Wall(
        layers,
        sides["inside"],
        sides["outside"],
        str(stated.get("irradiance", "")),
        _pairs(_texts(stated, "sensor"), "--sensor"),
        latitude,
        longitude,
        altitude,
        str(stated.get("timezone", zone)),
    )
    wall.building()
    files = {"building.yaml": wall.yaml()}
    if "data" in stated:
        files["study.yaml"] = wall.study(_record(stated))
    return files, ""


def _record(stated: Mapping[str, object]):  # type: ignore[no-untyped-def]
    from mascarin.templates.study_text import LoggerRecord

    for name, example in (("data", "logger.csv"), ("timezone", "UTC+4")):
        if name not in stated:
            raise InputError(
                f"--{name}: found none; expected it for measurements, such as --{name} {example}"
            )
    return LoggerRecord.of_file(Path(str(stated["data"])), str(stated["timezone"]))


def _texts(stated: Mapping[str, object], name: str) -> Sequence[str]:
    value = stated.get(name, ())
    return [str(text) for text in value] if isinstance(value, list) else []


def _pairs(texts: Sequence[str], option: str) -> dict[str, str]:
    pairs = {}
    for text in texts:
        key, sign, value = (part.strip() for part in text.partition("="))
        if not (key and sign and value):
            raise InputError(f"{option}: found '{text}'; expected two names with '=' between them")
        pairs[key] = value
    return pairs


def _words(stated: Mapping[str, object]) -> list[str]:
    """The options as they were written."""
    words = []
    for name, value in stated.items():
        for text in value if isinstance(value, list) else [value]:
            quoted = f"'{text}'" if " " in str(text) else str(text)
            words.append(re.sub(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]", " ", f"--{name} {quoted}"))
    return words


def _write(folder: Path, files: Mapping[str, str], data: Path | None, weather: str) -> None:
    """Write all files into a new folder, and print what comes next."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(
            f"{folder}: is there already; expected a new folder, as nothing is overwritten. Use -o"
        )
    with writing_into(folder):
        for name, text in files.items():
            print(write(folder / name, text.encode("utf-8")))
        if data is not None:
            shutil.copyfile(data, folder / data.name)
            print(folder / data.name)
    building, study = folder / "building.yaml", folder / "study.yaml"
    lines = [f"mascarin check '{building}'"]
    if "study.yaml" in files:
        lines += [f"mascarin validate '{study}'", f"mascarin study '{study}' -o '{folder / 'out'}'"]
    elif weather:
        lines += [
            f"mascarin run '{building}' --weather '{weather}' --report '{folder / 'run.html'}'",
            f"mascarin explore '{building}' --weather '{weather}'",
        ]
    print("next: " + "\n      ".join(lines), file=sys.stderr)
