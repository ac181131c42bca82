"""Laws of the liquid fraction by a formula, about the melting temperature."""

from __future__ import annotations

from typing import ClassVar, Final

from mascarin.building.part import Part

#: Fraction of the transition cut off at each end of a curve with tails, where hysteresis needs an end.
CUT: Final = 1e-3


class ClosedLaw(Part):
    """A law of the liquid fraction by a formula, about the melting temperature."""

    #: Whether the fraction reaches 0 and 1 only at infinity.
    tails: ClassVar[bool] = False

    @property
    def half_width(self) -> float:
        """Half-width of the melting range [K]."""
        raise TypeError("each law defines its width")

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, relative to the melting temperature, without tails [K]."""
        raise TypeError("each law defines its reach")

    def fraction(self, above: float) -> float:
        """Liquid fraction at a distance above the melting temperature [K]."""
        raise TypeError("each law defines its fraction")
