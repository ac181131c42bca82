"""Which parameters matter, for which output, when, and how certain that is.

`sensitivity_analysis` does it for a building, `plan` and `run` for any model. The methods are the spectral
one (first-order indices over time) and, by SALib, RBD-FAST, Sobol' and Morris. Every analysis is a
`Sensitivity`.

The public names are listed in ``__init__.pyi`` and imported when they are first used.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
