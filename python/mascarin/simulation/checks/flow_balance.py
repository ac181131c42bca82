"""Check of the air that fans move: what enters a zone must leave it, at every step of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mascarin.building.checks.air import BALANCED, REMEDY, flows_of_zones, imbalance
from mascarin.errors import InputError
from mascarin.tables.times import local_time
from mascarin.weather.records.channels import CHANNELS

if TYPE_CHECKING:
    from datetime import tzinfo

    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.parts.envelope.measured_values import Driven

    Array = npt.NDArray[np.float64]


def require_balanced_flows(
    building: Building, forcing: Array, channels: Sequence[str], begins: Array, clock: tzinfo
) -> None:
    """Refuse flows that do not balance in a zone without make-up air.

    Parameters
    ----------
    building : Building
        The building.
    forcing : ndarray, shape (steps, stages, channels)
        What acts on the building, schedules and columns included. [unit of each]
    channels : sequence of str
        Channels of the forcing after those of the climate.
    begins : ndarray, shape (steps or more,)
        Starts of the steps, in seconds since 1970-01-01 UTC. [s]
    clock : datetime.tzinfo
        Zone of the local clock, for the message.

    Raises
    ------
    InputError
        Naming the zone, the step with the largest difference, and all flows.
    """
    columns = {name: len(CHANNELS) + k for k, name in enumerate(channels)}

    def of(part: Driven) -> Array:
        """Mean flow of each step. [m3/s]"""
        name = part.course.name if part.course is not None else getattr(part, "schedule", None)
        design_flow = float(part.number if part.course is None else part.factor or 0.0)
        course = np.ones(len(forcing)) if name is None else forcing[:, 0, columns[f"schedule {name}"]]
        return np.asarray(design_flow * course)

    for (zone, air), parts in flows_of_zones(building).items():
        if building.zones[zone].makeup_air is not None:
            continue
        flows = {path: sign * of(part) for path, part, sign in parts}
        all_flows = np.array(list(flows.values()))
        enters, leaves = all_flows.clip(min=0.0).sum(axis=0), -all_flows.clip(max=0.0).sum(axis=0)
        worst = int(np.argmax(np.abs(enters - leaves) - BALANCED * np.maximum(enters, leaves)))
        wrong = imbalance({path: float(flow[worst]) for path, flow in flows.items()}, air)
        if wrong is not None:
            when = local_time(float(begins[worst]), clock)
            raise InputError(
                f"zones.{zone}: found that {wrong} in the step from {when:%Y-%m-%d %H:%M}; expected as much "
                f"air in as out. {REMEDY}"
            )
