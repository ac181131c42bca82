"""Checks of parameter vectors: limits of each parameter, and heating set points below cooling ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.channels import CHANNELS

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building, Parameter
    from mascarin.simulation.times import Times

    Array = npt.NDArray[np.float64]


#: Comparisons made at once: members times steps would not fit into memory.
_AT_ONCE: Final = 2**22


class Limits:
    """Limits of parameters, in the order of a parameter vector.

    Parameters
    ----------
    parameters : sequence of Parameter, length P
        The parameters.
    """

    def __init__(self, parameters: Sequence[Parameter]) -> None:
        self._parameters = list(parameters)
        self._lower = np.array([p.lower for p in parameters])
        self._upper = np.array([p.upper for p in parameters])

    def require(self, vectors: Array) -> None:
        """Refuse vectors of the wrong length, or with a value outside its limits.

        Parameters
        ----------
        vectors : ndarray, shape (M, P)
            Parameter vectors. [unit of each]

        Raises
        ------
        InputError
            Naming the parameter, the member, the value and the limits.
        """
        if vectors.ndim != 2 or vectors.shape[1] != len(self._parameters):
            raise InputError(
                f"samples: found an array of shape {vectors.shape}, expected (members, "
                f"{len(self._parameters)}): one value for each parameter"
            )
        # A value that is no number makes only its own member fail.
        bad = np.argwhere((vectors < self._lower) | (vectors > self._upper))
        if bad.size:
            member, k = (int(i) for i in bad[0])
            parameter = self._parameters[k]
            raise InputError(
                f"samples: {parameter.path} of member {member}: found {vectors[member, k]:g} "
                f"{parameter.unit}; expected {parameter.allowed}"
            )


def require_set_points_apart(
    building: Building,
    vectors: Array,
    forcing: Array,
    *,
    positions: Mapping[str, int],
    channels: Sequence[str],
    times: Times,
) -> None:
    """Refuse heating above cooling.

    Parameters
    ----------
    building : Building
        The building.
    vectors : ndarray, shape (M, P)
        Parameter vectors. [unit of each]
    forcing : ndarray, shape (steps, stages, channels)
        What acts on the building, schedules included. [unit of each]
    positions : mapping of str to int
        Position of each parameter in a vector.
    channels : sequence of str
        Channels of the forcing after those of the climate.
    times : Times
        Times of the records.

    Raises
    ------
    InputError
        Naming the zone, the member, the time and both set points.
    """

    def set_point(zone: str, which: str) -> Array:
        """Set points at the ends of the steps, shape (members, 1) or (1, steps). [degC]"""
        point = building.zones[zone].loads[which].setpoint
        if point.temperature is not None:
            return vectors[:, [positions[f"zones.{zone}.{which}.setpoint.temperature"]]]
        place = len(CHANNELS) + list(channels).index(f"schedule {point.course}")
        return forcing[None, :, -1, place]

    for name, zone in building.zones.items():
        if zone.heating is None or zone.cooling is None:
            continue
        heating, cooling = set_point(name, "heating"), set_point(name, "cooling")
        found = _first_above(heating, cooling + 1e-9)
        if found is None:
            continue
        member, step = found
        warm, cold = (
            float(np.broadcast_to(x, (len(vectors), len(forcing)))[member, step]) for x in (heating, cooling)
        )
        raise InputError(
            f"zones.{name}: found heating to {warm:g} degC above cooling to {cold:g} degC at the end "
            f"of the step from {times.index[step]:%Y-%m-%d %H:%M}"
            f"{f' (member {member})' if len(vectors) > 1 else ''}; expected a heating set point at or "
            "below the cooling set point at all times: lower the one or raise the other"
        )


def _first_above(high: Array, low: Array) -> tuple[int, int] | None:
    """First place where `high` is above `low`; the two are broadcast, a part of the rows at a time."""
    rows, columns = np.broadcast_shapes(high.shape, low.shape)
    part = max(_AT_ONCE // columns, 1)
    for first in range(0, rows, part):
        above, below = (one if len(one) == 1 else one[first : first + part] for one in (high, low))
        bad = np.argwhere(above > below)
        if len(bad):
            return first + int(bad[0][0]), int(bad[0][1])
    return None
