"""Mascarin simulates buildings with phase-change materials and validates them against measurements.

The public names are listed in ``__init__.pyi``. Each is imported when it is first used, so that
``import mascarin`` stays quick.
"""

from __future__ import annotations

from typing import Any, Final

import lazy_loader

__version__: Final = "0.1.0"

_public, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    if name == "screen":
        # The former name of sensitivity_analysis; the function itself warns.
        from mascarin.sensitivity.building_analysis import screen

        return screen
    return _public(name)
