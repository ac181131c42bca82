"""Calibration: estimating parameters from measurements, with their uncertainty.

`calibrate` does it for a building. The parts work on plain arrays: a `CalibrationProblem` has parameters,
measured series and a model that is evaluated in batches; `solve` finds the parameters, and `Calibration` is
the result.

The public names are listed in ``__init__.pyi`` and imported when they are first used.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
