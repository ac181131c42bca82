"""The start of a run: what a user gives, and the temperatures of a building that follow from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

from pydantic import ValidationError

from mascarin.errors import InputError
from mascarin.simulation.preparation.initial_state import (
    LIMITS,
    Ambient,
    GivenStart,
    InitialTemperatures,
    InitialWall,
    Known,
    StartError,
    given,
    located,
    profile,
    walls,
)

if TYPE_CHECKING:
    from datetime import datetime

    from mascarin.building import Building
    from mascarin.weather import Measurements

#: The first value of a sensor lies within this time after the start. [s]
WITHIN: Final = 3600.0
_BETWEEN: Final = f"between {LIMITS[0]:g} and {LIMITS[1]:g} degC"


@dataclass(frozen=True, eq=False)
class MeasuredStart:
    """A start from measured temperatures.

    Parameters
    ----------
    measurements : Measurements
        The table; temperatures in degC.
    sensors : mapping of str to str or sequence of str
        Column of each output, or columns whose mean is used. Temperatures of zone airs, surfaces, interfaces,
        phase-change layers and sensors in walls are used; other outputs are ignored.

    Examples
    --------
    >>> import pandas as pd
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> climate = box_climate()
    >>> table = pd.DataFrame({"air": 24.5}, index=climate.index)
    >>> measured = mc.Measurements.from_table(table, timezone="UTC-07:00")
    >>> start = mc.MeasuredStart(measured, {"room.air_temperature": "air"})
    >>> mc.simulate(box(), climate, step="1h", initial=start).provenance.start
    'measured from 2001-07-01 00:00: room.air_temperature 24.5 degC...'
    """

    measurements: Measurements
    sensors: Mapping[str, str | Sequence[str]]

    def known(self, building: Building, wall_list: Sequence[InitialWall], start: datetime) -> Known:
        """The first value of each sensor.

        Parameters
        ----------
        building : Building
            The building.
        wall_list : sequence of InitialWall
            Its walls.
        start : datetime
            Start of the run.

        Raises
        ------
        StartError
            A sensor has no value, or an impossible one, or none of them is in the air of a zone.
        """
        zones: dict[str, float] = {}
        points: dict[str, list[tuple[float, float]]] = {}
        notes = []
        for name, columns in self.sensors.items():
            position = located(building.output(name), wall_list, building)
            if position is None:
                continue
            value = self._first(name, [columns] if isinstance(columns, str) else list(columns), start)
            notes.append(f"{name} {value:g}")
            if position[1] is None:
                zones[position[0]] = value
            else:
                points.setdefault(position[0], []).append((position[1], value))
        if building.zones and not zones:
            raise StartError(
                ("initial",),
                f"found no sensor in the air of {' or '.join(building.zones)}, expected at least one for a "
                "measured start: add it, or give temperatures (initial: {zones: {...}})",
            )
        return Known(zones, points, None, f"measured from {start:%Y-%m-%d %H:%M}: {', '.join(notes)} degC")

    def _first(self, name: str, columns: Sequence[str], start: datetime) -> float:
        """First value within an hour of the start, the mean of the columns that have one. [degC]"""
        import numpy as np
        import pandas as pd

        table, step = self.measurements, self.measurements.step_seconds
        times = pd.date_range(start, periods=1 + int(WITHIN // step), freq=pd.Timedelta(seconds=step))
        rows = np.stack([table.at(column, times) for column in columns])
        where = f"{' and '.join(repr(column) for column in columns)} ({name})"
        for row in rows.T:
            value = float(row[np.isfinite(row)].mean()) if np.isfinite(row).any() else None
            if value is None:
                continue
            if not LIMITS[0] < value < LIMITS[1]:
                raise StartError(
                    ("initial",),
                    f"found {value:g} in {where} at the start, expected a temperature {_BETWEEN}: correct "
                    "the column or its unit, or leave that sensor out (in a study use: false)",
                )
            return value
        raise StartError(
            ("initial",),
            f"found no value of {where} within an hour from {start:%Y-%m-%d %H:%M} in {table.file} (missing "
            "or masked), expected one: begin later, leave that sensor out (in a study use: false), or give "
            "temperatures (initial: {zones: {...}})",
        )


Initial = Literal["repeat"] | float | Mapping[str, Any] | GivenStart | MeasuredStart
"""Values of the option ``initial``."""


def read(start: object) -> float | GivenStart | MeasuredStart | None:
    """Read the option ``initial``: one temperature [degC], given or measured ones, or None for ``repeat``.

    Raises
    ------
    InputError
        Another value.
    """
    if isinstance(start, GivenStart | MeasuredStart):
        return start
    if isinstance(start, str) and start == "repeat":
        return None
    if isinstance(start, (int, float)) and not isinstance(start, bool) and LIMITS[0] < start < LIMITS[1]:
        return float(start)
    if isinstance(start, Mapping):
        from mascarin.building.reading import explained

        plain = dict(start)
        try:
            return GivenStart.model_validate(plain)
        except ValidationError as error:
            raise explained(error, plain, "initial") from None
    raise InputError(
        f"initial: found {start!r}, expected 'repeat', a temperature {_BETWEEN}, a mapping of temperatures "
        "such as {'zones': {'room': 21}}, or a MeasuredStart"
    )


def resolved(
    stated: GivenStart | MeasuredStart,
    building: Building,
    nodes: Mapping[tuple[str, str], int],
    ambient: Ambient,
    start: datetime,
) -> InitialTemperatures:
    """Temperatures everywhere in a building.

    Parameters
    ----------
    stated : GivenStart or MeasuredStart
        Temperatures that are given or measured.
    building : Building
        The building.
    nodes : mapping of (str, str) to int
        Finite volumes by construction and layer.
    ambient : Ambient
        Temperatures around it at the start.
    start : datetime
        Start of the run.

    Raises
    ------
    StartError
        A name that does not exist, a sensor without a value, no temperature of any air.
    """
    wall_list = walls(building, nodes)
    if isinstance(stated, MeasuredStart):
        return profile(building, wall_list, stated.known(building, wall_list, start), ambient)
    return profile(building, wall_list, given(stated, wall_list, building), ambient)
