"""Runs whose time step is too long for the air of a room."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.outputs import Output

#: Error of the air temperature from which a step is called too long [K].
LARGE: Final = 0.2
#: Error over the second difference of a series [-]. Measured: rooms of concrete, wood, insulated and bare
#: steel sheet under the sun of Denver, with steps of 5 min to 1 h against one of 75 s: 0.03 to 0.2, and 0.05
#: to 0.11 where the error is above 0.03 K.
SHARE: Final = 0.1
#: Steps that divide an hour [min].
STEPS: Final = (30, 20, 15, 12, 10, 6, 5, 4, 3, 2, 1)
#: Records after the start that are left out: a given initial state adapts.
START: Final = 3


def error_of(series: npt.NDArray[np.float64]) -> float:
    """Estimate of the error of a series by the time step. [K]

    The scheme is of second order: its error is a share of the step squared times the second derivative, and
    the second difference of the series is this product.

    Parameters
    ----------
    series : ndarray, shape (rows,)
        Temperatures at the ends of the steps. [degC]
    """
    bends = np.diff(series[START:], 2)
    return float(SHARE * np.sqrt(np.mean(bends**2))) if len(bends) else 0.0


def warnings(
    building: Building,
    outputs: Sequence[Output],
    records: npt.NDArray[np.float64],
    step_seconds: float,
) -> Iterator[str]:
    """Warnings about zones whose air changes too fast for the step, with the step to take.

    Zones with heating or cooling are left out: their set points jump.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What was recorded.
    records : ndarray, shape (rows, outputs)
        Its values. [unit of each output]
    step_seconds : float
        Time step. [s]
    """
    zones = list(building.zones.items())
    for column, output in enumerate(outputs):
        if output.kind != "air_temperature" or output.zone is None:
            continue
        name, zone = zones[output.zone]
        error = error_of(records[:, column])
        if zone.heating is not None or zone.cooling is not None or error < LARGE:
            continue
        # Hourly weather bends the series at every hour: the error falls with the step, not with its square.
        minutes = step_seconds / 60.0 * LARGE / error
        better = next((step for step in STEPS if step <= minutes), STEPS[-1])
        yield (
            f"zones.{name}: the time step of {step_seconds / 60.0:g} min is too long for its air, which "
            f"reacts faster: its temperature is wrong by about {error:.1g} K (root mean square); take a step "
            f"of {better} min"
        )
