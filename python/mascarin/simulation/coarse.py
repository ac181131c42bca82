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


class Bends:
    """How much the air temperatures of a run bend from step to step, from its records in blocks.

    The scheme is of second order: its error is a share of the step squared times the second derivative, and
    the second difference of a series is this product. Zones with heating or cooling are left out: their set
    points jump.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What is recorded.
    """

    def __init__(self, building: Building, outputs: Sequence[Output]) -> None:
        zones = list(building.zones.items())
        self._names: list[str] = []
        self._columns: list[int] = []
        for column, output in enumerate(outputs):
            if output.kind != "air_temperature" or output.zone is None:
                continue
            name, zone = zones[output.zone]
            if zone.heating is None and zone.cooling is None:
                self._names.append(name)
                self._columns.append(column)
        self._skip = START
        self._before = np.empty((0, len(self._columns)))
        self._sum = np.zeros((1, len(self._columns)))
        self._count = 0

    def add(self, rows: npt.NDArray[np.float64]) -> None:
        """Add the next records, shape (n, outputs or more). [unit of each output]"""
        series = np.concatenate([self._before, rows[self._skip :, self._columns]])
        self._skip = max(self._skip - len(rows), 0)
        bends = np.diff(series, 2, axis=0)
        # One after the other, so that the sum does not depend on the blocks.
        self._sum = np.add.accumulate(np.concatenate([self._sum, bends**2]), axis=0)[-1:]
        self._count += len(bends)
        self._before = series[-2:]

    def errors(self) -> npt.NDArray[np.float64]:
        """Estimate of the error of each series by the time step, root mean square. [K]"""
        return np.asarray(SHARE * np.sqrt(self._sum[0] / max(self._count, 1)))

    def warnings(self, step_seconds: float) -> Iterator[str]:
        """Warnings about zones whose air changes too fast for the step, with the step to take.

        Parameters
        ----------
        step_seconds : float
            Time step. [s]
        """
        for name, error in zip(self._names, self.errors(), strict=True):
            if error < LARGE:
                continue
            # Hourly weather bends the series at every hour: the error falls with the step, not its square.
            minutes = step_seconds / 60.0 * LARGE / error
            better = next((step for step in STEPS if step <= minutes), STEPS[-1])
            yield (
                f"zones.{name}: the time step of {step_seconds / 60.0:g} min is too long for its air, which "
                f"reacts faster: its temperature is wrong by about {error:.1g} K (root mean square); take a "
                f"step of {better} min"
            )
