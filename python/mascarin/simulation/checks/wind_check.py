"""Check of the wind that drives air through openings: a climate must have it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate


def require_wind(building: Building, climate: Climate, *, calm: bool) -> None:
    """Refuse a climate without wind where wind drives air through vents; a measured calm is no such climate.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    calm : bool
        Whether the wind has no speed in any step of the run.

    Raises
    ------
    InputError
        There is no wind in the whole record, or no direction of it; the text names a vent and what to do.
    """
    windy = [name for name, vent in building.vents.items() if vent.windy]
    directed = [name for name, vent in building.vents.items() if vent.directed]
    record = climate.record
    speeds = record.columns.get("wind_speed")
    still = speeds is None or not np.nan_to_num(speeds).any()
    if still and record.measured("wind_speed"):
        return
    if windy and calm and still:
        raise InputError(
            "climate: found no wind in the whole record (0 m/s, or 'absent: [wind_speed]'), expected a wind "
            f"speed: the wind drives air through {_some(windy)}. Give the column of the wind speed, a speed "
            "in place of it ('absent: {wind_speed: 2}'), or write 'pressure: none' at the vents, which stack "
            "alone then drives"
        )
    # A direction that is stated may be 360: the forcing does not tell it from one that is absent.
    directions = record.columns.get("wind_direction")
    if directed and (directions is None or not np.nan_to_num(directions).any()):
        raise InputError(
            "climate: found no direction of the wind in the whole record (0 deg, or 'absent: "
            "[wind_direction]'), expected one: the wind pressure on "
            f"{_some(directed)} depends on it. Give the column of the wind direction, a direction in place "
            "of it ('absent: {wind_direction: 225}'; 360 is north), or wind pressure coefficients that hold "
            "for all directions ('pressure: {kind: table, coefficients: [0.3]}')"
        )


def _some(names: list[str]) -> str:
    ending = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return f"vents.{names[0]}{ending}"
