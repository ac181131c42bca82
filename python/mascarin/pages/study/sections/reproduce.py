"""How to get the same results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from mascarin.figures import text
from mascarin.pages.study.data.series import Series

TITLE = "How to reproduce the results"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    if not any(key in study for key in ("command", "versions", "sources", "inputs")):
        return None
    return {
        "command": "\n".join(study.get("command", [])),
        "inputs": study.get("inputs", []),
        "versions": study.get("versions", {}),
        "seed": study.get("seed"),
        "run_time": text.duration(float(study["run_time"])) if study.get("run_time") is not None else "",
        "sources": [_source(source) for source in study.get("sources", [])],
    }


def _source(source: Mapping[str, str]) -> Markup:
    """Text of a source; its DOI, given or found in the text, becomes a link."""
    words, doi = str(source.get("text", "")), str(source.get("doi", ""))
    doi_match = text.DOI.search(words)
    if not doi.startswith("10.") and doi_match:
        doi = doi_match.group(1)
        words = words[: doi_match.start()] + words[doi_match.end() :]
    if not doi.startswith("10."):
        return Markup("{}").format(words)
    return Markup('{} <a href="https://doi.org/{}" rel="noopener noreferrer">doi:{}</a>').format(
        words.rstrip(" ,;"), doi, doi
    )
