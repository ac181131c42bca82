"""Runs whose time step is too long for the air of a room."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.outputs.output import Output

#: Error of the air temperature from which a step is called too long [K].
LARGE: Final = 0.2
#: Order of the difference of a series, and the error over this difference [-], by scheme. Measured: rooms of
#: concrete, wood, insulated and bare steel sheet under the sun of Denver, with steps of 5 min to 1 h against
#: one of 75 s: 0.03 to 0.2, and 0.05 to 0.11 where the error is above 0.03 K. Rooms of concrete, bare steel
#: and foam in Tampa with all schemes at 15 min and 1 h: `linearly-implicit` as `sdirk2` to three digits, the
#: schemes of first order 0.14 (smooth weather) to 0.54 of the first difference.
SHARES: Final = {
    "sdirk2": (2, 0.1),
    "linearly-implicit": (2, 0.1),
    "backward-euler": (1, 0.25),
    "apparent-capacity": (1, 0.25),
}
#: Steps that divide an hour [min].
STEPS: Final = (30, 20, 15, 12, 10, 6, 5, 4, 3, 2, 1)
#: Records after the start that are left out: a given initial state adapts.
START: Final = 3


def watched(building: Building, outputs: Sequence[Output]) -> list[Output]:
    """Air temperatures of zones without plant that are not among the outputs of a run."""
    names = {output.name for output in outputs}
    all_outputs = building.outputs()
    columns = free_airs(building, all_outputs).values()
    return [all_outputs[column] for column in columns if all_outputs[column].name not in names]


def member_errors(
    building: Building, outputs: Sequence[Output], records: npt.NDArray[np.float64], scheme: str = "sdirk2"
) -> npt.NDArray[np.float64]:
    """Largest error of an air by the time step in each member of an ensemble.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What is recorded.
    records : ndarray, shape (members, rows, outputs)
        The records, of every step. [unit of each output]
    scheme : str
        Time-stepping scheme.

    Returns
    -------
    ndarray, shape (members,)
        Root mean square as of `Bends`; NaN where no air of a zone without plant was recorded. [K]
    """
    columns = list(free_airs(building, outputs).values())
    order, share = SHARES[scheme]
    if not columns or records.shape[1] <= START + order:
        return np.full(len(records), np.nan)
    bends = np.diff(records[:, START:, columns], order, axis=1)
    return np.asarray(share * np.sqrt(np.mean(bends**2, axis=1)).max(axis=1))


def free_airs(building: Building, outputs: Sequence[Output]) -> dict[str, int]:
    """Zones without heating and cooling whose air temperature is an output, with its position.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        The outputs.
    """
    zones = list(building.zones.items())
    columns = {}
    for column, output in enumerate(outputs):
        if output.kind != "air_temperature" or output.zone is None:
            continue
        name, zone = zones[output.zone]
        if zone.heating is None and zone.cooling is None:
            columns[name] = column
    return columns


class Bends:
    """How much the air temperatures of a run bend from step to step, from its records in blocks.

    The error of a scheme of second order is a share of the step squared times the second derivative, and the
    second difference of a series is this product; that of a scheme of first order is a share of the first
    difference. Zones with heating or cooling are left out: their set
    points jump.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What is recorded.
    scheme : str
        Time-stepping scheme.
    """

    def __init__(self, building: Building, outputs: Sequence[Output], scheme: str = "sdirk2") -> None:
        self._order, self._share = SHARES[scheme]
        columns = free_airs(building, outputs)
        self._names = list(columns)
        self._columns = list(columns.values())
        self._skip = START
        self._before = np.empty((0, len(self._columns)))
        self._sum = np.zeros((1, len(self._columns)))
        self._count = 0

    def add(self, rows: npt.NDArray[np.float64]) -> None:
        """Add the next records, shape (n, outputs or more). [unit of each output]"""
        series = np.concatenate([self._before, rows[self._skip :, self._columns]])
        self._skip = max(self._skip - len(rows), 0)
        bends = np.diff(series, self._order, axis=0)
        # One after the other, so that the sum does not depend on the blocks.
        self._sum = np.add.accumulate(np.concatenate([self._sum, bends**2]), axis=0)[-1:]
        self._count += len(bends)
        self._before = series[-self._order :]

    def errors(self) -> npt.NDArray[np.float64]:
        """Estimate of the error of each series by the time step, root mean square. [K]"""
        return np.asarray(self._share * np.sqrt(self._sum[0] / max(self._count, 1)))

    def warnings(self, step_seconds: float) -> Iterator[RunWarning]:
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
            text = (
                f"zones.{name}: the time step of {step_seconds / 60.0:g} min is too long for its air, which "
                f"reacts faster: its temperature is wrong by about {error:.1g} K (root mean square); take a "
                f"step of {better} min"
            )
            yield RunWarning(text, WarningKind.STEP)
