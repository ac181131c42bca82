"""Studies: comparison with measurements, sensitivity analysis, calibration and validation in one run.

An interrupted study continues where it was. The public names are listed in ``__init__.pyi`` and imported when
they are first used: a single run reads its weather as a study does, without the rest of a study.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
