"""A local page with sliders: runs of a building that follow the hand."""

from __future__ import annotations

from mascarin.pages.explore.server import Server
from mascarin.pages.explore.session import Session

__all__ = ["Server", "Session"]


def __dir__() -> list[str]:
    return __all__
