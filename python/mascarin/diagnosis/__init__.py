"""Diagnosis: causes of the difference between a calibrated model and measurements.

Every cause is tested given the errors of the model that the data themselves show, the uncertainty of its
parameters and the stated errors of the sensors. The public names are listed in ``__init__.pyi``; each is
imported when it is first used.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
