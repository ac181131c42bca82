"""What the commands read alike: a building with ``--set``, a time step."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from cyclopts import Parameter

from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building

Flag: Final = Parameter(negative="", show_default=False)
"""An option that is there or not."""

Settings = Annotated[
    list[str] | None,
    Parameter(
        name="--set", negative="", help="Other value for a parameter, as PATH=VALUE; may be given again."
    ),
]
AsJson = Annotated[bool, Flag, Parameter(name="--json", help="Print the result as JSON.")]
Step = Annotated[str, Parameter(help="Time step, such as 900, 15min or 1h.")]


def read_building(file: Path, settings: Sequence[str] | None) -> Building:
    """Read a building and give it the values of ``--set``.

    Parameters
    ----------
    file : Path
        Its description.
    settings : sequence of str or None
        Each as ``path=value``.

    Raises
    ------
    InputError
        If the description or a setting cannot be used.
    """
    from mascarin.building import load

    building = load(file)
    values = dict(_setting(text) for text in settings or ())
    return building.replace(values) if values else building


def _setting(text: str) -> tuple[str, float]:
    path, equals, value = text.partition("=")
    try:
        if equals and path.strip():
            return path.strip(), float(value)
    except ValueError:
        pass
    raise InputError(f"--set: found '{text}'; expected PATH=NUMBER, such as zones.room.volume=27")


def seconds(text: str) -> float:
    """Time step in words as a number.

    Parameters
    ----------
    text : str
        A number with ``s``, ``min`` or ``h``, or without: seconds.

    Returns
    -------
    float
        The step. [s]

    Raises
    ------
    InputError
        If it is no such text, or not positive.
    """
    from mascarin.weather.times import seconds_of

    return seconds_of(text, "--step")
