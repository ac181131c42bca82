"""Renders the templates of the report of a study."""

from __future__ import annotations

from mascarin.pages.frame.cross_references import CrossReferences
from mascarin.pages.frame.template import CURVES, environment, frame
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.page import context, explorer
from mascarin.study_document.document import StudyDocument


def page(study: StudyDocument, series: Series) -> str:
    """Make the HTML of a report.

    Parameters
    ----------
    study : StudyDocument
        The results.
    series : Series
        Curves.
    """
    references = CrossReferences()
    template = environment(references).get_template("pages/study/page.html")
    values = context(study, series) | frame(
        styles=["pages/frame/vendor/uPlot.min.css"],
        libraries=[CURVES],
        scripts=["pages/frame/curves.js", "pages/study/report.js"],
        data=explorer(study, series),
    )
    template.render(values)  # counts the tables and figures to which texts refer
    references.restart()
    return template.render(values)
