"""Names of parts, and references from one part to another by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Annotated, Any

from pydantic import AfterValidator

from mascarin.building.base.number import problem, shown
from mascarin.errors import did_you_mean

#: Names that parts of the description being read may refer to, by section.
_names: ContextVar[Mapping[str, Mapping[str, None]] | None] = ContextVar("names", default=None)


def _name(text: str) -> str:
    if not text.replace("-", "_").isidentifier():
        raise problem(
            shown(text),
            "a name of letters, digits, '_' and '-' that starts with a letter",
            "Dots separate the steps of a parameter path, so names cannot contain them.",
        )
    return text


#: Name of a part, which is also a step of a parameter path.
Name = Annotated[str, AfterValidator(_name)]


@contextmanager
def known_names(description: Any) -> Iterator[None]:
    """Let the parts that are read inside refer to the sections of this description."""
    sections = {}
    for section in (
        "materials",
        "constructions",
        "zones",
        "surfaces",
        "schedules",
        "glazings",
        "controls",
        "soil_blocks",
    ):
        named = description.get(section) if isinstance(description, Mapping) else None
        sections[section] = dict.fromkeys(map(str, named)) if isinstance(named, Mapping) else {}
    token = _names.set(sections)
    try:
        yield
    finally:
        _names.reset(token)


def _reference(section: str, singular: str) -> AfterValidator:
    def check(name: str) -> str:
        sections = _names.get()
        if sections is not None and name not in sections[section]:
            raise problem(
                f"'{name}'",
                f"the name of a {singular} under '{section}:'",
                did_you_mean(name, sections[section]) or f"Add it under '{section}:'.",
            )
        return name

    return AfterValidator(check)


MaterialName = Annotated[str, _reference("materials", "material")]
ConstructionName = Annotated[str, _reference("constructions", "construction")]
ZoneName = Annotated[str, _reference("zones", "zone")]
SurfaceName = Annotated[str, _reference("surfaces", "surface")]
ScheduleName = Annotated[str, _reference("schedules", "schedule")]
ControlName = Annotated[str, _reference("controls", "control")]
SoilBlockName = Annotated[str, _reference("soil_blocks", "block of soil")]
GlazingName = Annotated[str, _reference("glazings", "glazing")]
