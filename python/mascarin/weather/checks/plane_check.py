"""Check the clock of a record by the measured irradiance of a tilted plane beside the global one."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array
from mascarin.tables.timezones import zone_name
from mascarin.weather.checks import clock_shift, plane_shift
from mascarin.weather.checks.clock_shift import shifts_of
from mascarin.weather.checks.once import said_once
from mascarin.weather.checks.plane_shift import MeasuredPlane, PlaneShift, shift_by_plane
from mascarin.weather.records.channels import RADIATION
from mascarin.weather.records.record import WeatherRecord

_LARGEST: Final = 600.0
"""A shift by more than this and three times its uncertainty is refused. [s]"""
_NAMED: Final = 180.0
"""One by more than this and three times its uncertainty is named. [s]"""
_FARTHEST: Final = 6000.0
"""Larger shifts put radiation into the night, which is refused for itself; a plane only names them. [s]"""
_FOLLOWED: Final = 0.6
"""Part of the clear hours that the plane must follow with the shift, for a refusal. [-]"""
_MORE: Final = 0.2
"""How many more of the clear hours it must follow than with the stated clock: where most hours follow that
one and some do not at all, there is an obstacle. [-]"""
_AGREED: Final = 2.0
"""Shifts of planes that face different sides agree within this many uncertainties. [-]"""
_ASIDE: Final = 40.0
"""Planes whose azimuths differ by less face the same side. [deg]"""
_TILTS: Final = (45.0, 135.0)
"""Planes closer to the horizontal change too little with the time of day to tell it from a shadow. [deg]"""
_FEWEST_DAYS: Final = 3
"""Clear days from which a refusal may follow."""


def plane_warnings(
    record: WeatherRecord, planes: Sequence[MeasuredPlane], latitude: float, longitude: float
) -> tuple[str, ...]:
    """Compare the irradiance of tilted planes with that of the horizontal and with the sun.

    Refused is a shift of more than ten minutes and of more than three times its uncertainty, on three clear
    days or more, which neither other instruments nor clear hours contradict, and which planes that face
    different sides agree on; a single plane must follow many more hours with it than with the stated clock.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    planes : sequence of MeasuredPlane
        Of the same table.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    tuple of str
        Warnings: smaller shifts, and such that are not certain.

    Raises
    ------
    InputError
        The plane, the global irradiance and the sun do not agree.
    """
    planes = [plane for plane in planes if _TILTS[0] <= plane.tilt <= _TILTS[1]]
    if not planes or not record.measured("global_horizontal") or not record.check_sun:
        return ()
    columns = [record.columns[name] for name in RADIATION if name in record.columns]
    key = (
        "planes",
        sorted(record.columns),
        record.kinds["global_horizontal"],
        [(plane.name, plane.azimuth, plane.tilt, plane.albedo) for plane in planes],
        latitude,
        longitude,
    )
    return said_once(
        record,
        [*columns, *(plane.values for plane in planes)],
        key,
        [sys.modules[__name__], plane_shift, clock_shift],
        lambda: _said(record, planes, latitude, longitude),
    )


def on_grid(values: Array, kind: str, of_global: str) -> Array:
    """Values of a plane as those of the global irradiance are: means of intervals, or those at the stamp.

    Parameters
    ----------
    values : ndarray, shape (rows,)
        Irradiance of the plane. [W/m2]
    kind, of_global : str
        `mean` or `instant`: of the plane, and of the global irradiance.

    Returns
    -------
    ndarray, shape (rows,)
        The last or the first row stays where the one beside it is not known. [W/m2]
    """
    if kind == of_global:
        return values
    if of_global == "mean":
        return np.asarray(0.5 * (values + np.append(values[1:], values[-1:])))
    return np.asarray(0.5 * (values + np.append(values[:1], values[:-1])))


def _said(
    record: WeatherRecord, planes: Sequence[MeasuredPlane], latitude: float, longitude: float
) -> list[str]:
    shown = [(plane, shift_by_plane(record, plane, latitude, longitude)) for plane in planes]
    sure = _of_directions([(plane, shift) for plane, shift in shown if shift is not None])
    if not sure:
        return []
    combined = _combined([shift for _, shift in sure])
    if abs(combined.late) < max(_NAMED, 3.0 * combined.uncertainty):
        return []
    text = _sentence([plane for plane, _ in sure], combined)
    agreed = len(sure) > 1 and all(
        abs(shift.late - combined.late) < _AGREED * shift.uncertainty for _, shift in sure
    )
    certain = _LARGEST < abs(combined.late) < _FARTHEST and combined.days >= _FEWEST_DAYS
    if not (certain and (agreed or _is_clear(combined))) or _contradicted(
        record, combined, latitude, longitude
    ):
        return [f"{record.file}: {text}; the clock is used as stated."]
    minutes = -round(combined.late / 60.0)
    stated = ", ".join(f"{plane.name} {plane.azimuth:g} and {plane.tilt:g} deg" for plane, _ in sure)
    raise InputError(
        f"{record.file}: {text}; expected less than {_LARGEST / 60.0:g} min. Check the time zone (now "
        f"{zone_name(record.grid.zone)}), whether stamps mark the start or the end of their interval, and "
        f"azimuth and tilt (now {stated}). If the clock was wrong, state shift: {minutes}min (on the command "
        f"line --shift={minutes}min, in Python shift='{minutes}min'). If all of these are right, read the "
        "record as it is with check_sun: false (on the command line --no-check-sun, in Python "
        "check_sun=False)."
    )


def _of_directions(
    shown: list[tuple[MeasuredPlane, PlaneShift]],
) -> list[tuple[MeasuredPlane, PlaneShift]]:
    """Of planes that face the same side the one with the least uncertainty, the most certain first."""
    chosen: list[tuple[MeasuredPlane, PlaneShift]] = []
    for plane, shift in sorted(shown, key=lambda pair: pair[1].uncertainty):
        apart = [abs((plane.azimuth - other.azimuth + 180.0) % 360.0 - 180.0) for other, _ in chosen]
        if all(angle > _ASIDE for angle in apart):
            chosen.append((plane, shift))
    return chosen


def _combined(shifts: list[PlaneShift]) -> PlaneShift:
    """Mean of the shifts of some planes by their uncertainties; what is best for one stays for the others."""
    if len(shifts) == 1:
        return shifts[0]
    weights = np.array([shift.uncertainty**-2 for shift in shifts])
    late = float(np.average([shift.late for shift in shifts], weights=weights))
    spread = float(np.sqrt(np.average([(shift.late - late) ** 2 for shift in shifts], weights=weights)))
    uncertainty = max(float(weights.sum() ** -0.5), spread / np.sqrt(len(shifts) - 1.0), plane_shift.FLOOR)
    best = shifts[0]
    return PlaneShift(late, uncertainty, best.days, best.followed, best.stated)


def _is_clear(shift: PlaneShift) -> bool:
    """Whether one plane shows a shift of the clock alone: no obstacle and no cloud explains it."""
    return shift.followed >= _FOLLOWED and shift.followed - shift.stated >= _MORE


def _contradicted(record: WeatherRecord, shift: PlaneShift, latitude: float, longitude: float) -> bool:
    """Whether other instruments or the form of clear hours show another shift."""
    return any(
        not other.split
        and abs(other.late - shift.late) > 3.0 * float(np.hypot(other.uncertainty, shift.uncertainty))
        for other in shifts_of(record, latitude, longitude)
    )


def _sentence(planes: Sequence[MeasuredPlane], shift: PlaneShift) -> str:
    side = "later" if shift.late > 0.0 else "earlier"
    names = ", ".join(plane.name for plane in planes)
    return (
        f"the radiation is {abs(shift.late) / 60.0:.0f} min (standard uncertainty "
        f"{shift.uncertainty / 60.0:.1f} min) {side} than the sun: {names} beside global_horizontal "
        f"agree{'s' * (len(planes) == 1)} with the stated direction with this shift ({shift.days} clear days)"
    )
