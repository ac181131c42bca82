"""A linear building as matrices (Guichard et al., eq. 1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mascarin import _engine
from mascarin._io import memory
from mascarin._io.durations import seconds_of
from mascarin.engine_errors import translated

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StateSpace:
    """A linear model in state space: ``dx/dt = A x + B u``, ``y = C x + D u``.

    States are temperatures of finite volumes and zone airs [degC]. Inputs are the outdoor air temperature
    [degC], the emission of the sky [W/m2], irradiances on surfaces [W/m2], heat by the outdoor air into soil
    [W/m2], measured temperatures [degC], and ``one``, the constant 1, for the constant terms of linearized
    radiation. Outputs are temperatures of zone airs and surfaces [degC].

    Parameters
    ----------
    a, b, c, d : ndarray, shapes (n, n), (n, m), (p, n), (p, m)
        The matrices. [1/s and units of the inputs]
    states, inputs, outputs : list of str
        Names of rows and columns.
    warnings : tuple of str
        Warnings about the building and its mesh.

    Examples
    --------
    >>> one = np.ones((1, 1))
    >>> StateSpace(-one / 3600.0, one, one, one, ["air"], ["outdoor"], ["air"]).time_constants()
    array([3600.])
    """

    a: Array
    b: Array
    c: Array
    d: Array
    states: list[str]
    inputs: list[str]
    outputs: list[str]
    warnings: tuple[str, ...] = ()

    def time_constants(self) -> Array:
        """Time constants, longest first, shape (n,). [s]"""
        return np.sort(-1.0 / np.linalg.eigvals(self.a).real)[::-1]


def _require_room(building: Building, cells: int) -> None:
    """Refuse matrices that memory does not hold: they grow with the square of the cells."""
    states = cells + len(building.zones)
    surfaces = 2 * (len(building.surfaces) + len(building.windows))
    nodes = states + surfaces
    # Conductances of all nodes; rows of the states, before and after they are split; responses of surfaces.
    size = 8.0 * (nodes * nodes + 2.0 * states * (states + surfaces) + 3.0 * surfaces * (states + surfaces))
    memory.require(
        size, f"state_space: matrices of {states} states", "describe layers with fewer nodes (`nodes:`)"
    )


def state_space(building: Building, *, step: str | float = "15min") -> StateSpace:
    """Write a linear building as the matrices of a model in state space.

    Parameters
    ----------
    building : Building
        Every law in it is linear and constant: constant convective coefficients, linearized or no long-wave
        exchange, no phase change, constant infiltration.
    step : str or float
        Time step for which the mesh is chosen, such as ``15min``, or a number of seconds. [s]

    Returns
    -------
    StateSpace
        Matrices with named states, inputs and outputs.

    Raises
    ------
    InputError
        A law is not linear and constant; the text names the first one and what to use instead. Matrices that
        memory does not hold.

    References
    ----------
    Guichard et al., eq. 1: ``C dT/dt = A T + B``.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> linear = {"kind": "linearised", "reference": 20.0}
    >>> building = box().replace(
    ...     {"zones.room.longwave": linear, "surfaces.facade.outside.longwave": linear}
    ... )
    >>> state_space(building).outputs
    ['room.air_temperature', 'facade.outside_temperature', 'facade.inside_temperature']
    """
    from mascarin.building.checks import plausibility  # pydantic

    description = building.to_engine(seconds_of(step), {})
    with translated():
        plan = _engine.Plan(description.json)
        _require_room(building, plan.n_cells)
        raw = plan.state_space(description.values)
    return StateSpace(**raw, warnings=tuple(plausibility.warnings(building, description.notes)))
