"""Buildings from a few words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mascarin.building.reading import parse
from mascarin.templates.room import Room
from mascarin.templates.room_text import text_of

if TYPE_CHECKING:
    from mascarin.building import Building


def building_of(room: Room) -> Building:
    """The building that the description of a room is read as.

    Parameters
    ----------
    room : Room
        The room.

    Examples
    --------
    >>> round(float(building_of(Room("4x3x2.8")).zones["room"].volume), 2)
    33.6
    """
    return parse(text_of(room), "building.yaml")


def new_room(
    size: str,
    *,
    roof: str = Room.roof,
    ceiling: str = Room.ceiling,
    walls: str = Room.walls,
    floor: str = Room.floor,
    gap: str = Room.gap,
    windows: Sequence[str] = (),
    place: str = Room.place,
    rooms: int = 1,
    recipes: Sequence[str] = (),
) -> Building:
    """Describe a room, or a row of equal rooms, in a few words.

    Parameters
    ----------
    size : str
        Length (east to west), width (north to south) and height in m, such as ``4x3x2.8``.
    roof, ceiling, walls, floor : str
        Layers from inside to outside, such as ``plasterboard 12.5mm + SP24E 15mm``: common materials, and
        the products of `mascarin.materials`. A common material has a typical thickness.
    gap : str
        Air between roof and ceiling: ``none``, ``closed`` or ``ventilated``.
    windows : sequence of str
        Such as ``south:1.2x1.0``; of every room.
    place : str
        A shipped climate such as ``saint-denis``, or a weather file: its site is that of the room.
    rooms : int
        How many; the length is divided among them.
    recipes : sequence of str
        ``cool-roof``, ``radiant-foil``, ``night-ventilation``.

    Returns
    -------
    Building
        All numbers that were not stated are marked as assumed, with a range.

    Raises
    ------
    InputError
        A word that is not known; the text lists what is.

    Examples
    --------
    >>> import mascarin as mc
    >>> room = mc.new_room("4x3x2.8", gap="ventilated", ceiling="plasterboard 12.5mm + SP24E 15mm")
    >>> run = mc.simulate(room, mc.Climate.shipped("saint-denis"), start="2023-02-01", end="2023-02-03")
    >>> bool(run.energy.closes)
    True
    """
    room = Room(
        size, roof=roof, ceiling=ceiling, walls=walls, floor=floor, gap=gap, windows=tuple(windows),
        place=place, rooms=rooms, recipes=tuple(recipes),
    )  # fmt: skip
    return building_of(room)
