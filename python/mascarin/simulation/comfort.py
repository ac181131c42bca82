"""The comfort of a zone from the series of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.comfort import ComfortSettings, Surroundings
from mascarin.comfort.assessment import Comfort, assess
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building, Output
    from mascarin.comfort.evaluation import Floats
    from mascarin.weather import Climate

_AIR, _RADIANT, _OPERATIVE = "air_temperature", "mean_radiant_temperature", "operative_temperature"
_HUMIDITY = "relative_humidity"
_RADIANT_NOTE = (
    "the mean radiant temperature is the mean of the surfaces of the zone, weighted by area, and not that "
    "at a seat"
)


def comfort_of(
    outputs: Sequence[Output],
    records: Floats,
    times: pd.DatetimeIndex,
    zone: str | None,
    climate: Climate | None,
    settings: ComfortSettings,
    building: Building | None = None,
) -> Comfort:
    """Assess the comfort of a zone.

    Parameters
    ----------
    outputs : sequence of Output
        What was recorded.
    records : ndarray, shape (times, outputs)
        Values. [unit of each output]
    times : pandas.DatetimeIndex, shape (times,)
        Local times.
    zone : str or None
        Name of the zone; None: the only one that was recorded.
    climate : Climate or None
        The weather of the run.
    settings : ComfortSettings
        How comfort is assessed.
    building : Building, optional
        The building of the run, for what is seen from a seat.

    Returns
    -------
    Comfort
        The comfort of the zone.

    Raises
    ------
    InputError
        A series that is needed was not recorded, or something that the index needs is not known.
    """
    columns = {output.name: records[:, k] for k, output in enumerate(outputs)}
    units = {output.name: output.unit for output in outputs}
    name = zone_of(columns, zone)
    notes: tuple[str, ...] = (_RADIANT_NOTE,)
    if settings.seat is not None:
        air, radiant, notes = _at_seat(columns, name, settings, building)
    elif f"{name}.{_AIR}" in columns and f"{name}.{_RADIANT}" in columns:
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


def _at_seat(
    columns: Mapping[str, Floats], name: str, settings: ComfortSettings, building: Building | None
) -> tuple[Floats, Floats, tuple[str, ...]]:
    """Temperature of the air, mean radiant temperature at the seat, and what it was made of."""
    if building is None:
        raise InputError(
            "seat: found no building; expected the building of the run, whose vertices say what is seen "
            "from the seat: run.comfort(..., building=building)"
        )
    view = settings.view(building, name)
    if view is None:
        raise TypeError("a view is from a seat")
    missing = [key for key in (f"{name}.{_AIR}", *view.outputs) if key not in columns]
    if missing:
        raise InputError(
            f"{', '.join(missing)}: not recorded in this run; comfort at a seat needs "
            f"outputs=['{name}.{_AIR}', *seen_from(building, '{name}', seat).outputs] of simulate "
            "(mascarin.comfort.seen_from)"
        )
    radiant = view.radiant(np.stack([columns[key] for key in view.outputs], axis=-1))
    position = ", ".join(f"{c:g}" for c in settings.seat or ())
    notes = (
        f"the mean radiant temperature is that at the seat [{position}] ({settings.posture})",
        *view.notes,
    )
    return columns[f"{name}.{_AIR}"], radiant, (*notes, "no sun falls on the person")


def zone_of(columns: Mapping[str, Any], zone: str | None) -> str:
    """The zone whose comfort is meant.

    Raises
    ------
    InputError
        Nothing of it was recorded, or there are several and none is named.
    """
    keys = (_AIR, _RADIANT, _OPERATIVE)
    owners = list(dict.fromkeys(n.rpartition(".")[0] for n in columns if n.rpartition(".")[2] in keys))
    if not owners:
        raise InputError(
            "comfort: found no temperature of a zone in this run; record ZONE.air_temperature and "
            "ZONE.mean_radiant_temperature (outputs= of simulate)"
        )
    if zone is None:
        if len(owners) > 1:
            raise InputError(f"zone: found none; expected one of {', '.join(owners)}")
        return owners[0]
    if zone not in owners:
        raise InputError(
            f"zone: found {zone!r}; expected a zone with recorded temperatures. {did_you_mean(zone, owners)}"
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
