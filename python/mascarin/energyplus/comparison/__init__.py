"""Results of EnergyPlus beside those of the converted model."""

from __future__ import annotations

from mascarin.energyplus.comparison.compared import Comparison, compare

__all__ = ["Comparison", "compare"]
