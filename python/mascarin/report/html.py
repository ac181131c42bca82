"""Renders the templates of the report of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin.report.cross_references import CrossReferences
from mascarin.report.page import context, explorer
from mascarin.report.series import Series
from mascarin.report.template import CURVES, environment, frame


def page(study: Mapping[str, Any], series: Series) -> str:
    """Make the HTML of a report.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    """
    references = CrossReferences()
    template = environment(references).get_template("report/page.html")
    values = context(study, series) | frame(
        styles=["report/vendor/uPlot.min.css"],
        libraries=[CURVES],
        scripts=["report/curves.js", "report/report.js"],
        data=explorer(study, series),
    )
    template.render(values)  # counts the tables and figures to which texts refer
    references.restart()
    return template.render(values)
