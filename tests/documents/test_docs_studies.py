"""The table of study keys in docs/studies.md agrees with the code.

``python tests/documents/test_docs_studies.py`` updates it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from mascarin.simulation.preparation.initial_state import GivenStart
from mascarin.study.file import data_sources, description
from mascarin.validation.comparison import METRICS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "studies.md"
BEGIN, END = "<!-- keys: begin -->", "<!-- keys: end -->"

#: Title and kind of each section, in the order of the page.
SECTIONS = (
    ("The study", description.StudyFile),
    ("`climate`", data_sources.ClimateSource),
    ("`climate.measured`", data_sources.MeasuredWeather),
    ("`measurements`", data_sources.MeasuredTable),
    ("Each of `sensors`", description.Sensor),
    ("`periods` of a sensor", description.SensorPeriods),
    ("`initial`", GivenStart),
    ("`periods`", description.Periods),
    ("`quality`", description.Quality),
    ("Each of `criteria`", description.Limit),
    ("`sensitivity`", description.SensitivityPlan),
    ("`identification`", description.IdentificationPlan),
    ("`identification.discrepancy`", description.DiscrepancyPlan),
    ("Each of `identification.parameters`", description.Free),
    ("Each of `variants`", description.Variant),
    ("Each of `transfer`", data_sources.Transfer),
    ("Each of `experiments`", data_sources.Experiment),
    ("Each form of each of `alternatives`", description.Alternative),
    ("`reference`", description.Publication),
    ("Each of `reference.influential`", description.Influential),
    ("Each of `reference.parameters`", description.PublishedParameter),
    ("Each period of each of `reference.sensors`", description.PublishedScores),
)


def words(kind: Any) -> str:
    """A type in words."""
    origin, inside = get_origin(kind), get_args(kind)
    if origin is Literal and inside == METRICS:
        return "a metric"  # the page lists them with their meaning
    if origin is Literal:
        return ", ".join(f"`{word}`" for word in inside)
    if origin in (Union, UnionType):
        return " or ".join(dict.fromkeys(words(one) for one in inside if one is not type(None)))
    if origin is tuple:
        if inside[-1] is Ellipsis:
            return f"list of {words(inside[0])}"
        return f"list of {len(inside)}: {words(inside[0])}"
    if origin is dict:
        return f"mapping to {words(inside[1])}"
    if hasattr(kind, "__metadata__"):
        return words(inside[0])
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return "section"
    return {str: "text", float: "number", int: "whole number", bool: "true or false", Any: "anything"}.get(
        kind, str(kind)
    )


def default(field: FieldInfo) -> str:
    """What a key is when it is not there."""
    if field.is_required():
        return "required"
    value = field.get_default(call_default_factory=True)
    if value is None or value in ((), {}, ""):
        return ""
    if isinstance(value, BaseModel):
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def in_order(kind: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields in the order of the page: the files of a study come after its name."""
    fields = dict(kind.model_fields)
    if kind is not description.StudyFile:
        return fields
    files = [name for name in fields if name not in description.StudyPlan.model_fields]
    plan = list(description.StudyPlan.model_fields)
    first = plan[: plan.index("sensors")]
    return {name: fields[name] for name in (*first, *files, *plan[len(first) :])}


def lines(kind: type[BaseModel]) -> Iterator[str]:
    yield "| key | holds | default | meaning |"
    yield "|---|---|---|---|"
    for name, field in in_order(kind).items():
        meaning = (field.description or "").replace("|", "\\|")
        yield f"| `{name}` | {words(field.annotation)} | {default(field)} | {meaning} |"


def summary(kind: type[BaseModel]) -> str:
    """The docstring without its list of parameters."""
    return re.split(r"\n\s*Parameters\n\s*---", kind.__doc__ or "")[0].strip()


def rendered() -> str:
    parts = []
    for title, kind in SECTIONS:
        parts.append(f"### {title}\n\n{summary(kind)}\n\n" + "\n".join(lines(kind)))
    return "\n\n".join(parts)


def test_the_table_of_keys_agrees_with_the_code() -> None:
    text = PAGE.read_text(encoding="utf-8")
    shown = text[text.index(BEGIN) + len(BEGIN) : text.index(END)].strip()
    assert shown == rendered(), "python tests/documents/test_docs_studies.py updates it"


def test_every_kind_of_section_is_on_the_page() -> None:
    kinds = {
        kind
        for kind in [*vars(description).values(), *vars(data_sources).values()]
        if isinstance(kind, type)
        and issubclass(kind, BaseModel)
        and kind.__module__.startswith(("mascarin.study.", "mascarin.measurements."))
    }
    bases = {description.StudyPlan, data_sources.TableSource}
    assert kinds | {GivenStart} == {kind for _, kind in SECTIONS} | bases
    for kind in kinds:
        for name, field in kind.model_fields.items():
            assert field.description, f"{kind.__name__}.{name}"


def test_words_for_types() -> None:
    assert words(tuple[str, ...] | None) == "list of text"
    assert words(tuple[float, float]) == "list of 2: number"
    assert words(Literal["a", "b"]) == "`a`, `b`"
    assert words(dict[str, description.Free | None]) == "mapping to section"


if __name__ == "__main__":
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(
        re.sub(f"{BEGIN}.*{END}", lambda _: f"{BEGIN}\n\n{rendered()}\n\n{END}", page, flags=re.DOTALL),
        encoding="utf-8",
    )
