"""Validation: comparison of simulations with measurements.

`metrics` compares two series, `judge` applies limits, `analyze_residuals` examines
residuals. All of them work on pandas series or arrays, without a study. The public names are listed in
``__init__.pyi``; each is imported when it is first used.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
