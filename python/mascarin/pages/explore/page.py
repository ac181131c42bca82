"""The page of `mascarin explore`."""

from __future__ import annotations

from pathlib import Path

from mascarin import __version__
from mascarin.figures import text
from mascarin.pages.explore.session import Session
from mascarin.pages.frame.template import CURVES, environment, frame


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
        .get_template("pages/explore/explore.html")
        .render(
            frame(
                styles=["pages/frame/vendor/uPlot.min.css", "pages/explore/explore.css"],
                libraries=[CURVES],
                scripts=["pages/frame/curves.js", "pages/explore/explore.js"],
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
