"""What a conversion carried over in another form or not at all, object by object."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Final, Literal

from mascarin.energyplus.model.effects import Effect, effect_of
from mascarin.energyplus.model.idf import IdfObject

Level = Literal["left out", "approximated", "no effect"]

#: Levels in the order in which they are listed.
LEVELS: Final[tuple[Level, ...]] = ("left out", "approximated", "no effect")


@dataclass(frozen=True)
class Finding:
    """One object, or one property of it, that is not carried over as it is.

    Attributes
    ----------
    level : str
        ``left out``: not carried over, the results change. ``approximated``: carried over in another form,
        whose effect is stated. ``no effect``: not needed here.
    kind, name : str
        Class and name of the object; several names for objects of the same kind without effect.
    line : int or None
        Line in the file.
    what : str
        What was found.
    effect : str
        What this does to the results.
    measured : Effect or None
        Its size in small rooms in EnergyPlus with the object, and without it, where it was measured.
    """

    level: Level
    kind: str
    name: str
    line: int | None
    what: str
    effect: str
    measured: Effect | None = None

    @property
    def kelvin(self) -> float | None:
        """Measured effect on the air temperature of a small room; None where it was not measured. [K]"""
        return None if self.measured is None else self.measured.kelvin

    @property
    def consequence(self) -> str:
        """The effect, with its measured size."""
        return self.effect if self.measured is None else f"{self.effect}: {self.measured.text()}"

    def text(self) -> str:
        """The finding on one line."""
        position = "" if self.line is None else f"line {self.line}: "
        name = f" '{self.name}'" if self.name else ""
        return f"{position}{self.kind}{name}: {self.what}: {self.consequence}"


@dataclass
class Findings:
    """Findings in the order in which they were made, each once."""

    unique: dict[Finding, None] = field(default_factory=dict)
    _objects: set[tuple[str, str, int | None, str]] = field(default_factory=set)

    def left_out(self, item: IdfObject, what: str, effect: str) -> None:
        """Note an object or property that is not carried over and changes the results."""
        self._add("left out", item, what, effect)

    def approximated(self, item: IdfObject, what: str, effect: str) -> None:
        """Note an object or property that is carried over in another form."""
        self._add("approximated", item, what, effect)

    def no_effect(self, items: Iterable[IdfObject], what: str, effect: str) -> None:
        """Note objects of one class that are not needed."""
        objects = list(items)
        if len(objects) == 1:
            self._add("no effect", objects[0], what, effect)
        elif objects:
            count = f"{len(objects)} objects"
            self.unique[Finding("no effect", objects[0].kind, count, objects[0].line, what, effect)] = None

    def _add(self, level: Level, item: IdfObject, what: str, effect: str) -> None:
        measured = None if level == "no effect" else effect_of(item.kind, what)
        self.unique[Finding(level, item.kind, item.name, item.line, what, effect, measured)] = None
        self._objects |= {(item.kind, item.name, item.line, any_level) for any_level in ("", level)}

    def about(self, item: IdfObject, level: Level | Literal[""] = "") -> bool:
        """Whether something is noted about an object; of one level, if it is given."""
        return (item.kind, item.name, item.line, level) in self._objects

    def of(self, level: Level) -> list[Finding]:
        """Findings of one level, by line."""
        return sorted(
            (finding for finding in self.unique if finding.level == level),
            key=lambda finding: finding.line or 0,
        )
