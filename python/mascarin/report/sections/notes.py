"""Remarks of the analysis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.report.labels import note_words
from mascarin.report.sections.error_sources import MISSED
from mascarin.report.series import Series

TITLE = "Remarks"


def content(study: Mapping[str, Any], _series: Series) -> list[dict[str, Any]] | None:
    """Notes under their titles, those of one title together."""
    paragraphs_by_title: dict[str, list[str]] = {}
    if study.get("warnings"):
        paragraphs_by_title["Warnings of the runs"] = [str(line) for line in study["warnings"]]
    for note in study.get("notes", []):
        if note.get("title") != MISSED:
            paragraphs_by_title.setdefault(str(note.get("title", "")), []).extend(note_words(study, note))
    return [
        {"title": title, "paragraphs": paragraphs} for title, paragraphs in paragraphs_by_title.items()
    ] or None
