"""The energy balance of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np

from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

FLOWS: Final = (
    "solar",
    "convection",
    "longwave",
    "boundary",
    "infiltration",
    "ventilation",
    "interzone",
    "gains",
    "heating",
    "cooling",
    "transmitted",
    "glass",
    "bridges",
    "sources",
)
"""Heat flows into a building; cooling removes heat and is negative."""

CLOSED: Final = 1e-10
"""Relative energy-balance residual up to which an energy balance closes: rounding stays below it. [-]"""


CLOSED_SINGLE: Final = 1e-4
"""The same in single precision: members that are above it have been run again in double precision. [-]"""


def balance_warnings(residuals: Array, first: int = 0, precision: str = "double") -> list[RunWarning]:
    """One line where the energy balance of a member of an ensemble does not close, else nothing.

    Parameters
    ----------
    residuals : ndarray, shape (members,)
        Relative energy-balance residual of each member; NaN for one that failed. [-]
    first : int
        Number of the first member.
    precision : str
        Of the members: ``double`` or ``single``.

    Returns
    -------
    list of RunWarning
        How many members do not close, and the worst of them.

    Examples
    --------
    >>> balance_warnings(np.array([1e-12, np.nan, 2e-9]))[0][:56]
    'the energy balance of 1 of 3 members does not close: the'
    """
    closed = CLOSED_SINGLE if precision == "single" else CLOSED
    open_ones = np.flatnonzero(residuals > closed)
    if not open_ones.size:
        return []
    worst = int(np.nanargmax(residuals))
    text = (
        f"the energy balance of {len(open_ones)} of {len(residuals)} members does not close: the heat stored "
        "and the heat that flowed in differ by more than "
        f"{closed:g} of all heat exchanged, most in member {first + worst} ({residuals[worst]:.1e}). Their "
        "temperatures may be wrong by as much or more: use another time-stepping scheme "
        "('apparent-capacity' never closes) or a shorter step"
    )
    return [RunWarning(text, WarningKind.ENERGY_BALANCE)]


@dataclass(frozen=True)
class EnergyLedger:
    """Heat by flow over a run, the heat stored, and how well they balance.

    Parameters
    ----------
    into : mapping of str to float
        Net heat into the building by flow. [J]
    stored : float
        Rise of the heat stored in walls and air. [J]
    turnover : float
        Total heat exchanged: sum of the magnitudes of all flows. [J]
    relative_residual : float
        Relative energy-balance residual: sum over steps of ``|stored - into|``, over the total heat
        exchanged. [-]

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> ledger = mc.simulate(box(), box_climate(), step="1h").energy
    >>> ledger.relative_residual < 1e-9
    True
    """

    into: Mapping[str, float]
    stored: float
    turnover: float
    relative_residual: float

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name != "closure"]

    @property
    def closure(self) -> float:
        """The same as `relative_residual`. [-]"""
        return self.relative_residual

    @property
    def closes(self) -> bool:
        """Whether the heat stored is the heat that flowed in: a residual of 1e-10 at most."""
        return self.relative_residual <= CLOSED

    def warnings(self) -> list[RunWarning]:
        """One line where the energy balance does not close, else nothing."""
        if self.closes:
            return []
        text = (
            "the energy balance does not close: the heat stored and the heat that flowed in differ by "
            f"{self.relative_residual:.1e} of all heat exchanged, expected {CLOSED:g} at most. Temperatures "
            "may be wrong by as much or more: use another time-stepping scheme ('apparent-capacity' never "
            "closes) or a shorter step"
        )
        return [RunWarning(text, WarningKind.ENERGY_BALANCE)]

    @classmethod
    def read(cls, raw: Mapping[str, Any]) -> Self:
        """Make one from the values that the engine returns.

        Parameters
        ----------
        raw : mapping
            Heat by flow, ``stored``, ``turnover`` [J] and ``closure`` [-].
        """
        into = {flow: float(raw[flow]) for flow in FLOWS}
        return cls(into, float(raw["stored"]), float(raw["turnover"]), float(raw["closure"]))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Make one from the values of `to_dict`.

        Parameters
        ----------
        values : mapping of str to float
            The values.
        """
        # Files of earlier versions have no thermal bridges.
        into = {flow: float(values.get(f"{flow}_joule", 0.0)) for flow in FLOWS}
        numbers = (values[key] for key in ("stored_joule", "turnover_joule", "closure"))
        return cls(into, *(float(number) for number in numbers))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        into = {f"{flow}_joule": value for flow, value in self.into.items()}
        return {
            "closure": self.relative_residual,
            "stored_joule": self.stored,
            "turnover_joule": self.turnover,
            **into,
        }

    def __repr__(self) -> str:
        return str(self)

    def __str__(self) -> str:
        lines = [f"{flow:<14}{value / 3.6e6:>12.3f} kWh" for flow, value in self.into.items()]
        residual = f"relative energy-balance residual {self.relative_residual:.1e}"
        return "\n".join([*lines, f"{'stored':<14}{self.stored / 3.6e6:>12.3f} kWh", residual])
