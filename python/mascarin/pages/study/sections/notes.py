"""Remarks of the analysis."""

from __future__ import annotations

from typing import Any

from mascarin.pages.study.data.labels import note_words
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.sections.error_sources import MISSED
from mascarin.study_document.document import StudyDocument

TITLE = "Remarks"


def content(study: StudyDocument, _series: Series) -> list[dict[str, Any]] | None:
    """Notes under their titles, those of one title together."""
    paragraphs_by_title: dict[str, list[str]] = {}
    if study.warnings:
        paragraphs_by_title["Warnings of the runs"] = [str(line) for line in study.warnings]
    for note in study.notes:
        if note.title != MISSED:
            paragraphs_by_title.setdefault(note.title, []).extend(note_words(study, note))
    return [
        {"title": title, "paragraphs": paragraphs} for title, paragraphs in paragraphs_by_title.items()
    ] or None
