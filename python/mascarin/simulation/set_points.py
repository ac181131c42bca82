"""Heating set points at or below cooling set points, in every member and at all times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.channels import CHANNELS

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


def require_apart(
    building: Building,
    vectors: Array,
    forcing: Array,
    *,
    positions: Mapping[str, int],
    channels: Sequence[str],
    times: pd.DatetimeIndex,
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
    times : pandas.DatetimeIndex, shape (rows,)
        Times of the records.

    Raises
    ------
    InputError
        Naming the zone, the member, the time and both set points.
    """

    def set_point(zone: str, which: str) -> Array:
        """Set points at the ends of the steps, shape (members, 1) or (1, steps). [degC]"""
        loads = building.zones[zone].plants[which]
        if loads.setpoint.schedule is None:
            return vectors[:, [positions[f"zones.{zone}.{which}.setpoint.temperature"]]]
        place = len(CHANNELS) + list(channels).index(f"schedule {loads.setpoint.schedule}")
        return forcing[None, :, -1, place]

    for name, zone in building.zones.items():
        if zone.heating is None or zone.cooling is None:
            continue
        heating, cooling = set_point(name, "heating"), set_point(name, "cooling")
        bad = np.argwhere(heating > cooling + 1e-9)
        if not len(bad):
            continue
        member, step = (int(i) for i in bad[0])
        warm, cold = (
            float(np.broadcast_to(x, (len(vectors), len(forcing)))[member, step]) for x in (heating, cooling)
        )
        raise InputError(
            f"zones.{name}: found heating to {warm:g} degC above cooling to {cold:g} degC at the end "
            f"of the step from {times[step]:%Y-%m-%d %H:%M}"
            f"{f' (member {member})' if len(vectors) > 1 else ''}; expected a heating set point at or "
            "below the cooling set point at all times: lower the one or raise the other"
        )
