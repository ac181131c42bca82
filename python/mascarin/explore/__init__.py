"""A local page with sliders: runs of a building that follow the hand."""

from __future__ import annotations

from mascarin.explore.server import Server
from mascarin.explore.session import Session

__all__ = ["Server", "Session"]


def __dir__() -> list[str]:
    return __all__
