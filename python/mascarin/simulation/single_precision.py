"""How far results in single precision are from those in double precision: some members are run in both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Units of differences that are not those of the results.
_OF_DIFFERENCE: Final = {"degC": "K", "-": ""}

CHECKED: Final = 8
"""Members that are run again in double precision: as many as the engine runs at once."""


#: Relative energy-balance residual: those in single precision are larger, those in double smaller. [-]
_DOUBLE: Final = 1e-9


def run_in_double(closure: Array) -> list[str]:
    """One line where members of an ensemble in single precision were run in double precision, else nothing.

    Parameters
    ----------
    closure : ndarray, shape (members,)
        Relative energy-balance residual of each member, by which they are told apart. [-]

    Examples
    --------
    >>> run_in_double(np.array([2e-6, 1e-14, 3e-6]))
    ['1 of 3 members were run in double precision']
    """
    count = int(np.count_nonzero(closure < _DOUBLE))
    return [f"{count} of {len(closure)} members were run in double precision"] if count else []


@dataclass(frozen=True)
class Difference:
    """Difference of one result between single and double precision.

    Parameters
    ----------
    name : str
        The output or objective.
    unit : str
        Unit of the difference: K for temperatures, nothing for ratios.
    rms : float
        Root mean square over the members (and times) that were compared. [unit of the result]
    largest : float
        Largest magnitude. [unit of the result]
    members : int
        Members that were compared.

    Examples
    --------
    >>> print(Difference("room.air_temperature", "K", 0.0004, 0.0007, 8))
    room.air_temperature differs by 0.0004 K (rms), 0.0007 K at most, in 8 members
    """

    name: str
    unit: str
    rms: float
    largest: float
    members: int

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"{self.name} differs by {self.rms:.2g}{unit} (rms), {self.largest:.2g}{unit} at most, "
            f"in {self.members} members"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"unit": self.unit, "rms": self.rms, "largest": self.largest, "members": self.members}


def members_to_check(count: int) -> list[int]:
    """Members that are run in both precisions, evenly over all.

    Parameters
    ----------
    count : int
        Number of all members.

    Examples
    --------
    >>> members_to_check(3), members_to_check(15)
    ([0, 1, 2], [0, 2, 4, 6, 8, 10, 12, 14])
    """
    return sorted({round(k * (count - 1) / (CHECKED - 1)) for k in range(CHECKED)})


def differences(names: Sequence[str], units: Sequence[str], single: Array, double: Array) -> list[Difference]:
    """Compare results of the same members.

    Parameters
    ----------
    names, units : sequence of str, length K
        The results.
    single, double : ndarray, shape (members, ..., K)
        Their values. Members that failed are NaN and are left out. [unit of each]

    Returns
    -------
    list of Difference
        One for each result of which a member can be compared.

    Examples
    --------
    >>> [found] = differences(["peak"], ["degC"], np.array([[30.001], [31.0]]), np.array([[30.0], [31.0]]))
    >>> round(found.largest, 6)
    0.001
    """
    apart = (single - double).reshape(len(single), -1, len(names))
    lines = []
    for k, (name, unit) in enumerate(zip(names, units, strict=True)):
        of_output = apart[:, :, k]
        of_output = of_output[np.isfinite(of_output).all(axis=1)]
        if of_output.size:
            rms, largest = float(np.sqrt(np.mean(of_output**2))), float(np.abs(of_output).max())
            lines.append(Difference(name, _OF_DIFFERENCE.get(unit, unit), rms, largest, len(of_output)))
    return lines
