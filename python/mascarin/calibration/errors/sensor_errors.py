"""Errors of a sensor that stay the same during an experiment: offset, gain, clock.

The terms are those of the GUM and the VIM: *accuracy* comprises what repeated readings share, such as an
offset from the calibration of the sensor; *repeatability* is the scatter of readings under the same
conditions. A datasheet that states an accuracy of 0.3 K does not say that readings scatter by 0.3 K.

References
----------
JCGM 100:2008, Evaluation of measurement data: guide to the expression of uncertainty in measurement (GUM).
JCGM 200:2012, International vocabulary of metrology (VIM), 2.13, 2.17, 2.21.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SensorError:
    """Standard uncertainties of the errors of a sensor that all its readings share; each has the mean 0.

    Attributes
    ----------
    offset : float
        Of a constant added to every reading. [unit]
    common : float
        Of a constant added to every reading of all sensors that have one, such as that of a logger; the
        constant of a sensor is its ``common`` times the same unknown number. [unit]
    gain : float
        Of a part of the distance from the reference that is added to it. [-]
    reference : float
        Reading at which a gain has no effect, such as that of the calibration. [unit]
    clock : float
        Of the time by which the clock of the logger is fast. [s]

    Examples
    --------
    >>> SensorError(offset=0.15).offset
    0.15
    """

    offset: float = 0.0
    common: float = 0.0
    gain: float = 0.0
    reference: float = 0.0
    clock: float = 0.0


def error_columns(
    names: Sequence[str], sensors: Sequence[SensorError], simulated: Floats, step: float
) -> tuple[Floats, tuple[str, ...]]:
    """Change of the readings for one standard uncertainty of each error.

    Parameters
    ----------
    names : sequence of str, length S
        Of the sensors.
    sensors : sequence of SensorError, length S
        Of each sensor.
    simulated : ndarray, shape (T, S)
        Series of the model. [unit]
    step : float
        Time between samples. [s]

    Returns
    -------
    ndarray, shape (T, S, k)
        One column for each error with an uncertainty; exact derivatives. [unit]
    tuple of str, length k
        Their names.

    Examples
    --------
    >>> columns, names = error_columns(["room"], [SensorError(offset=0.2)], np.array([[5.0], [6.0]]), 60.0)
    >>> columns[:, 0, 0], names
    (array([0.2, 0.2]), ('room offset',))
    """
    columns, column_names = [], []

    def add(name: str, s: int, values: Floats | float) -> None:
        column = np.zeros(simulated.shape)
        column[:, s] = values
        columns.append(column)
        column_names.append(name)

    slope = np.gradient(simulated, step, axis=0) if len(simulated) > 1 else np.zeros_like(simulated)
    for s, (name, error) in enumerate(zip(names, sensors, strict=True)):
        if error.offset:
            add(f"{name} offset", s, error.offset)
        if error.gain:
            add(f"{name} gain", s, error.gain * (simulated[:, s] - error.reference))
        if error.clock:
            # A clock that is fast by t shows at a stamp what was measured t before.
            add(f"{name} clock", s, -error.clock * slope[:, s])
    common = np.array([error.common for error in sensors])
    if common.any():
        columns.append(np.broadcast_to(common, simulated.shape).copy())
        column_names.append("common offset")
    stacked = np.stack(columns, axis=2) if columns else np.zeros((*simulated.shape, 0))
    return stacked, tuple(column_names)
