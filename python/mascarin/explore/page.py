"""The page of `mascarin explore`."""

from __future__ import annotations

from pathlib import Path

from mascarin import __version__
from mascarin.explore.session import Session
from mascarin.report import text
from mascarin.report.template import CURVES, environment, frame


def render(session: Session, token: str, target: Path) -> str:
    """Make the page.

    Parameters
    ----------
    session : Session
        Sliders and curves.
    token : str
        What its requests are known by.
    target : Path
        File that its button writes.

    Returns
    -------
    str
        HTML.

    Examples
    --------
    >>> from mascarin.examples import box, box_climate
    >>> "sliders" in render(Session(box(), box_climate(), options={"step": "1h"}), "t", Path("new.yaml"))
    True
    """
    simulation = session.simulation
    return (
        environment()
        .get_template("explore/explore.html")
        .render(
            frame(
                styles=["report/vendor/uPlot.min.css", "explore/explore.css"],
                libraries=[CURVES],
                scripts=["report/curves.js", "explore/explore.js"],
                data={**session.page(), "token": token},
                served=True,
            ),
            title=simulation.building.name,
            version=__version__,
            sections=[],
            period=text.span_of(simulation.start, simulation.end),
            sliders=session.sliders,
            target=target,
        )
    )
