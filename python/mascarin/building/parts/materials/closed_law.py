"""Laws of the liquid fraction by a formula, about the melting temperature."""

from __future__ import annotations

from typing import Any, ClassVar, Final

import numpy as np
import numpy.typing as npt

from mascarin.building.base.part import Part, cached_on
from mascarin.physics import MeltingCurve

#: Fraction of the transition cut off at each end of a curve with tails, where hysteresis needs an end.
CUT: Final = 1e-3

Floats = npt.NDArray[np.float64]


class ClosedLaw(Part):
    """A law of the liquid fraction by a formula, about the melting temperature."""

    #: Whether the fraction reaches 0 and 1 only at infinity.
    tails: ClassVar[bool] = False
    #: Its name in the descriptions of the engine.
    _KIND: ClassVar[str]

    @property
    def half_width(self) -> float:
        """Half-width of the melting range [K]."""
        raise TypeError("each law defines its width")

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, relative to the melting temperature, without tails [K]."""
        return self._curve().reach

    def fraction(self, above: npt.ArrayLike) -> Floats:
        """Liquid fraction at distances above the melting temperature [K], with their shape. [-]"""
        return self._curve()(above)

    def _curve(self) -> MeltingCurve:
        return cached_on(self, "_curve_of_engine", lambda: self._as_engine(0.0))

    def _as_engine(self, centre: float) -> MeltingCurve:
        """The curve of the engine about a temperature [degC]."""
        numbers = {"melting_temperature": centre, "width": self.half_width}
        return MeltingCurve(self._KIND, numbers, self._shape())

    def _shape(self) -> dict[str, Any]:
        """What the curve of the engine has beside numbers."""
        return {}
