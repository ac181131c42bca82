"""Faults of sensors that were found, put into simulated series: what the sensors would show."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mascarin.validation.sensor_faults import shifted

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


@dataclass(eq=False)
class Corrections:
    """Faults found so far, in their order.

    Attributes
    ----------
    faults : list of (int, str, float, float)
        Sensor, kind, size, and the value that a gain is about: delay [s], offset or drift over the record
        [unit of the sensor], relative error of the gain [-].
    """

    faults: list[tuple[int, str, float, float]] = field(default_factory=list)

    def shown(self, series: Array, interval: float) -> Array:
        """Simulated series as the sensors show them, shape (n, S). [unit of each]"""
        shown, n = series.copy(), len(series)
        for s, what, value, about in self.faults:
            if what == "clock":
                shown[:, s] = shifted(shown[:, s], value, interval)
            elif what == "offset":
                shown[:, s] += value
            elif what in ("gain", "scale"):
                shown[:, s] += value * (shown[:, s] - about)
            elif what == "drift":
                shown[:, s] += value * (np.arange(n) - 0.5 * n) / n
        return shown

    def effects(self, slopes: Array, interval: float) -> Array:
        """Effects of parameters as the sensors show them, shape (P, n, S). [unit of each]"""
        shown = slopes.copy()
        for s, what, value, _ in self.faults:
            if what == "clock":
                shown[:, :, s] = shifted(shown[:, :, s].T, value, interval).T
            elif what in ("gain", "scale"):
                shown[:, :, s] *= 1.0 + value
        return shown
