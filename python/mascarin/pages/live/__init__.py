"""A page in which the model runs: one file with the engine, the building and its weather."""

from __future__ import annotations

from mascarin.pages.live.page import Sent, live_page

__all__ = ["Sent", "live_page"]


def __dir__() -> list[str]:
    return __all__
