"""What each kind of output is, from the table of the engine: names, unit, meaning, where it exists."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from mascarin import _engine

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


class OutputName(NamedTuple):
    """A name of a kind of output for the parts of one sort.

    Attributes
    ----------
    owner : str
        What the parts are: ZONE, SURFACE, WINDOW, VENT, CONTROL, SOURCE or SENSOR; nothing for the building.
    pattern : str
        The name; words in capitals stand for names of the description, SIDE for outside or inside, N for a
        number.
    alias : str
        Pattern of a second name; nothing where there is none.
    """

    owner: str
    pattern: str
    alias: str


class OutputKind(NamedTuple):
    """A kind of output: a row of the engine's table (``crates/engine/src/run/outputs/mod.rs``).

    Attributes
    ----------
    names : tuple of OutputName
        Its names, those of different parts.
    unit : str
        Its unit.
    meaning : str
        What it is.
    exists : str
        For what there is such an output.
    of : str
        The parts that have it, as `mascarin.building.outputs.locations` lists them.
    label : str
        Title of figures of it.
    mean : bool
        Whether a record is the mean over the interval before it, and not a state at its time.
    usual : bool
        Whether a run records it where no outputs are named.
    """

    names: tuple[OutputName, ...]
    unit: str
    meaning: str
    exists: str
    of: str
    label: str
    mean: bool
    usual: bool

    @property
    def patterns(self) -> list[str]:
        """Every name and second name, with the sides in words."""
        return [side for name in self.names for pattern in name[1:] if pattern for side in _sides(pattern)]


def _sides(pattern: str) -> list[str]:
    if "SIDE" not in pattern:
        return [pattern]
    return [pattern.replace("SIDE", side) for side in ("outside", "inside")]


def _read(row: Mapping[str, Any]) -> OutputKind:
    return OutputKind(
        names=tuple(_names(row["name"])),
        unit=row["unit"],
        meaning=row["meaning"],
        exists=row["exists"],
        of=row["of"],
        label=row["label"],
        mean=row["time"] == "mean",
        usual=row["usual"],
    )


def _names(written: str) -> Iterator[OutputName]:
    for word in written.split(", "):
        pattern, _, alias = word.partition(" or ")
        owner = re.match(r"([A-Z]+)\.", pattern)
        yield OutputName("" if owner is None else owner[1], pattern, alias)


KINDS: Final[Mapping[str, OutputKind]] = {
    row["kind"]: _read(row) for row in json.loads(_engine.output_table())
}
"""Every kind of output, zones first."""
