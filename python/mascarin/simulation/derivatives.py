"""Derivatives by parameters: of series in forward mode, of one quantity made of them in reverse mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mascarin.simulation.preparation.engine_run import MEMORY
from mascarin.simulation.preparation.objectives import Gradient, Mean, Objective, SquaredResiduals
from mascarin.simulation.preparation.options import RunOptions, described
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    import xarray as xr

    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.simulation.preparation.options import Scheme, TimeLike
    from mascarin.weather import Climate, Measurements

__all__ = ["Gradient", "Mean", "Objective", "SquaredResiduals", "gradient", "jacobian"]


@described
def gradient(
    building: Building,
    climate: Climate,
    objective: Objective,
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
    memory: int = MEMORY,
) -> Gradient:
    """One quantity and its derivatives by all parameters, in reverse mode.

    The derivatives follow from one pass backward along the run, whatever the number of parameters. They are
    the exact derivatives of the discrete solution, as `jacobian` gives them; where the model switches (the
    ends of a melting range, a curve of hysteresis, windward and leeward, ideal loads that start or reach
    their capacity) they are one-sided: those of the branch that the run took.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    objective : callable
        From the series by output to a value and its derivatives by each: `Mean`, `SquaredResiduals` or a
        function of your own.
    <run options>
    memory : int
        About how much of the run may be kept: beyond it parts are calculated again. [B]

    Returns
    -------
    Gradient
        The value and its derivatives.

    Raises
    ------
    InputError
        Unknown path, a value that the parameter cannot have, an objective that does not fit the outputs.
    SolverError
        A step or the repeated first period did not converge.

    References
    ----------
    Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3 and 12, doi:10.1137/1.9780898717761.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> from mascarin.simulation import Mean
    >>> found = mc.gradient(box(), box_climate(), Mean("room.air_temperature"), step="1h")
    >>> found.slopes["surfaces.facade.outside.absorptance"] > 0.0
    True
    """
    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    simulation = Simulation(building, climate, **options.keywords())
    return simulation.gradient(objective, memory=memory, progress=progress)


@described
def jacobian(
    building: Building,
    climate: Climate,
    vary: Sequence[str],
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
) -> xr.Dataset:
    """Series of a building and their derivatives by some parameters, in forward mode.

    The derivatives by eight parameters are calculated side by side along one run: use this where parameters
    are few and series many. They are the exact derivatives of the discrete solution, through phase change,
    convection that depends on temperature and wind, long-wave exchange and the repeated start. Where the
    model switches (the ends of a melting range, windward and leeward) they are one-sided: those of the branch
    that the run took.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    vary : sequence of str
        Paths of the parameters to derive by.
    <run options>

    Returns
    -------
    xarray.Dataset
        Each output over (time), and ``d <output>`` over (parameter, time); coordinates ``time`` (UTC),
        ``local_time`` and ``parameter_unit``. [unit of the output / unit of the parameter]

    Raises
    ------
    InputError
        Unknown or structural path, a value that the parameter cannot have.
    SolverError
        A step or the repeated first period did not converge.

    References
    ----------
    Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3, doi:10.1137/1.9780898717761.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> path = "surfaces.facade.outside.absorptance"
    >>> found = mc.jacobian(box(), box_climate(), [path], step="1h", outputs=["room.air_temperature"])
    >>> bool(found["d room.air_temperature"].sel(parameter=path).max() > 0.0)
    True
    """
    options = RunOptions(
        parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
    )  # fmt: skip
    return Simulation(building, climate, **options.keywords()).jacobian(vary, progress=progress)
