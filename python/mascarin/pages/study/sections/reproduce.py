"""How to get the same results."""

from __future__ import annotations

from typing import Any

from markupsafe import Markup

from mascarin.figures import text
from mascarin.pages.study.data.series import Series
from mascarin.study_document.document import SourceEntry, StudyDocument

TITLE = "How to reproduce the results"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    if not study.states("command", "versions", "sources", "inputs"):
        return None
    return {
        "command": "\n".join(study.command),
        "inputs": study.inputs,
        "versions": study.versions,
        "seed": study.seed,
        "run_time": text.duration(float(study.run_time)) if study.run_time is not None else "",
        "sources": [_source(source) for source in study.sources],
    }


def _source(source: SourceEntry) -> Markup:
    """Text of a source; its DOI, given or found in the text, becomes a link."""
    words, doi = source.text, source.doi
    doi_match = text.DOI.search(words)
    if not doi.startswith("10.") and doi_match:
        doi = doi_match.group(1)
        words = words[: doi_match.start()] + words[doi_match.end() :]
    if not doi.startswith("10."):
        return Markup("{}").format(words)
    return Markup('{} <a href="https://doi.org/{}" rel="noopener noreferrer">doi:{}</a>').format(
        words.rstrip(" ,;"), doi, doi
    )
