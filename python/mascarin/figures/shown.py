"""Figures that people see: known to pyplot, and shown once by a notebook."""

from __future__ import annotations

import sys

from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A figure of pyplot that a notebook shows once, whether a cell returns it or not.

    A notebook draws what a cell returns, and then all figures of pyplot that are open: a figure that is
    both would be drawn twice. This one leaves pyplot when it is drawn.
    """

    def _ipython_display_(self) -> None:
        from matplotlib import pyplot

        # The notebook that calls this has it.
        display = sys.modules["IPython.display"].display

        pyplot.close(self)
        # Without this method IPython draws it as any other figure.
        vars(self)["_ipython_display_"] = None
        try:
            display(self)
        finally:
            del vars(self)["_ipython_display_"]


def new_figure(width: float, height: float) -> Figure:
    """Make a figure that `matplotlib.pyplot.show` and notebooks show.

    Parameters
    ----------
    width, height : float
        Size. [inch]

    Returns
    -------
    matplotlib.figure.Figure
        Empty.

    Examples
    --------
    >>> from matplotlib import pyplot
    >>> figure = new_figure(4.0, 3.0)
    >>> figure is pyplot.gcf()
    True
    >>> pyplot.close(figure)
    """
    from matplotlib import pyplot

    return pyplot.figure(figsize=(width, height), layout="constrained", FigureClass=ShownFigure)
