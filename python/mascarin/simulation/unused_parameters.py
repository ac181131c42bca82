"""Parameters that change nothing in a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import SolverError
from mascarin.simulation.preparation.prepare import period
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    from mascarin.building import Building, Parameter
    from mascarin.simulation.preparation.options import TimeLike
    from mascarin.weather import Climate, Measurements


#: Outputs that repeat the geometry of a side, whether or not anything depends on it.
_OF_GEOMETRY: Final = (".sky_view_factor", ".ground_view_factor")


def inactive_parameters(
    building: Building,
    climate: Climate,
    *,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    measurements: Measurements | None = None,
) -> dict[str, str]:
    """Find the parameters of a building that nothing in a run depends on.

    Each parameter that is not structural is changed a little, one at a time; it is active when any output or
    the energy balance changes by any bit.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    start, end : str, datetime or pandas.Timestamp, optional
        Period; by default the first three days of the climate, or all of a shorter one.
    step, measurements
        As in `Simulation`.

    Returns
    -------
    dict of str to str
        Path of each parameter that changed nothing, and why: the reason that the description gives, or that
        it did not act in this period.

    Raises
    ------
    InputError
        Something that cannot be used.
    SolverError
        The building cannot be simulated as it is.

    Examples
    --------
    >>> from mascarin.examples import box, box_climate
    >>> "zones.room.volume" in inactive_parameters(box(), box_climate(), step="1h")
    False
    """
    import pandas as pd

    begin, last = period(climate, start, end)
    if end is None:
        last = min(last, begin + pd.Timedelta(days=3))
    trial = Simulation(
        building,
        climate,
        outputs=[output.name for output in building.outputs() if not output.name.endswith(_OF_GEOMETRY)],
        start=begin,
        end=last,
        step=step,
        initial=20.0,
        measurements=measurements,
    )
    samples = np.tile(trial.values, (len(trial.paths) + 1, 1))
    for position, path in enumerate(trial.paths):
        moved = np.array([[_moved(building.parameter(path))]])
        samples[position + 1] = trial.varied([path], moved)[0]
    records, residuals, failures = trial.ensemble(samples)
    failed = {failure.member for failure in failures}
    if 0 in failed:
        raise SolverError(failures[0].reason)
    reasons = {}
    for member, path in enumerate(trial.paths, start=1):
        same = np.array_equal(records[member], records[0]) and residuals[member] == residuals[0]
        if same and member not in failed:
            reasons[path] = building.parameter(path).reason or "did not act in this period"
    return reasons


def _moved(parameter: Parameter) -> float:
    """A value a tenth of the way from the nominal one to an end of its range. [its unit]"""
    value, low, high = parameter.value, parameter.low, parameter.high
    if high > value:
        return value + 0.1 * (high - value)
    if low < value:
        return value - 0.1 * (value - low)
    nudge = 1e-3 * max(abs(value), 1.0)
    return value + nudge if value + nudge <= parameter.upper else value - nudge
