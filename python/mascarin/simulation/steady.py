"""The steady state of a building in weather that does not change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.arguments import names_of
from mascarin._io.durations import seconds_of
from mascarin.errors import SolverError
from mascarin.simulation.checks.energy import FLOWS
from mascarin.simulation.simulation import Simulation
from mascarin.tables.forcing_blocks import ForcingBlocks

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.simulation.preparation.options import TimeLike
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]

#: Length of a step of backward Euler, three years, and their number. A mode of time constant t is reduced by
#: ``1/(1 + step/t)`` in each: one of a year (2 m of soil have 0.1) to 1e-36.
_STEP: Final = 1e8
_STEPS: Final = 60
#: Temperature everywhere that the search begins at, which a steady state does not depend on. [degC]
_BEGIN: Final = 20.0
#: Magnitude of flows below which a building is at rest. [W]
_SMALLEST_FLOWS: Final = 1e-3
#: Heat flows of a steady state sum to zero within this part of their magnitudes. [-]
CLOSED: Final = 1e-9


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The steady state of a building: outputs, heat flows and how well they balance.

    Parameters
    ----------
    values : mapping of str to float
        Outputs by name. [unit of each]
    units : mapping of str to str
        Their units.
    flows : mapping of str to float
        Heat flows into the building, in the words of the energy balance of a run. [W]
    imbalance : float
        Their sum over the sum of their magnitudes. [-]
    moment : str
        When the weather was as it is taken, in local time.
    slopes : mapping of str to mapping of str to float
        Derivatives of outputs by parameters, by the paths of these. [unit of both]
    warnings : tuple of str
        Warnings about the building, and laws that do not hold in the steady state.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> state = mc.steady(box(), box_climate(), moment="2001-07-01 12:00")
    >>> abs(sum(state.flows.values())) < 1e-6
    True
    """

    values: Mapping[str, float]
    units: Mapping[str, str]
    flows: Mapping[str, float]
    imbalance: float
    moment: str
    slopes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        outputs = {name: {"unit": self.units[name], "value": value} for name, value in self.values.items()}
        flows = {f"{flow}_watt": value for flow, value in self.flows.items()}
        return {
            "moment": self.moment,
            "outputs": outputs,
            "flows": flows,
            "imbalance": self.imbalance,
            "slopes": {path: dict(by_output) for path, by_output in self.slopes.items()},
            "warnings": list(self.warnings),
        }

    def to_frame(self) -> pd.DataFrame:
        """Outputs with their values and units."""
        import pandas as pd

        return pd.DataFrame({"value": dict(self.values), "unit": dict(self.units)})


