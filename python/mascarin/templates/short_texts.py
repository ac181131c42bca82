"""Read what users write in a few words: sizes, layers and windows.

A size is ``4x3x2.8`` [m], layers ``plasterboard 12.5mm + SP24E 15mm``, a window ``south:1.2x1.0``.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from mascarin.errors import InputError, did_you_mean

WALLS: Final = {"south": 180.0, "east": 90.0, "north": 0.0, "west": 270.0}
"""Walls of a room by the direction that they face, with their azimuth [deg]."""

#: Texts that need no quotes in YAML.
_PLAIN: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*")
_NUMBER: Final = r"(\d+(?:\.\d+)?)"
_UNITS: Final = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
#: Units of lengths that are not read, for a remedy. [m]
_FOREIGN_UNITS: Final = {
    "in": 0.0254, "inch": 0.0254, "inches": 0.0254, '"': 0.0254, "''": 0.0254, "ft": 0.3048, "foot": 0.3048,
    "feet": 0.3048, "'": 0.3048,
}  # fmt: skip
_FOREIGN: Final = re.compile(
    rf"(?P<number>\d+(?:\.\d+)?)\s*(?P<unit>{'|'.join(sorted(_FOREIGN_UNITS, key=len)[::-1])})(?![a-z])"
)
_LAYER: Final = re.compile(rf"^(?P<name>.+?)(?:\s+{_NUMBER}\s*(?P<unit>[a-zA-Z]+)?)?$")
#: Limits of lengths of a room [m] and of a layer [m].
_ROOM: Final = (0.5, 100.0)
_THICKNESS: Final = (1e-4, 2.0)


@dataclass(frozen=True, slots=True)
class LayerText:
    """A layer: a common material, or a phase-change product.

    Attributes
    ----------
    name : str
        Name of the material in the description.
    material : dict
        Its keys in the description.
    thickness : float
        [m]
    assumed : bool
        Whether the thickness is a typical one.
    """

    name: str
    material: dict[str, Any]
    thickness: float
    assumed: bool = False


@dataclass(frozen=True, slots=True)
class WindowText:
    """A window: the wall that it is in, its width and height [m]."""

    wall: str
    width: float
    height: float


def quoted(text: str) -> str:
    """A text as YAML reads it back, whatever characters it has.

    Examples
    --------
    >>> quoted("T_room"), quoted("T room [degC]: 1")
    ('T_room', '"T room [degC]: 1"')
    """
    return text if _PLAIN.fullmatch(text) else json.dumps(text, ensure_ascii=False)


def name_of(column: str) -> str:
    """A name of a part from that of a column.

    Examples
    --------
    >>> name_of("T room [degC]"), name_of("2 m")
    ('T_room_degC', 'column_2_m')
    """
    name = re.sub(r"[^A-Za-z0-9_]+", "_", column).strip("_")
    return name if name[:1].isalpha() else f"column_{name}".rstrip("_")


def size_of(text: str, option: str = "size") -> tuple[float, float, float]:
    """Length (east to west), width (north to south) and height of a room.

    Parameters
    ----------
    text : str
        Such as ``4x3x2.8``.
    option : str
        Named in errors.

    Returns
    -------
    tuple of float
        [m]

    Raises
    ------
    InputError
        Not three lengths, or one that no room has.

    Examples
    --------
    >>> size_of("4 x 3 x 2.8")
    (4.0, 3.0, 2.8)
    """
    numbers = _lengths(text, 3, option, "length x width x height in m, such as 4x3x2.8")
    for name, value in zip(("length", "width", "height"), numbers, strict=True):
        if not _ROOM[0] <= value <= _ROOM[1]:
            raise InputError(
                f"{option}: found a {name} of {value:g} m; expected {_ROOM[0]:g} to {_ROOM[1]:g} m. Write "
                "lengths in m, such as 4x3x2.8"
            )
    return numbers[0], numbers[1], numbers[2]


def _lengths(text: str, count: int, option: str, expected: str) -> list[float]:
    parts = re.split(r"\s*[xX×*]\s*", text.strip())
    if len(parts) != count or not all(re.fullmatch(rf"{_NUMBER}\s*m?", part) for part in parts):
        comma = " Write decimals with a point." if "," in text else ""
        raise InputError(f"{option}: found '{text}'; expected {expected}.{comma}")
    return [float(re.sub(r"\s*m$", "", part)) for part in parts]


def window_of(text: str) -> WindowText:
    """Read a window.

    Parameters
    ----------
    text : str
        Wall, width and height, such as ``south:1.2x1.0``.

    Raises
    ------
    InputError
        No such wall, or no size.

    Examples
    --------
    >>> window_of("south:1.2x1.0")
    WindowText(wall='south', width=1.2, height=1.0)
    """
    wall, colon, size = text.partition(":")
    wall = wall.strip().lower()
    if not colon or wall not in WALLS:
        raise InputError(
            f"--window: found '{text}'; expected a wall and a size, such as south:1.2x1.0, with one of "
            f"{', '.join(WALLS)}. {'' if wall in WALLS else did_you_mean(wall, WALLS, known=False)}".rstrip(
                " "
            )
        )
    width, height = _lengths(size, 2, "--window", "width x height in m, such as south:1.2x1.0")
    return WindowText(wall, width, height)


def layers_of(text: str, option: str) -> list[LayerText]:
    """Read the layers of a wall, from inside to outside.

    Parameters
    ----------
    text : str
        Materials with their thicknesses, such as ``plasterboard 12.5mm + SP24E 15mm``. The thickness may be
        left out where a material has a typical one.
    option : str
        Named in errors.

    Returns
    -------
    list of LayerText
        From inside to outside.

    Raises
    ------
    InputError
        No material or product of this name, a thickness without unit or beyond what a layer has.

    Examples
    --------
    >>> layers = layers_of("plasterboard 12.5mm + RT25HC 15mm", "--ceiling")
    >>> [(layer.name, layer.thickness) for layer in layers]
    [('plasterboard', 0.0125), ('rt25hc', 0.015)]
    """
    if not text.strip():
        raise InputError(
            f"{option}: found no layer; expected materials, such as 'plasterboard 12.5mm + RT25HC 15mm'"
        )
    return [_layer(part.strip(), option) for part in text.split("+")]


def _layer(text: str, option: str) -> LayerText:
    # A name that ends in a number, such as RT21HC 10, is read as a product first.
    match = _LAYER.match(text)
    if match is None:
        raise InputError(f"{option}: found an empty layer; expected a material between two '+'")
    product_entry, product = _material(text)
    if product_entry is not None:
        name, (material, typical) = text, product_entry
        number = unit = None
    else:
        name, number, unit = match["name"], match[2], match["unit"]
        entry, product = _material(name)
        if entry is None and (stem := _stem(text)):
            raise InputError(_no_thickness(text, stem, option))
        if entry is None:
            names = [*common_materials(), *product]
            closest = did_you_mean(name, names, known=False)
            raise InputError(
                f"{option}: found no material '{name}'; expected a product that 'mascarin materials' lists, "
                f"or one of {', '.join(common_materials())}. {closest}".rstrip()
            )
        material, typical = entry
    thickness, assumed = _thickness(text, number, unit, typical, option)
    return LayerText(
        re.sub(r"[^a-z0-9]+", "_", name.strip().lower()).strip("_"), material, thickness, assumed
    )


def _thickness(
    text: str, number: str | None, unit: str | None, typical: float | None, option: str
) -> tuple[float, bool]:
    if number is None:
        if typical is None:
            raise InputError(
                f"{option}: found '{text}' without a thickness; expected one, such as '{text} 10mm'"
            )
        return typical, True
    if unit not in _UNITS:
        raise InputError(_no_thickness(text, _stem(text), option))
    thickness = round(float(number) * _UNITS[unit], 9)
    if not _THICKNESS[0] <= thickness <= _THICKNESS[1]:
        raise InputError(
            f"{option}: found '{text}', a layer of {thickness:g} m; expected {1e3 * _THICKNESS[0]:g} mm to "
            f"{_THICKNESS[1]:g} m. Check the unit"
        )
    return thickness, False


def _stem(text: str) -> str:
    """The material in a layer whose thickness cannot be read; empty where there is none."""
    words = text.strip().lower().replace("_", " ")
    names = sorted((*common_materials(), *_products()), key=len, reverse=True)
    for name in names:
        beside = re.fullmatch(rf"{re.escape(name)}\s*([^a-z\s].*)|(.*\d.*?)\s*{re.escape(name)}", words)
        if beside and re.search(r"\d", beside[1] or beside[2]):
            return _products().get(name, name)
    return ""


def _no_thickness(text: str, stem: str, option: str) -> str:
    """What is wrong with a thickness, and how to write it."""
    expected = f"{option}: found '{text}'; expected a thickness in {', '.join(_UNITS)}"
    beyond = text.lower().replace(stem.lower(), "", 1)
    foreign = _FOREIGN.search(beyond)
    if foreign is not None:
        length = float(foreign["number"]) * _FOREIGN_UNITS[foreign["unit"]]
        return f"{expected}, such as '{f'{stem} {1e3 * length:.4g}mm'.strip()}'"
    comma = " Write decimals with a point." if re.search(r"\d,\d", beyond) else ""
    example = f"'{stem} 12.5mm'" if stem else "12.5mm"
    return f"{expected}, such as {example}.{comma}"


def _products() -> dict[str, str]:
    """Names of products by their names in lower case."""
    from mascarin.materials.library import products

    return {product.lower(): product for product in products()}


def _material(name: str) -> tuple[tuple[dict[str, Any], float | None] | None, list[str]]:
    """Keys and typical thickness of a material, none if there is no such; and the names of all products."""
    names = _products()
    table, common = common_materials(), name.strip().lower().replace("_", " ")
    if common in table:
        row = dict(table[common])
        thickness, limits = row.pop("thickness"), row.pop("range")
        source = row.pop("source", "ISO 10456:2007, table 3")
        row["conductivity"] = {
            "value": row["conductivity"],
            "range": limits,
            "source": source,
            "assumed": True,
        }
        return (row, thickness), list(names.values())
    if name.strip().lower() in names:
        return ({"product": names[name.strip().lower()]}, None), list(names.values())
    return None, list(names.values())


def common_materials() -> dict[str, dict[str, Any]]:
    """Common materials by name; see ``materials.yaml``.

    Examples
    --------
    >>> common_materials()["steel"]["thickness"]
    0.001
    """
    from mascarin.building.files.yaml_document import plain

    file = Path(__file__).with_name("materials.yaml")
    table: dict[str, dict[str, Any]] = plain(file.read_text("utf-8"), file.name)
    return table
