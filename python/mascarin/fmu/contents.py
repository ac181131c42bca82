"""A run as files for programs without Python: a unit for co-simulation, a page whose model runs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin.weather import CHANNELS, summary

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.fmu.variables import Variable
    from mascarin.simulation import Simulation
    from mascarin.simulation.records.recorded_outputs import Readings

    Array = npt.NDArray[np.float64]

#: Number of the format, as in `crates/contents`.
_FORMAT: Final = 2
_MAGIC: Final = b"MASCARIN"


def packed(forcing: Array) -> bytes:
    """The file ``forcing.bin``: each channel in one piece, which archives pack tighter.

    Parameters
    ----------
    forcing : ndarray, shape (steps, stages, channels)
        Weather, measured boundaries and schedules. [unit of each channel]
    """
    return _MAGIC + np.ascontiguousarray(np.moveaxis(forcing, -1, 0), dtype="<f8").tobytes()


def run_json(
    simulation: Simulation,
    variables: Sequence[Variable],
    token: str,
    *,
    global_follows: bool = False,
    readings: Readings | None = None,
    sources: bool = True,
) -> bytes:
    """The file ``run.json``: settings, what is recorded, variables, and where all of it comes from.

    Parameters
    ----------
    simulation : Simulation
        The run.
    variables : sequence of Variable
        Inputs, outputs and parameters.
    token : str
        What the contents are known by.
    global_follows : bool
        Whether the global radiation is calculated from its parts, because one of them is an input.
    readings : Readings, optional
        What is recorded. Default: the outputs of the run.
    sources : bool
        Whether it names the weather file and the measured table, with what was read of each column.
    """
    compiled = simulation.compiled
    content = {
        "format": _FORMAT,
        "mascarin_version": __version__,
        "token": token,
        "settings": dict(compiled.settings),
        "outputs": json.loads((readings or compiled.readings).outputs),
        "variables": [variable.plain() for variable in variables],
        "conditioned": _conditioned(simulation),
        "global_follows": global_follows,
        "building": simulation.building.name,
        "building_sha256": compiled.hash,
        "start": simulation.start.isoformat(),
    }
    if sources:
        content |= {"climate": summary(simulation.climate), "measurements": simulation.measured}
    return json.dumps(content, default=str).encode()


def _conditioned(simulation: Simulation) -> list[dict[str, Any]]:
    """Zones whose set points must not cross."""

    def place(zone: str, which: str) -> dict[str, int]:
        point = simulation.building.zones[zone].loads[which].setpoint
        if point.temperature is not None:
            return {"parameter": simulation.position(f"zones.{zone}.{which}.setpoint.temperature")}
        return {"channel": len(CHANNELS) + simulation.channels.index(f"schedule {point.course}")}

    return [
        {"zone": name, "heating": place(name, "heating"), "cooling": place(name, "cooling")}
        for name, zone in simulation.building.zones.items()
        if zone.heating is not None and zone.cooling is not None
    ]
