"""A converted model beside a run of EnergyPlus, as one HTML file without scripts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mascarin
from mascarin._io import atomic
from mascarin.energyplus.comparison.compared import Comparison
from mascarin.energyplus.comparison.tables import header, tables
from mascarin.pages.frame.template import environment, frame


def write(path: Path, comparison: Comparison) -> Path:
    """Write the page of a comparison to a file.

    Parameters
    ----------
    path : Path
        Where to.
    comparison : Comparison
        A model in both programs.

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(comparison))


def render(comparison: Comparison) -> str:
    """Make the page: all zones by month, and the known causes of differences.

    Parameters
    ----------
    comparison : Comparison
        A model in both programs.
    """
    columns = header(comparison)
    sections: list[dict[str, Any]] = [
        {"id": f"part-{k}", "title": name, "content": {"header": columns, "lines": lines}}
        for k, (name, lines, _) in enumerate(tables(comparison, most=len(comparison.rows)))
    ]
    for key, title, texts in (
        ("causes", "Known causes of differences", comparison.causes),
        ("notes", "Notes", comparison.notes),
    ):
        if texts:
            sections.append({"id": key, "title": title, "content": texts})
    conversion = comparison.conversion
    return (
        environment()
        .get_template("pages/run/peer.html")
        .render(
            frame(styles=["pages/run/run.css"]),
            title=conversion.file.name,
            version=mascarin.__version__,
            sections=sections,
            period=f"{conversion.start} to {conversion.end}",
            peer=comparison.run.version,
        )
    )
