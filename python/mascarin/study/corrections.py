"""Faults of sensors that were found, put into simulated series: what the sensors would show."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mascarin.validation.sensor_faults import shifted

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Found:
    """A fault of one sensor.

    Attributes
    ----------
    sensor : int
        Which.
    what : str
        Its kind.
    value : float
        Delay [s], offset or drift over the record [unit of the sensor], relative error of the gain [-].
    about : float
        The value that a gain is about. [unit of the sensor]
    rows : tuple of int or None
        First row with it and the row after the last, if it is not in the whole record.
    """

    sensor: int
    what: str
    value: float
    about: float = 0.0
    rows: tuple[int, int] | None = None

    def part(self, count: int, rows: int) -> slice:
        """The part of a series with as many rows that has it, for a record with `rows` rows."""
        if self.rows is None:
            return slice(0, count)
        first, last = (round(row * count / max(rows, 1)) for row in self.rows)
        return slice(first, last)


@dataclass(eq=False)
class Corrections:
    """Faults found so far, in their order.

    Attributes
    ----------
    rows : int
        Number of rows of the record in which they were found.
    faults : list of Found
        The faults.
    """

    rows: int = 0
    faults: list[Found] = field(default_factory=list)

    def shown(self, series: Array, interval: float) -> Array:
        """Simulated series as the sensors show them, shape (n, S). [unit of each]"""
        shown, n = series.copy(), len(series)
        for fault in self.faults:
            before, value = shown[:, fault.sensor], fault.value
            after = before
            if fault.what == "clock":
                after = shifted(before, value, interval)
            elif fault.what == "offset":
                after = before + value
            elif fault.what in ("gain", "scale"):
                after = before + value * (before - fault.about)
            elif fault.what == "drift":
                after = before + value * (np.arange(n) - 0.5 * n) / n
            part = fault.part(n, self.rows)
            shown[part, fault.sensor] = after[part]
        return shown

    def effects(self, slopes: Array, interval: float) -> Array:
        """Effects of parameters as the sensors show them, shape (P, n, S). [unit of each]"""
        shown = slopes.copy()
        for fault in self.faults:
            part = fault.part(shown.shape[1], self.rows)
            if fault.what == "clock":
                moved = shifted(shown[:, :, fault.sensor].T, fault.value, interval).T
                shown[:, part, fault.sensor] = moved[:, part]
            elif fault.what in ("gain", "scale"):
                shown[:, part, fault.sensor] *= 1.0 + fault.value
        return shown
