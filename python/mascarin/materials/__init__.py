"""Phase-change products with their properties, and materials from calorimeter files (`from_dsc`).

The public names are listed in ``__init__.pyi`` and imported when they are first used.
"""

from __future__ import annotations

from mascarin.public_names import attached

__getattr__, __dir__, __all__ = attached(__name__, __file__)
