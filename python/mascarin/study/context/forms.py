"""Forms of the model of a study: the building as described, and its alternatives, one by one and combined."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, Final

from mascarin.errors import InputError
from mascarin.study.file.description import Alternative, Variant

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.study.file.description import StudyPlan
    from mascarin.study.file.locations import Places

#: All combinations of forms are calibrated up to this number; of more, those that differ in one part.
MOST_COMBINATIONS: Final = 12

Choice = tuple[tuple[str, str], ...]
"""Pairs of part and form that differ from the building as described, in the order of the study."""


class Forms:
    """Alternatives of a study with their paths written out.

    Parameters
    ----------
    plan : StudyPlan
        Has the alternatives.
    building : Building
        As described.
    places : Places
        Lines of the study, for errors.

    Raises
    ------
    InputError
        A path does not exist, a value is not possible, or two forms are the same.
    """

    def __init__(self, plan: StudyPlan, building: Building, places: Places) -> None:
        self._building = building
        self.parts: dict[str, dict[str, Alternative]] = {}
        for part, given in plan.alternatives.items():
            with places.blame("alternatives", part):
                self.parts[part] = self._written_out(part, given)

    def combinations(self) -> list[Choice]:
        """Forms to calibrate first: all combinations, or those that differ in one part if there are many."""
        number = 1
        for forms in self.parts.values():
            number *= 1 + len(forms)
        if number > MOST_COMBINATIONS:
            return [(), *self.beside(())]
        choices: list[Choice] = [()]
        for part, forms in self.parts.items():
            choices = [
                (*choice, *more) for choice in choices for more in ((), *(((part, form),) for form in forms))
            ]
        return choices

    def beside(self, choice: Choice) -> Iterator[Choice]:
        """Forms that differ from one of them in one part."""
        chosen = dict(choice)
        for part, forms in self.parts.items():
            for form in (None, *forms):
                if chosen.get(part) != form:
                    yield self.of({**chosen, part: form})

    def of(self, chosen: Mapping[str, str | None]) -> Choice:
        """The choice of forms by part."""
        return tuple((part, form) for part in self.parts if (form := chosen.get(part)) is not None)

    def variant(self, choice: Choice) -> Variant:
        """A choice as a variant of the study."""
        changes: dict[str, Any] = {}
        parameters: dict[str, Any] = {}
        for part, form in choice:
            changes |= self.parts[part][form].changes
            parameters |= self.parts[part][form].parameters
        return Variant(changes=changes, parameters=parameters, note=label(choice))

    def _written_out(self, part: str, given: Any) -> dict[str, Alternative]:
        if isinstance(given, Mapping):
            forms = {name: self._expanded(form) for name, form in given.items()}
            known = {}
        else:
            forms = {_word(value): self._expanded(Alternative(changes={part: value})) for value in given}
            if len(forms) < len(given):
                raise InputError("found one value twice, expected each once; remove one")
            known = {name: form for name, form in forms.items() if self._is_described(form)}
            forms = {name: form for name, form in forms.items() if name not in known}
        if not forms:
            raise InputError("found no form beside that of the building, expected at least one")
        self._require_different(forms)
        return forms

    def _expanded(self, form: Alternative) -> Alternative:
        """The same with every * replaced by names, checked."""
        changes = {matched: value for path, value in form.changes.items() for matched in self._matching(path)}
        self._building.replace(changes)
        return form.model_copy(update={"changes": changes})

    def _matching(self, path: str) -> list[str]:
        if "*" not in path:
            return [path]
        pieces = path.split(".")
        prefixes = {tuple(p.path.split(".")[: len(pieces)]) for p in self._building.parameters()}
        paths = [
            ".".join(steps)
            for steps in sorted(prefixes)
            if len(steps) == len(pieces) and all(map(fnmatchcase, steps, pieces))
        ]
        if not paths:
            raise InputError(f"{path}: found nothing in the building that matches; correct the path")
        return paths

    def _is_described(self, form: Alternative) -> bool:
        return _content(self._building) == _content(self._building.replace(form.changes))

    def _require_different(self, forms: Mapping[str, Alternative]) -> None:
        name_of_content = {_content(self._building): "the building as described"}
        for name, form in forms.items():
            content = _content(self._building.replace(form.changes))
            if content in name_of_content:
                raise InputError(
                    f"found '{name}', which is the same as {name_of_content[content]}, expected forms that "
                    "differ; remove one"
                )
            name_of_content[content] = f"'{name}'"


def label(choice: Choice) -> str:
    """Name of a choice in tables."""
    return ", ".join(f"{part}: {form}" for part, form in choice) or "as described"


def comparable(path: str, first: Choice, second: Choice, forms: Forms) -> bool:
    """Whether a parameter means the same in two forms: no part in which they differ replaces it.

    Parameters
    ----------
    path : str
        Of the parameter.
    first, second : tuple
        The two forms.
    forms : Forms
        Has the changes of each.
    """
    for part, form in set(first) ^ set(second):
        for changed in forms.parts[part][form].changes:
            if path == changed or path.startswith(f"{changed}."):
                return False
    return True


def _word(value: Any) -> str:
    if isinstance(value, Mapping) and "kind" in value:
        numbers = ", ".join(f"{key} {piece}" for key, piece in value.items() if key not in ("kind", "factor"))
        return f"{value['kind']}, {numbers}" if numbers else str(value["kind"])
    return str(value)


def _content(building: Building) -> str:
    """What a building is, without ranges and sources of its numbers."""
    return json.dumps(building.model_dump(mode="json", exclude={"name"}), sort_keys=True, default=str)
