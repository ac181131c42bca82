"""A room or a house from a few words: its description as a short YAML file with comments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from mascarin.errors import InputError, did_you_mean
from mascarin.templates.geometry import MARGIN, WALLS
from mascarin.templates.short_texts import LayerText, WindowText, layers_of, size_of, window_of

GAPS: Final = ("none", "closed", "ventilated")
"""Air between roof and ceiling."""
RECIPES: Final = {
    "cool-roof": "a white coating on the roof",
    "radiant-foil": "bright foil on the upper side of the ceiling; needs a gap",
    "night-ventilation": "windows that open at night when it is cooler outdoors; needs windows",
}
"""Changes of a room by name."""
#: Layers between two rooms.
_PARTITION: Final = "plasterboard + mineral wool 50mm + plasterboard"


@dataclass(frozen=True)
class Room:
    """A room, or a row of equal rooms from west to east.

    Attributes
    ----------
    size : str
        Length (east to west), width and height in m, such as ``4x3x2.8``.
    roof, ceiling, walls, floor : str
        Layers from inside to outside, such as ``plasterboard 12.5mm + SP24E 15mm``. An empty ceiling is none.
    gap : str
        Air between roof and ceiling: ``none``, ``closed`` or ``ventilated``.
    windows : tuple of str
        Such as ``south:1.2x1.0``; of every room.
    place : str
        A shipped climate, or a weather file.
    rooms : int
        How many.
    recipes : tuple of str
        Names of `RECIPES`.
    command : str
        What made it, for the first comment.

    Examples
    --------
    >>> room = Room("4x3x2.8", gap="ventilated", ceiling="plasterboard 12.5mm + RT25HC 15mm")
    >>> [*room.layers]
    ['roof', 'wall', 'floor', 'ceiling']
    """

    size: str
    roof: str = "steel"
    ceiling: str = ""
    walls: str = "plasterboard + mineral wool + fibre cement"
    floor: str = "concrete + soil"
    gap: str = "none"
    windows: tuple[str, ...] = ()
    place: str = "saint-denis"
    rooms: int = 1
    recipes: tuple[str, ...] = ()
    command: str = field(default="mascarin new room", compare=False)

    def __post_init__(self) -> None:
        """Check what the words say together.

        Raises
        ------
        InputError
            A gap without a ceiling, a recipe that needs another option, windows that do not fit.
        """
        _require("--gap", self.gap, GAPS)
        for recipe in self.recipes:
            _require("--recipe", recipe, tuple(RECIPES))
        if self.gap != "none" and not self.ceiling:
            raise InputError(
                f"--gap: found '{self.gap}' without a ceiling below it; expected its layers, such as "
                "--ceiling 'plasterboard 12.5mm + RT25HC 15mm'"
            )
        if "radiant-foil" in self.recipes and self.gap == "none":
            raise InputError("--recipe: found radiant-foil without a gap that it faces; add --gap closed")
        if "night-ventilation" in self.recipes and not self.windows:
            raise InputError(
                "--recipe: found night-ventilation without a window; add one, such as --window south:1.2x1.0"
            )
        if not 1 <= self.rooms <= 20:
            raise InputError(f"--rooms: found {self.rooms}; expected 1 to 20")
        self._fits()

    def _fits(self) -> None:
        """Check that the windows of each wall fit beside each other."""
        length, width, height = size_of(self.size)
        for wall in WALLS:
            windows = [window for window in self.openings if window.wall == wall]
            along = (length / self.rooms if wall in ("south", "north") else width) - 2.0 * MARGIN
            need = sum(window.width + MARGIN for window in windows) - MARGIN if windows else 0.0
            high = max((window.height for window in windows), default=0.0)
            if need > along or high > height - 2.0 * MARGIN:
                raise InputError(
                    f"--window: found {len(windows)} of {need:.2f} m in all and up to {high:g} m high in the "
                    f"{wall} wall; expected at most {along:.2f} m and {height - 2.0 * MARGIN:.2f} m. Make "
                    "them smaller, or the room larger"
                )

    @property
    def openings(self) -> list[WindowText]:
        """Windows of every room."""
        return [window_of(text) for text in self.windows]

    @property
    def layers(self) -> dict[str, list[LayerText]]:
        """Layers by construction, from inside to outside."""
        roof, walls, floor = (
            layers_of(text, option)
            for text, option in ((self.roof, "--roof"), (self.walls, "--walls"), (self.floor, "--floor"))
        )
        ceiling = layers_of(self.ceiling, "--ceiling") if self.ceiling else []
        layers = {"roof": roof if self.gap != "none" else [*ceiling, *roof], "wall": walls, "floor": floor}
        if self.gap != "none":
            layers["ceiling"] = ceiling
        if self.rooms > 1:
            layers["partition"] = layers_of(_PARTITION, "--rooms")
        return layers

    @property
    def names(self) -> list[str]:
        """Names of the rooms, from west to east."""
        return ["room"] if self.rooms == 1 else [f"room_{k + 1}" for k in range(self.rooms)]


def _require(option: str, value: str, allowed: Sequence[str]) -> None:
    if value not in allowed:
        raise InputError(
            f"{option}: found '{value}'; expected one of {', '.join(allowed)}. "
            f"{did_you_mean(value, allowed, known=False)}".rstrip()
        )
