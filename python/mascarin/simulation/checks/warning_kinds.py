"""A warning of a run: its text, and its kind, which exit codes read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum
from typing import Any, Final, Self

from mascarin._io.sealed.own_files import json_of


class WarningKind(StrEnum):
    """What a warning of a run is about.

    Examples
    --------
    >>> WarningKind("vapour_balance") in UNSOUND, WarningKind.LATENT in UNSOUND
    (True, False)
    """

    ENERGY_BALANCE = "energy_balance"
    VAPOUR_BALANCE = "vapour_balance"
    CAUSE = "cause"
    FAILURE = "failure"
    STEP = "step"
    SATURATION = "saturation"
    VALIDITY = "validity"
    LATENT = "latent"
    BUILDING = "building"
    METHOD = "method"
    UNKNOWN = "unknown"


UNSOUND: Final = frozenset(
    {WarningKind.ENERGY_BALANCE, WarningKind.VAPOUR_BALANCE, WarningKind.CAUSE, WarningKind.FAILURE}
)
"""Kinds that say that results are not to be used as they are: exit code 1."""


class RunWarning(str):
    """The text of a warning, with its kind.

    A text made of it, as by an f-string, has no kind: use `after`.

    Parameters
    ----------
    text : str
        The warning.
    kind : WarningKind
        What it is about.

    Examples
    --------
    >>> line = RunWarning("the energy balance does not close", WarningKind.ENERGY_BALANCE)
    >>> line.after("tampa").kind
    <WarningKind.ENERGY_BALANCE: 'energy_balance'>
    >>> print(line.after("tampa"))
    tampa: the energy balance does not close
    """

    __slots__ = ("kind",)

    kind: WarningKind

    def __new__(cls, text: str, kind: WarningKind) -> Self:
        """Make the text, which does not change."""
        line = super().__new__(cls, text)
        line.kind = kind
        return line

    def __reduce__(self) -> tuple[type[RunWarning], tuple[str, WarningKind]]:
        """Text and kind, for a copy in another process."""
        return type(self), (str(self), self.kind)

    @property
    def unsound(self) -> bool:
        """Whether it says that results are not to be used as they are."""
        return self.kind in UNSOUND

    def after(self, words: str) -> RunWarning:
        """The same with words before it that say where it holds.

        Parameters
        ----------
        words : str
            Such as the name of a climate.
        """
        return RunWarning(f"{words}: {self}", self.kind)


def of_kind(kind: WarningKind, lines: Iterable[str]) -> list[RunWarning]:
    """Texts as warnings of one kind; what has a kind keeps it.

    Parameters
    ----------
    kind : WarningKind
        The kind.
    lines : iterable of str
        The texts.

    Examples
    --------
    >>> [line.kind.value for line in of_kind(WarningKind.BUILDING, ["zones.room: a volume of 0.3 m3"])]
    ['building']
    """
    return [line if isinstance(line, RunWarning) else RunWarning(line, kind) for line in lines]


def kinds_of(lines: Iterable[str]) -> list[str]:
    """The kinds of warnings, for a file that has their texts beside them.

    Parameters
    ----------
    lines : iterable of str
        The warnings.
    """
    return [line.kind.value for line in of_kind(WarningKind.UNKNOWN, lines)]


def with_kinds(lines: Sequence[str], kinds: Sequence[str] | None) -> list[RunWarning]:
    """Warnings from the texts and kinds of a file.

    Parameters
    ----------
    lines : sequence of str
        The texts.
    kinds : sequence of str or None
        What `kinds_of` gave; None where a file of an earlier version has none.

    Raises
    ------
    ValueError
        An unknown kind, or another number of kinds.

    Examples
    --------
    >>> with_kinds(["the energy balance does not close"], ["energy_balance"])[0].unsound
    True
    """
    if kinds is None:
        return of_kind(WarningKind.UNKNOWN, lines)
    return [RunWarning(line, WarningKind(kind)) for line, kind in zip(lines, kinds, strict=True)]


def warnings_of(attributes: Mapping[str, Any]) -> list[RunWarning]:
    """Warnings of a file of results, with their kinds where it has them.

    Parameters
    ----------
    attributes : mapping
        Attributes of the file: ``warnings`` and perhaps ``warning_kinds``, as JSON.
    """
    lines = [str(line) for line in json_of(attributes["warnings"])]
    kinds = attributes.get("warning_kinds")
    return with_kinds(lines, None if kinds is None else json_of(kinds))
