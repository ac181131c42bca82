"""Numbers that are kept of a member instead of its series, given as text that any worker can read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from mascarin._io.limits import above, below
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import xarray as xr

_STATISTICS: Final[dict[str, Callable[[xr.DataArray, float], xr.DataArray]]] = {
    "min": lambda series, _: series.min("time"),
    "mean": lambda series, _: series.mean("time"),
    "max": lambda series, _: series.max("time"),
    "sd": lambda series, _: series.std("time"),
    # Each record represents the interval before it; the first is the state at the start.
    "above": lambda series, limit: _hours(series, above(series, limit)),
    "below": lambda series, limit: _hours(series, below(series, limit)),
}


@dataclass(frozen=True)
class Statistic:
    """A statistic of one output over time.

    Parameters
    ----------
    kind : str
        ``min``, ``mean``, ``max``, ``sd`` [unit of the output]; ``above``, ``below`` [h].
    output : str
        Name of the output.
    limit : float
        Limit of ``above`` and ``below``. [unit of the output]

    Examples
    --------
    >>> Statistic.read("above:26:room.operative_temperature")
    Statistic(kind='above', output='room.operative_temperature', limit=26.0)
    """

    kind: str
    output: str
    limit: float = 0.0

    def __call__(self, run: xr.Dataset) -> xr.DataArray:
        """Value for each member, shape (members,)."""
        return _STATISTICS[self.kind](run[self.output], self.limit)

    @classmethod
    def read(cls, text: str) -> Statistic:
        """Read ``max:room.air_temperature`` or ``above:26:room.operative_temperature``.

        Parameters
        ----------
        text : str
            Kind, limit where there is one, and output, joined by colons.

        Raises
        ------
        InputError
            Another text.
        """
        kind, *arguments = text.split(":")
        limited = kind in ("above", "below")
        if kind not in _STATISTICS or len(arguments) != 1 + limited or not arguments[-1]:
            raise InputError(
                f"objective: found '{text}'; expected min, mean, max or sd and an output "
                "(max:room.air_temperature), or above or below with a limit "
                f"(above:26:room.operative_temperature). {did_you_mean(kind, list(_STATISTICS))}".rstrip()
            )
        try:
            return cls(kind, arguments[-1], float(arguments[0]) if limited else 0.0)
        except ValueError:
            raise InputError(
                f"objective: found '{text}', whose limit '{arguments[0]}' is no number"
            ) from None


def _hours(series: xr.DataArray, counted: xr.DataArray) -> xr.DataArray:
    import numpy as np

    times = series["time"].to_numpy()
    interval = float((times[1] - times[0]) / np.timedelta64(1, "h"))
    return counted.isel(time=slice(1, None)).sum("time") * interval
