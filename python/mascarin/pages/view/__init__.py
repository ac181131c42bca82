"""A building as a page to look at: in three dimensions, with its layers, U values, warnings and the sun."""

from __future__ import annotations

from mascarin.pages.view.page import render, write

__all__ = ["render", "write"]


def __dir__() -> list[str]:
    return __all__
