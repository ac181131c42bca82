"""One run of a building in a climate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mascarin.simulation.preparation.options import RunOptions, described
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.simulation.preparation.options import Scheme, TimeLike
    from mascarin.simulation.results import Results
    from mascarin.weather import Climate, Measurements


@described
def simulate(
    building: Building,
    climate: Climate,
    *,
    parameters: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    measurements: Measurements | None = None,
    progress: ProgressOption = None,
) -> Results:
    """Run a building in a climate.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    <run options>

    Returns
    -------
    Results
        Series by name and the energy balance.

    Raises
    ------
    InputError
        Something that cannot be used, before the run.
    SolverError
        A step or the repeated first period did not converge.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> run = mc.simulate(box(), box_climate(), step="1h", parameters={"zones.room.volume": 30.0})
    >>> run["room.air_temperature"].attrs["units"]
    'degC'
    """
    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    return Simulation(building, climate, **options.keywords()).run(progress=progress)
