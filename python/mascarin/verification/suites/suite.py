"""A suite: the folder of its description, and the module that runs its cases."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mascarin.errors import InputError, did_you_mean
from mascarin.verification.suites.verdict import KnownMiss, SuiteVerdict, VerdictLine

if TYPE_CHECKING:
    from mascarin.verification.suites.case_data import CaseData

CATALOGUE: Final = Path(__file__).parent / "catalogue"
#: Keys of suite.yaml, and whether each must be there.
_KEYS: Final = {
    "title": True,
    "about": True,
    "term": True,
    "source": True,
    "licence": True,
    "data": True,
    "rule": True,
    "settings": False,
    "known_misses": False,
    "open": False,
    "not_expressible": False,
    "not_run": False,
}

#: Gives the lines of a suite from its data.
Cases = Callable[["CaseData"], Iterator[VerdictLine]]


@dataclass(frozen=True)
class Suite:
    """What `suite.yaml` says of a suite.

    Parameters
    ----------
    name : str
        Of its folder.
    title, about : str
        Its name in words, and what it asks.
    term : str
        The physical term that it is about: without it the suite fails, as a test shows.
    source, licence : str
        Where its facts come from.
    data : str
        Folder of its reference numbers below ``MASCARIN_DATA/suites``; empty where they are typed.
    rule : str
        When a number is inside.
    settings : tuple of str
        What the specification does not state, what was chosen, and whether a result was known then.
    known_misses : dict of (str, str) to KnownMiss
        By case and quantity.
    open_cases : dict of str to str
        Cases whose specification leaves open what decides them.
    not_expressible : dict of str to str
        Cases that cannot be described, with the reason.
    not_run : dict of str to str
        Cases whose data are not at hand, with what they need.
    """

    name: str
    title: str
    about: str
    term: str
    source: str
    licence: str
    data: str
    rule: str
    settings: tuple[str, ...] = ()
    known_misses: dict[tuple[str, str], KnownMiss] = field(default_factory=dict)
    open_cases: dict[str, str] = field(default_factory=dict)
    not_expressible: dict[str, str] = field(default_factory=dict)
    not_run: dict[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path) -> Suite:
        """Read the description of a suite from its folder.

        Raises
        ------
        InputError
            A key is missing or unknown.
        """
        from mascarin.building.files.yaml_document import plain

        file = folder / "suite.yaml"
        tree: dict[str, Any] = plain(file.read_text(encoding="utf-8"), str(file))
        for key in tree.keys() - _KEYS.keys():
            raise InputError(f"{file}: found the key '{key}', expected one of {', '.join(_KEYS)}")
        for key, required in _KEYS.items():
            if required and key not in tree:
                raise InputError(f"{file}: no key '{key}', which every suite needs")
        misses = {
            (str(miss["case"]), str(miss["quantity"])): KnownMiss(
                float(miss["deviation"]), str(miss["cause"])
            )
            for miss in tree.get("known_misses", ())
        }
        words = {key: str(tree[key]).strip() for key, required in _KEYS.items() if required}
        return cls(
            folder.name,
            **words,
            settings=tuple(map(str, tree.get("settings", ()))),
            known_misses=misses,
            open_cases=_reasons(tree, "open"),
            not_expressible=_reasons(tree, "not_expressible"),
            not_run=_reasons(tree, "not_run"),
        )

    @property
    def cases(self) -> Cases:
        """What runs its cases."""
        module = importlib.import_module(f"mascarin.verification.suites.catalogue.{self.name}.cases")
        cases: Cases = module.lines
        return cases

    def lines(self, data: CaseData) -> Iterator[VerdictLine]:
        """Run its cases, and say of each number what is known.

        Parameters
        ----------
        data : CaseData
            Its reference numbers.

        Yields
        ------
        Line
            Also of cases that cannot be described, or not be run.
        """
        for line in self.cases(data):
            yield line.judged(self.known_misses, self.open_cases)
        nothing = float("nan")
        for verdict, reasons in (
            (SuiteVerdict.NOT_EXPRESSIBLE, self.not_expressible),
            (SuiteVerdict.NOT_RUN, self.not_run),
        ):
            for case, reason in reasons.items():
                yield VerdictLine(case, "", "", nothing, nothing, verdict=verdict, cause=reason)


def _reasons(tree: dict[str, Any], key: str) -> dict[str, str]:
    return {str(case): str(reason).strip() for case, reason in tree.get(key, {}).items()}


@cache
def suites() -> dict[str, Suite]:
    """All suites by name, in alphabetical order.

    Examples
    --------
    >>> suites()["bland"].data
    'bland'
    """
    folders = sorted(path.parent for path in CATALOGUE.glob("*/suite.yaml"))
    return {folder.name: Suite.read(folder) for folder in folders}


def chosen(names: tuple[str, ...]) -> list[Suite]:
    """Suites by name, all of them without one.

    Raises
    ------
    InputError
        No suite has a name.
    """
    catalogue = suites()
    for name in names:
        if name not in catalogue:
            raise InputError(
                f"suites: found '{name}', expected one of {', '.join(catalogue)}. "
                f"{did_you_mean(name, catalogue, known=False)}".rstrip()
            )
    return [catalogue[name] for name in dict.fromkeys(names)] if names else list(catalogue.values())
