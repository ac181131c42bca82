"""Outlines of the surfaces and windows of a box: x points east, y north, z up; seen from outside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from mascarin.templates.short_texts import WALLS, WindowText

__all__ = ["MARGIN", "WALLS", "Outline", "floor_outline", "roof_outline", "wall_outlines", "window_outlines"]

Outline = list[tuple[float, float, float]]

MARGIN: Final = 0.05
"""Smallest distance of a window from an edge of its wall and from the next window. [m]"""
#: Height of a sill above the floor, where the window leaves that room. [m]
_SILL: Final = 0.9


def wall_outlines(west: float, east: float, width: float, low: float, high: float) -> dict[str, Outline]:
    """Outlines of the four walls of a box whose south-west corner is at y = 0.

    Parameters
    ----------
    west, east, width : float
        Ends along x, and the length along y. [m]
    low, high : float
        Lower and upper edge. [m]

    Examples
    --------
    >>> wall_outlines(0, 4, 3, 0, 2.8)["south"][0]
    (0, 0.0, 0)
    """
    corners = {
        "south": ((west, 0.0), (east, 0.0)),
        "east": ((east, 0.0), (east, width)),
        "north": ((east, width), (west, width)),
        "west": ((west, width), (west, 0.0)),
    }
    return {
        wall: [(*start, low), (*end, low), (*end, high), (*start, high)]
        for wall, (start, end) in corners.items()
    }


def roof_outline(west: float, east: float, width: float, height: float) -> Outline:
    """Outline of a flat roof or ceiling, seen from above."""
    return [(west, 0.0, height), (east, 0.0, height), (east, width, height), (west, width, height)]


def floor_outline(west: float, east: float, width: float) -> Outline:
    """Outline of a floor, seen from below."""
    return [(west, 0.0, 0.0), (west, width, 0.0), (east, width, 0.0), (east, 0.0, 0.0)]


def window_outlines(
    windows: Sequence[WindowText], west: float, east: float, width: float, height: float
) -> Iterator[tuple[str, WindowText, Outline]]:
    """Windows of a box, beside each other in the middle of their walls.

    Parameters
    ----------
    windows : sequence of WindowText
        The windows.
    west, east, width, height : float
        Of the box. [m]

    Yields
    ------
    tuple of str, WindowText and Outline
        Name, window and outline.
    """
    for wall, outline in wall_outlines(west, east, width, 0.0, height).items():
        row = [window for window in windows if window.wall == wall]
        (x_start, y_start, _), (x_end, y_end, _) = outline[:2]
        along = max(abs(x_end - x_start), abs(y_end - y_start))
        position = 0.5 * (along - sum(window.width + MARGIN for window in row) + MARGIN)
        for k, window in enumerate(row, start=1):
            low = max(min(_SILL, height - MARGIN - window.height), MARGIN)
            ends = [
                (x_start + share * (x_end - x_start), y_start + share * (y_end - y_start))
                for share in (position / along, (position + window.width) / along)
            ]
            high = low + window.height
            points: Outline = [(*ends[0], low), (*ends[1], low), (*ends[1], high), (*ends[0], high)]
            yield (f"{wall}_window" if len(row) == 1 else f"{wall}_window_{k}"), window, points
            position += window.width + MARGIN