def steady(
    building: Building,
    climate: Climate,
    *,
    moment: TimeLike | None = None,
    parameters: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
    step: str | float = "15min",
    measurements: Measurements | None = None,
    vary: Sequence[str] = (),
) -> SteadyState:
    """Find the state that a building comes to in weather that does not change.

    Weather, sun, schedules and measured columns are those of the step that ends at a moment. The equations
    are those of a run, solved by steps of backward Euler that are long against all that the building stores:
    what is left of storage is the steady state. Loads, melting, natural convection, radiation and openings
    follow their laws. Liquid fractions of a material with hysteresis depend on the way there, from 20 degC.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    moment : str, datetime or pandas.Timestamp, optional
        The moment; local time of the climate unless an offset is given. Default: the end of the first step.
    parameters : mapping of str to float, optional
        Values by path that replace those of the building. [unit of each]
    outputs : sequence of str, optional
        What to record. Default: as in a run.
    step : str or float
        Step at whose end the moment is, and for which the mesh is chosen; radiation is its mean. [s]
    measurements : Measurements, optional
        Table of the measured columns that the building names.
    vary : sequence of str
        Paths of the parameters to derive by, exactly.

    Returns
    -------
    SteadyState
        Outputs, heat flows and their balance.

    Raises
    ------
    InputError
        Something that cannot be used.
    SolverError
        There is no steady state: what is heated loses nothing, or an opening opens and closes on and on.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> state = mc.steady(box(), box_climate(), moment="2001-07-02 00:00", outputs=["room.air_temperature"])
    >>> round(state["room.air_temperature"], 3) == round(state.values["room.air_temperature"], 3)
    True
    """
    paths = names_of("vary", vary) if vary else []
    simulation = _at_a_moment(
        building,
        climate,
        moment,
        parameters=parameters,
        outputs=outputs,
        step=step,
        measurements=measurements,
    )
    one_step, clock = simulation.compiled, f"{simulation.end:%Y-%m-%d %H:%M}"
    vector = simulation.vector({})
    # Weather with gains or offsets is fixed at the values of the building.
    row = one_step.forcing_at(vector)[-1:]
    settings = dict(one_step.settings) | {"dt": _STEP, "initial": _BEGIN, "warmup_steps": 0}

    def through(steps: int) -> Any:
        forcing = ForcingBlocks.of(np.repeat(row, steps, axis=0))
        return replace(one_step, forcing_blocks=forcing, settings=settings, inputs=None)

    before = through(_STEPS - 1).run(vector)[1]
    before_laws = {(law[0], law[1]): law[2] for law in before["out_of_range"]}
    compiled = through(_STEPS)
    records, after = compiled.run(vector)
    flows = {flow: (float(after[flow]) - float(before[flow])) / _STEP for flow in FLOWS}
    size = sum(abs(flow) for flow in flows.values())
    imbalance = abs(sum(flows.values())) / max(size, _SMALLEST_FLOWS)
    names = [output.name for output in simulation.outputs]
    _require_still(records, names, imbalance)
    slopes: dict[str, dict[str, float]] = {}
    if paths:
        simulation.compiled = compiled
        free = [simulation.building.parameter(path).path for path in paths]
        by_path = simulation.jacobian_vector(free, vector)[1][:, -1]
        slopes = {
            path: dict(zip(names, map(float, values), strict=True))
            for path, values in zip(free, by_path, strict=True)
        }
    return SteadyState(
        values=dict(zip(names, map(float, records[-1]), strict=True)),
        units={output.name: output.unit for output in simulation.outputs},
        flows=flows,
        imbalance=imbalance,
        moment=clock,
        slopes=slopes,
        warnings=(*simulation.building_warnings, *_laws_beyond(before_laws, after)),
    )


class _OneStep(Simulation):
    """A run of one step, of which the length counts for nothing: the steps of `steady` last years."""

    def _require_control_times(self, vectors: Array) -> None:
        """Take minimum times of controls of any length: a step of years is longer."""


def _at_a_moment(
    building: Building, climate: Climate, moment: TimeLike | None, *, step: str | float, **options: Any
) -> Simulation:
    """A run of the one step that ends at a moment."""
    import pandas as pd

    from mascarin.tables.timezones import seconds_at, with_year

    grid, length = climate.grid, seconds_of(step)
    end = grid.start + length
    if moment is not None:
        stated = seconds_at(with_year(moment, grid.zone, grid.start), grid.zone, "moment")
        # Within the first step it is the end of that; before the weather the period is refused.
        end = stated if stated < grid.start else max(stated, end)
    start, last = (pd.Timestamp(seconds, unit="s", tz="UTC") for seconds in (end - length, end))
    return _OneStep(
        building,
        climate,
        start=start,
        end=last,
        step=step,
        scheme="backward-euler",
        initial=_BEGIN,
        **options,
    )


def _laws_beyond(before: Mapping[tuple[str, str], int], after: Mapping[str, Any]) -> Iterator[str]:
    """Laws written as text that do not hold in the last step; those of the way there do not count."""
    for owner, law, steps, _first, _values in after["out_of_range"]:
        if steps > before.get((owner, law), 0):
            yield (
                f"{owner}: its law of {law} is outside of its 'valid' in the steady state. The formula is "
                "used as it is there: take a law that holds, or widen 'valid' where its source does"
            )


def _require_still(records: Array, names: Sequence[str], imbalance: float) -> None:
    """Refuse what still changes, or has flows that do not balance.

    Raises
    ------
    SolverError
        With the output that changes most.
    """
    moved = np.abs(records[-1] - records[-2]) / np.maximum(1.0, np.abs(records[-1]))
    worst = int(np.argmax(moved)) if moved.size else 0
    change = float(moved[worst]) if moved.size else 0.0
    if change <= CLOSED and imbalance <= CLOSED:
        return
    still = f"flows differ by {imbalance:.1e} of all heat"
    what = f"{names[worst]} still changes" if change > CLOSED else still
    raise SolverError(
        f"steady state: {what} after {_STEPS} steps of {_STEP / 3.156e7:.0f} years, expected balance. "
        "Heat that nothing takes away warms on and on: give an adiabatic part a way for heat to leave; an "
        "opening with a control may open and close on and on: leave its 'control' out"
    )
