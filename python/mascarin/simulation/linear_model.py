"""A linear building as the matrices of the paper's eq. 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mascarin import _engine
from mascarin.simulation.engine_errors import translated

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StateSpace:
    """``dx/dt = A x + B u``, ``y = C x + D u``.

    States are cell and air temperatures [degC]. Inputs are the outdoor air [degC], the emission of the sky
    [W/m2], irradiances on faces [W/m2], measured temperatures [degC], and `one`, the constant 1 that carries
    what linearised radiation leaves over. Outputs are air and face temperatures [degC].

    Attributes
    ----------
    a, b, c, d : ndarray, shapes (n, n), (n, m), (p, n), (p, m)
        The matrices. [1/s and units of the inputs]
    states, inputs, outputs : list of str
        Names of rows and columns.
    """

    a: Array
    b: Array
    c: Array
    d: Array
    states: list[str]
    inputs: list[str]
    outputs: list[str]

    def time_constants(self) -> Array:
        """Time constants, longest first, shape (n,). [s]"""
        return np.sort(-1.0 / np.linalg.eigvals(self.a).real)[::-1]


def state_space(building: Building, *, step: float = 900.0) -> StateSpace:
    """Write a linear building as matrices.

    Parameters
    ----------
    building : Building
        Every law in it linear and constant: constant films, linearised or no long-wave exchange, no phase
        change, constant infiltration.
    step : float
        Step the mesh is chosen for. [s]

    Returns
    -------
    StateSpace
        Matrices with named states, inputs and outputs.

    Raises
    ------
    InputError
        A law is not linear and constant; the text names the first one and what to use instead.

    References
    ----------
    Guichard et al., eq. 1: ``C dT/dt = A T + B``.
    """
    description = building.to_engine(step, {})
    with translated():
        raw = _engine.Plan(description.json).state_space(description.values)
    return StateSpace(**raw)
