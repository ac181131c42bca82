"""Mascarin simulates buildings with phase-change materials and proves the model on measurements.

The names below are the public surface; each is imported from its room when first used, so that
``import mascarin`` stays quick.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from mascarin.calibration import calibrate as calibrate
    from mascarin.climate import Climate as Climate
    from mascarin.derivatives import gradient as gradient
    from mascarin.derivatives import jacobian as jacobian
    from mascarin.materials.dsc import from_dsc as from_dsc
    from mascarin.model import load as load
    from mascarin.sensitivity import screen as screen
    from mascarin.simulation import simulate as simulate
    from mascarin.start import MeasuredStart as MeasuredStart
    from mascarin.state_space import state_space as state_space
    from mascarin.study import Study as Study
    from mascarin.sweep import sweep as sweep

__version__: Final = "0.1.0"

_HOME: Final = {
    "Climate": "mascarin.climate",
    "MeasuredStart": "mascarin.start",
    "Study": "mascarin.study",
    "calibrate": "mascarin.calibration",
    "from_dsc": "mascarin.materials.dsc",
    "gradient": "mascarin.derivatives",
    "jacobian": "mascarin.derivatives",
    "load": "mascarin.model",
    "screen": "mascarin.sensitivity",
    "simulate": "mascarin.simulation",
    "state_space": "mascarin.state_space",
    "sweep": "mascarin.sweep",
}

__all__ = [
    "Climate",
    "MeasuredStart",
    "Study",
    "__version__",
    "calibrate",
    "from_dsc",
    "gradient",
    "jacobian",
    "load",
    "screen",
    "simulate",
    "state_space",
    "sweep",
]

if not TYPE_CHECKING:  # a type checker sees the imports above, and so finds a misspelt name

    def __getattr__(name: str) -> object:
        """Public name, imported from its room on first use."""
        if name not in _HOME:
            raise AttributeError(f"module 'mascarin' has no attribute '{name}'")
        value = getattr(importlib.import_module(_HOME[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """The package itself: `sweep` and `state_space` are functions, not the modules of that name.

    Importing a module binds it as an attribute of its package, so without this
    ``mascarin.sweep`` would be a function or a module depending on what was imported before.
    """

    def __setattr__(self, name: str, value: object) -> None:
        """Bind `name`, putting the public function in the place of the module it lives in."""
        if isinstance(value, ModuleType) and _HOME.get(name) == value.__name__:
            value = getattr(value, name)
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
