"""Mascarin simulates buildings with phase-change materials and validates them against measurements.

The public names are listed in ``__init__.pyi``. Each is imported when it is first used, so that
``import mascarin`` stays quick.
"""

from __future__ import annotations

from typing import Final

import lazy_loader

__version__: Final = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
