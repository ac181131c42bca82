"""The comfort of a zone from the series of a run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.comfort import ComfortSettings, Surroundings
from mascarin.comfort.assessment import Comfort, assess
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.comfort.evaluation import Floats
    from mascarin.weather import Climate

_AIR, _RADIANT, _OPERATIVE = "air_temperature", "mean_radiant_temperature", "operative_temperature"
_HUMIDITY = "relative_humidity"
_RADIANT_NOTE = (
    "the mean radiant temperature is the mean of the surfaces of the zone, weighted by area, and not that "
    "at a seat"
)


def comfort_of(
    columns: Mapping[str, Floats],
    units: Mapping[str, str],
    times: pd.DatetimeIndex,
    zone: str | None,
    climate: Climate | None,
    settings: ComfortSettings,
) -> Comfort:
    """Assess the comfort of a zone.

    Parameters
    ----------
    columns : mapping of str to ndarray, shape (times,)
        Series of the run by the name of their output.
    units : mapping of str to str
        Unit of each.
    times : pandas.DatetimeIndex, shape (times,)
        Local times.
    zone : str or None
        Name of the zone; None: the only one that was recorded.
    climate : Climate or None
        The weather of the run.
    settings : ComfortSettings
        How comfort is assessed.

    Returns
    -------
    Comfort
        The comfort of the zone.

    Raises
    ------
    InputError
        A series that is needed was not recorded, or something that the index needs is not known.
    """
    name = zone_of(columns, zone)
    notes: tuple[str, ...] = (_RADIANT_NOTE,)
    if f"{name}.{_AIR}" in columns and f"{name}.{_RADIANT}" in columns:
        air, radiant = columns[f"{name}.{_AIR}"], columns[f"{name}.{_RADIANT}"]
    elif f"{name}.{_OPERATIVE}" in columns and "humidity" not in settings.index_used.needs:
        air = radiant = columns[f"{name}.{_OPERATIVE}"]
        notes = (*notes, "the operative temperature is the mean of air and mean radiant temperature")
    else:
        missing = [f"{name}.{key}" for key in (_AIR, _RADIANT) if f"{name}.{key}" not in columns]
        raise InputError(
            f"{', '.join(missing)}: not recorded in this run; comfort needs "
            f"outputs=['{name}.{_AIR}', '{name}.{_RADIANT}', ...] of simulate"
        )
    around = None if climate is None else Surroundings.of(climate, times)
    return assess(
        name, settings, times, air, radiant, around, _humidity(columns, units, name, settings), notes
    )


def zone_of(columns: Mapping[str, Any], zone: str | None) -> str:
    """The zone whose comfort is meant.

    Raises
    ------
    InputError
        Nothing of it was recorded, or there are several and none is named.
    """
    keys = (_AIR, _RADIANT, _OPERATIVE)
    found = list(dict.fromkeys(n.rpartition(".")[0] for n in columns if n.rpartition(".")[2] in keys))
    if not found:
        raise InputError(
            "comfort: found no temperature of a zone in this run; record ZONE.air_temperature and "
            "ZONE.mean_radiant_temperature (outputs= of simulate)"
        )
    if zone is None:
        if len(found) > 1:
            raise InputError(f"zone: found none; expected one of {', '.join(found)}")
        return found[0]
    if zone not in found:
        raise InputError(
            f"zone: found {zone!r}; expected a zone with recorded temperatures. {did_you_mean(zone, found)}"
        )
    return zone


def _humidity(
    columns: Mapping[str, Floats], units: Mapping[str, str], name: str, settings: ComfortSettings
) -> Floats | None:
    """Simulated relative humidity in percent, where it is recorded and the settings do not replace it."""
    key = f"{name}.{_HUMIDITY}"
    if key not in columns or settings.humidity not in (None, "simulated"):
        return None
    return np.asarray(columns[key] * (1.0 if units[key] == "%" else 100.0))
