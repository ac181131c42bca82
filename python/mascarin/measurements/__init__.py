"""Measurements beside a model: sensors, the uncertainty of their values, series at the same instants.

`Sensor` is the one description of a measured series: that of a study file, and that of `calibrate`. The
public names are listed in ``__init__.pyi``; each is imported when it is first used.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
